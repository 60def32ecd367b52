/* test_map.c: stability maps of random springs, dampers and decays for each method, compared with closed forms on
 * both sides of the limit. Also limits for bounds, tolerance and energy, and maps that are interrupted. */
#include "test.h"

#include <complex.h>

#include "command.h"
#include "derived.h"
#include "host/os/system.h"
#include "host/study/stability_map.h"

typedef struct drawn_map {
    derived d;
    diags *errors;
    grid grid;
    overrides changes;
    stability_map map;
} drawn_map;

typedef struct map_asked {
    const char *text; /* a mechanism with a scene s */
    const char *over[2];
    wh_method method;
    double tolerance;
    void (*progress)(double runs, void *told);
} map_asked;

static void open_map(drawn_map *m, const map_asked *a) {
    *m = (drawn_map){.d = derived_scene(a->text, "s"), .errors = diags_new()};
    derived_expect(&m->d, a->text);
    m->changes.balance = true;
    const mechanism *of = m->d.model->mechanisms[0];
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_TRUE_MESSAGE(grid_add(&m->grid, of, a->over[i], m->errors), a->over[i]);
    }
    const map_request request = {.of = {.grid = &m->grid,
                                        .mechanism = of,
                                        .scene = m->d.model->scenes[0],
                                        .changes = &m->changes,
                                        .kind = &engine_double,
                                        .engine = {.method = a->method}},
                                 .tolerance = a->tolerance,
                                 .progress = a->progress};
    m->map = map_make(&request);
}

static void close_map(drawn_map *m) {
    map_free(&m->map);
    grid_free(&m->grid);
    diags_free(m->errors);
    derived_free(&m->d);
}

static const map_cell *cell_of(const drawn_map *m, uint64_t across, uint64_t at) {
    return &m->map.cell[map_point(&m->map, across, at)];
}

/* |R(z)| of a Runge-Kutta method with as many stages as its order: exp(z) without the terms after z^order. */
static double growth(int order, double complex z) {
    double complex sum = 1.0;
    double complex next = 1.0;
    for (int k = 1; k <= order; k++) {
        next *= z / k;
        sum += next;
    }
    return cabs(sum);
}

/* Largest |z| in this direction without growth; 0 if the method grows for every |z|. */
static double longest(int order, double complex direction) {
    double low = 0.0;
    double high = 0.0;
    while (high < 6.0 && growth(order, high * direction) <= 1.0 + 1e-12) {
        low = high;
        high += 0.01;
    }
    for (int i = 0; i < 50 && low > 0.0; i++) {
        const double middle = 0.5 * (low + high);
        *(growth(order, middle * direction) <= 1.0 + 1e-12 ? &low : &high) = middle;
    }
    return low;
}

/* Limits of the methods. If `order` is not 0, growth() gives the limit. Else `undamped` is the limit h w of an
 * undamped oscillation: 2 for leapfrog and semi-implicit Euler (Hairer, Lubich & Wanner, Geometric Numerical
 * Integration, section I.1), and from runs of 40,000 steps for Nyström methods (docs/stability.md). With a step 2 %
 * above the limit, a run grows a hundredfold in `steps` steps. */
static const struct {
    wh_method method;
    int order;
    double undamped;
    double known_to;
    double steps;
} rows[] = {{WH_RK4, 4, 0.0, 1e-3, 1e3},         {WH_EULER, 1, 0.0, 1e-3, 2e4},
            {WH_LEAPFROG, 0, 2.0, 1e-3, 1e3},    {WH_HEUN, 2, 0.0, 1e-3, 1e3},
            {WH_RK38, 4, 0.0, 1e-3, 1e3},        {WH_SEMI_IMPLICIT_EULER, 0, 2.0, 1e-3, 1e3},
            {WH_NYSTROEM3, 0, 2.141, 3e-3, 1e3}, {WH_NYSTROEM4, 0, 2.586, 3e-3, 1e3},
            {WH_NYSTROEM5, 0, 2.395, 3e-3, 2e4}};
enum { ROWS = sizeof rows / sizeof rows[0], STEPS = 25, PLACES = 3 };

typedef struct tally {
    unsigned within, beyond;
} tally;

