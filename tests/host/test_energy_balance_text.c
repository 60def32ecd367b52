/* test_energy_balance_text.c: what `whirl run` reports at the end on energy and momenta. Random mechanisms have uncoupled
 * coordinates: free, pushed, sprung or damped. Closed forms give the conserved momenta, their values and, with the
 * ledger, the cause of each change. */
#include "test.h"

#include "host/base/alloc.h"
#include "host/check/books.h"
#include "host/check/energy_residual.h"
#include "host/cli/commands.h"
#include "host/image/program.h"

#include "command.h"
#include "derived.h"
#include "motion.h"

/* === suite energy_balance_text ================================================================ */

enum { COORDINATES_MOST = 4 };

typedef enum held_by { FREE, PUSHED, SPRUNG, DAMPED, KINDS } held_by;

typedef struct own_body {
    held_by by;
    double mass_kg;
    double law; /* force, N, or stiffness, N/m, or damping, N s/m */
    double x_m;
    double speed_mps;
} own_body;

typedef struct own_bodies {
    own_body body[COORDINATES_MOST];
    unsigned count;
    double until_s;
} own_bodies;

static own_bodies drawn(dice *d) {
    own_bodies m = {.count = 1U + dice_one_of(d, COORDINATES_MOST),
                    .until_s = 0.001 * (100 + (int)dice_one_of(d, 900))};
    for (unsigned i = 0; i < m.count; i++) {
        m.body[i] = (own_body){.by = (held_by)dice_one_of(d, KINDS),
                               .mass_kg = dice_between(d, 0.5, 5.0),
                               .law = dice_between(d, 0.5, 5.0),
                               .x_m = dice_between(d, -1.0, 1.0),
                               .speed_mps = dice_between(d, -3.0, 3.0)};
    }
    return m;
}

static char name_of(unsigned i) { return (char)('z' - (int)i); }

/* Writes the sum over all bodies of one kind after the words `begins`, such as "V = 2 [N/m]*z^2/2 + 3 [N/m]*y^2/2".
 * The text is empty if there are no such bodies. */
static void sum_of(const own_bodies *m, held_by by, const char *begins, const char *unit,
                   const char *square, char text[400]) {
    int at = 0;
    text[0] = '\0';
    for (unsigned i = 0; i < m->count; i++) {
        const own_body *b = &m->body[i];
        if (b->by == by || by == KINDS) {
            at += snprintf(text + at, (size_t)(400 - at), "%s%.17g %s*%c%s/2",
                           at == 0 ? begins : " + ", by == KINDS ? b->mass_kg : b->law, unit,
                           name_of(i), square);
        }
    }
}

static void mechanism_text(const own_bodies *m, char text[2500]) {
    char sums[3][400];
    sum_of(m, KINDS, "T = ", "[kg]", "'^2", sums[0]);
    sum_of(m, SPRUNG, "V = ", "[N/m]", "^2", sums[1]);
    sum_of(m, DAMPED, "F = ", "[N*s/m]", "'^2", sums[2]);
    int at = snprintf(text, 2500, "mechanism own\n");
    for (unsigned i = 0; i < m->count; i++) {
        at += snprintf(text + at, (size_t)(2500 - at), "coordinate %c [m]\n", name_of(i));
    }
    at += snprintf(text + at, (size_t)(2500 - at), "%s\n%s\n%s\n", sums[0], sums[1], sums[2]);
    for (unsigned i = 0; i < m->count; i++) {
        if (m->body[i].by == PUSHED) {
            at += snprintf(text + at, (size_t)(2500 - at), "Q(%c) = %.17g [N]\n", name_of(i),
                           m->body[i].law);
        }
    }
    at += snprintf(text + at, (size_t)(2500 - at), "scene s { start ");
    for (unsigned i = 0; i < m->count; i++) {
        at += snprintf(text + at, (size_t)(2500 - at), "%s%c = %.17g [m], %c' = %.17g [m/s]",
                       i > 0 ? ", " : "", name_of(i), m->body[i].x_m, name_of(i),
                       m->body[i].speed_mps);
    }
    (void)snprintf(text + at, (size_t)(2500 - at), "; step 1 [ms]; until %.3f [s] }\n", m->until_s);
}

