/* features.c - see features.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "features.h"

#include <string.h>

const char *const conf_feature_groups[][5] = {
    { "motion.none", "motion.bank", "motion.concat", "motion.inr" },
    { "temporal-mask.off", "temporal-mask.on" },
    { "offset-mask.off", "offset-mask.on" },
    { "activation.off", "activation.on" },
    { "view.none", "view.colour", "view.full" },
    { "heads.linear", "heads.hidden" },
    { "scale.log2", "scale.linear" },
    { "prior.inr", "prior.factorised" },
    { "hyper.linear", "hyper.hidden" },
    { "pe.none", "pe.octaves" },
    { "slices.one", "slices.many" },
    { "tile.single", "tile.multi" },
    { "frames.one", "frames.many" },
    { "nete.raw", "nete.deflated", "nete.coded" },
    { "netr.raw", "netr.deflated", "netr.coded" },
    { "bank.none", "bank.raw", "bank.deflated", "bank.coded" },
};

const size_t conf_n_feature_groups = sizeof conf_feature_groups / sizeof *conf_feature_groups;

json_t *conf_features(const ted4_scene *s)
{
    const ted4_header *h = &s->head;
    const unsigned choice[] = { h->motion,
                                h->temporal_mask,
                                h->offset_mask,
                                h->activation,
                                h->view,
                                h->head_layers > 0,
                                h->scale_domain,
                                h->prior,
                                h->hyper_layers > 0,
                                h->pe_octaves > 0,
                                h->n_slices > 1,
                                s->shape.n_tiles > 1,
                                h->frames > 1,
                                s->nete.mode,
                                s->netr.mode,
                                s->bank.n == 0 ? 0 : 1u + s->bank.mode };
    json_t *o = json_array();

    for (size_t i = 0; i < conf_n_feature_groups; i++)
        json_array_append_new(o, json_string(conf_feature_groups[i][choice[i]]));
    return o;
}

static int both(const char *a, const char *b, const char *x, const char *y)
{
    return (strcmp(a, x) == 0 && strcmp(b, y) == 0) || (strcmp(a, y) == 0 && strcmp(b, x) == 0);
}

int conf_feature_excludes(const char *a, const char *b)
{
    static const char *const pair[][2] = {
        { "motion.none", "temporal-mask.on" }, { "motion.none", "bank.raw" },
        { "motion.none", "bank.deflated" },    { "motion.inr", "bank.raw" },
        { "motion.inr", "bank.deflated" },     { "motion.bank", "bank.none" },
        { "motion.concat", "bank.none" },      { "prior.factorised", "hyper.hidden" },
        { "prior.factorised", "pe.octaves" },  { "motion.none", "bank.coded" },
        { "motion.inr", "bank.coded" },
    };

    for (size_t i = 0; i < sizeof pair / sizeof *pair; i++)
        if (both(a, b, pair[i][0], pair[i][1]))
            return 1;
    return 0;
}
