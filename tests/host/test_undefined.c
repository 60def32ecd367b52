/* test_undefined.c: an undefined expression must end the run. In generated mechanisms, one expression of a contact,
 * an energy, a force or an output becomes undefined at a known time. The run must end there with status 1 and name
 * the line and text of the expression. */
#include "command.h"

#include "host/cli/commands.h"

/* The expression that becomes undefined; all others stay defined. */
typedef enum victim {
    GAP,
    CONDITION,
    CONDITION_AND,
    CONDITION_OR,
    HELD,
    CROSSING,
    SETTING,
    NORMAL_STUCK,
    NORMAL_SLIDING,
    STATIC,
    KINETIC,
    RESTITUTION,
    FORCE,
    STORED,
    OUTPUT,
    VICTIMS
} victim;

/* `d` falls through zero at a known time. After that, these forms are undefined. */
static const char *const forms[] = {"sqrt(d)",     "1/(sign(d) + 1)",     "sqrt(sign(d))",
                                    "d^1.5",       "min(2, sqrt(d))",     "max(sqrt(d), 0.25)",
                                    "log(d)",      "asin(1 - min(d, 1))", "acos(2*sqrt(d)/(1 + d))",
                                    "exp(sqrt(d))"};
enum { FORMS = sizeof forms / sizeof forms[0], FORMS_IN_FLOAT = 6 };

typedef struct trial {
    victim victim;
    char text[2048];
    char statement[160]; /* the message must quote it */
    int line;            /* line number of the statement */
    double end_s;        /* time at which the run must end */
    double step_s;
    bool is_float;
    bool is_infinite; /* infinite instead of NaN after end_s, which is seen up to a step later */
    bool ends_later;  /* a restitution is evaluated later, at the hit */
} trial;

/* Writes the statement that contains `form`. `y` is free, at rest or sliding, and has no other events. */
static void state(trial *t, const char *form, dice *d) {
    const double a = dice_between(d, 0.1, 0.9);
    char *s = t->statement;
    const size_t size = sizeof t->statement;
    switch (t->victim) {
    case GAP:
        snprintf(s, size, "stop y + (%s)*u >= -%.3f [m] restitution 0.5", form, 90.0 + a);
        break;
    case CONDITION:
        snprintf(s, size, "hold y while %s > %s%.2f", form, a > 0.5 ? "-9" : "9", a);
        break;
    case CONDITION_AND: snprintf(s, size, "hold y while y > -%.2f [m] and %s > -9", a, form); break;
    case CONDITION_OR: snprintf(s, size, "hold y while %s > 9 or y > %.2f [m]", form, a); break;
    case HELD: snprintf(s, size, "hold y + (%s)*%.2f*u while y > 5 [m]", form, a); break;
    case CROSSING:
        snprintf(s, size, "when %s crosses %.2f rising { set y' = 1 [m/s]", form, 19.0 + a);
        break;
    case SETTING: snprintf(s, size, "set y = (%s)*%.2f*u", form, a); break;
    case NORMAL_STUCK:
    case NORMAL_SLIDING:
        snprintf(s, size, "friction y static 0.4 kinetic 0.3 normal (%s)*%.2f [N]", form, a);
        break;
    case STATIC:
        snprintf(s, size, "friction y static %.2f + %s kinetic 0.05 normal 2 [N]", a, form);
        break;
    case KINETIC:
        snprintf(s, size, "friction y static 5 kinetic %.2f*(%s) normal 1 [N]", a, form);
        break;
    case RESTITUTION:
        snprintf(s, size, "stop x <= c + %.3f [m] restitution abs(cos(%s))*%.2f", 0.05 + a, form,
                 a);
        break;
    case FORCE: snprintf(s, size, "Q(y) = (%s)*%.2f [N]", form, a); break;
    case STORED: snprintf(s, size, "V = (%s)*%.2fe-6 [J]*y/u", form, a); break;
    case OUTPUT: snprintf(s, size, "output odd = %.2f*(%s)", a, form); break;
    case VICTIMS: break;
    }
}

