/* counted_by_hand.c: see counted_by_hand.h. */
#include "counted_by_hand.h"

#include <math.h>
#include <string.h>

#include "core/method.h"
#include "host/image/core_rows.h"
#include "host/image/turned.h"
#include "unity.h"

/* --- what depends on what ------------------------------------------------------------------------------*/

enum { MOST = 600 };

/* All that operation `i` takes, and what that takes, itself among it; not through waves of turn angles, where these are not
 * `through`. */
static void find_taken(const tape *t, int i, bool through, bool taken[MOST]) {
    memset(taken, 0, MOST * sizeof *taken);
    taken[i] = true;
    for (int k = i; k >= 0; k--) {
        int from[2];
        const int count = taken[k] ? tape_operands(&t->ops[k], from) : 0;
        for (int n = 0; n < count; n++) {
            const op *o = &t->ops[from[n]];
            taken[from[n]] = taken[from[n]] || through || o->code != OP_PHASE || o->b >= 0;
        }
    }
}

/* Is it the same at all stages? It takes numbers and inputs alone. */
static bool is_fixed(const tape *t, int i) {
    bool taken[MOST];
    find_taken(t, i, true, taken);
    for (int k = 0; k <= i; k++) {
        const op_kind kind = op_rows[t->ops[k].code].kind;
        if (taken[k] && (kind == OP_IS_PHASE || kind == OP_IS_CELL ||
                         (kind == OP_IS_LEAF && t->ops[k].code != OP_INPUT))) {
            return false;
        }
    }
    return true;
}

/* Is it the same wherever places are? No rate is in it, and no function of core/function.h; nor is it a pair of turn angles. */
static bool is_placed(const tape *t, int i) {
    bool taken[MOST];
    find_taken(t, i, false, taken);
    for (int k = 0; k <= i; k++) {
        const op *o = &t->ops[k];
        if (taken[k] && (o->code == OP_RATE || o->code == OP_CALL || o->code == OP_POW ||
                         (o->code == OP_PHASE && o->b < 0))) {
            return false;
        }
    }
    return true;
}

#define LIST_FIELDS(X) \
    X(sums) \
    X(products) \
    X(quotients) \
    X(roots) \
    X(sizes) \
    X(signs) \
    X(choices) \
    X(leaves) \
    X(constants) \
    X(results) \
    X(pairs) \
    X(terms) \
    X(radians) \
    X(powers) \
    X(cells) \
    X(lines) \
    X(cubics) \
    X(mirrored) \
    X(carried) \
    X(operations) X(zero_sums) X(zero_products) X(opposed) X(bits) X(still_pairs) X(zero_pairs)

void expect_list_counts(const cost_list *want, const cost_list *have, const char *what) {
#define LIST_SAME(field) \
    TEST_ASSERT_TRUE_MESSAGE(fabs((double)want->field - (double)have->field) < 1e-9, what);
    LIST_FIELDS(LIST_SAME)
    for (int f = 0; f < FUNCTIONS; f++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(want->calls[f], have->calls[f], what);
    }
}

/* --- what is expected ----------------------------------------------------------------------------------*/

/* Distinct places where a row's stages stand, and which they are. */
static int places_of(const wh_tableau *by, bool first[WH_STAGES_MAX]) {
    int places = 0;
    for (unsigned s = 0; s < by->stages; s++) {
        first[s] = true;
        for (unsigned e = 0; e < s && by->places != NULL; e++) {
            first[s] = first[s] && (by->places->node[e] != by->places->node[s] ||
                                    memcmp(&by->places->reach[e], &by->places->reach[s],
                                           sizeof by->places->reach[s]) != 0);
        }
        places += first[s];
    }
    return places;
}

static int others_than(const wh_real *of, unsigned count, double a, double b, double c) {
    int others = 0;
    for (unsigned j = 0; j < count; j++) {
        const double x = (double)of[j];
        others += x != a && x != b && x != c;
    }
    return others;
}

