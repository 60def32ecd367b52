/* bench.h: contacts laid out by hand, to test single functions of core/contact*.h: up to three coordinates and four contacts
 * with given rows, biases, limits and signals. Drawn numbers are whole, so that sums are exact and ties are ties. Entries after
 * those in use are so large that reading them shows. */
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
    /* growth of the row's first entry per metre of motion of the first line */
    wh_real lean[BENCH_CONTACTS];
    wh_real bias[BENCH_CONTACTS];
    wh_real first[BENCH_CONTACTS];
    wh_real second[BENCH_CONTACTS];
    wh_real free[WH_COORDS];            /* the unconstrained accelerations */
    wh_real ramp[WH_COORDS];            /* their growth per metre of the first line */
    wh_real signal[2 * BENCH_CONTACTS]; /* at any place, */
    bool moves; /* as above; or, with `moves`, with J x (lines only; bent by lean) and J x' added */
    wh_contact contact[BENCH_CONTACTS];
    wh_contact_system system;
    wh_ledger_form books;
    const wh_contact_point *at; /* if not NULL: the place at which everything must be evaluated */
    const wh_real *input;       /* with this input */
    bool astray;                /* an evaluation took place elsewhere */
    unsigned looks;             /* how often the signals were evaluated */
    unsigned laws;              /* and the forces */
} bench;

extern bench bench_now;

/* Sets up coordinates, the first `angles` of which are angles. M^-1 is random, whole and positive definite. */
void bench_build(uint64_t *seed, unsigned coordinates, unsigned angles);
/* Adds a contact that is pinned to coordinate `pin` or, for -1, has a random row. Returns its number. */
unsigned bench_add(uint64_t *seed, wh_contact_kind kind, int pin);
/* Adds one to four contacts of the kinds in `kinds` (bits), in order; some pinned, some redundant. */
void bench_add_some(uint64_t *seed, unsigned kinds);
/* A random mechanism with contacts of any kinds that have a force. With `angles` some coordinates may be angles. */
void bench_draw(uint64_t *seed, bool angles);
/* Starts w and evaluates the laws. Each contact gets a mode: it holds; with `some`, only some of them do. */
void bench_work(uint64_t *seed, bool some, wh_contact_work *w);
/* Does contact k, in its mode, constrain a place? */
bool bench_keeps(const wh_contact_work *w, unsigned k);
/* x[WH_COORDS]: whole numbers, and the guard values after them. */
void bench_vector(uint64_t *seed, wh_real *x);
/* Writes all or some of the contacts with a force to member[BENCH_CONTACTS], in any order, then an invalid one. Returns their
 * number. */
unsigned bench_members(uint64_t *seed, uint8_t *member);

/* A state: whole turns or radians, metres and rates, and the guard values after them. */
void bench_state(uint64_t *seed, wh_contact_state *s);
/* The motion of coordinate i from state `from` to state `to`, rad or m. */
wh_real bench_moved(const wh_contact_state *from, const wh_contact_state *to, unsigned i);

/* The references: plain sums over all entries. */
wh_real bench_along(unsigned k, const wh_real *x); /* J_k x */
wh_real bench_delassus(unsigned k, unsigned l);    /* J_k M^-1 J_l^T */
wh_real bench_way(unsigned k, unsigned i);         /* (M^-1 J_k^T)_i */
bool bench_near(wh_real value, wh_real wanted);    /* within the round-off of a few whole numbers */
/* The members whose rows are in the span of earlier independent rows, as bits of places. Members with nonzero at[] are
 * skipped (at may be NULL). */
unsigned bench_repeats(const uint8_t *member, unsigned count, const int8_t *at);
/* Solves the members' J M^-1 J^T lambda = wanted by Gauss-Jordan with the largest pivot. Members in `out` (bits of places)
 * get zero. */
void bench_solve(const uint8_t *member, unsigned count, unsigned out, const wh_real *wanted,
                 wh_real *lambda);

#endif
