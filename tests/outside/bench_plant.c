/* The rig as a plant: Runge-Kutta 4 in steps of 50 us. Pulses are located on the cubic through both ends of a step. */
#include "tests/outside/bench_plant.h"
#include "tests/outside/bench_line.h"
#include <math.h>

/* The rig of docs/rig.md: two shafts, each with an arm of 0.152 lb, 7.25 in long, and discs of 0.15 lb at 6.5 in. At
 * 24 V the motor has 1.5 N*m at standstill, and 600 rpm without load. */
#define GRAVITY 9.80665
#define POUND 0.45359237
#define INCH 0.0254
#define ARM_KG (0.152 * POUND)
#define DISC_KG (0.15 * POUND)
#define ARM_M (7.25 * INCH)
#define DISC_M (6.5 * INCH)
#define MOMENT (2.0 * (ARM_KG * ARM_M / 2.0 + DISC_KG * DISC_M))
#define ROTOR_KGM2 (2.0 * (ARM_KG * ARM_M * ARM_M / 3.0 + DISC_KG * DISC_M * DISC_M) + 5e-4)
#define WEIGHT_N ((12.0 * POUND + 2.0 * (ARM_KG + DISC_KG)) * GRAVITY)
#define STALL_NM 1.5
#define NO_LOAD (600.0 * RPM)
#define RATED_V 24.0
#define DRAG_NMS 0.001

static double driven(const plant *p, const double *y) {
    const bench *b = p->b;
    double torque = b->torque_2 * sin(2 * y[ANGLE] + b->phase_2) - b->drag * DRAG_NMS * y[SPEED];
    const bool stuck = p->stuck && (p->enable > 0.5 || b->ignores_enable != 0);
    if (stuck || p->enable > 0.5) {
        const double volts = (stuck ? b->share : p->duty) * b->supply;
        const double full = (1 - b->weak) * STALL_NM * (volts / RATED_V - y[SPEED] / NO_LOAD);
        const bool open = volts <= 0 && (b->coasts != 0 || b->freewheels != 0);
        torque += open ? 0 : b->freewheels != 0 ? fmax(full, 0) : full;
    }
    return torque;
}

static double weighed(const double *y) { return MOMENT * GRAVITY * sin(y[ANGLE]); }

static double force_of(const double *y, double acceleration) {
    return MOMENT * (y[SPEED] * y[SPEED] * cos(y[ANGLE]) + acceleration * sin(y[ANGLE]));
}

static void slope(const plant *p, const double *y, double way, double *dy) {
    const double torque = driven(p, y) - way * p->b->dry, w = TURN * p->b->resonance;
    dy[ANGLE] = y[SPEED];
    dy[SPEED] = p->held ? 0 : (torque - weighed(y)) / p->inertia;
    dy[WORK] = torque * y[SPEED];
    dy[BENT] = y[BENDING];
    dy[BENDING] =
        w <= 0 ? 0
               : w * w * (force_of(y, dy[SPEED]) - y[BENT]) - 2 * p->b->damping * w * y[BENDING];
}

static double energy(const plant *p) {
    return p->inertia * p->y[SPEED] * p->y[SPEED] / 2 - MOMENT * GRAVITY * cos(p->y[ANGLE]);
}

static void queue_pulse(plant *p, double seconds, uint32_t channel) {
    int at = p->queued++;
    if (at == QUEUE) {
        disagree("%d pulses wait: orders ask for readings too seldom", QUEUE);
    }
    for (; at > 0 && p->queue[at - 1].seconds > seconds; at--) {
        p->queue[at] = p->queue[at - 1];
    }
    p->queue[at] = (pulse){seconds, channel};
}

/* Queues the pulses of the last step, in which the rotor goes from angle a at speed va to p->y[ANGLE] at speed vb, on
 * a cubic. The jitter of a sensor's next pulse, in s, is converted to the angle lead[]. Within 0.35 rad of the sensor
 * this angle stays constant. */
static void find_pulses(plant *p, double a, double va, double vb, double h) {
    const double b = p->y[ANGLE], way = b > a ? 1 : -1;
    const double place[2] = {p->b->place_1 * DEG, PI / 2 + p->b->place_2 * DEG};
    for (uint32_t s = 0; s < 2; s++) {
        const double off = remainder(a - place[s], TURN);
        p->lead[s] = fabs(off) > 0.35 ? va * p->jitter[s] : p->lead[s];
        const double edge = a - off - way * DEG + p->lead[s];
        if (b == a || way * (a - edge) >= 0 || way * (b - edge) < 0) {
            continue;
        }
        double low = 0, high = 1;
        for (int i = 0; i < 40; i++) {
            const double u = (low + high) / 2, v = 1 - u;
            const double angle =
                v * v * (a * (1 + 2 * u) + h * va * u) + u * u * (b * (1 + 2 * v) - h * vb * v);
            *(way * (angle - edge) < 0 ? &low : &high) = u;
        }
        p->jitter[s] = p->b->jitter * 1e-6 * fmax(-4, fmin(4, normal(&p->d)));
        if (p->t < p->b->die.at || ((unsigned)p->b->dead >> s & 1) == 0) {
            queue_pulse(p, p->t + high * h, s);
            if (chance(&p->d, p->b->doubled)) {
                queue_pulse(p, p->t + high * h + p->b->double_s, s);
            }
        }
    }
}

