/* test_input_rates.c: inputs with a rate. Stops and holds that follow such an input are compared with closed forms,
 * or with the same motion by another method. The inputs are set before each step, as firmware does, or change by
 * themselves. */
#include "command.h"
#include "derived.h"
#include "motion.h"

#define G 9.81

static const engine_kind *const KINDS[] = {&engine_double, &engine_float};

/* place + size sin(rate t + phase) + drift t */
typedef struct course {
    double place, size, rate, phase, drift;
} course;

static double course_at(const course *c, double t, int primes) {
    const double angle = c->rate * t + c->phase;
    switch (primes) {
    case 0: return c->place + c->size * sin(angle) + c->drift * t;
    case 1: return c->size * c->rate * cos(angle) + c->drift;
    default: return -c->size * c->rate * c->rate * sin(angle);
    }
}

/* Inputs of the scene besides the value: its rate; the mean rate of the next step; or rate and acceleration. */
enum { RATE, MEAN_RATE, ACCELERATION, TELLINGS };

/* Sets the value, and the inputs that `telling` selects, to those of the course at time t, for a step of h seconds. */
static void set_course(motion *m, const course *c, int telling, double h, double t) {
    const double ahead = (course_at(c, t + h, 0) - course_at(c, t, 0)) / h;
    m->kind->set_input(m->run, 0, course_at(c, t, 0));
    m->kind->set_input(m->run, 1, telling == MEAN_RATE ? ahead : course_at(c, t, 1));
    if (telling == ACCELERATION) {
        m->kind->set_input(m->run, 2, course_at(c, t, 2));
    }
}

/* Reference: a ball between two walls that move at constant speeds. A ball that hits a wall of speed V at the speed
 * v leaves at V - e (v - V). */
static void exact_ball(const double *wall, const double *speed, double e, double until_s, double *x,
                       double *v) {
    double t = 0.0;
    for (;;) {
        const int to = *v > speed[1] ? 1 : 0; /* the wall that the ball meets next, if any */
        const double closing = to == 1 ? *v - speed[1] : speed[0] - *v;
        const double way = to == 1 ? wall[1] + speed[1] * t - *x : *x - wall[0] - speed[0] * t;
        if (!(closing > 0.0) || t + way / closing >= until_s) {
            *x += *v * (until_s - t);
            return;
        }
        t += way / closing;
        *x += *v * (way / closing);
        *v = speed[to] - e * (*v - speed[to]);
    }
}

TEST(input_rates, a_ball_between_moving_walls) {
    const unsigned cases = dice_cases(24);
    dice d = dice_of("input_rates", 4602);
    double worst[2] = {0.0, 0.0};
    for (unsigned i = 0; i < cases; i++) {
        char text[700];
        const double wall[2] = {dice_between(&d, -1.5, -0.5), dice_between(&d, 0.5, 1.5)};
        const double speed[2] = {dice_between(&d, -0.3, 0.15), dice_between(&d, -0.15, 0.3)};
        const double e = dice_between(&d, 0.5, 1.0);
        const double v0 = dice_between(&d, -4.0, 4.0);
        const bool sets = i % 3 != 0;
        const int number = (int)(i / 3 % 2);
        double x = dice_between(&d, -0.4, 0.4);
        double v = v0;
        snprintf(
            text, sizeof text,
            "mechanism walls\ncoordinate x [m]\ninput A rate Av = %.17g [m]\n"
            "input Av = %.17g [m/s]\ninput Bv = %.17g [m/s]\ninput B = %.17g [m] rate Bv\n"
            "T = %.17g [kg]*x'^2/2\nstop x >= A restitution %.17g\nstop B >= x restitution %.17g\n"
            "scene s {\n  with ledger\n  start x = %.17g [m], x' = %.17g [m/s]\n"
            "  step 1 [ms]\n  until 1.5 [s]\n}\n",
            wall[0], speed[0], speed[1], wall[1], dice_between(&d, 0.1, 5.0), e, e, x, v);
        motion m;
        double total[32];
        double left[8] = {0.0};
        motion_open_text(&m, text,
                         (stepping){.kind = KINDS[number], .method = WH_RK4, .ledger = true});
        for (unsigned k = 0; k < 1500; k++) {
            if (sets) {
                m.kind->set_input(m.run, 0, wall[0] + speed[0] * 1e-3 * k);
                m.kind->set_input(m.run, 3, wall[1] + speed[1] * 1e-3 * k);
            }
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        }
        exact_ball(wall, speed, e, 1.5, &x, &v);
        const double off = fabs(motion_value(&m, "x") - x) + fabs(motion_value(&m, "x'") - v);
        worst[number] = fmax(worst[number], off);
        m.kind->ledger(m.run, total, left);
        TEST_ASSERT_TRUE(fabs(left[0]) < (number ? 1e-3 : 1e-9));
        motion_close(&m);
    }
    printf("  balls between moving walls are off by %.1e, float %.1e\n", worst[0], worst[1]);
    TEST_ASSERT_TRUE(worst[0] <= 1e-11 && worst[1] <= 3e-4);
}

