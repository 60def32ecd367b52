/* test_missed.c: contacts and forces that are thinner than the path of a step. Hits on round posts must follow
 * closed forms (core/contact/contact_step.h). A body that passes a latch, a flat wall, an edge or a barrier of
 * potential energy must cause a warning (host/check/missed.h); a right run must not. WHIRL_CASES=N and WHIRL_SEED=N
 * choose other cases. */
#include "command.h"
#include "contacts.h"
#include "hybrid.h"
#include "jumps.h"

enum { TEXT = 1500 };

static char text[TEXT];

/* A body of 1 kg. Its path starts 1 m and a random part of a step before a place. */
typedef struct flight {
    double start_m; /* start on the x axis, relative to the place */
    double v_m_s;
    double step_s;
    double until_s;
    double place_m[2];
    char x[40]; /* x - place as a formula of the language */
    char y[40];
    double bounce_s; /* time at which another body bounces; 0: no other body */
} flight;

/* Draws the place, at the origin or up to 2 m from it on each axis, and whether another body bounces nearby. */
static void flight_place(dice *d, flight *f) {
    const bool away = dice_one_of(d, 4) != 0;
    static const char names[] = "xy";
    for (int i = 0; i < 2; i++) {
        f->place_m[i] = away ? dice_between(d, -2.0, 2.0) : 0.0;
        snprintf(i == 0 ? f->x : f->y, sizeof f->x, "(%c - %.17g [m])", names[i], f->place_m[i]);
    }
    f->bounce_s = dice_one_of(d, 3) == 0
                      ? -f->start_m / f->v_m_s + dice_between(d, -1.0, 1.0) * f->step_s
                      : 0.0;
}

static flight flight_draw(dice *d) {
    static const double steps_s[] = {1e-3, 2e-3, 5e-3};
    flight f = {.v_m_s = dice_between(d, 1.0, 32.0), .step_s = steps_s[dice_one_of(d, 3)]};
    f.start_m = -1.0 - dice_between(d, 0.0, f.v_m_s * f.step_s);
    f.until_s = f.step_s * floor((1.5 / f.v_m_s + 0.1) / f.step_s);
    flight_place(d, &f);
    return f;
}

/* Runs to the end with the statements `more`. y starts at aside_m. Returns whether there is a warning. */
static bool fly(motion *m, const flight *f, const char *more, double aside_m) {
    char start[80] = "";
    const bool beside = f->bounce_s > 0.0;
    if (beside) {
        snprintf(start, sizeof start, ", z = %.17g [m], z' = -1 [m/s]", f->bounce_s);
    }
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n%sT = 1 [kg]*(x'^2 + y'^2%s)/2\n"
             "%s\n%sscene s {\nstart x = %.17g [m], x' = %.17g [m/s], y = %.17g [m]%s\n"
             "step %.17g [s]\nuntil %.17g [s]\n}\n",
             beside ? "coordinate z [m]\n" : "", beside ? " + z'^2" : "", more,
             beside ? "stop z >= 0 restitution 1\n" : "", f->place_m[0] + f->start_m, f->v_m_s,
             f->place_m[1] + aside_m, start, f->step_s, f->until_s);
    motion_open_text(m, text, IN_DOUBLE);
    return jumps_some(m);
}

static double thickness_m(dice *d) { return 0.1e-3 * exp(dice_between(d, 0.0, log(320.0))); }

/* Copies statements. $x and $y become the coordinates relative to the place, $w becomes the thickness. */
static void place_write(const flight *f, double w_m, const char *from, char to[static TEXT]) {
    size_t used = 0;
    for (; *from != '\0'; from++) {
        if (*from != '$') {
            to[used++] = *from;
            continue;
        }
        const char of = *++from;
        used +=
            (size_t)(of == 'w' ? snprintf(to + used, TEXT - used, "%.17g [m]", w_m)
                               : snprintf(to + used, TEXT - used, "%s", of == 'x' ? f->x : f->y));
    }
    to[used] = '\0';
}

