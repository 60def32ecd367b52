#include "cost.h"

#include <stdlib.h>
#include <string.h>

#include "cost_count.h"
#include "host/engine/start.h"
#include "host/fixed/fixed_plan.h"
#include "host/image/core_rows.h"

#include "cost_rows.h"

/* --- predicting -----------------------------------------------------------------------------------*/

cost_figure cost_known(double value, cost_basis basis) {
    return (cost_figure){basis, value, value, value};
}

cost_figure cost_ranged(const cost_board *board, const cost_figure *instructions) {
    if (instructions->basis == COST_NOT_KNOWN) {
        return (cost_figure){0};
    }
    return (cost_figure){COST_RANGE, 0.0, instructions->least * board->cycles_least,
                         instructions->most * board->cycles_most};
}

const double *cost_counted(const cost_counts *c, cost_quantity quantity) {
    return quantity == COST_OF_INSTRUCTIONS || quantity == COST_OF_CYCLES ? c->run : c->code;
}

static const cost_row *row_of(const cost_board *board, cost_number number, cost_quantity quantity) {
    for (size_t i = 0; i < sizeof cost_rows / sizeof cost_rows[0]; i++) {
        const cost_row *row = &cost_rows[i];
        if (strcmp(row->board, board->name) == 0 && row->number == number &&
            row->quantity == quantity) {
            return row;
        }
    }
    return NULL;
}

/* The mean of a quantity, and *worst of the longest step. */
static cost_figure sum_of(const cost_row *row, const cost_counts *c, cost_figure *worst,
                          const char **why) {
    double sum = 0.0;
    for (int i = 0; row != NULL && i < COST_CLASSES; i++) {
        const double count = cost_counted(c, row->quantity)[i];
        if (count > 0.0 && row->figure[i] < 0.0) {
            *why = "no counted step has an operation that this scene has: measure it";
            row = NULL;
        } else {
            sum += count * row->figure[i];
        }
    }
    *worst = (cost_figure){0};
    if (row == NULL || !(sum > 0.0)) {
        return *worst;
    }
    *worst = (cost_figure){COST_PREDICTED, sum * row->longest, sum / row->within,
                           sum * row->longest * row->within};
    return (cost_figure){COST_PREDICTED, sum, sum / row->within, sum * row->within};
}

static bool takes_method(const image *im) {
    diags *unsaid = diags_new();
    const bool takes = start_has_method(im, im->settings.method, unsaid);
    diags_free(unsaid);
    return takes;
}

static double state_bytes(const image *im, cost_number number) {
    if (number == COST_FIXED) {
        const int words = ((int)WH_FIXED_BYTES(im->angles, im->reals + im->inputs) + 7) / 8;
        return 8.0 * words; /* the header's */
    }
    return 8.0 * im->angles + (number == COST_DOUBLE ? 8.0 : 4.0) * core_memory_reals(im);
}

cost cost_of(const image *im, const cost_board *board, cost_number number) {
    if (number != COST_FIXED && !takes_method(im)) {
        return (cost){.why = "the scene does not take this method"};
    }
    if (im->contacts > 0) { /* their memory is laid out by the board's compiler */
        return (cost){.why = "the cost of contacts depends on the motion: it must be counted"};
    }
    cost c = {.why = "", .state_bytes = cost_known(state_bytes(im, number), COST_EXACT)};
    if (row_of(board, number, COST_OF_INSTRUCTIONS) == NULL) {
        c.why = "no step has been counted on this board in this number";
        return c;
    }
    const cost_counts counts = cost_count(im, board, number);
    cost_figure none;
#define COST_SUM(of, worst) sum_of(row_of(board, number, COST_OF_##of), &counts, worst, &c.why)
    c.instructions = COST_SUM(INSTRUCTIONS, &c.instructions_worst);
    if (board->cycles == COST_RANGE) {
        c.cycles = cost_ranged(board, &c.instructions);
        c.cycles_worst = cost_ranged(board, &c.instructions_worst);
    } else {
        c.cycles = COST_SUM(CYCLES, &c.cycles_worst);
    }
    c.flash_bytes = COST_SUM(FLASH, &none);
    c.ram_bytes = COST_SUM(RAM, &none);
    c.stack_bytes = COST_SUM(STACK, &none);
#undef COST_SUM
    return c;
}

/* --- counted -----------------------------------------------------------------------------------------*/

bool cost_cut(char *row, char **column, int columns) {
    int count = 0;
    bool quoted = false;
    row[strcspn(row, "\r\n")] = '\0';
    column[count++] = row;
    for (char *at = row; *at != '\0' && count <= columns; at++) {
        quoted = quoted != (*at == '"');
        if (*at == ',' && !quoted) {
            *at = '\0';
            if (count < columns) {
                column[count] = at + 1;
            }
            count++;
        }
    }
    return count == columns;
}

static cost_figure told(const char *text, cost_basis basis) {
    return text[0] == '\0' ? (cost_figure){0} : cost_known(strtod(text, NULL), basis);
}

bool cost_measured(const char *row, const cost_board *board, cost *c) {
    char copy[1024];
    char *column[COST_COLUMNS];
    if (strlen(row) >= sizeof copy) {
        return false;
    }
    memcpy(copy, row, strlen(row) + 1);
    if (!cost_cut(copy, column, COST_COLUMNS) || strcmp(column[3], board->name) != 0) {
        return false;
    }
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
