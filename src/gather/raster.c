/* raster.c - all triangles, a piece to a worker, each worker with a buffer of its own.
 *
 * Invariant: a buffer holds, for each pixel, the least of the fragments (depth, triangle) that its
 * worker has met; the least over all workers is the least over all triangles, whoever met which. */
#include "gather/raster.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/parallel.h"
#include "gather/raster_triangle.h"

/* Triangles of one piece of work; more pixels than these are drawn by one worker, for the others'
 * buffers would be large. */
enum { CHUNK = 2048, MOST_SHARED = 1 << 18 };

/* A pixel's breadth that bounds are widened by, above the rounding of w >= 2^-30 of the largest
 * coordinate. */
static const double MARGIN = 0.0625, NEAR_EYE = 0x1p-30;

/* What is above this part of its terms is not made by their rounding. */
static const double SURE = 0x1p-30;

typedef struct {
    const assay_scene       *scene;
    const assay_raster_view *view;
    size_t                   pixels;
    assay_raster_sample     *samples; /* of worker 0: the caller's */
    assay_raster_sample     *others;  /* of the others             */
    double                  *x, *y;   /* of the pixels' centres    */
} raster_job;

typedef struct {
    int first, last;
} pixel_range;

assay_raster_point assay_raster_centre(const assay_raster_view *view, int column, int row)
{
    return (assay_raster_point){view->half *
                                    ((2 * column + 1 - view->columns) / (double)view->columns),
                                view->half * ((2 * row + 1 - view->rows) / (double)view->rows)};
}

/* ---- what can be seen at all ---- */

/* Whether all corners are beyond the same side of the plane, or behind the eye. */
static bool is_outside(const raster_triangle *t, double half)
{
    const raster_corner *p    = t->corner;
    bool                 left = true, right = true, below = true, above = true, behind = true;
    for (int i = 0; i < 3; i++) {
        const double edge = half * p[i].w;
        left &= p[i].x < -edge;
        right &= p[i].x > edge;
        below &= p[i].y < -edge;
        above &= p[i].y > edge;
        behind &= p[i].w <= 0.0;
    }
    return left || right || below || above || behind;
}

/* Whole numbers from low to high, within the pixels. */
static pixel_range clamp_range(double low, double high, int count)
{
    return (pixel_range){low > 0.0 ? (low < count ? (int)-assay_floor(-low) : count) : 0,
                         high < count - 1.0 ? (high < 0.0 ? -1 : (int)assay_floor(high))
                                            : count - 1};
}

/* Pixels whose centres lie between the projections of the corners, which are all before the eye. */
static void bound(const raster_triangle *t, const assay_raster_view *view, pixel_range *columns,
                  pixel_range *rows)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        const raster_corner *p     = &t->corner[i];
        const double         scale = 1.0 / (view->half * p->w);
        const double         x = p->x * scale, y = p->y * scale;
        low[0]  = fmin(low[0], x);
        high[0] = fmax(high[0], x);
        low[1]  = fmin(low[1], y);
        high[1] = fmax(high[1], y);
    }
    const double half_columns = 0.5 * view->columns, half_rows = 0.5 * view->rows;
    *columns = clamp_range((low[0] + 1.0) * half_columns - 0.5 - MARGIN,
                           (high[0] + 1.0) * half_columns - 0.5 + MARGIN, view->columns);
    *rows    = clamp_range((low[1] + 1.0) * half_rows - 0.5 - MARGIN,
                           (high[1] + 1.0) * half_rows - 0.5 + MARGIN, view->rows);
}

/* Whether all corners are so far before the eye that their projections are places. */
static bool is_before(const raster_triangle *t)
{
    double largest = 0.0, least = INFINITY;
    for (int i = 0; i < 3; i++) {
        const raster_corner *p = &t->corner[i];
        largest                = fmax(largest, fmax(fabs(p->x), fmax(fabs(p->y), fabs(p->w))));
        least                  = fmin(least, p->w);
    }
    return least > NEAR_EYE * largest;
}

/* A plane through the eye and an edge: x X + y Y + c is the edge function at (X, Y). */
typedef struct {
    double x, y, c;
} edge_plane;

typedef struct {
    edge_plane edge[3];
    double     sign; /* of the edge functions where the triangle is before the eye; 0: not known */
} crossing;