/* A ball on a shaking table must stay while the table's downward acceleration is below g, and then fly. */
TEST(input_rates, a_ball_on_a_shaking_table) {
    const unsigned cases = dice_cases(16);
    dice d = dice_of("input_rates", 4602);
    double worst[TELLINGS] = {0.0, 0.0, 0.0};
    for (unsigned i = 0; i < cases; i++) {
        char text[500];
        const int telling = (int)(i % TELLINGS);
        const bool leaves = i / TELLINGS % 2 == 1;
        course c = {0.0, 0.0, dice_between(&d, 6.0, 20.0), 0.0, 0.0};
        c.size = (leaves ? dice_between(&d, 1.2, 2.0) : dice_between(&d, 0.2, 0.9)) * G /
                 (c.rate * c.rate);
        snprintf(text, sizeof text,
                 "mechanism table\ncoordinate z [m]\ninput H rate Hv = 0 [m]\n"
                 "input Hv = %.17g [m/s]%s\ninput Ha = 0 [m/s^2]\nT = 2 [kg]*z'^2/2\n"
                 "V = 2 [kg]*9.81 [m/s^2]*z\nstop z >= H restitution 0\n"
                 "scene s {\n  start z' = %.17g [m/s]\n  step 0.5 [ms]\n  until 1 [s]\n}\n",
                 c.size * c.rate, telling == ACCELERATION ? " rate Ha" : "", c.size * c.rate);
        motion m;
        motion_open_text(&m, text, IN_DOUBLE);
        const double lost = asin(fmin(1.0, G / (c.size * c.rate * c.rate))) / c.rate;
        /* ends while the ball flies; or, if the ball stays, at a phase of 4.5 rad */
        const double until = leaves ? lost + 0.25 / c.rate : 4.5 / c.rate;
        const unsigned steps = (unsigned)(until / 0.5e-3);
        for (unsigned k = 0; k < steps; k++) {
            set_course(&m, &c, telling, 0.5e-3, 0.5e-3 * k);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        }
        const double t = 0.5e-3 * steps;
        const double flown = t - lost;
        const double z = leaves ? course_at(&c, lost, 0) + course_at(&c, lost, 1) * flown -
                                      G * flown * flown / 2.0
                                : course_at(&c, t, 0);
        int mode[1];
        m.kind->modes(m.run, mode);
        TEST_ASSERT_EQUAL_INT(leaves ? WH_FREE : WH_ACTIVE, mode[0]);
        worst[telling] = fmax(worst[telling], fabs(motion_value(&m, "z") - z) / c.size);
        motion_close(&m);
    }
    printf("  balls on shaking tables are off, in swings, by %.1e; with mean rates %.1e, with "
           "accelerations %.1e\n",
           worst[RATE], worst[MEAN_RATE], worst[ACCELERATION]);
    TEST_ASSERT_TRUE(worst[RATE] <= 1e-2 && worst[MEAN_RATE] <= 1e-2 &&
                     worst[ACCELERATION] <= 1e-4);
}

/* A pendulum on a rope of length L(t): a'' = -(2 L' a' + g sin a)/L, by RK4 with the exact L(t). */
static void exact_pendulum(const course *c, double until_s, double *a, double *rate) {
    enum { PARTS = 20000 };
    const double h = until_s / PARTS;
    for (int k = 0; k < PARTS; k++) {
        double at[4][2];
        double slope[4][2];
        static const double share[] = {0.0, 0.5, 0.5, 1.0};
        for (int s = 0; s < 4; s++) {
            const double t = (k + share[s]) * h;
            at[s][0] = *a + (s > 0 ? share[s] * h * slope[s - 1][0] : 0.0);
            at[s][1] = *rate + (s > 0 ? share[s] * h * slope[s - 1][1] : 0.0);
            slope[s][0] = at[s][1];
            slope[s][1] =
                -(2.0 * course_at(c, t, 1) * at[s][1] + G * sin(at[s][0])) / course_at(c, t, 0);
        }
        *a += h / 6.0 * (slope[0][0] + 2.0 * (slope[1][0] + slope[2][0]) + slope[3][0]);
        *rate += h / 6.0 * (slope[0][1] + 2.0 * (slope[1][1] + slope[2][1]) + slope[3][1]);
    }
}

