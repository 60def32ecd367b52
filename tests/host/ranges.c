#include "ranges.h"
#include "test.h"

static void look(const motion *m, range *r, unsigned count, bool first) {
    for (unsigned i = 0; i < count; i++) {
        const double value = motion_value(m, r[i].name);
        TEST_ASSERT_TRUE_MESSAGE(isfinite(value), r[i].name);
        r[i].least = first ? value : fmin(r[i].least, value);
        r[i].most = first ? value : fmax(r[i].most, value);
    }
}

void ranges_of(const char *which, stepping how, double until_s, double every_s, range *r,
               unsigned count) {
    motion m;
    motion_open(&m, which, how);
    look(&m, r, count, true);
    const unsigned looks = (unsigned)floor(until_s / every_s + 0.5);
    TEST_ASSERT_TRUE(looks > 0);
    for (unsigned i = 1; i <= looks; i++) {
        motion_to(&m, every_s * i);
        look(&m, r, count, false);
    }
    motion_close(&m);
}

double range_width(const range *r) { return r->most - r->least; }

void expect_between(const char *what, double least, double most, double got) {
    printf("  %-62s %.6g (%.6g ... %.6g)\n", what, got, least, most);
    TEST_ASSERT_TRUE_MESSAGE(got >= least && got <= most, what);
}
