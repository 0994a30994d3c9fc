/* material_grids.c - BRDFs as coefficients.
 *
 * Invariant: a grid belongs to a material, not to a point: what a texture may change is the base
 * colour alone, in which every model is affine, and so is the Lambertian that may be taken away. */
#include "methods/material_grids.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

enum { CHANNELS = ASSAY_MATERIAL_CHANNELS, FIRST_NODES = 32 };

/* A grid's texels on the horizon stand for directions this far above it: BRDFs end there. */
static const double LOWEST = 0x1p-10;

/* Accuracies of twice the nodes differ by no more than this where a lobe is resolved. */
static const double RESOLVED = 1e-3;

typedef struct {
    assay_bsdf black, white;   /* base colour 0 and 1                                */
    bool       beyond_lambert; /* as in the settings                                 */
    int        channel;        /* of black; -1: white less black, G                  */
    double     base;           /* of a whole lobe, assay_material_grids_accuracy     */
    assay_vec3 wo;             /* the same                                           */
} lobe_source;

static double channel_of(assay_rgb c, int channel)
{
    return channel == 0 ? c.r : channel == 1 ? c.g : c.b;
}

static assay_rgb value_of(const lobe_source *source, const assay_bsdf *bsdf, assay_vec3 wo,
                          assay_vec3 wi)
{
    const assay_bsdf_view view = assay_bsdf_seen_from(bsdf, wo);
    assay_rgb             f    = assay_bsdf_view_evaluate(&view, wi).value;
    if (source->beyond_lambert) {
        const assay_rgb lambert = assay_bsdf_view_lambert(&view);
        f                       = rgb_sub(f, rgb_scale(lambert, wi.z * ASSAY_INV_PI));
    }
    return f;
}

static double slope_of(const lobe_source *source, assay_vec3 wo, assay_vec3 wi)
{
    return value_of(source, &source->white, wo, wi).g - value_of(source, &source->black, wo, wi).g;
}

/* Only reads its source, as threads share it. */
static double evaluate(void *user, assay_vec3 wo, assay_vec3 wi)
{
    const lobe_source *source = user;
    if (wo.z < LOWEST) {
        const double scale = sqrt((1.0 - LOWEST * LOWEST) / (wo.x * wo.x + wo.y * wo.y));
        wo                 = vec3(wo.x * scale, wo.y * scale, LOWEST);
    }
    return source->channel < 0
               ? slope_of(source, wo, wi)
               : channel_of(value_of(source, &source->black, wo, wi), source->channel);
}

const char *assay_material_grids_problem(const assay_material *m)
{
    if (m->model != ASSAY_MATERIAL_PBR) {
        return NULL;
    }
    if (m->transmission > 0.0) {
        return "transmits light";
    }
    if (m->metallic_roughness_texture.texture != ASSAY_NONE) {
        return "has a texture of metallic and roughness";
    }
    if (m->specular_texture.texture != ASSAY_NONE ||
        m->specular_color_texture.texture != ASSAY_NONE) {
        return "has a texture of its specular reflection";
    }
    return m->roughness * m->roughness < ASSAY_ALPHA_MIN ? "is a perfect mirror" : NULL;
}

static assay_bsdf bsdf_with(const assay_material *material, double base)
{
    const assay_surface_material at = {
        .base_color      = rgb_grey(base),
        .coverage        = 1.0,
        .metallic        = material->metallic,
        .roughness       = material->roughness,
        .transmission    = 0.0,
        .specular_factor = material->specular_factor,
        .specular_color  = material->specular_color,
    };
    return assay_vertex_bsdf(material, &at);
}

