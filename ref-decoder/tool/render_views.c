/* render_views.c - ted4dec --render: the scene as each camera sees it, as pictures or a video.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "actions.h"
#include "cli.h"
#include "json_string.h"
#include "output.h"
#include "picture_out.h"
#include "render/view.h"
#include "video_out.h"

/* Frames per second of a video of a scene that has no rate. */
enum { STILL_RATE = 30 };

/* Writes picture number of --render. video: NULL if each is a file of its own. */
static int write_picture(const ted4_session *s, const ted4_view *v, const uint8_t *rgb,
                         uint32_t number, ted4_video_out *video, char path[TED4_PATH_SIZE])
{
    char why[256];

    if (ted4_pattern_make(path, s->set->render, number) != 0)
        return ted4_session_refused(s->set->render, "name too long");
    if (video != NULL)
        return ted4_video_out_write(video, rgb) == 0 ? TED4_EXIT_FINE : TED4_EXIT_TOOL;
    return ted4_picture_write(path, v->width, v->height, rgb, why, sizeof why) == 0
               ? TED4_EXIT_FINE
               : ted4_session_refused(path, why);
}

static int render_camera(ted4_session *s, ted4_viewer *viewer, const ted4_listed_camera *c,
                         uint32_t number, ted4_video_out *video)
{
    const ted4_time t = c->has_frame ? ted4_time_of_frame(c->frame, s->info.frames) : c->time;
    uint8_t *const rgb = malloc((size_t)c->view.width * (size_t)c->view.height * 3);
    char path[TED4_PATH_SIZE];
    int code = TED4_EXIT_FINE;
    ted4_status status = TED4_E_LIMIT_MEMORY;

    if (rgb != NULL)
        status = ted4_render_query(viewer, s->recon, &s->info, t.num, t.den, &c->view, &s->parallel,
                                   rgb);
    if (status != TED4_OK)
        code = ted4_session_failed(status, s);
    else
        code = write_picture(s, &c->view, rgb, number, video, path);
    if (code == TED4_EXIT_FINE && s->set->json)
        ted4_session_append(s->report, "views",
                            json_pack("{s:o, s:I, s:I}", "path", ted4_json_string(path), "num",
                                      (json_int_t)t.num, "den", (json_int_t)t.den));
    free(rgb);
    return code;
}

static int render_all(ted4_session *s, ted4_viewer *viewer, ted4_video_out *video)
{
    int code = TED4_EXIT_FINE;

    for (size_t i = 0; i < s->cameras.n && code == TED4_EXIT_FINE; i++) {
        code = render_camera(s, viewer, &s->cameras.camera[i], (uint32_t)i, video);
        ted4_session_progress(s, "drawn", i + 1, s->cameras.n);
    }
    return code;
}

static int render_video(ted4_session *s, ted4_viewer *viewer)
{
    const ted4_view *const first = &s->cameras.camera[0].view;
    const int moves = s->info.frames > 1;
    ted4_video_out video;
    char why[256];

    for (size_t i = 1; i < s->cameras.n; i++)
        if (s->cameras.camera[i].view.width != first->width ||
            s->cameras.camera[i].view.height != first->height)
            return ted4_session_refused(s->set->render, "the cameras differ in size");
    signal(SIGPIPE, SIG_IGN); /* an ffmpeg that ends early is told of by its exit status */
    if (ted4_video_out_open(&video, s->set->render, first->width, first->height,
                            moves ? s->info.rate_num : STILL_RATE, moves ? s->info.rate_den : 1,
                            why, sizeof why) != 0)
        return ted4_session_refused(s->set->render, why);
    const int code = render_all(s, viewer, &video);

    if (ted4_video_out_close(&video, code == TED4_EXIT_FINE, why, sizeof why) != 0)
        return ted4_session_refused(s->set->render, why);
    return code;
}

int ted4_action_render(ted4_session *s)
{
    ted4_viewer *const viewer = ted4_viewer_new();
    int code;

    if (viewer == NULL)
        code = ted4_session_failed(TED4_E_LIMIT_MEMORY, s);
    else if (ted4_has_suffix(s->set->render, TED4_VIDEO_SUFFIX))
        code = render_video(s, viewer);
    else
        code = render_all(s, viewer, NULL);
    ted4_viewer_free(viewer);
    return code;
}
