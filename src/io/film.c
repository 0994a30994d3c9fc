/* film.c - per-pixel statistics, and their names in the image.
 *
 * The mean and the sum of squared deviations are kept in double a channel; what was not asked for
 * has no memory. */
#include "io/film.h"

#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"

typedef struct {
    double   mean[3], squares[3]; /* squares: sum of squared deviations from the mean */
    uint32_t count;
} film_cell;

struct assay_film {
    assay_context       *context;
    int                  width, height;
    assay_layer_set      layers;
    film_cell           *cells[ASSAY_FILM_COUNT]; /* NULL where not asked for */
    assay_visible_point *visible;                 /* likewise                 */
    assay_error_target   target;
};

/* Layer name, and the group it belongs to. */
static const struct {
    const char     *layer;
    assay_layer_set group;
} QUANTITY[ASSAY_FILM_COUNT] = {
    [ASSAY_FILM_COLOR]               = {"", ASSAY_LAYERS_COLOR},
    [ASSAY_FILM_DIRECT]              = {"Direct.", ASSAY_LAYERS_SPLIT},
    [ASSAY_FILM_INDIRECT]            = {"Indirect.", ASSAY_LAYERS_SPLIT},
    [ASSAY_FILM_IRRADIANCE]          = {"Irradiance.", ASSAY_LAYERS_IRRADIANCE},
    [ASSAY_FILM_IRRADIANCE_DIRECT]   = {"IrradianceDirect.", ASSAY_LAYERS_IRRADIANCE},
    [ASSAY_FILM_IRRADIANCE_INDIRECT] = {"IrradianceIndirect.", ASSAY_LAYERS_IRRADIANCE},
};

static const struct {
    const char     *name;
    assay_layer_set group;
} GROUP[] = {{"color", ASSAY_LAYERS_COLOR},
             {"gbuffer", ASSAY_LAYERS_GBUFFER},
             {"split", ASSAY_LAYERS_SPLIT},
             {"irradiance", ASSAY_LAYERS_IRRADIANCE},
             {"all", ASSAY_LAYERS_ALL}};

assay_status assay_layers_parse(assay_context *context, const char *text,
                                assay_layer_set *layers_out)
{
    unsigned set = text ? 0 : ASSAY_LAYERS_ALL;
    while (text) {
        const size_t length = strcspn(text, ",");
        unsigned     found  = 0;
        for (size_t i = 0; i < sizeof GROUP / sizeof GROUP[0]; i++) {
            if (strlen(GROUP[i].name) == length && memcmp(GROUP[i].name, text, length) == 0) {
                found = GROUP[i].group;
            }
        }
        if (!found) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "unknown layers '%.*s'; there are: color, gbuffer, split, "
                              "irradiance, all",
                              length < 64 ? (int)length : 64, text);
        }
        set |= found;
        text = text[length] ? text + length + 1 : NULL;
    }
    *layers_out = (assay_layer_set)set;
    return ASSAY_OK;
}

static assay_status check_size(assay_context *context, int width, int height)
{
    if ((uint64_t)width * (uint64_t)height > ASSAY_RENDER_MAX_PIXELS) {
        return assay_fail(context, ASSAY_ERR_LIMIT,
                          "an image of %d x %d pixels is too large to render; at most %u pixels",
                          width, height, ASSAY_RENDER_MAX_PIXELS);
    }
    return ASSAY_OK;
}

uint64_t assay_film_pixel_bytes(assay_layer_set layers)
{
    uint64_t film = 0, channels = 0;
    for (int q = 0; q < ASSAY_FILM_COUNT; q++) {
        if (layers & QUANTITY[q].group) {
            film += sizeof(film_cell);
            channels += 6;
        }
    }
    if (layers & ASSAY_LAYERS_GBUFFER) {
        film += sizeof(assay_visible_point);
        channels += 17;
    }
    channels += layers & ASSAY_LAYERS_COLOR ? 1 : 0;
    channels += layers & ASSAY_LAYERS_IRRADIANCE ? 1 : 0;
    return film + channels * sizeof(float);
}

assay_status assay_film_ask(assay_context *context, int width, int height, assay_layer_set layers,
                            uint64_t more)
{
    char               what[80];
    const uint64_t     pixels = (uint64_t)width * (uint64_t)height;
    const assay_status status = check_size(context, width, height);
    snprintf(what, sizeof what, "an image of %d x %d pixels with its layers", width, height);
    return status != ASSAY_OK
               ? status
               : assay_memory_ask(context, pixels * (assay_film_pixel_bytes(layers) + more), what);
}