/* For each place, the map must show no divergence below the limit, and only divergence above 1.02 of the limit. */
static void hold_to(const map_asked *a, const double *limit_s, double known_to, tally *sum) {
    drawn_map m;
    open_map(&m, a);
    TEST_ASSERT_TRUE(m.map.by_step && m.map.done == m.grid.points);
    for (uint64_t p = 0; p < PLACES; p++) {
        for (uint64_t i = 0; i < STEPS; i++) {
            const double part = map_along(&m.map, i) / limit_s[p];
            const map_cell *c = cell_of(&m, p, i);
            char what[900];
            snprintf(what, sizeof what, "%s: %.5g of the limit, %s\n%s", wh_methods[a->method].word,
                     part, map_verdicts[c->verdict].word, a->text);
            if (part < 1.0 - 0.003 - known_to) {
                TEST_ASSERT_TRUE_MESSAGE(c->verdict < MAP_DIVERGES, what);
                sum->within++;
            } else if (part > 1.02) {
                TEST_ASSERT_EQUAL_INT_MESSAGE(MAP_DIVERGES, c->verdict, what);
                sum->beyond++;
            }
        }
    }
    close_map(&m);
}

/* Maps steps from 0.7 of the smallest limit to 1.3 of the largest. Steps rise or fall, and the axes come in either
 * sequence, at random. */
static void hold_drawn(dice *d, const char *text, wh_method method, const char *across,
                       const double *limit_s, double known_to, tally *sum) {
    char step[120];
    const double ends[2] = {0.7 * fmin(limit_s[0], limit_s[PLACES - 1]),
                            1.3 * fmax(limit_s[0], limit_s[PLACES - 1])};
    const bool falls = dice_one_of(d, 2) == 1;
    const bool second = dice_one_of(d, 2) == 1;
    snprintf(step, sizeof step, "step=%.17g..%.17g:%d%s", ends[falls], ends[!falls], STEPS,
             dice_one_of(d, 2) == 1 ? ",log" : "");
    const map_asked a = {.text = text,
                         .over = {second ? across : step, second ? step : across},
                         .method = method,
                         .tolerance = 1e-3};
    hold_to(&a, limit_s, known_to, sum);
}

/* m x'' + c x' + k x = 0 for any mass and stiffness, without damping or underdamped. */
TEST(map, springs_of_all_methods) {
    dice d = dice_of("map", 1421);
    const unsigned cases = dice_cases(few_or_all(1, 6) * ROWS);
    tally sum = {0};
    for (unsigned k = 0; k < cases; k++) {
        const wh_method method = rows[k % ROWS].method;
        const int order = rows[k % ROWS].order;
        const bool must = order == 1 || order == 2; /* methods of order 1 and 2 need damping */
        const double zeta =
            order == 0 || (!must && dice_one_of(&d, 2) == 0) ? 0.0 : dice_between(&d, 0.1, 0.9);
        const double mass_kg = pow(10.0, dice_between(&d, -2.0, 2.0));
        const double w = pow(10.0, dice_between(&d, -1.0, 3.0));
        const double z = order > 0
                             ? longest(order, -zeta + sqrt(1.0 - zeta * zeta) * (double complex)I)
                             : rows[k % ROWS].undamped;
        double limit_s[PLACES];
        char text[600];
        char across[100];
        /* m has the factor s^2 and c the factor s, so the frequency is w/s */
        for (int i = 0; i < PLACES; i++) {
            limit_s[i] = z / w * (1.0 + 0.1 * i);
        }
        snprintf(text, sizeof text,
                 "mechanism spring\ncoordinate x [m]\nparameter s = 1\nT = %.17g [kg]*s^2*x'^2/2\n"
                 "V = %.17g [N/m]*x^2/2\nF = %.17g [N*s/m]*s*x'^2/2\n"
                 "scene s { start x = 1 [m]; step %.17g [s]; until %.17g [s] }\n",
                 mass_kg, mass_kg * w * w, 2.0 * zeta * w * mass_kg, z / w,
                 rows[k % ROWS].steps * z / w);
        snprintf(across, sizeof across, "s=1..1.2:%d", PLACES);
        hold_drawn(&d, text, method, across, limit_s, rows[k % ROWS].known_to, &sum);
    }
    printf("  %u springs: %u runs within the limit, none out of bounds; %u beyond, all are\n",
           cases, sum.within, sum.beyond);
    TEST_ASSERT_TRUE(sum.within > cases * 20 && sum.beyond > cases * 20);
}

