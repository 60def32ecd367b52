/* test_counts.c: how many steps a run takes, and when they are, against whole numbers: from nanoseconds to
 * hours a step, and from one step to 50 years. WH_COUNTS=N: so many random pairs. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/emit/emit.h"

#include "unity.h"

void suite_counts(void);

__extension__ typedef unsigned __int128 wide;

static uint64_t seed_now;

static uint64_t random_below(uint64_t most) { /* xorshift64 (Marsaglia, 2003) */
    seed_now ^= seed_now << 13;
    seed_now ^= seed_now >> 7;
    seed_now ^= seed_now << 17;
    return seed_now % most;
}

/* --- pairs of step and until ------------------------------------------------------------------------- */

/* digits / in, and its text. */
typedef struct duration {
    uint64_t digits;
    uint64_t in; /* a power of ten */
    char text[64];
} duration;

/* `digits` of so many places behind the point, of a unit of 1/per s. */
static duration duration_of(uint64_t digits, int places, const char *of, uint64_t per) {
    duration d = {digits, per, ""};
    char number[32];
    int length = snprintf(number, sizeof number, "%0*" PRIu64, places + 1, digits);
    snprintf(d.text, sizeof d.text, "%.*s%s%s [%s]", length - places, number, places > 0 ? "." : "",
             number + length - places, of);
    for (int i = 0; i < places; i++) {
        d.in *= 10;
    }
    return d;
}

static uint64_t number_behind(const char *in, const char *what) {
    const char *at = strstr(in, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    return strtoull(at + strlen(what), NULL, 10);
}

/* What is emitted counts as the decimals say: round-half-down(until / step), and the step is the decimal. */
static void expect_count(const duration *step, const duration *until) {
    char text[320];
    char message[160];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nscene s { step %s; until %s }\n",
             step->text, until->text);
    snprintf(message, sizeof message, "step %s, until %s", step->text, until->text);
    const wide over = (wide)until->digits * step->in;
    const wide under = (wide)step->digits * until->in;
    const wide wanted = (2 * over + under - 1) / (2 * under);
    if (wanted == 0 || wanted >> 63 != 0) {
        return; /* refused: not what is tested here */
    }
    diags *errors = diags_new();
    whirl_model *from = model_parse("x.whirl", text, strlen(text), errors);
    instance *inst =
        from != NULL ? instance_make(from->mechanisms[0], from->scenes[0], NULL, errors) : NULL;
    diags_flush(errors, stdout);
    TEST_ASSERT_NOT_NULL_MESSAGE(inst, message);
    if (inst == NULL) { /* for the linter */
        return;
    }
    equations *e = equations_derive(inst, errors);
    image *p = image_make(e, NULL, &plainly, IMAGE_TO_RUN, errors);
    char *c = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&c, &length);
    emit_c(out, p, "x.whirl");
    fclose(out);
    TEST_ASSERT_TRUE_MESSAGE(wanted == number_behind(c, ".steps = UINT64_C("), message);
    const uint64_t numerator = number_behind(c, ".step = {UINT64_C(");
    const uint64_t denominator = number_behind(strstr(c, ".step = {") + 9, "), UINT64_C(");
    TEST_ASSERT_TRUE_MESSAGE((wide)numerator * step->in == (wide)denominator * step->digits,
                             message);
    free(c);
    image_free(p);
    equations_free(e);
    instance_free(inst);
    model_free(from);
    diags_free(errors);
}

static void test_counts_are_exact(void) {
    static const struct {
        const char *name;
        uint64_t per;
    } units[] = {{"ns", 1000000000}, {"us", 1000000}, {"ms", 1000}, {"s", 1}};
    const char *wanted = getenv("WH_COUNTS");
    const int pairs = wanted != NULL ? (int)strtol(wanted, NULL, 10) : 400;
    const uint64_t seed = UINT64_C(0x5eed0010);
    seed_now = seed;
    printf("  %d pairs, seed %" PRIx64 "\n", pairs, seed);
    /* a year at 1 ms, 50 years at 1 ns; just beyond what 32 bits hold */
    static const uint64_t long_s[] = {31536000, 1577880000, 4294968};
    for (unsigned i = 0; i < 3; i++) {
        const duration until = duration_of(long_s[i], 0, "s", 1);
        const duration milli = duration_of(1, 0, "ms", 1000);
        const duration nano = duration_of(1, 0, "ns", 1000000000);
        expect_count(&milli, &until);
        expect_count(&nano, &until);
    }
    for (int i = 0; i < pairs; i++) {
        const unsigned k = (unsigned)random_below(4);
        uint64_t most = 10;
        for (uint64_t more = random_below(6); more > 0; more--) {
            most *= 10;
        }
        const duration step =
            duration_of(1 + random_below(most), (int)random_below(4), units[k].name, units[k].per);
        /* so many steps, from one to 50 years of them, and up to a half beside it */
        const double span_s = (double)step.digits / (double)step.in;
        const double count = exp(log(1.6e9 / span_s) * (double)random_below(1000) / 1000.0);
        const double end_s = floor(count + 1.0) * span_s;
        if (end_s > 1.6e9 && count > 2.0) {
            continue;
        }
        int places = 0; /* up to 14 digits, as many as a double holds for certain */
        double digits = end_s;
        while (places < 12 && digits < 1e12) {
            digits *= 10.0;
            places++;
        }
        const duration until = duration_of((uint64_t)digits, places, "s", 1);
        expect_count(&step, &until);
        if (step.digits < 1000 && count < 1e9) { /* exactly so many */
            const duration whole =
                duration_of((uint64_t)floor(count + 1.0) * step.digits, 0, "s", step.in);
            int behind = 0;
            for (uint64_t in = step.in; in > 1; in /= 10) {
                behind++;
            }
            const duration exactly = duration_of(whole.digits, behind, "s", 1);
            expect_count(&step, &exactly);
        }
    }
}

