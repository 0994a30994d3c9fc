/* report_pack.c - Invariant: whoever knows floor, K and the layout below gets the integers back
 * exactly; only signed_log and quantise_log lose anything.
 *
 * Green comes first, red and blue as what they have more than green, for their noise is mostly its
 * noise.  An integer is predicted from its neighbours at the left and above (the median edge
 * detector of LOCO-I [weinberger00]), and what is left is folded to 0, -1, 1, -2, ... so that small
 * means few bits.  All sums wrap at 16 bits, so nothing can overflow.  Low bytes of all planes come
 * before high bytes: these are nearly always 0, and deflate makes nothing of them. */
#include "oracle/report/report_pack.h"

#include <math.h>
#include <string.h>
#include <zlib.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/parallel.h"

/* log2(1 + |v| / floor) with the sign of v; what has no logarithm stays as it is. */
static float signed_log(float value, double floor)
{
    if (!isfinite(value)) {
        return value;
    }
    const double log = assay_log1p(fabs((double)value) / floor) * 1.4426950408889634;
    return (float)(value < 0.0F ? -log : log);
}

static int16_t quantise_log(float log, int steps)
{
    if (isnan(log)) {
        return ASSAY_PACK_NAN;
    }
    double code = ASSAY_PACK_INFINITE;
    if (!isinf(log)) {
        code = fmin(assay_floor(steps * fabs((double)log) + 0.5), ASSAY_PACK_LARGEST);
    }
    return (int16_t)(log < 0.0F ? -code : code);
}

static int16_t predict(const int16_t *row, const int16_t *above, int x)
{
    const int left = x > 0 ? row[x - 1] : above ? above[0] : 0;
    const int up   = above ? above[x] : left;
    const int both = x > 0 && above ? above[x - 1] : up;
    const int low = left < up ? left : up, high = left < up ? up : left;
    return (int16_t)(both >= high ? low : both <= low ? high : left + up - both);
}

static uint16_t fold(int16_t residual)
{
    return (uint16_t)(((uint16_t)residual << 1) ^ (residual < 0 ? 0xffffu : 0u));
}

/* The 16-bit difference that wraps. */
static int16_t less(int16_t a, int16_t b) { return (int16_t)(uint16_t)((unsigned)a - (unsigned)b); }

/* Folded residuals of a plane of integers, low bytes and high bytes apart. */
static void spread(const int16_t *codes, int width, int height, uint8_t *low, uint8_t *high)
{
    for (int y = 0; y < height; y++) {
        const int16_t *row   = codes + (size_t)y * (size_t)width;
        const int16_t *above = y > 0 ? row - width : NULL;
        for (int x = 0; x < width; x++) {
            const uint16_t word = fold(less(row[x], predict(row, above, x)));
            const size_t   at   = (size_t)y * (size_t)width + (size_t)x;
            low[at]             = (uint8_t)(word & 255u);
            high[at]            = (uint8_t)(word >> 8);
        }
    }
}

static void *allocate(void *context, unsigned items, unsigned size)
{
    return assay_allocate(context, items, size);
}

static void release(void *context, void *memory) { assay_release(context, memory); }

/* Deflates `total` bytes into `room`, which suffices for anything. */
static assay_status deflate_bytes(assay_context *context, uint8_t *from, size_t total, uint8_t *to,
                                  size_t room, size_t *count_out)
{
    const size_t most   = (size_t)1 << 30; /* zlib counts in unsigned ints */
    z_stream     stream = {.zalloc = allocate, .zfree = release, .opaque = context};
    if (deflateInit2(&stream, 6, Z_DEFLATED, 15, 9, Z_RLE) != Z_OK) {
        return assay_fail_memory(context, "a compressed picture");
    }
    size_t given = 0, taken = 0;
    int    state = Z_OK;
    while (state == Z_OK) {
        const size_t in  = total - given < most ? total - given : most;
        const size_t out = room - taken < most ? room - taken : most;
        stream.next_in   = from + given;
        stream.avail_in  = (unsigned)in;
        stream.next_out  = to + taken;
        stream.avail_out = (unsigned)out;
        state            = deflate(&stream, given + in == total ? Z_FINISH : Z_NO_FLUSH);
        given += in - stream.avail_in;
        taken += out - stream.avail_out;
    }
    deflateEnd(&stream);
    if (state != Z_STREAM_END) {
        return assay_fail(context, ASSAY_ERR_INTERNAL, "zlib: error %d", state);
    }
    *count_out = taken;
    return ASSAY_OK;
}

typedef struct {
    const float *const *values;
    float              *logs[3]; /* of the values: made once, quantised as often as it takes */
    int16_t            *codes[3];
    uint8_t            *bytes, *packed;
    size_t              pixels, room;
    assay_report_pack  *pack;
} pack_work;

