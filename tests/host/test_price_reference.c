/* test_price_reference.c: the reference of `whirl price`, and the errors that it reports, compared with closed forms in
 * long double. */
#include "command.h"
#include "priced.h"

static reference *reference_of(const image *im, double spacing_s, int count) {
    const reference_request request = {
        .image = im, .spacing = ratio_of(spacing_s), .records = count, .operations = 6e8};
    reference *r = reference_new(&request);
    TEST_ASSERT_TRUE_MESSAGE(r->reliable, r->why);
    TEST_ASSERT_EQUAL_INT_MESSAGE(count, r->records, r->why);
    return r;
}

static double at(const reference *r, int record, const char *name) {
    bool noisy;
    const int column = reference_find(r, name, &noisy);
    TEST_ASSERT_TRUE_MESSAGE(column > 0 && !noisy, name);
    return r->row[(size_t)record * (size_t)r->columns + (size_t)column];
}

/* m x'' + c x' + k x = f from x0, v0 with m = 1 kg. */
typedef struct oscillator {
    double k, c, f, x0, v0;
} oscillator;

/* A scene of two: x is underdamped, without a spring, or with a spring that pushes (k < 0). y is at rest; if the kind is FAST,
 * it is a fast oscillator beside a slow x. */
enum { KINDS = 4, FAST = 3, LOOKS = 100 };
typedef struct pair {
    oscillator of[2];
    char text[800];
} pair;

static pair drawn_pair(dice *d, unsigned kind) {
    pair p = {.of = {{.k = kind % FAST == 0 ? dice_between(d, 1.0, kind == FAST ? 4.0 : 400.0)
                           : kind == 1      ? 0.0
                                            : -dice_between(d, 0.5, 4.0),
                      .c = dice_between(d, 0.05, 1.0),
                      .f = kind == 1 ? -9.81 : 0.0,
                      .x0 = dice_between(d, 0.5, 4.0),
                      .v0 = dice_between(d, -8.0, 8.0)},
                     {.k = dice_between(d, 1e4, 4e4),
                      .c = dice_between(d, 0.05, 1.0),
                      .x0 = kind == FAST ? dice_between(d, 0.5, 4.0) : 0.0}}};
    snprintf(p.text, sizeof p.text,
             "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
             "V = %.17g [N/m]*x^2/2 - %.17g [N]*x + %.17g [N/m]*y^2/2\n"
             "F = %.17g [N*s/m]*x'^2/2 + %.17g [N*s/m]*y'^2/2\n"
             "scene s { start x = %.17g [m], x' = %.17g [m/s], y = %.17g [m]\n"
             "step 5 [ms]; until 2 [s] }\n",
             p.of[0].k, p.of[0].f, p.of[1].k, p.of[0].c, p.of[1].c, p.of[0].x0, p.of[0].v0,
             p.of[1].x0);
    return p;
}

/* Value and rate at t. */
static void closed_form(const oscillator *o, long double t, long double *x) {
    const long double half = (long double)o->c / 2.0L;
    const long double x0 = (long double)o->x0;
    const long double v0 = (long double)o->v0;
    const long double square = (long double)o->k - half * half;
    const long double w = sqrtl(fabsl(square));
    const long double e = expl(-half * t);
    if (o->k == 0.0) { /* falls with drag to the speed f/c */
        const long double fall = (long double)o->f / (long double)o->c;
        const long double left = (v0 - fall) / (long double)o->c;
        x[0] = x0 + fall * t + left * (1.0L - e * e);
        x[1] = fall + (v0 - fall) * e * e;
        return;
    }
    const long double b = (v0 + half * x0) / w;
    const long double cosine = square > 0.0L ? cosl(w * t) : coshl(w * t);
    const long double sine = square > 0.0L ? sinl(w * t) : sinhl(w * t);
    const long double turned = square > 0.0L ? -sine : sine;
    x[0] = e * (x0 * cosine + b * sine);
    x[1] = e * ((b * w - half * x0) * cosine + (x0 * w * turned - half * b * sine));
}

TEST(price_reference, closed_forms) {
    dice d = dice_of("price_reference forms", 73);
    double worst = 0.0;
    for (unsigned n = 0; n < dice_cases(few_or_all(12, 200)); n++) {
        const pair o = drawn_pair(&d, n % FAST);
        derived of = derived_surely(derived_scene(o.text, "s"), o.text);
        reference *r = reference_of(of.image, 0.02, LOOKS);
        const char *const names[] = {"x", "x'"};
        for (int k = 0; k < 2; k++) {
            long double largest = 0.0L;
            long double off = 0.0L;
            for (int i = 0; i <= LOOKS; i++) {
                long double x[2];
                closed_form(&o.of[0], (long double)i / 50.0L, x);
                largest = fmaxl(largest, fabsl(x[k]));
                off = fmaxl(off, fabsl((long double)at(r, i, names[k]) - x[k]));
            }
            worst = fmax(worst, (double)(off / largest));
        }
        TEST_ASSERT_TRUE(reference_agreement(r, -1) <= 1e-11);
        reference_free(r);
        derived_free(&of);
    }
    printf("  closed forms: off by %.2e of the largest value over 2 s\n", worst);
    TEST_ASSERT_TRUE(worst <= 1e-11);
}

