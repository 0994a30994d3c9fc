/* writer_json.c - the document as text: one short line an object, in the order of its indices.
 *
 * Invariant: the text depends on nothing but the document (the C locale's decimal point is the
 * program's default and is never changed). */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "writer_document.h"

/* ---- small pieces ---- */

static void put_number(FILE *f, double value) { fprintf(f, "%.9g", value + 0.0); }

static void put_numbers(FILE *f, const char *key, const double *values, int count)
{
    fprintf(f, "\"%s\": [", key);
    for (int i = 0; i < count; i++) {
        fputs(i ? ", " : "", f);
        put_number(f, values[i]);
    }
    fputc(']', f);
}

static void put_bounds(FILE *f, const char *key, const float *values, int count)
{
    double wide[4];
    for (int i = 0; i < count; i++) {
        wide[i] = (double)values[i];
    }
    fputs(", ", f);
    put_numbers(f, key, wide, count);
}

static void end_line(FILE *f, size_t index, size_t count)
{
    fputs(index + 1 < count ? ",\n" : "\n", f);
}

/* Writes one element of an array of the document on a line of its own. */
typedef void (*put_element)(FILE *f, const gltf_document *d, size_t index);

/* glTF has no empty arrays: none is written for no element. */
static void put_array(FILE *f, const gltf_document *d, const char *key, size_t count,
                      put_element put)
{
    if (count) {
        fprintf(f, ",\n  \"%s\": [\n", key);
        for (size_t i = 0; i < count; i++) {
            put(f, d, i);
            end_line(f, i, count);
        }
        fputs("  ]", f);
    }
}

/* ---- extensions ---- */

static bool is_white(const gltf_material *m)
{
    return m->base_color[0] == 1.0 && m->base_color[1] == 1.0 && m->base_color[2] == 1.0;
}

static void put_extensions_used(FILE *f, const gltf_document *d)
{
    static const char *const names[6] = {
        "KHR_lights_punctual",    "KHR_materials_emissive_strength", "KHR_materials_ior",
        "KHR_materials_specular", "KHR_materials_transmission",      "KHR_materials_volume"};
    bool used[6] = {d->light_count > 0};
    for (size_t i = 0; i < d->material_count; i++) {
        const gltf_material *m = &d->materials[i];
        used[1] |= m->emissive_strength != 1.0;
        used[2] |= m->ior != 1.5;
        used[3] |= m->specular != 1.0;
        used[4] |= m->transmission > 0.0;
        used[5] |= m->solid;
    }
    const char *separator = ",\n  \"extensionsUsed\": [";
    for (int i = 0; i < 6; i++) {
        if (used[i]) {
            fprintf(f, "%s\"%s\"", separator, names[i]);
            separator = ", ";
        }
    }
    fputs(separator[1] == '\n' ? "" : "]", f);
}

static void put_material_extensions(FILE *f, const gltf_material *m)
{
    const char *separator = ",\n     \"extensions\": {";
    if (m->emissive_strength != 1.0) {
        fprintf(f, "%s\"KHR_materials_emissive_strength\": {\"emissiveStrength\": %.9g}", separator,
                m->emissive_strength);
        separator = ", ";
    }
    if (m->specular != 1.0) {
        fprintf(f, "%s\"KHR_materials_specular\": {\"specularFactor\": %.9g}", separator,
                m->specular);
        separator = ", ";
    }
    if (m->ior != 1.5) {
        fprintf(f, "%s\"KHR_materials_ior\": {\"ior\": %.9g}", separator, m->ior);
        separator = ", ";
    }
    if (m->transmission > 0.0) {
        fprintf(f, "%s\"KHR_materials_transmission\": {\"transmissionFactor\": %.9g}", separator,
                m->transmission);
        separator = ", ";
    }
    if (m->solid) {
        fprintf(f, "%s\"KHR_materials_volume\": {\"thicknessFactor\": 1}", separator);
        separator = ", ";
    }
    fputs(separator[0] == ',' && separator[1] == '\n' ? "" : "}", f);
}

/* ---- objects ---- */

static void put_material(FILE *f, const gltf_document *d, size_t index)
{
    const gltf_material *m = &d->materials[index];
    fprintf(f, "    {\"name\": \"%s\", \"pbrMetallicRoughness\": {", m->name);
    if (!is_white(m)) {
        const double factor[4] = {m->base_color[0], m->base_color[1], m->base_color[2], 1.0};
        put_numbers(f, "baseColorFactor", factor, 4);
        fputs(", ", f);
    }
    fprintf(f, "\"metallicFactor\": %.9g, \"roughnessFactor\": %.9g}", m->metallic, m->roughness);
    if (m->emissive[0] + m->emissive[1] + m->emissive[2] > 0.0) {
        fputs(",\n     ", f);
        put_numbers(f, "emissiveFactor", m->emissive, 3);
    }
    fputs(m->double_sided ? ", \"doubleSided\": true" : "", f);
    put_material_extensions(f, m);
    if (m->extras) {
        fprintf(f, ",\n     \"extras\": %s", m->extras);
    }
    fputc('}', f);
}

