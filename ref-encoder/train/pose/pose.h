/* pose.h - refinement of the poses of training cameras: a small rigid motion for each pose, learnt
 * together with the scene and not stored in the file. A point x of normalised space that the given
 * camera sees at R x + t, in its own axes, is seen at exp(w) (R x + t) + u, where w is a rotation
 * vector and u a translation. Depends on data/dataset.h, train/model/normalise.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_POSE_H
#define TED4_POSE_H

#include <stddef.h>
#include <stdint.h>

#include "data/dataset.h"
#include "norm/syntax.h"

/* Values of one pose: w in radians, then u in units of normalised space. */
enum { TED4_POSE_VALUES = 6 };

/* Motions of the whole scene: three rotations, three translations and the scale. */
enum { TED4_POSE_GAUGES = 7 };

typedef float ted4_pose_motion[TED4_POSE_VALUES];

/* Whether poses are refined: for a trial at first, the second part of which has a prior; then until
 * the end of training or not at all. */
typedef enum {
    TED4_POSES_ON_TRIAL,
    TED4_POSES_WITH_PRIOR,
    TED4_POSES_REFINED,
    TED4_POSES_GIVEN
} ted4_poses_decision;

/* The scene and all cameras could move together without changing any picture, but novel views are
 * asked for in the given world. So what the motions of all poses have in common with the motions of
 * the whole scene, to first order about the given poses, is always zero. */
typedef struct {
    size_t n;          /* number of poses; 0: nothing is refined and no memory is held */
    uint32_t *of;      /* owned, [n_pictures] pose of each picture; n: a held-out picture */
    uint32_t *picture; /* owned, [n] the first picture of each pose */
    uint64_t *steps;   /* owned, [n] number of Adam steps */
    uint8_t *seen;     /* owned, [n] 1: gradient holds a gradient that was not applied yet */
    ted4_pose_motion *value, *m, *v, *gradient; /* owned, [n]; m, v: Adam's moments */
    /* Owned, [n_gauges][n][TED4_POSE_VALUES]: orthonormal basis of the motions of all poses that a
     * motion of the whole scene amounts to. Fewer than 7 if some of these are the same, as where
     * all cameras have one centre. */
    double *gauge;
    int n_gauges;
    double unit; /* length of one unit of normalised space in the world */
    /* The decision, and by how many pixels poses had moved when it was last looked at
     * (pose_step.h). */
    ted4_poses_decision decision;
    double moved;
} ted4_poses;

/* Begins with the given poses. A camera that stands still, that is, all training pictures of which
 * have the same pose, is one pose; otherwise each picture is. Nothing is refined if there are fewer
 * than two poses, because then any motion is one of the whole scene. Returns 0, or -1 if memory ran
 * out (ted4_poses_finish is safe even then). */
int ted4_poses_init(ted4_poses *p, const ted4_dataset *d, const ted4_header *h);
void ted4_poses_finish(ted4_poses *p);

/* Returns whether poses are being refined: on trial or for good. */
int ted4_poses_learnt(const ted4_poses *p);
/* Returns whether it is not decided yet. */
int ted4_poses_on_trial(const ted4_poses *p);
/* Returns to the given poses for good. */
void ted4_poses_put_back(ted4_poses *p);
/* Removes the motions of the whole scene from those of the poses. */
void ted4_poses_fix_gauge(ted4_poses *p);
/* Returns whether all motions are finite. */
int ted4_poses_finite(const ted4_poses *p);

/* Moves *c, the given camera of picture item, to its refined pose. It does not change if the
 * picture has none. */
void ted4_pose_move(const ted4_poses *p, size_t item, ted4_camera *c);

#endif
