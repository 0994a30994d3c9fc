/* verify_judge.c - tests of all channels in three classes, each with a third of the level.
 *
 * Invariant: every test that may say FAIL is in one of the classes, and a class says FAIL of equal
 * light with at most its share of the level, however its tests depend on one another; so all of
 * them together hold the level.  Which rule corrects matters for pixels alone: tiles and the whole
 * are few. */
#include "oracle/image/verify_judge.h"

#include "core/context.h"
#include "core/numerics.h"
#include "oracle/image/student.h"

bool assay_judge_equivalence(const assay_verify_options *options)
{
    return !isnan(options->allow) || !isnan(options->allow_absolute);
}

assay_judgement assay_judgement_start(assay_context *context, const assay_verify_options *options,
                                      assay_verify_channel *channels, int count)
{
    const double    share = options->level / ASSAY_CLASS_COUNT;
    assay_judgement j     = {
            .context = context, .options = options, .channels = channels, .count = count};
    j.pixels.tests = assay_multiple_tests_start(context, share);
    j.tiles.tests  = assay_multiple_tests_start(context, share);
    j.whole.tests  = assay_multiple_tests_start(context, share);
    return j;
}

void assay_judgement_end(assay_judgement *judgement)
{
    assay_multiple_tests_end(&judgement->pixels.tests);
    assay_multiple_tests_end(&judgement->tiles.tests);
    assay_multiple_tests_end(&judgement->whole.tests);
}

/* A region's mean may be dark: then a tenth of the image's mean stands for it. */
double assay_judge_allowance(const assay_judgement *judgement, const assay_verify_channel *channel,
                             const assay_noisy_sums *sums)
{
    const assay_verify_options *o     = judgement->options;
    const assay_noisy_sums     *whole = &channel->sums.whole;
    const double floor_of             = 0.1 * fabs(whole->reference) * sums->pixels / whole->pixels;
    const double relative =
        isnan(o->allow) ? 0.0 : o->allow * fmax(fabs(sums->reference), floor_of);
    const double absolute = isnan(o->allow_absolute) ? 0.0 : o->allow_absolute * sums->pixels;
    return relative + absolute;
}

/* log p of the region's test: of any difference, or of one beyond the allowance. */
static double region_log_p(const assay_judgement *judgement, const assay_verify_channel *channel,
                           int level, const assay_noisy_sums *sums)
{
    const assay_noise noise = assay_verify_channel_noise(channel, level, sums);
    if (!assay_judge_equivalence(judgement->options)) {
        return assay_noise_log_p(&noise, assay_noisy_size(sums));
    }
    const double beyond = fabs(sums->difference) - assay_judge_allowance(judgement, channel, sums);
    return beyond > 0.0 ? assay_noise_log_p_one_sided(&noise, beyond) : 0.0;
}

assay_status assay_judge_channel(assay_judgement *judgement, int channel)
{
    assay_verify_channel *c      = &judgement->channels[channel];
    assay_status          status = ASSAY_OK;
    if (c->source != ASSAY_NOISE_RUNS) {
        c->neighbours = assay_neighbours_of(&c->pair);
    }
    if (!assay_judge_equivalence(judgement->options)) {
        assay_multiple_tests apart =
            assay_multiple_tests_start(judgement->context, judgement->pixels.tests.level);
        /* Without a variance of its own a firefly is no finding: its tests decide nothing. */
        assay_multiple_tests *into =
            c->source == ASSAY_NOISE_ALONE ? &apart : &judgement->pixels.tests;
        status = assay_pixel_test(judgement->context, &c->pair, &c->model,
                                  assay_test_item(channel, 0, 0), into, &c->pixels);
        assay_multiple_tests_end(&apart);
    }
    for (int l = 0; l < c->sums.level_count; l++) {
        for (size_t i = 0; i < c->sums.levels[l].count; i++) {
            assay_multiple_tests_add(&judgement->tiles.tests,
                                     region_log_p(judgement, c, l, &c->sums.levels[l].sums[i]),
                                     assay_test_item(channel, l, i));
        }
    }
    assay_multiple_tests_add(&judgement->whole.tests,
                             region_log_p(judgement, c, ASSAY_TILE_LEVELS, &c->sums.whole),
                             assay_test_item(channel, ASSAY_TILE_LEVELS, 0));
    return status;
}

/* Power of what is called visible: the two-sided level whose upper quantile is that of 0.1 on one
 * side. */
#define POWER_LOG_P assay_log(2.0 * (1.0 - 0.9))

static assay_status decide(assay_judgement *j)
{
    assay_status status =
        assay_multiple_tests_decide(&j->pixels.tests, j->options->correction, &j->pixels.decision);
    status                            = status != ASSAY_OK ? status
                                                           : assay_multiple_tests_decide(
                                                                 &j->tiles.tests, ASSAY_CORRECTION_HOLM, &j->tiles.decision);
    status                            = status != ASSAY_OK ? status
                                                           : assay_multiple_tests_decide(
                                                                 &j->whole.tests, ASSAY_CORRECTION_HOLM, &j->whole.decision);
    assay_test_class *const classes[] = {&j->pixels, &j->tiles, &j->whole};
    for (int i = 0; status == ASSAY_OK && i < ASSAY_CLASS_COUNT; i++) {
        classes[i]->critical = assay_critical_values_at(classes[i]->decision.log_bound);
    }
    j->power  = assay_critical_values_at(POWER_LOG_P);
    j->within = assay_critical_values_at(assay_log(2.0 * j->options->level));
    return status;
}

static assay_status add_channel(assay_judgement *j, int channel, assay_verdict *verdict)
{
    const assay_verify_channel *c = &j->channels[channel];
    if (c->problem) {
        return assay_judge_add_problem(c, verdict);
    }
    const bool   equivalence = assay_judge_equivalence(j->options);
    assay_status status      = equivalence
                                   ? assay_judge_add_equivalence(j, channel, ASSAY_TILE_LEVELS, verdict)
                                   : assay_judge_add_whole(j, channel, verdict);
    for (int l = c->sums.level_count - 1; status == ASSAY_OK && l >= 0; l--) {
        status = equivalence ? assay_judge_add_equivalence(j, channel, l, verdict)
                             : assay_judge_add_tiles(j, channel, l, verdict);
    }
    return status == ASSAY_OK && !equivalence ? assay_judge_add_pixels(j, channel, verdict)
                                              : status;
}

assay_status assay_judge(assay_judgement *judgement, assay_verdict *verdict)
{
    assay_status status = decide(judgement);
    for (int i = 0; status == ASSAY_OK && i < judgement->count; i++) {
        status = add_channel(judgement, i, verdict);
    }
    return status;
}
