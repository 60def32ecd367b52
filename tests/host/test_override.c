/* test_override.c: changes of a scene on the command line. */
#include "parsed.h"
#include "test.h"

#define PI 3.14159265358979323846

static const char sample[] = "mechanism epicyclic\n"
                             "coordinate theta [rad]\n"
                             "coordinate X [m]\n"
                             "parameter m = 2 [kg]\n"
                             "parameter r = 0.3 [m]\n"
                             "parameter I = m*r^2/2\n"
                             "input M = 2 [N*m]\n"
                             "let vx = X' - 2*r*theta'*sin(theta)\n"
                             "T = m*X'^2/2 + m*vx^2/2 + I*theta'^2\n"
                             "Q(theta) = M\n"
                             "effect rail_drag { parameter b = 0.5 [N*s/m]; F += b*X'^2/2 }\n"
                             "effect slope { V += m*X*1 [m/s^2] }\n"
                             "scene from_rest {\n"
                             "  with rail_drag\n"
                             "  set m = 3 [kg], M = 2*m*r*9.81 [m/s^2]\n"
                             "  start theta = 30 [deg], X = r, theta' = -8.5 [rad/s]\n"
                             "}\n";

static void test_overrides(void) {
    static const char *const sets[] = {"m=4", "r = 250 mm", "b=2*m/(1 [s])", "M=-1/4"};
    static const char *const starts[] = {"theta=90 [deg]", "X'=-36 km/h", "X = r"};
    static const char *const with[] = {"slope"};
    const overrides changes = {.sets = sets,
                               .set_count = 4,
                               .starts = starts,
                               .start_count = 3,
                               .with = with,
                               .with_count = 1,
                               .step = "2ms",
                               .until = "1 [min]"};
    parse(sample);
    instantiate(&changes);
    expect_exactly(4.0, parameter("m"));
    expect_exactly(0.25, parameter("r"));
    expect_exactly(0.125, parameter("I"));
    expect_exactly(8.0, parameter("b"));
    expect_exactly(-0.25, made->input[0]);
    expect_nearly(PI / 2.0, made->start[0][0]);
    expect_exactly(0.25, made->start[1][0]);
    expect_exactly(-10.0, made->start[1][1]);
    TEST_ASSERT_TRUE(made->with[0]);
    TEST_ASSERT_TRUE(made->with[1]);
    expect_exactly(0.002, made->step_s);
    expect_exactly(60.0, made->until_s);
}

static void expect_refused(const overrides *changes, const char *wanted) {
    parse(sample);
    TEST_ASSERT_NULL(instance_make(parsed->mechanisms[0], parsed->scenes[0], changes, said));
    expect_said(wanted);
}

static void expect_set_refused(const char *set, const char *wanted) {
    expect_refused(&(overrides){.sets = &set, .set_count = 1}, wanted);
}

static void expect_start_refused(const char *start, const char *wanted) {
    expect_refused(&(overrides){.starts = &start, .start_count = 1}, wanted);
}

static void test_wrong_overrides(void) {
    expect_set_refused("m=3 [m]",
                       "<command line>:1:3: error: 'm' is mass [kg], but this is length");
    expect_set_refused("m=3 m", "<command line>:1:3: error: 'm' is mass [kg], but this is length");
    expect_set_refused("m=3 [kgs]", "<command line>:1:6: error: unknown unit 'kgs'");
    expect_set_refused("m=3 [kg^100]", "<command line>:1:11: error: this exponent is above 99\n");
    expect_set_refused("m=3 [kg^(1/0)]", "error: division by zero in an exponent\n");
    expect_set_refused("m=3 [kg^(1/2]", "error: ')' is missing in this exponent\n");
    expect_set_refused("m=3 [(kg*m]", "error: ')' is missing in this unit\n");
    expect_set_refused("m=3 [kg*]", "error: a unit is missing here\n");
    expect_set_refused("m=3 [qqqqqqqqq]", "<command line>:1:6: error: unknown unit 'qqqqqqqqq'\n");
    expect_set_refused("mm=3",
                       "<command line>:1:1: error: 'mm' is unknown in mechanism 'epicyclic'");
    expect_set_refused("m=", "<command line>:1:3: error: a value is missing before the end");
    expect_set_refused("m", "<command line>:1:2: error: '=' is missing after 'm'");
    expect_set_refused("", "<command line>:1:1: error: a name is missing");
    expect_set_refused("m=1 2", "<command line>:1:5: error: an operator is missing before '2'");
    expect_set_refused("m=1;r=2", "<command line>:1:4: error: ';' is unexpected here");
    expect_set_refused("m=1\n",
                       "<command line>:1:4: error: the end of the line is unexpected here");
    expect_set_refused("theta=1",
                       "<command line>:1:1: error: 'theta' is not a parameter or an input");
    expect_set_refused("vx=1", "<command line>:1:1: error: 'vx' follows from other quantities");
    expect_set_refused("r=theta", "<command line>:1:3: error: 'theta' depends on the motion");
    expect_set_refused("m=m", "error: 'm' is set to a value that depends on itself");
    expect_set_refused("m=log(0)", "error: parameter 'm' is not a finite number");
    expect_start_refused("m=1", "<command line>:1:1: error: 'm' is not a coordinate or a rate");
    expect_start_refused("X''=1", "<command line>:1:1: error: 'X' has no initial value for this");
    expect_start_refused("X'=1 [m]", "<command line>:1:4: error: \"X'\" is speed [m/s]");
    const char *misspelt = "rail_darg";
    expect_refused(&(overrides){.with = &misspelt, .with_count = 1},
                   "hint: did you mean 'rail_drag'?");
    expect_refused(&(overrides){.without = &misspelt, .without_count = 1},
                   "<command line>:1:1: error: unknown effect 'rail_darg'");
    expect_refused(&(overrides){.step = "1 m"}, "error: step is time [s], but this is length [m]");
    expect_refused(&(overrides){.step = "0"}, "error: step must be above zero");
    expect_refused(&(overrides){.until = "-1s"}, "error: until must not be negative");
    expect_refused(&(overrides){.until = "soon"}, "error: unknown name 'soon'");
}

