/* stage_gather.c - stage `gather`: what the hemispheres of given points see, by the same random
 * numbers and strata as a cache's records: record k of a level takes the streams of item k.
 *
 * Directions and distances have bounds; a cell whose ray may as well meet another triangle has
 * none. Radiance is one path's estimate, in which a last bit decides which light is asked: it is
 * replayed without a bound, and compared as images are. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "gather/gather.h"
#include "oracle/stage/ray_bound.h"
#include "oracle/stage/stage_cells.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_records.h"
#include "oracle/stage/stage_world.h"

enum { POSITION, NORMAL, GEOMETRIC, NUMBER };
enum { OUT_FRAME, OUT_DIRECTION, OUT_DISTANCE, OUT_RADIANCE, OUT_COUNT };

/* clang-format off */
static const assay_param_desc PARAMS[] = {
    STAGE_CELL_PARAMS,
    {"jitter", ASSAY_PARAM_BOOL, "", "on", 0, 0, NULL,
     "Directions at random places of their cells, else at the centres.", "[gautron06] 2.2.5"},
    {"seed", ASSAY_PARAM_INT, "", "0", 0, 2147483646, NULL, "Of the random numbers.",
     "docs/determinism.md"},
    {"level", ASSAY_PARAM_INT, "", "0", 0, 127, NULL,
     "Of the cache whose hemispheres these are; 64 and more: of radiance records.", ""},
    {"secondary", ASSAY_PARAM_CHOICE, "", "path", 0, 0, "direct|path|cache",
     "Light where a ray ends: direct alone, or all; cache cannot be replayed.", "[gautron06]"},
    {"bounces", ASSAY_PARAM_INT, "", "inf", 0, ASSAY_PARAM_INF, NULL,
     "Of the image: 2 is one indirect bounce.", ""},
    {"estimator", ASSAY_PARAM_CHOICE, "", "mis", 0, 0, "nee|bsdf|mis",
     "How light is found where a ray ends.", "[veach95]"},
    {"roulette_depth", ASSAY_PARAM_INT, "bounces", "5", 1, 1e6, NULL,
     "From the bounce after it on, paths may end by roulette.", ""},
    {0}};

static const assay_stage_array INPUTS[] = {
    {"records/position", "m", "X Y Z", "record", "where is gathered", false, false, false},
    {"records/normal", "", "X Y Z", "record", "of the hemisphere", false, false, false},
    {"gather/geometric_normal", "", "X Y Z", "record",
     "nothing is seen under it; without it the normal", true, false, false},
    {"gather/number", "records", "K", "record",
     "of the record in its cache; without it the row", true, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"gather/frame", "", "Xx Xy Xz Yx Yy Yz Zx Zy Zz", "record",
     "axes of the local frame in the world, after [duff17]", false, false, false},
    {"gather/direction", "", "X Y Z", "cell", "local", false, false, false},
    {"gather/distance", "m", "T", "cell", "infinite where nothing is hit", false, false, true},
    {"gather/radiance", "W/(m2 sr)", "R G B", "cell", "", false, false, false},
    {0}};
/* clang-format on */

/* A level's hemispheres are numbered in streams of their own (irradiance_cache_gather.c). */
enum { LEVEL_SHIFT = 56 };

typedef struct {
    stage_run          *run;
    const assay_world  *world;
    assay_path_settings path;
    assay_ray_counts   *counts;
    assay_gather_hit   *hits;
    assay_hemisphere   *hemisphere;
    assay_vec3         *normals, *geometric;
    size_t              cells;
    stage_output       *out[OUT_COUNT];
} gather_job;

/* All that leaves the vertex, as a cache's gathering has it. */
static assay_rgb radiance(void *user, int cell, assay_vertex *vertex, assay_random *random,
                          int worker)
{
    const gather_job *job = user;
    (void)cell;
    const assay_path_light light =
        assay_path_scatter(job->world, &job->path, vertex, random, &job->counts[worker]);
    return rgb_add(light.direct, light.indirect);
}

/* ---- bounds ---- */

static uint32_t ask(const void *user, assay_vec3 origin, assay_vec3 direction)
{
    const gather_job *job    = user;
    uint64_t          count  = 0;
    assay_random      random = assay_random_start(0, ASSAY_STAGE_GATHER, 0, 0);
    assay_hit         hit;
    return assay_world_closest(job->world, origin, direction, false, &random, &count, &hit)
               ? hit.triangle
               : UINT32_MAX;
}

/* Of a direction after hemisphere.h: places in a stratum are numbers that are given, strata whole
 * numbers; sin and cos of theta are roots of what is left of 1, the azimuth an angle of up to 2 pi.
 */
