/* plot.c - curves in a frame.
 *
 * Invariant: the frame's inside is [left, right] x [top, bottom] in pixels, and all drawing of
 * curves is clipped to it. */
#include "assay/plot.h"

#include <math.h>
#include <stdio.h>

#include "core/context.h"
#include "core/numerics.h"
#include "io/canvas.h"

enum { MIN_SIZE = 200, MAX_SIZE = 4096 };

static const assay_rgb INK  = {0.02, 0.02, 0.02};
static const assay_rgb GRID = {0.78, 0.78, 0.78};

/* Linear light; apart in lightness as well as in hue, for those who do not see all hues. */
static const assay_rgb COLORS[ASSAY_PLOT_MAX_CURVES] = {
    {0.70, 0.02, 0.02}, {0.01, 0.10, 0.60}, {0.02, 0.30, 0.05}, {0.80, 0.28, 0.00},
    {0.30, 0.02, 0.40}, {0.02, 0.40, 0.55}, {0.10, 0.10, 0.10}, {0.45, 0.20, 0.08}};

typedef struct {
    const assay_plot *plot;
    assay_canvas      canvas;
    double            left, right, top, bottom; /* pixels */
    double            letter;                   /* height of capitals, pixels */
} frame;

static double across(const frame *f, double x)
{
    return f->left +
           (x - f->plot->x_min) / (f->plot->x_max - f->plot->x_min) * (f->right - f->left);
}

static double down(const frame *f, double y)
{
    return f->bottom -
           (y - f->plot->y_min) / (f->plot->y_max - f->plot->y_min) * (f->bottom - f->top);
}

/* The smallest of 1, 2, 5 times a power of ten that cuts a range into at most `most` steps; its
 * power of ten goes to *decimals_out, as digits behind the point. */
static double tick_step(double range, int most, int *decimals_out)
{
    double decade   = 1.0;
    int    decimals = 0;
    while (range / decade < most) {
        decade /= 10.0;
        decimals++;
    }
    static const double steps[] = {1.0, 2.0, 5.0};
    for (;;) {
        for (int i = 0; i < 3; i++) {
            if (range / (steps[i] * decade) <= most) {
                *decimals_out = decimals > 0 ? decimals : 0;
                return steps[i] * decade;
            }
        }
        decade *= 10.0;
        decimals--;
    }
}

/* Multiples of a step, from the first one in the range on. */
typedef struct {
    double step, first;
    int    count, decimals;
} tick_row;

static tick_row find_ticks(double low, double high)
{
    tick_row ticks;
    ticks.step  = tick_step(high - low, 10, &ticks.decimals);
    ticks.first = ceil(low / ticks.step - 1e-9);
    ticks.count = (int)(floor(high / ticks.step + 1e-9) - ticks.first) + 1;
    return ticks;
}

/* Its value, with its digits in text (40 characters); never -0. */
static double read_tick(const tick_row *ticks, int i, char *text)
{
    const double value = (ticks->first + i) * ticks->step + 0.0;
    snprintf(text, 40, "%.*f", ticks->decimals, value);
    return value;
}

static void draw_x_ticks(const frame *f)
{
    const tick_row ticks = find_ticks(f->plot->x_min, f->plot->x_max);
    for (int i = 0; i < ticks.count; i++) {
        char         text[40];
        const double x = across(f, read_tick(&ticks, i, text));
        assay_canvas_stroke(&f->canvas, x, f->top, x, f->bottom, 1.0, GRID);
        assay_canvas_text(&f->canvas, x - 0.5 * assay_text_width(f->letter, text),
                          f->bottom + 2.0 * f->letter, f->letter, false, INK, text);
    }
}