static const char spring_text[] =
    "mechanism spring\ncoordinate x [m]\nparameter k = 1 [N/m]\nparameter m = 1 [kg]\n"
    "T = m*x'^2/2\nV = k*x^2/2\nscene s { start x = 1 [m]; step 1 [s]; until 200 [s] }\n";

TEST(map, no_limit) {
    const wh_method methods[] = {WH_EULER, WH_HEUN};
    for (int i = 0; i < 2; i++) {
        drawn_map m;
        open_map(&m,
                 &(map_asked){spring_text, {"step=0.2..2:4", "k=1..4:3"}, methods[i], 1e-3, NULL});
        TEST_ASSERT_EQUAL_INT(MAP_DIVERGES, cell_of(&m, 2, 3)->verdict);
        close_map(&m);
    }
}

/* With a long step, a pendulum that starts at 90 degrees swings wider each time, until it goes over the top. This
 * happens at steps slightly below the limit of small oscillations, 2.83 sqrt(l/g). No step from that limit to ten
 * times that limit may be shown as stable. */
TEST(map, pendulums_from_a_right_angle) {
    static const char text[] = "mechanism pendulum\ncoordinate a [rad]\nparameter l = 0.19 [m]\n"
                               "T = 1 [kg]*(l*a')^2/2\nV = -9.81 [N]*l*cos(a)\n"
                               "scene s { start a = 90 [deg]; step 1 [ms]; until 5 [s] }\n";
    enum { LONG = 60 };
    const unsigned many = few_or_all(40, 200);
    char lengths[40];
    drawn_map m;
    snprintf(lengths, sizeof lengths, "l=0.05..0.4:%u", many);
    open_map(&m, &(map_asked){text, {"step=0.05..3:60,log", lengths}, WH_RK4, 1e-3, NULL});
    for (uint64_t p = 0; p < many; p++) {
        const double limit_s = sqrt(8.0 * map_row(&m.map, p) / 9.81);
        for (uint64_t i = 0; i < LONG; i++) {
            const double part = map_along(&m.map, i) / limit_s;
            const bool diverges = cell_of(&m, p, i)->verdict == MAP_DIVERGES;
            TEST_ASSERT_TRUE(part < 1.0 ? part > 0.9 || !diverges : diverges);
        }
    }
    close_map(&m);
}

/* A run that grows 20-fold counts as bounded, a run that grows 1e4-fold does not. If half the step is too long as
 * well, both runs grow alike; then the run with the finest step of the row decides. */
TEST(map, bounded_and_unbounded_runs) {
    dice d = dice_of("map bounds", 1424);
    for (unsigned k = 0; k < dice_cases(12); k++) {
        const double w = pow(10.0, dice_between(&d, -1.0, 2.0));
        const double z = dice_between(&d, 2.95, 3.2);
        const double grown = k % 2 == 0 ? 20.0 : 1e4;
        const double far = dice_between(&d, 7.0, 12.0);
        const double steps = ceil(log(grown) / log(growth(4, z * (double complex)I)));
        const double until[2] = {steps * z, 6.0 * far};
        const double step[2] = {z, far};
        for (int i = 0; i < 2; i++) {
            char text[400];
            char over[100];
            snprintf(
                text, sizeof text,
                "mechanism spring\ncoordinate x [m]\nparameter k = 1 [N/m]\nT = 1 [kg]*x'^2/2\n"
                "V = %.17g*k*x^2/2\nscene s { start x = 1 [m]; step %.17g [s]; until %.17g [s] }\n",
                w * w, 0.1 / w, until[i] / w);
            snprintf(over, sizeof over, "step=%.17g..%.17g:2", 0.1 / w, step[i] / w);
            drawn_map m;
            open_map(&m, &(map_asked){text, {over, "k=1..1:1"}, WH_RK4, 1e-3, NULL});
            TEST_ASSERT_TRUE_MESSAGE(cell_of(&m, 0, 0)->verdict < MAP_LOSES, text);
            TEST_ASSERT_EQUAL_INT_MESSAGE(i == 0 && grown < 100.0 ? MAP_LOSES : MAP_DIVERGES,
                                          cell_of(&m, 0, 1)->verdict, text);
            close_map(&m);
        }
    }
}

