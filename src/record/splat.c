/* splat.c - tiles of pixels, each of which takes the records that touch it in order.
 *
 * Invariant: a tile belongs to one worker, and goes over its records in the order of their numbers.
 * So a pixel's sums are those of the serial algorithm, whatever the threads, and the weights are
 * added in the very order in which a query of the store adds them.
 *
 * A box only leaves out; what counts is decided by assay_record_weight, after a test of the
 * distance over a whole row of the tile, which is the same as its first one and which compilers do
 * to several pixels at once.  A pixel without a point has NaN for a position, which no record
 * reaches. */
#include "record/splat.h"

#include <assert.h>
#include <string.h>

#include "core/alloc.h"
#include "core/parallel.h"

enum { TILE = ASSAY_SPLAT_TILE, ROW_CHUNK = 16, FEW_PIXELS = 1 << 14 };

struct assay_splat_buffer {
    assay_context   *context;
    int              width, height, columns, rows; /* pixels; tiles                        */
    size_t           pixels;
    assay_splat_view view;
    double          *x, *y, *z;    /* positions, m                                      */
    double          *nx, *ny, *nz; /* unit normals                                      */
    double          *row_stray;    /* a row: how far its points stray, pixels           */
    double          *sums;         /* 4 a pixel: weight times R, G, B, and weight       */
    uint64_t        *lost;         /* a tile                                            */
};

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
    buffer->columns = (width + TILE - 1) / TILE;
    buffer->rows    = (height + TILE - 1) / TILE;
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

static assay_vec3 position_of(const assay_splat_buffer *buffer, size_t pixel)
{
    return vec3(buffer->x[pixel], buffer->y[pixel], buffer->z[pixel]);
}

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
                         assay_splat_stray(&buffer->view, x, y, position_of(buffer, pixel)));
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

/* ---- splatting ---- */

typedef struct {
    assay_splat_buffer       *buffer;
    const assay_splat_source *source;
    uint32_t                  first;
    assay_splat_box           alone; /* of a single record                                     */
    const assay_splat_box    *boxes; /* of the records from first on; NULL: alone              */
    const uint32_t           *list;  /* of each row of tiles, one after the other: ascending   */
    const size_t             *ends;  /* of the rows' parts of the list                         */
    assay_splat_box           tiles; /* that may be touched                                    */
} splat_job;

static assay_splat_box intersect(assay_splat_box a, assay_splat_box b)
{
    return (assay_splat_box){a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0,
                             a.x1 < b.x1 ? a.x1 : b.x1, a.y1 < b.y1 ? a.y1 : b.y1};
}

static bool is_empty(const assay_splat_box *box)
{
    return box->x0 >= box->x1 || box->y0 >= box->y1;
}

/* A record over a part of a tile; billboard: NULL, or what is left of it. */
typedef struct {
    const splat_job       *job;
    uint32_t               number;
    const assay_record    *record;
    const assay_splat_box *billboard;
    assay_splat_box        tile;
    int                    worker;
    uint64_t              *lost;
} splat;

static assay_status splat_pixel(const splat *s, int x, int y, size_t pixel)
{
    const assay_splat_source *source = s->job->source;
    assay_splat_buffer       *buffer = s->job->buffer;
    const assay_vec3          p      = position_of(buffer, pixel);
    const assay_vec3          n = vec3(buffer->nx[pixel], buffer->ny[pixel], buffer->nz[pixel]);
    const double              weight = assay_record_weight(s->record, &source->rules, p, n);
    double                   *sum    = &buffer->sums[4 * pixel];
    assay_rgb                 said;
    if (!(weight > 0.0)) {
        return ASSAY_OK;
    }
    if (s->billboard && !assay_splat_box_holds(s->billboard, x, y)) {
        ++*s->lost;
        return ASSAY_OK;
    }
    if (source->say) {
        const assay_splat_place place  = {.worker   = s->worker,
                                          .slot     = (y - s->tile.y0) * TILE + (x - s->tile.x0),
                                          .pixel    = pixel,
                                          .position = p,
                                          .normal   = n};
        const assay_status      status = source->say(source->user, &place, s->number, &said);
        if (status != ASSAY_OK) {
            return status;
        }
    } else {
        said = assay_record_extrapolate(s->record, &source->rules, p, n);
    }
    sum[0] += weight * said.r;
    sum[1] += weight * said.g;
    sum[2] += weight * said.b;
    sum[3] += weight;
    return ASSAY_OK;
}