static bool same_color(assay_rgb a, assay_rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

bool assay_material_grids_same(const assay_material *a, const assay_material *b)
{
    const assay_bsdf x = bsdf_with(a, 0.0), y = bsdf_with(b, 0.0);
    return x.model == y.model && x.metallic == y.metallic && x.roughness == y.roughness &&
           x.ior == y.ior && x.specular_factor == y.specular_factor &&
           same_color(x.specular_color, y.specular_color) && x.solid == y.solid &&
           x.exponent == y.exponent && x.alpha_x == y.alpha_x && x.alpha_y == y.alpha_y;
}

static lobe_source source_of(const assay_material               *material,
                             const assay_material_grid_settings *settings)
{
    return (lobe_source){.black          = bsdf_with(material, 0.0),
                         .white          = bsdf_with(material, 1.0),
                         .beyond_lambert = settings->beyond_lambert};
}

/* ---- grids ---- */

/* Steps of a grid that are still waited for: some minutes of one processor. */
static const double MOST_STEPS = 1e12;

/* A texel takes a BRDF's value, some 300 multiplications, and n^2 of them, at each node. */
assay_status assay_material_grids_check_work(assay_context *context, int side, int nodes, int order)
{
    const double steps =
        (double)side * side * 2.0 * nodes * nodes * (300.0 + (double)order * order);
    return steps <= MOST_STEPS
               ? ASSAY_OK
               : assay_fail(context, ASSAY_ERR_ARGUMENT,
                            "parameters 'grid' %d, 'nodes' %d and 'order' %d ask for %.1g steps a "
                            "BRDF, hours of work: grid^2 * 2 nodes^2 * (300 + order^2) may be %.0g",
                            side, nodes, order, steps, MOST_STEPS);
}

static assay_status make_grid(assay_context *context, const assay_material_grid_settings *settings,
                              lobe_source *source, int channel, assay_brdf_grid **grid_out)
{
    source->channel = channel;
    return assay_brdf_grid_create_parallel(settings->basis, context, evaluate, source,
                                           settings->side, settings->nodes, 2 * settings->nodes,
                                           grid_out);
}

assay_status assay_material_grids_create(assay_context                      *context,
                                         const assay_material_grid_settings *settings,
                                         const assay_material               *material,
                                         assay_material_grids               *grids_out)
{
    assay_material_grids grids  = {0};
    lobe_source          source = source_of(material, settings);
    const assay_rgb      tint   = material->specular_color;
    assay_status         status = make_grid(context, settings, &source, -1, &grids.slope);
    for (int c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        if (c > 0 && channel_of(tint, c) == channel_of(tint, c - 1)) {
            grids.black[c] = grids.black[c - 1];
        } else {
            status = make_grid(context, settings, &source, c, &grids.black[c]);
        }
    }
    if (status != ASSAY_OK) {
        assay_material_grids_release(&grids);
        return status;
    }
    *grids_out = grids;
    return ASSAY_OK;
}

void assay_material_grids_release(assay_material_grids *grids)
{
    assay_brdf_grid_destroy(grids->slope);
    for (int c = CHANNELS - 1; c >= 0; c--) {
        if (c == 0 || grids->black[c] != grids->black[c - 1]) {
            assay_brdf_grid_destroy(grids->black[c]);
        }
    }
    *grids = (assay_material_grids){0};
}

/* ---- accuracy ---- */

/* The lobe and its square: of the square the constant function's coefficient is the energy. */
static void lobe_and_square(void *user, assay_vec3 wi, double *values_out)
{
    const lobe_source *source = user;
    double             sum    = 0.0;
    for (int c = 0; c < CHANNELS; c++) {
        sum += channel_of(value_of(source, &source->black, source->wo, wi), c);
    }
    const double value = sum / CHANNELS + source->base * slope_of(source, source->wo, wi);
    values_out[0]      = value;
    values_out[1]      = value * value;
}

/* coefficients: 2 rows of count. */
static void shares(const assay_basis *basis, const double *coefficients, double *accuracy_out)
{
    const size_t count                       = assay_basis_count(basis);
    const double energy                      = sqrt(2.0 * ASSAY_PI) * coefficients[count];
    double       held[ASSAY_BASIS_MAX_ORDER] = {0.0};
    for (size_t i = 0; i < count; i++) {
        int l = 0, m = 0;
        assay_basis_function(basis, i, &l, &m);
        held[l] += coefficients[i] * coefficients[i];
    }
    double sum = 0.0;
    for (int n = 0; n < assay_basis_order(basis); n++) {
        sum += held[n];
        accuracy_out[n] = energy > 0.0 ? sum / energy : 1.0;
    }
}

static double largest_step(const double *a, const double *b, int count)
{
    double largest = 0.0;
    for (int i = 0; i < count; i++) {
        largest = fmax(largest, fabs(a[i] - b[i]));
    }
    return largest;
}

assay_status assay_material_grids_accuracy(assay_context                      *context,
                                           const assay_material_grid_settings *settings,
                                           const assay_material *material, assay_vec3 wo,
                                           double *accuracy_out)
{
    const assay_basis *basis  = settings->basis;
    const int          order  = assay_basis_order(basis);
    lobe_source        source = source_of(material, settings);
    const double       red = material->base_color[0], green = material->base_color[1];
    double             found[2][ASSAY_BASIS_MAX_ORDER] = {{0.0}, {0.0}};
    double            *work = assay_allocate(context, 2 * assay_basis_count(basis), sizeof *work);
    if (!work) {
        return assay_fail_memory(context, "the accuracy of a lobe");
    }
    source.base           = (red + green + material->base_color[2]) / CHANNELS;
    source.wo             = wo;
    assay_status status   = ASSAY_OK;
    bool         resolved = false;
    int          round    = 0;
    for (int nodes = FIRST_NODES; nodes <= ASSAY_LOBE_NODES && !status && !resolved; nodes *= 2) {
        double *now = found[round & 1], *before = found[(round + 1) & 1];
        status = assay_basis_project(basis, context, lobe_and_square, &source, 2, nodes, 2 * nodes,
                                     work);
        if (status == ASSAY_OK) {
            shares(basis, work, now);
            resolved = round > 0 && largest_step(now, before, order) <= RESOLVED;
            round++;
        }
    }
    for (int n = 0; n < order && status == ASSAY_OK; n++) {
        accuracy_out[n] = resolved ? found[(round - 1) & 1][n] : 0.0;
    }
    assay_release(context, work);
    return status;
}

/* ---- reflecting ---- */

/* Seen from the back it is the surface's frame turned half about x; models mirror z instead, which
 * is the same for them, as all are symmetric about the plane of x and z. */
assay_frame3 assay_material_frame(const assay_vertex *vertex)
{
    if (vertex->front) {
        return vertex->frame;
    }
    return (assay_frame3){vertex->frame.x, vec3_negate(vertex->frame.y),
                          vec3_negate(vertex->frame.z)};
}

static double dot(size_t count, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

assay_status assay_material_grids_reflect(const assay_material_grids *grids, size_t count,
                                          const assay_vertex *vertex, const double *light,
                                          double *scratch, assay_rgb *radiance_out)
{
    const assay_frame3 frame = assay_material_frame(vertex);
    const assay_vec3   wo    = frame3_to_local(&frame, vertex->wo);
    if (!grids->slope || !(wo.z > 0.0)) {
        *radiance_out = rgb_grey(0.0);
        return ASSAY_OK;
    }
    const assay_rgb base           = vertex->bsdf.base_color;
    double          sums[CHANNELS] = {0.0, 0.0, 0.0};
    assay_status    status         = assay_brdf_grid_lookup(grids->slope, wo, scratch);
    for (int c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        sums[c] = channel_of(base, c) * dot(count, light + (size_t)c * count, scratch);
    }
    for (int c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        if (c == 0 || grids->black[c] != grids->black[c - 1]) {
            status = assay_brdf_grid_lookup(grids->black[c], wo, scratch);
        }
        sums[c] += dot(count, light + (size_t)c * count, scratch);
    }
    if (status == ASSAY_OK) {
        *radiance_out = rgb(sums[0], sums[1], sums[2]);
    }
    return status;
}

assay_status assay_material_grids_brdf(const assay_material_grids *grids, size_t count,
                                       assay_rgb base_color, assay_vec3 wo, double *scratch,
                                       double *coefficients_out)
{
    assay_status status = ASSAY_OK;
    if (!grids->slope || !(wo.z > 0.0)) {
        memset(coefficients_out, 0, CHANNELS * count * sizeof *coefficients_out);
        return ASSAY_OK;
    }
    status = assay_brdf_grid_lookup(grids->slope, wo, scratch);
    for (int c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        double *row = coefficients_out + (size_t)c * count;
        status      = assay_brdf_grid_lookup(grids->black[c], wo, row);
        for (size_t i = 0; i < count && status == ASSAY_OK; i++) {
            row[i] += channel_of(base_color, c) * scratch[i];
        }
    }
    return status;
}
