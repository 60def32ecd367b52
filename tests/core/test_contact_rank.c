/* test_contact_rank.c: rank of the holds (core/contact/contact_rank.h): rows made orthogonal in the metric of M^-1, and
 * rows that lose rank. */
#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 4000 : 200 };

#define SLACK (WH_DOUBLE ? WH_R(1e-12) : WH_R(1e-4))

/* Draws up to three holds with rows of whole numbers. Between them are stops, which must be ignored. Returns the number
 * of holds. */
static unsigned draw(uint64_t *seed, wh_contact_work *w) {
    hand_build(2, draw_whole(seed, 2, 4), draw_whole(seed, -1, 1), draw_whole(seed, 2, 4));
    const unsigned count = 1U + (unsigned)draw_bits(seed) % HAND_CONTACTS;
    for (unsigned k = 0; k < count; k++) {
        const bool hold = draw_bits(seed) % 4U != 0;
        (void)hand_add(hold ? WH_HOLD : WH_STOP, -1, draw_whole(seed, -2, 2),
                       draw_whole(seed, -2, 2), WH_R(0.0), WH_R(0.0), WH_R(0.0));
        w->mode[k] = draw_bits(seed) % 8U != 0 ? WH_ACTIVE : WH_FREE;
    }
    hand_start(false);
    return count;
}

static void rows_of(wh_contact_work *w, wh_contact_rows *rows) {
    wh_contact_point at;
    wh_contact_rows_of(&hand_now.system, w, &at, NULL, rows);
}

static bool says(const wh_contact_work *w, unsigned k) {
    return hand_now.contact[k].kind == WH_HOLD && w->mode[k] == WH_ACTIVE;
}

/* Returns a M^-1 b. */
static wh_real across(const wh_real *a, const wh_real *b) {
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < 2; i++) {
        for (unsigned j = 0; j < 2; j++) {
            sum += a[i] * hand_now.inverse[i][j] * b[j];
        }
    }
    return sum;
}

/* True if row k is a linear combination of earlier independent rows. Computed in whole numbers. */
static bool repeats(const wh_contact_work *w, unsigned k) {
    const wh_real *row = hand_now.law[k].row;
    const wh_real *one = NULL;
    if (row[0] == WH_R(0.0) && row[1] == WH_R(0.0)) {
        return true;
    }
    for (unsigned j = 0; j < k; j++) {
        const wh_real *other = hand_now.law[j].row;
        if (!says(w, j) || (other[0] == WH_R(0.0) && other[1] == WH_R(0.0))) {
            continue;
        }
        if (row[0] * other[1] == row[1] * other[0] ||
            (one != NULL && one[0] * other[1] != one[1] * other[0])) {
            return true;
        }
        one = other;
    }
    return false;
}

/* The remainder of a row is orthogonal to the other remainders. Its length is the row's distance from the span of the
 * others. */
TEST(contact_rank, remainders_of_rows_are_orthogonal) {
    uint64_t seed = 31;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w = {.capped = false};
        wh_contact_rows rows;
        const unsigned count = draw(&seed, &w);
        unsigned holds = 0;
        rows_of(&w, &rows);
        for (unsigned k = 0; k < count; k++) {
            holds += says(&w, k);
            if (!says(&w, k) || repeats(&w, k)) {
                TEST_ASSERT_TRUE(rows.size[k] == WH_R(0.0));
                continue;
            }
            TEST_ASSERT_TRUE(WH_ABS(rows.size[k] - across(rows.row[k], hand_now.law[k].row)) <=
                             SLACK);
            TEST_ASSERT_TRUE(rows.size[k] > SLACK);
            for (unsigned i = 0; i < 2; i++) {
                wh_real way = WH_R(0.0);
                for (unsigned j = 0; j < 2; j++) {
                    way += hand_now.inverse[i][j] * rows.row[k][j];
                }
                TEST_ASSERT_TRUE(WH_ABS(rows.way[k][i] - way) <= SLACK);
            }
            for (unsigned j = 0; j < k; j++) {
                const bool other = says(&w, j) && !repeats(&w, j);
                TEST_ASSERT_TRUE(!other || WH_ABS(across(rows.row[k], rows.row[j])) <= SLACK);
            }
        }
        TEST_ASSERT_EQUAL_UINT(holds, rows.holds);
    }
}

/* The rows of the holds change from one state to the next. Without a change, or with a small one, no hold loses rank.
 * The first hold whose row becomes dependent or reverses is reported. A redundant hold is never reported. */
TEST(contact_rank, first_dependent_hold_is_reported) {
    uint64_t seed = 37;
    unsigned lost = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w = {.capped = false};
        wh_contact_rows before;
        wh_contact_rows after;
        const unsigned count = draw(&seed, &w);
        unsigned wanted = count;
        rows_of(&w, &before);
        TEST_ASSERT_EQUAL_UINT(count, wh_contact_fallen(&hand_now.system, &before, &before));
        const unsigned changed = draw_one_of(&seed, count);
        const bool back = draw_bits(&seed) % 2U != 0;
        for (unsigned i = 0; i < 2; i++) {
            wh_real *entry = &hand_now.law[changed].row[i];
            *entry = back ? -*entry : WH_R(0.0);
        }
        rows_of(&w, &after);
        if (says(&w, changed) && before.size[changed] > WH_R(0.0)) {
            wanted = changed;
            lost++;
        }
        TEST_ASSERT_EQUAL_UINT(wanted, wh_contact_fallen(&hand_now.system, &before, &after));
    }
    TEST_ASSERT_TRUE(lost > ROUNDS / 4);
}

/* A single hold loses rank only if its row almost reverses. The second of two holds loses rank if its row has turned by
 * a right angle or more. */
TEST(contact_rank, how_far_a_row_may_turn) {
    static const struct {
        unsigned count;
        wh_real row[2][2];
        wh_real turned[2];
        unsigned lost; /* index of the hold that lost rank; `count`: none */
    } rows[] = {
        {1, {{1, 0}}, {WH_R(0.1), 1}, 1},           {1, {{1, 0}}, {-1, 1}, 1},
        {1, {{1, 0}}, {-1, WH_R(0.3)}, 0},          {1, {{1, 0}}, {-1, WH_R(0.4)}, 1},
        {2, {{1, 0}, {0, 1}}, {1, WH_R(0.1)}, 2},   {2, {{1, 0}, {0, 1}}, {1, 0}, 1},
        {2, {{1, 0}, {0, 1}}, {5, WH_R(-0.01)}, 1},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        wh_contact_work w = {.capped = false};
        wh_contact_rows before;
        wh_contact_rows after;
        hand_build(2, WH_R(1.0), WH_R(0.0), WH_R(1.0));
        for (unsigned k = 0; k < rows[i].count; k++) {
            (void)hand_add(WH_HOLD, -1, rows[i].row[k][0], rows[i].row[k][1], WH_R(0.0), WH_R(0.0),
                           WH_R(0.0));
            w.mode[k] = WH_ACTIVE;
        }
        hand_start(false);
        rows_of(&w, &before);
        hand_now.law[rows[i].count - 1].row[0] = rows[i].turned[0];
        hand_now.law[rows[i].count - 1].row[1] = rows[i].turned[1];
        rows_of(&w, &after);
        TEST_ASSERT_EQUAL_UINT(rows[i].lost, wh_contact_fallen(&hand_now.system, &before, &after));
    }
}
