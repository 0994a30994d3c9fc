/* hemisphere_plane_sums.c - irradiance, its gradients and mean distances from pixels of one plane.
 *
 * Invariant: sums run over cells, or over borders, in the order of their numbers. */
#include "gather/hemisphere_plane.h"

static size_t count_of(const assay_hemisphere *h)
{
    return (size_t)h->layout.theta * (size_t)h->layout.phi;
}

assay_rgb hemisphere_plane_irradiance(const assay_hemisphere *h)
{
    assay_rgb sum = rgb_grey(0.0);
    for (size_t i = 0; i < count_of(h); i++) {
        sum = rgb_add(sum, rgb_scale(h->cells[i].radiance, h->plane->cell[i].flux.z));
    }
    return sum;
}

static void add(assay_vec3 sum[3], assay_rgb radiance, assay_vec3 way)
{
    sum[0] = vec3_mad(sum[0], radiance.r, way);
    sum[1] = vec3_mad(sum[1], radiance.g, way);
    sum[2] = vec3_mad(sum[2], radiance.b, way);
}

/* z x Phi. */
void hemisphere_plane_rotation(const assay_hemisphere *h, assay_vec3 gradient_out[3])
{
    assay_vec3 sum[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < count_of(h); i++) {
        const assay_vec3 flux = h->plane->cell[i].flux;
        add(sum, h->cells[i].radiance, vec3(-flux.y, flux.x, 0.0));
    }
    for (int c = 0; c < 3; c++) {
        gradient_out[c] = sum[c];
    }
}

/* A border moves as the nearer of the things beside it; 1 / INFINITY is 0. */
void hemisphere_plane_translation(const assay_hemisphere *h, bool normal,
                                  assay_vec3 gradient_out[3])
{
    assay_vec3 sum[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < h->plane->wall_count; i++) {
        const plane_wall *wall = &h->plane->wall[i];
        const assay_cell *a = &h->cells[wall->a], *b = &h->cells[wall->b];
        const double      speed = 1.0 / (a->distance < b->distance ? a->distance : b->distance);
        add(sum, rgb_scale(rgb_sub(b->radiance, a->radiance), speed), wall->way);
    }
    for (int c = 0; c < 3; c++) {
        gradient_out[c] = vec3(sum[c].x, sum[c].y, normal ? sum[c].z : 0.0);
    }
}

double hemisphere_plane_mean(const assay_hemisphere *h, assay_mean_weight weight)
{
    double all = 0.0, near = 0.0;
    for (size_t i = 0; i < count_of(h); i++) {
        const plane_cell *cell  = &h->plane->cell[i];
        const double      share = weight == ASSAY_MEAN_COSINE ? cell->flux.z : cell->solid;
        all += share;
        near += share / h->cells[i].distance;
    }
    return all / near;
}