static const char *const posts[] = {
    "stop sqrt($x^2 + $y^2) >= $w restitution 1",
    "stop sqrt($x^2 + $y^2) - $w >= 0 restitution 1",
    "stop $x^2 + $y^2 >= ($w)^2 restitution 1",
};

enum { POSTS = sizeof posts / sizeof posts[0] };

/* Posts of 0.1 to 32 mm with restitution 1, hit at the centre, hit off the centre, or missed. */
TEST(missed, posts) {
    dice d = dice_of("missed", 1);
    const unsigned cases = dice_cases(few_or_all(usual_or(60, 20), 120));
    unsigned thin = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char more[TEXT];
        const flight f = flight_draw(&d);
        const double r_m = 0.5 * thickness_m(&d);
        const double aside_m = k % 3 == 0 ? 0.0 : r_m * dice_between(&d, -1.3, 1.3);
        place_write(&f, r_m, posts[dice_one_of(&d, POSTS)], more);
        TEST_ASSERT_FALSE_MESSAGE(fly(&m, &f, more, aside_m), text);
        const bool hits = fabs(aside_m) < r_m;
        const double at_m = hits ? -sqrt(r_m * r_m - aside_m * aside_m) : 0.0;
        const double hit_s = (at_m - f.start_m) / f.v_m_s;
        const double nx = at_m / r_m; /* (nx, ny): normal of the post at the hit */
        const double ny = aside_m / r_m;
        const double turn = hits ? 2.0 * f.v_m_s * nx : 0.0;
        const double left_s = f.until_s - hit_s;
        const double x_m = at_m + left_s * (f.v_m_s - turn * nx);
        const double y_m = aside_m - left_s * turn * ny;
        const double off_m = hypot(motion_value(&m, "x") - f.place_m[0] - x_m,
                                   motion_value(&m, "y") - f.place_m[1] - y_m);
        const double edge = fabs(fabs(ny) - 1.0);
        /* away from the origin, the squares are expanded, so the squared gap has the round-off of the squared
         * position */
        const double square_m2 = pow(hypot(f.place_m[0], f.place_m[1]), 2.0);
        const double turned = 16.0 * 0x1p-53 * square_m2 / (r_m * r_m * sqrt(edge));
        if (edge > 1e-3) { /* a grazing hit amplifies the round-off of the position */
            TEST_ASSERT_TRUE_MESSAGE(off_m < 1e-7 + turned, text);
        }
        thin += hits && 2.0 * r_m < f.v_m_s * f.step_s;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(thin * 3 > cases);
}

/* Has the energy changed by more than 1 % since the start? Start and end are far from the barrier. */
static bool is_unbalanced(const motion *m, const flight *f) {
    const double vx = motion_value(m, "x'");
    const double vy = motion_value(m, "y'");
    const double y_m = motion_value(m, "y") - f->place_m[1];
    const double from_J = 0.5 * f->v_m_s * f->v_m_s + 50.0 * 9e-6;
    return fabs(0.5 * (vx * vx + vy * vy) + 50.0 * y_m * y_m - from_J) > 0.01 * from_J;
}

static const char *const flats[] = {
    "hold x while $x > 0 and $x < $w",
    "hold x - y while abs($x) < $w/2",
    "stop $y + 4 [mm] >= 1 [m]*exp(-($x/($w))^2) restitution 0.5",
    "stop $y + 4 [mm] >= 1 [m]/(1 + ($x/($w))^4) restitution 0.5",
    "hold x while $x^2 < ($w)^2",
    "hold x while sqrt($x^2) < $w",
    "hold x while $x*($w - $x) > 0",
    "hold x while 1/(1 + ($x/($w))^2) > 0.5",
    "hold x while exp(-($x/($w))^2) > 0.5",
    "hold x while atan2($w, abs($x)) > 0.7853",
    "hold x while abs(acos($x/(8 [m])) - 1.5707963267948966) < ($w)/(8 [m])",
    "hold x while cosh(min(abs($x)/($w), 100)) < 1.5",
    "hold x while $x^2 + $y^2 < ($w)^2 + (3 [mm])^2",
};

