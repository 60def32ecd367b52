/* test_contact.c: contacts with more events than a step can resolve, while the step is also too coarse for a spring or
 * a damper. The remedy in a warning must remove all reported problems. */
#include "host/cli/commands.h"

#include "command.h"
#include "contacts.h"
#include "derived.h"
#include "drawn.h"
#include "rattle.h"

/* --- drawn curved contacts ---------------------------------------------------------------------------*/

/* Random mechanisms with curved stops and holds and dry friction, as text: cams, cranks and beads with
 * coupled inertia. Their friction passes dead centres. */

typedef struct writing {
    char *text;
    size_t size;
    size_t length;
} writing;

__attribute__((format(printf, 2, 3))) static void put(writing *w, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int more = vsnprintf(w->text + w->length, w->size - w->length, format, arguments);
    va_end(arguments);
    w->length += more > 0 ? (size_t)more : 0U;
    if (w->length >= w->size) {
        w->length = w->size - 1;
    }
}

/* A function of a, b and c, zero on a surface: `f(a) - other coordinate`, a circle or a square. With its value at the
 * start. */
typedef struct surface {
    char text[160];
    double value;
} surface;

static surface random_surface(uint64_t *seed, int coordinates, const double q[3]) {
    surface s = {.value = 0.0};
    const double e = random_between(seed, 0.05, 0.3);
    const int k = 1 + (int)(random_bits(seed) % 3U);
    const int family = (int)(random_bits(seed) % (coordinates == 3 ? 6U : 4U));
    switch (family) {
    case 0:
        snprintf(s.text, sizeof s.text, "b - %.17g [m]*cos(%d*a)", e, k);
        s.value = q[1] - e * cos(k * q[0]);
        break;
    case 1:
        snprintf(s.text, sizeof s.text, "b - %.17g [m]*sin(a)^2", e);
        s.value = q[1] - e * sin(q[0]) * sin(q[0]);
        break;
    case 2:
        snprintf(s.text, sizeof s.text, "b + %.17g [m]*sin(%d*a)", e, k);
        s.value = q[1] + e * sin(k * q[0]);
        break;
    case 3: /* connecting rod of length 1 m */
        snprintf(s.text, sizeof s.text,
                 "b - %.17g [m]*cos(a) - sqrt(1 [m^2] - %.17g [m^2]*sin(a)^2)", e, e * e);
        s.value = q[1] - e * cos(q[0]) - sqrt(1.0 - e * e * sin(q[0]) * sin(q[0]));
        break;
    case 4: /* bead over a round hill */
        snprintf(s.text, sizeof s.text, "sqrt(b^2 + (c - 2 [m])^2)");
        s.value = hypot(q[1], q[2] - 2.0);
        break;
    default:
        snprintf(s.text, sizeof s.text, "c - %.17g [1/m]*b^2 + %.17g [m]*sin(a)", 2.0 * e, e);
        s.value = q[2] - 2.0 * e * q[1] * q[1] + e * sin(q[0]);
        break;
    }
    return s;
}

/* Writes a mechanism to `text`; the same seed gives the same text. Returns the scale of its energy balance: the energy
 * at the start without gravity and springs at rest, J. `step_s` and `until_s` go into its scene. */
