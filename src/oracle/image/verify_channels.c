/* verify_channels.c - the estimated channels, before what is made of them.
 *
 * Invariant: irradiance comes before the radiance that it becomes, parts before their sum: so the
 * first finding that fails is of the first stage that is wrong. */
#include "oracle/image/verify_channels.h"

#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"

static const struct {
    const char *layer, *stage;
} LAYERS[] = {{"IrradianceDirect.", "irradiance"}, {"IrradianceIndirect.", "irradiance"},
              {"Irradiance.", "irradiance"},       {"Direct.", "radiance"},
              {"Indirect.", "radiance"},           {"", "image"}};

enum {
    LAYER_COUNT   = sizeof LAYERS / sizeof LAYERS[0],
    COLOURS       = 3,
    KNOWN         = LAYER_COUNT * COLOURS,
    MOST_CHANNELS = 64
};

static void known_name(int index, char name_out[ASSAY_CHANNEL_NAME])
{
    snprintf(name_out, ASSAY_CHANNEL_NAME, "%s%c", LAYERS[index / COLOURS].layer,
             "RGB"[index % COLOURS]);
}

static const char *stage_of(const char *name)
{
    for (int i = 0; i < LAYER_COUNT - 1; i++) {
        if (strncmp(name, LAYERS[i].layer, strlen(LAYERS[i].layer)) == 0) {
            return LAYERS[i].stage;
        }
    }
    return "image";
}

/* Rank on the light's way; names that are not known come last. */
static int rank_of(const char *name)
{
    char known[ASSAY_CHANNEL_NAME];
    for (int i = 0; i < KNOWN; i++) {
        known_name(i, known);
        if (strcmp(known, name) == 0) {
            return i;
        }
    }
    return KNOWN;
}

static assay_status add_channel(assay_context *context, assay_verify_channel *channels, int *count,
                                const char *name, size_t length)
{
    if (length == 0 || length >= ASSAY_CHANNEL_NAME || *count == MOST_CHANNELS) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "channels are at most %d names, separated by commas, as in R,G,B",
                          MOST_CHANNELS);
    }
    assay_verify_channel *channel = &channels[*count];
    memcpy(channel->name, name, length);
    channel->name[length] = '\0';
    channel->stage        = stage_of(channel->name);
    for (int i = 0; i < *count; i++) {
        if (strcmp(channels[i].name, channel->name) == 0) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT, "channel %s is named twice",
                              channel->name);
        }
    }
    ++*count;
    return ASSAY_OK;
}

/* Insertion sort: few, and equal ranks stay in the order in which they were named. */
static void sort_by_rank(assay_verify_channel *channels, int count)
{
    for (int i = 1; i < count; i++) {
        const assay_verify_channel moved = channels[i];
        int                        at    = i;
        for (; at > 0 && rank_of(channels[at - 1].name) > rank_of(moved.name); at--) {
            channels[at] = channels[at - 1];
        }
        channels[at] = moved;
    }
}

static assay_status list_channels(assay_context *context, const char *list,
                                  assay_verify_channel *channels, int *count)
{
    assay_status status = ASSAY_OK;
    if (!list) {
        char name[ASSAY_CHANNEL_NAME];
        for (int i = 0; status == ASSAY_OK && i < KNOWN; i++) {
            known_name(i, name);
            status = add_channel(context, channels, count, name, strlen(name));
        }
        return status;
    }
    for (const char *at = list; status == ASSAY_OK;) {
        const size_t length = strcspn(at, ",");
        status              = add_channel(context, channels, count, at, length);
        if (!at[length]) {
            break;
        }
        at += length + 1;
    }
    sort_by_rank(channels, *count);
    return status;
}

static bool both_have(const assay_image *candidate, const assay_image *reference, const char *name)
{
    return assay_image_find_channel(candidate, name, NULL) &&
           assay_image_find_channel(reference, name, NULL);
}

/* Whether a channel is of a layer that both images have, if only in part: a colour of it that one
 * image lacks is not left out, but cannot be told. */
static bool is_shared(const assay_image *candidate, const assay_image *reference, const char *name)
{
    char      sibling[ASSAY_CHANNEL_NAME];
    const int rank  = rank_of(name);
    bool      found = false;
    for (int i = rank / COLOURS * COLOURS; rank < KNOWN && i < (rank / COLOURS + 1) * COLOURS;
         i++) {
        known_name(i, sibling);
        found = found || both_have(candidate, reference, sibling);
    }
    return found && (assay_image_find_channel(candidate, name, NULL) ||
                     assay_image_find_channel(reference, name, NULL));
}

assay_status assay_verify_channels_choose(assay_context *context, const assay_image *candidate,
                                          const assay_image *reference, const char *list,
                                          assay_verify_channel **channels_out, int *count_out)
{
    int                   listed   = 0;
    assay_verify_channel *channels = assay_allocate(context, MOST_CHANNELS, sizeof *channels);
    if (!channels) {
        return assay_fail_memory(context, "the channels to compare");
    }
    assay_status status = list_channels(context, list, channels, &listed);
    int          count  = 0;
    for (int i = 0; status == ASSAY_OK && i < listed; i++) {
        if (list || is_shared(candidate, reference, channels[i].name)) {
            channels[count++] = channels[i];
        }
    }
    if (status == ASSAY_OK && count == 0) {
        status = assay_fail(context, ASSAY_ERR_ARGUMENT,
                            "candidate and reference have no channel of light in common (R, G, B, "
                            "Direct.R, Irradiance.R, ...)");
    }
    if (status != ASSAY_OK) {
        assay_release(context, channels);
        return status;
    }
    *channels_out = channels;
    *count_out    = count;
    return ASSAY_OK;
}

enum { MOST_NAMES = 2 * MOST_CHANNELS + 2, NAME = ASSAY_CHANNEL_NAME + 16 };

/* Texts stand behind the pointers to them, in one block. */
static void write_names(const assay_verify_channel *channels, int count, const char **names)
{
    char *text = (char *)(names + MOST_NAMES + 1);
    for (int i = 0; i < 2 * count; i++, text += NAME) {
        snprintf(text, NAME, "%s%s", i % 2 ? "Variance." : "", channels[i / 2].name);
        names[i] = text;
    }
    names[2 * count]     = "SampleCount";
    names[2 * count + 1] = "SampleCount.Irradiance";
}

assay_status assay_verify_channels_names(assay_context *context, const char *list,
                                         const char ***names_out)
{
    int                   count    = 0;
    assay_verify_channel *channels = assay_allocate(context, MOST_CHANNELS, sizeof *channels);
    if (!channels) {
        return assay_fail_memory(context, "the channels to compare");
    }
    assay_status status = list_channels(context, list, channels, &count);
    const char **names  = NULL;
    if (status == ASSAY_OK) {
        names  = assay_allocate(context, 1,
                                (MOST_NAMES + 1) * sizeof *names + (size_t)MOST_NAMES * NAME);
        status = names ? ASSAY_OK : assay_fail_memory(context, "the channels to compare");
    }
    if (names) {
        write_names(channels, count, names);
        *names_out = names;
    }
    assay_release(context, channels);
    return status;
}
