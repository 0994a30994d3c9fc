/* tangent_space.c - MikkTSpace's rules: what belongs together, and its mean [mikkelsen08].
 *
 * A corner is one of a triangle's three; corner 3 t + i stands for the edge to its next corner,
 * too. Corners of equal position, normal and texture coordinates are one vertex, whatever the
 * file's indices say.  Around a vertex, triangles belong together that share an edge there, with
 * opposite directions, and whose images are both upright or both mirrored.  Together they have one
 * tangent: the mean of theirs, each made a unit vector in the plane of the normal first and
 * weighted by the angle of its corner, as seen in that plane.
 *
 * Invariant: sets of corners are joined under their least corner and everything is summed in the
 * order of corners, so the result is a function of the primitive alone.  Another order of triangles
 * changes rounding, but sets only where an edge has more than two triangles, or where a triangle
 * without an image lies between an upright and a mirrored one. */
#include "scene/tangent_space.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "scene/key_table.h"

/* What the image on a triangle is like. */
enum {
    MIRRORED = -1,
    BLANK    = 0, /* texture coordinates without area: goes with any neighbour         */
    UPRIGHT  = 1,
    POINT    = 2 /* two corners at one place: no edges to share, no angle, no tangent */
};

/* ---- triangles ---- */

/* Equal numbers have equal bits: -0 becomes 0. */
static void float_bits(const float *values, int count, uint32_t *bits_out)
{
    for (int i = 0; i < count; i++) {
        const float value = values[i] + 0.0F;
        memcpy(&bits_out[i], &value, sizeof value);
    }
}

typedef struct {
    const assay_primitive   *primitive;
    const assay_texture_ref *ref;
    const float             *uv;
    uint32_t                 corners, triangles;
    uint32_t                *vertex; /* a corner: the welded vertex                             */
    uint32_t                *across; /* a corner: that of the neighbour which starts the same
                                        edge, the other way; ASSAY_NONE without                 */
    uint32_t   *set;                 /* a corner: one nearer to the least of its set            */
    int8_t     *image;               /* a triangle                                              */
    assay_vec3 *sum;                 /* the least corner of a set: the weighted sum of tangents */
    float      *result;              /* a corner: 4                                             */
} tangent_work;

static uint32_t next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

static assay_vec3 load3(const float *values, uint32_t index)
{
    const float *v = values + (size_t)index * 3;
    return vec3(v[0], v[1], v[2]);
}

static assay_vec3 position_at(const tangent_work *w, uint32_t corner)
{
    return load3(w->primitive->positions, w->primitive->indices[corner]);
}

/* Unit, or zero; of a flat primitive that of the triangle. */
static assay_vec3 normal_at(const tangent_work *w, uint32_t corner)
{
    if (w->primitive->normals) {
        return vec3_normalize(load3(w->primitive->normals, w->primitive->indices[corner]));
    }
    const uint32_t   first = corner - corner % 3;
    const assay_vec3 p     = position_at(w, first);
    return vec3_normalize(
        vec3_cross(vec3_sub(position_at(w, first + 1), p), vec3_sub(position_at(w, first + 2), p)));
}

static assay_vec3 in_plane(assay_vec3 v, assay_vec3 normal)
{
    return vec3_normalize(vec3_mad(v, -vec3_dot(v, normal), normal));
}

static bool same_place(const tangent_work *w, uint32_t a, uint32_t b)
{
    const assay_vec3 d = vec3_sub(position_at(w, a), position_at(w, b));
    return d.x == 0.0 && d.y == 0.0 && d.z == 0.0;
}

/* Direction of growing u on a triangle, of any length, and what its image is like. */
static int look_at_image(const tangent_work *w, uint32_t triangle, assay_vec3 *direction_out)
{
    const uint32_t first = 3 * triangle;
    double         s[3], t[3];
    *direction_out = vec3(0.0, 0.0, 0.0);
    if (same_place(w, first, first + 1) || same_place(w, first + 1, first + 2) ||
        same_place(w, first + 2, first)) {
        return POINT;
    }
    for (uint32_t i = 0; i < 3; i++) {
        const float *p = w->uv + (size_t)w->primitive->indices[first + i] * 2;
        s[i]           = w->ref->uv_matrix[0][0] * p[0] + w->ref->uv_matrix[0][1] * p[1];
        t[i]           = w->ref->uv_matrix[1][0] * p[0] + w->ref->uv_matrix[1][1] * p[1];
    }
    const double     s1 = s[1] - s[0], s2 = s[2] - s[0], t1 = t[1] - t[0], t2 = t[2] - t[0];
    const double     area = s1 * t2 - s2 * t1;
    const assay_vec3 p    = position_at(w, first);
    const assay_vec3 e1   = vec3_sub(position_at(w, first + 1), p);
    const assay_vec3 e2   = vec3_sub(position_at(w, first + 2), p);
    if (!isfinite(area) || area == 0.0) {
        return BLANK;
    }
    *direction_out =
        vec3_scale(vec3_sub(vec3_scale(e1, t2), vec3_scale(e2, t1)), area < 0.0 ? -1.0 : 1.0);
    /* v runs down: an upright image has its coordinates clockwise. */
    return area < 0.0 ? UPRIGHT : MIRRORED;
}