enum { BY_HOLD, BY_ANGLE, BY_WAYS };

/* Error after 2 s in steps of h. The pendulum has its rope as a hold, or the angle as its coordinate. *slipped: the
 * largest error of the held rope. */
static double rope_off(const course *c, int way, int telling, const engine_kind *kind, double h,
                       double *slipped) {
    static const char *const text_of[BY_WAYS] = {
        "coordinate x [m]\ncoordinate y [m]\n%sT = 2 [kg]*(x'^2 + y'^2)/2\n"
        "V = 2 [kg]*9.81 [m/s^2]*y\nhold sqrt(x^2 + y^2) - L while 1 > 0\n"
        "output px [m] = x\noutput py [m] = y\noutput gap [m] = sqrt(x^2 + y^2) - L\n",
        "coordinate a [rad]\n%slet x = L*sin(a)\nlet y = -L*cos(a)\n"
        "T = 2 [kg]*(x'^2 + y'^2)/2\nV = 2 [kg]*9.81 [m/s^2]*y\n"
        "output px [m] = x\noutput py [m] = y\noutput gap [m] = 0*L\n"};
    double a = 1.2;
    double rate = 0.5;
    char declared[300];
    char body[900];
    char text[1400];
    const double length = course_at(c, 0.0, 0);
    const double longer = course_at(c, 0.0, 1);
    snprintf(declared, sizeof declared,
             "input L rate Lv = %.17g [m]\ninput Lv = %.17g [m/s]%s\ninput La = %.17g [m/s^2]\n",
             length, longer, telling == ACCELERATION ? " rate La" : "", course_at(c, 0.0, 2));
    snprintf(body, sizeof body, text_of[way], declared);
    char start[300];
    snprintf(start, sizeof start,
             way == BY_HOLD ? "x = %.17g [m], y = %.17g [m], x' = %.17g [m/s], y' = %.17g [m/s]"
                            : "a = %.17g [rad], a' = %.17g [rad/s]",
             way == BY_HOLD ? length * sin(a) : a, way == BY_HOLD ? -length * cos(a) : rate,
             longer * sin(a) + length * cos(a) * rate, -longer * cos(a) + length * sin(a) * rate);
    snprintf(
        text, sizeof text,
        "mechanism rope\n%sscene s {\n  with ledger\n  start %s\n  step %.17g [s]\n  until 2 [s]\n}\n",
        body, start, h);
    motion m;
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4, .ledger = true});
    const unsigned steps = (unsigned)(2.0 / h + 0.5);
    for (unsigned k = 0; k < steps; k++) {
        set_course(&m, c, telling, h, h * k);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        *slipped = fmax(*slipped, fabs(motion_value(&m, "gap")));
    }
    exact_pendulum(c, 2.0, &a, &rate);
    const double end = course_at(c, 2.0, 0);
    const double off =
        hypot(motion_value(&m, "px") - end * sin(a), motion_value(&m, "py") + end * cos(a));
    double total[40];
    double left[8] = {0.0};
    m.kind->ledger(m.run, total, left);
    /* in float, correcting a position in each step changes the energy, and the ledger has no entry for this */
    TEST_ASSERT_TRUE(fabs(left[0]) < (kind == &engine_float ? 0.2 : 1e-6));
    motion_close(&m);
    return off;
}

static course draw_rope(dice *d) {
    return (course){dice_between(d, 0.8, 2.0), dice_between(d, 0.05, 0.3),
                    dice_between(d, 1.0, 6.0), dice_between(d, 0.0, 6.28),
                    dice_between(d, -0.1, 0.2)};
}

/* With the mean rate of the step, or with an acceleration, the rope follows to second order in the step; with the
 * rate at the step's start, to first order. So do energies that contain L. The hold itself is exact. */
