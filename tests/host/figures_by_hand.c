/* figures_by_hand.c: see figures_by_hand.h. */
#include "figures_by_hand.h"

#include <math.h>

#include "unity.h"

static bool near(double a, double b) { return fabs(a - b) <= 1e-12 * (fabs(a) + fabs(b)); }

static void expect_figure(const cost_figure *want, const cost_figure *have, const char *what) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(want->basis, have->basis, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(want->of, have->of, what);
    TEST_ASSERT_TRUE_MESSAGE(near(want->value, have->value), what);
    TEST_ASSERT_TRUE_MESSAGE(near(want->least, have->least), what);
    TEST_ASSERT_TRUE_MESSAGE(near(want->most, have->most), what);
    TEST_ASSERT_TRUE_MESSAGE(near(want->bound, have->bound), what);
}

void expect_cost(const cost *want, const cost *have, const char *what) {
    TEST_ASSERT_TRUE(have->predictable);
    expect_figure(&want->instructions, &have->instructions, what);
    expect_figure(&want->instructions_worst, &have->instructions_worst, what);
    expect_figure(&want->cycles, &have->cycles, what);
    expect_figure(&want->cycles_worst, &have->cycles_worst, what);
    expect_figure(&want->flash_bytes, &have->flash_bytes, what);
    expect_figure(&want->ram_bytes, &have->ram_bytes, what);
    expect_figure(&want->stack_bytes, &have->stack_bytes, what);
}

cost_figure longest_of(cost_figure f, double spread) {
    f.value *= spread;
    f.most *= spread;
    return f;
}

cost_figure range_of(const cost_board *b, cost_figure f) {
    return f.basis == COST_NOT_KNOWN ? f : (cost_figure){COST_RANGE,
                                                         COST_PREDICTED,
                                                         0.0,
                                                         f.least * b->cycles_least,
                                                         f.most * b->cycles_most,
                                                         1.0};
}
