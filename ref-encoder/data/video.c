/* video.c - see video.h. Frames are unpacked into a folder with a unique name, which gets its final
 * name when it is complete. So a folder with the final name always holds every frame, and programs
 * that unpack the same video at the same time do not disturb one another. What a killed program has
 * left is removed when the next video is unpacked; a signal that can be caught leaves nothing.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/video.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xxhash.h>
#include "data/data_util.h"
#include "data/raw_scene.h"
#include "data/video_folder.h"
#include "data/video_kind.h"
#include "tool/leftovers.h"

#define NO_EXEC 127         /* exit status of a child that could not start ffmpeg */
#define TAIL    2000        /* size of the kept end of ffmpeg's messages, in bytes */
enum { TELL_EVERY = 1000 }; /* interval of progress reports, in milliseconds */

/* The filters make time stamps even, so that no frame is duplicated or dropped; convert to RGB,
 * identically on every machine; and remove the colour tags, by which some PNG readers would convert
 * again. */
#define FILTERS                                                                                    \
    "settb=AVTB,setpts=N*40000,scale=flags=bitexact+accurate_rnd+full_chroma_int+full_chroma_inp," \
    "format=rgb24,setparams=color_primaries=unknown:color_trc=unknown"
#define RATE "25" /* 1 / 40000 us, as in setpts */

/* Returns the folder of all unpacked videos, which is created if necessary. A folder of another
 * user is refused, because its files would be used as pictures. Owned by the caller. Returns NULL
 * with *m filled on failure. */
static char *cache_folder(ted4_message *m)
{
    const char *cache = getenv("XDG_CACHE_HOME"), *temporary = getenv("TMPDIR");
    const int has_cache = cache != NULL && *cache != 0;
    char name[40] = "ted4";
    struct stat s;

    if (!has_cache) {
        snprintf(name, sizeof name, "ted4-%lu", (unsigned long)getuid());
        cache = temporary != NULL && *temporary != 0 ? temporary : "/tmp";
    }
    char *folder = ted4_path_join(cache, name);
    if (folder == NULL) {
        ted4_say_no_memory(m);
        return NULL;
    }
    if (has_cache)
        mkdir(cache, 0700);
    if (mkdir(folder, 0700) != 0 && errno != EEXIST)
        ted4_say(m,
                 "%s: cannot be made, for the frames of videos (XDG_CACHE_HOME, TMPDIR choose): %s",
                 folder, strerror(errno));
    else if (lstat(folder, &s) != 0 || !S_ISDIR(s.st_mode) || s.st_uid != getuid())
        ted4_say(m,
                 "%s: not a folder of this user, needed for the frames of videos (XDG_CACHE_HOME, "
                 "TMPDIR choose)",
                 folder);
    else
        return folder;
    free(folder);
    return NULL;
}

/* Returns cache/NAME-KEY. path: absolute path of the video. */
static char *final_folder(const char *cache, const char *path, const struct stat *s, size_t most)
{
    const char *base = strrchr(path, '/');
    char identity[320], name[120];

    snprintf(identity, sizeof identity, "%lld %lld.%09ld %zu " FILTERS, (long long)s->st_size,
             (long long)s->st_mtim.tv_sec, (long)s->st_mtim.tv_nsec, most);
    const XXH64_hash_t key = XXH64(path, strlen(path), XXH64(identity, strlen(identity), 0));
    snprintf(name, sizeof name, "%.80s-%016llx", base == NULL ? path : base + 1,
             (unsigned long long)key);
    return ted4_path_join(cache, name);
}

/* Counts the pictures in a folder, from 1 on without a gap. One without bytes is none: a crash of
 * the machine may leave the name of a file without its contents. */
static size_t count_frames(const char *folder)
{
    char name[32];
    struct stat s;
    int n = 0, found = 1;

    while (found) {
        snprintf(name, sizeof name, TED4_VIDEO_FRAME, n + 1);
        char *path = ted4_path_join(folder, name);
        found = path != NULL && stat(path, &s) == 0 && S_ISREG(s.st_mode) && s.st_size > 0;
        n += found != 0;
        free(path);
    }
    return (size_t)n;
}

/* Does the folder hold every frame that was unpacked? Programs that clean up old files may have
 * removed some. */
