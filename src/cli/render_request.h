/* render_request.h - what `assay render` was asked for. */
#ifndef ASSAY_CLI_RENDER_REQUEST_H
#define ASSAY_CLI_RENDER_REQUEST_H

#include "assay/assay.h"
#include "scene_options.h"

enum { CLI_MAX_PARAMS = 64 };

typedef struct {
    const char          *scene, *method, *output, *png, *points, *stats, *dump;
    cli_scene_request    scene_options;
    assay_render_options render;
    struct {
        const char *name, *value;
    } params[CLI_MAX_PARAMS]; /* borrowed from argv or from names */
    char     names[CLI_MAX_PARAMS][64];
    int      param_count;
    double   exposure; /* stops, of the PNG */
    double   time;     /* s; where no frames are asked for */
    long     first_frame, last_frame;
    double   fps;
    long     threads;
    uint64_t memory_limit; /* bytes; 0: what the machine has */
    bool     has_size, has_exposure, has_time, has_frames, has_fps;
    bool     quiet, help;
} cli_render_request;

/* Reads the command line.  False after a message. */
bool cli_render_request_parse(int count, char **argv, cli_render_request *request);
void cli_render_request_help(const cli_render_request *request);

/* The name of a frame's file: the last run of '#' becomes the number with that many digits, else
 * ".0007" goes before the extension; without frames, and for "-" and devices, the name as it is.
 * False where it gets too long. */
bool cli_frame_name(const cli_render_request *request, const char *pattern, long frame, char *out,
                    size_t size);

#endif
