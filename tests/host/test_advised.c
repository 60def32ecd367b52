/* test_advised.c: the figures in what a coarse run is warned of (host/run/advice.h), read back word by word: of oscillators, decays
 * and a passage by a singular place all of them are known in closed form, from the methods' stability functions. And the step
 * that is named does what is said of it. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"
#include "unity.h"

void suite_advised(void);

#define PI 3.14159265358979323846

static dice die;

/* --- methods -------------------------------------------------------------------------------------------------------*/

static const struct {
    const char *word;
    const char *title;
    int order;
    double decays_to; /* -h/tau down to which a decay does not grow */
} methods[] = {{"rk4", "Runge-Kutta 4", 4, 2.7852936}, {"heun", "Heun", 2, 2.0}};

/* By what a step multiplies a motion of z = h lambda: Taylor's series of exp, so far. */
static double growth(double re, double im, int order) {
    double term[2] = {1.0, 0.0};
    double sum[2] = {1.0, 0.0};
    for (int k = 1; k <= order; k++) {
        const double next = (term[0] * re - term[1] * im) / k;
        term[1] = (term[0] * im + term[1] * re) / k;
        term[0] = next;
        sum[0] += term[0];
        sum[1] += term[1];
    }
    return sqrt(sum[0] * sum[0] + sum[1] * sum[1]);
}

static void expect_figure(double wanted, double is, double part, const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(is - wanted) <= part * fabs(wanted), text);
}

/* " about t = 8 s: ": a moment of the run. */
static const char *read_about(const char *at, double until_s, const char *text) {
    double about_s = -1.0;
    at = said_exactly(said_number(said_exactly(at, " about t = "), &about_s), " s: ");
    TEST_ASSERT_TRUE_MESSAGE(about_s >= 0.0 && about_s <= until_s, text);
    return at;
}

/* "3 rad/s (a period of 2.09 s), h w = 0.6" */
static const char *read_swing(const char *at, double w, double step_s, const char *text) {
    double figure[3] = {0.0};
    at = said_number(at, &figure[0]);
    at = said_number(said_exactly(at, " rad/s (a period of "), &figure[1]);
    at = said_number(said_exactly(at, " s), h w = "), &figure[2]);
    expect_figure(w, figure[0], 0.006, text);
    expect_figure(2.0 * PI / w, figure[1], 0.006, text);
    expect_figure(w * step_s, figure[2], 0.006, text);
    return at;
}

/* "a time constant of 0.333 s, h/tau = 2.4" */
static const char *read_decay(const char *at, double tau_s, double step_s, const char *text) {
    double figure[2] = {0.0};
    at = said_number(said_exactly(at, "a time constant of "), &figure[0]);
    at = said_number(said_exactly(at, " s, h/tau = "), &figure[1]);
    expect_figure(tau_s, figure[0], 0.006, text);
    expect_figure(step_s / tau_s, figure[1], 0.006, text);
    return at;
}

/* "takes 6 % of its energy over the run", of `what` is multiplied by `times` in all. */
static const char *read_share(const char *at, const char *what, double times, const char *text) {
    double figure = 0.0;
    at = said_number(said_exactly(at, times < 1.0 ? "takes " : "adds "), &figure);
    at = said_exactly(at, times >= 2.0 ? " times its " : times < 1.0 ? " % of its " : " % to its ");
    at = said_exactly(said_exactly(at, what), " over the run");
    figure /= times < 2.0 ? 100.0 : 1.0;
    /* three digits of it */
    TEST_ASSERT_TRUE_MESSAGE(fabs(figure - fabs(times - 1.0)) <= 0.0055 * fabs(times - 1.0), text);
    return at;
}

/* "--step 20ms would do": it does, by closed form. */
static void read_cure(const char *at, double w, double until_s, int order, const char *text) {
    const double step_s = said_named_step_s(at);
    TEST_ASSERT_TRUE_MESSAGE(step_s > 0.0, text);
    const double times = pow(growth(0.0, w * step_s, order), 2.0 * until_s / step_s);
    TEST_ASSERT_TRUE_MESSAGE(fabs(times - 1.0) < 0.02, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(at, " would do"), text);
}

/* --- runs ----------------------------------------------------------------------------------------------------------*/

typedef struct coarse_run {
    double rate; /* rad/s, or 1/s */
    double step_s;
    unsigned steps;
    int method;
    bool as_matrix; /* its steps as one matrix */
    said what;
} coarse_run;

