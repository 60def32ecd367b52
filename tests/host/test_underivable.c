/* test_underivable.c: what cannot be derived is refused with its place and in bounded time. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "command.h"
#include "derived.h"
#include "host/cli/commands.h"
#include "unity.h"

void suite_underivable(void);

static void expect_refused(const char *text, const char *wanted) {
    const clock_t began = clock();
    derived d = derived_text(text);
    const double seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
    const bool found = strstr(d.errors, wanted) != NULL;
    if (!found || d.image != NULL) {
        printf("  wanted: %s\n  got: %.400s\n", wanted, d.errors);
    }
    TEST_ASSERT_NULL(d.image);
    TEST_ASSERT_TRUE(found);
    TEST_ASSERT_TRUE(seconds < 20.0); /* bounded, sanitizers included */
    derived_free(&d);
}

static void test_singular_and_other_impossible_mechanisms(void) {
    expect_refused("mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x' + y')^2\n",
                   "t.whirl:1:11: error: singular mass matrix: 'm' cannot be solved");
    expect_refused(
        "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*x'^2\n"
        "V = 1 [N/m]*y^2\n",
        "t.whirl:3:12: error: singular mass matrix: the kinetic energy does not contain y'");
    expect_refused("mechanism m\nstate x\nequation 1 [s^2]*x'^2 = 1\n",
                   "t.whirl:3:1: error: this equation is not linear in the highest derivatives: x");
    expect_refused("mechanism m\nstate x\nequation sin(1 [s]*x') = x\n",
                   "not linear in the highest");
    expect_refused("mechanism m\nstate x\nstate y\nequation x' + y' = 1 [1/s]\n"
                   "equation 2*x' + 2*y' = 3 [1/s]\n",
                   "the equations of 'm' cannot be solved for the highest derivatives");
    expect_refused("mechanism m\ncoordinate x [m]\ninput M = 1 [kg]\nT = M*x'^2/2\n",
                   "the kinetic energy depends on input 'M', whose rate is not known");
    expect_refused(
        "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2\nV = 1 [J]*log(0*x/1 [m] - 1)*x/1 [m]\n",
        "have no finite value at any state tried");
    expect_refused("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2\n"
                   "V = 1 [J]*sqrt(-1 - (x/1 [m])^2)\n",
                   "have no finite value at any state tried");
}

static void test_kinetic_energy_must_be_positive(void) {
    expect_refused("mechanism m\ncoordinate x [m]\nT = -1 [kg]*x'^2/2\n",
                   "t.whirl:3:1: error: the kinetic energy of 'm' is negative for some motion");
    expect_refused("mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate z [m]\n"
                   "T = 1 [kg]*(x'*y' + y'*z' + z'^2/2)\n",
                   "t.whirl:5:1: error: the kinetic energy of 'm' is negative for some motion");
    expect_refused("mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\n"
                   "T = 1 [kg*m^2]*(a'^2/2 + b'^2/2 + (2 + cos(a))*a'*b')\n",
                   "t.whirl:4:1: error: the kinetic energy of 'm' is negative for some motion");
    /* the same matrix, given outright, is a matter of how the equations are written */
    derived system = derived_text("mechanism m\nstate x\nstate y\nstate z\n"
                                  "equation 1 [s]*y' = x\nequation 1 [s]*(x' + z') = y\n"
                                  "equation 1 [s]*(y' + z') = z\n");
    derived_expect(&system, "a system");
    derived_free(&system);
}

/* What is positive, or finite, in a narrow range only: no generic state lies there, the start does. */
static void test_the_start_is_tried_too(void) {
    static const char *const texts[] = {
        "mechanism m\ncoordinate x [m]\n"
        "T = (1 [kg] - 1e12 [kg]*(x/1 [m] - 7)^2)*x'^2/2\nV = 1 [N/m]*x^2/2\n",
        "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [J]*log(x/1 [m] - 5)\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        static const char *const start[] = {"x = 7 [m]"};
        const overrides changes = {.starts = start, .start_count = 1};
        for (int moved = 0; moved < 2; moved++) {
            diags *all = diags_new();
            whirl_model *parsed = model_parse("t.whirl", texts[i], strlen(texts[i]), all);
            TEST_ASSERT_NOT_NULL(parsed);
            instance *made =
                instance_make(parsed->mechanisms[0], NULL, moved == 1 ? &changes : NULL, all);
            equations *e = made == NULL ? NULL : equations_derive(made, all);
            TEST_ASSERT_EQUAL_INT(moved == 1 ? 0 : 1, diags_count(all));
            TEST_ASSERT_TRUE((e != NULL) == (moved == 1));
            equations_free(e);
            instance_free(made);
            model_free(parsed);
            diags_free(all);
        }
    }
}

