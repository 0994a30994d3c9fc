/* cmd_verify.c - `assay verify CANDIDATE --reference REF`. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "console.h"
#include "options.h"
#include "output_check.h"
#include "verify_bundles.h"

typedef struct {
    const char          *candidates[ASSAY_VERIFY_MAX_RUNS];
    int                  count;
    const char          *reference;
    const char          *json, *junit;
    assay_verify_options options;
    uint64_t             memory_limit;
    bool                 annotations, list, quiet, help;
    bool                 noise; /* an option was given that is of images alone */
    long                 threads;
    cli_bundle_request   bundles;
} verify_request;

enum {
    OPT_REFERENCE,
    OPT_CANDIDATE,
    OPT_CHANNELS,
    OPT_LEVEL,
    OPT_CORRECTION,
    OPT_TILE,
    OPT_ALLOW,
    OPT_ALLOW_ABSOLUTE,
    OPT_DETECT,
    OPT_DETECT_TILE,
    OPT_SAMPLES,
    OPT_REFERENCE_SAMPLES,
    OPT_REFERENCE_EXACT,
    OPT_PRECISION,
    OPT_IGNORE_METADATA,
    OPT_JSON,
    OPT_JUNIT,
    OPT_ANNOTATIONS,
    OPT_LIST,
    OPT_THREADS,
    OPT_MEMORY,
    OPT_QUIET,
    OPT_HELP,
    OPT_SCENE,
    OPT_TIME,
    OPT_REQUIRE,
    OPT_JUDGED
};
static const cli_option OPTIONS[] = {
    {"reference", 0, "REF",
     "what is right: an image with variances, or the bundle that was begun with"},
    {"candidate", 0, "C.exr", "a run of the candidate; several differ in their seed alone"},
    {"channels", 0, "C,...", "channels to compare, as in R,G,B (default: all of light in both)"},
    {"level", 0, "P", "of a false alarm, over all tests together (default 0.01)"},
    {"correction", 0, "C", "of the tests of pixels: holm (default) or bh"},
    {"tile", 0, "N", "side of the smallest tiles, 4 to 256 pixels (default 16)"},
    {"allow", 0, "X", "test equivalence: a bias of X of the mean passes, by tile and whole"},
    {"allow-absolute", 0, "X", "likewise, in the channel's unit"},
    {"detect", 0, "X",
     "cannot tell unless a bias of X of the whole would have been seen; of bundles: of a typical "
     "number of each array"},
    {"detect-tile", 0, "X", "likewise in every tile, in parts of the image's mean"},
    {"samples", 0, "N", "of a candidate's pixel (default: its SampleCount)"},
    {"reference-samples", 0, "N", "of a reference's pixel (default: its SampleCount)"},
    {"reference-exact", 0, NULL, "the reference has no noise"},
    {"precision", 0, "P", "of the candidate: half, float (default) or double"},
    {"ignore-metadata", 0, NULL, "compare also where scene or camera are said to differ"},
    {"json", 0, "F.json", "write the verdict as JSON; - is standard output"},
    {"junit", 0, "F.xml", "write the verdict as JUnit XML"},
    {"annotations", 0, NULL, "print GitHub's ::error lines for what does not pass"},
    {"list", 0, NULL, "print every finding"},
    {"threads", 0, "N", "threads; 0, the default, is one a processor"},
    CLI_MEMORY_OPTION,
    {"quiet", 'q', NULL, "no progress, no warnings, no paragraph"},
    {"help", 'h', NULL, "this text"},
    {"scene", 0, "F.gltf", "bundles: judges the stages that look at a scene, too"},
    {"time", 0, "T", "seconds into the scene's animations (default 0)"},
    {"require", 0, "STAGE,...", "bundles: cannot tell where one of these is not judged"},
    {"judged", 0, "PART",
     "bundles: cannot tell where of an array less than this is judged (default 0.5)"},
    CLI_SCENE_OPTIONS,
    {0}};

static const char *read_positive(const char *value, double *out)
{
    return cli_read_real(value, out) || !(*out > 0.0) ? "takes a number > 0" : NULL;
}

/* Less than half never passes. */
static const char *read_part(const char *value, double *out)
{
    return cli_read_real(value, out) || !(*out >= 0.5 && *out <= 1.0)
               ? "takes a number from 0.5 to 1"
               : NULL;
}

