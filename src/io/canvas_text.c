/* canvas_text.c - text from the strokes of stroke_font.c. */
#include "assay/plot.h"
#include "io/canvas.h"
#include "io/stroke_font.h"

static int digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

static double unit_of(double height) { return height / (double)(STROKE_CAPITAL - STROKE_BASELINE); }

/* Strokes get thicker with the letters, but stay visible. */
static double pen_of(double height) { return height < 8.0 ? 1.0 : height / 8.0; }

typedef struct {
    double x, y;
} pen_point;

static pen_point place(double x, double y, double unit, bool upward, double gx, const char *pair)
{
    const double right = (gx + digit(pair[0])) * unit;
    const double up    = (digit(pair[1]) - STROKE_BASELINE) * unit;
    return upward ? (pen_point){x - up, y - right} : (pen_point){x + right, y - up};
}

static void draw_glyph(const assay_canvas *canvas, pen_point origin, double height, bool upward,
                       double gx, assay_rgb color, const char *glyph)
{
    const double unit = unit_of(height);
    pen_point    last = {0.0, 0.0};
    bool         down = false;
    while (*glyph) {
        if (*glyph == ' ') {
            down = false;
            glyph++;
            continue;
        }
        const pen_point at = place(origin.x, origin.y, unit, upward, gx, glyph);
        if (down) {
            assay_canvas_stroke(canvas, last.x, last.y, at.x, at.y, pen_of(height), color);
        }
        last = at;
        down = true;
        glyph += 2;
    }
}

void assay_canvas_text(const assay_canvas *canvas, double x, double y, double height, bool upward,
                       assay_rgb color, const char *text)
{
    double at = 0.0;
    for (; *text; text++) {
        draw_glyph(canvas, (pen_point){x, y}, height, upward, at, color, assay_stroke_glyph(*text));
        at += assay_stroke_advance(*text);
    }
}

double assay_text_width(double height, const char *text)
{
    double units = 0.0;
    for (; *text; text++) {
        units += assay_stroke_advance(*text);
    }
    return units > 0.0 ? (units - STROKE_GAP) * unit_of(height) : 0.0;
}

assay_status assay_image_draw_text(assay_image *image, double x, double y, double height,
                                   assay_rgb color, const char *text)
{
    assay_canvas canvas;
    if (!(height > 0.0) || !(height < 4096.0) || !assay_canvas_open(image, &canvas)) {
        return ASSAY_ERR_ARGUMENT;
    }
    assay_canvas_text(&canvas, x, y, height, false, color, text);
    return ASSAY_OK;
}