/* An end before the end of the first step is refused. Only `until 0` may have no step. */
static void test_until_holds_a_step(void) {
    parse(sample);
    expect_refused(&(overrides){.until = "1s", .step = "3s"},
                   "<command line>:1:1: error: 'until' is 1 s, less than one step of 3 s");
    expect_refused(&(overrides){.until = "0.99ms", .step = "1ms"},
                   "error: 'until' is 0.00099 s, less than one step of 0.001 s");
    instantiate(&(overrides){.until = "0", .step = "3s"});
    expect_exactly(0.0, made->until_s);
    instantiate(&(overrides){.until = "3", .step = "3s"});
    expect_exactly(3.0, made->until_s);
    instantiate(&(overrides){.until = "0.1*3", .step = "0.3"}); /* in double 0.30000000000000004 */
    instantiate(&(overrides){.until = "0.3", .step = "0.1*3"});
    expect_exactly(0.3, made->until_s);
}

/* A duration other than `until` may use the scene's parameters, and does not depend on the scene's step. */
static void test_durations_beside_the_run(void) {
    double seconds = -1.0;
    const char *sets[] = {"lag=0.25 [ms]"};
    const overrides changes = {.sets = sets, .set_count = 1};
    parse("mechanism m\ncoordinate x [m]\nparameter lag = 2 [s]\nT = 1 [kg]*x'^2/2\n"
          "scene s { set lag = 3 [s] }\n");
    const mechanism *of = parsed->mechanisms[0];
    TEST_ASSERT_TRUE(instance_duration(of, NULL, NULL, "from", "lag/2", said, &seconds));
    expect_exactly(1.0, seconds);
    TEST_ASSERT_TRUE(
        instance_duration(of, parsed->scenes[0], NULL, "from", "lag/2", said, &seconds));
    expect_exactly(1.5, seconds);
    TEST_ASSERT_TRUE(
        instance_duration(of, parsed->scenes[0], &changes, "from", "lag", said, &seconds));
    expect_exactly(0.25e-3, seconds);
    TEST_ASSERT_FALSE(instance_duration(of, NULL, NULL, "from", "-1ms", said, &seconds));
    expect_said("error: from must not be negative");
    TEST_ASSERT_FALSE(instance_duration(of, NULL, NULL, "from", "1 m", said, &seconds));
    expect_said("error: from is time [s], but this is length [m]");
}

static void test_the_same_error_again_is_refused_again(void) {
    static const char *const wrong[] = {"m=1 [m]", "m=2 [m]", "m=2 [m]"};
    parse(sample);
    for (size_t i = 0; i < 3; i++) {
        const overrides changes = {.sets = &wrong[i], .set_count = 1};
        TEST_ASSERT_NULL(instance_make(parsed->mechanisms[0], NULL, &changes, said));
    }
    TEST_ASSERT_GREATER_OR_EQUAL_INT(2, diags_count(said));
}

SUITE(override) {
    RUN_TEST(test_overrides);
    RUN_TEST(test_wrong_overrides);
    RUN_TEST(test_until_holds_a_step);
    RUN_TEST(test_durations_beside_the_run);
    RUN_TEST(test_the_same_error_again_is_refused_again);
    drop();
}
