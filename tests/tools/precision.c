/* precision.c: `precision SCENE... ` measures how far each method is off, by step, for the chart of work against precision
 * (mk/price/precision.sh). Lines on standard output:
 *
 *     error SCENE INPUTS METHOD SUMS STEP_US ERROR       of the whole state, SI, worst of four times over 2 s
 *     reference SCENE INPUTS ERROR                       how far two references are apart
 *
 * INPUTS is `steady` or `jumping`: then every input jumps each 2 ms, and steps divide these. SUMS is float, compensated or
 * double. The reference is Richardson's extrapolation of two fine runs by RK4 in double; the other one the same by the 3/8 rule.
 * ERROR is `inf` where a step was refused.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/derive/image_make.h"
#include "host/derive/lagrange.h"
#include "host/lang/builtin.h"
#include "host/run/engine.h"
#include "host/run/start.h"

#define UNTIL_S 2.0
#define HOLD_S 2e-3 /* between jumps */
enum { TIMES = 4, VALUES = 3 * IMAGE_COMPONENTS_MAX, FINE = 32768 };

typedef struct subject {
    char *text;
    whirl_model *model;
    const scene *scene;
    diags *errors;
} subject;

typedef struct manner {
    wh_method method;
    bool compensated;
    const engine_kind *kind;
    bool jumping;
    unsigned steps; /* in UNTIL_S */
} manner;

static char *text_of(const char *file) {
    FILE *in = fopen(file, "r");
    char *text = calloc(1, 1 << 16);
    if (in == NULL || text == NULL || fread(text, 1, (1 << 16) - 1, in) == 0) {
        fprintf(stderr, "precision: error: %s: cannot be read\n", file);
        exit(2);
    }
    fclose(in);
    return text;
}

static bool found(subject *s, const char *file, const char *text, const char *name) {
    s->errors = diags_new();
    s->model = model_parse(file, text, strlen(text), s->errors);
    for (int i = 0; s->model != NULL && i < s->model->scene_count; i++) {
        if (strcmp(s->model->scenes[i]->name, name) == 0) {
            s->scene = s->model->scenes[i];
            return true;
        }
    }
    model_free(s->model);
    diags_free(s->errors);
    return false;
}

/* SCENE of a built-in file, or FILE:SCENE. */
static subject subject_of(const char *word) {
    subject s = {NULL, NULL, NULL, NULL};
    const char *colon = strrchr(word, ':');
    if (colon != NULL) {
        char *file = strndup(word, (size_t)(colon - word));
        s.text = text_of(file);
        if (found(&s, file, s.text, colon + 1)) {
            free(file);
            return s;
        }
    }
    for (size_t i = 0; colon == NULL && i < builtin_model_count; i++) {
        if (found(&s, builtin_models[i].file, builtin_models[i].text, word)) {
            return s;
        }
    }
    fprintf(stderr, "precision: error: there is no scene %s\n", word);
    exit(2);
}

/* Numbers from -1 to 1 that scatter: the same for every step. */
static double scattered(unsigned hold, int input) {
    uint64_t x = (hold + 1U) * UINT64_C(0x9E3779B97F4A7C15) + (uint64_t)input;
    x = (x ^ x >> 31) * UINT64_C(0xBF58476D1CE4E5B9);
    return ldexp((double)(x >> 11), -52) - 1.0;
}

