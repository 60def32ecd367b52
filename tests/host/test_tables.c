/* test_tables.c: accelerations from tables of functions of one angle (--tables): the error of the tables, the error
 * and order of the motion, and refusals. */
#include "command.h"
#include "core/step/table.h"
#include "derived.h"
#include "host/engine/engine.h"
#include "table_check.h"

enum { VALUES = 3 * IMAGE_COMPONENTS_MAX, RESULTS = 8 };

static const image_tables both[] = {TABLES_LINEAR, TABLES_CUBIC};
enum { FORMS = 2 };

/* Makes an image with tables. Returns NULL if it is refused. *report: the reason, which the caller frees. */
static image *tabled(const derived *d, image_tables form, int cells, char **report) {
    const image_settings settings = {.tables = form, .cells = cells, .method = WH_RK4};
    diags *errors = diags_new();
    image *im = image_make(d->equations, d->instance->conserve, &settings, IMAGE_TO_WRITE, errors);
    size_t size = 0;
    FILE *out = open_memstream(report, &size);
    TEST_ASSERT_NOT_NULL(out);
    diags_flush(errors, out);
    fclose(out);
    diags_free(errors);
    return im;
}

static image *tabled_surely(const derived *d, image_tables form, int cells) {
    char *report = NULL;
    image *im = tabled(d, form, cells, &report);
    TEST_ASSERT_NOT_NULL_MESSAGE(im, report);
    TEST_ASSERT_EQUAL_STRING("", report);
    free(report);
    return im;
}

/* Samples one of 2^14 phases (`make test`: one of 2^16). `make tables-exhaustive` tests all phases. */
static int check_scene(const scene *s) {
    derived d = derived_surely(derived_builtin(s->name), s->name);
    char *report = NULL;
    image *im = tabled(&d, TABLES_LINEAR, 256, &report);
    const bool has = im != NULL;
    image_free(im);
    free(report);
    for (int f = 0; f < FORMS && has; f++) {
        static table_error error[1][TABLE_CHECK_MOST];
        im = tabled_surely(&d, both[f], f == 0 ? 256 : 64);
        const op_list_tables *t = &im->list[IMAGE_STEP]->tables;
        TEST_ASSERT_TRUE(t->count > 0 && t->count <= TABLE_CHECK_MOST);
        table_check((const image *const *)&im, 1, UINT64_C(1) << few_or_all(16, 14), error);
        for (int k = 0; k < t->count; k++) {
            char text[200];
            snprintf(text, sizeof text, "%s, table %d, %s: worst %.3g, bound %.3g, stated %.3g",
                     s->name, k, image_tables_words[both[f]], error[0][k].worst, error[0][k].bound,
                     t->off[k]);
            TEST_ASSERT_TRUE_MESSAGE(error[0][k].worst <= error[0][k].bound, text);
            TEST_ASSERT_TRUE_MESSAGE(error[0][k].worst >= 0.7 * t->off[k], text);
            /* with six weights, a sixth harmonic has the error 2/3 (2 pi 6/256)^2/8, relative to its size */
            TEST_ASSERT_TRUE_MESSAGE(t->off[k] > 0.0 && t->off[k] < 2e-3 * t->size[k], text);
        }
        image_free(im);
    }
    derived_free(&d);
    return has;
}

TEST(tables, table_errors_are_within_their_bound) {
    TEST_ASSERT_GREATER_OR_EQUAL_INT(9, each_builtin_scene(check_scene));
}

static double piece(const op_list_tables *t, int k, int cell, double y, int derivative) {
    const double *c = &t->number[((cell & ((1 << t->bits) - 1)) * t->count + k) * t->terms];
    double value = 0.0;
    for (int i = t->terms - 1; i >= derivative; i--) {
        value = (derivative == 0 ? 1.0 : i) * c[i] + y * value;
    }
    return value;
}

TEST(tables, pieces_are_continuous) {
    derived d = derived_builtin("halvorson_smooth");
    for (int f = 0; f < FORMS; f++) {
        image *im = tabled_surely(&d, both[f], 32);
        const op_list_tables *t = &im->list[IMAGE_STEP]->tables;
        double jump[2] = {0.0, 0.0};
        for (int k = 0; k < t->count; k++) {
            for (int i = 0; i < 32; i++) {
                for (int n = 0; n < 2; n++) {
                    const double off = piece(t, k, i, 0.5, n) - piece(t, k, i + 1, -0.5, n);
                    jump[n] = fmax(jump[n], fabs(off) / t->size[k]);
                }
            }
        }
        TEST_ASSERT_TRUE(jump[0] < 1e-14);
        TEST_ASSERT_TRUE(f == 0 ? jump[1] > 1e-3 : jump[1] < 1e-13);
        image_free(im);
    }
    derived_free(&d);
}

