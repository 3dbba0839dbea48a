/* leftovers.h - files and folders that are not complete yet, which a signal that ends the program
 * removes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LEFTOVERS_H
#define TED4_LEFTOVERS_H

#include <sys/types.h>

/* As many files and folders may be unfinished at a time; more than these stay where a signal ends
 * the program. */
enum { TED4_LEFTOVERS = 8 };

/* From now on SIGINT, SIGTERM, SIGHUP and SIGPIPE remove what was added, and then end the program
 * as they do by themselves. A signal that was ignored before stays ignored. */
void ted4_leftovers_watch(void);

/* The file at path is not complete. path must stay as it is until ted4_leftovers_forget. writer:
 * the child process that writes the file and is ended with this one, or 0. May be called from any
 * thread. */
void ted4_leftovers_add(const char *path, pid_t writer);
/* The same for a folder. empty: removes it with the files that may be in it; a signal handler calls
 * it, so that it may use only functions that are safe there. */
void ted4_leftovers_add_folder(const char *path, void (*empty)(const char *path));
/* A child process writes the file or folder, and is ended with this one, until ted4_leftovers_wait.
 * path: the pointer that was added. */
void ted4_leftovers_written(const char *path, pid_t writer);
/* Waits for the end of the child process that writes the file or folder. Returns its status, as
 * waitpid gives it, or -1. path: the pointer that was added. */
int ted4_leftovers_wait(const char *path, pid_t writer);
/* The file or folder has its name, or is gone. path: the pointer that was added. */
void ted4_leftovers_forget(const char *path);
/* Ends the writers and removes the files and folders. For signal handlers. */
void ted4_leftovers_remove(void);

#endif
