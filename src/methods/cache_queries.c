/* cache_queries.c - centres are looked at once more, when no record will be added any more.
 *
 * Invariant: a row is what the dumped records say, by the rules of the cache and by nothing else:
 * where none of them counts it is 0, though the image may show the nearest record there or a path.
 * The rays that find the points again are not counted: they are the dump's, not the image's.
 *
 * A row of coefficients is 2.4 kB at order 10, 2.4 GB for a picture of 1000 x 1000.  So of the
 * glossy pixels every k-th is asked, with the least k that leaves ASSAY_CACHE_QUERIES_MOST. */
#include "methods/cache_queries.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/parallel.h"
#include "trace/visible_point.h"

enum { POSITION, NORMAL, IRRADIANCE, WEIGHT, TABLES };

static const struct {
    const char *name, *unit;
    size_t      columns;
} IRRADIANCE_TABLES[TABLES] = {{"query/position", "m", 3},
                               {"query/normal", "", 3},
                               {"query/irradiance", "W/m2", 3},
                               {"query/weight_sum", "", 1}};

typedef struct {
    const assay_frame        *frame;
    const assay_record_store *store;
    assay_contributions      *found; /* a worker */
    assay_array              *tables[TABLES];
} query_job;

static size_t pixels_of(const assay_frame *frame)
{
    return (size_t)frame->width * (size_t)frame->height;
}

static bool look(const assay_frame *frame, size_t pixel, assay_vertex *vertex_out)
{
    assay_ray_counts uncounted = {0};
    return assay_visible_find(frame->world, frame->camera, frame->width, frame->height,
                              (int)(pixel % (size_t)frame->width),
                              (int)(pixel / (size_t)frame->width), &uncounted, vertex_out);
}

static void put(const query_job *job, int table, size_t row, assay_vec3 v)
{
    memcpy(assay_array_data(job->tables[table]) + 3 * row, &v, sizeof v);
}

/* ---- irradiance ---- */

static assay_status ask_pixel(const query_job *job, size_t pixel, assay_contributions *found)
{
    assay_vertex     vertex;
    const assay_vec3 none = vec3(NAN, NAN, NAN);
    if (!look(job->frame, pixel, &vertex)) {
        put(job, POSITION, pixel, none);
        put(job, NORMAL, pixel, none);
        return ASSAY_OK;
    }
    const assay_gather_site site = assay_gather_site_of(&vertex);
    const assay_vec3        p = site.position, n = site.frame.z;
    const assay_status      status = assay_record_store_find(job->store, p, n, UINT32_MAX, found);
    put(job, POSITION, pixel, p);
    put(job, NORMAL, pixel, n);
    if (status == ASSAY_OK && found->count > 0) {
        const assay_rgb e = assay_record_store_interpolate(job->store, found, p, n);
        put(job, IRRADIANCE, pixel, vec3(e.r, e.g, e.b));
        assay_array_data(job->tables[WEIGHT])[pixel] = found->weight;
    }
    return status;
}

static assay_status ask_row(void *user, uint64_t y, int worker)
{
    const query_job *job    = user;
    const size_t     width  = (size_t)job->frame->width;
    assay_status     status = ASSAY_OK;
    for (size_t x = 0; x < width && status == ASSAY_OK; x++) {
        status = ask_pixel(job, (size_t)y * width + x, &job->found[worker]);
    }
    return status;
}

static assay_status add_irradiance(query_job *job)
{
    const assay_frame *frame  = job->frame;
    assay_status       status = ASSAY_OK;
    for (int t = 0; t < TABLES && status == ASSAY_OK; t++) {
        status = assay_array_create(frame->context, pixels_of(frame), IRRADIANCE_TABLES[t].columns,
                                    &job->tables[t]);
    }
    if (status == ASSAY_OK) {
        status = assay_parallel_for(frame->context, NULL, (uint64_t)frame->height, ask_row, job);
    }
    for (int t = 0; t < TABLES && status == ASSAY_OK; t++) {
        status = assay_bundle_add_table(frame->dump, IRRADIANCE_TABLES[t].name,
                                        IRRADIANCE_TABLES[t].unit, job->tables[t]);
    }
    return status;
}

/* ---- radiance ---- */

enum { R_PIXEL, R_POSITION, R_FRAME, R_COEFFICIENTS, R_WEIGHT, R_TABLES, FRAME_COLUMNS = 9 };

static const struct {
    const char *name, *unit;
    size_t      columns; /* 0: a row of coefficients */
} RADIANCE_TABLES[R_TABLES] = {{"radiance_query/pixel", "", 1},
                               {"radiance_query/position", "m", 3},
                               {"radiance_query/frame", "", FRAME_COLUMNS},
                               {"radiance_query/coefficients", "W/(m2 sr)", 0},
                               {"radiance_query/weight_sum", "", 1}};

typedef struct {
    const assay_frame        *frame;
    const assay_record_store *store;
    const glossy_materials   *materials;
    assay_radiance_rows       rows;
    uint8_t                  *glossy; /* a pixel: has a material within reach */
    uint64_t                 *pixels; /* that are asked                       */
    size_t                    count;
    assay_contributions      *found;   /* a worker             */
    double                   *scratch; /* a worker: two rows   */
    assay_array              *tables[R_TABLES];
} radiance_job;

static assay_status look_row(void *user, uint64_t y, int worker)
{
    const radiance_job *job   = user;
    const size_t        width = (size_t)job->frame->width;
    (void)worker;
    for (size_t i = (size_t)y * width; i < ((size_t)y + 1) * width; i++) {
        assay_vertex vertex;
        job->glossy[i] =
            look(job->frame, i, &vertex) && glossy_materials_at(job->materials, &vertex) != NULL;
    }
    return ASSAY_OK;
}

