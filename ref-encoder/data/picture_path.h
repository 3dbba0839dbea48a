/* picture_path.h - the file that a list of pictures means by a name, however it writes it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PICTURE_PATH_H
#define TED4_PICTURE_PATH_H

/* The first that exists of: the name as it stands, in the scene's folder (or absolute); the same
 * without its first folders, one after the other, as lists come from other machines; and a name
 * without a folder in images/, in part/ (NULL: none), rgb/ or frames/. Each with its own extension,
 * with .png, .jpg or .jpeg added, in capitals, too, or in place of the extension that it has.
 * Backslashes count as slashes. 1 with *path the caller's; 0: there is none; -1: no memory. */
int ted4_picture_find(const char *folder, const char *name, const char *part, char **path);

/* Does the name end as a picture's does? */
int ted4_picture_is_named(const char *name);

#endif
