/* test_apart.c: holds that close a linkage and are not satisfied at the start (host/check/apart.h). For random
 * four-bar linkages, a wrong length and a wrong angle must both be reported with the energy that is lost. The start
 * values that Whirl proposes must satisfy the holds. */
#include "command.h"
#include "host/check/apart.h"
#include "motion.h"

enum { TEXT = 3000 };

typedef struct bars {
    double length_m[3];
    double inertia[3];
    double angle_rad[3];
    double rate[3];
    double at_m[2];    /* position of the last joint */
    double turned_rad; /* error of angle b at the start */
} bars;

static bars bars_draw(dice *d, bool off) {
    bars b = {.turned_rad = 0.0};
    double sine;
    do {
        for (int i = 0; i < 3; i++) {
            b.length_m[i] = dice_between(d, 0.1, 0.5);
            b.inertia[i] = dice_between(d, 0.01, 0.1);
            b.angle_rad[i] = dice_between(d, -3.0, 3.0);
        }
        sine = sin(b.angle_rad[1] - b.angle_rad[2]);
    } while (fabs(sine) < 0.4);
    b.rate[0] = dice_between(d, 2.0, 20.0);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            const double part = k == 0 ? cos(b.angle_rad[i]) : sin(b.angle_rad[i]);
            b.at_m[k] += (i < 2 ? 1.0 : -1.0) * b.length_m[i] * part;
        }
    }
    b.turned_rad = off ? 0.005 * exp(dice_between(d, 0.0, 4.4)) : 0.0; /* 0.005 to 0.4 rad */
    return b;
}

static void write(const bars *b, const char *start, char text[TEXT]) {
    snprintf(
        text, TEXT,
        "mechanism bars\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate c [rad]\n"
        "T = %.17g [kg*m^2]*a'^2/2 + %.17g [kg*m^2]*b'^2/2 + %.17g [kg*m^2]*c'^2/2\n"
        "hold %.17g [m]*cos(a) + %.17g [m]*cos(b) - %.17g [m]*cos(c) - %.17g [m] while 1 > 0\n"
        "hold %.17g [m]*sin(a) + %.17g [m]*sin(b) - %.17g [m]*sin(c) - %.17g [m] while 1 > 0\n"
        "scene s {\nstart a = %.17g [rad], b = %.17g [rad], c = %.17g [rad], a' = %.17g [rad/s]\n"
        "%sstep 1 [us]\nuntil 10 [us]\n}\n",
        b->inertia[0], b->inertia[1], b->inertia[2], b->length_m[0], b->length_m[1], b->length_m[2],
        b->at_m[0], b->length_m[0], b->length_m[1], b->length_m[2], b->at_m[1], b->angle_rad[0],
        b->angle_rad[1] + b->turned_rad, b->angle_rad[2], b->rate[0], start);
}

static double kinetic_J(const bars *b, const motion *m) {
    static const char *const names[] = {"a'", "b'", "c'"};
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        sum += 0.5 * b->inertia[i] * motion_value(m, names[i]) * motion_value(m, names[i]);
    }
    return sum;
}

static double gap_m(const bars *b, const motion *m, int across) {
    static const char *const names[] = {"a", "b", "c"};
    double sum = -b->at_m[across];
    for (int i = 0; i < 3; i++) {
        const double angle_rad = motion_value(m, names[i]);
        sum += (i < 2 ? 1.0 : -1.0) * b->length_m[i] * (across ? sin(angle_rad) : cos(angle_rad));
    }
    return sum;
}

static char *said_of(motion *m, const char *text) {
    char *told = NULL;
    size_t size = 0;
    motion_open_text(m, text, IN_DOUBLE);
    FILE *out = open_memstream(&told, &size);
    apart_say(out, "whirl run", m->image);
    fclose(out);
    return told;
}

