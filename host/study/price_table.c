#include "host/study/price_table.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/check/run_json.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"
#include "host/os/jobs.h"
#include "host/os/system.h"

/* === the table ================================================================================ */

/* climb() ends after PATIENCE successive trials with an error above FALLS * (least error so far). */
#define FALLS 0.7
enum { PATIENCE = 2, COARSEST = 5, LADDER = COARSEST + 3 * 8, SUBSTEPS = 10 + 9 * 5 };

const char *const table_unit_words[] = {[PRICE_CYCLES] = "cycles",
                                        [PRICE_INSTRUCTIONS] = "instructions",
                                        [PRICE_EVALUATIONS] = "evaluations"};

uint64_t table_decade(int i) {
    static const uint64_t mantissa[] = {1, 2, 5};
    uint64_t many = mantissa[i % 3];
    for (; i >= 3; i -= 3) {
        many *= 10;
    }
    return many;
}

bool table_pace(const table_request *w, int rung, deviation_pace *pace) {
    static const uint64_t tens[] = {12, 15, 20, 25, 30, 40, 50, 60, 80};
    if (w->rate_Hz > 0.0) {
        uint64_t many = rung < 10 ? (uint64_t)rung + 1 : tens[(rung - 10) % 9];
        for (int i = rung; i >= 19; i -= 9) {
            many *= 10;
        }
        *pace = (deviation_pace){w->periods * many, 1};
        return rung < SUBSTEPS;
    }
    *pace = rung < COARSEST ? (deviation_pace){1, table_decade(COARSEST - rung)}
                            : (deviation_pace){table_decade(rung - COARSEST), 1};
    return rung < LADDER;
}

uint64_t table_substeps(const table_request *w, const table_row *row) {
    return w->rate_Hz > 0.0 ? row->pace.steps / w->periods : 0;
}

table_price table_price_of(const cost *c, double step_s) {
    const bool cycles = cost_has_cycles(c);
    const cost_figure *f = cycles ? &c->cycles : &c->instructions;
    return (table_price){cycles ? PRICE_CYCLES : PRICE_INSTRUCTIONS, f->basis, f->value / step_s,
                         f->least / step_s, f->most / step_s};
}

/* --- one setting -----------------------------------------------------------------------------------*/

typedef enum ending { TRIED, NOT_OWN, UNPRICED, BROKEN_OFF } ending;

typedef struct climbed {
    ending end;
    const char *why; /* the reason, if `end` is UNPRICED */
    int count;
    table_row row[SUBSTEPS];
} climbed;

/* Tries ever finer steps of a setting, with up to `each` operations in one trial. */
static void climb(trials *t, const table_request *w, const setting *s, double each, climbed *c) {
    const bool contacts = t->image[0]->contacts > 0;
    bool own = true;
    int stalled = 0;
    double before = (double)INFINITY;
    table_row row = {.setting = *s};
    for (int rung = 0; table_pace(w, rung, &row.pace) && stalled < PATIENCE && !t->stopped;
         rung++) {
        const bool slow = trial_operations(t, s, row.pace) > each;
        if (row.pace.records > (uint64_t)t->records) {
            continue;
        }
        if (slow && setting_is_fixed(s)) { /* trial_cost() would need a slow run */
            c->end = own ? BROKEN_OFF : NOT_OWN;
            return;
        }
        row.cost = trial_cost(t, s, row.pace, &own);
        row.price = table_price_of(&row.cost, ratio_times(1, trial_step(t, row.pace)));
        if (!own && setting_price_varies(s)) {
            continue;
        }
        if (!own || (row.price.basis == COST_NOT_KNOWN && !contacts)) {
            c->end = own ? UNPRICED : NOT_OWN;
            c->why = row.cost.why;
            return;
        }
        if (slow) {
            c->end = BROKEN_OFF;
            return;
        }
        row.result = trial_run(t, s, row.pace);
        if (!row.result.ran || !row.result.usable) {
            continue;
        }
        if (contacts) { /* the price is the counted evaluations per simulated second */
            const double rate = row.result.evaluations;
            row.price = (table_price){PRICE_EVALUATIONS, COST_MEASURED, rate, rate, rate};
        }
        c->row[c->count++] = row;
        if (w->error > 0.0 && row.result.error * TABLE_MARGIN <= w->error) {
            return;
        }
        stalled = row.result.error > FALLS * before ? stalled + 1 : 0;
        before = number_least(before, row.result.error);
    }
    c->end = own ? TRIED : NOT_OWN;
}

