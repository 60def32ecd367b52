/* test_contact_books.c: the entries of a contact's correction (contact_ledger.h) for two random coupled bodies. The energy and
 * momentum changes, computed here from masses and springs, are in that contact's entries only. */
#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

static wh_contact_work w;
static wh_contact_state s;
static wh_ledger_work books;

static void level_of(wh_real *level) {
    const wh_real *rate = s.real + 2;
    level[0] = WH_R(0.0);
    for (unsigned i = 0; i < 2; i++) {
        level[1 + i] = hand_now.mass[i][0] * rate[0] + hand_now.mass[i][1] * rate[1];
        level[0] += WH_R(0.5) * level[1 + i] * rate[i] +
                    WH_R(0.5) * hand_now.spring[i] * s.real[i] * s.real[i] -
                    hand_now.load[i] * s.real[i];
    }
}

static void move_all(uint64_t *seed) {
    for (unsigned i = 0; i < 4; i++) {
        s.real[i] = draw_broken(seed, -20, 20);
    }
}

static void expect_entries(unsigned k, const wh_real *change, wh_real size) {
    for (unsigned i = 0; i < hand_books.entries; i++) {
        const unsigned first = wh_ledger_of_contact(&hand_books, k);
        const bool own = i >= first && i < first + 3U;
        const wh_real wanted = own ? change[i - first] : WH_R(0.0);
        TEST_ASSERT_TRUE(own ? WH_ABS(books.step[i] - wanted) <= size * WH_R(1e-5)
                             : books.step[i] == WH_R(0.0));
    }
}

TEST(contact_books, corrections_are_entered_where_they_belong) {
    uint64_t seed = 2323;
    for (unsigned round = 0; round < 200; round++) {
        static const wh_real none[1] = {WH_R(0.0)};
        wh_real before[3];
        wh_real after[3];
        wh_real change[3];
        wh_real size = WH_R(1.0);
        hand_build(2, WH_R(3.0), draw_broken(&seed, -1, 1), WH_R(2.0));
        for (unsigned k = 0; k < 3; k++) {
            hand_add(WH_STOP, -1, WH_R(1.0), WH_R(0.5), WH_R(0.0), WH_R(0.5), WH_R(0.0));
        }
        hand_now.weighs = true;
        for (unsigned i = 0; i < 2; i++) {
            hand_now.load[i] = draw_broken(&seed, -9, 9);
            hand_now.spring[i] = draw_broken(&seed, 1, 30);
        }
        hand_start(true);
        wh_contact_work_begin(&hand_now.system, &hand_state, &w);
        w.books = &books;
        wh_ledger_open(&hand_books, &hand_state, &books);
        const unsigned k = draw_one_of(&seed, 3);
        const bool levels = draw_one_in(&seed, 2); /* by its levels, counted twice, or evaluated */
        for (unsigned i = 0; i < hand_books.entries; i++) {
            books.step[i] = WH_R(0.0);
        }
        move_all(&seed);
        level_of(before);
        if (levels) {
            wh_books_levels(&hand_now.system, &w, &s, none, k, WH_R(-1.0));
        } else {
            wh_books_look(&hand_now.system, &w, &s, none);
        }
        move_all(&seed);
        level_of(after);
        if (levels) {
            wh_books_levels(&hand_now.system, &w, &s, none, k, WH_R(1.0));
        } else {
            wh_books_moved(&hand_now.system, &w, &s, none, k);
        }
        for (unsigned i = 0; i < 3; i++) {
            change[i] = after[i] - before[i];
            size += WH_ABS(before[i]) + WH_ABS(after[i]);
        }
        expect_entries(k, change, size);
    }
}
