/* closed_forms.c - scenes whose radiance is known: furnaces, a rectangle over a plane, two plates.
 *
 * The formulas are in each scene's README.md. */
#include "own_scenes.h"

static const assay_vec3 origin = {0.0, 0.0, 0.0};

static gltf_material emitter(const char *name, double reflectance, double radiance)
{
    gltf_material m     = gltf_lambertian(name, reflectance, reflectance, reflectance);
    m.emissive[0]       = 1.0;
    m.emissive[1]       = 1.0;
    m.emissive[2]       = 1.0;
    m.emissive_strength = radiance;
    return m;
}

static void add_and_release(gltf_document *d, const char *name, solid_mesh *mesh, int material)
{
    gltf_add_mesh_node(d, name, gltf_add_mesh(d, name, mesh, material), origin);
    mesh_release(mesh);
}

/* A horizontal rectangle centred at (0, y, 0); its front looks up or down. */
static void add_rectangle(gltf_document *d, const char *name, double width, double depth, double y,
                          bool down, int material)
{
    const double x = 0.5 * width, z = down ? -0.5 * depth : 0.5 * depth;
    solid_mesh   mesh;
    mesh_init(&mesh, true);
    mesh_quad(&mesh, vec3(-x, y, z), vec3(x, y, z), vec3(x, y, -z), vec3(-x, y, -z));
    add_and_release(d, name, &mesh, material);
}

gltf_document *make_furnace(void)
{
    gltf_document *d = gltf_create(
        "furnace", "A closed unit cube, every wall reflects 0.5 and emits 1; see README.md");
    solid_mesh room;
    mesh_init(&room, true);
    mesh_box(&room, origin, vec3(1.0, 1.0, 1.0), true);
    add_and_release(d, "room", &room, gltf_add_material(d, emitter("wall", 0.5, 1.0)));
    gltf_add_perspective(d, "inside", 1.2, vec3(0.25, 0.5, 0.875), vec3(0.625, 0.375, 0.0));
    return d;
}

gltf_document *make_furnace_sphere(void)
{
    gltf_document *d = gltf_create(
        "furnace-sphere",
        "A convex polyhedron that reflects 0.9, to be lit by a constant background; see README.md");
    solid_mesh sphere;
    mesh_init(&sphere, true);
    mesh_icosphere(&sphere, origin, 1.0, 3);
    add_and_release(d, "sphere", &sphere,
                    gltf_add_material(d, gltf_lambertian("grey", 0.9, 0.9, 0.9)));
    gltf_add_perspective(d, "front", 0.75, vec3(0.0, 0.0, 4.0), origin);
    return d;
}

gltf_document *make_rectangle_over_plane(void)
{
    gltf_document *d = gltf_create(
        "rectangle-over-plane",
        "A one-sided emitting rectangle of 1 m by 2 m, 1 m over a floor; see README.md");
    const int grey  = gltf_add_material(d, gltf_lambertian("floor", 0.5, 0.5, 0.5));
    const int light = gltf_add_material(d, emitter("light", 0.0, 4.0));
    add_rectangle(d, "floor", 10.0, 10.0, 0.0, false, grey);
    add_rectangle(d, "light", 1.0, 2.0, 1.0, true, light);
    gltf_add_perspective(d, "side", 0.8, vec3(3.5, 0.5, 3.0), vec3(0.0, 0.5, 0.0));
    gltf_add_orthographic(d, "plan", 2.0, 2.0, vec3(0.0, 0.875, 0.0), origin);
    return d;
}

gltf_document *make_two_plates(void)
{
    gltf_document *d = gltf_create(
        "two-plates", "Two parallel unit squares 1 m apart, the upper one emits; see README.md");
    const int grey  = gltf_add_material(d, gltf_lambertian("receiver", 0.5, 0.5, 0.5));
    const int light = gltf_add_material(d, emitter("emitter", 0.0, 1.0));
    add_rectangle(d, "receiver", 1.0, 1.0, 0.0, false, grey);
    add_rectangle(d, "emitter", 1.0, 1.0, 1.0, true, light);
    gltf_add_orthographic(d, "plan", 0.5, 0.5, vec3(0.0, 0.5, 0.0), origin);
    gltf_add_perspective(d, "side", 0.7, vec3(1.75, 0.625, 2.0), vec3(0.0, 0.4375, 0.0));
    return d;
}
