/* hemisphere_project.c - coefficients of the radiance that arrives, and the gradients of what stays
 * where it is.
 *
 * A cell counts with its solid angle, whatever the strata: 1 / (density of the direction), which is
 * the same in UNIFORM strata, grows without bound at the horizon in COSINE ones, and has an
 * infinite variance there (docs/methods/gathering.md).
 *
 * Invariant: outputs are copied from sums of our own when all has gone well. */
#include "gather/hemisphere_project.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"

/* Orthonormal under solid angle on the hemisphere, so that a coefficient is an integral. */
static assay_status check_kind(assay_context *context, const assay_basis *basis)
{
    switch (assay_basis_kind_of(basis)) {
    case ASSAY_BASIS_HSH:
    case ASSAY_BASIS_ZERNIKE:
    case ASSAY_BASIS_MAKHOTKIN_SQRT:
    case ASSAY_BASIS_ESH: return ASSAY_OK;
    default: break;
    }
    return assay_fail(context, ASSAY_ERR_ARGUMENT,
                      "%s: a hemisphere is projected onto hsh, zernike, makhotkin-sqrt or esh",
                      assay_basis_kind_name(assay_basis_kind_of(basis)));
}

static assay_status fail_direction(assay_context *context, assay_status status, int j)
{
    return status == ASSAY_ERR_DOMAIN
               ? assay_fail(context, status,
                            "stratum %d of a hemisphere: a direction is not of unit length or not "
                            "above the horizon",
                            j)
               : status;
}

/* ---- coefficients ---- */

typedef struct {
    assay_vec3 *directions; /* a stratum's                              */
    double     *values;     /* a stratum's: one row of count a cell     */
    double     *sums;       /* 3 rows of count                          */
} projection_work;

static void add_stratum(const assay_hemisphere *h, int j, size_t count, projection_work *work)
{
    const assay_cell *row   = h->cells + (size_t)j * (size_t)h->layout.phi;
    const double      angle = assay_hemisphere_solid_angle(h, j);
    for (int k = 0; k < h->layout.phi; k++) {
        const double  r = row[k].radiance.r * angle, g = row[k].radiance.g * angle;
        const double  b     = row[k].radiance.b * angle;
        const double *value = work->values + (size_t)k * count;
        for (size_t i = 0; i < count; i++) {
            work->sums[i] += r * value[i];
            work->sums[count + i] += g * value[i];
            work->sums[2 * count + i] += b * value[i];
        }
    }
}

static assay_status project(const assay_hemisphere *h, assay_context *context,
                            const assay_basis *basis, projection_work *work)
{
    const size_t count = assay_basis_count(basis), columns = (size_t)h->layout.phi;
    for (int j = 0; j < h->layout.theta; j++) {
        for (size_t k = 0; k < columns; k++) {
            work->directions[k] = h->cells[(size_t)j * columns + k].direction;
        }
        const assay_status status =
            assay_basis_evaluate_many(basis, columns, work->directions, work->values);
        if (status != ASSAY_OK) {
            return fail_direction(context, status, j);
        }
        add_stratum(h, j, count, work);
    }
    return ASSAY_OK;
}

assay_status assay_hemisphere_project(const assay_hemisphere *hemisphere, assay_context *context,
                                      const assay_basis *basis, double *coefficients_out)
{
    assay_status status = check_kind(context, basis);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t    count = assay_basis_count(basis), columns = (size_t)hemisphere->layout.phi;
    projection_work work = {.directions = assay_allocate(context, columns, sizeof *work.directions),
                            .values = assay_allocate(context, columns * count, sizeof *work.values),
                            .sums   = assay_allocate(context, 3 * count, sizeof *work.sums)};
    status               = work.directions && work.values && work.sums
                               ? project(hemisphere, context, basis, &work)
                               : assay_fail_memory(context, "a projection");
    if (status == ASSAY_OK) {
        memcpy(coefficients_out, work.sums, 3 * count * sizeof *work.sums);
    }
    assay_release(context, work.directions);
    assay_release(context, work.values);
    assay_release(context, work.sums);
    return status;
}

/* ---- gradients of fixed points ---- */

/* Surfaces seen more nearly edge-on than this do not change their solid angle by turning.
 * HEURISTIC: they cover 2^-20 of what is seen and would add 2^20 of noise. */
#define EDGE_ON 0x1p-20

/* Of ln(solid angle), 1/m: (3 w + n / cos xi) / r, xi between the hit's normal and the ray. */
static assay_vec3 stretch(const assay_cell *cell)
{
    const double     cosine = -vec3_dot(cell->hit_normal, cell->direction);
    const assay_vec3 nearer = vec3_scale(cell->direction, 3.0);
    return vec3_scale(cosine > EDGE_ON ? vec3_mad(nearer, 1.0 / cosine, cell->hit_normal) : nearer,
                      1.0 / cell->distance);
}

/* d(w) = -(delta - (delta . w) w) / r, so a function's surface gradient G adds -G / r. */
assay_status hemisphere_add_points(const assay_hemisphere *hemisphere, assay_context *context,
                                   const assay_basis *basis, assay_vec3 *sums)
{
    const size_t      count  = assay_basis_count(basis);
    double           *values = assay_allocate(context, count, sizeof *values);
    assay_vec3       *slopes = assay_allocate(context, count, sizeof *slopes);
    const assay_cell *cell   = hemisphere->cells;
    assay_status status = values && slopes ? ASSAY_OK : assay_fail_memory(context, "a gradient");
    for (int j = 0; j < hemisphere->layout.theta && status == ASSAY_OK; j++) {
        const double angle = assay_hemisphere_solid_angle(hemisphere, j);
        for (int k = 0; k < hemisphere->layout.phi && status == ASSAY_OK; k++, cell++) {
            status                = assay_basis_gradient(basis, cell->direction, values, slopes);
            const assay_vec3 grow = stretch(cell);
            for (size_t i = 0; i < count && status == ASSAY_OK; i++) {
                const assay_vec3 change = vec3_scale(
                    vec3_mad(vec3_scale(grow, values[i]), -1.0 / cell->distance, slopes[i]), angle);
                sums[i]             = vec3_mad(sums[i], cell->radiance.r, change);
                sums[count + i]     = vec3_mad(sums[count + i], cell->radiance.g, change);
                sums[2 * count + i] = vec3_mad(sums[2 * count + i], cell->radiance.b, change);
            }
        }
        status = fail_direction(context, status, j);
    }
    assay_release(context, values);
    assay_release(context, slopes);
    return status;
}

/* ---- either form ---- */

assay_status assay_hemisphere_project_gradient(const assay_hemisphere *hemisphere,
                                               assay_context *context, const assay_basis *basis,
                                               assay_gradient_form form, assay_vec3 *gradients_out)
{
    assay_status status = check_kind(context, basis);
    if (status != ASSAY_OK) {
        return status;
    }
    if (form != ASSAY_GRADIENT_POINTS && form != ASSAY_GRADIENT_WALLS) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "unknown form of a gradient");
    }
    const size_t count = 3 * assay_basis_count(basis);
    assay_vec3  *sums  = assay_allocate(context, count, sizeof *sums);
    if (!sums) {
        return assay_fail_memory(context, "a gradient");
    }
    status = form == ASSAY_GRADIENT_POINTS ? hemisphere_add_points(hemisphere, context, basis, sums)
                                           : hemisphere_add_walls(hemisphere, context, basis, sums);
    if (status == ASSAY_OK) {
        memcpy(gradients_out, sums, count * sizeof *sums);
    }
    assay_release(context, sums);
    return status;
}
