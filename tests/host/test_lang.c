/* test_lang.c: the meaning of a .whirl file: units, dimensions, names, and the values of scenes. */
#include "test.h"

#include "host/lang/value.h"
#include "parsed.h"

#define PI 3.14159265358979323846

static double value_of(const char *expression) {
    char text[300];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate X [m]\nT = 1 [kg]*X'^2\nparameter p = %s\n", expression);
    parse(text);
    instantiate(NULL);
    return parameter("p");
}

static void test_a_divided_unit_goes_from_left_to_right(void) {
    unit_scale read;
    unit_error error;
    TEST_ASSERT_TRUE(unit_parse("N*s/m*kg", 8, &read, &error));
    TEST_ASSERT_TRUE(dim_fits(read.dim, dim_of(0, 2, -1, 0, 0)));
    TEST_ASSERT_TRUE(unit_parse("m/s/s", 5, &read, &error));
    TEST_ASSERT_TRUE(dim_fits(read.dim, dim_of(1, 0, -2, 0, 0)));
    expect_exactly(2.0, value_of("2 [N * s / m]"));
    expect_nearly(1.0, value_of("1 [kg*(m/s)^2]"));
    expect_nearly(10.0, value_of("36 [km/h]"));
    TEST_ASSERT_FALSE(unit_parse("m/s^^2", 6, &read, &error));
    TEST_ASSERT_EQUAL_UINT(4, error.offset);
    TEST_ASSERT_FALSE(unit_parse("inches", 6, &read, &error));
    TEST_ASSERT_EQUAL_STRING("write in", error.hint);
}

static void test_arithmetic(void) {
    expect_exactly(-9.0, value_of("-3^2"));
    expect_exactly(512.0, value_of("2^3^2"));
    expect_exactly(0.125, value_of("2^-3"));
    expect_exactly(-1.0, value_of("2 - 1 - 2"));
    expect_exactly(2.0, value_of("8/2/2"));
    expect_exactly(-6.0, value_of("2*-3"));
    expect_exactly(7.0, value_of("1 + 2*3"));
    expect_exactly(9.0, value_of("(1 + 2)\t*3 # comment"));
    expect_exactly(3.0, value_of("(1\n + 2\n)"));
    expect_exactly(1500.0, value_of(".15e+4"));
    expect_exactly(PI, value_of("pi"));
    expect_exactly(sin(0.5), value_of("sin(0.5)"));
    expect_exactly(atan2(1.0, -2.0), value_of("atan2(1, -2)"));
    expect_exactly(3.0, value_of("max(2, 3)"));
    expect_exactly(-1.0, value_of("sign(-7 [m])"));
    expect_exactly(4.0, value_of("abs(-4 [m])"));
    expect_exactly(2.0, value_of("sqrt(4 [m^2])"));
}