static double change_Ns(const own_body *b, double time_s) {
    const double w = sqrt(b->law / b->mass_kg);
    double end_mps = b->speed_mps;
    switch (b->by) {
    case PUSHED: end_mps += b->law / b->mass_kg * time_s; break;
    case SPRUNG: end_mps = b->speed_mps * cos(w * time_s) - b->x_m * w * sin(w * time_s); break;
    case DAMPED: end_mps *= exp(-b->law / b->mass_kg * time_s); break;
    case FREE:
    case KINDS: break;
    }
    return b->mass_kg * (end_mps - b->speed_mps);
}

static void run(const char *text, const char *more, said *what) {
    COMMAND_SAY(command_run, what, model_keep(text), more, "ledger");
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what->err), what->status, what->err);
}

static void expect_number(const char *text, double wanted, const char *at) {
    double is = 0.0;
    (void)said_number(text, &is);
    TEST_ASSERT_TRUE_MESSAGE(fabs(is - wanted) <= 1e-8 * (1.0 + fabs(wanted)), at);
}

/* Checks the balance's energies at the end, its work and its losses. Springs do no work here: their energy is in V. */
static void expect_balance(const own_bodies *m, const char *text) {
    double kinetic_J = 0.0;
    double stored_J = 0.0;
    double work_J = 0.0;
    double losses_J = 0.0;
    for (unsigned i = 0; i < m->count; i++) {
        const own_body *b = &m->body[i];
        const double w = sqrt(b->law / b->mass_kg);
        const double end_mps = b->speed_mps + change_Ns(b, m->until_s) / b->mass_kg;
        const double gained_J =
            b->mass_kg * (end_mps * end_mps - b->speed_mps * b->speed_mps) / 2.0;
        const double end_m = b->x_m * cos(w * m->until_s) + b->speed_mps / w * sin(w * m->until_s);
        kinetic_J += b->mass_kg * end_mps * end_mps / 2.0;
        stored_J += b->by == SPRUNG ? b->law * end_m * end_m / 2.0 : 0.0;
        work_J += b->by == PUSHED ? gained_J : 0.0;
        losses_J += b->by == DAMPED ? gained_J : 0.0;
    }
    const char *at = strstr(text, "energy balance [J]\n");
    TEST_ASSERT_NOT_NULL_MESSAGE(at, text);
    expect_number(strstr(strstr(at, "  kinetic "), "-> ") + 3, kinetic_J, at);
    expect_number(strstr(strstr(at, "  stored "), "-> ") + 3, stored_J, at);
    expect_number(strpbrk(strstr(at, "  work of inputs "), "+-"), work_J, at);
    expect_number(strpbrk(strstr(at, "  losses "), "+-"), losses_J, at);
}

TEST(energy_balance_text, conserved_momenta) {
    dice d = dice_of("energy_balance_text", 4121);
    unsigned none = 0;
    for (unsigned k = 0; k < dice_cases(60); k++) {
        const own_bodies m = drawn(&d);
        char text[2500];
        said what;
        mechanism_text(&m, text);
        run(text, NULL, &what);
        const char *head = strstr(what.out, "conserved momentum [SI]\n");
        unsigned free_ones = 0;
        for (unsigned i = 0; i < m.count; i++) {
            char row[40];
            snprintf(row, sizeof row, "\n  of %c  ", name_of(i));
            const char *at = strstr(what.out, row);
            TEST_ASSERT_EQUAL_INT_MESSAGE(m.body[i].by == FREE, at != NULL, what.out);
            if (at != NULL) {
                TEST_ASSERT_TRUE_MESSAGE(head != NULL && at > head, what.out);
                at += strlen(row);
                expect_number(at + strspn(at, " "), m.body[i].mass_kg * m.body[i].speed_mps, at);
                free_ones++;
            }
        }
        none += free_ones == 0 ? 1U : 0U;
        TEST_ASSERT_EQUAL_INT_MESSAGE(free_ones > 0, head != NULL, what.out);
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            free_ones == 0,
            strstr(
                what.out,
                "\nno single coordinate's momentum is conserved; whirl examine finds other conserved momenta\n") !=
                NULL,
            what.out);
        expect_balance(&m, what.out);
    }
    model_drop();
    TEST_ASSERT_TRUE(none > 3U);
}

