/* animated.c - one moving part for every kind of motion of glTF, each with a closed form.
 *
 * Four seconds; the formulas are in scenes/animated/README.md. */
#include "own_scenes.h"

static const assay_vec3 origin = {0.0, 0.0, 0.0};

#define HALF_SQRT2 0.70710678118654752440

static int add_box(gltf_document *d, const char *name, assay_vec3 low, assay_vec3 high,
                   int material, assay_vec3 at)
{
    solid_mesh mesh;
    mesh_init(&mesh, true);
    mesh_box(&mesh, low, high, false);
    const int node = gltf_add_mesh_node(d, name, gltf_add_mesh(d, name, &mesh, material), at);
    mesh_release(&mesh);
    return node;
}

static int grey(gltf_document *d, const char *name, double r, double g, double b)
{
    return gltf_add_material(d, gltf_lambertian(name, r, g, b));
}

/* One turn about +Y in four seconds: a quarter between two keys. */
static void add_spinner(gltf_document *d)
{
    static const float times[5]  = {0, 1, 2, 3, 4};
    const float        h         = (float)HALF_SQRT2;
    const float        turns[20] = {0, 0, 0, 1, 0, h, 0, h, 0, 1, 0, 0, 0, h, 0, -h, 0, 0, 0, -1};
    const int node = add_box(d, "spinner", vec3(-0.375, -0.25, -0.125), vec3(0.375, 0.25, 0.125),
                             grey(d, "red", 0.6, 0.1, 0.1), vec3(-3.0, 0.5, 0.0));
    gltf_add_channel(d, node, GLTF_ROTATION, GLTF_LINEAR, times, 5, turns);
}

/* Jumps at whole seconds. */
static void add_stepper(gltf_document *d)
{
    static const float times[4]   = {0, 1, 2, 3};
    static const float places[12] = {-1.5f, 0.25f, 0, -1.5f, 0.75f, 0,
                                     -1.5f, 1.25f, 0, -1.5f, 0.25f, 0};
    const int node = add_box(d, "stepper", vec3(-0.25, -0.25, -0.25), vec3(0.25, 0.25, 0.25),
                             grey(d, "green", 0.1, 0.5, 0.1), vec3(-1.5, 0.25, 0.0));
    gltf_add_channel(d, node, GLTF_TRANSLATION, GLTF_STEP, times, 4, places);
}

/* Thrown up twice: between keys, height 0.25 + 2 s - s^2 at s seconds after the key, which a cubic
 * with the slopes 2 and -2 m/s is exactly. */
static void add_jumper(gltf_document *d)
{
    static const float times[3]    = {0, 2, 4};
    static const float splines[27] = {0, 0,  0, 0, 0.25f, 0, 0, 2, 0, /* in, value, out */
                                      0, -2, 0, 0, 0.25f, 0, 0, 2, 0,
                                      0, -2, 0, 0, 0.25f, 0, 0, 0, 0};
    const int node = add_box(d, "jumper", vec3(-0.25, -0.25, -0.25), vec3(0.25, 0.25, 0.25),
                             grey(d, "blue", 0.1, 0.15, 0.6), vec3(0.0, 0.25, 0.0));
    gltf_add_channel(d, node, GLTF_TRANSLATION, GLTF_CUBICSPLINE, times, 3, splines);
}

/* A box whose top rises by 0.5 m at weight 1; the weight goes 0, 1, 0. */
static void add_grower(gltf_document *d)
{
    static const float times[3]   = {0, 2, 4};
    static const float weights[3] = {0, 1, 0};
    assay_vec3         rise[24];
    solid_mesh         mesh;
    mesh_init(&mesh, true);
    mesh_box(&mesh, vec3(-0.25, 0.0, -0.25), vec3(0.25, 0.5, 0.25), false);
    for (size_t i = 0; i < mesh.vertex_count && i < 24; i++) {
        rise[i] = vec3(0.0, mesh.positions[i].y > 0.25 ? 0.5 : 0.0, 0.0);
    }
    const int added = gltf_add_mesh(d, "grower", &mesh, grey(d, "yellow", 0.6, 0.5, 0.1));
    gltf_add_morph_target(d, added, rise, mesh.vertex_count, 0.0);
    const int node = gltf_add_mesh_node(d, "grower", added, vec3(1.5, 0.0, 0.0));
    gltf_add_channel(d, node, GLTF_WEIGHTS, GLTF_LINEAR, times, 3, weights);
    mesh_release(&mesh);
}