static void test_dimensions_of_expressions(void) {
    parse("mechanism m\ncoordinate X [m]\ncoordinate a [rad]\nparameter k = 3 [N/m]\n"
          "let e = k*X^2/2\nlet root = sqrt(k/(2 [kg]))\nlet z = 0*X + 0\nlet y = atan2(X, 2 [m])\n"
          "let cube = X^(1/3)\nlet v = X'' + 0\nlet w = a' + 1 [rad/s]\nlet s = 2^a\n"
          "T = 1 [kg]*X'^2 + 0\nV = 0\nF = -0.0\nQ(a) = 2 [N*m]\nQ(X) = max(0, 3 [N])\n");
    const mechanism *of = parsed->mechanisms[0];
    static const struct {
        int index;
        const char *text;
    } cases[] = {{0, "energy or torque [kg*m^2/s^2]"},
                 {1, "frequency or angular speed [1/s]"},
                 {3, "dimensionless"},
                 {4, "[m^(1/3)]"},
                 {5, "acceleration [m/s^2]"},
                 {6, "frequency or angular speed [1/s]"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[DIM_TEXT_SIZE];
        dim_text(of->lets[cases[i].index]->dim, text, sizeof text);
        TEST_ASSERT_EQUAL_STRING(cases[i].text, text);
    }
    TEST_ASSERT_EQUAL_INT(2, of->lets[5]->value->order);
    TEST_ASSERT_TRUE((of->lets[0]->value->uses & USES_PARAMETER) != 0);
    TEST_ASSERT_TRUE(of->coordinates[1]->is_angle);
    TEST_ASSERT_FALSE(of->coordinates[0]->is_angle);
    TEST_ASSERT_EQUAL_INT(5, of->term_count);
}

static void test_a_bare_mechanism_is_at_rest(void) {
    parse("mechanism m; coordinate X [m]; T = 1 [kg]*X'^2; effect a { F += X'^2*2 [N*s/m] }");
    instantiate(NULL);
    TEST_ASSERT_NULL(made->scene);
    TEST_ASSERT_EQUAL_STRING("m", made->name);
    expect_exactly(0.0, made->start[0][0]);
    expect_exactly(1e-3, made->step_s);
    expect_exactly(10.0, made->until_s);
    TEST_ASSERT_FALSE(made->with[0]);
}

static void test_sets_may_name_later_parameters(void) {
    parse("mechanism m\ncoordinate X [m]\nparameter a = 1\nparameter b = 2*a\nparameter c = 3\n"
          "parameter d = c + 1\nlet e = d*d\nT = a*1 [kg]*X'^2\n"
          "scene s { set a = d, c = 10; start X = e*1 [m] }\n");
    instantiate(NULL);
    expect_exactly(11.0, parameter("a"));
    expect_exactly(22.0, parameter("b"));
    expect_exactly(121.0, made->start[0][0]);
}

/* Each of these sixty lets must be evaluated once; else each of them would double the work. */
static void test_lets_are_evaluated_once(void) {
    char text[4000];
    int used = snprintf(text, sizeof text,
                        "mechanism m\ncoordinate X [m]\nT = 1 [kg]*X'^2\n"
                        "parameter one = 1\nlet a0 = one\n");
    for (int i = 1; i <= 60; i++) {
        used += snprintf(text + used, sizeof text - (size_t)used, "let a%d = (a%d + a%d)/2\n", i,
                         i - 1, i - 1);
    }
    snprintf(text + used, sizeof text - (size_t)used, "parameter p = a60\n");
    parse(text);
    instantiate(NULL);
    expect_exactly(1.0, parameter("p"));
}

static void test_several_mechanisms_and_uses(void) {
    parse("mechanism a\ncoordinate X [m]\nT = 1 [kg]*X'^2\n"
          "mechanism b\ncoordinate X [rad]\nT = 1 [kg*m^2]*X'^2\n"
          "scene one { use a; start X = 2 [m] }\nscene two\n{\n  with none\n  start X = 2\n}\n"
          "scene three { use b }\n");
    TEST_ASSERT_EQUAL_INT(2, parsed->mechanism_count);
    TEST_ASSERT_EQUAL_INT(3, parsed->scene_count);
    TEST_ASSERT_EQUAL_PTR(parsed->mechanisms[0], parsed->scenes[0]->mechanism);
    TEST_ASSERT_EQUAL_PTR(parsed->mechanisms[1], parsed->scenes[1]->mechanism);
    TEST_ASSERT_EQUAL_PTR(parsed->mechanisms[1], parsed->scenes[2]->mechanism);
}

static void test_byte_order_mark_and_line_ends(void) {
    parse("\xef\xbb\xbfmechanism m \"\xc3\xa4\"\r\ncoordinate X [m] \"of\"\r\nT = 1 [kg]*X'^2\r\n");
    TEST_ASSERT_EQUAL_STRING("\xc3\xa4", parsed->mechanisms[0]->title);
    TEST_ASSERT_EQUAL_STRING("of", parsed->mechanisms[0]->coordinates[0]->text);
}

enum { IN_SCENE_PLACES = 5, PLACES = 7 };

/* Instantiates a mechanism with X, p and q in `unit`, and an assignment in place number `at` of the scene. Returns
 * NULL if it is refused. *report: the reason, which the caller frees. */
static instance *given_in(const char *unit, int at, const char *assigned, char **report) {
    static const char *const put[IN_SCENE_PLACES] = {"start %s", "start X = 0, %s", "set %s",
                                                     "set %s", "when X crosses 0 { set %s }"};
    char item[400] = "";
    char text[1200];
    size_t size = 0;
    drop();
    said = diags_new();
    if (at < IN_SCENE_PLACES) {
        snprintf(item, sizeof item, put[at], assigned); // NOLINT
    }
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate X [%s]\nparameter p = 2 [%s]\ninput q = 2 [%s]\n"
             "T = 1 [kg*m^2]*(X'/1 [%s])^2\nscene s { %s }\n",
             unit, unit, unit, unit, item);
    parsed = model_parse("x.whirl", text, strlen(text), said);
    const overrides typed = {.starts = &assigned,
                             .start_count = at == IN_SCENE_PLACES,
                             .sets = &assigned,
                             .set_count = at > IN_SCENE_PLACES};
    made = parsed == NULL ? NULL
                          : instance_make(parsed->mechanisms[0], parsed->scenes[0], &typed, said);
    FILE *out = open_memstream(report, &size);
    diags_flush(said, out);
    fclose(out);
    return made;
}

