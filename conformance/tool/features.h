/* features.h - the parts of the format that a file uses, by name: what decoders may decline, and
 * what pairs are counted of.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_FEATURES_H
#define CONF_FEATURES_H

#include <jansson.h>
#include "norm/syntax.h"

/* "motion.bank", "tile.multi", ...: one name from each group that the file has; a new array. */
json_t *conf_features(const ted4_scene *s);

/* Groups of names of which any two from different groups can stand together in a file, except where
 * conf_feature_excludes says so. */
extern const char *const conf_feature_groups[][5];
extern const size_t conf_n_feature_groups;
int conf_feature_excludes(const char *a, const char *b);

#endif
