/* picture_path.h - finds the file of a picture from its name in a list of pictures.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PICTURE_PATH_H
#define TED4_PICTURE_PATH_H

/* Gives the first of these that exists: the name as written, absolute or relative to the scene's
 * folder; the name without its first folder, its first two folders and so on, because lists may
 * come from other machines; and, for a name without a folder, the name in images/, part/ (unless
 * part is NULL), rgb/ or frames/. Each is tried as it is, with .png, .jpg or .jpeg added, and with
 * one of these in place of its own extension; the extensions are also tried in capitals.
 * Backslashes count as slashes. Returns 1 with *path owned by the caller, 0 if there is no such
 * file, or -1 if memory runs out. */
int ted4_picture_find(const char *folder, const char *name, const char *part, char **path);

/* Does the name end in the extension of a picture? */
int ted4_picture_is_named(const char *name);

/* Returns the last run of digits in the base name without its extension, -1 if there is none, or -2
 * if it has more than 15 digits, which a double may not hold. */
double ted4_picture_number(const char *name);

#endif
