/* path_trace.h - light that a point sends somewhere, by following random paths.
 *
 * Unidirectional path tracing [kajiya86] with next-event estimation, combined with BSDF sampling by
 * the power heuristic [veach95].  Unbiased for every setting; only `bounces` changes what is
 * measured.  A bounce is one scattering between a light and the eye: emission seen directly is
 * bounce 0, direct light is 1, light reflected twice is 2 (one *indirect* bounce, as the caching
 * papers count). */
#ifndef ASSAY_TRACE_PATH_TRACE_H
#define ASSAY_TRACE_PATH_TRACE_H

#include <limits.h>

#include "core/random.h"
#include "trace/vertex.h"

/* How the light that arrives at a vertex is found.  Perfectly specular lobes always use BSDF
 * sampling, punctual lights always light sampling. */
typedef enum {
    ASSAY_ESTIMATOR_NEE,  /* light sampling alone          */
    ASSAY_ESTIMATOR_BSDF, /* BSDF sampling alone           */
    ASSAY_ESTIMATOR_MIS   /* both, by the power heuristic  */
} assay_estimator;

#define ASSAY_BOUNCES_INF INT_MAX

typedef struct {
    int bounces;        /* largest number of scatterings; ASSAY_BOUNCES_INF: no limit   */
    int roulette_depth; /* >= 1: from the bounce after it on, paths may end by roulette */
    assay_estimator estimator;
} assay_path_settings;

/* Radiance, W/(m2 sr), split by the number of bounces. */
typedef struct {
    assay_rgb direct;   /* 0 and 1 bounce */
    assay_rgb indirect; /* 2 and more     */
} assay_path_light;

/* One sample of the light that comes along the ray, from camera (unit direction). */
assay_path_light assay_path_radiance(const assay_world *world, const assay_path_settings *settings,
                                     assay_vec3 origin, assay_vec3 direction, assay_random *random,
                                     assay_ray_counts *counts);

/* One sample of what the vertex scatters towards its wo, its own emission left out.  For a receiver
 * (vertex.h) that is its irradiance: direct, and indirect. */
assay_path_light assay_path_scatter(const assay_world *world, const assay_path_settings *settings,
                                    const assay_vertex *vertex, assay_random *random,
                                    assay_ray_counts *counts);

/* One sample of the indirect light (2 bounces and more) that the vertex (dressed) scatters towards
 * its wo beyond what a Lambertian of albedo `lambert` would: the integral of (f - lambert / pi)
 * times cosine times indirect radiance.  So a method that has the irradiance E adds lambert / pi E
 * and this, whatever it chose for lambert; may be negative.  Black: all indirect light. */
assay_rgb assay_path_indirect(const assay_world *world, const assay_path_settings *settings,
                              const assay_vertex *vertex, assay_rgb lambert, assay_random *random,
                              assay_ray_counts *counts);

#endif
