/* render_request.c - the options of `assay render`.
 *
 * Parameters of the method are options too: --NAME VALUE and -p NAME=VALUE say the same.  They are
 * checked once the method is known, by the library. */
#include "render_request.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "console.h"
#include "options.h"
#include "output_check.h"
#include "scene_options.h"

enum {
    OPT_METHOD,
    OPT_PARAM,
    OPT_OUTPUT,
    OPT_PNG,
    OPT_EXPOSURE,
    OPT_CAMERA,
    OPT_SIZE,
    OPT_LAYERS,
    OPT_POINTS,
    OPT_SEED,
    OPT_TIME,
    OPT_FRAMES,
    OPT_FPS,
    OPT_STATS,
    OPT_DUMP,
    OPT_THREADS,
    OPT_MEMORY,
    OPT_QUIET,
    OPT_HELP
};

static const cli_option OPTIONS[] = {
    [OPT_METHOD]   = {"method", 'm', "NAME", "method (default path); assay methods lists them"},
    [OPT_PARAM]    = {"param", 'p', "K=V", "set a parameter of the method; --K V says the same"},
    [OPT_OUTPUT]   = {"output", 'o', "F", "image (.exr), or with --points table (.npy)"},
    [OPT_PNG]      = {"png", 0, "F.png", "also a preview, 8 bits, sRGB"},
    [OPT_EXPOSURE] = {"exposure", 0, "STOPS", "of --png, value times 2^STOPS (default 0)"},
    [OPT_CAMERA]   = {"camera", 0, "C", "name or number (default: the first)"},
    [OPT_SIZE]   = {"size", 0, "WxH", "pixels (default 512x512): to 65536 a side, 67108864 in all"},
    [OPT_LAYERS] = {"layers", 0, "L", "color,gbuffer,split,irradiance or all (default)"},
    [OPT_POINTS] = {"points", 0, "F.npy", "irradiance at points, no image: rows x y z nx ny nz"},
    [OPT_SEED]   = {"seed", 0, "S", "of the random numbers (default 0)"},
    [OPT_TIME]   = {"time", 0, "T", "time of animations, s (default 0)"},
    [OPT_FRAMES] = {"frames", 0, "A:B",
                    "frames A to B; # in names is the number, else .0000 is added"},
    [OPT_FPS]    = {"fps", 0, "F", "of --frames, a second (default 24)"},
    [OPT_STATS]  = {"stats", 0, "F.json", "write rays, samples, seconds, memory"},
    [OPT_DUMP]   = {"dump", 0, "DIR", "write every stage as arrays into a new folder"},
    [OPT_THREADS] = {"threads", 0, "N", "0: one a processor (default); never changes a bit"},
    [OPT_MEMORY]  = CLI_MEMORY_OPTION,
    [OPT_QUIET]   = {"quiet", 'q', NULL, "no progress, no warnings"},
    [OPT_HELP]    = {"help", 'h', NULL, "this text"},
    CLI_SCENE_OPTIONS,
    {0}};

static const char *add_param(cli_render_request *request, const char *name, size_t length,
                             const char *value)
{
    if (request->param_count == CLI_MAX_PARAMS) {
        return "too many parameters";
    }
    if (length >= sizeof request->names[0]) {
        return "the parameter's name is too long";
    }
    /* Flags are spelled with '-', the names in the table with '_'. */
    char *copy = request->names[request->param_count];
    for (size_t i = 0; i < length; i++) {
        copy[i] = name[i] == '-' ? '_' : name[i];
    }
    copy[length]                                = '\0';
    request->params[request->param_count].name  = copy;
    request->params[request->param_count].value = value;
    request->param_count++;
    return NULL;
}

static const char *take_param(cli_render_request *request, const char *value)
{
    const char *equals = strchr(value, '=');
    return equals ? add_param(request, value, (size_t)(equals - value), equals + 1)
                  : "takes NAME=VALUE";
}

static bool is_param(const assay_method_info *method, const char *name)
{
    for (const assay_param_desc *p = method->params; p->name; p++) {
        size_t i = 0;
        while (p->name[i] && p->name[i] == (name[i] == '-' ? '_' : name[i])) {
            i++;
        }
        if (!p->name[i] && !name[i]) {
            return true;
        }
    }
    return false;
}

/* Which method it will be is not known yet: a parameter of any of them will do. */
static const char *take_unknown(void *user, const char *name, const char *value)
{
    for (int i = 0; i < assay_method_count(); i++) {
        const assay_method_info method = assay_method_at(i);
        if (is_param(&method, name)) {
            return value ? add_param(user, name, strlen(name), value) : "a value is missing";
        }
    }
    return "unknown option";
}

static const char *take_number(cli_render_request *request, int index, const char *value)
{
    const char        *problem = NULL;
    unsigned long long seed    = 0;
    switch (index) {
    case OPT_EXPOSURE:
        request->has_exposure = true;
        problem               = cli_read_real(value, &request->exposure);
        return problem || fabs(request->exposure) > 1000.0 ? "takes stops from -1000 to 1000"
                                                           : NULL;
    case OPT_SIZE:
        request->has_size = true;
        return cli_read_size(value, &request->render.width, &request->render.height);
    case OPT_SEED:
        problem              = cli_read_seed(value, &seed);
        request->render.seed = seed;
        return problem;
    case OPT_TIME: request->has_time = true; return cli_read_real(value, &request->time);
    case OPT_FRAMES:
        request->has_frames = true;
        return cli_read_range(value, &request->first_frame, &request->last_frame);
    case OPT_FPS:
        request->has_fps = true;
        problem          = cli_read_real(value, &request->fps);
        return problem || !(request->fps > 0.0) ? "takes a number > 0" : NULL;
    case OPT_THREADS:
        problem = cli_read_count(value, 0, 1024, &request->threads);
        return problem ? "takes a whole number from 0 to 1024" : NULL;
    case OPT_MEMORY: return cli_read_bytes(value, &request->memory_limit);
    default: break;
    }
    cli_scene_option(&request->scene_options, OPTIONS[index].name, value, &problem);
    return problem;
}

