/* choice.c: see choice.h. */
#include "choice.h"

#include <stdlib.h>
#include <string.h>

#include "choice_price.h"
#include "host/base/room.h"
#include "host/number/functions.h"

#define CHOICE_LIMIT_WORD(id, word) word,
const char *const choice_limit_words[CHOICE_LIMITS] = {CHOICE_LIMIT_ROWS(CHOICE_LIMIT_WORD)};

uint64_t choice_substeps(int i) {
    static const uint64_t tens[] = {12, 15, 20, 25, 30, 40, 50, 60, 80};
    if (i < 10) {
        return (uint64_t)i + 1;
    }
    uint64_t steps = tens[(i - 10) % 9];
    for (int k = (i - 10) / 9; k > 0; k--) {
        steps *= 10;
    }
    return steps;
}

/* --- what a row is judged by ---------------------------------------------------------------------------*/

static bool is_known(const cost_figure *f) { return f->basis != COST_NOT_KNOWN; }

static void judge_limit(choice_row *row, choice_limit which, double limit, bool known,
                        double most) {
    row->unknown[which] = limit > 0.0 && !known;
    row->fails[which] = limit > 0.0 && known && most > limit;
}

static void judge(const trials *t, const choice_wish *w, choice_row *row) {
    const cost *c = &row->cost;
    const double each_s = ratio_times(1, trial_step(t, row->pace));
    const bool cycles = is_known(&c->cycles_worst);
    const cost_figure *worst = cycles ? &c->cycles_worst : &c->instructions_worst;
    row->worst = worst->most / each_s;
    row->load = w->clock_Hz > 0.0 && cycles ? c->cycles_worst.value / each_s / w->clock_Hz : 0.0;
    row->load_most = w->clock_Hz > 0.0 && cycles ? row->worst / w->clock_Hz : 0.0;
    judge_limit(row, CHOICE_LOAD, w->clock_Hz > 0.0 ? 1.0 : 0.0, cycles, row->load_most);
    judge_limit(row, CHOICE_FLASH, w->flash_bytes, is_known(&c->flash_bytes), c->flash_bytes.most);
    /* what does not fit without the stack does not fit, whatever that takes */
    const bool ram =
        is_known(&c->ram_bytes) && (is_known(&c->stack_bytes) || c->ram_bytes.most > w->ram_bytes);
    judge_limit(row, CHOICE_RAM, w->ram_bytes, ram, c->ram_bytes.most + c->stack_bytes.most);
}

static bool fails_besides(const choice_row *row, choice_limit but) {
    for (int i = 0; i < CHOICE_LIMITS; i++) {
        if (i != (int)but && row->fails[i]) {
            return true;
        }
    }
    return false;
}

static bool fails(const choice_row *row) { return fails_besides(row, CHOICE_LIMITS); }

/* Less of `worst`, or as much of it and a smaller error. */
static bool is_cheaper(const choice_row *a, const choice_row *b) {
    return a->worst < b->worst || (!(a->worst > b->worst) && a->result.error < b->result.error);
}

static void keep_least(bool *has, choice_row *kept, const choice_row *row, double value,
                       double best) {
    if (!*has || value < best) {
        *has = true;
        *kept = *row;
    }
}

/* Enter a row of which all is known. */
static void enter(choice *c, const choice_row *row, const choice_row *coarser) {
    if (row->result.usable && !fails_besides(row, CHOICE_ERROR)) {
        keep_least(&c->has_weaker, &c->weaker, row, row->result.error, c->weaker.result.error);
    }
    if (!fails_besides(row, CHOICE_LOAD)) {
        keep_least(&c->has_dearer, &c->dearer, row, row->load_most, c->dearer.load_most);
    }
    if (!row->fails[CHOICE_ERROR]) {
        keep_least(&c->has_any, &c->any, row, row->worst, c->any.worst);
    }
    if (!row->fails[CHOICE_ERROR] && !row->fails[CHOICE_LOAD]) {
        keep_least(&c->has_larger, &c->larger, row, row->cost.flash_bytes.most,
                   c->larger.cost.flash_bytes.most);
    }
    if (fails(row)) {
        return;
    }
    if (!c->found || is_cheaper(row, &c->best)) {
        c->has_second = c->found;
        c->second = c->best;
        c->best = *row;
        c->found = true;
        c->has_coarser = coarser != NULL;
        c->coarser = coarser != NULL ? *coarser : (choice_row){0};
    } else if (!c->has_second || is_cheaper(row, &c->second)) {
        c->second = *row;
        c->has_second = true;
    }
}