static double value_in(int at) {
    switch (at) {
    case 0:
    case IN_SCENE_PLACES: return made->start[0][0];
    case 1: return made->start[0][1];
    case 3: return made->input[0];
    case 4: return expr_value(parsed->scenes[0]->whens[0].sets[0].value, NULL);
    default: return made->parameter[0];
    }
}

/* For every unit, place and notation: a value without its unit must be refused, unless the unit is SI. The hint must
 * have the declared unit, and must be accepted if it is pasted. */
static void test_a_value_without_its_unit_is_refused(void) {
    static const char *const name[PLACES] = {"X", "X'", "p", "q", "X", "X", "p"};
    static const struct {
        const char *text;
        double value;
    } written[] = {{"30", 30.0},  {"-0.25", -0.25}, {"2*15", 30.0},
                   {"3e1", 30.0}, {"(7)", 7.0},     {"0", 0.0}};
    int refused = 0;
    for (int u = 0; unit_name(u) != NULL; u++) {
        const char *unit = unit_name(u);
        unit_scale is;
        unit_error error;
        TEST_ASSERT_TRUE(unit_parse(unit, strlen(unit), &is, &error));
        const double si = is.scale / is.divisor;
        for (int k = 0; k < PLACES * (int)(sizeof written / sizeof written[0]); k++) {
            const int at = k % PLACES;
            const int w = k / PLACES;
            const bool fits = dim_fits(is.dim, at == 1 ? dim_of(0, 0, 1, 0, 0) : dim_none());
            const bool typed = at >= IN_SCENE_PLACES;
            char assigned[80];
            char *report = NULL;
            snprintf(assigned, sizeof assigned, "%s = %s", name[at], written[w].text);
            const bool wanted = written[w].value == 0.0 || ((typed || fits) && si == 1.0);
            const bool taken = given_in(unit, at, assigned, &report) != NULL;
            TEST_ASSERT_EQUAL_INT_MESSAGE(wanted, taken, assigned);
            if (!taken && (typed || fits || si != 1.0)) {
                char *hint = strstr(report, "hint: ");
                TEST_ASSERT_NOT_NULL(strstr(report, "and this value has no unit"));
                TEST_ASSERT_NOT_NULL(hint);
                hint += 6 + (typed ? 1 : 0);
                *strstr(hint, typed ? "\", or in SI: " : ", or in SI: ") = '\0';
                char *again = NULL;
                TEST_ASSERT_NOT_NULL_MESSAGE(given_in(unit, at, hint, &again), hint);
                const double is_now = value_in(at);
                TEST_ASSERT_TRUE_MESSAGE(
                    fabs(is_now - written[w].value * si) <= 1e-15 * fabs(is_now), hint);
                free(again);
                refused++;
            }
            free(report);
        }
    }
    TEST_ASSERT_TRUE(refused > 500);
}

/* A number without a unit, next to an angle in [deg], must be refused in every sum and comparison, except 0 and pi.
 * The hint must be accepted if it is pasted. Next to an angle in [rad] the number is accepted. */