/* Gives the width of the widest number. */
static double draw_y_ticks(const frame *f)
{
    double         widest = 0.0;
    const tick_row ticks  = find_ticks(f->plot->y_min, f->plot->y_max);
    for (int i = 0; i < ticks.count; i++) {
        char         text[40];
        const double y     = down(f, read_tick(&ticks, i, text));
        const double width = assay_text_width(f->letter, text);
        widest             = fmax(widest, width);
        assay_canvas_stroke(&f->canvas, f->left, y, f->right, y, 1.0, GRID);
        assay_canvas_text(&f->canvas, f->left - width - f->letter, y + 0.5 * f->letter, f->letter,
                          false, INK, text);
    }
    return widest;
}

static void draw_frame(const frame *f)
{
    const assay_canvas *c      = &f->canvas;
    const double        widest = draw_y_ticks(f);
    draw_x_ticks(f);
    assay_canvas_stroke(c, f->left, f->top, f->left, f->bottom, 1.5, INK);
    assay_canvas_stroke(c, f->left, f->bottom, f->right, f->bottom, 1.5, INK);

    const double title = 1.3 * f->letter;
    assay_canvas_text(c, 0.5 * (f->left + f->right - assay_text_width(title, f->plot->title)),
                      f->top - 1.3 * f->letter, title, false, INK, f->plot->title);
    assay_canvas_text(c, 0.5 * (f->left + f->right - assay_text_width(f->letter, f->plot->x_label)),
                      f->bottom + 4.2 * f->letter, f->letter, false, INK, f->plot->x_label);
    assay_canvas_text(c, f->left - widest - 2.2 * f->letter,
                      0.5 * (f->top + f->bottom + assay_text_width(f->letter, f->plot->y_label)),
                      f->letter, true, INK, f->plot->y_label);
}

/* Cuts a segment to 0 <= q <= 1 of one coordinate (q0 to q1); the ends as shares of the segment. */
static bool clip(double q0, double q1, double low, double high, double *start, double *end)
{
    const double d = q1 - q0;
    if (d == 0.0) {
        return q0 >= low && q0 <= high;
    }
    const double a = (low - q0) / d, b = (high - q0) / d;
    *start = fmax(*start, fmin(a, b));
    *end   = fmin(*end, fmax(a, b));
    return *start <= *end;
}

static void draw_segment(const frame *f, double x0, double y0, double x1, double y1,
                         assay_rgb color)
{
    double start = 0.0, end = 1.0;
    if (clip(x0, x1, f->left, f->right, &start, &end) &&
        clip(y0, y1, f->top, f->bottom, &start, &end)) {
        assay_canvas_stroke(&f->canvas, x0 + start * (x1 - x0), y0 + start * (y1 - y0),
                            x0 + end * (x1 - x0), y0 + end * (y1 - y0), 2.2, color);
    }
}

/* One of a few shapes, so that curves can be told apart in grey. */
static void draw_mark(const frame *f, double x, double y, size_t kind, assay_rgb color)
{
    const assay_canvas *c = &f->canvas;
    const double        r = 0.35 * f->letter;
    if (x < f->left || x > f->right || y < f->top || y > f->bottom) {
        return;
    }
    switch (kind % 4) {
    case 0: assay_canvas_stroke(c, x, y, x, y, 2.4 * r, color); break;
    case 1:
        assay_canvas_stroke(c, x - r, y - r, x + r, y + r, 1.8, color);
        assay_canvas_stroke(c, x - r, y + r, x + r, y - r, 1.8, color);
        break;
    case 2:
        assay_canvas_stroke(c, x - r, y, x + r, y, 1.8, color);
        assay_canvas_stroke(c, x, y - r, x, y + r, 1.8, color);
        break;
    default:
        assay_canvas_stroke(c, x - r, y + r, x + r, y + r, 1.8, color);
        assay_canvas_stroke(c, x + r, y + r, x, y - r, 1.8, color);
        assay_canvas_stroke(c, x, y - r, x - r, y + r, 1.8, color);
        break;
    }
}

