/* test_show.c: printed expressions. The language's parser must read them back as the same expressions, and their
 * LaTeX must compile (latex.h). Random expressions and mechanisms have fixed seeds; SHOW_CASES=N sets their number
 * instead of some hundreds. Also events. */
#include "test.h"

#include "host/emit/emit.h"
#include "host/show/show.h"

#include "derived.h"
#include "expressions.h"
#include "formula.h"
#include "latex.h"
#include "parsed.h"
#include "printed.h"
#include "reread.h"

/* === suite show =============================================================================== */

enum { TEXT_SIZE = 1 << 16 };

static const expression_names names = {reread_coordinates, REREAD_COORDINATES, 1, reread_constants,
                                       REREAD_CONSTANTS};

static const char front[] =
    "mechanism m\ncoordinate theta1\ncoordinate x\ncoordinate phi_1_a\ncoordinate _odd\n"
    "parameter a1 = 2\nparameter n_1 = 1.5\nparameter mass_of_it = 0.7\ninput Omega_ = 1.2\n"
    "input x__2 = 0.4\ninput y1 = 3\n";

static int cases(int usual) {
    const char *wanted = getenv("SHOW_CASES");
    return wanted != NULL ? (int)strtol(wanted, NULL, 10)
                          : usual / (getenv("WHIRL_FEW") != NULL ? 3 : 1);
}

static char *shown(algebra *a, const poly *p, show_style style) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    const show s = show_start(out, style, a);
    show_poly(&s, p);
    fclose(out);
    return text;
}

/* Has the expression a finite value at any of eight states? If not, a derivation refuses the expression. */
static bool is_ever_finite(const poly *p, uint64_t *seed) {
    bool finite = false;
    for (int k = 0; k < 8 && !finite; k++) {
        state s = random_values(seed);
        finite = isfinite(poly_evaluate(p, value_here, &s));
    }
    return finite;
}

/* A batch has BATCH expressions, and a derivative of each, which has more powers. */
enum { BATCH = 10, FORMULAS = 2 * BATCH };

