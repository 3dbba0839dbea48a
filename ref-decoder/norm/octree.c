/* octree.c - see octree.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/octree.h"

#include "norm/adaptive.h"
#include "norm/half.h"

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

/* What is coded. n_leaves: how many positions the leaves so far have. */
typedef struct {
    ted4_coder *c;
    uint16_t *position; /* [n][3] */
    size_t n, n_leaves;
    unsigned depth;
    model m;
} tree;

uint64_t ted4_octree_key(const uint16_t *p, unsigned depth)
{
    return ted4_spread3(ted4_grid_place(p[0], depth)) << 2 |
           ted4_spread3(ted4_grid_place(p[1], depth)) << 1 |
           ted4_spread3(ted4_grid_place(p[2], depth));
}

/* Codes the next leaf. Returns 0 if there is no room for it, or if the writer's positions are not
 * on the grid or not in order. */
static int put_leaf(tree *t, uint64_t key)
{
    uint16_t *p = t->position + 3 * t->n_leaves;

    if (t->n_leaves == t->n || (!t->c->reads && ted4_octree_key(p, t->depth) != key))
        return 0;
    t->n_leaves++;
    for (unsigned j = 0; t->c->reads && j < 3; j++)
        p[j] = ted4_grid_half(ted4_gather3(key >> (2 - j)), t->depth);
    return 1;
}

/* Returns which children of the node with this prefix are occupied, bit i for child i, by the
 * positions from the first that has no leaf yet on. shift: bits of a key below a child's prefix. */
static unsigned children_of(const tree *t, uint64_t prefix, unsigned shift)
{
    unsigned children = 0;

    for (size_t i = t->n_leaves; i < t->n; i++) {
        const uint64_t key = ted4_octree_key(t->position + 3 * i, t->depth);

        if (key >> shift >> 3 != prefix)
            break;
        children |= 1u << (key >> shift & 7);
    }
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

/* Codes the children of a node at this many levels above the leaves, 1 .. depth. */
static node enter(tree *t, uint64_t prefix, unsigned n_siblings, unsigned below)
{
    ted4_adaptive *const bit = t->m.bit[n_siblings < FAMILIES ? n_siblings - 1 : FAMILIES - 1];
    node way = { prefix, 0, 0 };

    way.left = code_children(t->c, bit, t->c->reads ? 0 : children_of(t, prefix, 3 * (below - 1)));
    way.n_children = count_bits(way.left);
    return way;
}

int ted4_octree_walk(ted4_coder *c, unsigned depth, size_t n, uint16_t *position)
{
    node way[TED4_OCTREE_DEPTH];
    unsigned below = depth; /* of the node whose children are visited */
    tree t = { .c = c, .position = position, .n = n, .depth = depth };

    ted4_adaptive_init(t.m.bit[0], FAMILIES * PATTERNS);
    way[0] = enter(&t, 0, 1, depth);
    while (c->error.code == TED4_OK) {
        node *const from = &way[depth - below];
        uint64_t prefix;

        if (from->left == 0) {
            if (below == depth)
                return t.n_leaves == n;
            below++;
            continue;
        }
        prefix = from->prefix << 3 | ted4_log2_floor(from->left & -from->left);
        from->left &= from->left - 1;
        if (below > 1) {
            below--;
            way[depth - below] = enter(&t, prefix, from->n_children, below);
        } else if (!put_leaf(&t, prefix)) {
            return 0;
        }
    }
    return 0;
}
