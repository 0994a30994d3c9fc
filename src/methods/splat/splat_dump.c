/* splat_dump.c - tables of doubles, since 1e-12 is asked of those who splat again. */
#include "methods/splat/splat_dump.h"

#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "methods/splat/splat_lobes.h"

enum { WHAT_SIZE = 64, NAME_SIZE = 128, BRDF_COLUMNS = 15 };

/* The columns of a pixel. */
typedef void (*column_writer)(const splat_dump *dump, size_t pixel, double *row);

static assay_status add_table(const splat_dump *dump, const char *what, const char *unit,
                              size_t columns, column_writer write)
{
    const assay_frame *frame  = dump->image->frame;
    const size_t       pixels = (size_t)frame->width * (size_t)frame->height;
    assay_array       *table  = NULL;
    char               name[NAME_SIZE];
    assay_status       status = assay_array_create(frame->context, pixels, columns, &table);
    for (size_t i = 0; i < pixels && status == ASSAY_OK; i++) {
        write(dump, i, assay_array_data(table) + i * columns);
    }
    snprintf(name, sizeof name, "%s/%s", dump->name, what);
    status = status ? status : assay_bundle_add_table(frame->dump, name, unit, table);
    assay_array_destroy(table);
    return status;
}

static void put(double *row, assay_vec3 v) { memcpy(row, &v, 3 * sizeof *row); }

/* Points that are not asked are NaN. */
static void write_position(const splat_dump *dump, size_t pixel, double *row)
{
    put(row, assay_splat_has_point(dump->layer->buffer, pixel)
                 ? dump->image->points[pixel].site.position
                 : vec3(NAN, NAN, NAN));
}

static void write_frame(const splat_dump *dump, size_t pixel, double *row)
{
    const assay_frame3 *frame = &dump->image->points[pixel].site.frame;
    put(row, frame->x);
    put(row + 3, frame->y);
    put(row + 6, frame->z);
}

/* Geometric: nothing is gathered under it. */
static void write_normal(const splat_dump *dump, size_t pixel, double *row)
{
    put(row, dump->image->points[pixel].site.ng);
}

static void write_footprint(const splat_dump *dump, size_t pixel, double *row)
{
    row[0] = dump->image->points[pixel].footprint;
}

static void write_albedo(const splat_dump *dump, size_t pixel, double *row)
{
    const assay_rgb c = dump->image->lambert[pixel];
    put(row, vec3(c.r, c.g, c.b));
}

/* The frame of the BRDF, wo in it, base colour; NaN where the pixel is not glossy. */
static void write_brdf(const splat_dump *dump, size_t pixel, double *row)
{
    assay_frame3 frame;
    assay_vec3   wo;
    assay_rgb    base;
    for (int i = 0; i < BRDF_COLUMNS; i++) {
        row[i] = NAN;
    }
    if (assay_splat_has_point(dump->layer->buffer, pixel)) {
        splat_gloss_get(dump->image->gloss, pixel, &frame, &wo, &base);
        put(row, frame.x);
        put(row + 3, frame.y);
        put(row + 6, frame.z);
        put(row + 9, wo);
        put(row + 12, vec3(base.r, base.g, base.b));
    }
}

static void write_weight(const splat_dump *dump, size_t pixel, double *row)
{
    row[0] = assay_splat_weight(dump->layer->buffer, pixel);
}

/* From what records said to radiance: the Lambertian's share of an irradiance. */
static assay_rgb outgoing(const splat_dump *dump, size_t pixel, assay_rgb said)
{
    return dump->layer->source.say
               ? said
               : rgb_scale(rgb_mul(said, dump->image->lambert[pixel]), ASSAY_INV_PI);
}

static void write_sum(const splat_dump *dump, size_t pixel, double *row)
{
    const assay_rgb c = outgoing(dump, pixel, assay_splat_sum(dump->layer->buffer, pixel));
    put(row, vec3(c.r, c.g, c.b));
}

static void write_result(const splat_dump *dump, size_t pixel, double *row)
{
    const assay_rgb c = outgoing(dump, pixel, assay_splat_mean(dump->layer->buffer, pixel));
    put(row, vec3(c.r, c.g, c.b));
}

static void write_fate(const splat_dump *dump, size_t pixel, double *row)
{
    row[0] = dump->layer->fate[pixel];
}

assay_status splat_dump_begin(const splat_image *image, const splat_layer *layer, const char *name,
                              splat_dump *dump_out)
{
    const splat_dump dump   = {.image = image, .layer = layer, .name = name};
    assay_status     status = add_table(&dump, "position", "m", 3, write_position);
    status                  = status ? status : add_table(&dump, "frame", "", 9, write_frame);
    status = status ? status : add_table(&dump, "geometric_normal", "", 3, write_normal);
    status = status ? status : add_table(&dump, "footprint", "m", 1, write_footprint);
    status = status ? status : add_table(&dump, "albedo", "", 3, write_albedo);
    if (status == ASSAY_OK && layer->source.say) {
        status = add_table(&dump, "brdf", "", BRDF_COLUMNS, write_brdf);
        status = status ? status : splat_lobes_add(image, layer, name);
    }
    if (status == ASSAY_OK) {
        *dump_out = dump;
    }
    return status;
}

assay_status splat_dump_tell(void *user, const splat_layer *layer, uint32_t end)
{
    splat_dump *dump  = user;
    void       *grown = dump->ends;
    char        what[WHAT_SIZE];
    (void)layer;
    if (assay_grow(dump->image->context, &grown, &dump->capacity, dump->count + 1,
                   sizeof *dump->ends) != ASSAY_OK) {
        return assay_fail_memory(dump->image->context, "a dump");
    }
    dump->ends              = grown;
    dump->ends[dump->count] = end;
    snprintf(what, sizeof what, "batch.%zu/radiance", dump->count);
    assay_status status = add_table(dump, what, "W/(m2 sr)", 3, write_sum);
    snprintf(what, sizeof what, "batch.%zu/weight", dump->count);
    status = status ? status : add_table(dump, what, "", 1, write_weight);
    dump->count++;
    return status;
}

static assay_status add_ends(const splat_dump *dump)
{
    assay_array *table = NULL;
    char         name[NAME_SIZE];
    assay_status status = assay_array_create(dump->image->context, dump->count, 1, &table);
    if (status == ASSAY_OK) {
        memcpy(assay_array_data(table), dump->ends, dump->count * sizeof *dump->ends);
        snprintf(name, sizeof name, "%s/batch_end", dump->name);
        status = assay_bundle_add_table(dump->image->frame->dump, name, "records", table);
    }
    assay_array_destroy(table);
    return status;
}

assay_status splat_dump_finish(splat_dump *dump)
{
    assay_status status = add_ends(dump);
    status              = status ? status : add_table(dump, "fate", "", 1, write_fate);
    return status ? status : add_table(dump, "result", "W/(m2 sr)", 3, write_result);
}

void splat_dump_release(splat_dump *dump)
{
    if (dump->image) {
        assay_release(dump->image->context, dump->ends);
    }
}
