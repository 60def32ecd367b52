/* test_effect_parts.c: the parameters and inputs of an effect can be changed only if the effect is active, and
 * inertia may come from effects alone. Tested on every effect of every built-in mechanism and on random mechanisms.
 * Also noise. */
#include "test.h"

#include "core/noise.h"
#include "derived.h"
#include "host/lang/builtin.h"
#include "host/lang/value.h"
#include "motion.h"

/* The errors of an instance with one change; "" if the change is accepted. The caller frees the text. */
static char *said_of(const mechanism *of, const scene *in, const char *set, bool as_value,
                     const char *with) {
    const char *const sets[] = {set};
    const char *const effects[] = {with};
    const overrides changes = {.sets = sets,
                               .set_count = as_value ? 0 : 1,
                               .values = sets,
                               .value_count = as_value ? 1 : 0,
                               .with = effects,
                               .with_count = with != NULL ? 1 : 0};
    diags *errors = diags_new();
    instance *inst = instance_make(of, in, &changes, errors);
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    diags_flush(errors, out);
    fclose(out);
    TEST_ASSERT_TRUE((inst == NULL) == (text[0] != '\0'));
    instance_free(inst);
    diags_free(errors);
    return text;
}

/* The error must name the effect. If --set made the change, the error must also name the option that activates the
 * effect. */
static void expect_refused(const mechanism *of, const scene *in, const symbol *s, double value) {
    char wanted[200];
    const char *owner = of->effects[s->effect].name;
    char number[40];
    snprintf(number, sizeof number, "%.17g", value);
    char *set = shown_assignment(s, 0, number);
    for (int as_value = 0; as_value < 2; as_value++) {
        char *said = said_of(of, in, set, as_value != 0, NULL);
        snprintf(wanted, sizeof wanted, "'%s' belongs to the effect '%s'", s->name, owner);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, wanted), said);
        snprintf(wanted, sizeof wanted, "hint: add --with %s", owner);
        TEST_ASSERT_TRUE_MESSAGE((strstr(said, wanted) != NULL) == (as_value == 0), said);
        free(said);
    }
    char *said = said_of(of, in, set, false, owner);
    TEST_ASSERT_EQUAL_STRING("", said);
    free(said);
    free(set);
}

/* The mechanism's own value of a parameter or an input, which is valid. */
static double own_value(const mechanism *of, const symbol *s) {
    diags *errors = diags_new();
    instance *inst = instance_make(of, NULL, NULL, errors);
    TEST_ASSERT_NOT_NULL(inst);
    const double value =
        s->kind == SYM_PARAMETER ? inst->parameter[s->index] : inst->input[s->index];
    instance_free(inst);
    diags_free(errors);
    return value;
}

static int check_symbols(const whirl_model *m, const mechanism *of, const symbol *const *symbols,
                         int count) {
    int checked = 0;
    for (int i = 0; i < count; i++) {
        const symbol *s = symbols[i];
        if (s->effect < 0) {
            continue;
        }
        const double value = own_value(of, s);
        expect_refused(of, NULL, s, value);
        checked++;
        for (int k = 0; k < m->scene_count; k++) {
            if (m->scenes[k]->mechanism == of && !m->scenes[k]->with[s->effect]) {
                expect_refused(of, m->scenes[k], s, value);
            }
        }
    }
    return checked;
}

TEST(effect_parts, changes_of_unused_effects_are_refused) {
    int checked = 0;
    for (size_t i = 0; i < builtin_model_count; i++) {
        diags *errors = diags_new();
        whirl_model *m = model_parse(builtin_models[i].file, builtin_models[i].text,
                                     builtin_models[i].length, errors);
        TEST_ASSERT_NOT_NULL(m);
        for (int k = 0; k < m->mechanism_count; k++) {
            const mechanism *of = m->mechanisms[k];
            checked += check_symbols(m, of, of->parameters, of->parameter_count);
            checked += check_symbols(m, of, of->inputs, of->input_count);
        }
        model_free(m);
        diags_free(errors);
    }
    printf("  %d parameters and inputs of effects\n", checked);
    TEST_ASSERT_TRUE(checked > 30);
}