static const char *take(void *user, int index, const char *value)
{
    cli_render_request *request = user;
    switch (index) {
    case OPT_METHOD: request->method = value; return NULL;
    case OPT_PARAM: return take_param(request, value);
    case OPT_OUTPUT: request->output = value; return NULL;
    case OPT_PNG: request->png = value; return NULL;
    case OPT_CAMERA: request->render.camera = value; return NULL;
    case OPT_LAYERS: request->render.layers = value; return NULL;
    case OPT_POINTS: request->points = value; return *value ? NULL : "takes the name of a file";
    case OPT_STATS: request->stats = value; return NULL;
    case OPT_DUMP: request->dump = value; return NULL;
    case OPT_QUIET: request->quiet = true; return NULL;
    case OPT_HELP: request->help = true; return NULL;
    default: break;
    }
    if (index >= 0) {
        return take_number(request, index, value);
    }
    if (request->scene) {
        return "one scene at a time";
    }
    request->scene = value;
    return NULL;
}

void cli_render_request_help(const cli_render_request *request)
{
    printf("usage: assay render SCENE.gltf -o OUT.exr [-m METHOD] [-p K=V ...] ...\n");
    cli_print_options(OPTIONS);
    for (int i = 0; i < assay_method_count(); i++) {
        const assay_method_info method = assay_method_at(i);
        if (strcmp(method.name, request->method) == 0) {
            printf("\nParameters of the method `%s` (assay methods tells more):\n", method.name);
            for (const assay_param_desc *p = method.params; p->name; p++) {
                printf("      --%-24s (default %s)\n", p->name, p->default_value);
            }
        }
    }
}

/* An option that would change nothing is a misunderstanding; NULL where there is none. */
static const char *check_use(const cli_render_request *r)
{
    const struct {
        bool        idle;
        const char *problem;
    } uses[] = {
        {r->points && (r->png || r->dump), "--points makes a table alone: no --png, no --dump"},
        {r->points && r->render.camera, "--points looks through no camera: no --camera"},
        {r->points && r->has_size, "--points makes no image: no --size"},
        {r->points && r->render.layers, "--points makes no image: no --layers"},
        {r->has_frames && r->has_time, "--frames and --time: both say when"},
        {r->has_fps && !r->has_frames, "--fps without --frames does nothing"},
        {r->has_exposure && !r->png, "--exposure without --png does nothing"},
    };
    for (size_t i = 0; i < sizeof uses / sizeof uses[0]; i++) {
        if (uses[i].idle) {
            return uses[i].problem;
        }
    }
    return cli_scene_check(&r->scene_options);
}

/* What the options say together; NULL, or what is wrong. */
static const char *check_together(const cli_render_request *r)
{
    const char *layers = r->render.layers;
    if (!r->scene || !*r->scene) {
        return "no scene given";
    }
    if (!r->output) {
        return "no output given: -o OUT.exr";
    }
    if (strcmp(r->output, "-") == 0 || (r->png && strcmp(r->png, "-") == 0)) {
        return "images do not go to standard output; give the name of a file";
    }
    if (r->png && layers && !strstr(layers, "color") && !strstr(layers, "all")) {
        return "--png shows the colour: --layers must have color in it";
    }
    const char *names[] = {r->output, r->png, r->stats, r->dump};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < i; j++) {
            if (names[i] && names[j] && strcmp(names[i], names[j]) == 0 &&
                !cli_is_device(names[i])) {
                return "two outputs have the same name";
            }
        }
    }
    return check_use(r);
}

bool cli_render_request_parse(int count, char **argv, cli_render_request *request)
{
    *request = (cli_render_request){.method        = "path",
                                    .scene_options = cli_scene_request_default(),
                                    .render        = assay_render_options_default(),
                                    .fps           = 24.0};
    if (!cli_parse("render", count, argv, OPTIONS, take, take_unknown, request)) {
        return false;
    }
    const char *problem = request->help ? NULL : check_together(request);
    return !problem ||
           cli_complain("render", "%s (assay render --help lists the options)", problem);
}

bool cli_frame_name(const cli_render_request *request, const char *pattern, long frame, char *out,
                    size_t size)
{
    const char *hash = strrchr(pattern, '#');
    int         used;
    if (!request->has_frames || strcmp(pattern, "-") == 0 || cli_is_device(pattern)) {
        used = snprintf(out, size, "%s", pattern);
    } else if (hash) {
        const char *start = hash;
        while (start > pattern && start[-1] == '#') {
            start--;
        }
        used = snprintf(out, size, "%.*s%0*ld%s", (int)(start - pattern), pattern,
                        (int)(hash - start + 1), frame, hash + 1);
    } else {
        const char *slash = strrchr(pattern, '/');
        const char *dot   = strrchr(slash ? slash : pattern, '.');
        const int   stem  = dot ? (int)(dot - pattern) : (int)strlen(pattern);
        used = snprintf(out, size, "%.*s.%04ld%s", stem, pattern, frame, dot ? dot : "");
    }
    return used >= 0 && (size_t)used < size;
}
