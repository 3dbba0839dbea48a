/* mp4_whole.h - whether a file of MP4 is whole, by its boxes (ISO/IEC 14496-12, 4.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MP4_WHOLE_H
#define TED4_MP4_WHOLE_H

/* Returns 1 if the file at path consists of boxes to its last byte, and those with pictures and
 * with the list of them are there; otherwise 0. What is in them is not looked at. */
int ted4_mp4_is_whole(const char *path);

#endif
