/* test_metadata.c - every option that can change a pixel changes an attribute of its own, and what
 * changes no pixel changes none. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/measure.h"
#include "support/temporary.h"

/* A triangle with two scenes over it: the second has it twice as large. */
static const char GLTF[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,2]},{\"nodes\":[1,3]}],"
    "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"scale\":[2,2,2]},{\"camera\":0,\"translation\":[0,0,3]},"
    "{\"camera\":0,\"translation\":[0,0,3]}],\"cameras\":[{\"type\":\"perspective\","
    "\"perspective\":{\"yfov\":1,\"znear\":0.1}}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
    "\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
    "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,"
    "\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

typedef struct {
    temporary           folder;
    char                scene[512], maps[2][512];
    assay_context      *context;
    assay_scene_options scene_options;
    uint64_t            seed;
    double              time;
    setting             parameter; /* one that is not at its default, or none */
} fixture;

static void write_map(fixture *f, int index, float value)
{
    assay_image *image = NULL;
    assert_int_equal(assay_image_create(f->context, 2, 1, &image), ASSAY_OK);
    for (int c = 0; c < 3; c++) {
        const char    name[2] = {"RGB"[c], 0};
        assay_channel channel;
        assert_int_equal(assay_image_add_channel(image, name, ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        channel.data.f32[0] = value;
        channel.data.f32[1] = 1.0f;
    }
    assert_int_equal(assay_image_write_exr(image, f->maps[index]), ASSAY_OK);
    assay_image_destroy(image);
}

static void write_scene(fixture *f, const char *more)
{
    char text[sizeof GLTF + 64];
    snprintf(text, sizeof text, "%s%s", GLTF, more);
    temporary_write(f->scene, text, strlen(text));
}

static fixture open_fixture(void)
{
    fixture f = {.folder        = temporary_create(),
                 .context       = measure_context(1),
                 .scene_options = assay_scene_options_default()};
    snprintf(f.scene, sizeof f.scene, "%s/two scenes.gltf", f.folder.folder);
    snprintf(f.maps[0], sizeof f.maps[0], "%s/sky.exr", f.folder.folder);
    snprintf(f.maps[1], sizeof f.maps[1], "%s/dusk.exr", f.folder.folder);
    write_scene(&f, "");
    write_map(&f, 0, 3.0f);
    write_map(&f, 1, 4.0f);
    return f;
}

static void close_fixture(fixture *f)
{
    assay_context_destroy(f->context);
    temporary_destroy(&f->folder);
}

static assay_image *render(const fixture *f)
{
    assay_scene         *scene   = NULL;
    assay_params        *params  = NULL;
    assay_image         *image   = NULL;
    assay_render_options options = assay_render_options_default();
    options.width = options.height = 3;
    options.seed                   = f->seed;
    assert_int_equal(assay_scene_load(f->context, f->scene, &f->scene_options, &scene), ASSAY_OK);
    assert_int_equal(assay_scene_set_time(scene, f->time), ASSAY_OK);
    assert_int_equal(assay_method_params(f->context, "path", &params), ASSAY_OK);
    assert_int_equal(assay_params_set(params, "spp", "1"), ASSAY_OK);
    if (f->parameter.name) {
        assert_int_equal(assay_params_set(params, f->parameter.name, f->parameter.value), ASSAY_OK);
    }
    assert_int_equal(assay_render(scene, "path", params, &options, &image, NULL), ASSAY_OK);
    assay_params_destroy(params);
    assay_scene_destroy(scene);
    return image;
}

/* Names, separated by blanks, of the attributes of a that b has not or with another value. */
static void list_changes(const assay_image *a, const assay_image *b, char *names, size_t size)
{
    size_t used = 0;
    names[0]    = '\0';
    for (int i = 0; i < assay_image_attribute_count(a); i++) {
        const char *name, *value;
        assay_image_attribute_at(a, i, &name, &value);
        const char *other = assay_image_get_attribute(b, name);
        if (!other || strcmp(value, other) != 0) {
            used += (size_t)snprintf(names + used, size - used, "%s%s", used ? " " : "", name + 6);
            assert_true(used < size);
        }
    }
}

/* Renders both, and the second must differ from the first in just these attributes. */
static void check_change(const fixture *a, const fixture *b, const char *expected)
{
    char         names[512];
    assay_image *first = render(a), *second = render(b);
    list_changes(second, first, names, sizeof names);
    assert_string_equal(names, expected);
    assay_image_destroy(first);
    assay_image_destroy(second);
}

static void every_scene_option_has_its_attribute(void **state)
{
    (void)state;
    fixture f = open_fixture(), g = f;
    check_change(&f, &g, "");
    g.scene_options.scene_index = 1;
    check_change(&f, &g, "scene.digest scene.index");
    g                             = f;
    g.scene_options.force_diffuse = true;
    check_change(&f, &g, "scene.digest scene.force_diffuse");
    g                                  = f;
    g.scene_options.solid_transmission = true;
    check_change(&f, &g, "scene.digest scene.solid_transmission");
    g                            = f;
    g.scene_options.background.g = 0.5;
    check_change(&f, &g, "scene.background scene.digest");
    g      = f;
    g.time = 0.25;
    check_change(&f, &g, "scene.time");
    g      = f;
    g.seed = 1;
    check_change(&f, &g, "seed");
    close_fixture(&f);
}

static void the_environment_has_its_attributes(void **state)
{
    (void)state;
    fixture f = open_fixture(), g = f;
    g.scene_options.environment_path = g.maps[0];
    check_change(&f, &g,
                 "scene.digest scene.environment scene.environment.digest "
                 "scene.environment.rotation scene.environment.scale");
    f                                 = g;
    g.scene_options.environment_scale = 2.0;
    check_change(&f, &g, "scene.digest scene.environment.scale");
    g                                    = f;
    g.scene_options.environment_rotation = 1.0;
    check_change(&f, &g, "scene.digest scene.environment.rotation");
    g                                = f;
    g.scene_options.environment_path = g.maps[1];
    check_change(&f, &g, "scene.digest scene.environment scene.environment.digest");
    assay_image *image = render(&f);
    assert_string_equal(assay_image_get_attribute(image, "assay:scene.environment"), "sky.exr");
    assert_string_equal(assay_image_get_attribute(image, "assay:scene.file"), "two scenes.gltf");
    assert_null(assay_image_get_attribute(image, "assay:scene.background"));
    assay_image_destroy(image);
    close_fixture(&f);
}

/* A blank at the end of the file is another file. */
static void the_files_have_a_digest_of_their_own(void **state)
{
    (void)state;
    char         names[512];
    fixture      f     = open_fixture();
    assay_image *first = render(&f);
    write_scene(&f, " ");
    assay_image *second = render(&f);
    list_changes(second, first, names, sizeof names);
    assert_string_equal(names, "scene.digest scene.files_digest");
    assert_int_equal(strlen(assay_image_get_attribute(second, "assay:scene.files_digest")), 64);
    assay_image_destroy(first);
    assay_image_destroy(second);
    close_fixture(&f);
}

static void every_parameter_has_its_attribute(void **state)
{
    (void)state;
    static const setting changes[] = {{"spp", "2"},
                                      {"bounces", "3"},
                                      {"estimator", "nee"},
                                      {"roulette_depth", "2"},
                                      {"target_error", "0.5"},
                                      {"max_spp", "9"},
                                      {"gradients", "off"},
                                      {"gradient_step", "0.5"},
                                      {"gradient_angle", "0.5"}};
    fixture              f         = open_fixture();
    int                  seen      = 0;
    for (const assay_param_desc *p = assay_method_at(0).params; p->name; p++) {
        for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
            if (strcmp(changes[i].name, p->name) == 0) {
                char    expected[64];
                fixture g   = f;
                g.parameter = changes[i];
                snprintf(expected, sizeof expected, "path.%s", p->name);
                check_change(&f, &g, expected);
                seen++;
            }
        }
        seen -= 1;
    }
    assert_int_equal(seen, 0); /* a parameter that is new is missing in the table above */
    close_fixture(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_option_has_its_attribute),
        cmocka_unit_test(the_environment_has_its_attributes),
        cmocka_unit_test(the_files_have_a_digest_of_their_own),
        cmocka_unit_test(every_parameter_has_its_attribute),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
