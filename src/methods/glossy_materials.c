/* glossy_materials.c - the choice between coefficients and paths.
 *
 * Invariant: the choice is the material's, not the point's, so that no seam runs across a surface.
 * Materials with the same lobe share grids; the last of them by number releases these.
 *
 * The angle of 45 degrees is the mean angle of directions drawn by their cosine; beyond it lobes
 * meet the horizon, where every basis errs more, and grazing views are rare. */
#include "methods/glossy_materials.h"

#include "core/alloc.h"
#include "core/context.h"

static bool is_glossy(const assay_material *m)
{
    switch (m->model) {
    case ASSAY_MATERIAL_PHONG:
    case ASSAY_MATERIAL_WARD:
    case ASSAY_MATERIAL_WARD_PUBLISHED: return !rgb_is_black(m->specular_color);
    case ASSAY_MATERIAL_PBR:
        return m->metallic > 0.0 || m->specular_factor > 0.0 || m->transmission > 0.0;
    case ASSAY_MATERIAL_UNLIT:
    case ASSAY_MATERIAL_LAMBERT: break;
    }
    return false;
}

/* The smaller of both planes' shares. */
static assay_status measure(assay_context *context, const assay_material_grid_settings *settings,
                            const assay_material *material, double *share_out)
{
    const double     s      = sqrt(0.5);
    const assay_vec3 wo[2]  = {{s, 0.0, s}, {0.0, s, s}};
    const int        order  = assay_basis_order(settings->basis);
    assay_status     status = ASSAY_OK;
    double           least  = INFINITY;
    for (int i = 0; i < 2 && status == ASSAY_OK; i++) {
        double shares[ASSAY_BASIS_MAX_ORDER] = {0.0};
        status = assay_material_grids_accuracy(context, settings, material, wo[i], shares);
        least  = fmin(least, shares[order - 1]);
    }
    if (status == ASSAY_OK) {
        *share_out = least;
    }
    return status;
}

typedef struct {
    assay_context                      *context;
    const char                         *method;
    const assay_scene                  *scene;
    const assay_material_grid_settings *settings;
    double                              accuracy;
    glossy_materials                   *made;
} maker;

/* The grids of a material with the same lobe, or NULL where none has been made. */
static const assay_material_grids *made_before(const maker *m, const assay_material *material)
{
    for (uint32_t i = 0; i < m->made->count; i++) {
        const assay_material_grids *grids = &m->made->grids[i];
        if (grids->slope && assay_material_grids_same(&m->scene->materials[i], material)) {
            return grids;
        }
    }
    return NULL;
}

static assay_status make_grids(const maker *m, const assay_material *material,
                               assay_material_grids *grids_out)
{
    const assay_material_grids *before = made_before(m, material);
    if (before) {
        *grids_out = *before;
        return ASSAY_OK;
    }
    return assay_material_grids_create(m->context, m->settings, material, grids_out);
}

static assay_status make_material(const maker *m, const assay_material *material,
                                  assay_material_grids *grids)
{
    const char *name    = material->name ? material->name : "";
    const char *problem = assay_material_grids_problem(material);
    if (problem) {
        assay_inform(m->context, ASSAY_LOG_INFO,
                     "%s: material '%s' %s: its glossy light comes from paths", m->method, name,
                     problem);
        return ASSAY_OK;
    }
    double       share  = 0.0;
    assay_status status = measure(m->context, m->settings, material, &share);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_inform(m->context, ASSAY_LOG_INFO,
                 "%s: order %d holds %.4f of the lobe of material '%s': %s", m->method,
                 assay_basis_order(m->settings->basis), share, name,
                 share >= m->accuracy ? "within reach" : "its glossy light comes from paths");
    return share >= m->accuracy ? make_grids(m, material, grids) : ASSAY_OK;
}

/* seen: a flag a material, all false. */
static assay_status make_all(const maker *m, bool *seen)
{
    const assay_scene *scene  = m->scene;
    assay_status       status = ASSAY_OK;
    for (uint32_t i = 0; i < scene->shape_count && status == ASSAY_OK; i++) {
        const uint32_t        index    = scene->shapes[i].material;
        const assay_material *material = &scene->materials[index];
        assay_material_grids *grids    = &m->made->grids[index];
        if (!seen[index] && is_glossy(material)) {
            status       = make_material(m, material, grids);
            m->made->any = m->made->any || grids->slope;
        }
        seen[index] = true;
    }
    return status;
}

assay_status glossy_materials_make(assay_context *context, const char *method,
                                   const assay_scene                  *scene,
                                   const assay_material_grid_settings *settings, double accuracy,
                                   glossy_materials *materials_out)
{
    glossy_materials made = {.context = context, .count = scene->material_count};
    const maker      m    = {context, method, scene, settings, accuracy, &made};
    made.grids            = assay_allocate(context, scene->material_count, sizeof *made.grids);
    bool        *seen     = assay_allocate(context, scene->material_count, sizeof *seen);
    assay_status status   = ASSAY_ERR_MEMORY;
    if (made.grids && seen) {
        status = make_all(&m, seen);
    } else {
        assay_fail_memory(context, "BRDFs in harmonics");
    }
    assay_release(context, seen);
    if (status != ASSAY_OK) {
        glossy_materials_release(&made);
        return status;
    }
    *materials_out = made;
    return ASSAY_OK;
}

/* Whether a material of a higher number has them, too. */
static bool goes_on(const glossy_materials *materials, uint32_t number)
{
    for (uint32_t i = number + 1; i < materials->count; i++) {
        if (materials->grids[i].slope == materials->grids[number].slope) {
            return true;
        }
    }
    return false;
}

void glossy_materials_release(glossy_materials *materials)
{
    for (uint32_t i = 0; materials->grids && i < materials->count; i++) {
        if (materials->grids[i].slope && !goes_on(materials, i)) {
            assay_material_grids_release(&materials->grids[i]);
        }
    }
    if (materials->context) {
        assay_release(materials->context, materials->grids);
    }
    *materials = (glossy_materials){0};
}
