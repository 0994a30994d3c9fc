/* splat_gloss.c - BRDFs of the pixels of a tile, made where the first record is heard.
 *
 * Coefficients of all pixels at once would be 2.4 kB a pixel and channel at order 10.  A tile takes
 * all its records before its worker goes on, so those of a tile are enough.
 *
 * The BRDF is turned about the normal into the frame in which records are added up, once a pixel,
 * in place of every record's light into the BRDF's frame: the dot product is the same. */
#include "methods/splat/splat_gloss.h"

#include "core/alloc.h"
#include "core/context.h"

enum { CHANNELS = ASSAY_MATERIAL_CHANNELS };

typedef struct {
    const assay_material_grids *grids;
    assay_frame3                frame; /* of the material      */
    assay_vec3                  wo;    /* in it                */
    assay_rgb                   base_color;
} gloss_pixel;

/* A worker's own. */
typedef struct {
    size_t *owners; /* a slot: the pixel whose BRDF is there, or SIZE_MAX */
    double *brdfs;  /* a slot: 3 rows of coefficients                     */
    double *light;  /* 3 rows                                             */
    double *scratch;
} gloss_desk;

struct splat_gloss {
    assay_context        *context;
    assay_radiance_cache *cache;
    size_t                count; /* coefficients */
    gloss_pixel          *pixels;
    gloss_desk           *desks;
    int                   workers;
};

static void release_desk(assay_context *context, gloss_desk *desk)
{
    assay_release(context, desk->owners);
    assay_release(context, desk->brdfs);
    assay_release(context, desk->light);
    assay_release(context, desk->scratch);
}

void splat_gloss_destroy(splat_gloss *gloss)
{
    if (gloss) {
        for (int i = 0; gloss->desks && i < gloss->workers; i++) {
            release_desk(gloss->context, &gloss->desks[i]);
        }
        assay_release(gloss->context, gloss->desks);
        assay_release(gloss->context, gloss->pixels);
        assay_release(gloss->context, gloss);
    }
}

static bool make_desk(assay_context *context, size_t count, gloss_desk *desk)
{
    const size_t row = CHANNELS * count * sizeof(double);
    desk->owners     = assay_allocate(context, ASSAY_SPLAT_SLOTS, sizeof *desk->owners);
    desk->brdfs      = assay_allocate(context, ASSAY_SPLAT_SLOTS, row);
    desk->light      = assay_allocate(context, 1, row);
    desk->scratch    = assay_allocate(context, 1, row);
    return desk->owners && desk->brdfs && desk->light && desk->scratch;
}

assay_status splat_gloss_create(assay_context *context, size_t pixels, assay_radiance_cache *cache,
                                splat_gloss **gloss_out)
{
    splat_gloss *gloss = assay_allocate(context, 1, sizeof *gloss);
    if (!gloss) {
        return assay_fail_memory(context, "glossy pixels");
    }
    gloss->context = context;
    gloss->cache   = cache;
    gloss->workers = assay_context_threads(context);
    gloss->count   = assay_basis_count(assay_radiance_cache_basis(cache));
    gloss->pixels  = assay_allocate(context, pixels, sizeof *gloss->pixels);
    gloss->desks   = assay_allocate(context, (size_t)gloss->workers, sizeof *gloss->desks);
    bool have      = gloss->pixels && gloss->desks;
    for (int i = 0; have && i < gloss->workers; i++) {
        have = make_desk(context, gloss->count, &gloss->desks[i]);
    }
    if (!have) {
        splat_gloss_destroy(gloss);
        return assay_fail_memory(context, "glossy pixels");
    }
    splat_gloss_begin(gloss);
    *gloss_out = gloss;
    return ASSAY_OK;
}

void splat_gloss_begin(splat_gloss *gloss)
{
    for (int i = 0; i < gloss->workers; i++) {
        for (int slot = 0; slot < ASSAY_SPLAT_SLOTS; slot++) {
            gloss->desks[i].owners[slot] = SIZE_MAX;
        }
    }
}

void splat_gloss_set(splat_gloss *gloss, size_t pixel, const assay_material_grids *grids,
                     const assay_vertex *vertex)
{
    const assay_frame3 frame = assay_material_frame(vertex);
    gloss->pixels[pixel]     = (gloss_pixel){.grids      = grids,
                                             .frame      = frame,
                                             .wo         = frame3_to_local(&frame, vertex->wo),
                                             .base_color = vertex->bsdf.base_color};
}

void splat_gloss_get(const splat_gloss *gloss, size_t pixel, assay_frame3 *frame_out,
                     assay_vec3 *wo_out, assay_rgb *base_color_out)
{
    *frame_out      = gloss->pixels[pixel].frame;
    *wo_out         = gloss->pixels[pixel].wo;
    *base_color_out = gloss->pixels[pixel].base_color;
}

const assay_material_grids *splat_gloss_grids(const splat_gloss *gloss, size_t pixel)
{
    return gloss->pixels[pixel].grids;
}

static double dot(size_t count, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

assay_status splat_gloss_say(void *user, const assay_splat_place *place, uint32_t record,
                             assay_rgb *said_out)
{
    splat_gloss       *gloss  = user;
    const gloss_pixel *pixel  = &gloss->pixels[place->pixel];
    const gloss_desk  *desk   = &gloss->desks[place->worker];
    double            *brdf   = desk->brdfs + (size_t)place->slot * CHANNELS * gloss->count;
    const assay_frame3 here   = frame3_from_z(place->normal);
    assay_status       status = ASSAY_OK;
    if (desk->owners[place->slot] != place->pixel) {
        status = assay_material_grids_brdf(pixel->grids, gloss->count, pixel->base_color, pixel->wo,
                                           desk->scratch, brdf);
        status = status ? status
                        : assay_radiance_cache_turn(gloss->cache, &pixel->frame, &here,
                                                    place->worker, brdf);
        desk->owners[place->slot] = status ? SIZE_MAX : place->pixel;
    }
    status = status ? status
                    : assay_radiance_cache_say(gloss->cache, record, place->position, &here,
                                               place->worker, desk->light);
    if (status == ASSAY_OK) {
        const size_t n = gloss->count;
        *said_out      = rgb(dot(n, desk->light, brdf), dot(n, desk->light + n, brdf + n),
                             dot(n, desk->light + 2 * n, brdf + 2 * n));
    }
    return status;
}
