/* test_rank.c: the rank of matrices that are made with a known rank, in any units of rows and columns, and the
 * round-off that counts as zero. Also solving, and scenes that cannot be derived. */
#include "test.h"

#include <time.h>

#include "host/cli/commands.h"
#include "host/derive/lagrange.h"
#include "host/image/lower.h"

#include "command.h"
#include "derived.h"

/* === suite rank =============================================================================== */

enum { MOST = 6 };

static double whole(uint64_t *seed, int most) {
    return (double)(random_bits(seed) % (uint64_t)(2 * most + 1)) - most;
}

/* The rank of a matrix of small integers, by Bareiss' elimination without fractions. */
static int exact_rank(const double *m, int n) {
    double a[MOST][MOST] = {{0.0}};
    for (int i = 0; i < n * n; i++) {
        a[i / n][i % n] = m[i];
    }
    double last = 1.0;
    int rank = 0;
    for (int column = 0; column < n && rank < n; column++) {
        int row = rank;
        while (row < n && a[row][column] == 0.0) {
            row++;
        }
        if (row == n) {
            continue;
        }
        for (int j = 0; j < n; j++) {
            const double swap = a[rank][j];
            a[rank][j] = a[row][j];
            a[row][j] = swap;
        }
        for (int i = rank + 1; i < n; i++) {
            for (int j = n - 1; j >= column; j--) {
                a[i][j] = (a[i][j] * a[rank][column] - a[i][column] * a[rank][j]) / last;
            }
        }
        last = a[rank][column];
        rank++;
    }
    return rank;
}

/* Computes m = left * right, with n by inner and inner by n numbers. */
static void product(double *m, const double *left, const double *right, int n, int inner) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            m[i * n + j] = 0.0;
            for (int k = 0; k < inner; k++) {
                m[i * n + j] += left[i * MOST + k] * right[k * MOST + j];
            }
        }
    }
}

static void errors_of(const double *m, double *error, int n) {
    for (int i = 0; i < n * n; i++) {
        error[i] = 4e-16 * fabs(m[i]);
    }
}

TEST(rank, rank_is_independent_of_units) {
    uint64_t seed = 17;
    int seen[MOST + 1] = {0};
    for (int round = 0; round < 3000; round++) {
        const int n = 1 + round % MOST;
        const int inner = (int)(random_bits(&seed) % (unsigned)(n + 1));
        double left[MOST * MOST];
        double right[MOST * MOST];
        double m[MOST * MOST];
        double error[MOST * MOST];
        const bool symmetric = round % 2 == 0;
        for (int i = 0; i < MOST * MOST; i++) {
            left[i] = whole(&seed, 3);
            right[i] = whole(&seed, 3);
        }
        for (int i = 0; i < MOST && symmetric; i++) {
            for (int k = 0; k < MOST; k++) {
                right[k * MOST + i] = left[i * MOST + k];
            }
        }
        product(m, left, right, n, inner);
        const int rank = exact_rank(m, n);
        seen[rank]++;
        int row[MOST];
        int column[MOST];
        for (int i = 0; i < n; i++) {
            row[i] = (int)whole(&seed, symmetric ? 60 : 30);
            column[i] = symmetric ? row[i] : (int)whole(&seed, 30);
        }
        for (int i = 0; i < n * n; i++) {
            m[i] = ldexp(m[i], row[i / n] + column[i % n]);
        }
        errors_of(m, error, n);
        TEST_ASSERT_EQUAL_INT(rank, rank_of(m, error, n, symmetric));
    }
    for (int r = 1; r <= MOST; r++) {
        TEST_ASSERT_GREATER_THAN_INT(50, seen[r]);
    }
}

