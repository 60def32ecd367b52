/* test_verdict.c: findings and exit statuses of `whirl run` and `whirl sweep` must agree. The status must be 1 after
 * a warning and only then, 0 with --strict=off, and with a limit follow the energy ratio. Random springs, dampers,
 * swings of systems, flights past a pole, fast forces, springs far from the origin, and balls between stops run with
 * fine to useless steps and all methods. For rods that do not fit at the start, `whirl trust` must give the same
 * words. Every kind of finding must occur, and many runs must have none. */
#include "test.h"

#include <glob.h>

#include "command.h"
#include "derived.h"
#include "host/base/alloc.h"
#include "host/check/run_checks.h"
#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/engine/loop.h"
#include "json_check.h"

enum { TEXT = 1200, SHAPES = 8 };

static void draw(dice *d, unsigned shape, char text[TEXT]) {
    const double coarse = pow(10.0, dice_between(d, -2.0, 0.4));
    const double until = coarse * (10.0 + dice_one_of(d, 200));
    switch (shape) {
    case 0:
        snprintf(
            text, TEXT,
            "mechanism m\ncoordinate x [m]\nparameter p = 1\nT = 1 [kg]*x'^2/2\n"
            "V = 1 [N/m]*x^2/2\nscene s { start x = 1 [m]\nstep %.12g [s]\nuntil %.12g [s] }\n",
            coarse, until);
        break;
    case 1: /* a run whose power is badly integrated */
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate x [m]\nparameter p = 1\nT = 1 [kg]*x'^2/2\n"
                 "F = 1 [N*s/m]*x'^2/2\n"
                 "scene s { start x' = 1 [m/s]\nstep %.12g [s]\nuntil %.12g [s] }\n",
                 coarse, until);
        break;
    case 2:
        snprintf(text, TEXT,
                 "mechanism m\nstate a [m]\nstate b [m/s]\nparameter p = 1\nequation a' = b\n"
                 "equation b' = -1 [1/s^2]*a\n"
                 "scene s { start a = 1 [m]\nstep %.12g [s]\nuntil %.12g [s] }\n",
                 coarse, until);
        break;
    case 3: { /* a straight motion past the origin, in polar coordinates */
        const double past = pow(10.0, dice_between(d, -4.0, -0.5));
        const double r = sqrt(1.0 + past * past);
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate r [m]\ncoordinate phi [rad]\nparameter p = 1\n"
                 "T = 1 [kg]*(r'^2 + r^2*phi'^2)/2\n"
                 "scene s { start r = %.15g [m], phi = 0, r' = %.15g [m/s], phi' = %.15g [rad/s]\n"
                 "step 1 [ms]\nuntil 0.5 [s] }\n",
                 r, -4.0 / r, 4.0 * past / (r * r));
        break;
    }
    case 4: /* a driven spring, up to 900 periods in a step */
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate x [m]\ncoordinate y [rad]\nparameter p = 1\n"
                 "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*y'^2/2\nV = 1 [N/m]*x^2/2\nQ(x) = 1 [N]*cos(y)\n"
                 "scene s { start x = 1 [m], y' = %.12g [rad/s]\nstep 10 [ms]\nuntil 5 [s] }\n",
                 pow(10.0, dice_between(d, 0.0, 5.0)));
        break;
    case 5: /* a spring far from the origin */
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate x [m]\nparameter p = 1\nparameter D = %.12g [m]\n"
                 "T = 1 [kg]*x'^2/2\nV = 100 [N/m]*(x - D)^2/2\n"
                 "scene s { start x = D + 1 [m]\nstep 1 [ms]\nuntil 1 [s] }\n",
                 pow(10.0, dice_between(d, 0.0, 7.0)));
        break;
    case 6: /* an elastic ball between stops */
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate x [m]\nparameter p = 1\nT = 1 [kg]*x'^2/2\n"
                 "stop x >= 0 [m] restitution 1\nstop x <= 1 [mm] restitution 1\n"
                 "scene s { start x = 0.5 [mm], x' = %.12g [m/s]\nstep 1 [ms]\nuntil 50 [ms] }\n",
                 pow(10.0, dice_between(d, 0.0, 1.7)));
        break;
    case 7: {
        /* a pendulum on a rod of right or wrong length, with a speed along the rod or across it */
        const double rod_m = dice_between(d, 0.2, 3.0);
        const double angle_rad = dice_between(d, -3.0, 3.0);
        const double at_m = rod_m * (dice_one_of(d, 2) == 0 ? 1.0 : dice_between(d, 0.8, 1.2));
        const double along = dice_one_of(d, 2) == 0 ? 0.0 : dice_between(d, -1.0, 1.0);
        const double across = dice_between(d, -1.0, 1.0);
        snprintf(
            text, TEXT,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nparameter p = 1\n"
            "T = 1 [kg]*(x'^2 + y'^2)/2\nV = 9.81 [N]*y\n"
            "hold sqrt(x^2 + y^2) - %.17g [m] while 1 > 0\n"
            "scene s { start x = %.17g [m], y = %.17g [m], x' = %.17g [m/s], y' = %.17g [m/s]\n"
            "step 1 [ms]\nuntil 50 [ms] }\n",
            rod_m, at_m * cos(angle_rad), at_m * sin(angle_rad),
            along * cos(angle_rad) - across * sin(angle_rad),
            along * sin(angle_rad) + across * cos(angle_rad));
        break;
    }
    }
}

