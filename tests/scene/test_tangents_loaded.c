/* test_tangents_loaded.c - tangents that the loader makes: for whom, with what, and without memory.
 *
 * The rules themselves are in test_tangent_space.c. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "support/failing_context.h"
#include "support/gltf_maker.h"
#include "support/near.h"

/* An image and its mirror image meet at x = 0, with shared vertices. */
static const float    FRONT[18]   = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static const float    SEAM[18]    = {-1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 1, 0, 0, 1, 0, 1, 1, 0};
static const float    SEAM_UV[12] = {1, 0, 0, 0, 1, 0, 1, -1, 0, -1, 1, -1};
static const uint16_t SEAM_AT[12] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};

static double off(const float *t, double x, double y, double z, double w)
{
    return fmax(fmax(fabs(t[0] - x), fabs(t[1] - y)), fmax(fabs(t[2] - z), fabs(t[3] - w)));
}

static const char SEAM_MESH[] =
    "\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"TEXCOORD_0\":%d},\"indices\":%d,"
    "\"material\":%d,\"targets\":[{\"POSITION\":%d}]";

/* The mirrored seam through the loader, where a Ward material asks for tangents. */
static assay_status load_seam(assay_context *context, void *user)
{
    const bool   ward  = *(const bool *)user;
    gltf_maker  *maker = gltf_maker_create();
    assay_scene *scene = NULL;
    gltf_add(maker, "materials", "\"name\":\"plain\"");
    gltf_add(maker, "materials",
             "\"extras\":{\"assay\":{\"brdf\":\"ward\",\"alpha\":[0.1,0.3],"
             "\"specular\":[0.2,0.2,0.2],\"diffuse\":[0.5,0.5,0.5]}}");
    const int p = gltf_floats(maker, "VEC3", 6, SEAM), n = gltf_floats(maker, "VEC3", 6, FRONT);
    const int t = gltf_floats(maker, "VEC2", 6, SEAM_UV), i = gltf_shorts(maker, 12, SEAM_AT);
    gltf_shown_mesh(maker, SEAM_MESH, p, n, t, i, ward ? 1 : 0, p);
    const assay_status status = gltf_load_status(maker, context, NULL, &scene);
    if (status == ASSAY_OK) {
        const assay_shape *shape = &scene->shapes[0];
        assert_int_equal(scene->vertex_count, ward ? 8 : 6);
        assert_int_equal(shape->tangents != NULL, ward);
        for (int c = 0; ward && c < 12; c++) {
            const uint32_t v = scene->indices[c];
            const double   x = c < 6 ? -1 : 1;
            assert_near(off(shape->tangents + 4 * (size_t)v, x, 0, 0, x), 0.0, 1e-6);
            assert_memory_equal(scene->positions + 3 * (size_t)v, SEAM + 3 * SEAM_AT[c], 12);
            assert_memory_equal(shape->primitive->targets[0].positions + 3 * (size_t)v,
                                SEAM + 3 * SEAM_AT[c], 12);
        }
    }
    assay_scene_destroy(scene);
    return status;
}

static void loaded(void **state)
{
    (void)state;
    bool ward = false;
    assert_true(failing_each(load_seam, &ward) > 10);
    ward = true;
    assert_true(failing_each(load_seam, &ward) > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(loaded)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
