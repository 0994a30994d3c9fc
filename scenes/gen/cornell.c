/* cornell.c - the Cornell box: published vertices [cornellbox], and a variant with a glossy wall.
 *
 * Lists are in millimetres and in the published order, which is counter-clockwise seen from inside
 * the room (from outside for the blocks).  The published frame (x to the left, y up, z into the
 * room, as seen through the open front) is right-handed: it is kept. */
#include "cornell_spectra.h"
#include "own_scenes.h"

typedef struct {
    double x, y, z; /* mm */
} millimetres;

static const millimetres floor_quad[4] = {
    {552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}};
static const millimetres back_quad[4] = {
    {549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556.0, 548.8, 559.2}};
static const millimetres right_quad[4] = {
    {0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}};
static const millimetres left_quad[4] = {
    {552.8, 0, 0}, {549.6, 0, 559.2}, {556.0, 548.8, 559.2}, {556.0, 548.8, 0}};
static const millimetres light_quad[4] = {
    {343.0, 548.8, 227.0}, {343.0, 548.8, 332.0}, {213.0, 548.8, 332.0}, {213.0, 548.8, 227.0}};

/* The published ceiling, cut into four round the light, which lies in its plane. */
static const millimetres ceiling_outer[4] = {
    {556.0, 548.8, 0}, {556.0, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}};

static const millimetres short_block[5][4] = {
    {{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}},
    {{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}},
    {{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}},
    {{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}},
    {{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}};

static const millimetres tall_block[5][4] = {
    {{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}},
    {{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}},
    {{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}},
    {{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}},
    {{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}};

static assay_vec3 metres(millimetres p) { return vec3(p.x / 1000.0, p.y / 1000.0, p.z / 1000.0); }

static void add_quad(solid_mesh *mesh, const millimetres q[4])
{
    mesh_quad(mesh, metres(q[0]), metres(q[1]), metres(q[2]), metres(q[3]));
}

/* One node of quads at the origin. */
static void add_part(gltf_document *d, const char *name, const millimetres (*quads)[4], int count,
                     int material)
{
    solid_mesh mesh;
    mesh_init(&mesh, true);
    for (int i = 0; i < count; i++) {
        add_quad(&mesh, quads[i]);
    }
    gltf_add_mesh_node(d, name, gltf_add_mesh(d, name, &mesh, material), vec3(0.0, 0.0, 0.0));
    mesh_release(&mesh);
}

static void add_ceiling(gltf_document *d, int material)
{
    millimetres quads[4][4];
    for (int i = 0; i < 4; i++) {
        const int next = (i + 1) % 4;
        quads[i][0]    = ceiling_outer[i];
        quads[i][1]    = ceiling_outer[next];
        quads[i][2]    = light_quad[next];
        quads[i][3]    = light_quad[i];
    }
    add_part(d, "ceiling", (const millimetres(*)[4])quads, 4, material);
}

static gltf_material paint(const char *name, cornell_paint which)
{
    double rgb[3];
    cornell_reflectance(which, rgb);
    return gltf_lambertian(name, rgb[0], rgb[1], rgb[2]);
}

/* The lamp's own surface reflects 0.78 at all wavelengths [cornellbox]. */
static gltf_material lamp(void)
{
    const double  strength = 25.0;
    gltf_material material = gltf_lambertian("light", 0.78, 0.78, 0.78);
    double        rgb[3];
    cornell_radiance(rgb);
    for (int c = 0; c < 3; c++) {
        material.emissive[c] = rgb[c] / strength;
    }
    material.emissive_strength = strength;
    return material;
}

static gltf_document *cornell(const char *name, const char *description, const char *back_extras)
{
    gltf_document *d     = gltf_create(name, description);
    const int      white = gltf_add_material(d, paint("white", CORNELL_WHITE));
    const int      green = gltf_add_material(d, paint("green", CORNELL_GREEN));
    const int      red   = gltf_add_material(d, paint("red", CORNELL_RED));
    const int      light = gltf_add_material(d, lamp());
    int            back  = white;
    if (back_extras) {
        gltf_material glossy = paint("glossy", CORNELL_WHITE);
        glossy.extras        = back_extras;
        back                 = gltf_add_material(d, glossy);
    }
    add_part(d, "floor", &floor_quad, 1, white);
    add_part(d, "light", &light_quad, 1, light);
    add_ceiling(d, white);
    add_part(d, "back wall", &back_quad, 1, back);
    add_part(d, "right wall", &right_quad, 1, green);
    add_part(d, "left wall", &left_quad, 1, red);
    add_part(d, "short block", short_block, 5, white);
    add_part(d, "tall block", tall_block, 5, white);
    /* Focal length 35 mm, film 25 mm square: 2 atan(12.5 / 35). */
    gltf_add_perspective(d, "front", 0.6860478808414068, vec3(0.278, 0.273, -0.8),
                         vec3(0.278, 0.273, 0.0));
    return d;
}

gltf_document *make_cornell_box(void)
{
    return cornell("cornell-box",
                   "Cornell box, measured geometry and reflectances, all diffuse; see README.md",
                   NULL);
}

gltf_document *make_cornell_box_glossy(void)
{
    return cornell("cornell-box-glossy",
                   "Cornell box with a glossy back wall, Phong exponent 20; see README.md",
                   "{\"assay\": {\"brdf\": \"phong\", \"exponent\": 20, "
                   "\"diffuse\": [0.37, 0.37, 0.37], \"specular\": [0.37, 0.37, 0.37]}}");
}