/* Of a triangle that crosses the eye's plane.  The sign is that of its volume with the eye, unless
 * rounding could have made it. */
static crossing cross_eye_plane(const raster_triangle *t)
{
    crossing c;
    for (int i = 0; i < 3; i++) {
        const raster_corner *p = &t->corner[(i + 1) % 3], *q = &t->corner[(i + 2) % 3];
        c.edge[i] = (edge_plane){p->w * q->y - p->y * q->w, p->x * q->w - p->w * q->x,
                                 p->y * q->x - p->x * q->y};
    }
    const raster_corner *p = &t->corner[0];
    const double         x = p->x * c.edge[0].x, y = p->y * c.edge[0].y, w = p->w * c.edge[0].c;
    const double         volume = x + y + w, size = fabs(x) + fabs(y) + fabs(w);
    c.sign = fabs(volume) > SURE * size ? copysign(1.0, volume) : 0.0;
    return c;
}

/* The columns of a row where all edge functions can have that sign.  An edge that the row runs
 * along, as far as rounding tells, leaves them all. */
static pixel_range span(const crossing *c, const assay_raster_view *view, double y)
{
    double low = -view->half, high = view->half;
    for (int i = 0; i < 3 && c->sign != 0.0; i++) {
        const edge_plane *e = &c->edge[i];
        if (fabs(e->x) * view->half > SURE * (fabs(e->y * y) + fabs(e->c))) {
            const double at = -(e->y * y + e->c) / e->x;
            low             = c->sign * e->x > 0.0 ? fmax(low, at) : low;
            high            = c->sign * e->x > 0.0 ? high : fmin(high, at);
        }
    }
    const double scale = 0.5 * view->columns;
    return clamp_range((low / view->half + 1.0) * scale - 1.5,
                       (high / view->half + 1.0) * scale + 0.5, view->columns);
}

/* ---- pixels ---- */

/* The order of fragments: depth, then the triangle's number. */
static inline bool comes_before(double depth, uint32_t triangle, const assay_raster_sample *sample)
{
    return depth < sample->depth || (depth == sample->depth && triangle < sample->triangle);
}

static void draw_row(const raster_job *job, const raster_triangle *t, int row, pixel_range columns,
                     bool opaque, assay_raster_sample *samples)
{
    const assay_raster_view *view = job->view;
    assay_raster_sample     *line = samples + (size_t)row * (size_t)view->columns;
    const double             y    = job->y[row];
    for (int i = columns.first; i <= columns.last; i++) {
        raster_fragment f;
        if (raster_triangle_covers(t, (assay_raster_point){job->x[i], y}, &f) &&
            f.depth > view->near && comes_before(f.depth, t->triangle, &line[i]) &&
            (opaque || assay_triangle_coverage(job->scene, t->triangle, f.u, f.v) >= 0.5)) {
            line[i] = (assay_raster_sample){f.depth, t->triangle};
        }
    }
}

static bool is_opaque(const assay_scene *scene, uint32_t triangle)
{
    const assay_shape *shape = &scene->shapes[scene->triangle_shape[triangle]];
    return scene->materials[shape->material].alpha_mode == ASSAY_ALPHA_OPAQUE;
}

static void draw_triangle(const raster_job *job, uint32_t triangle, assay_raster_sample *samples)
{
    const assay_raster_view *view = job->view;
    raster_triangle          t;
    raster_triangle_load(job->scene, view, triangle, &t);
    if (is_outside(&t, view->half)) {
        return;
    }
    const bool opaque = is_opaque(job->scene, triangle);
    if (is_before(&t)) {
        pixel_range columns, rows;
        bound(&t, view, &columns, &rows);
        for (int row = rows.first; row <= rows.last && columns.first <= columns.last; row++) {
            draw_row(job, &t, row, columns, opaque, samples);
        }
        return;
    }
    const crossing c = cross_eye_plane(&t);
    for (int row = 0; row < view->rows; row++) {
        draw_row(job, &t, row, span(&c, view, job->y[row]), opaque, samples);
    }
}

