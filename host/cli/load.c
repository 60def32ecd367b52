/* load.c: finding, reading and deriving the target. */
#define _XOPEN_SOURCE 700 /* realpath() */

#include "host/cli/load.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/base/spelling.h"
#include "host/derive/lagrange.h"
#include "host/emit/emit.h"
#include "host/engine/start.h"
#include "host/lang/hints.h"
#include "host/lang/override.h"
#include "host/show/show.h"

#ifdef __wasi__ /* WASI has no full paths: returns the given name */
static char *realpath(const char *path, char *resolved) {
    (void)resolved;
    return alloc_copy(path, strlen(path));
}
#endif

bool files_are_one(const struct stat *one, const char *path, const struct stat *other,
                   const char *other_path) {
    if (one->st_ino != 0 && other->st_ino != 0) {
        return one->st_dev == other->st_dev && one->st_ino == other->st_ino;
    }
    char *resolved = realpath(path, NULL);
    char *other_resolved = realpath(other_path, NULL);
    const bool same =
        resolved != NULL && other_resolved != NULL && strcmp(resolved, other_resolved) == 0;
    free(resolved);
    free(other_resolved);
    return same;
}

/* Would two paths that do not exist yet name one file: the same name in the same folder? */
static bool is_one_place(const char *one, const char *other) {
    const char *slash[] = {strrchr(one, '/'), strrchr(other, '/')};
    const char *name = slash[0] == NULL ? one : slash[0] + 1;
    const char *other_name = slash[1] == NULL ? other : slash[1] + 1;
    char *folder = alloc_words("%.*s.", (int)(name - one), one);
    char *other_folder = alloc_words("%.*s.", (int)(other_name - other), other);
    struct stat first;
    struct stat second;
    const bool met = strcmp(name, other_name) == 0 && stat(folder, &first) == 0 &&
                     stat(other_folder, &second) == 0 &&
                     files_are_one(&first, folder, &second, other_folder);
    free(folder);
    free(other_folder);
    return met;
}

bool files_same(const char *one, const char *other) {
    struct stat first;
    struct stat second;
    const bool there = stat(one, &first) == 0;
    const bool other_there = stat(other, &second) == 0;
    return strcmp(one, other) == 0 || (!there && !other_there && is_one_place(one, other)) ||
           (there && other_there && S_ISREG(first.st_mode) &&
            files_are_one(&first, one, &second, other));
}

/* The endings of an output ("") and of the files that are written beside it. */
static const char *const beside[] = {"", ".part", ".toml", ".toml.part", ".sweep"};
enum { BESIDE = sizeof beside / sizeof beside[0] };

bool files_meet(const char *output, const char *other, bool is_input) {
    bool met = false;
    for (int i = 0; i < (is_input ? BESIDE : BESIDE * BESIDE) && !met; i++) {
        char *one = alloc_words("%s%s", output, beside[i % BESIDE]);
        char *two = alloc_words("%s%s", other, beside[i / BESIDE]);
        met = files_same(one, two);
        free(one);
        free(two);
    }
    return met;
}

/* === mechanisms and scenes ==================================================================== */

/* The parts of the target. */
typedef struct sought {
    const char *mechanism; /* [mechanism_length]; NULL: any */
    size_t mechanism_length;
    const char *name; /* name of a scene or a mechanism */
} sought;

static bool is_mechanism(const sought *w, const mechanism *m) {
    return w->mechanism == NULL || (strlen(m->name) == w->mechanism_length &&
                                    strncmp(m->name, w->mechanism, w->mechanism_length) == 0);
}

/* Finds the scene of that name, else the mechanism (*in is NULL). Returns false if there is none. */
static bool find(const sought *w, const whirl_model *m, const mechanism **of, const scene **in) {
    *of = NULL;
    *in = NULL;
    for (int i = 0; i < m->scene_count && *in == NULL; i++) {
        if (is_mechanism(w, m->scenes[i]->mechanism) && strcmp(m->scenes[i]->name, w->name) == 0) {
            *in = m->scenes[i];
            *of = m->scenes[i]->mechanism;
        }
    }
    for (int i = 0; i < m->mechanism_count && *of == NULL; i++) {
        if (is_mechanism(w, m->mechanisms[i]) && strcmp(m->mechanisms[i]->name, w->name) == 0) {
            *of = m->mechanisms[i];
        }
    }
    return *of != NULL;
}

static void say_ambiguous(const sought *w, const source_model *each, size_t count) {
    fprintf(stderr,
            "whirl: error: '%s' names more than one built-in scene or mechanism\nhint: "
            "choose one of:",
            w->name);
    for (size_t i = 0; i < count; i++) {
        const mechanism *of;
        const scene *in;
        if (find(w, each[i].model, &of, &in)) {
            fprintf(stderr, " %s:%s (%s)", of->name, w->name, each[i].file);
        }
    }
    fputc('\n', stderr);
}

