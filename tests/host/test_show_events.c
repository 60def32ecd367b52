/* test_show_events.c: stops, frictions, holds and crossings as `derive` prints them. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/emit/emit.h"
#include "host/show/show_equations.h"
#include "latex.h"
#include "printed.h"
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
    expect(as_octave, "%", true); /* comments: no part of the function */
}

static void test_no_events_no_word_of_them(void) {
    expect(as_text, "", false);
    expect(as_latex, "", false);
    expect(as_octave, "%", false);
}

/* Lines of a text that begin with the words, LaTeX's comments apart. */
static int lines_with(const char *all, const char *words) {
    int found = 0;
    for (const char *line = all; (line = strchr(line, '\n')) != NULL;) {
        line++;
        found += strncmp(line, words, strlen(words)) == 0;
    }
    return found;
}

/* A compiled page of LaTeX prints the rows, and they are no wider than A4 between margins of an inch. */
static void check_rows(const char *name, const char *all) {
    enum { PAPER = 455 };
    static const char begin[] = "\\begin{align*}";
    const char *from = strstr(all, begin);
    const char *where;
    TEST_ASSERT_NOT_NULL_MESSAGE(from, name);
    const char *end = strstr(from, "\\end{align*}");
    char *rows = strndup(from + strlen(begin), (size_t)(end - from) - strlen(begin));
    TEST_ASSERT_NULL_MESSAGE(latex_problem(rows, &where), name);
    TEST_ASSERT_TRUE_MESSAGE(latex_width(rows) <= PAPER, name);
    free(rows);
}

/* Every form names each contact of the file and each `when` of the scene that takes part. */
static int check_scene(const scene *of) {
    static const char *const begins[][2] = {{"  stop ", "  \\text{stop, "},
                                            {"  friction on ", "  \\text{friction on } "},
                                            {"  hold ", "  \\text{hold } "},
                                            {"  when ", "  \\text{when } "}};
    static const contact_kind kinds[] = {CONTACT_STOP, CONTACT_FRICTION, CONTACT_HOLD,
                                         CONTACT_WHEN};
    static const language forms[] = {TEXT, STEPS, LATEX, LATEX_STEPS};
    derived d = derived_builtin(of->name);
    const mechanism *m = d.instance->mechanism;
    int all = 0;
    for (int form = 0; form < 4; form += m->is_system ? 2 : 1) { /* a system has no steps */
        char *text_of = printed(&d, forms[form]);
        const bool latex = form >= 2;
        all = 0;
        for (int kind = 0; kind < 4; kind++) {
            int wanted = kinds[kind] == CONTACT_WHEN ? of->when_count : 0;
            for (int k = 0; k < m->contact_count; k++) {
                wanted += m->contacts[k].kind == kinds[kind] &&
                          instance_has_contact(d.instance, &m->contacts[k]);
            }
            const int rows = kinds[kind] == CONTACT_FRICTION && latex ? 2 : 1;
            TEST_ASSERT_EQUAL_INT_MESSAGE(rows * wanted, lines_with(text_of, begins[kind][latex]),
                                          of->name);
            all += wanted;
        }
        if (latex && all > 0) {
            check_rows(of->name, text_of);
        }
        free(text_of);
    }
    derived_free(&d);
    return all;
}

static void test_every_form_names_the_contacts(void) {
    TEST_ASSERT_GREATER_THAN_INT(40, each_builtin_scene(check_scene));
}

void suite_show_events(void) {
    RUN_TEST(test_events_stand_beside_the_equations);
    RUN_TEST(test_no_events_no_word_of_them);
    RUN_TEST(test_every_form_names_the_contacts);
}
