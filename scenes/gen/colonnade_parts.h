/* colonnade_parts.h - the parts of the colonnade, each modelled once.
 *
 * Every function initialises the mesh and fills it; the caller releases it.  Local frame of a part
 * of a side: x along the side, y up, z outwards from the court, the column axes in z = 0. */
#ifndef ASSAY_SCENES_COLONNADE_PARTS_H
#define ASSAY_SCENES_COLONNADE_PARTS_H

#include "solid_mesh.h"

/* m */
#define BAY 2.5
#define BAYS_X 8
#define BAYS_Z 3
#define HALF_X 10.0 /* 8 bays */
#define HALF_Z 3.75 /* 3 bays */
#define AISLE 3.75  /* from the column axes to the outer wall */
#define GALLERY 5.6 /* floor of the upper storey */
#define ARCH_RADIUS 0.9
#define WALL 0.6 /* thickness of the arcades */

typedef struct {
    const char *column_name, *arcade_name, *archivolt_name, *pilaster_name;
    double base, springing, top; /* heights of the floor, of the arches' feet, of the wall, m */
    double radius;               /* of a column's shaft at its foot, m */
} storey_shape;

/* 0: lower, 1: upper. */
const storey_shape *colonnade_storey(int index);

void column_solid(solid_mesh *mesh, const storey_shape *storey); /* y = 0: the storey's floor */
void arcade_solid(solid_mesh *mesh, const storey_shape *storey, int bays);
void archivolt_solid(solid_mesh *mesh); /* y = 0: springing */
void pilaster_solid(solid_mesh *mesh, const storey_shape *storey);
void pier_solid(solid_mesh *mesh);
void beam_solid(solid_mesh *mesh);
void door_solid(solid_mesh *mesh);
void baluster_row(solid_mesh *mesh);
void basin_solid(solid_mesh *mesh);
void finial_solid(solid_mesh *mesh);

void outer_wall_ring(solid_mesh *mesh);
void vault_ring(solid_mesh *mesh);
void cornice_ring(solid_mesh *mesh);
void ceiling_ring(solid_mesh *mesh);
void roof_ring(solid_mesh *mesh);
void kerb_ring(solid_mesh *mesh);
void rail_ring(solid_mesh *mesh, double low, double high, double half_width);

/* style 0 to 2: length and folds differ. */
void banner_sheet(solid_mesh *mesh, int style);
/* colour 0 or 1 of a chequered floor. */
void floor_tiles(solid_mesh *mesh, int colour);

#endif
