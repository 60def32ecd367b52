/* Bench for the rig's firmware, written from docs/pil.md ("Bytes on the line") and docs/rig.md alone.
 * It links libc and libm and nothing of the project: frames, plant, sensors and judge are its own.
 * It starts the firmware as a child process, takes turns with it, breaks the plant or its sensors,
 * and judges each run from the plant. Exit status: 0 no rule is broken, 1 a rule is broken, 2 the
 * page and the firmware disagree, or bad usage. */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define PI 3.14159265358979323846
#define TURN (2.0 * PI)
#define RPM (TURN / 60.0)
#define DEG (PI / 180.0)
#define NEVER 1e9

_Noreturn static void disagree(const char *format, ...) {
    va_list values;
    va_start(values, format);
    fputs("error: the page and the firmware disagree: ", stderr);
    vfprintf(stderr, format, values);
    fputc('\n', stderr);
    va_end(values);
    exit(2);
}

/* ---- frames: version, kind, sequence, ticks, payload, CRC-32, coded by COBS ---- */

enum { HELLO = 1, ORDERS = 2, READINGS = 3, REMEMBER = 5 };
enum { PATIENCE_S = 60, CPU_LIMIT_S = 120 };

typedef struct {
    uint8_t byte[2048];
    size_t n, at; /* at: the reader's place */
} message;

typedef struct {
    pid_t child;
    FILE *to, *from;
} line;

static uint32_t crc32(const uint8_t *byte, size_t n) {
    uint32_t crc = 0xFFFFFFFFU;
    for (size_t i = 0; i < 8 * n; i++) {
        crc ^= i % 8 == 0 ? byte[i / 8] : 0;
        crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    return crc ^ 0xFFFFFFFFU;
}

static void put(message *m, uint32_t value, int bytes) {
    for (int i = 0; i < bytes; i++) {
        m->byte[m->n++] = (uint8_t)(value >> (8 * i));
    }
}

static uint32_t get(message *m, int bytes) {
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++) {
        if (m->at == m->n) {
            disagree("a frame of kind %d has only %zu bytes", m->byte[1], m->n);
        }
        value |= (uint32_t)m->byte[m->at++] << (8 * i);
    }
    return value;
}

static double get_float(message *m) {
    const union {
        uint32_t bits;
        float value;
    } u = {get(m, 4)};
    return (double)u.value;
}

static const char *get_string(message *m) {
    const char *text = (const char *)&m->byte[m->at];
    while (get(m, 1) != 0) {
    }
    return text;
}

static void say(const line *l, message *m) {
    uint8_t block[254];
    size_t n = 0;
    put(m, crc32(m->byte, m->n), 4);
    for (size_t i = 0; i <= m->n; i++) {
        if (i < m->n && m->byte[i] != 0) {
            block[n++] = m->byte[i];
        }
        if (i == m->n || m->byte[i] == 0 || n == sizeof block) {
            fputc((int)n + 1, l->to);
            fwrite(block, 1, n, l->to);
            n = 0;
        }
    }
    fputc(0, l->to);
    fflush(l->to);
}

static void silent(int signal_number) {
    static const char text[] = "error: the firmware owes a frame and is silent for 60 s\n";
    _exit(write(2, text, sizeof text - 1) > 0 && signal_number == SIGALRM ? 2 : 3);
}

/* Read the next frame. False: end of file. */
static bool hear(const line *l, message *m) {
    int code = 0;
    m->n = 0;
    m->at = 8;
    alarm(PATIENCE_S);
    while (code == 0) {
        code = getc(l->from);
    }
    while (code > 0) {
        const int block = code;
        for (int i = 1; i < block && code > 0 && m->n < sizeof m->byte - 1; i++) {
            code = getc(l->from);
            m->byte[m->n++] = (uint8_t)code;
        }
        if (code <= 0) {
            disagree("a frame ends inside a block of %d bytes", block);
        }
        code = getc(l->from);
        if (code > 0 && block < 255) {
            m->byte[m->n++] = 0;
        }
    }
    if (code == EOF) {
        return false;
    }
    const size_t n = m->at = m->n - 4;
    if (m->n < 12 || m->byte[0] != 1 || get(m, 4) != crc32(m->byte, n)) {
        disagree("a frame of %zu bytes, version %d, or its CRC", m->n, m->byte[0]);
    }
    m->n = n;
    m->at = 1;
    return true;
}

static void line_start(line *l, const char *firmware) {
    int down[2], up[2];
    if (access(firmware, X_OK) != 0 || pipe(down) != 0 || pipe(up) != 0) {
        fprintf(stderr, "error: cannot start %s\nhint: make pil-images\n", firmware);
        exit(2);
    }
    l->child = fork();
    if (l->child == 0) {
        const struct rlimit most = {CPU_LIMIT_S, CPU_LIMIT_S};
        const int in = fcntl(down[0], F_DUPFD, 10), out = fcntl(up[1], F_DUPFD, 10);
        setrlimit(RLIMIT_CPU, &most);
        dup2(open("/dev/null", O_WRONLY), 1);
        dup2(in, 3);
        dup2(out, 4);
        for (int fd = 5; fd < 64; fd++) {
            close(fd);
        }
        execl(firmware, firmware, (char *)NULL);
        _exit(127);
    }
    close(down[0]);
    close(up[1]);
    l->to = fdopen(down[1], "wb");
    l->from = fdopen(up[0], "rb");
}

