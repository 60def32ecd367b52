
#include "derived.h"

#include "host/emit/emit.h"
#include "host/engine/engine.h"
#include "host/lang/builtin.h"
#include "host/show/show.h"

const image_settings plainly = IMAGE_SETTINGS_DEFAULT;

static const scene *scene_called(const whirl_model *m, const char *name) {
    for (int i = 0; i < m->scene_count; i++) {
        if (strcmp(m->scenes[i]->name, name) == 0) {
            return m->scenes[i];
        }
    }
    return NULL;
}

static const mechanism *mechanism_called(const whirl_model *m, const char *name) {
    for (int i = 0; i < m->mechanism_count; i++) {
        if (strcmp(m->mechanisms[i]->name, name) == 0) {
            return m->mechanisms[i];
        }
    }
    return NULL;
}

/* Derives the mechanism `name`, or the first if `name` is NULL. Takes ownership of `all`. */
static derived derive_model(whirl_model *m, const char *name, diags *all) {
    derived d = {.model = m};
    if (m != NULL) {
        const scene *in = name == NULL ? NULL : scene_called(m, name);
        const mechanism *of = in != NULL     ? in->mechanism
                              : name == NULL ? m->mechanisms[0]
                                             : mechanism_called(m, name);
        d.instance = instance_make(of, in, NULL, all);
        d.equations = d.instance == NULL ? NULL : equations_derive(d.instance, all);
        d.image = d.equations == NULL ? NULL
                                      : image_make(d.equations, in == NULL ? NULL : in->conserve,
                                                   &plainly, IMAGE_TO_RUN, all);
    }
    size_t size = 0;
    FILE *out = open_memstream(&d.errors, &size);
    TEST_ASSERT_NOT_NULL(out);
    diags_flush(all, out);
    fclose(out);
    diags_free(all);
    /* a derivation fails if and only if it reports an error */
    TEST_ASSERT_TRUE_MESSAGE((d.image == NULL) == (strstr(d.errors, "error: ") != NULL), d.errors);
    return d;
}

const char *report_of_text(const char *text) {
    static char report[REPORT_OF_TEXT_SIZE];
    diags *all = diags_new();
    whirl_model *read = model_parse("x.whirl", text, strlen(text), all);
    FILE *out = fmemopen(report, sizeof report, "w");
    TEST_ASSERT_NOT_NULL(out);
    report[0] = '\0';
    diags_flush(all, out);
    fclose(out);
    diags_free(all);
    model_free(read);
    return report;
}

derived derived_text(const char *text) {
    diags *all = diags_new();
    return derive_model(model_parse("t.whirl", text, strlen(text), all), NULL, all);
}

derived derived_scene(const char *text, const char *name) {
    diags *all = diags_new();
    return derive_model(model_parse("t.whirl", text, strlen(text), all), name, all);
}

derived derived_file(const char *path) {
    FILE *in = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, path);
    char *text = calloc(1, 1 << 16);
    TEST_ASSERT_NOT_NULL(text);
    const size_t length = fread(text, 1, (1 << 16) - 1, in);
    fclose(in);
    diags *all = diags_new();
    derived d = derive_model(model_parse(path, text, length, all), NULL, all);
    d.text = text;
    return d;
}

