/* bench_splat.c - splatting against the octree's final pass: the same records, the same points.
 *
 *     bench_splat [SIDE RECORDS]
 *
 * A room of records, as bench_records has it: some ten reach a point, whatever their number, and
 * their zones are as large as that makes them.  The camera stands in the room.  Both sides begin
 * with points and normals of an image and end with its irradiance: the octree asks each pixel, with
 * a store that is there; splatting clears its sums, measures the points, binds records to tiles,
 * adds them up and divides.  One thread, by processor time; the least of some rounds, in turns. */
#include <stdio.h>
#include <stdlib.h>

#include "bench/bench.h"
#include "bench/bench_walls.h"
#include "core/numerics.h"
#include "core/random.h"
#include "record/splat.h"
#include "trace/camera_ray.h"

enum { ROUNDS = 3, SIDES = 4, COUNTS = 4 };

static const int      SIDE[SIDES]   = {256, 512, 1000, 1024};
static const uint32_t COUNT[COUNTS] = {1000, 4000, 10000, 50000};

static const double A = 0.25, WANTED = 10.0;

static assay_record_store *make_store(assay_context *context, uint32_t count)
{
    const assay_record_rules rules = {
        .a = A, .gradients = ASSAY_GRADIENTS_BOTH, .clamp_negative = true};
    const double        radius = bench_record_radius(count, A, WANTED);
    assay_random        random = assay_random_start(count, ASSAY_STAGE_TEST, 0, 0);
    assay_record_store *store  = NULL;
    bench_require(context,
                  assay_record_store_create(context, &rules, vec3(0.0, 0.0, 0.0),
                                            vec3(1.0, 1.0, 1.0), ASSAY_INDEX_OCTREE, &store));
    for (uint32_t i = 0; i < count; i++) {
        const bench_site   s      = bench_random_site(&random);
        const double       r      = radius * (0.7 + 0.6 * assay_random_next(&random));
        const assay_record record = {.position   = s.position,
                                     .normal     = s.normal,
                                     .radius     = r,
                                     .mean       = r,
                                     .nearest    = r,
                                     .irradiance = {1.0, 1.0, 1.0}};
        bench_require(context, assay_record_store_add(store, &record));
    }
    return store;
}

/* The wall that a ray from within leaves through. */
static bench_site leave(assay_vec3 origin, assay_vec3 direction)
{
    const double o[3] = {origin.x, origin.y, origin.z};
    const double d[3] = {direction.x, direction.y, direction.z};
    double       t    = INFINITY;
    int          axis = 0;
    for (int i = 0; i < 3; i++) {
        const double here = d[i] > 0.0 ? (1.0 - o[i]) / d[i] : d[i] < 0.0 ? -o[i] / d[i] : INFINITY;
        axis              = here < t ? i : axis;
        t                 = here < t ? here : t;
    }
    const double in = d[axis] > 0.0 ? -1.0 : 1.0;
    return (bench_site){vec3_mad(origin, t, direction),
                        vec3(axis == 0 ? in : 0.0, axis == 1 ? in : 0.0, axis == 2 ? in : 0.0)};
}

static assay_camera room_camera(void)
{
    const assay_frame3 f = frame3_from_z(vec3_normalize(vec3(0.3, 0.2, 0.9)));
    return (assay_camera){.position      = {0.7, 0.6, 0.9},
                          .right         = f.x,
                          .up            = f.y,
                          .forward       = vec3_negate(f.z),
                          .tan_half_yfov = 0.7};
}

static bench_site *make_points(int side)
{
    const assay_camera camera = room_camera();
    bench_site        *points = malloc((size_t)side * (size_t)side * sizeof *points);
    for (int i = 0; points && i < side * side; i++) {
        assay_vec3 origin, direction;
        assay_camera_ray(&camera, i % side + 0.5, i / side + 0.5, side, side, &origin, &direction);
        points[i] = leave(origin, direction);
    }
    return points ? points : (exit(1), NULL);
}

