/* choice.c: see choice.h. */
#include "choice.h"

#include "host/number/functions.h"

#define CHOICE_LIMIT_WORD(id, word) word,
const char *const choice_limit_words[CHOICE_LIMITS] = {CHOICE_LIMIT_ROWS(CHOICE_LIMIT_WORD)};

static bool is_known(const cost_figure *f) { return f->basis != COST_NOT_KNOWN; }

/* --- rows by the limits ----------------------------------------------------------------------------*/

static void judge_limit(choice_row *row, choice_limit which, double limit, bool known,
                        double most) {
    row->unknown[which] = limit > 0.0 && !known;
    row->fails[which] = limit > 0.0 && known && most > limit;
}

static const cost_figure *worst_of(const cost *c) {
    return is_known(&c->cycles_worst) ? &c->cycles_worst : &c->instructions_worst;
}

/* A limit is kept by the most that a figure may be; a prediction that will be counted, by the least. */
static double bound_of(const cost_figure *f, bool hopeful) { return hopeful ? f->least : f->most; }

static choice_row judged(const trials *t, const choice_wish *w, const table *made, int i) {
    const table_row *of = &made->row[i];
    const cost *c = &of->cost;
    const bool hopeful = w->counts && !of->counted;
    choice_row row = {.row = i};
    const double each_s = ratio_times(1, trial_step(t, of->pace));
    const bool cycles = is_known(&c->cycles_worst);
    const double clock = cycles ? w->clock_Hz : 0.0;
    const cost_figure *worst = worst_of(c);
    const bool best = hopeful && worst->basis != COST_RANGE;
    row.worst = (best ? worst->value : worst->most) / each_s;
    row.load = clock > 0.0 ? c->cycles_worst.value / each_s / clock : 0.0;
    row.load_most = clock > 0.0 ? row.worst / clock : 0.0;
    row.fails[CHOICE_ERROR] = of->result.error * TABLE_MARGIN > w->table.error;
    judge_limit(&row, CHOICE_LOAD, w->clock_Hz > 0.0 ? 1.0 : 0.0, cycles, row.load_most);
    judge_limit(&row, CHOICE_FLASH, w->flash_bytes, is_known(&c->flash_bytes),
                bound_of(&c->flash_bytes, hopeful));
    /* what does not fit without the stack does not fit, whatever that takes */
    const double ram = bound_of(&c->ram_bytes, hopeful);
    const bool known = is_known(&c->ram_bytes) && (is_known(&c->stack_bytes) || ram > w->ram_bytes);
    judge_limit(&row, CHOICE_RAM, w->ram_bytes, known, ram + bound_of(&c->stack_bytes, hopeful));
    return row;
}

static bool fails_besides(const choice_row *row, choice_limit but) {
    for (int i = 0; i < CHOICE_LIMITS; i++) {
        if (i != (int)but && row->fails[i]) {
            return true;
        }
    }
    return false;
}

/* Rows come by rising price: the first of equal ones stays. */
static void keep_least(choice_row *kept, const choice_row *row, double value, double best) {
    if (kept->row < 0 || value < best) {
        *kept = *row;
    }
}

static double flash_of(const table *made, const choice_row *row) {
    return row->row < 0 ? 0.0 : made->row[row->row].cost.flash_bytes.value;
}

static double error_of(const table *made, const choice_row *row) {
    return row->row < 0 ? 0.0 : made->row[row->row].result.error;
}

static void enter(choice *c, const table *made, const choice_row *row) {
    const bool has_flash = flash_of(made, row) > 0.0;
    if (!fails_besides(row, CHOICE_LIMITS)) {
        keep_least(&c->fastest, row, row->worst, c->fastest.worst);
        if (has_flash) {
            keep_least(&c->smallest, row, flash_of(made, row), flash_of(made, &c->smallest));
        }
    }
    if (!fails_besides(row, CHOICE_ERROR)) {
        keep_least(&c->weaker, row, error_of(made, row), error_of(made, &c->weaker));
    }
    if (row->fails[CHOICE_ERROR]) {
        return;
    }
    keep_least(&c->any, row, row->worst, c->any.worst);
    if (!fails_besides(row, CHOICE_LOAD)) {
        keep_least(&c->dearer, row, row->load_most, c->dearer.load_most);
    }
    if (!row->fails[CHOICE_LOAD] && has_flash) {
        keep_least(&c->larger, row, flash_of(made, row), flash_of(made, &c->larger));
    }
}

