/* verify_metadata.c - attributes that say what light an image measures.
 *
 * Invariant: what is compared here changes the expectation of an image; seed, samples and method do
 * not, and may differ.  What sums up others (a digest of all options) is compared last, so that a
 * message names the option. */
#include "oracle/image/verify_metadata.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"

static const char *const LIGHT[] = {"assay:scene.files_digest",
                                    "assay:scene.time",
                                    "assay:scene.force_diffuse",
                                    "assay:scene.solid_transmission",
                                    "assay:scene.background",
                                    "assay:scene.environment.digest",
                                    "assay:scene.environment.scale",
                                    "assay:scene.environment.rotation",
                                    "assay:camera.position",
                                    "assay:camera.forward",
                                    "assay:camera.up",
                                    "assay:camera.right",
                                    "assay:camera.yfov",
                                    "assay:camera.xmag",
                                    "assay:camera.ymag",
                                    "assay:scene.digest"};

/* Names under which other programs say what their colours are. */
static const char *const COLOUR[] = {"oiio:ColorSpace", "colorSpace", "colorspace", "ColorSpace",
                                     "colorInteropID"};

/* What means linear light with the primaries of Rec. 709. */
static const char *const LINEAR[] = {"Linear",          "linear",       "lin_srgb",
                                     "lin_rec709",      "scene_linear", "Linear Rec.709 (sRGB)",
                                     "lin_rec709_scene"};

/* Of red, green, blue and white, x and y; white is D65 [bt709, section 1]. */
static const double REC709[] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};

/* Writers round the white point in several ways; the next space of the same kind (Rec. 601, 625
 * lines) differs by 0.01. */
#define CHROMATICITY_TOLERANCE 0.002

static bool is_rec709(const char *chromaticities)
{
    const char *at = chromaticities;
    for (size_t i = 0; i < sizeof REC709 / sizeof REC709[0]; i++) {
        char        *end   = NULL;
        const double value = strtod(at, &end);
        if (end == at || !(fabs(value - REC709[i]) <= CHROMATICITY_TOLERANCE)) {
            return false;
        }
        at = end;
    }
    return true;
}

/* "unknown" is what the list of such names has for saying nothing. */
static bool is_linear(const char *value)
{
    if (strcmp(value, "unknown") == 0) {
        return true;
    }
    for (size_t i = 0; i < sizeof LINEAR / sizeof LINEAR[0]; i++) {
        if (strcmp(value, LINEAR[i]) == 0) {
            return true;
        }
    }
    return false;
}

/* What an OpenEXR header says in other types than text (io/exr_colour.c).  Without chromaticities
 * they are those of Rec. 709; an ACES container has primaries of its own. */
static assay_status check_primaries(assay_context *context, const assay_image *image,
                                    const char *whose)
{
    const char *primaries = assay_image_get_attribute(image, "exr:chromaticities");
    const char *aces      = assay_image_get_attribute(image, "exr:acesImageContainerFlag");
    if (primaries && !is_rec709(primaries)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "the %s's attribute chromaticities is '%s': linear Rec. 709 is compared",
                          whose, primaries);
    }
    return aces && strcmp(aces, "0") != 0
               ? assay_fail(context, ASSAY_ERR_ARGUMENT,
                            "the %s's attribute acesImageContainerFlag is %s: linear Rec. 709 is "
                            "compared",
                            whose, aces)
               : ASSAY_OK;
}

static assay_status check_colour(assay_context *context, const assay_image *image,
                                 const char *whose)
{
    for (size_t i = 0; i < sizeof COLOUR / sizeof COLOUR[0]; i++) {
        const char *value = assay_image_get_attribute(image, COLOUR[i]);
        if (value && !is_linear(value)) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "the %s's attribute %s is '%s': linear Rec. 709 is compared", whose,
                              COLOUR[i], value);
        }
    }
    return check_primaries(context, image, whose);
}

static assay_status check_same(assay_context *context, const assay_image *candidate,
                               const assay_image *reference, const char *mine, const char *theirs)
{
    const char *a = assay_image_get_attribute(candidate, mine);
    const char *b = assay_image_get_attribute(reference, theirs);
    if (a && b && strcmp(a, b) != 0) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "%s is '%s' in the candidate, but '%s' in the reference: not the same "
                          "light",
                          mine, a, b);
    }
    return ASSAY_OK;
}

/* A parameter that several methods have, each under its own name. */
static void parameter_name(const assay_image *image, const char *parameter, char name_out[128])
{
    const char *method = assay_image_get_attribute(image, "assay:method");
    snprintf(name_out, 128, "assay:%.80s.%s", method ? method : "", parameter);
}

/* A picture of records or weights is no light. */
static assay_status check_debug(assay_context *context, const assay_image *image, const char *whose)
{
    char name[128];
    parameter_name(image, "debug", name);
    const char *value = assay_image_get_attribute(image, name);
    return value && strcmp(value, "off") != 0
               ? assay_fail(context, ASSAY_ERR_ARGUMENT, "the %s's attribute %s is '%s': no light",
                            whose, name, value)
               : ASSAY_OK;
}

assay_status assay_verify_metadata(assay_context *context, const assay_image *candidate,
                                   const assay_image *reference)
{
    assay_status status = check_colour(context, candidate, "candidate");
    status = status != ASSAY_OK ? status : check_colour(context, reference, "reference");
    for (size_t i = 0; status == ASSAY_OK && i < sizeof LIGHT / sizeof LIGHT[0]; i++) {
        status = check_same(context, candidate, reference, LIGHT[i], LIGHT[i]);
    }
    status = status != ASSAY_OK ? status : check_debug(context, candidate, "candidate");
    status = status != ASSAY_OK ? status : check_debug(context, reference, "reference");
    char mine[128], theirs[128];
    parameter_name(candidate, "bounces", mine);
    parameter_name(reference, "bounces", theirs);
    return status != ASSAY_OK ? status : check_same(context, candidate, reference, mine, theirs);
}

bool assay_verify_shared_seed(const assay_image *candidate, const assay_image *reference)
{
    static const char *const SAME[] = {"assay:seed", "assay:method", "assay:version"};
    for (size_t i = 0; i < sizeof SAME / sizeof SAME[0]; i++) {
        const char *a = assay_image_get_attribute(candidate, SAME[i]);
        const char *b = assay_image_get_attribute(reference, SAME[i]);
        if (!a || !b || strcmp(a, b) != 0) {
            return false;
        }
    }
    return true;
}
