/* functions_exhaustive.c: the float functions of core/function.h and the square root, compared with the library's in
 * double, in float ulps. Functions of one argument run over all 2^32 floats, those of two over 2^32 scattered pairs.
 * Sine and cosine run over all 2^32 phases, and their errors are absolute. Both square roots must be the nearest
 * float. Their reference is the double root, rounded: double has more than twice a float's bits plus two (Figueroa,
 * When is double rounding innocuous?, SIGNUM Newsletter 30 (1995) 3).
 *
 *     functions_exhaustive [STRIDE [FUNCTION]]
 *
 * STRIDE > 1 takes one argument out of every STRIDE, at a scattered place in each. Prints each function's worst
 * error, its argument, and the number of results that are not the nearest float (of the sine and cosine: the RMS
 * error). The exit status is 1 if an error exceeds the bound of core/function.h, or if infinities, NaNs or signs of
 * zero differ. The library's own error, some 2^-29 ulp, does not show. */
#include "core/angle.h"
#include "core/function.h"
#include "core/root.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define ARGUMENTS (UINT64_C(1) << 32)
#define CORES_MAX 64

typedef struct subject {
    const char *name;
    double allowed; /* units in the last place */
    float (*one)(float);
    double (*reference)(double);
    float (*two)(float, float);
    double (*reference_of_two)(double, double);
    float (*of_phase)(wh_phase); /* `allowed` is an absolute error; `reference` takes radians */
} subject;

static float used_sqrt(float x) { return WH_SQRT(x); }

static float sine_of(wh_phase phase) {
    float sine;
    float cosine;
    wh_sincos(phase, &sine, &cosine);
    return sine;
}

static float cosine_of(wh_phase phase) {
    float sine;
    float cosine;
    wh_sincos(phase, &sine, &cosine);
    return cosine;
}

static const subject subjects[] = {
    {"sine", 1e-7, .of_phase = sine_of, .reference = sin},
    {"cosine", 1e-7, .of_phase = cosine_of, .reference = cos},
    {"sqrt", 0.5, .one = wh_sqrt, .reference = sqrt},
    {"WH_SQRT", 0.5, .one = used_sqrt, .reference = sqrt},
    {"exp", 1.0, .one = wh_exp, .reference = exp},
    {"log", 1.0, .one = wh_log, .reference = log},
    {"tan", 2.0, .one = wh_tan, .reference = tan},
    {"asin", 1.0, .one = wh_asin, .reference = asin},
    {"acos", 1.0, .one = wh_acos, .reference = acos},
    {"atan", 1.0, .one = wh_atan, .reference = atan},
    {"atan2", 2.0, .two = wh_atan2, .reference_of_two = atan2},
    {"pow", 2.0, .two = wh_pow, .reference_of_two = pow},
    {"sinh", 1.0, .one = wh_sinh, .reference = sinh},
    {"cosh", 1.0, .one = wh_cosh, .reference = cosh},
    {"tanh", 1.0, .one = wh_tanh, .reference = tanh},
};
#define ONE_MORE(name) +1
_Static_assert(sizeof subjects / sizeof subjects[0] == 4 WH_FUNCTIONS(ONE_MORE, ONE_MORE),
               "every function of core/function.h is tried");

typedef struct tally {
    uint64_t taken;
    double worst;
    float worst_at[2];
    uint32_t worst_phase;
    double squares; /* sum of the squared errors at phases */
    uint64_t not_nearest;
    uint64_t wrong; /* results that differ from the reference in infinity, NaN or sign */
    float wrong_at[2];
} tally;