static void make(trial *t, dice *d) {
    const double v = dice_between(d, 0.3, 2.0);
    const double c = dice_between(d, 0.2, 1.5) * v; /* x reaches c after 0.2 to 1.5 s */
    unsigned form = dice_one_of(d, t->is_float ? FORMS_IN_FLOAT : FORMS);
    if (t->victim == CONDITION_AND || t->victim == CONDITION_OR) {
        form += form == 1; /* a condition may compare with infinity */
    } else if (t->victim == HELD && (form == 1 || form == 2 || form == 6)) {
        form = 0; /* a hold uses only the rate, which log(d) has after end_s, too */
    }
    t->is_infinite = form == 1;
    const bool slides = t->victim == NORMAL_SLIDING || t->victim == KINETIC;
    t->step_s = 1e-3 * (1.0 + dice_one_of(d, 5));
    t->end_s = c / v;
    t->ends_later = t->victim == RESTITUTION;
    /* If a name of another line is used, the message must still have the statement's line. */
    const bool named = t->victim != HELD && dice_one_of(d, 2) == 0;
    state(t, named ? "e" : forms[form], d);
    const int blank = (int)dice_one_of(d, 4);
    char around[200];
    if (t->victim == SETTING) { /* a `set` is evaluated at its crossing */
        snprintf(around, sizeof around, "when x crosses c + 0.1 [m] { %s }", t->statement);
        t->end_s = (c + 0.1) / v;
    } else {
        snprintf(around, sizeof around, "%s%s", t->statement, t->victim == CROSSING ? " }" : "");
    }
    snprintf(t->text, sizeof t->text,
             "mechanism trial\n" /* the file's first line */
             "coordinate x [m]\ncoordinate y [m]\n"
             "parameter c = %.9f [m]\nparameter u = 1 [m]\n"
             "let d = (c - x)/u\n"
             "let e = %s\n"
             "T = 1 [kg]*(x'^2 + 2*y'^2)/2\n"
             "%.*s%s\n"
             "scene moves { start x' = %.9f [m/s], y' = %s\n step %.6f [s]\n until 5 [s] }\n",
             c, named ? forms[form] : "1", blank, "\n\n\n\n", around, v, slides ? "30 [m/s]" : "0",
             t->step_s);
    t->line = 9 + blank;
}

/* The number in "... after t = 1.2 s"; -1 if there is none. */
static double time_told(const char *text) {
    const char *at = strstr(text, "t = ");
    return at != NULL ? strtod(at + 4, NULL) : -1.0;
}

static void check(const trial *t, const char *file) {
    const char *words[] = {file, "--csv", "/dev/null", "--number", t->is_float ? "float" : "double",
                           NULL};
    said what;
    char place[80];
    char note[4096];
    command_say(command_run, words, &what);
    snprintf(note, sizeof note, "case %d, %s\n%.2000s\n%.1000s", (int)t->victim, words[4], t->text,
             what.err);
    snprintf(place, sizeof place, "%s:%d:", file, t->line);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, note);
    TEST_ASSERT_TRUE_MESSAGE(strncmp(what.err, place, strlen(place)) == 0, note);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "is not a finite number"), note);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, t->statement), note);
    /* the reported step may begin up to one step early; an output is evaluated at the end of the step */
    const double late_s = time_told(what.err) - t->end_s;
    const double most = t->ends_later                           ? 5.0
                        : t->victim == OUTPUT || t->is_infinite ? 1.01 * t->step_s
                                                                : 1e-3 * t->step_s;
    const double rounding_s = t->is_float ? 1e-3 : 0.0; /* round-off of x in float */
    TEST_ASSERT_TRUE_MESSAGE(
        late_s <= most + rounding_s && late_s >= -1.01 * t->step_s - rounding_s, note);
}

TEST(undefined, expressions_that_stop_being_numbers) {
    dice d = dice_of("undefined", 20261);
    const unsigned rounds = dice_cases(usual_or(6, 1));
    unsigned tried = 0;
    for (unsigned i = 0; i < rounds; i++) {
        for (victim v = 0; v < VICTIMS; v++) {
            /* runs in float and double, or in one of them */
            for (unsigned k = 0; k < usual_or(2, 1); k++) {
                trial t = {.victim = v, .is_float = (usual_or(0, 1) * v + k) % 2U == 1U};
                make(&t, &d);
                check(&t, model_keep(t.text));
                tried++;
            }
        }
    }
    model_drop();
    printf("  %u runs ended with the expression's name\n", tried);
}

/* The same mechanisms must give no message if they end before that time. */
TEST(undefined, expressions_that_are_numbers_throughout) {
    dice d = dice_of("defined", 20262);
    const unsigned rounds = dice_cases(usual_or(3, 1));
    for (unsigned i = 0; i < rounds; i++) {
        for (victim v = 0; v < VICTIMS; v++) {
            trial t = {.victim = v, .is_float = i % 2 == 1};
            char until[40];
            said what;
            make(&t, &d);
            snprintf(until, sizeof until, "%.6f", 0.9 * t.end_s - 0.1);
            if (0.9 * t.end_s - 0.1 > t.step_s) {
                COMMAND_SAY(command_run, &what, model_keep(t.text), "--until", until, "--number",
                            t.is_float ? "float" : "double", "--csv", "/dev/null");
                TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, t.text);
                TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "error"), t.text);
            }
        }
    }
    model_drop();
}

/* A stop ends the motion at the place where an expression becomes undefined. The step evaluates the expression
 * beyond that place, but the motion does not go there. */