/* --- all of them -------------------------------------------------------------------------------------*/

typedef struct table_work {
    trials *trials;
    const table_request *request;
    table *made;
    setting *setting; /* [count] */
    int count;
} table_work;

/* Runs in a worker, which sends the bytes of its result to the parent. */
static bool work(void *context, uint64_t point, FILE *out, FILE *reason) {
    const table_work *w = context;
    climbed *c = alloc(1, sizeof *c);
    (void)reason;
    climb(w->trials, w->request, &w->setting[point], w->request->operations / w->count, c);
    const size_t size = offsetof(climbed, row) + (size_t)c->count * sizeof c->row[0];
    const bool good = fwrite(c, 1, size, out) == size;
    free(c);
    return good;
}

static bool deliver(void *context, uint64_t point, bool good, const char *row, const char *reason) {
    const table_work *w = context;
    table *made = w->made;
    climbed *c = alloc(1, sizeof *c);
    (void)point;
    (void)reason;
    memcpy(c, row, offsetof(climbed, row));
    made->row = alloc_more(made->row, made->count + c->count + 1, sizeof *made->row);
    memcpy(made->row + made->count, row + offsetof(climbed, row),
           (size_t)c->count * sizeof *made->row);
    made->count += c->count;
    made->settings += c->end != NOT_OWN;
    made->broken_off += c->end == BROKEN_OFF;
    made->unpriced += c->end == UNPRICED;
    made->why = c->end == UNPRICED ? c->why : made->why;
    free(c);
    return good;
}

static bool tell_progress(void *context, uint64_t next) {
    const table_work *w = context;
    if (w->request->shows) {
        fprintf(stderr, "\r%3d of %d settings ", (int)next, w->count);
    }
    return true;
}

table *table_new(trials *t, const table_request *w) {
    table *made = alloc(1, sizeof *made);
    table_work all = {t, w, made, alloc(setting_count(), sizeof(setting)), 0};
    made->why = "";
    made->operations = w->operations;
    for (int i = 0; i < setting_count(); i++) {
        const setting s = setting_at(i);
        if (setting_is_asked(&s, w->method)) {
            all.setting[all.count++] = s;
        }
    }
    const jobs j = {.workers = w->workers,
                    .end = (uint64_t)all.count,
                    .context = &all,
                    .work = work,
                    .deliver = deliver,
                    .pause = tell_progress};
    t->stopped = jobs_run(&j) != JOBS_DONE || t->stopped;
    free(all.setting);
    table_sort(made);
    return made;
}

static int by_price(const void *left, const void *right) {
    const table_row *a = left;
    const table_row *b = right;
    if (a->price.value != b->price.value) {
        return a->price.value < b->price.value ? -1 : 1;
    }
    if (a->result.error != b->result.error) {
        return a->result.error < b->result.error ? -1 : 1;
    }
    const int words = setting_order(&a->setting) - setting_order(&b->setting);
    return words != 0 ? words : (int)a->pace.steps - (int)b->pace.steps;
}

void table_sort(table *made) {
    double best = (double)INFINITY;
    if (made->count > 0) {
        qsort(made->row, (size_t)made->count, sizeof *made->row, by_price);
    }
    for (int i = 0; i < made->count; i++) {
        made->row[i].on_front = made->row[i].result.error < best;
        best = number_least(best, made->row[i].result.error);
    }
}

void table_free(table *made) {
    if (made != NULL) {
        free(made->row);
        free(made);
    }
}

/* === text ===================================================================================== */

/* --- figures ---------------------------------------------------------------------------------------*/

enum { FIGURE_TEXT = 64 };

static const char letters[] = "-xpmesr";
static_assert(sizeof letters == COST_BASES + 1, "one each");

static const char *figure_text(const cost_figure *f, char text[FIGURE_TEXT]) {
    if (f->basis == COST_NOT_KNOWN) {
        snprintf(text, FIGURE_TEXT, "-");
    } else if (f->basis == COST_RANGE) {
        snprintf(text, FIGURE_TEXT, "%.3g to %.3g r", f->least, f->most);
    } else {
        snprintf(text, FIGURE_TEXT, "%.0f %c", f->value, letters[f->basis]);
    }
    return text;
}