enum { FLATS = sizeof flats / sizeof flats[0] };

/* A body must hit latches, walls, and a potential barrier above its energy, or there must be a warning. */
TEST(missed, flat_ones) {
    dice d = dice_of("missed", 2);
    const unsigned cases = dice_cases(few_or_all(112, 224));
    unsigned told = 0;
    unsigned met = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char more[TEXT];
        char from[400];
        const flight f = flight_draw(&d);
        const double w_m = thickness_m(&d);
        const double hill_J = 0.5 * f.v_m_s * f.v_m_s * dice_between(&d, 1.2, 5.0);
        const bool is_hill = k % (FLATS + 1) == FLATS;
        if (is_hill) {
            snprintf(from, sizeof from, "V = 100 [N/m]*$y^2/2 + %.17g [J]*exp(-($x/($w))^2)",
                     hill_J);
        } else {
            snprintf(from, sizeof from, "V = 100 [N/m]*$y^2/2\n%s", flats[k % (FLATS + 1)]);
        }
        place_write(&f, w_m, from, more);
        const bool is_told = fly(&m, &f, more, 3e-3);
        const bool is_met = is_hill ? motion_value(&m, "x") < f.place_m[0]
                                    : fabs(motion_value(&m, "x'") - f.v_m_s) > 1e-6 * f.v_m_s;
        TEST_ASSERT_TRUE_MESSAGE(is_told || is_met || (is_hill && is_unbalanced(&m, &f)), text);
        told += is_told;
        met += is_met;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(told * 4 > cases && met * 10 > cases);
}

/* With the warning's remedy, a shorter step or an earlier end, the run must not have this warning. */
TEST(missed, remedies_end_the_warning) {
    dice d = dice_of("missed", 7);
    const unsigned cases = dice_cases(few_or_all(usual_or(26, 13), 130));
    unsigned ways[2] = {0, 0};
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char more[TEXT];
        char from[400];
        char cure[SAID_SIZE];
        char *words[JUMPS_WORDS] = {NULL};
        flight f = flight_draw(&d);
        f.bounce_s = 0.0;
        snprintf(from, sizeof from, "V = 100 [N/m]*$y^2/2\n%s", flats[k % FLATS]);
        place_write(&f, dice_one_of(&d, 2) == 0 ? thickness_m(&d) : 1e-4 * thickness_m(&d), from,
                    more);
        const bool is_told = fly(&m, &f, more, 3e-3);
        motion_close(&m);
        const char *number = dice_one_of(&d, 2) == 0 ? "double" : "float";
        if (is_told) {
            jumps_run(text, number, words);
        }
        if (is_told && strstr(jumps_said.err, "[missed]") != NULL) { /* else cosh() overflowed */
            TEST_ASSERT_TRUE_MESSAGE(jumps_named(cure, words), text);
            ways[strncmp(cure, "--until", 7) == 0]++;
            jumps_run(text, number, words);
            TEST_ASSERT_NULL_MESSAGE(strstr(jumps_said.err, "[missed]"), text);
        }
    }
    TEST_ASSERT_TRUE(ways[0] * 6 > cases && ways[1] > 0);
}

/* The body passes near the tip of a weak conical potential, where the direction of the force jumps, and then comes
 * to a barrier of potential energy. It must turn back there, or there must be a warning. */
