/* test_tape_used.c: properties of finished lists and images (host/image/op_list_use.c, image.c). The results for
 * random lists are compared with counts, searches of paths and comparisons by the test itself. */
#include "drawn_scene.h"
#include "evaluated.h"
#include "host/base/alloc.h"
#include "test.h"

static dice die;
static drawn_scene drawn;

static op_list_cost counted(const op_list *t) {
    op_list_cost c = {0};
    for (int i = 0; i < t->count; i++) {
        const op_code code = t->ops[i].code;
        c.arithmetic += code == OP_ADD || code == OP_SUB || code == OP_MUL || code == OP_NEG ||
                        code == OP_ABS || code == OP_SIGN || code == OP_MIN || code == OP_MAX;
        /* a linear table costs a product and a sum, a cubic one three of each */
        c.arithmetic += code == OP_LINE ? 2 : code == OP_CUBIC ? 6 : 0;
        c.look_ups += code == OP_LINE || code == OP_CUBIC;
        c.divisions += code == OP_DIV;
        c.roots += code == OP_SQRT;
        c.waves += code == OP_PHASE;
        c.calls += code == OP_CALL || code == OP_POW;
    }
    return c;
}

static bool is_operation(op_code code) {
    return code >= OP_SIN && code != OP_CELL; /* these rows come after leaves and phases */
}

static void check_counts(const op_list *t) {
    const op_list_cost wanted = counted(t);
    const op_list_cost got = op_list_count(t);
    int operations = 0;
    int waves = 0;
    bool reads = false;
    bool takes = true;
    TEST_ASSERT_EQUAL_MEMORY(&wanted, &got, sizeof got);
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        operations += is_operation(o->code);
        waves += o->code == OP_PHASE && o->turns != NULL;
        reads = reads || o->code == OP_RADIANS || o->parts != NULL;
        takes =
            takes && (o->code != OP_PHASE || (o->parts == NULL && (o->turns == NULL || o->b < 0)));
    }
    TEST_ASSERT_EQUAL_INT(operations, op_list_operations(t));
    TEST_ASSERT_EQUAL_INT(waves, op_list_waves(t));
    TEST_ASSERT_EQUAL(reads, op_list_reads_turns(t));
    TEST_ASSERT_EQUAL(takes, op_list_takes_waves(t));
    TEST_ASSERT_EQUAL_INT(got.arithmetic + 14 * got.divisions + 14 * got.roots + 36 * got.waves +
                              100 * got.calls,
                          op_list_weight(t));
}

static void each_list(unsigned cases, void (*check)(scene_list *l)) {
    for (unsigned c = 0; c < dice_cases(cases); c++) {
        drawn_scene_draw(&drawn, &die);
        for (int role = 0; role < IMAGE_ROLES; role++) {
            if (drawn.im.list[role] != NULL) {
                check(&drawn.list[role]);
            }
        }
    }
}

static void check_list_counts(scene_list *l) { check_counts(&l->list); }
TEST(tape_used, operations_are_counted) { each_list(200, check_list_counts); }

static bool leads_from(const op_list *t, int i, int by) {
    int operand[2];
    bool leads = i == by;
    for (int k = op_list_operands(&t->ops[i], operand); k > 0 && !leads; k--) {
        leads = leads_from(t, operand[k - 1], by);
    }
    return leads;
}

static void check_finite(scene_list *l) {
    op_list *t = &l->list;
    if (t->count > 40) {
        return; /* too many paths to count */
    }
    TEST_ASSERT_EQUAL_INT(-1, op_list_not_finite(t));
    const int by = (int)dice_one_of(&die, (unsigned)t->count);
    op *o = &l->ops[by];
    const double none = dice_one_of(&die, 2) == 0 ? (double)INFINITY : (double)NAN;
    const int part = t->angles > 0 ? (int)dice_one_of(&die, (unsigned)t->angles) : 0;
    const bool in_parts = o->parts != NULL && dice_one_of(&die, 2) == 0;
    double *number = in_parts ? &l->parts[by][part] : &o->value;
    const double kept = *number;
    *number = none;
    int wanted = -1;
    for (int i = t->results - 1; i >= 0; i--) {
        wanted = leads_from(t, t->result[i], by) ? i : wanted;
    }
    TEST_ASSERT_EQUAL_INT(wanted, op_list_not_finite(t));
    *number = kept;
}

TEST(tape_used, non_finite_results_are_found) { each_list(200, check_finite); }

static const double fits[] = {0.0, -0.0, 0x1p-126, -0x1p-126, 1.0, 0x1.fffffep127, -3e38};
static const double fits_not[] = {0x1.fffffep-127,   -1e-40,           0x1.ffffffp127, 1e39,
                                  -(double)INFINITY, (double)INFINITY, 5e-324};

