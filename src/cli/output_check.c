/* output_check.c - stat and access; what happens between asking and writing is told by the writer.
 */
#include "output_check.h"

#include <errno.h>
#include <libgen.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "console.h"

/* Always the exit code of what cannot be written. */
static int refuse(const char *command, const char *path, const char *reason)
{
    cli_complain(command, "%s: %s", path, reason);
    return assay_status_exit_code(ASSAY_ERR_WRITE);
}

/* A mistake of the command line, whatever the machine can write. */
static int refuse_empty(const char *command)
{
    cli_complain(command, "the name of an output is empty");
    return CLI_EXIT_USAGE;
}

static int check_parent(const char *command, const char *path)
{
    struct stat info;
    char        copy[4096];
    if ((size_t)snprintf(copy, sizeof copy, "%s", path) >= sizeof copy) {
        return refuse(command, path, strerror(ENAMETOOLONG));
    }
    const char *folder = dirname(copy);
    int         error  = stat(folder, &info) == 0 ? 0 : errno;
    if (!error && !S_ISDIR(info.st_mode)) {
        error = ENOTDIR;
    }
    if (!error && access(folder, W_OK | X_OK) != 0) {
        error = errno;
    }
    if (!error) {
        return 0;
    }
    cli_complain(command, "%s: cannot write in folder '%s': %s", path, folder, strerror(error));
    return assay_status_exit_code(ASSAY_ERR_WRITE);
}

int cli_check_file(const char *command, const char *path)
{
    struct stat  info;
    const size_t length = strlen(path);
    if (length == 0) {
        return refuse_empty(command);
    }
    if ((stat(path, &info) == 0 && S_ISDIR(info.st_mode)) || path[length - 1] == '/') {
        return refuse(command, path, "is a folder; give the name of a file");
    }
    if (access(path, F_OK) == 0 && access(path, W_OK) != 0) {
        return refuse(command, path, strerror(errno));
    }
    return cli_is_device(path) ? 0 : check_parent(command, path);
}

int cli_check_new_folder(const char *command, const char *path)
{
    struct stat info;
    if (!*path) {
        return refuse_empty(command);
    }
    if (lstat(path, &info) == 0) {
        return refuse(command, path, "is there already; a bundle replaces nothing");
    }
    return check_parent(command, path);
}

int cli_check_not_input(const char *command, const char *path, const char *input)
{
    struct stat a, b;
    if (stat(path, &a) != 0 || stat(input, &b) != 0 || !S_ISREG(a.st_mode) ||
        a.st_dev != b.st_dev || a.st_ino != b.st_ino) {
        return 0;
    }
    cli_complain(command, "%s: is an input; give another name for the output", path);
    return CLI_EXIT_USAGE;
}

int cli_check_extension(const char *command, const char *option, const char *path,
                        const char *extension)
{
    static const char *const OTHERS[] = {".exr", ".png",  ".npy",  ".json", ".jpg",
                                         ".hdr", ".jpeg", ".gltf", ".glb"};
    const char              *slash    = strrchr(path, '/');
    const char              *dot      = strrchr(slash ? slash : path, '.');
    for (size_t i = 0; dot && i < sizeof OTHERS / sizeof OTHERS[0]; i++) {
        if (strcasecmp(dot, OTHERS[i]) == 0 && strcasecmp(dot, extension) != 0) {
            cli_complain(command, "%s %s: the file will be %s; name it so", option, path,
                         extension);
            return CLI_EXIT_USAGE;
        }
    }
    return 0;
}

bool cli_is_device(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}