static tracked3 direction_of(const rounding *r, assay_vec3 d)
{
    const double side  = sqrt(d.x * d.x + d.y * d.y);
    const double loss  = 2.0 * (r->given + 2.0 * r->u);
    const double turn  = ASSAY_TWO_PI * (r->given + 4.0 * r->u) + 4.0 * r->u;
    const double slope = fmin(sqrt(loss), loss / fmax(side, 1e-300));
    const double rise  = fmin(sqrt(loss), loss / fmax(d.z, 1e-300));
    return (tracked3){{d.x, side * turn + slope}, {d.y, side * turn + slope}, {d.z, rise}};
}

static void bound_frame(const rounding *r, const assay_frame3 *f, double *bounds)
{
    /* 1 / (1 + |z|) is at most 1, so every entry is a product of few numbers below 1. */
    const double e = 4.0 * r->given + 6.0 * r->u;
    (void)f;
    for (int i = 0; i < 6; i++) {
        bounds[i] = e;
    }
}

/* To the world, with what the frame's entries may be off. */
static tracked3 world_direction(const rounding *r, const assay_frame3 *f, const tracked3 *local)
{
    const assay_vec3 d = frame3_to_world(f, vec3(local->x.v, local->y.v, local->z.v));
    const double     e =
        sqrt(local->x.e * local->x.e + local->y.e * local->y.e + local->z.e * local->z.e) +
        3.0 * (4.0 * r->given + 10.0 * r->u);
    return (tracked3){{d.x, e}, {d.y, e}, {d.z, e}};
}

static void bound_cell(const gather_job *job, const assay_gather_site *site, size_t cell,
                       size_t row)
{
    const rounding  *r     = &job->run->rounding;
    const tracked3   local = direction_of(r, job->hemisphere->cells[cell].direction);
    const tracked3   way   = world_direction(r, &site->frame, &local);
    const double     size  = bound_scene_size(job->world->scene);
    const assay_vec3 d     = vec3(way.x.v, way.y.v, way.z.v);
    /* Candidates start off the surface by what keeps them from meeting it again. */
    const double            off      = (r->given + 256.0 * r->u) * size;
    const assay_vec3        o        = assay_world_offset(job->world, site->position, site->ng, d);
    const bound_ray         ray      = {{{o.x, off}, {o.y, off}, {o.z, off}}, way};
    const assay_gather_hit *hit      = &job->hits[cell];
    const uint32_t          triangle = hit->hit ? hit->vertex.surface.triangle : UINT32_MAX;
    double                 *bounds   = job->out[OUT_DIRECTION]->bounds + 3 * row;
    bounds[0]                        = local.x.e;
    bounds[1]                        = local.y.e;
    bounds[2]                        = local.z.e;
    for (int c = 0; c < 3; c++) {
        job->out[OUT_RADIANCE]->bounds[3 * row + (size_t)c] = NAN;
    }
    const double over = vec3_dot(d, site->ng);
    if (fabs(over) <= 2.0 * way.x.e ||
        (over > 0.0 && bound_is_torn(r, job->world->scene, &ray, triangle,
                                     job->hemisphere->cells[cell].distance, ask, job))) {
        job->out[OUT_DISTANCE]->bounds[row] = NAN;
    } else if (triangle != UINT32_MAX) {
        job->out[OUT_DISTANCE]->bounds[row] =
            bound_hit_of(r, job->world->scene, triangle, &ray).distance.e;
    }
}

/* ---- values ---- */

static assay_gather_site site_of(const gather_job *job, size_t record)
{
    return (assay_gather_site){
        .position = stage_vec3(job->run->in[POSITION].values + 3 * record),
        .ng       = job->geometric ? job->geometric[record] : job->normals[record],
        .frame    = frame3_from_z(job->normals[record]),
    };
}

static void put_cells(const gather_job *job, const assay_gather_site *site, size_t record)
{
    memcpy(job->out[OUT_FRAME]->values + 9 * record, &site->frame, sizeof site->frame);
    for (size_t i = 0; i < job->cells; i++) {
        const assay_cell *cell = &job->hemisphere->cells[i];
        const size_t      row  = record * job->cells + i;
        memcpy(job->out[OUT_DIRECTION]->values + 3 * row, &cell->direction, sizeof cell->direction);
        memcpy(job->out[OUT_RADIANCE]->values + 3 * row, &cell->radiance, sizeof cell->radiance);
        job->out[OUT_DISTANCE]->values[row] = cell->distance;
        if (job->run->bounded) {
            bound_cell(job, site, i, row);
        }
    }
    if (job->run->bounded) {
        bound_frame(&job->run->rounding, &site->frame, job->out[OUT_FRAME]->bounds + 9 * record);
        for (int i = 6; i < 9; i++) {
            job->out[OUT_FRAME]->bounds[9 * record + (size_t)i] = job->run->rounding.given;
        }
    }
}