static assay_status draw_chunk(void *user, uint64_t chunk, int worker)
{
    const raster_job    *job   = user;
    const uint64_t       count = job->scene->triangle_count;
    assay_raster_sample *samples =
        worker == 0 ? job->samples : job->others + (size_t)(worker - 1) * job->pixels;
    for (uint64_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < count; i++) {
        draw_triangle(job, (uint32_t)i, samples);
    }
    return ASSAY_OK;
}

static void clear(assay_raster_sample *samples, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        samples[i] = (assay_raster_sample){INFINITY, ASSAY_NO_TRIANGLE};
    }
}

static assay_status check(const assay_scene *scene, const assay_raster_view *view)
{
    if (view->columns < 1 || view->columns > ASSAY_RASTER_MAX || view->rows < 1 ||
        view->rows > ASSAY_RASTER_MAX) {
        return assay_fail(scene->context, ASSAY_ERR_ARGUMENT,
                          "a plane of %d x %d pixels: both must be 1 ... %d", view->columns,
                          view->rows, ASSAY_RASTER_MAX);
    }
    if (!(view->half > 0.0 && isfinite(view->half)) || isnan(view->near) ||
        (!view->parallel && view->near < 0.0)) {
        return assay_fail(scene->context, ASSAY_ERR_ARGUMENT,
                          "a plane of half side %g seen beyond %g m", view->half, view->near);
    }
    return ASSAY_OK;
}

static bool open_job(raster_job *job, size_t others)
{
    const assay_raster_view *view    = job->view;
    assay_context           *context = job->scene->context;
    job->others = assay_allocate(context, others * job->pixels, sizeof *job->others);
    job->x      = assay_allocate(context, (size_t)view->columns, sizeof *job->x);
    job->y      = assay_allocate(context, (size_t)view->rows, sizeof *job->y);
    if (!job->others || !job->x || !job->y) {
        return false;
    }
    for (int i = 0; i < view->columns; i++) {
        job->x[i] = assay_raster_centre(view, i, 0).x;
    }
    for (int j = 0; j < view->rows; j++) {
        job->y[j] = assay_raster_centre(view, 0, j).y;
    }
    clear(job->samples, job->pixels);
    clear(job->others, others * job->pixels);
    return true;
}

static void close_job(raster_job *job)
{
    assay_release(job->scene->context, job->others);
    assay_release(job->scene->context, job->x);
    assay_release(job->scene->context, job->y);
}

assay_status assay_raster_draw(const assay_scene *scene, const assay_raster_view *view,
                               assay_raster_sample *samples)
{
    assay_status status = check(scene, view);
    if (status != ASSAY_OK) {
        return status;
    }
    const uint64_t chunks = ((uint64_t)scene->triangle_count + CHUNK - 1) / CHUNK;
    const size_t   pixels = (size_t)view->columns * (size_t)view->rows;
    const bool     shared = chunks > 1 && pixels <= MOST_SHARED;
    const size_t   others = shared ? (size_t)assay_context_threads(scene->context) - 1 : 0;
    raster_job     job    = {.scene = scene, .view = view, .samples = samples, .pixels = pixels};
    if (!open_job(&job, others)) {
        status = assay_fail_memory(scene->context, "the buffers of a rasteriser");
    } else if (shared) {
        status = assay_parallel_for(scene->context, NULL, chunks, draw_chunk, &job);
    } else {
        for (uint64_t i = 0; i < chunks; i++) {
            (void)draw_chunk(&job, i, 0);
        }
    }
    for (size_t i = 0; i < others * job.pixels && status == ASSAY_OK; i++) {
        const assay_raster_sample *other = &job.others[i];
        if (comes_before(other->depth, other->triangle, &samples[i % job.pixels])) {
            samples[i % job.pixels] = *other;
        }
    }
    close_job(&job);
    return status;
}

assay_hit assay_raster_hit(const assay_scene *scene, const assay_raster_view *view, int column,
                           int row, const assay_raster_sample *sample)
{
    const assay_raster_point at = assay_raster_centre(view, column, row);
    raster_triangle          t;
    raster_fragment          f = {0};
    raster_triangle_load(scene, view, sample->triangle, &t);
    (void)raster_triangle_covers(&t, at, &f);
    const double stretch = view->parallel ? 1.0 : sqrt(at.x * at.x + at.y * at.y + 1.0);
    return (assay_hit){.t = f.depth * stretch, .u = f.u, .v = f.v, .triangle = sample->triangle};
}
