/* colonnade.c - a two-storey colonnade round a court that is open to the sky.
 *
 * Frame: the court's column axes lie on the rectangle |x| = HALF_X, |z| = HALF_Z; d is the distance
 * outwards from it.  Every part is a closed solid that ends inside its neighbours: no gaps, and no
 * two faces in one plane that overlap.  Only the floor, the cloths and the sky are sheets. */
#include <stdio.h>

#include "colonnade_parts.h"
#include "own_scenes.h"

static const assay_vec3 origin = {0.0, 0.0, 0.0};

typedef struct {
    gltf_document *d;
    int stone, pale, plaster, tile_light, tile_dark, roof, wood, bronze, red, green, blue;
} hall;

/* ---- placing ---- */

/* The four sides of the court, outward direction +z, +x, -z, -x. */
static gltf_node side_node(const char *name, int mesh, int side, double along, double y)
{
    static const assay_vec3 right[4]   = {{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 0, 1}};
    static const assay_vec3 outward[4] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
    gltf_node               node       = gltf_node_default(name);
    const double            distance   = side % 2 ? HALF_X : HALF_Z;
    const assay_vec3        foot       = vec3_scale(outward[side], distance);
    node.mesh                          = mesh;
    node.translation = vec3_add(vec3_mad(foot, along, right[side]), vec3(0.0, y, 0.0));
    node.transform   = side ? GLTF_MATRIX : GLTF_TRS;
    node.axes[0]     = right[side];
    node.axes[2]     = outward[side];
    return node;
}

static int bays_of(int side) { return side % 2 ? BAYS_Z : BAYS_X; }

/* A part at every bay's middle, or at every column axis between bays. */
static void add_along_sides(hall *h, const char *name, int mesh, double y, bool at_columns)
{
    for (int side = 0; side < 4; side++) {
        const int bays = bays_of(side);
        for (int i = 0; i < (at_columns ? bays - 1 : bays); i++) {
            char label[48];
            snprintf(label, sizeof label, "%s %c%d", name, "SENW"[side], i + 1);
            const double along = (i + (at_columns ? 1.0 : 0.5) - 0.5 * bays) * BAY;
            gltf_add_node(h->d, side_node(label, mesh, side, along, y));
        }
    }
}

static int finish(hall *h, const char *name, solid_mesh *mesh, int material)
{
    const int added = gltf_add_mesh(h->d, name, mesh, material);
    mesh_release(mesh);
    return added;
}

/* ---- storeys ---- */

static void add_storey(hall *h, const storey_shape *s)
{
    char       name[4][48];
    solid_mesh mesh;
    column_solid(&mesh, s);
    add_along_sides(h, s->column_name, finish(h, s->column_name, &mesh, h->pale), s->base, true);

    archivolt_solid(&mesh);
    add_along_sides(h, s->archivolt_name, finish(h, s->archivolt_name, &mesh, h->pale),
                    s->springing, false);

    for (int side = 0; side < 4; side++) {
        snprintf(name[side], sizeof name[side], "%s %c", s->arcade_name, "SENW"[side]);
    }
    arcade_solid(&mesh, s, BAYS_X);
    const int along_x = finish(h, s->arcade_name, &mesh, h->stone);
    arcade_solid(&mesh, s, BAYS_Z);
    const int along_z = finish(h, s->arcade_name, &mesh, h->stone);
    for (int side = 0; side < 4; side++) {
        gltf_add_node(h->d, side_node(name[side], side % 2 ? along_z : along_x, side, 0.0, 0.0));
    }

    pilaster_solid(&mesh, s);
    add_along_sides(h, s->pilaster_name, finish(h, s->pilaster_name, &mesh, h->pale), s->base,
                    true);
}

static void add_corner_piers(hall *h)
{
    solid_mesh mesh;
    pier_solid(&mesh);
    const int pier = finish(h, "pier", &mesh, h->stone);
    for (int i = 0; i < 4; i++) {
        char label[48];
        snprintf(label, sizeof label, "pier %d", i + 1);
        gltf_add_mesh_node(h->d, label, pier,
                           vec3(i & 1 ? HALF_X : -HALF_X, 0.0, i & 2 ? HALF_Z : -HALF_Z));
    }
}

