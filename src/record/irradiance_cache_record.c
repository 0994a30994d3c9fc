/* irradiance_cache_record.c - a record from its hemisphere.
 *
 * Invariant: R_k is finite and above 0; limits that the settings state hold over what was seen and
 * over what gradients and neighbours ask for, and of these limits the lower one is the stronger. */
#include "record/irradiance_cache_data.h"

#include "record/neighbour_clamp.h"

static void to_world(const assay_frame3 *frame, assay_vec3 gradient[3])
{
    for (int c = 0; c < 3; c++) {
        gradient[c] = frame3_to_world(frame, gradient[c]);
    }
}

/* How far the light may go on changing as it does here until nothing is left of it, m. */
static double gradient_distance(const assay_record *record)
{
    const assay_rgb  e = record->irradiance;
    const assay_vec3 t =
        vec3_add(vec3_add(record->translation[0], record->translation[1]), record->translation[2]);
    const double change = vec3_length(t);
    return change > 0.0 ? (e.r + e.g + e.b) / change : INFINITY;
}

/* A radius that was made larger than that distance (by its lower limit, or where channels differ)
 * would have the record say much more, or less than nothing, within it. */
static void limit_gradient(assay_record *record)
{
    const double e[3] = {record->irradiance.r, record->irradiance.g, record->irradiance.b};
    for (int c = 0; c < 3; c++) {
        const double change = vec3_length(record->translation[c]) * record->radius;
        if (change > e[c]) {
            record->translation[c] = vec3_scale(record->translation[c], e[c] / change);
        }
    }
}

/* R_k from what was seen. */
static assay_status find_radius(assay_irradiance_cache *cache, const assay_cache_point *point,
                                assay_record *record)
{
    const assay_irradiance_cache_settings *s         = &cache->settings;
    const bool                             tabellion = s->rules.weight == ASSAY_WEIGHT_TABELLION;
    double radius = tabellion ? 0.5 * record->nearest : record->mean;
    /* Where nothing is seen the light changes nowhere, as far as one can tell. */
    radius = radius < cache->diagonal ? radius : cache->diagonal;
    if (s->gradient_limit) {
        radius = fmin(radius, gradient_distance(record));
    }
    if (s->neighbour_clamp) {
        const assay_status status =
            assay_neighbour_clamp_record(cache->store, record->position, &radius);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    double least = s->r_min, most = s->r_max;
    if (point->footprint > 0.0) {
        least = fmax(least, s->r_min_pixels * point->footprint);
        most  = fmin(most, s->r_max_pixels * point->footprint);
    }
    radius         = radius < most ? radius : most;
    radius         = radius > least ? radius : least;
    record->radius = radius > 0.0 ? radius : cache->world->offset;
    return ASSAY_OK;
}

assay_status irradiance_cache_add_record(assay_irradiance_cache  *cache,
                                         const assay_cache_point *point)
{
    const assay_irradiance_cache_settings *s      = &cache->settings;
    const assay_gather_site               *site   = &point->site;
    assay_status                           status = irradiance_cache_gather(cache, site);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_record record = {.position   = site->position,
                           .normal     = site->frame.z,
                           .mean       = assay_hemisphere_harmonic_mean(cache->hemisphere, s->mean),
                           .nearest    = assay_hemisphere_nearest(cache->hemisphere),
                           .irradiance = assay_hemisphere_irradiance(cache->hemisphere)};
    assay_hemisphere_rotation_gradient(cache->hemisphere, record.rotation);
    assay_hemisphere_translation_gradient(cache->hemisphere, s->normal_gradient,
                                          record.translation);
    to_world(&site->frame, record.rotation);
    to_world(&site->frame, record.translation);
    status = find_radius(cache, point, &record);
    if (status == ASSAY_OK && s->gradient_limit) {
        limit_gradient(&record);
    }
    if (status == ASSAY_OK && s->neighbour_clamp) {
        status = assay_neighbour_clamp_others(cache->store, &record, cache->diagonal);
    }
    if (status == ASSAY_OK && cache->companion.keep) {
        status = cache->companion.keep(cache->companion.user,
                                       assay_record_store_count(cache->store), cache->hemisphere);
    }
    return status ? status : assay_record_store_add(cache->store, &record);
}
