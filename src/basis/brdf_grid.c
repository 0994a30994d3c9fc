/* brdf_grid.c - a BRDF's coefficients on a paraboloid of outgoing directions [gautron06] 3.5.2.
 *
 * Paraboloid map, eq. 3.35 and 3.36, and its inverse: with (a, b) = (2u - 1, 2v - 1), r^2 = a^2 +
 * b^2,
 *
 *     u = (1 + x / (1 + z)) / 2,  v = (1 + y / (1 + z)) / 2;
 *     z = (1 - r^2) / (1 + r^2),  (x, y) = (a, b) (1 + z).
 *
 * The hemisphere is the disc r <= 1.  A lookup near the horizon also reads texels outside it, so
 * those are filled with the direction on the horizon that is nearest.
 *
 * Invariant: texel (column, row) belongs to u = (column + 1/2) / side, v = (row + 1/2) / side.  The
 * functions' values are the same for every texel and computed once.  Integrals run over the
 * hemisphere for SH, too: below the horizon a BRDF is 0, and its edge would spoil a rule that does
 * not know of it. */
#include "basis/brdf_grid.h"

#include <string.h>

#include "basis/analysis.h"
#include "basis/projection.h"
#include "basis/sphere_rule.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/parallel.h"

enum { MAX_SIDE = 4096 };

struct assay_brdf_grid {
    assay_context *context;
    int            side;
    size_t         count;
    double        *texels; /* side * side rows of count */
};

typedef struct {
    const assay_basis  *basis;
    assay_context      *context;
    assay_brdf_function f;
    void               *user;
    assay_analysis     *analysis;
    assay_sphere_rule   rule;
    double             *table; /* rings * sectors rows of count: functions times solid angle */
} grid_maker;

static assay_vec3 texel_direction(int side, int column, int row)
{
    double       a      = (2.0 * column + 1.0) / side - 1.0;
    double       b      = (2.0 * row + 1.0) / side - 1.0;
    const double square = a * a + b * b;
    if (square >= 1.0) {
        const double r = sqrt(square);
        return (assay_vec3){a / r, b / r, 0.0};
    }
    const double z = (1.0 - square) / (1.0 + square);
    return (assay_vec3){a * (1.0 + z), b * (1.0 + z), z};
}

static assay_status tabulate(grid_maker *maker, size_t count)
{
    const assay_sphere_rule *rule = &maker->rule;
    double                  *row  = maker->table;
    for (int i = 0; i < rule->rings; i++) {
        for (int j = 0; j < rule->sectors; j++, row += count) {
            const assay_status status = assay_analysis_evaluate(
                maker->analysis, assay_sphere_rule_direction(rule, i, j), row);
            if (status != ASSAY_OK) {
                return status;
            }
            for (size_t k = 0; k < count; k++) {
                row[k] *= rule->weight[i];
            }
        }
    }
    return ASSAY_OK;
}

/* quiet: without a message, which only one thread may leave. */
static assay_status fill_texel(const grid_maker *maker, assay_brdf_grid *grid, uint64_t at,
                               bool quiet)
{
    const int side = grid->side, column = (int)(at % (uint64_t)side),
              line                 = (int)(at / (uint64_t)side);
    const size_t             count = grid->count;
    const assay_vec3         wo    = texel_direction(side, column, line);
    double                  *texel = grid->texels + at * count;
    const assay_sphere_rule *rule  = &maker->rule;
    const double            *row   = maker->table;
    for (int i = 0; i < rule->rings; i++) {
        for (int j = 0; j < rule->sectors; j++, row += count) {
            const assay_vec3 wi    = assay_sphere_rule_direction(rule, i, j);
            const double     value = maker->f(maker->user, wo, wi);
            if (!isfinite(value)) {
                texel[0] = NAN;
                return quiet ? ASSAY_ERR_DOMAIN
                             : assay_projection_check(maker->context, &value, 1, wi);
            }
            for (size_t k = 0; k < count; k++) {
                texel[k] += value * row[k];
            }
        }
    }
    assay_analysis_finish(maker->analysis, texel);
    return ASSAY_OK;
}