static void put_mesh(FILE *f, const gltf_document *d, size_t index)
{
    const gltf_mesh *m = &d->meshes[index];
    fprintf(f, "    {\"name\": \"%s\", \"primitives\": [{\"attributes\": {\"POSITION\": %d",
            m->name, m->position);
    if (m->normal >= 0) {
        fprintf(f, ", \"NORMAL\": %d", m->normal);
    }
    if (m->joints >= 0) {
        fprintf(f, ", \"JOINTS_0\": %d, \"WEIGHTS_0\": %d", m->joints, m->weights);
    }
    fprintf(f, "}, \"indices\": %d, \"material\": %d", m->indices, m->material);
    if (m->morph >= 0) {
        fprintf(f, ", \"targets\": [{\"POSITION\": %d}]}], \"weights\": [%.9g]}", m->morph,
                m->morph_weight);
    } else {
        fputs("}]}", f);
    }
}

static void put_transform(FILE *f, const gltf_node *n)
{
    const double at[3] = {n->translation.x, n->translation.y, n->translation.z};
    if (n->transform == GLTF_TRS) {
        if (at[0] != 0.0 || at[1] != 0.0 || at[2] != 0.0) {
            fputs(", ", f);
            put_numbers(f, "translation", at, 3);
        }
        if (n->rotation[3] != 1.0) {
            fputs(", ", f);
            put_numbers(f, "rotation", n->rotation, 4);
        }
    } else if (n->transform == GLTF_MATRIX) {
        const assay_vec3 *a     = n->axes;
        const double      m[16] = {a[0].x, a[0].y, a[0].z, 0, a[1].x, a[1].y, a[1].z, 0,
                                   a[2].x, a[2].y, a[2].z, 0, at[0],  at[1],  at[2],  1};
        fputs(", ", f);
        put_numbers(f, "matrix", m, 16);
    }
}

static void put_children(FILE *f, const gltf_document *d, size_t parent)
{
    const char *separator = ", \"children\": [";
    for (size_t i = 0; i < d->node_count; i++) {
        if (d->nodes[i].node.parent == (int)parent) {
            fprintf(f, "%s%zu", separator, i);
            separator = ", ";
        }
    }
    fputs(separator[2] == '\0' ? "]" : "", f);
}

static void put_node(FILE *f, const gltf_document *d, size_t index)
{
    const gltf_node *n = &d->nodes[index].node;
    fprintf(f, "    {\"name\": \"%s\"", d->nodes[index].name);
    if (n->mesh >= 0) {
        fprintf(f, ", \"mesh\": %d", n->mesh);
    }
    if (n->skin >= 0) {
        fprintf(f, ", \"skin\": %d", n->skin);
    }
    if (n->camera >= 0) {
        fprintf(f, ", \"camera\": %d", n->camera);
    }
    put_transform(f, n);
    if (n->light >= 0) {
        fprintf(f, ", \"extensions\": {\"KHR_lights_punctual\": {\"light\": %d}}", n->light);
    }
    put_children(f, d, index);
    fputc('}', f);
}

static void put_camera(FILE *f, const gltf_document *d, size_t index)
{
    const gltf_camera *c = &d->cameras[index];
    if (c->yfov > 0.0) {
        fprintf(f,
                "    {\"name\": \"%s\", \"type\": \"perspective\", \"perspective\": {\"yfov\": "
                "%.9g, \"znear\": 0.01}}",
                c->name, c->yfov);
    } else {
        fprintf(f,
                "    {\"name\": \"%s\", \"type\": \"orthographic\", \"orthographic\": {\"xmag\": "
                "%.9g, \"ymag\": %.9g, \"znear\": 0.01, \"zfar\": 100}}",
                c->name, c->xmag, c->ymag);
    }
}

static void put_animation(FILE *f, const gltf_document *d)
{
    static const char *const ways[3]  = {"LINEAR", "STEP", "CUBICSPLINE"};
    static const char *const paths[4] = {"translation", "rotation", "scale", "weights"};
    fputs(",\n  \"animations\": [{\n    \"name\": \"motion\",\n    \"samplers\": [\n", f);
    for (size_t i = 0; i < d->channel_count; i++) {
        const gltf_channel *c = &d->channels[i];
        fprintf(f, "      {\"input\": %d, \"output\": %d, \"interpolation\": \"%s\"}", c->input,
                c->output, ways[c->interpolation]);
        end_line(f, i, d->channel_count);
    }
    fputs("    ],\n    \"channels\": [\n", f);
    for (size_t i = 0; i < d->channel_count; i++) {
        const gltf_channel *c = &d->channels[i];
        fprintf(f, "      {\"sampler\": %zu, \"target\": {\"node\": %d, \"path\": \"%s\"}}", i,
                c->node, paths[c->path]);
        end_line(f, i, d->channel_count);
    }
    fputs("    ]\n  }]", f);
}

static void put_skin(FILE *f, const gltf_document *d, size_t index)
{
    const gltf_skin *s = &d->skins[index];
    fprintf(f, "    {\"inverseBindMatrices\": %d, \"joints\": [", s->inverse_bind);
    for (size_t i = 0; i < s->joint_count; i++) {
        fprintf(f, "%s%d", i ? ", " : "", s->joints[i]);
    }
    fputs("]}", f);
}