/* Writes terms such as " + 0.123*sin(2*th)", whose sum is at most `most`. */
static void write_fourier(FILE *out, uint64_t *seed, double most) {
    const int terms = 1 + (int)(random_bits(seed) % 3);
    for (int i = 0; i < terms; i++) {
        fprintf(out, " %c %.3f*%s(%d*th)", random_bits(seed) % 2 == 0 ? '+' : '-',
                random_between(seed, 0.3, 1.0) * most / terms,
                random_bits(seed) % 2 == 0 ? "sin" : "cos", 1 + (int)(random_bits(seed) % 4));
    }
}

static void write_sum(FILE *out, uint64_t *seed, const char *before, double least, double most,
                      const char *behind) {
    fprintf(out, "%s(%.2f", before, least);
    write_fourier(out, seed, most);
    fprintf(out, ")%s", behind);
}

/* Writes a mechanism of `count` coordinates. The diagonal of its mass matrix makes it positive definite. */
static void write_mechanism(FILE *out, int count, uint64_t *seed) {
    static const char *const name[] = {"th", "x", "y"};
    char product[40];
    fprintf(out, "mechanism drawn\n");
    for (int i = 0; i < count; i++) {
        fprintf(out, "coordinate %s [rad]\n", name[i]);
    }
    fprintf(out, "input u = 0.7 [N*m]\nT = 1 [kg*m^2]*(0");
    for (int i = 0; i < count; i++) {
        for (int k = 0; k <= i; k++) {
            snprintf(product, sizeof product, "*%s'*%s'", name[i], name[k]);
            write_sum(out, seed, " + ", i == k ? 1.2 : 0.0, i == k ? 0.3 : 0.4, product);
        }
    }
    fprintf(out, ")\nV = 1 [J]*(0");
    write_fourier(out, seed, 2.0);
    for (int i = 1; i < count; i++) {
        for (int k = 1; k <= i; k++) {
            snprintf(product, sizeof product, "*%s*%s", name[i], name[k]);
            write_sum(out, seed, " + ", i == k ? 2.0 : 0.3, 0.5, product);
        }
    }
    fprintf(out, ")\nF = 0.1 [N*m*s]*th'^2/2\n");
    write_sum(out, seed, "Q(th) = u*", 1.0, 0.5, "\n");
    fprintf(out,
            "scene drawn_moves { start th = %.3f, th' = %.3f [rad/s]; step 1 [ms]; until 1 [s] }\n",
            random_between(seed, -2.0, 2.0), random_between(seed, 2.0, 6.0));
}

static derived drawn_mechanism(unsigned number, char **text) {
    uint64_t seed = 20261122U + number;
    size_t size = 0;
    FILE *out = open_memstream(text, &size);
    TEST_ASSERT_NOT_NULL(out);
    write_mechanism(out, 1 + (int)(number % 3), &seed);
    fclose(out);
    derived d = derived_surely(derived_scene(*text, "drawn_moves"), *text);
    return d;
}

/* Both lists at a random state. The bound on their difference is the error of each table times the sensitivity of
 * the accelerations, which comes from a list with this table shifted. */
typedef struct comparison {
    evaluator *exact;
    evaluator *tables;
    evaluator *moved[128]; /* [table] the list with this table shifted */
    int count;
} comparison;

static comparison comparison_of(const image *exact, image *im) {
    op_list *t = im->list[IMAGE_STEP];
    comparison c = {.exact = evaluator_new(exact->list[IMAGE_STEP]),
                    .tables = evaluator_new(t),
                    .count = t->tables.count};
    TEST_ASSERT_LESS_OR_EQUAL_INT(128, c.count);
    for (int k = 0; k < c.count; k++) {
        for (int sign = 1; sign >= -1; sign -= 2) {
            for (int i = 0; i < 1 << t->tables.bits; i++) {
                t->tables.number[(i * c.count + k) * t->tables.terms] +=
                    sign * 1e6 * t->tables.off[k];
            }
            c.moved[k] = sign > 0 ? evaluator_new(t) : c.moved[k];
        }
    }
    return c;
}