/* In [1 1; 1 1 + x], the pivot of the second row is x. */
TEST(rank, pivots_of_round_off_are_zero) {
    for (int k = 0; k < 4; k++) {
        const bool symmetric = k % 2 == 0;
        double m[4] = {1.0, 1.0, 1.0, 1.0 + (k < 2 ? 2e-14 : 1e-13)};
        double error[4];
        errors_of(m, error, 2);
        TEST_ASSERT_EQUAL_INT(k < 2 ? 1 : 2, rank_of(m, error, 2, symmetric));
    }
    for (int k = 0; k < 4; k++) {
        /* a pivot counts as zero below n = 2 times the largest error: 1.4 or, if blurred, 1.6, times `size` */
        const double size = k % 2 == 0 ? 1.0 : 0x1p80;
        const bool blurred = k >= 2;
        double m[4] = {2.0 * size, size, size, 2.0 * size}; /* its pivots are 2 and 1.5 */
        double error[4] = {0.0, blurred ? 0.8 * size : 0.7 * size, 0.0, 0.0};
        TEST_ASSERT_EQUAL_INT(blurred ? 1 : 2, rank_of(m, error, 2, false));
    }
    double none[4] = {0.0, 0.0, 0.0, 0.0};
    double error[4] = {0.0, 0.0, 0.0, 0.0};
    TEST_ASSERT_EQUAL_INT(0, rank_of(none, error, 2, true));
    TEST_ASSERT_EQUAL_INT(0, rank_of(none, error, 2, false));
}

/* B Bt + I is positive definite. It is not if a diagonal entry becomes -1, or an entry beside the diagonal too
 * large. */
TEST(rank, positive_definite_matrices) {
    uint64_t seed = 23;
    for (int round = 0; round < 1000; round++) {
        const int n = 1 + round % MOST;
        double left[MOST * MOST];
        double right[MOST * MOST];
        double m[MOST * MOST];
        for (int i = 0; i < MOST; i++) {
            for (int k = 0; k < MOST; k++) {
                left[i * MOST + k] = whole(&seed, 3);
                right[k * MOST + i] = left[i * MOST + k];
            }
        }
        product(m, left, right, n, n);
        for (int i = 0; i < n; i++) {
            m[i * n + i] += 1.0;
        }
        double kept[MOST * MOST];
        memcpy(kept, m, sizeof kept);
        TEST_ASSERT_TRUE(rank_is_positive(m, n));
        const int at = (int)(random_bits(&seed) % (unsigned)n);
        memcpy(m, kept, sizeof kept);
        m[at * n + at] = -1.0;
        TEST_ASSERT_FALSE(rank_is_positive(m, n));
        if (n > 1) { /* a 2 by 2 part with a positive diagonal and a negative determinant */
            const int other = (at + 1) % n;
            memcpy(m, kept, sizeof kept);
            const double mixed = sqrt(m[at * n + at] * m[other * n + other]) + 0.5;
            m[at * n + other] = m[other * n + at] = mixed;
            TEST_ASSERT_FALSE(rank_is_positive(m, n));
        }
    }
}

/* The report must show the first equation whose highest derivatives are a combination of those in earlier equations,
 * or which has no highest derivatives. */
