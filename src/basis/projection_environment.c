/* projection_environment.c - SH coefficients of a latitude-longitude map, patch by patch.
 *
 * The map's pole is world +y, the harmonics' is +z.  In a frame with the axes (world z, world x,
 * world y) a texel is a rectangle in the polar angle theta and the azimuth
 *
 *     psi = rotation - 2 pi x,    x in [0, 1) from the left,
 *
 * and the integral of a harmonic over it is a product: cos or sin of m psi in closed form, and
 * Theta(theta) sin(theta), a trigonometric polynomial of degree l + 1, by Gauss with nodes to
 * spare. The coefficients are then turned to the world's frame exactly, as rotation matrices of SH
 * do.
 *
 * Invariant: rows are added from the top, texels from the left. */
#include "basis/basis_data.h"
#include "basis/projection.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

enum { CHANNELS = 3 };

typedef struct {
    const assay_basis *basis;
    assay_context     *context;
    int                width, height, order, nodes;
    size_t             count;
    assay_channel      channels[CHANNELS];
    double            *circle_cos, *circle_sin; /* 2 width: of pi j / width                     */
    double            *node, *weight;           /* nodes: Gauss on [-1, 1]                      */
    double            *functions;               /* count                                        */
    double            *polar;                   /* count: integral of Theta sin(theta) dtheta   */
    double            *cosines, *sines;         /* CHANNELS rows of order: row's azimuthal part */
    double            *local, *world;           /* CHANNELS rows of count                       */
    double            *matrix;                  /* count * count                                */
} map_sum;

/* Integrals over the row's theta of each harmonic's part in it: its value at azimuth 0, which
 * functions with sin(m psi) borrow from their twins. */
static assay_status integrate_polar(map_sum *s, int row)
{
    for (size_t k = 0; k < s->count; k++) {
        s->polar[k] = 0.0;
    }
    const double half = 0.5 * ASSAY_PI / s->height;
    for (int i = 0; i < s->nodes; i++) {
        const assay_sincos theta  = assay_sincos_radians(half * (2.0 * row + 1.0 + s->node[i]));
        const assay_vec3   d      = {theta.sin, 0.0, theta.cos};
        const assay_status status = assay_basis_evaluate(s->basis, d, s->functions);
        if (status != ASSAY_OK) {
            return status;
        }
        for (size_t k = 0; k < s->count; k++) {
            s->polar[k] += half * s->weight[i] * theta.sin * s->functions[k];
        }
    }
    return ASSAY_OK;
}

/* Integrals over psi of the row's radiance times cos(m psi) and sin(m psi). */
static void integrate_azimuth(map_sum *s, int row, double rotation)
{
    const int circle = 2 * s->width;
    for (int m = 0; m < s->order; m++) {
        const assay_sincos turn = assay_sincos_radians(m * rotation);
        const double       patch =
            m > 0 ? 2.0 / m * assay_sin(m * ASSAY_PI / s->width) : ASSAY_TWO_PI / s->width;
        for (int c = 0; c < CHANNELS; c++) {
            const float *texels = s->channels[c].data.f32 + (size_t)row * (size_t)s->width;
            double       re = 0.0, im = 0.0;
            int          at = m % circle; /* m (2 column + 1) modulo the circle */
            for (int column = 0; column < s->width; column++) {
                re += texels[column] * s->circle_cos[at];
                im -= texels[column] * s->circle_sin[at];
                at = (at + 2 * m) % circle;
            }
            s->cosines[c * s->order + m] = patch * (re * turn.cos - im * turn.sin);
            s->sines[c * s->order + m]   = patch * (re * turn.sin + im * turn.cos);
        }
    }
}

static void add_row(map_sum *s)
{
    for (size_t k = 0; k < s->count; k++) {
        int l, m;
        assay_basis_function(s->basis, k, &l, &m);
        const double polar = s->polar[m < 0 ? basis_index(s->basis, l, -m) : k];
        for (int c = 0; c < CHANNELS; c++) {
            const double azimuth =
                m < 0 ? s->sines[c * s->order - m] : s->cosines[c * s->order + m];
            s->local[(size_t)c * s->count + k] += polar * azimuth;
        }
    }
}

