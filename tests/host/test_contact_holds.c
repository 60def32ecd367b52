/* test_contact_holds.c: holds keep their place, over 1e5 steps and more: rods, linkages, gears. What they keep is
 * state: an assignment gives it anew. Linkages that lie flat are refused. */
#include "command.h"
#include "contacts.h"
#include "derived.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

void suite_contact_holds(void);

static const engine_kind *const KINDS[] = {&engine_double, &engine_float};

/* Largest |output `off`| of the text's scene over `steps` steps, looked at now and then; by `scale`. */
static double worst_off(const char *text, const engine_kind *kind, long steps, double scale) {
    motion m;
    double worst = 0.0;
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4});
    for (long done = 0; done < steps; done += 100) {
        const wh_status status = motion_step(&m, 100);
        if (status != WH_OK) {
            puts(text);
        }
        TEST_ASSERT_EQUAL_INT(WH_OK, status);
        worst = fmax(worst, fabs(motion_value(&m, "off")));
    }
    motion_close(&m);
    return worst / scale;
}

static void expect_kept(const char *what, const char *text, long steps, double scale,
                        double scale_float) {
    const double worst[2] = {worst_off(text, KINDS[0], steps, scale),
                             worst_off(text, KINDS[1], steps, scale_float)};
    printf("  %s: off by %.1e of its scale, float %.1e\n", what, worst[0], worst[1]);
    if (worst[0] > 1e-12 || worst[1] > 1e-6) {
        puts(text);
    }
    TEST_ASSERT_TRUE(worst[0] <= 1e-12 && worst[1] <= 1e-6);
}

/* --- rods ------------------------------------------------------------------------------------------------------- */

static void test_rods_keep_their_length(void) {
    uint64_t seed = 11;
    for (int i = 0; i < 6; i++) {
        char text[700];
        const double length = exp(random_between(&seed, -3.0, 3.0));
        const double angle = random_between(&seed, -3.0, 3.0);
        const double rate = random_between(&seed, 5.0, 20.0); /* with 10 ms: h omega up to 0.2 */
        const bool square = i % 2 != 0;
        snprintf(
            text, sizeof text,
            "mechanism rod\ncoordinate x [m]\ncoordinate y [m]\nparameter l = %.17g [m]\n"
            "T = %.17g [kg]*(x'^2 + y'^2)/2\nV = %.17g [N]*y\n"
            "hold %s while x > -1e9 [m]\noutput off [m] = sqrt(x^2 + y^2) - l\n"
            "scene s {\n  start x = %.17g [m], y = %.17g [m], x' = %.17g [m/s], y' = %.17g [m/s]\n"
            "  step 10 [ms]\n  until 3600 [s]\n}\n",
            length, exp(random_between(&seed, -2.0, 2.0)), random_between(&seed, 0.0, 1.0),
            square ? "x^2 + y^2" : "sqrt(x^2 + y^2)", length * cos(angle), length * sin(angle),
            -length * rate * sin(angle), length * rate * cos(angle));
        expect_kept(square ? "rod, as x^2 + y^2" : "rod", text, 100000, length, length);
    }
}

/* --- linkages --------------------------------------------------------------------------------------------------- */

typedef struct linkage {
    double side[4];  /* crank, coupler, rocker, ground */
    double angle[3]; /* of the first three */
    double rate[3];
} linkage;

/* Place coupler and rocker at a crank angle; false where it cannot be closed. */
static bool close_linkage(linkage *l) {
    const double x = l->side[3] - l->side[0] * cos(l->angle[0]);
    const double y = -l->side[0] * sin(l->angle[0]);
    const double way = hypot(x, y);
    const double c =
        (l->side[1] * l->side[1] + way * way - l->side[2] * l->side[2]) / (2.0 * l->side[1] * way);
    if (!(fabs(c) < 0.999)) {
        return false;
    }
    l->angle[1] = atan2(y, x) + acos(c);
    const double tip_x = l->side[0] * cos(l->angle[0]) + l->side[1] * cos(l->angle[1]);
    const double tip_y = l->side[0] * sin(l->angle[0]) + l->side[1] * sin(l->angle[1]);
    l->angle[2] = atan2(tip_y, tip_x - l->side[3]);
    const double det = sin(l->angle[1] - l->angle[2]);
    l->rate[1] = l->rate[0] * l->side[0] * sin(l->angle[2] - l->angle[0]) / (l->side[1] * det);
    l->rate[2] = l->rate[0] * l->side[0] * sin(l->angle[1] - l->angle[0]) / (l->side[2] * det);
    return fabs(det) > 0.2;
}