/* Runs the command with these words and one more. */
static void say_with(const char *more, int (*command)(int, char **), const char *const *words,
                     said *what) {
    int count = 0;
    const char *again[20];
    for (; words[count] != NULL; count++) {
        again[count] = words[count];
    }
    again[count] = more;
    again[count + 1] = NULL;
    command_say(command, again, what);
}

static bool is_failed(const said *what) { return strstr(what->err, ": error: ") != NULL; }

static const char *value_at(const said *what, const char *path) {
    static char value[100];
    TEST_ASSERT_NOT_NULL_MESSAGE(json_value(what->out, path, value), path);
    return value;
}

static void expect_json(int (*command)(int, char **), const char **words, const said *before,
                        const char *list) {
    said what;
    char why[100];
    unsigned in_text = 0;
    say_with("--json", command, words, &what);
    TEST_ASSERT_TRUE_MESSAGE(json_is_valid(what.out, why), why);
    TEST_ASSERT_EQUAL_STRING(before->err, what.err);
    TEST_ASSERT_EQUAL_INT(before->status, what.status);
    TEST_ASSERT_EQUAL_INT(before->status, (int)strtol(value_at(&what, "exit"), NULL, 10));
    const int told = json_length(what.out, list);
    for (int k = 0; k < FINDINGS; k++) {
        char id[20];
        bool is_note = false;
        bool is_row = false;
        snprintf(id, sizeof id, "[%s]", finding_rows[k].word);
        for (int i = 0; i < told; i++) {
            char path[60];
            snprintf(path, sizeof path, "%s/%d/id", list, i);
            if (strcmp(value_at(&what, path), finding_rows[k].word) == 0) {
                is_row = true;
                snprintf(path, sizeof path, "%s/%d/severity", list, i);
                is_note = strcmp(value_at(&what, path), "note") == 0;
                in_text += 1U;
            }
        }
        TEST_ASSERT_TRUE_MESSAGE(is_note || is_row == (strstr(before->err, id) != NULL), what.out);
    }
    TEST_ASSERT_EQUAL_INT(is_failed(before) ? 0 : told, (int)in_text);
}

/* Compares the next field of the CSV with the JSON value at this path. null stands for a field that is empty or not
 * finite. */
static void expect_field(char **at, const said *what, const char *path) {
    char *end = *at + strcspn(*at, ",\r");
    const char behind = *end;
    char *stop;
    *end = '\0';
    const char *value = value_at(what, path);
    const double number = strtod(*at, &stop);
    if (strcmp(value, "null") == 0) {
        TEST_ASSERT_TRUE_MESSAGE(**at == '\0' || !isfinite(number), path);
    } else if (*stop == '\0') {
        TEST_ASSERT_TRUE_MESSAGE(fabs(strtod(value, NULL) - number) <= 1e-14 * fabs(number), path);
    } else {
        TEST_ASSERT_EQUAL_STRING_MESSAGE(*at, value, path);
    }
    *at = behind == '\0' ? end : end + 1;
}

