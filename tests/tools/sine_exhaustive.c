/* sine_exhaustive.c: the float sine and cosine against a double reference, at all 2^32 phases.
 *
 *     sine_exhaustive [STRIDE]
 *
 * STRIDE > 1 takes one phase out of every STRIDE, at a scattered place in each. Prints the worst and the RMS error of both
 * functions. The exit status is 1 if either error exceeds 1e-7.
 *
 * The reference is sinl and cosl of a multiple of 2^11 phases, rotated by the remainder with the addition theorems in double: 6
 * operations instead of two library calls. About one phase in 2^16 is also compared with sinl and cosl themselves. */
#include "core/angle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#define WORST_ALLOWED 1e-7
#define REFERENCE_ALLOWED 1e-14

#define PHASES (UINT64_C(1) << 32)
#define BLOCK_BITS 11
#define BLOCK (1U << BLOCK_BITS)
#define RAD_PER_PHASE (6.283185307179586476925286766559L / 4294967296.0L)

typedef struct tally {
    double worst;
    uint32_t worst_at;
    double sum_of_squares;
} tally;

typedef struct result {
    uint64_t phases;
    tally sine;
    tally cosine;
    double reference_worst; /* of the reference against sinl and cosl themselves */
    uint32_t over_one;      /* values beyond one */
} result;

static double rest_sine[BLOCK];
static double rest_cosine[BLOCK];

static uint32_t scatter(uint32_t x) {
    x = (x ^ (x >> 16)) * UINT32_C(0x7feb352d);
    x = (x ^ (x >> 15)) * UINT32_C(0x846ca68b);
    return x ^ (x >> 16);
}

static void count(tally *t, double error, uint32_t phase) {
    const double size = fabs(error);
    t->sum_of_squares += error * error;
    if (!(size <= t->worst)) { /* NaN is the worst */
        t->worst = size;
        t->worst_at = phase;
    }
}

static void merge(tally *into, const tally *from) {
    into->sum_of_squares += from->sum_of_squares;
    if (!(from->worst <= into->worst)) {
        into->worst = from->worst;
        into->worst_at = from->worst_at;
    }
}

/* The distance of a phase's reference (s, c) from the library's own value. */
static double reference_error(uint32_t phase, double s, double c) {
    const long double angle = (long double)phase * RAD_PER_PHASE;
    return (double)fmaxl(fabsl((long double)s - sinl(angle)), fabsl((long double)c - cosl(angle)));
}

static void show_progress(uint64_t done, uint64_t all) {
    fprintf(stderr, "\r%3u %%", (unsigned)(100 * done / all));
}

/* Strata first to last - 1 of `stride` phases each, of which one is taken. */
static result measure(uint64_t first, uint64_t last, uint32_t stride, int show) {
    result r = {.phases = last - first};
    uint32_t block = UINT32_MAX; /* no block: there are only 2^21 */
    double block_sine = 0.0;
    double block_cosine = 0.0;
    for (uint64_t k = first; k < last; k++) {
        uint32_t phase = (uint32_t)(k * stride);
        if (stride > 1) {
            phase += scatter((uint32_t)k) % stride;
        }
        if (phase >> BLOCK_BITS != block) {
            block = phase >> BLOCK_BITS;
            const long double angle = (long double)(block << BLOCK_BITS) * RAD_PER_PHASE;
            block_sine = (double)sinl(angle);
            block_cosine = (double)cosl(angle);
        }
        const uint32_t rest = phase & (BLOCK - 1U);
        const double s = block_sine * rest_cosine[rest] + block_cosine * rest_sine[rest];
        const double c = block_cosine * rest_cosine[rest] - block_sine * rest_sine[rest];
        float sine;
        float cosine;
        wh_sincos(phase, &sine, &cosine);
        count(&r.sine, (double)sine - s, phase);
        count(&r.cosine, (double)cosine - c, phase);
        r.over_one += fabsf(sine) > 1.0f || fabsf(cosine) > 1.0f;
        if ((scatter(phase) & 0xffffU) == 0) {
            r.reference_worst = fmax(r.reference_worst, reference_error(phase, s, c));
        }
        if (show && (k & 0xffffffU) == 0) {
            show_progress(k - first, last - first);
        }
    }
    return r;
}

/* The second half of the strata in a child process, the first half here. Zero if the child failed. */
static int measure_on_two_cores(uint64_t strata, uint32_t stride, result *both) {
    int channel[2];
    if (pipe(channel) != 0) {
        perror("sine_exhaustive: pipe");
        return 0;
    }
    const pid_t child = fork();
    if (child < 0) {
        perror("sine_exhaustive: fork");
        return 0;
    }
    if (child == 0) {
        const result r = measure(strata / 2, strata, stride, 0);
        _exit(write(channel[1], &r, sizeof r) == (ssize_t)sizeof r ? 0 : 1);
    }
    close(channel[1]);
    *both = measure(0, strata / 2, stride, isatty(STDERR_FILENO));
    if (isatty(STDERR_FILENO)) {
        fputs("\r     \r", stderr);
    }
    result other;
    const int whole = read(channel[0], &other, sizeof other) == (ssize_t)sizeof other;
    close(channel[0]);
    int status = 1;
    if (waitpid(child, &status, 0) != child || status != 0 || !whole) {
        fputs("sine_exhaustive: the second process failed\n", stderr);
        return 0;
    }
    both->phases += other.phases;
    merge(&both->sine, &other.sine);
    merge(&both->cosine, &other.cosine);
    both->reference_worst = fmax(both->reference_worst, other.reference_worst);
    both->over_one += other.over_one;
    return 1;
}

static int print_tally(const char *name, const tally *t, uint64_t phases) {
    const int good = t->worst <= WORST_ALLOWED;
    printf("%-7s worst %.3e at phase 0x%08lx (%.6f deg)  rms %.3e  %s\n", name, t->worst,
           (unsigned long)t->worst_at, (double)t->worst_at * (360.0 / (double)PHASES),
           sqrt(t->sum_of_squares / (double)phases), good ? "ok" : "TOO MUCH");
    return good;
}

int main(int argc, char **argv) {
    unsigned long stride = 1;
    if (argc > 1) {
        char *end;
        stride = strtoul(argv[1], &end, 10);
        if (argc > 2 || *end != '\0' || stride < 1 || stride > (1UL << 24)) {
            fputs("usage: sine_exhaustive [STRIDE, 1 to 16777216]\n", stderr);
            return 2;
        }
    }
    for (uint32_t i = 0; i < BLOCK; i++) {
        rest_sine[i] = (double)sinl(i * RAD_PER_PHASE);
        rest_cosine[i] = (double)cosl(i * RAD_PER_PHASE);
    }
    result r;
    if (!measure_on_two_cores(PHASES / stride, (uint32_t)stride, &r)) {
        return 1;
    }
    printf("float sine and cosine at %llu phases of 2^32, absolute error against double:\n",
           (unsigned long long)r.phases);
    const int sine_good = print_tally("sine", &r.sine, r.phases);
    const int cosine_good = print_tally("cosine", &r.cosine, r.phases);
    printf("values beyond one: %lu; the reference itself errs by up to %.1e\n",
           (unsigned long)r.over_one, r.reference_worst);
    return sine_good && cosine_good && r.over_one == 0 && r.reference_worst <= REFERENCE_ALLOWED
               ? 0
               : 1;
}
