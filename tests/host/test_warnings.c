/* test_warnings.c: warnings of `whirl run`, both ways. A loss of more than a hundredth of the energy must cause one,
 * a loss of less than a ten-thousandth must not. So must singular coordinates if the step is too coarse for them.
 * With the suggested remedy, warning and error must vanish. Energies come from formulas in this file and from closed
 * forms. */
#include "command.h"

#include "host/cli/commands.h"
#include "motion.h"
#include "named_cures.h"

#define SOUND 1e-4
#define GONE 1e-2

enum { MASSES = 4, TEXT = 1600 };

typedef enum made_kind { SPRING, CHAIN, PENDULUM, DAMPER, DAMPED, KINDS } made_kind;

typedef struct made_up {
    made_kind kind;
    int masses;
    double mass[MASSES];
    double stiffness
        /* stiffness of the spring to the previous mass (mass 0: to the wall); for a pendulum, m g l */
        [MASSES];
    double damping; /* between the first body and the wall, N s/m */
    double start[MASSES];
    double rate;
    double fastest; /* approximate largest angular frequency, rad/s */
    char text[TEXT];
} made_up;

static const char *const names[MASSES] = {"x", "y", "z", "u"};

static made_up drawn(dice *d, made_kind kind) {
    made_up m = {.kind = kind, .masses = kind == CHAIN ? 2 + (int)dice_one_of(d, 3) : 1};
    for (int i = 0; i < m.masses; i++) {
        m.mass[i] = dice_between(d, 0.5, 2.0);
        m.stiffness[i] = kind == DAMPER ? 0.0 : pow(10.0, dice_between(d, 0.0, 3.0));
        m.start[i] = kind == DAMPER ? 0.0 : dice_between(d, 0.3, 1.0);
        m.fastest = fmax(m.fastest, sqrt((i > 0 ? 4.0 : 1.0) * m.stiffness[i] / m.mass[i]));
    }
    if (kind == PENDULUM) {
        m.start[0] = dice_between(d, 0.1, 2.5);
    } else if (kind == DAMPER) {
        m.damping = m.mass[0] * pow(10.0, dice_between(d, -1.0, 3.0));
        m.rate = dice_between(d, 0.1, 3.0);
        m.fastest = m.damping / m.mass[0];
    } else if (kind == DAMPED) {
        m.damping = 2.0 * m.mass[0] * m.fastest * pow(10.0, dice_between(d, -3.0, -0.5));
    }
    return m;
}

static void write(made_up *m, double step_s, double until_s) {
    char kinetic[300] = "";
    char stored[300] = "";
    char start[300] = "";
    char coordinates[200] = "";
    for (int i = 0; i < m->masses; i++) {
        const bool turns = m->kind == PENDULUM;
        const char *n = names[i];
        char *to = coordinates + strlen(coordinates);
        sprintf(to, "coordinate %s [%s]\n", n, turns ? "rad" : "m");
        sprintf(kinetic + strlen(kinetic), "%s%.9g [%s]*%s'^2/2", i > 0 ? " + " : "", m->mass[i],
                turns ? "kg*m^2" : "kg", n);
        if (turns) {
            sprintf(stored, "-%.9g [J]*cos(x)", m->stiffness[i]);
        } else if (i > 0) {
            sprintf(stored + strlen(stored), " + %.9g [N/m]*(%s - %s)^2/2", m->stiffness[i], n,
                    names[i - 1]);
        } else {
            sprintf(stored, "%.9g [N/m]*x^2/2", m->stiffness[i]);
        }
        sprintf(start + strlen(start), "%s%s = %.9g [%s]", i > 0 ? ", " : "", n, m->start[i],
                turns ? "rad" : "m");
    }
    snprintf(m->text, TEXT,
             "mechanism made\n%sT = %s\nV = %s\nF = %.9g [N*s/m%s]*x'^2/2\n"
             "scene s { start %s, x' = %.9g [%s]\nstep %.12g [s]\nuntil %.12g [s] }\n",
             coordinates, kinetic, stored, m->damping, m->kind == PENDULUM ? "*m^2" : "", start,
             m->rate, m->kind == PENDULUM ? "rad/s" : "m/s", step_s, until_s);
}

