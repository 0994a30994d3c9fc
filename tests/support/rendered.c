/* rendered.c - see rendered.h. */
#include "support/rendered.h"

#include <ftw.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void listen(void *user, assay_log_level level, const char *line)
{
    rendering *r = user;
    if (level == ASSAY_LOG_WARNING) {
        r->warnings++;
        snprintf(r->warning, sizeof r->warning, "%s", line);
    }
}

void rendering_open(rendering *r, int threads)
{
    const assay_context_options options = {.threads = threads, .log = listen, .user = r};
    *r                                  = (rendering){0};
    assert_int_equal(assay_context_create(&options, &r->context), ASSAY_OK);
}

void rendering_close(rendering *r) { assay_context_destroy(r->context); }

static void apply(const setting *s, assay_render_options *options, assay_params *params)
{
    if (strcmp(s->name, "method") == 0) {
        return;
    }
    if (strcmp(s->name, "dump") == 0) {
        options->dump = s->value;
    } else if (strcmp(s->name, "camera") == 0) {
        options->camera = s->value;
    } else if (strcmp(s->name, "layers") == 0) {
        options->layers = s->value;
    } else if (strcmp(s->name, "size") == 0) {
        options->width = options->height = atoi(s->value);
    } else if (strcmp(s->name, "seed") == 0) {
        options->seed = strtoull(s->value, NULL, 10);
    } else if (assay_params_set(params, s->name, s->value) != ASSAY_OK) {
        fail_msg("no setting %s=%s", s->name, s->value);
    }
}

rendered rendered_make(rendering *r, assay_scene *scene, const setting *settings,
                       const setting *more)
{
    assay_render_options options = assay_render_options_default();
    const char          *method  = settings->value;
    assay_params        *params  = NULL;
    rendered             made    = {0};
    options.width = options.height = 16;
    for (const setting *s = more; s && s->name; s++) {
        method = strcmp(s->name, "method") == 0 ? s->value : method;
    }
    assert_int_equal(assay_method_params(r->context, method, &params), ASSAY_OK);
    for (const setting *s = settings; s->name; s++) {
        apply(s, &options, params);
    }
    for (const setting *s = more; s && s->name; s++) {
        apply(s, &options, params);
    }
    made.status = assay_render(scene, method, params, &options, &made.image, &made.stats);
    if (made.status != ASSAY_OK) {
        snprintf(made.error, sizeof made.error, "%s", assay_context_error(r->context));
    }
    assay_params_destroy(params);
    return made;
}

void rendered_drop(rendered *made)
{
    assay_image_destroy(made->image);
    made->image = NULL;
}

static void require(const rendered *made)
{
    if (made->status != ASSAY_OK) {
        fail_msg("%s", made->error);
    }
}

bool rendered_same(const rendered *a, const rendered *b)
{
    char x[65], y[65];
    require(a);
    require(b);
    assay_image_digest(a->image, x);
    assay_image_digest(b->image, y);
    return strcmp(x, y) == 0;
}

double rendered_difference(const rendered *a, const rendered *b, const char *channel)
{
    assay_channel x = {0}, y = {0};
    require(a);
    require(b);
    if (!assay_image_find_channel(a->image, channel, &x) ||
        !assay_image_find_channel(b->image, channel, &y)) {
        fail_msg("no channel %s", channel);
        return INFINITY;
    }
    const size_t pixels =
        (size_t)assay_image_width(a->image) * (size_t)assay_image_height(a->image);
    double largest = 0.0, sum = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        const double one = x.data.f32[i], other = y.data.f32[i], d = fabs(one - other);
        largest = d > largest ? d : largest;
        sum += 0.5 * (fabs(one) + fabs(other));
    }
    return largest > 0.0 ? largest * (double)pixels / sum : 0.0;
}

char *rendered_folder(void)
{
    char *folder = strdup("/tmp/assay-render-XXXXXX");
    assert_non_null(folder);
    assert_non_null(mkdtemp(folder));
    return folder;
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *at)
{
    (void)status;
    (void)type;
    (void)at;
    return remove(path);
}

void rendered_remove(char *folder)
{
    assert_int_equal(nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS), 0);
    free(folder);
}

const char *rendered_path(const char *folder, const char *name)
{
    static char paths[4][RENDERED_TEXT];
    static int  next;
    char       *path = paths[next++ % 4];
    snprintf(path, RENDERED_TEXT, "%s/%s", folder, name);
    return path;
}