TEST(missed, barriers_after_a_tip) {
    dice d = dice_of("missed", 5);
    const unsigned cases = dice_cases(20);
    unsigned met = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char more[TEXT];
        char from[400];
        const flight f = flight_draw(&d);
        const double hill_J = 0.5 * f.v_m_s * f.v_m_s * dice_between(&d, 1.2, 5.0);
        snprintf(from, sizeof from,
                 "V = %.17g [J]*exp(-($x/($w))^2) + 1e-9 [J]*exp(-sqrt(($x + %.17g [m])^2 + "
                 "$y^2)/(1 [m]))",
                 hill_J, dice_between(&d, 0.2, 0.8));
        place_write(&f, thickness_m(&d), from, more);
        const bool is_told = fly(&m, &f, more, 0.0);
        const bool is_met = motion_value(&m, "x") < f.place_m[0];
        TEST_ASSERT_TRUE_MESSAGE(is_told || is_met, text);
        met += is_met;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(met < cases);
}

/* Bumps of height 1 and a width of about $w at $x = 0. */
static const char *const bumps[] = {
    "exp(-($x/($w))^2)",
    "max(0, 1 - ($x/($w))^2)",
    "cosh(min(abs($x)/($w), 300))^(-2)",
    "1/(1 + ($x/($w))^6)",
};

enum { BUMPS = sizeof bumps / sizeof bumps[0] };

/* Statements that act only in a narrow interval of x; %s is the bump. In sequence: a normal force that rises while y slides; one
 * that vanishes while y sticks and a spring pulls; coefficients that rise; a crossing that stops y; a force (no rational one). */
static const char *const narrow[] = {
    "friction y static 0.3 kinetic 0.2 normal 1 [mN] + 1e7 [N]*%s",
    "V = 1 [N/m]*$y^2/2\nfriction y static 0.9 kinetic 0.8 normal 10 [mN]*(1 - %s)",
    "friction y static 9e5*%s + 0.3 kinetic 8e5*%s + 0.2 normal 10 [N]",
    "when %s crosses 0.5 rising { set y' = 0 [m/s] }",
    "Q(y) = -1e5 [N]*%s",
};

enum { NARROW = sizeof narrow / sizeof narrow[0] };

/* Friction limits and crossings that exist only within a step. y must follow the closed form, or there must be a
 * warning. */
TEST(missed, narrow_limits_and_crossings) {
    dice d = dice_of("missed", 6);
    const unsigned cases = dice_cases(few_or_all(48, 240));
    unsigned told = 0;
    unsigned met = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char more[TEXT];
        char from[400];
        flight f = flight_draw(&d);
        f.bounce_s = 0.0;
        const char *bump = bumps[dice_one_of(&d, k % NARROW == 4 ? BUMPS - 1 : BUMPS)];
        const double w_m = f.v_m_s * f.step_s * exp(dice_between(&d, log(1e-3), log(3.0)));
        snprintf(from, sizeof from, narrow[k % NARROW], bump, bump);
        place_write(&f, w_m, from, more);
        const double y_m = k % NARROW == 1 ? 8e-3 : 0.0;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n%s\n"
                 "scene s {\nstart x = %.17g [m], x' = %.17g [m/s], y = %.17g [m]%s\n"
                 "step %.17g [s]\nuntil %.17g [s]\n}\n",
                 more, f.place_m[0] + f.start_m, f.v_m_s, f.place_m[1] + y_m,
                 k % NARROW == 1 ? "" : ", y' = 1e-3 [m/s]", f.step_s, f.until_s);
        motion_open_text(&m, text, IN_DOUBLE);
        const bool is_told = jumps_some(&m);
        const bool is_met = k % NARROW == 1   ? motion_value(&m, "y") - f.place_m[1] < y_m
                            : k % NARROW == 4 ? motion_value(&m, "y'") < -1e-3
                                              : fabs(motion_value(&m, "y'")) < 1e-9;
        TEST_ASSERT_TRUE_MESSAGE(is_told || is_met, text);
        told += is_told;
        met += is_met;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(told * 4 > cases && met * 10 > cases);
}

/* Two points on straight lines at constant speed; or the second point is on a turning disk. Their least distance is
 * found by dense sampling. */