/* ---- what belongs together ---- */

static bool weld(assay_context *context, tangent_work *w)
{
    assay_key_table table;
    const bool      open = assay_key_table_open(context, &table, 8, w->corners);
    for (uint32_t c = 0; open && c < w->corners; c++) {
        const uint32_t v = w->primitive->indices[c];
        uint32_t       key[8];
        float          normal[3];
        if (w->primitive->normals) {
            memcpy(normal, w->primitive->normals + (size_t)v * 3, sizeof normal);
        } else {
            const assay_vec3 n = normal_at(w, c);
            normal[0]          = (float)n.x;
            normal[1]          = (float)n.y;
            normal[2]          = (float)n.z;
        }
        float_bits(w->primitive->positions + (size_t)v * 3, 3, key);
        float_bits(normal, 3, key + 3);
        float_bits(w->uv + (size_t)v * 2, 2, key + 6);
        w->vertex[c] = assay_key_table_number(&table, key);
    }
    assay_key_table_close(context, &table);
    return open;
}

/* Pairs edges that run between the same vertices in opposite directions, the first with the first.
 * waiting: the first edge of a direction that has no partner yet, each with the next behind it. */
static bool find_neighbours(assay_context *context, tangent_work *w)
{
    assay_key_table table;
    uint32_t       *waiting = assay_allocate(context, 2 * (size_t)w->corners, sizeof *waiting);
    uint32_t       *behind  = assay_allocate(context, w->corners, sizeof *behind);
    const bool      open =
        assay_key_table_open(context, &table, 2, 2 * (size_t)w->corners) && waiting && behind;
    for (size_t i = 0; open && i < 2 * (size_t)w->corners; i++) {
        waiting[i] = ASSAY_NONE;
    }
    for (uint32_t c = w->corners; open && c-- > 0;) {
        const uint32_t edge[2] = {w->vertex[c], w->vertex[next(c)]};
        w->across[c]           = ASSAY_NONE;
        if (w->image[c / 3] != POINT) {
            const uint32_t number = assay_key_table_number(&table, edge);
            behind[c]             = waiting[number];
            waiting[number]       = c;
        }
    }
    for (uint32_t c = 0; open && c < w->corners; c++) {
        const uint32_t edge[2] = {w->vertex[next(c)], w->vertex[c]};
        if (w->image[c / 3] == POINT || w->across[c] != ASSAY_NONE) {
            continue;
        }
        uint32_t *first = &waiting[assay_key_table_number(&table, edge)];
        while (*first != ASSAY_NONE && w->across[*first] != ASSAY_NONE) {
            *first = behind[*first];
        }
        if (*first != ASSAY_NONE) {
            w->across[c]      = *first;
            w->across[*first] = c;
        }
    }
    assay_release(context, waiting);
    assay_release(context, behind);
    assay_key_table_close(context, &table);
    return open;
}

/* Blank triangles become like the neighbour through which they are reached first. */
static bool fill_blanks(assay_context *context, tangent_work *w)
{
    uint32_t *queue = assay_allocate(context, w->triangles, sizeof *queue);
    uint32_t  end   = 0;
    for (uint32_t t = 0; queue && t < w->triangles; t++) {
        if (w->image[t] == UPRIGHT || w->image[t] == MIRRORED) {
            queue[end++] = t;
        }
    }
    for (uint32_t at = 0; at < end; at++) {
        for (uint32_t i = 0; i < 3; i++) {
            const uint32_t other = w->across[3 * queue[at] + i];
            if (other != ASSAY_NONE && w->image[other / 3] == BLANK) {
                w->image[other / 3] = w->image[queue[at]];
                queue[end++]        = other / 3;
            }
        }
    }
    assay_release(context, queue);
    return queue != NULL;
}

static uint32_t least_of(uint32_t *set, uint32_t corner)
{
    while (set[corner] != corner) {
        set[corner] = set[set[corner]];
        corner      = set[corner];
    }
    return corner;
}