static void expect_method(const image *im, const cost_counts *c) {
    const wh_tableau *by = wh_tableau_of(im->settings.method);
    const char *word = wh_methods[im->settings.method].word;
    const bool placed = im->form == WH_SECOND_ORDER && by->places != NULL;
    bool first[WH_STAGES_MAX];
    const int places = places_of(by, first);
    int shares = 0;
    int scaled = 0;
    int leans = 0;
    int ends = 0;
    int most = 0;
    int reaches = 0;
    int reach_shares = 0;
    bool all_alike = true;
    for (unsigned s = 0; s < by->stages; s++) {
        const wh_real *share = by->stage[s].share;
        shares += others_than(share, s, 0.0, 0.0, 0.0);
        scaled += others_than(share, s, 0.0, 1.0, -1.0);
        leans += s > 1 && others_than(share + 1, s - 1, 0.0, 0.0, 0.0) > 0;
        ends += others_than(&by->rates[s], 1, 0.0, 0.0, 0.0);
        ends += others_than(&by->positions[s], 1, 0.0, (double)by->rates[s], 0.0);
        all_alike = all_alike && (double)by->positions[s] == (double)by->rates[s];
        most = by->turns[s] > most ? by->turns[s] : most;
        if (placed && first[s]) {
            reaches += others_than(&by->places->node[s], 1, 0.0, 0.0, 0.0);
            reach_shares += others_than(by->places->reach[s].share, s, 0.0, 0.0, 0.0);
        }
    }
    const bool moves = others_than(by->positions, by->stages, 0.0, 0.0, 0.0) > 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(by->stages, c->stages, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(placed ? places : (int)by->stages, c->places, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(reaches, c->reaches, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(reach_shares, c->reach_shares, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(shares, c->shares, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(scaled, c->scaled, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(leans, c->leans, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(ends, c->ends, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(most, c->turns, word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(c->second && c->turned && moves && all_alike, c->ends_twice,
                                  word);
}

/* A list as the code has it when it stands where it is called, a sine of radians as long as 25 operations. */
int length_by_hand(const tape *t) {
    int length = tape_operations(t);
    for (int i = 0; i < t->count; i++) {
        length += t->ops[i].code == OP_PHASE && t->ops[i].b != -1 ? 25 : 0;
    }
    return length;
}

static void expect_books(const image *im, const cost_counts *c, bool called, const char *what) {
    const tape *step = im->list[IMAGE_STEP];
    cost_list want = {.sums = 0};
    bool lists_called = called;
    if (im->ledger.kept) {
        const tape *books = im->list[IMAGE_POWERS];
        lists_called = called || length_by_hand(step) > 50;
        const bool books_called = called || length_by_hand(step) + length_by_hand(books) > 85;
        TEST_ASSERT_EQUAL_INT_MESSAGE(books_called, c->books_called, what);
        if (lists_called || books_called) {
            cost_list_add_all(books, &want);
        } else {
            cost_list_add_unshared(books, step, image_turns(im), &want);
        }
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(lists_called, c->called, what);
    expect_list_counts(&want, &c->books, what);
}

/* Which of the lists an operation is counted in. */
static cost_list *list_of(const image *im, const cost_counts *c, int i, cost_list of[3]) {
    const tape *t = im->list[IMAGE_STEP];
    return c->called                                                       ? &of[0]
           : is_fixed(t, i)                                                ? &of[1]
           : c->places < c->stages && !im->ledger.asked && is_placed(t, i) ? &of[2]
                                                                           : &of[0];
}

static void expect_lists(const image *im, const cost_counts *c, const operands *given,
                         const char *what) {
    const tape *t = im->list[IMAGE_STEP];
    cost_list of[3] = {{.sums = 0}, {.sums = 0}, {.sums = 0}};
    for (int i = 0; i < t->count; i++) {
        cost_list *to = list_of(im, c, i, of);
        cost_list_add(t, &t->ops[i], to);
        if (given != NULL) {
            cost_list_add_operands(&t->ops[i], &given->of[i], to);
        }
        if (given != NULL && t->ops[i].code == OP_PHASE && t->ops[i].b == -1) {
            cost_list_add_pair(t, &t->ops[i], given, &of[0]);
        }
    }
    of[0].results = t->results;
    of[0].carried = tape_carried(t);
    of[0].operations = tape_operations(t);
    expect_list_counts(&of[0], &c->step, what);
    expect_list_counts(&of[1], &c->fixed, what);
    expect_list_counts(&of[2], &c->placed, what);
}

/* Is component k of this kind of leaf, or of a pair's angle, in the list? */
static bool reads(const tape *t, op_code code, int k) {
    bool is = false;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const bool angle = (o->code == OP_PHASE || o->code == OP_CELL) && o->turns != NULL;
        is = is || (code != OP_PHASE && o->code == code && o->a == k) ||
             (code == OP_PHASE && angle && o->turns[k] != 0);
    }
    return is;
}

/* What later stages need of each component: all of a list that is a function of its own. */
static void expect_components(const image *im, const cost_counts *c, const char *what) {
    const tape *t = im->list[IMAGE_STEP];
    const bool second = im->form == WH_SECOND_ORDER;
    const int n = second ? im->coordinates : im->angles + im->reals;
    int moving = 0;
    int angles = 0;
    int linears = 0;
    int rates = 0;
    for (int k = 0; k < n; k++) {
        const bool turns = k < im->angles;
        const bool placed = turns ? reads(t, OP_PHASE, k) : reads(t, OP_LINEAR, k - im->angles);
        moving += c->called || t->ops[t->result[k]].code != OP_CONSTANT;
        angles += turns && (placed || c->called);
        linears += !turns && (placed || c->called);
        /* a place is where the rates lead, unless the row says where it is */
        rates +=
            second && (c->called || reads(t, OP_RATE, k) || (placed && c->reaches == 0)) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(n, c->components, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(im->angles, c->angles, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(n - im->angles, c->linears, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(moving, c->moving, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(angles, c->staged_angles, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(linears, c->staged_linears, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(rates, c->staged_rates, what);
}

/* What is not of the board's: pairs, tables, registers, words of the state. */
static void expect_rest(const image *im, const cost_board *b, cost_number number,
                        const cost_counts *c, const char *what) {
    const tape *t = im->list[IMAGE_STEP];
    const int pairs = c->step.pairs + c->placed.pairs + c->fixed.pairs;
    const int times = c->turned ? 1 : c->called ? c->stages : c->places;
    TEST_ASSERT_EQUAL_INT_MESSAGE(pairs, c->step.pairs, what); /* wherever they are counted */
    TEST_ASSERT_EQUAL_INT_MESSAGE(times * pairs, c->lookups, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(c->called ? 1 : c->stages, c->copies, what);
    /* of each component where it began and its sum, of several stages that of the rates as well, and of second order both */
    const int each[] = {2, 3, 4};
    const int kept = each[c->stages == 1 ? 0
                          : c->second    ? 2
                                         : 1] *
                         c->components +
                     (c->turned && c->stages > 1 ? 3 * pairs : 0);
    const int registers = cost_registers(b, number);
    const int half = registers / 2;
    TEST_ASSERT_TRUE_MESSAGE(c->pressed == (registers > 0 ? fmax(0.0, kept - half) : 0.0), what);
    TEST_ASSERT_TRUE_MESSAGE(c->spilled == (registers > 0 ? fmax(0.0, kept - registers) : 0.0),
                             what);
    const bool folded = t->tables.folds && !b->fpu && number == COST_FLOAT;
    const double cells = t->tables.count > 0 ? ldexp(1.0, t->tables.bits) : 0.0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(folded, c->folded, what);
    TEST_ASSERT_TRUE_MESSAGE(c->table_numbers == (folded ? cells / 2.0 + 1.0 : cells) *
                                                     t->tables.count * t->tables.terms,
                             what);
    const int stops = core_stops(im);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        im->contacts > 0 ? WH_CONTACT_EVALUATIONS(c->stages, stops, im->forced) : c->stages,
        c->evaluations, what);
    cost_list events = {.sums = 0};
    if (im->contacts > 0) {
        cost_list_add_all(im->list[IMAGE_SIGNALS], &events);
        cost_list_add_all(im->list[IMAGE_FORCES], &events);
    }
    expect_list_counts(&events, &c->events, what);
}

void expect_common_counts(const image *im, cost_number number, const cost_counts *c,
                          const char *what) {
    const image_ledger *l = &im->ledger;
    TEST_ASSERT_TRUE_MESSAGE(c->im == im && c->number == number, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(im->reals, c->reals, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(im->form == WH_SECOND_ORDER, c->second, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(image_turns(im), c->turned, what);
    /* an angle and what its sum lost, a real and its, inputs, and the books */
    TEST_ASSERT_EQUAL_INT_MESSAGE(2 * (im->angles + im->reals) + im->inputs +
                                      (l->kept ? 2 * (l->entries + l->accounts) + l->inputs : 0),
                                  c->state_words, what);
    cost_list observe = {.sums = 0};
    cost_list_add_all(im->list[IMAGE_OBSERVE], &observe);
    expect_list_counts(&observe, &c->observe, what);
}

void expect_counts(const image *im, const cost_board *b, cost_number number, const cost_counts *c,
                   const operands *given, const char *what) {
    const bool called = tape_operations(im->list[IMAGE_STEP]) > 150 || im->contacts > 0 || !b->fpu;
    expect_common_counts(im, number, c, what);
    TEST_ASSERT_FALSE_MESSAGE(c->is_matrix, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(given != NULL, c->soft, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(im->settings.compensated, c->compensated, what);
    expect_method(im, c);
    expect_books(im, c, called, what);
    expect_lists(im, c, given, what);
    expect_components(im, c, what);
    expect_rest(im, b, number, c, what);
    /* AVR's compiler, an old one, unrolls less */
    const bool avr = strcmp(b->core, "AVR") == 0;
    const bool unrolls_less =
        im->settings.compensated || tape_operations(im->list[IMAGE_STEP]) > 99;
    TEST_ASSERT_EQUAL_INT_MESSAGE(avr && (unrolls_less || im->ledger.kept || im->contacts > 0),
                                  c->looped, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(avr && unrolls_less && c->stages > 2, c->tabled, what);
}
