#include "choice.h"

#include <math.h>
#include <stdlib.h>

#include "host/number/functions.h"
#include "host/os/system.h"

static bool is_known(const cost_figure *f) { return f->basis != COST_NOT_KNOWN; }

/* --- rows by the limits ----------------------------------------------------------------------------*/

static void judge_limit(choice_row *row, choice_limit which, double limit, bool known,
                        double most) {
    row->unknown |= limit > 0.0 && !known ? CHOICE_BIT(which) : 0U;
    row->fails |= limit > 0.0 && known && most > limit ? CHOICE_BIT(which) : 0U;
}

static const cost_figure *worst_of(const cost *c) {
    return is_known(&c->cycles_worst) ? &c->cycles_worst : &c->instructions_worst;
}

static double bound_of(const cost_figure *f, bool hopeful) { return hopeful ? f->least : f->most; }

static choice_row judged(const trials *t, const choice_request *w, const table *made, int i) {
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
    row.fails = of->result.error * TABLE_MARGIN > w->table.error ? CHOICE_BIT(CHOICE_ERROR) : 0U;
    judge_limit(&row, CHOICE_LOAD, w->clock_Hz > 0.0 ? 1.0 : 0.0, cycles, row.load_most);
    judge_limit(&row, CHOICE_FLASH, w->flash_bytes, is_known(&c->flash_bytes),
                bound_of(&c->flash_bytes, hopeful));
    /* a row with an unknown stack fails if its other RAM already exceeds the limit */
    const double ram = bound_of(&c->ram_bytes, hopeful);
    const bool known = is_known(&c->ram_bytes) && (is_known(&c->stack_bytes) || ram > w->ram_bytes);
    judge_limit(&row, CHOICE_RAM, w->ram_bytes, known, ram + bound_of(&c->stack_bytes, hopeful));
    return row;
}

#define MEMORY (CHOICE_BIT(CHOICE_FLASH) | CHOICE_BIT(CHOICE_RAM))

/* ignores: limits that a choice may exceed. least: the figure that it minimizes. */
static const struct {
    unsigned ignores;
    enum { OF_CYCLES, OF_FLASH, OF_ERROR } least;
} kinds[CHOICES] = {[CHOICE_FASTEST] = {0, OF_CYCLES},
                    [CHOICE_SMALLEST] = {0, OF_FLASH},
                    [CHOICE_WEAKER] = {CHOICE_BIT(CHOICE_ERROR), OF_ERROR},
                    [CHOICE_DEARER] = {CHOICE_BIT(CHOICE_LOAD), OF_CYCLES},
                    [CHOICE_LARGER] = {MEMORY, OF_FLASH},
                    [CHOICE_ANY] = {CHOICE_BIT(CHOICE_LOAD) | MEMORY, OF_CYCLES}};

static double figure_of(const table *made, const choice_row *row, int kind) {
    const table_row *of = &made->row[row->row];
    return kinds[kind].least == OF_CYCLES  ? row->worst
           : kinds[kind].least == OF_FLASH ? of->cost.flash_bytes.value
                                           : of->result.error;
}

/* If rows have equal figures, the cheapest row wins, because made->row is sorted by price. */
choice choice_make(const trials *t, const table *made, const choice_request *w) {
    choice c;
    for (int i = 0; i < CHOICES; i++) {
        c.of[i] = (choice_row){.row = -1};
    }
    for (int i = 0; i < made->count; i++) {
        const choice_row row = judged(t, w, made, i);
        for (int k = 0; k < CHOICES; k++) {
            const double figure = figure_of(made, &row, k);
            const bool known = kinds[k].least != OF_FLASH || figure > 0.0;
            if ((row.fails & ~kinds[k].ignores) == 0 && known &&
                (c.of[k].row < 0 || figure < figure_of(made, &c.of[k], k))) {
                c.of[k] = row;
            }
        }
    }
    return c;
}

/* --- counting --------------------------------------------------------------------------------------*/

#define RUN_INSTRUCTIONS 1e9 /* most operations of a counted run: limits the emulator's time */
/* Assumed cost of an evaluation in an uncounted number type: low, so that choice_make() tries the type. */
#define UNTRIED 1e-3