TEST(undefined, expressions_that_end_at_a_stop) {
    static const char *const effects[] = {"hold y while sqrt(x/u) > 9",
                                          "when sqrt(x/u) crosses 9 { set y = 1 [m] }",
                                          "stop y + u*sqrt(x/u) >= -9 [m] restitution 0"};
    for (unsigned i = 0; i < 6; i += usual_or(1, 2)) {
        char text[600];
        said what;
        snprintf(text, sizeof text,
                 "mechanism ends\ncoordinate x [m]\ncoordinate y [m]\nparameter u = 1 [m]\n"
                 "T = 1 [kg]*(x'^2 + y'^2)/2\nV = 9.81 [N]*x\nstop x >= 0 restitution 0.8\n%s\n"
                 "scene s { start x = 1 [m]\n until 4 [s] }\n",
                 effects[i % 3]);
        COMMAND_SAY(command_run, &what, model_keep(text), "--number", i < 3 ? "double" : "float");
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    }
    model_drop();
}

TEST(undefined, accelerations_that_are_no_numbers) {
    static const char *const terms[] = {"V = 1 [J]*log(x/u)", "V = 1 [J]*u/x",
                                        "Q(x) = 1 [N]*sqrt(x/u - 1)", "F = 1 [N*s/m]*x'^2/(x/u)",
                                        "V = 1 [J]*sqrt(x/u)"};
    for (size_t i = 0; i < sizeof terms / sizeof terms[0]; i++) {
        char text[300];
        said what;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nparameter u = 1 [m]\nT = 1 [kg]*x'^2/2\n%s\n",
                 terms[i]);
        COMMAND_SAY(command_accel, &what, model_keep(text), "x=0", "x'=1");
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, terms[i]);
        TEST_ASSERT_EQUAL_STRING("", what.out);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, ":5:"), what.err);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, terms[i]), what.err);
        COMMAND_SAY(command_accel, &what, model_keep(text), "x=2", "x'=1");
        TEST_ASSERT_EQUAL_INT(said_owes(what.err), what.status);
    }
    model_drop();
}

/* A step over a pole leaves the force defined and the energy undefined. The energy balance must report this. */
TEST(undefined, energies_that_are_no_numbers) {
    dice d = dice_of("energies", 20263);
    for (unsigned i = 0; i < dice_cases(usual_or(10, 4)); i++) {
        char text[400];
        said what;
        char when[60];
        const double h = 1e-6 * floor(dice_between(&d, 1e2, 1e4));
        const unsigned before = i % 4U; /* number of steps before the pole */
        const double v = dice_between(&d, 5.0, 20.0) / sqrt(h);
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nparameter u = 1 [m]\nT = 1 [kg]*x'^2/2\n"
                 "V = -1e-3 [J]*log(x/u)\nscene s { start x = %.9f [m], x' = -%.9f [m/s]\n"
                 "step %.9f [s]\nuntil 1 [s] }\n",
                 (before + 0.7) * v * h, v, h);
        snprintf(when, sizeof when, "error: at t = %.9g s the stored energy ", (before + 1.0) * h);
        for (int quiet = 0; quiet < 2; quiet++) {
            COMMAND_SAY(command_run, &what, model_keep(text), quiet != 0 ? "--quiet" : NULL);
            TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, text);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, ":5:"), what.err);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, when), what.err);
            TEST_ASSERT_NOT_NULL(
                strstr(what.err, "the stored energy is not a finite number: V = -1e-3 [J]*log"));
            TEST_ASSERT_TRUE(quiet != 0 || strstr(what.out, "no balance") != NULL);
        }
    }
    model_drop();
}

TEST(undefined, angles_out_of_range) {
    static const struct {
        const char *number, *start;
        int status;
        const char *says;
    } rows[] = {{"float", "th'=0", 2, ":5:17: error: 'th' starts at 7e+09 rad"},
                {"float", "th=-6.3e9", 2, "<command line>:1:1: error: 'th' starts at -6.3e+09"},
                {"float", "th=6.2e9", 0, ""},
                {"double", "th=5.1e8", 1,
                 "() of 5.1e+08 rad, but sine and cosine are computed only up to 5e+08"}};
    const char *file =
        model_keep("mechanism m\ncoordinate th [rad]\nT = 1 [kg*m^2]*th'^2/2\nV = 1 [J]*cos(th)\n"
                   "scene s { start th = 7e9\n until 1 [s] }\n");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        said what;
        COMMAND_SAY(command_run, &what, file, "--number", rows[i].number, "--start", rows[i].start);
        TEST_ASSERT_EQUAL_INT_MESSAGE(rows[i].status > 0 ? rows[i].status : said_owes(what.err),
                                      what.status, what.err);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, rows[i].says), what.err);
    }
    model_drop();
}
