/* test_influence.c: `conserve` with forces, losses and contacts. The message must name the reason why a momentum is
 * not conserved, and a conserved coordinate on which others depend must be accurate. */
#include "derived.h"
#include "host/image/program.h"
#include "motion.h"
#include "parsed.h"
#include "ranges.h"

#define CART \
    "mechanism cart\ncoordinate x [m]\ncoordinate y [m]\ninput push = 0 [N]\n" \
    "T = 2 [kg]*(x'^2 + y'^2 + (x' + y')^2)/2\nV = 1 [N/m]*y^2/2\n" \
    "effect drag { F += 1 [N*s/m]*(x' - y')^2/2 }\neffect motor { Q(x) += push }\n" \
    "effect wall { stop x <= 1 [m] restitution 0.5 }\neffect latch { hold x - y while y > 0 }\n" \
    "effect rub { friction x static 0.3 kinetic 0.2 normal 1 [N] }\n" \
    "effect own { Q(y) += push\n  stop y <= 1 [m] restitution 0.5 }\n"

/* Fails the test if the scene's `conserve` is not refused with the text `wanted`. */
static void refused(const char *scene_text, const char *wanted) {
    char text[1200];
    snprintf(text, sizeof text, "%s%s", CART, scene_text);
    parse(text);
    instantiate(NULL);
    equations *e = equations_derive(made, said);
    TEST_ASSERT_TRUE(e != NULL &&
                     program_make(e, parsed->scenes[0]->conserve, &plainly, said) == NULL);
    equations_free(e);
    expect_said(wanted);
}

static void test_what_acts_is_named_with_its_line(void) {
    refused("scene s { with drag; conserve x }", "changed by the F in line 7\n");
    refused("scene s { with motor; conserve x }", "changed by the Q in line 8\n");
    refused("scene s { with wall; conserve x }", "changed by the stop in line 9\n");
    refused("scene s { with latch; conserve x }", "changed by the hold in line 10\n");
    refused("scene s { with rub; conserve x }", "changed by the friction in line 11\n");
    refused("scene s { conserve x\n when y crosses 1 [m] { set y' = 0 } }",
            "changed by the crossing in line 15\n");
    refused("scene s { with drag, motor, own; conserve x }", "changed by the F in line 7\n");
    refused("scene s { with drag, motor, wall, latch, rub; conserve x }",
            "changed by the F in line 7\n");
    refused("scene s { conserve y }", "the energies depend on y\n");
}

static void test_what_acts_on_others_only_is_no_reason(void) {
    parse(CART "scene s { with own; conserve x }");
    instantiate(NULL);
    equations *e = equations_derive(made, said);
    program *p = e == NULL ? NULL : program_make(e, parsed->scenes[0]->conserve, &plainly, said);
    TEST_ASSERT_TRUE(p != NULL && p->layout.conserved->closed);
    image_free(p->draft.made);
    equations_free(e);
}

/* A clock drives a mass on a spring, which starts at rest: m x'' + k x = F sin(w t). Except at resonance, x = F/(k -
 * m w^2) (sin(w t) - w/w0 sin(w0 t)), with w0 = sqrt(k/m). With h w0 = 0.005, the error of Runge-Kutta over 50 rad
 * is about 50 (h w0)^4/120 = 3e-10 of 0.125 m. The clock is a sum of 1e4 steps with an error of 1e-12. */
static void expect_driven(const char *clock) {
    char text[600];
    snprintf(text, sizeof text,
             "mechanism driven\ncoordinate x [m]\n%s\n"
             "T = 2 [kg]*x'^2/2 + clock_T\nV = 50 [N/m]*x^2/2\nQ(x) = 4 [N]*sin(angle)\n"
             "scene s {\n  start clock' = rate\n  conserve clock\n  until 10 [s]\n}\n",
             clock);
    motion m;
    motion_open_text(&m, text, IN_DOUBLE);
    motion_to(&m, 10.0);
    const double w0 = 5.0;
    const double wanted = 4.0 / (50.0 - 2.0 * 9.0) * (sin(3.0 * 10.0) - 3.0 / w0 * sin(w0 * 10.0));
    expect_between("x of the driven spring off its closed form, m", 1e-13, 1e-10,
                   fabs(motion_value(&m, "x") - wanted));
    motion_close(&m);
}

