/* cmd_basis_plot.c - `assay basis plot`: figures 3.4, 3.9 and 3.10 of the thesis. */
#include <math.h>
#include <stdio.h>

#include "basis_options.h"
#include "console.h"

static const char       COMMAND[] = "basis plot";
static const cli_option OPTIONS[] = {
    {"output", 'o', "F.png", "the picture"},
    BASIS_OPTION_BASIS,
    {"l", 0, "L", "band of the function to be drawn"},
    {"m", 0, "M", "its azimuthal number"},
    {"accuracy", 0, NULL, "draw accuracies against the number of coefficients"},
    BASIS_OPTION_LOBE,
    {"max-order", 0, "N", "accuracies of the orders 1 to N (default 10)"},
    {"size", 0, "PIXELS", "side of a function's picture, width of a plot (default 480, 720)"},
    BASIS_OPTION_CONVENTION,
    {"help", 'h', NULL, "this text"},
    {0}};

enum { CURVES = 6 };
/* Makhotkin's functions as the thesis's measure needs them: without a weight. */
static const assay_basis_kind DRAWN[CURVES] = {ASSAY_BASIS_HSH,     ASSAY_BASIS_SH,
                                               ASSAY_BASIS_ESH,     ASSAY_BASIS_LSOSH,
                                               ASSAY_BASIS_ZERNIKE, ASSAY_BASIS_MAKHOTKIN_SQRT};

typedef struct {
    double           x[CURVES][ASSAY_BASIS_MAX_ORDER], y[CURVES][ASSAY_BASIS_MAX_ORDER];
    assay_plot_curve curves[CURVES];
} accuracy_curves;

static assay_status find_function(const assay_basis *basis, const basis_request *r, size_t *i_out)
{
    for (size_t i = 0; i < assay_basis_count(basis); i++) {
        int l, m;
        assay_basis_function(basis, i, &l, &m);
        if (l == r->l && m == r->m) {
            *i_out = i;
            return ASSAY_OK;
        }
    }
    return ASSAY_ERR_ARGUMENT;
}

static assay_status draw_function(assay_context *context, const basis_request *r,
                                  assay_image **image_out)
{
    assay_basis *basis  = NULL;
    size_t       i      = 0;
    assay_status status = cli_basis_create(context, r, r->basis, r->l + 1, &basis);
    if (status == ASSAY_OK) {
        status = find_function(basis, r, &i);
        if (status != ASSAY_OK) {
            r->console->said = true;
            cli_complain(COMMAND, "--l %ld --m %ld: the basis %s has no such function", r->l, r->m,
                         assay_basis_kind_name(r->basis));
        }
    }
    if (status == ASSAY_OK) {
        status = assay_basis_draw(context, basis, i, r->size ? (int)r->size : 480, image_out);
    }
    assay_basis_destroy(basis);
    return status;
}

static assay_status measure_curve(assay_context *context, const basis_request *r, int at,
                                  accuracy_curves *curves)
{
    size_t       counts[ASSAY_BASIS_MAX_ORDER];
    assay_basis *basis  = NULL;
    assay_status status = cli_basis_create(context, r, DRAWN[at], r->order, &basis);
    if (status == ASSAY_OK) {
        status = assay_basis_accuracy(basis, context, &r->lobe, curves->y[at], counts);
    }
    assay_basis_destroy(basis);
    for (long n = 0; n < r->order && status == ASSAY_OK; n++) {
        curves->x[at][n] = (double)counts[n];
    }
    curves->curves[at] = (assay_plot_curve){assay_basis_kind_name(DRAWN[at]), (size_t)r->order,
                                            curves->x[at], curves->y[at]};
    return status;
}

static assay_status draw_accuracy(assay_context *context, const basis_request *r,
                                  assay_image **image_out)
{
    accuracy_curves curves = {0};
    assay_status    status = ASSAY_OK;
    double          lowest = 1.0;
    char            title[160];
    for (int i = 0; i < CURVES && status == ASSAY_OK; i++) {
        status = measure_curve(context, r, i, &curves);
        /* From order 2 on: the first point alone would flatten everything else. */
        lowest = fmin(lowest, curves.y[i][r->order > 1 ? 1 : 0]);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    snprintf(title, sizeof title, "Share of the energy captured: %.100s", r->lobe_text);
    const assay_plot plot  = {.title       = title,
                              .x_label     = "coefficients that can be non-zero",
                              .y_label     = "accuracy",
                              .x_max       = (double)(r->order * r->order),
                              .y_min       = floor(fmin(lowest, 0.9) * 10.0) / 10.0,
                              .y_max       = 1.0,
                              .curve_count = CURVES,
                              .curves      = curves.curves};
    const int        width = r->size ? (int)r->size : 720;
    return assay_plot_draw(context, &plot, width, width * 2 / 3, image_out);
}

static assay_status draw(assay_context *context, const basis_request *r)
{
    assay_image *image = NULL;
    assay_status status =
        r->accuracy ? draw_accuracy(context, r, &image) : draw_function(context, r, &image);
    if (status == ASSAY_OK) {
        status = assay_image_write_png(image, "", 0.0, r->output);
    }
    assay_image_destroy(image);
    return status;
}

static bool makes_sense(const basis_request *r)
{
    if (!cli_basis_need(COMMAND, r->output != NULL, "-o F.png")) {
        return false;
    }
    if (r->accuracy) {
        if (r->has_basis || r->has_l || r->has_m) {
            return cli_complain(COMMAND, "--accuracy draws all bases; --basis, --l and --m are of "
                                         "a function");
        }
        if (r->size && r->size < 300) {
            return cli_complain(COMMAND, "--size: a plot is 300 pixels wide at least");
        }
        return cli_basis_need(COMMAND, r->has_lobe, "--lobe");
    }
    if (r->has_lobe) {
        return cli_complain(COMMAND, "--lobe is of --accuracy");
    }
    return cli_basis_need(COMMAND, r->has_basis, "--basis") &&
           cli_basis_need(COMMAND, r->has_l, "--l") && cli_basis_need(COMMAND, r->has_m, "--m");
}

static const basis_command SELF = {
    .name      = COMMAND,
    .usage     = "usage: assay basis plot --basis hsh --l L --m M -o F.png\n"
                 "       assay basis plot --accuracy --lobe L [--max-order N] -o F.png\n"
                 "A function is drawn as |f| in each direction, warm where f > 0, cool where < 0.\n",
    .options   = OPTIONS,
    .extension = ".png",
    .check     = makes_sense,
    .run       = draw};

int cli_basis_plot(int count, char **argv)
{
    return cli_basis_run(&SELF, count, argv, (basis_request){.order = 10});
}
