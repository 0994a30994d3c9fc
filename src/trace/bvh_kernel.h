/* bvh_kernel.h - the walk in float vectors, compiled once for each instruction set.
 *
 * The including file defines the vectors, and a bvh_kernel of `closest` and `occluded`:
 *   v8, v8_load, v8_set1, v8_multiply_subtract, v8_min, v8_max, v8_store, v8_less_equal (8-bit
 * mask) v4, v4_load, v4_set1, v4_subtract, v4_multiply, v4_multiply_add (a b + c),
 *   v4_multiply_subtract (a b - c), v4_negative_multiply_add (c - a b), v4_min, v4_max, v4_negate,
 *   v4_less_equal (4-bit mask)
 * Multiplying and adding may round once or twice: nothing here decides.  Boxes and filter only pass
 * over what the decision would refuse (docs/exact-hits.md). */
#include "trace/bvh_decision.h"

static const float  least_step   = 0x1p-40F; /* of a direction against its largest component */
static const double range_low    = 0x1p-60;  /* M (m) and the direction's largest component;  */
static const double range_high   = 0x1p60;   /* outside is left to the double kernel          */
static const double slack        = 0x1p-22;  /* of distances rounded to float                 */
static const double filter_floor = 0x1p-140; /* products may vanish by this much, m2          */

/* The ray as the boxes see it: by tau = t scale, in the world's axes. */
typedef struct {
    _Alignas(16) float inverse[4];
    _Alignas(16) float near[4], far[4]; /* planes to tau: plane * inverse - near */
    size_t near_plane[3];               /* which of bvh_node.plane is met first  */
    float  tau_after;
    double scale;       /* the largest component of the direction, as a float      */
    double scale_above; /* the same, enlarged: (float)(t * scale_above) >= tau     */
} box_ray;

typedef struct {
    bvh_query query;
    box_ray   boxes;
    float     tau_best; /* not below that of the best hit */
} walk_state;

static inline v4 v4_of(const assay_vec3 *v)
{
    return v4_set((float)bvh_load_alone(&v->x), (float)bvh_load_alone(&v->y),
                  (float)bvh_load_alone(&v->z));
}

static inline void start_boxes(box_ray *r, const assay_bvh *bvh, const assay_ray *ray, double m)
{
    const v4       d       = v4_of(&ray->direction);
    const v4       size    = v4_absolute(d);
    const float    scale   = v4_largest_of_three(size);
    const v4       least   = v4_set1(scale * least_step);
    const v4       inverse = v4_copy_sign(v4_divide(v4_set1(scale), v4_max(size, least)), d);
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
    r->scale       = (double)scale;
    r->scale_above = (double)scale * (1.0 + slack);
}

/* False where the range of float does not suffice. */
static inline bool walk_start(walk_state *s, const assay_bvh *bvh, const assay_ray *ray)
{
    bvh_query_start(&s->query, bvh, ray);
    const bvh_shear *shear = &s->query.shear;
    const double     m     = shear->magnitude;
    if (!(m >= range_low && m <= range_high && shear->abs_dz >= range_low &&
          shear->abs_dz <= range_high && s->query.t_after >= 0.0)) {
        return false;
    }
    start_boxes(&s->boxes, bvh, ray, m);
    s->boxes.tau_after = (float)(s->query.t_after * s->boxes.scale * (1.0 - slack));
    s->tau_best        = (float)(s->query.best_t * s->boxes.scale_above);
    return true;
}

/* ---- leaves ---- */

/* Four corners in the ray's frame, as `sheared` of bvh_decision.c. */
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

static inline d4 combine(d4 u, d4 v, d4 w, d4 a, d4 b, d4 c)
{
    return d4_add(d4_add(d4_multiply(u, a), d4_multiply(v, b)), d4_multiply(w, c));
}

/* Lets one lane compete; true when it became the best so far. */
static inline bool try_lane(walk_state *s, const bvh_leaf *leaf, int lane, const double *t,
                            const double *v, const double *w, const double *det)
{
    bvh_query     *q        = &s->query;
    const uint32_t triangle = leaf->triangle[lane];
    if (!bvh_query_in_order(q, t[lane], triangle)) {
        return false;
    }
    q->best_t        = t[lane];
    q->best_triangle = triangle;
    q->v             = v[lane];
    q->w             = w[lane];
    q->det           = det[lane];
    return true;
}

/* The decision of bvh_decision.c for four triangles at once: the same operations in the same order,
 * so the same bits.  True when a triangle of the leaf became the best hit. */
