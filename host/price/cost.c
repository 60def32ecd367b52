/* cost.c: see cost.h. */
#include "cost.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cost_row.h"
#include "host/image/core_rows.h"
#include "host/run/start.h"

#include "cost_rows.h"

/* --- predicting -----------------------------------------------------------------------------------*/

static const cost_row *row_of(const cost_board *board, cost_number number) {
    for (size_t i = 0; i < sizeof cost_rows / sizeof cost_rows[0]; i++) {
        if (strcmp(cost_rows[i].board, board->name) == 0 && cost_rows[i].number == number) {
            return &cost_rows[i];
        }
    }
    return NULL;
}

static bool has_word(const char *words, const char *word) {
    char framed[64];
    snprintf(framed, sizeof framed, " %s ", word);
    return strstr(words, framed) != NULL;
}

/* One quantity, or nothing of it, and why in *why. */
static cost_figure predicted(const cost_row *row, cost_quantity quantity, cost_basis of,
                             const double *feature, const char **why) {
    const cost_fit *fit = &row->fit[quantity];
    int unseen = -1;
    const double value = fit->cases > 0 ? cost_fit_at(fit, feature, &unseen) : -1.0;
    if (fit->cases == 0 || value <= 0.0) {
        *why = fit->cases == 0 ? "nothing like this scene has been measured on this board"
                               : "the scene does something that no measured scene did: measure it";
        return (cost_figure){0};
    }
    const double bound = cost_bound_at(fit, feature, value);
    if (bound > COST_BOUND_MOST) {
        *why = "it depends on more than the image tells: measure it";
        return (cost_figure){0};
    }
    return (cost_figure){.basis = COST_PREDICTED,
                         .of = of,
                         .value = value,
                         .least = cost_least(fit, value, bound),
                         .most = cost_most(fit, value, bound),
                         .bound = cost_most(fit, value, bound) / value};
}

static void price_smooth(const cost_row *row, const cost_board *board, const double *feature,
                         cost *c) {
    c->instructions = predicted(row, COST_OF_INSTRUCTIONS, COST_MEASURED, feature, &c->why);
    c->instructions_worst = cost_longest(c->instructions, row->spread);
    if (board->cycles == COST_RANGE) {
        c->cycles = cost_ranged(board, &c->instructions);
        c->cycles_worst = cost_ranged(board, &c->instructions_worst);
    } else {
        c->cycles = predicted(row, COST_OF_CYCLES, board->cycles, feature, &c->why);
        c->cycles_worst = cost_longest(c->cycles, row->spread_cycles);
    }
}

/* Cycles as the instructions of the smooth step have them: events are made of the same kinds of instructions. */
static cost_figure scaled(const cost_figure *cycles, double share, double bound) {
    if (cycles->basis == COST_NOT_KNOWN) {
        return (cost_figure){0};
    }
    cost_figure of = *cycles;
    of.value *= share;
    of.least *= share / bound;
    of.most *= share * bound;
    of.bound *= of.basis == COST_PREDICTED ? bound : 1.0;
    return of;
}

static void price_contacts(const cost_row *row, double *feature, cost *c) {
    const double smooth = c->instructions.value;
    const cost_figure cycles = c->cycles;
    feature[COST_F_SMOOTH] = smooth;
    feature[COST_F_EVENT_SMOOTH] *= smooth;
    feature[COST_F_EVENT_EVALUATIONS] *= smooth;
    c->instructions = predicted(row, COST_OF_CONTACT_MEAN, COST_MEASURED, feature, &c->why);
    c->instructions_worst = predicted(row, COST_OF_CONTACT_WORST, COST_MEASURED, feature, &c->why);
    c->cycles = (cost_figure){0};
    c->cycles_worst = (cost_figure){0};
    if (c->instructions.basis == COST_PREDICTED && smooth > 0.0) {
        c->cycles = scaled(&cycles, c->instructions.value / smooth, c->instructions.bound);
    }
    if (c->instructions_worst.basis == COST_PREDICTED && smooth > 0.0) {
        c->cycles_worst =
            scaled(&cycles, c->instructions_worst.value / smooth, c->instructions_worst.bound);
    }
}