static const char *read_samples(const char *value, uint32_t *out)
{
    long number;
    if (cli_read_count(value, 1, 2147483647, &number)) {
        return "takes a whole number from 1 to 2147483647";
    }
    *out = (uint32_t)number;
    return NULL;
}

static const char *read_level(const char *value, double *out)
{
    return cli_read_real(value, out) || !(*out > 0.0 && *out < 0.5)
               ? "takes a number between 0 and 0.5"
               : NULL;
}

static const char *read_tile(const char *value, int *out)
{
    long number;
    if (cli_read_count(value, 4, 256, &number)) {
        return "takes a whole number from 4 to 256";
    }
    *out = (int)number;
    return NULL;
}

/* Index of the value among two words, or -1. */
static int word(const char *value, const char *first, const char *second)
{
    return strcmp(value, first) == 0 ? 0 : strcmp(value, second) == 0 ? 1 : -1;
}

static const char *read_correction(const char *value, assay_correction *out)
{
    const int index = word(value, "holm", "bh");
    if (index < 0) {
        return "takes holm or bh";
    }
    *out = index == 0 ? ASSAY_CORRECTION_HOLM : ASSAY_CORRECTION_BH;
    return NULL;
}

static const char *read_precision(const char *value, assay_precision *out)
{
    return assay_precision_find(value, out) ? "takes half, float or double" : NULL;
}

static const char *add_candidate(verify_request *r, const char *value)
{
    if (!*value) {
        return "the name of an image is empty";
    }
    if (r->count == ASSAY_VERIFY_MAX_RUNS) {
        return "more than 64 runs";
    }
    r->candidates[r->count++] = value;
    return NULL;
}

static const char *take_output(verify_request *r, int index, const char *value)
{
    switch (index) {
    case OPT_JSON: r->json = value; return NULL;
    case OPT_JUNIT: r->junit = value; return NULL;
    case OPT_ANNOTATIONS: r->annotations = true; return NULL;
    case OPT_LIST: r->list = true; return NULL;
    case OPT_THREADS:
        return cli_read_count(value, 0, 1024, &r->threads) ? "takes a whole number from 0 to 1024"
                                                           : NULL;
    case OPT_MEMORY: return cli_read_bytes(value, &r->memory_limit);
    case OPT_QUIET: r->quiet = true; return NULL;
    case OPT_HELP: r->help = true; return NULL;
    case OPT_SCENE: r->bundles.scene = value; return NULL;
    case OPT_REQUIRE: r->bundles.require = value; return NULL;
    case OPT_JUDGED: return read_part(value, &r->bundles.judged);
    case OPT_TIME: return cli_read_real(value, &r->bundles.time);
    default: break;
    }
    if (index >= 0) {
        const char *problem = NULL;
        cli_scene_option(&r->bundles.options, OPTIONS[index].name, value, &problem);
        return problem;
    }
    return add_candidate(r, value);
}

/* What would be without an effect on bundles. */
static bool is_of_images(int index)
{
    return index >= OPT_CHANNELS && index <= OPT_IGNORE_METADATA && index != OPT_DETECT &&
           index != OPT_PRECISION;
}

static const char *take(void *user, int index, const char *value)
{
    verify_request       *r = user;
    assay_verify_options *o = &r->options;
    r->noise                = r->noise || is_of_images(index);
    switch (index) {
    case OPT_REFERENCE: r->reference = value; return *value ? NULL : "the name is empty";
    case OPT_CANDIDATE: return add_candidate(r, value);
    case OPT_CHANNELS: o->channels = value; return NULL;
    case OPT_LEVEL: return read_level(value, &o->level);
    case OPT_CORRECTION: return read_correction(value, &o->correction);
    case OPT_TILE: return read_tile(value, &o->tile);
    case OPT_ALLOW: return read_positive(value, &o->allow);
    case OPT_ALLOW_ABSOLUTE: return read_positive(value, &o->allow_absolute);
    case OPT_DETECT: return read_positive(value, &o->detect);
    case OPT_DETECT_TILE: return read_positive(value, &o->detect_tile);
    case OPT_SAMPLES: return read_samples(value, &o->candidate_samples);
    case OPT_REFERENCE_SAMPLES: return read_samples(value, &o->reference_samples);
    case OPT_REFERENCE_EXACT: o->reference_exact = true; return NULL;
    case OPT_PRECISION: return read_precision(value, &o->precision);
    case OPT_IGNORE_METADATA: o->ignore_metadata = true; return NULL;
    default: return take_output(r, index, value);
    }
}