TEST(apart, four_bars) {
    dice d = dice_of("apart", 1);
    const unsigned cases = dice_cases(40);
    for (unsigned k = 0; k < cases; k++) {
        char text[TEXT];
        motion m;
        const bars b = bars_draw(&d, k % 2 == 0);
        write(&b, "", text);
        char *told = said_of(&m, text);
        TEST_ASSERT_EQUAL_MESSAGE(k % 2 == 0, strstr(told, "with an error of") != NULL, text);
        const char *takes = strstr(told, "and removes ");
        TEST_ASSERT_NOT_NULL_MESSAGE(takes, text);
        const double from_J = kinetic_J(&b, &m);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double lost_J = from_J - kinetic_J(&b, &m);
        const double told_J = strtod(takes + strlen("and removes "), NULL);
        TEST_ASSERT_TRUE_MESSAGE(fabs(told_J - lost_J) <= 1e-4 * from_J, text);
        motion_close(&m);
        /* runs again with the proposed values in place of the scene's own */
        char *values = strstr(told, "write: start ");
        TEST_ASSERT_TRUE_MESSAGE(values != NULL || b.turned_rad > 0.05, text);
        if (values == NULL) {
            TEST_ASSERT_NOT_NULL_MESSAGE(
                strstr(told, "Whirl found none near these that satisfy the holds"), text);
            free(told);
            continue;
        }
        values += strlen("write: ");
        strchr(values, '\n')[1] = '\0';
        char *own = strstr(text, "start a =");
        char *rest = strchr(own, '\n') + 1;
        char fitting[TEXT];
        snprintf(fitting, sizeof fitting, "%.*s%s%s", (int)(own - text), text, values, rest);
        char *again = said_of(&m, fitting);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", again, fitting);
        const double fits_J = kinetic_J(&b, &m);
        for (int i = 0; i < 2; i++) {
            TEST_ASSERT_TRUE_MESSAGE(fabs(gap_m(&b, &m, i)) < 1e-8, fitting);
        }
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_TRUE_MESSAGE(fabs(fits_J - kinetic_J(&b, &m)) < 1e-4 * fits_J, fitting);
        motion_close(&m);
        free(again);
        free(told);
    }
}

/* A rod whose length the file does not give has the length that it has at the start, so any start is possible. If
 * the file gives the length, a start with another length is reported. */
TEST(apart, rods) {
    dice d = dice_of("apart", 2);
    const unsigned cases = dice_cases(60);
    for (unsigned k = 0; k < cases; k++) {
        char text[TEXT];
        motion m;
        const double at[4] = {dice_between(&d, -20.0, 20.0), dice_between(&d, -20.0, 20.0),
                              dice_between(&d, -20.0, 20.0), dice_between(&d, -20.0, 20.0)};
        const double rod_m = hypot(at[0] - at[2], at[1] - at[3]);
        const bool own = k % 2 == 0;
        char length[60] = "";
        if (own) {
            snprintf(length, sizeof length, " - %.17g [m]", rod_m * dice_between(&d, 0.75, 0.97));
        }
        snprintf(text, TEXT,
                 "mechanism rod\ncoordinate x [m]\ncoordinate y [m]\ncoordinate u [m]\n"
                 "coordinate v [m]\nT = 1 [kg]*(x'^2 + y'^2 + 2*u'^2 + v'^2)/2\n"
                 "hold sqrt((x - u)^2 + (y - v)^2)%s while 1 > 0\n"
                 "scene s {\nstart x = %.17g [m], y = %.17g [m], u = %.17g [m], v = %.17g [m]\n"
                 "step 1 [ms]\nuntil 1 [s]\n}\n",
                 length, at[0], at[1], at[2], at[3]);
        char *told = said_of(&m, text);
        TEST_ASSERT_EQUAL_MESSAGE(own, strstr(told, "with an error of") != NULL, text);
        TEST_ASSERT_TRUE_MESSAGE(own || told[0] == '\0', text);
        motion_close(&m);
        free(told);
    }
}
