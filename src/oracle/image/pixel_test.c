/* pixel_test.c - a row is an item of a parallel loop and has its own list of small p; lists are
 * joined in the order of rows.
 *
 * Invariant: a p is computed only where it may be small, and that changes no answer.  The tail of
 * Student's t beyond 2 is no lighter than the normal one, so a |t| below the normal quantile of the
 * level cannot reject. */
#include "oracle/image/pixel_test.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "math/select.h"
#include "oracle/image/student.h"

/* Pixels from which the medians are taken, at most. */
enum { SAMPLE = 4096 };

/* A firefly's variance is so many times what the other image lets expect, and its difference as
 * many standard deviations as the root of that / 2. */
#define FIREFLY_VARIANCE 100.0
#define FIREFLY_DIFFERENCE 5.0

typedef struct {
    assay_multiple_tests tests;
    size_t               worst;
    double               worst_t;
    assay_fireflies      candidate, reference;
} row_result;

typedef struct {
    assay_context           *context;
    const assay_noisy_pair  *pair;
    const assay_noise_model *model;
    uint64_t                 first_item;
    double                   least_t;
    double                   level;
    row_result              *rows;
} pixel_job;

static void count_firefly(assay_fireflies *flies, size_t pixel, double difference, double variance,
                          double usual, double other)
{
    if (usual > 0.0 && variance > FIREFLY_VARIANCE * usual &&
        difference > FIREFLY_DIFFERENCE * sqrt(usual + other)) {
        flies->count++;
        flies->excess += difference;
        if (difference > flies->worst_difference) {
            flies->worst            = pixel;
            flies->worst_difference = difference;
        }
    }
}

static void look_for_fireflies(const assay_local_noise *local, const assay_noisy_sums *s,
                               size_t pixel, row_result *row)
{
    count_firefly(&row->candidate, pixel, s->difference, s->candidate_variance,
                  fmax(local->up * s->reference_variance, local->candidate), s->reference_variance);
    count_firefly(&row->reference, pixel, -s->difference, s->reference_variance,
                  fmax(local->down * s->candidate_variance, local->reference),
                  s->candidate_variance);
}

/* Whether three views alone, the quick ones, show that the pixel is neither the row's worst nor to
 * be rejected: the variance of all views is no less.  That is so of most. */
static bool is_ordinary(const pixel_job *job, const row_result *row, const assay_local_noise *local,
                        const assay_noisy_sums *s, double size)
{
    const double t        = fmin(job->least_t, row->worst_t) * (1.0 - 1e-9);
    const double c        = fmax(s->candidate_variance, local->candidate);
    const double r        = fmax(s->reference_variance, local->reference);
    const double variance = fmax(s->reference_variance + c, s->candidate_variance + r);
    return !(size > 0.0) || size * size < t * t * variance;
}

static void test_pixel(const pixel_job *job, row_result *row, size_t pixel, double size)
{
    const assay_noise noise = assay_noise_of_pixel(job->model, job->pair, pixel);
    const double      sd    = sqrt(assay_noise_variance(&noise));
    const double      t     = size > 0.0 ? size / sd : 0.0;
    if (t > row->worst_t) {
        row->worst   = pixel;
        row->worst_t = t;
    }
    if (t < job->least_t) {
        assay_multiple_tests_add_large(&row->tests, 1);
    } else {
        assay_multiple_tests_add(&row->tests, assay_noise_log_p(&noise, size),
                                 job->first_item + pixel);
    }
}

static assay_status test_row(void *user, uint64_t index, int worker)
{
    const pixel_job *job   = user;
    row_result      *row   = &job->rows[index];
    const size_t     width = (size_t)job->pair->width;
    row->tests             = assay_multiple_tests_start(job->context, job->level);
    row->worst             = index * width;
    uint64_t ordinary      = 0;
    for (size_t x = 0; x < width; x++) {
        const size_t             pixel = index * width + x;
        const assay_noisy_sums   sums  = assay_noisy_pixel(job->pair, pixel);
        const double             size  = assay_noisy_size(&sums);
        const assay_local_noise *local = assay_noise_near(job->model, (int)x, (int)index);
        if (is_ordinary(job, row, local, &sums, size)) {
            ordinary++;
        } else {
            test_pixel(job, row, pixel, size);
        }
        look_for_fireflies(local, &sums, pixel, row);
    }
    assay_multiple_tests_add_large(&row->tests, ordinary);
    (void)worker;
    return row->tests.failed ? ASSAY_ERR_MEMORY : ASSAY_OK;
}

static void join_flies(assay_fireflies *all, const assay_fireflies *more)
{
    all->count += more->count;
    all->excess += more->excess;
    if (more->worst_difference > all->worst_difference) {
        all->worst            = more->worst;
        all->worst_difference = more->worst_difference;
    }
}

static void join_rows(const pixel_job *job, assay_multiple_tests *tests, assay_pixel_result *result)
{
    for (int y = 0; y < job->pair->height; y++) {
        const row_result *row = &job->rows[y];
        assay_multiple_tests_append(tests, &row->tests);
        if (row->worst_t > result->worst_t) {
            result->worst   = row->worst;
            result->worst_t = row->worst_t;
        }
        join_flies(&result->candidate, &row->candidate);
        join_flies(&result->reference, &row->reference);
    }
}

/* The median over pixels that lie evenly in the image. */
static assay_status find_typical(const pixel_job *job, assay_pixel_result *result)
{
    const size_t pixels = (size_t)job->pair->width * (size_t)job->pair->height;
    const size_t count  = pixels < SAMPLE ? pixels : SAMPLE;
    double      *all    = assay_allocate(job->context, 2 * count, sizeof *all);
    if (!all) {
        return assay_fail_memory(job->context, "the medians of noise");
    }
    for (size_t i = 0; i < count; i++) {
        const assay_noise noise = assay_noise_of_pixel(job->model, job->pair, i * (pixels / count));
        all[i] = all[count + i] = assay_noise_variance(&noise);
    }
    const double median = assay_select(all, count, count / 2);
    for (size_t i = 0; i < count; i++) {
        result->typical = all[count + i] == median ? i * (pixels / count) : result->typical;
    }
    assay_release(job->context, all);
    return ASSAY_OK;
}

assay_status assay_pixel_test(assay_context *context, const assay_noisy_pair *pair,
                              const assay_noise_model *model, uint64_t first_item,
                              assay_multiple_tests *tests, assay_pixel_result *result_out)
{
    pixel_job job = {
        .context    = context,
        .pair       = pair,
        .model      = model,
        .first_item = first_item,
        .least_t = fmax(2.0, assay_student_quantile(tests->log_level, ASSAY_NORMAL) * (1 - 1e-9)),
        .level   = tests->level,
        .rows    = assay_allocate(context, (size_t)pair->height, sizeof *job.rows)};
    if (!job.rows) {
        return assay_fail_memory(context, "the tests of pixels");
    }
    assay_pixel_result result = {0};
    assay_status       status =
        assay_parallel_for(context, "verify", (uint64_t)pair->height, test_row, &job);
    if (status == ASSAY_OK) {
        join_rows(&job, tests, &result);
        status = tests->failed ? ASSAY_ERR_MEMORY : find_typical(&job, &result);
    }
    for (int y = 0; y < pair->height; y++) {
        assay_multiple_tests_end(&job.rows[y].tests);
    }
    assay_release(context, job.rows);
    if (status == ASSAY_ERR_MEMORY) {
        return assay_fail_memory(context, "the tests of pixels");
    }
    if (status == ASSAY_OK) {
        *result_out = result;
    }
    return status;
}
