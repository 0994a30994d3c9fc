/* verdict.c - the list of findings, and what they amount to.
 *
 * Invariant: findings keep the order in which they were added; each owns copies of its texts. */
#include "assay/verdict.h"

#include <math.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "oracle/verdict/verdict_data.h"

assay_finding assay_finding_default(void)
{
    return (assay_finding){.kind      = ASSAY_VERDICT_PASS,
                           .candidate = NAN,
                           .reference = NAN,
                           .effect    = NAN,
                           .bound     = NAN,
                           .in_bounds = NAN,
                           .ulps      = NAN,
                           .p         = NAN,
                           .log_p     = NAN,
                           .visible   = NAN,
                           .width     = NAN,
                           .width_90  = NAN};
}

assay_place assay_place_row(uint64_t row, int column)
{
    return (assay_place){.kind = ASSAY_PLACE_ROW, .row = row, .column = column};
}

assay_place assay_place_pixel(int x, int y)
{
    return (assay_place){.kind = ASSAY_PLACE_PIXEL, .x = x, .y = y, .width = 1, .height = 1};
}

assay_place assay_place_tile(int x, int y, int width, int height)
{
    return (assay_place){
        .kind = ASSAY_PLACE_TILE, .x = x, .y = y, .width = width, .height = height};
}

static void release_finding(assay_context *context, const assay_finding *f)
{
    const char *const texts[] = {f->stage, f->array, f->channel, f->test, f->meaning};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assay_release(context, (void *)texts[i]);
    }
}

/* A copy that owns its texts; what is NULL stays so. */
static assay_status copy_finding(assay_context *context, const assay_finding *from,
                                 assay_finding *to_out)
{
    assay_finding      to     = *from;
    const char **const mine[] = {&to.stage, &to.array, &to.channel, &to.test, &to.meaning};
    bool               ok     = true;
    for (size_t i = 0; i < sizeof mine / sizeof mine[0]; i++) {
        const char *text = *mine[i];
        *mine[i]         = text && ok ? assay_copy_text(context, text) : NULL;
        ok               = ok && (!text || *mine[i]);
    }
    if (!ok) {
        release_finding(context, &to);
        return assay_fail_memory(context, "a finding");
    }
    *to_out = to;
    return ASSAY_OK;
}

assay_status assay_verdict_create(assay_context *context, const char *candidate,
                                  const char *reference, assay_verdict **verdict_out)
{
    assay_verdict *verdict = assay_allocate(context, 1, sizeof *verdict);
    if (!verdict) {
        return assay_fail_memory(context, "a verdict");
    }
    verdict->context   = context;
    verdict->candidate = assay_copy_text(context, candidate);
    verdict->reference = assay_copy_text(context, reference);
    if (!verdict->candidate || !verdict->reference) {
        assay_verdict_destroy(verdict);
        return assay_fail_memory(context, "a verdict");
    }
    *verdict_out = verdict;
    return ASSAY_OK;
}

void assay_verdict_destroy(assay_verdict *verdict)
{
    if (!verdict) {
        return;
    }
    assay_context *context = verdict->context;
    for (size_t i = 0; i < verdict->count; i++) {
        release_finding(context, &verdict->findings[i]);
    }
    for (size_t i = 0; i < verdict->setting_count; i++) {
        assay_release(context, verdict->settings[i].key);
        assay_release(context, verdict->settings[i].value);
    }
    assay_release(context, verdict->findings);
    assay_release(context, verdict->settings);
    assay_release(context, verdict->candidate);
    assay_release(context, verdict->reference);
    assay_release(context, verdict);
}

static bool empty(const char *text) { return !text || !*text; }

assay_status assay_verdict_add(assay_verdict *verdict, const assay_finding *finding)
{
    if (empty(finding->stage) || empty(finding->array) || empty(finding->test)) {
        return assay_fail(verdict->context, ASSAY_ERR_ARGUMENT,
                          "a finding names its stage, its array and its test");
    }
    if (finding->kind != ASSAY_VERDICT_PASS && finding->kind != ASSAY_VERDICT_FAIL &&
        finding->kind != ASSAY_VERDICT_CANNOT_TELL) {
        return assay_fail(verdict->context, ASSAY_ERR_ARGUMENT,
                          "a finding passes, fails or cannot tell");
    }
    assay_finding copy;
    assay_status  status = copy_finding(verdict->context, finding, &copy);
    if (status != ASSAY_OK) {
        return status;
    }
    status = assay_grow(verdict->context, (void **)&verdict->findings, &verdict->capacity,
                        verdict->count + 1, sizeof *verdict->findings);
    if (status != ASSAY_OK) {
        release_finding(verdict->context, &copy);
        return assay_fail_memory(verdict->context, "a finding");
    }
    verdict->findings[verdict->count++] = copy;
    return ASSAY_OK;
}

