/* load.h: the steps from the command line's target to an image. */
#ifndef CLI_LOAD_H
#define CLI_LOAD_H

#include <stdbool.h>
#include <sys/stat.h>

#include "host/base/exit.h"
#include "host/engine/engine.h"
#include "host/image/image_make.h"
#include "host/lang/builtin.h"
#include "host/lang/model.h"

/* === the test for two names of the same file ================================================== */

/* Are these the same file? Compares device and inode, or paths if an inode is 0 (WASI, some network file systems). */
bool files_are_one(const struct stat *one, const char *path, const struct stat *other,
                   const char *other_path);

/* Returns true if the two names are equal or lead to one regular file. The file need not exist. */
bool files_same(const char *one, const char *other);

/* Returns true if `output`, OUTPUT.part, OUTPUT.toml or OUTPUT.sweep is the file `other`. If `is_input` is false, the
 * files OTHER.part, OTHER.toml and OTHER.sweep count as `other`. */
bool files_meet(const char *output, const char *other, bool is_input);

/* === a file, or a built-in model ============================================================== */

/* A .whirl file or a built-in model, to be closed with source_close(). */
typedef struct source_model {
    const char *file; /* the file's name in messages */
    char *text;       /* owned; NULL if nothing was read, or for source_builtin() */
    char *path;       /* owned */
    char *name;       /* owned: the name after ':', or the built-in name; "" if there is none */
    whirl_model *model;
    diags *errors;
} source_model;

/* `target` is FILE, FILE:NAME, or a built-in SCENE, MECHANISM or MECHANISM:SCENE. Returns an exit status (reported). */
int source_open(source_model *source, const char *target);
/* Opens the one of models[count] that has the scene or mechanism `target`. If none or several of the models have
 * `target`, returns EXIT_BAD_INPUT (reported). Always call source_close(). */
int source_find(source_model *source, const struct builtin_model *models, size_t count,
                const char *target);
/* Returns false after an error (reported). */
bool source_builtin(source_model *source, const struct builtin_model *model);
void source_close(source_model *source);

/* Returns the file of a target FILE or FILE:NAME, or "/dev/stdin" for "-". Returns NULL if the file does not exist.
 * The caller frees the text. */
char *source_file(const char *target);

/* Finds the scene named `source->name`. If no scene has the name, finds the mechanism, and *in is NULL. If the name is
 * "", finds the only scene if `prefer_scene` is true and the file has scenes. Otherwise "" finds the only mechanism.
 * Returns an exit status (reported). */
int source_pick(source_model *source, bool prefer_scene, const mechanism **of, const scene **in);

typedef struct load_request {
    image_settings settings;
    image_use use;
    bool hints;    /* print a hint for a valid model that could be written better */
    bool scene;    /* if the target has no name, target_load() prefers a scene to a mechanism */
    bool conserve; /* recover the coordinates named by `conserve` from their momenta */
} load_request;

typedef struct loaded {
    image *image;
    instance *instance; /* owned; `equations` point to it */
    equations *equations;
} loaded;

/* Derives the equations of an instance and makes its image. Returns an exit status (reported); call unload() in any case. */
int load(loaded *made, source_model *source, const mechanism *of, const scene *in,
         const overrides *changes, const load_request *request);
/* Returns the argument `contacts` of emit_octave(): a comment on the contacts. The caller frees it. */
char *contacts_in_octave(const equations *e);
/* Can a run start with the image's method and this number type? If not, reports the reasons. */
bool image_can_start(const image *im, const engine_kind *kind, diags *errors);
/* Warns of values that float cannot represent. */
void say_float_range(const image *im);
void unload(loaded *made);

/* Returns the content of `path` ("-": standard input), NUL-terminated; the caller frees it. Returns NULL (reported) if
 * reading fails, or if the content is longer than `most` bytes. */
char *read_all(const char *path, size_t most, size_t *length);
#define RECORDS_BYTES_MAX ((size_t)1 << 30) /* longer records are refused */

#endif
