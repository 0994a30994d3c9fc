/* records.c - the weight of [ward88] and the extrapolation of [ward-heckbert92], in single
 * precision; docs/methods/irradiance-cache.md.
 *
 * 1 - n . n_k may be rounded to below 0, and a record at its own place would divide by 0. */
#include "records.h"

#include <stdint.h>
#include <stdlib.h>

#include "planted.h"

static const float WEIGHT_MAX = 1e12f, IN_FRONT = 1e-3f;

enum { POINTS = 200 };

/* ---- taking ---- */

static void take_gradient(const table *t, size_t row, vec out[3])
{
    for (size_t c = 0; c < 3; c++) {
        out[c] = vec_of(table_row(t, row) + 3 * c);
    }
}

records records_take(const bundle *from, bundle *to)
{
    table      position    = bundle_pass_on(from, to, "records/position", "");
    table      normal      = bundle_pass_on(from, to, "records/normal", "");
    table      radius      = bundle_pass_on(from, to, "records/radius", "");
    table      irradiance  = bundle_pass_on(from, to, "records/irradiance", "");
    table      rotation    = bundle_pass_on(from, to, "records/rotation_gradient", "");
    table      translation = bundle_pass_on(from, to, "records/translation_gradient", "");
    const bool both        = bundle_is(from, "gradients", "both");
    records    r           = {.a              = bundle_number(from, "a"),
                              .in_front       = bundle_is(from, "in_front", "on"),
                              .by_rotation    = both || bundle_is(from, "gradients", "rotation"),
                              .by_translation = both || bundle_is(from, "gradients", "translation"),
                              .clamped        = bundle_is(from, "clamp_negative", "on"),
                              .count          = position.rows,
                              .list           = allocate(position.rows, sizeof *r.list)};
    for (size_t i = 0; i < r.count; i++) {
        record *k   = &r.list[i];
        k->position = vec_of(table_row(&position, i));
        k->normal   = vec_of(table_row(&normal, i));
        k->radius   = radius.values[i];
        for (size_t c = 0; c < 3; c++) {
            k->irradiance[c] = table_row(&irradiance, i)[c];
        }
        take_gradient(&rotation, i, k->rotation);
        take_gradient(&translation, i, k->translation);
    }
    table *all[] = {&position, &normal, &radius, &irradiance, &rotation, &translation};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        table_release(all[i]);
    }
    return r;
}

void records_release(records *r) { free(r->list); }

/* ---- weight ---- */

float record_weight(const records *rules, const record *k, vec position, vec normal)
{
    const vec   offset = sub(position, k->position);
    const float wider  = IS_PLANTED(RADIUS_DOUBLED) ? 2.0f
                         : IS_PLANTED(RADIUS_ROUGH) ? 1.001f
                                                    : 1.0f;
    const float radius = wider * k->radius;
    const float height = 0.5f * dot(offset, add(normal, k->normal));
    const float cosine = 1.0f - dot(normal, k->normal);
    const float tilt   = cosine > 0.0f ? cosine : 0.0f;
    const float turned = IS_PLANTED(SQRT_LEFT_OUT) ? tilt : sqrtf(tilt);
    const float change = length(offset) / radius + turned;
    const float weight = change < 1.0f / WEIGHT_MAX ? WEIGHT_MAX : 1.0f / change;
    const float least  = IS_PLANTED(THRESHOLD_INVERTED) ? rules->a : 1.0f / rules->a;
    if (rules->in_front && !IS_PLANTED(IN_FRONT_DROPPED) && height < -IN_FRONT * k->radius) {
        return 0.0f;
    }
    return weight >= least ? weight : 0.0f;
}

/* ---- what is said ---- */

void record_say(const records *rules, const record *k, vec position, vec normal, float out[3])
{
    static const size_t green_first[3] = {1, 0, 2};
    const vec           moved          = sub(position, k->position);
    const vec           turned         = cross(k->normal, normal);
    for (size_t c = 0; c < 3; c++) {
        const size_t g     = IS_PLANTED(CHANNELS_SWAPPED) ? green_first[c] : c;
        float        light = k->irradiance[c], change = 0.0f;
        if (rules->by_rotation) {
            const float by = dot(turned, k->rotation[g]);
            change += IS_PLANTED(ROTATION_SIGN) ? -by : by;
        }
        if (rules->by_translation) {
            const float by = dot(moved, k->translation[g]);
            change += IS_PLANTED(TRANSLATION_SIGN) ? -by : by;
        }
        light  = IS_PLANTED(RELATIVE_GRADIENTS) ? light * (1.0f + change) : light + change;
        out[c] = rules->clamped && !IS_PLANTED(CLAMP_DROPPED) && light < 0.0f ? 0.0f : light;
    }
}

/* ---- asking ---- */

/* In [-1, 1). */
static float any(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * 0x1p-23f - 1.0f;
}

static vec any_vector(uint32_t *state)
{
    const float x = any(state), y = any(state), z = any(state);
    return (vec){x, y, z};
}

/* Around the records: up to their radii away, tilted by up to half a radian or so. */
static void place_points(const records *r, table *positions, table *normals)
{
    uint32_t state = 1;
    for (size_t i = 0; i < POINTS; i++) {
        const record *k             = &r->list[i * r->count / POINTS];
        const vec     position      = add(k->position, scale(any_vector(&state), 0.4f * k->radius));
        const vec     normal        = unit(add(k->normal, scale(any_vector(&state), 0.15f)));
        const float   numbers[2][3] = {{position.x, position.y, position.z},
                                       {normal.x, normal.y, normal.z}};
        for (size_t c = 0; c < 3; c++) {
            table_row(positions, i)[c] = numbers[0][c];
            table_row(normals, i)[c]   = numbers[1][c];
        }
    }
}

static void ask_at(const records *r, vec position, vec normal, float *weights, float *sum_out,
                   float irradiance_out[3])
{
    float sum = 0.0f, light[3] = {0.0f, 0.0f, 0.0f};
    for (size_t i = 0; i < r->count; i++) {
        float said[3];
        weights[i] = record_weight(r, &r->list[i], position, normal);
        if (weights[i] > 0.0f) {
            const float weight = IS_PLANTED(ALL_AT_ONE_WEIGHT) ? 1.0f : weights[i];
            record_say(r, &r->list[i], position, normal, said);
            sum += weight;
            for (int c = 0; c < 3; c++) {
                light[c] += weight * said[c];
            }
        }
    }
    *sum_out = sum;
    for (int c = 0; c < 3; c++) {
        irradiance_out[c] = sum > 0.0f ? light[c] / sum : 0.0f;
    }
}

void records_ask(const records *r, bundle *to)
{
    table positions = table_make(POINTS, 3), normals = table_make(POINTS, 3);
    table weights = table_make(POINTS, r->count), sums = table_make(POINTS, 1);
    table irradiance = table_make(POINTS, 3);
    place_points(r, &positions, &normals);
    for (size_t i = 0; i < POINTS; i++) {
        ask_at(r, vec_of(table_row(&positions, i)), vec_of(table_row(&normals, i)),
               table_row(&weights, i), &sums.values[i], table_row(&irradiance, i));
    }
    bundle_write(to, "query/position", "m", &positions);
    bundle_write(to, "query/normal", "", &normals);
    bundle_write(to, "query/weight", "", &weights);
    bundle_write(to, "query/weight_sum", "", &sums);
    bundle_write(to, "query/irradiance", "W/m2", &irradiance);
}
