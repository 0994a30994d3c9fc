/* test_gltf_material.c - every field of materials and lights, their extensions, extras.assay. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/gltf_maker.h"
#include "support/near.h"

/* A 1 x 1 PNG, opaque white. */
static const char png[] =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmM"
    "IQAAAABJRU5ErkJggg==";

/* Two textures over that image, the second with a sampler. */
static gltf_maker *make_with_textures(void)
{
    gltf_maker *maker = gltf_maker_create();
    gltf_shown_triangle(maker);
    gltf_add(maker, "images", "\"uri\":\"%s\"", png);
    gltf_add(maker, "samplers", "\"magFilter\":9728,\"wrapS\":33071,\"wrapT\":33648");
    gltf_add(maker, "textures", "\"source\":0");
    gltf_add(maker, "textures", "\"source\":0,\"sampler\":0");
    return maker;
}

static assay_scene *load_material(assay_context *context, const assay_scene_options *options,
                                  const char *json)
{
    gltf_maker  *maker = make_with_textures();
    assay_scene *scene = NULL;
    gltf_add(maker, "materials", "%s", json);
    if (gltf_load_status(maker, context, options, &scene) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    return scene;
}

static void test_defaults(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene   = load_material(context, NULL, "\"name\":\"plain\"");
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        const assay_material *m = &scene->materials[i];
        assert_int_equal(m->model, ASSAY_MATERIAL_PBR);
        for (int c = 0; c < 4; c++) {
            assert_true(m->base_color[c] == 1.0);
        }
        assert_true(m->metallic == 1.0 && m->roughness == 1.0 && m->normal_scale == 1.0);
        assert_true(rgb_is_black(m->emissive));
        assert_int_equal(m->alpha_mode, ASSAY_ALPHA_OPAQUE);
        assert_true(m->alpha_cutoff == 0.5);
        assert_false(m->double_sided || m->emission_two_sided || m->solid);
        assert_true(m->ior == 1.5 && m->specular_factor == 1.0 && m->transmission == 0.0);
        assert_true(m->specular_color.r == 1.0 && isinf(m->attenuation_distance));
        assert_int_equal(m->base_color_texture.texture, ASSAY_NONE);
        assert_true(m->base_color_texture.uv_matrix[0][0] == 1.0);
        assert_true(m->base_color_texture.uv_matrix[1][1] == 1.0);
    }
    assert_string_equal(scene->materials[0].name, "plain");
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_core(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene =
        load_material(context, NULL,
                      "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,0.4],"
                      "\"metallicFactor\":0.25,\"roughnessFactor\":0.75,"
                      "\"baseColorTexture\":{\"index\":1,\"texCoord\":1},"
                      "\"metallicRoughnessTexture\":{\"index\":0}},"
                      "\"normalTexture\":{\"index\":1,\"scale\":-2.5},"
                      "\"occlusionTexture\":{\"index\":0,\"texCoord\":7,\"strength\":0.5},"
                      "\"emissiveTexture\":{\"index\":0},\"emissiveFactor\":[0.5,0.25,1],"
                      "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.75,\"doubleSided\":true");
    const assay_material *m = &scene->materials[0];
    (void)state;
    assert_true(m->base_color[0] == 0.1 && m->base_color[1] == 0.2);
    assert_true(m->base_color[2] == 0.3 && m->base_color[3] == 0.4);
    assert_true(m->metallic == 0.25 && m->roughness == 0.75 && m->normal_scale == -2.5);
    assert_true(m->emissive.r == 0.5 && m->emissive.g == 0.25 && m->emissive.b == 1.0);
    assert_int_equal(m->alpha_mode, ASSAY_ALPHA_MASK);
    assert_true(m->alpha_cutoff == 0.75 && m->double_sided && m->emission_two_sided);
    assert_int_equal(m->base_color_texture.texture, 1);
    assert_int_equal(m->base_color_texture.texcoord, 1);
    assert_int_equal(m->metallic_roughness_texture.texture, 0);
    assert_int_equal(m->normal_texture.texture, 1);
    assert_int_equal(m->emissive_texture.texture, 0);
    assert_int_equal(scene->textures[0].wrap_u, ASSAY_WRAP_REPEAT);
    assert_false(scene->textures[0].nearest);
    assert_int_equal(scene->textures[1].wrap_u, ASSAY_WRAP_CLAMP);
    assert_int_equal(scene->textures[1].wrap_v, ASSAY_WRAP_MIRROR);
    assert_true(scene->textures[1].nearest);
    assert_int_equal(scene->images[0].width, 1);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* An image inside of the buffer; emission above 1 is kept, and told of. */
static void test_image_in_a_view(void **state)
{
    static const uint8_t bytes[] = {
        0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48,
        0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00,
        0x00, 0x1F, 0x15, 0xC4, 0x89, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x44, 0x41, 0x54, 0x78,
        0xDA, 0x63, 0xFC, 0xCF, 0xC0, 0x50, 0x0F, 0x00, 0x04, 0x85, 0x01, 0x80, 0x84, 0xA9,
        0x8C, 0x21, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    gltf_shown_triangle(maker);
    gltf_add(maker, "images", "\"bufferView\":%d,\"mimeType\":\"image/png\"",
             gltf_view(maker, bytes, sizeof bytes, 0));
    gltf_add(maker, "images", "\"uri\":\"unused.ktx2\"");
    gltf_add(maker, "textures", "\"source\":0");
    gltf_add(maker, "textures", "\"source\":1");
    gltf_add(maker, "materials", "\"emissiveTexture\":{\"index\":0},\"emissiveFactor\":[4,1,0]");
    assay_scene *scene = gltf_load(maker, context);
    assert_int_equal(scene->images[0].width, 1);
    assert_null(scene->images[1].texels); /* no material looks at it */
    assert_true(scene->materials[0].emissive.r == 4.0);
    assert_non_null(strstr(assay_scene_warning(scene, 0), "emissiveFactor above 1"));
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_extensions(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene   = load_material(
            context, NULL,
            "\"emissiveFactor\":[1,0.5,0],\"extensions\":{"
                "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":5000000000},"
                "\"KHR_materials_ior\":{\"ior\":1.25},"
                "\"KHR_materials_specular\":{\"specularFactor\":0.5,\"specularTexture\":{\"index\":0},"
                "\"specularColorFactor\":[2,1,0.5],\"specularColorTexture\":{\"index\":1}},"
                "\"KHR_materials_transmission\":{\"transmissionFactor\":0.75,"
                "\"transmissionTexture\":{\"index\":1}},"
                "\"KHR_materials_volume\":{\"thicknessFactor\":0.1,\"attenuationDistance\":2,"
                "\"attenuationColor\":[0.5,0.25,1]}}");
    const assay_material *m = &scene->materials[0];
    (void)state;
    /* beyond 32 bits: tinygltf's own extension values would have cut it */
    assert_true(m->emissive.r == 5e9 && m->emissive.g == 2.5e9 && m->emissive.b == 0.0);
    assert_true(m->ior == 1.25 && m->specular_factor == 0.5 && m->transmission == 0.75);
    assert_true(m->specular_color.r == 2.0 && m->specular_color.g == 1.0);
    assert_true(m->specular_color.b == 0.5);
    assert_int_equal(m->specular_texture.texture, 0);
    assert_int_equal(m->specular_color_texture.texture, 1);
    assert_int_equal(m->transmission_texture.texture, 1);
    assert_true(m->solid && m->attenuation_distance == 2.0);
    assert_true(m->attenuation_color.r == 0.5 && m->attenuation_color.g == 0.25);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_unlit(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene =
        load_material(context, NULL, "\"extensions\":{\"KHR_materials_unlit\":{}}");
    (void)state;
    assert_int_equal(scene->materials[0].model, ASSAY_MATERIAL_UNLIT);
    assert_int_equal(scene->materials[1].model, ASSAY_MATERIAL_PBR);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* KHR_texture_transform with the example of its text: the lower left quadrant, turned. */
static void test_texture_transform(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene =
        load_material(context, NULL,
                      "\"emissiveTexture\":{\"index\":0,\"texCoord\":0,\"extensions\":{"
                      "\"KHR_texture_transform\":{\"offset\":[0,1],\"rotation\":1.57079632679,"
                      "\"scale\":[0.5,0.5],\"texCoord\":1}}}");
    const assay_texture_ref *ref           = &scene->materials[0].emissive_texture;
    static const double      corners[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    (void)state;
    assert_int_equal(ref->texcoord, 1);
    for (int i = 0; i < 4; i++) {
        const double u = ref->uv_matrix[0][0] * corners[i][0] +
                         ref->uv_matrix[0][1] * corners[i][1] + ref->uv_matrix[0][2];
        const double v = ref->uv_matrix[1][0] * corners[i][0] +
                         ref->uv_matrix[1][1] * corners[i][1] + ref->uv_matrix[1][2];
        assert_near(u, 0.5 * corners[i][1], 1e-9);
        assert_near(v, 1.0 - 0.5 * corners[i][0], 1e-9);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_solid(void **state)
{
    static const struct {
        const char *json;
        bool        option, solid;
    } cases[] = {
        {"\"KHR_materials_transmission\":{\"transmissionFactor\":1}", false, false},
        {"\"KHR_materials_transmission\":{\"transmissionFactor\":1}", true, true},
        {"\"KHR_materials_transmission\":{\"transmissionFactor\":0}", true, false},
        {"\"KHR_materials_transmission\":{\"transmissionFactor\":1},\"KHR_materials_volume\":{}",
         true, false},
        {"\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
         "\"KHR_materials_volume\":{\"thicknessFactor\":1e-9}",
         false, true},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assay_context      *context = gltf_context();
        assay_scene_options options = assay_scene_options_default();
        char                json[256];
        options.solid_transmission = cases[i].option;
        snprintf(json, sizeof json, "\"extensions\":{%s}", cases[i].json);
        assay_scene *scene = load_material(context, &options, json);
        assert_int_equal(scene->materials[0].solid, cases[i].solid);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* ---- extras.assay ---- */

static void test_phong_and_ward(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = make_with_textures();
    (void)state;
    gltf_add(maker, "materials",
             "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,0.125,1],"
             "\"baseColorTexture\":{\"index\":0}},\"extras\":{\"assay\":{\"brdf\":\"phong\","
             "\"exponent\":20,\"specular\":[0.5,0.5,0.5]}}");
    gltf_add(maker, "materials",
             "\"extras\":{\"assay\":{\"brdf\":\"ward\",\"alpha\":[0.1,0.5],"
             "\"diffuse\":[0.7,0.3,0],\"specular\":[0.3,0.7,1]},\"other\":3}");
    gltf_add(maker, "materials",
             "\"extras\":{\"assay\":{\"brdf\":\"ward\",\"alpha\":[0.1,0.1],\"diffuse\":[0,0,0],"
             "\"specular\":[1,1,1],\"variant\":\"published\"}}");
    gltf_add(maker, "materials", "\"extras\":[1,2]");
    assay_scene          *scene = gltf_load(maker, context);
    const assay_material *phong = &scene->materials[0], *ward = &scene->materials[1];
    assert_int_equal(phong->model, ASSAY_MATERIAL_PHONG);
    assert_true(phong->exponent == 20.0 && phong->base_color[1] == 0.25);
    assert_true(phong->specular_color.g == 0.5);
    assert_int_equal(phong->base_color_texture.texture, 0);
    assert_int_equal(ward->model, ASSAY_MATERIAL_WARD);
    assert_true(ward->alpha_x == 0.1 && ward->alpha_y == 0.5);
    assert_true(ward->base_color[0] == 0.7 && ward->specular_color.b == 1.0);
    assert_int_equal(scene->materials[2].model, ASSAY_MATERIAL_WARD_PUBLISHED);
    assert_int_equal(scene->materials[3].model, ASSAY_MATERIAL_PBR);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- force_diffuse ---- */

static void test_force_diffuse(void **state)
{
    assay_context      *context = gltf_context();
    assay_scene_options options = assay_scene_options_default();
    (void)state;
    for (int two_sided = 0; two_sided < 2; two_sided++) {
        char json[1024];
        options.force_diffuse = true;
        snprintf(json, sizeof json,
                 "\"doubleSided\":%s,\"alphaMode\":\"BLEND\",\"emissiveFactor\":[1,1,1],"
                 "\"emissiveTexture\":{\"index\":0},\"normalTexture\":{\"index\":0},"
                 "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,0.4],"
                 "\"baseColorTexture\":{\"index\":1},\"metallicFactor\":1},\"extensions\":{"
                 "\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
                 "\"KHR_materials_volume\":{\"thicknessFactor\":1}}",
                 two_sided ? "true" : "false");
        assay_scene          *scene = load_material(context, &options, json);
        const assay_material *m     = &scene->materials[0];
        assert_int_equal(m->model, ASSAY_MATERIAL_LAMBERT);
        assert_true(m->base_color[0] == 0.1 && m->base_color[2] == 0.3 && m->base_color[3] == 1.0);
        assert_int_equal(m->base_color_texture.texture, 1);
        assert_true(m->double_sided && !m->solid && m->transmission == 0.0 && m->metallic == 0.0);
        assert_int_equal(m->emission_two_sided, two_sided);
        assert_int_equal(m->alpha_mode, ASSAY_ALPHA_OPAQUE);
        assert_int_equal(m->emissive_texture.texture, 0);
        assert_true(m->emissive.r == 1.0);
        assert_int_equal(m->normal_texture.texture, ASSAY_NONE);
        assert_int_equal(scene->materials[1].model, ASSAY_MATERIAL_LAMBERT);
        assay_scene_destroy(scene);
    }
    assay_context_destroy(context);
}

/* The diffuse reflectance of extras.assay belongs to its model, and goes with it. */
static void test_force_diffuse_drops_extras(void **state)
{
    assay_context      *context = gltf_context();
    assay_scene_options options = assay_scene_options_default();
    static const char   json[] =
        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.6,0.3,0.2,1]},\"extras\":{\"assay\":{"
        "\"brdf\":\"phong\",\"exponent\":5,\"diffuse\":[0.1,0.1,0.1],\"specular\":[0.5,0.5,0.5]}}";
    (void)state;
    for (int forced = 0; forced < 2; forced++) {
        options.force_diffuse       = forced;
        assay_scene          *scene = load_material(context, &options, json);
        const assay_material *m     = &scene->materials[0];
        assert_int_equal(m->model, forced ? ASSAY_MATERIAL_LAMBERT : ASSAY_MATERIAL_PHONG);
        assert_true(m->base_color[0] == (forced ? 0.6 : 0.1));
        assert_true(m->base_color[1] == (forced ? 0.3 : 0.1));
        assert_true(m->base_color[2] == (forced ? 0.2 : 0.1));
        assay_scene_destroy(scene);
    }
    assay_context_destroy(context);
}

/* ---- lights ---- */

static void test_lights(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    gltf_shown_triangle(maker);
    gltf_root(maker,
              "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":["
              "{\"type\":\"point\",\"color\":[1,0.5,0.25],\"intensity\":4,\"range\":8},"
              "{\"type\":\"spot\",\"spot\":{\"innerConeAngle\":0.25,\"outerConeAngle\":0.5}},"
              "{\"type\":\"directional\",\"intensity\":3,\"range\":5},{\"type\":\"spot\"}]}}");
    for (int i = 0; i < 4; i++) {
        /* a quarter turn about x takes -z to -y... and the scale changes nothing */
        gltf_add(
            maker, "nodes",
            "\"translation\":[%d,2,3],\"rotation\":[-0.7071067811865475,0,0,0.7071067811865476],"
            "\"scale\":[7,7,7],\"extensions\":{\"KHR_lights_punctual\":{\"light\":%d}}",
            i, i);
    }
    assay_scene                *scene = gltf_load(maker, context);
    const assay_punctual_light *l     = scene->punctual;
    const assay_scene_info      info  = assay_scene_describe(scene);
    assert_int_equal(scene->punctual_count, 4);
    assert_int_equal(info.point_lights, 1);
    assert_int_equal(info.spot_lights, 2);
    assert_int_equal(info.directional_lights, 1);
    assert_true(info.has_light);
    for (int i = 0; i < 4; i++) {
        assert_true(l[i].position.x == i && l[i].position.y == 2.0 && l[i].position.z == 3.0);
        assert_near(l[i].direction.x, 0.0, 1e-15);
        assert_near(l[i].direction.y, -1.0, 1e-15);
        assert_near(l[i].direction.z, 0.0, 1e-15);
    }
    assert_true(l[0].intensity.r == 4.0 && l[0].intensity.g == 2.0 && l[0].intensity.b == 1.0);
    assert_true(l[0].range == 8.0 && isinf(l[1].range) && isinf(l[2].range));
    assert_near(l[1].cos_inner, cos(0.25), 1e-15);
    assert_near(l[1].cos_outer, cos(0.5), 1e-15);
    assert_near(l[3].cos_inner, 1.0, 0.0);
    assert_near(l[3].cos_outer, sqrt(0.5), 1e-15);
    assert_true(l[2].intensity.g == 3.0);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_core),
        cmocka_unit_test(test_image_in_a_view),
        cmocka_unit_test(test_extensions),
        cmocka_unit_test(test_unlit),
        cmocka_unit_test(test_texture_transform),
        cmocka_unit_test(test_solid),
        cmocka_unit_test(test_phong_and_ward),
        cmocka_unit_test(test_force_diffuse_drops_extras),
        cmocka_unit_test(test_force_diffuse),
        cmocka_unit_test(test_lights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