int each_builtin_scene(scene_check *check) {
    int sum = 0;
    for (size_t i = 0; i < builtin_model_count; i++) {
        const struct builtin_model *b = &builtin_models[i];
        diags *errors = diags_new();
        whirl_model *in = model_parse(b->file, b->text, b->length, errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(in, b->file);
        for (int k = 0; k < in->scene_count; k++) {
            sum += check(in->scenes[k]);
        }
        model_free(in);
        diags_free(errors);
    }
    return sum;
}

derived derived_builtin(const char *name) {
    for (size_t i = 0; i < builtin_model_count; i++) {
        const struct builtin_model *b = &builtin_models[i];
        diags *all = diags_new();
        whirl_model *m = model_parse(b->file, b->text, b->length, all);
        TEST_ASSERT_NOT_NULL_MESSAGE(m, b->file);
        if (scene_called(m, name) != NULL || mechanism_called(m, name) != NULL) {
            return derive_model(m, name, all);
        }
        model_free(m);
        diags_free(all);
    }
    TEST_FAIL_MESSAGE(name);
    return (derived){0};
}

void derived_free(derived *d) {
    image_free(d->image);
    free(d->text);
    equations_free(d->equations);
    instance_free(d->instance);
    model_free(d->model);
    free(d->errors);
    *d = (derived){0};
}

void derived_expect(const derived *d, const char *what) {
    if (d->image == NULL) {
        printf("  %s: %s\n", what, d->errors);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(d->image, what);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", d->errors, what);
}

derived derived_surely(derived d, const char *what) {
    derived_expect(&d, what);
    return d;
}

void random_state(state_values *s, const derived *d, uint64_t *seed) {
    s->instance = d->instance;
    TEST_ASSERT_TRUE(d->equations->count <= UNKNOWNS);
    for (int i = 0; i < d->equations->count; i++) {
        for (int primes = 0; primes < ORDERS_MAX; primes++) {
            s->value[i][primes] =
                primes == 0 ? random_between(seed, 0.2, 1.1) : random_between(seed, -2.0, 2.0);
        }
    }
}

void derived_run(const op_list *t, const derived *d, const state_values *s, double *result) {
    derived_run_known(t, d, s, result, NULL);
}

void derived_run_known(const op_list *t, const derived *d, const state_values *s, double *result,
                       double *off) {
    const image *p = d->image;
    double angle_rad[UNKNOWNS] = {0};
    double real[4 * UNKNOWNS] = {0};
    double input[UNKNOWNS] = {0};
    TEST_ASSERT_TRUE(p->angles <= UNKNOWNS && p->reals <= 4 * UNKNOWNS && p->inputs <= UNKNOWNS);
    for (int i = 0; i < p->angles; i++) {
        angle_rad[i] = s->value[p->angle[i].unknown][p->angle[i].primes];
    }
    for (int i = 0; i < p->reals; i++) {
        real[i] = s->value[p->real[i].unknown][p->real[i].primes];
    }
    image_inputs(p, input);
    evaluator *ev = evaluator_new(t);
    evaluator_run(ev, 0.0, angle_rad, real, real + (p->coordinates - p->angles), input, result);
    if (off != NULL) {
        evaluator_rounding(ev, angle_rad, 0.0, off);
    }
    evaluator_free(ev);
}

double state_value(void *context, const symbol *sym, int primes) {
    const state_values *state = context;
    if (sym->kind == SYM_PARAMETER) {
        return state->instance->parameter[sym->index];
    }
    return sym->kind == SYM_INPUT ? state->instance->input[sym->index]
                                  : state->value[sym->index][primes];
}

void derived_octave(FILE *out, const derived *d, const char *file, bool folded) {
    char *text = NULL;
    size_t size = 0;
    FILE *words = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(words);
    show_events(words, d->equations, "% ",
                "This function computes the motion between events. It does "
                "not contain:");
    fclose(words);
    if (folded) {
        emit_octave(out, d->image, file, text);
    } else {
        emit_octave_head(out, d->image, file, text);
        show_octave(out, d->equations, emit_octave_variable_is_free);
        emit_octave_end(out, d->image);
    }
    free(text);
}

uint64_t random_bits(uint64_t *seed) { /* the random generator splitmix64 */
    uint64_t x = *seed += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

unsigned random_one_of(uint64_t *seed, unsigned bound) {
    return (unsigned)(random_bits(seed) % bound);
}

double random_between(uint64_t *seed, double low, double high) {
    return low + (high - low) * (double)(random_bits(seed) >> 11) * 0x1p-53;
}

char *repeated(const char *front, const char *part, int times, const char *tail) {
    const size_t room = strlen(front) + strlen(tail) + (size_t)times * (strlen(part) + 16) + 1;
    char *text = malloc(room);
    TEST_ASSERT_NOT_NULL(text);
    size_t at = (size_t)snprintf(text, room, "%s", front);
    for (int i = 1; i <= times; i++) {
        for (const char *c = part; *c != '\0'; c++) {
            /* # becomes the number of this piece, @ the number of the piece before */
            if (*c == '#' || *c == '@') {
                at += (size_t)snprintf(text + at, room - at, "%d", *c == '#' ? i : i - 1);
            } else {
                text[at++] = *c;
            }
        }
    }
    snprintf(text + at, room - at, "%s", tail);
    return text;
}

double derived_rest(const derived *d, state_values *s, const double *accel, int i, double *size) {
    const equations *e = d->equations;
    double rest = -poly_evaluate(equations_force(e, i), state_value, s);
    *size = fabs(rest) + 1.0;
    for (int j = 0; j < e->count; j++) {
        const double part = poly_evaluate(e->mass[i * e->count + j], state_value, s) * accel[j];
        rest += part;
        *size += fabs(part);
    }
    return rest;
}

char *derived_written(void (*write)(FILE *out, const image *im, const char *file),
                      const image *im) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    write(out, im, "x.whirl");
    fclose(out);
    return text;
}

void dense_solve(int n, int width, long double *a, long double *x) {
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k; i < n; i++) {
            best = fabsl(a[i * width + k]) > fabsl(a[best * width + k]) ? i : best;
        }
        for (int j = 0; j <= n; j++) {
            const long double swap = a[k * width + j];
            a[k * width + j] = a[best * width + j];
            a[best * width + j] = swap;
        }
        for (int i = 0; i < n; i++) {
            const long double part = i == k ? 0.0L : a[i * width + k] / a[k * width + k];
            for (int j = k; j <= n; j++) {
                a[i * width + j] -= part * a[k * width + j];
            }
        }
    }
    for (int k = 0; k < n; k++) {
        x[k] = a[k * width + n] / a[k * width + k];
    }
}
