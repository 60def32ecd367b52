/* test_station_result.c: the run to which a result belongs, and how that run ended, in random sequences of orders,
 * settings, trips, stops and a lost host. Each answer of the console is about the last start. */
#include <stdlib.h>

#include "console.h"
#include "draw.h"
#include "tests/suites.h"

#define FOREVER 60000U /* limit in steps that is never reached */

static wh_conf conf;
static wh_step_inputs seen;
static uint64_t seed;

static unsigned runs;
static const char *ended;
static bool has_result;
static uint32_t result_steps; /* number of steps since the result was finished */
static wh_real measured_with[WH_CONF_COUNT];

static void own(wh_rig_config *config) { *config = even_config(); }

static bool is_active(void) {
    return even.rig.run.phase >= WH_PHASE_TARE && even.rig.run.phase <= WH_PHASE_RAMP_DOWN;
}

static void period(void) {
    const wh_rig_phase before = even.rig.run.phase;
    const bool was_active = is_active();
    even_step(&even);
    result_steps++;
    if (before == WH_PHASE_RECORD && even.rig.run.phase == WH_PHASE_RAMP_DOWN) {
        has_result = true;
        result_steps = 0;
        ended = "done";
        memcpy(measured_with, conf.value, sizeof measured_with);
    } else if (was_active && even.rig.state == WH_RIG_TRIPPED) {
        ended = "trip";
    }
    seen.inputs = even.inputs;
    wh_station_see(&station, &even.config, &even.rig, &seen);
    wh_station_step(&station, &even.rig);
}

static void periods(unsigned count) {
    while (count-- > 0) {
        period();
    }
}

static bool is_ok(const char *line) { return strncmp(ask(line), "OK", 2) == 0; }

/* Checks that the answer contains " name=" and this word. */
static void check_told(const char *name, const char *word) {
    const char *at = strstr(heard, name);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, name);
    at += strlen(name);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(word, at, strlen(word), name);
    TEST_ASSERT_TRUE(strchr(" :", at[strlen(word)]) != NULL); /* true for NUL, too */
}

static const char *decimal(unsigned number) {
    static char bytes[12];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add_unsigned(&text, number);
    return bytes;
}

static void check_answers(void) {
    static const char *const words[] = {
        [WH_GOOD] = "good", [WH_DOUBTFUL] = "doubtful", [WH_REFUSED] = "refused"};
    const bool is_same = memcmp(measured_with, conf.value, sizeof measured_with) == 0;
    const char *verdict = !has_result ? "none"
                          : is_same   ? words[even.rig.result.force.quality]
                                      : "outdated";
    ask("status");
    TEST_ASSERT_EQUAL_UINT32(0, station.lost_answers);
    check_told(" run=", decimal(runs));
    check_told(" ended=", ended);
    check_told(" result=", verdict);
    const bool brakes = even.command.way == WH_MOTOR_BRAKES;
    TEST_ASSERT_TRUE((strstr(heard, "state=brake ") != NULL) == brakes);
    ask("fault");
    check_told(" ended=", ended);
    ask("measure");
    if (!has_result) {
        check_told("ERR 104 ", "there is no result"); /* true during a run, too */
        return;
    }
    check_told(" result=", verdict);
    check_told(" run=", decimal(runs));
    TEST_ASSERT_TRUE((strstr(heard, "with other settings") == NULL) == is_same);
    const unsigned age_s = result_steps / STEPS_PER_S;
    const char *at = strstr(heard, " age_s=");
    TEST_ASSERT_NOT_NULL(at);
    const unsigned told_s = (unsigned)strtoul(at + 7, NULL, 10);
    TEST_ASSERT_TRUE(told_s <= age_s + 1U && told_s + 1U >= age_s);
}

static void start(void) {
    static const char *const targets[] = {"start 330", "start 250", "start 200"};
    (void)ask("arm");
    if (is_ok(targets[draw_one_of(&seed, 3)])) {
        runs++;
        ended = "none";
        has_result = false;
    }
}

static void stop_by_input(void) {
    static const char *const words[] = {"stop_input_or_drive_fault", "stop_input", "drive_fault"};
    const unsigned by = draw_one_of(&seed, 3);
    ended = is_active() ? words[by] : ended;
    even.inputs.stop_pressed = true;
    even.inputs.stop_by = (wh_stop_by)by;
    period();
    even.inputs.stop_pressed = false;
}

static void set_something(void) {
    static const char *const lines[] = {"conf set mass_moment 0.04",
                                        "conf set mass_moment 0.05",
                                        "conf set settle_time 2",
                                        "conf set stop_brakes off",
                                        "conf set no_load_speed 700",
                                        "conf default",
                                        "conf set host 2"};
    (void)ask(lines[draw_one_of(&seed, sizeof lines / sizeof lines[0])]);
}

static void lose_host(void) {
    if (!is_ok("host 1")) {
        return;
    }
    for (unsigned i = 0; i < STEPS_PER_S + 2U; i++) {
        const bool active = is_active();
        const uint32_t losses = station.host_losses;
        period();
        if (station.host_losses != losses && active) {
            period();
            ended = even.rig.state == WH_RIG_TRIPPED ? ended : "host_lost";
        }
    }
    TEST_ASSERT_TRUE(is_ok("host 0"));
}

