/* emit_settings.c: for the project's own build: scenes with every setting of `whirl price`, as C, and their state
 * hashes (tests/settings_hashes.sh). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/base/atomic_file.h"
#include "host/emit/emit.h"
#include "host/engine/start.h"
#include "host/fixed/c_fixed.h"
#include "host/fixed/engine_fixed.h"
#include "host/number/decimal.h"
#include "host/study/trial.h"
#include "load.h"
#include "scenes.h"

/* The number types: each has a list of hashes, with its name. Float and double are built from the same C. */
typedef enum kind_of { OF_FLOAT, OF_DOUBLE, OF_FIXED, KINDS } kind_of;
static const engine_kind *const kinds[KINDS] = {&engine_float, &engine_double, &engine_fixed};

/* Most words of an axis. */
enum { WORDS = 40 };

typedef struct emission {
    const char *folder;
    uint64_t steps; /* at most so many */
    int every;      /* one of so many settings of a scene is written, */
    int seen; /* counted through all scenes, so that each gets others; also every one with a new
               * word */
    const char *word[AXES][WORDS];
    FILE *hashes[KINDS];
    FILE *settings; /* NAME SCENE OPTIONS OF `whirl run` without float and double..., and the events
                   * of the run in float */
} emission;

/* Is one of its words new on its axis? */
static bool has_new_word(emission *to, const setting *s) {
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

/* A scene's C or its header; the plan is NULL except for fixed point. False: reported. */
static bool write_code(const emission *to, const image *im, const fixed_plan *plan,
                       const char *file, bool header) {
    FILE *out = scenes_open(to->folder, im->name, header ? ".h" : ".c");
    if (out == NULL) {
        return false;
    }
    if (plan != NULL) {
        (header ? c_fixed_header : c_fixed)(out, plan, file);
    } else {
        (header ? emit_c_header : emit_c)(out, im, file);
    }
    (void)atomic_file_close(out, to->folder, true);
    return true;
}

static bool write_both(const emission *to, const image *im, const fixed_plan *plan,
                       const char *file) {
    return write_code(to, im, plan, file, false) && write_code(to, im, plan, file, true);
}

/* The same in fixed point, if it has such a step: few settings have one, so all are written. */
static bool write_fixed(const emission *to, image *im, const setting *s, int number,
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

static bool write_setting(const emission *to, image *im, const setting *s, int number,
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

static int write_scene(emission *to, source_model *from, const mechanism *of, const scene *in,
                       const char *target) {
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

static int write_target(emission *to, const char *target) {
    source_model from;
    const mechanism *of;
    const scene *in;
    int code = source_open(&from, target);
    code = code == EXIT_DONE ? source_pick(&from, true, &of, &in) : code;
    code = code == EXIT_DONE ? write_scene(to, &from, of, in, target) : code;
    source_close(&from);
    return code;
}

static bool open_lists(emission *to) {
    bool good = true;
    for (int i = 0; i < KINDS; i++) {
        to->hashes[i] = scenes_open(to->folder, kinds[i]->name, ".hashes");
        good = good && to->hashes[i] != NULL;
    }
    to->settings = scenes_open(to->folder, "settings", ".txt");
    return good && to->settings != NULL;
}

static void close_lists(emission *to) {
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
    emission to = {.folder = words[0]};
    bool good = count >= 4 && count % 2 == 0;
    for (int i = 1; i < count && good; i += i == 1 ? 1 : 2) {
        good = whole_number(words[i]) > 0;
    }
    if (!good) {
        fputs(
            "usage: whirl emit-settings FOLDER STEPS EVERY SCENE|FILE[:SCENE] [EVERY SCENE ...]\n",
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
