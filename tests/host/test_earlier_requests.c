/* test_earlier_requests.c: a scene's program must not depend on what was computed before it with the same equations: other
 * expressions in their algebra, printed forms, or another program. Tests every built-in scene and generated mechanisms
 * (WHIRL_CASES). The C code must be identical to the byte; if the core lacks a function, the Octave form is compared
 * instead. */
#include "command.h"
#include "derived.h"
#include "host/emit/emit.h"
#include "host/show/show.h"
#include "mechanism.h"

enum { POOL = 24, QUESTIONS = 60, SIZE_MAX_ASKED = 60, MECHANISMS_FEW = 10, MECHANISMS = 30 };

static uint64_t seed = 20261122;

static unsigned draw(uint64_t *from, unsigned bound) {
    return (unsigned)(random_bits(from) % bound);
}

static const poly *any_symbol(algebra *a, const mechanism *m, uint64_t *from) {
    const unsigned which =
        draw(from, (unsigned)(3 * m->coordinate_count + m->parameter_count + m->input_count));
    const unsigned rates = 3 * (unsigned)m->coordinate_count;
    if (which < rates) {
        return poly_symbol(a, m->coordinates[which / 3], (int)which % 3);
    }
    return which - rates < (unsigned)m->parameter_count
               ? poly_symbol(a, m->parameters[which - rates], 0)
               : poly_symbol(a, m->inputs[which - rates - (unsigned)m->parameter_count], 0);
}

static const poly *any_result(algebra *a, const poly *x, const poly *y, const mechanism *m,
                              uint64_t *from) {
    static const double exponents[] = {2.0, 3.0, -1.0, 0.5, -2.0, 4.0};
    static const function_id functions[] = {FN_TAN, FN_ATAN, FN_EXP, FN_ABS, FN_SQRT, FN_SIGN};
    switch (draw(from, 9)) {
    case 0: return poly_add(a, x, y);
    case 1: return poly_sub(a, x, y);
    case 2: return poly_mul(a, x, y);
    case 3: return poly_sin(a, x);
    case 4: return poly_cos(a, poly_add(a, x, y));
    case 5: return poly_is_zero(x) ? x : poly_pow(a, x, exponents[draw(from, 6)]);
    case 6: return poly_call(a, functions[draw(from, 6)], x, NULL);
    case 7:
        return poly_derivative(a, x, m->coordinates[draw(from, (unsigned)m->coordinate_count)],
                               (int)draw(from, 2));
    default: return poly_scale(a, x, 0.5 * (1.0 + draw(from, 7)));
    }
}

/* Uses symbols, outputs and energies in a random sequence, and combines them to expressions. */
static void ask(uint64_t *from, algebra *a, const mechanism *m) {
    const poly *pool[POOL];
    for (int i = 0; i < POOL; i++) {
        pool[i] = any_symbol(a, m, from);
    }
    for (int k = (int)draw(from, 3); k > 0 && m->output_count > 0; k--) {
        pool[draw(from, POOL)] =
            poly_from_expr(a, m->outputs[draw(from, (unsigned)m->output_count)]->value);
    }
    for (int k = (int)draw(from, 3); k > 0 && m->term_count > 0; k--) {
        pool[draw(from, POOL)] =
            poly_from_expr(a, m->terms[draw(from, (unsigned)m->term_count)].value);
    }
    for (int k = 0; k < QUESTIONS; k++) {
        const poly *made = any_result(a, pool[draw(from, POOL)], pool[draw(from, POOL)], m, from);
        if (made->size < SIZE_MAX_ASKED && poly_is_finite(made)) {
            pool[draw(from, POOL)] = made;
        }
    }
}

typedef enum before { ALONE, OTHER_THINGS, OTHER_FORMS, OTHER_PROGRAM, WAYS } before;
static const char *const way_names[WAYS] = {"alone", "other things made", "other forms printed",
                                            "another program made"};