static int is_complete(const char *folder)
{
    char *path = ted4_path_join(folder, TED4_VIDEO_COUNT);
    FILE *f = path == NULL ? NULL : fopen(path, "r");
    unsigned long n = 0;
    const int told = f != NULL && fscanf(f, "%lu", &n) == 1;

    if (f != NULL)
        fclose(f);
    free(path);
    return told && n == count_frames(folder);
}

static int write_count(const char *folder, size_t n)
{
    char *path = ted4_path_join(folder, TED4_VIDEO_COUNT);
    FILE *f = path == NULL ? NULL : fopen(path, "w");
    int fine = f != NULL && fprintf(f, "%zu\n", n) > 0;

    if (f != NULL)
        fine = fclose(f) == 0 && fine;
    free(path);
    return fine ? 0 : -1;
}

/* A video that is unpacked: who receives progress reports, its absolute path, the demuxer that
 * reads it, and the folder of its frames. */
typedef struct {
    const ted4_dataset_options *o;
    const char *video, *demuxer, *folder;
} unpacking;

/* Makes this process, a child, end with its parent, whatever ends that: ffmpeg would go on to fill
 * the disk. Only Linux can do this. */
static void end_with(pid_t parent)
{
#ifdef __linux__
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent)
        _exit(NO_EXEC);
#else
    (void)parent;
#endif
}

/* Runs in the child process: works in the folder, writes errors to messages, and never returns. */
static void become_ffmpeg(const unpacking *a, const char *input, const char *limit, int messages)
{
    const int none = chdir(a->folder) == 0 ? open("/dev/null", O_RDWR) : -1;

    if (none >= 0 && dup2(none, 0) >= 0 && dup2(none, 1) >= 0 && dup2(messages, 2) >= 0)
        execlp("ffmpeg", "ffmpeg", "-nostdin", "-hide_banner", "-v", "repeat+error",
               "-protocol_whitelist", "file", "-f", a->demuxer, "-i", input, "-map", "0:v:0", "-vf",
               FILTERS, "-r", RATE, "-frames:v", limit, "-flags", "+bitexact", "-fflags",
               "+bitexact", "-compression_level", "1", "-f", "image2", TED4_VIDEO_FRAME,
               (char *)NULL);
    _exit(NO_EXEC);
}

/* Waits until there is something to read or the end is reached, and meanwhile reports the number of
 * frames. */
static void await(int from, const unpacking *a)
{
    struct pollfd wanted = { .fd = from, .events = POLLIN };

    if (a->o == NULL || a->o->unpacking == NULL)
        return;
    while (poll(&wanted, 1, TELL_EVERY) == 0)
        a->o->unpacking(a->o->user, a->video, count_frames(a->folder));
}

/* Reads messages to the end and keeps the last ones in tail, as a string. */
static void read_messages(int from, const unpacking *a, char tail[TAIL])
{
    size_t n = 0;

    for (;;) {
        await(from, a);
        if (n == TAIL - 1) {
            memmove(tail, tail + TAIL / 2, n - TAIL / 2);
            n -= TAIL / 2;
        }
        const ssize_t got = read(from, tail + n, TAIL - 1 - n);
        if (got == 0 || (got < 0 && errno != EINTR))
            break;
        n += got > 0 ? (size_t)got : 0;
    }
    tail[n] = 0;
}

/* Runs ffmpeg in a->folder. Returns its exit status, or -1, and gives the end of its
 * messages. They come through a pipe, because a file could not be written on a full disk. */
