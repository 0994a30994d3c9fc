/* colonnade_parts.c - solids that are turned, boxed or arched; the rings are in colonnade_rings.c.
 *
 * A part that stands on another begins a few centimetres inside it (SINK), never in its plane. */
#include "colonnade_parts.h"

#include "turn.h"

#define SINK 0.05
#define COUNT(array) (sizeof(array) / sizeof *(array))

const storey_shape *colonnade_storey(int index)
{
    static const storey_shape storeys[2] = {
        {"lower column", "lower arcade", "lower archivolt", "lower pilaster", 0.0, 3.4, 5.3, 0.23},
        {"upper column", "upper arcade", "upper archivolt", "upper pilaster", GALLERY, 8.3, 10.3,
         0.19},
    };
    return &storeys[index];
}

static void box(solid_mesh *mesh, double half_x, double half_z, double low, double high)
{
    mesh_box(mesh, vec3(-half_x, low, -half_z), vec3(half_x, high, half_z), false);
}

/* ---- columns ---- */

/* Plinth, attic base, fluted shaft with entasis, bell capital, abacus. */
void column_solid(solid_mesh *mesh, const storey_shape *storey)
{
    const double r = storey->radius, height = storey->springing - storey->base, neck = 0.84 * r;
    const double shaft_low = 0.34, shaft_high = height - 0.52, rise = shaft_high - shaft_low;
    const profile_point profile[] = {
        {0.0, 0.10, false, 0.0},
        {1.36 * r, 0.10, false, 0.0},
        {1.44 * r, 0.135, true, 0.0}, /* lower torus */
        {1.44 * r, 0.175, true, 0.0},
        {1.34 * r, 0.205, false, 0.0},
        {1.17 * r, 0.235, true, 0.0}, /* scotia */
        {1.20 * r, 0.26, false, 0.0},
        {1.27 * r, 0.28, true, 0.0}, /* upper torus */
        {1.20 * r, 0.31, false, 0.0},
        {1.02 * r, shaft_low, false, 0.0},
        {1.00 * r, shaft_low + 0.06, true, 0.09},
        {0.985 * r, shaft_low + 0.35 * rise, true, 0.09},
        {0.93 * r, shaft_low + 0.70 * rise, true, 0.09},
        {neck, shaft_high - 0.06, true, 0.09},
        {0.86 * r, shaft_high, false, 0.0},
        {1.02 * r, shaft_high + 0.03, true, 0.0}, /* astragal */
        {0.86 * r, shaft_high + 0.06, false, 0.0},
        {0.90 * r, shaft_high + 0.18, true, 0.0}, /* bell */
        {1.08 * r, shaft_high + 0.30, true, 0.0},
        {1.38 * r, shaft_high + 0.38, false, 0.0},
        {1.38 * r, shaft_high + 0.42, false, 0.0},
        {0.0, shaft_high + 0.42, false, 0.0},
    };
    mesh_init(mesh, false);
    box(mesh, 1.5 * r, 1.5 * r, -SINK, 0.12);
    mesh_revolve(mesh, profile, COUNT(profile), 28);
    box(mesh, 0.36, 0.36, height - 0.12, height + 0.02);
}

/* ---- walls and arches ---- */

void arcade_solid(solid_mesh *mesh, const storey_shape *storey, int bays)
{
    mesh_init(mesh, false);
    mesh_arcade(mesh, &(arcade_shape){.bays      = bays,
                                      .segments  = 20,
                                      .bay       = BAY,
                                      .radius    = ARCH_RADIUS,
                                      .margin    = 0.32,
                                      .springing = storey->springing,
                                      .top       = storey->top,
                                      .thickness = WALL});
}

void archivolt_solid(solid_mesh *mesh)
{
    const double        back      = -0.01;
    const profile_point profile[] = {{0.92, back, false, 0.0},  {1.12, back, false, 0.0},
                                     {1.12, 0.020, false, 0.0}, {1.07, 0.045, true, 0.0},
                                     {0.97, 0.045, true, 0.0},  {0.92, 0.020, false, 0.0}};
    mesh_init(mesh, false);
    /* Unequal feet: in the corners of the court two end in one pier, and not in one plane. */
    mesh_archivolt(mesh, profile, COUNT(profile), 16, -0.5 * WALL, 0.015, 0.010);
}

/* Flat half pillars on the outer wall. */
void pilaster_solid(solid_mesh *mesh, const storey_shape *storey)
{
    const double back = AISLE + SINK, front = AISLE - 0.14, springing = storey->springing;
    const double height = springing - storey->base + (storey->base > 0.0 ? 1.35 : 0.95);
    mesh_init(mesh, false);
    mesh_box(mesh, vec3(-0.24, -SINK, front), vec3(0.24, height, back), false);
    mesh_box(mesh, vec3(-0.29, -1.5 * SINK, front - 0.05), vec3(0.29, 0.3, back + 0.01), false);
    mesh_box(mesh, vec3(-0.30, height - 0.25, front - 0.06), vec3(0.30, height + SINK, back + 0.01),
             false);
}

/* The four corners of the court, from below the floor into the roof. */
void pier_solid(solid_mesh *mesh)
{
    mesh_init(mesh, false);
    box(mesh, 0.40, 0.40, -SINK, 10.5);
    box(mesh, 0.46, 0.46, -2.0 * SINK, 0.34);
    box(mesh, 0.44, 0.44, 3.27, 3.43);
    box(mesh, 0.45, 0.45, 5.55, 5.9);
    box(mesh, 0.435, 0.435, 8.17, 8.33);
}

/* Carries the upper ceiling, from the arcade to the outer wall. */
void beam_solid(solid_mesh *mesh)
{
    mesh_init(mesh, false);
    mesh_box(mesh, vec3(-0.1, 9.93, 0.28), vec3(0.1, 10.25, AISLE + SINK), false);
}