static double curved_text(uint64_t of, double step_s, double until_s, char *text, size_t size) {
    uint64_t seed = of * 0x9e3779b97f4a7c15U + 1U;
    writing w = {text, size, 0};
    const int n = random_bits(&seed) % 2U != 0 ? 3 : 2;
    const double J = exp(random_between(&seed, log(0.02), log(0.5)));
    const double m = exp(random_between(&seed, log(0.3), log(3.0)));
    const double mc = exp(random_between(&seed, log(0.3), log(3.0)));
    const double kb = random_between(&seed, 20.0, 200.0);
    const double kc = random_between(&seed, 20.0, 200.0);
    const double couple = random_between(&seed, -0.6, 0.6);
    const bool turning = random_bits(&seed) % 2U != 0; /* inertia that depends on the angle */
    double q[3] = {random_between(&seed, -3.0, 3.0), random_between(&seed, -0.3, 0.3),
                   random_between(&seed, -0.3, 0.3)};
    const double v[3] = {random_between(&seed, -20.0, 20.0), random_between(&seed, -2.0, 2.0),
                         random_between(&seed, -2.0, 2.0)};
    const double ab = couple * sqrt(J * m);
    const double bc = couple * sqrt(m * mc);

    put(&w, "mechanism curved\ncoordinate a [rad]\ncoordinate b [m]\n%s",
        n == 3 ? "coordinate c [m]\n" : "");
    put(&w, "T = %.17g [kg*m^2]*a'^2/2 + %.17g [kg]*b'^2/2 + %.17g [kg*m]*a'*b'%s", J, m, ab,
        turning ? "*cos(a)" : "");
    if (n == 3) {
        put(&w, " + %.17g [kg]*c'^2/2 + %.17g [kg]*b'*c'", mc, bc);
    }
    put(&w, "\nV = %.17g [N/m]*b^2/2 + %.17g [N]*b", kb, 9.81 * m);
    if (n == 3) {
        put(&w, " + %.17g [N/m]*c^2/2", kc);
    }
    put(&w, "\n");

    const surface s = random_surface(&seed, n, q);
    const bool holds = random_bits(&seed) % 3U == 0;
    const bool above = random_bits(&seed) % 2U != 0;
    const bool touching = random_bits(&seed) % 2U != 0;
    const double gap = touching ? 0.0 : random_between(&seed, 0.0, 0.1);
    const double restitution = random_bits(&seed) % 2U != 0 ? 0.0 : random_between(&seed, 0.0, 1.0);
    if (holds) {
        put(&w, "hold %s while %s\n", s.text, touching ? "b > -100 [m]" : "a' > 0 or b > 0");
    } else {
        put(&w, "stop %s %s %.17g [m] restitution %.17g\n", s.text,
            above ? ">=" : "<=", above ? s.value - gap - 1e-15 : s.value + gap + 1e-15,
            restitution);
    }
    const double mu = random_between(&seed, 0.05, 0.6);
    const char *const on[] = {"b", "c", "a"};
    const int which = (int)(random_bits(&seed) % 8U);
    const int rubs = which == 0 ? 2 : which < 4 && n == 3 ? 1 : 0;
    put(&w, "friction %s static %.17g kinetic %.17g normal %.17g [%s]\n", on[rubs], mu,
        mu * (random_bits(&seed) % 2U != 0 ? 1.0 : random_between(&seed, 0.5, 1.0)),
        rubs == 2 ? random_between(&seed, 0.1, 1.0) : random_between(&seed, 1.0, 10.0),
        rubs == 2 ? "N*m" : "N");
    put(&w,
        "scene s {\n  with ledger\n  start a = %.17g, b = %.17g [m], a' = %.17g [rad/s], b' = "
        "%.17g [m/s]\n",
        q[0], q[1], v[0], v[1]);
    if (n == 3) {
        put(&w, "  start c = %.17g [m], c' = %.17g [m/s]\n", q[2], v[2]);
    }
    put(&w, "  step %.17g [s]\n  until %.17g [s]\n}\n", step_s, until_s);
    double energy = 0.5 * (J * v[0] * v[0] + m * v[1] * v[1]) +
                    ab * v[0] * v[1] * (turning ? cos(q[0]) : 1.0) + 0.5 * kb * q[1] * q[1];
    if (n == 3) {
        energy += 0.5 * (mc * v[2] * v[2] + kc * q[2] * q[2]) + bc * v[1] * v[2];
    }
    return energy;
}

/* === busy beside ============================================================================== */

static void say(const char *text, const char *step, said *what) {
    const char *words[] = {model_keep(text),
                           "--quiet",
                           "--number",
                           "double",
                           step != NULL ? "--step" : NULL,
                           step,
                           NULL};
    command_say(command_run, words, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what->err), what->status, text);
}