TEST(rank, the_equation_that_depends_is_shown) {
    uint64_t seed = 29;
    int shown = 0;
    for (int round = 0; round < 400; round++) {
        const int n = 2 + round % (MOST - 1);
        double m[MOST * MOST] = {0};
        const int poor =
            (int)(random_bits(&seed) %
                  (unsigned)n); /* this row is a combination of two earlier rows, or empty */
        for (int i = 0; i < n; i++) {
            const double first = i == poor ? whole(&seed, 2) : 0.0;
            const double second = i == poor ? whole(&seed, 2) : 0.0;
            for (int j = 0; j < n; j++) {
                m[i * n + j] = i != poor ? whole(&seed, 4)
                                         : (i > 0 ? first * m[j] : 0.0) +
                                               (i > 1 ? second * m[(i - 1) * n + j] : 0.0);
            }
        }
        char text[2048] = "mechanism m\n";
        size_t length = strlen(text);
        for (int i = 0; i < n; i++) {
            length += (size_t)snprintf(text + length, sizeof text - length, "state x%d\n", i);
        }
        for (int i = 0; i < n; i++) {
            length += (size_t)snprintf(text + length, sizeof text - length, "equation x0 = 1");
            for (int j = 0; j < n; j++) {
                if (m[i * n + j] != 0.0) {
                    length += (size_t)snprintf(text + length, sizeof text - length,
                                               " + (%g [s])*x%d'", m[i * n + j], j);
                }
            }
            length += (size_t)snprintf(text + length, sizeof text - length, "\n");
        }
        int row = 0;
        for (; row < n; row++) {
            double above[MOST * MOST] = {0};
            memcpy(above, m, sizeof(double) * (size_t)((row + 1) * n));
            if (exact_rank(above, n) <= row) {
                break;
            }
        }
        bool used = true; /* each rate must occur, else another error comes first */
        for (int j = 0; j < n; j++) {
            bool in_column = false;
            for (int i = 0; i < n; i++) {
                in_column = in_column || m[i * n + j] != 0.0;
            }
            used = used && in_column;
        }
        if (row == n || !used) {
            continue;
        }
        bool empty = true;
        for (int j = 0; j < n; j++) {
            empty = empty && m[row * n + j] == 0.0;
        }
        char wanted[64];
        snprintf(wanted, sizeof wanted, "t.whirl:%d:1: error: ", 2 + n + row);
        derived d = derived_text(text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, wanted), d.errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(
            strstr(d.errors, empty ? "this equation contains none"
                                   : "the same highest derivatives as a sum of multiples"),
            text);
        derived_free(&d);
        shown++;
    }
    printf("  %d systems, seed 29\n", shown);
    TEST_ASSERT_GREATER_THAN_INT(200, shown);
}

/* === suite solving ============================================================================ */
/* The operation list solves systems of one to five equations, with entries of every kind. The results must satisfy
 * the equations. Also the choice of turn angles. */

/* Writes an entry: zero, a number, or a function of the states, which is usually not small. */
static void entry(FILE *to, int n, unsigned variety, uint64_t *seed) {
    const unsigned state = random_one_of(seed, (unsigned)n);
    const double number = (double)random_one_of(seed, 9) / 4.0 - 1.0;
    switch (random_one_of(seed, variety)) {
    case 0: fputs("0", to); break;
    case 1: fprintf(to, "(%g)", number); break;
    case 2: fprintf(to, "(2 + %g*sin(x%u))", number, state); break;
    case 3: fprintf(to, "(%g + x%u)", number, state); break;
    case 4: fprintf(to, "cos(2*x%u + %g)", state, number); break;
    case 5: fprintf(to, "exp(x%u/4)", state); break;
    default: fprintf(to, "(1 + x%u^2)", state); break;
    }
}

static char *written_system(int n, uint64_t *seed) {
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(to);
    const unsigned variety = 2 + random_one_of(seed, 6); /* variety: 2 is numbers only */
    fputs("mechanism m\n", to);
    for (int i = 0; i < n; i++) {
        fprintf(to, "state x%d\n", i);
    }
    for (int i = 0; i < n; i++) {
        fputs("equation 1 [s]*(0", to);
        for (int j = 0; j < n; j++) {
            fputs(" + ", to);
            entry(to, n, variety, seed);
            fprintf(to, "*x%d'", j);
        }
        fputs(") = sin(x0) + ", to);
        entry(to, n, 7, seed);
        fputs("\n", to);
    }
    fclose(to);
    return text;
}

static int check_solution(const derived *d, uint64_t *seed, const char *text) {
    const equations *e = d->equations;
    int checked = 0;
    for (int k = 0; k < 3; k++) {
        state_values s;
        double result[UNKNOWNS];
        random_state(&s, d, seed);
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, result);
        double largest = 0.0;
        for (int i = 0; i < e->count; i++) {
            largest = fmax(largest, fabs(result[i]));
        }
        if (!isfinite(largest) || largest > 1e4) {
            continue; /* this state is nearly singular */
        }
        for (int i = 0; i < e->count; i++) {
            double size;
            const double rest = derived_rest(d, &s, result, i, &size);
            TEST_ASSERT_TRUE_MESSAGE(fabs(rest) <= 1e-9 * largest + 1e-9 * size, text);
        }
        checked++;
    }
    return checked;
}

