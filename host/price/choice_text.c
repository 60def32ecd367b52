/* choice_text.c: see choice_text.h. */
#include "choice_text.h"

#include <stdlib.h>

#include "figure_text.h"
#include "host/number/functions.h"

/* Does anybody count this board's cycles? Else they are a range, and a row is judged by its instructions. */
static bool is_counted(const cost *c) {
    return c->cycles.basis != COST_RANGE && c->cycles.basis != COST_NOT_KNOWN;
}

/* "0.1 m", or "0.001 of the largest value". */
enum { AMOUNT = 64 };
static const char *amount(const trials *t, double error, char text[AMOUNT]) {
    if (t->what.column < 0) {
        snprintf(text, AMOUNT, "%.3g of the largest value", error);
    } else {
        snprintf(text, AMOUNT, "%.3g %s", error, trial_unit(t));
    }
    return text;
}

static void print_options(FILE *out, const trials *t, const choice_row *row) {
    char options[SETTING_TEXT];
    char step[TRIAL_TIME];
    fprintf(out, "%s --step %s", setting_options(&row->setting, true, options) + 1,
            trial_time(trial_step(t, row->pace), step));
}

static void print_figure(FILE *out, const char *name, const cost_figure *f, const char *unit) {
    char words[FIGURE_WORDS];
    if (f->basis == COST_NOT_KNOWN) {
        fprintf(out, "  %-12s%s\n", name, cost_basis_words[f->basis]);
    } else if (f->basis == COST_RANGE) {
        fprintf(out, "  %-12s%.3g to %.3g %s, %s\n", name, f->least, f->most, unit,
                figure_words(f, words));
    } else if (f->basis == COST_PREDICTED) {
        fprintf(out, "  %-12s%.0f %s, at most %.0f: %s\n", name, f->value, unit,
                number_ceiling(f->most), figure_words(f, words));
    } else {
        fprintf(out, "  %-12s%.0f %s, %s\n", name, f->value, unit, figure_words(f, words));
    }
}

/* The most that a step is declared to take, in what the row's steps are told; 0: not known. */
static double declared_of(const choice_row *row) {
    return is_counted(&row->cost) ? row->run.cycles_bound : row->run.instructions_bound;
}

static void print_load(FILE *out, const choice_wish *w, const choice_row *row) {
    if (!(w->clock_Hz > 0.0)) {
        fputs("  load        not asked: give --clock\n", out);
        return;
    }
    if (row->unknown[CHOICE_LOAD]) {
        fputs("  load        not known: nobody knows the cycles of the longest step\n", out);
        return;
    }
    const cost_figure *f = &row->cost.cycles_worst;
    fputs("  load        ", out);
    if (f->basis == COST_RANGE) {
        fprintf(out, "%.2g to %.2g %%", 100.0 * row->load_most * f->least / f->most,
                100.0 * row->load_most);
    } else {
        fprintf(out, "%.3g %%, at most %.3g %%,", 100.0 * row->load, 100.0 * row->load_most);
    }
    if (w->rate_Hz > 0.0) {
        fprintf(out, " of a period of %.6g s (%.6g Hz)", 1.0 / w->rate_Hz, w->rate_Hz);
    } else {
        fputs(" of real time", out);
    }
    fprintf(out, " at %.6g MHz, by the longest", 1e-6 * w->clock_Hz);
    if (row->run.steps > 0.0) {
        fprintf(out, " of %.0f counted steps", row->run.steps);
    } else {
        fputs(" step", out);
    }
    if (declared_of(row) > 0.0) {
        fprintf(out, "; %.3g %% by the declared one",
                100.0 * row->load_most * declared_of(row) /
                    (is_counted(&row->cost) ? f->most : row->cost.instructions_worst.most));
    }
    fputc('\n', out);
}

/* With contacts: of how many steps these are the mean and the longest, and what none can be longer than. */
static void print_run(FILE *out, const choice_row *row) {
    if (!(row->run.steps > 0.0)) {
        return;
    }
    fprintf(out, "  of          %.0f counted steps: every one to the horizon, events included\n",
            row->run.steps);
    if (declared_of(row) > 0.0) {
        fprintf(out,
                "  declared    %.0f %s are the most that a step can take: docs/dev/events.md\n",
                declared_of(row), is_counted(&row->cost) ? "cycles" : "instructions");
    } else {
        fputs("  declared    not known: nobody counts stretches of a step on this board\n", out);
    }
}

