/* test_rig_pulses.c: finds the true slot pulses of a rotor with gravity's ripple, among jitter, disturbances, losses
 * and bounces. */
#include <stddef.h>

#include "draw.h"
#include "even_rig.h"
#include "rotor.h"
#include "tests/suites.h"

#define RPM EVEN_RPM
#define STEP_TICKS EVEN_STEP_TICKS
#define TRAIN_PULSES 24U
#define SETTLED 6U    /* from this pulse on the speed must be right */
#define DISTURBED 12U /* number of the pulse before the false one */
#define MOST_PULSES (TRAIN_PULSES * 5U)
#define JITTER_TICKS 60U
/* Within this time, a false pulse may replace a true one of the same sensor, because a pulse's time is uncertain by
 * four times the jitter. */
#define TELLING_TICKS (4U * JITTER_TICKS)

static const wh_real speeds_rpm[] = {WH_R(100.0), WH_R(140.0), WH_R(170.0),
                                     WH_R(250.0), WH_R(330.0), WH_R(360.0)};
#define SPEEDS (sizeof speeds_rpm / sizeof speeds_rpm[0])

static wh_rig rig;
static wh_rig_config config;
static uint64_t seed;

/* The true pulses, starting with sensor 0; the timer wraps between them. */
static wh_pulse train[TRAIN_PULSES];
static wh_real mean_radps;

static wh_pulse given[MOST_PULSES];
static unsigned given_count;

/* Below WH_RIG_TARGET_MIN_RPM gravity is compensated; here gravity is zero instead, so the speed is constant. */
static rotor_kind kind_at(wh_real rpm) {
    rotor_kind kind = rotor_nominal();
    kind.jitter_s = WH_R(1e-6) * (wh_real)JITTER_TICKS;
    kind.weight_Nm = rpm < WH_RIG_TARGET_MIN_RPM ? WH_R(0.0) : kind.weight_Nm;
    return kind;
}

static wh_real drive_at(const rotor_kind *kind, wh_real speed_radps) {
    return speed_radps / kind->no_load_radps + kind->drag_Nms * speed_radps / kind->stall_Nm;
}

static void make_train(wh_real rpm) {
    const rotor_kind kind = kind_at(rpm);
    const wh_real drive = drive_at(&kind, rpm * RPM);
    rotor_state rotor = {
        .ticks = UINT32_MAX - 4500000U, .speed_radps = rpm * RPM, .seed = draw_bits(&seed)};
    rotor_turn(&kind, &rotor, drive, 3000000U);
    unsigned count = 0;
    while (count < TRAIN_PULSES) {
        rotor_turn(&kind, &rotor, drive, STEP_TICKS);
        for (unsigned i = 0; i < rotor.pulses && count < TRAIN_PULSES; i++) {
            if (rotor.pulse_sensor[i] == count % 2U) {
                train[count++] =
                    (wh_pulse){.ticks = rotor.pulse_ticks[i], .sensor = rotor.pulse_sensor[i]};
            }
        }
    }
    const unsigned turns = TRAIN_PULSES / 2U - 1U;
    mean_radps = WH_RIG_TWO_PI * (wh_real)turns * (wh_real)WH_RIG_TICKS_PER_S /
                 (wh_real)(train[2U * turns].ticks - train[0].ticks);
    CHECK_NEAR(0.03f * (float)rpm, rpm, mean_radps / RPM);
}

static unsigned quarters_of(unsigned pulse) { return pulse / 2U * 4U + pulse % 2U; }

static uint32_t apart(uint32_t a_ticks, uint32_t b_ticks) {
    const uint32_t ticks = a_ticks - b_ticks;
    return ticks >> 31 != 0 ? 0U - ticks : ticks;
}

/* Puts the train into the input, except for `lost` pulses, beginning with DISTURBED. */
static void give_train(unsigned lost) {
    given_count = 0;
    for (unsigned i = 0; i < TRAIN_PULSES; i++) {
        if (i < DISTURBED || i >= DISTURBED + lost) {
            given[given_count++] = train[i];
        }
    }
}

/* Adds a pulse to the input: before other pulses of the same time or, if `behind`, after them. */
static void give(unsigned sensor, uint32_t ticks, bool behind) {
    TEST_ASSERT_TRUE(given_count < MOST_PULSES);
    unsigned at = given_count++;
    for (; at > 0; at--) {
        const int32_t later = (int32_t)(given[at - 1U].ticks - ticks);
        if (later < 0 || (later == 0 && behind)) {
            break;
        }
        given[at] = given[at - 1U];
    }
    given[at] = (wh_pulse){.ticks = ticks, .sensor = sensor};
}

