/* scenes.c: for the project's own build: every built-in scene, or every scene of some files, as C, and its state hash. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/emit/emit.h"
#include "host/engine/engine.h"
#include "host/engine/loop.h"
#include "host/engine/start.h"
#include "host/fixed/c_fixed.h"
#include "host/fixed/engine_fixed.h"
#include "host/lang/builtin.h"
#include "host/number/decimal.h"
#include "host/os/atomic_file.h"
#include "host/show/show.h"
#include "host/study/trial.h"

/* === every scene ============================================================================== */
/* The common part of the commands of the project's own build: files in a folder, and lines of hashes. */

/* Both are called for each scene: the first with its equations (NULL: no call), the second with its image. They return
 * an exit status. */
typedef int equations_visitor(void *context, const char *file, const loaded *made);
typedef int image_visitor(void *context, const char *file, const image *im);

typedef struct visit {
    equations_visitor *equations;
    image_visitor *image;
    void *context;
} visit;

/* Visits every scene of an opened source, also after a refused one, and frees its model. Returns an exit code. */
static int each_scene_of(source_model *from, const visit *v) {
    static const load_wish wish = {.settings = IMAGE_SETTINGS_DEFAULT,
                                   .use = IMAGE_TO_WRITE,
                                   .keep = KEEP_EQUATIONS,
                                   .conserve = true,
                                   .comment = EMIT_OCTAVE_COMMENT};
    const int count = from->model->scene_count;
    const char *file = from->file;
    image **made = alloc(count, sizeof(image *));
    int code = EXIT_DONE;
    for (int k = 0; k < count; k++) {
        const scene *in = from->model->scenes[k];
        loaded each;
        int one = load(&each, from, in->mechanism, in, NULL, &wish);
        if (one == EXIT_DONE && v->equations != NULL) {
            one = v->equations(v->context, file, &each);
        }
        if (one == EXIT_DONE) { /* made[] keeps the image */
            made[k] = each.image;
            each.image = NULL;
        }
        unload(&each);
        code = one > code ? one : code;
    }
    source_forget(from);
    for (int k = 0; k < count; k++) {
        const int one = made[k] != NULL ? v->image(v->context, file, made[k]) : EXIT_DONE;
        code = one > code ? one : code;
        image_free(made[k]);
    }
    free(made);
    return code;
}

/* The scenes of the files, or, without files, every built-in one. Returns an exit code. */
static int each_scene(int files, char **file, const visit *v) {
    int code = EXIT_DONE;
    for (int i = 0; i < files && code == EXIT_DONE; i++) {
        source_model from;
        code = source_open(&from, file[i]);
        code = code == EXIT_DONE ? each_scene_of(&from, v) : code;
        source_close(&from);
    }
    for (size_t i = 0; files == 0 && i < builtin_model_count && code == EXIT_DONE; i++) {
        const struct builtin_model *b = &builtin_models[i];
        source_model from = {.file = b->file, .errors = diags_new()};
        from.model = model_parse(b->file, b->text, b->length, from.errors);
        diags_flush(from.errors, stderr);
        code = from.model == NULL ? EXIT_BAD_INPUT : each_scene_of(&from, v);
        source_close(&from);
    }
    return code;
}

/* The file FOLDER/NAME + ending, to write; NULL, reported. */
static FILE *scenes_open(const char *folder, const char *name, const char *ending) {
    char path[1024];
    if (snprintf(path, sizeof path, "%s/%s%s", folder, name, ending) >= (int)sizeof path) {
        fprintf(stderr, "%s: error: the path is too long\n", folder);
        return NULL;
    }
    FILE *out = fopen(path, "w");
    if (out == NULL) {
        write_error_say(path);
    }
    return out;
}

/* Writes a scene's C or header; the plan is NULL except for fixed point. False: reported. */
static bool write_code(const char *folder, const image *im, const fixed_plan *plan,
                       const char *file, bool header) {
    FILE *out = scenes_open(folder, im->name, header ? ".h" : ".c");
    if (out == NULL) {
        return false;
    }
    if (plan != NULL) {
        (header ? c_fixed_header : c_fixed)(out, plan, file);
    } else {
        (header ? emit_c_header : emit_c)(out, im, file);
    }
    (void)atomic_file_close(out, folder, true);
    return true;
}

