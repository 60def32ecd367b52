/* test_blame_lists.c: the expressions that Whirl checks if a value of a run is not a number. These are all
 * expressions on which the motion depends. If the equations contain derivatives of an expression, the derivatives
 * are listed, too, unless they always exist, as for sums, products, integer powers and waves. An expression has one
 * derivative for each coordinate in it; losses have one for each rate instead. */
#include "derived.h"

/* An expression of a (a length divided by 1 m), b (an angle) and their rates v and w. `places`: how many of a and b
 * the expression contains; `rates`: how many of v and w. Both are 0 if the derivatives always exist. */
typedef struct sample {
    const char *text;
    int places;
    int rates;
} sample;

static const sample samples[] = {
    {"2 + a", 0, 0},           {"a^2*b^3", 0, 0},
    {"a*cos(b)", 0, 0},        {"sin(3*b + a)^2", 0, 0},
    {"a*v^2*sin(b)*w", 0, 0},  {"cos(a*b)", 0, 0},
    {"cos(a^2)*b", 0, 0},      {"sqrt(a)", 1, 0},
    {"sqrt(a)*b", 2, 0},       {"b*sqrt(2 + a)*cos(b)", 2, 0},
    {"cos(sqrt(a))", 1, 0},    {"b*sin(b + 1/a)", 2, 0},
    {"1/(2 + a)", 1, 0},       {"b/(2 + a^2)", 2, 0},
    {"a^1.5", 1, 0},           {"a^2*b^0.5", 2, 0},
    {"abs(a)*b", 2, 0},        {"min(a, b)", 2, 0},
    {"exp(b)", 1, 0},          {"log(2 + a*b)", 2, 0},
    {"sqrt(v^2 + 1)", 0, 1},   {"sqrt(v^2 + w^2 + 1)", 0, 2},
    {"a*sqrt(v^2 + 1)", 1, 1}, {"abs(v)*sqrt(a)*w", 1, 2},
};

static int count_derived(const image *im, int first, int count, const char *text) {
    int derived_ones = 0;
    for (int i = first; i < first + count; i++) {
        const diagnostics_question *q = &im->diagnostics.question[i];
        TEST_ASSERT_TRUE_MESSAGE(q->node >= 0 && q->node < im->diagnostics.nodes, text);
        derived_ones += q->derived;
    }
    return derived_ones;
}

static derived with_statement(const char *statement) {
    static char text[600];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate b [rad]\n"
             "let a = x/1 [m]\nlet v = x'/1 [m/s]\nlet w = b'/1 [rad/s]\n"
             "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*b'^2/2\n%s\n",
             statement);
    derived d = derived_text(text);
    derived_expect(&d, text);
    return d;
}

/* Number of listed expressions of T: only T itself, because its derivatives always exist. */
enum { OF_T = 1 };

/* Losses have derivatives by the rates only. */
TEST(blame_lists, slopes_of_energies_and_losses) {
    for (size_t i = 0; i < sizeof samples / sizeof samples[0]; i++) {
        const sample *s = &samples[i];
        char text[200];
        const bool has_rates = strpbrk(s->text, "vw") != NULL;
        const int slopes = has_rates ? s->rates : s->places;
        snprintf(text, sizeof text, has_rates ? "F = 1 [W]*(%s)" : "V = 1 [J]*(%s)", s->text);
        derived d = with_statement(text);
        const image_diagnostics *b = &d.image->diagnostics;
        TEST_ASSERT_EQUAL_INT_MESSAGE(slopes, count_derived(d.image, 0, b->terms, text), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(OF_T + 1 + slopes, b->terms, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(b->terms, b->questions, text);
        derived_free(&d);
    }
}

/* Forces act directly, so their derivatives are not listed. */
TEST(blame_lists, forces_have_no_slopes) {
    for (size_t i = 0; i < sizeof samples / sizeof samples[0]; i++) {
        char text[200];
        snprintf(text, sizeof text, "Q(x) = 1 [N]*(%s)", samples[i].text);
        derived d = with_statement(text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(OF_T + 1, d.image->diagnostics.terms, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, count_derived(d.image, 0, OF_T + 1, text), text);
        derived_free(&d);
    }
}

/* Gaps and held expressions have derivatives by the coordinates. A crossing's value, a hold's condition and the
 * expressions of a friction have none. Contacts come after the terms; a stop's restitution comes last. */
TEST(blame_lists, slopes_of_contacts) {
    for (size_t i = 0; i < sizeof samples / sizeof samples[0]; i++) {
        const sample *s = &samples[i];
        const struct {
            const char *form;
            int values; /* number of values that are listed without derivatives */
            int late;
            bool slopes;
            bool takes_rates;
        } kinds[] = {
            {"stop %s >= -9 restitution 0.5*a", 1, 1, true, false},
            {"hold %s while a > 2", 2, 0, true, false},
            {"hold x while %s > 2", 2, 0, false, true},
            {"friction x static 0.5 kinetic 0.25 normal 1 [N]*(2 + %s)", 3, 0, false, true},
            {"when %s crosses 7 { set b = 1 }", 1, 0, false, true}};
        for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
            char text[200];
            if (strpbrk(s->text, "vw") != NULL && !kinds[k].takes_rates) {
                continue;
            }
            snprintf(text, sizeof text, kinds[k].form, s->text);
            derived d = with_statement(text);
            const image *im = d.image;
            const image_contact *c = &im->contact[0];
            const int slopes = kinds[k].slopes ? s->places : 0;
            TEST_ASSERT_EQUAL_INT_MESSAGE(
                slopes, count_derived(im, c->first_question, c->questions, text), text);
            TEST_ASSERT_EQUAL_INT_MESSAGE(kinds[k].values + slopes, c->questions, text);
            TEST_ASSERT_EQUAL_INT_MESSAGE(im->diagnostics.terms + im->diagnostics.sets,
                                          c->first_question, text);
            TEST_ASSERT_EQUAL_INT_MESSAGE(kinds[k].late, c->late, text);
            TEST_ASSERT_EQUAL_INT_MESSAGE(c->first_question + c->questions, c->first_late, text);
            TEST_ASSERT_EQUAL_INT_MESSAGE(c->sets, im->diagnostics.sets, text);
            derived_free(&d);
        }
    }
}
