/* test_books_told.c: what `whirl run` says of a run's books at its end, of drawn mechanisms whose coordinates are free, pushed,
 * sprung or damped, each by itself: which momenta are conserved and what they are, and with the ledger what changed each, all
 * by closed form. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/check/books_text.h"
#include "host/cli/commands.h"
#include "unity.h"

void suite_books_told(void);

enum { COORDINATES_MOST = 4 };

typedef enum held_by { FREE, PUSHED, SPRUNG, DAMPED, KINDS } held_by;

typedef struct own_body {
    held_by by;
    double mass_kg;
    double law; /* N, N/m or N s/m */
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

/* The last first, so that their order is nobody's alphabet. */
static char name_of(unsigned i) { return (char)('z' - (int)i); }

/* "V = 2 [N/m]*z^2/2 + 3 [N/m]*y^2/2": all that are held by this, begun by `begins`; nothing for none. */
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

/* m x' at the end, less that at the start. */
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
    const char *words[] = {model_keep(text), more, "ledger", NULL};
    words[2] = more != NULL ? words[2] : NULL;
    command_say(command_run, words, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what->err), what->status, what->err);
}

static void expect_number(const char *text, double wanted, const char *at) {
    double is = 0.0;
    (void)said_number(text, &is);
    TEST_ASSERT_TRUE_MESSAGE(fabs(is - wanted) <= 1e-8 * (1.0 + fabs(wanted)), at);
}

static void test_conserved_momenta(void) {
    dice d = dice_of("books told", 4121);
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
                "\nno coordinate's own momentum is conserved; whirl examine tells of sums and rotations\n") !=
                NULL,
            what.out);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, "energy book [J]\n"), what.out);
    }
    model_drop();
    TEST_ASSERT_TRUE(none > 3U);
}