typedef struct emission {
    const char *folder;
    FILE *declarations;
    FILE *index;
    bool all_forms; /* also write text, LaTeX, Octave and the runs' hashes */
} emission;

/* Writes the scene's run as a line with the hash of its last state: "WHAT NAME steps N hash 0x... ok". Returns the events. */
static uint64_t scenes_write_hash(FILE *out, const char *what, const engine_kind *kind,
                                  const image *im) {
    void *run = kind->start(im);
    const wh_status status = loop_steps(kind, run, im->steps);
    fprintf(out, "%s %s steps %" PRIu64 " hash 0x%016" PRIx64 " %s\n", what, im->name,
            kind->steps(run), kind->hash(run), wh_status_text(status));
    uint64_t overruns;
    const uint64_t events = kind->events(run, &overruns);
    kind->stop(run);
    return events;
}

/* Writes the forms of a file's scene that need the equations, and Octave's. */
static int emit_equations(void *context, const char *file, const loaded *made) {
    const emission *to = context;
    FILE *out = scenes_open(to->folder, made->image->name, ".txt");
    if (out == NULL) {
        return EXIT_RUN_FAILED;
    }
    show_text(out, made->equations);
    show_latex(out, made->equations);
    if (made->image->recovered == 0) {
        emit_octave(out, made->image, file, made->contacts);
    }
    (void)atomic_file_close(out, to->folder, true);
    return EXIT_DONE;
}

/* Writes the hashes of the runs of a file's scene. */
static int emit_hashes(const emission *to, const image *im) {
    FILE *out = scenes_open(to->folder, im->name, ".hash");
    if (out == NULL) {
        return EXIT_RUN_FAILED;
    }
    (void)scenes_write_hash(out, "scene", &engine_float, im);
    (void)scenes_write_hash(out, "double", &engine_double, im);
    (void)atomic_file_close(out, to->folder, true);
    return EXIT_DONE;
}

static int emit_image(void *context, const char *file, const image *im) {
    const emission *to = context;
    if (to->all_forms) {
        const int code = emit_hashes(to, im);
        if (code != EXIT_DONE) {
            return code;
        }
    }
    if (!write_code(to->folder, im, NULL, file, false) ||
        !write_code(to->folder, im, NULL, file, true)) {
        return EXIT_RUN_FAILED;
    }
    fprintf(to->declarations, "extern const wh_scene %s;\n", im->name);
    fprintf(to->index, "    &%s,\n", im->name);
    return EXIT_DONE;
}

int command_emit_scenes(int count, char **words) {
    if (count < 1) {
        fputs("usage: whirl emit-scenes FOLDER [FILE ...]\n", stderr);
        return EXIT_BAD_INPUT;
    }
    emission to = {.folder = words[0], .all_forms = count > 1};
    to.declarations = scenes_open(to.folder, "scenes", ".h");
    to.index = scenes_open(to.folder, "scenes", ".c");
    int code = to.declarations == NULL || to.index == NULL ? EXIT_RUN_FAILED : EXIT_DONE;
    if (code == EXIT_DONE) {
        fputs(
            "/* " EMIT_BANNER " from the built-in models: do not edit. */\n"
            "#ifndef GEN_SCENES_H\n#define GEN_SCENES_H\n\n#include \"core/scene.h\"\n\n"
            "#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n"
            "extern const wh_scene *const wh_scenes[];\nextern const unsigned wh_scene_count;\n\n",
            to.declarations);
        fputs("/* " EMIT_BANNER " from the built-in models: do not edit. */\n"
              "#include \"scenes.h\"\n\nconst wh_scene *const wh_scenes[] = {\n",
              to.index);
        const visit all = {to.all_forms ? emit_equations : NULL, emit_image, &to};
        code = each_scene(count - 1, words + 1, &all);
        fputs("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n", to.declarations);
        fputs("};\n\nconst unsigned wh_scene_count = sizeof wh_scenes / sizeof wh_scenes[0];\n",
              to.index);
    }
    if (to.declarations != NULL) {
        (void)atomic_file_close(to.declarations, to.folder, true);
    }
    if (to.index != NULL) {
        (void)atomic_file_close(to.index, to.folder, true);
    }
    return code;
}