static void write_linkage(const linkage *l, const double inertia[3], double step_s, char *text,
                          size_t size) {
    char closing[2][200];
    for (int i = 0; i < 2; i++) {
        static const char *const wave[] = {"cos", "sin"};
        snprintf(closing[i], sizeof closing[i],
                 "%.17g [m]*%s(a) + %.17g [m]*%s(b) - %.17g [m]*%s(c)", l->side[0], wave[i],
                 l->side[1], wave[i], l->side[2], wave[i]);
    }
    snprintf(text, size,
             "mechanism bars\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate c [rad]\n"
             "T = (%.17g [kg*m^2]*a'^2 + %.17g [kg*m^2]*b'^2 + %.17g [kg*m^2]*c'^2)/2\n"
             "hold %s while a > -1e9\nhold %s while a > -1e9\n"
             "output off [m] = abs(%s - %.17g [m]) + abs(%s)\n"
             "scene s {\n  start a = %.17g, b = %.17g, c = %.17g, a' = %.17g [rad/s], b' = %.17g "
             "[rad/s], c' = %.17g [rad/s]\n  step %.17g [s]\n  until 3600 [s]\n}\n",
             inertia[0], inertia[1], inertia[2], closing[0], closing[1], closing[0], l->side[3],
             closing[1], l->angle[0], l->angle[1], l->angle[2], l->rate[0], l->rate[1], l->rate[2],
             step_s);
}

/* A crank that can turn: its shortest side, and shortest + longest < the two others. */
static bool random_linkage(uint64_t *seed, linkage *l) {
    *l = (linkage){.side = {random_between(seed, 0.03, 0.1), random_between(seed, 0.2, 0.5),
                            random_between(seed, 0.2, 0.5), random_between(seed, 0.2, 0.5)},
                   .angle = {random_between(seed, -3.0, 3.0)},
                   .rate = {random_between(seed, 5.0, 15.0)}};
    const double longest = fmax(l->side[1], fmax(l->side[2], l->side[3]));
    const double sum = l->side[1] + l->side[2] + l->side[3];
    return l->side[0] + longest < 0.9 * (sum - longest) && close_linkage(l);
}

static void test_linkages_stay_closed(void) {
    uint64_t seed = 12;
    for (int i = 0; i < 4;) {
        linkage l;
        char text[1600];
        if (!random_linkage(&seed, &l)) {
            continue;
        }
        const double inertia[3] = {random_between(&seed, 0.05, 0.2),
                                   random_between(&seed, 0.005, 0.05),
                                   random_between(&seed, 0.005, 0.05)};
        write_linkage(&l, inertia, 5e-3, text, sizeof text);
        expect_kept("four-bar linkage", text, 30000, l.side[3], l.side[3]);
        i++;
    }
}

/* Where the shortest and the longest side make as much as the others, a linkage lies flat once a turn, and has two
 * ways to go on from there. */