static void check_fit(scene_list *l) {
    op_list *t = &l->list;
    double wanted = 0.0;
    for (int i = t->count - 1; i >= 0; i--) {
        const bool fitting = dice_one_of(&die, 4) > 0;
        if (l->ops[i].code == OP_CONSTANT) {
            l->ops[i].value = fitting ? fits[dice_one_of(&die, 7)] : fits_not[dice_one_of(&die, 7)];
            wanted = fitting ? wanted : l->ops[i].value;
        }
    }
    TEST_ASSERT_TRUE(op_list_out_of_float(t) == wanted);
}

TEST(tape_used, numbers_out_of_floats_range) {
    for (int i = 0; i < 7; i++) {
        TEST_ASSERT_TRUE(fits_float(fits[i]));
        TEST_ASSERT_FALSE(fits_float(fits_not[i]));
    }
    TEST_ASSERT_FALSE(fits_float((double)NAN));
    each_list(100, check_fit);
}

/* image_out_of_float() must consider the lists that move the scene, and the inputs, but no list that only serves
 * outputs. */
TEST(tape_used, images_out_of_floats_range) {
    for (unsigned c = 0; c < dice_cases(300); c++) {
        drawn_scene_draw(&drawn, &die);
        image *im = &drawn.im;
        TEST_ASSERT_TRUE(image_out_of_float(im) == 0.0);
        const image_role role = (image_role)dice_one_of(&die, IMAGE_ROLES);
        const bool matrix = im->settings.matrix != MATRIX_NONE;
        const bool moves = role == (matrix ? IMAGE_MATRIX : IMAGE_STEP) || role == IMAGE_SIGNALS ||
                           role == IMAGE_FORCES || role == IMAGE_SETS;
        if (im->list[role] != NULL) { /* operation 0 of each drawn list is a constant */
            drawn.list[role].ops[0].value = 1e-50;
            TEST_ASSERT_TRUE(image_out_of_float(im) == (moves ? 1e-50 : 0.0));
            drawn.list[role].ops[0].value = 1.0;
        }
        if (im->inputs > 0) {
            drawn.input[dice_one_of(&die, (unsigned)im->inputs)].value = -1e40;
            TEST_ASSERT_TRUE(image_out_of_float(im) == -1e40);
        }
    }
}

TEST(tape_used, images_are_read) {
    for (unsigned c = 0; c < dice_cases(100); c++) {
        drawn_scene_draw(&drawn, &die);
        const image *im = &drawn.im;
        double input[SCENE_FEW + 1] = {7.0, 7.0, 7.0, 7.0};
        bool calls = false;
        for (int unknown = 0; unknown < im->count; unknown++) {
            for (int primes = 0; primes < 4; primes++) {
                int wanted = -1;
                for (int i = 0; i < im->angles + im->reals; i++) {
                    const component of = i < im->angles ? im->angle[i] : im->real[i - im->angles];
                    wanted = of.unknown == unknown && of.primes == primes ? i : wanted;
                }
                TEST_ASSERT_EQUAL_INT(wanted, image_find_component(im, unknown, primes));
            }
        }
        image_inputs(im, input);
        for (int i = 0; i <= SCENE_FEW; i++) {
            TEST_ASSERT_TRUE(input[i] == (i < im->inputs ? im->input[i].value : 7.0));
        }
        for (int role = 0; role < IMAGE_ROLES; role++) {
            calls = calls || (im->list[role] != NULL && counted(im->list[role]).calls > 0);
        }
        TEST_ASSERT_EQUAL(calls, image_calls(im));
        for (int i = 0; i < im->inputs; i++) { /* the input's 5 mm are 0.005 m */
            const image_unit *u = &im->input[i].unit;
            const double si = im->input[i].value;
            TEST_ASSERT_EQUAL(strcmp(u->shown, u->si) == 0, image_shows_si(u));
            TEST_ASSERT_DOUBLE_WITHIN(1e-12 * fabs(si), si,
                                      image_shown(u, si) * u->scale / u->divisor);
        }
    }
    /* the energy balance is computed on the host, so a board does not need its functions */
    op_list *books = op_list_new(0, 1);
    books->result[0] = op_list_call(books, FN_EXP, op_list_leaf(books, OP_LINEAR, 0), -1);
    image im = {.list = {[IMAGE_BOOKS] = books}};
    TEST_ASSERT_FALSE(image_calls(&im));
    im.list[IMAGE_LEVELS] = books;
    TEST_ASSERT_TRUE(image_calls(&im));
    op_list_free(books);
}