static int hash_one(void *context, const char *file, const image *im) {
    (void)context;
    (void)file;
    (void)scenes_write_hash(stdout, "scene", &engine_float, im);
    return EXIT_DONE;
}

int command_hashes(int count, char **words) {
    (void)words;
    if (count != 0) {
        fputs("usage: whirl hashes\n", stderr);
        return EXIT_BAD_INPUT;
    }
    return each_scene(0, NULL, &(visit){.image = hash_one});
}

/* === every setting ============================================================================ */
/* For the project's own build: scenes with every setting of `whirl price`, as C, and their state
 * hashes (tests/settings_hashes.sh). */

/* The number types: each has a list of hashes, with its name. Float and double are built from the same C. */
typedef enum kind_of { OF_FLOAT, OF_DOUBLE, OF_FIXED, KINDS } kind_of;
static const engine_kind *const kinds[KINDS] = {&engine_float, &engine_double, &engine_fixed};

/* Most words of an axis. */
enum { WORDS = 40 };

typedef struct settings_emission {
    const char *folder;
    uint64_t steps; /* most steps of a run */
    int every;      /* writes every `every`-th setting, and each with a new word */
    int seen;       /* settings counted over all scenes, so that each scene gets others */
    const char *word[AXES][WORDS];
    FILE *hashes[KINDS];
    FILE *settings; /* rows: NAME SCENE, options of `whirl run` but not --number float, the events
                   * of the run in float */
} settings_emission;

static bool has_new_word(settings_emission *to, const setting *s) {
    bool has = false;
    for (int axis = 0; axis < AXES; axis++) {
        const char *word = setting_word(s, (setting_axis)axis);
        int i = 0;
        while (i < WORDS && to->word[axis][i] != NULL && strcmp(to->word[axis][i], word) != 0) {
            i++;
        }
        if (i == WORDS || to->word[axis][i] == NULL) {
            has = true;
            to->word[axis][i < WORDS ? i : 0] = word;
        }
    }
    return has;
}

static bool write_both(const settings_emission *to, const image *im, const fixed_plan *plan,
                       const char *file) {
    return write_code(to->folder, im, plan, file, false) &&
           write_code(to->folder, im, plan, file, true);
}

/* Writes the scene in fixed point, if it has a step in fixed point. Few settings have one, so all are written. */
static bool write_fixed(const settings_emission *to, image *im, const setting *s, int number,
                        const char *file, const char *target) {
    char options[SETTING_TEXT];
    diags *unsaid = diags_new();
    fixed_plan *plan = fixed_plan_make(im, false, unsaid);
    diags_free(unsaid);
    if (plan == NULL) {
        return true;
    }
    char *name = alloc_words("%s_%d_fixed", im->name, number);
    im->name = name;
    im->fixed = plan;
    (void)scenes_write_hash(to->hashes[OF_FIXED], "scene", kinds[OF_FIXED], im);
    fprintf(to->settings, "%s %s%s --number fixed events 0\n", name, target,
            setting_options(s, false, options));
    const bool done = write_both(to, im, plan, file);
    im->fixed = NULL;
    fixed_plan_free(plan);
    free(name);
    return done;
}

static bool write_setting(const settings_emission *to, image *im, const setting *s, int number,
                          const source_model *from, const char *target) {
    char options[SETTING_TEXT];
    char *name = alloc_words("%s_%d", im->name, number);
    fprintf(to->settings, "%s %s%s", name, target, setting_options(s, false, options));
    im->name = name;
    const uint64_t events = scenes_write_hash(to->hashes[OF_FLOAT], "scene", kinds[OF_FLOAT], im);
    (void)scenes_write_hash(to->hashes[OF_DOUBLE], "scene", kinds[OF_DOUBLE], im);
    fprintf(to->settings, " events %llu\n", (unsigned long long)events);
    const bool done = write_both(to, im, NULL, from->file);
    free(name);
    return done;
}