static void test_a_flat_linkage_is_refused(void) {
    const char *asked = getenv("WHIRL_FLAT_RUNS");
    const int runs =
        asked != NULL ? (int)strtol(asked, NULL, 10) : (int)few_or_all(usual_or(4, 2), 12);
    int missed[2] = {0, 0}; /* in double, in float */
    uint64_t seed = 13;
    for (int i = 0; i < runs; i++) {
        const double crank = random_between(&seed, 0.05, 0.15);
        const double coupler = random_between(&seed, 0.2, 0.4);
        linkage l = {.side = {crank, coupler, crank, coupler},
                     .angle = {random_between(&seed, 0.4, 2.7)},
                     .rate = {random_between(&seed, 1.0, 10.0)}};
        if (i % 3 == 0) { /* no parallelogram, but flat all the same */
            const double more = random_between(&seed, 0.01, 0.04);
            l.side[1] += more;
            l.side[2] += 0.05;
            l.side[3] = l.side[1] + l.side[2] - l.side[0];
        }
        TEST_ASSERT_TRUE(close_linkage(&l));
        const double inertia[3] = {random_between(&seed, 0.05, 0.2),
                                   random_between(&seed, 0.005, 0.05),
                                   random_between(&seed, 0.005, 0.05)};
        for (int n = 0; n < 2; n++) {
            char text[1600];
            motion m;
            write_linkage(&l, inertia, random_between(&seed, 0.5e-3, 3e-3), text, sizeof text);
            motion_open_text(&m, text, (stepping){.kind = KINDS[n], .method = WH_RK4});
            wh_status status = WH_OK;
            double flat = 1.0;
            for (long k = 0; k < 20000 && status == WH_OK; k++) {
                status = motion_step(&m, 1);
                flat = fmin(flat, fabs(sin(motion_value(&m, "a"))));
            }
            if (status != WH_E_SINGULAR || flat > 0.1) {
                printf("%sstatus %d, a = %g, %s\n", text, (int)status, motion_value(&m, "a"),
                       KINDS[n]->name);
            }
            /* not long before, and the last good state is kept */
            missed[n] += status != WH_E_SINGULAR || flat > 0.1;
            motion_close(&m);
        }
    }
    printf("  %d flat linkages: %d missed in double, %d in float\n", runs, missed[0], missed[1]);
    TEST_ASSERT_EQUAL_INT(0, missed[0]);
    /* a float's closure is as good as a gap of 1e-8 of the sides: some pass that, and turn back */
    TEST_ASSERT_LESS_OR_EQUAL_INT(runs / 100, missed[1]);
}

/* --- gears ------------------------------------------------------------------------------------------------------ */

/* Turned by 20000 rad, which a double knows to 4e-12. In float, where angles are integers, the mesh of gears whose
 * ratio a float holds is kept as such; another ratio to within what a float makes of it. */
static void test_gears_keep_their_mesh(void) {
    uint64_t seed = 14;
    static const double ratios[] = {1.0, 2.0, -3.0, 1.5, 0.0};
    for (int i = 0; i < 5; i++) {
        char text[900];
        const double ratio = ratios[i] != 0.0 ? ratios[i] : random_between(&seed, 0.3, 2.0);
        snprintf(text, sizeof text,
                 "mechanism gears\ncoordinate a [rad]\ncoordinate b [rad]\n"
                 "T = (0.1 [kg*m^2]*a'^2 + 0.2 [kg*m^2]*b'^2)/2\nV = 0.1 [J]*cos(a)\n"
                 "hold a - %.17g*b while a' > -1e9 [rad/s]\n"
                 "output off = sin(a - %.17g*b)\n"
                 "scene s {\n  start a' = %.17g [rad/s], b' = %.17g [rad/s]\n"
                 "  step 10 [ms]\n  until 3600 [s]\n}\n",
                 ratio, ratio, 20.0, 20.0 / ratio);
        expect_kept("gears", text, 100000, 20000.0, ratios[i] != 0.0 ? 1.0 : 20000.0);
        snprintf(text, sizeof text,
                 "mechanism wheel\ncoordinate a [rad]\ncoordinate x [m]\n"
                 "T = 0.1 [kg*m^2]*a'^2/2 + 1 [kg]*x'^2/2\nV = 5 [N/m]*x^2/2\n"
                 "hold x - %.17g [m]*a while x > -1e9 [m]\n"
                 "output off [m] = x - %.17g [m]*a\n"
                 "scene s {\n  start a' = %.17g [rad/s], x' = %.17g [m/s]\n"
                 "  step 10 [ms]\n  until 3600 [s]\n}\n",
                 ratio, ratio, 2.0, 2.0 * ratio);
        expect_kept("rolling wheel", text, 100000, 1.0, 1.0);
    }
}

/* --- what is kept is state -------------------------------------------------------------------------------------- */