static void print_row(FILE *out, const trials *t, const choice_wish *w, const choice_row *row) {
    char text[AMOUNT];
    char name[TRIAL_NAME];
    char step[TRIAL_TIME];
    const cost *c = &row->cost;
    const char *where = t->wish.source->name(t->wish.source->context, row->result.point);
    fprintf(out, "  error       %s%s, measured", row->result.bound ? "at most " : "",
            amount(t, row->result.error, text));
    if (t->what.column < 0) {
        fprintf(out, " (%s)", trial_column(t, row->result.column, name));
    }
    fprintf(out, "%s%s; ", where[0] != '\0' ? ", worst with" : "", where);
    fprintf(out, "%s is allowed", amount(t, w->error, text));
    if (row->result.error > 0.0) {
        fprintf(out, ", %.3g times as much", w->error / row->result.error);
    }
    fputc('\n', out);
    fprintf(out, "  step        %s s", trial_time(trial_step(t, row->pace), step));
    if (row->substeps > 0) {
        fprintf(out, ", %llu in a period", (unsigned long long)row->substeps);
    }
    fputc('\n', out);
    print_figure(out, "a step", is_counted(c) ? &c->cycles : &c->instructions,
                 is_counted(c) ? "cycles" : "instructions");
    print_figure(out, "the longest", is_counted(c) ? &c->cycles_worst : &c->instructions_worst,
                 is_counted(c) ? "cycles" : "instructions");
    print_run(out, row);
    if (!is_counted(c)) {
        print_figure(out, "in cycles", &c->cycles_worst, "cycles");
    }
    print_load(out, w, row);
    print_figure(out, "flash", &c->flash_bytes, "bytes");
    print_figure(out, "RAM", &c->ram_bytes, "bytes without the stack");
    print_figure(out, "stack", &c->stack_bytes, "bytes");
    print_figure(out, "state", &c->state_bytes, "bytes of these");
    for (int i = CHOICE_FLASH; i < CHOICE_LIMITS; i++) {
        if (row->unknown[i]) {
            fprintf(out, "  %s is limited, and not known here: measure it\n",
                    choice_limit_words[i]);
        }
    }
}

static void print_second(FILE *out, const trials *t, const choice *c) {
    if (!c->has_second) {
        fputs("\nrunner-up   none: no other setting keeps all this\n", out);
        return;
    }
    char text[AMOUNT];
    fputs("\nrunner-up   ", out);
    print_options(out, t, &c->second);
    const double more = c->second.worst / c->best.worst - 1.0;
    if (more > 0.0) {
        fprintf(out, "\n  lost by     %.3g %% more %s in its longest steps; it errs by %s\n",
                100.0 * more, is_counted(&c->best.cost) ? "cycles" : "instructions",
                amount(t, c->second.result.error, text));
    } else {
        fprintf(out, "\n  lost by     its error, %s, for the same price\n",
                amount(t, c->second.result.error, text));
    }
}

static void print_lines(FILE *out, const trials *t, const choice_row *row,
                        const table_words *words) {
    char *run = table_run_line(t, &row->setting, row->pace, row->result.point, words);
    char *derive = table_derive_line(t, &row->setting, row->pace, row->result.point, words);
    char *measure = table_measure_line(t, &row->setting, row->pace, row->result.point, words);
    fprintf(out, "\nagain       %s\nas code     %s\ncounted by  %s\n", run, derive, measure);
    free(measure);
    free(run);
    free(derive);
}

static void print_head(FILE *out, const trials *t, const choice_wish *w) {
    fprintf(out, "%s on %s (%s)\n", t->image[0]->name, t->wish.board->name, t->wish.board->core);
    figure_reference(out, t);
    if (w->prices != NULL) {
        fprintf(out, "  prices      %s\n", w->prices);
    }
}

static void print_reasons(FILE *out, const choice *c) {
    for (int i = 0; i < CHOICE_REASONS && c->reason[i].why != NULL; i++) {
        fprintf(out, i == 0 ? "%s" : "; %s", c->reason[i].why);
        if (c->reason[i].settings < c->unpriced) {
            fprintf(out, " (%d)", c->reason[i].settings);
        }
    }
    fputc('\n', out);
}

/* How many settings there are, how many were tried, and why others were not. */
static void print_counts(FILE *out, const choice *c) {
#define LEFT_WORDS(id, words, more) [id] = {words, more},
    static const struct {
        const char *why;
        const char *more;
    } left[CHOICE_LEFTS] = {CHOICE_LEFT_ROWS(LEFT_WORDS)};
#undef LEFT_WORDS
    fprintf(out, "\n%d settings, %d of them tried, %d not\n", c->settings, c->tried,
            choice_not_tried(c));
    if (c->unpriced > 0) {
        fprintf(out, "  %d not tried: no price here: ", c->unpriced);
        print_reasons(out, c);
    }
    for (int i = 0; i < CHOICE_LEFTS; i++) {
        if (c->left[i] > 0) {
            fprintf(out, "  %d not tried%s: %s%s%s\n", c->left[i],
                    i == CHOICE_LEFT_WHOLE ? "" : " to the end", left[i].why,
                    left[i].more[0] != '\0' ? ": " : "", left[i].more);
        }
    }
}

/* That nothing fits: proved where every setting was tried, and else of how many. */
static void print_verdict(FILE *out, const choice *c) {
    const int effort = c->left[CHOICE_LEFT_WHOLE] + c->left[CHOICE_LEFT_FINER];
    if (choice_not_tried(c) == 0) {
        fprintf(out, "\nnothing fits: all %d settings were tried\n", c->settings);
        return;
    }
    fprintf(out, "\nnothing fits of %d settings tried; %d not tried%s\n", c->tried,
            choice_not_tried(c), effort > 0 ? ": raise --effort" : "");
}