const char *figure_words(const cost_figure *f, char text[FIGURE_WORDS]) {
    const char *word = cost_basis_words[f->basis];
    if (f->basis == COST_PREDICTED && f->least > 0.0) {
        snprintf(text, FIGURE_WORDS, "%s: within %.0f %% in nine of ten counted cases", word,
                 100.0 * (number_root(f->most / f->least) - 1.0));
    } else {
        snprintf(text, FIGURE_WORDS, "%s", word);
    }
    return text;
}

static void figure_legend(FILE *out, const cost *c) {
    static const char *const says[COST_BASES] = {
#define COST_BASIS_SAYS(id, word, says) says,
        COST_BASIS_ROWS(COST_BASIS_SAYS)
#undef COST_BASIS_SAYS
    };
    const cost_figure *const figures[] = {&c->instructions, &c->instructions_worst, &c->cycles,
                                          &c->cycles_worst, &c->flash_bytes,        &c->ram_bytes,
                                          &c->stack_bytes,  &c->state_bytes};
    for (int basis = COST_EXACT; basis < COST_BASES; basis++) {
        bool there = false;
        for (size_t i = 0; i < sizeof figures / sizeof figures[0]; i++) {
            there = there || (int)figures[i]->basis == basis;
        }
        if (there) {
            fprintf(out, "  %c  %s: %s\n", letters[basis], cost_basis_words[basis], says[basis]);
        }
    }
}

/* Is this column a coordinate or rate that is only round-off at every point? */
static bool is_missing(const trials *t, int column) {
    bool counts = t->what.column >= 0 || t->reference[0]->shape->column[column].unknown < 0;
    for (int p = 0; p < t->points; p++) {
        counts = counts || t->reference[p]->column[column].counts;
    }
    return !counts;
}

static void say_missing(FILE *out, const trials *t) {
    bool first = true;
    for (int k = 1; k < t->reference[0]->columns; k++) {
        char name[TRIAL_NAME];
        if (is_missing(t, k)) {
            fprintf(out, "%s%s",
                    first ? "  left out    these are zero except for round-off: " : ", ",
                    trial_column(t, k, name));
            first = false;
        }
    }
    fputs(first ? "" : "\n", out);
}

void figure_reference(FILE *out, const trials *t) {
    const reference *r = t->reference[t->worst];
    fprintf(out, "  reference   %s\n", r->how);
    if (!r->reliable) {
        const char *where = trial_place(t, t->worst);
        fprintf(out, "              no reliable reference%s%s: %s\n",
                where[0] != '\0' ? ", with" : "", where, r->why);
        return;
    }
    char name[TRIAL_NAME];
    const int of = t->what.column;
    fprintf(out, "              both references agree within %.1e of %s%s\n",
            reference_agreement(r, of),
            of < 0 ? "the largest value of each coordinate and rate" : "the largest value of ",
            of < 0 ? "" : trial_column(t, of, name));
    fprintf(out, "  horizon     %.9g s", trial_horizon_s(t));
    if (t->records < t->request.records) {
        fprintf(out, " of %.9g s: %s\n",
                ratio_times((uint64_t)t->request.records, t->request.spacing),
                r->why != NULL ? r->why : "the reference ends");
    } else {
        fprintf(out, ", %d records\n", t->records);
    }
    say_missing(out, t);
    if (t->still != NULL) {
        fprintf(out, "  left out    combinations in which nothing moves:%.*s\n",
                (int)strlen(t->still) - 1, t->still);
    }
}

/* --- lines and rows --------------------------------------------------------------------------------*/

static char *line_of(const trials *t, const setting *s, deviation_pace pace, int point, bool run) {
    char options[SETTING_TEXT];
    char step[NUMBER_SIZE];
    char until[NUMBER_SIZE];
    return alloc_words("whirl %s %s%s%s%s%s --step %s --until %s%s", run ? "run" : "derive",
                       t->request.target, t->request.changes, run ? trial_place(t, point) : "",
                       setting_options(s, run, options), run ? "" : setting_form(s),
                       trial_step_text(t, pace, step), trial_until(t, until), run ? "" : " --as c");
}

char *table_run_line(const trials *t, const setting *s, deviation_pace pace, int point) {
    return line_of(t, s, pace, point, true);
}

char *table_derive_line(const trials *t, const setting *s, deviation_pace pace) {
    return line_of(t, s, pace, 0, false);
}