static void test_constants_that_are_not_finite(void) {
    expect_refused("mechanism m\ncoordinate x [m]\nT = 1e-200 [kg]*x'^2/2\n"
                   "V = 1e200 [N/m]*x^2/2\n",
                   "t.whirl:1:11: error: the equations of 'm' contain a number that is not finite");
    expect_refused("mechanism m\ncoordinate x [m]\nparameter a = 0 [m]\nT = 1 [kg]*x'^2/2\n"
                   "output good = x\noutput bad [1] = sin(x/a)\n",
                   "t.whirl:6:8: error: output 'bad' contains a number that is not finite");
}

static void test_too_many_components(void) {
    char *states = repeated("mechanism m\nstate z\n", "state x#\n", 40, "");
    char *text = repeated(states, "equation 1 [s^2]*x#'' = z\n", 40, "equation 1 [s]*z' = x1\n");
    expect_refused(text, "t.whirl:1:11: error: 'm' has more than 64 components of state");
    free(text);
    free(states);
}

/* A product of sums of parameters, as in the energies of a long chain. With the hint's change it derives. */
static void test_a_hint_about_parameters_helps(void) {
    dice d = dice_of("parameters", 2);
    for (unsigned k = 0; k < 3; k++) {
        char text[2][4000];
        char wanted[100];
        const unsigned sums = 11 + dice_one_of(&d, 3);
        snprintf(wanted, sizeof wanted,
                 "hint: write let in place of parameter: %u of them become numbers", 3 * sums);
        for (int lets = 0; lets < 2; lets++) {
            const dice drawn = d;
            size_t at = (size_t)snprintf(text[lets], sizeof text[lets],
                                         "mechanism m\ncoordinate x\ncoordinate y\n");
            for (unsigned i = 0; i < 3 * sums; i++) {
                at += (size_t)snprintf(text[lets] + at, sizeof text[lets] - at, "%s p%u = %.3f\n",
                                       lets ? "let" : "parameter", i, dice_between(&d, 0.1, 2.0));
            }
            at += (size_t)snprintf(text[lets] + at, sizeof text[lets] - at,
                                   "T = 1 [kg*m^2]*(x'^2 + y'^2)/2\nV = 1 [J]");
            for (unsigned i = 0; i < sums; i++) {
                at += (size_t)snprintf(text[lets] + at, sizeof text[lets] - at,
                                       "*(p%u + p%u*x + p%u*y)", 3 * i, 3 * i + 1, 3 * i + 2);
            }
            snprintf(text[lets] + at, sizeof text[lets] - at, "\n");
            d = lets ? d : drawn;
        }
        expect_refused(text[0], wanted);
        derived helped = derived_text(text[1]);
        TEST_ASSERT_NOT_NULL_MESSAGE(helped.image, helped.errors);
        derived_free(&helped);
    }
}

