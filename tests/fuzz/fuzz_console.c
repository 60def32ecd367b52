/* fuzz_console.c: random bytes at the rig's console must do only what a line allows. Answers must be whole lines,
 * settings must stay in range, telemetry in its buffer, and the motor's voltage between zero and the supply.
 *
 * The input is a sequence of control steps. The first byte of a step gives the number of bytes that arrive (low five
 * bits), whether a pulse and a sample come, and whether the host reads. These bytes follow. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/station/station.h"

enum {
    STEPS_PER_S = 500,
    STEP_TICKS = 2000,
    SLOT_BYTES = 256,
    PULSED = 32,
    SAMPLED = 64,
    READ = 128
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static uint8_t kept[WH_STORE_SLOTS][SLOT_BYTES];
static bool fails; /* if true, writing the settings fails */

static bool erase(unsigned slot) {
    memset(kept[slot], 0xFF, SLOT_BYTES);
    return !fails;
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

static void own(wh_rig_config *config) {
    *config = wh_rig_standard;
    config->measure.cell =
        (wh_cell_config){.newton_per_count = 0.0068f, .period_ticks = STEP_TICKS, .raw_max = 32767};
    wh_rig_slots(config, 0.0175f);
}

static void must(bool holds) {
    if (!holds) {
        abort();
    }
}

typedef struct bench {
    wh_rig rig;
    wh_rig_config config;
    wh_station station;
    wh_conf conf;
    wh_tel tel;
    uint32_t ticks;
    bool any_telemetry;
} bench;

static void look(const bench *b, const wh_rig_command *command) {
    must(command->volts >= 0.0f && command->volts <= 24.0f);
    must(command->way == WH_MOTOR_DRIVES || command->volts <= 0.0f);
    must(wh_ring_waiting(&b->station.out) <= WH_STATION_OUT_BYTES);
    for (unsigned i = 0; i < WH_CONF_COUNT; i++) {
        const wh_conf_row row = wh_conf_row_of((wh_conf_id)i);
        must(b->conf.value[i] >= row.least && b->conf.value[i] <= row.most);
    }
    must(b->config.guard.target_max_radps < b->config.guard.limit_radps);
}

/* The output must be whole lines of printable characters, except for the echo. */
static void hear(bench *b) {
    char bytes[WH_STATION_OUT_BYTES];
    const unsigned count = wh_station_peek(&b->station, bytes, sizeof bytes);
    wh_station_drop(&b->station, count);
    if (b->any_telemetry || b->station.talks || count == 0) {
        return;
    }
    must(memchr(bytes, 0, count) == NULL);
}

static size_t step(bench *b, const uint8_t *data, size_t size) {
    const uint8_t how = data[0];
    const size_t come = (size_t)(how & 31U) < size - 1U ? (size_t)(how & 31U) : size - 1U;
    wh_step_inputs seen = {.inputs = {.now_ticks = b->ticks, .supply_V = 24.0f}};
    if ((how & PULSED) != 0) {
        seen.pulsed = true;
        seen.sensor = b->ticks / STEP_TICKS & 1U;
        seen.pulse_ticks = b->ticks - 300U;
        wh_rig_pulse(&b->config, &b->rig, seen.sensor, seen.pulse_ticks);
    }
    if ((how & SAMPLED) != 0) {
        seen.samples = 1;
        seen.sample[0] = (wh_step_sample){b->ticks - 100U, (int32_t)how * 250 - 30000,
                                          (wh_load_status)(how % WH_LOAD_STATUSES)};
        wh_rig_load(&b->config, &b->rig, seen.sample[0].ticks, seen.sample[0].raw,
                    seen.sample[0].status);
    }
    const wh_rig_command command = wh_rig_step(&b->config, &b->rig, &seen.inputs);
    wh_station_take(&b->station, (const char *)data + 1, (unsigned)come);
    wh_station_see(&b->station, &b->config, &b->rig, &seen);
    wh_station_step(&b->station, &b->rig);
    b->any_telemetry = b->any_telemetry || b->tel.every > 0 || b->tel.reads;
    if ((how & READ) != 0) {
        hear(b);
    }
    look(b, &command);
    b->ticks += STEP_TICKS;
    return 1U + come;
}

/* Starts the rig and its console, and steps until the rotor counts as at rest: then the rig obeys orders. */
static void rest(bench *b) {
    b->ticks = 0xFFFF0000U;
    wh_station_start(&b->station, "rig", "here", STEPS_PER_S);
    wh_conf_start(&b->conf, own, &memory, &b->config);
    b->station.conf = &b->conf;
    b->station.tel = &b->tel;
    wh_rig_start(&b->config, &b->rig, b->ticks, NULL);
    for (unsigned i = 0; i < 800U; i++) {
        wh_rig_inputs inputs = {.now_ticks = b->ticks, .supply_V = 24.0f};
        wh_rig_load(&b->config, &b->rig, b->ticks, 500, WH_LOAD_OK);
        (void)wh_rig_step(&b->config, &b->rig, &inputs);
        b->ticks += STEP_TICKS;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static bench b; /* static, because it contains pointers to itself */
    static bench rested;
    static bool any;
    memset(kept, 0xFF, sizeof kept);
    if (!any) {
        rest(&b);
        rested = b;
        any = true;
    }
    b = rested;
    fails = size > 0 && data[0] == 0xFFU;
    for (size_t at = 0; at < size;) {
        at += step(&b, data + at, size - at);
    }
    /* at the next start, the stored settings or the defaults must load */
    static wh_conf again;
    static wh_rig_config config;
    wh_conf_start(&again, own, &memory, &config);
    b.config = config;
    const wh_rig_command none = {WH_MOTOR_COASTS, 0.0f};
    b.conf = again;
    look(&b, &none);
    return 0;
}
