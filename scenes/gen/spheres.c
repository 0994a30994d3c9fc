/* spheres.c - eight spheres, one a kind of surface, on a floor under a panel.
 *
 * All spheres share one mesh's arrays (an icosphere with smooth normals); only materials differ. */
#include "own_scenes.h"

static gltf_material surface(const char *name, double r, double g, double b, double metallic,
                             double roughness)
{
    gltf_material m = gltf_lambertian(name, r, g, b);
    m.metallic      = metallic;
    m.roughness     = roughness;
    m.specular      = 1.0;
    return m;
}

static gltf_material glass(const char *name, double roughness)
{
    gltf_material m = surface(name, 1.0, 1.0, 1.0, 0.0, roughness);
    m.transmission  = 1.0;
    m.solid         = true;
    return m;
}

static void add_quad_node(gltf_document *d, const char *name, const assay_vec3 corners[4],
                          gltf_material material)
{
    solid_mesh mesh;
    mesh_init(&mesh, true);
    mesh_quad(&mesh, corners[0], corners[1], corners[2], corners[3]);
    gltf_add_mesh_node(d, name, gltf_add_mesh(d, name, &mesh, gltf_add_material(d, material)),
                       vec3(0.0, 0.0, 0.0));
    mesh_release(&mesh);
}

gltf_document *make_spheres(void)
{
    gltf_document *d =
        gltf_create("spheres", "Eight spheres, one a kind of surface; see README.md");
    const gltf_material kinds[8] = {
        surface("mirror", 0.95, 0.95, 0.95, 1.0, 0.0),
        surface("satin gold", 1.0, 0.71, 0.29, 1.0, 0.25),
        surface("rough iron", 0.56, 0.57, 0.58, 1.0, 0.6),
        glass("clear glass", 0.0),
        glass("frosted glass", 0.3),
        surface("glossy red", 0.6, 0.05, 0.05, 0.0, 0.1),
        surface("satin blue", 0.05, 0.12, 0.6, 0.0, 0.45),
        gltf_lambertian("chalk", 0.8, 0.8, 0.8),
    };
    solid_mesh sphere;
    mesh_init(&sphere, false);
    mesh_icosphere(&sphere, vec3(0.0, 0.0, 0.0), 0.5, 3);
    int first = -1;
    for (int i = 0; i < 8; i++) {
        const int material = gltf_add_material(d, kinds[i]);
        const int mesh     = first < 0 ? gltf_add_mesh(d, kinds[i].name, &sphere, material)
                                       : gltf_add_mesh_like(d, kinds[i].name, first, material);
        first              = first < 0 ? mesh : first;
        gltf_add_mesh_node(d, kinds[i].name, mesh,
                           vec3(1.25 * (i % 4) - 1.875, 0.5, i < 4 ? -0.625 : 0.625));
    }
    mesh_release(&sphere);

    const assay_vec3 floor[4] = {{-6, 0, 5}, {6, 0, 5}, {6, 0, -5}, {-6, 0, -5}};
    const assay_vec3 back[4]  = {{-6, 0, -5}, {6, 0, -5}, {6, 6, -5}, {-6, 6, -5}};
    const assay_vec3 panel[4] = {{-2, 4, -1.5}, {2, 4, -1.5}, {2, 4, 1.5}, {-2, 4, 1.5}};
    gltf_material    light    = gltf_lambertian("light", 0.0, 0.0, 0.0);
    light.emissive[0]         = 1.0;
    light.emissive[1]         = 1.0;
    light.emissive[2]         = 1.0;
    light.emissive_strength   = 6.0;
    add_quad_node(d, "floor", floor, gltf_lambertian("floor", 0.4, 0.4, 0.4));
    add_quad_node(d, "back wall", back, gltf_lambertian("wall", 0.3, 0.45, 0.55));
    add_quad_node(d, "panel", panel, light);
    gltf_add_perspective(d, "front", 0.8, vec3(0.0, 3.0, 6.5), vec3(0.0, 0.375, 0.0));
    return d;
}
