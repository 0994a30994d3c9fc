/* output_check.h - whether outputs can be written: asked before hours are spent on them.
 *
 * Each check prints what is wrong and gives the exit code for it; 0 where all is well. */
#ifndef ASSAY_CLI_OUTPUT_CHECK_H
#define ASSAY_CLI_OUTPUT_CHECK_H

#include <stdbool.h>

/* A file of this name can be written: its folder is there and writable, and what has that name now
 * may be replaced. */
int cli_check_file(const char *command, const char *path);

/* A folder of this name can be made: nothing has that name, and its parent is writable. */
int cli_check_new_folder(const char *command, const char *path);

/* The output is not the very file that is read. */
int cli_check_not_input(const char *command, const char *path, const char *input);

/* The name does not speak of another format than the option writes (".exr"). */
int cli_check_extension(const char *command, const char *option, const char *path,
                        const char *extension);

/* True for a pipe, a terminal, /dev/null: what is never replaced by a new file. */
bool cli_is_device(const char *path);

#endif