/* A frame with two leaves, on the outer wall. */
void door_solid(solid_mesh *mesh)
{
    const double wall = AISLE;
    mesh_init(mesh, false);
    mesh_box(mesh, vec3(-0.75, -SINK, wall - 0.06), vec3(0.75, 2.45, wall + SINK), false);
    for (int leaf = -1; leaf <= 1; leaf += 2) {
        const double middle = 0.34 * leaf;
        for (int panel = 0; panel < 3; panel++) {
            const double low = 0.15 + 0.75 * panel;
            mesh_box(mesh, vec3(middle - 0.25, low, wall - 0.09),
                     vec3(middle + 0.25, low + 0.6, wall - 0.03), false);
        }
    }
}

/* ---- small turned things ---- */

/* Seven balusters of a bay, between the rails. */
void baluster_row(solid_mesh *mesh)
{
    static const profile_point profile[] = {
        {0.0, 0.10, false, 0.0},   {0.055, 0.10, false, 0.0}, {0.055, 0.20, false, 0.0},
        {0.035, 0.23, true, 0.0},  {0.066, 0.36, true, 0.0},  {0.058, 0.44, true, 0.0},
        {0.030, 0.62, true, 0.0},  {0.036, 0.72, false, 0.0}, {0.055, 0.76, false, 0.0},
        {0.055, 0.88, false, 0.0}, {0.0, 0.88, false, 0.0},
    };
    mesh_init(mesh, false);
    for (int i = 0; i < 7; i++) {
        const size_t first = mesh->vertex_count;
        mesh_revolve(mesh, profile, COUNT(profile), 8);
        for (size_t v = first; v < mesh->vertex_count; v++) {
            mesh->positions[v].x += 0.26 * (i - 3);
        }
    }
}

/* A round basin in the middle of the court, with a standing bowl. */
void basin_solid(solid_mesh *mesh)
{
    static const profile_point rim[] = {
        {0.0, -0.05, false, 0.0}, {1.70, -0.05, false, 0.0}, {1.70, 0.12, false, 0.0},
        {1.62, 0.16, false, 0.0}, {1.58, 0.42, true, 0.0},   {1.66, 0.50, true, 0.0},
        {1.68, 0.56, false, 0.0}, {1.40, 0.56, false, 0.0},  {1.34, 0.30, true, 0.0},
        {1.10, 0.20, true, 0.0},  {0.0, 0.18, false, 0.0},
    };
    static const profile_point bowl[] = {
        {0.0, 0.10, false, 0.0},  {0.32, 0.10, false, 0.0}, {0.28, 0.30, true, 0.0},
        {0.14, 0.50, true, 0.0},  {0.12, 0.90, true, 0.0},  {0.20, 1.06, false, 0.0},
        {0.46, 1.16, true, 0.0},  {0.72, 1.34, true, 0.0},  {0.78, 1.42, false, 0.0},
        {0.73, 1.44, false, 0.0}, {0.50, 1.28, true, 0.0},  {0.0, 1.22, false, 0.0},
    };
    mesh_init(mesh, false);
    mesh_revolve(mesh, rim, COUNT(rim), 48);
    mesh_revolve(mesh, bowl, COUNT(bowl), 32);
}

void finial_solid(solid_mesh *mesh)
{
    static const profile_point profile[] = {
        {0.0, 1.20, false, 0.0}, {0.12, 1.20, false, 0.0}, {0.10, 1.32, true, 0.0},
        {0.04, 1.42, true, 0.0}, {0.05, 1.52, true, 0.0},  {0.13, 1.62, true, 0.0},
        {0.10, 1.74, true, 0.0}, {0.03, 1.84, true, 0.0},  {0.0, 1.90, false, 0.0},
    };
    mesh_init(mesh, false);
    mesh_revolve(mesh, profile, COUNT(profile), 24);
}

/* ---- cloth and floor ---- */

typedef struct {
    double length, width, folds, depth; /* m, m, count, m */
} banner_shape;

/* u along the side seen from the court, v upwards; hangs over the rail, 0.55 m before the axes. */
static assay_vec3 banner_at(const void *user, double u, double v)
{
    const banner_shape *b    = user;
    const double        fall = 1.0 - v;
    const turn          fold = turn_by(b->folds * u + 0.15 * fall);
    const double        hem  = 0.12 * (2.0 * u - 1.0) * (2.0 * u - 1.0);
    return vec3((0.5 - u) * b->width * (1.0 - 0.12 * fall),
                GALLERY + 1.06 - b->length * fall + hem * fall,
                -0.55 - b->depth * fall * (1.2 + fold.sin));
}

void banner_sheet(solid_mesh *mesh, int style)
{
    static const banner_shape shapes[3] = {
        {3.6, 1.5, 3.0, 0.06}, {3.2, 1.3, 2.5, 0.07}, {4.0, 1.4, 3.5, 0.05}};
    mesh_init(mesh, false);
    mesh_sheet(mesh, 16, 12, banner_at, &shapes[style]);
}

void floor_tiles(solid_mesh *mesh, int colour)
{
    const double tile   = 0.625;
    const int    half_x = 23, half_z = 13; /* reaches under the outer wall */
    mesh_init(mesh, true);
    for (int k = -half_z; k < half_z; k++) {
        for (int i = -half_x; i < half_x; i++) {
            if (((i + k) & 1) == colour) {
                const double x = i * tile, z = k * tile;
                mesh_quad(mesh, vec3(x, 0.0, z + tile), vec3(x + tile, 0.0, z + tile),
                          vec3(x + tile, 0.0, z), vec3(x, 0.0, z));
            }
        }
    }
}
