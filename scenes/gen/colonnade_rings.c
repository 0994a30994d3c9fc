/* colonnade_rings.c - parts of the colonnade that run round the court: one profile each.
 *
 * Profiles are counter-clockwise in (u outwards from the column axes, v up), m.  Each ends inside
 * its neighbours and has no face in the plane of another part's face. */
#include "colonnade_parts.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define EDGE(u, v)                                                                                 \
    {                                                                                              \
        u, v, false, 0.0                                                                           \
    }
#define BEND(u, v)                                                                                 \
    {                                                                                              \
        u, v, true, 0.0                                                                            \
    }

static void ring(solid_mesh *mesh, const profile_point *profile, size_t count)
{
    mesh_init(mesh, false);
    mesh_rectangular_ring(mesh, profile, count, HALF_X, HALF_Z);
}

void outer_wall_ring(solid_mesh *mesh)
{
    static const profile_point profile[] = {EDGE(AISLE, -0.1), EDGE(AISLE + 0.5, -0.1),
                                            EDGE(AISLE + 0.5, 11.4), EDGE(AISLE, 11.4)};
    ring(mesh, profile, COUNT(profile));
}

/* The lower storey's ceiling: a segmental barrel that carries the gallery's floor.
 * Chord 2 a = 3.35 m from u = 0.30 - 0.05 + 0.1 on, rise h = 0.8 m. */
#define VAULT_STEPS 16

void vault_ring(solid_mesh *mesh)
{
    const double  low = 0.2, high = 3.85, foot = 4.3, h = 0.85, a = 0.5 * (high - low);
    const double  radius = (a * a + h * h) / (2.0 * h), middle = 0.5 * (low + high);
    profile_point profile[VAULT_STEPS + 3];
    size_t        count = 0;
    for (int i = 0; i <= VAULT_STEPS; i++) {
        const double x   = a * (2.0 * i / VAULT_STEPS - 1.0);
        const double y   = foot + h - radius + sqrt(radius * radius - x * x);
        const bool   end = i == 0 || i == VAULT_STEPS;
        profile[count++] = (profile_point){middle + x, end ? foot : y, !end, 0.0};
    }
    profile[count++] = (profile_point)EDGE(high, GALLERY);
    profile[count++] = (profile_point)EDGE(low, GALLERY);
    ring(mesh, profile, count);
}

/* The edge of the gallery's floor on the court's side, with mouldings. */
void cornice_ring(solid_mesh *mesh)
{
    static const profile_point profile[] = {
        EDGE(0.22, 5.20),  EDGE(0.22, GALLERY - 0.01), EDGE(-0.48, GALLERY - 0.01),
        EDGE(-0.48, 5.51), EDGE(-0.44, 5.49),          BEND(-0.41, 5.42),
        BEND(-0.35, 5.37), EDGE(-0.34, 5.33),          EDGE(-0.34, 5.20)};
    ring(mesh, profile, COUNT(profile));
}

void ceiling_ring(solid_mesh *mesh)
{
    static const profile_point profile[] = {EDGE(0.22, 10.2), EDGE(AISLE + 0.1, 10.2),
                                            EDGE(AISLE + 0.1, 10.6), EDGE(0.22, 10.6)};
    ring(mesh, profile, COUNT(profile));
}

/* A lean-to roof with a moulded cornice over the court. */
void roof_ring(solid_mesh *mesh)
{
    static const profile_point profile[] = {
        EDGE(-0.34, 10.15),      EDGE(0.25, 10.15),         EDGE(0.25, 10.5),
        EDGE(AISLE + 0.2, 11.2), EDGE(AISLE + 0.85, 11.45), EDGE(AISLE + 0.85, 11.62),
        EDGE(-0.75, 10.62),      EDGE(-0.75, 10.50),        EDGE(-0.60, 10.46),
        BEND(-0.52, 10.36),      BEND(-0.40, 10.30),        EDGE(-0.36, 10.22)};
    ring(mesh, profile, COUNT(profile));
}

/* A step between the columns, on which nothing stands but their plinths pass through. */
void kerb_ring(solid_mesh *mesh)
{
    static const profile_point profile[] = {EDGE(-0.52, -0.06), EDGE(0.52, -0.06),
                                            EDGE(0.52, 0.04),   EDGE(0.49, 0.07),
                                            EDGE(-0.49, 0.07),  EDGE(-0.52, 0.04)};
    ring(mesh, profile, COUNT(profile));
}

void rail_ring(solid_mesh *mesh, double low, double high, double half_width)
{
    const double        w = half_width, b = 0.03;
    const profile_point profile[] = {EDGE(-w + b, low),  EDGE(w - b, low),  EDGE(w, low + b),
                                     EDGE(w, high - b),  EDGE(w - b, high), EDGE(-w + b, high),
                                     EDGE(-w, high - b), EDGE(-w, low + b)};
    ring(mesh, profile, COUNT(profile));
}