/* --- trials ------------------------------------------------------------------------------------------*/

/* The rung-th pace: substeps of a period, or steps of any length. False: there is none. */
static bool pace_of(const choice_wish *w, int rung, choice_row *row) {
    if (w->rate_Hz > 0.0) {
        row->substeps = rung < CHOICE_SUBSTEPS ? choice_substeps(rung) : 0;
        row->pace = (deviation_pace){w->periods * row->substeps, 1};
        return rung < CHOICE_SUBSTEPS;
    }
    row->pace = table_ladder(rung);
    return rung < TABLE_LADDER;
}

/* The first step that is tried of a setting may take so many times its share of the operations. */
#define FIRST_MAY_TAKE 4.0

static void count_failures(choice *c, const choice_row *row) {
    for (int i = 0; i < CHOICE_LIMITS; i++) {
        c->failed[i] += row->fails[i] ? 1 : 0;
    }
}

/* Can no step from this one on be of use, since none keeps flash, RAM or load? What a finer step takes is as much, and more
 * of it a second; but that of a matrix comes and goes with its entries. (With contacts, it is a step without an event.) */
static bool is_hopeless(const setting *s, const choice_row *row) {
    return !setting_price_varies(s) && fails_besides(row, CHOICE_ERROR);
}

/* How climbing a setting's steps ended: one of choice_left; or tried, until it kept the error or was too dear to win; until no
 * finer step could be of use; or without one that could. */
enum { CLIMB_DONE = CHOICE_LEFTS, CLIMB_ERRS, CLIMB_REFUSED };
typedef int climb_end;

/* With contacts, the price of a row that was run, and what it is judged by then. Not CLIMB_DONE: the setting is left. */
static climb_end price_run(trials *t, const choice_wish *w, const cost *price, choice_row *row) {
    if (!choice_prices_runs(w)) {
        return CLIMB_DONE;
    }
    row->cost = choice_price_of_run(t, w, &row->setting, row->pace, price, &row->result);
    row->run = measured_run_of(w->counted, &row->setting, row->pace);
    if (!is_known(&row->cost.instructions_worst)) {
        return CHOICE_LEFT_UNBUILT;
    }
    if (!(row->run.steps > 0.0) && choice_run_is_long(t, row->pace, &row->cost)) {
        return CHOICE_LEFT_LONG;
    }
    judge(t, w, row);
    return CLIMB_DONE;
}

/* Constants that happen to be alike at one step cost less there: a price varies by so much of itself at most where it is
 * not said to vary. */
#define PRICE_VARIES 0.02

static bool may_win(const choice *c, const choice_row *row) {
    return !c->found || !c->has_second || row->worst * (1.0 - PRICE_VARIES) < c->second.worst;
}

/* What is predicted of a row that was run is predicted of its own step. */
static void price_own_step(trials *t, const choice_wish *w, choice_row *row) {
    bool own;
    if (w->counted == NULL && !setting_price_varies(&row->setting)) {
        row->cost = choice_price(t, w, &row->setting, row->pace, false, &own);
        judge(t, w, row);
    }
}

/* One setting by ever finer steps, until it keeps the error, or could not be of use if it did. */
static climb_end climb(trials *t, const choice_wish *w, choice *c, const setting *s,
                       const cost *price, double each) {
    choice_row row = {.setting = *s};
    choice_row before = row;
    bool has_before = false;
    bool tried = false;
    bool dear = false;
    for (int rung = 0; pace_of(w, rung, &row); rung++) {
        if (row.pace.records > (uint64_t)t->records) {
            continue;
        }
        const double started = t->operations;
        row.cost = *price;
        const bool too_dear =
            dear || trial_operations(t, s, row.pace) > (tried ? 1.0 : FIRST_MAY_TAKE) * each;
        if (too_dear && setting_is_fixed(s)) { /* its price alone takes a run */
            return tried ? CHOICE_LEFT_FINER : CHOICE_LEFT_WHOLE;
        }
        if (setting_price_varies(s)) {
            bool own;
            row.cost = choice_price(t, w, s, row.pace, false, &own);
            if (!own || !is_known(&row.cost.instructions_worst)) {
                continue; /* in fixed point a step may be too long; or it was counted, and could not be */
            }
        }
        judge(t, w, &row);
        if (!may_win(c, &row)) {
            return CLIMB_DONE;
        }
        if (too_dear) {
            if (is_hopeless(s, &row)) {
                return has_before ? CLIMB_ERRS : CLIMB_REFUSED;
            }
            return tried ? CHOICE_LEFT_FINER : CHOICE_LEFT_WHOLE;
        }
        tried = true;
        row.result = trial_memo_run(w->memo, t, s, row.pace);
        if (!row.result.ran && !t->stopped && setting_price_varies(s)) {
            continue; /* the numbers of its matrix are too large */
        }
        if (!row.result.ran) {
            return CHOICE_LEFT_UNRUN;
        }
        row.fails[CHOICE_ERROR] = !row.result.usable || row.result.error * CHOICE_MARGIN > w->error;
        price_own_step(t, w, &row);
        const climb_end run = price_run(t, w, price, &row);
        if (run != CLIMB_DONE) {
            return run;
        }
        enter(c, &row, has_before ? &before : NULL);
        if (!row.fails[CHOICE_ERROR]) {
            count_failures(c, &row);
            return CLIMB_DONE;
        }
        before = row;
        has_before = true;
        dear = (t->operations - started) * 2.0 > each;
    }
    return has_before ? CHOICE_LEFT_FINEST : CHOICE_LEFT_UNRUN;
}

