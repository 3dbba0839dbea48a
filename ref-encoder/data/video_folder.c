/* video_folder.c - see video_folder.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/video_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "tool/leftovers.h"

#define UNIQUE ".XXXXXX" /* end of the name, as mkdtemp fills it */
enum { IDLE = 60 };      /* seconds in which an abandoned folder has not changed */

void ted4_video_folder_remove(const char *path)
{
    DIR *d = opendir(path);

    for (struct dirent *e = d == NULL ? NULL : readdir(d); e != NULL; e = readdir(d)) {
        char *file = ted4_path_join(path, e->d_name);
        if (file != NULL && ted4_is_file(file))
            unlink(file);
        free(file);
    }
    if (d != NULL)
        closedir(d);
    rmdir(path);
}

/* Writes the name of frame n, with six digits, as printf would do, which a signal handler may not
 * call. */
static void name_frame(char name[sizeof "000001.png"], unsigned n)
{
    memcpy(name, "000000.png", sizeof "000001.png");
    for (int i = 5; i >= 0; i--, n /= 10)
        name[i] = (char)('0' + n % 10);
}

/* Removes a folder that ffmpeg was filling. For signal handlers. */
static void empty(const char *path)
{
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    char name[sizeof "000001.png"];
    unsigned n = 1;

    do
        name_frame(name, n);
    while (n++ < 999999 && unlinkat(folder, name, 0) == 0);
    unlinkat(folder, TED4_VIDEO_COUNT, 0);
    rmdir(path);
}

/* Locks a folder. Returns a descriptor, which holds the lock until it is closed, or -1. */
static int lock_folder(const char *path)
{
    const int lock = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);

    if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) != 0) {
        close(lock);
        return -1;
    }
    return lock;
}

int ted4_video_folder_make(ted4_video_folder *v, const char *final, ted4_message *m)
{
    const size_t size = strlen(final) + sizeof UNIQUE;

    v->lock = -1;
    v->path = malloc(size);
    if (v->path == NULL)
        return ted4_say_no_memory(m);
    snprintf(v->path, size, "%s" UNIQUE, final);
    if (mkdtemp(v->path) == NULL) {
        ted4_say(m, "%s: %s", v->path, strerror(errno));
        free(v->path);
        return -1;
    }
    ted4_leftovers_add_folder(v->path, empty);
    v->lock = lock_folder(v->path); /* without one, another program may remove it when it is idle */
    return 0;
}

void ted4_video_folder_leave(ted4_video_folder *v)
{
    ted4_video_folder_remove(v->path);
    ted4_leftovers_forget(v->path);
    if (v->lock >= 0)
        close(v->lock);
    free(v->path);
}

/* Is this NAME-KEY.XXXXXX, with the 16 digits of a key? */
static int is_unfinished(const char *name)
{
    const size_t n = strlen(name), end = sizeof UNIQUE - 1, key = 16;

    return n > key + end && name[n - end] == '.' && name[n - end - key - 1] == '-' &&
           strspn(name + n - end - key, "0123456789abcdef") == key;
}

static void sweep_one(const char *path)
{
    struct stat s;

    if (lstat(path, &s) != 0 || !S_ISDIR(s.st_mode) || time(NULL) - s.st_mtime < IDLE)
        return;
    const int lock = lock_folder(path);
    if (lock >= 0) {
        ted4_video_folder_remove(path);
        close(lock);
    }
}

void ted4_video_folder_sweep(const char *cache)
{
    DIR *d = opendir(cache);

    for (struct dirent *e = d == NULL ? NULL : readdir(d); e != NULL; e = readdir(d)) {
        char *path = is_unfinished(e->d_name) ? ted4_path_join(cache, e->d_name) : NULL;
        if (path != NULL)
            sweep_one(path);
        free(path);
    }
    if (d != NULL)
        closedir(d);
}