/* ---- buffers ---- */

/* Index of a view among those that are not empty. */
static int view_index(const gltf_document *d, gltf_view view)
{
    int index = 0;
    for (int v = 0; v < (int)view; v++) {
        index += d->views[v].size > 0;
    }
    return index;
}

static void put_accessor(FILE *f, const gltf_document *d, size_t index)
{
    const gltf_accessor *a = &d->accessors[index];
    fprintf(f,
            "    {\"bufferView\": %d, \"byteOffset\": %zu, \"componentType\": %d, \"count\": %zu, "
            "\"type\": \"%s\"",
            view_index(d, a->view), a->offset,
            a->is_u16  ? 5123
            : a->is_u8 ? 5121
                       : 5126,
            a->count, a->type);
    if (a->bound_count) {
        put_bounds(f, "min", a->low, a->bound_count);
        put_bounds(f, "max", a->high, a->bound_count);
    }
    fputc('}', f);
}

static void put_buffer(FILE *f, const gltf_document *d)
{
    static const char *const layout[GLTF_VIEW_COUNT] = {
        ", \"byteStride\": 12, \"target\": 34962", ", \"byteStride\": 16, \"target\": 34962",
        ", \"byteStride\": 4, \"target\": 34962", "", ", \"target\": 34963"};
    size_t      offset    = 0;
    const char *separator = "";
    fputs(",\n  \"bufferViews\": [\n", f);
    for (int v = 0; v < GLTF_VIEW_COUNT; v++) {
        if (d->views[v].size) {
            fprintf(f, "%s    {\"buffer\": 0, \"byteOffset\": %zu, \"byteLength\": %zu%s}",
                    separator, offset, d->views[v].size, layout[v]);
            separator = ",\n";
            offset += d->views[v].size;
        }
    }
    fprintf(f, "\n  ],\n  \"buffers\": [{\"uri\": \"%s.bin\", \"byteLength\": %zu}]", d->name,
            offset);
}

static void put_scene(FILE *f, const gltf_document *d)
{
    fputs(",\n  \"scene\": 0,\n  \"scenes\": [{\"nodes\": [", f);
    size_t roots = 0;
    for (size_t i = 0; i < d->node_count; i++) {
        if (d->nodes[i].node.parent < 0) {
            fprintf(f, "%s%s%zu", roots ? "," : "",
                    roots % 20 ? " " : (d->node_count > 20 ? "\n    " : ""), i);
            roots++;
        }
    }
    fputs("]}]", f);
}

static void put_lights(FILE *f, const gltf_document *d)
{
    fputs(",\n  \"extensions\": {\"KHR_lights_punctual\": {\"lights\": [\n", f);
    for (size_t i = 0; i < d->light_count; i++) {
        fprintf(f, "    {\"name\": \"%s\", \"type\": \"directional\", \"intensity\": %.9g, ",
                d->lights[i].name, d->lights[i].intensity);
        put_numbers(f, "color", d->lights[i].color, 3);
        fputc('}', f);
        end_line(f, i, d->light_count);
    }
    fputs("  ]}}", f);
}

static void put_document(FILE *f, const gltf_document *d)
{
    fprintf(f,
            "{\n  \"asset\": {\"version\": \"2.0\", \"generator\": \"assay make_scenes\",\n"
            "    \"extras\": {\"description\": \"%s\"}}",
            d->description);
    put_extensions_used(f, d);
    if (d->light_count) {
        put_lights(f, d);
    }
    put_scene(f, d);
    put_array(f, d, "nodes", d->node_count, put_node);
    put_array(f, d, "cameras", d->camera_count, put_camera);
    put_array(f, d, "meshes", d->mesh_count, put_mesh);
    put_array(f, d, "materials", d->material_count, put_material);
    put_array(f, d, "skins", d->skin_count, put_skin);
    if (d->channel_count) {
        put_animation(f, d);
    }
    put_array(f, d, "accessors", d->accessor_count, put_accessor);
    put_buffer(f, d);
    fputs("\n}\n", f);
}

/* ---- files ---- */

static bool close_file(FILE *f)
{
    const bool failed = ferror(f) != 0;
    return fclose(f) == 0 && !failed;
}

bool gltf_write(const gltf_document *document, const char *directory)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", directory, document->name);
    if (mkdir(path, 0777) != 0 && errno != EEXIST) {
        return false;
    }
    snprintf(path, sizeof path, "%s/%s/%s.gltf", directory, document->name, document->name);
    FILE *f = fopen(path, "wb");
    if (!f) {
        return false;
    }
    put_document(f, document);
    if (!close_file(f)) {
        return false;
    }
    snprintf(path, sizeof path, "%s/%s/%s.bin", directory, document->name, document->name);
    f = fopen(path, "wb");
    if (!f) {
        return false;
    }
    for (int v = 0; v < GLTF_VIEW_COUNT; v++) {
        fwrite(document->views[v].bytes, 1, document->views[v].size, f);
    }
    return close_file(f);
}