/* `text` ends before its scene. */
static void run(coarse_run *r, const char *text, const char *starts) {
    char whole[700];
    snprintf(whole, sizeof whole, "%sscene s { start %s; step %.9f [s]; until %.9f [s] }\n", text,
             starts, r->step_s, r->step_s * r->steps);
    const char *words[] = {model_keep(whole), "--quiet", r->as_matrix ? "--matrix" : "--method",
                           methods[r->method].word, NULL};
    command_say(command_run, words, &r->what);
}

/* A step for which the energy is multiplied by something between 0.3 and 30: less, somewhat more and much more in turn. */
static coarse_run drawn_swing(unsigned turn) {
    coarse_run r = {.rate = exp(dice_between(&die, -1.0, 2.0)),
                    .method = turn % 3U == 0 ? 0 : 1,
                    .steps = 60 + dice_one_of(&die, 60)};
    const double wanted = turn % 3U == 2U ? dice_between(&die, 1.5, 3.4)
                                          : dice_between(&die, 0.1, turn % 3U == 0 ? 1.2 : 0.65);
    double low = 0.0;
    double high = 2.0;
    for (int i = 0; i < 50; i++) { /* by halving: it grows with the step up to there */
        const double z = 0.5 * (low + high);
        const bool less =
            fabs(2.0 * r.steps * log(growth(0.0, z, methods[r.method].order))) < wanted;
        low = less ? z : low;
        high = less ? high : z;
    }
    r.step_s = low / r.rate;
    return r;
}

static double energy_times(const coarse_run *r) {
    return pow(growth(0.0, r->rate * r->step_s, methods[r->method].order), 2.0 * r->steps);
}

/* Of a system given by its equations: the warning itself. Of two that carry it either may stand first. */
static void test_swings_of_systems(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
        char text[300];
        coarse_run r = drawn_swing(c);
        snprintf(text, sizeof text,
                 "mechanism m\nstate p\nstate q\nequation p' = %.9f [1/s]*q\n"
                 "equation q' = -%.9f [1/s]*p\n",
                 r.rate, r.rate);
        run(&r, text, "p = 1");
        const char *err = r.what.err;
        const char *at = said_exactly(err, "whirl run: warning: the step is too coarse for '");
        const bool p_first = *at == 'p';
        at = said_exactly(at, p_first ? "p' and 'q'" : "q' and 'p'");
        at = read_about(at, r.steps * r.step_s, err);
        at = said_exactly(read_swing(at, r.rate, r.step_s, err), "; ");
        at = said_exactly(said_exactly(at, methods[r.method].title), " ");
        at = read_share(at, "amplitude", sqrt(energy_times(&r)), err);
        at = said_exactly(at, "\nhint: ");
        read_cure(at, r.rate, r.steps * r.step_s, methods[r.method].order, err);
        TEST_ASSERT_EQUAL_INT(0, r.what.status);
    }
    model_drop();
}

/* Of a mechanism: the hint behind what its books have lost. What is slow beside it is not named. */
static void test_swings_of_mechanisms(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
        char text[300];
        coarse_run r = drawn_swing(c);
        r.as_matrix = c % 6U == 0;
        double left_J = 0.0;
        double part = 0.0;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
                 "V = %.12f [N/m]*x^2/2 + %.12f [N/m]*y^2/2\n",
                 r.rate * r.rate, 1e-4 * r.rate * r.rate);
        run(&r, text, "x = 1 [m]");
        const char *err = r.what.err;
        const double times = energy_times(&r);
        const double start_J = 0.5 * r.rate * r.rate;
        const char *at = said_exactly(err, "whirl run: warning: this run cannot be believed: ");
        at = said_number(at, &left_J);
        at = said_number(said_exactly(at, " J of its energy is left over, "), &part);
        at = said_exactly(
            at, " of the largest entry of its books\nhint: the step is too coarse for 'x'");
        TEST_ASSERT_TRUE_MESSAGE(
            fabs(left_J - (times - 1.0) * start_J) <= 0.06 * fabs((times - 1.0) * start_J), err);
        TEST_ASSERT_TRUE_MESSAGE(part > 1e-3 && part < 1.3 * (fabs(times - 1.0) + 0.3), err);
        at = read_about(at, r.steps * r.step_s, err);
        at = said_exactly(read_swing(at, r.rate, r.step_s, err), "; ");
        at = said_exactly(said_exactly(at, methods[r.method].title), " ");
        at = said_exactly(read_share(at, "energy", times, err), "; ");
        read_cure(at, r.rate, r.steps * r.step_s, methods[r.method].order, err);
    }
    model_drop();
}