static void join(uint32_t *set, uint32_t a, uint32_t b)
{
    a = least_of(set, a);
    b = least_of(set, b);
    if (a < b) {
        set[b] = a;
    } else {
        set[a] = b;
    }
}

static void join_corners(tangent_work *w)
{
    for (uint32_t c = 0; c < w->corners; c++) {
        w->set[c] = c;
    }
    for (uint32_t c = 0; c < w->corners; c++) {
        const uint32_t other = w->across[c];
        if (other != ASSAY_NONE && w->image[c / 3] == w->image[other / 3]) {
            join(w->set, c, next(other));
            join(w->set, next(c), other);
        }
    }
}

/* ---- their tangents ---- */

static void add_tangents(tangent_work *w)
{
    for (uint32_t c = 0; c < w->corners; c++) {
        assay_vec3 direction;
        const int  image = look_at_image(w, c / 3, &direction);
        if (image == POINT || image == BLANK) {
            continue;
        }
        const assay_vec3 n      = normal_at(w, c);
        const assay_vec3 p      = position_at(w, c);
        const assay_vec3 e1     = in_plane(vec3_sub(position_at(w, next(c)), p), n);
        const assay_vec3 e2     = in_plane(vec3_sub(position_at(w, next(next(c))), p), n);
        const double     cosine = vec3_dot(e1, e2);
        const double     angle  = assay_acos(cosine < -1.0 ? -1.0 : cosine > 1.0 ? 1.0 : cosine);
        assay_vec3      *sum    = &w->sum[least_of(w->set, c)];
        *sum                    = vec3_mad(*sum, angle, in_plane(direction, n));
    }
}

/* Corners that belong to nothing take what another corner of their vertex has. */
static bool finish(assay_context *context, tangent_work *w)
{
    uint32_t *giver = assay_allocate(context, w->corners, sizeof *giver); /* a vertex: corner + 1 */
    for (uint32_t c = 0; giver && c < w->corners; c++) {
        const assay_vec3 t  = vec3_normalize(w->sum[least_of(w->set, c)]);
        float           *to = w->result + (size_t)c * 4;
        to[0]               = (float)t.x;
        to[1]               = (float)t.y;
        to[2]               = (float)t.z;
        to[3]               = w->image[c / 3] == MIRRORED ? -1.0F : 1.0F;
        const bool found    = to[0] != 0.0F || to[1] != 0.0F || to[2] != 0.0F;
        if (found && giver[w->vertex[c]] == 0) {
            giver[w->vertex[c]] = c + 1;
        }
    }
    for (uint32_t c = 0; giver && c < w->corners; c++) {
        const uint32_t from = giver[w->vertex[c]];
        if (from && (w->image[c / 3] == POINT || w->image[c / 3] == BLANK)) {
            memcpy(w->result + (size_t)c * 4, w->result + (size_t)(from - 1) * 4,
                   4 * sizeof(float));
        }
    }
    assay_release(context, giver);
    return giver != NULL;
}

/* ---- back to vertices ---- */

/* A longer copy of an array with rows of this many bytes: row count + i is row source[i]. */
static bool extend(assay_context *context, void **array, size_t row, size_t count,
                   const uint32_t *source, size_t extra)
{
    if (!*array || row == 0) {
        return true;
    }
    unsigned char *longer = assay_allocate(context, count + extra, row);
    if (!longer) {
        return false;
    }
    memcpy(longer, *array, count * row);
    for (size_t i = 0; i < extra; i++) {
        memcpy(longer + (count + i) * row, longer + source[i] * row, row);
    }
    assay_release(context, *array);
    *array = longer;
    return true;
}

/* Until vertex_count says so, the new rows are not there, so this may stop anywhere. */
static bool extend_all(assay_context *context, assay_primitive *p, const uint32_t *source,
                       size_t extra)
{
    struct {
        void **array;
        size_t row;
    } const arrays[]  = {{(void **)&p->positions, 12},
                         {(void **)&p->normals, 12},
                         {(void **)&p->uv[0], 8},
                         {(void **)&p->uv[1], 8},
                         {(void **)&p->colors, 16},
                         {(void **)&p->joints, (size_t)p->joint_sets * 8},
                         {(void **)&p->weights, (size_t)p->joint_sets * 16}};
    const size_t n    = p->vertex_count;
    bool         done = true;
    for (size_t i = 0; done && i < sizeof arrays / sizeof arrays[0]; i++) {
        done = extend(context, arrays[i].array, arrays[i].row, n, source, extra);
    }
    for (uint32_t i = 0; done && i < p->target_count; i++) {
        assay_morph_target *t = &p->targets[i];
        done                  = extend(context, (void **)&t->positions, 12, n, source, extra) &&
               extend(context, (void **)&t->normals, 12, n, source, extra) &&
               extend(context, (void **)&t->tangents, 12, n, source, extra);
    }
    return done;
}

