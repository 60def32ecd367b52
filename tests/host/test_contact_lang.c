/* test_contact_lang.c: parsed stop, friction, hold, when and noise statements. Their expressions are evaluated at
 * given states and compared with the same formula in C. */
#include "test.h"

#include <time.h>

#include "parsed.h"

#define BASE \
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate phi [rad]\n" \
    "parameter m = 2 [kg]\nparameter e = 0.5\nparameter mu = 0.3\ninput push = 3 [N]\n" \
    "let gap = x - y\nlet vx = x' - y'\n" \
    "T = m*(x'^2 + y'^2)/2 + 1 [kg*m^2]*phi'^2/2\noutput x_mm [mm] = x\noutput angle = phi\n"

/* [coordinate][number of time derivatives] */
static double state[3][2];

static double call(const expr *e, double a, double b) {
    const bool smaller = e->function == FN_MIN;
    if (e->function == FN_SIN || e->function == FN_COS) {
        return e->function == FN_SIN ? sin(a) : cos(a);
    }
    if (e->function == FN_ABS) {
        return fabs(a);
    }
    TEST_ASSERT_TRUE_MESSAGE(smaller || e->function == FN_MAX, "a function that no text here has");
    return smaller ? fmin(a, b) : fmax(a, b);
}

static double value(const expr *e) {
    const double a = e->left == NULL ? 0.0 : value(e->left);
    const double b = e->right == NULL ? 0.0 : value(e->right);
    switch (e->op) {
    case EXPR_NUMBER: return e->number;
    case EXPR_ADD: return a + b;
    case EXPR_SUB: return a - b;
    case EXPR_MUL: return a * b;
    case EXPR_DIV: return a / b;
    case EXPR_POW: return pow(a, b);
    case EXPR_NEG: return -a;
    case EXPR_CALL: return call(e, a, b);
    case EXPR_SYMBOL: break;
    }
    const symbol *named = e->symbol;
    return named->kind == SYM_COORDINATE ? state[named->index][e->primes] : value(named->value);
}

static void place_at(double x, double y, double phi, double vx, double vy, double w) {
    const double all[3][2] = {{x, vx}, {y, vy}, {phi, w}};
    memcpy(state, all, sizeof state);
}

static void expect(double wanted, const expr *e) {
    TEST_ASSERT_NOT_NULL(e);
    if (!(fabs(value(e) - wanted) <= 1e-15)) { /* allows a few round-offs of numbers near 1 */
        printf("wanted %.17g, got %.17g\n", wanted, value(e));
    }
    TEST_ASSERT_TRUE(fabs(value(e) - wanted) <= 1e-15);
}

typedef bool truth(double x, double y, double phi, double vx);

static bool one(double x, double y, double phi, double vx) {
    (void)y;
    (void)phi;
    (void)vx;
    return x > 0.5;
}

static bool and_first(double x, double y, double phi, double vx) {
    (void)vx;
    return x > 0.5 || (y < 0.25 && phi >= 1.0);
}

static bool and_then_or(double x, double y, double phi, double vx) {
    (void)vx;
    return (x > 0.5 && y < 0.25) || phi >= 1.0;
}

static bool grouped(double x, double y, double phi, double vx) {
    return (x > 0.5 || y < 0.25) && (phi >= 1.0 || vx < 0.0);
}

static bool sums(double x, double y, double phi, double vx) {
    (void)phi;
    return (x + y) * 2.0 > 1.5 && -(x) < y - 0.1 && (vx - 0.1) * (vx + 0.3) > 0.0;
}

static bool four(double x, double y, double phi, double vx) {
    return (x > 0.5 || y > 0.25 || vx > 0.0) && phi > 0.0 && x - y < 0.7;
}