/* Predicts the cost of uncounted rows from each[number type], the cost of an evaluation. */
static void expect(const trials *t, table *made, const table_row *last,
                   double each[SETTING_NUMBERS]) {
    if (last != NULL && last->result.evaluations_most > 0.0) {
        each[setting_number(&last->setting)] =
            worst_of(&last->cost)->value / last->result.evaluations_most;
    }
    const bool cycles = t->request.board->cycles != COST_RANGE;
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

static void drop_long(const trials *t, table *made) {
    int kept = 0;
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        const double each = (double)t->image[0]->list[IMAGE_STEP]->count;
        const double evaluations = row->result.evaluations * trial_horizon_s(t) * t->points;
        if (evaluations * each <= RUN_INSTRUCTIONS) {
            made->row[kept++] = *row;
        } else {
            made->why = "the run has too many steps for a count: use a shorter --horizon";
        }
    }
    made->unpriced += kept < made->count;
    made->count = kept;
}

/* A row of the choice that was not counted, or -1. */
static int uncounted(const table *made, const choice *c) {
    const bool found = c->of[CHOICE_FASTEST].row >= 0;
    for (int i = found ? 0 : CHOICE_WEAKER; i < (found ? CHOICE_WEAKER : CHOICES); i++) {
        const int row = c->of[i].row;
        if (row >= 0 && !made->row[row].counted) {
            return row;
        }
    }
    return -1;
}

measured_end choice_counted(trials *t, table *made, const choice_request *w, choice *c) {
    const bool runs = t->image[0]->contacts > 0;
    double each[SETTING_NUMBERS] = {0};
    if (runs) {
        drop_long(t, made);
        expect(t, made, NULL, each);
    }
    *c = choice_make(t, made, w);
    int counts = 0;
    for (int i = uncounted(made, c); i >= 0 && !t->stopped; i = uncounted(made, c)) {
        if (w->table.shows) {
            fprintf(stderr, "\rcounting on the board: %d so far ", counts++);
        }
        const table_row before = made->row[i];
        if (measured_count(t, made, i) == MEASURED_MISSING) {
            return MEASURED_MISSING;
        }
        for (int k = 0; k < made->count && runs; k++) {
            const table_row *row = &made->row[k];
            if (row->counted && setting_order(&row->setting) == setting_order(&before.setting) &&
                row->pace.steps == before.pace.steps && row->pace.records == before.pace.records) {
                expect(t, made, row, each);
            }
        }
        t->stopped = t->stopped || interrupted;
        *c = choice_make(t, made, w);
    }
    return MEASURED_COUNTED;
}

/* --- for people ------------------------------------------------------------------------------------*/

enum { AMOUNT = 64 }; /* room for an error in words: "0.001 of the largest value" */
static const char *amount(const trials *t, double error, char text[AMOUNT]) {
    const bool part = t->what.column < 0;
    snprintf(text, AMOUNT, "%.3g %s", error, part ? "of the largest value" : trial_unit(t));
    return text;
}

static void print_options(FILE *out, const trials *t, const table_row *row) {
    char options[SETTING_TEXT];
    char step[NUMBER_SIZE];
    fprintf(out, "%s --step %s\n", setting_options(&row->setting, true, options) + 1,
            trial_step_text(t, row->pace, step));
}

static void print_figure(FILE *out, const char *name, const cost_figure *f, const char *unit) {
    char words[FIGURE_WORDS];
    fprintf(out, "  %-12s", name);
    if (f->basis == COST_NOT_KNOWN) {
        fprintf(out, "%s\n", cost_basis_words[f->basis]);
    } else if (f->basis == COST_RANGE) {
        fprintf(out, "%.3g to %.3g %s, %s\n", f->least, f->most, unit, figure_words(f, words));
    } else {
        fprintf(out, "%.0f %s, %s\n", f->value, unit, figure_words(f, words));
    }
}

/* The declared bound on the cycles or instructions of a step; 0: unknown. */
static double declared_of(const table_row *row) {
    return cost_has_cycles(&row->cost) ? row->run.cycles_bound : row->run.instructions_bound;
}

