/* ray_scene.c - the table of scenes. The scenes of the lab are small, so that a training takes a
 * minute on one core. The last scene is for the zoo (bench/zoo.txt).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_scene.h"

/* Pictures, cameras and times of the first scenes, and of the lab. With hold = 8, times 4 and 12
 * are held out. */
#define FIRST .width = 160, .height = 120, .n_train = 12, .n_test = 2, .n_frames = 16, .scale = 1
#define SMALL .width = 96, .height = 64
#define LAB   SMALL, .n_train = 6, .n_test = 2, .n_frames = 16

static const ted4_ray_plan plans[RAY_SCENES] = {
    [RAY_STILL] = { "still", "nothing moves", FIRST },
    [RAY_TURN] = { "turn", "a carousel turns", FIRST },
    [RAY_OCCLUDER] = { "occluder",
                       "a ball rolls behind a small wall, out on the other side, and back", FIRST },
    [RAY_POP] = { "pop", "things come and go", FIRST },
    [RAY_BEND] = { "bend", "a bar bends and twists", FIRST },
    [RAY_FAIR] = { "fair", "a carousel turns, things come and go", FIRST },

    /* Where a thing rolls by more than its radius per time, no time is held out: the scene "fast"
     * tests such motion. */
    [RAY_HIDE] = { "hide", "a ball is hidden from every camera for a third of the time", LAB,
                   .scale = 1 },
    [RAY_BLINK] = { "blink", "things pop in and out, one of them three times", LAB, .hold = 8,
                    .scale = 1 },
    [RAY_FAST] = { "fast", "things move by up to twice their size a time", LAB, .hold = 8,
                   .scale = 1 },
    [RAY_SPLIT] = { "split", "a block parts in two, two balls become one", LAB, .hold = 8,
                    .scale = 1 },
    [RAY_TINTS] = { "tints", "turn, cameras disagree in colour and exposure", LAB, .hold = 8,
                    .tint = 1, .scale = 1 },
    /* The lamp's power at a time does not follow from that at other times, so no time is held out.
     */
    [RAY_FLICKER] = { "flicker", "the lamp flickers", LAB, .scale = 1 },
    [RAY_BARE] = { "bare", "turn, walls without texture", LAB, .hold = 8, .scale = 1 },
    [RAY_FAR] = { "far", "turn, 1,000 units from the origin", LAB, .hold = 8, .scale = 1,
                  .shift = { 576, -768, 280 } },
    [RAY_WIDE] = { "wide", "turn, in a room 1,000 units wide", LAB, .hold = 8,
                   .scale = 1000 / 5.4 },
    [RAY_PAIR] = { "pair", "turn, two cameras only", SMALL, .n_train = 2, .n_test = 1,
                   .n_frames = 16, .hold = 8, .places = 6, .scale = 1 },
    [RAY_LONG] = { "long", "600 times", .width = 64, .height = 48, .n_train = 3, .n_test = 1,
                   .n_frames = 600, .hold = 8, .scale = 1 },
    [RAY_WIRES] = { "wires", "a cage of wires thinner than a pixel turns", LAB, .hold = 8,
                    .scale = 1 },
    [RAY_SHAKEN] = { "shaken", "turn, cameras with small errors of pose", LAB, .hold = 8,
                     .pose_error = 0.4, .scale = 1 },
    [RAY_CHANGE] = { "change", "what is there first is gone in the end, and the other way round",
                     LAB, .hold = 8, .scale = 1 },
    [RAY_EMPTY] = { "empty", "turn, on a stage in the dark; one camera sees only the dark", LAB,
                    .hold = 8, .turned_away = 1, .scale = 1 },
    [RAY_MOMENT] = { "moment", "turn, one time only", SMALL, .n_train = 8, .n_test = 2,
                     .n_frames = 1, .scale = 1 },
    [RAY_ALONE] = { "alone", "turn, one camera only", SMALL, .n_train = 1, .n_test = 1,
                    .n_frames = 24, .hold = 8, .scale = 1 },
    [RAY_EDGE] = { "edge", "things pop in and out at the upper edge of all pictures", LAB,
                   .hold = 8, .scale = 1 },

    [RAY_DUSK] = { "dusk", "turn, exposures drift by half a stop", LAB, .hold = 8, .drift = 0.5,
                   .scale = 1 },
    [RAY_TINTS4] = { "tints4",
                     "turn, four cameras disagree in colour, and held-out times are theirs", SMALL,
                     .n_train = 4, .n_test = 4, .n_frames = 16, .hold = 8, .tint = 1, .same = 1,
                     .scale = 1 },

    [RAY_THINGS0] = { "things0", "eight things, none moves", LAB, .hold = 8, .scale = 1 },
    [RAY_THINGS1] = { "things1", "eight things, one moves", LAB, .hold = 8, .scale = 1 },
    [RAY_THINGS2] = { "things2", "eight things, two move", LAB, .hold = 8, .scale = 1 },
    [RAY_THINGS4] = { "things4", "eight things, four move", LAB, .hold = 8, .scale = 1 },
    [RAY_THINGS8] = { "things8", "eight things, all move", LAB, .hold = 8, .scale = 1 },
    [RAY_REST] = { "rest", "things4, then as long a rest", SMALL, .n_train = 6, .n_test = 2,
                   .n_frames = 32, .hold = 8, .scale = 1 },

    [RAY_TOYS] = { "toys", "small things on a disk, a ball goes round, droplets fall", SMALL,
                   .n_train = 10, .n_test = 2, .n_frames = 16, .background = RAY_CLEAR, .dome = 1,
                   .scale = 1 },
    /* With 117 times the training cameras take 84 pictures. */
    [RAY_RELAY] = { "relay", "a ball, a swinging block and drops, before cameras that take turns",
                    SMALL, .n_train = 5, .n_test = 2, .n_frames = 117, .rounds = 1,
                    .background = RAY_WHITE, .scale = 1 },
};

const ted4_ray_plan *ted4_ray_plan_of(ted4_ray_scene s)
{
    return &plans[s];
}

const char *ted4_ray_scene_name(ted4_ray_scene s)
{
    return plans[s].name;
}