TEST(input_rates, a_pendulum_on_a_rope_of_changing_length) {
    const unsigned cases = dice_cases(6);
    dice d = dice_of("input_rates", 4602);
    static const char *const by[BY_WAYS] = {"a hold", "the angle"};
    double worst[BY_WAYS][TELLINGS] = {{0.0}};
    double slipped[2] = {0.0, 0.0};
    for (unsigned i = 0; i < cases; i++) {
        const course c = draw_rope(&d);
        for (int way = 0; way < BY_WAYS; way++) {
            for (int telling = 0; telling < TELLINGS; telling++) {
                const double coarse = rope_off(&c, way, telling, KINDS[0], 2e-3, &slipped[0]);
                const double fine = rope_off(&c, way, telling, KINDS[0], 1e-3, &slipped[0]);
                worst[way][telling] = fmax(worst[way][telling], fine);
                TEST_ASSERT_TRUE_MESSAGE(
                    fine < (telling != RATE ? 0.4 : 0.7) * coarse || fine < 1e-7, "of its order");
            }
            (void)rope_off(&c, way, ACCELERATION, KINDS[1], 1e-3, &slipped[1]);
        }
    }
    for (int way = 0; way < BY_WAYS; way++) {
        printf(
            "  ends of ropes by %s are off by %.1e m; with mean rates %.1e m, with accelerations "
            "%.1e m\n",
            by[way], worst[way][RATE], worst[way][MEAN_RATE], worst[way][ACCELERATION]);
        TEST_ASSERT_TRUE(worst[way][RATE] <= 5e-2 && worst[way][MEAN_RATE] <= 1e-4 &&
                         worst[way][ACCELERATION] <= 2e-4);
    }
    printf("  held ropes are off by %.1e m, float %.1e m\n", slipped[0], slipped[1]);
    TEST_ASSERT_TRUE(slipped[0] <= 1e-13 && slipped[1] <= 2e-6);
}

/* Writes a scene with or without energy balance. x is free, at a wall that the input moves, or constrained by one or
 * several holds. */
static void refused_text(dice *d, unsigned i, char text[static 900]) {
    static const char *const contact[] = {
        "",
        "stop x >= L restitution 0.5\n",
        "hold x - L while 1 > 0\n",
        "hold x while 1 > 0\n",
        "friction x static 9 kinetic 9 normal 9 [N]\nhold x while 1 > 0\n",
        "hold x while 1 > 0\nhold x while 1 > 0\n",
        "hold x - y while 1 > 0\nhold x while 1 > 0\n"};
    snprintf(text, 900,
             "mechanism wall\ncoordinate a [rad]\ncoordinate y [m]\ncoordinate x [m]\n"
             "input Lv = %.17g [m/s]\ninput L rate Lv = %.17g [m]\ninput M = 0.1 [N*m]\n"
             "input K rate Kv = 0.2 [m]\ninput Kv rate Ka = 0 [m/s]\ninput Ka = 0.1 [m/s^2]\n"
             "input P = 0.1 [N]\nT = 1 [kg]*(x'^2 + y'^2)/2 + 0.1 [kg*m^2]*a'^2/2\n"
             "V = 50 [N/m]*((x - L)^2 + (y - K)^2)/2 - 1 [J]*cos(a)\nQ(a) = M\nQ(x) = P\n%s"
             "scene s {%s\n start x = %.17g [m]\n step 1 [ms]\n until 1 [s]\n}\n",
             dice_between(d, -0.2, 0.2), dice_between(d, -0.5, -0.3), contact[i / 2 % 7],
             i % 2 ? " with ledger" : "", dice_between(d, -0.3, 0.3));
}

/* After a refused step, the run must go on as if the step had not been requested, whatever inputs caused the
 * refusal. */