/* Compares the condition with the formula on a grid of states, at which no two sides are equal. */
static void check_condition(const char *text, truth *wanted) {
    char all[900];
    snprintf(all, sizeof all, "%shold x while %s\n", BASE, text);
    const mechanism *m = parse(all);
    const contact_statement *held = &m->contacts[0];
    int trues = 0;
    int falses = 0;
    TEST_ASSERT_EQUAL_INT(CONTACT_HOLD, held->kind);
    for (int i = 0; i < 6 * 6 * 6 * 6; i++) {
        const double x = -0.63 + 0.31 * (i % 6);
        const double y = -0.41 + 0.29 * (i / 6 % 6);
        const double phi = -0.77 + 0.47 * (i / 36 % 6);
        const int last = i / 216;
        const double vx = -0.83 + 0.33 * last;
        place_at(x, y, phi, vx, 0.0, 0.0);
        const bool is = value(held->condition) > 0.0;
        const bool should = wanted(x, y, phi, vx);
        if (is != should) {
            printf("%s is %d at x=%g y=%g phi=%g x'=%g\n", text, is, x, y, phi, vx);
        }
        TEST_ASSERT_EQUAL_INT(should, is);
        trues += is;
        falses += !is;
    }
    TEST_ASSERT_TRUE(trues > 0 && falses > 0);
}

static void test_conditions_are_true_where_they_should(void) {
    check_condition("x > 0.5 [m]", one);
    check_condition("0.5 [m] < x", one);
    check_condition("((x)) >= ((0.5 [m]))", one);
    check_condition("(x) - 0.1 [m] > 0.4 [m]", one);
    check_condition("x > 0.5 [m] or y < 0.25 [m] and phi >= 1", and_first);
    check_condition("x > 0.5 [m] and y < 0.25 [m] or phi >= 1", and_then_or);
    check_condition("phi >= 1 or (x > 0.5 [m] and y <= 0.25 [m])", and_then_or);
    check_condition("(x > 0.5 [m] or y < 0.25 [m]) and (phi >= 1 or x' < 0 [m/s])", grouped);
    check_condition("(\n(x > 0.5 [m]\n or y < 0.25 [m])\n and (phi >= 1 or x' < 0))", grouped);
    check_condition("(x + y)*2 > 1.5 [m] and -(x) < (y) - 0.1 [m] and "
                    "(x' - 0.1 [m/s])*(x' + 0.3 [m/s]) > 0",
                    sums);
    check_condition("((x > 0.5 [m] or y > 0.25 [m]) or x' > 0) and phi > 0 and gap < 0.7 [m]",
                    four);
}

static void test_deep_parentheses_are_bounded_and_quick(void) {
    enum { DEEP = 20000 };
    const size_t head = strlen(BASE "hold x while ");
    char *text = malloc(head + DEEP + 1);
    TEST_ASSERT_NOT_NULL(text);
    memcpy(text, BASE "hold x while ", head);
    memset(text + head, '(', DEEP);
    text[head + DEEP] = '\0';
    diags *all = diags_new();
    const clock_t began = clock();
    TEST_ASSERT_NULL(model_parse("x.whirl", text, head + DEEP, all));
    TEST_ASSERT_TRUE((double)(clock() - began) / CLOCKS_PER_SEC < 1.0);
    diags_free(all);
    free(text);
}

static void test_words_of_the_statements_may_be_names(void) {
    const mechanism *m = parse(
        "mechanism m\ncoordinate static [m]\ncoordinate and [m]\nparameter restitution = 0.25\n"
        "parameter kinetic = 0.2\nparameter normal = 2 [N]\nparameter or = 1 [m]\n"
        "parameter noise = 3 [mm]\nparameter seed = 1\nparameter ledger = 1\n"
        "input rising = 1 [m]\nlet crosses = static - and\nlet while = static'\n"
        "output deviation [mm] = static\nT = 1 [kg]*(static'^2 + and'^2)/2\n"
        "stop static >= or restitution restitution\n"
        "friction static static 2*kinetic kinetic kinetic normal normal\n"
        "friction and static 1 kinetic kinetic normal normal\n"
        "hold and - static while while > 0 and and > or or or < static\n"
        "when crosses crosses rising rising { set static = or, and' = while }\n"
        "noise deviation deviation noise seed 5\n");
    place_at(0.5, 2.0, 0.0, 0.125, 0.0, 0.0);
    TEST_ASSERT_EQUAL_INT(5, m->contact_count);
    expect(-0.5, m->contacts[0].value);
    expect(0.25, m->contacts[0].restitution);
    expect(0.4, m->contacts[1].static_friction);
    expect(0.125, m->contacts[3].condition); /* = max(min(0.125, 2 - 1), 0.5 - 1) */
    expect(-2.5, m->contacts[4].value);
    TEST_ASSERT_EQUAL_INT(1, m->contacts[4].direction);
    expect(0.003, m->noises[0].deviation);
    TEST_ASSERT_EQUAL_UINT32(5, m->noises[0].seed);
}

