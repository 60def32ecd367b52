/* atmega_slots.c: edges at the capture pins, and what the firmware takes of them (hal_slots_take()). */
#include <stdio.h>
#include <string.h>

#include "tests/tools/atmega.h"

/* Pulses as they are taken: where it is called, *pulse is in r25:r24; where it returns, r24 says whether there was one. */
static struct {
    uint32_t take;
    uint32_t back;
    uint16_t at;
    bool within;
} watch;

static void watch_take(void) {
    memset(&watch, 0, sizeof watch);
    watch.take = mega_symbol("hal_slots_take");
}

/* A step; true when a pulse was taken by it. */
static bool taken(uint32_t *ticks, unsigned *sensor) {
    mega_step();
    const uint8_t *data = mega_data();
    const uint32_t pc = mega_pc();
    if (!watch.within && pc == watch.take) {
        const uint8_t *sp = data + mega_sp();
        watch.within = true;
        watch.back = 2U * ((uint32_t)sp[1] << 16 | (uint32_t)sp[2] << 8 | sp[3]);
        watch.at = (uint16_t)(data[24] | data[25] << 8);
    } else if (watch.within && pc == watch.back) {
        watch.within = false;
        if (data[24] != 0) {
            const uint8_t *pulse = data + watch.at;
            *ticks = (uint32_t)pulse[0] | (uint32_t)pulse[1] << 8 | (uint32_t)pulse[2] << 16 |
                     (uint32_t)pulse[3] << 24;
            *sensor = pulse[4];
            return true;
        }
    }
    return false;
}

static uint32_t now_us(void) { return (uint32_t)(mega_cycle() / MEGA_CYCLES_PER_US); }

/* Edges at scattered times, over several wraps of the timers; the first says how the clocks differ. */
bool sees_edges(unsigned times) {
    uint32_t differ = 0;
    mega_start(image);
    mega_no_pulses = true;
    mega_run(30);
    watch_take();
    for (unsigned i = 0; i < times; i++) {
        uint32_t ticks = 0;
        unsigned sensor = 2;
        const unsigned of = below(2);
        for (unsigned wait = below(40000) + 2000U; wait > 0; wait--) {
            if (taken(&ticks, &sensor)) {
                return no("edge %u: one of none", i);
            }
        }
        const uint32_t at = now_us();
        mega_edge(of);
        const uint64_t most = mega_cycle() + MEGA_HZ / 100U;
        while (!taken(&ticks, &sensor) && mega_cycle() < most) {
        }
        if (mega_cycle() >= most || sensor != of) {
            return no("edge %u of sensor %u is told as of %u", i, of, sensor);
        }
        differ = i == 0 ? ticks - at : differ;
        if (ticks - at - differ + 1U > 2U) {
            return no("edge %u is %d us off", i, (int)(ticks - at - differ));
        }
    }
    mega_no_pulses = false;
    return true;
}

/* As many as a capture can take, on both pins, while it spins up: pulses are rejected, the rig trips, and no step is late. */
bool survives_storm(unsigned times) {
    unsigned taken_of = 0;
    uint32_t ticks = 0;
    unsigned sensor = 0;
    if (!runs(330, 3000)) {
        return false;
    }
    memset(mega_times_now(), 0, sizeof(mega_times));
    mega_no_pulses = true;
    watch_take();
    const uint64_t began = mega_cycle();
    for (unsigned i = 0; i < times; i++) {
        mega_edge(i & 1U);
        const uint64_t end = mega_cycle() + 200U + below(400); /* 40,000 a second */
        while (mega_cycle() < end) {
            taken_of += taken(&ticks, &sensor) ? 1U : 0U;
        }
    }
    const double took_s = (double)(mega_cycle() - began) / MEGA_HZ;
    const mega_times *seen = mega_times_now();
    mega_no_pulses = false;
    printf(
        "# %u edges, %.0f a second, %u taken; worst control step %llu cycles, %llu of %llu late\n",
        times, times / took_s, taken_of, (unsigned long long)seen->worst_step,
        (unsigned long long)seen->late, (unsigned long long)seen->steps);
    return (seen->late == 0 || no("%llu steps are late", (unsigned long long)seen->late)) &&
           ((double)seen->steps > 495.0 * took_s ||
            no("%llu steps", (unsigned long long)seen->steps)) &&
           (taken_of > 0 || no("none is taken")) && asks("fault", "OK trip=3");
}
