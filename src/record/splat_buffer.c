/* splat_buffer.c - points and sums of an image.
 *
 * A pixel without a point has NaN for a position, which no record reaches. */
#include "record/splat.h"

#include <assert.h>
#include <string.h>

#include "core/alloc.h"
#include "core/parallel.h"
#include "record/splat_data.h"

enum { ROW_CHUNK = 16 };

/* ---- room ---- */

void assay_splat_buffer_destroy(assay_splat_buffer *buffer)
{
    if (buffer) {
        double *const blocks[] = {buffer->x,  buffer->y,  buffer->z,         buffer->nx,
                                  buffer->ny, buffer->nz, buffer->row_stray, buffer->sums};
        for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; i++) {
            assay_release(buffer->context, blocks[i]);
        }
        assay_release(buffer->context, buffer->lost);
        assay_release(buffer->context, buffer);
    }
}

static bool allocate(assay_splat_buffer *b)
{
    double **const points[] = {&b->x, &b->y, &b->z, &b->nx, &b->ny, &b->nz};
    bool           have     = true;
    for (size_t i = 0; i < sizeof points / sizeof points[0]; i++) {
        *points[i] = assay_allocate(b->context, b->pixels, sizeof(double));
        have       = have && *points[i];
    }
    b->row_stray = assay_allocate(b->context, (size_t)b->height, sizeof(double));
    b->sums      = assay_allocate(b->context, b->pixels, 4 * sizeof(double));
    b->lost = assay_allocate(b->context, (size_t)b->columns * (size_t)b->rows, sizeof *b->lost);
    return have && b->row_stray && b->sums && b->lost;
}

assay_status assay_splat_buffer_create(assay_context *context, int width, int height,
                                       assay_splat_buffer **buffer_out)
{
    assay_splat_buffer *buffer = assay_allocate(context, 1, sizeof *buffer);
    if (!buffer) {
        return assay_fail_memory(context, "a splat buffer");
    }
    buffer->context = context;
    buffer->width   = width;
    buffer->height  = height;
    buffer->columns = (width + ASSAY_SPLAT_TILE - 1) / ASSAY_SPLAT_TILE;
    buffer->rows    = (height + ASSAY_SPLAT_TILE - 1) / ASSAY_SPLAT_TILE;
    buffer->pixels  = (size_t)width * (size_t)height;
    if (!allocate(buffer)) {
        assay_splat_buffer_destroy(buffer);
        return assay_fail_memory(context, "a splat buffer");
    }
    *buffer_out = buffer;
    return ASSAY_OK;
}

/* ---- points ---- */

void assay_splat_buffer_look(assay_splat_buffer *buffer, const assay_camera *camera)
{
    buffer->view = assay_splat_view_of(camera, buffer->width, buffer->height);
    for (size_t i = 0; i < buffer->pixels; i++) {
        buffer->x[i] = NAN;
    }
}

void assay_splat_buffer_set(assay_splat_buffer *buffer, size_t pixel, assay_vec3 position,
                            assay_vec3 normal)
{
    assert(pixel < buffer->pixels);
    buffer->x[pixel]  = position.x;
    buffer->y[pixel]  = position.y;
    buffer->z[pixel]  = position.z;
    buffer->nx[pixel] = normal.x;
    buffer->ny[pixel] = normal.y;
    buffer->nz[pixel] = normal.z;
}

bool assay_splat_has_point(const assay_splat_buffer *buffer, size_t pixel)
{
    return !isnan(buffer->x[pixel]);
}

assay_context *assay_splat_context(const assay_splat_buffer *buffer) { return buffer->context; }

static assay_status measure_rows(void *user, uint64_t chunk, int worker)
{
    assay_splat_buffer *buffer = user;
    const int           first  = (int)chunk * ROW_CHUNK;
    (void)worker;
    for (int y = first; y < first + ROW_CHUNK && y < buffer->height; y++) {
        buffer->row_stray[y] = 0.0;
        for (int x = 0; x < buffer->width; x++) {
            const size_t pixel = (size_t)y * (size_t)buffer->width + (size_t)x;
            if (assay_splat_has_point(buffer, pixel)) {
                buffer->row_stray[y] =
                    fmax(buffer->row_stray[y],
                         assay_splat_stray(&buffer->view, x, y, splat_position(buffer, pixel)));
            }
        }
    }
    return ASSAY_OK;
}

assay_status assay_splat_buffer_close(assay_splat_buffer *buffer)
{
    const uint64_t     chunks = ((uint64_t)buffer->height + ROW_CHUNK - 1) / ROW_CHUNK;
    const assay_status status =
        assay_parallel_for(buffer->context, NULL, chunks, measure_rows, buffer);
    buffer->view.stray = 0.0;
    for (int y = 0; y < buffer->height; y++) {
        buffer->view.stray = fmax(buffer->view.stray, buffer->row_stray[y]);
    }
    assay_splat_buffer_clear(buffer);
    return status;
}

/* ---- sums ---- */

void assay_splat_buffer_clear(assay_splat_buffer *buffer)
{
    const size_t tiles = (size_t)buffer->columns * (size_t)buffer->rows;
    memset(buffer->sums, 0, buffer->pixels * 4 * sizeof *buffer->sums);
    memset(buffer->lost, 0, tiles * sizeof *buffer->lost);
}

double assay_splat_weight(const assay_splat_buffer *buffer, size_t pixel)
{
    return buffer->sums[4 * pixel + 3];
}

assay_rgb assay_splat_sum(const assay_splat_buffer *buffer, size_t pixel)
{
    const double *sum = &buffer->sums[4 * pixel];
    return rgb(sum[0], sum[1], sum[2]);
}

assay_rgb assay_splat_mean(const assay_splat_buffer *buffer, size_t pixel)
{
    const double    weight = assay_splat_weight(buffer, pixel);
    const assay_rgb sum    = assay_splat_sum(buffer, pixel);
    return weight > 0.0 ? rgb(sum.r / weight, sum.g / weight, sum.b / weight) : rgb_grey(0.0);
}

uint64_t assay_splat_lost(const assay_splat_buffer *buffer)
{
    uint64_t     sum   = 0;
    const size_t tiles = (size_t)buffer->columns * (size_t)buffer->rows;
    for (size_t i = 0; i < tiles; i++) {
        sum += buffer->lost[i];
    }
    return sum;
}
