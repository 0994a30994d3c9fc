/* lobes.c - spheres so far from one another that each sees nothing but the sky.
 *
 * For methods that know light from infinitely far alone: path tracing of one bounce must agree. */
#include "own_scenes.h"

static const double APART = 256.0; /* m: a neighbour covers 5e-5 sr */

static void add_sphere(gltf_document *d, int place, gltf_material material)
{
    const assay_vec3 centre = vec3(APART * place, 0.0, 0.0);
    solid_mesh       sphere;
    mesh_init(&sphere, false);
    mesh_icosphere(&sphere, vec3(0.0, 0.0, 0.0), 1.0, 4);
    gltf_add_mesh_node(d, material.name,
                       gltf_add_mesh(d, material.name, &sphere, gltf_add_material(d, material)),
                       centre);
    mesh_release(&sphere);
    gltf_add_perspective(d, material.name, 0.6, vec3(centre.x, 1.5, 4.0), centre);
}

gltf_document *make_lobes(void)
{
    gltf_document *d =
        gltf_create("lobes", "Three glossy spheres, each alone under the sky; see README.md");
    gltf_material phong   = gltf_lambertian("phong", 0.3, 0.2, 0.1);
    gltf_material satin   = gltf_lambertian("satin", 0.9, 0.6, 0.3);
    gltf_material plastic = gltf_lambertian("plastic", 0.1, 0.2, 0.5);
    phong.extras =
        "{\"assay\": {\"brdf\": \"phong\", \"exponent\": 20, \"diffuse\": [0.3, 0.2, 0.1], "
        "\"specular\": [0.5, 0.5, 0.5]}}";
    satin.metallic    = 1.0;
    satin.roughness   = 0.6;
    satin.specular    = 1.0;
    plastic.roughness = 0.5;
    plastic.specular  = 1.0;
    add_sphere(d, 0, phong);
    add_sphere(d, 1, satin);
    add_sphere(d, 2, plastic);
    return d;
}