/* What has contacts has no price that could be predicted, but its run can be counted. */
static void print_contacts(FILE *out, const trials *t, const table_words *words) {
    char until[TRIAL_TIME];
    fprintf(
        out,
        "nothing can be promised of contacts without counting: in Whirl's source tree, where the\n"
        "board's compiler and emulator are, `whirl choose` counts\n"
        "\nby evaluations  whirl price %s%s\n"
        "counted by  sh mk/price/measure_one.sh --whole-run %s float %s%s --until %s\n",
        words->target, words->changes, t->wish.board->name, words->target, words->changes,
        trial_until(t, until));
}

void choice_print(FILE *out, const trials *t, const choice_wish *w, const choice *c,
                  const table_words *words) {
    char text[AMOUNT];
    char step[TRIAL_TIME];
    print_head(out, t, w);
    fputs("\nchosen      ", out);
    print_options(out, t, &c->best);
    fputc('\n', out);
    print_row(out, t, w, &c->best);
    if (c->has_coarser && c->coarser.result.usable) {
        fprintf(out, "  coarser     --step %s errs by %s%s\n",
                trial_time(trial_step(t, c->coarser.pace), step),
                amount(t, c->coarser.result.error, text),
                c->coarser.result.error <= w->error ? ", more than half of what is allowed" : "");
    }
    print_second(out, t, c);
    print_counts(out, c);
    print_lines(out, t, &c->best, words);
}

static void print_would(FILE *out, const trials *t, const char *what, const choice_row *row) {
    fprintf(out, "  %s: ", what);
    print_options(out, t, row);
    fputc('\n', out);
}

/* Two digits that are no less. */
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

/* Where no one limit would do: all that the cheapest that keeps the error asks for. */
static void print_all_at_once(FILE *out, const trials *t, const choice_wish *w, const choice *c) {
    char what[2 * AMOUNT];
    if (!c->has_any) {
        fputs("  nothing that was tried\n", out);
        return;
    }
    if (c->any.fails[CHOICE_LOAD]) {
        fprintf(out, "  together with the next: a clock of %.3g MHz\n",
                no_less(1e-6 * w->clock_Hz * c->any.load_most));
    }
    snprintf(what, sizeof what, "%.0f bytes of flash and %.0f of RAM with the stack",
             number_ceiling(c->any.cost.flash_bytes.most),
             number_ceiling(c->any.cost.ram_bytes.most + c->any.cost.stack_bytes.most));
    print_would(out, t, what, &c->any);
}

void choice_print_none(FILE *out, const trials *t, const choice_wish *w, const choice *c,
                       const table_words *words, double lower_rate_Hz, const choice_row *lower) {
    char text[AMOUNT];
    char what[2 * AMOUNT];
    print_head(out, t, w);
    print_verdict(out, c);
    if (c->unpriced == c->settings) {
        fputs("no setting has a price here: ", out);
        print_reasons(out, c);
        if (t->image[0]->contacts > 0) {
            print_contacts(out, t, words);
        }
        return;
    }
    if (c->tried == 0 && c->left[CHOICE_LEFT_WHOLE] == c->settings - c->unpriced) {
        fputs("at this rate even one step a period takes too long\n"
              "hint: a shorter --horizon, a lower --rate, or more --effort\n",
              out);
        print_counts(out, c);
        return;
    }
    if (c->refused > 0) {
        fprintf(out, "  %d keep load, flash or RAM by no step\n", c->refused);
    }
    for (int i = 0; i < CHOICE_LIMITS; i++) {
        if (c->failed[i] > 0) {
            fprintf(out, "  %-6s fails in %d%s\n", choice_limit_words[i], c->failed[i],
                    i == CHOICE_ERROR ? "" : " of those that keep the error");
        }
    }
    fputs("\nwhat would fit\n", out);
    if (c->has_weaker) {
        snprintf(what, sizeof what, "an error of %s",
                 amount(t, no_less(CHOICE_MARGIN * c->weaker.result.error), text));
        print_would(out, t, what, &c->weaker);
    }
    if (c->has_dearer && w->clock_Hz > 0.0 && c->dearer.fails[CHOICE_LOAD]) {
        snprintf(what, sizeof what, "a clock of %.3g MHz",
                 no_less(1e-6 * w->clock_Hz * c->dearer.load_most));
        print_would(out, t, what, &c->dearer);
    }
    if (lower_rate_Hz > 0.0) {
        snprintf(what, sizeof what, "a rate of %.6g Hz", lower_rate_Hz);
        print_would(out, t, what, lower);
    }
    if (c->has_larger && (c->larger.fails[CHOICE_FLASH] || c->larger.fails[CHOICE_RAM])) {
        snprintf(what, sizeof what, "%.0f bytes of flash and %.0f of RAM with the stack",
                 number_ceiling(c->larger.cost.flash_bytes.most),
                 number_ceiling(c->larger.cost.ram_bytes.most + c->larger.cost.stack_bytes.most));
        print_would(out, t, what, &c->larger);
    }
    if (!c->has_weaker && !c->has_dearer && !c->has_larger) {
        print_all_at_once(out, t, w, c);
    }
    print_counts(out, c);
}