/* Checks each momentum balance: the named cause, the change, and the change divided by the run's duration. */
TEST(energy_balance_text, ledgers) {
    static const char *const givers[KINDS] = {[FREE] = NULL,
                                              [PUSHED] = "\n  Q(",
                                              [SPRUNG] = "\n  from T and V: dL/d",
                                              [DAMPED] = "\n  F = "};
    dice d = dice_of("ledgers told", 4122);
    for (unsigned k = 0; k < dice_cases(60); k++) {
        const own_bodies m = drawn(&d);
        char text[2500];
        said what;
        mechanism_text(&m, text);
        run(text, "--with", &what);
        TEST_ASSERT_NULL_MESSAGE(strstr(what.out, "conserved"), what.out);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, "energy balance [J]\n"), what.out);
        for (unsigned i = 0; i < m.count; i++) {
            char head[60];
            snprintf(head, sizeof head, "\nmomentum balance of %c [kg*m/s]\n", name_of(i));
            const char *book = strstr(what.out, head);
            TEST_ASSERT_NOT_NULL_MESSAGE(book, what.out);
            const char *change = strstr(book + 1, "\n  change ");
            const char *force =
                strstr(book + 1, "\n  change divided by the run's duration, along ");
            TEST_ASSERT_TRUE_MESSAGE(change != NULL && force != NULL && change < force, book);
            const double wanted = change_Ns(&m.body[i], m.until_s);
            const char *number = change + strlen("\n  change ");
            expect_number(number + strspn(number, " +"), wanted, book);
            force += strlen("\n  change divided by the run's duration, along ");
            TEST_ASSERT_EQUAL_CHAR(name_of(i), force[0]);
            expect_number(force + 3, wanted / m.until_s, book);
            for (int by = PUSHED; by < KINDS; by++) {
                const char *named = strstr(book + 1, givers[by]);
                const bool told = named != NULL && named < change;
                TEST_ASSERT_EQUAL_INT_MESSAGE((int)m.body[i].by == by, told, book);
            }
        }
    }
    model_drop();
}

/* The ball never reaches some of the random stops. Such a stop must have no line in any account. */
TEST(energy_balance_text, contacts_without_impulse_have_no_line) {
    dice die = dice_of("energy_balance_text", 93);
    enum { STOPS = 4 };
    for (unsigned c = 0; c < dice_cases(4); c++) {
        char text[1200];
        char at[STOPS][40];
        bool reached[STOPS];
        said what;
        int length = snprintf(text, sizeof text,
                              "mechanism ball \"a ball\"\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                              "V = 9.81 [N]*x\n");
        for (int i = 0; i < STOPS; i++) {
            /* the ball falls from 1 m and hits only one stop, the highest */
            reached[i] = i == (int)(c % STOPS);
            const double below =
                reached[i] ? dice_between(&die, 0.0, 0.5) : dice_between(&die, 2.0, 9.0);
            snprintf(at[i], sizeof at[i], "stop x >= %.9g [m]", -below);
            length += snprintf(text + length, sizeof text - (size_t)length, "%s restitution 0.5\n",
                               at[i]);
        }
        snprintf(text + length, sizeof text - (size_t)length,
                 "scene a {\nwith ledger\nstart x = 1 [m]\nstep 1 [ms]\nuntil 1 [s]\n}\n");
        COMMAND_SAY(command_run, &what, model_keep(text));
        model_drop();
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        for (int i = 0; i < STOPS; i++) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(reached[i], strstr(what.out, at[i]) != NULL, what.out);
        }
    }
}

