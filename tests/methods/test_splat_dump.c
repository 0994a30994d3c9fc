/* test_splat_dump.c - every step of a dump, done again from the step before. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "io/bundle_read.h"
#include "record/record_bundle.h"
#include "record/splat.h"
#include "scene/scene_data.h"
#include "support/rendered.h"
#include "support/scene_builder.h"

enum { SIZE = 40, PIXELS = SIZE * SIZE, BATCH = 25 };

static const setting SPLAT[] = {
    {"method", "splat"},  {"size", "40"},          {"spp", "1"},
    {"a", "0.3"},         {"theta_strata", "6"},   {"phi_strata", "15"},
    {"bounces", "2"},     {"secondary", "direct"}, {"estimator", "nee"},
    {"order", "3"},       {"grid", "8"},           {"nodes", "16"},
    {"dump_batch", "25"}, {"camera", "0"},         {"glossy_accuracy", "0"},
    {NULL, NULL}};

static assay_scene *room(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = scene_builder_diffuse(b, 0.5, 0.0, false);
    const int      lamp  = scene_builder_diffuse(b, 0.0, 12.0, false);
    const int      ball  = scene_builder_material(
              b, "\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0.7}");
    scene_builder_quad(b, walls, vec3(-1, -1, 1), vec3(1, -1, 1), vec3(1, -1, -1),
                       vec3(-1, -1, -1));
    scene_builder_quad(b, walls, vec3(-1, -1, -1), vec3(1, -1, -1), vec3(1, 1, -1),
                       vec3(-1, 1, -1));
    scene_builder_sphere(b, ball, vec3(0, -0.4, -0.2), 0.6, 2);
    scene_builder_quad(b, lamp, vec3(-0.3, 0.98, -0.3), vec3(0.3, 0.98, -0.3), vec3(0.3, 0.98, 0.3),
                       vec3(-0.3, 0.98, 0.3));
    scene_builder_camera(b, vec3(0.2, 0.1, 2), vec3(0, -0.3, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

typedef struct {
    rendering            r;
    assay_scene         *scene;
    char                *folder;
    assay_bundle_reader *reader;
    assay_record_store  *store;
    assay_splat_buffer  *buffer;
} replay;

static assay_array *table(replay *p, const char *name, size_t rows, size_t columns)
{
    assay_array *t = NULL;
    if (assay_bundle_read_table(p->reader, name, rows, columns, &t) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(p->r.context));
    }
    return t;
}

static void begin(replay *p)
{
    static const assay_record_rules rules = {
        .a = 0.3, .gradients = ASSAY_GRADIENTS_BOTH, .clamp_negative = true};
    rendering_open(&p->r, 2);
    p->scene             = room(p->r.context);
    p->folder            = rendered_folder();
    const char   *dump   = rendered_path(p->folder, "dump");
    const setting more[] = {{"dump", dump}, {NULL, NULL}};
    rendered      made   = rendered_make(&p->r, p->scene, SPLAT, more);
    assert_int_equal(made.status, ASSAY_OK);
    rendered_drop(&made);
    assert_int_equal(assay_bundle_open(p->r.context, dump, &p->reader), ASSAY_OK);
    assert_int_equal(assay_record_store_create(p->r.context, &rules, vec3(0, 0, 0), vec3(0, 0, 0),
                                               ASSAY_INDEX_LIST, &p->store),
                     ASSAY_OK);
    assert_int_equal(
        assay_record_bundle_read(p->r.context, p->reader, "records", SIZE_MAX, p->store), ASSAY_OK);
    assert_int_equal(assay_splat_buffer_create(p->r.context, SIZE, SIZE, &p->buffer), ASSAY_OK);
}

static void end(replay *p)
{
    assay_splat_buffer_destroy(p->buffer);
    assay_record_store_destroy(p->store);
    assay_bundle_close(p->reader);
    assay_scene_destroy(p->scene);
    rendering_close(&p->r);
    rendered_remove(p->folder);
}

static void set_points(replay *p)
{
    assay_array  *positions = table(p, "splat/position", PIXELS, 3);
    assay_array  *frames    = table(p, "splat/frame", PIXELS, 9);
    const double *x = assay_array_values(positions), *f = assay_array_values(frames);
    assay_splat_buffer_look(p->buffer, &p->scene->world_cameras[0]);
    for (size_t i = 0; i < PIXELS; i++) {
        if (!isnan(x[3 * i])) {
            assay_splat_buffer_set(p->buffer, i, vec3(x[3 * i], x[3 * i + 1], x[3 * i + 2]),
                                   vec3(f[9 * i + 6], f[9 * i + 7], f[9 * i + 8]));
        }
    }
    assert_int_equal(assay_splat_buffer_close(p->buffer), ASSAY_OK);
    assay_array_destroy(positions);
    assay_array_destroy(frames);
}

static void check_batch(replay *p, size_t batch, const double *albedo)
{
    char name[64];
    snprintf(name, sizeof name, "splat/batch.%zu/weight", batch);
    assay_array *weights = table(p, name, PIXELS, 1);
    snprintf(name, sizeof name, "splat/batch.%zu/radiance", batch);
    assay_array *sums = table(p, name, PIXELS, 3);
    for (size_t i = 0; i < PIXELS; i++) {
        const assay_rgb sum = assay_splat_sum(p->buffer, i);
        const double   *got = assay_array_values(sums) + 3 * i;
        assert_true(assay_array_values(weights)[i] == assay_splat_weight(p->buffer, i));
        assert_true(got[0] == sum.r * albedo[3 * i] * ASSAY_INV_PI);
        assert_true(got[2] == sum.b * albedo[3 * i + 2] * ASSAY_INV_PI);
    }
    assay_array_destroy(weights);
    assay_array_destroy(sums);
}

/* Buffers after each batch from G-buffer and records; the result from the last buffer. */
static void batches_again(void **state)
{
    (void)state;
    replay p;
    begin(&p);
    set_points(&p);
    const assay_splat_source source = {.store = p.store,
                                       .rules = *assay_record_store_rules(p.store)};
    assay_array             *ends   = table(&p, "splat/batch_end", SIZE_MAX, 1);
    assay_array             *albedo = table(&p, "splat/albedo", PIXELS, 3);
    assay_array             *result = table(&p, "splat/result", PIXELS, 3);
    uint32_t                 done   = 0;
    const size_t             count  = assay_array_rows(ends);
    assert_true(count > 4);
    for (size_t k = 0; k < count; k++) {
        const uint32_t upto = (uint32_t)assay_array_values(ends)[k];
        assert_true(k == 0 ? upto == 0 : upto - done <= BATCH);
        assert_int_equal(assay_splat_records(p.buffer, &source, done, upto), ASSAY_OK);
        check_batch(&p, k, assay_array_values(albedo));
        done = upto;
    }
    for (size_t i = 0; i < PIXELS; i++) {
        const assay_rgb mean = assay_splat_mean(p.buffer, i);
        assert_true(assay_array_values(result)[3 * i + 1] ==
                    mean.g * assay_array_values(albedo)[3 * i + 1] * ASSAY_INV_PI);
        assert_true(!assay_splat_has_point(p.buffer, i) ||
                    assay_splat_weight(p.buffer, i) >= source.rules.a);
    }
    assay_array_destroy(ends);
    assay_array_destroy(albedo);
    assay_array_destroy(result);
    end(&p);
}

