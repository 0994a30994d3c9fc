/* basis_direction.h - a direction as the recurrences want it. */
#ifndef ASSAY_BASIS_DIRECTION_H
#define ASSAY_BASIS_DIRECTION_H

#include "basis/basis_data.h"
#include "basis/lanes.h"

typedef struct {
    lanes x, y, z;
} lanes_direction;

/* x = hi + lo; hi is a multiple of 2^-26. */
typedef struct {
    lanes hi, lo;
} lanes_pair;

/* Of d / |d|, for a whole zone of directions. */
typedef struct {
    lanes      argument; /* zone with ends: 1 - |t|; middle: t                     */
    lanes      parity;   /* -1 where |t| stands for -t, else 1                     */
    lanes      weight;   /* factor of all functions                                */
    lanes_pair re, im;   /* b                                                      */
} basis_place;

/* Zone of a direction that basis_check_direction lets pass. */
int basis_zone(const assay_basis *basis, double z);

basis_place basis_locate(const assay_basis *basis, int zone, lanes_direction d);

#endif