/* Without a constant entry, the pivots are chosen by their values: all diagonal entries are zero. */
TEST(solving, zeros_on_the_diagonal_are_no_pivots) {
    static const char text[] =
        "mechanism m\nstate a\nstate b\nstate c\nstate d\n"
        "equation 1 [s]*((2 + sin(a))*b' + (3 + cos(b))*c' + (1 + a^2)*d') = 1\n"
        "equation 1 [s]*((2 + sin(c))*a' + (1 + b^2)*c' + (3 + sin(d))*d') = sin(a)\n"
        "equation 1 [s]*((1 + c^2)*a' + (5 + sin(b))*b' + (2 + cos(a))*d') = cos(b)\n"
        "equation 1 [s]*((2 + cos(a))*a' + exp(c)*b' + (7 + sin(d))*c') = d\n";
    uint64_t seed = 43;
    derived d = derived_surely(derived_text(text), text);
    TEST_ASSERT_EQUAL_INT(3, check_solution(&d, &seed, text));
    derived_free(&d);
}

TEST(solving, any_regular_system_is_solved) {
    uint64_t seed = 41;
    int checked[6] = {0};
    for (int round = 0; round < 1200; round++) {
        const int n = 1 + round % 5;
        char *text = written_system(n, &seed);
        derived d = derived_text(text);
        if (d.image != NULL) {
            checked[n] += check_solution(&d, &seed, text);
        }
        derived_free(&d);
        free(text);
    }
    printf("  seed 41: %d %d %d %d %d states\n", checked[1], checked[2], checked[3], checked[4],
           checked[5]);
    for (int n = 1; n <= 5; n++) {
        TEST_ASSERT_GREATER_THAN_INT(200, checked[n]);
    }
}

/* A force that contains the angle of a hinge inside functions is no sinusoid of this angle. Its second derivative may
 * exceed the limits of the algebra, so the solver must not ask for it. */
TEST(solving, functions_of_a_hinge_angle) {
    static const char *const function[] = {"sin", "cos", "tan", "exp", "atan"};
    uint64_t seed = 44;
    int checked = 0;
    for (int round = 0; round < 40; round++) {
        const char *f[6];
        for (int i = 0; i < 6; i++) {
            f[i] = function[random_one_of(&seed, 5)];
        }
        char text[512];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
                 "T = 1 [kg]*((x' + 1 [m]*a'*cos(a))^2 + (1 [m]*a'*sin(a))^2 + x'^2)/2\n"
                 "V = 1 [J]*atan2(x/1 [m] + 4, 2 + %s(%s(%s(sin(a)))*%s(%s(%s(sin(%u*a))))))\n",
                 f[0], f[1], f[2], f[3], f[4], f[5], 1U + (unsigned)round % 3U);
        derived d = derived_surely(derived_text(text), text);
        checked += check_solution(&d, &seed, text);
        derived_free(&d);
    }
    TEST_ASSERT_GREATER_THAN_INT(100, checked);
}

TEST(solving, long_products_keep_their_value) {
    uint64_t seed = 43;
    for (int factors = 20; factors <= 40; factors++) {
        char text[4096];
        size_t length = (size_t)snprintf(text, sizeof text,
                                         "mechanism m\ncoordinate q\ncoordinate x\n"
                                         "T = 1 [kg*m^2]*(q'^2 + x'^2)\noutput it = 0.5*q^2");
        for (int part = 0; part < 2; part++) {
            length += (size_t)snprintf(text + length, sizeof text - length, " + 3*x^%d", part + 1);
            for (int k = 1; k <= factors; k++) {
                length += (size_t)snprintf(text + length, sizeof text - length, "*atan(q + %d)^%u",
                                           k, 1 + random_one_of(&seed, 3));
            }
        }
        snprintf(text + length, sizeof text - length, "\n");
        derived d = derived_surely(derived_text(text), text);
        state_values s;
        double result[UNKNOWNS];
        random_state(&s, &d, &seed);
        derived_run(d.image->list[IMAGE_OBSERVE], &d, &s, result);
        const double wanted = poly_evaluate(d.equations->output[0], state_value, &s);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12 * fabs(wanted), wanted, result[0]);
        derived_free(&d);
    }
}

