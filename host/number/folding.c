/* folding.c: see folding.h. */
#include "folding.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/hash.h"
#include "enclosure.h"
#include "functions.h"
#include "twofold.h"

/* What double is rounded by. */
#define UNIT 0x1p-53
/* What a few roundings leave: 0.1 + 0.2 - 0.3. */
#define GHOST (16.0 * UNIT)

static folding now;

folding folding_begin(int way, const folding_notes *on) {
    const folding before = now;
    now = (folding){.way = way};
    if (on != NULL) {
        now.notes = *on;
    }
    return before;
}

folding_notes folding_end(folding before) {
    const folding_notes notes = now.notes;
    now = before;
    return notes;
}

int folding_way(void) { return now.way; }

static uint64_t digits_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits & ((UINT64_C(1) << 52) - 1);
}

/* The same in all that is folded of these digits, whatever their signs and powers of two, and in whatever order. */
static bool is_turned(double x, double y) {
    if (now.way <= FOLDING_APART) {
        return now.way == FOLDING_OTHER;
    }
    const uint64_t a = digits_of(x);
    const uint64_t b = digits_of(y);
    const uint64_t hash = ((a + b) * WH_HASH_PRIME ^ (a ^ b)) * WH_HASH_PRIME;
    return (hash >> (32 + now.way - FOLDING_SOME) & 1U) != 0;
}

/* On the other side of what `exact` is, one double beyond its neighbour: several roundings may have put a number as far off
 * as that. Itself where it is a double. */
static double other_neighbour(twofold exact, double x, double y) {
    if (!twofold_is_finite(exact) || exact.low == 0.0 || !is_turned(x, y)) {
        return exact.high;
    }
    return exact.low > 0.0 ? enclosure_above(enclosure_above(exact.high))
                           : enclosure_below(enclosure_below(exact.high));
}

/* --- what is noted, of what is rounded to nearest ----------------------------------------------------*/

static bool is_rest(double x) {
    const folding_notes *n = &now.notes;
    for (int i = 0; i < n->rests; i++) {
        if (n->rest[i] == fabs(x)) {
            return true;
        }
    }
    return false;
}

static void note_rest(double x) {
    folding_notes *n = &now.notes;
    if (x != 0.0 && n->rests < FOLDING_RESTS && !is_rest(x)) {
        n->rest[n->rests++] = fabs(x);
    }
}

static void note_lost(double part) { now.notes.lost = number_most(now.notes.lost, part); }

double folding_wave(double wave, double angle_rad) {
    if (fabs(wave) <= GHOST * fabs(angle_rad)) {
        note_rest(wave);
    }
    return wave;
}

/* A rest that vanishes beside a number is no loss; a number that vanishes beside a rest is. */
static void note_sum(double x, double y, double sum) {
    const bool rest_x = is_rest(x);
    const bool rest_y = is_rest(y);
    const double most = number_most(fabs(x), fabs(y));
    if (fabs(sum) <= GHOST * most || (rest_x && rest_y)) {
        note_rest(sum);
        return;
    }
    const double least =
        number_least(fabs(sum), number_least(rest_x ? most : fabs(x), rest_y ? most : fabs(y)));
    if (least > 0.0) {
        note_lost(UNIT * most / least);
    }
}

/* --- what is folded ----------------------------------------------------------------------------------*/

double folding_sum(double x, double y) {
    if (now.way != FOLDING_NEAREST) {
        return other_neighbour(twofold_add(twofold_of(x), twofold_of(y)), x, y);
    }
    note_sum(x, y, x + y);
    return x + y;
}

double folding_product(double x, double y) {
    if (now.way != FOLDING_NEAREST) {
        return other_neighbour(twofold_mul(twofold_of(x), twofold_of(y)), x, y);
    }
    if (is_rest(x) || is_rest(y)) {
        note_rest(x * y);
    }
    return x * y;
}

bool folding_cancels(double left, double size, double part) {
    if (now.way != FOLDING_NEAREST || !(fabs(left) <= part * size)) {
        return left == 0.0;
    }
    if (fabs(left) > GHOST * size) {
        note_lost(1.0);
    }
    return true;
}

bool folding_same(double x, double y, double part) {
    return folding_cancels(x - y, number_most(fabs(x), fabs(y)), part);
}