/* === suite energy_integral ==================================================================== */
/* The energy balance of motions in which T + V is not conserved, because T is not quadratic in the rates, V contains
 * rates, or an energy contains a changing input. Each energy integral is derived by hand (Goldstein, Classical
 * Mechanics, section 2.7). */

/* A bead on a hoop that turns at the rate w about its vertical diameter. */
#define HOOP(rate) \
    "mechanism hoop\ncoordinate th [rad]\nparameter m = 0.1 [kg]\n" \
    "parameter R = 0.2 [m]\nparameter g = 9.81 [m/s^2]\n" rate \
    "\nT = m*R^2*(th'^2 + w^2*sin(th)^2)/2\nV = -m*g*R*cos(th)\n"
#define HOOP_AT_10 HOOP("parameter w = 10 [rad/s]")
/* A charge in a homogeneous magnetic field: V contains rates. */
#define FIELD \
    "mechanism field\ncoordinate x [m]\ncoordinate y [m]\nparameter m = 1 [kg]\n" \
    "parameter B = 1 [kg/s]\nT = m*(x'^2+y'^2)/2\nV = -B*(x*y'-y*x')/2\n"
/* A body on a spring, in a slot of a turning table. */
#define SLOT \
    "mechanism slot\ncoordinate x [m]\nparameter m = 1 [kg]\n" \
    "parameter w = 2 [rad/s]\nparameter k = 9 [N/m]\n" \
    "T = m*(x'^2 + w^2*x^2)/2\nV = k*x^2/2\n"
/* A body on a spring, near the speed of light, which is 2 m/s here. */
#define FAST \
    "mechanism fast\ncoordinate x [m]\nparameter m = 1 [kg]\n" \
    "parameter c = 2 [m/s]\nparameter k = 1 [N/m]\n" \
    "T = -m*c^2*sqrt(1 - x'^2/c^2)\nV = k*x^2/2\n"
/* A puck and a wall on a turning table, in the table's frame. T has terms that are linear in the rates. */
#define TABLE \
    "mechanism table\ncoordinate x [m]\ncoordinate y [m]\nparameter m = 2 [kg]\n" \
    "parameter w = 1.5 [rad/s]\nT = m*((x' - w*y)^2 + (y' + w*x)^2)/2\n" \
    "stop x <= 0.5 [m] restitution 0.6\n"

static double square(double x) { return x * x; }

static double hoop_J(const motion *m, double w) {
    const double th = motion_value(m, "th");
    return 0.1 * 0.04 * (square(motion_value(m, "th'")) - square(w * sin(th))) / 2.0 -
           0.1 * 9.81 * 0.2 * cos(th);
}

static double hoop_at_10(const motion *m) { return hoop_J(m, 10.0); }

static double field_J(const motion *m) {
    return (square(motion_value(m, "x'")) + square(motion_value(m, "y'"))) / 2.0;
}

static double slot_J(const motion *m) {
    const double x = motion_value(m, "x");
    return (square(motion_value(m, "x'")) - square(2.0 * x) + 9.0 * square(x)) / 2.0;
}

static double fast_J(const motion *m) {
    const double v = motion_value(m, "x'");
    return 4.0 / sqrt(1.0 - square(v) / 4.0) + square(motion_value(m, "x")) / 2.0;
}

static double table_J(const motion *m) {
    const double x = motion_value(m, "x");
    const double y = motion_value(m, "y");
    return square(motion_value(m, "x'")) + square(motion_value(m, "y'")) -
           square(1.5) * (square(x) + square(y));
}

typedef double by_hand(const motion *m);

static const stepping booked = {.kind = &engine_double, .method = WH_RK4, .ledger = true};

typedef struct remainders {
    double summary_J; /* energy residual that the summary of the run prints */
    double ledger_J;  /* energy residual of the run's own ledger */
    double change_J;  /* change of the energy integral that was derived by hand */
} remainders;

