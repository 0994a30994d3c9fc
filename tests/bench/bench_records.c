/* bench_records.c - what a query of the records costs, against their number.
 *
 *     bench_records
 *
 * Records are spread at random over the walls of a room, with radii such that some ten contribute
 * at a point, whatever their number.  Each kind of query is timed against the same kind on the
 * smallest store, in turns, on one thread, by processor time: along lines, as an image asks, and at
 * random places, where each query finds its records far from those of the one before, so that the
 * machine's memory is measured as well. */
#include <stdio.h>

#include "bench/bench.h"
#include "bench/bench_walls.h"
#include "core/numerics.h"
#include "core/random.h"
#include "record/record_store.h"

enum { QUERIES = 1 << 15, ROUNDS = 5, SIZES = 6, LIST_SIZES = 3 };

static const uint32_t SIZE[SIZES] = {1000, 3000, 10000, 30000, 100000, 300000};

static const double A = 0.25, WANTED = 10.0;

static assay_record_store *make_store(assay_context *context, uint32_t count,
                                      assay_record_index index, double grown)
{
    const assay_record_rules rules  = {.a = A, .gradients = ASSAY_GRADIENTS_BOTH, .in_front = true};
    assay_random             random = assay_random_start(count, ASSAY_STAGE_TEST, 0, 0);
    assay_record_store      *store  = NULL;
    if (assay_record_store_create(context, &rules, vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0), index,
                                  &store) != ASSAY_OK) {
        bench_stop(assay_context_error(context));
    }
    const double radius = bench_record_radius(count, A, WANTED);
    for (uint32_t i = 0; i < count; i++) {
        const bench_site   s      = bench_random_site(&random);
        const double       r      = radius * (0.7 + 0.6 * assay_random_next(&random));
        const assay_record record = {.position = s.position,
                                     .normal   = s.normal,
                                     .radius   = r * grown,
                                     .mean     = r,
                                     .nearest  = r};
        if (assay_record_store_add(store, &record) != ASSAY_OK) {
            bench_stop(assay_context_error(context));
        }
        if (grown > 1.0) {
            assay_record_store_shrink(store, i, r);
        }
    }
    return store;
}

/* Either 2^15 sites at random, or 128 lines of 256 that wander over a plane. */
static void make_queries(bench_site *queries, bool lines)
{
    assay_random random = assay_random_start(1, ASSAY_STAGE_TEST, 1, 0);
    for (int i = 0; i < QUERIES; i++) {
        queries[i] = bench_random_site(&random);
        if (lines && i % 256) {
            const bench_site *before = &queries[i - 1];
            const assay_vec3  n      = before->normal;
            const assay_vec3  along  = vec3_cross(n, vec3(0.6 * n.y, 0.6 * n.z, 0.6 * n.x));
            queries[i]               = *before;
            queries[i].position      = vec3_mad(before->position, 0.001, along);
        }
    }
}

typedef struct {
    double nanoseconds; /* a query; the least of the rounds */
    double found, weight;
} result;

static void run(const assay_record_store *store, const bench_site *queries, int count,
                assay_contributions *list, result *r)
{
    size_t       found  = 0;
    double       weight = 0.0;
    const double start  = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (int i = 0; i < count; i++) {
        if (assay_record_store_find(store, queries[i].position, queries[i].normal, UINT32_MAX,
                                    list) != ASSAY_OK) {
            bench_stop("out of memory");
        }
        found += list->count;
        weight += list->weight;
    }
    const double nanoseconds = 1e9 * (bench_seconds(CLOCK_THREAD_CPUTIME_ID) - start) / count;
    r->nanoseconds = r->nanoseconds > 0.0 ? fmin(r->nanoseconds, nanoseconds) : nanoseconds;
    r->found       = (double)found / count;
    r->weight      = weight;
}

static void measure(assay_record_store *const stores[], int sizes, const bench_site *queries,
                    int count, const char *what)
{
    result              r[SIZES] = {{0}};
    assay_contributions list     = {0};
    for (int round = 0; round < ROUNDS; round++) {
        for (int k = 0; k < sizes; k++) {
            run(stores[k], queries, count, &list, &r[k]);
        }
    }
    for (int k = 0; k < sizes; k++) {
        const double n = SIZE[k];
        printf("%-24s %8.0f %8.1f %9.0f %8.2f %8.2f %8.0f\n", what, n, r[k].found, r[k].nanoseconds,
               r[k].nanoseconds / r[0].nanoseconds, assay_log(n) / assay_log(SIZE[0]), n / SIZE[0]);
    }
    assay_contributions_release(&list);
}

static void destroy(assay_record_store *stores[], int count)
{
    for (int k = 0; k < count; k++) {
        assay_record_store_destroy(stores[k]);
    }
}

int main(void)
{
    assay_context      *context = NULL;
    static bench_site   lines[QUERIES], random[QUERIES];
    assay_record_store *octree[SIZES], *shrunk[SIZES], *list[LIST_SIZES];
    if (assay_context_create(NULL, &context) != ASSAY_OK) {
        bench_stop("cannot make a context");
    }
    make_queries(lines, true);
    make_queries(random, false);
    for (int k = 0; k < SIZES; k++) {
        const double start = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
        octree[k]          = make_store(context, SIZE[k], ASSAY_INDEX_OCTREE, 1.0);
        const double bytes = (double)assay_record_store_bytes(octree[k]);
        printf("%u records: made in %.0f ns each, %.0f bytes each (%zu of them the record)\n",
               SIZE[k], 1e9 * (bench_seconds(CLOCK_THREAD_CPUTIME_ID) - start) / SIZE[k],
               bytes / SIZE[k], sizeof(assay_record));
        shrunk[k] = make_store(context, SIZE[k], ASSAY_INDEX_OCTREE, 16.0);
        if (k < LIST_SIZES) {
            list[k] = make_store(context, SIZE[k], ASSAY_INDEX_LIST, 1.0);
        }
    }
    printf("\n%-24s %8s %8s %9s %8s %8s %8s\n", "", "records", "found", "ns/query", "ratio", "log",
           "linear");
    measure(octree, SIZES, lines, QUERIES, "octree, along lines");
    measure(octree, SIZES, random, QUERIES, "octree, at random");
    measure(shrunk, SIZES, random, QUERIES, "octree, shrunk by 16");
    measure(list, LIST_SIZES, random, QUERIES / 64, "list");
    destroy(octree, SIZES);
    destroy(shrunk, SIZES);
    destroy(list, LIST_SIZES);
    assay_context_destroy(context);
    return 0;
}
