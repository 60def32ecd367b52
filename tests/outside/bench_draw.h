/* Random benches: the rig, its errors and its faults. */
#ifndef TESTS_OUTSIDE_BENCH_DRAW_H
#define TESTS_OUTSIDE_BENCH_DRAW_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PI 3.14159265358979323846
#define TURN (2.0 * PI)
#define RPM (TURN / 60.0)
#define DEG (PI / 180.0)
#define NEVER 1e9

/* clang-format off */
/* The numbers of a bench. Errors and faults are 0 in a healthy bench. */
#define NUMBERS(X) \
    X(rpm) \
    X(fed) \
    X(brakes) X(supply) X(supply_off) X(supply_gain) X(supply_sat) X(swings) X(inertia) X(drag) \
        X(dry) X(weak) X(torque_2) X(phase_2) X(freewheels) X(coasts) X(share) X(ignores_enable) \
            X(place_1) X(place_2) X(jitter) X(dead) X(doubled) X(double_s) X(resonance) X(damping) \
                X(play) X(cubic) X(gain) X(drift) X(pickup) X(pickup_phase) X(noise) X(hum) \
                    X(hum_hz) X(hum_phase) X(clip_above) X(clip_below) X(adc) X(quantized)
/* The events of a bench. After `silent`, the load cell gives no more samples, so the rig trips. */
#define EVENTS(X) X(stop) X(release) X(stuck) X(die) X(silent)

enum { BY_TIME = -1, AFTER_STOP = -2, NOT_AT_ALL = -3 };
enum {
    IDLE,
    ARMED,
    RUNNING,
    STOPPING,
    TRIPPED,
    TARE = 9,
    SPIN_UP,
    RAMP,
    SETTLE,
    RECORD,
    SLOW,
    COAST
};
/* clang-format on */

typedef struct { /* at: time, s; delay: s from the start, stop or the first orders in `state` */
    int state;
    double delay, at;
} event;

typedef struct {
#define X(name) double name;
    NUMBERS(X)
#undef X
#define X(name) event name;
    EVENTS(X)
#undef X
    double clip_high, clip_low; /* limits of the amplifier, N from the reading at rest */
    uint64_t seed;
    int kind, second;
} bench;

/* A kind of fault: the offset of a number in the struct bench, and the number's range. If signed_, half of the
 * numbers are negative. */
typedef struct {
    const char *name;
    size_t number;
    double low, high;
    bool signed_;
} fault_kind;
extern const fault_kind kinds[];
enum { KIND_STUCK = 28, KIND_SWING, KINDS };

typedef uint64_t dice; /* state of the generator splitmix64 */
uint64_t dice_next(dice *d);
bool chance(dice *d, double share);
double normal(dice *d);

void draw_healthy(bench *b, dice *d);
void draw_bench(bench *b, int kind, dice *d);
void draw_run_out(bench *b, dice *d);

#endif