static double ledger_left_J(const motion *m) {
    const image_ledger *l = &m->image->ledger;
    double *total = calloc((size_t)(l->entries + l->accounts), sizeof *total);
    TEST_ASSERT_NOT_NULL(total);
    m->kind->ledger(m->run, total, total + l->entries);
    const double left_J = total[l->entries];
    free(total);
    return left_J;
}

static remainders book(const char *text, by_hand *energy_J, double step_s) {
    motion m;
    stepping how = booked;
    how.step_s = step_s;
    motion_open_text(&m, text, how);
    TEST_ASSERT_TRUE(m.image->has_integral);
    books *b = books_open(m.image);
    const uint64_t steps = m.instance->steps;
    remainders r = {.change_J = -energy_J(&m)};
    books_enter(b, m.kind, m.run);
    for (uint64_t step = 1; step <= steps; step++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        books_enter(b, m.kind, m.run);
        if (step % 2 == 0) { /* Simpson's rule needs pairs of steps */
            r.summary_J = fmax(r.summary_J, fabs(books_left_J(b)));
        }
        r.ledger_J = fmax(r.ledger_J, fabs(ledger_left_J(&m)));
    }
    r.change_J += energy_J(&m);
    TEST_ASSERT_DOUBLE_WITHIN(1e-13, r.change_J, b->energy_J[1] - b->energy_J[0]);
    books_close(b);
    motion_close(&m);
    return r;
}

/* With the scene's own step, the residual is the method's error: below 1e-9 J for energies of about 1 J. */
static void expect_closed(const char *text, by_hand *energy_J) {
    const remainders r = book(text, energy_J, 0.0);
    printf("  left over %.1e J in the summary's books, %.1e J in the ledger\n", r.summary_J,
           r.ledger_J);
    TEST_ASSERT_TRUE(r.summary_J < 1e-9 && r.ledger_J < 1e-9);
}

/* The residual must fall like the method's error: with the fourth power of the step or a higher one. */
static void expect_order(const char *text, by_hand *energy_J, double step_s) {
    remainders r[3];
    for (int k = 0; k < 3; k++) {
        r[k] = book(text, energy_J, step_s / (1 << k));
    }
    for (int k = 0; k < 2; k++) {
        const double orders[] = {log2(r[k].summary_J / r[k + 1].summary_J),
                                 log2(r[k].ledger_J / r[k + 1].ledger_J)};
        char line[120];
        snprintf(line, sizeof line, "left over %.2e, %.2e J: orders %.2f, %.2f", r[k].summary_J,
                 r[k].ledger_J, orders[0], orders[1]);
        printf("  %s\n", line);
        TEST_ASSERT_TRUE_MESSAGE(orders[0] > 3.7 && orders[1] > 3.7, line);
    }
}

TEST(energy_integral, smooth_motions) {
    static const struct {
        const char *text;
        by_hand *energy_J;
        double step_s; /* a coarse step, to measure the order */
    } rows[] = {{HOOP_AT_10 "scene s { start th = 0.1\nuntil 2 [s] }\n", hoop_at_10, 4e-3},
                /* the work of the torque and the loss of the damper are entries of about 1e-2 J */
                {HOOP_AT_10 "input M = 0.06 [N*m]\nQ(th) = M\n"
                            "F = 1e-3 [N*m*s]*th'^2/2\nscene s { start th = 0.1\nuntil 2 [s] }\n",
                 hoop_at_10, 2e-3},
                {FIELD "scene s { start x' = 1 [m/s]\nuntil 1 [s] }\n", field_J, 0.2},
                {SLOT "scene s { start x = 1 [m]\nuntil 1 [s] }\n", slot_J, 0.1},
                {FAST "scene s { start x' = 1.5 [m/s]\nuntil 1 [s] }\n", fast_J, 0.1}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        expect_closed(rows[i].text, rows[i].energy_J);
        expect_order(rows[i].text, rows[i].energy_J, rows[i].step_s);
    }
    TEST_ASSERT_TRUE(fabs(book(rows[1].text, hoop_at_10, 0.0).change_J) > 1e-2);
}