static int run_ffmpeg(const unpacking *a, size_t most, char tail[TAIL])
{
    char input[4200], limit[24];
    int ends[2];

    tail[0] = 0;
    snprintf(limit, sizeof limit, "%zu", most);
    if (snprintf(input, sizeof input, "file:%s", a->video) >= (int)sizeof input || pipe(ends) != 0)
        return -1;
    const pid_t parent = getpid(), child = fork();
    if (child == 0) {
        end_with(parent);
        become_ffmpeg(a, input, limit, ends[1]);
    }
    close(ends[1]);
    if (child > 0) {
        ted4_leftovers_written(a->folder, child);
        read_messages(ends[0], a, tail);
    }
    close(ends[0]);
    if (child < 0)
        return -1;

    const int status = ted4_leftovers_wait(a->folder, child);

    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* Gives the last line of the messages, preceded by ": ", or an empty string if there are none.
 * Bytes that are not text are omitted. */
static void last_words(char tail[TAIL], char words[200])
{
    size_t end = strlen(tail), start, n = 0;

    while (end > 0 && (uint8_t)tail[end - 1] <= ' ')
        end--;
    start = end;
    while (start > 0 && tail[start - 1] != '\n')
        start--;
    words[0] = 0;
    if (end > start)
        n = (size_t)snprintf(words, 200, ": ");
    for (; start < end && n < 199; start++)
        if ((uint8_t)tail[start] >= ' ' && tail[start] != 127)
            words[n++] = tail[start];
    words[n] = 0;
}

static int fill(const unpacking *a, size_t most, ted4_message *m)
{
    const char *const video = a->video, *const folder = a->folder;
    char tail[TAIL], words[200];
    const int status = run_ffmpeg(a, most, tail);
    const size_t n = count_frames(folder);

    if (status == NO_EXEC)
        return ted4_say(
            m,
            "%s: the program ffmpeg is needed to read it and cannot be started (is it installed?)",
            video);
    last_words(tail, words);
    if (status != 0 || n == 0)
        return ted4_say(m, "%s: ffmpeg, unpacking into %s, failed after %zu frames%s", video,
                        folder, n, words);
    if (words[0] != 0) /* what it cannot decode it leaves out, or makes up, and goes on */
        return ted4_say(m,
                        "%s: ffmpeg gives %zu frames, but some may be missing or wrong%s (if not, "
                        "convert the video with ffmpeg and use the result)",
                        video, n, words);
    return write_count(folder, n) == 0 ? 0 : ted4_say(m, "%s: %s", folder, strerror(errno));
}

/* Gives a complete folder its final name. A folder of that name makes way if it lacks frames, and
 * stays if it does not, because another program was first. Returns 0, or -1 with *m filled. */
static int settle(const char *folder, const char *final, ted4_message *m)
{
    if (rename(folder, final) == 0 || is_complete(final))
        return 0;
    ted4_video_folder_remove(final);
    if (rename(folder, final) == 0)
        return 0;

    const int why = errno;

    return is_complete(final) ? 0 : ted4_say(m, "%s: %s", final, strerror(why));
}

/* Unpacks into a new folder beside the final one, and renames it. */
static int unpack(const unpacking *a, size_t most, const char *final, ted4_message *m)
{
    unpacking with_folder = *a;
    ted4_video_folder v;

    if (ted4_video_folder_make(&v, final, m) != 0)
        return -1;
    with_folder.folder = v.path;

    int result = fill(&with_folder, most, m);
    if (result == 0)
        result = settle(v.path, final, m);
    /* The folder does not exist any more if it was renamed. It does if this failed or another
     * program was first. */
    ted4_video_folder_leave(&v);
    return result;
}

/* Returns an absolute path, since ffmpeg works in another folder. Owned by the caller. */
static char *absolute(const char *path)
{
    char here[4096];

    return getcwd(here, sizeof here) == NULL ? NULL : ted4_path_join(here, path);
}

char *ted4_video_unpack(const char *video, size_t most, const ted4_dataset_options *o,
                        ted4_message *m)
{
    struct stat s;
    const size_t limit = most > 0 && most < TED4_MAX_FRAMES ? most : TED4_MAX_FRAMES;
    char *cache = cache_folder(m), *path = cache == NULL ? NULL : absolute(video);
    unpacking a = { .o = o, .video = path };
    char *final = NULL;

    if (cache != NULL && (path == NULL || stat(path, &s) != 0))
        ted4_say(m, "%s: %s", video, strerror(errno));
    else if (cache != NULL && (final = final_folder(cache, path, &s, limit)) == NULL)
        ted4_say_no_memory(m);
    if (final != NULL && !is_complete(final)) {
        ted4_video_folder_sweep(cache);
        a.demuxer = ted4_video_demuxer(path, m);
        if (a.demuxer == NULL || unpack(&a, limit, final, m) != 0) {
            free(final);
            final = NULL;
        }
    }
    free(cache);
    free(path);
    return final;
}