/* Of each coordinate: what gave to it, what changed, and that over the time. */
static void test_ledgers(void) {
    static const char *const givers[KINDS] = {[FREE] = NULL,
                                              [PUSHED] = "\n  Q(",
                                              [SPRUNG] = "\n  of the energies: dL/d",
                                              [DAMPED] = "\n  F = "};
    dice d = dice_of("ledgers told", 4122);
    for (unsigned k = 0; k < dice_cases(60); k++) {
        const own_bodies m = drawn(&d);
        char text[2500];
        said what;
        mechanism_text(&m, text);
        run(text, "--with", &what);
        TEST_ASSERT_NULL_MESSAGE(strstr(what.out, "conserved"), what.out);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, "energy book [J]\n"), what.out);
        for (unsigned i = 0; i < m.count; i++) {
            char head[60];
            snprintf(head, sizeof head, "\nmomentum book of %c [kg*m/s]\n", name_of(i));
            const char *book = strstr(what.out, head);
            TEST_ASSERT_NOT_NULL_MESSAGE(book, what.out);
            const char *change = strstr(book + 1, "\n  change ");
            const char *force = strstr(book + 1, "\n  change divided by the run's length, along ");
            TEST_ASSERT_TRUE_MESSAGE(change != NULL && force != NULL && change < force, book);
            const double wanted = change_Ns(&m.body[i], m.until_s);
            const char *number = change + strlen("\n  change ");
            expect_number(number + strspn(number, " +"), wanted, book);
            force += strlen("\n  change divided by the run's length, along ");
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

/* --- of books that are made up ----------------------------------------------------------------------------------------*/

/* Every line, whatever is known of it. */
static void test_every_line(void) {
    static const char *const texts[] = {
        "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
        "scene s { step 1 [ms]; until 1 [s] }\n",
        "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
        "stop x >= -1 [m] restitution 0.5\nscene s { step 1 [ms]; until 1 [s] }\n"};
    dice d = dice_of("books_told", 98);
    for (unsigned c = 0; c < dice_cases(usual_or(60, 24)); c++) {
        derived made = derived_scene(texts[c % 2U], "s");
        derived_expect(&made, texts[c % 2U]);
        image *im = made.image;
        char wanted[2000];
        char *is = NULL;
        size_t size = 0;
        books *b = books_open(im);
        const bool integral = dice_one_of(&d, 2) == 0;
        const bool known = dice_one_of(&d, 3) > 0;
        im->has_integral = integral;
        for (int k = 0; k < 2; k++) {
            b->kinetic_J[k] = dice_between(&d, 0.0, 9.0);
            b->stored_J[k] = dice_between(&d, -9.0, 9.0);
            b->energy_J[k] = dice_between(&d, -9.0, 9.0);
            b->momentum[k] = dice_between(&d, -9.0, 9.0);
            b->drift[k] = dice_between(&d, 0.0, 1e-3);
            im->unknown[k].conserved = dice_one_of(&d, 2) == 0;
        }
        b->input_J = dice_between(&d, -9.0, 9.0);
        b->loss_J = dice_between(&d, 0.0, 9.0);
        if (dice_one_of(&d, 3) == 0) {
            b->energy_J[1] = (double)NAN;
        }
        const energy_residual balance = {.known = known,
                                         .inputs_J = dice_between(&d, -9.0, 9.0),
                                         .losses_J = dice_between(&d, -9.0, 0.0),
                                         .contacts_J = dice_between(&d, -9.0, 0.0),
                                         .left_J = dice_between(&d, -9.0, 9.0)};
        int at = snprintf(
            wanted, sizeof wanted, "energy book [J]\n  %-44s %.9g -> %.9g\n  %-44s %.9g -> %.9g\n",
            "kinetic", b->kinetic_J[0], b->kinetic_J[1], "stored", b->stored_J[0], b->stored_J[1]);
#define ADD(...) at += snprintf(wanted + at, sizeof wanted - (size_t)at, __VA_ARGS__)
        if (integral) {
            ADD("  %-44s %.9g -> %.9g\n", "booked: h = sum q' dL/dq' - L, not T + V",
                b->energy_J[0], b->energy_J[1]);
        }
        const char *contacts = "impacts, friction, holds and settings";
        const double change_J = b->energy_J[1] - b->energy_J[0];
        if (known) {
            ADD("  %-44s %+.9g\n", "work of inputs", balance.inputs_J);
            ADD("  %-44s %+.9g\n", "losses", balance.losses_J);
            if (im->contacts > 0) {
                ADD("  %-44s %+.9g%s\n", contacts, balance.contacts_J,
                    " (--with ledger says which)");
            }
            ADD("  %-44s %+.9g%s\n", "change", change_J, "");
            ADD("  %-44s %+.2e (numerical)\n", "left over", balance.left_J);
        } else if (isnan(change_J)) {
            ADD("  no balance: the energies are not finite numbers\n");
        } else {
            ADD("  %-44s %+.9g\n", "work of inputs", b->input_J);
            ADD("  %-44s %+.9g\n", "losses", -b->loss_J);
            ADD("  %-44s %+.9g%s\n", contacts, change_J - b->input_J + b->loss_J,
                ", numerical errors with it: how much they are is not known here");
        }
        if (im->unknown[0].conserved || im->unknown[1].conserved) {
            ADD("conserved momentum [SI]\n");
            for (int k = 0; k < 2; k++) {
                if (im->unknown[k].conserved) {
                    ADD("  of %-13s %.9g, drift at most %.2e (numerical)\n", k == 0 ? "x" : "y",
                        b->momentum[k], b->drift[k]);
                }
            }
        } else {
            ADD("no coordinate's own momentum is conserved; whirl examine tells of sums and rotations\n");
        }
#undef ADD
        FILE *out = open_memstream(&is, &size);
        books_print(out, b, &balance);
        fclose(out);
        TEST_ASSERT_EQUAL_STRING(wanted, is);
        free(is);
        books_close(b);
        derived_free(&made);
    }
}

/* Drawn stops, some of which the ball never comes to: these have no line, in no book. */
static void test_contacts_that_gave_nothing(void) {
    dice die = dice_of("books_told", 93);
    enum { STOPS = 4 };
    for (unsigned c = 0; c < dice_cases(4); c++) {
        char text[1200];
        char at[STOPS][40];
        bool reached[STOPS];
        said what;
        int length = snprintf(text, sizeof text,
                              "mechanism ball \"a ball\"\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                              "V = 9.81 [N]*x\n");
        for (int i = 0; i < STOPS; i++) { /* from 1 m on it falls, and hits the highest alone */
            reached[i] = i == (int)(c % STOPS);
            const double below =
                reached[i] ? dice_between(&die, 0.0, 0.5) : dice_between(&die, 2.0, 9.0);
            snprintf(at[i], sizeof at[i], "stop x >= %.9g [m]", -below);
            length += snprintf(text + length, sizeof text - (size_t)length, "%s restitution 0.5\n",
                               at[i]);
        }
        snprintf(text + length, sizeof text - (size_t)length,
                 "scene a {\nwith ledger\nstart x = 1 [m]\nstep 1 [ms]\nuntil 1 [s]\n}\n");
        const char *const words[] = {model_keep(text), NULL};
        command_say(command_run, words, &what);
        model_drop();
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        for (int i = 0; i < STOPS; i++) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(reached[i], strstr(what.out, at[i]) != NULL, what.out);
        }
    }
}

void suite_books_told(void) {
    RUN_TEST(test_conserved_momenta);
    RUN_TEST(test_ledgers);
    RUN_TEST(test_every_line);
    RUN_TEST(test_contacts_that_gave_nothing);
}