/* A bar of 1.5 m in twelve slices; weight of the upper joint 0 below 0.5 m, 1 above 1 m. */
static void bar(solid_mesh *mesh)
{
    const double x[5] = {-0.125, 0.125, 0.125, -0.125, -0.125};
    const double z[5] = {0.125, 0.125, -0.125, -0.125, 0.125};
    for (int slice = 0; slice < 12; slice++) {
        const double low = 0.125 * slice, high = low + 0.125;
        for (int i = 0; i < 4; i++) {
            mesh_quad(mesh, vec3(x[i], low, z[i]), vec3(x[i + 1], low, z[i + 1]),
                      vec3(x[i + 1], high, z[i + 1]), vec3(x[i], high, z[i]));
        }
    }
    mesh_quad(mesh, vec3(-0.125, 1.5, 0.125), vec3(0.125, 1.5, 0.125), vec3(0.125, 1.5, -0.125),
              vec3(-0.125, 1.5, -0.125));
    mesh_quad(mesh, vec3(-0.125, 0.0, -0.125), vec3(0.125, 0.0, -0.125), vec3(0.125, 0.0, 0.125),
              vec3(-0.125, 0.0, 0.125));
}

/* The upper joint, at 0.75 m, turns a quarter about +Z and back. */
static void add_bender(gltf_document *d)
{
    static const float times[3]  = {0, 2, 4};
    const float        h         = (float)HALF_SQRT2;
    const float        turns[12] = {0, 0, 0, 1, 0, 0, h, h, 0, 0, 0, 1};
    double             weights[256];
    solid_mesh         mesh;
    mesh_init(&mesh, true);
    bar(&mesh);
    for (size_t i = 0; i < mesh.vertex_count && i < 256; i++) {
        const double w = 2.0 * (mesh.positions[i].y - 0.5);
        weights[i]     = w < 0.0 ? 0.0 : w > 1.0 ? 1.0 : w;
    }
    const int added = gltf_add_mesh(d, "bender", &mesh, grey(d, "white", 0.7, 0.7, 0.7));
    gltf_bind_to_joints(d, added, weights, mesh.vertex_count);
    mesh_release(&mesh);

    gltf_node lower                  = gltf_node_default("lower joint");
    lower.transform                  = GLTF_TRS;
    lower.translation                = vec3(3.0, 0.0, 0.0);
    const int lower_index            = gltf_add_node(d, lower);
    gltf_node upper                  = gltf_node_default("upper joint");
    upper.parent                     = lower_index;
    upper.transform                  = GLTF_TRS;
    upper.translation                = vec3(0.0, 0.75, 0.0);
    const int        upper_index     = gltf_add_node(d, upper);
    const int        joints[2]       = {lower_index, upper_index};
    const assay_vec3 inverse_bind[2] = {origin, {0.0, -0.75, 0.0}};

    gltf_node node = gltf_node_default("bender");
    node.mesh      = added;
    node.skin      = gltf_add_skin(d, joints, inverse_bind, 2);
    gltf_add_node(d, node);
    gltf_add_channel(d, upper_index, GLTF_ROTATION, GLTF_LINEAR, times, 3, turns);
}

gltf_document *make_animated(void)
{
    gltf_document *d =
        gltf_create("animated", "One part for every kind of motion, four seconds; see README.md");
    solid_mesh floor, panel;
    mesh_init(&floor, true);
    mesh_quad(&floor, vec3(-5, -0.125, 3), vec3(5, -0.125, 3), vec3(5, -0.125, -3),
              vec3(-5, -0.125, -3));
    gltf_add_mesh_node(d, "floor",
                       gltf_add_mesh(d, "floor", &floor, grey(d, "floor", 0.5, 0.5, 0.5)), origin);
    mesh_release(&floor);
    gltf_material light     = gltf_lambertian("light", 0.0, 0.0, 0.0);
    light.emissive[0]       = 1.0;
    light.emissive[1]       = 1.0;
    light.emissive[2]       = 1.0;
    light.emissive_strength = 4.0;
    mesh_init(&panel, true);
    mesh_quad(&panel, vec3(-3, 4, -1), vec3(3, 4, -1), vec3(3, 4, 1), vec3(-3, 4, 1));
    gltf_add_mesh_node(d, "panel", gltf_add_mesh(d, "panel", &panel, gltf_add_material(d, light)),
                       origin);
    mesh_release(&panel);
    add_spinner(d);
    add_stepper(d);
    add_jumper(d);
    add_grower(d);
    add_bender(d);
    gltf_add_perspective(d, "front", 0.75, vec3(0.0, 2.0, 9.0), vec3(0.0, 1.0, 0.0));
    return d;
}