/* The rows of --csv=- must equal those of `list` in the object of --json, and the exit statuses must be equal. */
static void expect_rows(int (*command)(int, char **), const char *const *words, const char *list,
                        const char *const *keys) {
    static said csv;
    static said object;
    char why[100];
    say_with("--json", command, words, &object);
    say_with("--csv=-", command, words, &csv);
    TEST_ASSERT_EQUAL_INT(csv.status, object.status);
    TEST_ASSERT_TRUE_MESSAGE(json_is_valid(object.out, why), object.err);
    TEST_ASSERT_EQUAL_INT(csv.status, (int)strtol(value_at(&object, "exit"), NULL, 10));
    int rows = 0;
    for (char *line = strchr(csv.out, '\n') + 1; *line != '\0'; rows++) {
        char *at = line;
        line += strcspn(line, "\n") + 1;
        for (int k = 0; keys[k] != NULL; k++) {
            char path[80];
            snprintf(path, sizeof path, "%s/%d/%s", list, rows, keys[k]);
            expect_field(&at, &object, path);
        }
    }
    TEST_ASSERT_EQUAL_INT(json_length(object.out, list), rows);
}

/* The JSON text must have the findings, the sentence about the run, and the pairs of a map. */
TEST(verdict, json_of_trust_and_map) {
    static const char *const columns[] = {"name",  "unit", "verdict", "until_s",
                                          "range", "off",  NULL};
    static const char *const pairs[] = {"values/0", "values/1",        "verdict", "until_s",
                                        "end_s",    "energy_residual", NULL};
    dice d = dice_of("json", 15006);
    unsigned told[2] = {0};
    for (unsigned i = 0; i < 4 * SHAPES; i++) {
        char text[TEXT];
        said what;
        draw(&d, i % SHAPES, text);
        const char *file = model_keep(text);
        const char *trust[] = {file, "--quiet", NULL};
        expect_rows(command_trust, trust, "columns", columns);
        command_say(command_trust, trust, &what);
        const char *until = strstr(what.out, "trusted until t = ");
        const bool end = strstr(what.out, "trusted to the end, t = ") != NULL;
        const double said_s = until != NULL ? strtod(until + 18, NULL) : 0.0;
        const bool aliased = strstr(what.out, "the steps alias a fast force") != NULL;
        COMMAND_SAY(command_trust, &what, file, "--quiet", "--json");
        const char *value = value_at(&what, "trusted_until_s");
        if (until != NULL && !aliased) {
            TEST_ASSERT_TRUE(fabs(strtod(value, NULL) - said_s) <= 1e-8 * said_s);
        }
        TEST_ASSERT_TRUE_MESSAGE(!end || strcmp(value, "null") != 0, text);
        told[end] += 1U;
        if (i % SHAPES == 0) {
            const char *map[] = {file, "--quiet", "--over=step=10ms..1s:5,log", "--over=p=1..1:1",
                                 NULL};
            expect_rows(command_map, map, "rows", pairs);
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(told[0] > 1 && told[1] > 1);
}

/* The JSON text of `price` must have its table; that of `choose` must have the command lines of its answers. */
TEST(verdict, json_of_price_and_choose) {
    static const char *const columns[] = {
        "front",       "error",     "error_unit",  "error_basis", "error_bound", "component",
        "price_per_s", "price_of",  "price_basis", "price_least", "price_most",  "step_s",
        "method",      "number",    "angles",      "matrix",      "tables",      "flash_bytes",
        "flash_basis", "ram_bytes", "ram_basis",   "stack_bytes", "stack_basis", "state_bytes",
        "state_basis", "run",       "derive",      NULL};
    const char *price[] = {"two_mass_relative", "--effort=1e5", "--quiet", "--method=rk4", NULL};
    expect_rows(command_price, price, "rows", columns);
    const char *within[] = {"two_mass_relative", "--effort=1e5",  "--quiet",
                            "--method=rk4",      "--error=1e-30", NULL};
    expect_rows(command_price, within, "rows", columns); /* no such row: exit status 1 */
    for (unsigned i = 0; i < 2; i++) {
        static said object;
        said what;
        char why[100];
        const char *words[] = {"two_mass_relative", "--effort=1e7", "--predict",
                               i == 0 ? "--error=1e-4" : "--error=1e-30", NULL};
        command_say(command_choose, words, &what);
        say_with("--json", command_choose, words, &object);
        TEST_ASSERT_EQUAL_INT(i == 0 ? 0 : 1, what.status);
        TEST_ASSERT_EQUAL_INT(what.status, object.status);
        TEST_ASSERT_EQUAL_STRING(what.err, object.err);
        TEST_ASSERT_TRUE_MESSAGE(json_is_valid(object.out, why), why);
        TEST_ASSERT_EQUAL_INT(what.status, (int)strtol(value_at(&object, "exit"), NULL, 10));
        TEST_ASSERT_EQUAL_INT(i == 0 ? 2 : 0, json_length(object.out, "answers"));
        for (int k = 0; k < (i == 0 ? 2 : 0); k++) {
            TEST_ASSERT_NOT_NULL(
                strstr(what.out, value_at(&object, k == 0 ? "answers/0/run" : "answers/1/run")));
        }
    }
}

/* A title with every character that needs an escape. */
TEST(verdict, json_of_a_title) {
    said what;
    char why[100];
    const char *titled[] = {
        model_keep("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                   "output none = sqrt(x/1 [m] - 1)\n"
                   "scene s \"Gr\303\266\303\237e \\ x\" { step 1 [ms]; until 2 [ms] }\n"),
        "--json", NULL};
    command_say(command_run, titled, &what);
    TEST_ASSERT_TRUE_MESSAGE(json_is_valid(what.out, why), why);
    TEST_ASSERT_EQUAL_STRING("Gr\303\266\303\237e \\\\ x", value_at(&what, "title"));
    TEST_ASSERT_EQUAL_STRING("null", value_at(&what, "values/2/value"));
    TEST_ASSERT_EQUAL_INT(1, what.status);
    model_drop();
}

/* The JSON text of a failed run must have the reason that comes first on standard error, and all hints. Other runs must
 * have no reason. In every second run an output is undefined from some time on; the run may fail later. */
TEST(verdict, json_of_failures) {
    dice d = dice_of("json_failed", 29112026);
    for (int i = 0; i < 24; i++) {
        static const char *const ways[] = {
            "V = -%.3g [N/m^3]*x^4", "V = %.3g [J]*sqrt(1 - x/(1 [m]))", "V = %.3g [N/m]*x^2"};
        const bool fails = i % 3 != 2;
        char energy[80];
        said what;
        snprintf(energy, sizeof energy, ways[i % 3], dice_between(&d, 50.0, 90.0)); // NOLINT
        char *text = alloc_words("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n%s\n%s"
                                 "scene s { start x = 0.5 [m], x' = 4 [m/s]; step 1 [ms]; "
                                 "until 2 [s] }\n",
                                 energy, i % 2 == 0 ? "" : "output r [m] = sqrt(1 [m^2] - x^2)\n");
        COMMAND_SAY(command_run, &what, model_keep(text), "--json", "--csv", "/dev/null");
        const char *error = value_at(&what, "error");
        TEST_ASSERT_EQUAL_INT_MESSAGE(fails, strcmp(error, "null") != 0, energy);
        const char *first = strstr(what.err, "error: ");
        TEST_ASSERT_TRUE(!fails || (what.status == 1 && first != NULL &&
                                    strstr(what.err, error) == first + strlen("error: ")));
        int hints = 0;
        for (const char *at = what.err; (at = strstr(at, "hint: ")) != NULL; at++) {
            hints++;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(hints, json_length(what.out, "hints"), what.err);
        model_drop();
        free(text);
    }
}

/* Runs without an option, with --strict=off, and with a random limit. Returns whether a finding gives status 1. */
static bool expect_statuses(dice *d, const char **run, const char **sweep, const said *ran,
                            const said *swept, const char *about) {
    said off[2];
    said limited[2];
    char limit[40];
    snprintf(limit, sizeof limit, "--strict=%.3e", pow(10.0, dice_between(d, -9.0, 0.0)));
    const bool failed = is_failed(ran);
    TEST_ASSERT_EQUAL_INT_MESSAGE(failed ? 1 : said_owes(ran->err), ran->status, about);
    TEST_ASSERT_EQUAL_INT_MESSAGE(ran->status, swept->status, about);
    for (int k = 0; k < 2; k++) {
        const said *what = k == 0 ? ran : swept;
        const size_t same = strlen(k == 0 ? ran->err : swept->err);
        const char *last = strstr(what->err, ": exit status 1 because of [");
        TEST_ASSERT_EQUAL_MESSAGE(!failed && said_owes(what->err) == 1, last != NULL, about);
        const char **words = k == 0 ? run : sweep;
        int (*command)(int, char **) = k == 0 ? command_run : command_sweep;
        say_with("--strict=off", command, words, &off[k]);
        say_with(limit, command, words, &limited[k]);
        TEST_ASSERT_EQUAL_STRING(what->out, off[k].out);
        TEST_ASSERT_EQUAL_STRING(what->out, limited[k].out);
        TEST_ASSERT_EQUAL_INT_MESSAGE(failed ? 1 : 0, off[k].status, about);
        const size_t length = strlen(off[k].err);
        TEST_ASSERT_TRUE_MESSAGE(strncmp(off[k].err, what->err, length) == 0, about);
        TEST_ASSERT_EQUAL_MESSAGE(last == NULL, length == same, about);
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(limited[0].status, limited[1].status, about);
    return !failed && ran->status == 1;
}

TEST(verdict, strict_limits_the_energy_residual) {
    dice d = dice_of("limit", 15005);
    unsigned of[2] = {0};
    for (unsigned i = 0; i < dice_cases(few_or_all(12, 100)); i++) {
        char text[TEXT];
        char limit[40];
        said what;
        draw(&d, 0, text);
        COMMAND_SAY(command_run, &what, model_keep(text));
        const char *at = strstr(what.out, "energy residual ");
        if (at == NULL) {
            continue;
        }
        const double ratio = strtod(at + strlen("energy residual "), NULL);
        const double share = i % 2 == 0 ? 0.9 : 1.1;
        if (!(ratio > 1e-12 && share * ratio < 1.0)) {
            continue;
        }
        snprintf(limit, sizeof limit, "--strict=%.3e", share * ratio);
        COMMAND_SAY(command_run, &what, model_keep(text), limit);
        const char *last = strstr(what.err, "exit status 1 because of");
        const bool energy = last != NULL && strstr(last, "[energy]") != NULL;
        TEST_ASSERT_EQUAL_MESSAGE(share < 1.0, energy, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(last != NULL, what.status, text);
        of[i % 2]++;
    }
    model_drop();
    TEST_ASSERT_TRUE(of[0] > 1 && of[1] > 1);
}

/* A disc with an uneven inertia and a torque of several waves. With coarse tables the finer run must not have the same
 * tables, whether the sweep derives each point (over M) or could share its lists (over a start or the step). */
TEST(verdict, sweeps_find_coarse_tables) {
    dice d = dice_of("tables", 15006);
    unsigned of[2] = {0};
    for (unsigned i = 0; i < dice_cases(few_or_all(12, 60)); i++) {
        char text[TEXT];
        char start[60];
        char torque[60];
        said ran;
        said swept;
        const double rate = dice_between(&d, 1.0, 3.0);
        const double torque_Nm = dice_between(&d, 0.01, 4.0);
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate a [rad]\nparameter M = %.17g [N*m]\n"
                 "T = 1 [kg*m^2]*a'^2/2*(1 + %.3g*cos(a)^2)\nQ(a) = M*sin(%u*a)\n"
                 "scene s { start a' = %.17g [rad/s]; step 5 [ms]; until 2 [s] }\n",
                 torque_Nm, dice_between(&d, 0.1, 0.6), 1U + dice_one_of(&d, 5), rate);
        snprintf(start, sizeof start, "a'=%.17g..%.17g [rad/s]:1", rate, rate);
        snprintf(torque, sizeof torque, "M=%.17g..%.17g [N*m]:1", torque_Nm, torque_Nm);
        const char *const overs[] = {"step=5..5 [ms]:1", start, torque};
        const char *cells = i % 2 == 0 ? "--cells=8" : "--cells=4096";
        COMMAND_SAY(command_run, &ran, model_keep(text), "--quiet", "--tables", "linear", cells);
        COMMAND_SAY(command_sweep, &swept, model_keep(text), "--quiet", "--tables", "linear", cells,
                    "--over", overs[i / 2 % 3]);
        const bool told = strstr(ran.err, "[accuracy]") != NULL;
        TEST_ASSERT_EQUAL_MESSAGE(told, strstr(swept.err, "[accuracy]") != NULL, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(ran.status, swept.status, text);
        of[told]++;
    }
    model_drop();
    printf("  %u tables accurate enough, %u too coarse\n", of[0], of[1]);
    TEST_ASSERT_TRUE(of[0] > 1 && of[1] > 1);
}

TEST(verdict, sweep_points_equal_runs) {
    static const char *const methods[] = {"rk4", "heun", "leapfrog", "semi-implicit-euler",
                                          "nystroem5"};
    dice d = dice_of("verdict", 15004);
    const unsigned cases = dice_cases(few_or_all(32, 320));
    unsigned of[FINDINGS + 1] = {0};
    unsigned not_believed = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[TEXT];
        char about[TEXT + 2 * SAID_SIZE + 100];
        said ran;
        said swept;
        said trusted = {.status = -1};
        bool silent = true;
        const unsigned shape = i % SHAPES;
        draw(&d, shape, text);
        const unsigned method = shape == 0 || shape == 2 ? dice_one_of(&d, shape == 0 ? 5 : 2) : 0;
        const char *file = model_keep(text);
        const char *number = dice_one_of(&d, 2) == 0 ? "double" : "float";
        const char *run[] = {file,       "--quiet", "--method", methods[method],
                             "--number", number,    NULL};
        const char *sweep[] = {file,       "--quiet", "--method", methods[method],
                               "--number", number,    "--over",   "p=1..1:1",
                               "--jobs",   "1",       NULL};
        command_say(command_run, run, &ran);
        command_say(command_sweep, sweep, &swept);
        if (shape == 7) { /* this case does not test other findings */
            COMMAND_SAY(command_trust, &trusted, file, "--quiet", "--number", number);
        }
        snprintf(about, sizeof about, "%s--method %s --number %s\n%s\n%s", text, methods[method],
                 number, ran.err, swept.err);
        expect_json(command_run, run, &ran, "findings");
        expect_json(command_sweep, sweep, &swept, "rows/0/findings");
        not_believed += expect_statuses(&d, run, sweep, &ran, &swept, about) ? 1U : 0U;
        for (int k = 0; k < FINDINGS && !is_failed(&ran); k++) {
            char id[20];
            snprintf(id, sizeof id, "[%s]", finding_rows[k].word);
            const bool told = strstr(ran.err, id) != NULL;
            const bool is_note = finding_rows[k].severity == FINDING_NOTE;
            TEST_ASSERT_TRUE_MESSAGE(is_note || told == (strstr(swept.err, id) != NULL), about);
            TEST_ASSERT_TRUE_MESSAGE(k != FINDING_APART || shape != 7 ||
                                         told == (strstr(trusted.err, id) != NULL),
                                     about);
            of[k] += told ? 1U : 0U;
            silent = silent && !told;
        }
        of[FINDINGS] += silent ? 1U : 0U;
    }
    model_drop();
    printf("  %u runs and points: %u of the energy, %u of the accuracy, %u aliased, %u "
           "of events, %u apart, %u silent; %u with exit status 1\n",
           cases, of[FINDING_ENERGY], of[FINDING_ACCURACY], of[FINDING_ALIASED], of[FINDING_EVENTS],
           of[FINDING_APART], of[FINDINGS], not_believed);
    TEST_ASSERT_TRUE(not_believed > 1 && not_believed < cases);
    TEST_ASSERT_TRUE(of[FINDING_ENERGY] > 1 && of[FINDING_ACCURACY] > 1 && of[FINDINGS] > 1);
    TEST_ASSERT_TRUE(of[FINDING_APART] > 1);
    TEST_ASSERT_TRUE(of[FINDING_ALIASED] + of[FINDING_EVENTS] > 0);
}

/* --- a speed that all bodies share --- */

/* Writes wagons on a line, or discs on a shaft, with springs and perhaps a damper. All move at a common speed. */
static void write_chain(dice d, double speed, char text[TEXT]) {
    const bool turns = dice_one_of(&d, 2) == 0;
    const int count = 2 + (int)dice_one_of(&d, 3);
    const char *unit = turns ? "rad" : "m";
    const double step_s = pow(10.0, dice_between(&d, -3.0, 0.3));
    const double damping = dice_one_of(&d, 3) == 0 ? dice_between(&d, 0.01, 0.3) : 0.0;
    int at = snprintf(text, TEXT, "mechanism m\n");
    for (int i = 0; i < count; i++) {
        at += snprintf(text + at, TEXT - (size_t)at, "coordinate q%d [%s]\n", i, unit);
    }
    for (int i = 0; i < count; i++) {
        at +=
            snprintf(text + at, TEXT - (size_t)at, "%s%.6g [%s]*q%d'^2/2", i == 0 ? "T = " : " + ",
                     dice_between(&d, 0.5, 2.0), turns ? "kg*m^2" : "kg", i);
    }
    for (int i = 1; i < count; i++) {
        at += snprintf(text + at, TEXT - (size_t)at, "%s%.6g [%s]*(q%d - q%d)^2/2",
                       i == 1 ? "\nV = " : " + ", dice_between(&d, 0.5, 2.0), turns ? "N*m" : "N/m",
                       i, i - 1);
    }
    at +=
        snprintf(text + at, TEXT - (size_t)at, "\nF = %.6g [%s]*(q1' - q0')^2/2\nscene s { start ",
                 damping, turns ? "N*m*s" : "N*s/m");
    for (int i = 0; i < count; i++) {
        at += snprintf(text + at, TEXT - (size_t)at, "%sq%d = %.6g [%s], q%d' = %.17g [%s/s]",
                       i > 0 ? ", " : "", i, dice_between(&d, -0.4, 0.4), unit, i, speed, unit);
    }
    snprintf(text + at, TEXT - (size_t)at, "\nstep %.6g [s]\nuntil %.6g [s] }\n", step_s,
             step_s * (20.0 + dice_one_of(&d, 200)));
}

TEST(verdict, common_speed_changes_no_verdict) {
    dice d = dice_of("frames", 4729);
    const unsigned cases = dice_cases(few_or_all(20, 300));
    unsigned told = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[2][TEXT];
        said what[2];
        const dice drawn = d;
        const double speed = pow(10.0, dice_between(&d, -1.0, 2.0));
        for (int k = 0; k < 2; k++) {
            write_chain(drawn, k == 0 ? 0.0 : speed, text[k]);
            const char *words[] = {model_keep(text[k]), "--quiet", "--method",
                                   i % 2 == 0 ? "rk4" : "semi-implicit-euler", NULL};
            command_say(command_run, words, &what[k]);
        }
        for (int k = 0; k < FINDINGS; k++) {
            char id[20];
            snprintf(id, sizeof id, "[%s]", finding_rows[k].word);
            const bool still = strstr(what[0].err, id) != NULL;
            const bool asked =
                k != FINDING_ACCURACY || i % 2 == 0; /* the speed enlarges its range */
            const bool moving = asked ? strstr(what[1].err, id) != NULL : still;
            if (still != moving) {
                printf("%s%s\n%s%s\n", text[0], what[0].err, text[1], what[1].err);
            }
            TEST_ASSERT_EQUAL(still, moving);
            told += still ? 1U : 0U;
        }
    }
    model_drop();
    printf("  %u chains at rest and moving along: %u findings, the same\n", cases, told);
    TEST_ASSERT_TRUE(told > cases / 4);
}

/* --- the cost of the checks --- */

/* Runs `whirl run`, then prints its number of operations on standard error. */
static int run_counted(int count, char **words) {
    const uint64_t before = engine_operations;
    const int status = command_run(count, words);
    fprintf(stderr, "\ncounted %.0f\n", (double)(engine_operations - before));
    return status;
}

static double total; /* largest part of the limit that was used */
static void expect_cost(const char *target, double share) {
    said what;
    char until[40];
    loaded made;
    const mechanism *of;
    const scene *in;
    const overrides changes = {.balance = true};
    const load_request request = {.settings = plainly, .use = IMAGE_TO_RUN, .conserve = true};
    source_model from = {0};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, source_open(&from, target), target);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, source_pick(&from, true, &of, &in), target);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, load(&made, &from, of, in, &changes, &request), target);
    const uint64_t steps = (uint64_t)(share * (double)made.image->steps) + 1U;
    const uint64_t before = engine_operations;
    void *run = engine_double.start(made.image);
    (void)loop_steps(&engine_double, run, steps);
    engine_double.stop(run);
    const double own = (double)(engine_operations - before);
    snprintf(until, sizeof until, "%.15g", ratio_times(steps, made.image->step));
    unload(&made);
    source_close(&from);
    command_say(run_counted, (const char *[]){target, "--strict=off", "--until", until, NULL},
                &what);
    const char *counted = strstr(what.err, "\ncounted ");
    TEST_ASSERT_NOT_NULL_MESSAGE(counted, target);
    const double all = strtod(counted + 9, NULL);
    const double most = 2.0 * own + BUDGET_LEAST;
    if (all > most) {
        printf("%s until %s s: %.3g operations, %.3g of its steps\n%s", target, until, all, own,
               what.err);
    }
    TEST_ASSERT_TRUE_MESSAGE(all <= most, target);
    total = fmax(total, all / most);
}