static double energy_J(const made_up *m, const motion *at) {
    double sum_J = 0.0;
    double before = 0.0;
    for (int i = 0; i < m->masses; i++) {
        char rate[8];
        snprintf(rate, sizeof rate, "%s'", names[i]);
        const double q = motion_value(at, names[i]);
        const double v = motion_value(at, rate);
        sum_J += m->mass[i] * v * v / 2.0;
        sum_J += m->kind == PENDULUM ? 2.0 * m->stiffness[i] * sin(q / 2.0) * sin(q / 2.0)
                                     : m->stiffness[i] * (q - before) * (q - before) / 2.0;
        before = q;
    }
    return sum_J;
}

static double truth_J(const made_up *m, double start_J, double t) {
    const double decay = m->damping / m->mass[0];
    if (m->kind == DAMPER) {
        return start_J * exp(-2.0 * decay * t);
    }
    if (m->kind != DAMPED) {
        return start_J;
    }
    const double stiffness = m->stiffness[0] / m->mass[0];
    const double half = decay / 2.0;
    const double w = sqrt(stiffness - half * half);
    const double q = m->start[0] * exp(-half * t) * (cos(w * t) + half / w * sin(w * t));
    const double v = -m->start[0] * exp(-half * t) * stiffness / w * sin(w * t);
    return m->mass[0] * v * v / 2.0 + m->stiffness[0] * q * q / 2.0;
}

/* Largest energy error of a run, relative to the energy at the start; infinite if the run diverges. */
static double energy_off(const made_up *m, wh_method method, double step_s, uint64_t steps,
                         bool is_float, bool compensated) {
    motion at;
    motion_open_text(&at, m->text,
                     (stepping){.kind = is_float ? &engine_float : &engine_double,
                                .method = method,
                                .compensated = compensated,
                                .step_s = step_s});
    const double start_J = energy_J(m, &at);
    double most = 0.0;
    for (uint64_t k = 1; k <= steps && isfinite(most); k++) {
        const bool stepped = motion_step(&at, 1) == WH_OK;
        const double off = fabs(energy_J(m, &at) - truth_J(m, start_J, (double)k * step_s));
        most = stepped ? fmax(most, off / start_J) : (double)INFINITY;
    }
    motion_close(&at);
    return most;
}

static void run(const char *file, const char *method, const char *step, bool is_float, said *what) {
    const char *words[10] = {
        file, "--number", is_float ? "float" : "double", "--method", method, "--quiet", NULL};
    if (step != NULL) {
        words[6] = "--step";
        words[7] = step;
    }
    command_say(command_run, words, what);
}

static wh_method method_named(const char *word) {
    int m = 0;
    while (m < WH_METHODS && strcmp(wh_methods[m].word, word) != 0) {
        m++;
    }
    TEST_ASSERT_TRUE_MESSAGE(m < WH_METHODS, word);
    return (wh_method)m;
}

/* Applies each remedy of a warning. There must be no warning, and the energy must be right. Returns the number of
 * remedies. */
static int cure(const made_up *m, const said *warned, wh_method method, double step_s,
                double until_s, bool is_float) {
    int done = 0;
    named_cure list[NAMED_CURES];
    const int count = named_cures(warned->err, list);
    for (int k = 0; k < count; k++) {
        const named_cure *c = &list[k];
        const char *words[12] = {model_keep(m->text), "--quiet"};
        said what;
        if (!c->tried) {
            continue;
        }
        named_words(c, wh_methods[method].word, is_float ? "float" : "double", words, 2);
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, warned->err);
        const double h = c->step[0] != '\0' ? said_step_s(c->step) : step_s;
        const double off = energy_off(m, method_named(words[5]), h, (uint64_t)(until_s / h + 0.5),
                                      is_float && !c->in_double, c->compensated);
        TEST_ASSERT_TRUE_MESSAGE(off < 1e-3, warned->err);
        done++;
    }
    return done;
}