static void enter_end(choice *c, climb_end end) {
    if (end < CHOICE_LEFTS) {
        c->left[end]++;
        return;
    }
    c->tried++;
    c->refused += end == CLIMB_REFUSED ? 1 : 0;
    c->failed[CHOICE_ERROR] += end == CLIMB_ERRS ? 1 : 0;
}

int choice_not_tried(const choice *c) {
    int count = c->unpriced;
    for (int i = 0; i < CHOICE_LEFTS; i++) {
        count += c->left[i];
    }
    return count;
}

static void count_reason(choice *c, const char *why) {
    int i = 0;
    while (i < CHOICE_REASONS - 1 && c->reason[i].why != NULL &&
           strcmp(c->reason[i].why, why) != 0) {
        i++;
    }
    c->reason[i].why = why;
    c->reason[i].settings++;
    c->unpriced++;
}

choice choice_make(trials *t, const choice_wish *w) {
    choice c = {.settings = 0};
    const int count = setting_count();
    cost *price = room(count, sizeof *price);
    bool *priced = room(count, sizeof *priced);
    int wanted = 0;
    t->planned_most = FIRST_MAY_TAKE * w->operations / (2.0 * count);
    for (int i = 0; i < count; i++) {
        const setting s = setting_at(i);
        bool own;
        if (trial_is_slow_to_plan(t, &s, (deviation_pace){w->periods, 1})) {
            c.settings++;
            c.left[CHOICE_LEFT_WHOLE]++;
            continue;
        }
        price[i] = choice_price(t, w, &s, (deviation_pace){w->periods, 1}, true, &own);
        priced[i] = own && is_known(&price[i].instructions_worst);
        c.settings += own ? 1 : 0;
        if (own && !priced[i]) {
            count_reason(&c, price[i].why);
        }
        wanted += priced[i] ? 1 : 0;
    }
    int done = 0;
    for (int i = 0; i < count && !t->stopped; i++) {
        const setting s = setting_at(i);
        if (!priced[i]) {
            continue;
        }
        if (w->progress != NULL) {
            w->progress(w->context, done, wanted);
        }
        enter_end(&c, climb(t, w, &c, &s, &price[i], w->operations / (2.0 * wanted)));
        done++;
    }
    free(price);
    free(priced);
    return c;
}

double choice_lower_rate(trials *t, const choice_wish *w, const choice *c, choice_row *row) {
    *row = c->dearer;
    if (!c->has_dearer || choice_prices_runs(w) || !(w->rate_Hz > 0.0) || c->dearer.substeps != 1) {
        return 0.0; /* as many steps a second as now would be taken at any rate */
    }
    const double slower = number_ceiling(c->dearer.load_most);
    if (!(slower >= 2.0 && slower < 1e6)) {
        return 0.0;
    }
    const uint64_t times = (uint64_t)slower;
    if (times % w->periods != 0 || times / w->periods > (uint64_t)t->records) {
        return 0.0; /* no whole number of records */
    }
    row->pace = (deviation_pace){1, times / w->periods};
    row->result = trial_run(t, &row->setting, row->pace);
    const bool keeps =
        row->result.ran && row->result.usable && row->result.error * CHOICE_MARGIN <= w->error;
    return keeps ? w->rate_Hz / slower : 0.0;
}
