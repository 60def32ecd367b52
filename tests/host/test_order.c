/* test_order.c: operation lists are reordered so that few values are alive. Operations and bits must stay the same,
 * operands must come before their uses, and there must be fewer stores and loads; if the minimum is known, that
 * minimum. WHIRL_CASES=N sets the number of random lists. Also splitting of sums. */
#include "test.h"

#include "host/base/alloc.h"
#include "host/engine/engine.h"
#include "host/image/lower.h"

#include "command.h"
#include "derived.h"

/* === suite order ============================================================================== */

enum { ANGLES = 5, LEAVES = 12, STATES = 3, SIZE_MOST = 900, RESULTS_MOST = 12 };

/* Draws an earlier value. The latest forty values are likelier. */
static int some_value(dice *d, const int *value, int values) {
    const int near = values < 40 ? values : 40;
    const bool anywhere = dice_one_of(d, 3) == 0;
    const unsigned back = dice_one_of(d, (unsigned)(anywhere ? values : near));
    return value[values - 1 - (int)back];
}

/* Draws a sine or cosine of angles, of a value, or of both. */
static int some_wave(dice *d, op_list *t, const int *value, int values) {
    double multiple[ANGLES];
    const bool turns = dice_one_of(d, 4) > 0;
    for (int k = 0; k < ANGLES; k++) {
        multiple[k] = turns ? (double)dice_one_of(d, 5) - 2.0 : 0.0;
    }
    const int radians = dice_one_of(d, 3) > 0 ? -1 : some_value(d, value, values);
    const int phase = op_list_phase(t, multiple, dice_one_of(d, 2) * 0.25, radians);
    return op_list_unary(t, dice_one_of(d, 2) > 0 ? OP_SIN : OP_COS, phase);
}

static int some_call(dice *d, op_list *t, int a, int b) {
    const function_id function = (function_id)dice_one_of(d, FUNCTIONS);
    return op_list_call(t, function, a, function_arguments(function) == 2 ? b : -1);
}

static int some_operation(dice *d, op_list *t, const int *value, int values) {
    const int a = some_value(d, value, values);
    const int b = some_value(d, value, values);
    switch (dice_one_of(d, 16)) {
    case 0: return op_list_leaf(t, OP_LINEAR, (int)dice_one_of(d, LEAVES));
    case 1: return op_list_leaf(t, OP_RATE, (int)dice_one_of(d, LEAVES));
    case 2: return op_list_leaf(t, OP_INPUT, (int)dice_one_of(d, LEAVES));
    case 3: return op_list_constant(t, dice_between(d, -2.0, 2.0));
    case 4: return some_wave(d, t, value, values);
    case 5: return op_list_div(t, a, b);
    case 6: return op_list_unary(t, OP_SQRT, op_list_unary(t, OP_ABS, a));
    case 7:
    case 8:
    case 9: return some_call(d, t, a, b);
    case 10: return op_list_sub(t, a, b);
    case 11: return op_list_unary(t, OP_NEG, a);
    case 12:
    case 13: return op_list_mul(t, a, b);
    }
    return op_list_add(t, a, b);
}

static op_list *some_list(dice d) {
    const int size = (int)dice_one_of(&d, SIZE_MOST);
    op_list *t = op_list_new(ANGLES, (int)dice_one_of(&d, RESULTS_MOST + 1));
    int *value = alloc((int64_t)size + 1, sizeof *value);
    int values = 1;
    value[0] = op_list_leaf(t, OP_RATE, 0);
    while (values <= size) {
        value[values] = some_operation(&d, t, value, values);
        values++;
    }
    for (int i = 0; i < t->results; i++) {
        t->result[i] = some_value(&d, value, values);
    }
    free(value);
    if (dice_one_of(&d, 4) > 0) { /* one list in four keeps its unused operations */
        op_list_prune(t);
    }
    return t;
}

static int by_size(const void *x, const void *y) {
    const uint64_t left = *(const uint64_t *)x;
    const uint64_t right = *(const uint64_t *)y;
    return (left > right) - (left < right);
}