/* An assignment that moves a held body is not undone: the hold keeps where it was put; and the books balance. */
static void test_an_assignment_gives_it_anew(void) {
    uint64_t seed = 15;
    for (int i = 0; i < 10; i++) {
        char text[900];
        const double to = random_between(&seed, 0.3, 2.0);
        const double angle = random_between(&seed, -1.0, 1.0);
        snprintf(
            text, sizeof text,
            "mechanism rod\ncoordinate x [m]\ncoordinate y [m]\ncoordinate clock [rad]\n"
            "T = 1 [kg]*(x'^2 + y'^2)/2 + 1 [kg*m^2]*clock'^2/2\nV = 3 [N]*y\n"
            "hold sqrt(x^2 + y^2) while x > -1e9 [m]\noutput off [m] = sqrt(x^2 + y^2)\n"
            "scene s {\n  with ledger\n  start x = 1 [m], y' = %.17g [m/s], clock' = 1 [rad/s]\n"
            "  when clock crosses %.17g rising { set x = %.17g [m], y = %.17g [m] }\n"
            "  step 2 [ms]\n  until 20 [s]\n}\n",
            random_between(&seed, 1.0, 8.0), random_between(&seed, 1.0, 5.0), to * cos(angle),
            to * sin(angle));
        for (int n = 0; n < 2; n++) {
            double total[32] = {0.0};
            double left[8] = {0.0};
            motion m;
            motion_open_text(&m, text, (stepping){.kind = KINDS[n], .method = WH_RK4});
            motion_to(&m, 20.0);
            expect_between("length over what was set", n ? 1.0 - 1e-6 : 1.0 - 1e-12,
                           n ? 1.0 + 1e-6 : 1.0 + 1e-12, motion_value(&m, "off") / to);
            m.kind->ledger(m.run, total, left);
            expect_between("left over, J", n ? -1e-2 : -1e-6, n ? 1e-2 : 1e-6, left[0]);
            motion_close(&m);
        }
    }
}

/* A stop that an input raises, and what is held to the body on it, straight or along a chain, the mass matrix coupled
 * or not: all of it comes along, by as much as keeps what is held. */
static void test_what_is_held_to_a_raised_body_comes_along(void) {
    uint64_t seed = 17;
    double worst[2] = {0.0, 0.0};
    for (int i = 0; i < 40; i++) {
        char text[900];
        const int number = i % 2;
        const double ratio[2] = {random_between(&seed, -2.0, 2.0),
                                 random_between(&seed, -2.0, 2.0)};
        const double coupled = i % 3 == 0 ? 0.0 : random_between(&seed, -0.5, 0.5);
        snprintf(
            text, sizeof text,
            "mechanism raised\ncoordinate x [m]\ncoordinate y [m]\ncoordinate z [m]\n"
            "input u = 0 [m]\nT = %.17g [kg]*x'^2/2 + y'^2*1 [kg]/2 + z'^2*1 [kg]/2 + %.17g [kg]*y'*x'\n"
            "V = 40 [N]*x\nstop %.17g*x >= %.17g*u restitution 0\nhold y - %.17g*x while u > -1 [m]\n"
            "hold z - %.17g*y while u > -1 [m]\n"
            "output off_y [m] = y - %.17g*x\noutput off_z [m] = z - %.17g*y\n"
            "scene s {\n  start y = 0.1 [m]\n  step 1 [ms]\n  until 1 [s]\n}\n",
            1.0 + random_between(&seed, 0.0, 3.0), coupled, 1.0 + i % 3, 1.0 + i % 3, ratio[0],
            ratio[1], ratio[0], ratio[1]);
        motion m;
        motion_open_text(&m, text, (stepping){.kind = KINDS[number], .method = WH_RK4});
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 5));
        const double kept[2] = {motion_value(&m, "off_y"), motion_value(&m, "off_z")};
        for (int step = 0; step < 20; step++) {
            const double u = 0.01 * (step % 7); /* up at once or in steps, and down again */
            m.kind->set_input(m.run, 0, u);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            worst[number] = fmax(worst[number], fabs(motion_value(&m, "off_y") - kept[0]));
            worst[number] = fmax(worst[number], fabs(motion_value(&m, "off_z") - kept[1]));
            worst[number] = fmax(worst[number], u - motion_value(&m, "x"));
        }
        motion_close(&m);
    }
    printf("  what is held to a raised body is off by %.1e m, float %.1e m\n", worst[0], worst[1]);
    TEST_ASSERT_TRUE(worst[0] <= 1e-15 && worst[1] <= 1e-6);
}