TEST(busy_beside, a_cure_is_one_of_all) {
    dice d = dice_of("busy beside", 15005);
    const unsigned cases = dice_cases(few_or_all(usual_or(80, 12), 300));
    unsigned energies = 0;
    unsigned both = 0;
    unsigned cured = 0;
    for (unsigned i = 0; i < cases; i++) {
        const bool damped = i % 2 == 1; /* agreed runs may still miss most of the loss */
        const rattle r = rattle_drawn(&d, damped ? HOLD : (rattle_kind)(i / 2 % KINDS));
        const double rate_radps =
            pow(10.0, damped ? dice_between(&d, -0.1, 0.4) : dice_between(&d, -0.8, 0.1)) /
            r.step_s;
        const double speed = r.kind == BALL ? fabs(r.speed_mps) : r.number[r.kind == HOLD ? 0 : 1];
        const double size_m = speed / rate_radps * pow(10.0, dice_between(&d, -0.5, 3.0));
        char text[LINKAGE_TEXT];
        said what;
        rattle_write_beside(&r, damped, rate_radps, size_m, text);
        say(text, NULL, &what);
        const bool energy = strstr(what.err, "energy balance fails") != NULL;
        energies += energy ? 1U : 0U;
        both += energy && strstr(what.err, "[events]") != NULL ? 1U : 0U;
        for (const char *at = what.err; (at = strstr(at, "--step ")) != NULL; at++) {
            char step[40];
            if (sscanf(at, "--step %39s", step) == 1 &&
                strncmp(at + strlen("--step ") + strlen(step), " would do", 9) == 0) {
                said then;
                say(text, step, &then);
                cured++;
                if (then.err[0] != '\0') {
                    printf("%s%s# and with %s: %s\n", text, what.err, step, then.err);
                }
                TEST_ASSERT_EQUAL_STRING("", then.err);
            }
        }
    }
    model_drop();
    printf(
        "  %u rattles beside a spring or a damper: %u told of their energy, %u of both; %u cures, all silent\n",
        cases, energies, both, cured);
    TEST_ASSERT_TRUE(energies > cases / 4 && cured > cases / 4 && (both > 0 || cases < 30));
}

/* A heavy round body hits another one head-on, and no force presses them together. The restitution named in the hint ends the
 * events. */
TEST(busy_beside, head_on) {
    dice d = dice_of("head on", 15006);
    const unsigned cases = dice_cases(few_or_all(usual_or(60, 20), 300));
    unsigned told = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[500];
        said what;
        const double v = dice_between(&d, -20.0, 20.0);
        const double r = dice_between(&d, 0.001, 0.03);
        const double at = v * dice_between(&d, 0.1, 0.4) + (v > 0.0 ? r : -r);
        bool again = true;
        for (int cured = 0; again; cured++) {
            snprintf(text, sizeof text,
                     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate u [m]\n"
                     "T = 1 [kg]*(x'^2 + y'^2)/2 + 1e4 [kg]*u'^2/2\n"
                     "stop sqrt((x - u)^2 + y^2) >= %.9g [m] restitution %s\n"
                     "scene s { start u = %.9g [m], u' = %.9g [m/s]; step 1 [ms]; until 1 [s] }\n",
                     r, cured > 0 ? "0.01" : "0", -at, v);
            say(text, NULL, &what);
            TEST_ASSERT_TRUE_MESSAGE(cured == 0 || what.err[0] == '\0', text);
            TEST_ASSERT_TRUE_MESSAGE(what.err[0] == '\0' || strstr(what.err, "restitution 0.01"),
                                     what.err);
            again = cured == 0 && what.err[0] != '\0';
            told += again;
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(told * 10 > cases);
}

/* A body with far less inertia than the others, used as a clock, hits a stop. Its run ends, and the hint names the stop. */
TEST(busy_beside, light_clocks) {
    dice d = dice_of("light clocks", 15007);
    const unsigned cases = dice_cases(usual_or(20, 8));
    unsigned failed = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[500];
        said what;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate y [m]\ncoordinate c [s]\n"
                 "T = 1 [kg]*y'^2/2 + %.9g [J]*c'^2/2\nV = 9.81 [N]*y\n"
                 "stop y >= %.9g [m]*sin(%.9g [1/s]*c) restitution %.9g\n"
                 "scene s { start y = 0.1 [m], c' = 1; step 1 [ms]; until 1 [s] }\n",
                 pow(10.0, dice_between(&d, -9.0, -5.0)), dice_between(&d, 0.01, 0.03),
                 dice_between(&d, 20.0, 60.0), dice_between(&d, 0.0, 0.8));
        command_say(command_run, (const char *[]){model_keep(text), "--quiet", NULL}, &what);
        const bool fails = strstr(what.err, "left all bounds") != NULL;
        TEST_ASSERT_TRUE_MESSAGE(!fails || strstr(what.err, "give a clock in it far more inertia"),
                                 what.err);
        failed += fails;
    }
    model_drop();
    TEST_ASSERT_TRUE(failed * 2 > cases);
}

/* === contact curved =========================================================================== */
/* Random curved contacts: the energy balance closes, also at dead centres. */

static long wanted_runs(long usual) {
    const char *wanted = getenv("WHIRL_CURVED_RUNS");
    const long count = wanted != NULL ? strtol(wanted, NULL, 10) : 0;
    return count > 0 ? count : usual;
}

