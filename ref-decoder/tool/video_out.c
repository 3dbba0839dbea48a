/* video_out.c - see video_out.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "video_out.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "leftovers.h"
#include "mp4_whole.h"

/* Exit status of a child process that could not become ffmpeg. */
enum { NO_FFMPEG = 127 };

/* Players want even sizes and colours at half the resolution. ffmpeg converts colours by BT.601
 * unless told otherwise, and players guess BT.709 for videos of 720 lines or more. */
static const char FILTER[] =
    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709,format=yuv420p";

/* Runs in the child process and never returns. */
static void become_ffmpeg(const char *size, const char *rate, const char *to, int pictures,
                          int messages)
{
    const int none = open("/dev/null", O_WRONLY);

    if (none >= 0 && dup2(pictures, 0) >= 0 && dup2(none, 1) >= 0 && dup2(messages, 2) >= 0)
        execlp("ffmpeg", "ffmpeg", "-hide_banner", "-v", "repeat+error", "-xerror", "-f",
               "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", rate, "-i", "pipe:0", "-vf",
               FILTER, "-color_range", "tv", "-colorspace", "bt709", "-color_primaries", "bt709",
               "-color_trc", "iec61966-2-1", "-flags", "+bitexact", "-fflags", "+bitexact",
               "-movflags", "+faststart", "-f", "mp4", "-y", to, (char *)NULL);
    _exit(NO_FFMPEG);
}

/* Starts ffmpeg with the pictures from a pipe. Returns 0, or -1 with errno set. */
static int start(ted4_video_out *v, const char *size, const char *rate)
{
    char to[TED4_PATH_SIZE + 8];
    int ends[2];

    /* "file:": no name is taken for an option or a protocol. */
    snprintf(to, sizeof to, "file:%s", v->file.temporary);
    if (pipe(ends) != 0)
        return -1;
    (void)fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    v->child = fork();
    if (v->child == 0)
        become_ffmpeg(size, rate, to, ends[0], fileno(v->messages));
    v->pipe = ends[1];

    const int why = errno;

    close(ends[0]);
    if (v->child > 0) {
        ted4_leftovers_written(v->file.temporary, v->child);
        return 0;
    }
    close(v->pipe);
    errno = why;
    return -1;
}

int ted4_video_out_open(ted4_video_out *v, const char *path, int width, int height,
                        uint32_t rate_num, uint32_t rate_den, char *why, size_t why_size)
{
    char size[32], rate[32];

    snprintf(size, sizeof size, "%dx%d", width, height);
    snprintf(rate, sizeof rate, "%" PRIu32 "/%" PRIu32, rate_num, rate_den);
    v->broken = 0;
    v->bytes = (size_t)width * (size_t)height * 3;
    if (ted4_output_open(&v->file, path) != 0) {
        snprintf(why, why_size, "%s", strerror(errno));
        return -1;
    }
    v->messages = tmpfile();
    if (v->messages != NULL && start(v, size, rate) == 0)
        return 0;
    snprintf(why, why_size, "%s%s",
             v->messages == NULL ? "no temporary file for the messages of ffmpeg: " : "",
             strerror(errno));
    if (v->messages != NULL)
        fclose(v->messages);
    ted4_output_cancel(&v->file);
    return -1;
}

int ted4_video_out_write(ted4_video_out *v, const uint8_t *rgb)
{
    for (size_t done = 0; done < v->bytes;) {
        const ssize_t n = write(v->pipe, rgb + done, v->bytes - done);

        if (n < 0 && errno != EINTR) {
            v->broken = 1;
            return -1;
        }
        done += n > 0 ? (size_t)n : 0;
    }
    return 0;
}

/* Reads the first line of the messages, without characters that are not text. */
static void first_words(FILE *messages, char *text, size_t size)
{
    size_t n = 0;

    rewind(messages);
    for (int c; n + 1 < size && (c = getc(messages)) != EOF && c != '\n';)
        if (c >= ' ' && c != 127)
            text[n++] = (char)c;
    text[n] = '\0';
}

/* Returns what is wrong with the video of an ffmpeg that has ended, or NULL. Status 0 is no proof:
 * some versions give it where the end of the file could not be written. Nor is a message proof of a
 * failure: libraries, and what loads them, print harmless ones. words: the first message. */
static const char *fault(const ted4_video_out *v, int status, int keep, const char *words)
{
    const int fails = v->broken || !WIFEXITED(status) || WEXITSTATUS(status) != 0;

    if (!fails && (!keep || ted4_mp4_is_whole(v->file.temporary)))
        return NULL;
    if (words[0] != '\0')
        return words;
    return fails ? "it says no reason" : "the video is not complete";
}

int ted4_video_out_close(ted4_video_out *v, int keep, char *why, size_t why_size)
{
    const char *wrong;
    char words[200];
    int status;

    close(v->pipe);
    status = ted4_leftovers_wait(v->file.temporary, v->child);
    first_words(v->messages, words, sizeof words);
    fclose(v->messages);
    wrong = fault(v, status, keep, words);
    if (wrong != NULL && WIFEXITED(status) && WEXITSTATUS(status) == NO_FFMPEG)
        snprintf(why, why_size, "videos need the program ffmpeg, which cannot be started");
    else if (wrong != NULL)
        snprintf(why, why_size, "ffmpeg failed: %s", wrong);
    if (wrong != NULL || !keep) {
        ted4_output_cancel(&v->file);
        return wrong != NULL ? -1 : 0;
    }
    if (ted4_output_close(&v->file) == 0)
        return 0;
    snprintf(why, why_size, "%s", strerror(errno));
    return -1;
}
