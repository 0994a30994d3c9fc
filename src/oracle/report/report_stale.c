/* report_stale.c - a verdict is found by the name of its image, and the image may have been
 * rendered again since.
 *
 * Invariant: a single value is compared bit for bit, with the hexadecimal text of the verdict; a
 * mean of n values within what their order and the quotient can do to it, 2 n 2^-53 of the mean of
 * their sizes [higham02, eq. 4.4]: far less than another seed does.
 *
 * What cannot be compared is passed over: the candidate of several runs (their mean is in no file),
 * what a stage should have made, layers that a bundle does not hold. */
#include "oracle/report/report_stale.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "io/image_decode.h"
#include "scene/scene_text.h"

enum { MOST_CHANNELS = 64, NAME_SIZE = 128, SENTENCE_SIZE = 1024 };

/* One of the two images. */
typedef struct {
    const assay_report_source *source;
    assay_image               *more; /* channels that the report does not show; NULL */
    const char                *key;
    size_t                     others;    /* values that are not the file's      */
    double                     exactness; /* pixels behind the one that is told  */
    char                       told[SENTENCE_SIZE];
} side;

typedef struct {
    int    x, y, width, height;
    double pixels;
} box;

static const char *text_of(const cJSON *finding, const char *key)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(finding, key));
}

/* A whole number that an int holds. */
static bool take_int(const cJSON *place, const char *key, int *out)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(place, key);
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0.0 && item->valuedouble < 2147483648.0)) {
        return false;
    }
    *out = (int)item->valuedouble;
    return true;
}

static bool take_hex(const cJSON *finding, const char *key, double *out)
{
    const char *hex = text_of(finding, key);
    char       *end = NULL;
    if (!hex) {
        return false;
    }
    *out = strtod(hex, &end);
    return end != hex && *end == '\0';
}

/* Arrays of bundles have a room before their name. */
static bool is_of_bundle(const char *array) { return strchr(array, '/') != NULL; }

/* ---- what is told ---- */

/* The place of the fewest pixels is told, the first of several. */
static void tell(side *s, double pixels, const char *what, double mine, double theirs)
{
    if (s->others++ == 0 || pixels < s->exactness) {
        s->exactness = pixels;
        snprintf(s->told, sizeof s->told, "%.300s is %.9g (%a) in %s and %.9g (%a) in the verdict",
                 what, mine, mine, s->source->label, theirs, theirs);
    }
}

static void tell_lack(side *s, const char *what)
{
    if (s->others++ == 0 || s->exactness > 0.0) {
        s->exactness = 0.0;
        snprintf(s->told, sizeof s->told, "%s has no %.300s", s->source->label, what);
    }
}

static void put_side(assay_report_text *text, const side *s)
{
    char sentence[SENTENCE_SIZE + 128], clean[SENTENCE_SIZE + 128], more[96] = "";
    if (s->others == 0) {
        return;
    }
    if (s->others > 1) {
        snprintf(more, sizeof more, ", and %zu more of its values are not the file's",
                 s->others - 1);
    }
    snprintf(sentence, sizeof sentence, "The verdict is of other pixels than those here: %s%s.",
             s->told, more);
    assay_text_clean(sentence, clean, sizeof clean);
    assay_report_put_text(text, NULL, clean);
}

/* ---- images ---- */

static bool find_floats(const side *s, const char *name, assay_channel *out)
{
    return (assay_image_find_channel(s->source->image, name, out) ||
            (s->more && assay_image_find_channel(s->more, name, out))) &&
           out->type == ASSAY_CHANNEL_FLOAT;
}

/* The place of a finding; all of the image where it has none. */
static bool take_box(const cJSON *finding, const assay_image *image, box *out)
{
    const cJSON *place = cJSON_GetObjectItemCaseSensitive(finding, "place");
    box          b     = {0, 0, assay_image_width(image), assay_image_height(image), 0.0};
    if (!cJSON_IsNull(place) &&
        !(take_int(place, "x", &b.x) && take_int(place, "y", &b.y) &&
          take_int(place, "width", &b.width) && take_int(place, "height", &b.height) &&
          b.width > 0 && b.height > 0)) {
        return false;
    }
    b.pixels = (double)b.width * (double)b.height;
    *out     = b;
    return true;
}

static bool is_inside(const box *b, const assay_image *image)
{
    return b->width <= assay_image_width(image) - b->x &&
           b->height <= assay_image_height(image) - b->y;
}

