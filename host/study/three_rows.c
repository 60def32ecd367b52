/* three_rows.c: see three_rows.h. */
#include "three_rows.h"

#include "host/number/functions.h"
#include "table_text.h"

/* Steps of the run in a record's spacing, for each of so many records at most. */
enum { RECORDS_MOST = 20000, SPACING = 2 };
/* Steps that a step of the run becomes, all rows together; and the reference's two runs together. */
#define ROWS_STEPS (0.5 + 1.0 + 2.0)
#define REFERENCE_STEPS (4.0 + 2.0)

double three_rows_operations(const three_rows_wish *w, const image *im) {
    const double runs = setting_is_fixed(&w->setting) ? 2.0 : 1.0; /* one finds the ranges */
    const double each = ROWS_STEPS * runs * wh_methods[w->setting.image.method].stages +
                        REFERENCE_STEPS * wh_methods[w->method].stages;
    return (double)w->steps * each * (double)engine_evaluation(im);
}

void three_rows_make(three_rows *t, const three_rows_wish *w) {
    const uint64_t pairs = w->steps / SPACING;
    const uint64_t many = 1 + (pairs - 1) / RECORDS_MOST;
    *t = (three_rows){.setting = w->setting};
    const trial_wish wish = {
        .source = w->source,
        .board = w->board,
        .spacing = ratio_of(ratio_times(SPACING * many, w->step)),
        .records = (int)(pairs / many),
        .by = {.steps = 8 * many, .method = w->method, .order = w->order, .limit = w->limit},
        .plain = &w->plain,
        .priced_step = w->priced_step};
    t->trial.reliable = trial_begin(&t->trial, &wish) && t->trial.reliable;
    for (int i = 0; i < THREE_ROWS && t->trial.reliable && !t->trial.stopped; i++) {
        bool own;
        t->pace[i] = (deviation_pace){many << i, 1};
        t->cost[i] = trial_cost(&t->trial, &t->setting, t->pace[i], &own);
        t->result[i] = trial_run(&t->trial, &t->setting, t->pace[i]);
    }
}

void three_rows_end(three_rows *t) { trial_end(&t->trial); }

static const char *bytes_text(const cost_figure *f, char text[FIGURE_TEXT]) {
    snprintf(text, FIGURE_TEXT, f->basis == COST_NOT_KNOWN ? "-" : "%.0f", f->value);
    return text;
}

static void print_row(FILE *out, const three_rows *t, int i) {
    char text[FIGURE_TEXT];
    char name[TRIAL_NAME] = "";
    const trial_result *r = &t->result[i];
    const cost *c = &t->cost[i];
    const double step_s = ratio_times(1, trial_step(&t->trial, t->pace[i]));
    bool known;
    const table_price price = table_price_of(c, step_s, &known);
    fprintf(out, "  %-10.6g", step_s);
    if (!r->ran) {
        fprintf(out, " %9s", "-");
    } else if (!r->usable) {
        fprintf(out, " %9s", "above 1");
    } else {
        snprintf(text, sizeof text, "%s%.2e", r->bound ? "<" : "", r->error);
        fprintf(out, " %9s", text);
    }
    snprintf(text, sizeof text, known ? "%.3g" : "-", price.value);
    fprintf(out, "  %10s", text);
    fprintf(out, "  %8s", bytes_text(&c->flash_bytes, text));
    fprintf(out, "  %6s", bytes_text(&c->ram_bytes, text));
    fprintf(out, "  %8s", bytes_text(&c->stack_bytes, text));
    fprintf(out, "   %s\n", r->ran ? trial_column(&t->trial, r->column, name) : "no such step");
}

void three_rows_print(FILE *out, const three_rows *t) {
    const cost_board *board = t->trial.wish.board;
    bool known;
    const table_price price = table_price_of(&t->cost[0], 1.0, &known);
    fprintf(out, "accuracy and cost  in %s on %s (%s), until t = %.6g s; costs are %s\n",
            t->setting.number->name, board->name, board->core, trial_horizon_s(&t->trial),
            known ? cost_basis_words[price.basis] : "not known");
    fprintf(out, "  %-10s %9s  %10s  %8s  %6s  %8s   worst\n", "step, s", "error",
            table_heads[price.unit], "flash, B", "RAM, B", "stack, B");
    for (int i = 0; i < THREE_ROWS; i++) {
        print_row(out, t, i);
    }
}