/* The largest deviation of a run from the closed forms, as a part of the component's largest value. */
static double true_error(priced *p, const pair *o, const setting *s, deviation_pace pace) {
    char step[NUMBER_SIZE];
    image *im = priced_image(p, 0, s, trial_step_text(&p->trial, pace, step));
    void *run = s->number->start(im);
    long double largest[4] = {0.0L};
    long double off[4] = {0.0L};
    for (int i = 0; i <= LOOKS; i++) {
        double angle[1];
        double real[4]; /* x, y, x', y' */
        for (uint64_t k = 0; k < pace.steps && i > 0; k++) {
            TEST_ASSERT_EQUAL_INT(WH_OK, s->number->step(run));
        }
        s->number->state(run, angle, real);
        for (int k = 0; k < 4; k++) {
            long double x[2];
            closed_form(&o->of[k % 2], i * (long double)ratio_times(1, p->request.spacing), x);
            largest[k] = fmaxl(largest[k], fabsl(x[k / 2]));
            off[k] = fmaxl(off[k], fabsl((long double)real[k] - x[k / 2]));
        }
    }
    double worst = 0.0;
    for (int k = 0; k < 4; k++) {
        worst = fmax(worst, (double)(off[k] / largest[k])); /* 0/0, NaN, if y is at rest */
    }
    s->number->stop(run);
    image_free(im);
    return worst;
}

/* A reported error must be within a tenth of the true error. A reported bound must not be below the true error. */
TEST(price_reference, errors_equal_closed_forms_or_bounds) {
    static const wh_method methods[] = {WH_HEUN, WH_RK4, WH_NYSTROEM5, WH_EULER};
    dice d = dice_of("price_reference errors", 75);
    int figures = 0;
    int bounds = 0;
    double worst = 0.0;
    double largest = 0.0;
    for (unsigned n = 0; n < dice_cases(few_or_all(9, 120)); n++) {
        const bool fast = n % KINDS == FAST;
        const pair o = drawn_pair(&d, n % KINDS);
        const char *const texts[] = {o.text};
        priced p;
        priced_open(&p, texts, 1);
        TEST_ASSERT_TRUE(priced_begin(&p, "host", (whole_ratio){1, fast ? 5 : 50}, LOOKS, NULL));
        TEST_ASSERT_TRUE(p.trial.reliable && p.trial.records == LOOKS);
        for (unsigned i = 0; i < 16; i++) {
            setting s = priced_setting(methods[i % 4], i < 4 ? &engine_float : &engine_double);
            s.image.compensated = i % 2 == 0;
            const deviation_pace pace = {
                (i < 8 ? 1 + dice_one_of(&d, 8) : 10 + dice_one_of(&d, 150)) * (fast ? 50 : 1), 1};
            const trial_result r = trial_run(&p.trial, &s, pace);
            if (!r.usable) {
                continue;
            }
            const double error = true_error(&p, &o, &s, pace);
            figures += !r.bound;
            bounds += r.bound;
            if (r.bound) {
                largest = fmax(largest, error / r.error);
            } else {
                worst = fmax(worst, fabs(r.error / error - 1.0));
            }
        }
        priced_close(&p);
    }
    printf("  %d errors within %.2e of themselves; %d bounds, at most %.2g of them reached\n",
           figures, worst, bounds, largest);
    TEST_ASSERT_TRUE(worst <= 0.1 && largest <= 1.0 && figures > 80 && bounds > 5);
}

TEST(price_reference, pendulums_keep_their_energy) {
    uint64_t seed = 74;
    double worst = 0.0;
    for (int i = 0; i < 12; i++) {
        char text[400];
        const double rate = number_nearest(random_between(&seed, 0.0, 40.0)) / 4.0;
        snprintf(text, sizeof text,
                 "mechanism pendulum\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\n"
                 "V = -8 [J]*cos(a)\n"
                 "scene p { start a = 0.25 [rad], a' = %g [rad/s]; step 1 [ms]; until 10 [s] }\n",
                 rate);
        derived d = derived_surely(derived_scene(text, "p"), text);
        reference *r = reference_of(d.image, 0.05, 200);
        const double start = at(r, 0, "a'") * at(r, 0, "a'") / 2.0 - 8.0 * cos(0.25);
        for (int n = 0; n <= 200; n++) {
            const double v = at(r, n, "a'");
            const double now = v * v / 2.0 - 8.0 * cos(at(r, n, "a"));
            worst = fmax(worst, fabs(now - start) / (8.0 + v * v / 2.0));
        }
        reference_free(r);
        derived_free(&d);
    }
    printf("  pendulums: energy off by %.2e of itself over 10 s\n", worst);
    TEST_ASSERT_TRUE(worst <= 1e-14); /* without compensated sums it would be 1e-13 */
}
