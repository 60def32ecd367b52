/* test_books.c: the energy balance that the summary of a run prints, compared with closed forms, across impacts. */
#include "host/cli/commands.h"
#include "host/image/program.h"

#include "command.h"
#include "derived.h"
#include "motion.h"

/* === suite account ============================================================================ */

/* The number that follows `words` in the summary. */
static double told(const char *summary, const char *words) {
    const char *at = strstr(summary, words);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, words);
    return strtod(at + strlen(words), NULL);
}

/* A ball with a constant force P bounces in the middle of steps, and a second body slides with damping. The work
 * P (z - h) and the loss of the slide have closed forms. Work, loss and the stop's entry must sum to the change of
 * energy. A ledger that integrated only from one step's end to the next would miss a part of the step with the impact. */
TEST(account, entries_across_impacts_are_closed_forms) {
    dice d = dice_of("pushed bounces", 4005);
    for (unsigned i = 0; i < dice_cases(10); i++) {
        const double e = dice_between(&d, 0.2, 0.95);
        const double height = dice_between(&d, 0.5, 2.0);
        const double push = dice_between(&d, -8.0, 8.0);
        const double damping = dice_between(&d, 0.1, 1.0);
        char text[500];
        said what;
        snprintf(text, sizeof text,
                 "mechanism ball\ncoordinate z [m]\ncoordinate x [m]\ninput P = %.9f [N]\n"
                 "T = 2 [kg]*(z'^2 + x'^2)/2\nV = 2 [kg]*9.81 [m/s^2]*z\nQ(z) = P\n"
                 "F = %.9f [N*s/m]*x'^2/2\nstop z >= 0 restitution %.9f\n"
                 "scene s { start z = %.9f [m], x' = 1.5 [m/s]\nuntil 2 [s] }\n",
                 push, damping, e, height);
        COMMAND_SAY(command_run, &what, model_keep(text));
        TEST_ASSERT_EQUAL_INT(said_owes(what.err), what.status);
        const double work = push * (told(what.out, "\n  z ") - height);
        const double lost = 1.5 * 1.5 * (exp(-2.0 * damping) - 1.0); /* v = 1.5 exp(-b t/m) */
        const double change = told(what.out, "\n  change");
        const double took = told(what.out, "stops, friction, holds and crossings");
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-8, work, told(what.out, "work of inputs"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-8, lost, told(what.out, "\n  losses"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-7, change, work + lost + took, text);
    }
    model_drop();
}

/* === suite ledger_turns ======================================================================= */
/* If the total derivative dG/dt of a function of the coordinates is added to L, the motion stays the same, but each
 * momentum changes by dG/dq, and each dL/dq changes, too. Then the energy balance needs the angles themselves, while
 * the equations need only their sines. Checked by closed forms and by random mechanisms. */

static const stepping booked = {.kind = &engine_double, .method = WH_RK4, .ledger = true};
static const stepping booked_float = {.kind = &engine_float, .method = WH_RK4, .ledger = true};

enum { ENTRIES_MAX = 200 };

typedef struct account_book {
    double total[ENTRIES_MAX];
    double left_over[8]; /* residual of each account */
} account_book;

static account_book read_book(const motion *m) {
    account_book book;
    TEST_ASSERT_TRUE(m->image->ledger.entries <= ENTRIES_MAX);
    TEST_ASSERT_TRUE(m->image->ledger.accounts <= 8);
    m->kind->ledger(m->run, book.total, book.left_over);
    return book;
}

/* The total of the entry for dL/dq, with q the coordinate `name`. */
static double of_energies(const motion *m, const account_book *book, const char *name) {
    const image_ledger *l = &m->image->ledger;
    for (int i = 0; i < l->smooth; i++) {
        const int account = l->entry[i].account;
        if (l->entry[i].kind == LEDGER_ENERGIES && account > 0 &&
            strcmp(m->equations->unknowns[l->unknown[account]].symbol->name, name) == 0) {
            return book->total[i];
        }
    }
    TEST_FAIL_MESSAGE("no such entry");
    return 0.0;
}

/* A random function G of the angles a and b. `rate` is its rate, derived by hand. */
typedef struct gauge {
    char rate[400];
    double factor[3];
    int power[3][2];
} gauge;

static gauge random_gauge(uint64_t *seed) {
    gauge g = {.rate = ""};
    for (int k = 0; k < 3; k++) {
        char line[160];
        const int p = (int)(random_bits(seed) % 4);
        const int q = (int)(random_bits(seed) % 3);
        g.factor[k] = floor(random_between(seed, -20.0, 20.0)) / 8.0;
        g.power[k][0] = p;
        g.power[k][1] = q;
        snprintf(line, sizeof line, " + (%.17g [N*m*s])*(%d*a^%d*b^%d*a' + %d*a^%d*b^%d*b')",
                 g.factor[k], p, p > 0 ? p - 1 : 0, q, q, p, q > 0 ? q - 1 : 0);
        strcat(g.rate, line);
    }
    return g;
}

static void slopes(const gauge *g, double a, double b, double slope[2]) {
    slope[0] = slope[1] = 0.0;
    for (int k = 0; k < 3; k++) {
        const int p = g->power[k][0];
        const int q = g->power[k][1];
        slope[0] += p > 0 ? g->factor[k] * p * pow(a, p - 1) * pow(b, q) : 0.0;
        slope[1] += q > 0 ? g->factor[k] * q * pow(a, p) * pow(b, q - 1) : 0.0;
    }
}

/* Opens a double pendulum with drag, a motor and a stop. The text `rate` is added to L. */
static void open_pendulum(motion *m, const char *rate, stepping how) {
    char text[1500];
    snprintf(text, sizeof text,
             "mechanism pair\ncoordinate a [rad]\ncoordinate b [rad]\ninput M = 1 [N*m]\n"
             "T = 1 [kg*m^2]*(2*a'^2 + b'^2 + 2*a'*b'*cos(a - b))/2%s\n"
             "V = -9 [J]*(2*cos(a) + cos(b))\nF = 0.1 [N*m*s]*(a' - b')^2/2\nQ(a) = M\n"
             "stop sin(a) <= 0.6 restitution 0.5\n"
             "scene s { start a = 0.3, b = -0.4, b' = 9 [rad/s]\nuntil 1 [s] }\n",
             rate);
    motion_open_text(m, text, how);
}

static void compare(const gauge *g, stepping how, double tolerance) {
    motion with;
    motion without;
    double before[2];
    double after[2];
    open_pendulum(&with, g->rate, how);
    open_pendulum(&without, "", how);
    motion_to(&with, 1.0);
    motion_to(&without, 1.0);
    TEST_ASSERT_TRUE(with.kind->hash(with.run) == without.kind->hash(without.run));
    uint64_t overruns;
    TEST_ASSERT_TRUE(with.kind->events(with.run, &overruns) > 0);
    const account_book plain = read_book(&without);
    const account_book book = read_book(&with);
    slopes(g, 0.3, -0.4, before);
    slopes(g, motion_value(&with, "a"), motion_value(&with, "b"), after);
    /* dG/dt in L adds dG/dq to each momentum, and the same amount to the entry for dL/dq */
    const char *const names[] = {"a", "b"};
    for (int i = 0; i < 2; i++) {
        const double size = 1.0 + fabs(after[i]) + fabs(before[i]);
        TEST_ASSERT_DOUBLE_WITHIN(tolerance * size, after[i] - before[i],
                                  of_energies(&with, &book, names[i]) -
                                      of_energies(&without, &plain, names[i]));
        TEST_ASSERT_DOUBLE_WITHIN(tolerance * size, 0.0, book.left_over[1 + i]);
    }
    TEST_ASSERT_DOUBLE_WITHIN(tolerance, 0.0, book.left_over[0]);
    motion_close(&with);
    motion_close(&without);
}

TEST(ledger_turns, total_derivatives_change_no_motion) {
    uint64_t seed = 20110;
    const char *more = getenv("WHIRL_GAUGE_CASES");
    const int cases = more != NULL ? (int)strtol(more, NULL, 10) : 30;
    int turned = 0;
    for (int i = 0; i < cases; i++) {
        const gauge g = random_gauge(&seed);
        compare(&g, booked, 2e-8);
        compare(&g, booked_float, 2e-4);
        motion m;
        open_pendulum(&m, g.rate, booked);
        turned += m.image->ledger.turned;
        motion_close(&m);
    }
    printf("  %d mechanisms from seed 20110, %d with angles outside sines\n", cases, turned);
    TEST_ASSERT_TRUE(turned > cases / 2);
}