static void say_unknown(const sought *w, const char *target, const source_model *each,
                        size_t count) {
    nearest search = nearest_start(w->name, strlen(w->name));
    for (size_t i = 0; i < count; i++) {
        const whirl_model *m = each[i].model;
        for (int k = 0; k < m->scene_count; k++) {
            if (is_mechanism(w, m->scenes[k]->mechanism)) {
                nearest_offer(&search, m->scenes[k]->name);
            }
        }
        for (int k = 0; k < m->mechanism_count && w->mechanism == NULL; k++) {
            nearest_offer(&search, m->mechanisms[k]->name);
        }
    }
    fprintf(stderr, "whirl: error: there is no file and no built-in scene or mechanism '%s'\n",
            target);
    if (search.best != NULL) {
        fprintf(stderr, "hint: did you mean '%s'? `whirl list` shows all\n", search.best);
    } else {
        fprintf(stderr, "hint: `whirl list` shows the built-in ones\n");
    }
}

bool source_builtin(source_model *s, const struct builtin_model *model) {
    *s = (source_model){.file = model->file, .errors = diags_new()};
    s->model = model_parse(model->file, model->text, model->length, s->errors);
    diags_flush(s->errors, stderr);
    return s->model != NULL;
}

int source_find(source_model *s, const struct builtin_model *models, size_t count,
                const char *target) {
    const char *colon = strrchr(target, ':');
    const sought w = colon == NULL ? (sought){NULL, 0, target}
                                   : (sought){target, (size_t)(colon - target), colon + 1};
    source_model *each = alloc((int64_t)count, sizeof *each);
    size_t hits = 0;
    size_t hit = 0;
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        good = source_builtin(&each[i], &models[i]) && good;
        const mechanism *of;
        const scene *in;
        if (each[i].model != NULL && find(&w, each[i].model, &of, &in)) {
            hit = i;
            hits++;
        }
    }
    if (good && hits == 0) {
        say_unknown(&w, target, each, count);
    } else if (good && hits > 1) {
        say_ambiguous(&w, each, count);
    }
    good = good && hits == 1;
    for (size_t i = 0; i < count; i++) {
        if (!good || i != hit) {
            source_close(&each[i]);
        }
    }
    *s = good ? each[hit] : (source_model){0};
    s->text = good ? alloc_words("%s", models[hit].text) : NULL;
    s->name = alloc_words("%s", w.name);
    free(each);
    return good ? EXIT_DONE : EXIT_BAD_INPUT;
}

/* === reading and deriving ===================================================================== */

char *read_all(const char *path, size_t most, size_t *length) {
    FILE *in = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    if (in == NULL) {
        fprintf(stderr, "%s: error: cannot be read: %s\n", path, strerror(errno));
        return NULL;
    }
    size_t size = 1U << 16;
    char *text = alloc((int64_t)size, 1);
    *length = 0;
    for (;;) {
        *length += fread(text + *length, 1, size - *length - 1, in);
        if (*length < size - 1 || *length > most) {
            break;
        }
        size *= 2;
        text = alloc_more(text, (int64_t)size, 1);
    }
    if (ferror(in) != 0) { /* the text is incomplete, but may still be a valid model */
        fprintf(stderr, "%s: error: cannot be read: %s\n", path, strerror(errno));
        free(text);
        text = NULL;
    } else if (*length > most) {
        fprintf(stderr, "%s:1:1: error: the text is longer than %zu bytes\n", path, most);
        free(text);
        text = NULL;
    } else {
        text[*length] = '\0';
    }
    if (in != stdin) {
        fclose(in);
    }
    return text;
}

static bool file_exists(const char *path) {
    struct stat about;
    return strcmp(path, "-") == 0 || stat(path, &about) == 0;
}

/* Length of FILE in FILE:NAME, or of the whole target. */
static size_t file_part(const char *target) {
    const char *colon = strrchr(target, ':');
    return colon == NULL || file_exists(target) ? strlen(target) : (size_t)(colon - target);
}

char *source_file(const char *target) {
    char *path = alloc_copy(target, file_part(target));
    if (strcmp(path, "-") == 0) {
        free(path);
        return alloc_words("/dev/stdin");
    }
    if (!file_exists(path)) {
        free(path);
        path = NULL;
    }
    return path;
}

int source_open(source_model *s, const char *target) {
    const size_t length = file_part(target);
    char *path = alloc_copy(target, length);
    const bool looks_like_file = strchr(path, '/') != NULL || strstr(path, ".whirl") != NULL;
    if (!file_exists(path) && !looks_like_file) {
        free(path);
        return source_find(s, builtin_models, builtin_model_count, target);
    }
    *s = (source_model){.path = path, .errors = diags_new()};
    s->file = strcmp(path, "-") == 0 ? "<standard input>" : path;
    s->name = alloc_words("%s", target[length] == ':' ? target + length + 1 : "");
    size_t bytes;
    s->text = read_all(path, MODEL_BYTES_MAX, &bytes);
    if (s->text == NULL) {
        return EXIT_BAD_INPUT;
    }
    s->model = model_parse(s->file, s->text, bytes, s->errors);
    diags_flush(s->errors, stderr);
    return s->model == NULL ? EXIT_BAD_INPUT : EXIT_DONE;
}