/* 1 kg on a spring, by a method's name; its file. */
static const char *run_spring(coarse_run *r, const char *method) {
    char text[300];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.12f [N/m]*x^2/2\n"
             "scene s { start x = 1 [m]; step %.9f [s]; until %.9f [s] }\n",
             r->rate * r->rate, r->step_s, r->steps * r->step_s);
    const char *file = model_keep(text);
    const char *words[] = {file, "--quiet", "--method", method, NULL};
    command_say(command_run, words, &r->what);
    return file;
}

/* Leapfrog keeps v^2/(1 - q) + w^2 x^2 with q = (h w/2)^2: its energy goes from 1 to 1 - q of its largest. */
static void test_ripples(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(4, 2)); c++) {
        double figure = 0.0;
        coarse_run r = {.rate = exp(dice_between(&die, -1.0, 2.0)), .steps = 150};
        const double z = dice_between(&die, 0.6, 1.2);
        r.step_s = z / r.rate;
        (void)run_spring(&r, "leapfrog");
        const char *at = strstr(r.what.err, "leapfrog lets its energy go ");
        TEST_ASSERT_NOT_NULL_MESSAGE(at, r.what.err);
        at = said_number(at + strlen("leapfrog lets its energy go "), &figure);
        (void)said_exactly(at, " % up and down; --step ");
        const double q = z * z / 4.0;
        expect_figure(100.0 * (q / 2.0) / (1.0 - q / 2.0), figure, 0.02, r.what.err);
    }
    model_drop();
}

/* Where a method of a higher order leaves next to nothing at the same step, it is named, first where it costs less, and does. */
static void test_better_methods(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(4, 2)); c++) {
        char word[40];
        said better;
        const double z = dice_between(&die, 0.05, 0.09);
        coarse_run r = {.rate = exp(dice_between(&die, -1.0, 2.0)), .method = 1};
        /* the energy grows by z^4/4 a step; Runge-Kutta 4 takes z^6/72 */
        r.steps = (unsigned)(dice_between(&die, 0.02, 0.06) * 4.0 / pow(z, 4.0));
        r.step_s = z / r.rate;
        const char *file = run_spring(&r, "heun");
        const char *method = strstr(r.what.err, "--method ");
        TEST_ASSERT_NOT_NULL_MESSAGE(method, r.what.err);
        (void)said_word(method + strlen("--method "), word, sizeof word);
        const char *again[] = {file, "--quiet", "--method", word, NULL};
        command_say(command_run, again, &better);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", better.err, word);
        const char *step = strstr(r.what.err, "--step ");
        const double times = step != NULL ? r.step_s / said_named_step_s(step) : 0.0;
        TEST_ASSERT_TRUE_MESSAGE(step == NULL || times < 40.0 || method < step, r.what.err);
    }
    model_drop();
}

/* --- what is more than a method carries ---------------------------------------------------------------------------------*/

/* The largest step of 1, 2 and 5, not beyond it, in which a swing by Runge-Kutta 4 has lost or won at the end no more than is left
 * where nothing is known of the motion as it should have been: three millionths of its energy. */
static double swing_step_s(double w, double most_s, double until_s) {
    static const double digits[] = {5.0, 2.0, 1.0};
    for (int decade = 1; decade > -9; decade--) {
        for (int i = 0; i < 3; i++) {
            const double step_s = digits[i] * pow(10.0, decade);
            const double times = pow(growth(0.0, w * step_s, 4), until_s / step_s);
            if (step_s <= most_s && 2.0 * fabs(times - 1.0) <= 3e-6) {
                return step_s;
            }
        }
    }
    return 0.0;
}