/* --- a hold freezes its own condition ----------------------------------------------------------------------------- */

/* An expression, and what moves it: bodies of 1 kg or kg*m^2, pushed along it by $f. */
typedef struct held {
    const char *expression;
    const char *unit; /* of it, and */
    const char *push; /* of the force */
    const char *coordinates;
    const char *kinetic;
    double yields; /* its acceleration by a force of 1; 0: not constant */
    /* $v its value, $r its rate, $c and $w a place and a rate that are none of it */
    const char *start;
} held;

static const held helds[] = {
    {"(a - b)", "m", "N", "coordinate a [m]\ncoordinate b [m]", "1 [kg]*(a'^2 + b'^2)/2", 2.0,
     "a = $v [m] + $c [m], b = $c [m], a' = $r [m/s] + $w [m/s], b' = $w [m/s]"},
    {"a", "m", "N", "coordinate a [m]", "1 [kg]*a'^2/2", 1.0, "a = $v [m], a' = $r [m/s]"},
    {"(a - 2*b)", "rad", "N*m", "coordinate a [rad]\ncoordinate b [rad]",
     "1 [kg*m^2]*(a'^2 + b'^2)/2", 5.0,
     "a = $v [rad] + 2*$c [rad], b = $c [rad], a' = $r [rad/s] + 2*$w [rad/s], b' = $w [rad/s]"},
    {"sqrt(x^2 + y^2)", "m", "N", "coordinate x [m]\ncoordinate y [m]", "1 [kg]*(x'^2 + y'^2)/2",
     0.0,
     "x = $v [m]*cos($c), y = $v [m]*sin($c), x' = $r [m/s]*cos($c) - $w [m/s]*sin($c), "
     "y' = $r [m/s]*sin($c) + $w [m/s]*cos($c)"},
};

/* $e is the expression, $l its limit, as the input L is; p rests at 0, d falls by 1 m/s. Those from LET_GO on are let go of
 * when d comes to zero. */
static const char *const edges[] = {
    "$e < $l",
    "$l - $e > 0",
    "abs($e) < $l",
    "$e^2 < ($l)^2",
    "atan($e/($l)) < atan(1)",
    "$e < L",
    "$e < $l or p > 1 [m]",
    "$e < $l and p < 1 [m]",
    "$e < $l and d > 0",
    "($e < $l or p > 1 [m]) and d > 0",
};

enum {
    HELDS = sizeof helds / sizeof helds[0],
    EDGES = sizeof edges / sizeof edges[0],
    LET_GO = EDGES - 2
};

/* `from` with each $ and its letter replaced. */
static const char *fill(const char *from, const held *of, const double number[static 6],
                        char to[static 600]) {
    static const char letters[] = "vrcwlf";
    size_t used = 0;
    for (; *from != '\0'; from++) {
        if (*from != '$') {
            to[used++] = *from;
        } else if (*++from == 'e') {
            used += (size_t)snprintf(to + used, 600 - used, "%s", of->expression);
        } else {
            used += (size_t)snprintf(to + used, 600 - used, "%.17g",
                                     number[strchr(letters, *from) - letters]);
            used += *from == 'l' ? (size_t)snprintf(to + used, 600 - used, " [%s]", of->unit) : 0U;
        }
    }
    to[used] = '\0';
    return to;
}

/* Where such a hold closes, its condition is at its limit, to the last digits. It stays held in both numbers, whatever pulls, and
 * whatever else happens in the same steps, until something else lets it go. One that begins there holds unless it goes out. */