static void print_load(FILE *out, const choice_request *w, const table_row *row,
                       const choice_row *by) {
    const cost_figure *f = &row->cost.cycles_worst;
    if (!(w->clock_Hz > 0.0) || (by->unknown & CHOICE_BIT(CHOICE_LOAD)) != 0) {
        fputs(w->clock_Hz > 0.0 ? "  load        unknown, because the cycles of the longest step "
                                  "are unknown\n"
                                : "  load        not computed: add --clock 16e6\n",
              out);
        return;
    }
    if (f->basis == COST_RANGE) {
        fprintf(out, "  load        %.2g to %.2g %%", 100.0 * by->load_most * f->least / f->most,
                100.0 * by->load_most);
    } else {
        fprintf(out, "  load        %.3g %%, at most %.3g %%,", 100.0 * by->load,
                100.0 * by->load_most);
    }
    if (w->table.rate_Hz > 0.0) {
        fprintf(out, " of a period of %.6g s (%.6g Hz)", 1.0 / w->table.rate_Hz, w->table.rate_Hz);
    } else {
        fputs(" of real time", out);
    }
    fprintf(out, " at %.6g MHz, from the longest", 1e-6 * w->clock_Hz);
    if (row->run.steps > 0.0) {
        fprintf(out, " of %.0f counted steps", row->run.steps);
    } else {
        fputs(" step", out);
    }
    if (declared_of(row) > 0.0) {
        fprintf(out, "; %.3g %% with the bound",
                100.0 * by->load_most * declared_of(row) /
                    (cost_has_cycles(&row->cost) ? f->most : row->cost.instructions_worst.most));
    }
    fputc('\n', out);
}

static void print_run(FILE *out, const table_row *row) {
    if (!(row->run.steps > 0.0)) {
        return;
    }
    fprintf(out, "  counted     %.0f steps: all steps of the run to the horizon, with events\n",
            row->run.steps);
    if (declared_of(row) > 0.0) {
        fprintf(
            out,
            "  bound       at most %.0f %s in a step with eight of the most expensive events (docs/dev/events.md)\n",
            declared_of(row), cost_has_cycles(&row->cost) ? "cycles" : "instructions");
    } else {
        fputs("  bound       not known: this board does not count the parts of a step separately\n",
              out);
    }
}

static void print_answer(FILE *out, const trials *t, const choice_request *w, const table *made,
                         const choice_row *by, const char *head) {
    char text[AMOUNT];
    char name[TRIAL_NAME];
    const table_row *row = &made->row[by->row];
    const cost *c = &row->cost;
    const bool cycles = cost_has_cycles(c);
    const char *unit = cycles ? "cycles" : "instructions";
    const char *at = trial_place(t, row->result.point);
    const uint64_t substeps = table_substeps(&w->table, row);
    fputs(head, out);
    print_options(out, t, row);
    fprintf(out, "  error       %s%s, measured", row->result.bound ? "at most " : "",
            amount(t, row->result.error, text));
    if (t->what.column < 0) {
        fprintf(out, " (%s)", trial_column(t, row->result.column, name));
    }
    if (t->points > 1) {
        fprintf(out, ", the worst of %d combinations: with%s", t->points,
                at[0] != '\0' ? at : " the scene's own values");
    }
    fprintf(out, "; %s is allowed\n", amount(t, w->table.error, text));
    if (substeps > 0) {
        fprintf(out, "  a period    %llu steps\n", (unsigned long long)substeps);
    }
    print_figure(out, "a step", cycles ? &c->cycles : &c->instructions, unit);
    print_figure(out, "the longest", cycles ? &c->cycles_worst : &c->instructions_worst, unit);
    print_run(out, row);
    if (!cycles) {
        print_figure(out, "in cycles", &c->cycles_worst, "cycles");
    }
    print_load(out, w, row, by);
    print_figure(out, "flash", &c->flash_bytes, "bytes");
    print_figure(out, "RAM", &c->ram_bytes, "bytes without the stack");
    print_figure(out, "stack", &c->stack_bytes, "bytes");
    if (c->state_bytes.basis != COST_NOT_KNOWN) {
        print_figure(out, "state", &c->state_bytes, "bytes of the RAM");
    }
    for (int i = CHOICE_FLASH; i < CHOICE_LIMITS; i++) {
        if ((by->unknown & CHOICE_BIT(i)) != 0) {
            fprintf(out,
                    "  the %s of a row is unknown, so its limit was not tested: add --measure\n",
                    i == CHOICE_FLASH ? "flash" : "RAM");
        }
    }
    char *run = table_run_line(t, &row->setting, row->pace, row->result.point);
    char *derive = table_derive_line(t, &row->setting, row->pace);
    char *measure = table_measure_line(t, &row->setting, row->pace, row->result.point);
    fprintf(out, "  to run      %s\n  to print C  %s\n  to count    %s\n", run, derive, measure);
    free(measure);
    free(run);
    free(derive);
}