SUITE(contact_lang) {
    RUN_TEST(test_conditions_are_true_where_they_should);
    RUN_TEST(test_deep_parentheses_are_bounded_and_quick);
    RUN_TEST(test_words_of_the_statements_may_be_names);
    drop();
}

/* === suite contact_run ======================================================================== */
/* Tests which stops, frictions, holds, whens and noises take part in a run, and the allowed ranges of their numbers.
 * Also the ledger. */

static instance *instance_of(int scene_number, const overrides *changes) {
    instance_free(made);
    const scene *in = scene_number < 0 ? NULL : parsed->scenes[scene_number];
    made = instance_make(parsed->mechanisms[0], in, changes, said);
    return made;
}

/* Fails the test if the instance is not refused with the message `wanted`. */
static void refuse(int scene_number, const overrides *changes, const char *wanted) {
    TEST_ASSERT_NULL(instance_of(scene_number, changes));
    expect_said(wanted);
}

static void test_the_ledger_is_called_for_like_an_effect(void) {
    const char *word[] = {"ledger"};
    const char *misspelt[] = {"ledgr"};
    parse(BASE "effect drag { F += 1 [N*s/m]*x'^2 }\nscene a { with drag, ledger }\n"
               "scene b { with drag }\nscene c { with ledger; with none }\n");
    TEST_ASSERT_TRUE(parsed->scenes[0]->ledger);
    TEST_ASSERT_TRUE(parsed->scenes[0]->with[0]);
    TEST_ASSERT_FALSE(parsed->scenes[1]->ledger);
    TEST_ASSERT_TRUE(instance_of(0, NULL)->ledger);
    TEST_ASSERT_FALSE(instance_of(1, NULL)->ledger);
    TEST_ASSERT_TRUE(instance_of(2, NULL)->ledger);
    TEST_ASSERT_TRUE(instance_of(1, &(overrides){.with = word, .with_count = 1})->ledger);
    TEST_ASSERT_FALSE(instance_of(0, &(overrides){.without = word, .without_count = 1})->ledger);
    TEST_ASSERT_TRUE(instance_of(-1, &(overrides){.with = word, .with_count = 1})->ledger);
    refuse(1, &(overrides){.with = misspelt, .with_count = 1}, "did you mean 'ledger'?");
}

static void test_noise_comes_with_its_effect(void) {
    const mechanism *m = parse(BASE "noise x_mm deviation 2 [mm]\n"
                                    "effect hum { noise angle deviation 1 [deg] }\n"
                                    "effect still { noise angle deviation 0 seed 0 }\n");
    TEST_ASSERT_NOT_NULL(instance_of(-1, NULL));
    TEST_ASSERT_TRUE(instance_has(made, m->noises[0].effect));
    TEST_ASSERT_FALSE(instance_has(made, m->noises[1].effect));
    const char *both[] = {"hum", "still"};
    refuse(-1, &(overrides){.with = both, .with_count = 2},
           "noise on 'angle' was already given in line 15");
}

static void test_effects_bring_their_events(void) {
    const mechanism *m = parse(BASE "stop x >= 0 restitution e\n"
                                    "effect wall { stop x <= 1 [m] restitution e }\n"
                                    "effect rub { friction x static mu kinetic mu normal 1 [N] }\n"
                                    "scene s { with wall }\n");
    const char *rub[] = {"rub"};
    const char *wall[] = {"wall"};
    const overrides swap = {.with = rub, .with_count = 1, .without = wall, .without_count = 1};
    TEST_ASSERT_NOT_NULL(instance_of(0, NULL));
    TEST_ASSERT_TRUE(instance_has(made, m->contacts[0].effect));
    TEST_ASSERT_TRUE(instance_has(made, m->contacts[1].effect));
    TEST_ASSERT_FALSE(instance_has(made, m->contacts[2].effect));
    TEST_ASSERT_NOT_NULL(instance_of(0, &swap));
    TEST_ASSERT_TRUE(instance_has(made, m->contacts[0].effect));
    TEST_ASSERT_FALSE(instance_has(made, m->contacts[1].effect));
    TEST_ASSERT_TRUE(instance_has(made, m->contacts[2].effect));
}

