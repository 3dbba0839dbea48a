/* features.h - names for the parts of the format that a file uses. Decoders may decline features,
 * and coverage counts pairs of them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_FEATURES_H
#define CONF_FEATURES_H

#include <jansson.h>
#include "norm/syntax.h"

/* Returns a new array with one name from each group that the file has: "motion.bank", "tile.multi",
 * ... */
json_t *conf_features(const ted4_scene *s);

/* Groups of names. Any two names from different groups can occur together in a file, unless
 * conf_feature_excludes excludes the pair. */
extern const char *const conf_feature_groups[][5];
extern const size_t conf_n_feature_groups;
int conf_feature_excludes(const char *a, const char *b);

#endif
