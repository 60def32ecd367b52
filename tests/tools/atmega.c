/* atmega.c: the rig's firmware on an ATmega2560 in simavr, cycle by cycle, with the rig round its pins (mega.h).
 *
 *     atmega boot|orders|run|busy|slots|storm|faults|resets|supply|settings IMAGE [TIMES [SEED]]
 *
 * Prints "ok - ..." or "not ok - ..." lines, and figures after #. The exit status is 1 after a "not ok". */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/tools/atmega.h"
#include "tests/tools/mega_parts.h"

#define PERIOD_CYCLES (MEGA_HZ / 500U)
#define STEP_MOST (PERIOD_CYCLES * 85U / 100U)

char answer[400];

bool asks(const char *order, const char *begin) {
    return mega_answers(order, begin, answer, sizeof answer) ||
           no("'%s': '%s', not '%s'", order, answer, begin);
}

bool runs(unsigned rpm, unsigned ms) {
    char order[20];
    mega_start(image);
    mega_run(1600);
    snprintf(order, sizeof order, "start %u", rpm);
    return asks("arm", "OK arm") && asks(order, "OK start") && (mega_run(ms) || no("it ended"));
}

static bool boots(unsigned times) {
    static const struct {
        const char *order;
        const char *begin;
    } said[] = {
        {"id", "OK program=rig board=atmega2560 dialogue=1"},
        {"status", "OK state=idle speed_rpm=- set_rpm=0.00 motor_V=0.00 trip=0 result=none"},
        {"arm", "ERR 11 "},
        {"start 330", "ERR 1 "},
        {"conf list", "OK settings="},
        {"conf get inertia",
         "OK inertia=0.0057679 type=real unit=kgm2 least=0.00001 most=10 default=0.0057679: moment"},
        {"conf get compensation", "OK compensation=never "},
        {"conf set compensation always", "ERR 114 this program does not support it"},
        {"conf set swings on", "ERR 114 this program does not support it"},
        {"tel list", "ERR 114 this program does not support it"},
        {"help talk", "OK talk on|off: echo typed"},
        {"measure", "ERR 104 there is no result"},
        {"nonsense", "ERR 100 no such command"}};
    (void)times;
    mega_start(image);
    mega_run(20);
    for (unsigned i = 0; i < sizeof said / sizeof said[0]; i++) {
        if (!asks(said[i].order, said[i].begin)) {
            return false;
        }
    }
    mega_run(1500);
    return asks("selftest", "OK selftest=good arithmetic=good clock=good") && asks("arm", "OK") &&
           asks("start 100", "ERR 14 ") && asks("stop", "OK");
}

static double number_of(const char *name) {
    const char *at = strstr(answer, name);
    return at == NULL ? -1.0 : strtod(at + strlen(name), NULL);
}

/* Runs until the rig is idle again. If `busy`, asks for the state once per millisecond, otherwise twice per second.
 * The limit is 150 s, because without dry friction the rotor coasts for a minute. */
static bool goes_on(bool busy) {
    const uint64_t end = mega_cycle() + 150ULL * MEGA_HZ;
    while (mega_cycle() < end) {
        if (!mega_run(busy ? 1 : 500) || !asks("status", "OK state=")) {
            return false;
        }
        if (strstr(answer, "trip=0") == NULL) {
            return no("it tripped: %s", answer);
        }
        if (strstr(answer, "state=idle") != NULL) {
            return true;
        }
    }
    return no("it does not end: %s", answer);
}

static bool measures(unsigned rpm, bool busy) {
    if (!runs(rpm, 0) || !goes_on(busy) || !asks("measure", "OK result=good")) {
        return false;
    }
    const mega_times *times = mega_times_now();
    const uint64_t period = PERIOD_CYCLES;
    const double force_N = number_of("force_N=");
    const double expected_N = number_of("expected_N=");
    const double phase_deg = number_of("phase_deg=");
    const double speed_rpm = number_of("speed_rpm=");
    printf("# %u rpm%s: %s\n", rpm, busy ? ", asked all the time" : "", answer);
    printf(
        "# cycles of %llu control steps: mean %llu, worst %llu (%.1f %% of a period), with an answer "
        "%llu; %llu began late\n",
        (unsigned long long)times->steps, (unsigned long long)(times->sum_step / times->steps),
        (unsigned long long)times->worst_step, 100.0 * (double)times->worst_step / (double)period,
        (unsigned long long)times->worst_loop, (unsigned long long)times->late);
    return (fabs(force_N - expected_N) < 0.002 * expected_N ||
            no("%.3f N instead of %.3f", force_N, expected_N)) &&
           (fabs(phase_deg) < 0.1 || no("%.3f degrees off", phase_deg)) &&
           (fabs(speed_rpm - rpm) < 0.1 || no("%.3f rpm", speed_rpm)) &&
           (times->worst_step <= STEP_MOST ||
            no("a control step takes %llu cycles", (unsigned long long)times->worst_step));
}

