/* octree.c - see octree.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/octree.h"

#include "norm/adaptive.h"

/* The context of an occupancy bit: how many children its node's parent has (1, 2, more), and which
 * of the node's children are known to be occupied, behind a leading 1. Most nodes near the leaves
 * are alone in theirs, and have one child; what lies in the cells around them saves little
 * (bench/compact.md). */
enum { FAMILIES = 3, PATTERNS = 256 };

typedef struct {
    ted4_adaptive bit[FAMILIES][PATTERNS];
} model;

/* A node on the way from the root: the bits of its key, its children, and those not visited yet. */
typedef struct {
    uint64_t prefix;
    unsigned n_children, left;
} node;

/* Returns which children of the node with this prefix are occupied, bit i for child i. key: the
 * keys from the node's first one on; shift: bits of a key below a child's prefix. */
static unsigned children_of(const uint64_t *key, size_t n, uint64_t prefix, unsigned shift)
{
    unsigned children = 0;

    for (size_t i = 0; i < n && key[i] >> shift >> 3 == prefix; i++)
        children |= 1u << (key[i] >> shift & 7);
    return children;
}

/* Every node has a child: the last one is certain if all others are missing. */
static unsigned code_children(ted4_coder *c, ted4_adaptive *bit, unsigned children)
{
    unsigned known = 0;

    for (unsigned i = 0; i < 8; i++) {
        ted4_adaptive *const m = &bit[1u << i | known];
        int occupied = 1;

        if (i < 7 || known != 0) {
            occupied = c->ops->bit(c, m->p, (int)(children >> i & 1));
            ted4_adaptive_update(m, occupied);
        }
        known |= (unsigned)occupied << i;
    }
    return known;
}

static unsigned count_bits(unsigned x)
{
    unsigned n = 0;

    for (; x != 0; x &= x - 1)
        n++;
    return n;
}

static node enter(ted4_coder *c, model *m, uint64_t prefix, unsigned n_siblings, unsigned children)
{
    node t = { prefix, 0, 0 };

    t.left =
        code_children(c, m->bit[n_siblings < FAMILIES ? n_siblings - 1 : FAMILIES - 1], children);
    t.n_children = count_bits(t.left);
    return t;
}

int ted4_octree_walk(ted4_coder *c, unsigned depth, size_t n, uint64_t *key)
{
    const int writes = !c->reads;
    node way[TED4_OCTREE_DEPTH];
    size_t leaves = 0;
    unsigned below = depth; /* levels below the node's own: 1 .. depth; depth is the root */
    model m;

    ted4_adaptive_init(m.bit[0], FAMILIES * PATTERNS);
    way[0] = enter(c, &m, 0, 1, writes ? children_of(key, n, 0, 3 * (depth - 1)) : 0);
    while (c->error.code == TED4_OK) {
        node *const t = &way[depth - below];
        uint64_t prefix;

        if (t->left == 0) {
            if (below == depth)
                return leaves == n;
            below++;
            continue;
        }
        prefix = t->prefix << 3 | ted4_log2_floor(t->left & -t->left);
        t->left &= t->left - 1;
        if (below > 1) {
            const unsigned shift = 3 * (--below - 1);

            way[depth - below] =
                enter(c, &m, prefix, t->n_children,
                      writes ? children_of(key + leaves, n - leaves, prefix, shift) : 0);
        } else if (leaves == n) {
            return 0;
        } else {
            key[leaves++] = prefix;
        }
    }
    return 0;
}
