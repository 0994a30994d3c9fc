/* verdict_power.c - the tables of docs/verdicts.md: how often `assay verify` says FAIL of images
 * that are the same light, and of images with a defect that was planted.
 *
 *     verdict_power [NULLS [PLANTED [RARE]]]     comparisons in all (10000), of each defect (1000),
 *                                                and of each row on light that is rarely found
 * (500)
 *
 * Images are drawn from pools of samples (tests/support/noise_pool.h): of our Cornell box, once as
 * path traces it by default and once with light found by scattered rays alone, which is full of
 * fireflies, and made-up ones. */
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assay/verify.h"
#include "core/parallel.h"
#include "support/noise_pool.h"

enum { SIDE = 48, TILE = 8 };
#define LEVEL 0.01

/* How the candidate's noise is known. */
typedef enum { OWN, RUNS, ALONE, ALLOWED, OWN_UNCOUNTED, RUNS_UNCOUNTED, ALONE_UNCOUNTED } way;
static const char *const WAYS[] = {"own variance",
                                   "4 runs",
                                   "alone",
                                   "allow 0.05",
                                   "own variance, no SampleCount",
                                   "4 runs, no SampleCount",
                                   "alone, no SampleCount"};

typedef struct {
    const noise_pool *candidate, *reference;
    int               samples, reference_samples;
    way               how;
    noise_defect      defect;
    uint64_t          first; /* number of the first image */
    atomic_int        failed, passed;
} experiment;

static void require(bool ok, const char *what)
{
    if (!ok) {
        fprintf(stderr, "verdict_power: %s\n", what);
        exit(1);
    }
}