static void do_something(void) {
    switch (draw_one_of(&seed, 12)) {
    case 0:
    case 1:
    case 2: start(); break;
    case 3: {
        const bool active = is_active();
        TEST_ASSERT_TRUE(is_ok("stop"));
        ended = active ? "stop_command" : ended;
        break;
    }
    case 4: stop_by_input(); break;
    case 5: set_something(); break;
    case 6: lose_host(); break;
    case 7: /* a trip, or a refused order */
        even.inputs.supply_V = WH_R(0.0);
        period();
        even.inputs.supply_V = WH_RIG_RATED_V;
        break;
    case 8: (void)ask("clear"); break;
    case 9: periods(draw_one_of(&seed, 3U * STEPS_PER_S)); break;
    default:
        for (unsigned i = 0; i < FOREVER && !even_is_over(&even); i++) {
            period();
        }
        periods(draw_one_of(&seed, 2U * STEPS_PER_S));
        break;
    }
}

static void begin(void) {
    console_begin();
    wh_conf_start(&conf, own, NULL, &even.config);
    station.conf = &conf;
    runs = 0;
    ended = "none";
    has_result = false;
}

TEST(station_result, answers_belong_to_the_last_start) {
    unsigned results = 0;
    unsigned outdated = 0;
    seed = 71;
    const unsigned rounds = draw_cases(12);
    /* Some sequences have no result: continue until enough of them have one. */
    for (unsigned round = 0; round < rounds || (round < 8U * rounds && (results < draw_cases(40) ||
                                                                        outdated < draw_cases(8)));
         round++) {
        begin();
        for (unsigned i = 0; i < 40U; i++) {
            do_something();
            check_answers();
            results += has_result ? 1U : 0U;
            outdated += strstr(heard, "result=outdated") != NULL ? 1U : 0U;
        }
        TEST_ASSERT_TRUE(runs > 0);
    }
    TEST_ASSERT_TRUE(results >= draw_cases(40) && outdated >= draw_cases(8));
}

/* Each setting changes the hash. The hash depends only on the values: if these are restored, so is the hash. */
TEST(station_result, each_setting_changes_the_hash) {
    seed = 72;
    begin();
    const uint32_t plain = even.config.settings;
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        const wh_conf_row row = wh_conf_row_of((wh_conf_id)id);
        const wh_real before = conf.value[id];
        const bool is_least = before < row.least + (row.most - row.least) / 2;
        const wh_real other = (wh_conf_kind)row.kind == WH_CONF_REAL
                                  ? before * WH_R(1.01) + WH_R(1e-3)
                              : is_least ? before + 1
                                         : before - 1;
        if (wh_conf_set(&conf, (wh_conf_id)id, other) == WH_STATION_FINE) {
            TEST_ASSERT_TRUE(even.config.settings != plain);
            TEST_ASSERT_TRUE(wh_conf_set(&conf, (wh_conf_id)id, before) == WH_STATION_FINE);
        } else {
            TEST_ASSERT_TRUE(id == WH_CONF_mount_factor || id == WH_CONF_speed_limit ||
                             id == WH_CONF_amplitude_floor);
        }
        TEST_ASSERT_TRUE(even.config.settings == plain);
    }
}

/* The age of a result after hours. The timer's wraps do not make it smaller. */
TEST(station_result, an_age_beyond_the_timer) {
    begin();
    start();
    for (unsigned i = 0; i < FOREVER && !has_result; i++) {
        period();
    }
    const uint32_t before_s = wh_rig_result_age_s(&even.rig, even.inputs.now_ticks);
    for (unsigned hour = 0; hour < 3U; hour++) {
        for (unsigned i = 0; i < 3600U; i++) { /* one step per second */
            even.inputs.now_ticks += WH_RIG_TICKS_PER_S - EVEN_STEP_TICKS;
            even_step(&even);
        }
    }
    const uint32_t age_s = wh_rig_result_age_s(&even.rig, even.inputs.now_ticks);
    TEST_ASSERT_TRUE(age_s - before_s >= 3U * 3600U - 1U && age_s - before_s <= 3U * 3600U + 1U);
}

/* The console prints all reasons of a result, with the largest numbers of a rig. If numbers are even larger, the line
 * is cut but still has its end. */
TEST(station_result, every_reason_is_printed) {
    static const char other[] = "conf set settle_time 2";
    wh_measured *force = &even.rig.result.force;
    begin();
    start();
    for (unsigned i = 0; i < FOREVER && !even_is_over(&even); i++) {
        period();
    }
    TEST_ASSERT_TRUE(has_result);
    for (unsigned i = 0; i < 4U * WH_WHYS; i++) {
        const char *words = wh_why_text((wh_why)(i % WH_WHYS));
        const bool is_odd = i >= 2U * WH_WHYS; /* numbers larger than those of any rig */
        const wh_real most = is_odd ? WH_R(-1e30) : WH_R(-9999.99);
        if (i == WH_WHYS || i == 3U * WH_WHYS) {
            TEST_ASSERT_TRUE(is_ok(other));
        } else if (i == 2U * WH_WHYS) {
            TEST_ASSERT_TRUE(is_ok("conf default"));
        }
        force->why = (wh_why)(i % WH_WHYS);
        force->quality = WH_DOUBTFUL;
        force->turns = 65535U;
        force->calibrated = false;
        force->speed_radps = force->scatter_radps = most / WH_R(10.0);
        force->amplitude_N = force->amplitude_half_N = force->expected_N = most;
        force->phase_rad = force->phase_half_rad = most / WH_R(100.0);
        TEST_ASSERT_TRUE(is_ok("measure"));
        if (!is_odd) {
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(heard, words), words);
        }
    }
}