static assay_status splat_part(const splat *s, const assay_splat_box *part)
{
    const assay_splat_buffer *buffer = s->job->buffer;
    const assay_vec3          centre = s->record->position;
    const double              reach  = assay_record_reach(s->record, &s->job->source->rules);
    const double              most   = reach * reach;
    const int                 count  = part->x1 - part->x0;
    assay_status              status = ASSAY_OK;
    for (int y = part->y0; y < part->y1 && status == ASSAY_OK; y++) {
        const size_t  first = (size_t)y * (size_t)buffer->width + (size_t)part->x0;
        const double *px = buffer->x + first, *py = buffer->y + first, *pz = buffer->z + first;
        double        squared[TILE];
        for (int i = 0; i < count; i++) {
            const double dx = px[i] - centre.x, dy = py[i] - centre.y, dz = pz[i] - centre.z;
            squared[i] = dx * dx + dy * dy + dz * dz;
        }
        for (int i = 0; i < count && status == ASSAY_OK; i++) {
            if (squared[i] <= most) {
                status = splat_pixel(s, part->x0 + i, y, first + (size_t)i);
            }
        }
    }
    return status;
}

static assay_status splat_record(const splat_job *job, uint32_t number, const assay_splat_box *tile,
                                 size_t tile_index, int worker)
{
    const assay_splat_box part =
        intersect(job->boxes ? job->boxes[number - job->first] : job->alone, *tile);
    if (is_empty(&part)) {
        return ASSAY_OK;
    }
    const assay_record *record = assay_record_store_at(job->source->store, number);
    assay_splat_box     billboard;
    splat               s = {.job    = job,
                             .number = number,
                             .record = record,
                             .tile   = *tile,
                             .worker = worker,
                             .lost   = &job->buffer->lost[tile_index]};
    if (job->source->bounds == ASSAY_SPLAT_BOUNDS_PUBLISHED) {
        billboard   = assay_splat_billboard(&job->buffer->view, record->position,
                                            job->source->rules.a * record->radius);
        s.billboard = &billboard;
    }
    return splat_part(&s, &part);
}

static assay_status splat_tile(void *user, uint64_t index, int worker)
{
    const splat_job          *job     = user;
    const assay_splat_buffer *buffer  = job->buffer;
    const int                 columns = job->tiles.x1 - job->tiles.x0;
    const int                 column  = job->tiles.x0 + (int)(index % (uint64_t)columns);
    const int                 row     = job->tiles.y0 + (int)(index / (uint64_t)columns);
    const size_t              number  = (size_t)row * (size_t)buffer->columns + (size_t)column;
    const assay_splat_box     tile    = {
               .x0 = column * TILE, .y0 = row * TILE, .x1 = (column + 1) * TILE, .y1 = (row + 1) * TILE};
    assay_status status = ASSAY_OK;
    if (!job->list) {
        return splat_record(job, job->first, &tile, number, worker);
    }
    for (size_t i = row > 0 ? job->ends[row - 1] : 0; i < job->ends[row] && status == ASSAY_OK;
         i++) {
        status = splat_record(job, job->list[i], &tile, number, worker);
    }
    return status;
}

static assay_splat_box box_of(const splat_job *job, uint32_t number)
{
    const assay_record *record = assay_record_store_at(job->source->store, number);
    return assay_splat_bounds(&job->buffer->view, record->position,
                              assay_record_reach(record, &job->source->rules));
}