/* Every k-th of the glossy pixels. */
static void choose_pixels(radiance_job *job)
{
    const size_t pixels = pixels_of(job->frame);
    size_t       glossy = 0, seen = 0;
    for (size_t i = 0; i < pixels; i++) {
        glossy += job->glossy[i];
    }
    const size_t step = glossy > 0 ? (glossy - 1) / ASSAY_CACHE_QUERIES_MOST + 1 : 1;
    for (size_t i = 0; i < pixels; i++) {
        if (job->glossy[i] && seen++ % step == 0) {
            job->pixels[job->count++] = i;
        }
    }
}

static void put_row(const radiance_job *job, int table, size_t row, size_t columns,
                    const void *values)
{
    memcpy(assay_array_data(job->tables[table]) + row * columns, values, columns * sizeof(double));
}

static assay_status ask_radiance(void *user, uint64_t row, int worker)
{
    const radiance_job  *job   = user;
    assay_contributions *found = &job->found[worker];
    const double         pixel = (double)job->pixels[row];
    assay_vertex         vertex;
    look(job->frame, (size_t)job->pixels[row], &vertex);
    const assay_frame3 frame  = assay_material_frame(&vertex);
    const assay_vec3   p      = vertex.surface.position;
    assay_status       status = assay_record_store_find(job->store, p, frame.z, UINT32_MAX, found);
    put_row(job, R_PIXEL, row, 1, &pixel);
    put_row(job, R_POSITION, row, 3, &p);
    put_row(job, R_FRAME, row, FRAME_COLUMNS, &frame);
    if (status == ASSAY_OK && found->count > 0) {
        put_row(job, R_WEIGHT, row, 1, &found->weight);
        status = assay_radiance_rows_mean(
            &job->rows, assay_record_store_at(job->store, 0), found, p, &frame, worker,
            job->scratch + (size_t)worker * 2 * job->rows.count,
            assay_array_data(job->tables[R_COEFFICIENTS]) + row * job->rows.count);
    }
    return status;
}

static assay_status find_pixels(radiance_job *job)
{
    const assay_frame *frame = job->frame;
    job->glossy              = assay_allocate(frame->context, pixels_of(frame), 1);
    job->pixels = assay_allocate(frame->context, ASSAY_CACHE_QUERIES_MOST, sizeof *job->pixels);
    if (!job->glossy || !job->pixels) {
        return assay_fail_memory(frame->context, "a dump");
    }
    const assay_status status =
        assay_parallel_for(frame->context, NULL, (uint64_t)frame->height, look_row, job);
    if (status == ASSAY_OK) {
        choose_pixels(job);
    }
    return status;
}

static assay_status fill_radiance(radiance_job *job)
{
    const assay_frame *frame   = job->frame;
    const size_t       threads = (size_t)assay_context_threads(frame->context);
    assay_status       status  = find_pixels(job);
    job->found                 = assay_allocate(frame->context, threads, sizeof *job->found);
    job->scratch = assay_allocate(frame->context, threads, 2 * job->rows.count * sizeof(double));
    if (status == ASSAY_OK && (!job->found || !job->scratch)) {
        status = assay_fail_memory(frame->context, "a cache's users");
    }
    for (int t = 0; t < R_TABLES && status == ASSAY_OK; t++) {
        const size_t columns = RADIANCE_TABLES[t].columns;
        status = assay_array_create(frame->context, job->count, columns ? columns : job->rows.count,
                                    &job->tables[t]);
    }
    return status ? status
                  : assay_parallel_for(frame->context, NULL, job->count, ask_radiance, job);
}

static assay_status add_radiance(radiance_job *job)
{
    const assay_frame *frame  = job->frame;
    assay_status       status = fill_radiance(job);
    for (int t = 0; t < R_TABLES; t++) {
        status = status ? status
                        : assay_bundle_add_table(frame->dump, RADIANCE_TABLES[t].name,
                                                 RADIANCE_TABLES[t].unit, job->tables[t]);
        assay_array_destroy(job->tables[t]);
    }
    for (int i = 0; job->found && i < assay_context_threads(frame->context); i++) {
        assay_contributions_release(&job->found[i]);
    }
    assay_release(frame->context, job->found);
    assay_release(frame->context, job->scratch);
    assay_release(frame->context, job->glossy);
    assay_release(frame->context, job->pixels);
    return status;
}

/* ---- both ---- */

static void close_irradiance(query_job *job)
{
    for (int t = 0; t < TABLES; t++) {
        assay_array_destroy(job->tables[t]);
    }
    for (int i = 0; job->found && i < assay_context_threads(job->frame->context); i++) {
        assay_contributions_release(&job->found[i]);
    }
    assay_release(job->frame->context, job->found);
}

assay_status assay_cache_queries_add(const assay_frame *frame, const assay_cache_set *caches,
                                     const glossy_materials *materials)
{
    query_job job = {.frame = frame, .store = assay_irradiance_cache_store(caches->irradiance)};
    job.found     = assay_allocate(frame->context, (size_t)assay_context_threads(frame->context),
                                   sizeof *job.found);
    assay_status status =
        job.found ? add_irradiance(&job) : assay_fail_memory(frame->context, "a cache's users");
    close_irradiance(&job);
    if (status == ASSAY_OK && caches->radiance) {
        radiance_job glossy = {
            .frame = frame,
            .store = assay_irradiance_cache_store(assay_radiance_cache_records(caches->radiance)),
            .materials = materials,
            .rows      = assay_radiance_cache_rows(caches->radiance)};
        status = add_radiance(&glossy);
    }
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(frame->context, "a look into the cache")
                                      : status;
}
