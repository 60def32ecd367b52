/* load.h: from what the user named to an image. */
#ifndef COMMANDS_LOAD_H
#define COMMANDS_LOAD_H

#include "host/base/exit.h"
#include "host/derive/image_make.h"
#include "host/lang/builtin.h"
#include "host/lang/model.h"

/* === a built-in scene or mechanism by its name ================================================ */

/* Look for `target`, SCENE, MECHANISM or MECHANISM:SCENE, in models [count]. *found is then parsed (free with
 * model_free()), *from is its entry, and *name, within `target`, what source_pick() shall look for.
 * Returns an exit code; what is wrong (unknown, or in more than one model) is said on standard error. */
int find_builtin(const struct builtin_model *models, size_t count, const char *target,
                 diags *errors, whirl_model **found, const struct builtin_model **from,
                 const char **name);

/* A .whirl file, or the one built-in model that has what was named. Free with source_close(). */
typedef struct source_model {
    const char *file; /* as in messages */
    char *text;       /* owned; NULL for a built-in model */
    char *path;       /* owned */
    char *name; /* owned: what was named behind the ':', or the built-in name; "" if nothing */
    whirl_model *model;
    diags *errors;
} source_model;

/* `target` is FILE, FILE:NAME, or a built-in SCENE, MECHANISM or MECHANISM:SCENE. On failure the errors
 * have been printed; returns an exit code. */
int source_open(source_model *source, const char *target);
void source_close(source_model *source);
/* Nothing asks the model any more: frees it and its text; names and errors stay until source_close(). */
void source_forget(source_model *source);

/* Would writing the file `path` + `ending` write over the model, by whatever name or link it
 * goes? Then that is said, with the option that asked for it. `path` may be NULL or "-": no
 * file. */
bool source_would_be_lost(const source_model *source, const char *option, const char *path,
                          const char *ending);

/* What `source->name` means: a scene, or a mechanism (scene NULL). Nothing named: with
 * `prefer_scene` the file's only scene, else its only mechanism. Returns an exit code. */
int source_pick(source_model *source, bool prefer_scene, const mechanism **of, const scene **in);

/* What is kept beside an image: it needs neither, but text and LaTeX are printed from the equations, and a sweep makes
 * more instances like the first. */
typedef enum load_keep { KEEP_IMAGE, KEEP_INSTANCE, KEEP_EQUATIONS } load_keep;

typedef struct load_wish {
    image_settings settings;
    image_use use;
    load_keep keep;
    bool conserve; /* the coordinates that the scene names are recovered from their momentum */
    const char *comment; /* contacts in words: begins each line of them; NULL: not wished */
} load_wish;

typedef struct loaded {
    image *image;
    instance *instance;   /* NULL unless it is kept; equations have theirs */
    equations *equations; /* NULL unless they are kept */
    char *hint;           /* of what is no error, but has a better way; or NULL */
    char *contacts;       /* in words, whole lines; "" without any, and unless it was wished */
} loaded;

/* Derive one instance to its image; errors are printed. What is not kept is freed; whoever needs the model no more
 * calls source_forget(). Returns an exit code; unload() in any case. */
int load(loaded *made, source_model *source, const mechanism *of, const scene *in,
         const overrides *changes, const load_wish *wish);
/* On standard error: the hint. */
void say_hints(const loaded *made);
/* Warns of what a run in float has no room for. */
void say_float_range(const image *im);
void unload(loaded *made);

/* The whole of `path` in memory ("-" is standard input), with a zero byte behind; NULL, reported. */
char *read_all(const char *path, size_t *length);

#endif