typedef struct outcome {
    double share; /* residual of the energy balance relative to the energy at the start */
    uint64_t overruns;
    bool refused;
} outcome;

static outcome run(uint64_t seed, double step_s, const engine_kind *kind) {
    char text[2000];
    motion m;
    const double energy_J = curved_text(seed, step_s, 2.0, text, sizeof text);
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4});
    outcome o = {.refused = motion_step(&m, m.instance->steps) != WH_OK};
    double total[64] = {0.0};
    double left[8] = {0.0};
    m.kind->ledger(m.run, total, left);
    o.overruns = contacts_overruns(&m);
    o.share = fabs(left[0]) / energy_J;
    motion_close(&m);
    return o;
}

/* If the inertia along the curve changes within a few steps, RK4 itself has a larger residual. It falls with the fourth
 * power of the step and is not the subject. */
static bool is_the_methods(uint64_t seed, double share) {
    const outcome fine = run(seed, 0.25e-3, &engine_double);
    printf("  seed %llu leaves %.1e, with a quarter of the step %.1e\n", (unsigned long long)seed,
           share, fine.share);
    return fine.overruns == 0 && fine.share < share / 60.0;
}

/* In float a motion with contacts may differ from that in double, but it must not lose energy. */
static void check_energy(const engine_kind *kind, double most, double coarse_share) {
    const long runs = wanted_runs((long)few_or_all(100, 300));
    double worst = 0.0;
    int beyond = 0;
    int coarse = 0;
    int over = 0;
    for (uint64_t seed = 1; seed <= (uint64_t)runs; seed++) {
        const outcome o = run(seed, 1e-3, kind);
        TEST_ASSERT_FALSE(o.refused);
        over += o.overruns > 0;
        if (o.overruns == 0 && !(o.share <= most)) {
            const bool method = kind == &engine_double
                                    ? is_the_methods(seed, o.share)
                                    : run(seed, 1e-3, &engine_double).share >= 1e-4;
            coarse += method;
            beyond += !method;
        } else if (o.overruns == 0) {
            worst = fmax(worst, o.share);
        }
    }
    char line[200];
    snprintf(
        line, sizeof line,
        "%s, seeds 1 to %ld: %d leave more than %g of the energy, %d more for a coarse step; else "
        "at most %.1e; %d with overruns",
        kind->name, runs, beyond, most, coarse, worst, over);
    puts(line);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, beyond, line);
    TEST_ASSERT_TRUE_MESSAGE(coarse <= coarse_share * (double)runs, line);
    TEST_ASSERT_TRUE_MESSAGE(kind == &engine_float || over <= runs / 20, line);
}

TEST(contact_curved, energy_is_accounted_for) { check_energy(&engine_double, 1e-4, 0.01); }
TEST(contact_curved, energy_is_accounted_for_in_float) { check_energy(&engine_float, 1e-3, 1.0); }

/* === contact devices ========================================================================== */
/* Devices of the dissertation with a stop: the carriage at a stop (row S18, test 3), Halvorson's vehicle (S12). */

static double pi(void) { return acos(-1.0); }

/* --- S18, test 3 ----------------------------------------------------------------------------------------- */

#define LB 0.45359237
#define INCH 0.0254
#define ECCENTRIC_KG (2.0 * (0.152 + 0.15) * LB)
#define ALL_KG (4.0 * ECCENTRIC_KG)                                     /* weight ratio 1/3 */
#define MOMENT_KG_M (2.0 * LB * INCH * (0.152 * 7.25 / 2 + 0.15 * 6.5)) /* sum of m r */

/* Largest and least X over the next `turns` turns. A turn is not a whole number of steps. So in twenty turns some step
 * ends within a twentieth of a step of an extreme. The error is then (0.05 w h)^2/2, 2e-6 of the range. */
static void swing(motion *m, double turns, double *least, double *most) {
    const double until = motion_value(m, "theta") + turns * 2.0 * pi();
    *least = HUGE_VAL;
    *most = -HUGE_VAL;
    while (motion_value(m, "theta") < until) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(m, 1));
        *least = fmin(*least, motion_value(m, "X"));
        *most = fmax(*most, motion_value(m, "X"));
    }
}