/* --- fractions and times ----------------------------------------------------------------------------- */

/* What units and sums leave on a double is not taken for the step. */
static void test_steps_are_what_was_written(void) {
    const struct {
        double value;
        uint64_t numerator, denominator;
    } known[] = {{0.0, 0, 1},
                 {1.1 * 1e-3, 11, 10000},
                 {0.1 + 0.2, 3, 10},
                 {1.0 / 3.0, 1, 3},
                 {1.0 / 44100.0, 1, 44100},
                 {1001.0 / 30000.0, 1001, 30000},
                 {0x1p-20, 1, 1U << 20U},
                 {1e-18, 1, UINT64_C(1000000000000000000)},
                 {1e18, UINT64_C(1000000000000000000), 1},
                 {86400.0 * 365.0, 31536000, 1}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        const whole_ratio r = ratio_of(known[i].value);
        TEST_ASSERT_EQUAL_UINT64(known[i].numerator, r.numerator);
        TEST_ASSERT_EQUAL_UINT64(known[i].denominator, r.denominator);
    }
}

/* Any double at all: within 2^-51, and small enough for the core's 64 bits. */
static void test_every_double_has_a_fraction(void) {
    seed_now = UINT64_C(0x5eed0011);
    for (int i = 0; i < 30000; i++) {
        /* every other one beside a simple number, where fractions are far between */
        const double value =
            i % 2 != 0
                ? nextafter(1.0 / (1.0 + (double)random_below(2000)), 0.0)
                : fmin(1e18,
                       fmax(1e-18, ldexp(1.0 + (double)random_below(UINT64_C(1) << 52) * 0x1p-52,
                                         (int)random_below(120) - 60)));
        const whole_ratio r = ratio_of(value);
        char message[80];
        snprintf(message, sizeof message, "%.17g is not %" PRIu64 "/%" PRIu64, value, r.numerator,
                 r.denominator);
        TEST_ASSERT_TRUE_MESSAGE((r.numerator | r.denominator) >> 60 == 0, message);
        TEST_ASSERT_TRUE_MESSAGE(fabs(ratio_times(1, r) - value) <= 0x1.8p-51 * value, message);
    }
}

/* count * numerator / denominator, rounded once. */
static void test_times_are_rounded_once(void) {
    seed_now = UINT64_C(0x5eed0012);
    for (int i = 0; i < 30000; i++) {
        const whole_ratio r = {1 + random_below(1000000), 1 + random_below(UINT64_C(1) << 40)};
        const uint64_t count = random_below(UINT64_MAX) >> random_below(64);
        const double time = ratio_times(count, r);
        const wide exact = (wide)count * r.numerator; /* below 2^84 */
        int places;
        const uint64_t digits = (uint64_t)ldexp(frexp(time, &places), 53);
        places -= 53; /* time = digits * 2^places */
        /* |exact - digits 2^places denominator| <= 2^(places - 1) denominator */
        wide have = (wide)digits * r.denominator;
        wide want = exact;
        wide half = r.denominator;
        if (places > 0) {
            have <<= places;
            half <<= places;
        } else {
            want = exact == 0 ? 0 : exact << -places; /* about denominator * 2^53 */
        }
        const wide off = have > want ? have - want : want - have;
        TEST_ASSERT_TRUE(exact == 0 ? !(time > 0.0) : 2 * off <= half);
    }
}

/* --every and --from, as of values that were computed in double: beside a step's end by a rounding is at it. */
static void test_spacings_and_begins_are_counted_in_steps(void) {
    for (int i = 0; i < 20000; i++) {
        const whole_ratio step =
            ratio_of((double)(1 + random_below(999)) / (double)(1 + random_below(99999)));
        const double step_s = ratio_times(1, step);
        const uint64_t wanted = 1 + random_below(UINT64_C(1) << (1 + random_below(30)));
        const double time_s = (double)wanted * step_s;
        const double part = 0.1 + 0.8 * (double)random_below(1000) / 1000.0;
        uint64_t count = 0;
        TEST_ASSERT_TRUE(ratio_count_each(time_s, step, &count) && count == wanted);
        TEST_ASSERT_TRUE(ratio_count_from(time_s, step, &count) && count == wanted);
        TEST_ASSERT_TRUE(ratio_count_from(time_s + part * step_s, step, &count) &&
                         count == wanted + 1);
        TEST_ASSERT_TRUE(ratio_count_from(time_s - part * step_s, step, &count) && count == wanted);
        const bool whole =
            ratio_count_each((double)(1 + wanted % 1000) * step_s + part * step_s, step, &count);
        TEST_ASSERT_TRUE(!whole);
    }
    uint64_t count = 7;
    TEST_ASSERT_TRUE(!ratio_count_each(0.0, ratio_of(1e-3), &count));
    TEST_ASSERT_TRUE(!ratio_count_each(-1.0, ratio_of(1e-3), &count));
    TEST_ASSERT_TRUE(!ratio_count_each(1e19, ratio_of(1e-3), &count));
    TEST_ASSERT_TRUE(ratio_count_from(0.0, ratio_of(1e-3), &count) && count == 0);
    TEST_ASSERT_TRUE(!ratio_count_from(1e18, ratio_of(1e-18), &count));
}

void suite_counts(void) {
    RUN_TEST(test_counts_are_exact);
    RUN_TEST(test_steps_are_what_was_written);
    RUN_TEST(test_every_double_has_a_fraction);
    RUN_TEST(test_times_are_rounded_once);
    RUN_TEST(test_spacings_and_begins_are_counted_in_steps);
}
