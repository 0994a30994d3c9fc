/* splat_lobes.c - Coefficients of every pixel would be 7 kB a pixel at order 10; what they are
 * looked up in is as large for any picture.
 *
 * Invariant: a grid is written once, however many materials and channels share it. */
#include "methods/splat/splat_lobes.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

enum { NAME_SIZE = 128, CHANNELS = ASSAY_MATERIAL_CHANNELS, COLUMNS = 1 + CHANNELS };

typedef struct {
    const assay_brdf_grid **grids;
    size_t                  count, capacity;
} grid_list;

static size_t find(const grid_list *list, const assay_brdf_grid *grid)
{
    size_t i = 0;
    while (i < list->count && list->grids[i] != grid) {
        i++;
    }
    return i;
}

static assay_status note(assay_context *context, grid_list *list, const assay_brdf_grid *grid)
{
    void *grown = (void *)list->grids;
    if (find(list, grid) < list->count) {
        return ASSAY_OK;
    }
    const assay_status status = assay_grow(context, &grown, &list->capacity, list->count + 1,
                                           sizeof(const assay_brdf_grid *));
    list->grids               = grown;
    if (status == ASSAY_OK) {
        list->grids[list->count++] = grid;
    }
    return status;
}

static assay_status list_grids(const splat_image *image, grid_list *list)
{
    assay_status status = ASSAY_OK;
    for (uint32_t i = 0; i < image->materials->count && status == ASSAY_OK; i++) {
        const assay_material_grids *grids = &image->materials->grids[i];
        for (int c = -1; c < CHANNELS && grids->slope && status == ASSAY_OK; c++) {
            status = note(image->context, list, c < 0 ? grids->slope : grids->black[c]);
        }
    }
    return status ? assay_fail_memory(image->context, "a dump") : ASSAY_OK;
}

static assay_status add(const splat_image *image, const char *name, const char *what,
                        const char *unit, const assay_array *table)
{
    char full[NAME_SIZE];
    snprintf(full, sizeof full, "%s/%s", name, what);
    return assay_bundle_add_table(image->frame->dump, full, unit, table);
}

static assay_status add_grids(const splat_image *image, const char *name, const grid_list *list)
{
    const size_t count = assay_basis_count(assay_radiance_cache_basis(image->caches->radiance));
    const size_t side  = (size_t)assay_brdf_grid_side(list->grids[0]);
    assay_array *table = NULL;
    assay_status status =
        assay_array_create(image->context, list->count * side * side, count, &table);
    for (size_t i = 0; i < list->count && status == ASSAY_OK; i++) {
        memcpy(assay_array_data(table) + i * side * side * count,
               assay_brdf_grid_texel(list->grids[i], 0, 0), side * side * count * sizeof(double));
    }
    status = status ? status : add(image, name, "lobe_grid", "1/sr", table);
    assay_array_destroy(table);
    return status;
}

static assay_status add_pixels(const splat_image *image, const splat_layer *layer, const char *name,
                               const grid_list *list)
{
    const size_t pixels = (size_t)image->frame->width * (size_t)image->frame->height;
    assay_array *table  = NULL;
    assay_status status = assay_array_create(image->context, pixels, COLUMNS, &table);
    for (size_t i = 0; i < pixels && status == ASSAY_OK; i++) {
        double                     *row   = assay_array_data(table) + i * COLUMNS;
        const bool                  has   = assay_splat_has_point(layer->buffer, i);
        const assay_material_grids *grids = has ? splat_gloss_grids(image->gloss, i) : NULL;
        for (int c = 0; c < COLUMNS; c++) {
            row[c] = has ? (double)find(list, c == 0 ? grids->slope : grids->black[c - 1]) : NAN;
        }
    }
    status = status ? status : add(image, name, "lobe", "", table);
    assay_array_destroy(table);
    return status;
}

assay_status splat_lobes_add(const splat_image *image, const splat_layer *layer, const char *name)
{
    grid_list    list   = {0};
    assay_status status = list_grids(image, &list);
    assert(status != ASSAY_OK || list.grids); /* else no pixel would be glossy */
    status = status ? status : add_grids(image, name, &list);
    status = status ? status : add_pixels(image, layer, name, &list);
    assay_release(image->context, (void *)list.grids);
    return status;
}