static void describe(const char *array, const box *b, const assay_image *image, char *out,
                     size_t size)
{
    if (b->pixels == 1.0) {
        snprintf(out, size, "'%.100s' at (%d, %d)", array, b->x, b->y);
    } else if (b->width == assay_image_width(image) && b->height == assay_image_height(image)) {
        snprintf(out, size, "the mean of '%.100s'", array);
    } else {
        snprintf(out, size, "the mean of '%.100s' over %d x %d pixels at (%d, %d)", array, b->width,
                 b->height, b->x, b->y);
    }
}

static void compare_box(side *s, const char *array, const assay_channel *channel, const box *b,
                        double theirs)
{
    const assay_image *image = s->source->image;
    const size_t       width = (size_t)assay_image_width(image);
    double             sum = 0.0, size = 0.0;
    char               what[NAME_SIZE + 128];
    describe(array, b, image, what, sizeof what);
    if (!is_inside(b, image)) {
        tell_lack(s, what);
        return;
    }
    for (int y = b->y; y < b->y + b->height; y++) {
        for (int x = b->x; x < b->x + b->width; x++) {
            const double value = channel->data.f32[(size_t)y * width + (size_t)x];
            sum += value;
            size += fabs(value);
        }
    }
    const double mean = sum / b->pixels;
    const double away = b->pixels > 1.0 ? 0x1p-52 * size : 0.0;
    if (!(mean == theirs || fabs(mean - theirs) <= away)) {
        tell(s, b->pixels, what, mean, theirs);
    }
}

static void check_image(side *s, const cJSON *finding, const char *array)
{
    assay_channel channel;
    double        theirs;
    box           b;
    if (!take_hex(finding, s->key, &theirs) || !take_box(finding, s->source->image, &b)) {
        return;
    }
    if (find_floats(s, array, &channel)) {
        compare_box(s, array, &channel, &b, theirs);
    } else if (!s->source->bundle) {
        char what[NAME_SIZE];
        snprintf(what, sizeof what, "channel '%.100s'", array);
        tell_lack(s, what);
    }
}

/* A value that was not finite is one no more. */
static void check_healed(side *mine, const side *theirs, const cJSON *finding, const char *array)
{
    assay_channel a, b;
    box           place;
    const char   *test = text_of(finding, "test");
    if (!test || strcmp(test, "finite") != 0 || !take_box(finding, mine->source->image, &place) ||
        place.pixels != 1.0 || !is_inside(&place, mine->source->image) ||
        !find_floats(mine, array, &a) || !find_floats(theirs, array, &b)) {
        return;
    }
    const size_t pixel =
        (size_t)place.y * (size_t)assay_image_width(mine->source->image) + (size_t)place.x;
    if (isfinite(a.data.f32[pixel]) && isfinite(b.data.f32[pixel])) {
        char what[NAME_SIZE + 64];
        describe(array, &place, mine->source->image, what, sizeof what);
        tell(mine, 1.0, what, a.data.f32[pixel], NAN);
    }
}

/* ---- bundles ---- */

/* Row and column of a finding's number; the column of an image, whose order is the
 * stage's own, is SIZE_MAX: any will do. */
static bool take_cell(const cJSON *finding, const assay_bundle_entry *entry, size_t *row,
                      size_t *column)
{
    const cJSON *place = cJSON_GetObjectItemCaseSensitive(finding, "place");
    int          a, b;
    if (take_int(place, "row", &a) && take_int(place, "column", &b)) {
        *row    = (size_t)a;
        *column = entry->image ? SIZE_MAX : (size_t)b;
        return true;
    }
    if (entry->dimensions < 2 || !take_int(place, "x", &a) || !take_int(place, "y", &b)) {
        return false;
    }
    *row    = (size_t)b * entry->shape[1] + (size_t)a;
    *column = SIZE_MAX;
    return true;
}

static void compare_cell(side *s, const char *array, const assay_array *table, size_t row,
                         size_t column, double theirs)
{
    const size_t columns = assay_array_columns(table);
    char         what[NAME_SIZE + 64];
    snprintf(what, sizeof what, "'%.100s' in row %zu", array, row);
    if (row >= assay_array_rows(table) || (column != SIZE_MAX && column >= columns)) {
        tell_lack(s, what);
        return;
    }
    const double *values = assay_array_values(table) + row * columns;
    const size_t  first  = column == SIZE_MAX ? 0 : column,
                 end     = column == SIZE_MAX ? columns : column + 1;
    for (size_t i = first; i < end; i++) {
        if (values[i] == theirs) {
            return;
        }
    }
    tell(s, 1.0, what, values[first], theirs);
}