static void comparison_free(comparison *c) {
    evaluator_free(c->exact);
    evaluator_free(c->tables);
    for (int k = 0; k < c->count; k++) {
        evaluator_free(c->moved[k]);
    }
}

/* Largest difference at a random state, divided by its bound. */
static double compare(const comparison *c, int coordinates, uint64_t *seed, const char *text) {
    double angle[1] = {random_between(seed, -20.0, 20.0)};
    double linear[RESULTS];
    double rate[RESULTS];
    double input[1] = {random_between(seed, -2.0, 2.0)};
    double exact[RESULTS];
    double tables[RESULTS];
    double moved[RESULTS];
    double may[RESULTS] = {0.0};
    double worst = 0.0;
    for (int i = 0; i < coordinates; i++) {
        linear[i] = random_between(seed, -2.0, 2.0);
        rate[i] = random_between(seed, -5.0, 5.0);
    }
    evaluator_run(c->exact, 0.0, angle, linear, rate, input, exact);
    evaluator_run(c->tables, 0.0, angle, linear, rate, input, tables);
    for (int k = 0; k < c->count; k++) {
        evaluator_run(c->moved[k], 0.0, angle, linear, rate, input, moved);
        for (int i = 0; i < coordinates; i++) {
            may[i] += fabs(moved[i] - tables[i]) / 1e6;
        }
    }
    for (int i = 0; i < coordinates; i++) {
        const double off = fabs(tables[i] - exact[i]);
        const double share = off / (1.02 * may[i] + 1e-11 * (1.0 + fabs(exact[i])));
        if (!(share <= 1.0)) {
            printf("coordinate %d: %.17g, exactly %.17g, may be off by %.3g\n", i, tables[i],
                   exact[i], may[i]);
        }
        TEST_ASSERT_TRUE_MESSAGE(share <= 1.0, text);
        worst = fmax(worst, share);
    }
    return worst;
}

TEST(tables, accelerations_are_within_the_tables_error) {
    double worst = 0.0;
    const int cases = (int)dice_cases(few_or_all(8, 40));
    for (int n = 0; n < cases; n++) {
        char *text = NULL;
        derived d = drawn_mechanism((unsigned)n, &text);
        for (int f = 0; f < FORMS; f++) {
            uint64_t seed = (uint64_t)n;
            image *im = tabled_surely(&d, both[f], 64);
            TEST_ASSERT_EQUAL_INT(0, op_list_count(im->list[IMAGE_STEP]).divisions);
            TEST_ASSERT_EQUAL_INT(0, op_list_count(im->list[IMAGE_STEP]).waves);
            comparison c = comparison_of(d.image, im);
            for (int s = 0; s < 20; s++) {
                worst = fmax(worst, compare(&c, im->coordinates, &seed, text));
            }
            comparison_free(&c);
            image_free(im);
        }
        derived_free(&d);
        free(text);
    }
    printf("  %d mechanisms: accelerations off by at most %.3f of what they may be\n", cases,
           worst);
    TEST_ASSERT_TRUE(worst > 0.5); /* the bound must not be too wide */
}

static int after(image *im, double step_s, uint64_t steps, double value[VALUES]) {
    im->step_s = step_s;
    void *run = engine_double.start(im);
    wh_status status = WH_OK;
    while (status == WH_OK && steps-- > 0) {
        status = engine_double.step(run);
    }
    engine_double.state(run, value, value + im->angles);
    engine_double.stop(run);
    return status == WH_OK ? im->angles + im->reals : 0;
}

static double distance(int count, const double *x, const double *y) {
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        sum = hypot(sum, x[i] - y[i]);
    }
    return sum;
}

static int by_size(const void *x, const void *y) {
    const double a = *(const double *)x;
    const double b = *(const double *)y;
    return (a > b) - (a < b);
}

/* The error of the motion by cell size. Tables have order 2 or 4. At this order, the mean of their error over a cell
 * is zero, so only the cells at the start and end of the motion remain, which gives one order more. */
