/* console.h - what the commands share: a context that talks to the terminal, and how they end. */
#ifndef ASSAY_CLI_CONSOLE_H
#define ASSAY_CLI_CONSOLE_H

#include "assay/assay.h"

/* Exit codes beside those of assay_status_exit_code. */
enum { CLI_EXIT_DIFFERENT = 1, CLI_EXIT_USAGE = 2 };

typedef struct {
    const char *command;  /* "render", for messages                             */
    bool        quiet;    /* no warnings, no progress                           */
    bool        terminal; /* stderr is one: progress bars are drawn             */
    bool        said;     /* what is wrong is printed already                   */
    bool        bar_drawn;
    int         last_percent;
    char        last_phase[16];
} cli_console;

/* A context with this many threads (0: all processors) and this limit of memory (0: what the
 * machine has, as in assay_context_options) that warns and shows progress on stderr, and stops at
 * Ctrl-C.  The console must outlive it.  NULL after a message. */
assay_context *cli_console_open(cli_console *console, const char *command, bool quiet, int threads,
                                uint64_t memory_limit);

/* Whether Ctrl-C was pressed: asked between steps that show no progress. */
bool cli_console_stopped(void);

/* Takes the progress bar off the screen, so that something can be printed. */
void cli_console_clear(cli_console *console);

/* Prints `assay COMMAND: ...` as one line on stderr, whatever the arguments hold.  Always false. */
bool cli_complain(const char *command, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Prints why a call failed, unless the command said so itself, and gives the exit code; 0 for
 * ASSAY_OK, silently. */
int cli_console_finish(cli_console *console, const assay_context *context, assay_status status);

/* Writes a text to a file, or to stdout for "-". */
assay_status cli_write_text(cli_console *console, assay_context *context, const char *path,
                            const char *text);

/* The commands: arguments behind the command's name; they return the exit code. */
int cli_render(int count, char **argv);
int cli_scene(int count, char **argv);
int cli_methods(int count, char **argv);
int cli_diff(int count, char **argv);
int cli_report(int count, char **argv);
int cli_replay(int count, char **argv);
int cli_basis(int count, char **argv);
int cli_verify(int count, char **argv);

#endif
