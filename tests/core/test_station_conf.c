/* test_station_conf.c: settings at the console: range, place in the configuration, change only while idle, saving, and
 * restoring with the same bits. */
#include <stddef.h>

#include "console.h"
#include "core/station/answer.h"
#include "core/text.h"
#include "draw.h"
#include "tests/suites.h"

#define SLOT_BYTES 256U
#define DEG WH_RIG_DEG_PER_RAD
#define RPM (WH_R(1.0) / EVEN_RPM)

static wh_conf conf;
static uint64_t seed;
static uint8_t kept[WH_STORE_SLOTS][SLOT_BYTES];
static bool memory_fails;

static bool erase(unsigned slot) {
    memset(kept[slot], 0xFF, SLOT_BYTES);
    return !memory_fails;
}
static bool write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    memcpy(kept[slot] + at, bytes, count);
    return true;
}
static bool read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    memcpy(bytes, kept[slot] + at, count);
    return true;
}
static const wh_store_memory memory = {erase, write, read};

static void own(wh_rig_config *config) { *config = even_config(); }

static void begin(void) {
    memset(kept, 0xFF, sizeof kept);
    memory_fails = false;
    console_begin();
    wh_conf_start(&conf, own, &memory, &even.config);
    station.conf = &conf;
}

static void period(void) {
    even_step(&even);
    wh_station_step(&station, &even.rig);
}

/* Checks that two configurations are equal, except for the hash of the settings, which does not exist in a program
 * without settings. */
static void check_same(const wh_rig_config *one, const wh_rig_config *other) {
    wh_rig_config with_hash = *one;
    with_hash.settings = one->settings == 0 ? other->settings : one->settings;
    one = &with_hash;
    TEST_ASSERT_TRUE(memcmp(one, other, sizeof *one) == 0);
}

/* Returns the value of a setting in the configuration, in its unit. It is an independent copy of the table. */
static wh_real where(const wh_rig_config *c, const char *name) {
    const struct {
        const char *name;
        wh_real value;
    } places[] = {{"mass_moment", c->measure.rotor.unbalance_kgm},
                  {"inertia", c->measure.rotor.inertia_kgm2},
                  {"damping", c->measure.rotor.damping_Nms},
                  {"damping_tolerance", c->measure.rotor.damping_tolerance},
                  {"gravity", c->measure.rotor.gravity_mps2},
                  {"gravity_angle", c->measure.rotor.gravity_rad * DEG},
                  {"mount_factor", c->measure.result.mount_factor},
                  {"sensor1", (c->measure.rotor.pulse_rad[0] + c->swing.lead_rad) * DEG},
                  {"sensor2", (c->observer.pulse_rad[1] + c->swing.lead_rad) * DEG},
                  {"slot_lead", c->swing.lead_rad * DEG},
                  {"cell_scale", WH_ABS(c->measure.cell.newton_per_count) * WH_R(1000.0)},
                  {"cell_reversed", c->measure.cell.newton_per_count < 0 ? WH_R(1.0) : WH_R(0.0)},
                  {"cell_offset", c->measure.cell.offset_N},
                  {"cell_delay", (wh_real)c->measure.cell.delay_ticks},
                  {"amplitude_floor", c->measure.result.amplitude_floor},
                  {"phase_floor", c->measure.result.phase_floor_rad * DEG},
                  {"record_time", c->measure.record_s},
                  {"record_turns", c->measure.record_turns},
                  {"settle_time", c->run.settle_s},
                  {"settle_band", c->run.settle_band_radps * RPM},
                  {"ramp", c->run.drive.ramp_radps2 * RPM},
                  {"gain", c->run.drive.proportional_V_per_radps},
                  {"gain_integral", c->run.drive.integral_V_per_rad},
                  {"spin_up", c->run.spin_up_V},
                  {"speed_least", c->guard.target_min_radps * RPM},
                  {"speed_most", c->guard.target_max_radps * RPM},
                  {"speed_limit", c->guard.limit_radps * RPM},
                  {"supply_least", c->guard.supply_min_V},
                  {"supply_most", c->guard.supply_max_V},
                  {"armed_time", c->armed_max_s},
                  {"rest_time", c->rest_max_s},
                  {"stop_brakes", c->stop_brakes ? WH_R(1.0) : WH_R(0.0)},
                  {"swings", c->swings ? WH_R(1.0) : WH_R(0.0)},
                  {"host_loss_stops", c->host_loss_stops ? WH_R(1.0) : WH_R(0.0)},
                  {"compensation", (wh_real)c->compensation_when},
                  {"yields", c->measure.rotor.yields_kgm2},
                  {"no_load_speed", c->run.no_load_radps * RPM},
                  {"rated_voltage", c->run.rated_V},
                  {"stall_torque", c->compensation.stall_Nm},
                  {"host", (wh_real)c->host_max_s}};
    TEST_ASSERT_EQUAL_UINT(WH_CONF_COUNT, sizeof places / sizeof places[0]);
    unsigned i = 0;
    while (i < WH_CONF_COUNT && strcmp(places[i].name, name) != 0) {
        i++;
    }
    TEST_ASSERT_TRUE_MESSAGE(i < WH_CONF_COUNT, name);
    return places[i].value;
}

