/* radiance_candidate.h - a candidate that asks records of radiance, in rounded operations and
 * orders of chance, and the mistakes that it may make.
 *
 * Written from [gautron06] 2.2.6, 3.4; of the library it has the matrices M_R alone, rounded as a
 * table would be. */
#ifndef ASSAY_TESTS_RADIANCE_CANDIDATE_H
#define ASSAY_TESTS_RADIANCE_CANDIDATE_H

#include "assay/basis.h"
#include "math/frame.h"
#include "support/stage_case.h"

#include <string.h>

enum { RECORDS = 90, SIDE = 11, POINTS = SIDE * SIDE, ORDER = 4, COUNT = ORDER * ORDER };
enum { ROW = 3 * COUNT, STEPS = 8, LOBES = 4, GRID = 40, TEXELS = GRID * GRID };

typedef struct {
    double position[3 * RECORDS], normal[3 * RECORDS], radius[RECORDS];
    double coefficients[ROW * RECORDS], gradient[3 * ROW * RECORDS];
    double at[3 * POINTS], frame[9 * POINTS]; /* queries, and pixels with the frame of the BRDF */
    double brdf[15 * POINTS], lobe[4 * POINTS], weight[POINTS];
    double grids[LOBES * TEXELS * COUNT];
    size_t count; /* queries */
} radiance_data;

typedef enum {
    RIGHT,
    FLIPPED,     /* the gradient's sign                         */
    NOT_LOCAL,   /* gradients dotted with the offset in the world */
    NOT_TURNED,  /* coefficients stay in the record's frame     */
    INVERSE,     /* turned the other way                        */
    OTHER_FRAME, /* in frame3_from_z of the normal              */
    SWAPPED,     /* R and B                                     */
    MIRRORED,    /* m for -m                                    */
    LOST,        /* the last record                             */
    LARGER_R,    /* radii by 1 percent                          */
    TRANSPOSED,  /* a grid's rows for columns                   */
    NO_BASE      /* base colour 1                               */
} defect;

/* How it turns. */
typedef enum { BY_SINES, BY_ANGLES, BY_ONE_MATRIX, WAYS } turning;

typedef struct {
    few_digits           f;
    const radiance_data *d;
    defect               defect;
    turning              way;
    bool                 exact;     /* one matrix a tilt and no table                         */
    double               threshold; /* of the tilt's sine, below which there is none          */
    double               nodes[STEPS + 1];
    double (*table)[COUNT * COUNT];
    assay_basis   *hsh;
    assay_context *context;
} radiance_candidate;

/* Records, points at and near them, pixels that show lobes; free it. */
radiance_data *radiance_data_make(void);
/* All but the grids rounded: normals are not quite of unit length, and frames not quite
 * orthonormal. Free it. */
radiance_data *radiance_data_stored(const radiance_data *d, int digits);
/* Texts and tables of the records. */
void radiance_data_add(const stage_case *c, const radiance_data *d);
/* d: may be NULL for turns alone. */
void radiance_candidate_open(radiance_candidate *c, assay_context *context, const radiance_data *d);
void radiance_candidate_close(radiance_candidate *c);
/* A threshold of a candidate's own, from the least to the largest. */
void radiance_candidate_choose(radiance_candidate *c, int precision, defect planted, turning way,
                               bool high);
/* [duff17], listing 3. */
void few_frame(const few_digits *f, const double *normal, double frame[9]);
/* 3 rows about z. */
void few_spin(const few_digits *f, double cosine, double sine, double *row);
/* M_R(tilt) by linear interpolation between matrices that were rounded once, or itself. */
void few_matrix(radiance_candidate *c, double tilt, double matrix[COUNT * COUNT]);
/* 3 rows. */
void few_multiply(radiance_candidate *c, const double matrix[COUNT * COUNT], double *row);
/* Rz(alpha) M Rz(gamma) as one matrix, rounded; cosines and sines of alpha and gamma. */
void few_whole_turn(radiance_candidate *c, const double ca, const double sa, const double cg,
                    const double sg, double tilt, double *row);
/* From one frame to another. */
void few_turn(radiance_candidate *c, const double from[9], const double to[9], double *row);
/* Of record k; 0 where it does not count. */
double few_weight(radiance_candidate *c, const double *p, const double *n, size_t k);
/* Weights of the records that count, and what they say in frame3_from_z of the point's normal. */
size_t few_terms(radiance_candidate *c, const double *p, const double *n, double weights[RECORDS],
                 double (*said)[ROW]);
/* 0 of none. */
double few_mean(radiance_candidate *c, size_t count, const double *weights, const double *values);
/* A normal beside n: number i of a list of tilts, from none to 0.1. */
assay_vec3 tilted(assay_vec3 n, size_t i, assay_random *random);

static inline void put_values(double *to, const void *from, size_t count)
{
    memcpy(to, from, count * sizeof *to);
}

#endif
