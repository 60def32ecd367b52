/* bench.h: contacts laid out by hand, so that single functions of core/contact*.h can be asked what they make of them: up
 * to three coordinates, up to four contacts, rows, biases, limits and signals that are what a test says. Numbers are
 * drawn whole, so that sums of them are exact and ties are ties. What stands behind the coordinates and the contacts
 * in use is no part of them, and so large that whoever reads it is noticed. */
#ifndef TESTS_BENCH_H
#define TESTS_BENCH_H

#define WH_LEDGER 1
#define WH_LEDGER_MAX 20
#define WH_ACCOUNTS_MAX 4
#define WH_COORDS 4
#define WH_UNROLL
#define BENCH_CONTACTS 5
#define WH_CONTACTS_MAX BENCH_CONTACTS
#define WH_SETS_MAX 1
#include "core/contact/contact_step.h"
#include "draw.h"

enum { BENCH_COORDS = 3, BENCH_FORCED = 4 };

#define BENCH_SENTINEL WH_R(1048576.0)

typedef struct bench {
    wh_real inverse[WH_COORDS][WH_COORDS]; /* M^-1 */
    wh_real row[BENCH_CONTACTS][WH_COORDS];
    wh_real lean
        [BENCH_CONTACTS]; /* the row's first entry gets so much more for each metre of the first line */
    wh_real bias[BENCH_CONTACTS];
    wh_real first[BENCH_CONTACTS];
    wh_real second[BENCH_CONTACTS];
    wh_real free[WH_COORDS];            /* the accelerations without contacts */
    wh_real ramp[WH_COORDS];            /* on top, for each metre of the first line */
    wh_real signal[2 * BENCH_CONTACTS]; /* whatever the place, */
    bool moves; /* or that, with J x (lines only; bent by lean) and J x' on top */
    wh_contact contact[BENCH_CONTACTS];
    wh_contact_system system;
    wh_ledger_form books;
    const wh_contact_point *at; /* if not NULL, where all is to be asked, */
    const wh_real *input;       /* with this input */
    bool astray;                /* something was asked elsewhere */
    unsigned looks;             /* how often the signals were evaluated */
    unsigned laws;              /* and the forces */
} bench;

extern bench bench_now;

/* So many coordinates, the first `angles` of them angles; M^-1 drawn, whole and positive definite. */
void bench_build(uint64_t *seed, unsigned coordinates, unsigned angles);
/* A contact: pinned to coordinate `pin`, or, with -1, on no single one: its row is drawn. Returns its number. */
unsigned bench_add(uint64_t *seed, wh_contact_kind kind, int pin);
/* One to four contacts of the kinds in `kinds` (bits), in order; some pinned, some repeating others. */
void bench_add_some(uint64_t *seed, unsigned kinds);
/* Any mechanism: its coordinates, `angles` perhaps among them, and contacts of any kinds with a force. */
void bench_draw(uint64_t *seed, bool angles);
/* w as new, with the laws in it, and each contact in a mode: it holds, or, `some`, perhaps not. */
void bench_work(uint64_t *seed, bool some, wh_contact_work *w);
/* Does contact k, in its mode, keep something? */
bool bench_keeps(const wh_contact_work *w, unsigned k);
/* x[WH_COORDS]: whole numbers, and what is behind them. */
void bench_vector(uint64_t *seed, wh_real *x);
/* All or some of the contacts with a force in member[BENCH_CONTACTS], in any order; behind them one that is none.
 * Returns how many. */
unsigned bench_members(uint64_t *seed, uint8_t *member);

/* A state: whole numbers of turns or radians, of metres, and rates, and what is behind them. */
void bench_state(uint64_t *seed, wh_contact_state *s);
/* What coordinate i has moved by from one to the other, rad or m. */
wh_real bench_moved(const wh_contact_state *from, const wh_contact_state *to, unsigned i);

/* The references: plain sums over all entries. */
wh_real bench_along(unsigned k, const wh_real *x); /* J_k x */
wh_real bench_delassus(unsigned k, unsigned l);    /* J_k M^-1 J_l^T */
wh_real bench_way(unsigned k, unsigned i);         /* (M^-1 J_k^T)_i */
bool bench_near(wh_real value, wh_real wanted);    /* within the rounding of a few whole numbers */
/* Of the members, taken in their order, those whose rows are in the span of the earlier ones that are not, as
 * bits of places; those with at[] other than zero are left out (at may be NULL). */
unsigned bench_repeats(const uint8_t *member, unsigned count, const int8_t *at);
/* Solve the members' J M^-1 J^T lambda = wanted, those in `out` (bits of places) being zero: by Gauss and Jordan with
 * the largest pivot. */
void bench_solve(const uint8_t *member, unsigned count, unsigned out, const wh_real *wanted,
                 wh_real *lambda);

#endif