/* The total of a contact in account 0 (the energy) or 1 + i (the momentum of coordinate i). *left_over: the
 * account's residual. */
static double of_contact(const motion *m, int account, double *left_over) {
    const image_ledger *l = &m->image->ledger;
    double *total = calloc((size_t)(l->entries + l->accounts), sizeof *total);
    TEST_ASSERT_NOT_NULL(total);
    m->kind->ledger(m->run, total, total + l->entries);
    const double entry = total[l->smooth + account];
    *left_over = total[l->entries + account];
    free(total);
    return entry;
}

/* A stop on the turning table changes the energy integral by half the mass times the change of the squared speed.
 * The terms that are linear in the rates have no part in the change. */
TEST(energy_integral, a_wall_on_the_turning_table) {
    static const char text[] =
        TABLE "scene s { start x = 0.1 [m], x' = 1 [m/s], y' = 0.4 [m/s]\nuntil 0.5 [s] }\n";
    motion m;
    uint64_t overruns;
    double left_over;
    motion_open_text(&m, text, booked);
    TEST_ASSERT_TRUE(m.image->has_integral);
    const double before_J = table_J(&m);
    while (m.kind->events(m.run, &overruns) == 0) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
    }
    const double took_J = before_J - table_J(&m);
    TEST_ASSERT_TRUE(took_J > 0.1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -took_J, of_contact(&m, 0, &left_over));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, left_over);
    TEST_ASSERT_TRUE(of_contact(&m, 1, &left_over) < -1.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, left_over);
    /* without friction, the wall does not change the momentum along it */
    TEST_ASSERT_TRUE(of_contact(&m, 2, &left_over) == 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, left_over);
    motion_to(&m, 0.5);
    of_contact(&m, 0, &left_over);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, left_over);
    motion_close(&m);
}

static image *image_of(const char *text, derived *d) {
    *d = derived_text(text);
    TEST_ASSERT_NOT_NULL_MESSAGE(d->equations, d->errors);
    diags *errors = diags_new();
    d->instance->ledger = true;
    image *p = image_make(d->equations, NULL, &plainly, IMAGE_TO_RUN, errors);
    TEST_ASSERT_TRUE((p == NULL) == (diags_count(errors) > 0));
    diags_free(errors);
    return p;
}

/* If T is not quadratic in a body's rates, an impulse is not mass times change of speed. Stops of such bodies are
 * refused; other stops are not. */
TEST(energy_integral, impacts_of_fast_bodies_are_refused) {
    static const struct {
        const char *text;
        bool kept;
    } all[] = {{FAST "stop x <= 0.3 [m] restitution 0.5\n", false},
               {FAST "hold x while x > 0.3 [m]\n", false},
               {FAST "friction x static 0.2 kinetic 0.1 normal 1 [N]\n", true},
               {FAST, true},
               {SLOT "stop x <= 0.3 [m] restitution 0.5\n", true}};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        derived d;
        image *p = image_of(all[i].text, &d);
        TEST_ASSERT_TRUE_MESSAGE((p != NULL) == all[i].kept, all[i].text);
        image_free(p);
        derived_free(&d);
    }
}

/* The hoop's rate w is an input that changes after every step, as with a joystick. The energy balance must have only
 * one entry: a change from w1 to w2 adds -m R^2 sin^2(th) (w2^2 - w1^2)/2. */