static bool is_whole(wh_conf_row row) { return (wh_conf_kind)row.kind != WH_CONF_REAL; }

static wh_real draw_value(wh_conf_row row) {
    const wh_real part = draw_whole(&seed, 0, 1000) / 1000;
    const wh_real value = row.least + part * (row.most - row.least);
    return is_whole(row) ? (wh_real)(int32_t)(value + WH_R(0.5)) : (wh_real)(float)value;
}

static const char *settings_told(void) {
    static char bytes[40];
    const wh_value value = {.count = WH_CONF_COUNT};
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_answer(&text, "OK settings=@c ", &value);
    return bytes;
}

static const char *name_of(wh_conf_id id) {
    static char bytes[40];
    const wh_value value = {.word = wh_conf_name(id)};
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_answer(&text, "@w", &value);
    return bytes;
}

TEST(station_conf, rows) {
    begin();
    for (unsigned i = 0; i < WH_CONF_COUNT; i++) {
        const wh_conf_row row = wh_conf_row_of((wh_conf_id)i);
        TEST_ASSERT_TRUE(row.least < row.most && row.number > 0);
        const char *name = name_of((wh_conf_id)i);
        TEST_ASSERT_TRUE(strchr(name, ' ') == NULL && strlen(name) > 0);
        TEST_ASSERT_TRUE(conf.value[i] >= row.least && conf.value[i] <= row.most);
        for (unsigned k = 0; k < i; k++) {
            const wh_conf_row other = wh_conf_row_of((wh_conf_id)k);
            TEST_ASSERT_TRUE(other.number != row.number);
        }
        TEST_ASSERT_EQUAL_UINT(i, wh_conf_find(name)); /* no earlier setting has this name */
    }
    TEST_ASSERT_EQUAL_UINT(WH_CONF_COUNT, wh_conf_find("mass"));
    TEST_ASSERT_EQUAL_UINT(WH_CONF_COUNT, wh_conf_find(""));
}