static inline bool try_leaf(walk_state *s, const bvh_leaf *leaf)
{
    const bvh_shear *r = &s->query.shear;
    const corners    a = shear_corners(r, leaf->vertex[0][0]);
    const corners    b = shear_corners(r, leaf->vertex[1][0]);
    const corners    c = shear_corners(r, leaf->vertex[2][0]);
    const d4         u = edge(c, b), v = edge(a, c), w = edge(b, a);
    const d4         low  = d4_min(d4_min(u, v), w);
    const d4         high = d4_max(d4_max(u, v), w);
    const unsigned   enclosing = d4_or_mask(d4_greater_equal(low, d4_set1(0.0)), d4_greater_equal(d4_set1(0.0), high));
    if (!enclosing) {
        return false;
    }
    const d4 det = d4_add(d4_add(u, v), w);
    const d4 limit = d4_multiply(d4_set1(r->residual), d4_absolute(det));
    const d4 x = d4_absolute(combine(u, v, w, a.x, b.x, c.x));
    const d4 y = d4_absolute(combine(u, v, w, a.y, b.y, c.y));
    const d4 t = d4_multiply(d4_divide(combine(u, v, w, a.z, b.z, c.z), det), d4_set1(r->inverse_dz));
    const unsigned consistent = d4_and_mask(d4_greater(limit, x), d4_greater(limit, y));
    const unsigned range = d4_and_mask(d4_greater_equal(d4_set1(s->query.best_t), t), d4_greater_equal(t, d4_set1(s->query.t_after)));
    unsigned lanes = enclosing & (range | ~consistent);
    if (!lanes) {
        return false;
    }
    _Alignas(32) double ts[4], vs[4], ws[4], dets[4];
    d4_store(ts, t);
    d4_store(vs, v);
    d4_store(ws, w);
    d4_store(dets, det);
    bool found = false;
    do {
        const int lane = __builtin_ctz(lanes);
        if (__builtin_expect(consistent >> lane & 1, 1)) {
            found |= try_lane(s, leaf, lane, ts, vs, ws, dets);
        } else {
            found |= bvh_query_try(&s->query, &leaf->vertex[0][0][lane], 3 * BVH_LEAF_SIZE,
                                   BVH_LEAF_SIZE, leaf->triangle[lane]);
        }
        lanes &= lanes - 1;
    } while (lanes);
    if (found) {
        s->tau_best = (float)(s->query.best_t * s->boxes.scale_above);
    }
    return found;
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

/* Mask of the children that the ray may meet before tau_best, and where it enters each. */
static inline unsigned meet_children(const box_vectors *r, const bvh_node *node, v8 tau_best,
                                     float *entry)
{
    v8 near[3], far[3];
    for (int k = 0; k < 3; k++) {
        const size_t plane = r->near_plane[k];
        near[k] = v8_multiply_subtract(v8_load(node->plane[plane]), r->inverse[k], r->near[k]);
        far[k]  = v8_multiply_subtract(v8_load(node->plane[plane ^ 1]), r->inverse[k], r->far[k]);
    }
    const v8 enter = v8_max(v8_max(near[0], near[1]), v8_max(near[2], r->tau_after));
    const v8 leave = v8_min(v8_min(far[0], far[1]), v8_min(far[2], tau_best));
    v8_store(entry, enter);
    return v8_less_equal(enter, leave);
}

static inline void prefetch(const assay_bvh *bvh, uint32_t reference)
{
    const unsigned char *at = bvh->memory + (size_t)(reference & ~BVH_LEAF_BIT) * BVH_UNIT;
    __builtin_prefetch(at + 0);
}

/* A child still to visit: bits of its entry above, its reference below. */
static inline uint64_t stack_item(float entry, uint32_t reference)
{
    uint32_t bits;
    __builtin_memcpy(&bits, &entry, sizeof bits);
    return (uint64_t)bits << 32 | reference;
}

static inline float stack_entry(uint64_t item)
{
    const uint32_t bits = (uint32_t)(item >> 32);
    float          entry;
    __builtin_memcpy(&entry, &bits, sizeof entry);
    return entry;
}

static inline uint64_t take_child(const assay_bvh *bvh, const bvh_node *node, const float *entry, unsigned *mask)
{
    const int i = __builtin_ctz(*mask);
    *mask &= *mask - 1;
    prefetch(bvh, node->child[i]);
    return stack_item(entry[i], node->child[i]);
}

#define ORDER(x, y) do { const uint64_t big_ = x > y ? x : y; y = x > y ? y : x; x = big_; } while (0)

/* Pushes the children in `mask`, the nearest last; returns the new top. */
static inline uint64_t *push_children(const assay_bvh *bvh, uint64_t *top, const bvh_node *node, const float *entry,
                                      unsigned mask)
{
    uint64_t a = take_child(bvh, node, entry, &mask);
    uint64_t b = take_child(bvh, node, entry, &mask);
    uint64_t c = take_child(bvh, node, entry, &mask);
    if (!mask) {
        ORDER(a, b);
        ORDER(b, c);
        ORDER(a, b);
        top[0] = a;
        top[1] = b;
        top[2] = c;
        return top + 3;
    }
    uint64_t d = take_child(bvh, node, entry, &mask);
    ORDER(a, b);
    ORDER(c, d);
    ORDER(a, c);
    ORDER(b, d);
    ORDER(b, c);
    top[0] = a;
    top[1] = b;
    top[2] = c;
    top[3] = d;
    uint64_t *first = top;
    top += 4;
    while (mask) {
        const uint64_t item = take_child(bvh, node, entry, &mask);
        uint64_t      *at   = top++;
        for (; at > first && at[-1] < item; at--) {
            *at = at[-1];
        }
        *at = item;
    }
    return top;
}

static bool closest(const assay_bvh *bvh, const assay_ray *ray, assay_hit *hit_out)
{
    walk_state s;
    if (!walk_start(&s, bvh, ray)) {
        return bvh_kernel_double.closest(bvh, ray, hit_out);
    }
    const box_vectors boxes    = box_vectors_of(&s.boxes);
    v8                tau_best = v8_set1(s.tau_best);
    uint64_t          stack[BVH_MAX_STACK];
    uint64_t         *top       = stack;
    uint32_t          reference = bvh->root;
    for (;;) {
        if (!(reference & BVH_LEAF_BIT)) {
            const bvh_node    *node = bvh_node_at(bvh, reference);
            _Alignas(32) float entry[BVH_WIDTH];
            unsigned           mask = meet_children(&boxes, node, tau_best, entry);
            if (mask) {
                const int i = __builtin_ctz(mask);
                reference   = node->child[i];
                prefetch(bvh, reference);
                mask &= mask - 1;
                if (!mask) {
                    continue;
                }
                const int j = __builtin_ctz(mask);
                mask &= mask - 1;
                if (!mask) {
                    const uint32_t other = node->child[j];
                    prefetch(bvh, other);
                    if (entry[i] <= entry[j]) {
                        *top++ = stack_item(entry[j], other);
                    } else {
                        *top++    = stack_item(entry[i], reference);
                        reference = other;
                    }
                    continue;
                }
                mask |= 1U << i | 1U << j;
                top       = push_children(bvh, top, node, entry, mask);
                reference = (uint32_t) * --top;
                continue;
            }
        } else if (try_leaf(&s, bvh_leaf_at(bvh, reference))) {
            tau_best = v8_set1(s.tau_best);
        }
        uint64_t item;
        do {
            if (top == stack) {
                return bvh_query_finish(&s.query, hit_out);
            }
            item = *--top;
        } while (stack_entry(item) > s.tau_best);
        reference = (uint32_t)item;
    }
}

static bool occluded(const assay_bvh *bvh, const assay_ray *ray)
{
    walk_state s;
    if (!walk_start(&s, bvh, ray)) {
        return bvh_kernel_double.occluded(bvh, ray);
    }
    const box_vectors boxes    = box_vectors_of(&s.boxes);
    const v8          tau_best = v8_set1(s.tau_best);
    uint32_t          stack[BVH_MAX_STACK];
    uint32_t         *top = stack;
    *top++                = bvh->root;
    while (top > stack) {
        const uint32_t reference = *--top;
        if (reference & BVH_LEAF_BIT) {
            if (try_leaf(&s, bvh_leaf_at(bvh, reference))) {
                return true;
            }
            continue;
        }
        const bvh_node    *node = bvh_node_at(bvh, reference);
        _Alignas(32) float entry[BVH_WIDTH];
        unsigned           mask = meet_children(&boxes, node, tau_best, entry);
        for (; mask; mask &= mask - 1) {
            *top++ = node->child[__builtin_ctz(mask)];
            prefetch(bvh, top[-1]);
        }
    }
    return false;
}