assay_status assay_verdict_mean(assay_verdict *verdict, size_t index, const char *meaning)
{
    assay_finding *f    = &verdict->findings[index];
    char          *copy = assay_copy_text(verdict->context, meaning);
    if (!copy) {
        return assay_fail_memory(verdict->context, "a finding");
    }
    assay_release(verdict->context, (void *)f->meaning);
    f->meaning = copy;
    return ASSAY_OK;
}

void assay_verdict_truncate(assay_verdict *verdict, int count)
{
    while (verdict->count > (size_t)count) {
        release_finding(verdict->context, &verdict->findings[--verdict->count]);
    }
}

static assay_verdict_setting *find_setting(const assay_verdict *verdict, const char *key)
{
    for (size_t i = 0; i < verdict->setting_count; i++) {
        if (strcmp(verdict->settings[i].key, key) == 0) {
            return &verdict->settings[i];
        }
    }
    return NULL;
}

assay_status assay_verdict_set(assay_verdict *verdict, const char *key, const char *value)
{
    assay_context *context = verdict->context;
    if (empty(key)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "a setting of a verdict has a name");
    }
    char                  *copy = assay_copy_text(context, value);
    assay_verdict_setting *old  = find_setting(verdict, key);
    if (copy && old) {
        assay_release(context, old->value);
        old->value = copy;
        return ASSAY_OK;
    }
    char *name = copy ? assay_copy_text(context, key) : NULL;
    if (!name || assay_grow(context, (void **)&verdict->settings, &verdict->setting_capacity,
                            verdict->setting_count + 1, sizeof *verdict->settings) != ASSAY_OK) {
        assay_release(context, name);
        assay_release(context, copy);
        return assay_fail_memory(context, "a setting of a verdict");
    }
    verdict->settings[verdict->setting_count++] = (assay_verdict_setting){name, copy};
    return ASSAY_OK;
}

const char *assay_verdict_get(const assay_verdict *verdict, const char *key)
{
    const assay_verdict_setting *setting = find_setting(verdict, key);
    return setting ? setting->value : NULL;
}

int assay_verdict_count(const assay_verdict *verdict) { return (int)verdict->count; }

assay_finding assay_verdict_at(const assay_verdict *verdict, int index)
{
    return verdict->findings[index];
}

assay_verdict_kind assay_verdict_whole(const assay_verdict *verdict)
{
    bool unsure = verdict->count == 0;
    for (size_t i = 0; i < verdict->count; i++) {
        if (verdict->findings[i].kind == ASSAY_VERDICT_FAIL) {
            return ASSAY_VERDICT_FAIL;
        }
        unsure = unsure || verdict->findings[i].kind == ASSAY_VERDICT_CANNOT_TELL;
    }
    return unsure ? ASSAY_VERDICT_CANNOT_TELL : ASSAY_VERDICT_PASS;
}

int assay_verdict_first(const assay_verdict *verdict)
{
    const assay_verdict_kind kind  = assay_verdict_whole(verdict);
    int                      first = -1;
    for (size_t i = 0; kind != ASSAY_VERDICT_PASS && i < verdict->count; i++) {
        const assay_finding *f = &verdict->findings[i];
        const assay_finding *b = first < 0 ? NULL : &verdict->findings[first];
        if (f->kind == kind && (!b || (strcmp(f->stage, b->stage) == 0 &&
                                       (f->in_bounds > b->in_bounds ||
                                        (isnan(b->in_bounds) && !isnan(f->in_bounds)))))) {
            first = (int)i;
        }
    }
    return first;
}

const char *assay_verdict_kind_text(assay_verdict_kind kind)
{
    switch (kind) {
    case ASSAY_VERDICT_PASS: return "pass";
    case ASSAY_VERDICT_FAIL: return "fail";
    case ASSAY_VERDICT_CANNOT_TELL: break;
    }
    return "cannot tell";
}
