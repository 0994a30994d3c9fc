/* neighbours.h - whether pixels share their noise with their neighbours, as under a filter. */
#ifndef ASSAY_ORACLE_NEIGHBOURS_H
#define ASSAY_ORACLE_NEIGHBOURS_H

#include <stdbool.h>

#include "oracle/image/noisy_pair.h"

/* Correlations of the differences' signs, over pairs of pixels in a row or a column. */
typedef struct {
    double near;  /* side by side       */
    double far;   /* four pixels apart  */
    double pairs; /* of the latter     */
} assay_neighbours;

assay_neighbours assay_neighbours_of(const assay_noisy_pair *pair);

/* Whether neighbours are alike by more than chance and more than a bias makes them. */
bool assay_neighbours_share_noise(const assay_neighbours *neighbours);

#endif
