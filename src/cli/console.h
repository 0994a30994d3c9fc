/* console.h - what the commands share: a context that talks to the terminal, and how they end. */
#ifndef ASSAY_CLI_CONSOLE_H
#define ASSAY_CLI_CONSOLE_H

#include "assay/assay.h"

/* Exit codes beside those of assay_status_exit_code. */
enum { CLI_EXIT_DIFFERENT = 1, CLI_EXIT_USAGE = 2 };

typedef struct {
    const char *command;  /* "render", for messages                             */
    bool        quiet;    /* no warnings, no progress                           */
    bool        terminal; /* stderr is one: progress bars are drawn            */
    bool        bar_drawn;
    int         last_percent;
    char        last_phase[16];
} cli_console;

/* A context with this many threads (0: all processors) that warns and shows progress on stderr, and
 * stops at Ctrl-C.  The console must outlive it.  NULL after a message. */
assay_context *cli_console_open(cli_console *console, const char *command, bool quiet, int threads);

/* Takes the progress bar off the screen, so that something can be printed. */
void cli_console_clear(cli_console *console);

/* Prints why a call failed, and gives the exit code; 0 for ASSAY_OK, silently. */
int cli_console_finish(cli_console *console, const assay_context *context, assay_status status);

/* Whether a file of this name could be written (its folder is there and writable, it is not a
 * folder itself): asked before hours are spent.  Prints what is wrong and answers false. */
bool cli_can_write(const cli_console *console, const char *path);

/* Writes a text to a file, or to stdout for "-". */
assay_status cli_write_text(assay_context *context, const char *path, const char *text);

/* The commands: arguments behind the command's name; they return the exit code. */
int cli_render(int count, char **argv);
int cli_scene(int count, char **argv);
int cli_methods(int count, char **argv);
int cli_diff(int count, char **argv);

#endif
