/* ray_bound.c - t = n . (p0 - o) / n . d in tracked arithmetic.
 *
 * World positions of vertices are what a candidate makes of the file by its own transformations:
 * within (given + 4 u) of the largest coordinate of the scene, as four rounded products and their
 * sum leave it.  A triangle that a ray only grazes has a large bound, as it should. */
#include "oracle/stage/ray_bound.h"

double bound_scene_size(const assay_scene *scene)
{
    const assay_vec3 a = scene->bounds_min, b = scene->bounds_max;
    return fmax(fmax(fmax(fabs(a.x), fabs(b.x)), fmax(fabs(a.y), fabs(b.y))),
                fmax(fabs(a.z), fabs(b.z)));
}

static double vertex_error(const rounding *r, const assay_scene *scene)
{
    return (r->given + 4.0 * r->u) * bound_scene_size(scene);
}

static tracked3 vertex_of(const rounding *r, const assay_scene *scene, uint32_t triangle,
                          int corner)
{
    const float *p =
        scene->positions + 3 * (size_t)scene->indices[3 * (size_t)triangle + (size_t)corner];
    const double e = vertex_error(r, scene);
    return (tracked3){{p[0], e}, {p[1], e}, {p[2], e}};
}

static tracked3 unit_of(const rounding *r, const tracked3 *a)
{
    const tracked length = tracked_sqrt(r, tracked3_dot(r, a, a));
    return (tracked3){tracked_div(r, a->x, length), tracked_div(r, a->y, length),
                      tracked_div(r, a->z, length)};
}

bound_hit bound_hit_of(const rounding *r, const assay_scene *scene, uint32_t triangle,
                       const bound_ray *ray)
{
    const tracked3 a = vertex_of(r, scene, triangle, 0), b = vertex_of(r, scene, triangle, 1);
    const tracked3 c     = vertex_of(r, scene, triangle, 2);
    const tracked3 side1 = tracked3_sub(r, &b, &a), side2 = tracked3_sub(r, &c, &a);
    const tracked3 n   = tracked3_cross(r, &side1, &side2);
    const tracked3 way = tracked3_sub(r, &a, &ray->origin);
    const tracked  t =
        tracked_div(r, tracked3_dot(r, &n, &way), tracked3_dot(r, &n, &ray->direction));
    const tracked3 *o = &ray->origin, *d = &ray->direction;
    return (bound_hit){
        .distance = t,
        .point    = {tracked_add(r, o->x, tracked_mul(r, t, d->x)),
                     tracked_add(r, o->y, tracked_mul(r, t, d->y)),
                     tracked_add(r, o->z, tracked_mul(r, t, d->z))},
        .normal   = unit_of(r, &n),
    };
}

static double error_size(const tracked3 *a)
{
    return sqrt(a->x.e * a->x.e + a->y.e * a->y.e + a->z.e * a->z.e);
}

static assay_vec3 middle(const tracked3 *a) { return vec3(a->x.v, a->y.v, a->z.v); }

bool bound_is_torn(const rounding *r, const assay_scene *scene, const bound_ray *ray,
                   uint32_t triangle, double distance, bound_ask ask, const void *user)
{
    enum { TRIES = 8 };
    const double       near  = fmax(fmin(distance, bound_scene_size(scene)), 1e-300);
    const double       moved = error_size(&ray->origin) + 2.0 * vertex_error(r, scene);
    const double       angle = 2.0 * (error_size(&ray->direction) + moved / near);
    const assay_vec3   d     = vec3_normalize(middle(&ray->direction));
    const assay_frame3 frame = frame3_from_z(d);
    for (int i = 0; i < TRIES; i++) {
        const assay_sincos turn = assay_sincos_turns((double)i / TRIES);
        const assay_vec3   off  = vec3_mad(vec3_scale(frame.x, turn.cos), turn.sin, frame.y);
        if (ask(user, middle(&ray->origin), vec3_normalize(vec3_mad(d, angle, off))) != triangle) {
            return true;
        }
    }
    return false;
}