/* Adds the integrals of f cos and f sin over the angle from a to b, by the trapezoidal rule. `f` holds at a, `g` at
 * b. */
static void add_to_turn(turn *now, double a, double b, const double *f, const double *g) {
    for (int k = 0; k < 2; k++) {
        now->cosine[k] += (b - a) / TURN * (f[k] * cos(a) + g[k] * cos(b));
        now->sine[k] += (b - a) / TURN * (f[k] * sin(a) + g[k] * sin(b));
    }
}

static void follow_turn(plant *p, double a, const double *f, const double *g, double h) {
    const double b = p->y[ANGLE], mark = TURN * (floor(a / TURN) + 1);
    p->whole = p->whole && b >= a;
    if (b < mark) {
        add_to_turn(&p->now, a, b, f, g);
        return;
    }
    const double u = (mark - a) / (b - a), at = p->t + u * h;
    const double m[2] = {f[0] + u * (g[0] - f[0]), f[1] + u * (g[1] - f[1])};
    add_to_turn(&p->now, a, mark, f, m);
    p->now.seconds = at - p->turn_began;
    if (p->whole) {
        p->past[p->turns++ % KEPT] = p->now;
    }
    p->whole = true;
    p->turn_began = at;
    p->now = (turn){.seconds = 0};
    add_to_turn(&p->now, mark, b, m, g);
}

void plant_start(plant *p, const bench *b) {
    *p = (plant){.b = b, .d = b->seed, .inertia = b->inertia * ROTOR_KGM2};
    for (int i = 0; i < 500; i++) { /* iterates to the angle at which the rotor rests */
        p->y[ANGLE] += driven(p, p->y) - weighed(p->y);
    }
    p->energy_0 = energy(p);
}

void plant_step(plant *p, double h) {
    double y[STATES], k[4][STATES], end[STATES];
    const double from = p->y[ANGLE], before = p->y[SPEED], f[2] = {p->force[0], p->force[1]};
    const double pull = driven(p, p->y) - weighed(p->y);
    const double way = (before != 0 ? before : pull) > 0 ? 1 : -1;
    p->held = before == 0 && fabs(pull) <= p->b->dry;
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < STATES; i++) {
            y[i] = p->y[i] + (stage == 0 ? 0 : stage == 3 ? h * k[2][i] : h / 2 * k[stage - 1][i]);
        }
        slope(p, y, way, k[stage]);
    }
    for (int i = 0; i < STATES; i++) {
        p->y[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
    if (p->b->dry > 0 && before * p->y[SPEED] < 0) {
        p->y[SPEED] = 0;
    }
    slope(p, p->y, way, end);
    p->force[0] = force_of(p->y, end[SPEED]);
    p->force[1] = p->b->resonance > 0 ? p->y[BENT] : p->force[0];
    find_pulses(p, from, before, p->y[SPEED], h);
    follow_turn(p, from, f, p->force, h);
    const double play = p->b->play / 2;
    p->play_at = fmin(fmax(p->play_at, p->force[1] - play), p->force[1] + play);
    p->t += h;
    p->energy_off = fmax(p->energy_off, fabs(energy(p) - p->energy_0 - p->y[WORK]));
}

/* The reading of the load cell in N: hysteresis, cubic error, gain, drift, hum, noise, pick-up, amplifier,
 * converter. */
static double cell_reads(plant *p, bool recording) {
    const bench *b = p->b;
    const double u = p->play_at / (MOMENT * b->rpm * RPM * b->rpm * RPM);
    const double rest = (1 + b->gain) * WEIGHT_N;
    double load = (1 + b->gain) * p->play_at * (1 + b->cubic * u * u) + b->drift * p->t +
                  b->hum * sin(TURN * b->hum_hz * p->t + b->hum_phase) + b->noise * normal(&p->d);
    load += p->y[SPEED] > 1 ? b->pickup * cos(p->y[ANGLE] + b->pickup_phase) : 0;
    p->peak_high = recording ? fmax(p->peak_high, load) : p->peak_high;
    p->peak_low = recording ? fmin(p->peak_low, load) : p->peak_low;
    load = rest + fmin(fmax(load, b->clip_low), b->clip_high) + b->adc * normal(&p->d);
    return b->quantized > 0 ? b->quantized * nearbyint(load / b->quantized) : load;
}

double plant_sample(plant *p, int channel, bool recording) {
    const bench *b = p->b;
    const double volts = b->supply * (1 + b->supply_gain) + b->supply_off;
    switch (channel) {
    case 0: return cell_reads(p, recording);
    case 1: return b->supply_sat > 0 ? fmin(b->supply_sat, volts) : volts;
    case 2: return p->pressed;
    case 3: return b->rpm * RPM;
    case 4: return b->fed;
    default: return b->brakes;
    }
}