static assay_status check_bundle(side *s, const cJSON *finding, const char *array)
{
    double             theirs;
    assay_bundle_entry entry;
    size_t             row, column;
    assay_array       *table = NULL;
    if (!take_hex(finding, s->key, &theirs)) {
        return ASSAY_OK;
    }
    if (!assay_bundle_has(s->source->bundle, array)) {
        char what[NAME_SIZE];
        snprintf(what, sizeof what, "array '%.100s'", array);
        tell_lack(s, what);
        return ASSAY_OK;
    }
    assay_status status = assay_bundle_entry_of(s->source->bundle, array, &entry);
    if (status != ASSAY_OK || !take_cell(finding, &entry, &row, &column)) {
        return status;
    }
    status = assay_bundle_read_array(s->source->bundle, array, NULL, &table);
    if (status == ASSAY_OK) {
        compare_cell(s, array, table, row, column, theirs);
    }
    assay_array_destroy(table);
    return status;
}

/* ---- all findings ---- */

static assay_status check_finding(side *candidate, side *reference, bool runs, const cJSON *finding)
{
    const char *array = text_of(finding, "array"), *test = text_of(finding, "test");
    if (!array || !test) {
        return ASSAY_OK;
    }
    if (!is_of_bundle(array)) {
        if (!runs) {
            check_image(candidate, finding, array);
            check_healed(candidate, reference, finding, array);
        }
        check_image(reference, finding, array);
        return ASSAY_OK;
    }
    assay_status status = ASSAY_OK;
    if (candidate->source->bundle) {
        status = check_bundle(candidate, finding, array);
        if (status == ASSAY_OK && reference->source->bundle && strcmp(test, "given") == 0) {
            status = check_bundle(reference, finding, array);
        }
    }
    return status;
}

/* Channels that findings name and the report does not show. */
static assay_status read_more(assay_context *context, const cJSON *findings, side *s)
{
    const char  *names[MOST_CHANNELS + 1];
    int          count   = 0;
    const cJSON *finding = NULL;
    cJSON_ArrayForEach(finding, findings)
    {
        const char *array = text_of(finding, "array");
        bool        known = !array || is_of_bundle(array) ||
                     assay_image_find_channel(s->source->image, array, NULL);
        for (int i = 0; !known && i < count; i++) {
            known = strcmp(names[i], array) == 0;
        }
        if (!known && count < MOST_CHANNELS) {
            names[count++] = array;
        }
    }
    names[count] = NULL;
    return count > 0 && !s->source->bundle
               ? assay_image_read_channels(context, s->source->path, names, &s->more)
               : ASSAY_OK;
}

/* "a.exr and 3 more", as verify_files.c names several runs. */
static bool is_of_runs(const cJSON *verdict)
{
    const char  *name   = text_of(verdict, "candidate");
    const size_t length = name ? strlen(name) : 0;
    return length > 5 && strcmp(name + length - 5, " more") == 0 && strstr(name, " and ");
}

assay_status assay_report_stale_put(assay_context *context, assay_report_text *text,
                                    const assay_report_source *reference,
                                    const assay_report_source *candidate, const char *verdict)
{
    side   c    = {.source = candidate, .key = "candidate_hex"};
    side   r    = {.source = reference, .key = "reference_hex"};
    cJSON *root = cJSON_Parse(verdict);
    if (!root) {
        return assay_fail_memory(context, "a verdict");
    }
    const cJSON *findings = cJSON_GetObjectItemCaseSensitive(root, "findings");
    const cJSON *finding  = NULL;
    const bool   runs     = is_of_runs(root);
    assay_status status   = read_more(context, findings, &c);
    status                = status ? status : read_more(context, findings, &r);
    cJSON_ArrayForEach(finding, findings)
    {
        status = status ? status : check_finding(&c, &r, runs, finding);
    }
    if (status == ASSAY_OK && c.others + r.others > 0) {
        assay_report_open(text, "otherPixels", '[');
        put_side(text, &c);
        put_side(text, &r);
        assay_report_close(text, ']');
    }
    assay_image_destroy(c.more);
    assay_image_destroy(r.more);
    cJSON_Delete(root);
    return status;
}
