/* basis_evaluate.c - all functions at one direction, or at many.
 *
 * Invariant: one direction and many go the same way, two lanes at a time, so their bits are the
 * same.
 *
 * Powers of b are carried as a multiple of 2^-26 and a rest: the products of the multiples and
 * their difference are exact, so the error of a step is some 2^-78 and does not add up.  Near an
 * end of t the recurrence is for differences (Reinsch's form [deuflhard76]): the plain one loses
 * l^2 units there. */
#include "basis/basis_direction.h"

typedef struct {
    lanes_pair re, im;
} lanes_power;

/* power b */
static inline lanes_power multiply_base(lanes_power p, const basis_place *b, lanes re, lanes im)
{
    const lanes re_exact = p.re.hi * b->re.hi - p.im.hi * b->im.hi;
    const lanes im_exact = p.re.hi * b->im.hi + p.im.hi * b->re.hi;
    const lanes re_rest = (p.re.hi * b->re.lo + p.re.lo * re) - (p.im.hi * b->im.lo + p.im.lo * im);
    const lanes im_rest = (p.re.hi * b->im.lo + p.re.lo * im) + (p.im.hi * b->re.lo + p.im.lo * re);
    const lanes re_head = lanes_coarse(re_exact + re_rest);
    const lanes im_head = lanes_coarse(im_exact + im_rest);
    return (lanes_power){{re_head, (re_exact - re_head) + re_rest},
                         {im_head, (im_exact - im_head) + im_rest}};
}

static inline void store(double *const row[LANES], int index, lanes value)
{
    for (int lane = 0; lane < LANES; lane++) {
        row[lane][index] = value[lane];
    }
}

static inline void store_step(double *const row[LANES], const basis_step *step, lanes q, lanes re,
                              lanes im)
{
    const lanes value = step->scale * q;
    if (step->plus >= 0) {
        store(row, step->plus, value * re);
    }
    if (step->minus >= 0) {
        store(row, step->minus, value * im);
    }
}

/* All degrees of one m, near an end: argument is 1 - |t|. */
static inline void walk_end(const basis_step *step, int steps, lanes argument, lanes parity,
                            lanes re, lanes im, double *const row[LANES])
{
    lanes q = lanes_of(1.0), difference = lanes_of(0.0);
    lanes next_re = re * parity, next_im = im * parity;
    for (int k = 0; k < steps; k++, step++) {
        store_step(row, step, q, re, im);
        difference    = step->c * difference - (step->a * argument) * q;
        q             = q + difference;
        const lanes r = re;
        const lanes i = im;
        re            = next_re;
        im            = next_im;
        next_re       = r;
        next_im       = i;
    }
}

/* The same in the middle: argument is t, and alpha = beta. */
static inline void walk_middle(const basis_step *step, int steps, lanes argument, lanes re,
                               lanes im, double *const row[LANES])
{
    lanes q = lanes_of(1.0), before = lanes_of(0.0);
    for (int k = 0; k < steps; k++, step++) {
        store_step(row, step, q, re, im);
        const lanes next = (step->a * argument) * q - step->c * before;
        before           = q;
        q                = next;
    }
}

static void evaluate_lanes(const assay_basis *basis, int zone, const lanes_direction *direction,
                           double *const row[LANES])
{
    const basis_place place  = basis_locate(basis, zone, *direction);
    const bool        middle = basis->symmetric && zone == 1;
    const lanes       re     = place.re.hi + place.re.lo;
    const lanes       im     = place.im.hi + place.im.lo;
    const basis_step *step   = basis->zone[zone];
    lanes_power       power  = {.re = {.hi = lanes_of(1.0)}};
    for (int m = 0; m < basis->order; m++) {
        const lanes c = (power.re.hi + power.re.lo) * place.weight;
        const lanes s = (power.im.hi + power.im.lo) * place.weight;
        if (middle) {
            walk_middle(step, basis->steps[m], place.argument, c, s, row);
        } else {
            walk_end(step, basis->steps[m], place.argument, place.parity, c, s, row);
        }
        step += basis->steps[m];
        power = multiply_base(power, &place, re, im);
    }
}

static void evaluate_pair(const assay_basis *basis, int zone, const assay_vec3 *a, double *row_a,
                          const assay_vec3 *b, double *row_b)
{
    const lanes_direction direction  = {{a->x, b->x}, {a->y, b->y}, {a->z, b->z}};
    double *const         row[LANES] = {row_a, row_b};
    evaluate_lanes(basis, zone, &direction, row);
}

assay_status assay_basis_evaluate(const assay_basis *basis, assay_vec3 direction,
                                  double *values_out)
{
    const assay_status status = basis_check_direction(basis, direction);
    if (status == ASSAY_OK) {
        evaluate_pair(basis, basis_zone(basis, direction.z), &direction, values_out, &direction,
                      values_out);
    }
    return status;
}

assay_status assay_basis_evaluate_many(const assay_basis *basis, size_t direction_count,
                                       const assay_vec3 *directions, double *values_out)
{
    for (size_t i = 0; i < direction_count; i++) {
        const assay_status status = basis_check_direction(basis, directions[i]);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    size_t waiting[BASIS_ZONES] = {SIZE_MAX, SIZE_MAX}; /* a direction without its partner */
    for (size_t i = 0; i < direction_count; i++) {
        const int    zone = basis_zone(basis, directions[i].z);
        const size_t j    = waiting[zone];
        if (j == SIZE_MAX) {
            waiting[zone] = i;
            continue;
        }
        evaluate_pair(basis, zone, &directions[j], values_out + j * basis->count, &directions[i],
                      values_out + i * basis->count);
        waiting[zone] = SIZE_MAX;
    }
    for (int zone = 0; zone < BASIS_ZONES; zone++) {
        const size_t j = waiting[zone];
        if (j != SIZE_MAX) {
            evaluate_pair(basis, zone, &directions[j], values_out + j * basis->count,
                          &directions[j], values_out + j * basis->count);
        }
    }
    return ASSAY_OK;
}
