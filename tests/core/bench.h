/* bench.h: a mechanism of plain numbers, to test single functions of core/contact/: up to three coordinates and four
 * contacts with given rows, biases, limits and signals. Random numbers are whole, so that sums and ties are exact.
 * Unused entries have a very large value, so that a test fails if a function reads one. */
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
    /* Growth of the row's first entry per metre of motion of the first coordinate. */
    wh_real lean[BENCH_CONTACTS];
    wh_real bias[BENCH_CONTACTS];
    wh_real first[BENCH_CONTACTS];
    wh_real second[BENCH_CONTACTS];
    wh_real free[WH_COORDS]; /* the unconstrained accelerations */
    /* Growth of the unconstrained accelerations per metre of motion of the first coordinate. */
    wh_real ramp[WH_COORDS];
    wh_real signal[2 * BENCH_CONTACTS]; /* constant parts of the signals */
    bool moves; /* the signals also contain J x and J x'; only without angles */
    wh_contact contact[BENCH_CONTACTS];
    wh_contact_system system;
    wh_ledger_form books;
    const wh_contact_point *at; /* if not NULL: the state at which everything must be evaluated */
    const wh_real *input;       /* the input at that state */
    bool astray;                /* true after an evaluation at another state or input */
    unsigned looks;             /* number of evaluations of the signals */
    unsigned laws;              /* number of evaluations of the forces */
} bench;

extern bench bench_now;

/* Sets up `coordinates` coordinates; the first `angles` are angles. M^-1 is random, whole and positive definite. */
void bench_build(uint64_t *seed, unsigned coordinates, unsigned angles);
/* Adds a contact. If pin is -1, its row is random; otherwise it is pinned to coordinate `pin`. Returns its number. */
unsigned bench_add(uint64_t *seed, wh_contact_kind kind, int pin);
/* Adds one to four contacts of the kinds in `kinds` (bits), sorted by kind. Some are pinned, some redundant. */
void bench_add_some(uint64_t *seed, unsigned kinds);
/* Draws a mechanism with contacts of all kinds that have a force. If `angles`, some coordinates may be angles. */
void bench_draw(uint64_t *seed, bool angles);
/* Starts w and evaluates the laws. Each contact acts; if `some`, only some of them act. */
void bench_work(uint64_t *seed, bool some, wh_contact_work *w);
/* True if contact k, in its mode, constrains a position. */
bool bench_keeps(const wh_contact_work *w, unsigned k);
/* Fills x[WH_COORDS] with random whole numbers, and with the large value in unused entries. */
void bench_vector(uint64_t *seed, wh_real *x);
/* Writes the numbers of all or some contacts with a force to member[BENCH_CONTACTS], in random order, then an invalid
 * number. Returns their count. */
unsigned bench_members(uint64_t *seed, uint8_t *member);

/* Draws a state: angles in whole turns or radians, positions and rates, and the large value in unused entries. */
void bench_state(uint64_t *seed, wh_contact_state *s);
/* Returns the motion of coordinate i from state `from` to state `to`, rad or m. */
wh_real bench_moved(const wh_contact_state *from, const wh_contact_state *to, unsigned i);

/* References: plain sums over all entries. */
wh_real bench_along(unsigned k, const wh_real *x); /* J_k x */
wh_real bench_delassus(unsigned k, unsigned l);    /* J_k M^-1 J_l^T */
wh_real bench_way(unsigned k, unsigned i);         /* (M^-1 J_k^T)_i */
/* true within the round-off of a few whole numbers */
bool bench_near(wh_real value, wh_real wanted);
/* Returns the members whose rows are linear combinations of earlier rows, as bits of indices in member[]. Members with
 * nonzero at[] are skipped (at may be NULL). */
unsigned bench_repeats(const uint8_t *member, unsigned count, const int8_t *at);
/* Solves the members' J M^-1 J^T lambda = wanted by Gauss-Jordan with the largest pivot. Members in `out` (bits of
 * indices) get zero. */
void bench_solve(const uint8_t *member, unsigned count, unsigned out, const wh_real *wanted,
                 wh_real *lambda);

/* Draws a mechanism without angles, starts its work and sets every mode. */
void bench_plain(uint64_t *seed, wh_contact_work *w);
/* True if one of these contacts is pinned to coordinate c. */
bool bench_pins(const uint8_t *member, unsigned count, unsigned c);

#endif
