/* video_kind.c - see video_kind.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/video_kind.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "data/raw_scene.h"

enum { HEAD = 512 }; /* bytes that decide */

/* Bytes that files of a kind have at an offset. */
typedef struct {
    const char *demuxer;
    size_t at, n;
    const char *bytes;
} signature;

#define SIGNATURE(demuxer, at, text)       \
    {                                      \
        demuxer, at, sizeof text - 1, text \
    }

/* MPEG elementary streams begin with a sequence header, H.264 with a sequence parameter set (NAL
 * type 7), HEVC with a video parameter set (NAL type 32), each behind a start code. */
static const signature SIGNATURES[] = {
    SIGNATURE("mov", 4, "ftyp"),
    SIGNATURE("mov", 4, "styp"),
    SIGNATURE("mov", 4, "moov"),
    SIGNATURE("mov", 4, "mdat"),
    SIGNATURE("mov", 4, "wide"),
    SIGNATURE("mov", 4, "free"),
    SIGNATURE("mov", 4, "skip"),
    SIGNATURE("matroska", 0, "\x1a\x45\xdf\xa3"),
    SIGNATURE("avi", 8, "AVI "),
    SIGNATURE("mpeg", 0, "\0\0\1\xba"),
    SIGNATURE("mpegvideo", 0, "\0\0\1\xb3"),
    SIGNATURE("h264", 0, "\0\0\0\1\x67"),
    SIGNATURE("h264", 0, "\0\0\0\1\x27"),
    SIGNATURE("hevc", 0, "\0\0\0\1\x40\1"),
    SIGNATURE("yuv4mpegpipe", 0, "YUV4MPEG2 "),
    SIGNATURE("ogg", 0, "OggS"),
    SIGNATURE("flv", 0, "FLV\1"),
    SIGNATURE("asf", 0, "\x30\x26\xb2\x75\x8e\x66\xcf\x11"),
    SIGNATURE("ivf", 0, "DKIF"),
    SIGNATURE("gif", 0, "GIF8"),
};

/* Transport streams have the byte 0x47, a letter in texts, at the begin of each packet of 188
 * bytes, or 4 bytes later in packets of 192 bytes. */
static int is_transport_stream(const uint8_t *head, size_t n)
{
    enum { SYNC = 0x47, PACKET = 188, TIMED_PACKET = 192, TIME = 4 };

    return n > TIME + TIMED_PACKET && ((head[0] == SYNC && head[PACKET] == SYNC) ||
                                       (head[TIME] == SYNC && head[TIME + TIMED_PACKET] == SYNC));
}

static const char *find_signature(const uint8_t *head, size_t n)
{
    for (size_t i = 0; i < sizeof SIGNATURES / sizeof SIGNATURES[0]; i++) {
        const signature *s = &SIGNATURES[i];

        if (n >= s->at + s->n && memcmp(head + s->at, s->bytes, s->n) == 0)
            return s->demuxer;
    }
    return NULL;
}

static int is_text(const uint8_t *head, size_t n)
{
    size_t i = 0;

    while (i < n && (head[i] >= ' ' || head[i] == '\t' || head[i] == '\n' || head[i] == '\r'))
        i++;
    return i == n;
}

const char *ted4_video_demuxer(const char *video, ted4_message *m)
{
    uint8_t head[HEAD];
    FILE *f = fopen(video, "rb");

    if (f == NULL) {
        ted4_say(m, "%s: %s", video, strerror(errno));
        return NULL;
    }
    const size_t n = fread(head, 1, sizeof head, f);
    const char *demuxer = find_signature(head, n);
    const int text = demuxer == NULL && is_text(head, n);

    fclose(f);
    if (demuxer == NULL && !text && is_transport_stream(head, n))
        demuxer = "mpegts";
    if (text)
        ted4_say(m, "%s: %s, expected a video", video, n == 0 ? "empty" : "text (a playlist?)");
    else if (demuxer == NULL)
        ted4_say(m,
                 "%s: begins like no video that is known here, expected MP4, MOV, Matroska, WebM, "
                 "AVI, MPEG, H.264, HEVC, Y4M, Ogg, FLV, ASF, IVF or GIF",
                 video);
    return demuxer;
}