char *table_measure_line(const trials *t, const setting *s, deviation_pace pace, int point) {
    char options[SETTING_TEXT];
    char step[NUMBER_SIZE];
    char until[NUMBER_SIZE];
    const bool runs = t->image[0]->contacts > 0;
    /* fixed point needs a run to find the ranges of quantities */
    const bool ranged = runs || setting_is_fixed(s);
    return alloc_words("sh mk/price/measure_one.sh%s %s %s %s%s%s%s --step %s%s%s",
                       runs ? " --whole-run" : "", t->request.board->name, s->number->name,
                       t->request.target, t->request.changes, trial_place(t, point),
                       setting_options(s, false, options), trial_step_text(t, pace, step),
                       ranged ? " --until " : "", ranged ? trial_until(t, until) : "");
}

static void print_row(FILE *out, const trials *t, const table_row *row) {
    char text[FIGURE_TEXT];
    char options[SETTING_TEXT];
    char step[NUMBER_SIZE];
    char error[24];
    char price[24];
    const cost *c = &row->cost;
    snprintf(error, sizeof error, "%s%.2e", row->result.bound ? "<" : "", row->result.error);
    snprintf(price, sizeof price, "%.3g %c", row->price.value, letters[row->price.basis]);
    fprintf(out, "%s %9s  %10s", row->on_front ? "*" : " ", error, price);
    fprintf(out, "  %8s", figure_text(&c->flash_bytes, text));
    fprintf(out, "  %7s", figure_text(&c->ram_bytes, text));
    fprintf(out, "  %7s", figure_text(&c->stack_bytes, text));
    fprintf(out, "  %6s ", figure_text(&c->state_bytes, text));
    fprintf(out, "%s --step %s\n", setting_options(&row->setting, true, options),
            trial_step_text(t, row->pace, step));
}

const char *const table_heads[] = {[PRICE_CYCLES] = "cycles/s",
                                   [PRICE_INSTRUCTIONS] = "instr./s",
                                   [PRICE_EVALUATIONS] = "eval./s"};

/* Marks a row of the front if its error is at most 1/factor of the last marked row's. Returns the number of marks. */
static int shown(const table *made, double factor, bool *show) {
    double before = 0.0;
    int count = 0;
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        show[i] = row->on_front && (count == 0 || row->result.error * factor <= before);
        before = show[i] ? row->result.error : before;
        count += show[i];
    }
    return count;
}

static void print_rows(FILE *out, const trials *t, const table *made, bool all) {
    char heading[40] = "error";
    bool *show = alloc(made->count, sizeof *show);
    const int front = shown(made, 1.0, show);
    int rows = front;
    double factor = 1.1;
    while (rows > TABLE_ROWS) {
        rows = shown(made, factor, show);
        factor *= 1.1;
    }
    if (trial_unit(t)[0] != '\0') {
        snprintf(heading, sizeof heading, "error, %s", trial_unit(t));
    }
    fprintf(out, "\n  %9s  %10s  %8s  %7s  %7s  %6s   settings\n", heading,
            table_heads[made->row[0].price.unit], "flash, B", "RAM, B", "stack, B", "state");
    for (int i = 0; i < made->count; i++) {
        if (all || show[i]) {
            print_row(out, t, &made->row[i]);
        }
    }
    free(show);
    fprintf(out,
            "\n%d rows; no other row beats the %d rows marked * (the front) in both error and cost",
            made->count, front);
    if (!all) {
        fprintf(out, "; %d are shown, --all shows all", rows);
    }
    fputc('\n', out);
}

void table_print_left(FILE *out, const table *made) {
    fprintf(out, "%d settings", made->settings);
    if (made->broken_off > 0) {
        fprintf(
            out,
            "; for %d settings, finer steps need more than one setting's share of --effort %.3g",
            made->broken_off, made->operations);
    }
    if (made->unpriced > 0) {
        fprintf(out, "; %d without a price: %s", made->unpriced, made->why);
    }
    fputc('\n', out);
}

/* Explains the letters. This comes before the table, in which "m" could be read as metre. */
static void print_letters(FILE *out, const table_row *first) {
    fputs("\nletters after figures: the source of each figure\n", out);
    figure_legend(out, &first->cost);
    if (first->price.unit == PRICE_EVALUATIONS) {
        fputs(
            "  m  measured: evaluations of the accelerations per simulated second, counted in the "
            "run\n"
            "  -  not known: the cost of contacts depends on the motion\n",
            out);
    }
}

