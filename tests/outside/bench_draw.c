/* Random benches. */
#include "tests/outside/bench_draw.h"
#include <math.h>
#include <string.h>

const fault_kind kinds[] = {
#define KIND(name, low, high, sign) {#name, offsetof(bench, name), low, high, sign},
    {"none", 0, 0, 0, false},
    KIND(noise, 0.2, 3, false)          /* N, standard deviation */
    KIND(hum, 0.05, 3, false)           /* amplitude in N, at 50 or 60 Hz */
    KIND(pickup, 0.1, 5, false)         /* amplitude in N, once per turn */
    KIND(clip_above, 0.9, 0.995, false) /* limit, as a share of the record's upper peak */
    KIND(clip_below, 0.9, 0.995, false) /* limit, as a share of the record's lower peak */
    KIND(play, 0.5, 2, false)           /* N, full width of the hysteresis */
    KIND(cubic, 0.005, 0.02, true)      /* relative error at the nominal amplitude */
    KIND(drift, 0.01, 0.5, true)        /* N/s */
    KIND(gain, 0.005, 0.3, true)        /* relative error */
    KIND(quantized, 0.02, 0.5, false)   /* N per count */
    KIND(resonance, 20, 80, false)      /* Hz */
    KIND(place_1, 0.2, 5, true)         /* deg */
    KIND(place_2, 0.2, 5, true)         /* deg */
    {"place_both", 0, 0.2, 5, true},    /* deg */
    KIND(jitter, 60, 300, false)        /* us, standard deviation */
    {"dead_1", offsetof(bench, dead), 1, 1, false},
    {"dead_2", offsetof(bench, dead), 2, 2, false},
    KIND(doubled, 0, 1, false)                            /* share of pulses that come twice */
    KIND(torque_2, 0.02, 0.12, false)                     /* amplitude in N*m, twice per turn */
    KIND(inertia, 0.5, 6, false)                          /* times the nominal inertia */
    {"friction", offsetof(bench, dry), 0.02, 0.2, false}, /* N*m */
    KIND(weak, -0.2, 0.5, false) /* share of the motor's torque that is missing */
    {"freewheel", offsetof(bench, freewheels), 1, 1, false},
    KIND(supply_off, 0.2, 5, true)     /* V */
    KIND(supply_gain, 0.02, 0.5, true) /* relative error */
    KIND(supply_sat, 10, 24, false)    /* V */
    {"stop", 0, 0, 0, false},
    {"stuck", 0, 0, 0, false},
    {"swing", offsetof(bench, swings), 1, 1, false},
#undef KIND
};
_Static_assert(sizeof kinds / sizeof kinds[0] == KINDS, "KIND_STUCK and KIND_SWING come last");