assay_status assay_film_create(assay_context *context, int width, int height,
                               assay_layer_set layers, assay_film **film_out)
{
    const uint64_t     pixels = (uint64_t)width * (uint64_t)height;
    const assay_status status = check_size(context, width, height);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_film *film = assay_allocate(context, 1, sizeof *film);
    if (!film) {
        return assay_fail_memory(context, "the film");
    }
    *film = (assay_film){.context = context, .width = width, .height = height, .layers = layers};
    bool complete = true;
    for (int q = 0; q < ASSAY_FILM_COUNT; q++) {
        if (layers & QUANTITY[q].group) {
            film->cells[q] = assay_allocate(context, pixels, sizeof *film->cells[q]);
            complete &= film->cells[q] != NULL;
        }
    }
    if (layers & ASSAY_LAYERS_GBUFFER) {
        film->visible = assay_allocate(context, pixels, sizeof *film->visible);
        complete &= film->visible != NULL;
    }
    if (!complete) {
        assay_film_destroy(film);
        return assay_fail_memory(context, "the film");
    }
    *film_out = film;
    return ASSAY_OK;
}

void assay_film_destroy(assay_film *film)
{
    if (film) {
        for (int q = 0; q < ASSAY_FILM_COUNT; q++) {
            assay_release(film->context, film->cells[q]);
        }
        assay_release(film->context, film->visible);
        assay_release(film->context, film);
    }
}

static bool fits(double x) { return fabs(x) <= ASSAY_FILM_MAX_VALUE; }

bool assay_film_add(assay_film *film, uint64_t pixel, assay_film_quantity quantity, assay_rgb value)
{
    if (!fits(value.r) || !fits(value.g) || !fits(value.b)) {
        return false;
    }
    if (!film->cells[quantity]) {
        return true;
    }
    film_cell   *cell      = &film->cells[quantity][pixel];
    const double sample[3] = {value.r, value.g, value.b};
    const double scale     = 1.0 / ++cell->count;
    for (int c = 0; c < 3; c++) {
        const double deviation = sample[c] - cell->mean[c];
        cell->mean[c] += deviation * scale;
        cell->squares[c] += deviation * (sample[c] - cell->mean[c]);
    }
    return true;
}

void assay_film_set_visible(assay_film *film, uint64_t pixel, const assay_visible_point *point)
{
    if (film->visible) {
        film->visible[pixel] = *point;
    }
}

uint32_t assay_film_samples(const assay_film *film, uint64_t pixel, assay_film_quantity quantity)
{
    return film->cells[quantity] ? film->cells[quantity][pixel].count : 0;
}

assay_rgb assay_film_mean(const assay_film *film, uint64_t pixel, assay_film_quantity quantity)
{
    const double *mean = film->cells[quantity][pixel].mean;
    return rgb(mean[0], mean[1], mean[2]);
}

assay_rgb assay_film_variance(const assay_film *film, uint64_t pixel, assay_film_quantity quantity)
{
    const film_cell *cell = &film->cells[quantity][pixel];
    if (cell->count < 2) {
        return rgb_grey(0.0);
    }
    const double scale = 1.0 / ((double)cell->count * (cell->count - 1.0));
    return rgb(cell->squares[0] * scale, cell->squares[1] * scale, cell->squares[2] * scale);
}

double assay_film_relative_error(const assay_film *film)
{
    const uint64_t   pixels = (uint64_t)film->width * (uint64_t)film->height;
    const film_cell *cells  = film->cells[ASSAY_FILM_COLOR];
    double           error = 0.0, light = 0.0;
    if (!cells) {
        return NAN;
    }
    for (uint64_t i = 0; i < pixels; i++) {
        if (cells[i].count < 2) {
            return NAN;
        }
        const assay_rgb variance = assay_film_variance(film, i, ASSAY_FILM_COLOR);
        light += rgb_luminance(assay_film_mean(film, i, ASSAY_FILM_COLOR));
        error += rgb_luminance(rgb(sqrt(variance.r), sqrt(variance.g), sqrt(variance.b)));
    }
    return light > 0.0 ? error / light : 0.0;
}

void assay_film_set_target(assay_film *film, assay_error_target target) { film->target = target; }

assay_error_target assay_film_target(const assay_film *film) { return film->target; }

/* ---- development ---- */

/* Adds PREFIX + LAYER + each of three suffixes ("R", "G", "B"). */
static assay_status add_triple(assay_image *image, const char *prefix, const char *layer,
                               const char *suffixes, float *data_out[3])
{
    for (int c = 0; c < 3; c++) {
        char          name[64];
        assay_channel channel;
        snprintf(name, sizeof name, "%s%s%c", prefix, layer, suffixes[c]);
        const assay_status status =
            assay_image_add_channel(image, name, ASSAY_CHANNEL_FLOAT, &channel);
        if (status != ASSAY_OK) {
            return status;
        }
        data_out[c] = channel.data.f32;
    }
    return ASSAY_OK;
}