TEST(warnings, energy_loss_is_warned_of) {
    dice d = dice_of("warned", 14001);
    const unsigned cases = dice_cases(few_or_all(usual_or(60, 40), 300));
    unsigned gone = 0;
    unsigned sound = 0;
    unsigned between = 0;
    unsigned cured = 0;
    unsigned cures = 0;
    unsigned without = 0;
    for (unsigned i = 0; i < cases; i++) {
        made_up m = drawn(&d, (made_kind)(i % KINDS));
        wh_method method = (wh_method)dice_one_of(&d, WH_METHODS);
        const bool rates = m.damping > 0.0;
        method = wh_methods[method].takes == WH_NO_RATES && rates ? WH_RK4 : method;
        const bool is_float = dice_one_of(&d, 2) == 0;
        const double step_s = pow(10.0, dice_between(&d, -2.0, log10(3.0))) / m.fastest;
        const uint64_t steps = (uint64_t)pow(10.0, dice_between(&d, 1.0, 3.0));
        const double until_s = step_s * (double)steps;
        said what;
        write(&m, step_s, until_s);
        const double off = energy_off(&m, method, step_s, steps, is_float, false);
        run(model_keep(m.text), wh_methods[method].word, NULL, is_float, &what);
        char about[TEXT + SAID_SIZE + 200];
        snprintf(about, sizeof about, "%s %s, off by %.3g:\n%s%s", wh_methods[method].word,
                 is_float ? "float" : "double", off, m.text, what.err);
        if (off > GONE) {
            gone++;
            TEST_ASSERT_TRUE_MESSAGE(strstr(what.err, "energy balance fails") != NULL ||
                                         strstr(what.err, "diverged") != NULL,
                                     about);
            TEST_ASSERT_TRUE_MESSAGE(strstr(what.err, "\nhint: ") != NULL, about);
            TEST_ASSERT_EQUAL_INT_MESSAGE(
                strstr(what.err, "diverged") != NULL ? 1 : said_owes(what.err), what.status, about);
            const int by = cure(&m, &what, method, step_s, until_s, is_float);
            cured += by > 0 ? 1 : 0;
            cures += (unsigned)by;
            without += by > 0 ? 0 : 1;
        } else if (off < SOUND) {
            sound++;
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
        } else {
            between++;
        }
    }
    model_drop();
    printf("  %u runs: of %u more than 1 %% of the energy is gone, %u of them with cures (%u, "
           "all tried), %u without; %u are sound\n",
           cases, gone, cured, cures, without, sound);
    TEST_ASSERT_TRUE(gone > cases / 10 && sound > cases / 10 && between < cases / 2);
    TEST_ASSERT_TRUE(without <= gone / 20);
}

/* Final error in m of a particle that passes the axis of spherical coordinates. */
static double flight_off(const char *text, const double end[3], double step_s, bool is_float,
                         bool compensated) {
    motion at;
    motion_open_text(&at, text,
                     (stepping){.kind = is_float ? &engine_float : &engine_double,
                                .method = WH_RK4,
                                .compensated = compensated,
                                .step_s = step_s});
    const bool went = motion_step(&at, (uint64_t)(1.0 / step_s + 0.5)) == WH_OK;
    const double r = motion_value(&at, "r");
    const double theta = motion_value(&at, "theta");
    const double phi = motion_value(&at, "phi");
    motion_close(&at);
    const double x = r * sin(theta) * cos(phi) - end[0];
    const double y = r * sin(theta) * sin(phi) - end[1];
    const double z = r * cos(theta) - end[2];
    return went ? sqrt(x * x + y * y + z * z) : (double)INFINITY;
}

