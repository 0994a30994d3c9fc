/* splat.c - tiles of pixels, each of which takes the records that touch it in order.
 *
 * Invariant: a tile belongs to one worker, and goes over its records in the order of their numbers.
 * So a pixel's sums are those of the serial algorithm, whatever the threads, and the weights are
 * added in the very order in which a query of the store adds them.
 *
 * A box only leaves out; what counts is decided by assay_record_weight, after a test of the
 * distance over a whole row of the tile, which is the same as its first one and which compilers do
 * to several pixels at once. */
#include "record/splat.h"

#include <assert.h>
#include <string.h>

#include "core/alloc.h"
#include "core/parallel.h"
#include "record/record_inline.h"
#include "record/splat_data.h"

enum { TILE = ASSAY_SPLAT_TILE, FEW_PIXELS = 1 << 14 };

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

static void add(double *sum, double weight, assay_rgb said)
{
    sum[0] += weight * said.r;
    sum[1] += weight * said.g;
    sum[2] += weight * said.b;
    sum[3] += weight;
}

static assay_status splat_pixel(const splat *s, int x, int y, size_t pixel)
{
    const assay_splat_source *source = s->job->source;
    assay_splat_buffer       *buffer = s->job->buffer;
    const assay_vec3          p      = splat_position(buffer, pixel);
    const assay_vec3          n      = splat_normal(buffer, pixel);
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
    add(sum, weight, said);
    return ASSAY_OK;
}

/* Squared distances of a row's points. */
static void measure_row(const assay_splat_buffer *buffer, assay_vec3 centre, size_t first,
                        int count, double squared[TILE])
{
    const double *x = buffer->x + first, *y = buffer->y + first, *z = buffer->z + first;
    for (int i = 0; i < count; i++) {
        const double dx = x[i] - centre.x, dy = y[i] - centre.y, dz = z[i] - centre.z;
        squared[i] = dx * dx + dy * dy + dz * dz;
    }
}

static size_t pixel_at(const assay_splat_buffer *buffer, int x, int y)
{
    return (size_t)y * (size_t)buffer->width + (size_t)x;
}

static assay_status splat_part(const splat *s, const assay_splat_box *part)
{
    const assay_splat_buffer *buffer = s->job->buffer;
    const double              reach  = assay_record_reach(s->record, &s->job->source->rules);
    const double              most   = reach * reach;
    const int                 count  = part->x1 - part->x0;
    assay_status              status = ASSAY_OK;
    for (int y = part->y0; y < part->y1 && status == ASSAY_OK; y++) {
        const size_t first = pixel_at(buffer, part->x0, y);
        double       squared[TILE];
        measure_row(buffer, s->record->position, first, count, squared);
        for (int i = 0; i < count && status == ASSAY_OK; i++) {
            if (squared[i] <= most) {
                status = splat_pixel(s, part->x0 + i, y, first + (size_t)i);
            }
        }
    }
    return status;
}

/* The same for irradiance in exact bounds.  Copies of record and rules, as no sum can then be among
 * them: what does not depend on the pixel leaves the loop. */
static void splat_part_of_irradiance(const splat *s, const assay_splat_box *part)
{
    const assay_splat_buffer *buffer = s->job->buffer;
    const assay_record        record = *s->record;
    const assay_record_rules  rules  = s->job->source->rules;
    const double              reach  = record_reach(&record, &rules);
    const double              most   = reach * reach;
    const int                 count  = part->x1 - part->x0;
    for (int y = part->y0; y < part->y1; y++) {
        const size_t first = pixel_at(buffer, part->x0, y);
        double       squared[TILE];
        measure_row(buffer, record.position, first, count, squared);
        for (int i = 0; i < count; i++) {
            const size_t pixel = first + (size_t)i;
            if (squared[i] <= most) {
                const assay_vec3 p      = splat_position(buffer, pixel);
                const assay_vec3 n      = splat_normal(buffer, pixel);
                const double     weight = record_weight(&record, &rules, p, n);
                if (weight > 0.0) {
                    add(&buffer->sums[4 * pixel], weight,
                        record_extrapolate(&record, &rules, p, n));
                }
            }
        }
    }
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
    if (s.billboard || job->source->say) {
        return splat_part(&s, &part);
    }
    splat_part_of_irradiance(&s, &part);
    return ASSAY_OK;
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