static void test_diverged(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(4, 2)); c++) {
        char text[300];
        double limit = 0.0;
        const bool swings = c % 2U == 0;
        coarse_run r = {.rate = exp(dice_between(&die, -1.0, 2.0)),
                        .method = swings ? 0 : (int)dice_one_of(&die, 2),
                        .steps = 2000};
        const double carries = swings ? 2.0 * sqrt(2.0) : methods[r.method].decays_to;
        r.step_s = carries * dice_between(&die, 1.2, 1.6) / r.rate;
        if (swings) {
            snprintf(text, sizeof text,
                     "mechanism m\ncoordinate y [m]\ncoordinate x [m]\n"
                     "T = 1 [kg]*(x'^2 + y'^2)/2\nV = %.12f [N/m]*x^2/2 + %.12f [N/m]*y^2/2\n",
                     r.rate * r.rate, 1e-3 * r.rate * r.rate);
        } else {
            snprintf(text, sizeof text,
                     "mechanism m\nstate y\nstate x\nequation x' = -%.9f [1/s]*x\n"
                     "equation y' = -%.9f [1/s]*y\n",
                     r.rate, 0.01 * r.rate);
        }
        run(&r, text, swings ? "x = 1 [m], y = 0.7 [m]" : "x = 1, y = 0.7");
        const char *err = r.what.err;
        const char *at = strstr(err, "\nhint: 'x'");
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, r.what.status, err);
        TEST_ASSERT_NOT_NULL_MESSAGE(at, err);
        at = said_exactly(at + strlen("\nhint: 'x'"), " about t = 0 s: "); /* from the start on */
        at = swings ? read_swing(at, r.rate, r.step_s, err)
                    : read_decay(at, 1.0 / r.rate, r.step_s, err);
        at = said_exactly(said_exactly(at, " is more than "), methods[r.method].title);
        at = said_number(said_exactly(at, " carries ("), &limit);
        expect_figure(carries, limit, 0.006, err);
        at = said_exactly(at, " in this direction); --step ");
        const double step_s = said_named_step_s(strstr(err, "direction); "));
        TEST_ASSERT_TRUE_MESSAGE(step_s > 0.0 && step_s * r.rate < 0.5 * carries, err);
        if (swings) { /* over all of the run, not only to where it ended */
            const double wanted_s = swing_step_s(r.rate, r.step_s, r.steps * r.step_s);
            TEST_ASSERT_TRUE_MESSAGE(fabs(step_s - wanted_s) < 1e-6 * wanted_s, err);
        }
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(at, " would do\n"), err);
    }
    model_drop();
}

/* What grows by itself is no method's fault. */
static void test_grows_by_itself(void) {
    for (unsigned c = 0; c < dice_cases(3); c++) {
        char text[300];
        coarse_run r = {
            .rate = exp(dice_between(&die, -1.0, 2.0)), .method = (int)(c % 2U), .steps = 2500};
        r.step_s = dice_between(&die, 0.03, 0.06) / r.rate;
        if (c % 3U == 0) {
            snprintf(text, sizeof text, "mechanism m\nstate x\nequation x' = %.9f [1/s]*x\n",
                     r.rate);
        } else { /* about an equilibrium that is none */
            snprintf(text, sizeof text,
                     "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = -%.12f [N/m]*x^2/2\n",
                     r.rate * r.rate);
        }
        run(&r, text, c % 3U == 0 ? "x = 1" : "x = 1 [m]");
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, r.what.status, r.what.err);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(r.what.err, " left all bounds\n"), r.what.err);
        TEST_ASSERT_NULL_MESSAGE(strstr(r.what.err, "lets such a motion"), r.what.err);
        TEST_ASSERT_NULL_MESSAGE(strstr(r.what.err, "too coarse"), r.what.err);
        double time_constant_s;
        said_number(said_words(strstr(r.what.err, "a time constant of"), "a time constant of"),
                    &time_constant_s);
        TEST_ASSERT_TRUE(fabs(time_constant_s * r.rate - 1.0) < 1e-2);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(r.what.err, ": such a motion grows by itself"),
                                     r.what.err);
    }
    model_drop();
}

/* --- a singular place ------------------------------------------------------------------------------------------------------*/

