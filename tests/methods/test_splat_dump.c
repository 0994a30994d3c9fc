/* test_splat_dump.c - every step of a dump, done again from the step before and from nothing else.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "io/bundle_read.h"
#include "methods/cache_params.h"
#include "methods/radiance_params.h"
#include "record/radiance_cache.h"
#include "record/record_bundle.h"
#include "record/splat.h"
#include "scene/scene_data.h"
#include "support/rendered.h"
#include "support/scene_builder.h"

enum { SIZE = 40, PIXELS = SIZE * SIZE, BATCH = 25, ORDER = 3, COUNT = ORDER * ORDER };

static const setting SPLAT[] = {{"method", "splat"},
                                {"size", "40"},
                                {"spp", "1"},
                                {"a", "0.3"},
                                {"theta_strata", "6"},
                                {"phi_strata", "15"},
                                {"bounces", "2"},
                                {"secondary", "direct"},
                                {"estimator", "nee"},
                                {"order", "3"},
                                {"grid", "8"},
                                {"nodes", "16"},
                                {"dump_batch", "25"},
                                {"camera", "0"},
                                {"glossy_accuracy", "0"},
                                {"r_max_pixels", "15"},
                                {NULL, NULL}};

static assay_scene *room(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = scene_builder_material(
             b, "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.6,0.5,0.3,1],\"metallicFactor\":0},"
                     "\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}");
    const int lamp = scene_builder_diffuse(b, 0.0, 12.0, false);
    const int ball = scene_builder_material(
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

static void set_points(replay *p, const char *layer)
{
    char name[64];
    snprintf(name, sizeof name, "%s/position", layer);
    assay_array *positions = table(p, name, PIXELS, 3);
    snprintf(name, sizeof name, "%s/frame", layer);
    assay_array  *frames = table(p, name, PIXELS, 9);
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
    set_points(&p, "splat");
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
    set_points(&p, "splat");
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

/* ---- light, gathered again ---- */

/* What the parameters of the render make of the scene. */
typedef struct {
    assay_radiance_params         params;
    assay_radiance_cache_settings settings;
    assay_world                  *world;
    glossy_materials              materials;
    assay_irradiance_cache       *irradiance;
    assay_radiance_cache         *radiance;
} light;

static bool is_parameter(const char *name)
{
    return strcmp(name, "method") != 0 && strcmp(name, "size") != 0 && strcmp(name, "camera") != 0;
}

static void open_light(replay *p, light *l)
{
    assay_context              *c      = p->r.context;
    assay_params               *params = NULL;
    assay_cached_image_settings image;
    const uint64_t              seed = assay_render_options_default().seed;
    *l                               = (light){0};
    assert_int_equal(assay_method_params(c, "splat", &params), ASSAY_OK);
    for (const setting *s = SPLAT; s->name; s++) {
        assert_true(!is_parameter(s->name) ||
                    assay_params_set(params, s->name, s->value) == ASSAY_OK);
    }
    assert_int_equal(assay_radiance_params_read(c, "splat", params, &l->params), ASSAY_OK);
    l->settings = l->params.cache;
    assert_int_equal(assay_cache_params_read(c, params, &l->settings.records, &image), ASSAY_OK);
    assert_int_equal(assay_radiance_params_materials(c, p->scene, &l->params, &l->materials),
                     ASSAY_OK);
    assert_int_equal(assay_world_create(p->scene, &l->world), ASSAY_OK);
    assert_int_equal(
        assay_irradiance_cache_create(l->world, &l->settings.records, seed, &l->irradiance),
        ASSAY_OK);
    assert_int_equal(assay_radiance_cache_create(c, l->irradiance, &l->settings, &l->radiance),
                     ASSAY_OK);
    assay_params_destroy(params);
}

static void close_light(light *l)
{
    assay_radiance_cache_destroy(l->radiance);
    assay_irradiance_cache_destroy(l->irradiance);
    glossy_materials_release(&l->materials);
    assay_world_destroy(l->world);
}

