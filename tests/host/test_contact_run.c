/* test_contact_run.c: selection of stops, frictions, holds, whens and noises for one run, ranges of their numbers, and
 * the ledger. */
#include "parsed.h"
#include "test.h"

#define BASE \
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate phi [rad]\n" \
    "parameter m = 2 [kg]\nparameter e = 0.5\nparameter mu = 0.3\ninput push = 3 [N]\n" \
    "let gap = x - y\nlet vx = x' - y'\n" \
    "T = m*(x'^2 + y'^2)/2 + 1 [kg*m^2]*phi'^2/2\noutput x_mm [mm] = x\noutput angle = phi\n"

static instance *instance_of(int scene_number, const overrides *changes) {
    instance_free(made);
    const scene *in = scene_number < 0 ? NULL : parsed->scenes[scene_number];
    made = instance_make(parsed->mechanisms[0], in, changes, said);
    return made;
}

/* The instance must be refused with this message. */
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

/* Inputs count with their initial value: declared, the scene's, or the command line's. */
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
    TEST_ASSERT_NOT_NULL(instance_of(4, NULL)); /* depends on the motion: known at impact */
}

static void test_how_many_values_one_run_sets(void) {
    char text[12000] = BASE;
    for (int i = 0; i < 42; i++) { /* with x, y and phi: 45 coordinates, 90 values each time */
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
           "the whens of one run set more than 128 values");
}

SUITE(contact_run) {
    RUN_TEST(test_the_ledger_is_called_for_like_an_effect);
    RUN_TEST(test_noise_comes_with_its_effect);
    RUN_TEST(test_effects_bring_their_events);
    RUN_TEST(test_inputs_must_be_in_range_at_the_start);
    RUN_TEST(test_how_many_values_one_run_sets);
    drop();
}
