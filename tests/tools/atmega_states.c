/* atmega_states.c: faults, resets and supply failures in random states of the rig. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/tools/atmega.h"

enum { POWER_ON = 1, EXTERNAL = 2, BROWN_OUT = 4 }; /* flags of MCUSR */
#define HANG 0xCFFFU                                /* a jump to itself */

/* Brings the rig into a random state: idle, armed, at some time of a run, or tripped. *tripped: a trip is latched.
 * Returns false if that failed. */
static bool draw_state(bool *tripped) {
    *tripped = false;
    const unsigned state = below(4);
    if (state == 0) {
        mega_start(image);
        return mega_run(20 + below(1000));
    }
    if (state == 1U) {
        mega_start(image);
        mega_run(1600);
        return asks("arm", "OK arm") && mega_run(1 + below(500));
    }
    if (state == 2U) {
        return runs(200 + below(150), 10 + below(7000));
    }
    *tripped = true;
    if (!runs(250, 2600 + below(2000))) {
        return false;
    }
    mega_supply_V = 8.0f; /* below its range */
    mega_run(60);
    mega_supply_V = 24.0f;
    return mega_run(100) && asks("fault", "OK trip=11");
}

/* Over-voltage up to 60 V is detected even if a setting allows it: `arm` is refused, and a run trips within two
 * samples. */
bool sees_supply(unsigned times) {
    for (unsigned i = 0; i < times; i++) {
        const bool set = below(2) == 1U;
        const float supply_V =
            set ? 50.0f + (float)below(10001) / 1000.0f : 37.3f + (float)below(22701) / 1000.0f;
        const bool in_run = i % 8U == 7U;
        mega_start(image);
        mega_run(1600);
        if (set && !asks("conf set supply_most 60", "OK")) {
            return false;
        }
        if (in_run && (!asks("arm", "OK arm") || !asks("start 250", "OK start"))) {
            return false;
        }
        mega_run(in_run ? 1U + below(5000) : 0U);
        mega_supply_V = supply_V;
        mega_run(25);
        mega_supply_V = in_run ? 24.0f : supply_V;
        if (!(in_run ? asks("fault", "OK trip=11 ")
                     : asks("arm", "ERR 9 the motor's supply is out of its range: supply_V="))) {
            return no("%.3f V: %s", (double)supply_V, answer);
        }
        mega_supply_V = 24.0f;
    }
    return true;
}

/* Maximum number of cycles from a fault until the enable is off. */
#define OFF_CYCLES 40U

static bool is_off_within(uint64_t cycles) {
    const uint64_t end = mega_cycle() + cycles;
    while (mega_motor_now().enabled) {
        if (mega_cycle() > end || !mega_step()) {
            return no("the motor is on %llu cycles later", (unsigned long long)cycles);
        }
    }
    return true;
}

/* Checks that the firmware restarts, reports `cause` (NULL: nothing), does not drive by itself, and is tripped as
 * before. */
static bool begins_anew(const char *cause, bool tripped) {
    const uint64_t end = mega_cycle() + MEGA_HZ / 5U;
    char line[300] = "";
    const bool says = mega_hear(line, sizeof line, 200);
    if (says != (cause != NULL) || (says && strncmp(line, cause, strlen(cause)) != 0)) {
        return no("it says '%s', not '%s'", line, cause != NULL ? cause : "");
    }
    while (mega_cycle() < end) {
        if (!mega_step()) {
            return no("it ended");
        }
        if (mega_motor_now().enabled) {
            return no("it drives after a reset");
        }
    }
    return asks("status", tripped ? "OK state=tripped" : "OK state=idle") &&
           asks("fault", tripped ? "OK trip=11" : "OK trip=0") && asks("start 330", "ERR ");
}

static bool hangs(void) {
    const uint32_t kick = mega_symbol("hal_watchdog_kick");
    const uint16_t was = mega_set_flash(kick, HANG);
    const uint64_t began = mega_cycle();
    bool off = true;
    while (mega_pc() != 0) {
        if (mega_cycle() - began > MEGA_HZ / 10U || !mega_step()) {
            off = no("the watchdog has not bitten within 100 ms");
            break;
        }
    }
    mega_set_flash(kick, was);
    return off && is_off_within(0) && begins_anew("# reset: watchdog", false);
}

static bool one_fault(unsigned kind, bool tripped) {
    if (kind == 0) { /* an interrupt without a handler */
        mega_push_pc();
        mega_set_pc(4U * 9U);
        return is_off_within(OFF_CYCLES) &&
               begins_anew("# reset: fault: an interrupt has no handler", tripped);
    }
    if (kind == 1) { /* the stack's lowest byte: the firmware checks it once per control period */
        mega_data()[mega_symbol("_end")] ^= 0xFFU;
        return is_off_within(MEGA_HZ / 400U) &&
               begins_anew("# reset: fault: the stack reached", tripped);
    }
    mega_set_pc(0); /* a stray jump through erased flash ends at address 0 */
    return is_off_within(OFF_CYCLES) && begins_anew("# reset: fault: restarted without", tripped);
}