TEST(tables, motions_have_the_tables_order) {
    enum { MOST = 300 };
    double order[MOST];
    const int wanted = (int)dice_cases(few_or_all(6, 24));
    const int cases = wanted < MOST ? wanted : MOST;
    for (int f = 0; f < FORMS; f++) {
        int count = 0;
        for (int n = 0; n < cases; n++) {
            char *text = NULL;
            derived d = drawn_mechanism((unsigned)n, &text);
            double exact[VALUES];
            double value[2][VALUES];
            const int values = after(d.image, 1e-3, 500, exact);
            double off[2];
            for (int k = 0; k < 2; k++) {
                image *im = tabled_surely(&d, both[f], 64 << k);
                TEST_ASSERT_EQUAL_INT(values, after(im, 1e-3, 500, value[k]));
                off[k] = distance(values, value[k], exact);
                image_free(im);
            }
            TEST_ASSERT_TRUE_MESSAGE(off[0] < (f == 0 ? 0.3 : 0.01), text);
            if (values > 0 && off[1] > 1e-12) {
                order[count++] = log2(off[0] / off[1]);
            }
            derived_free(&d);
            free(text);
        }
        TEST_ASSERT_GREATER_OR_EQUAL_INT(cases / 2, count);
        qsort(order, (size_t)count, sizeof *order, by_size);
        printf("  %d mechanisms, %s: the motion's error by the cells' size is of order %.2f\n",
               count, image_tables_words[both[f]], order[count / 2]);
        TEST_ASSERT_DOUBLE_WITHIN(f == 0 ? 0.6 : 1.0, f == 0 ? 3.0 : 5.0, order[count / 2]);
    }
}

/* The order in the step: the median over some seconds. The reference has the same tables and 1/32 of the step. */
static double order_of(image *im) {
    enum { TIMES = 24 };
    double order[TIMES];
    for (int i = 0; i < TIMES; i++) {
        double fine[VALUES];
        double value[2][VALUES];
        const uint64_t steps = 40U + 10U * (uint64_t)i;
        const int values = after(im, 4e-3 / 32, 32 * steps, fine);
        (void)after(im, 4e-3, steps, value[0]);
        (void)after(im, 2e-3, 2 * steps, value[1]);
        order[i] = log2(distance(values, value[0], fine) / distance(values, value[1], fine));
    }
    qsort(order, TIMES, sizeof *order, by_size);
    return order[TIMES / 2];
}

TEST(tables, straight_pieces_end_the_order_of_the_step) {
    derived d = derived_scene("mechanism p\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\n"
                              "V = -30 [J]*cos(a)\n"
                              "scene s { start a = 1, a' = 9 [rad/s]; step 4 [ms]; until 1 [s] }\n",
                              "s");
    derived_expect(&d, "a pendulum that goes round");
    image *linear = tabled_surely(&d, TABLES_LINEAR, 64);
    image *cubic = tabled_surely(&d, TABLES_CUBIC, 64);
    const double orders[] = {order_of(d.image), order_of(linear), order_of(cubic)};
    char text[100];
    snprintf(text, sizeof text, "orders: exact %.2f, linear %.2f, cubic %.2f", orders[0], orders[1],
             orders[2]);
    printf("  %s\n", text);
    TEST_ASSERT_TRUE_MESSAGE(orders[0] > 3.7 && orders[0] < 4.3, text);
    TEST_ASSERT_TRUE_MESSAGE(orders[1] < 2.6, text);
    TEST_ASSERT_TRUE_MESSAGE(orders[2] > 3.5 && orders[2] < 4.5, text);
    image_free(linear);
    image_free(cubic);
    derived_free(&d);
}