/* Milliseconds; sums so that nothing is left undone. */
typedef struct {
    double octree, splat, splat_only;
    double sum_octree, sum_splat;
} result;

static void ask_octree(const assay_record_store *store, const bench_site *points, int pixels,
                       result *r)
{
    assay_contributions found = {0};
    const double        start = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    r->sum_octree             = 0.0;
    for (int i = 0; i < pixels; i++) {
        if (assay_record_store_find(store, points[i].position, points[i].normal, UINT32_MAX,
                                    &found) != ASSAY_OK) {
            exit(1);
        }
        if (found.count > 0) {
            r->sum_octree +=
                assay_record_store_interpolate(store, &found, points[i].position, points[i].normal)
                    .g;
        }
    }
    r->octree = fmin(r->octree, 1e3 * (bench_seconds(CLOCK_THREAD_CPUTIME_ID) - start));
    assay_contributions_release(&found);
}

static void splat_all(assay_context *context, assay_splat_buffer *buffer,
                      const assay_record_store *store, int pixels, result *r)
{
    const assay_splat_source source = {.store = store, .rules = *assay_record_store_rules(store)};
    const double             start  = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    r->sum_splat                    = 0.0;
    bench_require(context, assay_splat_buffer_close(buffer));
    const double closed = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    bench_require(context,
                  assay_splat_records(buffer, &source, 0, assay_record_store_count(store)));
    for (int i = 0; i < pixels; i++) {
        r->sum_splat += assay_splat_mean(buffer, (size_t)i).g;
    }
    r->splat      = fmin(r->splat, 1e3 * (bench_seconds(CLOCK_THREAD_CPUTIME_ID) - start));
    r->splat_only = fmin(r->splat_only, 1e3 * (bench_seconds(CLOCK_THREAD_CPUTIME_ID) - closed));
}

static void measure(assay_context *context, int side, uint32_t count)
{
    const assay_camera  camera = room_camera();
    const int           pixels = side * side;
    assay_record_store *store  = make_store(context, count);
    bench_site         *points = make_points(side);
    assay_splat_buffer *buffer = NULL;
    result              r      = {INFINITY, INFINITY, INFINITY, 0.0, 0.0};
    bench_require(context, assay_splat_buffer_create(context, side, side, &buffer));
    assay_splat_buffer_look(buffer, &camera);
    for (int i = 0; i < pixels; i++) {
        assay_splat_buffer_set(buffer, (size_t)i, points[i].position, points[i].normal);
    }
    for (int round = 0; round < ROUNDS; round++) {
        ask_octree(store, points, pixels, &r);
        splat_all(context, buffer, store, pixels, &r);
    }
    if (fabs(r.sum_octree - r.sum_splat) > 1e-9 * r.sum_octree) {
        fprintf(stderr, "bench_splat: the images differ\n");
        exit(1);
    }
    printf("%5d x %-5d %8u %12.1f %12.1f %12.1f %10.2f\n", side, side, count, r.octree, r.splat,
           r.splat_only, r.octree / r.splat);
    assay_splat_buffer_destroy(buffer);
    assay_record_store_destroy(store);
    free(points);
}

int main(int count, char **argv)
{
    const assay_context_options options = {.threads = 1};
    assay_context              *context = NULL;
    if (assay_context_create(&options, &context) != ASSAY_OK) {
        return 1;
    }
    printf("%13s %8s %12s %12s %12s %10s\n", "pixels", "records", "octree, ms", "splat, ms",
           "of it adding", "octree/splat");
    for (int s = 0; s < SIDES && count < 3; s++) {
        for (int k = 0; k < COUNTS; k++) {
            measure(context, SIDE[s], COUNT[k]);
        }
    }
    if (count == 3) {
        measure(context, atoi(argv[1]), (uint32_t)atoi(argv[2]));
    }
    assay_context_destroy(context);
    return 0;
}