TEST(input_rates, refused_step_changes_nothing) {
    /* input 6, a force, never becomes 1e20 or 1e30, which holds may bear */
    static const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1e20, 1e30};
    dice d = dice_of("input_rates", 4603);
    for (unsigned i = 0; i < dice_cases(56); i++) {
        char text[900];
        motion m[2];
        double left[2][8] = {{0.0}};
        refused_text(&d, i, text);
        for (int k = 0; k < 2; k++) {
            motion_open_text(
                &m[k], text,
                (stepping){.kind = KINDS[i / 14 % 2], .method = WH_RK4, .ledger = i % 2 == 1});
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m[k], i % 5 * 30));
        }
        for (int input = 0; input < m[0].image->inputs; input++) {
            const double next = dice_between(&d, -0.4, -0.2);
            m[0].kind->set_input(m[0].run, input,
                                 bad[(i + (unsigned)input) % (input == 6 ? 3 : 5)]);
            TEST_ASSERT_TRUE_MESSAGE(motion_step(&m[0], 1) != WH_OK, text);
            TEST_ASSERT_EQUAL_UINT64(m[1].kind->hash(m[1].run), m[0].kind->hash(m[0].run));
            m[0].kind->set_input(m[0].run, input, next);
            m[1].kind->set_input(m[1].run, input, next);
        }
        for (int k = 0; k < 2; k++) {
            double total[60];
            TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, motion_step(&m[k], 50), text);
            if (i % 2 == 1) {
                m[k].kind->ledger(m[k].run, total, left[k]);
            }
        }
        TEST_ASSERT_EQUAL_UINT64(m[1].kind->hash(m[1].run), m[0].kind->hash(m[0].run));
        TEST_ASSERT_TRUE_MESSAGE(left[0][0] == left[1][0] && fabs(left[0][0]) < 1e-2, text);
        /* wh_scene_set_real() must refuse coordinates that follow an input, and accept all others */
        const image *im = m[0].image;
        wh_real real[2 * IMAGE_COMPONENTS_MAX] = {0};
        wh_contacts contacts;
        wh_state state = {.real = real, .contacts = &contacts};
        const wh_scene stepped = {.angles = (uint8_t)im->angles,
                                  .reals = (uint8_t)im->reals,
                                  .driven = (uint8_t)im->drives};
        for (int k = 0; k < im->reals; k++) {
            bool driven = false;
            for (int n = 0; n < im->drives; n++) {
                driven = driven || k == im->drive[n].value_at || k == im->drive[n].rate_at;
            }
            TEST_ASSERT_EQUAL_INT(driven ? WH_E_ARGUMENT : WH_OK,
                                  wh_scene_set_real(&stepped, &state, (unsigned)k, WH_R(0.5)));
            TEST_ASSERT_TRUE(real[k] == (driven ? WH_R(0.0) : WH_R(0.5)));
        }
        motion_close(&m[0]);
        motion_close(&m[1]);
    }
}

TEST(input_rates, allowed_rates) {
    static const struct {
        const char *lines;
        const char *said;
    } cases[] = {
        {"input L = 2 [m]\nhold x - L while 1 > 0", "which has no declared rate"},
        {"input L = 2 [cm]  # long\nhold x - L while 1 > 0",
         "hint: input L rate L_rate = 2 [cm]  ; input L_rate = 0 [m/s]"},
        {"input L = 2 [m]\nlet r = 2*L\nhold x - r while 1 > 0", "the input 'L', which has no"},
        {"input L = 2 [m]\nstop x <= L restitution 0", ""},
        {"input L = 2 [m]\nhold x while L > 0", ""},
        {"input L rate Lv = 2 [m]", "no input is called 'Lv', the rate of 'L'"},
        {"input L rate Lv = 2 [m]", "hint: input Lv = 0 [m/s]"},
        {"input L rate x = 2 [m]", "the rate of an input is another input"},
        {"input L rate Lv = 2 [m]\ninput Lv = 1 [m]", "must be in [m/s]"},
        {"input L rate Lv = 2 [m]\ninput Lv = 1 [m/s]\nstop x >= Lv*1 [s] restitution 0",
         "not on rates: 'Lv' is a rate"},
        {"input L rate Lv = 2 [m]\nlet v = Lv\ninput Lv = 1 [m/s]", "move the declaration in line"},
        {"input L rate v = 2 [m]\ninput v rate a = 0 [m/s]\ninput a rate j = 0 [m/s^2]\n"
         "input j = 0 [m/s^3]",
         "'a' is the acceleration of 'L', and an acceleration cannot have a rate"},
        {"effect e { input L rate v = 2 [m] }", "an input of an effect cannot have a rate"},
        {"input L rate Lv = 2 [m]\ninput Lv = 1 [m/s]\nlet r = L*x\nQ(x) = r'*1 [kg/m/s]", ""},
        {"input v = 1 [m/s]\ninput L = 2 [m] rate v\ninput K = 3 [m] rate v\nhold x - L + K while 1 > 0",
         ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[600];
        snprintf(text, sizeof text, "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n%s\n",
                 cases[i].lines);
        const char *report = report_of_text(text);
        TEST_ASSERT_TRUE_MESSAGE(cases[i].said[0] == '\0' ? report[0] == '\0'
                                                          : strstr(report, cases[i].said) != NULL,
                                 report[0] == '\0' ? cases[i].lines : report);
    }
}