static assay_status compare(void *user, uint64_t index, int worker)
{
    experiment                 *e         = user;
    const assay_context_options options   = {.threads = 1};
    const bool                  uncounted = e->how >= OWN_UNCOUNTED;
    const bool     bare    = e->how == ALONE || e->how == ALONE_UNCOUNTED || e->how == ALLOWED;
    const int      runs    = e->how == RUNS || e->how == RUNS_UNCOUNTED ? 4 : 1;
    assay_context *context = NULL;
    assay_image   *candidates[4], *reference;
    assay_verdict *verdict = NULL;
    require(assay_context_create(&options, &context) == ASSAY_OK, "a context");
    const uint64_t number = e->first + index * 8;
    for (int k = 0; k < runs; k++) {
        candidates[k] =
            noise_pool_draw(context, e->candidate, e->samples, number + (uint64_t)k, e->defect);
        candidates[k] = noise_pool_without(context, candidates[k], bare, uncounted);
        require(candidates[k] != NULL, "an image");
    }
    reference =
        noise_pool_draw(context, e->reference, e->reference_samples, number + 7, DEFECT_NONE);
    assay_verify_options how = assay_verify_options_default();
    how.tile                 = TILE;
    how.level                = LEVEL;
    how.allow                = e->how == ALLOWED ? 0.05 : NAN;
    require(assay_verdict_create(context, "candidate", "reference", &verdict) == ASSAY_OK &&
                assay_verify_images((const assay_image *const *)candidates, runs, reference, &how,
                                    verdict) == ASSAY_OK,
            assay_context_error(context));
    const assay_verdict_kind kind = assay_verdict_whole(verdict);
    atomic_fetch_add(&e->failed, kind == ASSAY_VERDICT_FAIL);
    atomic_fetch_add(&e->passed, kind == ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
    for (int k = 0; k < runs; k++) {
        assay_image_destroy(candidates[k]);
    }
    assay_image_destroy(reference);
    assay_context_destroy(context);
    (void)worker;
    return ASSAY_OK;
}

static bool show(void *user, const char *phase, double fraction)
{
    if (isatty(STDERR_FILENO) && phase) {
        fprintf(stderr, "\r%s %3.0f %% ", (const char *)user, 100.0 * fraction);
    }
    return true;
}

static void run(assay_context *context, experiment *e, uint64_t count)
{
    require(assay_parallel_for(context, "compare", count, compare, e) == ASSAY_OK, "a comparison");
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r\033[K");
    }
}

/* ---- the two tables ---- */

typedef struct {
    noise_pool *mis, *bsdf, *mis_many, *bounces_many, *made[NOISE_KINDS];
} pools;

static void tell_nulls(assay_context *context, const pools *p, uint64_t total)
{
    const struct {
        const char       *name;
        const noise_pool *candidate, *reference;
        int               samples, reference_samples;
        way               how;
    } rows[] = {
        {"Cornell box", p->mis, p->mis, 16, 256, OWN},
        {"Cornell box", p->mis, p->mis, 64, 64, OWN},
        {"Cornell box", p->mis, p->mis, 4, 256, OWN},
        {"Cornell box", p->mis, p->mis, 256, 16, OWN},
        {"Cornell box, many samples", p->mis_many, p->mis_many, 64, 256, OWN},
        {"the same, fireflies", p->bsdf, p->bsdf, 16, 256, OWN},
        {"normal", p->made[NOISE_GAUSS], p->made[NOISE_GAUSS], 3, 3, OWN},
        {"normal, elsewhere than the reference's", p->made[NOISE_ELSEWHERE], p->made[NOISE_GAUSS],
         4, 64, OWN},
        {"log-normal", p->made[NOISE_LOGNORMAL], p->made[NOISE_LOGNORMAL], 16, 256, OWN},
        {"rare and bright", p->made[NOISE_RARE], p->made[NOISE_RARE], 16, 256, OWN},
        {"fireflies, the reference without", p->bsdf, p->mis, 16, 256, OWN},
        {"Cornell box", p->mis, p->mis, 16, 256, RUNS},
        {"rare and bright", p->made[NOISE_RARE], p->made[NOISE_RARE], 16, 256, RUNS},
        {"Cornell box", p->mis, p->mis, 16, 256, ALONE},
        {"rare and bright", p->made[NOISE_RARE], p->made[NOISE_RARE], 16, 256, ALONE},
    };
    enum { ROWS = sizeof rows / sizeof rows[0] };
    const uint64_t each = (total + ROWS - 1) / ROWS;
    uint64_t       all  = 0;
    printf("| noise | samples | of the reference | candidate's noise | comparisons | FAIL |\n"
           "|---|---|---|---|---|---|\n");
    for (int i = 0; i < ROWS; i++) {
        experiment e = {.candidate         = rows[i].candidate,
                        .reference         = rows[i].reference,
                        .samples           = rows[i].samples,
                        .reference_samples = rows[i].reference_samples,
                        .how               = rows[i].how,
                        .first             = (uint64_t)(i + 1) << 32};
        run(context, &e, each);
        printf("| %s | %d | %d | %s | %llu | %d |\n", rows[i].name, e.samples, e.reference_samples,
               WAYS[e.how], (unsigned long long)each, (int)e.failed);
        fflush(stdout);
        all += (uint64_t)e.failed;
    }
    printf("| all | | | | %llu | %llu |\n\n", (unsigned long long)(each * ROWS),
           (unsigned long long)all);
}

static void tell_planted(assay_context *context, const pools *p, uint64_t count)
{
    static const struct {
        int samples, reference_samples;
        way how;
        int share; /* of the comparisons, one in so many */
    } COLUMN[] = {{16, 64, OWN, 1}, {64, 128, OWN, 1}, {16, 128, RUNS, 4}, {64, 128, ALONE, 4}};
    enum { COLUMNS = sizeof COLUMN / sizeof COLUMN[0] };
    printf("| defect |");
    for (int c = 0; c < COLUMNS; c++) {
        printf(" %d of %d, %s |", 16 * COLUMN[c].samples, 16 * COLUMN[c].reference_samples,
               WAYS[COLUMN[c].how]);
    }
    printf("\n|---|---|---|---|---|\n");
    for (int d = 1; d < DEFECT_COUNT; d++) {
        printf("| %s |", noise_defect_names[d]);
        for (int c = 0; c < COLUMNS; c++) {
            experiment     e = {.candidate = d == DEFECT_BOUNCE ? p->bounces_many : p->mis_many,
                                .reference = p->mis_many,
                                .samples   = COLUMN[c].samples,
                                .reference_samples = COLUMN[c].reference_samples,
                                .how               = COLUMN[c].how,
                                .defect            = (noise_defect)d,
                                .first             = (uint64_t)(1000 + d * 10 + c) << 32};
            const uint64_t compared = (count - 1) / (uint64_t)COLUMN[c].share + 1;
            run(context, &e, compared);
            printf(" %.1f |", 100.0 * e.failed / (double)compared);
            fflush(stdout);
        }
        printf("\n");
    }
}

/* Light that few samples find: missed by chance, which is no error, and missed altogether. */
static void tell_rare(assay_context *context, uint64_t count)
{
    static const struct {
        int samples, reference_samples;
        way how;
    } rows[] = {{4, 256, OWN},
                {16, 256, OWN},
                {64, 256, OWN},
                {256, 1024, OWN},
                {4, 256, RUNS},
                {16, 256, RUNS},
                {64, 256, RUNS},
                {4, 256, OWN_UNCOUNTED},
                {16, 256, OWN_UNCOUNTED},
                {64, 256, OWN_UNCOUNTED},
                {4, 256, RUNS_UNCOUNTED},
                {16, 256, RUNS_UNCOUNTED},
                {64, 256, RUNS_UNCOUNTED},
                {4, 256, ALONE},
                {16, 256, ALONE},
                {64, 256, ALONE},
                {256, 1024, ALONE},
                {4, 256, ALONE_UNCOUNTED},
                {16, 256, ALONE_UNCOUNTED},
                {64, 256, ALONE_UNCOUNTED},
                {256, 1024, ALONE_UNCOUNTED}};
    enum { ROWS = sizeof rows / sizeof rows[0] };
    static const int rare[] = {128, 1024};
    noise_pool      *pools_of[2][2]; /* rarity, and whether the light is missing */
    printf("\n| candidate's noise | samples | of the reference |");
    for (int k = 0; k < 2; k++) {
        pools_of[k][0] = noise_pool_of_rare_light(SIDE, rare[k], true);
        pools_of[k][1] = noise_pool_of_rare_light(SIDE, rare[k], false);
        printf(" 1 in %d: same light | without it |", rare[k]);
    }
    printf("\n|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < ROWS; i++) {
        printf("| %s | %d | %d |", WAYS[rows[i].how], rows[i].samples, rows[i].reference_samples);
        for (int k = 0; k < 4; k++) {
            experiment e = {.candidate         = pools_of[k / 2][k % 2],
                            .reference         = pools_of[k / 2][0],
                            .samples           = rows[i].samples,
                            .reference_samples = rows[i].reference_samples,
                            .how               = rows[i].how,
                            .first = (uint64_t)(3000 + 4 * rare[k / 2] + 2 * i + k % 2) << 32};
            run(context, &e, count);
            printf(" %.1f |", 100.0 * e.failed / (double)count);
            fflush(stdout);
        }
        printf("\n");
    }
    for (int k = 0; k < 4; k++) {
        noise_pool_free(pools_of[k / 2][k % 2]);
    }
}

/* What takes renders. */
static void tell_rendered(assay_context *context, uint64_t nulls, uint64_t planted)
{
    assay_scene *scene = NULL;
    require(assay_scene_load(context, "scenes/cornell-box/cornell-box.gltf", NULL, &scene) ==
                ASSAY_OK,
            assay_context_error(context));
    pools       p   = {.mis  = noise_pool_render(context, scene, SIDE, NULL, NULL),
                       .bsdf = noise_pool_render(context, scene, SIDE, "estimator", "bsdf")};
    noise_pool *few = noise_pool_render(context, scene, SIDE, "bounces", "5");
    p.mis_many      = noise_pool_batches(p.mis, 16);
    p.bounces_many  = noise_pool_batches(few, 16);
    for (int k = 0; k < NOISE_KINDS; k++) {
        p.made[k] = noise_pool_made_up((noise_kind)k, SIDE);
    }
    noise_pool_match(p.made[NOISE_ELSEWHERE], p.made[NOISE_GAUSS]);
    noise_pool_match(p.bsdf, p.mis);
    if (nulls > 0) {
        tell_nulls(context, &p, nulls);
    }
    if (planted > 0) {
        tell_planted(context, &p, planted);
    }
    for (int k = 0; k < NOISE_KINDS; k++) {
        noise_pool_free(p.made[k]);
    }
    noise_pool_free(p.mis);
    noise_pool_free(p.bsdf);
    noise_pool_free(few);
    noise_pool_free(p.mis_many);
    noise_pool_free(p.bounces_many);
    assay_scene_destroy(scene);
}

int main(int argc, char **argv)
{
    const uint64_t              nulls   = argc > 1 ? strtoull(argv[1], NULL, 10) : 10000;
    const uint64_t              planted = argc > 2 ? strtoull(argv[2], NULL, 10) : 1000;
    const uint64_t              rare    = argc > 3 ? strtoull(argv[3], NULL, 10) : 500;
    const assay_context_options options = {.progress = show, .user = "verdict_power"};
    assay_context              *context = NULL;
    require(assay_context_create(&options, &context) == ASSAY_OK, "a context");
    if (nulls > 0 || planted > 0) {
        tell_rendered(context, nulls, planted);
    }
    if (rare > 0) {
        tell_rare(context, rare);
    }
    assay_context_destroy(context);
    return 0;
}
