/* bvh_kernel.h - the walk in vectors, compiled once for each instruction set.
 *
 * The including file defines the vectors and, from closest() and occluded() below, a bvh_kernel:
 *   v8, eight floats: v8_load, v8_set1, v8_multiply_subtract (a b - c), v8_min, v8_max, v8_store,
 *       v8_less_equal (bit i: a[i] <= b[i])
 *   v4, four floats:  v4_set (x, y, z, 1), v4_set1, v4_store, v4_add, v4_subtract, v4_multiply,
 *       v4_divide, v4_max, v4_absolute, v4_copy_sign (of a number >= 0), v4_signs (bits),
 *       v4_largest_of_three
 *   d4, four doubles: d4_load (from floats), d4_store, d4_set1, d4_add, d4_subtract, d4_multiply,
 *       d4_divide, d4_min, d4_max, d4_absolute, d4_greater_equal, d4_greater (all ones where true),
 *       d4_and_bits, d4_or_bits (bit i: of a[i] and b[i], a[i] or b[i])
 * Floats only pass over what cannot be hit (docs/exact-hits.md); they may round once or twice in a
 * b - c.  Doubles decide: their products must be rounded before they are added. */
#include "trace/bvh_decision.h"

static const float  least_step = 0x1p-40F; /* of a direction against its largest component     */
static const double range_low  = 0x1p-60;  /* M (m) and the direction's largest component;     */
static const double range_high = 0x1p60;   /* what lies outside is left to the double kernel   */
static const double slack      = 0x1p-22;  /* of distances rounded to float                    */

/* The ray as the boxes see it: by tau = t scale, in the world's axes. */
typedef struct {
    _Alignas(16) float inverse[4];      /* scale / direction                            */
    _Alignas(16) float near[4], far[4]; /* where a plane is met: plane * inverse - near */
    size_t near_plane[3];               /* which of bvh_node.plane is met first         */
    double scale;                       /* the direction's largest component, a float   */
    float  tau_after, tau_best;         /* not above that of t_after, not below best_t's */
} box_ray;

typedef struct {
    bvh_query query;
    box_ray   boxes;
} walk_state;

static inline v4 v4_of(const assay_vec3 *v)
{
    return v4_set((float)bvh_load_alone(&v->x), (float)bvh_load_alone(&v->y),
                  (float)bvh_load_alone(&v->z));
}

static inline void set_tau_best(walk_state *s)
{
    s->boxes.tau_best = (float)(s->query.best_t * (s->boxes.scale * (1.0 + slack)));
}

/* False where the range of float does not suffice. */
static inline bool walk_start(walk_state *s, const assay_bvh *bvh, const assay_ray *ray)
{
    bvh_query_start(&s->query, bvh, ray);
    const double m = s->query.shear.magnitude, size = s->query.shear.abs_dz;
    if (!(m >= range_low && m <= range_high && size >= range_low && size <= range_high &&
          s->query.t_after >= 0.0)) {
        return false;
    }
    box_ray       *r       = &s->boxes;
    const v4       d       = v4_of(&ray->direction);
    const float    scale   = v4_largest_of_three(v4_absolute(d));
    const v4       step    = v4_max(v4_absolute(d), v4_set1(scale * least_step));
    const v4       inverse = v4_copy_sign(v4_divide(v4_set1(scale), step), d);
    const v4       origin  = v4_multiply(v4_of(&ray->origin), inverse);
    const float    margin  = (float)(bvh->tuning.box_margin * m);
    const v4       widen   = v4_multiply(v4_set1(margin), v4_absolute(inverse));
    const unsigned signs   = v4_signs(d);
    v4_store(r->inverse, inverse);
    v4_store(r->near, v4_add(origin, widen));
    v4_store(r->far, v4_subtract(origin, widen));
    for (unsigned k = 0; k < 3; k++) {
        r->near_plane[k] = 2 * k + (signs >> k & 1);
    }
    r->scale     = (double)scale;
    r->tau_after = (float)(s->query.t_after * (r->scale * (1.0 - slack)));
    set_tau_best(s);
    return true;
}

/* ---- leaves ---- */