/* Rounds upwards, to two significant digits. */
static double no_less(double value) {
    double unit = 1.0;
    while (value / unit >= 100.0) {
        unit *= 10.0;
    }
    while (value > 0.0 && value / unit < 10.0) {
        unit /= 10.0;
    }
    return number_ceiling(value / unit * (1.0 - 1e-12)) * unit;
}

static void print_remedy(FILE *out, const trials *t, const table *made, const choice_request *w,
                         const choice_row *by) {
    char text[AMOUNT];
    const table_row *row = &made->row[by->row];
    const cost *c = &row->cost;
    if ((by->fails & CHOICE_BIT(CHOICE_ERROR)) != 0) {
        fprintf(out,
                "  an error of %s: ", amount(t, no_less(TABLE_MARGIN * row->result.error), text));
    }
    if ((by->fails & CHOICE_BIT(CHOICE_LOAD)) != 0) {
        fprintf(out, "  a clock of %.3g MHz: ", no_less(1e-6 * w->clock_Hz * by->load_most));
    }
    if ((by->fails & MEMORY) != 0) {
        fprintf(out, "  %.0f bytes of flash and %.0f of RAM with the stack: ",
                number_ceiling(c->flash_bytes.most),
                number_ceiling(c->ram_bytes.most + c->stack_bytes.most));
    }
    print_options(out, t, row);
}

static void print_remedies(FILE *out, const trials *t, const table *made, const choice_request *w,
                           const choice *c) {
    bool none = true;
    fputs("\nwhat would fit\n", out);
    for (int i = CHOICE_WEAKER; i < CHOICES; i++) {
        /* CHOICE_ANY raises clock and memory: print it only if raising one of them is not enough */
        const bool alone = c->of[CHOICE_DEARER].row < 0 && c->of[CHOICE_LARGER].row < 0;
        if (c->of[i].row >= 0 && (i != CHOICE_ANY || alone)) {
            print_remedy(out, t, made, w, &c->of[i]);
            none = false;
        }
    }
    fputs(none ? "  no tried setting\n" : "", out);
}

void choice_print(FILE *out, const trials *t, const table *made, const choice_request *w,
                  const choice *c) {
    const int fastest = c->of[CHOICE_FASTEST].row;
    const int smallest = c->of[CHOICE_SMALLEST].row;
    fprintf(out, "%s on %s (%s)\n", t->image[0]->name, t->request.board->name,
            t->request.board->core);
    figure_reference(out, t);
    fprintf(out, "  prices      %s\n\n", w->prices);
    if (fastest >= 0) {
        print_answer(out, t, w, made, &c->of[CHOICE_FASTEST], "fewest cycles  ");
        fputc('\n', out);
        if (smallest < 0 || smallest == fastest) {
            fprintf(out, "least flash    %s\n", smallest < 0 ? "not known" : "the same");
        } else {
            print_answer(out, t, w, made, &c->of[CHOICE_SMALLEST], "least flash    ");
        }
    } else if (made->broken_off + made->unpriced == 0) {
        fprintf(out, "no setting fits: all %d settings were tried\n", made->settings);
    } else {
        fprintf(out, "no setting fits among the tried steps%s\n",
                made->broken_off > 0 ? ": raise --effort" : "");
    }
    if (fastest < 0 && made->count > 0) {
        print_remedies(out, t, made, w, c);
    }
    fputc('\n', out);
    table_print_left(out, made);
}

void choice_json(FILE *out, const trials *t, const table *made, const choice_request *w,
                 const choice *c, int status) {
    json j = {.out = out};
    table_json_begin(&j, "choose", t);
    json_number(&j, "allowed", w->table.error);
    json_text(&j, "prices", w->prices);
    json_open(&j, "answers", '[');
    for (int i = CHOICE_FASTEST; i <= CHOICE_SMALLEST; i++) {
        const choice_row *of = &c->of[i];
        if (of->row >= 0) {
            json_open(&j, NULL, '{');
            json_text(&j, "least", i == CHOICE_FASTEST ? "cycles" : "flash");
            json_number(&j, "load_most", of->load_most > 0.0 ? of->load_most : (double)NAN);
            table_json_row(&j, t, &made->row[of->row]);
            json_close(&j, '}');
        }
    }
    json_close(&j, ']');
    json_whole(&j, "exit", status);
    json_close(&j, '}');
}
