/* ray_rig.c - see ray_rig.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_rig.h"

#include <string.h>

/* For tint 1, before the mean is subtracted, in linear light: the exposure changes by at most this
 * share, up or down, and by at least half of it; gains of the channels; share of light that leaks
 * into another channel. */
static const double exposure = 0.4, gain = 0.12, leak = 0.03;

/* Seeds for the random values of a camera. */
enum { SEED_TURN = 301, SEED_MOVE = 302, SEED_TINT = 303, SEED_TIME = 304 };

static double draw(const ted4_ray_options *o, int number, int which, uint32_t seed)
{
    return (double)ray_random(number, which, 0, o->seed + seed);
}

/* ---- times ---- */

/* Returns 1 if the test cameras are the training cameras again. */
static int is_same(const ted4_ray_options *o)
{
    return ted4_ray_plan_of(o->scene)->same && ted4_ray_has_lists(o->layout);
}

/* Returns the number of the camera that stands where this one does. */
static int stands_as(const ted4_ray_options *o, int number)
{
    return is_same(o) && number >= o->n_train ? (number - o->n_train) % o->n_train : number;
}

int ted4_ray_has_lists(ted4_ray_layout l)
{
    return l == RAY_BLENDER || l == RAY_NERFSTUDIO || l == RAY_HYPERNERF;
}

int ted4_ray_is_held(const ted4_ray_options *o, int frame)
{
    return o->hold > 0 && ted4_ray_has_lists(o->layout) && frame % o->hold == o->hold / 2 &&
           frame < o->n_frames - 1;
}

/* Returns the rank of x among 0 .. n - 1 in the order of their hashes. */
static int shuffled(int x, int n, uint32_t seed)
{
    const uint32_t mine = ray_hash(x, 0, 0, seed);
    int before = 0;

    for (int i = 0; i < n; i++) {
        const uint32_t other = ray_hash(i, 0, 0, seed);
        before += other < mine || (other == mine && i < x);
    }
    return before;
}

int ted4_ray_start(const ted4_ray_options *o, int number)
{
    static const int late[4] = { 0, 3, 1, 4 };

    return o->ways.starts && o->n_frames > 8 ? late[number % 4] : 0;
}

/* Returns the place, from 0, of test camera k in a round of all cameras. */
static int test_place(const ted4_ray_options *o, int k)
{
    return (2 * k + 1) * (o->n_train + o->n_test) / (2 * o->n_test);
}

/* Returns the place, from 0, of a camera in a round of all cameras: the test cameras are spread
 * over the round, and the training cameras fill the other places in order. */
static int place_in_round(const ted4_ray_options *o, int number)
{
    int place = number;

    if (number >= o->n_train)
        return test_place(o, number - o->n_train);
    for (int k = 0; k < o->n_test; k++)
        place += test_place(o, k) <= place;
    return place;
}

int ted4_ray_is_taken(const ted4_ray_options *o, int number, int frame)
{
    if (number >= o->n_train && o->ways.split == RAY_TRAIN_ONLY)
        return 0;
    if (o->ways.turns)
        return shuffled(number, o->n_train + o->n_test, o->seed + SEED_TIME) == frame;
    if (ted4_ray_plan_of(o->scene)->rounds && ted4_ray_has_lists(o->layout))
        return frame % (o->n_train + o->n_test) == place_in_round(o, number) &&
               (number >= o->n_train || !ted4_ray_is_held(o, frame));
    if (number < o->n_train)
        return !ted4_ray_is_held(o, frame) && frame >= ted4_ray_start(o, number);
    if (o->ways.split == RAY_OTHER_TIMES || is_same(o))
        return ted4_ray_is_held(o, frame);
    return frame >= ted4_ray_start(o, number);
}

int ted4_ray_is_missing(const ted4_ray_options *o, int number, int frame)
{
    const int mine = number * o->n_frames + frame;
    const uint32_t hash = ray_hash(mine, 1, 0, o->seed);
    int before = 0;

    if (o->ways.missing == 0 || number >= o->n_train || !ted4_ray_is_taken(o, number, frame))
        return 0;
    for (int i = 0; i < o->n_train * o->n_frames && before < o->ways.missing; i++) {
        const uint32_t other = ray_hash(i, 1, 0, o->seed);
        before += (other < hash || (other == hash && i < mine)) &&
                  ted4_ray_is_taken(o, i / o->n_frames, i % o->n_frames);
    }
    return before < o->ways.missing;
}

/* ---- worlds ---- */

ted4_ray_background ted4_ray_around(const ted4_ray_options *o)
{
    if (o->ways.background == RAY_USUAL)
        return ted4_ray_plan_of(o->scene)->background;
    return (ted4_ray_background)o->ways.background;
}