static void check_walk(stepping how, double swing_bound, double speed_most) {
    motion m;
    double least;
    double most;
    motion_open(&m, "carriage_stop", how);
    double nearest = motion_value(&m, "X");
    for (unsigned i = 0; i < 55000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        nearest = fmin(nearest, motion_value(&m, "X"));
    }
    const double theta = motion_value(&m, "theta");
    const double x_cm = motion_value(&m, "x_cm");
    swing(&m, 20.0, &least, &most);
    const double w = motion_value(&m, "theta'");
    const double speed =
        (motion_value(&m, "x_cm") - x_cm) * w / (motion_value(&m, "theta") - theta);
    motion_close(&m);
    printf("  %s: at last between %.6f and %.6f m\n", how.kind->name, least, most);
    /* the stop is not passed; a float location leaves some 2^-24 of the step's distance */
    expect_between("  nearest to the stop, m", -1e-9, 1e-3, nearest);
    /* walked away: further than its swing */
    expect_between("  mean place at last, m", 10.0 * MOMENT_KG_M / ALL_KG, 10.0,
                   (least + most) / 2.0);
    /* the project's result m r/(m + M), without friction; friction is 1/80 of the force here, and its effect on the
     * swing is of second order */
    const double free = MOMENT_KG_M / ALL_KG;
    expect_between("  swing over m r/(m + M)", 1.0 - 1e-3, 1.0 + 1e-3, (most - least) / 2.0 / free);
    /* closed form (Den Hartog, Forced vibrations with combined Coulomb and viscous friction, 1931). Without a spring
     * the factor is sqrt(1 - (pi f/2 F)^2), f the friction, F the force's amplitude */
    const double ratio = 0.05 * ALL_KG * 9.80665 / (MOMENT_KG_M * w * w);
    const double closed = free * sqrt(1.0 - pi() * pi() * ratio * ratio / 4.0);
    expect_between("  swing over the closed form, less 1", -swing_bound, swing_bound,
                   (most - least) / 2.0 / closed - 1.0);
    /* friction brakes the mean motion at a rate of 2 mu g/(pi swing w) = 0.28 per second: exp(-15) of 2 m/s */
    expect_between("  mean velocity at last, m/s", -speed_most, speed_most, speed);
}

TEST(contact_devices, carriage_walks_away_from_the_stop_and_then_only_swings) {
    /* see swing(); the closed form's speed is constant, the motor's ripples by 1e-5 */
    check_walk(IN_DOUBLE, 2e-5, 1e-5);
    /* X near 6 m in 24 bits: 2^-22 m in each of half a turn's 90 sums, of 0.064 m, as a random walk */
    check_walk(IN_FLOAT, 1e-4, 1e-4);
}

/* --- S12 ------------------------------------------------------------------------------------------------- */

/* The normal force oscillates around the weight, and the vehicle never leaves the ground. */
TEST(contact_devices, normal_force_pulsates_round_the_weight) {
    range r = {.name = "normal"};
    motion m;
    double sum = 0.0;
    unsigned looks = 0;
    motion_open(&m, "halvorson_ground", IN_DOUBLE);
    motion_to(&m, 5.0);
    const double turn = motion_value(&m, "theta") + 100.0 * 2.0 * pi();
    r.least = HUGE_VAL;
    r.most = 0.0;
    while (motion_value(&m, "theta") < turn) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double N = motion_value(&m, "normal");
        sum += N;
        looks++;
        r.least = fmin(r.least, N);
        r.most = fmax(r.most, N);
    }
    motion_close(&m);
    expect_between("S12: normal force, least, N", 0.1, 10.0, r.least);
    expect_between("S12: normal force, most, N", 15.0, 30.0, r.most);
    /* no net vertical motion: its mean is the weight, 1.33 kg; a hundred turns, cut at a step */
    expect_between("S12: mean normal force over the weight", 1.0 - 1e-4, 1.0 + 1e-4,
                   sum / looks / (1.33 * 9.81));
}

/* === contact law ============================================================================== */
/* Random mechanisms with a constant mass matrix, whose contacts all act at one moment. The laws of
 * core/contact/contact_lcp.h and core/contact/contact_resolve.h are solved independently by trying every case (active
 * contacts, those at a limit). Compares rates, places, and each contact's part of the energy and of each momentum. */

/* --- impacts --------------------------------------------------------------------------------------------------- */

