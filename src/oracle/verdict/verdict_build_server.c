/* verdict_build_server.c - a verdict as JUnit XML, and as GitHub's workflow commands.
 *
 * Invariant: whatever the names hold, the XML is well-formed (characters that XML 1.0 does not
 * have, and bytes that are no UTF-8, become '?') and an annotation stays one line. */
#include <string.h>

#include "oracle/verdict/verdict_data.h"

/* ---- JUnit ---- */

/* Bytes of the UTF-8 sequence at s, 0 where it is none, or one that XML has no character for. */
static size_t utf8_length(const unsigned char *s)
{
    if (s[0] < 0x80) {
        return s[0] >= 0x20 || s[0] == '\t' || s[0] == '\n' || s[0] == '\r' ? 1 : 0;
    }
    const size_t n = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
    if (s[0] < 0xc2 || s[0] > 0xf4) {
        return 0;
    }
    for (size_t i = 1; i < n; i++) {
        if ((s[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    const bool overlong  = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xf0 && s[1] < 0x90);
    const bool surrogate = s[0] == 0xed && s[1] >= 0xa0;
    const bool beyond    = s[0] == 0xf4 && s[1] >= 0x90;
    const bool no_char   = s[0] == 0xef && s[1] == 0xbf && s[2] >= 0xbe;
    return overlong || surrogate || beyond || no_char ? 0 : n;
}

static void add_xml(assay_text_builder *text, const char *value)
{
    const unsigned char *s = (const unsigned char *)value;
    while (*s) {
        const size_t n = utf8_length(s);
        if (n == 1 && strchr("<>&\"'\t\n\r", *s)) {
            assay_text_add(text, "&#%d;", *s);
        } else if (n > 0) {
            assay_text_add(text, "%.*s", (int)n, (const char *)s);
        } else {
            assay_text_add_char(text, '?');
        }
        s += n > 0 ? n : 1;
    }
}

static void add_attribute(assay_text_builder *text, const char *name, const char *value)
{
    assay_text_add(text, " %s=\"", name);
    add_xml(text, value);
    assay_text_add_char(text, '"');
}

/* A finding's sentences, or another text of it, made by itself so that it can be escaped. */
typedef void (*finding_text)(assay_text_builder *text, const assay_finding *finding);

static char *make_text(assay_text_builder *into, finding_text make, const assay_finding *finding)
{
    assay_text_builder part = assay_text_start(into->context);
    char              *text = NULL;
    make(&part, finding);
    if (assay_text_finish(&part, "a verdict's text", &text) != ASSAY_OK) {
        into->failed = true;
    }
    return text;
}

static void add_name_and_place(assay_text_builder *text, const assay_finding *finding)
{
    assay_finding_add_name(text, finding);
    assay_finding_add_place(text, finding);
}

static void add_case(assay_text_builder *text, const assay_finding *f)
{
    char *name      = make_text(text, assay_finding_add_name, f);
    char *sentences = make_text(text, assay_finding_add_sentences, f);
    if (name && sentences) {
        assay_text_add(text, "    <testcase");
        add_attribute(text, "classname", f->stage);
        add_attribute(text, "name", name);
        if (f->kind == ASSAY_VERDICT_PASS) {
            assay_text_add(text, ">\n      <system-out>");
            add_xml(text, sentences);
            assay_text_add(text, "</system-out>\n    </testcase>\n");
        } else {
            const char *element = f->kind == ASSAY_VERDICT_FAIL ? "failure" : "error";
            assay_text_add(text, ">\n      <%s", element);
            add_attribute(text, "type", assay_verdict_kind_text(f->kind));
            add_attribute(text, "message", sentences);
            assay_text_add(text, "/>\n    </testcase>\n");
        }
    }
    assay_text_destroy(text->context, name);
    assay_text_destroy(text->context, sentences);
}

/* Findings of a stage, or of all for NULL. */
static size_t count(const assay_verdict *v, const char *stage, int kind)
{
    size_t found = 0;
    for (size_t i = 0; i < v->count; i++) {
        const assay_finding *f = &v->findings[i];
        found += (!stage || strcmp(f->stage, stage) == 0) && (kind < 0 || (int)f->kind == kind);
    }
    return found;
}

static void add_counts(assay_text_builder *text, const assay_verdict *v, const char *stage,
                       size_t skipped)
{
    assay_text_add(text, " tests=\"%zu\" failures=\"%zu\" errors=\"%zu\"",
                   count(v, stage, -1) + skipped, count(v, stage, ASSAY_VERDICT_FAIL),
                   count(v, stage, ASSAY_VERDICT_CANNOT_TELL));
    if (skipped > 0) {
        assay_text_add(text, " skipped=\"%zu\"", skipped);
    }
}

static void add_suite(assay_text_builder *text, const assay_verdict *v, const char *stage)
{
    assay_text_add(text, "  <testsuite");
    add_attribute(text, "name", stage);
    add_counts(text, v, stage, 0);
    assay_text_add(text, ">\n");
    for (size_t i = 0; i < v->count; i++) {
        if (strcmp(v->findings[i].stage, stage) == 0) {
            add_case(text, &v->findings[i]);
        }
    }
    assay_text_add(text, "  </testsuite>\n");
}

/* What a verdict on a bundle says nothing of, by the names of settings. */
static const char *const UNSEEN[] = {"blind", "not judged", "missing"};
enum { UNSEEN_COUNT = sizeof UNSEEN / sizeof UNSEEN[0] };

static size_t count_unseen(const assay_verdict *v)
{
    size_t found = 0;
    for (int i = 0; i < UNSEEN_COUNT; i++) {
        found += assay_verdict_get(v, UNSEEN[i]) != NULL;
    }
    return found;
}

static void add_unseen(assay_text_builder *text, const assay_verdict *v)
{
    const size_t found = count_unseen(v);
    if (found == 0) {
        return;
    }
    assay_text_add(text,
                   "  <testsuite name=\"unseen\" tests=\"%zu\" failures=\"0\" errors=\"0\" "
                   "skipped=\"%zu\">\n",
                   found, found);
    for (int i = 0; i < UNSEEN_COUNT; i++) {
        const char *names = assay_verdict_get(v, UNSEEN[i]);
        if (names) {
            assay_text_add(text, "    <testcase classname=\"unseen\" name=\"%s\">\n      <skipped",
                           UNSEEN[i]);
            add_attribute(text, "message", names);
            assay_text_add(text, "/>\n    </testcase>\n");
        }
    }
    assay_text_add(text, "  </testsuite>\n");
}

static bool first_of_stage(const assay_verdict *v, size_t index)
{
    for (size_t i = 0; i < index; i++) {
        if (strcmp(v->findings[i].stage, v->findings[index].stage) == 0) {
            return false;
        }
    }
    return true;
}

/* A verdict without findings is one error: nothing was tested. */
static void add_nothing(assay_text_builder *text)
{
    assay_text_add(text, "  <testsuite name=\"verify\" tests=\"1\" failures=\"0\" errors=\"1\">\n"
                         "    <testcase classname=\"verify\" name=\"verify\">\n"
                         "      <error type=\"cannot tell\" message=\"nothing was tested\"/>\n"
                         "    </testcase>\n  </testsuite>\n");
}

assay_status assay_verdict_junit(const assay_verdict *verdict, char **text_out)
{
    assay_text_builder text = assay_text_start(verdict->context);
    assay_text_add(&text, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites");
    add_attribute(&text, "name", verdict->candidate);
    if (verdict->count > 0) {
        add_counts(&text, verdict, NULL, count_unseen(verdict));
    } else {
        assay_text_add(&text, " tests=\"%zu\" failures=\"0\" errors=\"1\"",
                       1 + count_unseen(verdict));
    }
    assay_text_add(&text, ">\n");
    if (verdict->count == 0) {
        add_nothing(&text);
    }
    for (size_t i = 0; i < verdict->count; i++) {
        if (first_of_stage(verdict, i)) {
            add_suite(&text, verdict, verdict->findings[i].stage);
        }
    }
    add_unseen(&text, verdict);
    assay_text_add(&text, "</testsuites>\n");
    return assay_text_finish(&text, "a verdict's JUnit XML", text_out);
}

/* ---- GitHub ---- */

/* As its runner decodes it: in properties ':' and ',' have a meaning, too. */
static void add_command_text(assay_text_builder *text, const char *value, bool property)
{
    for (const char *c = value; *c; c++) {
        if (strchr(property ? "%\r\n:," : "%\r\n", *c)) {
            assay_text_add(text, "%%%02X", (unsigned)(unsigned char)*c);
        } else {
            assay_text_add_char(text, *c);
        }
    }
}

static void add_annotation(assay_text_builder *text, const assay_verdict *v, const assay_finding *f)
{
    char *title     = make_text(text, add_name_and_place, f);
    char *sentences = make_text(text, assay_finding_add_sentences, f);
    if (title && sentences) {
        assay_text_add(text, "::%s file=", f->kind == ASSAY_VERDICT_FAIL ? "error" : "warning");
        add_command_text(text, v->candidate, true);
        assay_text_add(text, ",title=");
        add_command_text(text, f->stage, true);
        assay_text_add(text, "%%3A ");
        add_command_text(text, title, true);
        assay_text_add(text, "::");
        add_command_text(text, sentences, false);
        assay_text_add_char(text, '\n');
    }
    assay_text_destroy(text->context, title);
    assay_text_destroy(text->context, sentences);
}

assay_status assay_verdict_annotations(const assay_verdict *verdict, char **text_out)
{
    assay_text_builder text = assay_text_start(verdict->context);
    if (verdict->count == 0) {
        assay_text_add(&text, "::warning title=verify::nothing was tested\n");
    }
    for (size_t i = 0; i < verdict->count; i++) {
        if (verdict->findings[i].kind != ASSAY_VERDICT_PASS) {
            add_annotation(&text, verdict, &verdict->findings[i]);
        }
    }
    return assay_text_finish(&text, "a verdict's annotations", text_out);
}