bool all_faults(unsigned times) {
    for (unsigned i = 0; i < times; i++) {
        bool tripped = false;
        const unsigned kind = i % 4U;
        if (kind == 3U ? !runs(250, 10 + below(6000)) || !hangs()
                       : !draw_state(&tripped) || !one_fault(kind, tripped)) {
            return false;
        }
    }
    return true;
}

bool all_resets(unsigned times) {
    for (unsigned i = 0; i < times; i++) {
        bool tripped = false;
        static const struct {
            uint8_t flag;
            const char *cause;
        } rows[] = {{EXTERNAL, "# reset: other"}, {BROWN_OUT, "# reset: supply"}, {POWER_ON, NULL}};
        const unsigned row = below(3); /* POWER_ON: a power loss so short that memory survives */
        if (!draw_state(&tripped)) {
            return false;
        }
        for (unsigned steps = below(60000); steps > 0; steps--) {
            mega_step();
        }
        mega_reset(rows[row].flag);
        const bool stays = tripped && rows[row].flag != POWER_ON;
        if (mega_motor_now().enabled || !begins_anew(rows[row].cause, stays)) {
            return false;
        }
        mega_reset(EXTERNAL); /* a cleared trip does not return */
        if (!begins_anew("# reset: other", stays)) {
            return false;
        }
    }
    return true;
}

#define TORN_MOST 1024U
static uint8_t (
    *torn)[MEGA_EEPROM_BYTES]; /* the state just before a byte changes, with that byte corrupted */
static unsigned torn_count;

static void tear(unsigned address) {
    if (torn_count < TORN_MOST) {
        memcpy(torn[torn_count], mega_eeprom(), MEGA_EEPROM_BYTES);
        torn[torn_count][address % MEGA_EEPROM_BYTES] = (uint8_t)below(256);
        torn_count++;
    }
}

/* Restarts from each torn content of the EEPROM. Returns true if the setting always has its old or its new value. */
static bool is_either(const char *old, const char *new, unsigned *news) {
    for (unsigned k = 0; k < torn_count; k++) {
        memcpy(mega_eeprom(), torn[k], MEGA_EEPROM_BYTES);
        mega_start(image);
        mega_run(10);
        if (!asks("conf get sensor2", "OK sensor2=")) {
            return false;
        }
        const bool is_new = strncmp(answer, new, strlen(new)) == 0;
        if (!is_new && strncmp(answer, old, strlen(old)) != 0) {
            return no("torn at write %u of %u: %s", k, torn_count, answer);
        }
        *news += is_new ? 1U : 0U;
    }
    return torn_count > 10U || no("only %u bytes were written", torn_count);
}

/* Four saves, so that both slots are erased and written. */
bool keeps_settings(unsigned times) {
    static const char *const values[] = {"90", "91.5", "88.25", "90.75", "89.5"};
    static const char *const others[] = {"conf set amplitude_floor 0.002",
                                         "conf set mass_moment 0.036", "conf set inertia 0.0058"};
    static uint8_t saved[MEGA_EEPROM_BYTES];
    unsigned cases = 0;
    unsigned news = 0;
    bool good = true;
    (void)times;
    torn = malloc(sizeof *torn * TORN_MOST);
    if (torn == NULL) {
        return no("no memory");
    }
    memset(mega_eeprom(), 0xFF, MEGA_EEPROM_BYTES);
    for (unsigned i = 0; good && i < 4; i++) {
        char old[40];
        char new[40];
        char set[40];
        snprintf(old, sizeof old, "OK sensor2=%s ", values[i]);
        snprintf(new, sizeof new, "OK sensor2=%s ", values[i + 1U]);
        snprintf(set, sizeof set, "conf set sensor2 %s", values[i + 1U]);
        mega_start(image);
        mega_run(20);
        torn_count = 0;
        mega_on_eeprom = tear;
        good = asks("conf get sensor2", old) && asks(set, "OK sensor2");
        for (unsigned k = 0; good && k < i; k++) { /* save number i has i more changed settings */
            good = asks(others[k], "OK ");
        }
        good = good && asks("conf save", "OK sequence");
        mega_on_eeprom = NULL;
        memcpy(saved, mega_eeprom(), sizeof saved);
        good = good && is_either(old, new, &news);
        cases += torn_count;
        memcpy(mega_eeprom(), saved, sizeof saved);
    }
    free(torn);
    printf(
        "# %u bytes of which each was spoilt as it was written: the new value %u times, else the old\n",
        cases, news);
    return good;
}