/* Four corners in the ray's frame. */
typedef struct {
    d4 x, y, z;
} corners;

static inline corners shear_corners(const bvh_shear *r, const float *corner)
{
    const d4 x = d4_subtract(d4_load(corner + r->axis[0] * BVH_LEAF_SIZE), d4_set1(r->o[0]));
    const d4 y = d4_subtract(d4_load(corner + r->axis[1] * BVH_LEAF_SIZE), d4_set1(r->o[1]));
    const d4 z = d4_subtract(d4_load(corner + r->axis[2] * BVH_LEAF_SIZE), d4_set1(r->o[2]));
    return (corners){d4_subtract(x, d4_multiply(d4_set1(r->sx), z)),
                     d4_subtract(y, d4_multiply(d4_set1(r->sy), z)), z};
}

static inline d4 edge(corners p, corners q)
{
    return d4_subtract(d4_multiply(p.x, q.y), d4_multiply(p.y, q.x));
}

/* Edge functions of four triangles, and what follows from them. */
typedef struct {
    d4 u, v, w, det, t;
} crossings;

static inline d4 combine(const crossings *e, d4 a, d4 b, d4 c)
{
    return d4_add(d4_add(d4_multiply(e->u, a), d4_multiply(e->v, b)), d4_multiply(e->w, c));
}

/* Lets the lanes compete one by one; those that are not consistent are refined. */
static inline bool try_lanes(bvh_query *q, const bvh_leaf *leaf, const crossings *e, unsigned lanes,
                             unsigned consistent)
{
    _Alignas(32) double t[4], v[4], w[4], det[4];
    d4_store(t, e->t);
    d4_store(v, e->v);
    d4_store(w, e->w);
    d4_store(det, e->det);
    bool found = false;
    for (; lanes; lanes &= lanes - 1) {
        const int      i        = __builtin_ctz(lanes);
        const uint32_t triangle = leaf->triangle[i];
        if (__builtin_expect(!(consistent >> i & 1), 0)) {
            found |= bvh_query_try(q, &leaf->vertex[0][0][i], 3 * BVH_LEAF_SIZE, BVH_LEAF_SIZE,
                                   triangle);
        } else if (bvh_query_in_order(q, t[i], triangle)) {
            bvh_query_take(q, t[i], triangle, v[i], w[i], det[i]);
            found = true;
        }
    }
    return found;
}

/* The decision of bvh_decision.c for four triangles at once, by the same operations in the same
 * order.  True when a triangle of the leaf became the best hit; with `any`, when one could. */
static inline __attribute__((always_inline)) bool decide_leaf(walk_state *s, const bvh_leaf *leaf,
                                                              const bool any)
{
    bvh_query       *q    = &s->query;
    const bvh_shear *r    = &q->shear;
    const corners    a    = shear_corners(r, leaf->vertex[0][0]);
    const corners    b    = shear_corners(r, leaf->vertex[1][0]);
    const corners    c    = shear_corners(r, leaf->vertex[2][0]);
    crossings        e    = {.u = edge(c, b), .v = edge(a, c), .w = edge(b, a)};
    const d4         zero = d4_set1(0.0);
    const d4         low = d4_min(d4_min(e.u, e.v), e.w), high = d4_max(d4_max(e.u, e.v), e.w);
    const unsigned   enclosing =
        d4_or_bits(d4_greater_equal(low, zero), d4_greater_equal(zero, high));
    if (!enclosing) {
        return false;
    }
    e.det = d4_add(d4_add(e.u, e.v), e.w);
    e.t   = d4_multiply(d4_divide(combine(&e, a.z, b.z, c.z), e.det), d4_set1(r->inverse_dz));
    const d4 limit = d4_multiply(d4_set1(r->residual), d4_absolute(e.det));
    const d4 x     = d4_absolute(combine(&e, a.x, b.x, c.x));
    const d4 y     = d4_absolute(combine(&e, a.y, b.y, c.y));

    const unsigned consistent = d4_and_bits(d4_greater(limit, x), d4_greater(limit, y));
    const unsigned in_range   = d4_and_bits(d4_greater_equal(d4_set1(q->best_t), e.t),
                                            d4_greater_equal(e.t, d4_set1(q->t_after)));
    const unsigned lanes      = enclosing & (in_range | ~consistent);
    const unsigned inside =
        d4_and_bits(d4_greater(d4_set1(q->best_t), e.t), d4_greater(e.t, d4_set1(q->t_after)));
    if (any && (lanes & consistent & inside)) {
        return true;
    }
    if (!lanes || !try_lanes(q, leaf, &e, lanes, consistent)) {
        return false;
    }
    set_tau_best(s);
    return true;
}