/* q can be a turn angle if it occurs only in sines and tangents, with integer factors. */
TEST(solving, allowed_turn_angles) {
    static const struct {
        const char *text;
        bool turns;
    } rows[] = {
        {"sin(q)", true},
        {"cos(3*q - 2*x + 0.7)", true},
        {"x*sin(q)^2 + exp(cos(2*q))", true},
        {"tan(q)", true},
        {"tan(2*q + x)", true},
        {"atan2(sin(q), cos(q))", true},
        {"sin(sin(q))", true},
        {"sin(x + 3*cos(q))", true},
        {"sin(x*sin(q))", true},
        {"sin(exp(sin(q)))", true},
        {"(2 + cos(q))^x", true},
        {"x^(2 + cos(q))", true},
        {"sqrt(3 + sin(q))", true},
        {"1 [s]*q'*cos(q)", true},
        {"sin(1 [s]*q')", true},
        {"x", true},
        {"q", false},
        {"q^2", false},
        {"x*q", false},
        {"sin(q) + q", false},
        {"sin(q/2)", false},
        {"sin(1.5*q)", false},
        {"sin(2000001*q)", false},
        {"tan(q/2)", false},
        {"tan(q^2)", false},
        {"sin(x*q)", false},
        {"sin(q^2)", false},
        {"sin(q*x + x)", false},
        {"sin(exp(q))", false},
        {"sin(x + exp(q/2))", false},
        {"sin(x*sin(q/2))", false},
        {"sin(sin(q/2))", false},
        {"sin(q*sin(x))", false},
        {"sin(x*atan2(x, q))", false},
        {"sin(x*atan2(q, x))", false},
        {"exp(q)", false},
        {"atan2(q, x)", false},
        {"atan2(x, q)", false},
        {"(2 + q^2)^x", false},
        {"x^q", false},
        {"(q + x)^3", false},
        {"sqrt(3 + q^2)", false},
        {"abs(sin(q) + q)", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[256];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate q\ncoordinate x\nT = 1 [kg*m^2]*(q'^2 + x'^2)\n"
                 "let it = %s\n",
                 rows[i].text);
        diags *all = diags_new();
        whirl_model *m = model_parse("t", text, strlen(text), all);
        if (m == NULL) {
            diags_flush(all, stdout);
        }
        TEST_ASSERT_NOT_NULL_MESSAGE(m, rows[i].text);
        algebra *a = algebra_new();
        const poly *p = poly_from_expr(a, m->mechanisms[0]->lets[0]->value);
        const symbol *q = m->mechanisms[0]->coordinates[0];
        TEST_ASSERT_TRUE_MESSAGE(lower_only_in_waves(p, q) == rows[i].turns, rows[i].text);
        algebra_free(a);
        model_free(m);
        diags_free(all);
    }
}

/* === suite underivable ======================================================================== */
/* Models that cannot be derived must be refused with their place, and within bounded time. */

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
    TEST_ASSERT_TRUE(seconds < 20.0); /* a bound that holds with sanitizers, too */
    derived_free(&d);
}

TEST(underivable, singular_mechanisms_are_refused) {
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
                   "the kinetic energy depends on input 'M', which has no declared rate");
    expect_refused(
        "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2\nV = 1 [J]*log(0*x/1 [m] - 1)*x/1 [m]\n",
        "have no finite value at any state tried");
    expect_refused("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2\n"
                   "V = 1 [J]*sqrt(-1 - (x/1 [m])^2)\n",
                   "have no finite value at any state tried");
}