static const struct {
    const char *text;
    const char *said;
    const char *at; /* line and column of the message */
} refused[] = {
    {"mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\nT = 1 [kg*m^2]*(a'^2 + b'^2)/2\n"
     "V = 1 [J]*(cos(a) + cos(b))\n",
     "depend on the sines of more than one turn angle, such as 'b'", "3:12"},
    {"mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\nT = 1 [kg*m^2]*(a'^2 + b'^2)/2\n"
     "V = 1 [J]*(cos(a - b) + cos(a + b))\n",
     "more than one turn angle", "2:12"},
    {"mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
     "T = 1 [kg*m^2]*a'^2/2 + 1 [kg]*x'^2/2 + 1 [kg]*x^2*a'^2/2\nV = 1 [J]*cos(a)\n",
     "have a denominator with a rate, an input, or a coordinate other than a turn angle", "1:11"},
    {"mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = 1 [J]*cos(a)\n"
     "Q(a) = -0.1 [N*m]*sign(a')\n",
     "contain a function", "1:11"},
    {"mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = 1 [J]*(cos(a) + a^2)\n",
     "contain a sine or cosine of a quantity other than a turn angle", "1:11"},
    {"mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = 1 [J]*abs(cos(a))\n",
     "have a kink or a jump", "1:11"},
    {"mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = 1 [J]*tan(a)\n",
     "have no finite value or slope at some angle", "1:11"},
    {"mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*(1 - cos(a))*a'^2\nV = 1 [J]*cos(a)\n",
     "have no finite value or slope at some angle", "1:11"},
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [N/m]*x^2\n",
     "there is nothing to look up", "1:11"},
    {"mechanism m\ncoordinate a [rad]\ncoordinate x [m]\nT = 1 [kg*m^2]*a'^2/2 + 1 [kg]*x'^2/2\n"
     "V = 1 [J]*cos(a)\nstop x >= 0 [m] restitution 0.5\n",
     "a scene with events cannot use tables", "6:1"}};

/* A power above 2 of an expression that touches zero has a finite slope there. */
TEST(tables, powers_of_expressions_with_a_zero) {
    dice d = dice_of("table powers", 51);
    for (unsigned i = 0; i < dice_cases(few_or_all(6, 60)); i++) {
        char text[300];
        const int n = 1 + (int)dice_one_of(&d, 3);
        const double p = dice_between(&d, 2.0, 5.0);
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate th [rad]\nT = 1 [kg*m^2]*th'^2/2\n"
                 "V = 1 [J]*(1 - cos(%d*th))^%.17g\nscene s { start th = 1 [rad]; until 1 [s] }\n",
                 n, p);
        derived of = derived_surely(derived_text(text), text);
        image *im = tabled_surely(&of, both[i % 2U], 1024);
        evaluator *e = evaluator_new(im->list[IMAGE_STEP]);
        for (int k = 0; k < 50; k++) {
            double accel = 0.0;
            const double rate = 0.0;
            const double th = k == 0 ? 0.0 : dice_between(&d, -3.0, 3.0);
            evaluator_run(e, 0.0, &th, NULL, &rate, NULL, &accel);
            const double exact = -p * pow(1.0 - cos(n * th), p - 1.0) * n * sin(n * th);
            TEST_ASSERT_TRUE_MESSAGE(fabs(accel - exact) < 2e-3 * n * p * pow(2.0, p), text);
        }
        evaluator_free(e);
        image_free(im);
        derived_free(&of);
    }
}

TEST(tables, unsuitable_expressions_are_refused_with_place) {
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        derived d = derived_surely(derived_text(refused[i].text), refused[i].text);
        char *report = NULL;
        char at[40];
        image *im = tabled(&d, TABLES_CUBIC, 64, &report);
        snprintf(at, sizeof at, "t.whirl:%s: error: --tables: ", refused[i].at);
        TEST_ASSERT_NULL_MESSAGE(im, refused[i].text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report, refused[i].said), report);
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(at, report, strlen(at), report);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report, "hint: "), report);
        free(report);
        derived_free(&d);
    }
}

/* Angles that occur only as multiples of one difference need one phase only. */
TEST(tables, one_sum_of_angles_is_one_phase) {
    derived d =
        derived_surely(derived_text("mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\n"
                                    "T = 1 [kg*m^2]*(a'^2 + b'^2 + a'*b'*cos(4*a - 2*b)/2)\n"
                                    "V = 1 [J]*cos(6*a - 3*b + 1)\n"),
                       "two angles");
    image *im = tabled_surely(&d, TABLES_CUBIC, 64);
    const op_list *t = im->list[IMAGE_STEP];
    int cells = 0;
    for (int i = 0; i < t->count; i++) {
        if (t->ops[i].code == OP_CELL) {
            cells++;
            TEST_ASSERT_EQUAL_INT(2, abs(t->ops[i].turns[0]));
            TEST_ASSERT_EQUAL_INT(-t->ops[i].turns[0], 2 * t->ops[i].turns[1]);
        }
    }
    TEST_ASSERT_EQUAL_INT(1, cells);
    image_free(im);
    derived_free(&d);
}
