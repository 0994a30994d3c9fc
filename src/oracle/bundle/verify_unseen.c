/* verify_unseen.c - Invariant: every array of either bundle has a finding or is named here, however
 * many there are; of batches, which the candidate may cut in another way, one of a kind will do. */
#include "oracle/bundle/verify_unseen.h"

#include "oracle/bundle/bundle_match.h"
#include "oracle/bundle/verify_inputs.h"
#include "oracle/verdict/verdict_data.h"

typedef bool (*is_unseen)(const assay_verdict *verdict, const assay_bundle_reader *candidate,
                          const char *name);

static bool is_unjudged(const assay_verdict *verdict, const assay_bundle_reader *candidate,
                        const char *name)
{
    (void)candidate;
    return !verify_is_judged(verdict, name);
}

static bool is_missing(const assay_verdict *verdict, const assay_bundle_reader *candidate,
                       const char *name)
{
    assay_bundle_entry like = {.name = NULL};
    (void)verdict;
    return !bundle_find_like(candidate, name, &like);
}

static assay_status tell(const assay_bundle_reader *candidate, const assay_bundle_reader *of,
                         is_unseen unseen, const char *setting, assay_verdict *verdict)
{
    assay_text_builder text  = assay_text_start(verdict->context);
    char              *names = NULL;
    for (int i = 0; i < assay_bundle_count(of); i++) {
        assay_bundle_entry entry = {.name = NULL};
        if (assay_bundle_entry_at(of, i, &entry) == ASSAY_OK &&
            unseen(verdict, candidate, entry.name)) {
            assay_text_add(&text, "%s%s", text.length ? ", " : "", entry.name);
        }
    }
    const bool   any    = text.length > 0 || text.failed;
    assay_status status = any ? assay_text_finish(&text, "names of arrays", &names) : ASSAY_OK;
    if (names) {
        status = assay_verdict_set(verdict, setting, names);
        assay_text_destroy(verdict->context, names);
    }
    return status;
}

assay_status verify_tell_unseen(const assay_bundle_reader *candidate,
                                const assay_bundle_reader *reference, assay_verdict *verdict)
{
    const assay_status status = tell(candidate, candidate, is_unjudged, "not judged", verdict);
    return status || !reference ? status
                                : tell(candidate, reference, is_missing, "missing", verdict);
}