/* For the closest hit, out of line: in line it would take the walk's registers. */
static __attribute__((noinline)) bool try_leaf(walk_state *s, const bvh_leaf *leaf)
{
    return decide_leaf(s, leaf, false);
}

/* ---- nodes ---- */

/* The constants of box_ray, one vector each, to live in registers. */
typedef struct {
    v8     inverse[3], near[3], far[3], tau_after;
    size_t near_plane[3];
} box_vectors;

static inline box_vectors box_vectors_of(const box_ray *r)
{
    box_vectors v;
    for (int k = 0; k < 3; k++) {
        v.inverse[k]    = v8_set1(r->inverse[k]);
        v.near[k]       = v8_set1(r->near[k]);
        v.far[k]        = v8_set1(r->far[k]);
        v.near_plane[k] = r->near_plane[k];
    }
    v.tau_after = v8_set1(r->tau_after);
    return v;
}

/* Mask of the children that the ray may meet up to tau_best, and where it enters each. */
static inline unsigned meet_children(const box_vectors *r, const bvh_node *node, v8 tau_best,
                                     v8 *enter_out)
{
    v8 near[3], far[3];
    for (int k = 0; k < 3; k++) {
        const size_t plane = r->near_plane[k];
        near[k] = v8_multiply_subtract(v8_load(node->plane[plane]), r->inverse[k], r->near[k]);
        far[k]  = v8_multiply_subtract(v8_load(node->plane[plane ^ 1]), r->inverse[k], r->far[k]);
    }
    const v8 enter = v8_max(v8_max(near[0], near[1]), v8_max(near[2], r->tau_after));
    const v8 leave = v8_min(v8_min(far[0], far[1]), v8_min(far[2], tau_best));
    *enter_out     = enter;
    return v8_less_equal(enter, leave);
}

/* ---- the stack ---- */

/* A child still to visit: the bits of its entry (a float >= 0) above, its reference below, so that
 * integers order items by entry. */
static inline uint64_t item_of(float entry, uint32_t reference)
{
    uint32_t bits;
    __builtin_memcpy(&bits, &entry, sizeof bits);
    return (uint64_t)bits << 32 | reference;
}

static inline float item_entry(uint64_t item)
{
    const uint32_t bits = (uint32_t)(item >> 32);
    float          entry;
    __builtin_memcpy(&entry, &bits, sizeof entry);
    return entry;
}

static inline void prefetch(const assay_bvh *bvh, uint32_t reference)
{
    __builtin_prefetch(bvh->memory + (size_t)(reference & ~BVH_LEAF_BIT) * BVH_UNIT);
}

/* The item of the lowest child in the mask, which is taken out of it. */
static inline uint64_t take_child(const assay_bvh *bvh, const bvh_node *node, const float *entry,
                                  unsigned *mask)
{
    const int i = __builtin_ctz(*mask);
    *mask &= *mask - 1;
    prefetch(bvh, node->child[i]);
    return item_of(entry[i], node->child[i]);
}

/* The farther first; without a branch, since nobody can foresee it. */
static inline void order(uint64_t *x, uint64_t *y)
{
    const uint64_t near = *x < *y ? *x : *y;
    *x                  = *x < *y ? *y : *x;
    *y                  = near;
}