/* The start values of inputs count, wherever they come from: the declaration, the scene or the command line. */
static void test_inputs_must_be_in_range_at_the_start(void) {
    const char *good[] = {"e_in=1"};
    const char *bouncy[] = {"e_in=1.01"};
    const char *slippery[] = {"grip=0.29"};
    const char *negative[] = {"grip=-0.5"};
    const char *infinite[] = {"grip=0"};
    parse(BASE "input e_in = 0.5\ninput grip = 0.3\nlet twice = 2*grip\n"
               "effect wall { stop x >= 0 restitution e_in^2 }\n"
               "effect rub { friction x static grip kinetic 0.3 normal 1 [N] }\n"
               "effect rail { friction y static twice kinetic 0 normal 1 [N] }\n"
               "effect odd { stop y >= 0 restitution 1/twice - 1 }\n"
               "effect fast { stop y <= 1 [m] restitution e_in*(1 - y'/1 [m/s]) }\n"
               "scene s { with wall, rub, rail }\nscene set_wrong { with wall; set e_in = 2 }\n"
               "scene none_of_them { until 1 [s] }\nscene both { with odd }\n"
               "scene moving { with fast; set e_in = 2 }\n");
    TEST_ASSERT_NOT_NULL(instance_of(0, NULL));
    TEST_ASSERT_NOT_NULL(instance_of(0, &(overrides){.sets = good, .set_count = 1}));
    refuse(0, &(overrides){.sets = bouncy, .set_count = 1},
           "x.whirl:17:43: error: a restitution is from 0 to 1, and this is 1.0201");
    refuse(1, NULL, "x.whirl:17:43: error: a restitution is from 0 to 1, and this is 4");
    refuse(0, &(overrides){.sets = slippery, .set_count = 1},
           "x.whirl:18:45: error: kinetic friction 0.3 is above static friction 0.29");
    refuse(0, &(overrides){.sets = negative, .set_count = 1},
           "x.whirl:19:33: error: a coefficient of friction must not be negative, and this is -1");
    refuse(3, &(overrides){.sets = infinite, .set_count = 1},
           "error: the restitution is not a finite number (infinity)");
    TEST_ASSERT_NOT_NULL(instance_of(2, &(overrides){.sets = bouncy, .set_count = 1}));
    /* in scene 4, the restitution is known only at the impact */
    TEST_ASSERT_NOT_NULL(instance_of(4, NULL));
}

static void test_how_many_values_one_run_sets(void) {
    char text[12000] = BASE;
    /* each `when` sets 42 coordinates and their 42 rates */
    for (int i = 0; i < 42; i++) {
        char line[80];
        snprintf(line, sizeof line, "coordinate z%d [m]\n", i);
        strcat(text, line);
    }
    for (int k = 0; k < 2; k++) {
        strcat(text, k == 0 ? "when x crosses 0 {\n" : "effect b {\nwhen y crosses 0 {\n");
        for (int i = 0; i < 42; i++) {
            char line[80];
            snprintf(line, sizeof line, "set z%d = 1 [m], z%d' = 1 [m/s]\n", i, i);
            strcat(text, line);
        }
        strcat(text, k == 0 ? "}\n" : "}\n}\n");
    }
    const mechanism *m = parse(text);
    const char *b[] = {"b"};
    TEST_ASSERT_EQUAL_INT(84, m->contacts[1].set_count);
    TEST_ASSERT_NOT_NULL(instance_of(-1, NULL));
    refuse(-1, &(overrides){.with = b, .with_count = 1},
           "the 'when' statements of one run set more than 128 values");
}

SUITE(contact_run) {
    RUN_TEST(test_the_ledger_is_called_for_like_an_effect);
    RUN_TEST(test_noise_comes_with_its_effect);
    RUN_TEST(test_effects_bring_their_events);
    RUN_TEST(test_inputs_must_be_in_range_at_the_start);
    RUN_TEST(test_how_many_values_one_run_sets);
    drop();
}