/* The image with these settings, or NULL if the scene does not support them. Other errors are reported in *good. */
static image *image_with(const equations *e, const setting *s, source_model *from, bool *good) {
    diags *unsaid = diags_new();
    image *im = image_make(e, e->instance->conserve, &s->image, IMAGE_TO_WRITE,
                           setting_may_be_refused(&s->image) ? unsaid : from->errors);
    diags_free(unsaid);
    *good = im != NULL || setting_may_be_refused(&s->image);
    if (im != NULL && (!start_has_method(im, WH_METHOD_DEFAULT, from->errors) ||
                       !start_angles_are_held(im, from->errors))) {
        *good = false;
    }
    diags_flush(from->errors, stderr);
    return im;
}

static int write_scene(settings_emission *to, source_model *from, const mechanism *of,
                       const scene *in, const char *target) {
    const load_wish wish = {.settings = IMAGE_SETTINGS_DEFAULT,
                            .use = IMAGE_TO_WRITE,
                            .keep = KEEP_EQUATIONS,
                            .conserve = true,
                            .comment = NULL};
    loaded made;
    int code = load(&made, from, of, in, NULL, &wish);
    for (int i = 0; code == EXIT_DONE && i < setting_count(); i++) {
        const setting s = setting_at(i);
        bool good = true;
        image *im =
            s.number == kinds[OF_FLOAT] ? image_with(made.equations, &s, from, &good) : NULL;
        if (good && im != NULL && setting_is_own(&s, im)) {
            const char *name = im->name;
            im->steps = im->steps < to->steps ? im->steps : to->steps;
            good = write_fixed(to, im, &s, i, from->file, target);
            im->name = name;
            const bool in_turn = to->seen++ % to->every == 0;
            const bool taken = has_new_word(to, &s) || in_turn;
            good = good && (!taken || write_setting(to, im, &s, i, from, target));
        }
        image_free(im);
        code = good ? EXIT_DONE : EXIT_RUN_FAILED;
    }
    unload(&made);
    return code;
}

static int write_target(settings_emission *to, const char *target) {
    source_model from;
    const mechanism *of;
    const scene *in;
    int code = source_open(&from, target);
    code = code == EXIT_DONE ? source_pick(&from, true, &of, &in) : code;
    code = code == EXIT_DONE ? write_scene(to, &from, of, in, target) : code;
    source_close(&from);
    return code;
}

static bool open_lists(settings_emission *to) {
    bool good = true;
    for (int i = 0; i < KINDS; i++) {
        to->hashes[i] = scenes_open(to->folder, kinds[i]->name, ".hashes");
        good = good && to->hashes[i] != NULL;
    }
    to->settings = scenes_open(to->folder, "settings", ".txt");
    return good && to->settings != NULL;
}

static void close_lists(settings_emission *to) {
    for (int i = 0; i < KINDS; i++) {
        if (to->hashes[i] != NULL) {
            (void)atomic_file_close(to->hashes[i], to->folder, true);
        }
    }
    if (to->settings != NULL) {
        (void)atomic_file_close(to->settings, to->folder, true);
    }
}

static int whole_number(const char *word) {
    const char *rest;
    const double value = decimal_read(word, &rest);
    return rest != word && *rest == '\0' && value >= 1.0 && value <= 1e9 ? (int)value : 0;
}

int command_emit_settings(int count, char **words) {
    settings_emission to = {.folder = words[0]};
    bool good = count >= 4 && count % 2 == 0;
    for (int i = 1; i < count && good; i += i == 1 ? 1 : 2) {
        good = whole_number(words[i]) > 0;
    }
    if (!good) {
        fputs(
            "usage: whirl emit-settings FOLDER STEPS INTERVAL SCENE|FILE[:SCENE] [INTERVAL SCENE ...]\n",
            stderr);
        return EXIT_BAD_INPUT;
    }
    to.steps = (uint64_t)whole_number(words[1]);
    int code = open_lists(&to) ? EXIT_DONE : EXIT_RUN_FAILED;
    for (int i = 2; i < count && code == EXIT_DONE; i += 2) {
        to.every = whole_number(words[i]);
        code = write_target(&to, words[i + 1]);
    }
    close_lists(&to);
    return code;
}