/* Sorts three or more children, of which two are taken already, onto the stack. */
static inline uint64_t *push_many(const assay_bvh *bvh, uint64_t *top, const bvh_node *node,
                                  const float *entry, unsigned mask, uint64_t a, uint64_t b)
{
    uint64_t *first = top;
    uint64_t  c     = take_child(bvh, node, entry, &mask);
    if (!mask) {
        order(&a, &b);
        order(&b, &c);
        order(&a, &b);
        top[0] = a;
        top[1] = b;
        top[2] = c;
        return top + 3;
    }
    uint64_t d = take_child(bvh, node, entry, &mask);
    order(&a, &b);
    order(&c, &d);
    order(&a, &c);
    order(&b, &d);
    order(&b, &c);
    top[0] = a;
    top[1] = b;
    top[2] = c;
    top[3] = d;
    for (top += 4; mask; top++) {
        const uint64_t item = take_child(bvh, node, entry, &mask);
        uint64_t      *at   = top;
        for (; at > first && at[-1] < item; at--) {
            *at = at[-1];
        }
        *at = item;
    }
    return top;
}

/* The nearest child in the mask (not empty); the others go onto the stack, nearer ones above. */
static inline uint32_t descend(const assay_bvh *bvh, uint64_t **top, const bvh_node *node,
                               const float *entry, unsigned mask)
{
    const uint64_t a = take_child(bvh, node, entry, &mask);
    if (!mask) {
        return (uint32_t)a;
    }
    const uint64_t b = take_child(bvh, node, entry, &mask);
    if (!mask) {
        /* A real branch: it lets the nearer child be fetched before the entries are known. */
        if (a < b) {
            *(*top)++ = b;
            return (uint32_t)a;
        }
        *(*top)++ = a;
        return (uint32_t)b;
    }
    *top                   = push_many(bvh, *top, node, entry, mask, a, b) - 1;
    const uint64_t nearest = **top;
    return (uint32_t)nearest;
}

static bool closest(const assay_bvh *bvh, const assay_ray *ray, assay_hit *hit_out)
{
    walk_state s;
    if (!walk_start(&s, bvh, ray)) {
        return bvh_kernel_double.closest(bvh, ray, hit_out);
    }
    const box_vectors boxes    = box_vectors_of(&s.boxes);
    v8                tau_best = v8_set1(s.boxes.tau_best);
    uint64_t          stack[BVH_MAX_STACK];
    uint64_t         *top       = stack;
    uint32_t          reference = bvh->root;
    for (;;) {
        if (!(reference & BVH_LEAF_BIT)) {
            const bvh_node *node = bvh_node_at(bvh, reference);
            v8              enter;
            const unsigned  mask = meet_children(&boxes, node, tau_best, &enter);
            if (mask) {
                _Alignas(32) float entry[BVH_WIDTH];
                v8_store(entry, enter);
                reference = descend(bvh, &top, node, entry, mask);
                continue;
            }
        } else if (try_leaf(&s, bvh_leaf_at(bvh, reference))) {
            tau_best = v8_set1(s.boxes.tau_best);
        }
        do {
            if (top == stack) {
                return bvh_query_finish(&s.query, hit_out);
            }
            top--;
        } while (item_entry(*top) > s.boxes.tau_best);
        reference = (uint32_t)*top;
    }
}

static bool occluded(const assay_bvh *bvh, const assay_ray *ray)
{
    walk_state s;
    if (!walk_start(&s, bvh, ray)) {
        return bvh_kernel_double.occluded(bvh, ray);
    }
    const box_vectors boxes    = box_vectors_of(&s.boxes);
    const v8          tau_best = v8_set1(s.boxes.tau_best);
    uint32_t          stack[BVH_MAX_STACK];
    uint32_t         *top       = stack;
    uint32_t          reference = bvh->root;
    for (;;) {
        if (!(reference & BVH_LEAF_BIT)) {
            const bvh_node *node = bvh_node_at(bvh, reference);
            v8              enter;
            unsigned        mask = meet_children(&boxes, node, tau_best, &enter);
            if (mask) {
                reference = node->child[__builtin_ctz(mask)];
                for (mask &= mask - 1; mask; mask &= mask - 1) {
                    *top++ = node->child[__builtin_ctz(mask)];
                    prefetch(bvh, top[-1]);
                }
                continue;
            }
        } else if (decide_leaf(&s, bvh_leaf_at(bvh, reference), true)) {
            return true;
        }
        if (top == stack) {
            return false;
        }
        reference = *--top;
    }
}