static void test_expressions_that_explode_are_refused(void) {
    static const char front[] = "mechanism m\ncoordinate x\ncoordinate y\nlet a0 = x + y + 1\n";
    static const char tail[] = "T = 1 [kg*m^2]*(x'^2 + y'^2)\nV = 1 [J]*a30\n";
    static const char *const pieces[] = {"let a# = a@*a@ + x\n",
                                         "let a# = sin(a@)*a@ + y\n",
                                         "let a# = a@^2 + cos(a@)*x\n",
                                         "let a# = exp(a@) + a@*y\n",
                                         "let a# = a@/(1 + a@^2)\n",
                                         "let a# = sqrt(a@*a@ + 1) + a@^3\n",
                                         "let a# = atan2(a@, a@ + 2) + max(a@, x)\n"};
    for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++) {
        char *text = repeated(front, pieces[i], 30, tail);
        expect_refused(text,
                       "t.whirl:1:11: error: the equations of 'm' grow beyond what can be handled");
        free(text);
    }
    /* nothing to multiply out and few objects, but 2^40 leaves for whoever walks through them all */
    char *doubled = repeated(front, "let a# = exp(a@) + atan(a@)\n", 40,
                             "T = 1 [kg*m^2]*(x'^2 + y'^2)\noutput o = a40\n");
    expect_refused(doubled, "error: the equations of 'm' grow beyond what can be handled");
    free(doubled);
    /* one unknown less deep, so that the algebra gets further before it gives up */
    for (int deep = 4; deep < 12; deep++) {
        char end[96];
        snprintf(end, sizeof end, "T = 1 [kg*m^2]*(x'^2 + y'^2)*(1 + a%d^2)\n", deep);
        char *text = repeated(front, "let a# = a@*sin(a@ + y) + x\n", deep, end);
        const clock_t began = clock();
        derived d = derived_text(text);
        TEST_ASSERT_TRUE((d.image == NULL) == (d.errors[0] != '\0'));
        derived_free(&d);
        TEST_ASSERT_TRUE((double)(clock() - began) / CLOCKS_PER_SEC < 60.0);
        free(text);
    }
}

/* A length in the motion, with a number in it; of drawn sums, products and functions. */
static void length_of(dice *d, int depth, double number, char *to, size_t size) {
    static const char *const ways[] = {"%s + gap", "-(%s)*0.5",      "max(%s, y)",
                                       "abs(%s)",  "(%s)^2/(1 [m])", "(%s)*cos(phi)"};
    char inner[300];
    if (depth == 0) {
        snprintf(to, size, "%.17g*x", number);
        return;
    }
    length_of(d, depth - 1, number, inner, sizeof inner);
    snprintf(to, size, ways[dice_one_of(d, 6)], inner);
}

static const char two[] = "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate phi [rad]\n"
                          "parameter e = 0.5\nlet gap = x - y\n"
                          "T = 1 [kg]*(x'^2 + y'^2)/2 + 1 [kg*m^2]*phi'^2/2\n";

/* What is compared with itself never changes; with another number in it, it does. */
static void test_nothing_is_compared_with_itself(void) {
    static const char *const statements[] = {
        "stop %s >= %s restitution e\n", "stop %s <= (%s) restitution e\n",
        "hold x while %s > %s\n", "when %s crosses (%s) { set x' = -x' }\n"};
    dice d = dice_of("compared with itself", 3301);
    for (unsigned i = 0; i < dice_cases(usual_or(80, 20)); i++) {
        char side[2][300];
        char line[700];
        char text[1500];
        said what;
        const bool same = dice_one_of(&d, 2) == 0;
        const double number = dice_between(&d, 0.5, 3.0);
        const int depth = (int)dice_one_of(&d, 5);
        const dice begin = d;
        length_of(&d, depth, number, side[0], sizeof side[0]);
        d = begin;
        length_of(&d, depth, same ? number : number * 1.25, side[1], sizeof side[1]);
        snprintf(line, sizeof line, statements[i % 4], side[0], side[1]);
        snprintf(text, sizeof text, "%s%s", two, line);
        command_say_model(command_derive, text, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(same ? 2 : 0, what.status, text);
        TEST_ASSERT_EQUAL_MESSAGE(same, strstr(what.err, "both sides are the same") != NULL, text);
    }
}

void suite_underivable(void) {
    RUN_TEST(test_singular_and_other_impossible_mechanisms);
    RUN_TEST(test_kinetic_energy_must_be_positive);
    RUN_TEST(test_the_start_is_tried_too);
    RUN_TEST(test_constants_that_are_not_finite);
    RUN_TEST(test_too_many_components);
    RUN_TEST(test_a_hint_about_parameters_helps);
    RUN_TEST(test_expressions_that_explode_are_refused);
    RUN_TEST(test_nothing_is_compared_with_itself);
}