/* Such an image may be had, but nothing runs it. */
static bool takes_method(const image *im) {
    diags *unsaid = diags_new();
    const bool takes = start_has_method(im, im->settings.method, unsaid);
    diags_free(unsaid);
    return takes;
}

static double state_bytes(const image *im, cost_number number) {
    const double real = number == COST_DOUBLE ? 8.0 : 4.0;
    return 8.0 * im->angles + real * core_memory_reals(im);
}

cost cost_of(const image *im, const cost_board *board, cost_number number) {
    if (number == COST_FIXED) {
        return (cost){.why = "steps in fixed point have prices of their own: cost_fixed_of()"};
    }
    if (!takes_method(im)) {
        return (cost){.why = "the scene does not take this method"};
    }
    const cost_row *row = row_of(board, number);
    cost c = {.why = ""};
    if (im->contacts == 0) { /* what contacts keep is laid out by the board's compiler */
        c.state_bytes = cost_known(state_bytes(im, number), COST_EXACT);
    }
    if (row == NULL) {
        c.why = "no scene has been measured on this board in this number";
        return c;
    }
    if (!has_word(row->methods, wh_methods[im->settings.method].word)) {
        c.why = "no scene has been measured with this method: make price-rows price-fit";
        return c;
    }
    double feature[COST_FEATURES];
    cost_counts counts = cost_counts_of(im, board, number);
    counts.smooth = 1.0;
    cost_features(&counts, feature);
    c.predictable = true;
    price_smooth(row, board, feature, &c);
    c.flash_bytes = predicted(row, COST_OF_FLASH, COST_MEASURED, feature, &c.why);
    c.ram_bytes = predicted(row, COST_OF_RAM, COST_MEASURED, feature, &c.why);
    c.stack_bytes = predicted(row, COST_OF_STACK, COST_MEASURED, feature, &c.why);
    if (im->contacts > 0) {
        c.flash_bytes = c.ram_bytes = c.stack_bytes = (cost_figure){0};
        price_contacts(row, feature, &c);
        c.why = "what events take depends on the motion: a scene with contacts must be measured";
    }
    return c;
}

/* --- measured --------------------------------------------------------------------------------------*/

enum { COLUMNS = 15 };

/* Cuts a row at its commas outside quotes; returns how many there are. */
static int cut(char *row, char *column[COLUMNS]) {
    int count = 0;
    bool quoted = false;
    column[count++] = row;
    for (char *at = row; *at != '\0' && *at != '\n' && count <= COLUMNS; at++) {
        quoted = quoted != (*at == '"');
        if (*at == ',' && !quoted) {
            *at = '\0';
            if (count < COLUMNS) {
                column[count] = at + 1;
            }
            count++;
        }
    }
    return count;
}

static cost_figure told(const char *text, cost_basis basis) {
    return text[0] == '\0' || text[0] == '\n' ? (cost_figure){0}
                                              : cost_known(strtod(text, NULL), basis);
}

bool cost_measured(const char *row, const cost_board *board, cost *c) {
    char copy[1024];
    char *column[COLUMNS];
    if (strlen(row) >= sizeof copy) {
        return false;
    }
    memcpy(copy, row, strlen(row) + 1);
    if (cut(copy, column) != COLUMNS || strcmp(column[3], board->name) != 0) {
        return false;
    }
    c->predictable = true;
    c->why = "";
    c->instructions = told(column[7], COST_MEASURED);
    c->instructions_worst = told(column[8], COST_MEASURED);
    if (board->cycles == COST_RANGE) {
        c->cycles = cost_ranged(board, &c->instructions);
        c->cycles_worst = cost_ranged(board, &c->instructions_worst);
    } else {
        c->cycles = told(column[9], board->cycles);
        c->cycles_worst = told(column[10], board->cycles);
    }
    c->flash_bytes = told(column[12], COST_MEASURED);
    c->ram_bytes = told(column[13], COST_MEASURED);
    c->stack_bytes = told(column[14], COST_MEASURED);
    return c->instructions.basis == COST_MEASURED;
}