static void print_notes(FILE *out, const trials *t, const table *made) {
    char text[FIGURE_WORDS];
    const table_row *first = &made->row[0];
    const char *board = t->request.board->name;
    const bool contacts = first->price.unit == PRICE_EVALUATIONS;
    table_print_left(out, made);
    if (contacts && strcmp(board, "host") != 0) {
        fprintf(
            out,
            "run this in the root of Whirl's source tree to count cycles, flash and RAM with the "
            "emulator:\n  whirl choose %s%s --error 1e-3 --board %s\n",
            t->request.target, t->request.changes, board);
    } else if (!contacts) {
        fprintf(out, "  %s per simulated second: %s\n", table_unit_words[first->price.unit],
                figure_words(first->price.unit == PRICE_CYCLES ? &first->cost.cycles
                                                               : &first->cost.instructions,
                             text));
    }
    int last = made->count - 1;
    while (last > 0 && !made->row[last].on_front) {
        last--;
    }
    const table_row *row = &made->row[last];
    char *run = table_run_line(t, &row->setting, row->pace, row->result.point);
    char *derive = table_derive_line(t, &row->setting, row->pace);
    fprintf(out, "commands that run the last row of the front and print its code:\n  %s\n  %s\n",
            run, derive);
    free(run);
    free(derive);
}

void table_print(FILE *out, const trials *t, const table *made, bool all) {
    const image *im = t->image[0];
    char name[TRIAL_NAME];
    fprintf(out, "%s on %s (%s)\n", im->name, t->request.board->name, t->request.board->core);
    if (t->what.column < 0) {
        fputs(
            "  error       measured: the largest deviation from the reference, divided by the "
            "largest\n              value of the coordinate or rate; the worst coordinate or rate "
            "counts\n",
            out);
    } else {
        fprintf(out,
                "  error       measured: the largest deviation of %s from the reference over all "
                "records\n",
                trial_column(t, t->what.column, name));
    }
    if (t->points > 1) {
        fprintf(out, "              the worst of %d combinations of the varied values\n",
                t->points);
    }
    figure_reference(out, t);
    if (t->reliable && made != NULL && made->count > 0) {
        print_letters(out, &made->row[0]);
        print_rows(out, t, made, all);
        print_notes(out, t, made);
    } else if (t->reliable && made != NULL && made->unpriced + made->broken_off > 0) {
        fputs("the table is empty: ", out);
        table_print_left(out, made);
    } else if (t->reliable) {
        fputs("no setting follows the motion: every error is larger than the values themselves\n",
              out);
    } else {
        fputs("no table: without a reliable reference the errors are unknown\n", out);
    }
}

/* --- for programs ------------------------------------------------------------------------------------*/

/* Writes a row into a JSON object, or as a line of CSV if json is NULL. is_head: the line has names, not values. */
typedef struct row_sink {
    FILE *csv;
    json *json;
    bool is_head;
    bool begun;
} row_sink;

static void put(row_sink *s, const char *name, const char *text, bool is_number) {
    if (s->json == NULL) {
        fputs(s->begun ? "," : "", s->csv);
        atomic_file_field(s->csv, s->is_head ? name : text);
        s->begun = true;
    } else if (is_number) {
        json_number(s->json, name, text[0] != '\0' ? decimal_read(text, NULL) : (double)NAN);
    } else {
        json_text(s->json, name, text);
    }
}

static void put_words(row_sink *s, const char *name, const char *text) {
    put(s, name, text, false);
}

static void put_number(row_sink *s, const char *name, int digits, double value) {
    char text[FIGURE_TEXT];
    snprintf(text, sizeof text, "%.*g", digits, value);
    put(s, name, text, true);
}

static void put_figure(row_sink *s, const char *name, const char *basis, const cost_figure *f) {
    if (f->basis == COST_NOT_KNOWN) {
        put(s, name, "", true);
    } else {
        put_number(s, name, 17, f->value);
    }
    put_words(s, basis, cost_basis_words[f->basis]);
}

