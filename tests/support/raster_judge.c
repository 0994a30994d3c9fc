/* raster_judge.c - see raster_judge.h. */
#include "support/raster_judge.h"

#include "core/numerics.h"

/* How near to an edge, in weights of corners, a pixel must be for a tie; and how near in depth two
 * surfaces that coincide, in parts of the scene. */
static const double EDGE = 1e-9, DEPTH = 1e-10;

static bool is_there(const assay_scene *scene, const assay_hit *hit)
{
    return assay_triangle_coverage(scene, hit->triangle, hit->u, hit->v) >= 0.5;
}

static bool cast(const assay_world *world, const assay_raster_view *view, int i, int j,
                 assay_hit *hit)
{
    const assay_raster_point at    = assay_raster_centre(view, i, j);
    const assay_vec3         slope = vec3(at.x, at.y, 1.0);
    const assay_vec3         origin =
        view->parallel ? vec3_add(view->eye, frame3_to_world(&view->frame, vec3(at.x, at.y, 0.0)))
                               : view->eye;
    assay_ray ray = assay_ray_start(
        origin,
        view->parallel ? view->frame.z : frame3_to_world(&view->frame, vec3_normalize(slope)),
        INFINITY);
    ray.t_after = view->parallel ? view->near : view->near * vec3_length(slope);
    while (assay_bvh_closest(world->bvh, &ray, hit)) {
        if (is_there(world->scene, hit)) {
            return true;
        }
        ray.t_after        = hit->t;
        ray.triangle_after = hit->triangle;
    }
    return false;
}

static bool is_at_edge(const assay_hit *h)
{
    return fmin(fmin(h->u, h->v), 1.0 - h->u - h->v) < EDGE;
}

raster_verdict raster_judge(const assay_world *world, const assay_raster_view *view,
                            const assay_raster_sample *samples)
{
    const assay_scene *scene   = world->scene;
    const double       size    = vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    raster_verdict     verdict = {0, 0, 0, 0};
    for (int j = 0; j < view->rows; j++) {
        for (int i = 0; i < view->columns; i++) {
            const assay_raster_sample *s = &samples[j * view->columns + i];
            assay_hit                  ray, raster = {.triangle = ASSAY_NO_TRIANGLE};
            const bool                 hit  = cast(world, view, i, j, &ray);
            const bool                 seen = s->triangle != ASSAY_NO_TRIANGLE;
            verdict.hits += hit;
            if (seen) {
                raster = assay_raster_hit(scene, view, i, j, s);
            }
            if (!hit && !seen) {
                verdict.same += s->depth == INFINITY;
                verdict.wrong += s->depth != INFINITY;
            } else if (hit && seen && ray.triangle == raster.triangle) {
                const bool equal = fabs(ray.t - raster.t) <= DEPTH * size &&
                                   fabs(ray.u - raster.u) < 1e-7 && fabs(ray.v - raster.v) < 1e-7;
                verdict.same += equal;
                verdict.wrong += !equal;
            } else {
                const bool coincide = hit && seen && fabs(ray.t - raster.t) <= DEPTH * size;
                const bool nearer   = hit && (!seen || ray.t < raster.t);
                const bool tie      = coincide || is_at_edge(nearer ? &ray : &raster);
                verdict.tie += tie;
                verdict.wrong += !tie;
            }
        }
    }
    return verdict;
}

assay_raster_view raster_judge_view(const assay_world *world, uint64_t seed, uint64_t number,
                                    double half, int side)
{
    assay_random  random = assay_random_start(seed, ASSAY_STAGE_TEST, number, 0);
    const double  pick   = assay_random_next(&random);
    const double  r      = sqrt(assay_random_next(&random));
    const double  v      = r * assay_random_next(&random);
    const double  turn   = assay_random_next(&random);
    const bool    back   = assay_random_next(&random) < 0.5;
    assay_surface surface;
    assay_surface_at(world->scene, (uint32_t)(pick * world->scene->triangle_count), r - v, v,
                     &surface);
    const assay_vec3   n       = back ? vec3_negate(surface.ng) : surface.ng;
    const assay_frame3 plain   = frame3_from_z(n);
    const assay_sincos azimuth = assay_sincos_turns(turn);
    const assay_vec3   x       = vec3_mad(vec3_scale(plain.x, azimuth.cos), azimuth.sin, plain.y);
    return (assay_raster_view){.eye     = vec3_mad(surface.position, world->offset, n),
                               .frame   = frame3_from_zx(n, x),
                               .half    = half,
                               .columns = side,
                               .rows    = side};
}