/* Each format is whole only where nothing else is written to the same place. */
static const char *check_outputs(const verify_request *r)
{
    const bool json = r->json && strcmp(r->json, "-") == 0;
    const bool xml  = r->junit && strcmp(r->junit, "-") == 0;
    if (r->json && r->junit && strcmp(r->json, r->junit) == 0) {
        return "--json and --junit are the same file";
    }
    return (json || xml) && (r->list || r->annotations)
               ? "--list and --annotations write to standard output, as - does"
               : NULL;
}

/* What the options say together; NULL, or what is wrong. */
static const char *check_together(const verify_request *r)
{
    if (r->count == 0) {
        return "a candidate is missing";
    }
    if (!r->reference && !cli_is_bundle(r->candidates[0])) {
        return "--reference is missing";
    }
    const bool bundle = cli_is_bundle(r->candidates[0]);
    if (!bundle && cli_is_bundle(r->reference)) {
        return "the reference is a bundle, the candidate is none that can be read";
    }
    if (bundle && r->reference && cli_is_image(r->reference)) {
        return "the candidate is a bundle, the reference is an image";
    }
    const char *problem =
        bundle && r->noise
            ? "--channels, --level, --correction, --tile, --allow, --detect-tile, --samples, "
              "--reference-exact and --ignore-metadata go with images"
            : NULL;
    problem = problem ? problem : cli_bundle_check(&r->bundles, r->count, r->candidates[0]);
    if (problem) {
        return problem;
    }
    if ((problem = check_outputs(r)) != NULL) {
        return problem;
    }
    const bool allow = r->options.allow > 0.0 || r->options.allow_absolute > 0.0;
    if (allow && (r->options.detect > 0.0 || r->options.detect_tile > 0.0)) {
        return "--detect goes with a test of differences, --allow with one of equivalence";
    }
    return NULL;
}

static int check_output(const verify_request *r, const char *path)
{
    if (!path || strcmp(path, "-") == 0) {
        return 0;
    }
    int code = r->reference ? cli_check_not_input("verify", path, r->reference) : 0;
    for (int k = 0; code == 0 && k < r->count; k++) {
        code = cli_check_not_input("verify", path, r->candidates[k]);
    }
    return code ? code : cli_check_file("verify", path);
}

typedef assay_status (*verdict_text)(const assay_verdict *verdict, char **text_out);

static assay_status write_output(cli_console *console, assay_context *context,
                                 const assay_verdict *verdict, verdict_text make, const char *path)
{
    char        *text   = NULL;
    assay_status status = make(verdict, &text);
    if (status == ASSAY_OK && (*text || strcmp(path, "-") != 0)) {
        const size_t length = strlen(text);
        if (strcmp(path, "-") == 0 && length > 0 && text[length - 1] == '\n') {
            text[length - 1] = '\0'; /* that of puts */
        }
        status = cli_write_text(console, context, path, text);
    }
    assay_text_destroy(context, text);
    return status;
}

/* The part of an array that was judged, in percent. */
static double judged_of(const assay_finding *f)
{
    return f->values ? 100.0 * (double)f->values / (double)(f->values + f->unjudged) : NAN;
}

/* Columns of texts are as wide as the longest of them. */
typedef struct {
    int stage, array, test;
} list_widths;

static int wider(int width, size_t length) { return length > (size_t)width ? (int)length : width; }

static size_t array_length(const assay_finding *f)
{
    return strlen(f->array) + (f->channel ? 1 + strlen(f->channel) : 0);
}

static list_widths widths_of(const assay_verdict *verdict)
{
    list_widths w = {(int)strlen("stage"), (int)strlen("array"), (int)strlen("test")};
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        const assay_finding f = assay_verdict_at(verdict, i);
        w.stage               = wider(w.stage, strlen(f.stage));
        w.array               = wider(w.array, array_length(&f));
        w.test                = wider(w.test, strlen(f.test));
    }
    return w;
}