static int tile_after(int end) { return (end + TILE - 1) / TILE; }

/* A record alone, as they come one by one: without any list. */
static assay_status splat_one(splat_job *job)
{
    const assay_splat_box box = box_of(job, job->first);
    if (is_empty(&box)) {
        return ASSAY_OK;
    }
    job->alone = box;
    job->tiles =
        (assay_splat_box){box.x0 / TILE, box.y0 / TILE, tile_after(box.x1), tile_after(box.y1)};
    const uint64_t tiles =
        (uint64_t)(job->tiles.x1 - job->tiles.x0) * (uint64_t)(job->tiles.y1 - job->tiles.y0);
    if ((int64_t)(box.x1 - box.x0) * (box.y1 - box.y0) > FEW_PIXELS) {
        return assay_parallel_for(job->buffer->context, NULL, tiles, splat_tile, job);
    }
    assay_status status = ASSAY_OK;
    for (uint64_t i = 0; i < tiles && status == ASSAY_OK; i++) {
        status = splat_tile(job, i, 0);
    }
    return status;
}

/* ends: a row of tiles; at first how many records touch it, at last where its part of the list
 * ends. */
static void count_rows(const assay_splat_box *boxes, uint32_t count, size_t *ends, int rows)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!is_empty(&boxes[i])) {
            for (int row = boxes[i].y0 / TILE; row < tile_after(boxes[i].y1); row++) {
                ends[row]++;
            }
        }
    }
    for (int row = 1; row < rows; row++) {
        ends[row] += ends[row - 1];
    }
}

/* Backwards, so that each row's part fills from its end and is ascending. */
static void fill_rows(const assay_splat_box *boxes, uint32_t first, uint32_t count, size_t *places,
                      uint32_t *list)
{
    for (uint32_t i = count; i-- > 0;) {
        if (!is_empty(&boxes[i])) {
            for (int row = boxes[i].y0 / TILE; row < tile_after(boxes[i].y1); row++) {
                list[--places[row]] = first + i;
            }
        }
    }
}

static assay_status splat_many(splat_job *job, uint32_t count)
{
    assay_context   *context = job->buffer->context;
    const int        rows    = job->buffer->rows;
    assay_splat_box *boxes   = assay_allocate(context, count, sizeof *boxes);
    size_t          *ends    = assay_allocate(context, 2 * (size_t)rows, sizeof *ends);
    uint32_t        *list    = NULL;
    if (boxes && ends) {
        for (uint32_t i = 0; i < count; i++) {
            boxes[i] = box_of(job, job->first + i);
        }
        count_rows(boxes, count, ends, rows);
        memcpy(ends + rows, ends, (size_t)rows * sizeof *ends);
        list = assay_allocate(context, ends[rows - 1], sizeof *list);
    }
    assay_status status = ASSAY_ERR_MEMORY;
    if (list) {
        fill_rows(boxes, job->first, count, ends + rows, list);
        job->boxes = boxes;
        job->list  = list;
        job->ends  = ends;
        job->tiles = (assay_splat_box){0, 0, job->buffer->columns, rows};
        status = assay_parallel_for(context, NULL, (uint64_t)rows * (uint64_t)job->buffer->columns,
                                    splat_tile, job);
    } else {
        assay_fail_memory(context, "the bounds of records");
    }
    assay_release(context, boxes);
    assay_release(context, ends);
    assay_release(context, list);
    return status;
}

assay_status assay_splat_records(assay_splat_buffer *buffer, const assay_splat_source *source,
                                 uint32_t first, uint32_t end)
{
    splat_job job = {.buffer = buffer, .source = source, .first = first};
    assert(end <= assay_record_store_count(source->store));
    if (first >= end) {
        return ASSAY_OK;
    }
    return end - first == 1 ? splat_one(&job) : splat_many(&job, end - first);
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