static void stand_in(wh_rig_phase phase) {
    config = even_config();
    const uint32_t now = train[0].ticks - STEP_TICKS;
    wh_rig_start(&config, &rig, now, NULL);
    wh_run_start(&rig.run, mean_radps, now);
    rig.state = WH_RIG_RUNNING;
    rig.run.phase = phase;
    rig.run.volts = wh_run_needs_V(&config.run, mean_radps);
    wh_drive_start(&rig.run.drive, mean_radps, rig.run.volts);
}

typedef struct outcome {
    unsigned pulses;
    unsigned gaps;
    unsigned strange;   /* number of confirmed pulses that are false, or have a wrong position */
    uint32_t off_ticks; /* largest error of a confirmed pulse's time */
    wh_real off_rpm;    /* largest error of the speed */
} outcome;

/* Returns the true pulse to which a confirmed one belongs; the search begins with number `from`. */
static unsigned true_pulse(const wh_index_pulse *index, unsigned from) {
    unsigned best = from;
    for (unsigned i = from; i < TRAIN_PULSES && i < from + 6U; i++) {
        if (apart(train[i].ticks, index->pulse.ticks) <
            apart(train[best].ticks, index->pulse.ticks)) {
            best = i;
        }
    }
    return best;
}

/* Processes all input in control steps. The steps' own times are up to `early` before the pulses. */
static outcome play(uint32_t early) {
    outcome out = {.pulses = 0};
    uint32_t now = train[0].ticks - 1000U;
    const uint32_t end = train[TRAIN_PULSES - 1U].ticks + 200000U;
    unsigned next = 0;
    unsigned from = 0;
    uint32_t base = 0; /* count of quarter turns minus the true count */
    while ((int32_t)(end - now) > 0) {
        const uint32_t due = next < given_count ? given[next].ticks - early : end;
        now = early > 0 && (int32_t)(due - now) > 0 && apart(due, now) < STEP_TICKS
                  ? due
                  : now + STEP_TICKS;
        for (; next < given_count && (int32_t)(now + early - given[next].ticks) >= 0; next++) {
            wh_rig_pulse(&config, &rig, given[next].sensor, given[next].ticks);
        }
        wh_index_pulse index;
        while (wh_pulses_confirmed(&rig.pulses, now, &index)) {
            const unsigned at = true_pulse(&index, from);
            const uint32_t off = apart(index.pulse.ticks, train[at].ticks);
            from = at + 1U;
            base = out.pulses == 0 || index.gap ? index.quarter - quarters_of(at) : base;
            out.gaps += index.gap ? 1U : 0U;
            out.strange += index.pulse.sensor != train[at].sensor || off > TELLING_TICKS ||
                                   index.quarter - quarters_of(at) != base
                               ? 1U
                               : 0U;
            out.off_ticks = off > out.off_ticks ? off : out.off_ticks;
            /* The next pulse may still reject this one. */
            TEST_ASSERT_TRUE((int32_t)(now - index.pulse.ticks) > 0);
            out.pulses++;
        }
        wh_guard_speed(&config.guard, &rig.guard, &rig.pulses, WH_TRIP_OVERSPEED, 0);
        wh_guard_pulses(&config.guard, &rig.guard, &rig.pulses, WH_R(2.0), now);
        if (out.pulses >= SETTLED) {
            const wh_real off_rpm = WH_ABS(rig.pulses.speed.turn_radps - mean_radps) / RPM;
            out.off_rpm = off_rpm > out.off_rpm ? off_rpm : out.off_rpm;
        }
    }
    TEST_ASSERT_EQUAL_UINT(given_count, next);
    return out;
}

/* Checks that exactly the true pulses are confirmed, at their positions. A false pulse within `off_ticks` of a true one
 * cannot be distinguished from it. */
static void check_pulses(const outcome *out, uint32_t off_ticks) {
    TEST_ASSERT_EQUAL_UINT(TRAIN_PULSES, out->pulses);
    TEST_ASSERT_EQUAL_UINT(0, out->strange + out->gaps);
    TEST_ASSERT_TRUE(out->off_ticks <= off_ticks);
    TEST_ASSERT_EQUAL_UINT32(0, rig.pulses.speed.lost);
}

TEST(rig_pulses, pulse_train_without_faults) {
    seed = 1;
    for (unsigned i = 0; i < SPEEDS; i++) {
        for (wh_rig_phase phase = WH_PHASE_RAMP; phase <= WH_PHASE_RECORD; phase++) {
            make_train(speeds_rpm[i]);
            give_train(0);
            stand_in(phase);
            const outcome out = play(0);
            check_pulses(&out, 0);
            TEST_ASSERT_EQUAL_UINT32(0, rig.pulses.rejected);
            TEST_ASSERT_TRUE(out.off_rpm < WH_R(0.5));
            TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
        }
    }
}