static void expect_costs(const char *target) {
    static const double shares[] = {0.1, 0.01, 1.0};
    for (unsigned i = 0; i < few_or_all(1, 3); i++) {
        expect_cost(target, shares[i]);
    }
}

static int built_in(const scene *s) {
    expect_costs(s->name);
    return 1;
}

static int of_files(const char *pattern) {
    glob_t files;
    int scenes = 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, glob(pattern, 0, NULL, &files), pattern);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        source_model from = {0};
        TEST_ASSERT_EQUAL_INT(0, source_open(&from, files.gl_pathv[i]));
        for (int k = 0; k < from.model->scene_count; k++, scenes++) {
            char target[200];
            snprintf(target, sizeof target, "%s:%s", files.gl_pathv[i],
                     from.model->scenes[k]->name);
            expect_costs(target);
        }
        source_close(&from);
    }
    globfree(&files);
    return scenes;
}

/* The checks may take as many operations as twice the run's steps, plus a fixed number. All scenes, built in or in
 * the catalogue, run for 10 % of their time and, with all cases, for 1 and 100 %. */
TEST(verdict, checks_stay_within_their_budget) {
    expect_cost("cuff_equal", 0.004);
    expect_cost("tests/reference/stack.whirl", 0.2);
    expect_cost("tests/reference/stack.whirl", 1.0);
    TEST_ASSERT_TRUE(total > 0.5); /* the stack uses more than half of the limit */
    TEST_ASSERT_TRUE(each_builtin_scene(built_in) > 60);
    TEST_ASSERT_TRUE(of_files("docs/*/*.whirl") + of_files("tests/mechanisms/*.whirl") > 35);
    printf("  looks: at most %.2f of what they may take\n", total);
}

