/* test_command_changes.c: values that commands change. A name that is given twice is refused; a measure that
 * overflows fails. */
#include "command.h"

#include "host/cli/commands.h"

static const char model[] =
    "mechanism m\ncoordinate th [deg]\ncoordinate x [mm]\nparameter b = 2 [kg]\n"
    "input M = 3 [N*m]\nT = 1 [kg*m^2]*th'^2/2 + b*x'^2/2\n"
    "V = 5 [N*m]*th^2/2 + 700 [N/m]*x^2/2\nQ(th) = M\n"
    "scene s { start th = 0.1 [rad]\nuntil 50 [ms] }\n";

/* How a command takes a change: as the value of --set or --start or, for `accel`, as a bare word. */
typedef struct way {
    const char *name;
    int (*command)(int count, char **words);
    const char *more[2];
    bool bare;
} way;

static const way ways[] = {{"accel", command_accel, {NULL}, true},
                           {"run", command_run, {"--quiet", NULL}, false},
                           {"derive", command_derive, {NULL}, false},
                           {"sweep", command_sweep, {"--over", "step=1..2 [ms]:2"}, false}};
enum { WAYS = sizeof ways / sizeof ways[0] };

static void tell(const way *w, const char *const *changes, int count, said *what) {
    const char *words[24] = {model_keep(model)};
    int used = 1;
    for (int k = 0; k < 2 && w->more[k] != NULL; k++) {
        words[used++] = w->more[k];
    }
    for (int i = 0; i < count; i++) {
        if (!w->bare) {
            words[used++] = changes[i][0] == 't' || changes[i][0] == 'x' ? "--start" : "--set";
        }
        words[used++] = changes[i];
    }
    words[used] = NULL;
    command_say(w->command, words, what);
}

TEST(command_changes, repeated_names_are_refused) {
    static const char *const names[] = {"th", "th'", "x", "x'", "b", "M"};
    static const char *const units[] = {"rad", "rad/s", "m", "m/s", "kg", "N*m"};
    enum { NAMES = sizeof names / sizeof names[0] };
    dice d = dice_of("twice", 4301);
    for (int w = 0; w < WAYS; w++) {
        for (int i = 0; i < NAMES; i++) {
            char text[NAMES + 1][40];
            const char *changes[NAMES + 1];
            char wanted[80];
            said what;
            for (int k = 0; k < NAMES; k++) { /* all names once, which must be accepted */
                snprintf(text[k], sizeof text[k], "%s=%.3f %s", names[k],
                         dice_between(&d, 0.1, 1.0), units[k]);
                changes[k] = text[k];
            }
            tell(&ways[w], changes, NAMES, &what);
            TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
            /* gives one name a second time, with the same value or another */
            const bool same = dice_one_of(&d, 2) == 0;
            snprintf(text[NAMES], sizeof text[NAMES], "%s = %s%s", names[i],
                     same ? strchr(text[i], '=') + 1 : "7 ", same ? "" : units[i]);
            changes[NAMES] = text[NAMES];
            tell(&ways[w], changes, NAMES + 1, &what);
            snprintf(wanted, sizeof wanted, "<command line>:1:1: error: '%s' is given twice",
                     names[i]);
            TEST_ASSERT_EQUAL_INT_MESSAGE(2, what.status, wanted);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, wanted), what.err);
            TEST_ASSERT_EQUAL_STRING("", what.out);
        }
    }
    model_drop();
}

/* A measure of finite samples can overflow. If the same samples are made small enough, the measure is a number. */
TEST(command_changes, measures_that_overflow_fail_their_points) {
    static const struct {
        const char *measure; /* a measure of x, which swings between -1 and 1 */
        double most;         /* the measure of factor * 1e308 * x is finite up to this factor */
        double least;        /* the measure is infinite from this factor on */
    } cases[] = {{"mean", 1e-8, 0.1}, {"amplitude", 0.8, 1.5}, {"period", 1e-8, 1.5}};
    dice d = dice_of("overflows", 4302);
    for (unsigned i = 0; i < 30; i++) {
        const unsigned which = i % 3;
        const bool fails = i / 3 % 2 == 0;
        const double factor = fails ? dice_between(&d, cases[which].least, 1.7)
                                    : dice_between(&d, 0.0, cases[which].most);
        char measure[80];
        said what;
        /* for the mean, the square of x: all samples have one sign, so their sum overflows */
        snprintf(measure, sizeof measure, "%s(%.9e*%s)", cases[which].measure, 1e308 * factor,
                 which == 0 ? "(x/1 [m])^2" : "x/1 [m]");
        COMMAND_SAY(command_sweep, &what, model_keep(model), "--over", "M=1..2 [N*m]:2", "--start",
                    "x=1 [m]", "--step", "0.1ms", "--set", "b=0.0003 [kg]", "--measure", measure,
                    "--measure", "x");
        TEST_ASSERT_EQUAL_INT_MESSAGE(fails ? 1 : 0, what.status, measure);
        TEST_ASSERT_NULL_MESSAGE(strstr(strchr(what.out, '\n'), "nan"), what.out);
        TEST_ASSERT_NULL_MESSAGE(strstr(what.out, "inf"), what.out);
        TEST_ASSERT_TRUE_MESSAGE((strstr(what.out, "\n1,,,\r\n2,,,\r\n") != NULL) == fails,
                                 what.out);
        TEST_ASSERT_TRUE_MESSAGE((strstr(what.err, "' is not a finite number") != NULL) == fails,
                                 what.err);
    }
    model_drop();
}