static void check_table(replay *p, const char *prefix, const char *what, size_t row, size_t columns,
                        const void *expected)
{
    char name[64];
    snprintf(name, sizeof name, "%s/%s", prefix, what);
    assay_array *t = table(p, name, SIZE_MAX, columns);
    assert_memory_equal(assay_array_values(t) + row * columns, expected, columns * sizeof(double));
    assay_array_destroy(t);
}

/* Records at the pixels that were found to miss one. */
static uint32_t make_again(replay *p, const char *layer, assay_irradiance_cache *cache)
{
    static const char *const names[5]   = {"position", "frame", "geometric_normal", "footprint",
                                           "fate"};
    static const size_t      columns[5] = {3, 9, 3, 1, 1};
    assay_array             *t[5];
    const double            *v[5];
    uint32_t                 made = 0;
    for (int k = 0; k < 5; k++) {
        char name[64];
        snprintf(name, sizeof name, "%s/%s", layer, names[k]);
        t[k] = table(p, name, PIXELS, columns[k]);
        v[k] = assay_array_values(t[k]);
    }
    for (size_t i = 0; i < PIXELS; i++) {
        assay_cache_point point = {.footprint = v[3][i], .wanted = true};
        memcpy(&point.site.position, v[0] + 3 * i, sizeof point.site.position);
        memcpy(&point.site.frame, v[1] + 9 * i, sizeof point.site.frame);
        memcpy(&point.site.ng, v[2] + 3 * i, sizeof point.site.ng);
        if (v[4][i] == 1.0) {
            assert_int_equal(assay_irradiance_cache_make(cache, &point), ASSAY_OK);
            made++;
        }
    }
    for (int k = 0; k < 5; k++) {
        assay_array_destroy(t[k]);
    }
    return made;
}

static void check_records(replay *p, const char *prefix, assay_irradiance_cache *cache,
                          uint32_t count)
{
    const assay_record_store *store = assay_irradiance_cache_store(cache);
    assert_in_range(count, 5, PIXELS / 2);
    for (uint32_t i = 0; i < count; i++) {
        const assay_record *record = assay_record_store_at(store, i);
        check_table(p, prefix, "position", i, 3, &record->position);
        check_table(p, prefix, "normal", i, 3, &record->normal);
        check_table(p, prefix, "radius", i, 1, &record->radius);
        check_table(p, prefix, "irradiance", i, 3, &record->irradiance);
    }
}

/* The records from the G-buffer: what is gathered at its pixels. */
static void records_again(void **state)
{
    (void)state;
    replay p;
    light  l;
    begin(&p);
    open_light(&p, &l);
    check_records(&p, "records", l.irradiance, make_again(&p, "splat", l.irradiance));
    assay_irradiance_cache *glossy = assay_radiance_cache_records(l.radiance);
    const uint32_t          count  = make_again(&p, "splat_glossy", glossy);
    check_records(&p, "radiance_records", glossy, count);
    for (uint32_t i = 0; i < count; i++) {
        check_table(&p, "radiance_records", "coefficients", i, 3 * COUNT,
                    assay_radiance_cache_coefficients(l.radiance, i));
        check_table(&p, "radiance_records", "coefficient_gradient", i, 9 * COUNT,
                    assay_radiance_cache_gradients(l.radiance, i));
    }
    close_light(&l);
    end(&p);
}

/* ---- glossy pixels ---- */

typedef struct {
    light                      *light;
    const assay_material_grids *ball;
    const double               *brdf; /* splat_glossy/brdf */
} reflection;