/* The states at TIMES moments, value[TIMES][VALUES]; how many components, or 0 where a step or the method is refused. */
static int walk(const subject *s, manner how, double (*value)[VALUES]) {
    char step[64];
    snprintf(step, sizeof step, "%.17g", UNTIL_S / how.steps);
    const overrides changes = {.step = step};
    const image_settings settings = {.method = how.method, .compensated = how.compensated};
    diags *errors = diags_new();
    instance *inst = instance_make(s->scene->mechanism, s->scene, &changes, errors);
    equations *e = inst != NULL ? equations_derive(inst, errors) : NULL;
    image *im =
        e != NULL ? image_make(e, s->scene->conserve, &settings, IMAGE_TO_RUN, errors) : NULL;
    int count = 0;
    if (im != NULL && start_has_method(im, how.method, errors)) {
        const unsigned holds = (unsigned)lround(UNTIL_S / HOLD_S);
        void *run = how.kind->start(im);
        count = im->angles + im->reals;
        for (unsigned i = 0; i < how.steps && count > 0; i++) {
            for (int k = 0; k < im->inputs && how.jumping && i % (how.steps / holds) == 0; k++) {
                how.kind->set_input(
                    run, k, im->input[k].value * (1.0 + scattered(i / (how.steps / holds), k)));
            }
            count = how.kind->step(run) == WH_OK ? count : 0;
            for (unsigned t = 0; t < TIMES && count > 0; t++) {
                if (i + 1 == how.steps * (t + 1) / TIMES) {
                    how.kind->state(run, value[t], value[t] + im->angles);
                }
            }
        }
        how.kind->stop(run);
    }
    image_free(im);
    equations_free(e);
    instance_free(inst);
    diags_free(errors);
    return count;
}

static double distance(int count, double (*a)[VALUES], double (*b)[VALUES]) {
    double worst = 0.0;
    for (unsigned t = 0; t < TIMES; t++) {
        double sum = 0.0;
        for (int i = 0; i < count; i++) {
            sum = hypot(sum, a[t][i] - b[t][i]);
        }
        worst = fmax(worst, sum);
    }
    return count > 0 && isfinite(worst) ? worst : (double)INFINITY;
}

static int extrapolated(const subject *s, manner how, double (*value)[VALUES]) {
    static double coarse[TIMES][VALUES];
    const unsigned fine = how.jumping ? 32000 : FINE;
    how.steps = fine / 2;
    int count = walk(s, how, coarse);
    how.steps = fine;
    count = count > 0 ? walk(s, how, value) : 0;
    for (unsigned t = 0; t < TIMES; t++) {
        for (int i = 0; i < count; i++) {
            value[t][i] += (value[t][i] - coarse[t][i]) / 15.0;
        }
    }
    return count;
}

static void measure(const char *word, bool jumping) {
    static double exact[TIMES][VALUES];
    static double other[TIMES][VALUES];
    const subject s = subject_of(word);
    const char *name = s.scene->name;
    const char *inputs = jumping ? "jumping" : "steady";
    manner how = {WH_RK4, true, &engine_double, jumping, 0};
    int count = extrapolated(&s, how, exact);
    how.method = WH_RK38;
    count = count > 0 ? extrapolated(&s, how, other) : 0;
    printf("reference %s %s %.3g\n", name, inputs, distance(count, exact, other));
    for (int k = 0; k < 3 * WH_METHODS; k++) {
        static const char *const sums[] = {"float", "compensated", "double"};
        how = (manner){(wh_method)(k / 3), k % 3 == 1, k % 3 == 2 ? &engine_double : &engine_float,
                       jumping, 0};
        for (int i = 0; i < (jumping ? 16 : 17); i++) {
            how.steps =
                jumping ? 1000U * ((unsigned)i + 1) : (unsigned)(4 * lround(8.0 * exp2(0.5 * i)));
            const int had = walk(&s, how, other);
            if (had == 0 && i == 16) {
                break;
            }
            printf("error %s %s %s %s %.6g %.4g\n", name, inputs, wh_methods[how.method].word,
                   sums[k % 3], 1e6 * UNTIL_S / how.steps, distance(had, exact, other));
        }
    }
    model_free(s.model);
    diags_free(s.errors);
    free(s.text);
}

int main(int count, char **words) {
    if (count < 2) {
        fputs("usage: precision SCENE|FILE:SCENE[@jumping]...\n", stderr);
        return 2;
    }
    for (int i = 1; i < count; i++) {
        char *at = strchr(words[i], '@');
        const bool jumping = at != NULL && strcmp(at, "@jumping") == 0;
        if (at != NULL) {
            *at = '\0';
        }
        measure(words[i], jumping);
        fflush(stdout);
    }
    return 0;
}
