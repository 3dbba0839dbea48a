/* windows.h - included before every source of the Windows build (cross.sh): what its C library
 * calls otherwise.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CROSS_WINDOWS_H
#define CROSS_WINDOWS_H

#include <direct.h>
#include <sys/stat.h>

#define mkdir(path, mode) _mkdir(path)

#endif