/* Parts drawn once round the court. */
static void add_rings(hall *h)
{
    solid_mesh mesh;
    outer_wall_ring(&mesh);
    gltf_add_mesh_node(h->d, "outer wall", finish(h, "outer wall", &mesh, h->plaster), origin);
    vault_ring(&mesh);
    gltf_add_mesh_node(h->d, "vault", finish(h, "vault", &mesh, h->plaster), origin);
    cornice_ring(&mesh);
    gltf_add_mesh_node(h->d, "cornice", finish(h, "cornice", &mesh, h->pale), origin);
    ceiling_ring(&mesh);
    gltf_add_mesh_node(h->d, "ceiling", finish(h, "ceiling", &mesh, h->plaster), origin);
    roof_ring(&mesh);
    gltf_add_mesh_node(h->d, "roof", finish(h, "roof", &mesh, h->roof), origin);
    kerb_ring(&mesh);
    gltf_add_mesh_node(h->d, "kerb", finish(h, "kerb", &mesh, h->pale), origin);
    rail_ring(&mesh, GALLERY - 0.02, GALLERY + 0.14, 0.13);
    gltf_add_mesh_node(h->d, "lower rail", finish(h, "lower rail", &mesh, h->stone), origin);
    rail_ring(&mesh, GALLERY + 0.84, GALLERY + 1.0, 0.15);
    gltf_add_mesh_node(h->d, "upper rail", finish(h, "upper rail", &mesh, h->stone), origin);
}

/* ---- things ---- */

static void add_furnishing(hall *h)
{
    solid_mesh mesh;
    baluster_row(&mesh);
    add_along_sides(h, "balusters", finish(h, "balusters", &mesh, h->pale), GALLERY, false);
    beam_solid(&mesh);
    const int beam = finish(h, "beam", &mesh, h->wood);
    add_along_sides(h, "beam", beam, 0.0, true);
    add_along_sides(h, "half beam", beam, 0.0, false);
    basin_solid(&mesh);
    gltf_add_mesh_node(h->d, "basin", finish(h, "basin", &mesh, h->pale), origin);
    finial_solid(&mesh);
    gltf_add_mesh_node(h->d, "finial", finish(h, "finial", &mesh, h->bronze), origin);
    door_solid(&mesh);
    const int door = finish(h, "door", &mesh, h->wood);
    for (int storey = 0; storey < 2; storey++) {
        const double y = storey ? GALLERY : 0.0;
        for (int side = 0; side < 4; side++) {
            for (int i = 0; i < (side % 2 ? 1 : 2); i++) {
                const double along = side % 2 ? 0.0 : (i ? 1.5 : -1.5) * BAY;
                char         label[48];
                snprintf(label, sizeof label, "door %c%d%d", "SENW"[side], storey + 1, i + 1);
                gltf_add_node(h->d, side_node(label, door, side, along, y));
            }
        }
    }
}

static void add_cloths(hall *h)
{
    static const struct {
        int    side, color;
        double along;
    } banners[7]                          = {{0, 0, -2.5}, {0, 1, -0.5}, {0, 2, 1.5}, {2, 1, -1.5},
                                             {2, 2, 0.5},  {2, 0, 2.5},  {3, 0, 0.0}};
    static const char *const names[3]     = {"red cloth", "green cloth", "blue cloth"};
    const int                materials[3] = {h->red, h->green, h->blue};
    int                      meshes[3];
    for (int c = 0; c < 3; c++) {
        solid_mesh mesh;
        banner_sheet(&mesh, c);
        meshes[c] = finish(h, names[c], &mesh, materials[c]);
    }
    for (int i = 0; i < 7; i++) {
        char label[48];
        snprintf(label, sizeof label, "cloth %d", i + 1);
        gltf_add_node(h->d, side_node(label, meshes[banners[i].color], banners[i].side,
                                      banners[i].along * BAY, 0.0));
    }
}