/* End the line, and the firmware with it: its exit status, or -1 after a signal. */
static int line_end(const line *l) {
    int status = 0;
    fclose(l->to);
    fclose(l->from);
    waitpid(l->child, &status, 0);
    alarm(0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* ---- random numbers: splitmix64 ---- */

typedef uint64_t dice;

static uint64_t dice_next(dice *d) {
    uint64_t z = (*d += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}
static double uniform(dice *d, double low, double high) {
    return low + (high - low) * (double)(dice_next(d) >> 11) * 0x1p-53;
}

static bool chance(dice *d, double share) { return uniform(d, 0, 1) < share; }

static double normal(dice *d) {
    return sqrt(-2.0 * log(uniform(d, 0x1p-53, 1.0))) * cos(TURN * uniform(d, 0, 1));
}

/* ---- a bench as drawn ---- */

/* Numbers of a bench. Errors and faults are 0 in a healthy one. */
#define NUMBERS(X) \
    X(rpm) \
    X(fed) \
    X(supply) \
    X(inertia) \
    X(drag) X(dry) X(weak) X(torque_2) X(phase_2) X(freewheels) X(coasts) X(swings) X(share) \
        X(ignores_enable) X(dead) X(place_1) X(place_2) X(jitter) X(doubled) X(double_s) X(noise) \
            X(hum) X(hum_hz) X(hum_phase) X(pickup) X(pickup_phase) X(gain) X(cubic) X(drift) \
                X(play) X(clip_above) X(clip_below) X(quantized) X(resonance) X(damping) \
                    X(supply_off) X(supply_gain) X(supply_sat)
/* Events of a bench. silent: the load cell, which makes a trip. */
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

typedef struct { /* so long after the first orders of a state, or one of the three above */
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
    double clip_high, clip_low;
    uint64_t seed;
    int kind, second;
} bench;

/* Kinds of faults: a number of the bench and its range, of either sign in the last column. */
static const struct {
    const char *name;
    size_t number;
    double low, high;
    bool signed_;
} kinds[] = {
#define KIND(name, low, high, sign) {#name, offsetof(bench, name), low, high, sign},
    {"none", 0, 0, 0, false},
    KIND(noise, 0.2, 3, false)          /* N, standard deviation */
    KIND(hum, 0.05, 3, false)           /* N, amplitude, at 50 or 60 Hz */
    KIND(pickup, 0.1, 5, false)         /* N, once a turn */
    KIND(clip_above, 0.9, 0.995, false) /* share of the record's upper peak */
    KIND(clip_below, 0.9, 0.995, false) /* ... lower peak */
    KIND(play, 0.5, 2, false)           /* N, from one side to the other */
    KIND(cubic, 0.005, 0.02, true)      /* error at the nominal amplitude */
    KIND(drift, 0.01, 0.5, true)        /* N/s */
    KIND(gain, 0.005, 0.3, true)        /* error */
    KIND(quantized, 0.02, 0.5, false)   /* N a count */
    KIND(resonance, 20, 80, false)      /* Hz */
    KIND(place_1, 0.2, 5, true)         /* deg */
    KIND(place_2, 0.2, 5, true)         /* deg */
    {"place_both", 0, 0.2, 5, true},    /* deg */
    KIND(jitter, 60, 300, false)        /* us, standard deviation */
    {"dead_1", offsetof(bench, dead), 1, 1, false},
    {"dead_2", offsetof(bench, dead), 2, 2, false},
    KIND(doubled, 0, 1, false)                            /* share of the pulses */
    KIND(torque_2, 0.02, 0.12, false)                     /* N*m, twice a turn */
    KIND(inertia, 0.5, 6, false)                          /* times the rotor's */
    {"friction", offsetof(bench, dry), 0.02, 0.2, false}, /* N*m */
    KIND(weak, -0.2, 0.5, false) /* share of the motor's torque that is missing */
    {"freewheel", offsetof(bench, freewheels), 1, 1, false},
    KIND(supply_off, 0.2, 5, true)     /* V */
    KIND(supply_gain, 0.02, 0.5, true) /* error */
    KIND(supply_sat, 10, 24, false)    /* V */
    {"stop", 0, 0, 0, false},
    {"stuck", 0, 0, 0, false},
    {"swing", offsetof(bench, swings), 1, 1, false},
#undef KIND
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

static bool is(int kind, const char *name) { return strcmp(kinds[kind].name, name) == 0; }

/* The rig of docs/rig.md: two shafts, on each an arm of 0.152 lb, 7.25 in long, and discs of
 * 0.15 lb at 6.5 in; a motor of 1.5 N*m at rest and 600 rpm without load at 24 V. */
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

/* The highest set-point that the page allows at this supply, with 1.5 V in hand for friction. */
static double most_rpm(double supply) { return fmin(360.0, (supply - 2.3) / RATED_V * 600.0); }

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
    if (where < 0.35) { /* after stop, held or released */
        b->stop = drawn_event(d);
        b->stuck = (event){AFTER_STOP, chance(d, 0.3) ? 0 : uniform(d, 0, 4), NEVER};
        if (chance(d, 0.4)) {
            b->release = (event){AFTER_STOP, uniform(d, 0.01, 5), NEVER};
        }
    } else if (where < 0.5) { /* after a trip */
        b->silent = drawn_event(d);
        b->stuck = (event){TRIPPED, uniform(d, 0, 4), NEVER};
    } else if (where < 0.65) { /* after a run */
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

/* A healthy bench of the issue: noise and hum to 0.3 N, jitter to 100 us, inertia 0.75 to 1.5. */
static void draw_healthy(bench *b, dice *d) {
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

static void draw_bench(bench *b, int kind, dice *d) {
    draw_healthy(b, d);
    b->noise /= 3;
    b->hum = 0;
    b->jitter *= 0.6;
    b->supply = chance(d, 0.6) ? 24.0 : uniform(d, 14, 36);
    b->rpm = fmin(b->rpm, most_rpm(b->supply));
    b->fed = chance(d, 0.1);
    b->drag = uniform(d, 0.7, 1.5);
    b->dry = chance(d, 0.5) ? 0.0 : uniform(d, 0, 0.02);
    b->pickup_phase = uniform(d, 0, TURN);
    b->phase_2 = uniform(d, 0, TURN);
    b->damping = uniform(d, 0.01, 0.1);
    b->double_s = uniform(d, 1e-4, 5e-3);
    b->kind = kind;
    draw_fault(b, kind, d);
    if (kind != 0 && chance(d, 0.25)) { /* a second one, but none of the last three */
        b->second = 1 + (int)(dice_next(d) % (KINDS - 4));
        draw_fault(b, b->second, d);
    }
}

/* A healthy run-out: to the run's end or from a stop at any time, braked, coasting or swinging. */
static void draw_run_out(bench *b, dice *d) {
    draw_healthy(b, d);
    b->supply = uniform(d, 12, 36);
    b->rpm = fmin(b->rpm, most_rpm(b->supply));
    b->drag = uniform(d, 0.7, 1.5);
    b->dry = uniform(d, 0.005, 0.03);
    const double way = uniform(d, 0, 1);
    if (way < 0.3 && b->supply > 17) {
        draw_fault(b, b->kind = KINDS - 1, d);
    } else if (way < 0.6 && b->rpm > 170) {
        b->coasts = 1;
    }
    if (chance(d, 0.7)) {
        b->stop = chance(d, 0.5) ? (event){BY_TIME, uniform(d, 1, 17), NEVER} : drawn_event(d);
        if (chance(d, 0.3)) {
            b->release = (event){AFTER_STOP, uniform(d, 0.01, 3), NEVER};
        }
    }
}

/* ---- the plant ---- */

enum { ANGLE, SPEED, WORK, BENT, BENDING, STATES };
enum { KEPT = 128, QUEUE = 64, STEP_US = 50 };

typedef struct
{ /* first Fourier coefficients: of the force, and with errors that no run can tell */
    double cosine[2], sine[2], seconds;
} turn;

typedef struct {
    double seconds;
    uint32_t channel;
} pulse;

typedef struct {
    const bench *b;
    dice d;
    double t, y[STATES], inertia, duty, enable, turn_began;
    bool stuck, cut, pressed, stopped, stop_told, held, whole; /* held: by dry friction */
    uint32_t watchdog_us;
    uint64_t now_us, kicked_us;
    int queued;
    double play_at, jitter[2], lead[2]; /* this pass's jitter, in seconds and as an angle */
    double force[2], energy_0, energy_off, peak_high, peak_low;
    long turns;
    turn now, past[KEPT];
    pulse queue[QUEUE];
} plant;

static double driven(const plant *p, const double *y) {
    const bench *b = p->b;
    double torque = b->torque_2 * sin(2 * y[ANGLE] + b->phase_2) - b->drag * DRAG_NMS * y[SPEED];
    const bool stuck = p->stuck && (p->enable > 0.5 || b->ignores_enable);
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

/* Queue the pulses of the last step, from angle a, by speeds va to vb: on the cubic through both
 * ends. Far from a sensor its jitter becomes an angle, which stays while the slot is near. */
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

/* Fourier integrals over the angle from a to b, by a trapezoid. */
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

static void plant_start(plant *p, const bench *b) {
    *p = (plant){.b = b, .d = b->seed, .inertia = b->inertia * ROTOR_KGM2};
    for (int i = 0; i < 500; i++) { /* to where the rotor rests */
        p->y[ANGLE] += driven(p, p->y) - weighed(p->y);
    }
    p->energy_0 = energy(p);
}

static void plant_step(plant *p, double h) {
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

/* The load cell's reading in newtons: play, cubic error, gain, what is added, amplifier, counts. */
static double cell_reads(plant *p, bool recording) {
    const bench *b = p->b;
    const double u = p->play_at / (MOMENT * b->rpm * RPM * b->rpm * RPM);
    double reading = (1 + b->gain) * (WEIGHT_N + p->play_at * (1 + b->cubic * u * u)) +
                     b->drift * p->t + b->noise * normal(&p->d) +
                     b->hum * sin(TURN * b->hum_hz * p->t + b->hum_phase);
    reading += p->y[SPEED] > 1 ? b->pickup * cos(p->y[ANGLE] + b->pickup_phase) : 0;
    if (recording) {
        p->peak_high = fmax(p->peak_high, reading - WEIGHT_N * (1 + b->gain));
        p->peak_low = fmin(p->peak_low, reading - WEIGHT_N * (1 + b->gain));
    }
    reading = fmin(fmax(reading, b->clip_low), b->clip_high);
    return b->quantized > 0 ? b->quantized * nearbyint(reading / b->quantized) : reading;
}

static double sampled(plant *p, int what, bool recording) {
    const bench *b = p->b;
    const double volts = b->supply * (1 + b->supply_gain) + b->supply_off;
    switch (what) {
    case 0: return cell_reads(p, recording);
    case 1: return b->supply_sat > 0 ? fmin(b->supply_sat, volts) : volts;
    case 2: return p->pressed;
    case 3: return b->rpm * RPM;
    default: return b->fed;
    }
}

/* ---- a run: the hello, turns, and the judge ---- */

enum { DUTY, ENABLE, STATE, TRIP, QUALITY, AMPLITUDE, AMPLITUDE_HALF, PHASE, PHASE_HALF, MEASURED };
enum { FLOATS = 11, MOST_SAMPLES = 24, MOST_EDGES = 16, SAMPLES = 5 };

/* The signals of the rig, as the page's table has them, dials last: kind, name and period in ms. */
static const struct {
    int kind;
    const char *name;
    uint32_t ms;
} page[] = {{0, "duty", 0},       {0, "enable", 0},       {2, "theta", 0},
            {2, "theta", 0},      {1, "cell_force", 2},   {1, "supply", 2},
            {1, "stop_input", 2}, {3, "state", 0},        {3, "trip", 0},
            {3, "quality", 0},    {3, "amplitude", 0},    {3, "amplitude_half", 0},
            {3, "phase", 0},      {3, "phase_half", 0},   {3, "turns", 0},
            {3, "reset", 0},      {1, "dial_speed", 100}, {1, "dial_feed", 100}};
enum { SIGNALS = sizeof page / sizeof page[0] };

typedef struct {
    uint32_t start;
    int samples;
    double low[SAMPLES], high[SAMPLES], per_count[SAMPLES];
} hello;

static void read_hello(message *m, hello *h) {
    const uint32_t kind = get(m, 1), sequence = get(m, 2), ticks = get(m, 4);
    get_string(m);
    get_string(m);
    const uint32_t hz = get(m, 4), timer = get(m, 4);
    h->start = get(m, 4);
    h->samples = 0;
    if (kind != HELLO || sequence != 0 || ticks != h->start || hz != 1000000 || timer != 0) {
        disagree("kind %u, sequence %u, %u ticks/s in place of a hello", kind, sequence, hz);
    }
    const int rows = (int)get(m, 1);
    for (int i = 0, row = 0; row < SIGNALS; row++) {
        const size_t before = m->at;
        const int is_kind = i < rows ? (int)get(m, 1) : -1;
        const char *name = is_kind >= 0 ? get_string(m) : "nothing";
        if (strncmp(page[row].name, "dial", 4) == 0 && strcmp(name, page[row].name) != 0) {
            m->at = before; /* no dials */
            continue;
        }
        if (is_kind != page[row].kind || strcmp(name, page[row].name) != 0) {
            disagree("signal %d is %s, on the page %s", i, name, page[row].name);
        }
        get_string(m);
        const double low = get_float(m), high = get_float(m), per_count = get_float(m);
        const uint32_t period = get(m, 4);
        const double at = row == 2 ? 0 : PI / 2;
        if (period != 1000 * page[row].ms ||
            (is_kind == 2 && fmax(fabs(low - at + DEG), fabs(high - at - DEG)) > 1e-5)) {
            disagree("%s, %g to %g, every %u ticks", name, low, high, period);
        }
        if (is_kind == 1) {
            h->low[h->samples] = low;
            h->high[h->samples] = high;
            h->per_count[h->samples++] = per_count;
        }
        i++;
    }
    if (m->at != m->n) {
        disagree("%d signals and %zu bytes more in the hello", rows, m->n - m->at);
    }
}

typedef struct {
    int index, kind, second, status, state, state_before, trip, quality, turns, trip_state;
    bool wrong, on, tripped, ended;
    double note[FLOATS], amplitude, phase, rpm; /* of the result; the plant's */
    double energy_off, seconds, on_s, peak_high, peak_low, fastest;
    char why[160];
} outcome;

static void blame(outcome *o, bool *rule, const char *format, ...) {
    va_list values;
    va_start(values, format);
    if (!o->wrong && !o->on) {
        vsnprintf(o->why, sizeof o->why, format, values);
    }
    *rule = true;
    va_end(values);
}

/* Compare a good result with the force's Fourier coefficient over as many turns, the last ones or
 * up to two earlier. A result is right, too, if it has just those errors that no run can tell
 * (docs/rig.md): a gain off by less than 5 %, a sensor 1 by less than 5 degrees, a load train. */
static void judge_result(const plant *p, outcome *o) {
    double least = NEVER;
    for (int known = 0; known < 2; known++) {
        const double gain = known == 1 && fabs(p->b->gain) < 0.05 ? 1 + p->b->gain : 1;
        const double place = known == 1 && fabs(p->b->place_1) < 5 ? p->b->place_1 * DEG : 0;
        for (int back = 0; back < 3 && o->turns + back <= fmin((double)p->turns, KEPT); back++) {
            turn sum = {.seconds = 0};
            for (long i = p->turns - back - o->turns; i < p->turns - back; i++) {
                sum.cosine[0] += p->past[i % KEPT].cosine[known] / o->turns;
                sum.sine[0] += p->past[i % KEPT].sine[known] / o->turns;
                sum.seconds += p->past[i % KEPT].seconds / o->turns;
            }
            const double amplitude = gain * hypot(sum.cosine[0], sum.sine[0]);
            const double phase = atan2(-sum.sine[0], sum.cosine[0]) + place;
            const double off =
                (fabs(o->note[AMPLITUDE] - amplitude) - o->note[AMPLITUDE_HALF]) / amplitude;
            const double turned =
                fabs(remainder(o->note[PHASE] - phase, TURN)) - o->note[PHASE_HALF];
            if (fmax(off, turned) < least) {
                least = fmax(off, turned);
                o->amplitude = amplitude;
                o->phase = phase;
                o->rpm = TURN / sum.seconds / RPM;
            }
        }
    }
    if (o->quality == 0 && least > 0.01) {
        blame(o, &o->wrong, "good: %.3f +- %.3f N, %.2f +- %.2f deg; true are %.3f N, %.2f deg",
              o->note[AMPLITUDE], o->note[AMPLITUDE_HALF], o->note[PHASE] / DEG,
              o->note[PHASE_HALF] / DEG, o->amplitude, o->phase / DEG);
    }
}

/* After stop, a trip or the run's end no voltage may be asked for. A stage that drives all the same
 * must lose its enable within 1 s of the first turn that shows it: one by which the rotor has not
 * slowed down, or comes above 408 rpm in a run. */
typedef struct {
    double off_since, drives_since, shown, angle_0, last_at, last_took;
    long turns;
    bool ran, from_rest;
} safety;

static void judge_motor(safety *s, const plant *p, outcome *o) {
    const bool on = p->enable > 0.5;
    s->ran = s->ran || o->state == RUNNING || o->state >= SPIN_UP;
    const bool off = p->stop_told || o->state == TRIPPED || o->state == STOPPING ||
                     o->state == COAST || (o->state == IDLE && s->ran);
    s->off_since = off && s->off_since == NEVER ? p->t : s->off_since;
    if (s->off_since < NEVER && on && p->duty > 0) {
        blame(o, &o->on, "duty %.3f in state %d at %.3f s, off since %.3f s", p->duty, o->state,
              p->t, s->off_since);
    }
    if (p->stuck && s->drives_since == NEVER && s->off_since < NEVER) {
        s->drives_since = s->last_at = p->t;
        s->angle_0 = p->y[ANGLE];
        s->from_rest = fabs(p->y[SPEED]) < 1;
    }
    if (s->drives_since < NEVER && p->y[ANGLE] >= s->angle_0 + TURN * (double)(s->turns + 1)) {
        const double took = p->t - s->last_at;
        if (s->shown == NEVER && (s->turns > 0 ? took <= s->last_took * 1.01 : s->from_rest)) {
            s->shown = p->t;
        }
        s->turns++;
        s->last_at = p->t;
        s->last_took = took;
    }
    if (p->turns > 0) {
        o->fastest = fmax(o->fastest, TURN / p->past[(p->turns - 1) % KEPT].seconds / RPM);
    }
    s->shown = p->stuck && on && o->fastest > 408 ? fmin(s->shown, p->t) : s->shown;
    if (on && p->stuck && s->shown < NEVER) {
        o->on_s = p->t - s->shown;
        if (o->on_s > 1) {
            blame(o, &o->on,
                  "enable on 1 s after a turn shows drive, at %.2f s; off: %.2f s; %d, %.0f rpm",
                  s->shown, fmin(s->off_since, 999), o->state, p->y[SPEED] / RPM);
        }
    }
}

static void read_orders(message *m, plant *p, outcome *o, uint32_t *until, uint32_t *watchdog,
                        bool *kicked) {
    double value[FLOATS];
    *until = get(m, 4);
    get(m, 4), get(m, 4), get(m, 4);
    *watchdog = get(m, 4);
    *kicked = (get(m, 1) & 1U) != 0;
    if (get(m, 1) != FLOATS) {
        disagree("%zu bytes of orders", m->n);
    }
    for (int i = 0; i < FLOATS; i++) {
        value[i] = get_float(m);
        if (!isfinite(value[i])) {
            disagree("float %d of orders is %g", i, value[i]);
        }
    }
    p->duty = p->cut ? 0 : fmin(1, fmax(0, value[DUTY]));
    p->enable = p->cut ? 0 : value[ENABLE];
    o->state_before = o->state;
    o->state = (int)value[STATE];
    o->trip = (int)value[TRIP];
    if (o->state == TRIPPED && !o->tripped) {
        o->tripped = true;
        o->trip_state = o->state_before;
    }
    if (o->turns == 0 && value[MEASURED] > 0) {
        memcpy(o->note, value, sizeof value);
        o->turns = (int)value[MEASURED];
        o->quality = (int)value[QUALITY];
        judge_result(p, o);
    }
}

static void watch(event *e, double t, int state, bool stopped) {
    if (e->at == NEVER &&
        (e->state == BY_TIME || e->state == state || (e->state == AFTER_STOP && stopped))) {
        e->at = e->state == BY_TIME ? e->delay : t + e->delay;
    }
}

/* Let the plant go on until its timer shows until, and write down what its sensors give. */
static void advance(plant *p, const hello *h, uint32_t until, bool recording, message *m) {
    message taken = {.n = 0};
    uint32_t edges = 0, samples = 0;
    const int32_t ahead = (int32_t)(until - (h->start + (uint32_t)p->now_us));
    const uint64_t end = p->now_us + (uint64_t)(ahead > 0 ? ahead : 0);
    while (p->now_us < end) {
        uint64_t to = (p->now_us / STEP_US + 1) * STEP_US; /* samples lie on the grid, too */
        to = to < end ? to : end;
        plant_step(p, (double)(to - p->now_us) * 1e-6);
        p->now_us = to;
        p->t = (double)to * 1e-6;
        p->pressed = p->t >= p->b->stop.at && p->t < p->b->release.at;
        p->stopped = p->stopped || p->pressed;
        p->stuck = p->t >= p->b->stuck.at;
        p->cut = p->cut || (p->watchdog_us > 0 && to - p->kicked_us > p->watchdog_us);
        p->duty = p->cut ? 0 : p->duty;
        p->enable = p->cut ? 0 : p->enable;
        for (int i = 0; i < h->samples && to % 2000 == 0 && samples < MOST_SAMPLES; i++) {
            if ((i > 2 && to % 100000 != 0) || (i == 0 && p->t >= p->b->silent.at)) {
                continue;
            }
            const double value = sampled(p, i, recording);
            const double held = fmin(fmax(value, h->low[i]), h->high[i]);
            put(&taken, h->start + (uint32_t)to, 4);
            put(&taken, (uint32_t)(int32_t)nearbyint(held / h->per_count[i]), 4);
            put(&taken, (uint32_t)i, 1);
            put(&taken, value >= h->high[i] || value <= h->low[i], 1);
            samples++;
            p->stop_told = p->stop_told || (i == 2 && p->pressed);
        }
    }
    m->n = 11;
    for (; edges < MOST_EDGES && p->queued > 0 && p->queue[0].seconds <= p->t; edges++) {
        put(m, h->start + (uint32_t)(uint64_t)(p->queue[0].seconds * 1e6), 4);
        put(m, p->queue[0].channel, 1);
        memmove(p->queue, p->queue + 1, (size_t)--p->queued * sizeof p->queue[0]);
    }
    memcpy(m->byte + m->n, taken.byte, taken.n);
    m->n += taken.n;
    m->byte[8] = p->cut;
    m->byte[9] = (uint8_t)edges;
    m->byte[10] = (uint8_t)samples;
}

static void run(const char *firmware, bench *b, outcome *o, bool verbose) {
    line l;
    message m;
    hello h;
    plant p;
    uint32_t until = 0;
    safety s = {.off_since = NEVER, .drives_since = NEVER, .shown = NEVER};
    line_start(&l, firmware);
    if (!hear(&l, &m)) {
        disagree("%s ends without a hello, status %d", firmware, line_end(&l));
    }
    read_hello(&m, &h);
    plant_start(&p, b);
    until = h.start;
    for (uint32_t sequence = 0;; sequence = (sequence + 1) & 0xFFFFU) {
        advance(&p, &h, until, o->state == RECORD, &m);
        const uint32_t ticks = h.start + (uint32_t)p.now_us;
        const size_t n = m.n;
        m.n = 0;
        put(&m, 1, 1);
        put(&m, READINGS, 1);
        put(&m, sequence, 2);
        put(&m, ticks, 4);
        m.n = n;
        say(&l, &m);
        uint32_t kind = REMEMBER;
        while (kind == REMEMBER && !o->ended) {
            o->ended = !hear(&l, &m);
            kind = o->ended ? 0 : get(&m, 1);
        }
        if (o->ended) {
            break;
        }
        if (kind != ORDERS || get(&m, 2) != sequence || get(&m, 4) != ticks) {
            disagree("kind %u in place of orders %u at %u", kind, sequence, ticks);
        }
        bool kicked = false;
        read_orders(&m, &p, o, &until, &p.watchdog_us, &kicked);
        p.kicked_us = kicked ? p.now_us : p.kicked_us;
        if (o->state != o->state_before && verbose) {
            printf("%9.3f s  state %d, trip %d, %.1f rpm, enable %.0f\n", p.t, o->state, o->trip,
                   p.y[SPEED] / RPM, p.enable);
        }
#define X(name) watch(&b->name, p.t, o->state, p.stopped);
        EVENTS(X)
#undef X
        judge_motor(&s, &p, o);
        if (p.t > 300 || p.t > b->stuck.at + 60 || o->on) {
            break;
        }
    }
    if (p.enable > 0.5 && (p.stuck || p.duty > 0)) {
        blame(o, &o->on, "%s at %.3f s with enable on, duty %.3f, state %d%s",
              o->ended ? "ends" : "does not end", p.t, p.duty, o->state, p.stuck ? ", stuck" : "");
    }
    o->status = line_end(&l);
    if (o->ended && (o->status < 0 || o->status > 2)) {
        disagree("the firmware ends with status %d", o->status);
    }
    o->seconds = p.t;
    o->energy_off = p.energy_off;
    o->peak_high = p.peak_high;
    o->peak_low = p.peak_low;
}

/* ---- campaigns ---- */

enum mode { BENCH, HEALTHY, RUNOUTS, STUCK, NOMINAL, MODES };
static const char *const mode_name[MODES] = {"bench", "healthy", "runouts", "stuck", "nominal"};
static const int mode_runs[MODES] = {500, 200, 2000, 500, 1};

typedef struct {
    enum mode mode;
    const char *firmware, *swing, *set[16];
    uint64_t seed;
    int runs, one, only, sets;
} campaign;

static void play(const campaign *c, int index, outcome *o) {
    dice d =
        c->seed * 0x2545F4914F6CDD1DU + (uint64_t)index * 0x9E6C63D0876A9A47U + (uint64_t)c->mode;
    bench b;
    dice_next(&d);
    switch (c->mode) {
    case BENCH: draw_bench(&b, c->only >= 0 ? c->only : index % KINDS, &d); break;
    case STUCK: draw_bench(&b, KINDS - 2, &d); break;
    case RUNOUTS: draw_run_out(&b, &d); break;
    case HEALTHY: draw_healthy(&b, &d); break;
    case NOMINAL:
    case MODES:
        draw_healthy(&b, &d);
        b.noise = b.hum = b.jitter = 0;
        b.inertia = 1;
        b.rpm = 330;
    }
    for (int i = 0; i < c->sets; i++) {
        const char *value = strchr(c->set[i], '=');
#define X(name) \
    if (value != NULL && strncmp(c->set[i], #name "=", sizeof #name) == 0) { \
        b.name = atof(value + 1); \
    }
        NUMBERS(X)
#undef X
    }
    const outcome fresh = {.index = index, .kind = b.kind, .second = b.second, .quality = -1};
    const char *firmware = b.swings != 0 ? c->swing : c->firmware;
    if (b.clip_above > 0 || b.clip_below > 0) { /* a share of the peaks that come unclipped */
        bench whole = b;
        *o = fresh;
        run(firmware, &whole, o, false);
        const double tare = (1 + b.gain) * WEIGHT_N;
        b.clip_high =
            b.clip_above > 0 && o->peak_high > 0 ? tare + b.clip_above * o->peak_high : NEVER;
        b.clip_low =
            b.clip_below > 0 && o->peak_low < 0 ? tare + b.clip_below * o->peak_low : -NEVER;
    }
    if (c->one >= 0) {
#define X(name) b.name != 0 ? printf(#name " %g, ", b.name) : 0;
        NUMBERS(X)
#undef X
#define X(name) \
    b.name.state > NOT_AT_ALL ? printf(#name " %d+%gs, ", b.name.state, b.name.delay) : 0;
        EVENTS(X)
#undef X
        puts(kinds[b.kind].name);
    }
    *o = fresh;
    run(firmware, &b, o, c->one >= 0);
    if (c->one >= 0) {
        printf("status %d after %.3f s, trip %d, quality %d of %d turns at %.2f rpm\n", o->status,
               o->seconds, o->trip, o->quality, o->turns, o->rpm);
        printf("force %.3f +- %.3f N, true %.4f N; phase %.3f +- %.3f deg, true %.4f deg\n",
               o->note[AMPLITUDE], o->note[AMPLITUDE_HALF], o->amplitude, o->note[PHASE] / DEG,
               o->note[PHASE_HALF] / DEG, o->phase / DEG);
        printf("peaks %.2f %.2f N, fastest turn %.1f rpm, energy balance off by %.2e J\n%s\n",
               o->peak_low, o->peak_high, o->fastest, o->energy_off,
               o->wrong || o->on ? o->why : "no rule is broken");
    }
}

typedef struct {
    int runs, quality[4], tripped, wrong, on, trips[16]; /* quality: none, good, ... */
    double on_s;
} tally;

static void count(tally *t, const outcome *o) {
    t->runs++;
    t->quality[(o->quality + 1) & 3]++;
    t->tripped += o->tripped;
    t->wrong += o->wrong;
    t->on += o->on;
    t->trips[o->tripped ? o->trip & 15 : 0]++;
    t->on_s = fmax(t->on_s, o->on_s);
}

static void print_row(const char *name, const tally *t) {
    printf("| %-11s | %4d | %4d | %4d | %4d | %4d | %4d | %4d | %4d | %5.3f |", name, t->runs,
           t->quality[1], t->quality[2], t->quality[3], t->quality[0], t->tripped, t->wrong, t->on,
           t->on_s);
    for (int i = 1; i < 16; i++) {
        t->trips[i] > 0 ? printf(" %d: %d", i, t->trips[i]) : 0;
    }
    puts(" |");
}

static void print_run(const campaign *c, const outcome *o) {
    printf("run %d (%s%s%s): ", o->index, kinds[o->kind].name, o->second > 0 ? ", " : "",
           o->second > 0 ? kinds[o->second].name : "");
    if (o->wrong || o->on) {
        puts(o->why);
    } else {
        printf("quality %d, trip %d from state %d, %.3f s\n", o->quality, o->trip, o->trip_state,
               o->seconds);
    }
    printf("    build/rig_bench %s --seed %llu --run %d", mode_name[c->mode],
           (unsigned long long)c->seed, o->index);
    c->only >= 0 ? printf(" --only %s", kinds[c->only].name) : 0;
    for (int i = 0; i < c->sets; i++) {
        printf(" --set %s", c->set[i]);
    }
    puts("");
}

/* Two workers at most play the runs. This process counts what they find. */
static int play_all(const campaign *c) {
    static tally of[KINDS], all;
    const bool healthy = c->mode == HEALTHY || c->mode == RUNOUTS;
    int results[2];
    double energy_off = 0;
    if (pipe(results) != 0) {
        return 2;
    }
    for (int job = 0; job < 2; job++) {
        if (fork() == 0) {
            close(results[0]);
            for (int i = job; i < c->runs; i += 2) {
                outcome o;
                play(c, i, &o);
                if (write(results[1], &o, sizeof o) != (ssize_t)sizeof o) {
                    exit(1);
                }
            }
            exit(0);
        }
    }
    close(results[1]);
    for (outcome o; read(results[0], &o, sizeof o) == (ssize_t)sizeof o;) {
        count(&of[o.kind], &o);
        count(&all, &o);
        energy_off = fmax(energy_off, o.energy_off);
        if (o.wrong || o.on || (healthy && o.tripped) || (c->mode == HEALTHY && o.quality != 0)) {
            print_run(c, &o);
        }
    }
    puts("| kind        | runs | good | dbtf | rfsd | none | trip | wrong | on  |  on s | trips: "
         "number, runs |\n|---|---|---|---|---|---|---|---|---|---|---|");
    for (int k = 0; k < KINDS; k++) {
        of[k].runs > 0 && of[k].runs < all.runs ? print_row(kinds[k].name, &of[k]) : (void)0;
    }
    print_row("all", &all);
    bool right = all.wrong == 0 && all.on == 0 && energy_off < 1e-5;
    right = right && (!healthy || all.tripped == 0);
    right = right && (c->mode != HEALTHY || all.quality[1] * 20 >= all.runs * 19);
    printf("%s, %d runs, seed %llu, %s; the plant's energy balance is off by %.1e J: %s\n",
           mode_name[c->mode], all.runs, (unsigned long long)c->seed, c->firmware, energy_off,
           right ? "no rule is broken" : "a rule is broken");
    return all.runs != c->runs ? 2 : right ? 0 : 1;
}

int main(int argc, char **argv) {
    campaign c = {.firmware = "build/pil_dialled", .swing = "build/pil_swing", .seed = 1};
    int mode = MODES - 1;
    while (mode >= 0 && (argc < 2 || strcmp(argv[1], mode_name[mode]) != 0)) {
        mode--;
    }
    bool usage = mode < 0 || argc % 2 != 0;
    c.one = mode == NOMINAL ? 0 : -1;
    c.only = -1;
    for (int i = 2; i + 1 < argc; i += 2) {
        const char *option = argv[i], *value = argv[i + 1];
        if (strcmp(option, "--firmware") == 0) {
            c.firmware = value;
        } else if (strcmp(option, "--swing") == 0) {
            c.swing = value;
        } else if (strcmp(option, "--seed") == 0) {
            c.seed = strtoull(value, NULL, 0);
        } else if (strcmp(option, "--runs") == 0) {
            c.runs = atoi(value);
        } else if (strcmp(option, "--run") == 0) {
            c.one = atoi(value);
        } else if (strcmp(option, "--set") == 0 && c.sets < 16) {
            c.set[c.sets++] = value;
        } else if (strcmp(option, "--only") == 0) {
            for (c.only = KINDS - 1; c.only >= 0 && !is(c.only, value); c.only--) {
            }
            usage = usage || c.only < 0;
        } else {
            usage = true;
        }
    }
    if (usage) {
        fputs("usage: rig_bench bench|healthy|runouts|stuck|nominal [--firmware PATH]\n"
              "    [--swing PATH] [--seed N] [--runs N] [--run I] [--only KIND]\n"
              "    [--set NUMBER=VALUE]\n",
              stderr);
        return 2;
    }
    c.mode = (enum mode)mode;
    c.runs = c.runs > 0 ? c.runs : mode_runs[mode];
    signal(SIGPIPE, SIG_IGN);
    signal(SIGALRM, silent);
    setvbuf(stdout, NULL, _IOLBF, 0);
    setpriority(PRIO_PROCESS, 0, 10);
    if (c.one >= 0) {
        outcome o;
        play(&c, c.one, &o);
        return o.wrong || o.on;
    }
    return play_all(&c);
}