void source_close(source_model *s) {
    model_free(s->model);
    free(s->text);
    diags_free(s->errors);
    free(s->path);
    free(s->name);
}

/* Prints the names of the scenes, or of the mechanisms. */
static void say_choices(const source_model *s, bool scenes) {
    const whirl_model *m = s->model;
    fprintf(stderr, "hint: name one:");
    for (int i = 0; scenes && i < m->scene_count; i++) {
        fprintf(stderr, " %s:%s", s->file, m->scenes[i]->name);
    }
    for (int i = 0; i < m->mechanism_count && !(scenes && m->scene_count > 0); i++) {
        fprintf(stderr, " %s:%s", s->file, m->mechanisms[i]->name);
    }
    fprintf(stderr, "\n");
}

int source_pick(source_model *s, bool prefer_scene, const mechanism **of, const scene **in) {
    const whirl_model *m = s->model;
    const bool named = s->name[0] != '\0';
    const int scenes = prefer_scene ? m->scene_count : 0;
    if (find(&(sought){.name = s->name}, m, of, in)) {
        return EXIT_DONE;
    }
    if (!named && (scenes == 1 || (scenes == 0 && m->mechanism_count == 1))) {
        *in = scenes == 1 ? m->scenes[0] : NULL;
        *of = scenes == 1 ? m->scenes[0]->mechanism : m->mechanisms[0];
        return EXIT_DONE;
    }
    if (!named) {
        fprintf(stderr, "%s: error: the file has more than one %s\n", s->file,
                scenes > 1 ? "scene" : "mechanism");
    } else {
        fprintf(stderr, "%s: error: the file has no scene or mechanism '%s'\n", s->file, s->name);
    }
    say_choices(s, prefer_scene);
    return EXIT_BAD_INPUT;
}

static void say_hint(const instance *inst) {
    const symbol *on = NULL;
    const term *friction = hint_friction(inst, &on);
    if (friction == NULL) {
        return;
    }
    const char *name = on->name;
    fprintf(
        stderr,
        "%s:%d:%d: note: this force changes its sign with %s', so the body shakes at rest instead "
        "of sticking\nhint: write dry friction as: friction"
        " %s static EXPR kinetic EXPR normal EXPR\n",
        friction->at.source->file, friction->at.line, friction->at.column, name, name);
}

char *contacts_in_octave(const equations *e) {
    char *text;
    FILE *out = alloc_text(&text, NULL);
    show_events(out, e, EMIT_OCTAVE_COMMENT,
                "This function computes the motion between events. It does not contain:");
    alloc_text_end(out);
    return text;
}

int load(loaded *made, source_model *s, const mechanism *of, const scene *in,
         const overrides *changes, const load_request *request) {
    *made = (loaded){0};
    if (request->settings.cells != 0 && request->settings.tables == TABLES_NONE) {
        fputs("whirl: error: --cells sets the size of tables, so it needs --tables\nhint: "
              "--tables linear or --tables cubic\n",
              stderr);
        return EXIT_BAD_INPUT;
    }
    made->instance = instance_make(of, in, changes, s->errors);
    if (made->instance != NULL) {
        made->equations = equations_derive(made->instance, s->errors);
    }
    if (made->equations != NULL) {
        const bool *conserve = request->conserve ? made->equations->instance->conserve : NULL;
        made->image =
            image_make(made->equations, conserve, &request->settings, request->use, s->errors);
    }
    diags_flush(s->errors, stderr);
    if (made->image != NULL && request->hints) {
        say_hint(made->instance);
    }
    return made->image == NULL ? EXIT_BAD_INPUT : EXIT_DONE;
}

bool image_can_start(const image *im, const engine_kind *kind, diags *errors) {
    const bool can =
        start_has_method(im, im->settings.method, errors) && start_is_possible(im, kind, errors);
    diags_flush(errors, stderr);
    return can;
}

void say_float_range(const image *im) {
    const double number = image_out_of_float(im);
    if (number != 0.0) {
        fprintf(
            stderr,
            "warning: float cannot represent %.6g, a constant or an input of '%s' in SI units: quantities that "
            "depend on it are %s\n"
            "hint: float represents sizes from 1.2e-38 to 3.4e+38; choose larger or smaller "
            "units, or use --number double; (s/r)^12 is computed as s^12 times r^-12, and both must be in this range\n",
            number, im->name, fabs(number) < 1.0 ? "imprecise or zero" : "infinite");
    }
}

void unload(loaded *made) {
    image_free(made->image);
    equations_free(made->equations);
    instance_free(made->instance);
}