static uint64_t hash_changed(const op_list *t, double *number) {
    const double kept = *number;
    *number = kept + 1.0;
    const uint64_t hash = op_list_hash(t);
    *number = kept;
    return hash;
}

static void check_hash(scene_list *l) {
    op_list *t = &l->list;
    const uint64_t hash = op_list_hash(t);
    const int i = (int)dice_one_of(&die, (unsigned)t->count);
    op *o = &l->ops[i];
    TEST_ASSERT_TRUE(hash != hash_changed(t, &o->value));
    for (int k = 0; k < t->angles; k++) {
        if (o->parts != NULL) {
            TEST_ASSERT_TRUE(hash != hash_changed(t, &l->parts[i][k]));
        }
        if (o->turns != NULL) {
            l->turns[i][k]++;
            TEST_ASSERT_TRUE(hash != op_list_hash(t));
            l->turns[i][k]--;
        }
    }
    int *const whole[] = {&o->a, &o->b, t->results > 0 ? &l->result[t->results - 1] : &o->a};
    for (int k = 0; k < 3; k++) {
        ++*whole[k];
        TEST_ASSERT_TRUE(hash != op_list_hash(t));
        --*whole[k];
    }
    const int numbers = t->tables.count * t->tables.terms << t->tables.bits;
    if (t->tables.count > 0) {
        TEST_ASSERT_TRUE(hash !=
                         hash_changed(t, &t->tables.number[dice_one_of(&die, (unsigned)numbers)]));
        TEST_ASSERT_TRUE(hash != hash_changed(t, &t->tables.number[numbers - 1]));
    }
    TEST_ASSERT_TRUE(hash == op_list_hash(t));
}

TEST(tape_used, a_hash_is_of_everything) { each_list(60, check_hash); }

enum { PAIRS_MOST = 6, WAYS = 8 };

/* Enters two sums of two leaves each, of which one has a doubled part. Returns whether one sum can be computed from
 * the other with one product less. */
static bool enter_pair(op_list *t, int k, unsigned way) {
    const int a = op_list_leaf(t, OP_LINEAR, 2 * k);
    const int b = op_list_leaf(t, OP_RATE, 2 * k + 1);
    const int other = op_list_leaf(t, OP_INPUT, k);
    const bool late = dice_one_of(&die, 2) == 0;
    const int times = op_list_mul(t, op_list_constant(t, way == 6 ? 3.0 : 2.0), b);
    int whole = -1;
    if (late) { /* the sum with the doubled part comes first */
        whole = way == 1   ? op_list_sub(t, a, times)
                : way == 2 ? op_list_sub(t, times, a)
                           : op_list_add(t, times, a);
    }
    const int half = way == 1   ? op_list_sub(t, a, b)
                     : way == 2 ? op_list_sub(t, b, a)
                     : way == 4 ? op_list_add(t, a, other)
                     : way == 5 ? op_list_sub(t, a, b)
                                : op_list_add(t, a, b);
    if (!late) {
        whole = way == 1   ? op_list_sub(t, a, times)
                : way == 2 ? op_list_sub(t, times, a)
                           : op_list_add(t, times, a);
    }
    t->result[3 * k] = half;
    t->result[3 * k + 1] = whole;
    t->result[3 * k + 2] = way == 3 ? times : other; /* way 3: the doubled part itself */
    return way < 3 || way == 7;
}

static int products(const op_list *t) {
    int count = 0;
    for (int i = 0; i < t->count; i++) {
        count += t->ops[i].code == OP_MUL;
    }
    return count;
}

TEST(tape_used, sums_share_their_halves) {
    static double before[EVALUATED_MOST];
    static double after[EVALUATED_MOST];
    for (unsigned c = 0; c < dice_cases(300); c++) {
        const int pairs = 1 + (int)dice_one_of(&die, PAIRS_MOST);
        op_list *t = op_list_new(0, 3 * pairs);
        double wanted[3 * PAIRS_MOST];
        int shared = 0;
        for (int k = 0; k < pairs; k++) {
            shared += enter_pair(t, k, dice_one_of(&die, WAYS));
        }
        op_list_prune(t);
        evaluated(t, before);
        for (int i = 0; i < t->results; i++) {
            wanted[i] = before[t->result[i]];
        }
        const int had = products(t);
        const int operations = op_list_operations(t);
        op_list_share_sums(t);
        evaluated(t, after);
        TEST_ASSERT_EQUAL_INT(had - shared, products(t));
        TEST_ASSERT_EQUAL_INT(operations - shared, op_list_operations(t));
        for (int i = 0; i < t->results; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-14, wanted[i], after[t->result[i]]);
        }
        op_list_free(t);
    }
}

SUITE(tape_used) { die = dice_of("tape_used", 4180); }