static void test_a_conserved_clock_drives(void) {
    expect_driven("coordinate clock [s]\nparameter rate = 1\nlet angle = 3 [1/s]*clock\n"
                  "let clock_T = 1e-9 [J]*clock'^2/2");
    expect_driven("coordinate clock [rad]\nparameter rate = 3 [1/s]\nlet angle = clock\n"
                  "let clock_T = 1e-9 [kg*m^2]*clock'^2/2");
}

/* No force acts on x, but an expression of a contact of y contains x. Then x must be in the state. */
static void test_a_contact_that_names_it_keeps_it_in_the_state(void) {
    static const char *const contacts[] = {
        "stop y <= 1 [m] restitution x/10 [m]",
        "hold y while x > 0",
        "friction y static x/10 [m] kinetic 0.2 normal 1 [N]",
        "friction y static 0.3 kinetic x/10 [m] normal 1 [N]",
        "friction y static 0.3 kinetic 0.2 normal 1 [N/m]*x",
    };
    for (size_t i = 0; i < sizeof contacts / sizeof contacts[0]; i++) {
        char text[600];
        snprintf(text, sizeof text,
                 "mechanism two\ncoordinate x [m]\ncoordinate y [m]\n"
                 "T = 2 [kg]*(x'^2 + y'^2)/2\nV = 1 [N/m]*y^2/2\n%s\nscene s { conserve x }\n",
                 contacts[i]);
        parse(text);
        instantiate(NULL);
        equations *e = equations_derive(made, said);
        TEST_ASSERT_TRUE_MESSAGE(
            e != NULL && program_make(e, parsed->scenes[0]->conserve, &plainly, said) == NULL,
            contacts[i]);
        equations_free(e);
        expect_said("cannot compute a coordinate's rate from its conserved momentum");
    }
}

/* Every expression of a contact is checked for a value that is not a number. The message must have its place. */
static void test_a_contact_without_a_number_is_refused(void) {
    static const struct {
        const char *contact;
        const char *column;
    } rows[] = {
        {"stop y <= 1 [m]/(k - k) restitution 0.5", ":6:1: "},
        {"stop y <= 1 [m] restitution 0.5/(k - k)", ":6:"},
        {"hold y while 1/(k - k) > 0", ":6:"},
        {"friction y static 0.3/(k - k) kinetic 0.2 normal 1 [N]", ":6:"},
        {"friction y static 0.3 kinetic 0.2/(k - k) normal 1 [N]", ":6:"},
        {"friction y static 0.3 kinetic 0.2 normal 1 [N]/(k - k)", ":6:1: "},
        {"when y crosses 1 [m]/(k - k) { set y = 0 }", ":6:1: "},
        {"when y crosses 1 [m] { set y = 1 [m]/(k - k) }", ":6:28: "},
        {"when y crosses 1 [m] { set y = 0\n set y' = 1 [m/s]/(k - k) }", ":7:6: "},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[600];
        snprintf(text, sizeof text,
                 "mechanism two\ncoordinate y [m]\nparameter k = 2\n"
                 "T = 2 [kg]*y'^2/2\nV = 1 [N/m]*y^2/2\n%s\n",
                 rows[i].contact);
        derived d = derived_text(text);
        TEST_ASSERT_TRUE_MESSAGE(d.image == NULL, rows[i].contact);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, "finite"), d.errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, rows[i].column), d.errors);
        derived_free(&d);
    }
}

SUITE(influence) {
    RUN_TEST(test_a_contact_that_names_it_keeps_it_in_the_state);
    RUN_TEST(test_a_contact_without_a_number_is_refused);
    RUN_TEST(test_what_acts_is_named_with_its_line);
    RUN_TEST(test_what_acts_on_others_only_is_no_reason);
    RUN_TEST(test_a_conserved_clock_drives);
    drop();
}