/* Returns the sorted hashes of the operations with their operands. *phases: a hash of all OP_PHASE in their order. */
static uint64_t *computed_by(const op_list *t, uint64_t *phases) {
    uint64_t *sum = alloc((int64_t)t->count + 1, sizeof *sum);
    int operand[2];
    *phases = 1;
    for (int i = 0; i < t->count; i++) {
        op alone = t->ops[i];
        const int operands = op_list_operands(&alone, operand);
        if (op_rows[alone.code].values > 0) {
            alone.a = -2;
        }
        alone.b = operands > 0 ? -2 : alone.b;
        sum[i] = op_list_op_hash(t, &alone);
        for (int k = 0; k < operands; k++) {
            TEST_ASSERT_TRUE_MESSAGE(operand[k] < i, "an operation before what it takes");
            sum[i] = (sum[i] + sum[operand[k]]) * UINT64_C(0x9e3779b97f4a7c15);
        }
        *phases = alone.code == OP_PHASE ? *phases * 31 + sum[i] : *phases;
    }
    qsort(sum, (size_t)t->count, sizeof *sum, by_size);
    return sum;
}

static void expect_same_operations(const op_list *entered, const op_list *ordered) {
    uint64_t phases[2];
    TEST_ASSERT_EQUAL_INT(entered->count, ordered->count);
    uint64_t *before = computed_by(entered, &phases[0]);
    uint64_t *after = computed_by(ordered, &phases[1]);
    TEST_ASSERT_EQUAL_MEMORY(before, after, ((size_t)entered->count + 1) * sizeof *before);
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(phases[0], phases[1], "phases in another order");
    free(before);
    free(after);
}

static void expect_same_bits(dice *d, const op_list *entered, const op_list *ordered) {
    evaluator *one = evaluator_new(entered);
    evaluator *other = evaluator_new(ordered);
    for (int state = 0; state < STATES; state++) {
        double leaf[ANGLES + 3 * LEAVES];
        double before[RESULTS_MOST + 1] = {0.0};
        double after[RESULTS_MOST + 1] = {0.0};
        for (int i = 0; i < ANGLES + 3 * LEAVES; i++) {
            leaf[i] = dice_between(d, -1.5, 1.5);
        }
        const double *in = leaf + ANGLES;
        evaluator_run(one, 0.0, leaf, in, in + LEAVES, in + 2 * LEAVES, before);
        evaluator_run(other, 0.0, leaf, in, in + LEAVES, in + 2 * LEAVES, after);
        TEST_ASSERT_EQUAL_MEMORY(before, after, sizeof before);
    }
    evaluator_free(one);
    evaluator_free(other);
}

TEST(order, random_lists_compute_the_same) {
    dice d = dice_of("order", 41);
    const unsigned cases = dice_cases(300);
    long long before = 0;
    long long after = 0;
    int moved = 0;
    for (unsigned i = 0; i < cases; i++) {
        const dice same = {d.state * 2862933555777941757ULL + i};
        op_list *entered = some_list(same);
        op_list *ordered = some_list(same);
        op_list_order(ordered);
        expect_same_operations(entered, ordered);
        expect_same_bits(&d, entered, ordered);
        const int carried = op_list_carried(entered);
        const int carried_now = op_list_carried(ordered);
        TEST_ASSERT_TRUE_MESSAGE(carried_now <= carried, "values are carried more often");
        TEST_ASSERT_TRUE((carried_now < carried) ==
                         (op_list_hash(entered) != op_list_hash(ordered)));
        moved += carried_now < carried;
        before += carried;
        after += carried_now;
        op_list_free(entered);
        op_list_free(ordered);
    }
    char told[96];
    snprintf(told, sizeof told, "%d of %u lists reordered; values carried %lld times, were %lld",
             moved, cases, after, before);
    TEST_MESSAGE(told);
    TEST_ASSERT_TRUE(moved > 0);
}

/* The sum of n squares, with all squares first. The minimum is one load for each leaf. In the entered sequence, the
 * squares that do not fit 20 registers are stored and loaded again. */