void ted4_ray_world_of(const ted4_ray_options *o, int frame, ted4_ray_world *w)
{
    ted4_ray_world_at(w, o->scene, o->seed, frame, o->n_frames);
    if (ted4_ray_around(o) > RAY_ROOM)
        w->room = RAY_DARK;
}

/* ---- colours ---- */

/* Signs of exposures: + - - + in turn, so that they do not correlate with the heights of the
 * cameras. */
static double sign_of(int number)
{
    return (number + number / 2) % 2 == 0 ? 1 : -1;
}

static void raw_tint(const ted4_ray_options *o, int number, double A[9])
{
    const double e = 1 + o->tint * exposure * sign_of(number) *
                             (0.5 + 0.5 * draw(o, number, 9, SEED_TINT));

    for (int i = 0; i < 9; i++) {
        const double r = 2 * draw(o, number, i, SEED_TINT) - 1;
        A[i] = e * (i % 4 == 0 ? 1 + o->tint * gain * r : o->tint * leak * r);
    }
}

/* The mean of the training cameras' matrices is the unit matrix, so that test cameras, which have
 * no tint, and the initial points show the scene's colours. */
static void tint(const ted4_ray_options *o, int number, float colour[9])
{
    double A[9], B[9], mean[9] = { 0 };

    if (o->tint == 0 || number >= o->n_train)
        return;
    raw_tint(o, number, A);
    for (int k = 0; k < o->n_train && o->n_train > 1; k++) {
        raw_tint(o, k, B);
        for (int i = 0; i < 9; i++)
            mean[i] += (B[i] - (i % 4 == 0 ? 1 : 0)) / o->n_train;
    }
    for (int i = 0; i < 9; i++)
        colour[i] = (float)(A[i] - mean[i]);
}

double ted4_ray_exposure(const ted4_ray_options *o, int number, int frame)
{
    const double half = ted4_ray_cos(ted4_ray_time(frame, o->n_frames) / 2) / 2;
    double sign = sign_of(stands_as(o, number));

    if (o->drift == 0 || stands_as(o, number) >= o->n_train)
        return 1;
    for (int k = 0; k < o->n_train && o->n_train > 1; k++)
        sign -= sign_of(k) / o->n_train;
    return ted4_ray_exp2(o->drift * sign * half);
}

void ted4_ray_expose(const ted4_ray_options *o, int number, int frame, ted4_ray_camera *c)
{
    const double e = ted4_ray_exposure(o, number, frame);

    for (int i = 0; i < 9 && e != 1; i++)
        c->colour[i] = (float)(e * (double)c->colour[i]);
}

/* ---- poses ---- */

/* Returns the number of places on the arc. The training cameras take the places from *first on. */
static int arc_of(const ted4_ray_options *o, int *first)
{
    const int places = ted4_ray_plan_of(o->scene)->places;

    *first = places > o->n_train ? (places - o->n_train) / 2 : 0;
    return places > o->n_train ? places : o->n_train;
}

int ted4_ray_is_blind(const ted4_ray_options *o, int number)
{
    return ted4_ray_plan_of(o->scene)->turned_away && number == o->n_train - 1 && number > 0;
}

/* Turns a camera by half a turn about its own up axis. */
static void turn_away(ted4_ray_camera *c)
{
    for (int i = 0; i < 3; i++) {
        c->matrix[i][0] = -c->matrix[i][0];
        c->matrix[i][2] = -c->matrix[i][2];
    }
}

/* Sets the size of the pictures and the principal point. */
static void lens(const ted4_ray_options *o, int number, ted4_ray_camera *c)
{
    static const int quarters[3] = { 4, 3, 5 };
    const int q = o->ways.sizes ? quarters[number % 3] : 4, width = (c->width * q + 2) / 4;

    c->focal *= (double)width / c->width;
    c->width = width;
    c->height = (c->height * q + 2) / 4;
    c->cx = (0.5 + o->ways.off[0]) * c->width;
    c->cy = (0.5 + o->ways.off[1]) * c->height;
}

void ted4_ray_camera_of(const ted4_ray_options *o, int number, ted4_ray_camera *c)
{
    int first;
    const int places = arc_of(o, &first);

    number = stands_as(o, number);
    if (ted4_ray_plan_of(o->scene)->dome && ted4_ray_around(o) != RAY_ROOM)
        ted4_ray_camera_dome(c, number, o->n_train + o->n_test, o->width, o->height);
    else if (number >= o->n_train)
        ted4_ray_camera_test(c, number - o->n_train, o->n_test, places, o->width, o->height);
    else
        ted4_ray_camera_train(c, first + number, places, o->width, o->height);
    if (ted4_ray_is_blind(o, number))
        turn_away(c);
    lens(o, number, c);
    tint(o, number, c->colour);
}