/* The miss mask: linear traversal of the splat buffers makes these records at these pixels. */
static void misses_again(void **state)
{
    (void)state;
    replay p;
    begin(&p);
    set_points(&p);
    const assay_splat_source source    = {.store = p.store,
                                          .rules = *assay_record_store_rules(p.store)};
    assay_array             *fate      = table(&p, "splat/fate", PIXELS, 1);
    assay_array             *positions = table(&p, "splat/position", PIXELS, 3);
    uint32_t                 made      = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const bool missing =
            assay_splat_has_point(p.buffer, i) && assay_splat_weight(p.buffer, i) < source.rules.a;
        assert_true(assay_array_values(fate)[i] == (missing ? 1.0 : 0.0));
        if (missing) {
            const assay_record *record = assay_record_store_at(p.store, made);
            assert_memory_equal(&record->position, assay_array_values(positions) + 3 * i,
                                3 * sizeof(double));
            assert_int_equal(assay_splat_records(p.buffer, &source, made, made + 1), ASSAY_OK);
            made++;
        }
    }
    assay_array *ends = table(&p, "splat/batch_end", SIZE_MAX, 1);
    assert_true(made == assay_array_values(ends)[assay_array_rows(ends) - 1]);
    assay_array_destroy(fate);
    assay_array_destroy(positions);
    assay_array_destroy(ends);
    end(&p);
}

/* wo, turned to the world, looks from the point to the eye; the ball is white. */
static void check_brdf(const double *row, const double *position, bool on)
{
    const double eye[3] = {0.2, 0.1, 2.0};
    double       off = 0.0, along = 0.0, length = 0.0;
    for (int k = 0; k < 3 && on; k++) {
        const double world = row[k] * row[9] + row[3 + k] * row[10] + row[6 + k] * row[11];
        const double way   = eye[k] - position[k];
        along += world * way;
        length += way * way;
        off = fmax(off, fabs(row[12 + k] - 1.0));
    }
    assert_true(on ? fabs(along - sqrt(length)) < 1e-9 && row[11] > 0.0 && off < 1e-12
                   : isnan(row[0]) && isnan(row[14]));
}

/* Glossy pixels have steps of their own: on the ball and nowhere else. */
static void glossy_steps(void **state)
{
    (void)state;
    replay p;
    begin(&p);
    assay_array *weights   = table(&p, "splat_glossy/batch.1/weight", PIXELS, 1);
    assay_array *positions = table(&p, "splat_glossy/position", PIXELS, 3);
    assay_array *result    = table(&p, "splat_glossy/result", PIXELS, 3);
    assay_array *brdf      = table(&p, "splat_glossy/brdf", PIXELS, 15);
    int          glossy    = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const bool    on = !isnan(assay_array_values(positions)[3 * i]);
        const double *r  = assay_array_values(result) + 3 * i;
        glossy += on && r[0] != 0.0;
        assert_true(isfinite(r[0]) && (on || assay_array_values(weights)[i] == 0.0));
        assert_true(on || r[0] == 0.0);
        check_brdf(assay_array_values(brdf) + 15 * i, assay_array_values(positions) + 3 * i, on);
    }
    assert_in_range(glossy, 100, PIXELS / 2);
    assay_array_destroy(weights);
    assay_array_destroy(positions);
    assay_array_destroy(result);
    assay_array_destroy(brdf);
    end(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(batches_again),
        cmocka_unit_test(misses_again),
        cmocka_unit_test(glossy_steps),
    };
    return cmocka_run_group_tests_name("splat_dump", tests, NULL, NULL);
}
