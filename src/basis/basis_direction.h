/* basis_direction.h - a direction as the recurrences want it. */
#ifndef ASSAY_BASIS_DIRECTION_H
#define ASSAY_BASIS_DIRECTION_H

#include "basis/basis_data.h"
#include "basis/lanes.h"

typedef struct {
    lanes x, y, z;
} lanes_direction;

/* hi + lo: hi is a multiple of 2^-26, lo some 2^-27 with the relative error of a double. */
typedef struct {
    lanes hi, lo;
} lanes_pair;

/* What d / |d| amounts to. */
typedef struct {
    lanes_pair t;
    lanes_pair re, im; /* b                       */
    lanes      weight; /* factor of all functions */
} basis_place;

basis_place basis_locate(assay_basis_kind kind, lanes_direction d);

#endif
