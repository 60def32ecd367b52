/* test_let_rates.c: x1' and x1'' of `let x1 = ...`, compared with derivatives by the textbook's rules. A random tree
 * of functions is written once as a let, and once with its derivatives as text. Both files must give the same
 * equations. */
#include "command.h"
#include "derived.h"
#include "host/base/alloc.h"
#include "host/emit/emit.h"

/* A formula and its first and second derivative as texts, "0" if zero. They are freed at the end of the test. */
typedef struct formula {
    char *f, *d, *dd;
} formula;

static char *kept[4000];
static int kept_count;

static char *keep(char *text) {
    TEST_ASSERT_TRUE(kept_count < (int)(sizeof kept / sizeof kept[0]));
    return kept[kept_count++] = text;
}

#define TEXT(...) keep(alloc_words(__VA_ARGS__))

static void forget(void) {
    while (kept_count > 0) {
        free(kept[--kept_count]);
    }
}

/* f(u), with the texts `slope` for f'(u) and `bend` for f''(u). */
static formula chain(char *f, char *slope, char *bend, formula u) {
    return (formula){f, TEXT("(%s)*(%s)", slope, u.d),
                     TEXT("((%s)*(%s)^2 + (%s)*(%s))", bend, u.d, slope, u.dd)};
}

static formula leaf(dice *d) {
    switch (dice_one_of(d, 4)) {
    case 0: return (formula){"x/L", "x'/L", "x''/L"};
    case 1: return (formula){"a", "a'", "a''"};
    case 2: return (formula){"(a - 2*x/L)", "(a' - 2*x'/L)", "(a'' - 2*x''/L)"};
    default: return (formula){TEXT("(%g + a)", 0.25 * (1 + dice_one_of(d, 8))), "a'", "a''"};
    }
}

/* Draws a tree with `deep` levels. A quotient inside a power has many normal forms and is not drawn. */
static formula draw(dice *d, int deep) {
    if (deep == 0) {
        return leaf(d);
    }
    const formula u = draw(d, deep - 1);
    const bool has_quotient = strstr(u.f, ")/(") != NULL;
    switch (dice_one_of(d, has_quotient ? 5 : 14)) {
    case 0: return chain(TEXT("sin(%s)", u.f), TEXT("cos(%s)", u.f), TEXT("-sin(%s)", u.f), u);
    case 1: return chain(TEXT("cos(%s)", u.f), TEXT("-sin(%s)", u.f), TEXT("-cos(%s)", u.f), u);
    case 2: return chain(TEXT("exp(%s)", u.f), TEXT("exp(%s)", u.f), TEXT("exp(%s)", u.f), u);
    case 3: return chain(TEXT("sinh(%s)", u.f), TEXT("cosh(%s)", u.f), TEXT("sinh(%s)", u.f), u);
    case 4: return chain(TEXT("cosh(%s)", u.f), TEXT("sinh(%s)", u.f), TEXT("cosh(%s)", u.f), u);
    case 5: return chain(TEXT("(%s)^3", u.f), TEXT("3*(%s)^2", u.f), TEXT("6*(%s)", u.f), u);
    case 6: return chain(TEXT("log(%s)", u.f), TEXT("(%s)^-1", u.f), TEXT("-(%s)^-2", u.f), u);
    case 7:
        return chain(TEXT("sqrt(%s)", u.f), TEXT("(%s)^(-1/2)/2", u.f), TEXT("-(%s)^(-3/2)/4", u.f),
                     u);
    case 8: return chain(TEXT("abs(%s)", u.f), TEXT("sign(%s)", u.f), "0", u);
    case 9:
        return chain(TEXT("(%s)^k", u.f), TEXT("k*(%s)^(k - 1)", u.f),
                     TEXT("k*(k - 1)*(%s)^(k - 2)", u.f), u);
    case 10: return (formula){TEXT("-(%s)", u.f), TEXT("-(%s)", u.d), TEXT("-(%s)", u.dd)};
    default: break;
    }
    const formula v = draw(d, deep - 1);
    switch (dice_one_of(d, strstr(v.f, ")/(") != NULL ? 2 : 4)) {
    case 0:
        return (formula){TEXT("(%s + %s)", u.f, v.f), TEXT("(%s + %s)", u.d, v.d),
                         TEXT("(%s + %s)", u.dd, v.dd)};
    case 1:
        return (formula){TEXT("(%s - %s)", u.f, v.f), TEXT("(%s - (%s))", u.d, v.d),
                         TEXT("(%s - (%s))", u.dd, v.dd)};
    case 2:
        return (formula){TEXT("(%s)/(%s)", u.f, v.f),
                         TEXT("((%s)/(%s) - (%s)*(%s)*(%s)^-2)", u.d, v.f, u.f, v.d, v.f),
                         TEXT("((%s)/(%s) - 2*(%s)*(%s)*(%s)^-2 - (%s)*(%s)*(%s)^-2 + "
                              "2*(%s)*(%s)^2*(%s)^-3)",
                              u.dd, v.f, u.d, v.d, v.f, u.f, v.dd, v.f, u.f, v.d, v.f)};
    default:
        return (formula){
            TEXT("(%s)*(%s)", u.f, v.f), TEXT("((%s)*(%s) + (%s)*(%s))", u.d, v.f, u.f, v.d),
            TEXT("((%s)*(%s) + 2*(%s)*(%s) + (%s)*(%s))", u.dd, v.f, u.d, v.d, u.f, v.dd)};
    }
}