/* Returns the time from a pulse to the nearest true pulse of its sensor. */
static uint32_t apart_from_its_own(unsigned sensor, uint32_t ticks) {
    uint32_t least = UINT32_MAX;
    for (unsigned i = sensor; i < TRAIN_PULSES; i += 2U) {
        const uint32_t ticks_apart = apart(train[i].ticks, ticks);
        least = ticks_apart < least ? ticks_apart : least;
    }
    return least;
}

#define RAMP_FASTER WH_R(1.14) /* a turn shorter by the ramp's window of 0.12: 1/0.88 */

/* Adds a false pulse. It must be rejected, so that the confirmed pulses are the true ones. Within the jitter of a true
 * pulse, either may be confirmed. */
static outcome disturb(wh_rig_phase phase, unsigned sensor, uint32_t ticks, bool behind) {
    give_train(0);
    give(sensor, ticks, behind);
    stand_in(phase);
    const outcome out = play(0);
    const uint32_t near = apart_from_its_own(sensor, ticks);
    check_pulses(&out, near < TELLING_TICKS ? near : 0);
    TEST_ASSERT_EQUAL_UINT32(1, rig.pulses.rejected);
    /* Late on the ramp, a pulse that is as early as the window allows counts as over-speed until the true pulse
     * comes. */
    const bool over = phase == WH_PHASE_RAMP && rig.guard.trip == WH_TRIP_OVERSPEED &&
                      RAMP_FASTER * mean_radps > config.guard.limit_radps;
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE || over);
    return out;
}

#define PLACES 60U

/* In the record a wrong speed stops the run. While the rig settles, a pulse that is early within the window gives a
 * wrong speed until the true pulse comes. */
static void check_disturbed(wh_rig_phase phase, unsigned sensor, uint32_t ticks) {
    for (unsigned behind = 0; behind < 2; behind++) {
        const outcome out = disturb(phase, sensor, ticks, behind == 1);
        /* Bound on the error of the speed. Outside the record, a pulse may be as early as the window allows. */
        const wh_real most_rpm = phase == WH_PHASE_RECORD ? WH_R(2.0)
                                 : phase == WH_PHASE_SETTLE
                                     ? WH_R(0.035) * mean_radps / RPM
                                     : (RAMP_FASTER - WH_R(1.0)) * mean_radps / RPM;
        TEST_ASSERT_TRUE(out.off_rpm <= most_rpm);
    }
}

static void check_places(wh_rig_phase phase) {
    static const uint32_t near_ticks[] = {0, 1, 30, 60, 150, 400, 1000, 4000};
    seed = 2;
    for (unsigned i = 0; i < SPEEDS; i++) {
        make_train(speeds_rpm[i]);
        const uint32_t turn = train[DISTURBED + 2U].ticks - train[DISTURBED].ticks;
        for (unsigned sensor = 0; sensor < 2; sensor++) {
            for (unsigned place = 0; place < PLACES; place++) {
                check_disturbed(phase, sensor,
                                train[DISTURBED].ticks + (2U * place + 1U) * (turn / PLACES / 2U));
            }
            for (unsigned k = 0; k < 8; k++) { /* near the true pulses of either sensor */
                for (unsigned at = DISTURBED; at < DISTURBED + 2U; at++) {
                    check_disturbed(phase, sensor, train[at].ticks - near_ticks[k]);
                    check_disturbed(phase, sensor, train[at].ticks + near_ticks[k]);
                }
            }
        }
    }
}

TEST(rig_pulses, extra_pulse_in_the_record) { check_places(WH_PHASE_RECORD); }

TEST(rig_pulses, extra_pulse_while_settling) { check_places(WH_PHASE_SETTLE); }

TEST(rig_pulses, extra_pulse_on_the_ramp) { check_places(WH_PHASE_RAMP); }

/* Two false pulses come, with a given number of true pulses between them. Both are rejected. */
TEST(rig_pulses, two_extra_pulses) {
    seed = 7;
    for (unsigned i = 0; i < draw_cases(240); i++) {
        make_train(speeds_rpm[draw_one_of(&seed, SPEEDS)]);
        give_train(0);
        const unsigned first = DISTURBED + draw_one_of(&seed, 2);
        for (unsigned k = 0; k < 2U; k++) {
            const unsigned at = first + k * (1U + i % 3U);
            const uint32_t gap = train[at + 1U].ticks - train[at].ticks;
            give(draw_one_of(&seed, 2),
                 train[at].ticks + gap / 8U + (uint32_t)(draw_bits(&seed) % (gap / 4U * 3U)),
                 false);
        }
        stand_in(WH_PHASE_RECORD);
        const outcome out = play(0);
        check_pulses(&out, 0);
        TEST_ASSERT_EQUAL_UINT32(2, rig.pulses.rejected);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE && out.off_rpm <= WH_R(2.0));
    }
}