static void print_findings(const assay_verdict *verdict)
{
    const list_widths w = widths_of(verdict);
    printf("%-*s  %-*s  %-*s  %-11s %10s %12s %12s %8s %10s\n", w.stage, "stage", w.array, "array",
           w.test, "test", "verdict", "in bounds", "effect", "visible", "judged %", "width");
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        const assay_finding f = assay_verdict_at(verdict, i);
        printf("%-*s  %s%s%s%*s  %-*s  %-11s %10.4g %12.4g %12.4g %8.4g %10.3g\n", w.stage, f.stage,
               f.array, f.channel ? "." : "", f.channel ? f.channel : "",
               w.array - (int)array_length(&f), "", w.test, f.test, assay_verdict_kind_text(f.kind),
               f.in_bounds, f.effect, f.visible, judged_of(&f), f.width);
    }
}

/* What the paragraph does not say. */
static void print_caveats(const assay_verdict *verdict)
{
    const char *seed     = assay_verdict_get(verdict, "shared_seed");
    const char *unjudged = assay_verdict_get(verdict, "not judged");
    const char *missing  = assay_verdict_get(verdict, "missing");
    const char *blind    = assay_verdict_get(verdict, "blind");
    if (seed) {
        printf("The same seed in both: %s.\n", seed);
    }
    if (blind) {
        printf("Without a bound on any number in this precision and with these parameters: stage "
               "%s.\n",
               blind);
    }
    if (unjudged) {
        printf("Not judged: %s.\n", unjudged);
    }
    if (missing) {
        printf("Missing, of the reference's arrays: %s.\n", missing);
    }
}

static assay_status report(cli_console *console, assay_context *context, const verify_request *r,
                           const assay_verdict *verdict)
{
    const bool   text   = !r->quiet && !(r->json && strcmp(r->json, "-") == 0);
    assay_status status = ASSAY_OK;
    cli_console_clear(console);
    if (r->list) {
        print_findings(verdict);
    }
    if (text) {
        status = write_output(console, context, verdict, assay_verdict_paragraph, "-");
    }
    if (status == ASSAY_OK && text) {
        print_caveats(verdict);
    }
    if (status == ASSAY_OK && r->annotations) {
        status = write_output(console, context, verdict, assay_verdict_annotations, "-");
    }
    if (status == ASSAY_OK && r->json) {
        status = write_output(console, context, verdict, assay_verdict_json, r->json);
    }
    return status == ASSAY_OK && r->junit
               ? write_output(console, context, verdict, assay_verdict_junit, r->junit)
               : status;
}

static int verify(const verify_request *r)
{
    cli_console    console;
    assay_context *context =
        cli_console_open(&console, "verify", r->quiet, (int)r->threads, r->memory_limit);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    assay_verdict *verdict = NULL;
    const bool     bundle  = cli_is_bundle(r->candidates[0]);
    assay_status   status  = bundle ? cli_verify_bundle(context, r->candidates[0], r->reference,
                                                        &r->bundles, &r->options, &verdict)
                                    : assay_verify_files(context, r->candidates, r->count,
                                                         r->reference, &r->options, &verdict);
    if (status == ASSAY_OK) {
        status = report(&console, context, r, verdict);
    }
    const int kind = status == ASSAY_OK ? (int)assay_verdict_whole(verdict) : 0;
    assay_verdict_destroy(verdict);
    const int code = cli_console_finish(&console, context, status);
    assay_context_destroy(context);
    return code != 0 ? code : kind;
}

int cli_verify(int count, char **argv)
{
    verify_request request = {.options = assay_verify_options_default(),
                              .bundles = cli_bundle_request_default()};
    if (!cli_parse("verify", count, argv, OPTIONS, take, NULL, &request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        printf("usage: assay verify CANDIDATE.exr [MORE.exr ...] --reference REF.exr [options]\n"
               "       assay verify BUNDLE [--reference BUNDLE] [--scene F.gltf] [--precision P]\n"
               "Is it the same light? Several candidates are runs of one renderer.\n"
               "Of a bundle: which stage is the first that does not follow from its inputs?\n"
               "Exit code 0: passes; 1: fails; 2: cannot tell, or bad input.\n");
        cli_print_options(OPTIONS);
        return 0;
    }
    const char *problem = check_together(&request);
    if (problem) {
        cli_complain("verify", "%s (assay verify --help lists the options)", problem);
        return CLI_EXIT_USAGE;
    }
    const int check = check_output(&request, request.json);
    const int other = check ? check : check_output(&request, request.junit);
    return other ? other : verify(&request);
}