static void test_a_bare_number_beside_an_angle(void) {
    static const char *const lines[] = {
        "stop %s >= a restitution 0",
        "stop a - %s <= 0 restitution 0",
        "stop abs(a) <= %s restitution 0",
        "stop 2*a <= %s restitution 0",
        "stop a/2 <= k + %s restitution 0",
        "stop b <= %s restitution 0",
        "let l = %s\nstop a <= l restitution 0",
        "hold a while a > %s",
        "hold a while a' > 1 [rad/s] and (%s < a or -a > 2*k)",
        "when a - %s crosses 0 { set a = 0 }",
        "V = 1 [J]*(a - %s)^2",
        "V = 1 [J]*sin(k + a - %s)",
        "V = 1 [J]*max(a - %s, 0)",
        "V = 1 [J]*min(%s, -a)",
        "output o [deg] = a - %s",
    };
    static const char *const numbers[] = {"30", "-2*15", "0", "pi/2", "30 [deg]"};
    enum { LINES = sizeof lines / sizeof lines[0], NUMBERS = sizeof numbers / sizeof numbers[0] };
    for (int k = 0; k < LINES * NUMBERS * 2; k++) {
        const bool in_degrees = k % 2 == 0;
        const int n = k / 2 % NUMBERS;
        char number[80];
        snprintf(number, sizeof number, "%s", numbers[n]);
        for (int again = 0; again < 2; again++) {
            const bool wanted = again == 1 || !in_degrees || n > 1;
            char line[200];
            char text[700];
            snprintf(line, sizeof line, lines[k / 2 / NUMBERS], number);
            snprintf(text, sizeof text,
                     "mechanism m\ncoordinate a [%s]\nparameter k = 20 [%s]\nlet b = 2*a + k\n"
                     "T = 1 [kg*m^2]*a'^2\n%s\nscene s { until 1 [s] }\n",
                     in_degrees ? "deg" : "rad", in_degrees ? "deg" : "rad", line);
            diags *errors = diags_new();
            whirl_model *model = model_parse("x.whirl", text, strlen(text), errors);
            char *report = NULL;
            size_t size = 0;
            FILE *out = open_memstream(&report, &size);
            diags_flush(errors, out);
            fclose(out);
            const char *hint = strstr(report, "hint: write ");
            TEST_ASSERT_EQUAL_INT_MESSAGE(!wanted, strstr(report, "this value has no unit") != NULL,
                                          text);
            TEST_ASSERT_TRUE_MESSAGE(model != NULL || !wanted, report);
            const bool is_let = strncmp(line, "let", 3) == 0;
            if (!wanted) {
                TEST_ASSERT_NOT_NULL_MESSAGE(hint, report);
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(hint, is_let ? "l*1 [deg]" : "30 [deg]"), hint);
                snprintf(number, sizeof number, "(%.*s)", (int)strcspn(hint + 12, ","), hint + 12);
            }
            if (is_let) {
                snprintf(number, sizeof number, "30 [deg]");
            }
            free(report);
            diags_free(errors);
            model_free(model);
        }
    }
}

/* A bare number in a parameter must be refused, too. Functions that return radians must be accepted. */
static void test_units_come_through_names(void) {
    static const char *const good[] = {"X = 2*p", "X = asin(0.5)", "X = q0*1 [deg]"};
    for (int i = 0; i < 4; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate X [deg]\nparameter p = 2 [deg]\nparameter q0 = 2\n"
                 "T = 1 [kg*m^2]*X'^2\nscene s { start %s }\n",
                 i < 3 ? good[i] : "X = q0");
        if (i < 3) {
            parse(text);
            continue;
        }
        drop();
        said = diags_new();
        parsed = model_parse("x.whirl", text, strlen(text), said);
        TEST_ASSERT_NULL(parsed);
        expect_said("X = (q0)*1 [deg], or in SI: X = (q0)*1 [rad]");
    }
}

SUITE(lang) {
    RUN_TEST(test_a_value_without_its_unit_is_refused);
    RUN_TEST(test_a_bare_number_beside_an_angle);
    RUN_TEST(test_units_come_through_names);
    RUN_TEST(test_a_divided_unit_goes_from_left_to_right);
    RUN_TEST(test_arithmetic);
    RUN_TEST(test_dimensions_of_expressions);
    RUN_TEST(test_a_bare_mechanism_is_at_rest);
    RUN_TEST(test_sets_may_name_later_parameters);
    RUN_TEST(test_lets_are_evaluated_once);
    RUN_TEST(test_several_mechanisms_and_uses);
    RUN_TEST(test_byte_order_mark_and_line_ends);
    drop();
}