typedef struct {
    const grid_maker *maker;
    assay_brdf_grid  *grid;
} grid_job;

static assay_status fill_item(void *user, uint64_t index, int worker)
{
    const grid_job *job = user;
    (void)worker;
    return fill_texel(job->maker, job->grid, index, true);
}

/* The first texel that failed again, for its message. */
static assay_status explain(const grid_maker *maker, assay_brdf_grid *grid, uint64_t texels)
{
    for (uint64_t i = 0; i < texels; i++) {
        if (isnan(grid->texels[i * grid->count])) {
            return fill_texel(maker, grid, i, false);
        }
    }
    return ASSAY_ERR_INTERNAL;
}

static assay_status fill_grid(grid_maker *maker, assay_brdf_grid *grid, bool parallel)
{
    const uint64_t side = (uint64_t)grid->side, texels = side * side;
    assay_status   status = tabulate(maker, grid->count);
    if (parallel) {
        grid_job job = {maker, grid};
        status       = status == ASSAY_OK
                           ? assay_parallel_for(maker->context, "project", texels, fill_item, &job)
                           : status;
        return status == ASSAY_ERR_DOMAIN ? explain(maker, grid, texels) : status;
    }
    for (uint64_t i = 0; i < texels && status == ASSAY_OK; i++) {
        status = i % side == 0 ? assay_progress(maker->context, "project", i, texels) : ASSAY_OK;
        status = status == ASSAY_OK ? fill_texel(maker, grid, i, false) : status;
    }
    return status;
}

