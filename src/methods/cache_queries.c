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
        status = status == ASSAY_ERR_MEMORY
                     ? assay_fail_memory(frame->context, "a look into the cache")
                     : status;
    }
    for (int t = 0; t < TABLES && status == ASSAY_OK; t++) {
        status = assay_bundle_add_table(frame->dump, IRRADIANCE_TABLES[t].name,
                                        IRRADIANCE_TABLES[t].unit, job->tables[t]);
    }
    return status;
}

assay_status assay_cache_queries_add(const assay_frame *frame, const assay_cache_set *caches,
                                     const glossy_materials *materials)
{
    const int threads = assay_context_threads(frame->context);
    query_job job     = {.frame = frame, .store = assay_irradiance_cache_store(caches->irradiance)};
    job.found         = assay_allocate(frame->context, (size_t)threads, sizeof *job.found);
    (void)materials;
    const assay_status status =
        job.found ? add_irradiance(&job) : assay_fail_memory(frame->context, "a cache's users");
    for (int t = 0; t < TABLES; t++) {
        assay_array_destroy(job.tables[t]);
    }
    for (int i = 0; job.found && i < threads; i++) {
        assay_contributions_release(&job.found[i]);
    }
    assay_release(frame->context, job.found);
    return status;
}