/* Draws a vector of length r in a random direction, uniform over the sphere. */
static void random_vector(const ted4_ray_options *o, int number, uint32_t seed, double r,
                          double v[3])
{
    const double z = 2 * draw(o, number, 0, seed) - 1, side = sqrt(1 - z * z);
    const double turns = draw(o, number, 1, seed);

    v[0] = r * side * ted4_ray_cos(turns);
    v[1] = r * side * ted4_ray_sin(turns);
    v[2] = r * z;
}

static void centred(const ted4_ray_options *o, int number, uint32_t seed, double r, double v[3])
{
    double other[3];

    random_vector(o, number, seed, r, v);
    for (int k = 0; k < o->n_train && o->n_train > 1; k++) {
        random_vector(o, k, seed, r, other);
        for (int i = 0; i < 3; i++)
            v[i] -= other[i] / o->n_train;
    }
}

void ted4_ray_pose_error(const ted4_ray_options *o, int number, double turn[3], double move[3])
{
    const double angle = o->pose_error * RAY_PI / 180;

    centred(o, number, SEED_TURN, angle, turn);
    centred(o, number, SEED_MOVE, angle * ted4_ray_radius, move);
}

/* Rotates v by the rotation vector, in world axes (Rodrigues). */
static void rotate(const double turn[3], double v[3])
{
    const double angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);

    if (angle == 0)
        return;
    const double c = ted4_ray_cos(angle / (2 * RAY_PI)), s = ted4_ray_sin(angle / (2 * RAY_PI));
    const double k[3] = { turn[0] / angle, turn[1] / angle, turn[2] / angle };
    const double along = (k[0] * v[0] + k[1] * v[1] + k[2] * v[2]) * (1 - c);
    const double cross[3] = { k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2],
                              k[0] * v[1] - k[1] * v[0] };
    for (int i = 0; i < 3; i++)
        v[i] = c * v[i] + s * cross[i] + along * k[i];
}

double ted4_ray_scale(const ted4_ray_options *o)
{
    return ted4_ray_plan_of(o->scene)->scale * (o->ways.unit > 0 ? o->ways.unit : 1);
}

/* Rotates by a quarter turn about x if y is up in the files. */
static void upright(const ted4_ray_options *o, double v[3])
{
    const double z = v[2];

    if (!o->ways.up_y)
        return;
    v[2] = -v[1];
    v[1] = z;
}

void ted4_ray_mapped(const ted4_ray_options *o, const double room[3], double file[3])
{
    const ted4_ray_plan *const plan = ted4_ray_plan_of(o->scene);

    for (int i = 0; i < 3; i++)
        file[i] = ted4_ray_scale(o) * room[i] + plan->shift[i];
    upright(o, file);
}

void ted4_ray_camera_stated(const ted4_ray_options *o, int number, ted4_ray_camera *c)
{
    double turn[3] = { 0, 0, 0 }, move[3] = { 0, 0, 0 }, centre[3];

    ted4_ray_camera_of(o, number, c);
    if (o->pose_error > 0 && number < o->n_train)
        ted4_ray_pose_error(o, number, turn, move);
    for (int i = 0; i < 3; i++)
        move[i] += c->matrix[i][3];
    ted4_ray_mapped(o, move, centre);
    for (int j = 0; j < 3; j++) {
        double axis[3] = { c->matrix[0][j], c->matrix[1][j], c->matrix[2][j] };
        rotate(turn, axis);
        upright(o, axis);
        for (int i = 0; i < 3; i++)
            c->matrix[i][j] = axis[i];
    }
    for (int i = 0; i < 3; i++)
        c->matrix[i][3] = centre[i];
}

vec3 ted4_ray_point_stated(const ted4_ray_options *o, int number, vec3 p)
{
    const double point[3] = { (double)p.x, (double)p.y, (double)p.z };
    double q[3];
    ted4_ray_camera is, stated;

    ted4_ray_camera_of(o, number, &is);
    ted4_ray_camera_stated(o, number, &stated);
    if (memcmp(is.matrix, stated.matrix, sizeof is.matrix) == 0)
        return p;
    for (int i = 0; i < 3; i++)
        q[i] = stated.matrix[i][3];
    for (int j = 0; j < 3; j++) {
        double along = 0;
        for (int k = 0; k < 3; k++)
            along += is.matrix[k][j] * (point[k] - is.matrix[k][3]);
        for (int i = 0; i < 3; i++)
            q[i] += ted4_ray_scale(o) * along * stated.matrix[i][j];
    }
    return v3((float)q[0], (float)q[1], (float)q[2]);
}