TEST(order, squares_are_reordered_for_registers) {
    for (int n = 1; n <= 200; n++) {
        op_list *t = op_list_new(0, 1);
        int *square = alloc(n, sizeof *square);
        for (int i = 0; i < n; i++) {
            const int leaf = op_list_leaf(t, OP_LINEAR, i);
            square[i] = op_list_mul(t, leaf, leaf);
        }
        int sum = square[0];
        for (int i = 1; i < n; i++) {
            sum = op_list_add(t, sum, square[i]);
        }
        t->result[0] = sum;
        TEST_ASSERT_EQUAL_INT(n <= 20 ? n : n + 2 * (n - 20), op_list_carried(t));
        op_list_order(t);
        TEST_ASSERT_EQUAL_INT(n, op_list_carried(t));
        free(square);
        op_list_free(t);
    }
}

/* === suite pieces ============================================================================= */
/* A sum is split into pieces before its operations are made. Half angles are restored if this saves a term. The
 * value must not change. */

enum { VARIABLES = 2 };

static const symbol variables[VARIABLES] = {
    {.kind = SYM_COORDINATE, .name = "u", .text = "", .unit = "", .index = 0},
    {.kind = SYM_COORDINATE, .name = "v", .text = "", .unit = "", .index = 1}};

static double variable_value(void *context, const symbol *sym, int primes) {
    (void)primes;
    return ((const double *)context)[sym->index];
}

static double pieces_value(const piece *pieces, int count, double at[VARIABLES]) {
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        double product = pieces[i].coefficient;
        for (int k = 0; k < pieces[i].mono->count; k++) {
            const mono_factor *f = &pieces[i].mono->factors[k];
            product *= pow(at[f->atom->symbol->index], f->exponent);
        }
        if (pieces[i].angle != NULL) {
            const double angle = poly_evaluate(pieces[i].angle, variable_value, at);
            product *= pow(sin(angle), pieces[i].sines) * pow(cos(angle), pieces[i].cosines);
        }
        sum += product;
    }
    return sum;
}

/* 0.3 sin(w)^(2p) cos(w)^(2q) with w = 2u - v, its product with v, and its slope. Each must give one piece, or two
 * if the slope is a sum of two products. */
TEST(pieces, even_powers_give_one_piece) {
    for (int p = 0; p <= 8; p++) {
        for (int q = 0; p + q <= 8; q++) {
            if (p + q == 0) {
                continue;
            }
            algebra *a = algebra_new();
            const poly *u = poly_symbol(a, &variables[0], 0);
            const poly *v = poly_symbol(a, &variables[1], 0);
            const poly *w = poly_sub(a, poly_scale(a, u, 2.0), v);
            const poly *power = poly_scale(a,
                                           poly_mul(a, poly_pow(a, poly_sin(a, w), 2.0 * p),
                                                    poly_pow(a, poly_cos(a, w), 2.0 * q)),
                                           0.3);
            piece pieces[32];
            TEST_ASSERT_TRUE(power->count <= 32);
            TEST_ASSERT_EQUAL_INT(1, pieces_of(a, poly_mul(a, power, v), pieces));
            const bool doubled = p == q; /* sin(w)^2 cos(w)^2 = sin(2w)^2/4 */
            TEST_ASSERT_EQUAL_INT(2 * p, pieces[0].sines);
            TEST_ASSERT_EQUAL_INT(doubled ? 0 : 2 * q, pieces[0].cosines);
            TEST_ASSERT_TRUE(pieces[0].angle == (doubled ? poly_scale(a, w, 2.0) : w));
            const double size = doubled ? 0.3 * pow(0.25, p) : 0.3;
            TEST_ASSERT_DOUBLE_WITHIN(1e-13 * size, size, pieces[0].coefficient);
            const poly *slope = poly_derivative(a, power, &variables[1], 0);
            const int count = pieces_of(a, slope, pieces);
            TEST_ASSERT_EQUAL_INT(p > 0 && q > 0 && !doubled ? 2 : 1, count);
            for (int i = 0; i < count && slope->count > 1; i++) {
                TEST_ASSERT_TRUE(pieces[i].sines >= 2 * p - 1);
                TEST_ASSERT_TRUE(doubled || pieces[i].cosines >= 2 * q - 1);
            }
            algebra_free(a);
        }
    }
}

