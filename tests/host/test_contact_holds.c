/* test_contact_holds.c: holds keep their value for 1e5 steps and more, in rods, linkages and gears. The value that a
 * hold keeps is part of the state, and a `set` can change it. Linkages in their flat position are refused. */
#include "command.h"
#include "contacts.h"
#include "derived.h"

/* === suite contact_holds ====================================================================== */

static const engine_kind *const KINDS[] = {&engine_double, &engine_float};

/* Largest absolute value of the output `off` over `steps` steps, from samples, divided by `scale`. */
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

TEST(contact_holds, rods_keep_their_length) {
    uint64_t seed = 11;
    for (int i = 0; i < 6; i++) {
        char text[700];
        const double length = exp(random_between(&seed, -3.0, 3.0));
        const double angle = random_between(&seed, -3.0, 3.0);
        const double rate = random_between(&seed, 5.0, 20.0); /* step times rate is 0.2 or less */
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

typedef struct linkage {
    double side[4];  /* lengths of crank, coupler, rocker and ground */
    double angle[3]; /* angles of crank, coupler and rocker */
    double rate[3];
} linkage;

/* Finds the angles of coupler and rocker for a crank angle. Returns false if the linkage cannot close. */
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

/* Draws a linkage whose crank can turn fully: the crank is the shortest side, and shortest + longest < sum of the
 * others. */
static bool random_linkage(uint64_t *seed, linkage *l) {
    *l = (linkage){.side = {random_between(seed, 0.03, 0.1), random_between(seed, 0.2, 0.5),
                            random_between(seed, 0.2, 0.5), random_between(seed, 0.2, 0.5)},
                   .angle = {random_between(seed, -3.0, 3.0)},
                   .rate = {random_between(seed, 5.0, 15.0)}};
    const double longest = fmax(l->side[1], fmax(l->side[2], l->side[3]));
    const double sum = l->side[1] + l->side[2] + l->side[3];
    return l->side[0] + longest < 0.9 * (sum - longest) && close_linkage(l);
}

TEST(contact_holds, linkages_stay_closed) {
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

/* If shortest + longest equals the sum of the others, the linkage lies flat once per turn. Two motions are possible
 * from there. */
TEST(contact_holds, a_flat_linkage_is_refused) {
    const int runs = (int)dice_cases(few_or_all(usual_or(4, 2), 12));
    int missed[2] = {0, 0}; /* runs that were not refused, in double and in float */
    uint64_t seed = 13;
    for (int i = 0; i < runs; i++) {
        const double crank = random_between(&seed, 0.05, 0.15);
        const double coupler = random_between(&seed, 0.2, 0.4);
        linkage l = {.side = {crank, coupler, crank, coupler},
                     .angle = {random_between(&seed, 0.4, 2.7)},
                     .rate = {random_between(&seed, 1.0, 10.0)}};
        if (i % 3 == 0) { /* a flat linkage that is no parallelogram */
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
            /* the run must end as singular, near the flat position */
            missed[n] += status != WH_E_SINGULAR || flat > 0.1;
            motion_close(&m);
        }
    }
    printf("  %d flat linkages: %d missed in double, %d in float\n", runs, missed[0], missed[1]);
    TEST_ASSERT_EQUAL_INT(0, missed[0]);
    /* the round-off of float moves the gap by 1e-8 of the sides, so some runs pass the flat position and turn back */
    TEST_ASSERT_LESS_OR_EQUAL_INT(runs / 100, missed[1]);
}

/* The gears turn by 20000 rad, where a double resolves 4e-12 rad. In float, angles are integers, so the mesh is
 * exact if float represents the gear ratio. Else the mesh is as accurate as the rounded ratio. */
TEST(contact_holds, gears_keep_their_mesh) {
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

/* A `set` moves a held body. The hold keeps the new value, and the energy balance has no residual. */
TEST(contact_holds, hold_accepts_an_assigned_value) {
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

/* An input raises a stop. Bodies that are held to the body on this stop, directly or in a chain, must move by the
 * distance that satisfies the holds, with or without coupling in the mass matrix. */
TEST(contact_holds, bodies_held_to_a_raised_body) {
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
            const double u = 0.01 * (step % 7); /* raises the stop in steps, then lowers it */
            m.kind->set_input(m.run, 0, u);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            worst[number] = fmax(worst[number], fabs(motion_value(&m, "off_y") - kept[0]));
            worst[number] = fmax(worst[number], fabs(motion_value(&m, "off_z") - kept[1]));
            worst[number] = fmax(worst[number], u - motion_value(&m, "x"));
        }
        motion_close(&m);
    }
    printf("  the expression of a hold to a raised body is off by %.1e m, float %.1e m\n", worst[0],
           worst[1]);
    TEST_ASSERT_TRUE(worst[0] <= 1e-15 && worst[1] <= 1e-6);
}

/* An expression to be held; its bodies have 1 kg or 1 kg m^2. A force pushes along the expression. */
typedef struct held {
    const char *expression;
    const char *unit; /* unit of the expression */
    const char *push; /* unit of the force */
    const char *coordinates;
    const char *kinetic;
    double yields; /* acceleration of the expression by a force of 1; 0: not constant */
    /* $v: value of the expression; $r: its rate; $c and $w: a position and its rate that change neither */
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

/* Conditions of the hold. $e is the expression; $l and the input L are its limit; p rests at 0; d falls at 1 m/s.
 * The conditions from number LET_GO on release the hold when d reaches zero. */
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

/* Copies `from`; replaces each $ and the letter after it by the expression or a number. */
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

/* A hold begins to act when its expression reaches the limit of its own condition. The hold must act on, with any
 * load and through other events in the same step, until another condition releases the hold. A hold that starts at
 * its limit must act, too, unless its body moves out of the condition. */
TEST(contact_holds, hold_acts_at_its_own_limit) {
    dice d = dice_of("contact_holds", 1);
    int failures = 0;
    const unsigned cases = dice_cases(few_or_all(usual_or(120, 60), 600));
    for (unsigned i = 0; i < cases; i++) {
        char text[2000];
        char filled[2][600];
        const held *of = &helds[i % HELDS];
        const unsigned form = dice_one_of(&d, of->yields > 0.0 ? EDGES : LET_GO);
        /* in float, the expanded square of a small number loses its digits, so the limit is larger */
        const double least = strchr(edges[form], '^') != NULL ? 0.5 : 0.02;
        const double limit = exp(dice_between(&d, log(least), log(2.0)));
        /* 0 to 2: starts at the limit and moves out (0), rests (1) or moves in (2); 3 to 5: starts beyond it */
        const unsigned begins = dice_one_of(&d, 6);
        const double gap = begins < 3 ? 0.0 : exp(dice_between(&d, log(0.01), log(0.5)));
        const double force = dice_between(&d, 0.1, 5.0);
        const double across = dice_between(&d, -2.0, 2.0) * limit / (limit + gap);
        const double turns =
            of->yields > 0.0 ? 0.0 : across * across * (pow(1.0 + gap / limit, 2.0) - 1.0);
        /* this potential bends the motion within a step, so the located event lies before or beyond the limit */
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

/* === suite contact_load ======================================================================= */
/* Contacts that share one load (core/models/contacts_together.whirl), and resting contacts that a `set` or an input
 * disturbs. */

#define G 9.81

static const stepping *each_number(int i) {
    static const stepping ways[] = {{.kind = &engine_double, .method = WH_RK4},
                                    {.kind = &engine_float, .method = WH_RK4},
                                    {.kind = &engine_float, .method = WH_RK4, .compensated = true}};
    return i < 3 ? &ways[i] : NULL;
}

/* Three contacts act on two coordinates, so the forces are not unique. If some forces can hold the bodies, the
 * bodies must not move. */
TEST(contact_load, leaning_blocks_rest_exactly) {
    for (int i = 0; each_number(i) != NULL; i++) {
        motion m;
        motion_open(&m, "leaning_rests", *each_number(i));
        motion_to(&m, 2.0);
        const double x = motion_value(&m, "x");
        const double y = motion_value(&m, "y");
        const uint64_t events = contacts_events(&m);
        TEST_ASSERT_TRUE(motion_value(&m, "x'") == 0.0 && motion_value(&m, "y'") == 0.0);
        motion_to(&m, 60.0);
        TEST_ASSERT_TRUE(motion_value(&m, "x") == x && motion_value(&m, "y") == y);
        TEST_ASSERT_EQUAL_UINT64(events, contacts_events(&m));
        TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
        /* the blocks touch, apart from round-off */
        expect_between("y - x - w", -1e-7, 1e-7, y - x - 0.1);
        motion_close(&m);
    }
}

static const char *const GROOVES[][2] = {
    {"a=30 [deg]", "b=30 [deg]"}, {"a=45 [deg]", "b=45 [deg]"}, {"a=44 [deg]", "b=45 [deg]"},
    {"a=10 [deg]", "b=60 [deg]"}, {"a=60 [deg]", "b=60 [deg]"}, {"a=20 [deg]", "b=15 [deg]"}};

static void run_groove(const char *const slopes[2], const char *restitution,
                       const engine_kind *kind) {
    char more[300];
    motion m;
    snprintf(more, sizeof more,
             "scene groove_now {\n use groove\n with sides\n set %s, %s, %s\n"
             " start x = 5 [cm], y = 30 [cm]\n step 1 [ms]\n until 30 [s]\n}\n",
             slopes[0], slopes[1], restitution);
    motion_open_more(&m, "contacts_together.whirl", more,
                     (stepping){.kind = kind, .method = WH_RK4});
    motion_to(&m, 20.0);
    const uint64_t events = contacts_events(&m);
    printf("  %s, %s, %s, %s: %llu events, %llu overruns\n", slopes[0], slopes[1], restitution,
           kind->name, (unsigned long long)events, (unsigned long long)contacts_overruns(&m));
    /* at rest in the corner, apart from the round-off of one product */
    const double speed = hypot(motion_value(&m, "x'"), motion_value(&m, "y'"));
    TEST_ASSERT_TRUE(speed < 1e-15);
    TEST_ASSERT_TRUE(hypot(motion_value(&m, "x"), motion_value(&m, "y")) < 1e-15);
    TEST_ASSERT_TRUE(contacts_overruns(&m) <= 1);
    motion_to(&m, 30.0);
    TEST_ASSERT_EQUAL_UINT64(events, contacts_events(&m));
    motion_close(&m);
}

TEST(contact_load, ball_rests_in_a_groove) {
    for (unsigned i = 0; i < sizeof GROOVES / sizeof GROOVES[0]; i++) {
        run_groove(GROOVES[i], "e=0", &engine_double);
        run_groove(GROOVES[i], "e=0.5", &engine_double);
        run_groove(GROOVES[i], "e=0.5", &engine_float);
    }
}

#define FLOOR \
    "mechanism kicked\ncoordinate y [m]\ncoordinate c [rad]\nparameter m = 1 [kg]\n" \
    "parameter J = 1 [kg*m^2]\nparameter g = 9.81 [m/s^2]\ninput floor = 0 [m]\n" \
    "input e = 0.5\n" \
    "T = m*y'^2/2 + J*c'^2/2\nV = m*g*y\nstop y >= floor restitution e\n" \
    "scene s {\n  start y = 0, c' = 1 [rad/s]\n  with ledger\n  step 1 [ms]\n  until 4 [s]\n"

/* The height at time at_s of a ball that rests until `set` acts on it, when the clock c passes 0.5 s. */
static double height_after(const char *set, double at_s, const engine_kind *kind) {
    char text[600];
    motion m;
    snprintf(text, sizeof text, FLOOR "  when c crosses 0.5 rising { set %s }\n}\n", set);
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4});
    motion_to(&m, at_s);
    const double y = motion_value(&m, "y");
    motion_to(&m, 4.0);
    TEST_ASSERT_TRUE(motion_value(&m, "y") == 0.0 && motion_value(&m, "y'") == 0.0);
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    motion_close(&m);
    return y;
}

TEST(contact_load, assignments_lift_or_throw_resting_bodies) {
    for (int i = 0; each_number(i) != NULL; i++) {
        const engine_kind *kind = each_number(i)->kind;
        const double bound = kind == &engine_float ? 1e-5 : 1e-9;
        expect_between("thrown up with 2 m/s, after 0.2 s", -bound, bound,
                       height_after("y' = 2 [m/s]", 0.7, kind) - (0.4 - 0.5 * G * 0.04));
        /* thrown down: the ball returns with half of the speed */
        expect_between("thrown down with 4 m/s, after 0.2 s", -bound, bound,
                       height_after("y' = -4 [m/s]", 0.7, kind) - (0.4 - 0.5 * G * 0.04));
        expect_between("lifted by 1 m, after 0.2 s", -bound, bound,
                       height_after("y = 1 [m]", 0.7, kind) - (1.0 - 0.5 * G * 0.04));
        /* set into the floor: the ball is put back at once */
        expect_between("pushed through, after 0.2 s", 0.0, 0.0,
                       height_after("y = -1 [m]", 0.7, kind));
    }
}

/* An input sets the restitution below 0 or above 1. Whirl must use 0 or 1 instead, so that no energy appears. */
TEST(contact_load, restitution_from_inputs_is_clamped) {
    motion m;
    stepping how = IN_DOUBLE;
    how.start = "y=1";
    motion_open_text(&m, FLOOR "}\n", how);
    m.kind->set_input(m.run, 1, 1.5);
    double highest = 0.0;
    for (int i = 0; i < 4000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        highest = fmax(highest, motion_value(&m, "y"));
    }
    expect_between("highest", 0.99, 1.0 + 1e-12, highest);
    TEST_ASSERT_TRUE(contacts_events(&m) >= 4);
    motion_close(&m);
}

/* A `set` gives a held expression a rate of 2 m/s. The hold captures again; its entries are the momentum m (2 - 0)
 * and the energy m 2^2/2. */
TEST(contact_load, hold_absorbs_an_assigned_rate) {
    static const char text[] =
        "mechanism held\ncoordinate x [m]\ncoordinate z [m]\ncoordinate c [rad]\n"
        "parameter m = 1 [kg]\nparameter J = 1 [kg*m^2]\nT = m*(x'^2 + z'^2)/2 + J*c'^2/2\n"
        "hold x - z while c < 2\n"
        "scene s {\n  with ledger\n  start c' = 1 [rad/s]\n"
        "  when c crosses 0.5 rising { set x' = 2 [m/s] }\n  step 1 [ms]\n  until 1 [s]\n}\n";
    motion m;
    double total[64] = {0.0};
    double left[8] = {0.0};
    motion_open_text(&m, text, IN_DOUBLE);
    motion_to(&m, 1.0);
    expect_between("x'", 1.0 - 1e-15, 1.0 + 1e-15, motion_value(&m, "x'"));
    expect_between("z'", 1.0 - 1e-15, 1.0 + 1e-15, motion_value(&m, "z'"));
    m.kind->ledger(m.run, total, left);
    expect_between("energy residual", -1e-14, 1e-14, left[0]);
    bool booked = false; /* is an entry the lost 1 J, half of the energy? */
    for (int i = 0; i < 64; i++) {
        booked = booked || fabs(total[i] + 1.0) < 1e-14;
    }
    TEST_ASSERT_TRUE(booked);
    motion_close(&m);
}

/* === suite contact_rest ======================================================================= */
/* Bodies that come to rest together, pressed together only by their braking. Static friction must keep them at rest
 * in spite of round-off in forces and rates. */

/* Wagon x brakes, and wagon y pushes x through a straight or curved buffer, with less than the static friction. If
 * `both`, y has friction, too. */
static void write_wagons(uint64_t *seed, bool curved, bool both, char *text, size_t size) {
    const double mass[2] = {exp(random_between(seed, -1.0, 1.0)),
                            exp(random_between(seed, -1.0, 1.0))};
    const double bend = curved ? random_between(seed, 0.02, 0.3) : 0.0;
    const double slope = curved ? random_between(seed, 0.5, 1.0) : 1.0;
    const double speed = random_between(seed, 0.4, 2.0);
    const double normal = random_between(seed, 8.0, 40.0) * (mass[0] + mass[1]);
    const double mu = random_between(seed, 0.2, 0.5);
    const double ratio = random_bits(seed) % 3U != 0 ? random_between(seed, 0.5, 1.0) : 1.0;
    const double push = random_between(seed, -0.5, 0.5) * mu * ratio * normal;
    char second[160] = "";
    if (both) { /* the friction of y is weak, so that y keeps pushing */
        const double own = 0.05 * normal * slope * mass[1] / mass[0];
        snprintf(second, sizeof second, "friction y static %.17g kinetic %.17g normal %.17g [N]\n",
                 mu, mu * ratio, own);
    }
    snprintf(text, size,
             "mechanism wagons\ncoordinate x [m]\ncoordinate y [m]\n"
             "T = %.17g [kg]*x'^2/2 + %.17g [kg]*y'^2/2\nV = %.17g [N]*x\n"
             "stop y <= %.17g*x + %.17g [1/m]*x^2 restitution 0\n"
             "friction x static %.17g kinetic %.17g normal %.17g [N]\n%s"
             "scene s {\n  start x' = %.17g [m/s], y' = %.17g [m/s]\n  until 6 [s]\n}\n",
             mass[0], mass[1], push, slope, bend, mu, mu * ratio, normal, second, speed,
             slope * speed);
}

static void check_wagons(bool curved, bool both, const char *words) {
    static const double steps_s[] = {5e-3, 2e-3, 1e-3, 0.5e-3};
    uint64_t seed = 31;
    const int pairs = (int)few_or_all(usual_or(4, 2), 60);
    for (int i = 0; i < pairs; i++) {
        char text[1200];
        double rests[4];
        write_wagons(&seed, curved, both, text, sizeof text);
        for (int n = 0; n < 2; n++) {
            for (int k = 0; k < 4; k++) {
                motion m;
                motion_open_text(
                    &m, text, (stepping){.kind = KINDS[n], .method = WH_RK4, .step_s = steps_s[k]});
                motion_to(&m, 6.0);
                const double moves = fabs(motion_value(&m, "x'")) + fabs(motion_value(&m, "y'"));
                const uint64_t events = contacts_events(&m);
                rests[k] = motion_value(&m, "x");
                const double off = fabs(rests[k] - rests[0]);
                if (moves > 1e-9 || events > 6 || off > (n ? 1e-4 : 1e-6)) {
                    printf("%sh = %g s, %s: moves with %.2e m/s, %llu events, off by %.1e m\n",
                           text, steps_s[k], KINDS[n]->name, moves, (unsigned long long)events,
                           off);
                }
                TEST_ASSERT_TRUE_MESSAGE(moves <= 1e-9 && events <= 6 && off <= (n ? 1e-4 : 1e-6),
                                         words);
                TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, contacts_overruns(&m), words);
                motion_close(&m);
            }
        }
    }
}

TEST(contact_rest, wagons_with_a_straight_buffer) { check_wagons(false, false, "straight"); }
TEST(contact_rest, wagons_with_a_curved_buffer) { check_wagons(true, false, "curved"); }
TEST(contact_rest, wagons_that_both_brake) { check_wagons(true, true, "curved, both brake"); }

/* A row of wagons with brakes and plastic buffers, with or without a wall, pushed with less than the static
 * friction. The wagons must come to rest after few events, at a position that does not depend on the step, without
 * overlap. */
static void write_row(uint64_t *seed, int wagons, bool wall, char *text, size_t size) {
    int at = snprintf(text, size, "mechanism row\n");
    char T[400] = "0";
    char rest[1200] = "";
    char start[500] = "start ";
    double speed = random_between(seed, 0.5, 2.5);
    for (int i = 0; i < wagons; i++) {
        const double normal = 10.0 * (double)(1 + random_bits(seed) % 5U);
        const double mu = 0.05 * (double)(1 + random_bits(seed) % 6U);
        char more[300];
        at += snprintf(text + at, size - (size_t)at, "coordinate x%d [m]\n", i);
        snprintf(more, sizeof more, " + %d [kg]*x%d'^2/2", 1 + (int)(random_bits(seed) % 4U), i);
        strncat(T, more, sizeof T - strlen(T) - 1);
        snprintf(more, sizeof more, "friction x%d static %.17g kinetic %.17g normal %.17g [N]\n", i,
                 1.2 * mu, mu, normal);
        strncat(rest, more, sizeof rest - strlen(rest) - 1);
        if (i > 0) {
            snprintf(more, sizeof more, "stop x%d >= x%d restitution 0\n", i, i - 1);
            strncat(rest, more, sizeof rest - strlen(rest) - 1);
        } else {
            snprintf(more, sizeof more, "Q(x0) = %.17g [N]\n",
                     random_between(seed, 0.0, 0.9) * mu * normal);
            strncat(rest, more, sizeof rest - strlen(rest) - 1);
        }
        snprintf(more, sizeof more, "%sx%d = %.17g [m], x%d' = %.17g [m/s]", i > 0 ? ", " : "", i,
                 0.1 * i, i, speed);
        strncat(start, more, sizeof start - strlen(start) - 1);
        speed *= random_between(seed, 0.0, 1.0);
    }
    if (wall) {
        char more[100];
        snprintf(more, sizeof more, "stop %.17g [m] >= x%d restitution 0\n",
                 0.1 * (wagons - 1) + random_between(seed, 0.0, 0.2), wagons - 1);
        strncat(rest, more, sizeof rest - strlen(rest) - 1);
    }
    snprintf(text + at, size - (size_t)at, "T = 0 [J]*0%s\n%sscene s {\n  %s\n  until 30 [s]\n}\n",
             T + 1, rest, start);
}

TEST(contact_rest, rows_of_wagons) {
    uint64_t seed = 41;
    uint64_t most = 0;
    int overran = 0;
    int runs = 0;
    const int rows = (int)dice_cases(few_or_all(usual_or(3, 2), 18));
    for (int i = 0; i < rows; i++) {
        char text[3000];
        const int wagons = 2 + i % 3;
        double rests[8] = {0.0};
        write_row(&seed, wagons, i % 2 != 0, text, sizeof text);
        for (int n = 0; n < 4; n++) {
            static const double steps_s[] = {1e-3, 5e-3};
            motion m;
            motion_open_text(
                &m, text,
                (stepping){.kind = KINDS[n / 2], .method = WH_RK4, .step_s = steps_s[n % 2]});
            motion_to(&m, 30.0);
            const bool over = contacts_overruns(&m) > 0;
            bool good = contacts_events(&m) <= 60;
            overran += over;
            double before = -1.0;
            for (int k = 0; k < wagons; k++) {
                char name[16];
                snprintf(name, sizeof name, "x%d", k);
                const double x = motion_value(&m, name);
                good = good && x - before >= (n < 2 ? -1e-12 : -1e-6);
                before = x;
                rests[k] = n == 0 ? x : rests[k];
                good = good && fabs(x - rests[k]) < (over ? 1e-2 : 2e-3);
                snprintf(name, sizeof name, "x%d'", k);
                good = good && fabs(motion_value(&m, name)) < 1e-12;
            }
            runs++;
            most = contacts_events(&m) > most ? contacts_events(&m) : most;
            if (!good) {
                printf("%s%s, h = %g s: %llu events, %llu overruns; ends at", text,
                       KINDS[n / 2]->name, steps_s[n % 2], (unsigned long long)contacts_events(&m),
                       (unsigned long long)contacts_overruns(&m));
                for (int k = 0; k < wagons; k++) {
                    char name[16];
                    snprintf(name, sizeof name, "x%d", k);
                    printf(" %.12g (%.12g)", motion_value(&m, name), rests[k]);
                }
                puts("");
            }
            TEST_ASSERT_TRUE(good);
            motion_close(&m);
        }
    }
    printf("  at most %llu events; %d of %d runs overran\n", (unsigned long long)most, overran,
           runs);
    TEST_ASSERT_TRUE(overran <= runs / 20);
}

/* A growing force pulls a light body, while a large force acts on another body. The round-off of the large force
 * must not affect the light body. */
TEST(contact_rest, distant_forces_hold_no_body) {
    for (int i = 0; i < 8; i++) {
        char text[700];
        const int digits = 2 + i / 2;
        const double large = pow(10.0, digits);
        snprintf(text, sizeof text,
                 "mechanism beside\ncoordinate y [m]\ncoordinate z [m]\ncoordinate c [rad]\n"
                 "T = 0.5 [kg]*y'^2/2 + 2 [kg]*z'^2/2 + 1e6 [kg*m^2]*c'^2/2\n"
                 "Q(y) = %s\nQ(z) = -%.17g [N]\nstop z >= 0 [m] restitution 0\n%s"
                 "scene s {\n  start c' = 0.1 [rad/s]\n  until 6 [s]\n}\n",
                 i % 2 ? "2 [N]*sin(c)" : "2 [N]*sin(c) - 0.5 [N]", large,
                 i % 2 ? "friction y static 0.5 kinetic 0.5 normal 1 [N]\n"
                       : "stop y >= 0 [m] restitution 0\n");
        for (int n = 0; n < 2; n++) {
            motion m;
            motion_open_text(&m, text, (stepping){.kind = KINDS[n], .method = WH_RK4});
            motion_to(&m, 6.0);
            /* the motion begins at t0 with sin(0.1 t0) = 1/4: m y'' = 2 (sin(0.1 t) - 1/4) */
            const double c0 = asin(0.25);
            const double c1 = 0.6;
            const double y =
                4.0 * 100.0 *
                (-sin(c1) + sin(c0) + cos(c0) * (c1 - c0) - 0.25 * (c1 - c0) * (c1 - c0) / 2.0);
            expect_between("y over the closed form", n ? 0.999 : 1.0 - 1e-9, n ? 1.001 : 1.0 + 1e-9,
                           motion_value(&m, "y") / y);
            motion_close(&m);
        }
    }
}
