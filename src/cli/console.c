/* console.c - progress, warnings, errors and Ctrl-C. */
#include "console.h"

#include <errno.h>
#include <libgen.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A signal handler can reach nothing but a global. */
static volatile sig_atomic_t interrupted;

/* The first Ctrl-C asks the library to stop; the second one ends the process. */
static void handle_interrupt(int number)
{
    interrupted = 1;
    signal(number, SIG_DFL);
}

void cli_console_clear(cli_console *console)
{
    if (console->bar_drawn) {
        fputs("\r\033[K", stderr);
        console->bar_drawn = false;
    }
}

static void print_log(void *user, assay_log_level level, const char *line)
{
    cli_console *console = user;
    if (!console->quiet) {
        cli_console_clear(console);
        fprintf(stderr, "assay %s: %s%s\n", console->command,
                level == ASSAY_LOG_WARNING ? "warning: " : "", line);
    }
}

static bool show_progress(void *user, const char *phase, double fraction)
{
    enum { WIDTH = 40 };
    cli_console *console = user;
    const int    percent = (int)(fraction * 100.0);
    if (console->terminal && !console->quiet &&
        (percent != console->last_percent || strcmp(phase, console->last_phase) != 0)) {
        char bar[WIDTH + 1];
        for (int i = 0; i < WIDTH; i++) {
            bar[i] = i * 100 < percent * WIDTH ? '#' : '.';
        }
        bar[WIDTH] = '\0';
        fprintf(stderr, "\r\033[K%-8s [%s] %3d %%", phase, bar, percent);
        fflush(stderr);
        console->bar_drawn    = true;
        console->last_percent = percent;
        snprintf(console->last_phase, sizeof console->last_phase, "%s", phase);
    }
    return !interrupted;
}

assay_context *cli_console_open(cli_console *console, const char *command, bool quiet, int threads)
{
    *console = (cli_console){
        .command = command, .quiet = quiet, .terminal = isatty(STDERR_FILENO), .last_percent = -1};
    const assay_context_options options = {
        .threads = threads, .log = print_log, .progress = show_progress, .user = console};
    assay_context     *context = NULL;
    const assay_status status  = assay_context_create(&options, &context);
    if (status != ASSAY_OK) {
        fprintf(stderr, "assay %s: %s\n", command, assay_status_text(status));
        return NULL;
    }
    signal(SIGINT, handle_interrupt);
    signal(SIGTERM, handle_interrupt);
    return context;
}

int cli_console_finish(cli_console *console, const assay_context *context, assay_status status)
{
    cli_console_clear(console);
    /* What the command itself found wrong is said already. */
    if (status != ASSAY_OK && *assay_context_error(context)) {
        fprintf(stderr, "assay %s: %s\n", console->command, assay_context_error(context));
    }
    return assay_status_exit_code(status);
}

bool cli_can_write(const cli_console *console, const char *path)
{
    struct stat info;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode)) {
        fprintf(stderr, "assay %s: %s: is a folder; give the name of a file\n", console->command,
                path);
        return false;
    }
    char *copy = strdup(path);
    if (!copy) {
        return false;
    }
    const char *folder = dirname(copy);
    const bool  writable =
        access(folder, W_OK) == 0 ||
        (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && access(path, W_OK) == 0);
    if (!writable) {
        fprintf(stderr, "assay %s: %s: cannot write in folder '%s': %s\n", console->command, path,
                folder, strerror(errno));
    }
    free(copy);
    return writable;
}

assay_status cli_write_text(assay_context *context, const char *path, const char *text)
{
    if (strcmp(path, "-") != 0) {
        return assay_text_write(context, path, text);
    }
    return puts(text) < 0 || fflush(stdout) ? ASSAY_ERR_WRITE : ASSAY_OK;
}