uint64_t dice_next(dice *d) {
    uint64_t z = (*d += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}
static double uniform(dice *d, double low, double high) {
    return low + (high - low) * (double)(dice_next(d) >> 11) * 0x1p-53;
}

bool chance(dice *d, double share) { return uniform(d, 0, 1) < share; }

double normal(dice *d) {
    return sqrt(-2.0 * log(uniform(d, 0x1p-53, 1.0))) * cos(TURN * uniform(d, 0, 1));
}

static bool is(int kind, const char *name) { return strcmp(kinds[kind].name, name) == 0; }

/* The highest set-point in rpm. docs/rig.md requires 0.8 V more supply than n/600 * 24 V; another 1.5 V are for
 * friction. */
static double most_rpm(double supply) { return fmin(360.0, (supply - 2.3) / 24.0 * 600.0); }

static event drawn_event(dice *d) {
    static const int states[] = {IDLE, ARMED, TARE, SPIN_UP, RAMP, SETTLE, RECORD, SLOW, COAST};
    static const double longest[] = {1.5, 0.004, 0.5, 0.6, 2.5, 3, 2, 2, 3};
    const size_t i = dice_next(d) % (sizeof states / sizeof states[0]);
    return (event){states[i], uniform(d, 0, longest[i]), NEVER};
}

static void draw_stuck(bench *b, dice *d) {
    b->share = uniform(d, 0.2, 1.0);
    b->ignores_enable = chance(d, 0.3);
    b->inertia = chance(d, 0.3) ? 1.0 : 0.5 * pow(12.0, uniform(d, 0, 1));
    b->supply = chance(d, 0.4) ? 24.0 : uniform(d, 12, 36);
    b->rpm = uniform(d, 100, most_rpm(b->supply));
    b->stuck = drawn_event(d);
    const double where = uniform(d, 0, 1);
    if (where < 0.35) { /* the stage sticks after stop, which stays pressed or is released */
        b->stop = drawn_event(d);
        b->stuck = (event){AFTER_STOP, chance(d, 0.3) ? 0 : uniform(d, 0, 4), NEVER};
        if (chance(d, 0.4)) {
            b->release = (event){AFTER_STOP, uniform(d, 0.01, 5), NEVER};
        }
    } else if (where < 0.5) { /* the stage sticks after a trip */
        b->silent = drawn_event(d);
        b->stuck = (event){TRIPPED, uniform(d, 0, 4), NEVER};
    } else if (where < 0.65) { /* the stage sticks after a run */
        b->stuck = (event){COAST, uniform(d, 0, 4), NEVER};
    }
    if (chance(d, 0.5)) {
        b->dead = chance(d, 0.5) ? 1 : 2;
        b->die = chance(d, 0.5) ? b->stuck : drawn_event(d);
    }
}

static void draw_fault(bench *b, int kind, dice *d) {
    double size = uniform(d, kinds[kind].low, kinds[kind].high);
    size = kinds[kind].signed_ && chance(d, 0.5) ? -size : size;
    if (kinds[kind].number > 0) {
        memcpy((char *)b + kinds[kind].number, &size, sizeof size);
    }
    if (is(kind, "place_both")) {
        b->place_1 = b->place_2 = size;
    } else if (strncmp(kinds[kind].name, "dead", 4) == 0) {
        b->die = drawn_event(d);
    } else if (is(kind, "friction")) {
        b->drag = uniform(d, 1, 5);
    } else if (is(kind, "stop")) {
        b->stop = drawn_event(d);
    } else if (is(kind, "stuck")) {
        draw_stuck(b, d);
    } else if (is(kind, "swing")) {
        b->rpm = 330;
        b->supply = fmax(b->supply, 17);
    }
}

/* Draws a healthy bench: noise and hum up to 0.3 N, jitter up to 100 us, inertia 0.75 to 1.5 times the nominal one. */
void draw_healthy(bench *b, dice *d) {
    const event never = {NOT_AT_ALL, 0, NEVER};
    *b = (bench){.supply = 24, .drag = 1, .clip_high = NEVER, .clip_low = -NEVER};
    b->stop = b->release = b->stuck = b->die = b->silent = never;
    b->seed = dice_next(d);
    b->rpm = chance(d, 0.3) ? 330.0 : uniform(d, 100, 360);
    b->noise = uniform(d, 0, 0.3);
    b->hum = uniform(d, 0, 0.3);
    b->hum_hz = (chance(d, 0.5) ? 50 : 60) * (1.0 + uniform(d, -0.002, 0.002));
    b->hum_phase = uniform(d, 0, TURN);
    b->jitter = uniform(d, 0, 100);
    b->inertia = uniform(d, 0.75, 1.5);
}

void draw_bench(bench *b, int kind, dice *d) {
    draw_healthy(b, d);
    b->noise /= 3;
    b->hum = 0;
    b->jitter *= 0.6;
    b->supply = chance(d, 0.6) ? 24.0 : uniform(d, 14, 36);
    b->rpm = fmin(b->rpm, most_rpm(b->supply));
    b->fed = chance(d, 0.1);
    b->brakes = chance(d, 0.3);
    b->drag = uniform(d, 0.7, 1.5);
    b->dry = chance(d, 0.5) ? 0.0 : uniform(d, 0, 0.02);
    b->pickup_phase = uniform(d, 0, TURN);
    b->phase_2 = uniform(d, 0, TURN);
    b->damping = uniform(d, 0.01, 0.1);
    b->adc = chance(d, 0.5) ? uniform(d, 0.01, 0.1) : 0;
    b->double_s = uniform(d, 1e-4, 5e-3);
    b->kind = kind;
    draw_fault(b, kind, d);
    if (kind != 0 && chance(d, 0.25)) { /* a second fault of any kind except the last three */
        b->second = 1 + (int)(dice_next(d) % (KINDS - 4));
        draw_fault(b, b->second, d);
    }
}

/* Draws a healthy rotor that slows down, braked, coasting or swinging, after the end of a run or after a stop at any
 * time. */
void draw_run_out(bench *b, dice *d) {
    draw_healthy(b, d);
    b->supply = uniform(d, 12, 36);
    b->rpm = fmin(b->rpm, most_rpm(b->supply));
    b->drag = uniform(d, 0.7, 1.5);
    b->dry = uniform(d, 0.005, 0.03);
    const double way = uniform(d, 0, 1);
    if (way < 0.3 && b->supply > 17) {
        draw_fault(b, b->kind = KIND_SWING, d);
    } else if (way < 0.6 && b->rpm > 170) {
        b->coasts = 1; /* the drive stage is open at duty 0 */
    } else {
        b->brakes = chance(d, 0.7);
    }
    if (chance(d, 0.7)) {
        b->stop = chance(d, 0.5) ? (event){BY_TIME, uniform(d, 1, 17), NEVER} : drawn_event(d);
        if (chance(d, 0.3)) {
            b->release = (event){AFTER_STOP, uniform(d, 0.01, 3), NEVER};
        }
    }
}