static void put_row(row_sink *s, const trials *t, const table_row *row) {
    char text[TRIAL_NAME];
    put_number(s, "front", 9, row->on_front ? 1.0 : 0.0);
    put_number(s, "error", 9, row->result.error);
    put_words(s, "error_unit", trial_unit(t));
    put_words(s, "error_basis", "measured");
    put_number(s, "error_bound", 9, row->result.bound ? 1.0 : 0.0);
    put_words(s, "component", trial_column(t, row->result.column, text));
    put_number(s, "price_per_s", 9, row->price.value);
    put_words(s, "price_of", table_unit_words[row->price.unit]);
    put_words(s, "price_basis", cost_basis_words[row->price.basis]);
    put_number(s, "price_least", 9, row->price.least);
    put_number(s, "price_most", 9, row->price.most);
    put(s, "step_s", trial_step_text(t, row->pace, text), true);
    for (int axis = 0; axis < AXES; axis++) {
        put_words(s, setting_heading((setting_axis)axis),
                  setting_word(&row->setting, (setting_axis)axis));
    }
    put_figure(s, "flash_bytes", "flash_basis", &row->cost.flash_bytes);
    put_figure(s, "ram_bytes", "ram_basis", &row->cost.ram_bytes);
    put_figure(s, "stack_bytes", "stack_basis", &row->cost.stack_bytes);
    put_figure(s, "state_bytes", "state_basis", &row->cost.state_bytes);
    char *run = table_run_line(t, &row->setting, row->pace, row->result.point);
    char *derive = table_derive_line(t, &row->setting, row->pace);
    put_words(s, "run", run);
    put_words(s, "derive", derive);
    free(run);
    free(derive);
}

void table_csv(FILE *out, const trials *t, const table *made) {
    for (int i = made->count > 0 ? -1 : 0; i < made->count; i++) {
        row_sink s = {.csv = out, .is_head = i < 0};
        put_row(&s, t, &made->row[i < 0 ? 0 : i]);
        fputs("\r\n", out);
    }
}

void table_json_begin(json *j, const char *command, const trials *t) {
    const image *im = t->image[0];
    json_begin(j, command, im->name, im->title, NULL, im->settings.method);
    json_text(j, "board", t->request.board->name);
    json_text(j, "reference", t->reference[t->worst]->how);
    json_number(j, "horizon_s", t->reliable ? trial_horizon_s(t) : (double)NAN);
    json_whole(j, "places", t->points);
    json_open(j, "left_out", '[');
    for (int k = 1; k < t->reference[0]->columns; k++) {
        char name[TRIAL_NAME];
        if (t->reliable && is_missing(t, k)) {
            json_text(j, NULL, trial_column(t, k, name));
        }
    }
    json_close(j, ']');
}

void table_json_row(json *j, const trials *t, const table_row *row) {
    row_sink s = {.json = j};
    put_row(&s, t, row);
}

void table_json(FILE *out, const trials *t, const table *made, int status) {
    json j = {.out = out};
    table_json_begin(&j, "price", t);
    json_open(&j, "rows", '[');
    for (int i = 0; made != NULL && i < made->count; i++) {
        json_open(&j, NULL, '{');
        table_json_row(&j, t, &made->row[i]);
        json_close(&j, '}');
    }
    json_close(&j, ']');
    json_whole(&j, "exit", status);
    json_close(&j, '}');
}

/* === counted prices =========================================================================== */

#define COUNTS "mk/price/measure_one.sh"
#define STATUS_MISSING 2 /* exit status of measure_one.sh: wrong arguments or a missing tool */

/* Reads the first line that contains `with`, or the last line if no line does. Returns the exit status, or -1. */
static int line_from(const char *command, const char *with, char *line, int size) {
    FILE *from = system_read_from(command);
    if (from == NULL) {
        return -1;
    }
    char next[1024];
    bool found = false;
    while (fgets(next, sizeof next, from) != NULL) {
        next[strcspn(next, "\r\n")] = '\0';
        if (!found) {
            snprintf(line, (size_t)size, "%s", next);
            found = with != NULL && strstr(next, with) != NULL;
        }
    }
    return system_end(from);
}

/* --- can it be counted? --------------------------------------------------------------------------------*/

static bool is_host(const cost_board *board) { return strcmp(board->name, "host") == 0; }

const char *measured_missing(const trials *t, const cost_board *board, char text[MEASURED_TEXT]) {
    if (t != NULL && t->image[0]->contacts > 0 && is_host(board)) {
        return "the instructions of a run with contacts are counted only in emulators";
    }
    if (access(COUNTS, R_OK) != 0) {
        return "whirl can count in an emulator only in the root of its source tree";
    }
    char *command = is_host(board)
                        ? alloc_words("make -s price-ready-host 2>&1")
                        : alloc_words("make -s BOARD=%s price-ready-board 2>&1", board->name);
    snprintf(text, MEASURED_TEXT, "make fails");
    const int status = line_from(command, " is missing", text, MEASURED_TEXT);
    const char *quoted = strchr(text, '\''); /* the name of a missing tool */
    free(command);
    return status == 0 ? NULL : quoted != NULL ? quoted : text;
}