static uint64_t scatter(uint64_t x) { /* splitmix64; Steele, Lea, Flood, OOPSLA 2014 */
    x += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

static float float_of(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Returns 1 divided by the spacing of floats near `size`. `size` is at most the largest float. */
static double per_unit(double size) {
    uint64_t bits;
    memcpy(&bits, &size, sizeof bits);
    const uint64_t exponent = bits >> 52 < 1023U - 126U ? 1023U - 126U : bits >> 52;
    const uint64_t inverse = (2U * 1023U + 23U - exponent) << 52;
    memcpy(&size, &inverse, sizeof size);
    return size;
}

static void judge(tally *t, float got, double wanted, float x, float y) {
    t->taken++;
    if (isnan(wanted) || isnan(got) || !signbit(wanted) != !signbit(got)) {
        if (!(isnan(wanted) && isnan(got)) && t->wrong++ == 0) {
            t->wrong_at[0] = x;
            t->wrong_at[1] = y;
        }
        return;
    }
    if (got == (float)wanted) {
        if (isinf(got) || (double)got == wanted) {
            return;
        }
    } else {
        t->not_nearest++;
    }
    /* An infinite result counts as 2^128, the number after the largest float. */
    const double reached = isinf(got) ? 0x1p128 : fabs((double)got);
    const double truth = fmin(fabs(wanted), 0x1p128);
    const double error = fabs(reached - truth) * per_unit(fmin(truth, 0x1.fffffep127));
    if (error > t->worst) {
        t->worst = error;
        t->worst_at[0] = x;
        t->worst_at[1] = y;
    }
}

static void judge_at_phase(tally *t, float got, double wanted, uint32_t phase) {
    const double error = fabs((double)got - wanted);
    t->taken++;
    t->squares += error * error;
    t->wrong += !(fabsf(got) <= 1.0f);
    if (error > t->worst) {
        t->worst = error;
        t->worst_phase = phase;
    }
}

/* Five kinds of pairs in turn: any floats; similar sizes; a power without overflow; a base near one; small integers. */
static void pair_of(uint64_t k, float *x, float *y) {
    const uint64_t s = scatter(k);
    const uint32_t high = (uint32_t)(s >> 32);
    const uint32_t low = (uint32_t)s;
    *x = float_of(high);
    *y = float_of(low);
    switch (k % 5U) {
    case 1: *y = ldexpf(*x, (int)(low & 63U) - 32) * (1.0f + (float)(low >> 6) * 0x1p-26f); break;
    case 2:
        *x = float_of(high & 0x7fffffffU);
        *y = (float)((double)(int32_t)low * (0x1p-31 * 105.0) / log((double)*x));
        break;
    case 3:
        *x = 1.0f + (float)(int32_t)high * 0x1p-31f * ldexpf(1.0f, -(int)(low & 15U));
        *y = (float)((double)(int32_t)low * (0x1p-31 * 105.0) / log((double)*x));
        break;
    case 4:
        *x = (float)((int32_t)(high & 1023U) - 512) / (float)(1U << (high >> 29));
        *y = (float)((int32_t)(low & 255U) - 128) / (float)(1U << (low >> 30));
        break;
    }
}

/* Measures the strata from `first` to last - 1. A stratum is `stride` arguments, one of which is measured. */
static void measure(const subject *s, uint64_t first, uint64_t last, uint64_t stride, tally *t) {
    for (uint64_t k = first; k < last; k++) {
        const uint64_t at = k * stride + (stride > 1 ? scatter(k) % stride : 0U);
        if (s->of_phase != NULL) {
            const double rad = (double)at * (6.283185307179586 / 4294967296.0);
            judge_at_phase(t, s->of_phase((wh_phase)at), s->reference(rad), (uint32_t)at);
        } else if (s->one != NULL) {
            const float x = float_of((uint32_t)at);
            judge(t, s->one(x), s->reference((double)x), x, 0.0f);
        } else {
            float x;
            float y;
            pair_of(at, &x, &y);
            judge(t, s->two(x, y), s->reference_of_two((double)x, (double)y), x, y);
        }
    }
}

static void merge(tally *into, const tally *from) {
    into->taken += from->taken;
    into->not_nearest += from->not_nearest;
    if (from->worst > into->worst) {
        into->worst = from->worst;
        memcpy(into->worst_at, from->worst_at, sizeof from->worst_at);
        into->worst_phase = from->worst_phase;
    }
    into->squares += from->squares;
    if (into->wrong == 0) {
        memcpy(into->wrong_at, from->wrong_at, sizeof from->wrong_at);
    }
    into->wrong += from->wrong;
}

/* Measures with one process per core. Returns false if one failed. */
static int measure_on_all_cores(const subject *s, uint64_t stride, tally *all) {
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    const uint64_t cores = online < 1 ? 1U : (online > CORES_MAX ? CORES_MAX : (uint64_t)online);
    const uint64_t strata = ARGUMENTS / stride;
    int channel[2];
    if (pipe(channel) != 0) {
        perror("functions_exhaustive: pipe");
        return 0;
    }
    uint64_t started = 0;
    for (; started < cores; started++) {
        const pid_t child = fork();
        if (child < 0) {
            perror("functions_exhaustive: fork");
            break;
        }
        if (child == 0) {
            tally t = {0};
            measure(s, strata * started / cores, strata * (started + 1) / cores, stride, &t);
            _exit(write(channel[1], &t, sizeof t) == (ssize_t)sizeof t ? 0 : 1);
        }
    }
    close(channel[1]);
    int whole = started == cores;
    tally t;
    while (read(channel[0], &t, sizeof t) == (ssize_t)sizeof t) {
        merge(all, &t);
    }
    close(channel[0]);
    for (uint64_t i = 0; i < started; i++) {
        int status = 1;
        whole = wait(&status) > 0 && status == 0 && whole;
    }
    return whole && all->taken == strata;
}

static int show(const subject *s, const tally *t) {
    const int good = t->worst <= s->allowed && t->wrong == 0;
    if (s->of_phase != NULL) {
        printf("%-6s %11llu  worst %.3e at phase 0x%08x  rms %.3e  %s\n", s->name,
               (unsigned long long)t->taken, t->worst, (unsigned)t->worst_phase,
               sqrt(t->squares / (double)t->taken), good ? "ok" : "TOO MUCH");
        return good;
    }
    printf("%-6s %11llu  worst %.4f units at %a", s->name, (unsigned long long)t->taken, t->worst,
           (double)t->worst_at[0]);
    if (s->two != NULL) {
        printf(", %a", (double)t->worst_at[1]);
    }
    printf("  not the nearest %.3f %%  %s\n", 100.0 * (double)t->not_nearest / (double)t->taken,
           good ? "ok" : "TOO MUCH");
    if (t->wrong > 0) {
        printf("       %llu wrong in kind or sign, first at %a, %a\n", (unsigned long long)t->wrong,
               (double)t->wrong_at[0], (double)t->wrong_at[1]);
    }
    fflush(stdout);
    return good;
}

int main(int argc, char **argv) {
    unsigned long stride = 1;
    if (argc > 1) {
        char *end;
        stride = strtoul(argv[1], &end, 10);
        if (argc > 3 || *end != '\0' || stride < 1 || stride > (1UL << 24)) {
            fputs("usage: functions_exhaustive [STRIDE, 1 to 16777216 [FUNCTION]]\n", stderr);
            return 2;
        }
    }
    int good = 1;
    int known = 0;
    for (size_t i = 0; i < sizeof subjects / sizeof subjects[0]; i++) {
        if (argc > 2 && strcmp(argv[2], subjects[i].name) != 0) {
            continue;
        }
        known = 1;
        tally all = {0};
        if (!measure_on_all_cores(&subjects[i], stride, &all)) {
            fputs("functions_exhaustive: a process failed\n", stderr);
            return 1;
        }
        good = show(&subjects[i], &all) && good;
    }
    if (!known) {
        fprintf(stderr, "functions_exhaustive: no function '%s'\n", argv[2]);
        return 2;
    }
    return good ? 0 : 1;
}