/* A scene may have its `set` before or after its `with`. */
TEST(effect_parts, set_before_or_after_with) {
    static const struct {
        const char *scene;
        const char *said; /* the error; NULL if accepted */
    } all[] = {{"scene s { set b = 3 }",
                "t.whirl:5:15: error: 'b' belongs to the effect 'drag', which this "
                "scene does not select"},
               {"scene s { set b = 3\nwith drag }", NULL},
               {"scene s { with drag\nset b = 3, m = 2 [kg] }", NULL},
               {"scene s { set m = 2 [kg], push = 1 [N]\nwith drag }",
                "'push' belongs to the effect 'motor'"},
               {"scene s { with drag, motor\nset push = 1 [N], b = 2 }", NULL}};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        char text[600];
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\nparameter m = 1 [kg]\nT = m*x'^2/2; effect drag { "
            "parameter b = 1; F += b*1 [kg/s]*x'^2/2 }; effect motor { input push = 0 [N]; Q(x) += "
            "push }\n%s\n",
            all[i].scene);
        derived d = derived_text(text);
        TEST_ASSERT_TRUE_MESSAGE((d.model != NULL) == (all[i].said == NULL), d.errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, all[i].said != NULL ? all[i].said : ""),
                                     d.errors);
        derived_free(&d);
    }
}

TEST(effect_parts, set_of_a_removed_effect) {
    static const char text[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                               "effect drag { parameter b = 1 [kg/s]; F += b*x'^2/2 }\n"
                               "scene s { with drag; set b = 3 [kg/s] }\n";
    static const char *const drag[] = {"drag"};
    diags *errors = diags_new();
    whirl_model *m = model_parse("t.whirl", text, strlen(text), errors);
    TEST_ASSERT_NOT_NULL(m);
    const overrides changes = {.without = drag, .without_count = 1};
    instance *inst = instance_make(m->mechanisms[0], m->scenes[0], &changes, errors);
    TEST_ASSERT_NOT_NULL(inst);
    TEST_ASSERT_FALSE(inst->with[0]);
    instance_free(inst);
    model_free(m);
    diags_free(errors);
}

enum { COORDINATES = 3 };

/* Derives a mechanism in which coordinate i has its inertia from the mechanism (giver[i] = 0) or from effect e1, e2
 * or e3. The bits of `with` are the active effects. */
static derived derive_with(const int *giver, unsigned with) {
    char text[2000] = "mechanism parts\n";
    char line[160];
    bool none = true;
    for (int i = 0; i < COORDINATES; i++) {
        snprintf(line, sizeof line, "coordinate q%d [m]\n", i);
        strcat(text, line);
    }
    for (int of = 0; of <= 3; of++) {
        if (of > 0) {
            snprintf(line, sizeof line, "effect e%d {\n", of);
            strcat(text, line);
        }
        for (int i = 0; i < COORDINATES; i++) {
            if (giver[i] == of) {
                snprintf(line, sizeof line, "%s %d [kg]*q%d'^2/2\n",
                         of > 0 ? "T +="
                         : none ? "T ="
                                : "  +",
                         i + 2, i);
                if (of == 0 && !none) { /* this statement has the sum of all terms */
                    text[strlen(text) - 1] = '\0';
                }
                none = of == 0 ? false : none;
                strcat(text, line);
            }
        }
        strcat(text, of > 0 ? "V += 0 [J]\n}\n" : "");
    }
    strcat(text, "V = 3 [N/m]*(q0 + q1 + q2)^2/2\nscene s {\n");
    for (int of = 1; of <= 3; of++) {
        if ((with >> of & 1U) != 0) {
            snprintf(line, sizeof line, "with e%d\n", of);
            strcat(text, line);
        }
    }
    strcat(text, "with ledger\nstart q0 = 0.1 [m]\n}\n");
    return derived_scene(text, "s");
}

TEST(effect_parts, inertia_of_effects) {
    for (int way = 0; way < 64; way++) { /* tries every giver for every coordinate */
        int giver[COORDINATES];
        for (int i = 0; i < COORDINATES; i++) {
            giver[i] = way >> (2 * i) & 3;
        }
        for (unsigned with = 0; with < 16; with += 2) { /* tries every set of active effects */
            derived d = derive_with(giver, with);
            int missing = -1;
            for (int i = COORDINATES - 1; i >= 0; i--) {
                missing = giver[i] > 0 && (with >> giver[i] & 1U) == 0 ? i : missing;
            }
            if (missing < 0) {
                TEST_ASSERT_NOT_NULL_MESSAGE(d.image, d.errors);
            } else {
                char wanted[120];
                TEST_ASSERT_NULL(d.image);
                snprintf(wanted, sizeof wanted, "the kinetic energy does not contain q%d'",
                         missing);
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, wanted), d.errors);
                snprintf(wanted, sizeof wanted, "hint: the effect 'e%d' adds an inertia",
                         giver[missing]);
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, wanted), d.errors);
            }
            derived_free(&d);
        }
    }
}