static void change_the_hoop(const char *text, bool stops) {
    motion m;
    double w = 10.0;
    double gave_J = 0.0;
    motion_open_text(&m, text, booked);
    const image_ledger *l = &m.image->ledger;
    TEST_ASSERT_EQUAL_INT(1, l->inputs);
    double *total = calloc((size_t)(l->entries + l->accounts), sizeof *total);
    TEST_ASSERT_NOT_NULL(total);
    const double start_J = hoop_J(&m, w);
    for (int step = 0; step < 1000; step++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double next = 10.0 + 3.0 * sin(0.02 * step);
        gave_J -= 0.002 * square(sin(motion_value(&m, "th"))) * (next * next - w * w);
        m.kind->set_input(m.run, 0, next); /* input 1 belongs to a motor that stands still */
        w = next;
    }
    /* the next step enters the effect of the last change */
    m.kind->ledger(m.run, total, total + l->entries);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, total[l->entries]);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
    m.kind->ledger(m.run, total, total + l->entries);
    TEST_ASSERT_TRUE(fabs(gave_J) > 1e-3);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, gave_J, total[l->entries - 1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, total[l->entries]);
    const double took_J = stops ? total[l->smooth] : 0.0;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, gave_J + took_J, hoop_J(&m, w) - start_J);
    TEST_ASSERT_TRUE((took_J < -1e-3) == stops);
    free(total);
    motion_close(&m);
}

TEST(energy_integral, hoop_with_a_changed_input) {
    static const char run[] = "scene s { start th = 0.1\nuntil 2 [s] }\n";
    char text[1000];
    for (int stops = 0; stops < 2; stops++) {
        snprintf(text, sizeof text, "%s%s%s",
                 HOOP("input w = 10 [rad/s]") "input M = 0 [N*m]\nQ(th) = M\n",
                 stops != 0 ? "stop th <= 0.8 restitution 0.5\n" : "", run);
        change_the_hoop(text, stops != 0);
    }
}

/* The stiffnesses of two springs are inputs. A change from k1 to k2 adds (k2 - k1) x^2/2 to the spring's entry. A
 * change before a refused step must not be lost. */
TEST(energy_integral, springs_whose_rates_are_changed) {
    static const char text[] =
        "mechanism springs\ncoordinate x [m]\ncoordinate y [m]\ninput a = 9 [N/m]\n"
        "input push = 0 [N]\ninput b = 4 [N/m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
        "V = a*x^2/2 + b*y^2/2\nQ(x) = push\nscene s { start x = 1 [m], y = 0.5 [m]\nuntil 1 [s] }\n";
    motion m;
    motion_open_text(&m, text, booked);
    const image_ledger *l = &m.image->ledger;
    TEST_ASSERT_FALSE(m.image->has_integral);
    TEST_ASSERT_EQUAL_INT(2, l->inputs);
    double *total = calloc((size_t)(l->entries + l->accounts), sizeof *total);
    TEST_ASSERT_NOT_NULL(total);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 300));
    const double x_J = square(motion_value(&m, "x")) / 2.0;
    const double y_J = square(motion_value(&m, "y")) / 2.0;
    m.kind->set_input(m.run, 0, 30.0);
    m.kind->set_input(m.run, 2, (double)NAN);
    TEST_ASSERT_EQUAL_INT(WH_E_DIVERGED, motion_step(&m, 1));
    m.kind->set_input(m.run, 2, 1.0);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 300));
    m.kind->ledger(m.run, total, total + l->entries);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 21.0 * x_J, total[l->entries - 2]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, -3.0 * y_J, total[l->entries - 1]);
    TEST_ASSERT_TRUE(x_J > 1e-3 && y_J > 1e-3);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, total[l->entries]);
    free(total);
    motion_close(&m);
}