/* Stops all reached at one moment, resting stops, a hold, and friction with zero normal force. */
static bool draw_impact(uint64_t *seed, double impact_s, drawn *b) {
    static const double restitutions[] = {0.0, 0.25, 0.5, 1.0};
    *b = drawn_body(seed);
    for (int i = 0; i < b->n; i++) {
        b->rate[i] = drawn_whole(seed, -3, 3);
    }
    b->rate[0] = random_bits(seed) % 2U != 0 ? 0.0 : b->rate[0]; /* so that friction may stick */
    const int hits = 1 + (int)(random_bits(seed) % 3U);
    for (int k = 0; k < hits; k++) {
        drawn_contact *of = drawn_add(b, 's');
        drawn_row(b, seed, of->row);
        const double speed = drawn_along(b, k, b->rate);
        if (speed == 0.0) {
            return false;
        }
        for (int i = 0; i < b->n && speed > 0.0; i++) {
            of->row[i] = -of->row[i];
        }
        of->restitution = restitutions[random_bits(seed) % 4U];
        of->offset = -fabs(speed) * impact_s;
        of->target = of->restitution * fabs(speed);
    }
    if (random_bits(seed) % 2U != 0) {
        drawn_row_at_rest(b, seed, drawn_add(b, 's')->row);
    }
    if (random_bits(seed) % 2U != 0) { /* every third in the opposite direction of a resting stop */
        drawn_contact *of = drawn_add(b, 'h');
        const bool repeats = of[-1].offset == 0.0 && random_bits(seed) % 3U == 0;
        drawn_row_at_rest(b, seed, of->row);
        for (int i = 0; i < b->n && repeats; i++) {
            of->row[i] = -of[-1].row[i];
        }
    }
    if (random_bits(seed) % 2U != 0) {
        drawn_add(b, 'f')->row[random_bits(seed) % (uint64_t)b->n] = 1.0;
    }
    return true;
}

/* Draws a hold that captures at the time of the impact, next to resting stops that may be released. */
static bool draw_capture(uint64_t *seed, double impact_s, drawn *b) {
    *b = drawn_body(seed);
    for (int i = 0; i < b->n; i++) {
        b->rate[i] = drawn_whole(seed, -3, 3);
    }
    const int stops = (int)(random_bits(seed) % 3U);
    for (int k = 0; k < stops; k++) {
        drawn_row_at_rest(b, seed, drawn_add(b, 's')->row);
    }
    drawn_contact *of = drawn_add(b, 'h');
    drawn_row(b, seed, of->row);
    drawn_row(b, seed, of->since);
    double speed = 0.0;
    for (int i = 0; i < b->n; i++) {
        speed += of->since[i] * b->rate[i];
    }
    of->since_m = speed * impact_s;
    return speed > 0.0;
}

static double apart(double got, double wanted) { return fabs(got - wanted) / (1.0 + fabs(wanted)); }

/* Error in the account of contact k: first the energy, then each momentum. */
static double books_apart(const motion *m, const drawn *b, int k, double energy, double impulse) {
    double total[64] = {0.0};
    double left[DRAWN_MOST + 1] = {0.0};
    m->kind->ledger(m->run, total, left);
    const double *entry = total + m->image->ledger.smooth + k * (1 + b->n);
    double worst = apart(entry[0], energy);
    for (int i = 0; i < b->n; i++) {
        worst = fmax(worst, apart(entry[1 + i], impulse * b->contact[k].row[i]));
    }
    return worst;
}

static double state_apart(const motion *m, const drawn *b, const double *at, const double *rate) {
    double worst = 0.0;
    for (int i = 0; i < b->n; i++) {
        const char name[] = {'x', (char)('0' + i), '\'', '\0'};
        const char value[] = {'x', (char)('0' + i), '\0'};
        worst = fmax(worst, apart(motion_value(m, name), rate[i]));
        worst = fmax(worst, apart(motion_value(m, value), at[i]) / DRAWN_STEP_S);
    }
    return worst;
}

static long wanted_runs_contact_law(long usual) {
    const char *wanted = getenv("WHIRL_LAW_RUNS");
    const long count = wanted != NULL ? strtol(wanted, NULL, 10) : 0;
    return count > 0 ? count : usual;
}

typedef bool draw_moment(uint64_t *seed, double impact_s, drawn *b);