static void test_a_hold_stays_at_its_own_limit(void) {
    dice d = dice_of("contact_holds", 1);
    int failures = 0;
    const unsigned cases = dice_cases(few_or_all(usual_or(120, 60), 600));
    for (unsigned i = 0; i < cases; i++) {
        char text[2000];
        char filled[2][600];
        const held *of = &helds[i % HELDS];
        const unsigned form = dice_one_of(&d, of->yields > 0.0 ? EDGES : LET_GO);
        /* in float a small square is lost in those that it is multiplied out to */
        const double least = strchr(edges[form], '^') != NULL ? 0.5 : 0.02;
        const double limit = exp(dice_between(&d, log(least), log(2.0)));
        const unsigned begins =
            dice_one_of(&d, 6); /* 0, 1, 2: at the limit, and goes out, rests, comes */
        const double gap = begins < 3 ? 0.0 : exp(dice_between(&d, log(0.01), log(0.5)));
        const double force = dice_between(&d, 0.1, 5.0);
        const double across = dice_between(&d, -2.0, 2.0) * limit / (limit + gap);
        const double turns =
            of->yields > 0.0 ? 0.0 : across * across * (pow(1.0 + gap / limit, 2.0) - 1.0);
        /* of a potential that bends the way in a step: the location ends short of the limit, or beyond */
        const double bends = gap > 0.0 && form < LET_GO ? dice_between(&d, 0.0, 2.0) : 0.0;
        const double work = force * gap + bends * gap / (limit + gap);
        const double speed =
            sqrt(2.0 * fmax(of->yields, 1.0) * work + turns) + dice_between(&d, 0.3, 2.0);
        const double until_s = dice_between(&d, 1.2, 1.6);
        const bool flies = begins == 0 && of->yields > 0.0;
        const double rate = flies ? 0.1 : begins == 1 ? 0.0 : -speed;
        const double free_s = flies ? 2.0 : form < LET_GO ? 0.0 : 2.0 - until_s;
        const double end =
            limit + (flies ? rate * 2.0 : 0.0) + 0.5 * force * of->yields * free_s * free_s;
        const double number[6] = {limit + gap, rate,  dice_between(&d, -2.0, 2.0),
                                  across,      limit, force};
        snprintf(
            text, sizeof text,
            "mechanism m\n%s\ncoordinate d [m]\ncoordinate p [m]\ncoordinate z [m]\ninput L = %.17g [%s]\n"
            "T = %s + 1 [kg]*(d'^2 + p'^2 + z'^2)/2\nV = 9.81 [N]*z - %.17g [%s]*%s + %.17g [J]*(%.17g [%s])/%s\n"
            "stop z >= 0 restitution 1\nwhen d crosses 0.3 [m] falling { set p = 0 [m] }\nhold %s while %s\noutput off [%s] = %s\n"
            "scene s {\nstart z = 0.05 [m], d = %.17g [m], d' = -1 [m/s], %s\nstep %.17g [ms]\nuntil 2 [s]\n}\n",
            of->coordinates, limit, of->unit, of->kinetic, force, of->push, of->expression, bends,
            limit, of->unit, of->expression, of->expression,
            fill(edges[form], of, number, filled[0]), of->unit, of->expression, until_s,
            fill(of->start, of, number, filled[1]), dice_one_of(&d, 2) == 0 ? 1.0 : 2.5);
        for (int kind = 0; kind < 2; kind++) {
            motion m;
            motion_open_text(&m, text, (stepping){.kind = KINDS[kind], .method = WH_RK4});
            TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, motion_step(&m, m.image->steps), text);
            const double off = fabs(motion_value(&m, "off") - end);
            motion_close(&m);
            if (!(off < (kind == 1 ? 1e-3 : bends > 0.0 ? 1e-5 : 1e-7) * (1.0 + end))) {
                printf("off by %g of %g in %s:\n%s", off, end, KINDS[kind]->name, text);
                failures++;
            }
        }
    }
    TEST_ASSERT_EQUAL_INT(0, failures);
}

void suite_contact_holds(void) {
    RUN_TEST(test_a_hold_stays_at_its_own_limit);
    RUN_TEST(test_what_is_held_to_a_raised_body_comes_along);
    RUN_TEST(test_rods_keep_their_length);
    RUN_TEST(test_linkages_stay_closed);
    RUN_TEST(test_a_flat_linkage_is_refused);
    RUN_TEST(test_gears_keep_their_mesh);
    RUN_TEST(test_an_assignment_gives_it_anew);
}