TEST(energy_integral, both_energies_at_both_ends) {
    dice d = dice_of("energy_integral", 41);
    for (int i = 0; i < 20; i++) {
        const double k = dice_between(&d, 1.0, 20.0);
        const double mass[2] = {dice_between(&d, 0.5, 3.0), dice_between(&d, 0.5, 3.0)};
        char text[600];
        motion m;
        snprintf(
            text, sizeof text,
            "mechanism two\ncoordinate x [m]\ncoordinate y [m]\nparameter k = %.17g [N/m]\n"
            "T = %.17g [kg]*x'^2/2 + %.17g [kg]*y'^2/2\nV = k*(x - y)^2/2 + k*x^2\n"
            "scene s { start x = %.17g [m], x' = %.17g [m/s], y' = %.17g [m/s]\nuntil 1 [s] }\n",
            k, mass[0], mass[1], dice_between(&d, -1.0, 1.0), dice_between(&d, -3.0, 3.0),
            dice_between(&d, -3.0, 3.0));
        motion_open_text(&m, text, booked);
        books *b = books_open(m.image);
        double kinetic_J[2];
        double stored_J[2];
        for (int end = 0; end < 2; end++) {
            const double x = motion_value(&m, "x");
            const double y = motion_value(&m, "y");
            books_enter(b, m.kind, m.run);
            kinetic_J[end] = (mass[0] * square(motion_value(&m, "x'")) +
                              mass[1] * square(motion_value(&m, "y'"))) /
                             2.0;
            stored_J[end] = k * square(x - y) / 2.0 + k * square(x);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, end == 0 ? 300 : 1));
        }
        for (int end = 0; end < 2; end++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, kinetic_J[end], b->kinetic_J[end]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, stored_J[end], b->stored_J[end]);
        }
        books_close(b);
        motion_close(&m);
    }
}

static int check_plain(const scene *s) {
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    TEST_ASSERT_FALSE_MESSAGE(d.image->has_integral, s->name);
    derived_free(&d);
    return 1;
}

/* The summary must name the energy integral beside T and V only if it differs from T + V. */
static void expect_told(const image *im) {
    char *text;
    size_t length;
    void *run = engine_double.start(im);
    books *b = books_open(im);
    for (int step = 0; step < 3; step++) {
        books_enter(b, &engine_double, run);
        TEST_ASSERT_EQUAL_INT(WH_OK, (int)engine_double.step(run));
    }
    const energy_residual balance = energy_residual_of(b, &engine_double, run);
    FILE *out = alloc_text(&text, &length);
    books_print(out, b, &balance);
    alloc_text_end(out);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "  kinetic "), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "  stored "), text);
    TEST_ASSERT_TRUE_MESSAGE((strstr(text, "  h = sum") != NULL) == im->has_integral, text);
    free(text);
    books_close(b);
    engine_double.stop(run);
}

/* If T + V of a built-in scene is its energy integral, the balance must be that of T + V. */
TEST(energy_integral, integral_equals_the_energy) {
    static const struct {
        const char *text;
        bool integral;
    } all[] = {{HOOP("parameter w = 0 [rad/s]"), false},
               {HOOP("parameter w = 1e-7 [rad/s]"), true},
               {FIELD, true},
               {"mechanism a\ncoordinate x [m]\nT = 1 [kg]*x'^2/2 + 1 [kg*m/s]*abs(x')\n", true},
               {"mechanism a\ncoordinate x [m]\nT = 1 [kg]*x'^2/2 + 1 [kg*m/s]*x'\n", true},
               {"mechanism a\ncoordinate x [m]\nT = 1 [kg]*x'^2/2 + 3 [J]\n", true},
               {"mechanism a\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1e-11 [kg]*x'^2\n", true},
               {"mechanism a\ncoordinate x [m]\ncoordinate y [m]\ncoordinate a [rad]\n"
                "let v = (x' + y'*cos(a) + 1 [m]*a'*sin(a + x/1 [m]))\n"
                "T = 1 [kg]*(v^2 + x'^2 + y'^2)/2 + 1 [kg*m^2]*a'^2\n"
                "V = 1 [J]*sin(a)*exp(x/1 [m])*sqrt(1 + (y/1 [m])^2)\n",
                false}};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        derived d;
        image *p = image_of(all[i].text, &d);
        TEST_ASSERT_NOT_NULL_MESSAGE(p, all[i].text);
        TEST_ASSERT_TRUE_MESSAGE(p->has_integral == all[i].integral, all[i].text);
        expect_told(p);
        image_free(p);
        derived_free(&d);
    }
    TEST_ASSERT_TRUE(each_builtin_scene(check_plain) > 40);
}