static derived moved(const formula *u, const formula *v, bool by_hand, char **text) {
    *text =
        TEXT("mechanism m\ncoordinate x [m]\ncoordinate a [rad]\nparameter L = 0.7 [m]\n"
             "parameter k = 2.5\nlet u = %s\nlet v = %s\nlet q = u + 3*v\n"
             "T = 2 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2 + 0.5 [kg*m^2]*(%s)^2/2\n"
             "V = 3 [N*m]*u + 2 [N*m]*v\nF = 0.1 [N*m*s]*(%s)^2/2\noutput o = %s\noutput w = %s\n",
             u->f, v->f, by_hand ? u->d : "u'", by_hand ? TEXT("%s + 3*(%s)", u->d, v->d) : "q'",
             by_hand ? u->dd : "u''", by_hand ? v->d : "v'");
    return derived_text(*text);
}

static void expect_same_numbers(const derived *a, const derived *b, const char *text) {
    enum { RESULTS = 64 };
    static const image_role roles[] = {IMAGE_STEP, IMAGE_OBSERVE};
    uint64_t seed = 4602;
    for (int k = 0; k < 10; k++) {
        state_values s;
        double of_a[RESULTS];
        double of_b[RESULTS];
        random_state(&s, a, &seed);
        for (int r = 0; r < 2; r++) {
            const op_list *t = a->image->list[roles[r]];
            TEST_ASSERT_TRUE(t->results <= RESULTS);
            derived_run(t, a, &s, of_a);
            derived_run(b->image->list[roles[r]], b, &s, of_b);
            for (int i = 0; i < t->results; i++) {
                const double off = fabs(of_a[i] - of_b[i]);
                TEST_ASSERT_TRUE_MESSAGE(off <= 1e-10 * (1.0 + fabs(of_a[i])) ||
                                             !isfinite(of_a[i]) || !isfinite(of_b[i]),
                                         text);
            }
        }
    }
}

/* Both files must give the same numbers, and in nine of ten cases the same C code. Powers of quotients in the other
 * cases have no unique normal form. */
TEST(let_rates, derivatives_of_lets_match_manual_ones) {
    dice d = dice_of("let_rates", 4601);
    const unsigned cases = dice_cases(usual_or(120, 20));
    unsigned compared = 0;
    unsigned equal = 0;
    for (unsigned c = 0; c < cases; c++) {
        char *text[2];
        const formula u = draw(&d, 1 + (int)dice_one_of(&d, 2));
        const formula v = draw(&d, 1);
        derived by_let = moved(&u, &v, false, &text[0]);
        derived by_hand = moved(&u, &v, true, &text[1]);
        TEST_ASSERT_TRUE_MESSAGE((by_let.image == NULL) == (by_hand.image == NULL), by_let.errors);
        if (by_let.image != NULL) {
            char *c_by_let = derived_written(emit_c, by_let.image);
            char *c_by_hand = derived_written(emit_c, by_hand.image);
            expect_same_numbers(&by_let, &by_hand, text[0]);
            compared++;
            equal += strcmp(c_by_let, c_by_hand) == 0;
            free(c_by_let);
            free(c_by_hand);
        }
        derived_free(&by_let);
        derived_free(&by_hand);
        forget();
    }
    printf("  %u mechanisms, %u of the same C\n", compared, equal);
    TEST_ASSERT_TRUE(compared >= cases / 2 && 10 * equal >= 9 * compared);
}

/* A derivative of a let is allowed wherever that of a coordinate is. A refusal must name the derivative's order. */
TEST(let_rates, derivatives_of_lets_keep_the_rules) {
    static const struct {
        const char *line;
        const char *said;
    } cases[] = {
        {"V = 1 [N]*z'", "V must be"},
        {"Q(x) = 1 [kg]*z''", "T, V, F and Q cannot contain a second derivative: \"z''\" has one"},
        {"stop z' >= 0 [m/s] restitution 0", "not on rates: \"z'\" has a rate"},
        {"output p = z'''", "at most two primes"},
        {"V = 1 [N]*(x + l'*1 [s])", ""},
        {"let w = n'", "the input 'f' has no declared rate"},
        {"when z' crosses 0 [m/s] { set x' = 0 }", ""},
        {"friction x static 0.3 kinetic 0.2 normal abs(z')*1 [kg/s]", ""},
        {"friction x static 0.3 kinetic 0.2 normal 1 [kg]*z''",
         "hint: write it with coordinates and rates"},
        {"when a'' crosses 0 [rad/s^2] { set x' = 0 }",
         "hint: write it with coordinates and rates"},
        {"output p = z''", ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[600];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\ncoordinate a [rad]\nparameter k = 2 [m]\n"
                 "input f = 2\nlet z = x + k*sin(a)\nlet l = 2*k\nlet n = f*x\n"
                 "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\n%s\n",
                 cases[i].line);
        const char *report = report_of_text(text);
        TEST_ASSERT_TRUE_MESSAGE(cases[i].said[0] == '\0' ? report[0] == '\0'
                                                          : strstr(report, cases[i].said) != NULL,
                                 cases[i].line);
    }
}
