/* raster.c - bands of rows, each drawn by one worker from the near to the far.
 *
 * The tree leaves out what no pixel's centre is in, or what lies behind what was drawn before; it
 * never decides anything.
 *
 * Invariant: a pixel holds the least of the fragments (depth, triangle) met so far, and what is
 * left out is greater or not there: so it ends with the least of all, in whatever order they came.
 */
#include "gather/raster.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "gather/raster_bounds.h"

/* Rows of a band at least, and bands for each worker; pixels up to which a box is looked at to see
 * whether it is hidden. */
enum { BAND_ROWS = 16, BANDS_EACH = 4, MOST_HIDDEN = 4096 };

typedef struct {
    const assay_world       *world;
    const assay_raster_view *view;
    assay_raster_sample     *samples;
    double                  *x, *y; /* of the pixels' centres */
    int                      bands;
} raster_job;

/* A band under way. */
typedef struct {
    const raster_job *job;
    raster_band       band;
} band_work;

assay_raster_point assay_raster_centre(const assay_raster_view *view, int column, int row)
{
    return (assay_raster_point){view->half *
                                    ((2 * column + 1 - view->columns) / (double)view->columns),
                                view->half * ((2 * row + 1 - view->rows) / (double)view->rows)};
}

/* ---- pixels ---- */

/* The order of fragments: depth, then the triangle's number. */
static inline bool comes_before(double depth, uint32_t triangle, const assay_raster_sample *sample)
{
    return depth < sample->depth || (depth == sample->depth && triangle < sample->triangle);
}

static void draw_row(const raster_job *job, const raster_triangle *t, int row, pixel_range columns,
                     bool opaque)
{
    const assay_raster_view *view = job->view;
    assay_raster_sample     *line = job->samples + (size_t)row * (size_t)view->columns;
    const double             y    = job->y[row];
    for (int i = columns.first; i <= columns.last; i++) {
        raster_fragment f;
        if (raster_triangle_covers(t, (assay_raster_point){job->x[i], y}, &f) &&
            f.depth > view->near && comes_before(f.depth, t->triangle, &line[i]) &&
            (opaque || assay_triangle_coverage(job->world->scene, t->triangle, f.u, f.v) >= 0.5)) {
            line[i] = (assay_raster_sample){f.depth, t->triangle};
        }
    }
}

static bool is_opaque(const assay_world *world, uint32_t triangle)
{
    const assay_scene *scene = world->scene;
    return !world->has_alpha ||
           scene->materials[scene->shapes[scene->triangle_shape[triangle]].material].alpha_mode ==
               ASSAY_ALPHA_OPAQUE;
}

static void draw_triangle(void *user, uint32_t triangle)
{
    const band_work  *work = user;
    const raster_job *job  = work->job;
    pixel_range       columns, rows;
    raster_triangle   t;
    raster_triangle_load(job->world->scene, job->view, triangle, &t);
    if (raster_band_misses(&work->band, &t)) {
        return;
    }
    const bool opaque = is_opaque(job->world, triangle);
    if (raster_band_bound(&work->band, &t, &columns, &rows)) {
        for (int row = rows.first; row <= rows.last && columns.first <= columns.last; row++) {
            draw_row(job, &t, row, columns, opaque);
        }
        return;
    }
    const raster_crossing c = raster_crossing_of(&t);
    for (int row = work->band.rows.first; row <= work->band.rows.last; row++) {
        draw_row(job, &t, row, raster_crossing_span(&c, job->view, job->y[row]), opaque);
    }
}

/* ---- boxes ---- */

/* Whether all of the box's pixels have something before it. */
static bool is_hidden(const raster_job *job, const raster_box *box)
{
    const int wide = box->columns.last - box->columns.first + 1;
    const int high = box->rows.last - box->rows.first + 1;
    if (!box->bounded || wide * high > MOST_HIDDEN) {
        return false;
    }
    for (int row = box->rows.first; row <= box->rows.last; row++) {
        const assay_raster_sample *line = job->samples + (size_t)row * (size_t)job->view->columns;
        for (int i = box->columns.first; i <= box->columns.last; i++) {
            if (!(line[i].depth < box->depth)) {
                return false;
            }
        }
    }
    return true;
}

static void weigh_boxes(void *user, const assay_bvh_planes planes, double keys[ASSAY_BVH_BOXES])
{
    const band_work *work = user;
    raster_box       boxes[ASSAY_BVH_BOXES];
    raster_band_boxes(&work->band, planes, boxes);
    for (int i = 0; i < ASSAY_BVH_BOXES; i++) {
        keys[i] = boxes[i].depth < INFINITY && is_hidden(work->job, &boxes[i]) ? INFINITY
                                                                               : boxes[i].depth;
    }
}

/* ---- all of it ---- */

static assay_status draw_band(void *user, uint64_t index, int worker)
{
    static const assay_bvh_visitor visitor = {weigh_boxes, draw_triangle};
    const raster_job              *job     = user;
    const int64_t                  rows = job->view->rows, band = (int64_t)index;
    const pixel_range              own  = {(int)(band * rows / job->bands),
                                           (int)((band + 1) * rows / job->bands) - 1};
    band_work                      work = {job, raster_band_of(job->world->scene, job->view, own)};
    (void)worker;
    for (size_t i = (size_t)own.first * (size_t)job->view->columns;
         i < (size_t)(own.last + 1) * (size_t)job->view->columns; i++) {
        job->samples[i] = (assay_raster_sample){INFINITY, ASSAY_NO_TRIANGLE};
    }
    assay_bvh_visit(job->world->bvh, &visitor, &work);
    return ASSAY_OK;
}

static assay_status check(assay_context *context, const assay_raster_view *view)
{
    if (view->columns < 1 || view->columns > ASSAY_RASTER_MAX || view->rows < 1 ||
        view->rows > ASSAY_RASTER_MAX) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a plane of %d x %d pixels: both must be 1 ... %d", view->columns,
                          view->rows, ASSAY_RASTER_MAX);
    }
    if (!(view->half > 0.0 && isfinite(view->half)) || isnan(view->near) ||
        (!view->parallel && view->near < 0.0)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "a plane of half side %g seen beyond %g m",
                          view->half, view->near);
    }
    return ASSAY_OK;
}

static int bands_of(assay_context *context, int rows)
{
    const int threads = assay_context_threads(context);
    const int most    = (rows + BAND_ROWS - 1) / BAND_ROWS,
              want    = threads > 1 ? BANDS_EACH * threads : 1;
    return most < want ? most : want;
}

assay_status assay_raster_draw(const assay_world *world, const assay_raster_view *view,
                               assay_raster_sample *samples)
{
    assay_context *context = world->scene->context;
    assay_status   status  = check(context, view);
    if (status != ASSAY_OK) {
        return status;
    }
    raster_job job = {.world   = world,
                      .view    = view,
                      .samples = samples,
                      .x       = assay_allocate(context, (size_t)view->columns, sizeof *job.x),
                      .y       = assay_allocate(context, (size_t)view->rows, sizeof *job.y),
                      .bands   = bands_of(context, view->rows)};
    if (job.x && job.y) {
        for (int i = 0; i < view->columns; i++) {
            job.x[i] = assay_raster_centre(view, i, 0).x;
        }
        for (int j = 0; j < view->rows; j++) {
            job.y[j] = assay_raster_centre(view, 0, j).y;
        }
        status = assay_parallel_for(context, NULL, (uint64_t)job.bands, draw_band, &job);
    } else {
        status = assay_fail_memory(context, "a rasteriser");
    }
    assay_release(context, job.x);
    assay_release(context, job.y);
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