TEST(underivable, kinetic_energy_must_be_positive) {
    expect_refused("mechanism m\ncoordinate x [m]\nT = -1 [kg]*x'^2/2\n",
                   "t.whirl:3:1: error: the kinetic energy of 'm' is negative for some rates");
    expect_refused("mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate z [m]\n"
                   "T = 1 [kg]*(x'*y' + y'*z' + z'^2/2)\n",
                   "t.whirl:5:1: error: the kinetic energy of 'm' is negative for some rates");
    expect_refused("mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\n"
                   "T = 1 [kg*m^2]*(a'^2/2 + b'^2/2 + (2 + cos(a))*a'*b')\n",
                   "t.whirl:4:1: error: the kinetic energy of 'm' is negative for some rates");
    /* the same matrix is accepted if it is written as equations */
    derived system =
        derived_surely(derived_text("mechanism m\nstate x\nstate y\nstate z\n"
                                    "equation 1 [s]*y' = x\nequation 1 [s]*(x' + z') = y\n"
                                    "equation 1 [s]*(y' + z') = z\n"),
                       "a system");
    derived_free(&system);
}

/* T is positive, or V is finite, only in a small range of x, in which no random state lies. If the start is in this
 * range, the mechanism must be derived. */
TEST(underivable, the_start_is_tried_too) {
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

TEST(underivable, constants_that_are_not_finite) {
    expect_refused("mechanism m\ncoordinate x [m]\nT = 1e-200 [kg]*x'^2/2\n"
                   "V = 1e200 [N/m]*x^2/2\n",
                   "t.whirl:1:11: error: the equations of 'm' contain a number that is not finite");
    expect_refused("mechanism m\ncoordinate x [m]\nparameter a = 0 [m]\nT = 1 [kg]*x'^2/2\n"
                   "output good = x\noutput bad [1] = sin(x/a)\n",
                   "t.whirl:6:8: error: output 'bad' contains a number that is not finite");
}

TEST(underivable, too_many_components) {
    char *states = repeated("mechanism m\nstate z\n", "state x#\n", 40, "");
    char *text = repeated(states, "equation 1 [s^2]*x#'' = z\n", 40, "equation 1 [s]*z' = x1\n");
    expect_refused(text, "t.whirl:1:11: error: 'm' has more than 64 coordinates, rates and states");
    free(text);
    free(states);
}

/* A product of sums of parameters, as in the energies of a long chain. With the change that the hint asks for, the
 * mechanism must be derived. */
TEST(underivable, a_hint_about_parameters_helps) {
    dice d = dice_of("parameters", 2);
    for (unsigned k = 0; k < 3; k++) {
        char text[2][4000];
        char wanted[100];
        const unsigned sums = 11 + dice_one_of(&d, 3);
        snprintf(wanted, sizeof wanted,
                 "hint: write 'let' instead of 'parameter', so that %u parameters become numbers",
                 3 * sums);
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

TEST(underivable, expressions_that_explode_are_refused) {
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
        expect_refused(text, "t.whirl:1:11: error: the equations of 'm' grow too large");
        free(text);
    }
    /* few objects, but 2^40 leaves for a traversal that visits an object again for each use */
    char *doubled = repeated(front, "let a# = exp(a@) + atan(a@)\n", 40,
                             "T = 1 [kg*m^2]*(x'^2 + y'^2)\noutput o = a40\n");
    expect_refused(doubled, "error: the equations of 'm' grow too large");
    free(doubled);
    /* at a smaller depth, the derivation may succeed, but must end in time */
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

/* Writes a random expression that is a length, changes with time and contains `number`. */
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

/* An expression that is compared with itself never changes its order, so it must be refused. If one side has another
 * number, it must be accepted. */
TEST(underivable, comparisons_with_itself_are_refused) {
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
