/* test_derive.c: the operation list of every mechanism, compared with the energy balance; also large expressions,
 * powers and exponents. test_octave.c compares the lists with their equations. */
#include <time.h>

#include "derived.h"
#include "host/derive/conserve.h"

enum { STATES = 50 };

static derived mechanism_file(const char *name) {
    char path[128];
    snprintf(path, sizeof path, "tests/mechanisms/%s.whirl", name);
    derived d = derived_file(path);
    derived_expect(&d, name);
    return d;
}

/* The energy integral h = sum q' dL/dq' - L must change by the power of the inputs minus the losses. dh/dt is a
 * central difference along the motion, with the accelerations of the operation list. */
static void check_balance(const derived *d, const char *name) {
    const equations *e = d->equations;
    uint64_t seed = 17;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, d, &seed);
        double books[UNKNOWNS * 3 + 8];
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, books);
        double size = 1e-3;
        double rate = 0.0;
        for (int side = -1; side <= 1; side += 2) { /* the state a small time before and after */
            const double dt = 1e-5 * side;
            state_values near = s;
            for (int i = 0; i < e->count; i++) {
                near.value[i][0] += dt * s.value[i][1];
                near.value[i][1] += dt * books[i];
            }
            double h = poly_evaluate(e->stored, state_value, &near) -
                       poly_evaluate(e->kinetic, state_value, &near);
            for (int i = 0; i < e->count; i++) {
                const double part =
                    near.value[i][1] * poly_evaluate(e->momentum[i], state_value, &near);
                h += part;
                size = fmax(size, fabs(part));
            }
            rate += h / (2.0 * dt);
            size = fmax(size, fabs(h));
        }
        for (int i = 0; i < e->count; i++) {
            size = fmax(size, fabs(books[i] * s.value[i][1]));
        }
        const double *entry = books + e->count;
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2e-7 * (size + size * size), 0.0,
                                          rate - entry[BOOK_INPUT_POWER] + entry[BOOK_LOSS_POWER],
                                          name);
    }
}

TEST(derive, power_balances_in_every_mechanism) {
    char lagrangian[] =
        "bead_on_hoop bead_on_wire cart_pole charged_particle contact double_pendulum "
        "elastic_pendulum furuta kepler leaking_mass mass_chain morse planar_arm "
        "quadratic_drag simple_pendulum slider_crank spherical_pendulum swinging_atwood "
        "symmetric_top tan_well triple_pendulum vortex";
    char *rest = NULL;
    for (char *name = strtok_r(lagrangian, " ", &rest); name != NULL;
         name = strtok_r(NULL, " ", &rest)) {
        derived d = mechanism_file(name);
        check_balance(&d, name);
        derived_free(&d);
    }
    static const char *const own[] = {"spherical_particle", "masses_relative", "masses_absolute",
                                      "epicyclic",          "driven_hinge",    "thomson_a_spin"};
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        derived d = derived_builtin(own[i]);
        derived_expect(&d, own[i]);
        check_balance(&d, own[i]);
        derived_free(&d);
    }
}

TEST(derive, large_but_tame_expressions_are_derived) {
    derived d = derived_text("mechanism m\ncoordinate a\ncoordinate b\ncoordinate c\ncoordinate d\n"
                             "coordinate e\nT = 1 [kg*m^2]*(a'^2 + b'^2 + c'^2 + d'^2 + e'^2)/2\n"
                             "V = 1 [J]*(a + b + c + d + e)^60\n");
    derived_expect(&d, "(a+b+c+d+e)^60");
    state_values s = {.instance = d.instance,
                      .value = {{0.1, 0, 0}, {0.25, 0, 0}, {0.3, 0, 0}, {0.2, 0, 0}, {0.05, 0, 0}}};
    double result[5];
    derived_run(d.image->list[IMAGE_STEP], &d, &s, result);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, -60.0 * pow(0.9, 59.0), result[3]);
    derived_free(&d);

    char *front = repeated("mechanism m\n", "coordinate x# [m]\n", 64,
                           "let x0 = 0 [m]\nT = 1 [kg]*(0 [m^2/s^2]");
    char *energy = repeated(front, " + x#'^2", 64, ")/2\nV = 3 [N/m]/2*(0 [m^2]");
    char *whole = repeated(energy, " + (x# - x@)^2", 64, ")\n");
    const clock_t began = clock();
    d = derived_text(whole);
    derived_expect(&d, "64 masses");
    TEST_ASSERT_TRUE((double)(clock() - began) / CLOCKS_PER_SEC < 20.0);
    TEST_ASSERT_EQUAL_INT(64, d.image->coordinates);
    /* 3 (x_{i+1} - 2 x_i + x_{i-1}) needs about four operations for each mass */
    TEST_ASSERT_TRUE(op_list_operations(d.image->list[IMAGE_STEP]) <= 64 * 5);
    derived_free(&d);
    free(front);
    free(energy);
    free(whole);
}

/* A power of a sum that is not expanded must hide neither a cyclic coordinate nor the function whose rate is its
 * momentum. */
TEST(derive, unexpanded_powers_hide_no_conservation) {
    derived d = derived_text("mechanism m\ncoordinate X\ncoordinate x\n"
                             "T = 1 [kg*m^2]*((X' + 4*(x - 2)^3*x')^2 + x'^2)/2\n"
                             "V = 1 [J]*((x - 2)^4 + (X + x)^4 - ((X + x)^2)^2)\n");
    derived_expect(&d, "kept powers");
    TEST_ASSERT_TRUE(d.equations->conserved[0]);
    TEST_ASSERT_FALSE(d.equations->conserved[1]);
    static const bool wanted[] = {true, false};
    diags *none = diags_new();
    conservation *c = conservation_make(d.equations, wanted, none);
    TEST_ASSERT_NOT_NULL(c);
    TEST_ASSERT_TRUE(c->closed); /* X = P t + G(start) - (x - 2)^4 */
    diags_free(none);
    derived_free(&d);
}

/* x^e and x^e (1 + x), with integer and half-integer exponents up to 1e14. x is so near 1 that the values stay
 * small. */
TEST(derive, large_exponents_are_not_cut) {
    uint64_t seed = 20;
    for (int i = 0; i < 200; i++) {
        const double size = pow(10.0, random_between(&seed, 0.0, 14.0));
        const double e = (i % 4 < 2 ? floor(size) : floor(size) + 0.5) * (i % 2 == 0 ? 1.0 : -1.0);
        char text[256];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x\nT = 1 [kg*m^2]*x'^2/2\n"
                 "output a = x^(%.17g)\noutput b = x^(%.17g)*(1 + x)\n",
                 e, e);
        derived d = derived_text(text);
        derived_expect(&d, text);
        state_values s = {.instance = d.instance};
        const double x = 1.0 + random_between(&seed, -1.0, 1.0) / (1.0 + size);
        double result[2];
        s.value[0][0] = x;
        derived_run(d.image->list[IMAGE_OBSERVE], &d, &s, result);
        const double wanted = pow(x, e);
        TEST_ASSERT_TRUE_MESSAGE(fabs(result[0] - wanted) <= 3e-14 * wanted, text);
        TEST_ASSERT_TRUE_MESSAGE(fabs(result[1] - wanted * (1.0 + x)) <= 6e-14 * wanted, text);
        derived_free(&d);
    }
}