/* --- counting --------------------------------------------------------------------------------------------*/

/* The columns of count_run.sh's row. */
enum { RUN_STEPS = 2, RUN_BOUND = 5, RUN_CYCLES_BOUND = 8, RUN_COLUMNS = 13 };
static const cost_layout run_layout = {RUN_COLUMNS, 0, 3, 4, 6, 7};

/* The larger of the bounds at two points. The result is 0 (unknown) if one of them is 0. */
static double bound_of(double a, double b) { return a > 0.0 && b > 0.0 ? number_most(a, b) : 0.0; }

/* Enters a row of count_run.sh into *run. The row has the counts of a whole run at one point. */
static void enter_run(char *const *column, bool first, counted_run *run) {
    const double instructions = decimal_read(column[RUN_BOUND], NULL);
    const double cycles = decimal_read(column[RUN_CYCLES_BOUND], NULL);
    run->steps += decimal_read(column[RUN_STEPS], NULL);
    run->instructions_bound =
        first ? instructions : bound_of(run->instructions_bound, instructions);
    run->cycles_bound = first ? cycles : bound_of(run->cycles_bound, cycles);
}

/* Counts the cost of a step, at the point with the worst error. With contacts, it counts the run of every point. */
static int count(const trials *t, table_row *row) {
    const bool runs = t->image[0]->contacts > 0;
    const cost_layout *layout = runs ? &run_layout : &cost_step_layout;
    char *column[COST_COLUMNS];
    char line[1024];
    int status = 0;
    row->cost = (cost){.why = "", .state_bytes = !runs ? row->cost.state_bytes : (cost_figure){0}};
    for (int p = 0; p < (runs ? t->points : 1) && status == 0; p++) {
        const int point = runs ? p : row->result.point;
        char *measure = table_measure_line(t, &row->setting, row->pace, point);
        char *command = alloc_words("%s 2>/dev/null", measure);
        line[0] = '\0';
        status = line_from(command, NULL, line, sizeof line);
        free(command);
        free(measure);
        if (status == 0 && !cost_enter(line, layout, column, t->request.board, &row->cost)) {
            status = 1;
        } else if (status == 0 && runs) {
            enter_run(column, p == 0, &row->run);
        }
    }
    return status;
}

measured_end measured_count(const trials *t, table *made, int row) {
    const bool runs = t->image[0]->contacts > 0;
    table_row counted = made->row[row];
    const int status = count(t, &counted);
    if (status == STATUS_MISSING) {
        return MEASURED_MISSING;
    }
    int kept = 0;
    /* true: the counts apply only to rows with the same step */
    const bool by_pace = runs || setting_price_varies(&counted.setting);
    const deviation_pace pace = counted.pace;
    for (int i = 0; i < made->count; i++) {
        table_row now = made->row[i];
        const bool alike =
            setting_order(&now.setting) == setting_order(&counted.setting) &&
            (!by_pace || now.pace.steps * pace.records == pace.steps * now.pace.records);
        if (alike) {
            now.cost = counted.cost;
            now.run = counted.run;
            now.counted = true;
            now.price = table_price_of(&now.cost, ratio_times(1, trial_step(t, now.pace)));
        }
        if (!alike || status == 0) {
            made->row[kept++] = now;
        }
    }
    made->count = kept;
    if (status != 0) {
        made->unpriced++;
        made->why = "the step cannot be built, linked or run on this board";
    }
    table_sort(made);
    return MEASURED_COUNTED;
}

static int uncounted(const table *made) {
    int i = 0;
    while (i < made->count && (!made->row[i].on_front || made->row[i].counted)) {
        i++;
    }
    return i;
}

measured_end measured_front(const trials *t, table *made, bool shows) {
    int i = t->image[0]->contacts > 0 ? made->count : uncounted(made);
    while (i < made->count && !interrupted) {
        if (shows) {
            fprintf(stderr, "\r%3d of %d rows ", i, made->count);
        }
        if (measured_count(t, made, i) == MEASURED_MISSING) {
            return MEASURED_MISSING;
        }
        i = uncounted(made);
    }
    return MEASURED_COUNTED;
}