typedef struct {
    uint32_t *index;  /* a corner: its vertex now              */
    uint32_t *source; /* a new vertex: the one that it doubles */
    uint32_t  extra;
} vertex_split;

/* The first tangent of a vertex stays with it; each other one asks for a double. */
static bool split_vertices(assay_context *context, const tangent_work *w, vertex_split *split)
{
    assay_key_table table;
    uint32_t       *vertex_of = assay_allocate(context, w->corners, sizeof *vertex_of);
    uint8_t        *taken     = assay_allocate(context, w->primitive->vertex_count, sizeof *taken);
    const bool open = assay_key_table_open(context, &table, 5, w->corners) && vertex_of && taken;
    for (uint32_t c = 0; open && c < w->corners; c++) {
        const uint32_t v      = w->primitive->indices[c];
        uint32_t       key[5] = {v};
        float_bits(w->result + (size_t)c * 4, 4, key + 1);
        const uint32_t known  = table.count;
        const uint32_t number = assay_key_table_number(&table, key);
        if (number == known && taken[v]) {
            split->source[split->extra] = v;
            vertex_of[number]           = w->primitive->vertex_count + split->extra++;
        } else if (number == known) {
            vertex_of[number] = v;
            taken[v]          = 1;
        }
        split->index[c] = vertex_of[number];
    }
    assay_key_table_close(context, &table);
    assay_release(context, vertex_of);
    assay_release(context, taken);
    return open;
}

static bool store(assay_context *context, assay_primitive *p, const tangent_work *w)
{
    vertex_split split = {
        .index  = assay_allocate(context, w->corners, sizeof *split.index),
        .source = assay_allocate(context, w->corners, sizeof *split.source),
    };
    bool   done     = split.index && split.source && split_vertices(context, w, &split);
    float *tangents = NULL;
    if (done) {
        tangents =
            assay_allocate(context, (size_t)p->vertex_count + split.extra, 4 * sizeof(float));
        done = tangents && (!split.extra || extend_all(context, p, split.source, split.extra));
    }
    if (done) {
        for (uint32_t c = 0; c < w->corners; c++) {
            p->indices[c] = split.index[c];
            memcpy(tangents + (size_t)split.index[c] * 4, w->result + (size_t)c * 4,
                   4 * sizeof(float));
        }
        p->vertex_count += split.extra;
        p->tangents = tangents;
    } else {
        assay_release(context, tangents);
    }
    assay_release(context, split.index);
    assay_release(context, split.source);
    return done;
}

static bool run(assay_context *context, assay_primitive *p, tangent_work *w)
{
    if (!w->vertex || !w->across || !w->set || !w->image || !w->sum || !w->result ||
        !weld(context, w)) {
        return false;
    }
    for (uint32_t t = 0; t < w->triangles; t++) {
        assay_vec3 direction;
        w->image[t] = (int8_t)look_at_image(w, t, &direction);
    }
    if (!find_neighbours(context, w) || !fill_blanks(context, w)) {
        return false;
    }
    join_corners(w);
    add_tangents(w);
    return finish(context, w) && store(context, p, w);
}

assay_status assay_primitive_make_tangents(assay_context *context, assay_primitive *primitive,
                                           const assay_texture_ref *ref)
{
    const float *uv = primitive->uv[ref->texcoord & 1u];
    if (primitive->tangents || !uv || primitive->triangle_count == 0) {
        return ASSAY_OK;
    }
    const uint32_t corners = 3 * primitive->triangle_count;
    tangent_work   w       = {
                .primitive = primitive,
                .ref       = ref,
                .uv        = uv,
                .corners   = corners,
                .triangles = primitive->triangle_count,
                .vertex    = assay_allocate(context, corners, sizeof *w.vertex),
                .across    = assay_allocate(context, corners, sizeof *w.across),
                .set       = assay_allocate(context, corners, sizeof *w.set),
                .image     = assay_allocate(context, primitive->triangle_count, sizeof *w.image),
                .sum       = assay_allocate(context, corners, sizeof *w.sum),
                .result    = assay_allocate(context, corners, 4 * sizeof(float)),
    };
    const bool done = run(context, primitive, &w);
    assay_release(context, w.vertex);
    assay_release(context, w.across);
    assay_release(context, w.set);
    assay_release(context, w.image);
    assay_release(context, w.sum);
    assay_release(context, w.result);
    return done ? ASSAY_OK : assay_fail_memory(context, "tangents");
}