static void add_floor(hall *h)
{
    solid_mesh mesh;
    floor_tiles(&mesh, 0);
    gltf_add_mesh_node(h->d, "light tiles", finish(h, "light tiles", &mesh, h->tile_light), origin);
    floor_tiles(&mesh, 1);
    gltf_add_mesh_node(h->d, "dark tiles", finish(h, "dark tiles", &mesh, h->tile_dark), origin);
}

/* ---- light ---- */

/* The sky ends in the east where the sun's rays to the court begin: those that pass the western
 * edge of the roof, at x = -9.25 m and 10.6 m up, come down from x = 5.3 m at the sky's height. */
#define SKY_HEIGHT 24.0

static void add_light(hall *h)
{
    static const double warm[3] = {1.0, 0.93, 0.8};
    gltf_material       sky     = gltf_lambertian("sky", 0.0, 0.0, 0.0);
    sky.emissive[0]             = 0.7;
    sky.emissive[1]             = 0.85;
    sky.emissive[2]             = 1.0;
    sky.emissive_strength       = 2.5;
    solid_mesh mesh;
    mesh_init(&mesh, true);
    mesh_quad(&mesh, vec3(-38.0, SKY_HEIGHT, -12.0), vec3(5.0, SKY_HEIGHT, -12.0),
              vec3(5.0, SKY_HEIGHT, 12.0), vec3(-38.0, SKY_HEIGHT, 12.0));
    gltf_add_mesh_node(h->d, "sky", finish(h, "sky", &mesh, gltf_add_material(h->d, sky)), origin);
    gltf_add_sun(h->d, "sun", warm, 10.0, vec3(-12.0, -11.0, 4.0));
}

static void add_materials(hall *h)
{
    gltf_document *d       = h->d;
    h->stone               = gltf_add_material(d, gltf_lambertian("stone", 0.56, 0.50, 0.42));
    h->pale                = gltf_add_material(d, gltf_lambertian("pale stone", 0.68, 0.64, 0.57));
    h->plaster             = gltf_add_material(d, gltf_lambertian("plaster", 0.70, 0.66, 0.58));
    h->tile_light          = gltf_add_material(d, gltf_lambertian("light tile", 0.52, 0.48, 0.42));
    h->tile_dark           = gltf_add_material(d, gltf_lambertian("dark tile", 0.32, 0.26, 0.21));
    h->roof                = gltf_add_material(d, gltf_lambertian("terracotta", 0.45, 0.22, 0.14));
    h->wood                = gltf_add_material(d, gltf_lambertian("wood", 0.20, 0.12, 0.07));
    h->bronze              = gltf_add_material(d, gltf_lambertian("bronze", 0.30, 0.22, 0.10));
    gltf_material cloth[3] = {gltf_lambertian("red cloth", 0.60, 0.05, 0.05),
                              gltf_lambertian("green cloth", 0.06, 0.45, 0.12),
                              gltf_lambertian("blue cloth", 0.06, 0.12, 0.60)};
    for (int i = 0; i < 3; i++) {
        cloth[i].double_sided = true;
    }
    h->red   = gltf_add_material(d, cloth[0]);
    h->green = gltf_add_material(d, cloth[1]);
    h->blue  = gltf_add_material(d, cloth[2]);
}

gltf_document *make_colonnade(void)
{
    hall h = {
        .d = gltf_create("colonnade", "A two-storey colonnade round an open court; see README.md")};
    add_materials(&h);
    add_floor(&h);
    add_rings(&h);
    add_corner_piers(&h);
    add_storey(&h, colonnade_storey(0));
    add_storey(&h, colonnade_storey(1));
    add_furnishing(&h);
    add_cloths(&h);
    add_light(&h);
    gltf_add_perspective(h.d, "atrium", 1.05, vec3(9.25, 1.75, 0.75), vec3(-9.0, 4.5, -0.5));
    gltf_add_perspective(h.d, "lower_arcade", 1.0, vec3(8.5, 1.65, 6.0), vec3(-10.0, 1.75, 4.5));
    gltf_add_perspective(h.d, "upper_gallery", 0.85, vec3(11.75, 7.375, 0.5),
                         vec3(-4.0, 2.75, -1.25));
    return h.d;
}