/* Noise must change the records only, by the same numbers on every host. */

/* The hash FNV-1a with 32 bits and its published parameters. */
static uint32_t seed_of(const char *output, uint32_t seed) {
    uint32_t hash = 2166136261U;
    for (; *output != '\0'; output++) {
        hash = (hash ^ (unsigned char)*output) * 16777619U;
    }
    return hash ^ seed;
}

/* Compares an output with and without noise, step by step. The state must not depend on the noise. */
static void compare_noise(const char *use, const char *with, const char *output, uint32_t seed,
                          double deviation) {
    char text[200];
    motion clean;
    motion noisy;
    snprintf(text, sizeof text, "scene t { use %s; set duty = 0.6 }\n", use);
    motion_open_more(&clean, "eccentric.whirl", text, IN_DOUBLE_STEP(1e-3));
    snprintf(text, sizeof text, "scene t { use %s; with %s; set duty = 0.6 }\n", use, with);
    motion_open_more(&noisy, "eccentric.whirl", text, IN_DOUBLE_STEP(1e-3));
    TEST_ASSERT_EQUAL_UINT64(clean.image->hash, noisy.image->hash);
    double sum = 0.0;
    double squares = 0.0;
    for (unsigned i = 0; i < 4096; i++) {
        const double is = motion_value(&noisy, output);
        const double pure = motion_value(&clean, output);
        const double want = deviation * wh_noise_raw(seed_of(output, seed), i) * 0x1p-16;
        TEST_ASSERT_DOUBLE_WITHIN(1e-13 * (fabs(pure) + deviation), pure + want, is);
        sum += is - pure;
        squares += (is - pure) * (is - pure);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&clean, 1));
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&noisy, 1));
        TEST_ASSERT_EQUAL_UINT64(clean.kind->hash(clean.run), noisy.kind->hash(noisy.run));
    }
    /* four standard errors of 4096 samples: 4/64 of the deviation; for its square, sqrt(2) times as much */
    TEST_ASSERT_DOUBLE_WITHIN(deviation / 16.0, 0.0, sum / 4096.0);
    TEST_ASSERT_DOUBLE_WITHIN(deviation * deviation / 11.0, deviation * deviation,
                              squares / 4096.0);
    motion_close(&clean);
    motion_close(&noisy);
}

TEST(effect_parts, noise_is_on_the_records_only) {
    compare_noise("eccentric_fixed", "cell_noise", "cell_force", 1, 0.07);
    compare_noise("eccentric", "cell_noise", "pin_force", 2, 0.07);
    compare_noise("eccentric_coupled", "sensor_noise", "cell_force", 1, 0.07);
    compare_noise("eccentric_coupled", "sensor_noise", "speed", 1, 0.05);
}