TEST(warnings, passing_a_pole_is_warned_of) {
    dice d = dice_of("poles", 14002);
    const unsigned cases = dice_cases(few_or_all(20, 50));
    unsigned off_course = 0;
    double worst_m = 0.0;
    unsigned sound = 0;
    for (unsigned i = 0; i < cases; i++) {
        const double past_m = pow(10.0, dice_between(&d, -3.7, -0.7));
        const double speed = dice_between(&d, 3.0, 9.0);
        const double away = dice_between(&d, 0.35, 0.65) * speed; /* metres from the axis */
        const double height = dice_between(&d, 3.0, 6.0);
        const double rise = dice_between(&d, 1.0, 5.0);
        const bool is_float = i % 3 == 2;
        const double rho = sqrt(away * away + past_m * past_m);
        const double r = sqrt(rho * rho + height * height);
        /* the body is at x = away, y = past; it moves along x to the axis, and rises */
        const double phi = atan2(past_m, away);
        const double rho_rate = -speed * cos(phi);
        const double phi_rate = speed * sin(phi) / rho;
        const double theta = atan2(rho, height);
        const double r_rate = rho_rate * sin(theta) + rise * cos(theta);
        const double theta_rate = (rho_rate * cos(theta) - rise * sin(theta)) / r;
        const double end[3] = {away - speed, past_m, height + rise - 9.81 / 2.0};
        char text[1000];
        snprintf(
            text, sizeof text,
            "mechanism flight\ncoordinate r [m]\ncoordinate theta [rad]\n"
            "coordinate phi [rad]\nparameter m = 1 [kg]\n"
            "T = m*(r'^2 + r^2*theta'^2 + r^2*sin(theta)^2*phi'^2)/2\n"
            "V = m*9.81 [m/s^2]*r*cos(theta)\n"
            "scene s { start r = %.15g [m], theta = %.15g, phi = %.15g\n"
            "start r' = %.15g [m/s], theta' = %.15g [rad/s], phi' = %.15g [rad/s]\nstep 1 [ms]\nuntil 1 [s] }\n",
            r, theta, phi, r_rate, theta_rate, phi_rate);
        const double off_m = flight_off(text, end, 1e-3, is_float, false);
        said what;
        run(model_keep(text), "rk4", NULL, is_float, &what);
        char about[SAID_SIZE + 1200];
        snprintf(about, sizeof about, "past %.3g m, off by %.3g m\n%s%s", past_m, off_m, text,
                 what.err);
        if (off_m > 0.02) {
            off_course++;
            named_cure is;
            TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, about);
            TEST_ASSERT_TRUE_MESSAGE(named_with_step(what.err, &is), about);
            const double cured_m = flight_off(text, end, said_step_s(is.step),
                                              is_float && !is.in_double, is.compensated);
            const char *words[12] = {model_keep(text), "--quiet"};
            named_words(&is, "rk4", is_float ? "float" : "double", words, 2);
            command_say(command_run, words, &what);
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
            TEST_ASSERT_TRUE_MESSAGE(cured_m < 2e-3 && cured_m < 0.1 * off_m, about);
            worst_m = fmax(worst_m, cured_m);
        } else if (off_m < 1e-4) {
            sound++;
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
        }
    }
    model_drop();
    printf("  %u flights: %u more than 2 cm off, all told, and cured to %.1e m; %u sound\n", cases,
           off_course, worst_m, sound);
    TEST_ASSERT_TRUE(off_course > cases / 10 && sound > cases / 10);
}

/* A step computes at most eight of the ball's bounces, then lets the ball rest, and the run warns. With the remedy the warning must vanish. */
static void expect_ball_between(said *what, const char **words) {
    named_cure is;
    const char *again[12];
    TEST_ASSERT_NOT_NULL_MESSAGE(
        strstr(what->err, "1 step of 1000, the first at t = 0 s, had more"), what->err);
    TEST_ASSERT_TRUE_MESSAGE(named_with_step(what->err, &is), what->err);
    memcpy(again, words, 2 * sizeof *words);
    named_words(&is, "rk4", words[3], again, 2);
    command_say(command_run, again, what);
}

/* All built-in scenes run to their ends, in both number types or by turns. Only the one scene that demonstrates a
 * warning may have one. */
TEST(warnings, built_in_scenes_have_no_warnings) {
    said list;
    said what;
    const char *none[] = {NULL};
    const unsigned numbers = few_or_all(1, 2);
    const unsigned each = usual_or(1, 2);
    unsigned scenes = 0;
    command_say(command_list, none, &list);
    char *rest = NULL;
    for (char *line = strtok_r(list.out, "\n", &rest); line != NULL;
         line = strtok_r(NULL, "\n", &rest)) {
        char name[80];
        if (sscanf(line, "scene %79s", name) != 1) {
            continue;
        }
        for (unsigned k = 0; k < numbers && scenes % each == 0; k++) {
            const bool is_ball = strcmp(name, "ball_between") == 0;
            /* in float, the remedy for ball_between exceeds the effort */
            const bool is_float = (scenes / each + k) % 2 == 1 && !is_ball;
            const char *words[] = {name, "--quiet", "--number", is_float ? "float" : "double",
                                   NULL};
            command_say(command_run, words, &what);
            if (is_ball) { /* this scene demonstrates a warning */
                expect_ball_between(&what, words);
            }
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, name);
            TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, name);
        }
        scenes++;
    }
    TEST_ASSERT_TRUE(scenes > 40);
    printf("  %u scenes, to their ends\n", scenes / each);
}
