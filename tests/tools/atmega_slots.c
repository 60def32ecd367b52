/* atmega_slots.c: edges at the capture pins, and the pulses that the firmware takes (hal_slots_take()). */
#include <stdio.h>
#include <string.h>

#include "tests/tools/atmega.h"

/* Watches hal_slots_take(): at the call *edge is in r25:r24, at the return r24 is its result. */
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

/* Makes one step. Returns true if the step took an edge. */
static bool taken(hal_slot_edge *edge) {
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
            const uint8_t *at = data + watch.at;
            edge->ticks = (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 |
                          (uint32_t)at[3] << 24;
            edge->sensor = at[4];
            edge->end = at[5];
            return true;
        }
    }
    return false;
}

static uint32_t now_us(void) { return (uint32_t)(mega_cycle() / MEGA_CYCLES_PER_US); }

/* Makes an edge, which the firmware must take next within 10 ms, with a time right to 1 us. *differ: clock
 * difference. */
static bool sees_edge(unsigned i, unsigned sensor, hal_slot_end end, int64_t *differ) {
    hal_slot_edge seen = {0};
    const uint32_t at = now_us();
    mega_level(sensor, end == HAL_SLOT_LEADING);
    const uint64_t most = mega_cycle() + MEGA_HZ / 100U;
    while (!taken(&seen) && mega_cycle() < most) {
    }
    if (mega_cycle() >= most || seen.sensor != sensor || seen.end != end) {
        return no("edge %u of sensor %u, end %u, is told as of %u, %u", i, sensor, end, seen.sensor,
                  seen.end);
    }
    const uint32_t off = seen.ticks - at;
    *differ = *differ < 0 ? off : *differ;
    return off - (uint32_t)*differ + 1U <= 2U || no("edge %u is %d us off", i, (int)off);
}

/* Returns true if no edge comes for this many steps. */
static bool sees_none(unsigned i, unsigned steps) {
    hal_slot_edge seen;
    for (; steps > 0; steps--) {
        if (taken(&seen)) {
            return no("edge %u: one of none", i);
        }
    }
    return true;
}

/* Runs this many cycles. Returns true if an edge came. */
static bool waits(unsigned cycles, hal_slot_edge *seen) {
    const uint64_t end = mega_cycle() + cycles;
    bool any = false;
    while (mega_cycle() < end) {
        any = taken(seen) || any;
    }
    return any;
}

/* Makes a burst of up to four pulses, most of which are over before an interrupt can read the pin. Returns true if at
 * least one edge is reported, and none twice. */
static bool sees_burst(unsigned i, unsigned sensor) {
    hal_slot_edge before = {0};
    hal_slot_edge seen = {0};
    bool any = false;
    const unsigned spikes = 1U + below(4);
    for (unsigned k = 0; k < 2U * spikes; k++) {
        mega_level(sensor, k % 2U == 0);
        any = waits(below(3) == 0 ? below(400) : below(60), &seen) || any;
    }
    const uint64_t most = mega_cycle() + MEGA_HZ / 50U;
    while (mega_cycle() < most) {
        if (!taken(&seen)) {
            continue;
        }
        if (seen.sensor != sensor ||
            (any && seen.end == before.end && seen.ticks == before.ticks)) {
            return no("burst %u of sensor %u is told as of %u, end %u, or twice", i, sensor,
                      seen.sensor, seen.end);
        }
        any = true;
        before = seen;
    }
    return any || no("burst %u is not told", i);
}

/* Pulses at random times over several wraps of the timers. Every third is a burst, and the next pulse is still seen. */
bool sees_edges(unsigned times) {
    int64_t differ = -1;
    mega_start(image);
    mega_no_pulses = true;
    mega_run(30);
    watch_take();
    for (unsigned i = 0; i < times; i++) {
        const unsigned of = below(2);
        if (!sees_none(i, below(40000) + 2000U) ||
            (i % 3U == 1U ? !sees_burst(i, of)
                          : !sees_edge(i, of, HAL_SLOT_LEADING, &differ) ||
                                !sees_none(i, below(4000) + 100U) ||
                                !sees_edge(i, of, HAL_SLOT_TRAILING, &differ))) {
            return false;
        }
    }
    mega_no_pulses = false;
    return true;
}

/* Both pins get the most edges that a capture can take: pulses are rejected, the rig trips, no step is late. */
bool survives_storm(unsigned times) {
    unsigned taken_of = 0;
    hal_slot_edge edge;
    if (!runs(330, 3000)) {
        return false;
    }
    memset(mega_times_now(), 0, sizeof(mega_times));
    mega_no_pulses = true;
    watch_take();
    const uint64_t began = mega_cycle();
    for (unsigned i = 0; i < times; i++) {
        mega_level(i & 1U, true);
        mega_level(i & 1U, false);
        const uint64_t end = mega_cycle() + 200U + below(400); /* 40,000 per second */
        while (mega_cycle() < end) {
            taken_of += taken(&edge) ? 1U : 0U;
        }
    }
    const double took_s = (double)(mega_cycle() - began) / MEGA_HZ;
    const mega_times *seen = mega_times_now();
    mega_no_pulses = false;
    printf("# %u edges, %.0f a second, %u taken; worst control step %llu cycles, worst loop %llu, "
           "%llu of %llu late\n",
           times, times / took_s, taken_of, (unsigned long long)seen->worst_step,
           (unsigned long long)seen->worst_loop, (unsigned long long)seen->late,
           (unsigned long long)seen->steps);
    return (seen->late == 0 || no("%llu steps are late", (unsigned long long)seen->late)) &&
           ((double)(seen->steps + 1U) > 495.0 * took_s || /* the last step may be incomplete */
            no("%llu steps", (unsigned long long)seen->steps)) &&
           (taken_of > 0 || no("none is taken")) && asks("fault", "OK trip=3");
}