typedef struct pass {
    double aside_m;    /* distance of the first body's path from the x axis */
    double u_m, w_m_s; /* the second body's start on the x axis, and its rate */
    /* radius of the second point on its disk; 0: the point moves along the x axis */
    double disk_m;
    double turn_rad, turn_rad_s;
} pass;

static double pass_least_m(const flight *f, const pass *p) {
    double least_m = 1e9;
    for (int i = 0; i <= 200000; i++) {
        const double t = f->until_s * i / 200000.0;
        const double x = f->start_m + f->v_m_s * t;
        const double angle = p->turn_rad + p->turn_rad_s * t;
        const double u = p->disk_m > 0.0 ? p->disk_m * cos(angle) : p->u_m + p->w_m_s * t;
        const double v = p->disk_m > 0.0 ? p->disk_m * sin(angle) : 0.0;
        least_m = fmin(least_m, hypot(x - u, p->aside_m - v));
    }
    return least_m;
}

/* Posts on a moving body or on a turning disk, pairs of posts, and latches between two circles. If the reference
 * hits a post, the run must hit it or have a warning. */
TEST(missed, moving_ones) {
    dice d = dice_of("missed", 4);
    const unsigned cases = dice_cases(few_or_all(usual_or(40, 15), 120));
    unsigned hits = 0;
    unsigned thin = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char head[TEXT];
        const flight f = flight_draw(&d);
        const double r_m = 0.5 * thickness_m(&d);
        const double meets_s = -f.start_m / f.v_m_s;
        pass p = {.aside_m = r_m * dice_between(&d, -1.3, 1.3)};
        const char *body = "";
        const char *energy = "";
        char stops[400];
        if (k % 4 == 0) {
            p.w_m_s = dice_between(&d, -16.0, 0.5 * f.v_m_s);
            p.u_m = -p.w_m_s * meets_s;
            body = "coordinate u [m]\n";
            energy = " + 2 [kg]*u'^2/2";
            snprintf(stops, sizeof stops, "stop sqrt((x - u)^2 + y^2) >= %.17g [m] restitution 0.5",
                     r_m);
        } else if (k % 4 == 1) {
            p.disk_m = dice_between(&d, 0.05, 0.5);
            p.turn_rad_s = dice_between(&d, -40.0, 40.0);
            p.turn_rad = dice_between(&d, -3.0, 3.0);
            p.aside_m += p.disk_m * sin(p.turn_rad + p.turn_rad_s * meets_s);
            body = "coordinate u [rad]\n";
            energy = " + 2 [kg*m^2]*u'^2/2";
            snprintf(stops, sizeof stops,
                     "stop sqrt((x - %.17g [m]*cos(u))^2 + (y - %.17g [m]*sin(u))^2) >= %.17g [m] "
                     "restitution 0.5",
                     p.disk_m, p.disk_m, r_m);
        } else if (k % 4 == 2) { /* two posts, of which the second is far away */
            snprintf(stops, sizeof stops,
                     "stop sqrt((x - 0.1 [m])^2 + (y - 1 [m])^2) >= %.17g [m] restitution 0.5\n"
                     "stop sqrt(x^2 + y^2) >= %.17g [m] restitution 0.5",
                     r_m, r_m);
        } else {
            snprintf(stops, sizeof stops,
                     "hold x - y while sqrt(x^2 + y^2) > %.17g [m] and sqrt(x^2 + y^2) < %.17g [m]",
                     0.1, 0.1 + r_m);
        }
        snprintf(
            head, sizeof head,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n%sT = 1 [kg]*(x'^2 + y'^2)/2%s\n%s\n"
            "scene s {\nstart x = %.17g [m], x' = %.17g [m/s], y = %.17g [m]",
            body, energy, stops, f.start_m, f.v_m_s, p.aside_m);
        const size_t used = strlen(head);
        const bool turns = p.disk_m > 0.0;
        if (k % 4 < 2) {
            snprintf(head + used, sizeof head - used, ", u = %.17g [%s], u' = %.17g [%s/s]",
                     turns ? p.turn_rad : p.u_m, turns ? "rad" : "m",
                     turns ? p.turn_rad_s : p.w_m_s, turns ? "rad" : "m");
        }
        snprintf(text, sizeof text, "%s\nstep %.17g [s]\nuntil %.17g [s]\n}\n", head, f.step_s,
                 f.until_s);
        motion_open_text(&m, text, IN_DOUBLE);
        const bool is_told = jumps_some(&m);
        const bool must = k % 4 == 3 || pass_least_m(&f, &p) < 0.98 * r_m;
        TEST_ASSERT_TRUE_MESSAGE(!must || is_told || contacts_events(&m) > 0, text);
        hits += must;
        thin += must && r_m < f.v_m_s * f.step_s;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(hits * 2 > cases && thin * 3 > cases);
}