static void draw_curve(const frame *f, size_t index)
{
    const assay_plot_curve *curve = &f->plot->curves[index];
    const assay_rgb         color = COLORS[index];
    for (size_t i = 0; i < curve->count; i++) {
        const double x = across(f, curve->x[i]), y = down(f, curve->y[i]);
        if (i > 0) {
            draw_segment(f, across(f, curve->x[i - 1]), down(f, curve->y[i - 1]), x, y, color);
        }
        draw_mark(f, x, y, index, color);
    }
}

static void draw_legend(const frame *f)
{
    double       widest = 0.0;
    const double line   = 2.0 * f->letter;
    for (size_t i = 0; i < f->plot->curve_count; i++) {
        widest = fmax(widest, assay_text_width(f->letter, f->plot->curves[i].name));
    }
    const double left   = f->right - widest - 6.0 * f->letter;
    const double bottom = f->bottom - f->letter;
    const double top    = bottom - line * (double)f->plot->curve_count - 0.6 * f->letter;
    for (int i = 0; i <= (int)(bottom - top); i++) {
        assay_canvas_stroke(&f->canvas, left, top + i, f->right - f->letter, top + i, 2.0,
                            (assay_rgb){1.0, 1.0, 1.0});
    }
    for (size_t i = 0; i < f->plot->curve_count; i++) {
        const double y = top + line * (double)(i + 1);
        const double x = left + f->letter, middle = y - 0.5 * f->letter;
        assay_canvas_stroke(&f->canvas, x, middle, x + 2.0 * f->letter, middle, 2.2, COLORS[i]);
        draw_mark(f, x + f->letter, middle, i, COLORS[i]);
        assay_canvas_text(&f->canvas, x + 3.0 * f->letter, y, f->letter, false, INK,
                          f->plot->curves[i].name);
    }
}

/* What ticks can be counted on. */
static bool is_range(double low, double high)
{
    const double largest = fmax(1.0, fmax(fabs(low), fabs(high)));
    return high - low >= 1e-6 * largest && largest <= 1e9;
}

static assay_status check(assay_context *context, const assay_plot *p, int width, int height)
{
    if (width < MIN_SIZE || height < MIN_SIZE || width > MAX_SIZE || height > MAX_SIZE) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a plot of %d x %d pixels: from %d to %d each way are possible", width,
                          height, MIN_SIZE, MAX_SIZE);
    }
    if (!is_range(p->x_min, p->x_max) || !is_range(p->y_min, p->y_max) ||
        p->curve_count > ASSAY_PLOT_MAX_CURVES) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a plot needs axes with min < max, within +-1e9 and a millionth of that "
                          "apart, and at most %d curves",
                          ASSAY_PLOT_MAX_CURVES);
    }
    for (size_t c = 0; c < p->curve_count; c++) {
        for (size_t i = 0; i < p->curves[c].count; i++) {
            if (!isfinite(p->curves[c].x[i]) || !isfinite(p->curves[c].y[i])) {
                return assay_fail(context, ASSAY_ERR_DOMAIN,
                                  "plot: point %zu of '%.60s' is not "
                                  "finite",
                                  i, p->curves[c].name);
            }
        }
    }
    return ASSAY_OK;
}

assay_status assay_plot_draw(assay_context *context, const assay_plot *plot, int width, int height,
                             assay_image **image_out)
{
    assay_image *image  = NULL;
    assay_status status = check(context, plot, width, height);
    if (status == ASSAY_OK) {
        status = assay_canvas_create(context, width, height, &image);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    frame f  = {.plot = plot, .letter = fmax(7.0, 0.022 * fmin(width, height))};
    f.left   = 8.5 * f.letter;
    f.right  = width - 2.0 * f.letter;
    f.top    = 4.0 * f.letter;
    f.bottom = height - 5.5 * f.letter;
    assay_canvas_open(image, &f.canvas);
    draw_frame(&f);
    for (size_t i = plot->curve_count; i-- > 0;) {
        draw_curve(&f, i);
    }
    draw_legend(&f);
    *image_out = image;
    return ASSAY_OK;
}