static void check_impacts(draw_moment *draw, const engine_kind *kind, double bound) {
    const long runs = wanted_runs_contact_law((long)few_or_all(12, 40));
    uint64_t seed = 79;
    double worst = 0.0;
    double worst_books = 0.0;
    int unsolved = 0;
    int booked = 0;
    for (long done = 0; done < runs;) {
        const double impact_s = DRAWN_STEP_S * (double)(1U + random_bits(&seed) % 7U) / 8.0;
        drawn b;
        motion m;
        double lambda[DRAWN_CONTACTS] = {0.0};
        double after[DRAWN_MOST] = {0.0};
        double spot[DRAWN_MOST] = {0.0};
        if (!draw(&seed, impact_s, &b)) {
            continue;
        }
        done++;
        if (!drawn_solved(&b, b.rate, lambda, after)) {
            unsolved++;
            continue;
        }
        for (int i = 0; i < b.n; i++) {
            spot[i] = b.rate[i] * impact_s + after[i] * (DRAWN_STEP_S - impact_s);
        }
        drawn_open(&m, &b, kind);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double off = state_apart(&m, &b, spot, after);
        if (off > bound) {
            printf("  %s: case %ld is off by %.1e\n", kind->name, done, off);
        }
        worst = fmax(worst, off);
        const bool single = drawn_independent(&b);
        booked += single;
        for (int k = 0; k < b.contacts && single; k++) {
            const double mean = (drawn_along(&b, k, b.rate) + drawn_along(&b, k, after)) / 2.0;
            worst_books = fmax(worst_books, books_apart(&m, &b, k, lambda[k] * mean, lambda[k]));
        }
        motion_close(&m);
    }
    printf("%s: %ld impacts, off by %.1e, their books by %.1e (%d); %d without an answer here\n",
           kind->name, runs, worst, worst_books, booked, unsolved);
    TEST_ASSERT_TRUE(worst <= bound && worst_books <= 10.0 * bound);
    TEST_ASSERT_TRUE(unsolved <= runs / 20 && booked >= runs / 6);
}

TEST(contact_law, impacts_follow_newtons_law) { check_impacts(draw_impact, &engine_double, 1e-11); }
TEST(contact_law, impacts_follow_newtons_law_in_float) {
    check_impacts(draw_impact, &engine_float, 1e-4);
}

TEST(contact_law, holds_capture_by_their_law) {
    check_impacts(draw_capture, &engine_double, 1e-11);
}

/* --- forces ---------------------------------------------------------------------------------------------------- */

/* Draws a body at rest on its stops, with active holds and sticking friction; then the loads act. */
static void draw_rest(uint64_t *seed, drawn *b) {
    *b = drawn_body(seed);
    for (int i = 0; i < b->n; i++) {
        b->load[i] = drawn_whole(seed, -6, 6);
    }
    const int stops = 1 + (int)(random_bits(seed) % 3U);
    for (int k = 0; k < stops; k++) {
        drawn_row(b, seed, drawn_add(b, 's')->row);
    }
    if (random_bits(seed) % 2U != 0) {
        drawn_row(b, seed, drawn_add(b, 'h')->row);
    }
    for (int i = 0; i < b->n && b->contacts < DRAWN_CONTACTS; i++) {
        if (random_bits(seed) % 2U != 0) {
            drawn_contact *of = drawn_add(b, 'f');
            of->row[i] = 1.0;
            of->limit = drawn_whole(seed, 1, 4);
        }
    }
}

/* Constant loads give constant accelerations: rates a h, places a h^2/2, impulses lambda h. */
static void check_forces(const engine_kind *kind, double bound) {
    const long runs = wanted_runs_contact_law((long)few_or_all(12, 40));
    uint64_t seed = 72;
    double worst = 0.0;
    double worst_books = 0.0;
    int unsolved = 0;
    int booked = 0;
    for (long done = 0; done < runs; done++) {
        drawn b;
        motion m;
        double free[DRAWN_MOST];
        double lambda[DRAWN_CONTACTS] = {0.0};
        double accel[DRAWN_MOST];
        double spot[DRAWN_MOST] = {0.0};
        double rate[DRAWN_MOST] = {0.0};
        draw_rest(&seed, &b);
        drawn_inverse(&b, b.load, free);
        if (!drawn_solved(&b, free, lambda, accel)) {
            unsolved++;
            continue;
        }
        for (int i = 0; i < b.n; i++) {
            rate[i] = accel[i] * DRAWN_STEP_S;
            spot[i] = accel[i] * DRAWN_STEP_S * DRAWN_STEP_S / 2.0;
        }
        drawn_open(&m, &b, kind);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double off = state_apart(&m, &b, spot, rate) / DRAWN_STEP_S;
        if (off > bound) {
            printf("  %s: case %ld is off by %.1e\n", kind->name, done, off);
        }
        worst = fmax(worst, off);
        const bool single = drawn_independent(&b);
        booked += single;
        for (int k = 0; k < b.contacts && single; k++) {
            const double work = lambda[k] * drawn_along(&b, k, spot);
            worst_books = fmax(worst_books, books_apart(&m, &b, k, work, lambda[k] * DRAWN_STEP_S) /
                                                DRAWN_STEP_S);
        }
        motion_close(&m);
    }
    printf("%s: %ld loads, off by %.1e, their books by %.1e (%d); %d without an answer here\n",
           kind->name, runs, worst, worst_books, booked, unsolved);
    TEST_ASSERT_TRUE(worst <= bound && worst_books <= 10.0 * bound);
    TEST_ASSERT_TRUE(unsolved <= runs / 20 && booked >= runs / 6);
}