TEST(pieces, unsuitable_rows_do_not_change) {
    algebra *a = algebra_new();
    const poly *u = poly_symbol(a, &variables[0], 0);
    const poly *one = poly_number(a, 1.0);
    const poly *two = poly_cos(a, poly_scale(a, u, 2.0));
    const poly *four = poly_cos(a, poly_scale(a, u, 4.0));
    const poly *row =
        poly_add(a, poly_sub(a, poly_scale(a, one, 3.0), poly_scale(a, two, 4.0)), four);
    piece pieces[8];
    TEST_ASSERT_EQUAL_INT(1, pieces_of(a, row, pieces));
    /* 1e-12 remains where the other terms cancel, so the sum is not made a product */
    const poly *more = poly_add(a, row, poly_number(a, 1e-12));
    TEST_ASSERT_EQUAL_INT(3, pieces_of(a, more, pieces));
    /* 3 - 4 cos a + cos 2a = 8 sin(a/2)^4, but a turn angle has no half */
    const poly *half =
        poly_add(a, poly_sub(a, poly_scale(a, one, 3.0), poly_scale(a, poly_cos(a, u), 4.0)), two);
    TEST_ASSERT_EQUAL_INT(3, pieces_of(a, half, pieces));
    /* in this sum, nothing cancels at 0 or pi/2 */
    const poly *flat =
        poly_add(a, poly_add(a, one, poly_scale(a, two, 2.0)), poly_scale(a, four, 0.5));
    TEST_ASSERT_EQUAL_INT(3, pieces_of(a, flat, pieces));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(pieces[i].sines + pieces[i].cosines <= 1);
    }
    /* these sums stay: products would cancel at other angles, or there would be more of them */
    const poly *tall = poly_sub(a, poly_cos(a, poly_scale(a, u, 16.0)), one);
    const poly *few = poly_add(a, tall, poly_scale(a, poly_sub(a, two, one), 1e-3));
    TEST_ASSERT_EQUAL_INT(3, pieces_of(a, few, pieces));
    const poly *many = tall;
    for (int k = 1; k < 8; k++) {
        const poly *cosine = poly_cos(a, poly_scale(a, u, 2.0 * k));
        many = poly_add(a, many, poly_scale(a, poly_sub(a, cosine, one), 1e-3));
    }
    piece room[16];
    TEST_ASSERT_EQUAL_INT(9, pieces_of(a, many, room));
    algebra_free(a);
}

TEST(pieces, pieces_have_the_sums_value) {
    uint64_t seed = 7;
    int powers = 0;
    for (int round = 0; round < 2000; round++) {
        algebra *a = algebra_new();
        const poly *sum = poly_number(a, 0.0);
        for (int i = 0; i < 3; i++) { /* small integer factors, so that powers occur */
            const poly *u = poly_symbol(a, &variables[0], 0);
            const poly *v = poly_symbol(a, &variables[1], 0);
            const poly *angle = poly_add(a, poly_scale(a, u, (double)(random_bits(&seed) % 3)),
                                         poly_scale(a, v, (double)(random_bits(&seed) % 2)));
            const poly *cosine =
                random_bits(&seed) % 2 == 0 ? poly_sin(a, angle) : poly_cos(a, angle);
            const poly *front = random_bits(&seed) % 2 == 0 ? u : poly_number(a, 2.0);
            const double exponent = 2.0 * (double)(1 + random_bits(&seed) % 3);
            sum = poly_add(a, sum, poly_mul(a, front, poly_pow(a, cosine, exponent)));
        }
        if (random_bits(&seed) % 2 == 0) {
            sum = poly_derivative(a, sum, &variables[0], 0);
        }
        double at[VARIABLES] = {random_between(&seed, -3.0, 3.0), random_between(&seed, -3.0, 3.0)};
        piece pieces[64];
        TEST_ASSERT_TRUE(sum->count < 64);
        const int count = pieces_of(a, sum, pieces);
        TEST_ASSERT_TRUE(count <= sum->count);
        for (int i = 0; i < count; i++) {
            powers += pieces[i].sines + pieces[i].cosines > 2;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, poly_evaluate(sum, variable_value, at),
                                  pieces_value(pieces, count, at));
        algebra_free(a);
    }
    printf("  %d powers above the second\n", powers);
    TEST_ASSERT_GREATER_THAN_INT(500, powers);
}

