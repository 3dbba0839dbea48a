/* ray_truth.c - see ray_truth.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_truth.h"

#include <string.h>

int ted4_ray_has_truth(const ted4_ray_options *o)
{
    static const ted4_ray_ways usual;

    return o->scene > RAY_FAIR || o->hold > 0 || o->pose_error > 0 || o->tint > 0 || o->drift > 0 ||
           memcmp(&o->ways, &usual, sizeof usual) != 0;
}

static void put_matrix(FILE *f, const char *name, const ted4_ray_camera *c)
{
    fprintf(f, "      \"%s\": [", name);
    for (int r = 0; r < 4; r++)
        fprintf(f, "%s[%.17g, %.17g, %.17g, %.17g]", r > 0 ? ", " : "", c->matrix[r][0],
                c->matrix[r][1], c->matrix[r][2], c->matrix[r][3]);
    fputs("],\n", f);
}

static void put_camera(FILE *f, const ted4_ray_options *o, int number)
{
    const int test = number >= o->n_train;
    ted4_ray_options exact = *o;
    ted4_ray_camera c;

    exact.pose_error = 0;
    ted4_ray_camera_stated(&exact, number, &c);
    fprintf(f, "    {\n      \"split\": \"%s\",\n      \"number\": %d,\n", test ? "test" : "train",
            test ? number - o->n_train : number);
    put_matrix(f, "true", &c);
    ted4_ray_camera_stated(o, number, &c);
    put_matrix(f, "stated", &c);
    fputs("      \"colour\": [", f);
    for (int r = 0; r < 3; r++)
        fprintf(f, "%s[%.9g, %.9g, %.9g]", r > 0 ? ", " : "", (double)c.colour[3 * r],
                (double)c.colour[3 * r + 1], (double)c.colour[3 * r + 2]);
    fputs("],\n      \"exposure\": [", f);
    for (int j = 0; j < o->n_frames; j++)
        fprintf(f, "%s%.9g", j > 0 ? ", " : "", ted4_ray_exposure(o, number, j));
    fputs("]\n    }", f);
}

static void put_times(FILE *f, const ted4_ray_options *o)
{
    ted4_ray_world plain, w;
    int n = 0;

    fputs("  \"held_times\": [", f);
    for (int j = 0; j < o->n_frames; j++) {
        if (ted4_ray_is_held(o, j))
            fprintf(f, "%s%d", n++ > 0 ? ", " : "", j);
    }
    ted4_ray_world_empty(&plain, o->seed);
    fputs("],\n  \"lamp\": [", f);
    for (int j = 0; j < o->n_frames; j++) {
        ted4_ray_world_at(&w, o->scene, o->seed, j, o->n_frames);
        fprintf(f, "%s%.9g", j > 0 ? ", " : "", (double)(w.lamp_power / plain.lamp_power));
    }
    fputs("],\n  \"solids\": [", f);
    for (int j = 0; j < o->n_frames; j++) {
        ted4_ray_world_at(&w, o->scene, o->seed, j, o->n_frames);
        fprintf(f, "%s%d", j > 0 ? ", " : "", w.n);
    }
    fputs("],\n", f);
}

void ted4_ray_put_truth(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    const ted4_ray_plan *const plan = ted4_ray_plan_of(o->scene);

    (void)number, (void)frame;
    fprintf(
        f,
        "{\n  \"scene\": \"%s\",\n  \"shows\": \"%s\",\n  \"seed\": %u,\n  \"size\": [%d, %d],\n",
        plan->name, plan->shows, (unsigned)o->seed, o->width, o->height);
    fprintf(f, "  \"train_cameras\": %d,\n  \"test_cameras\": %d,\n  \"frames\": %d,\n", o->n_train,
            o->n_test, o->n_frames);
    fprintf(f, "  \"pose_error\": %.9g,\n  \"tint\": %.9g,\n  \"drift\": %.9g,\n", o->pose_error,
            o->tint, o->drift);
    fprintf(f, "  \"world\": {\"scale\": %.17g, \"shift\": [%.17g, %.17g, %.17g]%s},\n",
            ted4_ray_scale(o), plan->shift[0], plan->shift[1], plan->shift[2],
            o->ways.up_y ? ", \"up\": \"y\"" : "");
    fputs("  \"turned_away\": [", f);
    if (ted4_ray_is_blind(o, o->n_train - 1))
        fprintf(f, "%d", o->n_train - 1);
    fputs("],\n", f);
    put_times(f, o);
    fputs("  \"cameras\": [\n", f);
    for (int i = 0; i < o->n_train + o->n_test; i++) {
        fputs(i > 0 ? ",\n" : "", f);
        put_camera(f, o, i);
    }
    fputs("\n  ]\n}\n", f);
}
