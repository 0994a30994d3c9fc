/* console.c - progress, warnings, errors and Ctrl-C.
 *
 * Ctrl-C asks the library to stop, and the library removes what it had begun to write.  Only from
 * two seconds later on a second one ends the process at once: a signal often comes twice, as from
 * timeout(1), which sends it to the process and to its group. */
#include "console.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* A signal handler can reach nothing but a global. */
static volatile sig_atomic_t interrupted;

enum { GRACE_SECONDS = 2 };
static const int STOP_SIGNALS[] = {SIGINT, SIGTERM, SIGHUP};
enum { STOP_SIGNAL_COUNT = sizeof STOP_SIGNALS / sizeof STOP_SIGNALS[0] };

static void end_grace(int number)
{
    (void)number;
    for (int i = 0; i < STOP_SIGNAL_COUNT; i++) {
        signal(STOP_SIGNALS[i], SIG_DFL);
    }
}

static void handle_stop(int number)
{
    (void)number;
    if (!interrupted) {
        interrupted = 1;
        alarm(GRACE_SECONDS);
    }
}

static void listen_to_signals(void)
{
    for (int i = 0; i < STOP_SIGNAL_COUNT; i++) {
        /* nohup(1) says so by ignoring SIGHUP. */
        if (signal(STOP_SIGNALS[i], handle_stop) == SIG_IGN && STOP_SIGNALS[i] == SIGHUP) {
            signal(SIGHUP, SIG_IGN);
        }
    }
    signal(SIGALRM, end_grace);
    /* Writing then fails with an error that is told, and what was begun is removed. */
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

bool cli_console_stopped(void) { return interrupted != 0; }

void cli_console_clear(cli_console *console)
{
    if (console->bar_drawn) {
        fputs("\r\033[K", stderr);
        console->bar_drawn = false;
    }
}

/* File names may hold anything; a message stays one line. */
static void print_line(const char *command, const char *kind, const char *text)
{
    char line[2048];
    snprintf(line, sizeof line, "%s", text);
    for (char *c = line; *c; c++) {
        if ((unsigned char)*c < ' ' || *c == 127) {
            *c = '?';
        }
    }
    fprintf(stderr, "assay %s: %s%s\n", command, kind, line);
}

static void print_log(void *user, assay_log_level level, const char *line)
{
    cli_console *console = user;
    if (!console->quiet) {
        cli_console_clear(console);
        print_line(console->command, level == ASSAY_LOG_WARNING ? "warning: " : "", line);
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

bool cli_complain(const char *command, const char *format, ...)
{
    char    text[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    print_line(command, "", text);
    return false;
}

assay_context *cli_console_open(cli_console *console, const char *command, bool quiet, int threads,
                                uint64_t memory_limit)
{
    *console = (cli_console){
        .command = command, .quiet = quiet, .terminal = isatty(STDERR_FILENO), .last_percent = -1};
    const assay_context_options options = {.threads      = threads,
                                           .log          = print_log,
                                           .progress     = show_progress,
                                           .user         = console,
                                           .memory_limit = memory_limit};
    assay_context              *context = NULL;
    const assay_status          status  = assay_context_create(&options, &context);
    if (status != ASSAY_OK) {
        cli_complain(command, "%s", assay_status_text(status));
        return NULL;
    }
    listen_to_signals();
    return context;
}

int cli_console_finish(cli_console *console, const assay_context *context, assay_status status)
{
    cli_console_clear(console);
    if (status != ASSAY_OK && !console->said) {
        const char *reason = assay_context_error(context);
        cli_complain(console->command, "%s", *reason ? reason : assay_status_text(status));
    }
    return assay_status_exit_code(status);
}

assay_status cli_write_text(cli_console *console, assay_context *context, const char *path,
                            const char *text)
{
    if (strcmp(path, "-") != 0) {
        return assay_text_write(context, path, text);
    }
    if (puts(text) >= 0 && fflush(stdout) == 0) {
        return ASSAY_OK;
    }
    console->said = true;
    cli_complain(console->command, "standard output: %s", strerror(errno));
    return ASSAY_ERR_WRITE;
}