/* Random values: each changes its member of the configuration, and is saved, loaded and restored. */
TEST(station_conf, values_have_their_places) {
    seed = 21;
    wh_rig_config plain;
    own(&plain);
    unsigned against = 0;
    for (unsigned round = 0; round < 400U; round++) {
        begin();
        check_same(&plain, &even.config);
        wh_real wanted[WH_CONF_COUNT];
        bool set[WH_CONF_COUNT] = {false};
        memcpy(wanted, conf.value, sizeof wanted);
        for (unsigned k = draw_one_of(&seed, 6); k > 0; k--) {
            const wh_conf_id id = (wh_conf_id)draw_one_of(&seed, WH_CONF_COUNT);
            const wh_real value = draw_value(wh_conf_row_of(id));
            const wh_station_error status = wh_conf_set(&conf, id, value);
            TEST_ASSERT_TRUE(status == WH_STATION_FINE || status == WH_STATION_CONF_AGAINST);
            set[id] = set[id] || status == WH_STATION_FINE;
            for (unsigned i = 0; i < WH_CONF_COUNT; i++) {
                /* Settings that follow from the motor come after the motor's settings. */
                wanted[i] = set[i] ? wanted[i] : conf.value[i];
            }
            wanted[id] = status == WH_STATION_FINE ? value : wanted[id];
            against += status == WH_STATION_CONF_AGAINST ? 1U : 0U;
        }
        for (unsigned i = 0; i < WH_CONF_COUNT; i++) {
            const char *name = name_of((wh_conf_id)i);
            const float size = (float)WH_ABS(wanted[i]);
            TEST_ASSERT_FLOAT_WITHIN_MESSAGE(size * 1e-5f + 2e-5f, (float)wanted[i],
                                             (float)where(&even.config, name), name);
        }
        TEST_ASSERT_TRUE(even.config.observer.pulse_rad[0] ==
                         even.config.measure.rotor.pulse_rad[0]);
        const wh_rig_config then = even.config;
        TEST_ASSERT_TRUE(wh_conf_save(&conf) == WH_STATION_FINE);
        static wh_conf again;
        wh_rig_config other;
        wh_conf_start(&again, own, &memory, &other);
        check_same(&then, &other);
        TEST_ASSERT_EQUAL_UINT32(1, again.sequence);
        wh_conf_default(&conf);
        check_same(&plain, &even.config);
    }
    TEST_ASSERT_TRUE(against > 10U);
}

static void own_standard(wh_rig_config *config) { *config = wh_rig_standard; }

/* Values that follow from masses, inertia, gravity and mount. */
TEST(station_conf, derived_values) {
    wh_rig_config plain;
    own_standard(&plain);
    wh_conf_start(&conf, own_standard, NULL, &even.config);
    TEST_ASSERT_TRUE(wh_conf_set(&conf, WH_CONF_mass_moment,
                                 WH_R(2.0) * plain.measure.rotor.unbalance_kgm) == WH_STATION_FINE);
    const float twice = 2.0f;
    CHECK_NEAR(1e-5f, twice, even.config.compensation.weight_Nm / plain.compensation.weight_Nm);
    CHECK_NEAR(1e-5f, twice, even.config.guard.load_still_kgm / plain.guard.load_still_kgm);
    CHECK_NEAR(1e-5f, 1.41421356f, even.config.guard.fall_radps / plain.guard.fall_radps);
    TEST_ASSERT_TRUE(wh_conf_set(&conf, WH_CONF_inertia,
                                 WH_R(8.0) * plain.measure.rotor.inertia_kgm2) == WH_STATION_FINE);
    CHECK_NEAR(1e-5f, 0.5f, even.config.guard.fall_radps / plain.guard.fall_radps);
    TEST_ASSERT_TRUE(wh_conf_set(&conf, WH_CONF_gravity, WH_R(0.0)) == WH_STATION_FINE);
    TEST_ASSERT_TRUE(even.config.compensation.weight_Nm < WH_R(1e-9) &&
                     even.config.guard.fall_radps < WH_R(1e-9));
    TEST_ASSERT_TRUE(wh_conf_set(&conf, WH_CONF_mount_factor, WH_R(0.25)) == WH_STATION_FINE);
    CHECK_NEAR(1e-5f, 0.5f, even.config.guard.load_still_kgm / plain.guard.load_still_kgm);
}

/* Settings that another program has saved: unknown numbers, values out of range, settings that contradict each
 * other. */
