/* test_show_events.c: stops, frictions, holds and crossings as `derive` prints them. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/emit/emit.h"
#include "host/show/show_equations.h"
#include "unity.h"

void suite_show_events(void);

static const char text[] =
    "mechanism block\ncoordinate x [m]\ncoordinate phi [rad]\n"
    "parameter m = 2 [kg]\nparameter J = 1 [kg*m^2]\nparameter e = 0.5\nparameter mu = 0.25\n"
    "T = m*x'^2/2 + J*phi'^2/2\n"
    "when x' crosses 0 [m/s] falling { set x = -x, phi' = 2*phi' }\n"
    "friction phi static 2*mu kinetic mu normal 3 [N*m]\n"
    "hold phi while phi > 0 and x' < 1 [m/s]\n"
    "effect wall { stop x <= 3 [m] restitution e }\n"
    "stop x >= 0 [m] restitution e^2\n";

/* The events stand in what is printed, in their order, with `mark` before each. */
static void expect(void (*print)(FILE *, const derived *), const char *mark, bool wanted) {
    static const char *const lines[] = {"stop x >= 0, restitution e^2", "hold phi' = 0 while",
                                        "friction on phi: sticks up to 6*mu, slides with 3*mu",
                                        "when x' crosses 0 falling: x = -x, phi' = 2*phi'"};
    char *printed = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&printed, &size);
    derived d = derived_text(wanted ? text
                                    : "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2\n"
                                      "effect wall { stop x >= 0 restitution 0 }\n");
    TEST_ASSERT_NOT_NULL(out);
    TEST_ASSERT_NOT_NULL_MESSAGE(d.image, d.errors);
    print(out, &d);
    fclose(out);
    const char *from = printed;
    for (size_t i = 0; i < sizeof lines / sizeof lines[0] && wanted; i++) {
        char line[120];
        snprintf(line, sizeof line, "\n%s%s  %s", mark, mark[0] != '\0' ? " " : "", lines[i]);
        const char *found = strstr(from, line);
        if (found == NULL) {
            printf("not in its turn: %s\nin:\n%s\n", line, printed);
        }
        TEST_ASSERT_NOT_NULL(found);
        from = found + 1;
    }
    TEST_ASSERT_NULL_MESSAGE(strstr(printed, "3 - x"), "the effect that takes no part");
    if (!wanted) {
        TEST_ASSERT_NULL(strstr(printed, "event"));
        TEST_ASSERT_NULL(strstr(printed, "stop"));
    }
    free(printed);
    derived_free(&d);
}

static void as_text(FILE *out, const derived *d) { show_text(out, d->equations); }

static void as_latex(FILE *out, const derived *d) { show_latex(out, d->equations); }

static void as_octave(FILE *out, const derived *d) { derived_octave(out, d, "block.whirl", false); }

static void test_events_stand_beside_the_equations(void) {
    expect(as_text, "", true);
    expect(as_latex, "%", true); /* comments: not part of the formulas, nor of the function */
    expect(as_octave, "%", true);
}

static void test_no_events_no_word_of_them(void) {
    expect(as_text, "", false);
    expect(as_latex, "%", false);
    expect(as_octave, "%", false);
}

void suite_show_events(void) {
    RUN_TEST(test_events_stand_beside_the_equations);
    RUN_TEST(test_no_events_no_word_of_them);
}