static void store(float *const data[3], uint64_t pixel, double a, double b, double c)
{
    data[0][pixel] = (float)a;
    data[1][pixel] = (float)b;
    data[2][pixel] = (float)c;
}

static assay_status develop_quantity(const assay_film *film, assay_film_quantity quantity,
                                     assay_image *image)
{
    const uint64_t pixels = (uint64_t)film->width * (uint64_t)film->height;
    float         *mean[3], *variance[3];
    assay_status   status = add_triple(image, "", QUANTITY[quantity].layer, "RGB", mean);
    if (status == ASSAY_OK) {
        status = add_triple(image, "Variance.", QUANTITY[quantity].layer, "RGB", variance);
    }
    for (uint64_t i = 0; status == ASSAY_OK && i < pixels; i++) {
        const assay_rgb m = assay_film_mean(film, i, quantity);
        const assay_rgb v = assay_film_variance(film, i, quantity);
        store(mean, i, m.r, m.g, m.b);
        store(variance, i, v.r, v.g, v.b);
    }
    return status;
}

static assay_status develop_count(const assay_film *film, assay_film_quantity quantity,
                                  const char *name, assay_image *image)
{
    const uint64_t     pixels = (uint64_t)film->width * (uint64_t)film->height;
    assay_channel      channel;
    const assay_status status = assay_image_add_channel(image, name, ASSAY_CHANNEL_UINT, &channel);
    for (uint64_t i = 0; status == ASSAY_OK && i < pixels; i++) {
        channel.data.u32[i] = film->cells[quantity][i].count;
    }
    return status;
}

static assay_status develop_visible(const assay_film *film, assay_image *image)
{
    const uint64_t pixels = (uint64_t)film->width * (uint64_t)film->height;
    float         *albedo[3], *position[3], *ng[3], *ns[3];
    assay_channel  z, u, v, material, primitive;
    assay_status   status = add_triple(image, "", "Albedo.", "RGB", albedo);
    status = status != ASSAY_OK ? status : add_triple(image, "", "P.", "XYZ", position);
    status = status != ASSAY_OK ? status : add_triple(image, "", "N.", "XYZ", ng);
    status = status != ASSAY_OK ? status : add_triple(image, "", "Ns.", "XYZ", ns);
    const struct {
        const char        *name;
        assay_channel_type type;
        assay_channel     *channel;
    } single[] = {{"Z", ASSAY_CHANNEL_FLOAT, &z},
                  {"UV.U", ASSAY_CHANNEL_FLOAT, &u},
                  {"UV.V", ASSAY_CHANNEL_FLOAT, &v},
                  {"MaterialId", ASSAY_CHANNEL_UINT, &material},
                  {"PrimitiveId", ASSAY_CHANNEL_UINT, &primitive}};
    for (size_t i = 0; status == ASSAY_OK && i < sizeof single / sizeof single[0]; i++) {
        status = assay_image_add_channel(image, single[i].name, single[i].type, single[i].channel);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    for (uint64_t i = 0; i < pixels; i++) {
        const assay_visible_point *p = &film->visible[i];
        store(albedo, i, p->albedo.r, p->albedo.g, p->albedo.b);
        store(position, i, p->position.x, p->position.y, p->position.z);
        store(ng, i, p->ng.x, p->ng.y, p->ng.z);
        store(ns, i, p->ns.x, p->ns.y, p->ns.z);
        z.data.f32[i]         = (float)p->z;
        u.data.f32[i]         = (float)p->uv[0];
        v.data.f32[i]         = (float)p->uv[1];
        material.data.u32[i]  = p->material;
        primitive.data.u32[i] = p->primitive;
    }
    return ASSAY_OK;
}

assay_status assay_film_develop(const assay_film *film, assay_image **image_out)
{
    assay_image *image  = NULL;
    assay_status status = assay_image_create(film->context, film->width, film->height, &image);
    for (int q = 0; status == ASSAY_OK && q < ASSAY_FILM_COUNT; q++) {
        if (film->cells[q]) {
            status = develop_quantity(film, (assay_film_quantity)q, image);
        }
    }
    if (status == ASSAY_OK && film->cells[ASSAY_FILM_COLOR]) {
        status = develop_count(film, ASSAY_FILM_COLOR, "SampleCount", image);
    }
    if (status == ASSAY_OK && film->cells[ASSAY_FILM_IRRADIANCE]) {
        status = develop_count(film, ASSAY_FILM_IRRADIANCE, "SampleCount.Irradiance", image);
    }
    if (status == ASSAY_OK && film->visible) {
        status = develop_visible(film, image);
    }
    if (status != ASSAY_OK) {
        assay_image_destroy(image);
        return status;
    }
    *image_out = image;
    return ASSAY_OK;
}