/* With z = h w, each step of Runge-Kutta 4 has a phase error of z^5/120 and an energy error of z^6/72. In a run of
 * length T these sum to w T z^4/120 of the amplitude (half of that relative to the range) and to w T z^5/72 of the
 * energy. The largest entry of the energy balance is half the RMS momentum times the range of the rate: sqrt(2) of
 * the energy. */
TEST(map, limits_of_tolerance_and_energy) {
    dice d = dice_of("map tolerance", 1423);
    const unsigned cases = dice_cases(few_or_all(4, 32));
    unsigned seen[MAP_VERDICTS] = {0};
    for (unsigned k = 0; k < cases; k++) {
        const double w = pow(10.0, dice_between(&d, -1.0, 2.0));
        const double radians = dice_between(&d, 100.0, 400.0);
        const double tolerance = pow(10.0, dice_between(&d, -4.0, -2.5));
        const double right = pow(240.0 * tolerance / radians, 0.25);
        const double kept = pow(72.0 * sqrt(2.0) * 1e-3 / radians, 0.2);
        char text[400];
        char step[100];
        snprintf(
            text, sizeof text,
            "mechanism spring\ncoordinate x [m]\nparameter k = 1 [N/m]\nT = 1 [kg]*x'^2/2\n"
            "V = %.17g*k*x^2/2\nscene s { start x = 1 [m]; step %.17g [s]; until %.17g [s] }\n",
            w * w, 0.1 / w, radians / w);
        snprintf(step, sizeof step, "step=%.17g..%.17g:40,log", 0.03 / w, 0.5 / w);
        drawn_map m;
        open_map(&m, &(map_asked){text, {step, "k=1..1:1"}, WH_RK4, tolerance, NULL});
        for (uint64_t i = 0; i < 40; i++) {
            const double z = map_along(&m.map, i) * w;
            const map_cell *c = cell_of(&m, 0, i);
            seen[c->verdict]++;
            if (z > 1.05 * kept) {
                TEST_ASSERT_EQUAL_INT_MESSAGE(MAP_LOSES, c->verdict, text);
            } else if (z < 0.95 * kept && z > 1.05 * right) {
                TEST_ASSERT_EQUAL_INT_MESSAGE(MAP_OFF, c->verdict, text);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.12 * c->end_s + 2.0 / w,
                                                  c->end_s * pow(right / z, 4.0), c->until_s, text);
            } else if (z < 0.95 * right && z < 0.95 * kept) {
                TEST_ASSERT_EQUAL_INT_MESSAGE(MAP_KEEPS, c->verdict, text);
            }
        }
        close_map(&m);
    }
    printf("  %u keep, %u are off, %u lose\n", seen[MAP_KEEPS], seen[MAP_OFF], seen[MAP_LOSES]);
    TEST_ASSERT_TRUE(seen[MAP_KEEPS] > cases && seen[MAP_OFF] > cases && seen[MAP_LOSES] > cases);
}

static void stop_after_six(double runs, void *told) {
    (void)told;
    interrupted = runs >= 6.0;
}

TEST(map, stopped_maps_have_their_finished_points) {
    drawn_map m;
    open_map(
        &m, &(map_asked){spring_text, {"step=0.1..4:4", "k=1..4:3"}, WH_RK4, 1e-3, stop_after_six});
    interrupted = 0;
    TEST_ASSERT_EQUAL_UINT64(6, m.map.done);
    TEST_ASSERT_EQUAL_UINT64(6, map_count(&m.map, MAP_UNTRIED));
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    map_csv(out, &m.map);
    fclose(out);
    unsigned lines = 0;
    for (size_t i = 0; i < length; i++) {
        lines += text[i] == '\n';
    }
    TEST_ASSERT_EQUAL_UINT(7, lines);
    free(text);
    close_map(&m);
}