static bool is_given(unsigned rpm) { return measures(rpm, false); }
static bool is_busy(unsigned rpm) { return measures(rpm, true); }

#define SCRATCH 0x3E000U /* flash that no image uses */

/* LDI r16, byte; STS address, r16 */
static uint32_t put_store(uint32_t at, unsigned address, unsigned byte) {
    (void)mega_set_flash(at, (uint16_t)(0xE000U | (byte << 4 & 0xF00U) | (byte & 0xFU)));
    (void)mega_set_flash(at + 2U, 0x9300U);
    (void)mega_set_flash(at + 4U, (uint16_t)address);
    return at + 6U;
}

/* Sets up a timer in random order and modes. ICRn takes a value in the modes that use it as TOP (DS 17.9, table 17-2). */
static bool takes_top(unsigned base) {
    static const bool is_top[16] = {[8] = true, [10] = true, [12] = true, [14] = true};
    uint8_t control[2] = {0, 0};
    unsigned wanted = 0;
    uint32_t at = SCRATCH;
    mega_start(image);
    for (unsigned stores = 2U + below(8); stores > 0; stores--) {
        const unsigned which = below(3);
        if (which < 2) {
            const unsigned bits = below(4);
            control[which] = (uint8_t)(which == 0 ? bits : bits << 3 | below(2));
            at = put_store(at, base + which, control[which]);
        } else {
            const unsigned top = 1U + below(65535);
            at = put_store(at, base + 7U, top >> 8);
            at = put_store(at, base + 6U, top & 0xFFU);
            wanted = is_top[(control[0] & 3U) | (control[1] >> 1 & 0xCU)] ? top : wanted;
        }
    }
    (void)mega_set_flash(at, 0x9508U); /* RET */
    mega_call(SCRATCH, (const uint8_t[4]){0, 0, 0, 0});
    const uint8_t *data = mega_data() + base;
    const unsigned top = data[6] | (unsigned)data[7] << 8;
    return top == wanted || no("ICR of the timer at 0x%X is %u, not %u", base, top, wanted);
}

static void call_with(const char *name, const void *argument, size_t bytes) {
    uint8_t arguments[4] = {0, 0, 0, 0};
    memcpy(arguments + 4 - (bytes == 4 ? 4 : 2), argument, bytes);
    mega_call(mega_symbol(name), arguments);
}

/* The motor brakes or coasts from any voltage and instant of the PWM's period, then is started again. The timer has
 * the ordered duty, and mega_parts.c checks that the pin is low at each start. */
static bool starts_low(unsigned times) {
    const uint32_t wait = mega_symbol("hal_clock_wait_until");
    for (unsigned i = 0; i < times; i++) {
        const float volts = (float)below(24001) / 1000.0f;
        const uint8_t way = (uint8_t)below(2);
        while (mega_pc() != wait) {
            mega_step();
        }
        call_with("hal_motor_start", "", 0);
        call_with("hal_motor_set_voltage", &volts, sizeof volts);
        const mega_motor motor = mega_motor_now();
        if (!motor.enabled || fabsf(motor.duty * 24.0f - volts) > 0.15f) {
            return no("%.3f V give a duty of %.4f", (double)volts, (double)motor.duty);
        }
        for (unsigned steps = below(500); steps > 0; steps--) {
            mega_step();
        }
        call_with("hal_motor_off", &way, sizeof way);
        mega_step();
    }
    return true;
}

static bool keeps_order(unsigned times) {
    for (unsigned i = 0; i < times; i++) {
        if (!takes_top(mega_timer_base[i % MEGA_TIMERS])) {
            return false;
        }
    }
    mega_start(image);
    mega_run(100);
    return starts_low(times);
}

int main(int count, char **words) {
    static const board_test tests[] = {
        {"boot", boots, 1, "boots, converses, and refuses by name what it is built without"},
        {"orders", keeps_order, 200,
         "ICRn is written in modes that have it as TOP alone; a start gives the duty, and no pulse"},
        {"run", is_given, 330,
         "a run gives the force; no control step takes more than 85 % of its period"},
        {"busy", is_busy, 330, "the same while it is asked for its state all the time"},
        {"slots", sees_edges, 300, "each edge once, in order, within 1 us of its time"},
        {"storm", survives_storm, 20000, "a storm of edges takes no control step its time"},
        {"faults", all_faults, 12,
         "a fault in whatever state: off first, then the record, reset, report; a trip stays"},
        {"resets", all_resets, 20,
         "a reset at any instant: not driven, idle or tripped as before, its cause told"},
        {"supply", sees_supply, 8,
         "an over-voltage, whatever is set: arm is refused, a run trips at once"},
        {"settings", keeps_settings, 1, "settings torn at any byte are the old or the new"},
    };
    board_test asked;
    return board_test_asked(count, words, tests, sizeof tests / sizeof tests[0], &asked) == NULL
               ? 2
               : board_test_tell(asked.holds(asked.times), asked.what);
}
