/* splat_method.c - the method: parameters, caches, and an image by splatting. */
#include "methods/splat/splat_method.h"

#include "core/alloc.h"
#include "core/context.h"
#include "methods/cache_pair.h"
#include "methods/cache_params.h"
#include "methods/splat/splat_image.h"

static const assay_param_desc PARAMS[] = {
    ASSAY_CACHE_PARAMS,
    ASSAY_RADIANCE_PARAMS,
    {"gbuffer", ASSAY_PARAM_CHOICE, "", "samples", 0, 0, "samples|centres",
     "Points that are splatted on: every camera sample, one after the other, or the pixels' "
     "centres alone, whose indirect light all samples of a pixel take.",
     "[gautron06] algorithm 4"},
    {"bounds", ASSAY_PARAM_CHOICE, "", "exact", 0, 0, "exact|published",
     "Pixels that a record is splatted on: bounds of its sphere that lose none, or a square at the "
     "depth of its centre, whose losses are counted.",
     "[gautron06] eq. 4.4, [class08]"},
    {"variant", ASSAY_PARAM_CHOICE, "", "corrected", 0, 0, "corrected|published",
     "Step 5 of algorithm 4: new records alone, or, as printed, all of them once more on top of "
     "the old ones.",
     "[gautron06] algorithm 4"},
    {"splat_a", ASSAY_PARAM_REAL, "", "0", 0, 1e3, NULL,
     "Accuracy with which the records are splatted when they are all there; 0: a.",
     "[gautron06] fig. 4.12"},
    {"max_new_records", ASSAY_PARAM_INT, "records", "1000000000", 0, 1e9, NULL,
     "Records that a frame may make, of a kind; what they do not reach is left to `uncovered`.",
     "[gautron06] fig. 4.11"},
    {"uncovered", ASSAY_PARAM_CHOICE, "", "nearest", 0, 0, "nearest|black",
     "Irradiance where no record reaches: the nearest record's, or none, as published.", ""},
    {"dump_batch", ASSAY_PARAM_INT, "records", "0", 0, 1e9, NULL,
     "The dump has the splat buffer after every so many new records; 0: before and after all.", ""},
    ASSAY_CACHE_SESSION_PARAMS,
    {0},
};

typedef struct {
    assay_context              *context;
    assay_cache_pair            pair;
    assay_cached_image_settings image_settings;
    assay_cache_session         session;
    splat_image                 image;
} splat_state;

static void destroy(void *state)
{
    splat_state *s = state;
    if (s) {
        splat_image_close(&s->image);
        assay_cache_pair_release(&s->pair);
        assay_cache_session_release(&s->session);
        assay_release(s->context, s);
    }
}

static void read_own_params(const assay_params *params, splat_state *s)
{
    s->image.uncovered            = (splat_uncovered)assay_params_choice(params, "uncovered");
    s->image.centres              = assay_params_choice(params, "gbuffer") == 1;
    s->image_settings.centres     = s->image.centres;
    s->pair.params.cache.widest_a = assay_params_real(params, "splat_a");
    s->image.rules                = (splat_rules){
                       .variant     = (splat_variant)assay_params_choice(params, "variant"),
                       .bounds      = (assay_splat_bounds_kind)assay_params_choice(params, "bounds"),
                       .accuracy    = assay_params_real(params, "splat_a"),
                       .max_records = s->pair.params.cache.records.max_records,
                       .max_new     = (uint32_t)assay_params_int(params, "max_new_records"),
                       .again       = s->pair.params.cache.records.neighbour_clamp,
                       .batch       = (uint32_t)assay_params_int(params, "dump_batch"),
    };
}

static assay_status create(assay_context *context, const assay_params *params, void **state_out)
{
    splat_state *s = assay_allocate(context, 1, sizeof *s);
    if (!s) {
        return assay_fail_memory(context, "splatting");
    }
    s->context          = context;
    assay_status status = assay_cache_pair_read(context, assay_method_splat.name, params, &s->pair,
                                                &s->image_settings);
    status = status ? status : assay_cache_session_create(context, params, &s->session);
    if (status != ASSAY_OK) {
        destroy(s);
        return status;
    }
    read_own_params(params, s);
    *state_out = s;
    return ASSAY_OK;
}

/* Without radiance records a saved cache is one of irradiance-cache, with them of radiance-cache.
 */
static assay_cache_set caches_of(const splat_state *s)
{
    return (assay_cache_set){&s->pair.params.cache.records,
                             s->pair.radiance ? &s->pair.params.cache : NULL, s->pair.irradiance,
                             s->pair.radiance};
}

static assay_status prepare(void *state, const assay_frame *frame)
{
    splat_state          *s      = state;
    const assay_status    status = assay_cache_pair_prepare(&s->pair, frame);
    const assay_cache_set caches = caches_of(s);
    return status ? status : assay_cache_session_begin(&s->session, frame, &caches);
}

static void report(const splat_state *s)
{
    const splat_image *image     = &s->image;
    const uint64_t     unreached = splat_image_unreached(image);
    assay_inform(s->context, ASSAY_LOG_INFO,
                 "splat: %u irradiance and %u radiance records were made this time",
                 image->diffuse.made, image->glossy.made);
    if (image->lost > 0) {
        assay_inform(s->context, ASSAY_LOG_WARNING,
                     "splat: bounds=published lost %llu contributions of records to pixels",
                     (unsigned long long)image->lost);
    }
    if (unreached > 0) {
        assay_inform(s->context, ASSAY_LOG_WARNING,
                     "splat: %llu looks at pixels that no record reaches (max_new_records, "
                     "max_records, splat_a, bounds, or records that shrank): %s",
                     (unsigned long long)unreached,
                     image->uncovered == SPLAT_NEAREST ? "answered by the nearest record"
                                                       : "black");
    }
}

static assay_status render(void *state, const assay_frame *frame, assay_film *film,
                           assay_ray_counts *counts)
{
    splat_state          *s      = state;
    const assay_cache_set caches = caches_of(s);
    s->image.context             = s->context;
    s->image.frame               = frame;
    s->image.caches              = &caches;
    s->image.materials           = &s->pair.materials;
    s->image.session             = &s->session;
    s->image.path                = &s->pair.params.cache.records.path;
    assay_status status          = splat_image_open(&s->image);
    if (status == ASSAY_OK) {
        const assay_cached_light light = splat_image_light(&s->image);
        status = assay_cache_session_render(&s->session, frame, &caches, &s->image_settings, &light,
                                            film, counts);
    }
    if (status == ASSAY_OK) {
        counts->lost += s->image.lost;
        report(s);
    }
    splat_image_close(&s->image);
    return status;
}

const assay_method assay_method_splat = {
    .name    = "splat",
    .summary = "Radiance cache splatting: irradiance and radiance records spread over the pixels "
               "that they reach.",
    .params  = PARAMS,
    .keeps_light = true,
    .create      = create,
    .prepare     = prepare,
    .render      = render,
    .destroy     = destroy,
};
