/* atmega.c: the rig's firmware on an ATmega2560 in simavr, cycle by cycle, with the rig round its pins (mega.h).
 *
 *     atmega boot|run|busy|slots|storm|faults|resets|settings IMAGE [TIMES [SEED]]
 *
 * Prints "ok - ..." or "not ok - ..." lines, and figures behind #; exit status 1 if one is not. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/tools/atmega.h"

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

/* --- the console -------------------------------------------------------------------------------- */

static bool boots(unsigned times) {
    static const struct {
        const char *order;
        const char *begin;
    } said[] = {
        {"id", "OK program=rig board=atmega2560 dialogue=1"},
        {"status", "OK state=idle speed_rpm=? set_rpm=0.00 motor_V=0.00 trip=0 result=none"},
        {"arm", "ERR 11 "},
        {"start 330", "ERR 1 "},
        {"conf list", "OK settings=36 mass_moment=0.03516284 inertia=0.0057679 "},
        {"conf get inertia",
         "OK inertia=0.0057679 type=real unit=kgm2 least=0.00001 most=10 default=0.0057679: of"},
        {"conf get feeds", "OK feeds=never "},
        {"conf set feeds always", "ERR 114 this program has none"},
        {"conf set swings on", "ERR 114 this program has none"},
        {"tel list", "ERR 114 this program has none"},
        {"help talk", "OK talk on|off: echo what is typed"},
        {"measure", "ERR 104 no run has given a result yet"},
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

/* --- runs ------------------------------------------------------------------------------------------ */

static double number_of(const char *name) {
    const char *at = strstr(answer, name);
    return at == NULL ? -1.0 : strtod(at + strlen(name), NULL);
}

/* Until the run is through, asking for nothing, or for the state all the time. */
static bool goes_on(bool busy) {
    const uint64_t end = mega_cycle() + 60ULL * MEGA_HZ;
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

int main(int count, char **words) {
    static const board_test tests[] = {
        {"boot", boots, 1, "boots, converses, and refuses by name what it is built without"},
        {"run", is_given, 330,
         "a run gives the force; no control step takes more than 85 % of its period"},
        {"busy", is_busy, 330, "the same while it is asked for its state all the time"},
        {"slots", sees_edges, 300, "each edge once, in order, within 1 us of its time"},
        {"storm", survives_storm, 20000, "a storm of edges takes no control step its time"},
        {"faults", all_faults, 12,
         "a fault in whatever state: off first, then the record, reset, report; a trip stays"},
        {"resets", all_resets, 20,
         "a reset at any instant: not driven, idle or tripped as before, its cause told"},
        {"settings", keeps_settings, 1, "settings torn at any byte are the old or the new"},
    };
    board_test asked;
    return board_test_asked(count, words, tests, sizeof tests / sizeof tests[0], &asked) == NULL
               ? 2
               : board_test_tell(asked.holds(asked.times), asked.what);
}