static assay_status prepare(grid_maker *maker, assay_brdf_grid *grid, int theta_nodes,
                            int phi_nodes)
{
    assay_status status =
        assay_sphere_rule_create(maker->context, true, theta_nodes, phi_nodes, &maker->rule);
    if (status == ASSAY_OK) {
        status = assay_analysis_create(maker->context, maker->basis, true, &maker->analysis);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t texels = (size_t)grid->side * (size_t)grid->side;
    const size_t nodes  = (size_t)theta_nodes * (size_t)phi_nodes;
    maker->table        = assay_allocate(maker->context, nodes, grid->count * sizeof(double));
    grid->texels        = assay_allocate(maker->context, texels, grid->count * sizeof(double));
    return maker->table && grid->texels ? ASSAY_OK
                                        : assay_fail_memory(maker->context, "a BRDF grid");
}

static assay_status check_side(assay_context *context, int side)
{
    return side >= 1 && side <= MAX_SIDE
               ? ASSAY_OK
               : assay_fail(context, ASSAY_ERR_ARGUMENT,
                            "a BRDF grid of %d x %d directions: from 1 to %d each way are possible",
                            side, side, MAX_SIDE);
}

assay_status assay_brdf_grid_from_texels(assay_context *context, int side, size_t count,
                                         const double *texels, assay_brdf_grid **grid_out)
{
    const size_t       rows   = (size_t)side * (size_t)side;
    const assay_status status = check_side(context, side);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_brdf_grid *grid = assay_allocate(context, 1, sizeof *grid);
    if (!grid) {
        return assay_fail_memory(context, "a BRDF grid");
    }
    *grid        = (assay_brdf_grid){.context = context, .side = side, .count = count};
    grid->texels = assay_allocate(context, rows, count * sizeof(double));
    if (!grid->texels) {
        assay_brdf_grid_destroy(grid);
        return assay_fail_memory(context, "a BRDF grid");
    }
    memcpy(grid->texels, texels, rows * count * sizeof *texels);
    *grid_out = grid;
    return ASSAY_OK;
}

static assay_status create(const assay_basis *basis, assay_context *context, assay_brdf_function f,
                           void *user, int side, int theta_nodes, int phi_nodes, bool parallel,
                           assay_brdf_grid **grid_out)
{
    assay_status status = check_side(context, side);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_brdf_grid *grid = assay_allocate(context, 1, sizeof *grid);
    if (!grid) {
        return assay_fail_memory(context, "a BRDF grid");
    }
    grid->context      = context;
    grid->side         = side;
    grid->count        = assay_basis_count(basis);
    grid_maker maker   = {.basis = basis, .context = context, .f = f, .user = user};
    maker.rule.context = context;
    status             = prepare(&maker, grid, theta_nodes, phi_nodes);
    if (status == ASSAY_OK) {
        status = fill_grid(&maker, grid, parallel);
    }
    assay_sphere_rule_destroy(&maker.rule);
    assay_analysis_destroy(maker.analysis);
    assay_release(context, maker.table);
    if (status != ASSAY_OK) {
        assay_brdf_grid_destroy(grid);
        return status;
    }
    *grid_out = grid;
    return ASSAY_OK;
}

assay_status assay_brdf_grid_create(const assay_basis *basis, assay_context *context,
                                    assay_brdf_function f, void *user, int side, int theta_nodes,
                                    int phi_nodes, assay_brdf_grid **grid_out)
{
    return create(basis, context, f, user, side, theta_nodes, phi_nodes, false, grid_out);
}

assay_status assay_brdf_grid_create_parallel(const assay_basis *basis, assay_context *context,
                                             assay_brdf_function f, void *user, int side,
                                             int theta_nodes, int phi_nodes,
                                             assay_brdf_grid **grid_out)
{
    return create(basis, context, f, user, side, theta_nodes, phi_nodes, true, grid_out);
}

void assay_brdf_grid_destroy(assay_brdf_grid *grid)
{
    if (grid) {
        assay_release(grid->context, grid->texels);
        assay_release(grid->context, grid);
    }
}

int assay_brdf_grid_side(const assay_brdf_grid *grid) { return grid->side; }

const double *assay_brdf_grid_texel(const assay_brdf_grid *grid, int column, int row)
{
    return grid->texels + ((size_t)row * (size_t)grid->side + (size_t)column) * grid->count;
}

/* The two texels along one axis and the share of the second. */
typedef struct {
    int    first, second;
    double share;
} texel_pair;

/* u in [0, 1]; clamped at the first and last texel's centre. */
static texel_pair find_pair(int side, double u)
{
    const double at    = fmin(fmax(u * side - 0.5, 0.0), side - 1.0);
    const int    first = (int)at < side - 1 ? (int)at : side - 1;
    const int    next  = first + 1 < side ? first + 1 : first;
    return (texel_pair){first, next, at - first};
}

assay_status assay_brdf_grid_lookup(const assay_brdf_grid *grid, assay_vec3 wo,
                                    double *coefficients_out)
{
    const double square = wo.x * wo.x + wo.y * wo.y + wo.z * wo.z;
    if (!(fabs(square - 1.0) <= ASSAY_BASIS_UNIT_TOLERANCE) || !(wo.z >= 0.0)) {
        return assay_fail(grid->context, ASSAY_ERR_DOMAIN,
                          "the outgoing direction (%.6g, %.6g, %.6g) is not a unit vector above "
                          "the horizon",
                          wo.x, wo.y, wo.z);
    }
    const double     length = sqrt(square);
    const double     scale  = 0.5 / (length + wo.z);
    const texel_pair c      = find_pair(grid->side, 0.5 + scale * wo.x);
    const texel_pair r      = find_pair(grid->side, 0.5 + scale * wo.y);
    const double    *t[4]   = {assay_brdf_grid_texel(grid, c.first, r.first),
                               assay_brdf_grid_texel(grid, c.second, r.first),
                               assay_brdf_grid_texel(grid, c.first, r.second),
                               assay_brdf_grid_texel(grid, c.second, r.second)};
    for (size_t k = 0; k < grid->count; k++) {
        const double top    = t[0][k] + c.share * (t[1][k] - t[0][k]);
        const double bottom = t[2][k] + c.share * (t[3][k] - t[2][k]);
        coefficients_out[k] = top + r.share * (bottom - top);
    }
    return ASSAY_OK;
}