static assay_status take_logs(void *user, uint64_t y, int worker)
{
    const pack_work *work  = user;
    const size_t     width = (size_t)work->pack->width;
    (void)worker;
    for (int p = 0; p < work->pack->planes; p++) {
        for (size_t i = (size_t)y * width; i < ((size_t)y + 1) * width; i++) {
            work->logs[p][i] = signed_log(work->values[p][i], work->pack->floor);
        }
    }
    return ASSAY_OK;
}

static assay_status quantise_row(void *user, uint64_t y, int worker)
{
    const pack_work *work  = user;
    const size_t     width = (size_t)work->pack->width;
    (void)worker;
    for (size_t i = (size_t)y * width; i < ((size_t)y + 1) * width; i++) {
        int16_t code[3] = {0, 0, 0};
        for (int p = 0; p < work->pack->planes; p++) {
            code[p] = quantise_log(work->logs[p][i], work->pack->steps);
        }
        const bool colour = work->pack->planes == 3;
        work->codes[0][i] = colour ? code[1] : code[0];
        if (colour) {
            work->codes[1][i] = less(code[0], code[1]);
            work->codes[2][i] = less(code[2], code[1]);
        }
    }
    return ASSAY_OK;
}

static assay_status spread_plane(void *user, uint64_t plane, int worker)
{
    const pack_work *work   = user;
    const size_t     offset = (size_t)plane * work->pixels;
    uint8_t         *high   = work->bytes + (size_t)work->pack->planes * work->pixels;
    (void)worker;
    spread(work->codes[plane], work->pack->width, work->pack->height, work->bytes + offset,
           high + offset);
    return ASSAY_OK;
}

static assay_status quantise(assay_context *context, pack_work *work)
{
    const assay_status status =
        assay_parallel_for(context, NULL, (uint64_t)work->pack->height, quantise_row, work);
    return status ? status
                  : assay_parallel_for(context, NULL, (uint64_t)work->pack->planes, spread_plane,
                                       work);
}

/* The first coarser step that may fit: half as many steps take a bit from every value. */
static const int *coarser(const int *steps, size_t count, size_t budget, size_t values)
{
    const double bits = 8.0 * ((double)count - (double)budget) / (double)values;
    const int   *next = steps + 1;
    while (next[1] && *next > *steps * assay_exp2(-0.9 * bits)) {
        next++;
    }
    return next;
}

static assay_status pack_planes(assay_context *context, pack_work *work, const int *steps,
                                size_t budget, assay_report_pack *pack)
{
    const size_t values = (size_t)pack->planes * work->pixels;
    assay_status status =
        assay_parallel_for(context, NULL, (uint64_t)pack->height, take_logs, work);
    for (;;) {
        pack->steps = *steps;
        status      = status ? status : quantise(context, work);
        status      = status ? status
                             : deflate_bytes(context, work->bytes, 2 * values, work->packed, work->room,
                                             &pack->count);
        if (status != ASSAY_OK || pack->count <= budget || !steps[1]) {
            return status;
        }
        steps = coarser(steps, pack->count, budget, values);
    }
}

assay_status assay_report_pack_create(assay_context *context, int width, int height, int planes,
                                      const float *const *values, double floor, const int *steps,
                                      size_t budget, assay_report_pack *pack_out)
{
    assay_report_pack pack = {width, height, planes, floor, 0, NULL, 0};
    pack_work    work = {.values = values, .pixels = (size_t)width * (size_t)height, .pack = &pack};
    const size_t total = 2 * (size_t)planes * work.pixels;
    work.room          = total + total / 1000 + 64; /* what does not shrink grows by less */
    bool there         = (work.bytes = assay_allocate(context, total, 1)) &&
                 (work.packed = assay_allocate(context, work.room, 1));
    for (int p = 0; there && p < planes; p++) {
        there = (work.codes[p] = assay_allocate(context, work.pixels, sizeof *work.codes[p])) &&
                (work.logs[p] = assay_allocate(context, work.pixels, sizeof *work.logs[p]));
    }
    assay_status status = there ? pack_planes(context, &work, steps, budget, &pack)
                                : assay_fail_memory(context, "a packed picture");
    if (status == ASSAY_OK) {
        pack.bytes = assay_allocate(context, pack.count, 1);
        status     = pack.bytes ? ASSAY_OK : assay_fail_memory(context, "a packed picture");
    }
    if (status == ASSAY_OK && pack.bytes && work.packed) {
        memcpy(pack.bytes, work.packed, pack.count);
        *pack_out = pack;
    }
    for (int p = 0; p < planes; p++) {
        assay_release(context, work.codes[p]);
        assay_release(context, work.logs[p]);
    }
    assay_release(context, work.bytes);
    assay_release(context, work.packed);
    return status;
}

void assay_report_pack_release(assay_context *context, assay_report_pack *pack)
{
    assay_release(context, pack->bytes);
    pack->bytes = NULL;
}
