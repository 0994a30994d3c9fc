/* cache_params.h - the parameters that all caching methods have. */
#ifndef ASSAY_METHODS_CACHE_PARAMS_H
#define ASSAY_METHODS_CACHE_PARAMS_H

#include "methods/cached_image.h"
#include "record/irradiance_cache.h"

/* Rows of a parameter table, read by assay_cache_params_read. */
/* clang-format off */
#define ASSAY_CACHE_PARAMS                                                                        \
    {"spp", ASSAY_PARAM_INT, "samples", "64", 1, 1e9, NULL,                                       \
     "Camera samples a pixel, and samples of its direct irradiance.",                             \
     ""},                                                                                         \
    {"bounces", ASSAY_PARAM_INT, "", "inf", 0, ASSAY_PARAM_INF, NULL,                             \
     "Largest number of scatterings between light and eye: 0 emission only, 1 direct light, "     \
     "2 one indirect bounce.",                                                                    \
     "[gautron06] 2.1"},                                                                          \
    {"estimator", ASSAY_PARAM_CHOICE, "", "mis", 0, 0, "nee|bsdf|mis",                            \
     "How paths find light, as of the method path.",                                              \
     "[veach95]"},                                                                                \
    {"roulette_depth", ASSAY_PARAM_INT, "bounces", "5", 1, 1e6, NULL,                             \
     "Russian roulette may end a path only after this bounce.",                                   \
     "[arvo90]"},                                                                                 \
    {"a", ASSAY_PARAM_REAL, "", "0.15", 1e-6, 1e3, NULL,                                          \
     "Accuracy: a record counts where its weight is 1 / a or more; smaller is better and "        \
     "slower.",                                                                                   \
     "[gautron06] eq. 2.6"},                                                                      \
    {"theta_strata", ASSAY_PARAM_INT, "", "16", 2, ASSAY_STRATA_MAX, NULL,                        \
     "Cells of a hemisphere from pole to horizon (M).",                                           \
     "[ward-heckbert92]"},                                                                        \
    {"phi_strata", ASSAY_PARAM_INT, "", "50", 2, ASSAY_STRATA_MAX, NULL,                          \
     "Cells of a hemisphere around (N), best about pi M.",                                        \
     "[ward-heckbert92]"},                                                                        \
    {"strata", ASSAY_PARAM_CHOICE, "", "cosine", 0, 0, "cosine|uniform",                          \
     "Cells of equal cosine-weighted or of equal solid angle.",                                   \
     "[gautron06] 2.2.5"},                                                                        \
    {"jitter", ASSAY_PARAM_BOOL, "", "on", 0, 0, NULL,                                            \
     "Rays go through random places of the cells; off: through their centres.",                   \
     ""},                                                                                         \
    {"gather", ASSAY_PARAM_CHOICE, "", "rays", 0, 0, "rays|raster",                               \
     "A hemisphere is seen by rays through its cells, or rasterised onto one plane, which "       \
     "misses the directions near the horizon.",                                                   \
     "[gautron06] 4.4.1"},                                                                        \
    {"raster_size", ASSAY_PARAM_INT, "pixels", "64", 2, ASSAY_STRATA_MAX, NULL,                   \
     "Side of the plane of gather=raster; theta_strata, phi_strata, strata and jitter are then "  \
     "not used.",                                                                                 \
     "[gautron06] 4.4.1"},                                                                        \
    {"raster_fov", ASSAY_PARAM_REAL, "rad", "2.214297435588181",  ASSAY_FOV_MIN, ASSAY_FOV_MAX,   \
     NULL, "Field of view of gather=raster; 2 atan 2 as published (126.87 degrees).",             \
     "[larsen04], [class08]"},                                                                  \
    {"missing", ASSAY_PARAM_CHOICE, "", "border-corrected", 0, 0,                                 \
     "plane|ratio|border|border-corrected",                                                       \
     "What stands for the directions that gather=raster misses: nothing, a ratio, the pixels of " \
     "the rim as published, or these with the cosine of where they are.",                         \
     "[gautron06] 4.4.1, [larsen04], [class08]"},                                               \
    {"shadow", ASSAY_PARAM_CHOICE, "", "ray", 0, 0, "ray|map",                                    \
     "Shadows where a gathering ray ends, with secondary=direct: by rays, or by maps of punctual "\
     "lights (all others by rays).",                                                              \
     "[gautron06] 4.4.1"},                                                                        \
    {"shadow_size", ASSAY_PARAM_INT, "texels", "1024", 16, 8192, NULL,                            \
     "Side of a shadow map.",                                                                     \
     "[gautron06] 4.7"},                                                                          \
    {"shadow_taps", ASSAY_PARAM_INT, "", "16", 1, 1024, NULL,                                     \
     "Depths that percentage-closer filtering compares: a square number.",                        \
     "[gautron06] 4.7, [reeves87]"},                                                              \
    {"secondary", ASSAY_PARAM_CHOICE, "", "path", 0, 0, "direct|path|cache",                      \
     "Light where a gathering ray ends: its direct light alone (at most 2 bounces in all), a "    \
     "path from there on, or direct light and a cache of its own.",                               \
     "[gautron06] 2.2.5, [ward88]"},                                                              \
    {"levels", ASSAY_PARAM_INT, "", "2", 1, ASSAY_CACHE_MAX_LEVELS, NULL,                         \
     "Caches on top of one another with secondary=cache; below the last one paths go on.",        \
     "[ward88]"},                                                                                 \
    {"mean", ASSAY_PARAM_CHOICE, "", "uniform", 0, 0, "uniform|cosine",                           \
     "Weight of directions in the harmonic mean distance R.",                                     \
     "ours"},                                                                                     \
    {"weight", ASSAY_PARAM_CHOICE, "", "ward", 0, 0, "ward|tabellion",                            \
     "Weight of a record.",                                                                       \
     "[gautron06] eq. 2.5, [tabellion04]"},                                                       \
    {"gradients", ASSAY_PARAM_CHOICE, "", "both", 0, 0, "none|rotation|translation|both",         \
     "What records extrapolate by.",                                                              \
     "[ward-heckbert92], [gautron06] eq. 2.7"},                                                   \
    {"normal_gradient", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL,                                  \
     "Translational gradients have a component along the normal, too.",                           \
     "ours"},                                                                                     \
    {"r_min", ASSAY_PARAM_REAL, "m", "0", 0, 1e9, NULL,                                           \
     "R is no smaller; 0: no limit.",                                                             \
     "ours"},                                                                                     \
    {"r_max", ASSAY_PARAM_REAL, "m", "0", 0, 1e9, NULL,                                           \
     "R is no larger; 0: the scene's diagonal.",                                                  \
     "ours"},                                                                                     \
    {"r_min_pixels", ASSAY_PARAM_REAL, "pixels", "0", 0, 1e6, NULL,                               \
     "R is no smaller than so many pixels at the record; 0: no limit.",                           \
     "[tabellion04]"},                                                                            \
    {"r_max_pixels", ASSAY_PARAM_REAL, "pixels", "0", 0, 1e6, NULL,                               \
     "R is no larger than so many pixels at the record; 0: no limit.",                            \
     "[tabellion04]"},                                                                            \
    {"gradient_limit", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL,                                   \
     "R is no larger than irradiance / |translational gradient|, nor that gradient than "          \
     "irradiance / R.",                                                                           \
     "[krivanek05]"},                                                                             \
    {"in_front", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL,                                         \
     "Records in front of the point are left out.",                                               \
     "[ward88]"},                                                                                 \
    {"neighbour_clamp", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL,                                  \
     "R of neighbours differs by no more than their distance.",                                   \
     "[krivanek06]"},                                                                             \
    {"clamp_negative", ASSAY_PARAM_BOOL, "", "on", 0, 0, NULL,                                    \
     "What is extrapolated below 0 counts as 0.",                                                 \
     "ours"},                                                                                     \
    {"traversal", ASSAY_PARAM_CHOICE, "", "scanline", 0, 0, "scanline|hierarchical",              \
     "Order in which the pixels' centres ask for records.",                                       \
     "[ward88]"},                                                                                 \
    {"max_records", ASSAY_PARAM_INT, "records", "10000000", 1, 1e9, NULL,                         \
     "Records a level; beyond them the nearest speaks for points that none reaches.",             \
     ""}

/* Of methods that go over the image once or twice; image_out->passes is 2 without. */
#define ASSAY_CACHE_PASSES_PARAM                                                                  \
    {"passes", ASSAY_PARAM_INT, "", "2", 1, 2, NULL,                                              \
     "1: pixels are evaluated while the cache grows, which leaves seams; 2: when it is "          \
     "complete.",                                                                                 \
     "[gautron06] fig. 4.2"}
/* clang-format on */

/* What the rows above say.  Errors: ARGUMENT (limits of R that exclude one another). */
assay_status assay_cache_params_read(assay_context *context, const assay_params *params,
                                     assay_irradiance_cache_settings *cache_out,
                                     assay_cached_image_settings     *image_out);

#endif