/* A run of many steps leaves no time for the finer run, or for the third run. Then `run`, `sweep` and `trust` must
 * report that the run was not checked. */
TEST(verdict, skipped_checks_are_reported) {
    static const struct {
        const char *until;
        const char *names;
        int count;
    } cases[] = {{"2000", "[aliased]", 1}, {"4000", "[accuracy] [aliased]", 2}};
    const char *file = model_keep("mechanism m\ncoordinate x [m]\nparameter p = 1\n"
                                  "T = 1 [kg]*x'^2/2\nV = 1 [N/m]*x^2/2\n"
                                  "scene s { start x = 1 [m]; step 1 [ms]; until 100 [s] }\n");
    for (unsigned i = 0; i < few_or_all(1, 2); i++) {
        said what;
        char line[100];
        const char *run[] = {file, "--until", cases[i].until, NULL, NULL};
        snprintf(line, sizeof line, "not checked        %s: ", cases[i].names);
        command_say(command_run, run, &what);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, line), what.out);
        run[3] = "--json";
        command_say(command_run, run, &what);
        TEST_ASSERT_EQUAL_INT(cases[i].count, json_length(what.out, "not_looked_at"));
        COMMAND_SAY(command_sweep, &what, file, "--until", cases[i].until, "--over=p=1..1:1",
                    "--json");
        TEST_ASSERT_EQUAL_INT(cases[i].count, json_length(what.out, "rows/0/not_looked_at"));
        snprintf(line, sizeof line, "1 of 1 points were not checked for %s: ", cases[i].names);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, line), what.err);
    }
    said what;
    const char *shorter[] = {file, "--json", NULL};
    command_say(command_run, shorter, &what);
    TEST_ASSERT_EQUAL_INT(0, json_length(what.out, "not_looked_at"));
    command_say(command_trust, shorter, &what);
    TEST_ASSERT_EQUAL_INT(0, json_length(what.out, "not_looked_at"));
    model_drop();
}