TEST(station_conf, settings_of_another_program) {
    static const struct {
        uint8_t payload[16];
        unsigned count;
        wh_conf_id set; /* the only valid setting; its value is `to` */
        float to;
    } rows[] = {
        /* setting 18 with 10.0, and the unknown setting 200 */
        {{18, 0, 0, 0x20, 0x41, 200, 0, 0, 0x20, 0x41}, 10, WH_CONF_record_turns, 10.0f},
        /* setting 7 with 2.0, which is out of range; 18 with NaN; 18 cut off */
        {{7, 0, 0, 0, 0x40, 18, 0, 0, 0xC0, 0x7F, 18, 0, 0}, 13, WH_CONF_COUNT, 0.0f},
        /* setting 32 with 0.5, which is no value of a switch */
        {{32, 0, 0, 0, 0x3F}, 5, WH_CONF_COUNT, 0.0f},
        /* setting 28 with 50 V, above its maximum, contradicts others: none is taken, not even 18 */
        {{28, 0, 0, 0x48, 0x42, 18, 0, 0, 0x20, 0x41}, 10, WH_CONF_COUNT, 0.0f},
        {{0}, 0, WH_CONF_COUNT, 0.0f}};
    wh_rig_config plain;
    own(&plain);
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        begin();
        uint8_t record[WH_STORE_SLOT_BYTES];
        memcpy(record + WH_STORE_HEAD_BYTES, rows[i].payload, sizeof rows[i].payload);
        TEST_ASSERT_TRUE(wh_store_save(&memory, record, rows[i].count) != 0);
        wh_conf_start(&conf, own, &memory, &even.config);
        for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
            const wh_real wanted = id == rows[i].set ? (wh_real)rows[i].to : conf.standard[id];
            TEST_ASSERT_TRUE(conf.value[id] == wanted);
        }
        if (rows[i].set == WH_CONF_COUNT) {
            check_same(&plain, &even.config);
        }
    }
    wh_conf_start(&conf, own, NULL, &even.config);
    TEST_ASSERT_TRUE(wh_conf_save(&conf) == WH_STATION_CONF_FAILED);
}

TEST(station_conf, list_is_complete_and_valid_input) {
    begin();
    unsigned from = 0;
    unsigned told = 0;
    for (unsigned lines = 0; lines < WH_CONF_COUNT; lines++) {
        char line[40];
        wh_text text;
        wh_text_start(&text, line, sizeof line);
        wh_text_add(&text, "conf list ");
        wh_text_add_unsigned(&text, from);
        check_begins(settings_told(), ask(line));
        from = WH_CONF_COUNT;
        char *words = heard + strlen(settings_told());
        for (char *end = words; end != NULL; words = end + 1) {
            end = strchr(words, ' ');
            if (end != NULL) {
                *end = '\0';
            }
            char *value = strchr(words, '=');
            TEST_ASSERT_NOT_NULL(value);
            *value++ = '\0';
            if (strcmp(words, "next") == 0) {
                wh_real number = 0;
                TEST_ASSERT_TRUE(wh_line_number(value, &number) && end == NULL);
                from = (unsigned)number;
            } else {
                TEST_ASSERT_EQUAL_UINT(told, wh_conf_find(words));
                const wh_real before = conf.value[told];
                TEST_ASSERT_TRUE(wh_conf_type(&conf, (wh_conf_id)told, value) == WH_STATION_FINE);
                CHECK_NEAR((float)WH_ABS(before) * 2e-6f + 1e-8f, before, conf.value[told]);
                told++;
            }
            if (end == NULL) {
                break;
            }
        }
        if (from == WH_CONF_COUNT) {
            break;
        }
        TEST_ASSERT_EQUAL_UINT(told, from);
    }
    TEST_ASSERT_EQUAL_UINT(WH_CONF_COUNT, told);
}