static assay_status turn_to_world(map_sum *s)
{
    /* Columns: where the local x, y and z axes lie in the world. */
    static const double to_world[9] = {0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0};
    assay_status        status      = assay_sh_rotation(s->basis, to_world, s->matrix);
    if (status == ASSAY_OK) {
        status = assay_sh_rotate(s->basis, s->matrix, CHANNELS, s->local, s->world);
    }
    return status;
}

assay_status assay_projection_check_map(assay_context *context, const assay_image *map,
                                        assay_channel channels_out[3])
{
    static const char *const names[CHANNELS] = {"R", "G", "B"};
    const size_t             width           = (size_t)assay_image_width(map);
    const size_t             texels          = width * (size_t)assay_image_height(map);
    for (int c = 0; c < CHANNELS; c++) {
        if (!assay_image_find_channel(map, names[c], &channels_out[c]) ||
            channels_out[c].type != ASSAY_CHANNEL_FLOAT) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "an environment map needs float channels R, G and B; '%s' is missing",
                              names[c]);
        }
        for (size_t i = 0; i < texels; i++) {
            if (!isfinite(channels_out[c].data.f32[i])) {
                return assay_fail(context, ASSAY_ERR_DOMAIN,
                                  "environment map: channel %s at column %zu, row %zu is %g; "
                                  "radiance must be finite",
                                  names[c], i % width, i / width,
                                  (double)channels_out[c].data.f32[i]);
            }
        }
    }
    return ASSAY_OK;
}

/* All arrays in one block. */
static double *allocate(map_sum *s)
{
    const size_t width = (size_t)s->width, nodes = (size_t)s->nodes, order = (size_t)s->order;
    const size_t count = s->count;
    double      *block = assay_allocate(s->context,
                                        4 * width + 2 * nodes + 2 * count +
                                            2 * CHANNELS * (order + count) + count * count,
                                        sizeof *block);
    if (block) {
        s->circle_cos = block;
        s->circle_sin = s->circle_cos + 2 * width;
        s->node       = s->circle_sin + 2 * width;
        s->weight     = s->node + nodes;
        s->functions  = s->weight + nodes;
        s->polar      = s->functions + count;
        s->cosines    = s->polar + count;
        s->sines      = s->cosines + CHANNELS * order;
        s->local      = s->sines + CHANNELS * order;
        s->world      = s->local + CHANNELS * count;
        s->matrix     = s->world + CHANNELS * count;
    }
    return block;
}

static assay_status integrate(map_sum *s, double rotation)
{
    assay_status status = ASSAY_OK;
    assay_gauss_legendre(s->nodes, s->node, s->weight);
    for (int j = 0; j < 2 * s->width; j++) {
        const assay_sincos at = assay_sincos_turns((double)j / (2.0 * s->width));
        s->circle_cos[j]      = at.cos;
        s->circle_sin[j]      = at.sin;
    }
    for (int row = 0; row < s->height && status == ASSAY_OK; row++) {
        status = integrate_polar(s, row);
        if (status == ASSAY_OK) {
            integrate_azimuth(s, row, rotation);
            add_row(s);
        }
    }
    return status == ASSAY_OK ? turn_to_world(s) : status;
}

assay_status assay_basis_project_environment(const assay_basis *basis, const assay_image *map,
                                             double rotation, double *coefficients_out)
{
    assay_context *context = basis->context;
    if (assay_basis_kind_of(basis) != ASSAY_BASIS_SH || !isfinite(rotation)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "an environment map is projected to SH, with a finite rotation");
    }
    map_sum s = {.basis   = basis,
                 .context = context,
                 .width   = assay_image_width(map),
                 .height  = assay_image_height(map),
                 .order   = assay_basis_order(basis),
                 .count   = assay_basis_count(basis)};
    /* Half a row is up to order pi / (2 height) wide in the phase of the fastest function; Gauss
     * converges faster than any power from there on. */
    s.nodes             = 12 + (int)(2.0 * s.order / s.height);
    assay_status status = assay_projection_check_map(context, map, s.channels);
    if (status != ASSAY_OK) {
        return status;
    }
    double *block = allocate(&s);
    if (!block) {
        return assay_fail_memory(context, "the projection of an environment map");
    }
    status = integrate(&s, rotation);
    for (size_t k = 0; k < CHANNELS * s.count && status == ASSAY_OK; k++) {
        coefficients_out[k] = s.world[k];
    }
    assay_release(context, block);
    return status;
}
