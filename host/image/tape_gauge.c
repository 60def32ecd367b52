/* tape_gauge.c: looking for the numbers that leave float's constants next to what they are. */
#include "tape_gauge.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"

enum {
    LONGEST = 250, /* operations of a list that is looked at */
    FIVES = 6,     /* most of each prime */
    THREES = 3,
    SEVENS = 1,
    REALS = 512,      /* numbers between one and two that are tried, */
    VANISHING = 24,   /* and those that leave a constant as one */
    ROUNDS = 3,       /* each from what the last one found */
    PATIENCE = 150000 /* operations of lists, after which a round ends */
};

/* Half is clearly better, and what is not a hundredth less is no better. */
#define CLEARLY 0.5
#define LESS 0.99

int tape_gauge_price(const tape *t) { return 1 + tape_operations(t) / 40; }

/* --- one list -------------------------------------------------------------------------------------------------*/

/* The best list so far. */
typedef struct gauge_search {
    const tape *like;
    const tape *from; /* the last round's */
    int most;         /* operations */
    tape *best;       /* NULL: none */
    double bias;
    int operations;
    double *times; /* [3 * from->count] */
    int64_t tried; /* operations of lists that were tried */
} gauge_search;

/* x to the e: whole powers as products, for these are to be exact. */
static double power(double x, double e) {
    if (e == number_floor(e) && fabs(e) <= 4.0) {
        double product = 1.0;
        for (int k = 0; k < (int)fabs(e); k++) {
            product *= x;
        }
        return e < 0.0 ? 1.0 / product : product;
    }
    return number_power(x, e);
}

/* More operations are taken for a bias that is clearly better, as many for one that is less, fewer for one that is not more. */
static bool is_better(const gauge_search *s, double bias, int operations) {
    return bias < CLEARLY * s->bias || (bias < LESS * s->bias && operations <= s->operations) ||
           (bias <= s->bias && operations < s->operations);
}

static void try_number(gauge_search *s, const double *exponent, double x) {
    if (s->tried >= PATIENCE) {
        return;
    }
    for (int i = 0; i < 3 * s->from->count; i++) {
        s->times[i] = power(x, exponent[i]);
    }
    tape *made = tape_multiplied(s->from, s->times);
    s->tried += made->count;
    const int operations = tape_operations(made);
    if (operations <= s->most && tape_not_finite(made) < 0) {
        const double bias = tape_bias(made, s->like);
        if (is_better(s, bias, operations)) {
            tape_free(s->best);
            s->best = made;
            s->bias = bias;
            s->operations = operations;
            return;
        }
    }
    tape_free(made);
}

/* --- which numbers ----------------------------------------------------------------------------------------------*/

/* Products of small primes, the simplest first: decimals times enough fives are whole numbers over powers of two, thirds
 * times three are whole. Twos change nothing. */
static void try_primes(gauge_search *s, const double *exponent) {
    for (int all = 1; all <= FIVES + THREES + SEVENS; all++) {
        for (int fives = -FIVES; fives <= FIVES; fives++) {
            for (int threes = -THREES; threes <= THREES; threes++) {
                const int sevens = all - abs(fives) - abs(threes);
                for (int sign = -1; sign <= 1 && sevens >= 0 && sevens <= SEVENS; sign += 2) {
                    const int cubes = fives / 3;
                    const double x = power(125.0, cubes) * power(5.0, fives % 3) *
                                     power(3.0, threes) * power(7.0, -sign * sevens);
                    try_number(s, exponent, x);
                }
            }
        }
    }
}

/* Those after which a product with a constant is none. */
static void try_vanishing(gauge_search *s, const double *exponent) {
    int tried = 0;
    double number;
    for (int i = 0; i < s->from->count && tried < VANISHING; i++) {
        const op *o = &s->from->ops[i];
        if (o->code == OP_MUL && tape_is_constant(s->from, o->a, &number)) {
            const double factor = tape_is_raw(&s->from->ops[o->b]) ? 0.0 : exponent[o->b];
            const double e = factor - exponent[i];
            if (e != 0.0) {
                try_number(s, exponent, number_power(fabs(number), 1.0 / e));
                tried++;
            }
        }
    }
}

static void try_reals(gauge_search *s, const double *exponent) {
    const double golden = 0.6180339887498949;
    for (int k = 1; k <= REALS; k++) {
        try_number(s, exponent, 1.0 + number_remainder(k * golden, 1.0));
    }
}

/* Can this freedom be afforded? With a number that leaves no constant as one. */
static bool affordable(const gauge_search *s, const double *exponent) {
    for (int i = 0; i < 3 * s->from->count; i++) {
        s->times[i] = power(1.2345678901, exponent[i]);
    }
    tape *made = tape_multiplied(s->from, s->times);
    const bool can = tape_operations(made) <= s->most;
    tape_free(made);
    return can;
}

/* Simple numbers for every freedom first, for the round may end. */
static void search_round(gauge_search *s) {
    tape_freedoms f = tape_freedoms_of(s->from);
    bool *can = room((int64_t)f.count + 1, sizeof *can);
    s->tried = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < f.count; k++) {
            const double *exponent = f.exponent + (size_t)k * (size_t)f.length;
            if (pass == 0) {
                try_vanishing(s, exponent);
                can[k] = affordable(s, exponent);
            }
            if (can[k]) {
                (pass == 0 ? try_primes : try_reals)(s, exponent);
            }
        }
    }
    free(can);
    tape_freedoms_free(&f);
}

void tape_gauge(tape **t, int price) {
    const double bias = tape_bias(*t, *t);
    if ((*t)->count > LONGEST || !(bias > 0.0)) {
        return;
    }
    tape *found = NULL;
    gauge_search s = {.like = *t,
                      .from = *t,
                      .most = tape_operations(*t) + price,
                      .bias = bias,
                      .operations = tape_operations(*t)};
    for (int round = 0; round < ROUNDS; round++) {
        s.times = room(3 * (int64_t)s.from->count + 1, sizeof *s.times);
        search_round(&s);
        free(s.times);
        if (s.best == NULL) {
            break;
        }
        tape_free(found);
        found = s.best;
        s.from = found;
        s.best = NULL;
    }
    if (found != NULL && s.bias <= CLEARLY * bias) {
        tape_free(*t);
        *t = found;
    } else {
        tape_free(found);
    }
}