static void print_forms(const equations *e, uint64_t *from) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    show_latex(out, e);
    show_text(out, e);
    fclose(out);
    free(text);
    const int i = (int)draw(from, (unsigned)e->count);
    if (e->kinetic != NULL) { /* computes a derivative and discards it */
        poly_derivative(e->algebra,
                        poly_derivative(e->algebra, e->kinetic, e->unknowns[i].symbol, 1),
                        e->unknowns[i].symbol, 0);
    }
    poly_derivative(e->algebra, equations_force(e, i), e->unknowns[i].symbol, 0);
}

/* The scene as C code; NULL if the scene cannot be derived. The caller frees the text. */
static char *written(const scene *in, before way, uint64_t from) {
    diags *errors = diags_new();
    instance *inst = instance_make(in->mechanism, in, NULL, errors);
    equations *e = NULL;
    image *p = NULL;
    if (inst != NULL) {
        e = equations_derive(inst, errors);
    }
    if (e != NULL && way == OTHER_THINGS) {
        ask(&from, e->algebra, inst->mechanism);
    }
    if (e != NULL && way == OTHER_FORMS) {
        print_forms(e, &from);
    }
    if (e != NULL && way == OTHER_PROGRAM) {
        image_free(image_make(e, NULL, &plainly, IMAGE_TO_RUN, errors));
    }
    if (e != NULL) {
        p = image_make(e, in->conserve, &plainly, IMAGE_TO_RUN, errors);
    }
    char *text = NULL;
    if (p != NULL) {
        size_t size = 0;
        FILE *out = open_memstream(&text, &size);
        TEST_ASSERT_NOT_NULL(out);
        emit_c(out, p, "asked.whirl");
        fclose(out);
    }
    image_free(p);
    equations_free(e);
    instance_free(inst);
    diags_free(errors);
    return text;
}

static int differing[WAYS];
static char first_differing[WAYS][64];

static void compare(const scene *in) {
    char *alone = written(in, ALONE, 0);
    TEST_ASSERT_NOT_NULL_MESSAGE(alone, in->name);
    for (before way = OTHER_THINGS; way < WAYS; way++) {
        char *after = written(in, way, random_bits(&seed));
        TEST_ASSERT_NOT_NULL_MESSAGE(after, in->name);
        if (strcmp(alone, after) != 0) {
            if (differing[way]++ == 0) {
                snprintf(first_differing[way], sizeof first_differing[way], "%s", in->name);
            }
        }
        free(after);
    }
    free(alone);
}

static void expect_none(int of) {
    int sum = 0;
    for (before way = OTHER_THINGS; way < WAYS; way++) {
        printf("  after %-22s %d of %d differ %s\n", way_names[way], differing[way], of,
               first_differing[way]);
        sum += differing[way];
        differing[way] = 0;
        first_differing[way][0] = '\0';
    }
    TEST_ASSERT_EQUAL_INT(0, sum);
}

static int compare_scene(const scene *in) {
    compare(in);
    return 1;
}

TEST(earlier_requests, built_in_scenes) { expect_none(each_builtin_scene(compare_scene)); }

TEST(earlier_requests, generated_mechanisms) {
    const int wanted = (int)dice_cases(few_or_all(usual_or(4, 2), MECHANISMS));
    int done = 0;
    for (uint64_t number = 0; done < wanted; number++) {
        char text[MECHANISM_SIZE];
        diags *errors = diags_new();
        mechanism_write((unsigned)number, seed + number, text);
        whirl_model *made = model_parse("generated", text, strlen(text), errors);
        char *alone = made != NULL ? written(made->scenes[0], ALONE, 0) : NULL;
        if (alone != NULL) {
            compare(made->scenes[0]);
            done++;
        }
        free(alone);
        model_free(made);
        diags_free(errors);
    }
    expect_none(wanted);
}

SUITE(earlier_requests) { printf("earlier_requests: seed %" PRIu64 "\n", seed); }