choice choice_make(const trials *t, const table *made, const choice_wish *w) {
    const choice_row none = {.row = -1};
    choice c = {none, none, none, none, none, none};
    for (int i = 0; i < made->count; i++) {
        const choice_row row = judged(t, w, made, i);
        enter(&c, made, &row);
    }
    return c;
}

/* --- counting --------------------------------------------------------------------------------------*/

/* A run on an emulator of no more instructions than this: some ten seconds. */
#define RUN_INSTRUCTIONS 1e9
/* Of what is not known of any run in this number: all rows of it before those of others. */
#define UNTRIED 1e-3

/* With contacts: the expected cost of runs that were not counted, by `each` evaluation of a number. */
static void expect(const trials *t, table *made, const table_row *last,
                   double each[SETTING_NUMBERS]) {
    if (last != NULL && last->result.evaluations_most > 0.0) {
        each[setting_number(&last->setting)] =
            worst_of(&last->cost)->value / last->result.evaluations_most;
    }
    const bool cycles = t->wish.board->cycles != COST_RANGE;
    for (int i = 0; i < made->count; i++) {
        table_row *row = &made->row[i];
        const double known = each[setting_number(&row->setting)];
        if (!row->counted) {
            const double worst = row->result.evaluations_most * (known > 0.0 ? known : UNTRIED);
            row->cost.instructions_worst = cost_known(worst, COST_PREDICTED);
            row->cost.cycles_worst = cycles ? row->cost.instructions_worst : (cost_figure){0};
        }
    }
}

/* Runs of too many steps leave the table. */
static void drop_long(const trials *t, table *made) {
    int kept = 0;
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        const double each = (double)t->image[0]->list[IMAGE_STEP]->count;
        const double evaluations = row->result.evaluations * trial_horizon_s(t) * t->points;
        if (evaluations * each <= RUN_INSTRUCTIONS) {
            made->row[kept++] = *row;
        } else {
            made->why = "its run has too many steps to be counted: a shorter --horizon";
        }
    }
    made->unpriced += kept < made->count;
    made->count = kept;
}

/* A row that an answer names and that was not counted; -1: there is none. */
static int uncounted(const table *made, const choice *c) {
    const bool found = c->fastest.row >= 0;
    const choice_row *const named[] = {found ? &c->fastest : &c->weaker,
                                       found ? &c->smallest : &c->dearer, found ? NULL : &c->larger,
                                       found ? NULL : &c->any};
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
        if (named[i] != NULL && named[i]->row >= 0 && !made->row[named[i]->row].counted) {
            return named[i]->row;
        }
    }
    return -1;
}

measured_end choice_counted(trials *t, table *made, const choice_wish *w, const table_words *words,
                            choice *c) {
    const bool runs = t->image[0]->contacts > 0;
    double each[SETTING_NUMBERS] = {0};
    if (runs) {
        drop_long(t, made);
        expect(t, made, NULL, each);
    }
    *c = choice_make(t, made, w);
    int counts = 0;
    for (int i = uncounted(made, c); i >= 0 && !t->stopped; i = uncounted(made, c)) {
        if (w->counting != NULL) {
            w->counting(w->table.context, counts++);
        }
        const table_row before = made->row[i];
        if (measured_count(t, made, i, words) == MEASURED_MISSING) {
            return MEASURED_MISSING;
        }
        for (int k = 0; k < made->count && runs; k++) {
            const table_row *row = &made->row[k];
            if (row->counted && setting_order(&row->setting) == setting_order(&before.setting) &&
                row->pace.steps == before.pace.steps && row->pace.records == before.pace.records) {
                expect(t, made, row, each);
            }
        }
        t->stopped = t->stopped || (t->wish.stop != NULL && *t->wish.stop);
        *c = choice_make(t, made, w);
    }
    return MEASURED_COUNTED;
}
