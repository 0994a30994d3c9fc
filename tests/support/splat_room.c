/* splat_room.c - walls of a cube from within, by a formula. */
#include "support/splat_room.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "core/random.h"
#include "trace/camera_ray.h"

assay_camera splat_room_camera(bool orthographic)
{
    const assay_frame3 f = frame3_from_z(vec3_normalize(vec3(0.3, 0.1, 0.9)));
    return (assay_camera){.position      = {0.55, 0.4, 0.8},
                          .right         = f.x,
                          .up            = f.y,
                          .forward       = vec3_negate(f.z),
                          .orthographic  = orthographic,
                          .xmag          = 0.15,
                          .ymag          = 0.15,
                          .tan_half_yfov = 0.9};
}

/* On the wall that a ray from within leaves through. */
static void leave(assay_vec3 origin, assay_vec3 direction, assay_vec3 *position_out,
                  assay_vec3 *normal_out)
{
    const double o[3] = {origin.x, origin.y, origin.z};
    const double d[3] = {direction.x, direction.y, direction.z};
    double       t    = INFINITY;
    int          axis = 0;
    for (int i = 0; i < 3; i++) {
        const double here = d[i] > 0.0 ? (1.0 - o[i]) / d[i] : d[i] < 0.0 ? -o[i] / d[i] : INFINITY;
        axis              = here < t ? i : axis;
        t                 = here < t ? here : t;
    }
    const double in = d[axis] > 0.0 ? -1.0 : 1.0;
    *position_out   = vec3_mad(origin, t, direction);
    *normal_out     = vec3(axis == 0 ? in : 0.0, axis == 1 ? in : 0.0, axis == 2 ? in : 0.0);
}

bool splat_room_point(const assay_camera *camera, int width, int height, size_t pixel,
                      assay_vec3 *position_out, assay_vec3 *normal_out)
{
    assay_random random = assay_random_start(0, ASSAY_STAGE_TEST, pixel, 0);
    assay_vec3   origin, direction;
    const double u = assay_random_next(&random), v = assay_random_next(&random);
    if (assay_random_next(&random) < 0.01) {
        return false;
    }
    const int x = (int)(pixel % (size_t)width), y = (int)(pixel / (size_t)width);
    assay_camera_ray(camera, x + 0.5, y + 0.5, width, height, &origin, &direction);
    leave(origin, direction, position_out, normal_out);
    *normal_out = vec3_normalize(vec3_add(*normal_out, vec3(0.1 * u, 0.1 * v, 0.0)));
    return true;
}

assay_record splat_room_record(uint64_t seed, uint32_t count, uint32_t k)
{
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, k, 1);
    assay_record record = {.mean = 1.0, .nearest = 1.0};
    double       u[16];
    for (int i = 0; i < 16; i++) {
        u[i] = assay_random_next(&random);
    }
    const double radius = sqrt(10.0 * 6.0 / (ASSAY_PI * count)) / 0.25;
    leave(vec3(0.5, 0.5, 0.5), vec3(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5), &record.position,
          &record.normal);
    record.normal     = vec3_normalize(vec3_add(record.normal, vec3(0.1 * u[3], 0.0, 0.1 * u[4])));
    record.radius     = radius * (0.7 + 0.6 * u[5]) * (k % 50 == 0 ? 6.0 : 1.0);
    record.irradiance = rgb(1.0 + u[6], 1.0 + u[7], u[8]);
    for (int c = 0; c < 3; c++) {
        record.rotation[c]    = vec3(u[9] - 0.5, u[10] - 0.5, u[11 + c] - 0.5);
        record.translation[c] = vec3(u[11] - 0.5, u[12 + c] - 0.5, u[9] - 0.5);
    }
    return record;
}

void splat_room_fill(assay_splat_buffer *buffer, const assay_camera *camera, int width, int height)
{
    assay_splat_buffer_look(buffer, camera);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
        assay_vec3 position, normal;
        if (splat_room_point(camera, width, height, i, &position, &normal)) {
            assay_splat_buffer_set(buffer, i, position, normal);
        }
    }
    assert_int_equal(assay_splat_buffer_close(buffer), ASSAY_OK);
}