static int check_batch(uint64_t *seed, int depth, int tame) {
    char *text = malloc((size_t)BATCH * TEXT_SIZE);
    TEST_ASSERT_NOT_NULL(text);
    size_t at = (size_t)sprintf(text, "%s", front);
    for (int i = 0; i < BATCH; i++) {
        at += (size_t)sprintf(text + at, "output f%d = ", i);
        expression_write(&names, depth, tame, seed, text + at, TEXT_SIZE / 2);
        at += strlen(text + at);
        at += (size_t)sprintf(text + at, "\n");
    }
    sprintf(text + at, "T = 1 [kg*m^2]*(theta1'^2 + x'^2 + phi_1_a'^2 + _odd'^2)\n");
    const mechanism *m = parse(text);
    algebra *a = algebra_new();
    const poly *p[FORMULAS];
    char *printed_text[FORMULAS] = {NULL};
    int count = 0;
    for (int i = 0; i < BATCH; i++) {
        p[count++] = poly_from_expr(a, m->outputs[i]->value);
        p[count] = poly_derivative(a, p[count - 1],
                                   m->coordinates[random_bits(seed) % REREAD_COORDINATES], 0);
        count++;
    }
    int kept = 0;
    const bool overflowed = algebra_overflow(a); /* printing may overflow, too */
    for (int i = 0; i < count && !overflowed; i++) {
        if (!is_ever_finite(p[i], seed)) {
            continue;
        }
        char *one = shown(a, p[i], SHOW_TEXT);
        if (strlen(one) > TEXT_SIZE || strstr(one, "inf") != NULL || strstr(one, "nan") != NULL) {
            free(one); /* never finite: would be refused */
            continue;
        }
        char *latex = shown(a, p[i], SHOW_LATEX);
        expect_compiles(latex);
        free(latex);
        p[kept] = p[i];
        printed_text[kept++] = one;
    }
    read_back b = parse_back((const char *const *)printed_text, kept);
    if (b.instance == NULL) {
        printf("%s", text);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(b.instance, "what was printed is not read back");
    int compared = 0;
    for (int i = 0; i < kept; i++) {
        const quantity q = {poly_here, a, p[i], NULL, 0};
        compared += compare(&q, printed_text[i], &b, i, -1, seed) > 0;
        free(printed_text[i]);
    }
    drop_back(&b);
    algebra_free(a);
    free(text);
    drop();
    return compared;
}

TEST(show, expressions_are_read_back_as_printed) {
    const int wanted = cases(600);
    uint64_t seed = 20;
    int compared = 0;
    int made_up = 0;
    for (; made_up < wanted; made_up += FORMULAS) {
        const uint64_t before = seed;
        const int here =
            check_batch(&seed, 1 + made_up / FORMULAS % 5, made_up / FORMULAS % 3 != 0);
        compared += here;
        (void)before;
    }
    printf("  seed 20: %d of %d expressions compared\n", compared, made_up);
    TEST_ASSERT_TRUE(10 * compared > 6 * made_up);
}

/* Splits a line in place at each " = ". Returns the number of formulas. */
static int formulas_of(char *line, char **formula) {
    int count = 0;
    for (char *next = line; next != NULL; line = next) {
        next = strstr(line, " = ");
        if (next != NULL) {
            *next = '\0';
            next += 3;
        }
        formula[count++] = line;
    }
    return count;
}

/* The difference of the two sides of a printed equation must be the derived A q'' - f. Returns the number of
 * compared states. */
static int compare_sides(const equations *e, int row, const read_back *b, const char *text,
                         uint64_t *seed) {
    algebra *a = e->algebra;
    const poly *rest = poly_scale(a, equations_force(e, row), -1.0);
    for (int j = 0; j < e->count; j++) {
        const poly *highest = poly_symbol(a, e->unknowns[j].symbol, e->unknowns[j].order);
        rest = poly_add(a, rest, poly_mul(a, e->mass[row * e->count + j], highest));
    }
    const quantity q = {poly_here, a, rest, NULL, 0};
    return compare(&q, text, b, 2 * row, 2 * row + 1, seed) > 0;
}

static double solution_here(const quantity *of, const state *at, double *size) {
    const equations *e = of->equations;
    double m[4];
    double f[2];
    state s = *at;
    bool good = true;
    for (int i = 0; i < 2; i++) {
        good = good && is_in_range(equations_force(e, i), 1e5, &s) &&
               is_in_range(e->mass[2 * i], 1e5, &s) && is_in_range(e->mass[2 * i + 1], 1e15, &s);
        f[i] = poly_evaluate(equations_force(e, i), value_here, &s);
        m[2 * i] = poly_evaluate(e->mass[2 * i], value_here, &s);
        m[2 * i + 1] = poly_evaluate(e->mass[2 * i + 1], value_here, &s);
    }
    const double bottom = m[0] * m[3] - m[1] * m[2];
    const int k = of->unknown;
    const double top = k == 0 ? f[0] * m[3] - m[1] * f[1] : m[0] * f[1] - f[0] * m[2];
    *size = (fabs(m[0] * m[3]) + fabs(m[1] * m[2])) * fabs(top / bottom / bottom) +
            (fabs(f[0]) + fabs(f[1])) * (fabs(m[k == 0 ? 3 : 0]) + fabs(m[1 + k])) / fabs(bottom);
    /* NaN if products in the formula would be too large */
    return good ? top / bottom : (double)NAN;
}

static void check_align(const derived *d) {
    char *text = printed(d, LATEX);
    int blocks = 0;
    for (char *at = text; (at = strstr(at, "\\begin{align}")) != NULL; blocks++) {
        char *end = strstr(at, "\\end{align}");
        TEST_ASSERT_NOT_NULL(end);
        *end = '\0';
        expect_compiles(at + strlen("\\begin{align}"));
        at = end + 1;
    }
    TEST_ASSERT_TRUE(blocks == 1 || blocks == 2);
    free(text);
}

static int check_mechanism(int depth, uint64_t *seed) {
    char *source_text = malloc(TEXT_SIZE);
    TEST_ASSERT_NOT_NULL(source_text);
    expression_mechanism(depth, seed, source_text, TEXT_SIZE);
    derived d = derived_text(source_text);
    if (d.equations == NULL) { /* refused, for example because the mass matrix is never finite */
        TEST_ASSERT_TRUE_MESSAGE(strstr(d.errors, "finite") != NULL ||
                                     strstr(d.errors, "grow beyond") != NULL,
                                 d.errors);
        derived_free(&d);
        free(source_text);
        return 0;
    }
    TEST_ASSERT_EQUAL_INT(2, d.equations->count);
    check_align(&d);
    char *text = printed(&d, TEXT);
    char *formula[64];
    int count = 0;
    int solved[2] = {-1, -1};
    char *line = strstr(strstr(text, "\nequations"), "\n\n") + 2;
    for (int i = 0; i < 2; i++) {
        char *end = strchr(line, '\n');
        char *label = strstr(line, ":  ");
        *end = '\0';
        TEST_ASSERT_EQUAL_INT(2, formulas_of(label != NULL ? label + 3 : line, formula + count));
        count += 2;
        line = end + 1;
    }
    for (int i = 0; i < 2; i++) { /* lines such as s3' = theta1'' = FORMULA */
        char wanted[32];
        const unknown *u = &d.equations->unknowns[i];
        snprintf(wanted, sizeof wanted, " = %s%.*s = ", u->symbol->name, u->order, "''''");
        char *at = strstr(line, wanted);
        if (at != NULL) {
            char *end = strchr(at, '\n');
            *end = '\0';
            solved[i] = count;
            formula[count++] = at + strlen(wanted);
            line = end + 1;
        }
    }
    read_back b = parse_back((const char *const *)formula, count);
    if (b.instance == NULL) {
        printf("%s", source_text);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(b.instance, "what was printed is not read back");
    int compared = 0;
    for (int i = 0; i < 2; i++) {
        compared += compare_sides(d.equations, i, &b, formula[2 * i], seed);
        const quantity q = {solution_here, NULL, NULL, d.equations, i};
        if (solved[i] >= 0) {
            compared += compare(&q, formula[solved[i]], &b, solved[i], -1, seed) > 0;
        }
    }
    drop_back(&b);
    free(text);
    derived_free(&d);
    free(source_text);
    return compared;
}

TEST(show, mechanisms_are_read_back_as_printed) {
    const int wanted = cases(600) / 10;
    uint64_t seed = 21;
    int compared = 0;
    for (int i = 0; i < wanted; i++) {
        compared += check_mechanism(1 + i % 4, &seed);
    }
    printf("  seed 21: %d formulas of %d mechanisms compared\n", compared, wanted);
    TEST_ASSERT_TRUE(compared > wanted);
}

/* Value of a name: q, n, or one of the lets a0 = q to a13 and g. */
static double q_or_n(void *context, const char *name, int length) {
    const state_values *s = context;
    const double q = s->value[0][0];
    const double n = s->instance->parameter[0];
    const bool is_last = length == 1 && *name == 'g';
    double a = q;
    for (int k = 0; k < (is_last ? 13 : (int)strtol(name + 1, NULL, 10)); k++) {
        a = exp(-fabs(a * q + a + n));
    }
    return is_last        ? tan(a) + tan(2.0 * a) + tan(3.0 * a) + tan(4.0 * a) + tan(5.0 * a)
           : *name == 'a' ? a
           : *name == 'q' ? q
                          : n;
}

/* The factored form of this right side would contain the expanded square of a large sum, which overflows. The
 * printed form must still have every term. */
TEST(show, printing_outlives_an_overflow) {
    char *source_text =
        repeated("mechanism m\ncoordinate q\nparameter n = 0.1\nlet a0 = q\n",
                 "let a# = exp(-abs(a@*q + a@ + n))\n", 13,
                 "let g = tan(a13) + tan(2*a13) + tan(3*a13) + tan(4*a13) + tan(5*a13)\n"
                 "T = 1 [kg*m^2]*q'^2/2\nQ(q) = 1 [N*m]*(g^3*q + g^5*n)\n");
    derived d = derived_surely(derived_text(source_text), "a large force");
    TEST_ASSERT_FALSE(algebra_overflow(d.equations->algebra));
    char *text = printed(&d, TEXT);
    TEST_ASSERT_TRUE_MESSAGE(algebra_overflow(d.equations->algebra), "a larger one is needed");
    const char *right = strstr(text, "  q:  q'' = ");
    TEST_ASSERT_NOT_NULL(right);
    uint64_t seed = 23;
    for (int k = 0; k < REREAD_STATES; k++) {
        state_values s;
        const char *end;
        random_state(&s, &d, &seed);
        const double wanted = poly_evaluate(d.equations->applied[0], state_value, &s);
        const double got = formula_value(right + strlen("  q:  q'' = "), &end, q_or_n, &s);
        TEST_ASSERT_EQUAL_INT('\n', *end);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * fabs(wanted), wanted, got);
    }
    free(text);
    derived_free(&d);
    free(source_text);
}

/* === suite show_events ======================================================================== */
/* Stops, frictions, holds and crossings, as `whirl derive` prints them. */

static const char text[] =
    "mechanism block\ncoordinate x [m]\ncoordinate phi [rad]\n"
    "parameter m = 2 [kg]\nparameter J = 1 [kg*m^2]\nparameter e = 0.5\nparameter mu = 0.25\n"
    "T = m*x'^2/2 + J*phi'^2/2\n"
    "when x' crosses 0 [m/s] falling { set x = -x, phi' = 2*phi' }\n"
    "friction phi static 2*mu kinetic mu normal 3 [N*m]\n"
    "hold phi while phi > 0 and x' < 1 [m/s]\n"
    "effect wall { stop x <= 3 [m] restitution e }\n"
    "stop x >= 0 [m] restitution e^2\n";

/* The events must appear in sequence, each after `mark`. */
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

TEST(show_events, events_are_printed_with_equations) {
    expect(as_text, "", true);
    expect(as_octave, "%", true); /* as comments */
}

TEST(show_events, no_text_without_events) {
    expect(as_text, "", false);
    expect(as_latex, "", false);
    expect(as_octave, "%", false);
}

/* Number of lines that begin with the words, perhaps after a LaTeX comment sign. */
static int lines_with(const char *all, const char *words) {
    int found = 0;
    for (const char *line = all; (line = strchr(line, '\n')) != NULL;) {
        line++;
        found += strncmp(line, words, strlen(words)) == 0;
    }
    return found;
}

/* The rows must compile in LaTeX and fit A4 with margins of one inch. */
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
    /* a system is not printed as steps */
    for (int form = 0; form < 4; form += m->is_system ? 2 : 1) {
        char *text_of = printed(&d, forms[form]);
        const bool latex = form >= 2;
        all = 0;
        for (int kind = 0; kind < 4; kind++) {
            int wanted = kinds[kind] == CONTACT_WHEN ? of->when_count : 0;
            for (int k = 0; k < m->contact_count; k++) {
                wanted += m->contacts[k].kind == kinds[kind] &&
                          instance_has(d.instance, m->contacts[k].effect);
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

TEST(show_events, every_form_names_the_contacts) {
    TEST_ASSERT_GREATER_THAN_INT(40, each_builtin_scene(check_scene));
}