/* $w is wide compared with the path of a step; %s are random numbers. */
static const char *const rights[] = {
    "stop sqrt($x^2 + $y^2) >= 0.5*$w restitution %s",
    ("V = 9.81 [N]*$y + %s*100 [N/m]*$x^2/2\nstop $y >= -0.3 [m] restitution 0.6\n"
     "stop abs($x) <= 1.2 [m] restitution 0.5"),
    "V = %s*100 [N/m]*$y^2/2\nhold x while $x > 0 and $x < $w",
    "V = %s*8 [J]*exp(-($x/($w))^2) + 100 [N/m]*$y^2/2",
    ("V = 9.81 [N]*$y + %s*100 [N/m]*$x^2/2\n"
     "stop $y + 0.4 [m] >= 0.1*$w*sin($x/($w)) restitution 0.5"),
    "V = %s*100 [N/m]*($x^2 + $y^2)/2\nfriction x static 1 kinetic 0.8 normal 2 [N]",
    "V = %s*100 [N/m]*($x^2 + $y^2)/2\nstop sqrt($x^2 + $y^2) <= 1.5 [m] restitution 0.7",
    "V = %s*100 [N/m]*$y^2/2\nhold x while $x^2 + $y^2 < ($w)^2",
    "V = %s*100 [N/m]*$y^2/2\nhold x while exp(-($x/($w))^2) > 0.5",
    "V = %s*100 [N/m]*$y^2/2\nhold x while atan2($w, abs($x)) > 0.7853",
    "V = %s*100 [N/m]*$y^2/2\nhold x while acos($x/(8 [m])) < 1.5",
    "V = %s*100 [N/m]*$y^2/2\nstop $y + 0.5 [m] >= 0.2 [m]*exp(-($x/($w))^2) restitution 0.5",
};

enum { RIGHT_KINDS = sizeof rights / sizeof rights[0] };

static void right_draw(dice *d, unsigned kind, flight *f, double *aside_m, char *more) {
    char from[400];
    char number[30];
    *f = (flight){.v_m_s = dice_between(d, 0.5, 4.0), .step_s = 1e-3, .until_s = 1.0};
    f->start_m = -dice_between(d, 0.5, 1.0);
    flight_place(d, f);
    const double w_m = f->v_m_s * f->step_s * exp(dice_between(d, log(8.0), log(100.0)));
    *aside_m = w_m * dice_between(d, -2.0, 2.0);
    snprintf(number, sizeof number, "%.17g", dice_between(d, 0.05, 1.0));
    const char *at = strstr(rights[kind], "%s");
    snprintf(from, sizeof from, "%.*s%s%s", (int)(at - rights[kind]), rights[kind], number, at + 2);
    place_write(f, w_m, from, more);
}