/* One lost pulse is bridged. After several lost pulses the count of positions restarts, and the speed stays. */
TEST(rig_pulses, lost_pulses) {
    seed = 3;
    for (unsigned i = 0; i < SPEEDS; i++) {
        for (wh_rig_phase phase = WH_PHASE_RAMP; phase <= WH_PHASE_RECORD; phase++) {
            for (unsigned lost = 1; lost <= 3; lost++) {
                make_train(speeds_rpm[i]);
                give_train(lost);
                stand_in(phase);
                const outcome out = play(0);
                TEST_ASSERT_EQUAL_UINT(TRAIN_PULSES - lost, out.pulses);
                TEST_ASSERT_EQUAL_UINT(lost > 1U ? 1U : 0U, out.gaps);
                TEST_ASSERT_EQUAL_UINT(0, out.strange + out.off_ticks);
                TEST_ASSERT_EQUAL_UINT32(lost > 2U ? 2U : lost, rig.pulses.speed.lost);
                TEST_ASSERT_EQUAL_UINT32(0, rig.pulses.rejected);
                TEST_ASSERT_TRUE(out.off_rpm <= WH_R(2.0));
                TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
            }
        }
    }
}

/* A pulse may be captured after the step has read the timer. The timer wraps during the train. */
TEST(rig_pulses, stamps_from_the_future) {
    seed = 4;
    for (unsigned i = 0; i < SPEEDS; i++) {
        for (uint32_t early = 1; early <= 3; early += 2) {
            make_train(speeds_rpm[i]);
            TEST_ASSERT_TRUE(train[TRAIN_PULSES - 1U].ticks < train[0].ticks);
            give_train(0);
            stand_in(WH_PHASE_RECORD);
            const outcome out = play(early);
            check_pulses(&out, 0);
            TEST_ASSERT_EQUAL_UINT32(0, rig.pulses.rejected);
            TEST_ASSERT_TRUE(out.off_rpm < WH_R(0.5));
            TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
        }
    }
}

/* The edge of a slot fires repeatedly. The repetitions are counted and do no harm; too many stop the rig. */
TEST(rig_pulses, bounces) {
    seed = 5;
    for (unsigned each = 1; each <= 4; each++) {
        for (unsigned i = 0; i < SPEEDS; i++) {
            make_train(speeds_rpm[i]);
            give_train(0);
            for (unsigned k = 0; k < TRAIN_PULSES; k++) {
                for (unsigned n = 0; n < each; n++) {
                    give(train[k].sensor,
                         train[k].ticks + 300U + (uint32_t)(draw_bits(&seed) % 3000U), true);
                }
            }
            stand_in(WH_PHASE_RECORD);
            const outcome out = play(0);
            check_pulses(&out, 0);
            TEST_ASSERT_TRUE(out.off_rpm < WH_R(0.5));
            TEST_ASSERT_EQUAL_UINT32(each * TRAIN_PULSES, rig.pulses.rejected);
            const bool many = each * TRAIN_PULSES > config.guard.rejected_max;
            TEST_ASSERT_TRUE(rig.guard.trip == (many ? WH_TRIP_PULSES : WH_TRIP_NONE));
        }
    }
}

/* Random pulses of both sensors, at some twenty times the normal rate, stop the rig. */
TEST(rig_pulses, a_storm_stops_the_rig) {
    seed = 6;
    for (unsigned i = 0; i < SPEEDS; i++) {
        for (wh_rig_phase phase = WH_PHASE_SPIN_UP; phase <= WH_PHASE_RAMP_DOWN; phase++) {
            make_train(speeds_rpm[i]);
            stand_in(phase);
            const uint32_t turn = train[2].ticks - train[0].ticks;
            uint32_t now = train[0].ticks;
            for (unsigned k = 0; k < 200U && rig.guard.trip == WH_TRIP_NONE; k++) {
                now += (uint32_t)(draw_bits(&seed) % (turn / 20U));
                wh_rig_pulse(&config, &rig, draw_one_of(&seed, 2), now);
                wh_guard_speed(&config.guard, &rig.guard, &rig.pulses, WH_TRIP_OVERSPEED, 0);
                wh_guard_pulses(&config.guard, &rig.guard, &rig.pulses, WH_R(2.0), now);
            }
            TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_PULSES ||
                             rig.guard.trip == WH_TRIP_OVERSPEED);
        }
    }
}