static assay_status gather_all(gather_job *job)
{
    stage_run           *run      = job->run;
    const assay_gatherer gatherer = {
        .world         = job->world,
        .seed          = (uint64_t)assay_params_int(run->params, "seed"),
        .radiance      = radiance,
        .user          = job,
        .worker_counts = job->counts,
    };
    const uint64_t level  = (uint64_t)assay_params_int(run->params, "level") << LEVEL_SHIFT;
    assay_status   status = ASSAY_OK;
    for (size_t i = 0; i < run->in[POSITION].rows && status == ASSAY_OK; i++) {
        const double           *number = run->in[NUMBER].values;
        const uint64_t          item   = level | (number ? (uint64_t)number[i] : i);
        const assay_gather_site site   = site_of(job, i);
        const int               n      = (int)job->cells;
        status = assay_gather_rays(&gatherer, &site, item, 0, n, job->hemisphere, job->hits);
        status = status ? status : assay_gather_light(&gatherer, 0, n, job->hits, job->hemisphere);
        if (status == ASSAY_OK) {
            put_cells(job, &site, i);
        }
    }
    return status;
}

static assay_status open_job(gather_job *job)
{
    stage_run              *run       = job->run;
    const size_t            records   = run->in[POSITION].rows;
    const int               secondary = assay_params_choice(run->params, "secondary");
    const int               bounces   = assay_params_int(run->params, "bounces");
    assay_hemisphere_layout layout    = stage_cells_layout(run->params);
    layout.jitter                     = assay_params_bool(run->params, "jitter");
    job->cells                        = (size_t)layout.theta * (size_t)layout.phi;
    job->path                         = (assay_path_settings){
                                .bounces        = secondary == 0                 ? 1
                                                  : bounces == ASSAY_BOUNCES_INF ? bounces
                                                                                 : bounces - 1,
                                .roulette_depth = assay_params_int(run->params, "roulette_depth"),
                                .estimator      = (assay_estimator)assay_params_choice(run->params, "estimator")};
    const size_t threads = (size_t)assay_context_threads(run->context);
    job->counts          = assay_allocate(run->context, threads, sizeof *job->counts);
    job->hits            = assay_allocate(run->context, job->cells, sizeof *job->hits);
    if (!job->counts || !job->hits) {
        return assay_fail_memory(run->context, "a hemisphere");
    }
    assay_status status          = assay_hemisphere_create(run->context, &layout, &job->hemisphere);
    const size_t rows[OUT_COUNT] = {records, records * job->cells, records * job->cells,
                                    records * job->cells};
    const size_t columns[OUT_COUNT] = {9, 3, 1, 3};
    for (int k = 0; k < OUT_COUNT && status == ASSAY_OK; k++) {
        status = stage_output_make(run, k, 0, rows[k], columns[k], &job->out[k]);
    }
    return status;
}

static assay_status check(const stage_run *run)
{
    const size_t records = run->in[POSITION].rows;
    for (int i = NORMAL; i <= NUMBER; i++) {
        if (run->in[i].values && run->in[i].rows != records) {
            return stage_fail_rows(run, i, records, "one a record, as of records/position");
        }
    }
    for (size_t i = 0; run->in[NUMBER].values && i < records; i++) {
        const double k = run->in[NUMBER].values[i];
        if (!(k >= 0.0 && k < 4294967295.0 && k == assay_floor(k))) {
            return stage_fail_value(run, NUMBER, i, 0, "not the number of a record");
        }
    }
    if (assay_params_choice(run->params, "secondary") == 2) {
        return assay_fail(run->context, ASSAY_ERR_UNSUPPORTED,
                          "stage 'gather': with secondary=cache the light comes from another "
                          "cache, which is not replayed");
    }
    return stage_cells_check(run);
}

static void close_job(gather_job *job)
{
    assay_context *context = job->run->context;
    assay_hemisphere_destroy(context, job->hemisphere);
    assay_release(context, job->counts);
    assay_release(context, job->hits);
    assay_release(context, job->normals);
    assay_release(context, job->geometric);
}

static assay_status run_gather(stage_run *run)
{
    assay_world *world  = NULL;
    gather_job   job    = {.run = run};
    assay_status status = check(run);
    status              = status ? status : stage_unit_vectors(run, NORMAL, 0, &job.normals);
    if (status == ASSAY_OK && run->in[GEOMETRIC].values) {
        status = stage_unit_vectors(run, GEOMETRIC, 0, &job.geometric);
    }
    status    = status ? status : stage_world_create(run, &world);
    job.world = world;
    status    = status ? status : open_job(&job);
    status    = status ? status : gather_all(&job);
    close_job(&job);
    assay_world_destroy(world);
    return status;
}

const oracle_stage stage_gather = {
    .info = {.name        = "gather",
             .summary     = "what the hemispheres of given points see, cell by cell",
             .params      = PARAMS,
             .inputs      = INPUTS,
             .outputs     = OUTPUTS,
             .needs_scene = true},
    .run  = run_gather};