/* Does the run agree with a run that has an eighth of the step? */
static bool is_right(const motion *m, const char *of, stepping how) {
    motion fine;
    how.step_s = m->image->step_s / 8.0;
    motion_open_text(&fine, of, how);
    fine.image->steps = 8 * m->image->steps;
    const bool done = motion_step(&fine, fine.image->steps) == WH_OK;
    double off = 0.0;
    for (int i = 0; i < m->image->count; i++) {
        const char *name = m->image->unknown[i].name;
        const double value = motion_value(&fine, name);
        off = fmax(off, fabs(motion_value(m, name) - value) / fmax(fabs(value), 1.0));
    }
    motion_close(&fine);
    return done && off < 1e-3;
}

/* Random linkages with stops and frictions, and wide contacts. A right run must have no warning. */
TEST(missed, right_runs) {
    dice d = dice_of("missed", 3);
    const unsigned cases = dice_cases(few_or_all(usual_or(30, 15), 120));
    uint64_t seed = d.state;
    unsigned told = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char linked[LINKAGE_TEXT];
        stepping how = IN_DOUBLE;
        const char *of = text;
        bool some;
        if (k % 2 == 0) {
            char statements[HYBRID_TEXT];
            const hybrid h = hybrid_draw(&seed);
            hybrid_statements(&h, statements);
            linkage_write(&h.of, "hybrid", (linkage_writing){LINKAGE_INSIDE, .more = statements},
                          linked);
            how.step_s = 0.25e-3;
            of = linked;
            motion_open_text(&m, linked, how);
            m.image->steps = 1000;
            some = jumps_some(&m);
        } else {
            flight f;
            double aside_m;
            char more[TEXT];
            right_draw(&d, k / 2 % RIGHT_KINDS, &f, &aside_m, more);
            some = fly(&m, &f, more, aside_m);
        }
        told += some;
        TEST_ASSERT_FALSE_MESSAGE(some && is_right(&m, of, how), of);
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(told * 20 <= cases);
}

/* Faces that end at $x = 0, except the last two faces, which go on. */
static const char *const faces[] = {
    "stop max($x, $y) >= 0 restitution %.3f",
    "stop max(abs($x + 0.6 [m]) - 0.6 [m], $y) >= 0 restitution %.3f",
    "stop $y >= -0.7*abs($x + abs($x)) restitution %.3f",
    "stop $y + 0.01*($x + abs($x)) >= 0 restitution %.3f",
    "stop max(abs($x) - 9 [m], $y) >= 0 restitution %.3f",
    ("stop $y >= 0.02 [m]*(cos($x/(1 [m])) - 0.5) restitution %.3f\n"
     "stop abs($x) <= 9 [m] restitution 0"),
};

enum { FACES = sizeof faces / sizeof faces[0], FACES_ENDING = FACES - 2 };

/* A body slides on a face; in half of the runs it leaves the face over its edge. The run must be right or have a
 * warning. On the face, there must be no warning. */
TEST(missed, edges) {
    dice d = dice_of("missed", 7);
    const unsigned cases = dice_cases(60);
    unsigned told = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char from[400];
        char more[TEXT];
        const unsigned face = k % FACES;
        const bool goes_over = face < FACES_ENDING && dice_one_of(&d, 2) == 0;
        flight f = flight_draw(&d);
        snprintf(from, sizeof from, "V = 9.81 [N]*$y\n");
        snprintf(from + strlen(from), sizeof from - strlen(from), faces[face],
                 0.5 * (double)dice_one_of(&d, 3));
        f.until_s = goes_over || face >= FACES_ENDING ? f.until_s
                                                      : f.step_s * floor(0.9 / f.v_m_s / f.step_s);
        place_write(&f, 0.0, from, more);
        const bool is_told = fly(&m, &f, more, 0.0);
        const double falls_s = f.until_s + f.start_m / f.v_m_s;
        const double y_m = f.place_m[1] - (goes_over ? 0.5 * 9.81 * falls_s * falls_s : 0.0);
        const bool is_right = fabs(motion_value(&m, "y") - y_m) < 1e-6;
        TEST_ASSERT_TRUE_MESSAGE(goes_over ? is_told || is_right : !is_told, text);
        told += is_told;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(told * 5 > cases);
}