/* `conf list N` begins at setting N. A fraction of N is ignored, and a number that no setting has is refused. */
TEST(station_conf, where_a_list_begins) {
    begin();
    unsigned below = 0;
    for (unsigned i = 0; i < draw_cases(2000); i++) {
        char line[60];
        wh_text text;
        const bool negative = draw_one_in(&seed, 3);
        const unsigned whole = draw_one_in(&seed, 2) ? 0U : draw_one_of(&seed, 60);
        const unsigned part = draw_one_of(&seed, 10000);
        wh_text_start(&text, line, sizeof line);
        wh_text_add(&text, negative ? "conf list -" : "conf list ");
        wh_text_add_fixed(&text, (wh_real)whole + (wh_real)part / 10000, 4);
        const bool is = whole < WH_CONF_COUNT && !(negative && whole + part > 0);
        below += negative && whole == 0 && part > 0;
        check_begins(is ? settings_told() : "ERR 109 ", ask(line));
    }
    TEST_ASSERT_TRUE(below > draw_cases(2000) / 12U);
}

TEST(station_conf, refusals) {
    static const struct {
        const char *line;
        const char *answer;
    } rows[] = {
        {"conf", "ERR 108 "},
        {"conf all", "ERR 108 "},
        {"conf get", "ERR 108 "},
        {"conf set", "ERR 108 "},
        {"conf set gain", "ERR 108 "},
        {"conf get gain now", "ERR 108 "},
        {"conf save now", "ERR 108 "},
        {"conf default gain", "ERR 108 "},
        {"conf set gain 1 2", "ERR 102 "},
        {"conf list 1 2", "ERR 102 "},
        {"conf list -1", "ERR 109 "},
        {"conf list all", "ERR 109 no such setting; conf list FROM shows them from number FROM"},
        {"conf get gains", "ERR 109 "},
        {"conf set gains 1", "ERR 109 "},
        {"conf set gain much", "ERR 110 "},
        {"conf set swings 1", "ERR 110 "},
        {"conf set swings o", "ERR 110 "},
        {"conf set swings off|on", "ERR 110 "},
        {"conf set gain 0.009", "ERR 111 "},
        {"conf set gain 5.1", "ERR 111 "},
        {"conf set cell_delay 1.5", "ERR 111 "},
        {"conf set speed_limit 360", "ERR 112 "},
        {"conf set speed_most 100", "ERR 112 "},
        {"conf set supply_most 5", "ERR 112 "},
        {"conf get swings", "OK swings=off type=off|on default=off: end a run"},
        {"conf set swings on", "OK swings=on"},
        {"conf get swings", "OK swings=on type=off|on default=off"},
        {"conf set compensation always", "OK compensation=always"},
        {"conf set speed_most 350.5", "OK speed_most=350.5"},
        {"conf get cell_delay",
         "OK cell_delay=0 type=whole unit=us least=0 most=100000 default=0: delay of"},
        {"conf save", "OK sequence=1"},
        {"conf default", "OK"},
        {"conf get compensation", "OK compensation=slow type=never|slow|always default=slow"},
        {"conf save", "OK sequence=2"},
        {"arm", "OK arm"},
        {"conf set gain 1", "ERR 107 "},
        {"conf save", "ERR 107 "},
        {"conf default", "ERR 107 "},
        {"conf get gain", "OK gain=0.24"},
        {"conf list", "OK settings="},
        {"stop", "OK"},
        {"conf set gain 1", "OK gain=1"}};
    begin();
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        check_begins(rows[i].answer, ask(rows[i].line));
    }
    memory_fails = true;
    check_begins("ERR 113 ", ask("conf save"));
    station.conf = NULL;
    check_begins("ERR 114 ", ask("conf list"));
}

/* Two settings change the measurement: the cell is twice as sensitive, the masses are half as large. */
TEST(station_conf, a_run_with_settings) {
    begin();
    check_begins("OK", ask("conf set cell_scale 20"));
    check_begins("OK", ask("conf set speed_least 120"));
    check_begins("OK", ask("arm"));
    check_begins("OK", ask("start 250"));
    even_go_on_until(&even, WH_PHASE_RAMP_DOWN);
    check_begins("OK result=", ask("measure"));
    CHECK_NEAR(0.05f, 2.0f * (float)EVEN_LOAD_N, even.rig.result.force.amplitude_N);
}