/* A free body passes the pole of polar coordinates at a distance: phi's inertia falls with the square of it. */
static void test_passes_a_pole(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(4, 2)); c++) {
        char text[500];
        double figure[4] = {0.0};
        said what;
        const double start_m = dice_between(&die, 0.7, 1.5);
        const double passes_m = dice_between(&die, 0.004, 0.02);
        const double speed_mps = dice_between(&die, 0.7, 1.4);
        const double along = sqrt(1.0 - passes_m * passes_m / (start_m * start_m));
        const double when_s = start_m * along / speed_mps;
        const double step_s = dice_between(&die, 0.9, 2.0) * passes_m / speed_mps;
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate r [m]\ncoordinate phi [rad]\n"
            "T = 1 [kg]*(r'^2 + r^2*phi'^2)/2\nscene s { start r = %.12f [m], r' = %.12f [m/s], "
            "phi' = %.12f [rad/s]; step %.9f [s]; until %.9f [s] }\n",
            start_m, -speed_mps * along, speed_mps * passes_m / (start_m * start_m), step_s,
            2.0 * when_s);
        const bool is_float = c % 2U == 1;
        const char *words[] = {model_keep(text), "--quiet", "--number",
                               is_float ? "float" : "double", NULL};
        command_say(command_run, words, &what);
        /* it was thrown out of all bounds there, if not behind it */
        const bool failed = strstr(what.err, "\nhint: about t = ") != NULL;
        TEST_ASSERT_TRUE_MESSAGE(what.status == 1 || !failed, what.err);
        const char *begin = failed ? "\nhint: about t = " : "whirl run: warning: about t = ";
        const char *at = strstr(what.err, begin);
        TEST_ASSERT_NOT_NULL_MESSAGE(at, what.err);
        at = said_number(at + strlen(begin), &figure[0]);
        at = said_exactly(at, " s these coordinates are singular: the inertia of 'phi' falls to ");
        at = said_number(at, &figure[1]);
        at = said_number(said_exactly(at, " of its largest, nearest at r = "), &figure[2]);
        at = said_exactly(at, failed ? " m\n" : " m; the steps there put ");
        TEST_ASSERT_TRUE_MESSAGE(fabs(figure[0] - when_s) < 2.0 * step_s, what.err);
        /* where steps throw it far away, the largest is larger */
        const double least = passes_m * passes_m / (start_m * start_m);
        TEST_ASSERT_TRUE_MESSAGE(figure[1] < 1.15 * least && figure[1] > 0.02 * least, what.err);
        TEST_ASSERT_TRUE_MESSAGE(step_s * speed_mps > 1.2 * passes_m || figure[1] > 0.5 * least,
                                 what.err);
        expect_figure(passes_m, figure[2], 0.1, what.err);
        const char *off = strstr(at, failed ? "hint: --step " : " off\nhint: --step ");
        TEST_ASSERT_NOT_NULL_MESSAGE(off, what.err);
        const double named_s = said_named_step_s(off);
        TEST_ASSERT_TRUE_MESSAGE(named_s > 0.0 && named_s < 0.5 * step_s, what.err);
        TEST_ASSERT_NOT_NULL_MESSAGE(
            strstr(off, "; coordinates that are not singular there need no smaller step\n"),
            what.err);
        /* so many small steps are summed up to more than a float's digits */
        const char *resolves = strstr(off, " resolves it");
        const char *compensated = strstr(off, " --compensated");
        TEST_ASSERT_NOT_NULL_MESSAGE(resolves, what.err);
        const bool is_compensated = compensated != NULL && compensated < resolves;
        const char *in_double = strstr(off, " --number double");
        const bool is_double = !is_float || (in_double != NULL && in_double < resolves);
        TEST_ASSERT_TRUE_MESSAGE(is_double || is_compensated == (10.0 * named_s <= step_s),
                                 what.err);
        const char *lost = strstr(what.err, "hint: these coordinates are singular about t = ");
        TEST_ASSERT_TRUE_MESSAGE(lost == NULL || strstr(lost, "or others\n") != NULL, what.err);
        if (resolves[strlen(" resolves it")] == ';') { /* not only there: it does, then */
            char step[40];
            snprintf(step, sizeof step, "%.17g", named_s);
            const char *cured[] = {words[0],
                                   "--quiet",
                                   "--number",
                                   is_double ? "double" : "float",
                                   "--step",
                                   step,
                                   is_compensated ? "--compensated" : NULL,
                                   NULL};
            command_say(command_run, cured, &what);
            TEST_ASSERT_EQUAL_STRING("", what.err);
        }
    }
    model_drop();
}

void suite_advised(void) {
    die = dice_of("advised", 67);
    RUN_TEST(test_swings_of_systems);
    RUN_TEST(test_swings_of_mechanisms);
    RUN_TEST(test_ripples);
    RUN_TEST(test_better_methods);
    RUN_TEST(test_diverged);
    RUN_TEST(test_grows_by_itself);
    RUN_TEST(test_passes_a_pole);
}