/* The dot product in the frame of the BRDF, where the method has that about the normal. */
static assay_status reflect(void *user, const assay_splat_place *place, uint32_t record,
                            assay_rgb *said_out)
{
    const reflection *r   = user;
    const double     *row = r->brdf + 15 * place->pixel;
    assay_frame3      frame;
    assay_vec3        wo;
    assay_rgb         base;
    double            light_there[3 * COUNT], brdf[3 * COUNT], scratch[3 * COUNT];
    double            sum[3] = {0.0, 0.0, 0.0};
    memcpy(&frame, row, sizeof frame);
    memcpy(&wo, row + 9, sizeof wo);
    memcpy(&base, row + 12, sizeof base);
    assay_status status = assay_material_grids_brdf(r->ball, COUNT, base, wo, scratch, brdf);
    status              = status ? status
                                 : assay_radiance_cache_say(r->light->radiance, record, place->position, &frame,
                                                            place->worker, light_there);
    for (size_t i = 0; i < 3 * COUNT; i++) {
        sum[i / COUNT] += light_there[i] * brdf[i];
    }
    *said_out = rgb(sum[0], sum[1], sum[2]);
    return status;
}

static const assay_material_grids *only_grids(const glossy_materials *materials)
{
    const assay_material_grids *found = NULL;
    for (uint32_t i = 0; i < materials->count; i++) {
        if (materials->grids[i].slope) {
            assert_null(found);
            found = &materials->grids[i];
        }
    }
    assert_non_null(found);
    return found;
}

static void check_glossy_batch(replay *p, size_t batch)
{
    char name[64];
    snprintf(name, sizeof name, "splat_glossy/batch.%zu/weight", batch);
    assay_array *weights = table(p, name, PIXELS, 1);
    snprintf(name, sizeof name, "splat_glossy/batch.%zu/radiance", batch);
    assay_array *sums = table(p, name, PIXELS, 3);
    for (size_t i = 0; i < PIXELS; i++) {
        const double    weight = assay_splat_weight(p->buffer, i);
        const assay_rgb sum    = assay_splat_sum(p->buffer, i);
        const double   *got    = assay_array_values(sums) + 3 * i;
        assert_true(assay_array_values(weights)[i] == weight);
        assert_true(fabs(got[0] - sum.r) <= 1e-12 * weight);
        assert_true(fabs(got[1] - sum.g) <= 1e-12 * weight);
        assert_true(fabs(got[2] - sum.b) <= 1e-12 * weight);
    }
    assay_array_destroy(weights);
    assay_array_destroy(sums);
}

static void glossy_batches_again(void **state)
{
    (void)state;
    replay p;
    light  l;
    begin(&p);
    open_light(&p, &l);
    set_points(&p, "splat_glossy");
    assay_irradiance_cache  *records = assay_radiance_cache_records(l.radiance);
    assay_array             *brdf    = table(&p, "splat_glossy/brdf", PIXELS, 15);
    assay_array             *ends    = table(&p, "splat_glossy/batch_end", SIZE_MAX, 1);
    reflection               mirror  = {&l, only_grids(&l.materials), assay_array_values(brdf)};
    const assay_splat_source source  = {.store = assay_irradiance_cache_store(records),
                                        .rules = l.settings.records.rules,
                                        .say   = reflect,
                                        .user  = &mirror};
    const uint32_t           made    = make_again(&p, "splat_glossy", records);
    uint32_t                 done    = 0;
    assert_true(made == assay_array_values(ends)[assay_array_rows(ends) - 1]);
    for (size_t k = 0; k < assay_array_rows(ends); k++) {
        const uint32_t upto = (uint32_t)assay_array_values(ends)[k];
        assert_int_equal(assay_splat_records(p.buffer, &source, done, upto), ASSAY_OK);
        check_glossy_batch(&p, k);
        done = upto;
    }
    assay_array_destroy(brdf);
    assay_array_destroy(ends);
    close_light(&l);
    end(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(batches_again),        cmocka_unit_test(misses_again),
        cmocka_unit_test(glossy_steps),         cmocka_unit_test(records_again),
        cmocka_unit_test(glossy_batches_again),
    };
    return cmocka_run_group_tests_name("splat_dump", tests, NULL, NULL);
}
