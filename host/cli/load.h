/* load.h: from the target on the command line to an image. */
#ifndef CLI_LOAD_H
#define CLI_LOAD_H

#include <stdbool.h>
#include <sys/stat.h>

#include "host/base/exit.h"
#include "host/derive/image_make.h"
#include "host/lang/builtin.h"
#include "host/lang/model.h"

/* === the test for two names of the same file ================================================== */

/* Do these describe the same file? Device and inode decide. If an inode is 0 (some network file systems and WASI), the
 * resolved paths are compared. */
bool files_are_one(const struct stat *one, const char *path, const struct stat *other,
                   const char *other_path);

/* Are both the same file, by name or, if they exist, by identity? */
bool files_same(const char *one, const char *other);

/* Is the output, or a file that a command may write beside it, the same as the other one? The other one is an input, or
 * an output with files beside it. */
bool files_meet(const char *output, const char *other, bool is_input);

/* === a file, or a built-in model ============================================================== */

/* A .whirl file, or the only built-in model that has the target. Free with source_close(). */
typedef struct source_model {
    const char *file; /* the file's name in messages */
    char *text;       /* owned; NULL if nothing was read, or for source_builtin() */
    char *path;       /* owned */
    char *name;       /* owned: the name after the ':', or the built-in name; "" without a name */
    whirl_model *model;
    diags *errors;
} source_model;

/* `target` is FILE, FILE:NAME, or a built-in SCENE, MECHANISM or MECHANISM:SCENE. Prints errors; returns an exit status. */
int source_open(source_model *source, const char *target);
/* The only one of the built-in models [count] with the target SCENE, MECHANISM or MECHANISM:SCENE. An unknown or ambiguous
 * target is reported. Returns an exit status; call source_close() in any case. */
int source_find(source_model *source, const struct builtin_model *models, size_t count,
                const char *target);
/* Opens a built-in model without a name. False: reported. */
bool source_builtin(source_model *source, const struct builtin_model *model);
void source_close(source_model *source);

/* The existing file of a target FILE or FILE:NAME, "/dev/stdin" for "-"; NULL if there is none. The caller frees it. */
char *source_file(const char *target);

/* The scene, or the mechanism (scene NULL), of `source->name`. Without a name: with `prefer_scene` the file's only
 * scene, else its only mechanism. Returns an exit status. */
int source_pick(source_model *source, bool prefer_scene, const mechanism **of, const scene **in);

typedef struct load_request {
    image_settings settings;
    image_use use;
    bool hints;          /* print a hint for a valid model that could be written better */
    bool conserve;       /* recover the coordinates that the scene names from their momentum */
    const char *comment; /* begins each line about contacts in `contacts`; NULL: no such lines */
} load_request;

typedef struct loaded {
    image *image;
    instance *instance; /* equations have their own instance */
    equations *equations;
    char *contacts; /* contacts in words, whole lines; "" without contacts, or if not requested */
} loaded;

/* Derive one instance to its image; errors are printed. Returns an exit status; call unload() in any case. */
int load(loaded *made, source_model *source, const mechanism *of, const scene *in,
         const overrides *changes, const load_request *request);
/* Warn of values that float cannot represent. */
void say_float_range(const image *im);
void unload(loaded *made);

/* The whole of `path` in memory ("-" is standard input), NUL-terminated; NULL, reported, if it cannot be read or has more
 * than `most` bytes. */
char *read_all(const char *path, size_t most, size_t *length);
#define RECORDS_BYTES_MAX ((size_t)1 << 30) /* longer records are refused */

#endif