TEST(contact_law, forces_share_a_load_by_their_law) { check_forces(&engine_double, 1e-11); }
TEST(contact_law, forces_share_a_load_by_their_law_in_float) { check_forces(&engine_float, 1e-4); }

/* --- impacts and forces ---------------------------------------------------------------------------------------- */

/* Draws the same with loads in both directions, and speeds from fast to almost zero, so that some flights are too
 * short. */
static bool draw_mixed(uint64_t *seed, drawn *b) {
    if (!draw_impact(seed, DRAWN_STEP_S / 2.0, b)) {
        return false;
    }
    const double slow = 1.0 / (double)(1U << random_bits(seed) % 14U);
    for (int i = 0; i < b->n; i++) {
        b->rate[i] *= slow;
        b->load[i] = drawn_whole(seed, -6, 6);
    }
    for (int k = 0; k < b->contacts; k++) {
        drawn_contact *of = &b->contact[k];
        of->offset *= slow;
        of->limit = of->kind == 'f' ? drawn_whole(seed, 0, 3) / 4.0 : 0.0;
    }
    return true;
}

static double broken(const motion *m, const drawn *b, int k, double time_s) {
    const drawn_contact *of = &b->contact[k];
    double total[64] = {0.0};
    double left[DRAWN_MOST + 1] = {0.0};
    double gap = -of->offset;
    double rate = 0.0;
    double impulse = 0.0;
    int must = 0;
    for (int i = 0; i < b->n; i++) {
        const char name[] = {'x', (char)('0' + i), '\'', '\0'};
        const char value[] = {'x', (char)('0' + i), '\0'};
        gap += of->row[i] * motion_value(m, value);
        rate += of->row[i] * motion_value(m, name);
        must = of->row[i] != 0.0 ? i : must;
    }
    m->kind->ledger(m->run, total, left);
    const double *entry = total + m->image->ledger.smooth + k * (1 + b->n);
    impulse = entry[1 + must] / of->row[must];
    const double gave_J = entry[0]; /* no contact adds energy */
    if (of->kind == 's') {          /* only pushes, and is not penetrated */
        return fmax(fmax(gave_J, -impulse), -gap);
    }
    if (of->kind == 'f') { /* within its limit: no impulse */
        return fmax(gave_J, fabs(impulse) - of->limit * time_s);
    }
    return fmax(fmax(gave_J, fabs(gap)), fabs(rate));
}

TEST(contact_law, no_contact_does_more_than_it_can) {
    const long runs = wanted_runs_contact_law((long)few_or_all(12, 40));
    uint64_t seed = 73;
    double worst = 0.0;
    int over = 0;
    for (long done = 0; done < runs;) {
        drawn b;
        motion m;
        if (!draw_mixed(&seed, &b)) {
            continue;
        }
        done++;
        drawn_open(&m, &b, &engine_double);
        for (int step = 1; step <= 8; step++) {
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            for (int k = 0; k < b.contacts; k++) {
                const double off =
                    contacts_overruns(&m) == 0 ? broken(&m, &b, k, step * DRAWN_STEP_S) : 0.0;
                if (off > 1e-11) {
                    printf("  case %ld, step %d: contact %d by %.1e\n", done, step, k, off);
                }
                worst = fmax(worst, off);
            }
        }
        over += contacts_overruns(&m) > 0;
        motion_close(&m);
    }
    printf("%ld mechanisms: beyond what they can by %.1e; %d with overruns\n", runs, worst, over);
    TEST_ASSERT_TRUE(worst <= 1e-11 && over <= runs / 10);
}