/* A sum of up to three even powers of sines and cosines, each times a power of v. */
TEST(pieces, several_even_powers_are_found) {
    for (unsigned which = 0; which < 64; which++) { /* each power: none, two or four */
        algebra *a = algebra_new();
        const poly *u = poly_symbol(a, &variables[0], 0);
        const poly *v = poly_symbol(a, &variables[1], 0);
        const poly *sum = poly_number(a, 0.0);
        int parts = 0;
        for (unsigned k = 0; k < 3; k++) {
            const unsigned power = which >> (2 * k) & 3U;
            const poly *beside = poly_pow(a, v, (double)k + 1.0);
            const poly *cosine = power == 1 ? poly_cos(a, u) : poly_sin(a, u);
            const double exponent = power == 3 ? 4.0 : 2.0;
            if (power > 0) {
                sum = poly_add(a, sum, poly_mul(a, beside, poly_pow(a, cosine, exponent)));
                parts++;
            }
        }
        piece pieces[16];
        TEST_ASSERT_EQUAL_INT(parts, pieces_of(a, sum, pieces));
        for (int i = 0; i < parts; i++) {
            TEST_ASSERT_TRUE(pieces[i].angle == u && pieces[i].sines + pieces[i].cosines >= 2);
            TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1.0, pieces[i].coefficient);
        }
        algebra_free(a);
    }
}

/* Sines of angles that contain sines, defined in any sequence. */
enum { MECHANISMS = 300, PIECES_STATES = 3 };

/* Writes a sum, difference or multiple of a few angles, with or without a sine inside. */
static void angle(FILE *to, int depth, uint64_t *seed) {
    static const char *const simple[] = {"q", "x", "(q + n)", "(q - x)", "(2*q)", "(x + n)"};
    static const char *const before[] = {"(", "(", "sin(", "exp(sin("};
    static const char *const after[] = {")", ")", ")", "))"};
    const unsigned which = depth > 0 ? random_one_of(seed, 6) : 4;
    if (which >= 4) {
        fputs(simple[random_one_of(seed, sizeof simple / sizeof simple[0])], to);
        return;
    }
    fputs(before[which], to);
    angle(to, depth - 1, seed);
    if (which < 2) {
        fputs(which == 0 ? " + " : " - ", to);
        angle(to, depth - 1, seed);
    }
    fputs(after[which], to);
}

/* The list's accelerations must solve the equations. Returns the number of states without singularity. */
static int check(const derived *d, uint64_t *seed) {
    const equations *e = d->equations;
    int checked = 0;
    for (int k = 0; k < PIECES_STATES; k++) {
        state_values s;
        double result[UNKNOWNS];
        random_state(&s, d, seed);
        TEST_ASSERT_TRUE(d->image->list[IMAGE_BOOKS]->results <= UNKNOWNS);
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, result);
        for (int i = 0; i < e->count; i++) {
            double size;
            const double rest = derived_rest(d, &s, result, i, &size);
            TEST_ASSERT_TRUE(fabs(rest) <= 1e-9 * size);
        }
        checked++;
    }
    return checked;
}

TEST(pieces, sines_inside_sines) {
    uint64_t seed = 7;
    int checked = 0;
    for (int i = 0; i < MECHANISMS; i++) {
        char *text = NULL;
        size_t size = 0;
        FILE *to = open_memstream(&text, &size);
        TEST_ASSERT_NOT_NULL(to);
        fputs("mechanism m\ncoordinate q\ncoordinate x\nparameter n = 2.5\n"
              "T = 1 [kg*m^2]*(2*q'^2 + cos(",
              to);
        angle(to, 1 + i % 3, &seed);
        fputs(")*q'*x' + (3 + cos(", to);
        angle(to, 1 + i % 3, &seed);
        fputs("))*x'^2)\nV = 1 [J]*cos(", to);
        angle(to, 1 + i % 3, &seed);
        fputs(")\n", to);
        fclose(to);
        derived d = derived_surely(derived_text(text), text);
        checked += check(&d, &seed);
        derived_free(&d);
        free(text);
    }
    printf("  seed 7: %d states of %d mechanisms\n", checked, MECHANISMS);
    TEST_ASSERT_EQUAL_INT(MECHANISMS * PIECES_STATES, checked);
}
