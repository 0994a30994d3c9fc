/* rendered.h - a render with all that came of it: image, counts, warnings, and dumped tables. */
#ifndef ASSAY_TESTS_RENDERED_H
#define ASSAY_TESTS_RENDERED_H

#include "support/measure.h"

enum { RENDERED_MAX_SETTINGS = 40, RENDERED_TEXT = 512 };

/* What a context says while it renders. */
typedef struct {
    assay_context *context;
    int            warnings;
    char           warning[RENDERED_TEXT]; /* the last one */
} rendering;

/* The value must stay where it is until it is closed. */
void rendering_open(rendering *r, int threads);
void rendering_close(rendering *r);

typedef struct {
    assay_status       status;
    assay_image       *image;
    assay_render_stats stats;
    char               error[RENDERED_TEXT];
} rendered;

/* The settings (the first is the method), then more of them, which win; "dump", "camera", "layers",
 * "size" and "seed" may be among them. */
rendered rendered_make(rendering *r, assay_scene *scene, const setting *settings,
                       const setting *more);
void     rendered_drop(rendered *made);

/* Whether both are the same images to the bit. */
bool rendered_same(const rendered *a, const rendered *b);

/* The largest difference of a channel, in parts of its mean over both. */
double rendered_difference(const rendered *a, const rendered *b, const char *channel);

/* A folder of its own; removed with everything in it. */
char *rendered_folder(void);
void  rendered_remove(char *folder);
/* "folder/name", overwritten by the next call but three. */
const char *rendered_path(const char *folder, const char *name);

#endif
