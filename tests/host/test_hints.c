/* test_hints.c: formulas of dry friction that a user wrote by hand must cause a hint; similar formulas must not. */
#include "derived.h"
#include "host/lang/hints.h"
#include "parsed.h"

/* The line of the formula that causes a hint; 0 if none does. The first Q is in line 9. */
static int told(const char *forces) {
    char text[900];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nparameter mu = 0.3\n"
             "parameter c = 2 [kg/m]\ninput N = 5 [N]\nlet way = sign(x')\n"
             "T = 1 [kg]*(x'^2 + y'^2)/2\n%s",
             forces);
    parse(text);
    instantiate(NULL);
    const double before = made->start[0][1];
    const symbol *on = NULL;
    const term *found = hint_friction(made, &on);
    TEST_ASSERT_TRUE(found == NULL || on->kind == SYM_COORDINATE);
    TEST_ASSERT_TRUE(made->start[0][1] == before);
    TEST_ASSERT_EQUAL_INT(0, diags_count(said));
    return found == NULL ? 0 : found->at.line;
}

static void test_friction_by_hand_is_told(void) {
    TEST_ASSERT_EQUAL_INT(9, told("Q(x) = -mu*sign(x')*N\n"));
    TEST_ASSERT_EQUAL_INT(9, told("Q(x) = -mu*way*N\n"));
    TEST_ASSERT_EQUAL_INT(9, told("Q(x) = 3 [N] - mu*N*sign(2*x'/1 [m/s]) - 1 [N*s/m]*x'\n"));
    TEST_ASSERT_EQUAL_INT(9, told("Q(x) = -mu*N*way\nscene s { start x' = 2 [m/s] }\n"));
    TEST_ASSERT_EQUAL_INT(10, told("Q(y) = N\neffect rub { Q(x) += -mu*N*way }\n"
                                   "scene s { with rub }\n"));
}

/* Random losses that grow with an absolute rate: a factor, its exponent, and smooth losses beside it. */
static void test_losses_with_a_kink_are_told(void) {
    static const char *const sizes[] = {"abs(x')", "sqrt(x'^2)",   "x'*sign(x')",
                                        "x'*way",  "max(x', -x')", "abs(x' - y')"};
    uint64_t seed = 4801;
    for (unsigned i = 0; i < 200; i++) {
        char forces[300];
        const unsigned power = 1 + (unsigned)(random_bits(&seed) % 3);
        const bool in_effect = (unsigned)(random_bits(&seed) % 2) == 0;
        const int length = snprintf(
            forces, sizeof forces, "%sF %s %.3f [W]*%s*(%s/1 [m/s])^%u + %.4f [N*s/m]*x'^2%s\n%s",
            in_effect ? "effect rub { " : "", in_effect ? "+=" : "=",
            random_between(&seed, 0.01, 50.0),
            (unsigned)(random_bits(&seed) % 2) == 0 ? "(2 + sin(y/1 [m]))" : "mu",
            sizes[(unsigned)(random_bits(&seed) % 6)], power, random_between(&seed, 0.0, 9.0),
            in_effect ? " }" : "", in_effect ? "scene s { with rub }\n" : "");
        TEST_ASSERT_TRUE(length < (int)sizeof forces);
        TEST_ASSERT_EQUAL_INT_MESSAGE(power == 1 ? 9 : 0, told(forces), forces);
    }
}

static void test_what_only_looks_like_it_is_not(void) {
    TEST_ASSERT_EQUAL_INT(0, told("Q(x) = -c*sign(x')*x'^2\n")); /* a drag law */
    TEST_ASSERT_EQUAL_INT(0, told("Q(x) = -c*x'*abs(x')\n"));    /* a drag law */
    TEST_ASSERT_EQUAL_INT(0, told("Q(x) = mu*N*way\n"));         /* pushes in x direction */
    /* rate of x */
    TEST_ASSERT_EQUAL_INT(0, told("Q(y) = -mu*N*way\n"));
    TEST_ASSERT_EQUAL_INT(0, told("Q(x) = -mu*N*sign(x' - y')\n")); /* between two bodies */
    TEST_ASSERT_EQUAL_INT(0, told("Q(x) = -mu*N*sign(x/1 [m])\n")); /* a position's sign */
    TEST_ASSERT_EQUAL_INT(0, told("effect rub { Q(x) += -mu*N*way }\nscene s { until 1 [s] }\n"));
    TEST_ASSERT_EQUAL_INT(0, told("Q(x) = -way*N*y/1 [m]/y*0\n")); /* not a number */
    TEST_ASSERT_EQUAL_INT(0, told("friction x static mu kinetic mu normal N\n"));
}

SUITE(hints) {
    RUN_TEST(test_friction_by_hand_is_told);
    RUN_TEST(test_losses_with_a_kink_are_told);
    RUN_TEST(test_what_only_looks_like_it_is_not);
    drop();
}
