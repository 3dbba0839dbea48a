/* render_views.c - ted4dec --render: the scene as each camera sees it, as pictures.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>

#include "actions.h"
#include "cli.h"
#include "output.h"
#include "render/png_file.h"
#include "render/view.h"

static int render_camera(ted4_session *s, ted4_viewer *viewer, const ted4_listed_camera *c,
                         uint32_t number)
{
    const ted4_time t = c->has_frame ? ted4_time_of_frame(c->frame, s->info.frames) : c->time;
    uint8_t *const rgb = malloc((size_t)c->view.width * (size_t)c->view.height * 3);
    char path[TED4_PATH_SIZE], why[256];
    int code = TED4_EXIT_FINE;
    ted4_status status = TED4_E_LIMIT_MEMORY;

    if (rgb != NULL)
        status = ted4_render_query(viewer, s->recon, &s->info, t.num, t.den, &c->view, &s->parallel,
                                   rgb);
    if (status != TED4_OK)
        code = ted4_session_failed(status, s);
    else if (ted4_pattern_make(path, s->set->render, number) != 0)
        code = ted4_session_refused(s->set->render, "name too long");
    else if (ted4_png_write(path, c->view.width, c->view.height, rgb, why, sizeof why) != 0)
        code = ted4_session_refused(path, why);
    else if (s->set->json)
        ted4_session_append(s->report, "views",
                            json_pack("{s:s, s:I, s:I}", "path", path, "num", (json_int_t)t.num,
                                      "den", (json_int_t)t.den));
    free(rgb);
    return code;
}

int ted4_action_render(ted4_session *s)
{
    ted4_viewer *const viewer = ted4_viewer_new();
    int code = viewer == NULL ? ted4_session_failed(TED4_E_LIMIT_MEMORY, s) : TED4_EXIT_FINE;

    for (size_t i = 0; i < s->cameras.n && code == TED4_EXIT_FINE; i++) {
        code = render_camera(s, viewer, &s->cameras.camera[i], (uint32_t)i);
        ted4_session_progress(s, "drawn", i + 1, s->cameras.n);
    }
    ted4_viewer_free(viewer);
    return code;
}
