#include "measured.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/base/interrupts.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

#define COUNTS "mk/price/measure_one.sh"
/* Its exit status for wrong words or a missing tool. */
#define STATUS_MISSING 2

/* The last line that a command prints, or the first with this in it. Returns its exit status, or -1. */
static int line_from(const char *command, const char *with, char *line, int size) {
    FILE *from = popen(command, "r");
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
    const int status = pclose(from);
    return status != -1 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* --- can it be counted? --------------------------------------------------------------------------------*/

#define NO_COMMAND 127 /* of a shell */

static bool is_host(const cost_board *board) { return strcmp(board->name, "host") == 0; }

const char *measured_missing(const trials *t, const cost_board *board, char text[MEASURED_TEXT]) {
    static const char missing[] = " is missing";
    if (t != NULL && t->image[0]->contacts > 0 && is_host(board)) {
        return "runs with contacts are counted in emulators alone";
    }
    if (access(COUNTS, R_OK) != 0) {
        return "this is not the root of Whirl's source tree; run it there to count with the "
               "emulator";
    }
    char line[MEASURED_TEXT] = "";
    char *target = is_host(board) ? alloc_words("price-ready-host")
                                  : alloc_words("BOARD=%s price-ready-board", board->name);
    char *command = alloc_words("make -s %s 2>&1", target);
    const int status = line_from(command, missing, line, sizeof line);
    const char *quoted = strchr(line, '\'');
    char *end = strstr(line, missing);
    if (status == 0) {
        text = NULL;
    } else if (status == NO_COMMAND) {
        snprintf(text, MEASURED_TEXT, "'make'%s", missing);
    } else if (quoted != NULL && end != NULL && quoted < end) {
        end[sizeof missing - 1] = '\0';
        snprintf(text, MEASURED_TEXT, "%s", quoted);
    } else {
        snprintf(text, MEASURED_TEXT, "make %.80s fails", target);
    }
    free(command);
    free(target);
    return text;
}

/* --- counting --------------------------------------------------------------------------------------------*/

/* Columns of count_run.sh's row. */
enum {
    RUN_STEPS = 2,
    RUN_INSTRUCTIONS,
    RUN_MOST,
    RUN_BOUND,
    RUN_CYCLES,
    RUN_CYCLES_MOST,
    RUN_CYCLES_BOUND,
    RUN_OBTAINED,
    RUN_FLASH,
    RUN_RAM,
    RUN_STACK,
    RUN_COLUMNS
};

static double value_of(const char *text) { return decimal_read(text, NULL); }

/* The larger of a figure and the count at one more place. */
static void grow(cost_figure *f, cost_basis basis, const char *text) {
    const double value = value_of(text);
    if (f->basis == COST_NOT_KNOWN || value > f->value) {
        *f = cost_known(value, basis);
    }
}

/* Adds the whole run at one place to a row; false: the line is not valid. */
static bool enter_run(const cost_board *board, char *line, table_row *to) {
    char *column[RUN_COLUMNS];
    if (!cost_cut(line, column, RUN_COLUMNS) || strcmp(column[0], board->name) != 0) {
        return false;
    }
    cost *c = &to->cost;
    grow(&c->instructions, COST_MEASURED, column[RUN_INSTRUCTIONS]);
    grow(&c->instructions_worst, COST_MEASURED, column[RUN_MOST]);
    if (board->cycles == COST_RANGE) {
        c->cycles = cost_ranged(board, &c->instructions);
        c->cycles_worst = cost_ranged(board, &c->instructions_worst);
    } else {
        grow(&c->cycles, board->cycles, column[RUN_CYCLES]);
        grow(&c->cycles_worst, board->cycles, column[RUN_CYCLES_MOST]);
    }
    grow(&c->flash_bytes, COST_MEASURED, column[RUN_FLASH]);
    grow(&c->ram_bytes, COST_MEASURED, column[RUN_RAM]);
    grow(&c->stack_bytes, COST_MEASURED, column[RUN_STACK]);
    to->run.steps += value_of(column[RUN_STEPS]);
    to->run.instructions_bound =
        number_most(to->run.instructions_bound, value_of(column[RUN_BOUND]));
    to->run.cycles_bound = number_most(to->run.cycles_bound, value_of(column[RUN_CYCLES_BOUND]));
    return true;
}

/* The exit status of a line, and the last line that it prints. */
static int count_line(char *line, char *row, int size) {
    char *command = alloc_words("%s 2>/dev/null", line);
    row[0] = '\0';
    const int status = line_from(command, NULL, row, size);
    free(command);
    free(line);
    return status;
}

/* Whole runs at all places; unknown if one of them failed. */
static int count_runs(const trials *t, const table_words *words, table_row *row) {
    bool bounded = true;
    int status = 0;
    row->cost = (cost){.why = ""};
    for (int p = 0; p < t->points && status == 0; p++) {
        char line[1024];
        const double before = row->run.instructions_bound;
        row->run.instructions_bound = 0.0;
        status = count_line(table_measure_line(t, &row->setting, row->pace, p, words), line,
                            sizeof line);
        status = status == 0 && !enter_run(t->wish.board, line, row) ? 1 : status;
        bounded = bounded && row->run.instructions_bound > 0.0;
        row->run.instructions_bound = number_most(before, row->run.instructions_bound);
    }
    if (!bounded) {
        row->run.instructions_bound = row->run.cycles_bound = 0.0;
    }
    return status;
}

static int count_step(const trials *t, const table_words *words, table_row *row) {
    char line[1024];
    const int status =
        count_line(table_measure_line(t, &row->setting, row->pace, row->result.point, words), line,
                   sizeof line);
    return status == 0 && !cost_measured(line, t->wish.board, &row->cost) ? 1 : status;
}

/* Do the counted figures of one row hold for another? */
static bool is_alike(const table_row *a, const table_row *b, bool by_pace) {
    return setting_order(&a->setting) == setting_order(&b->setting) &&
           (!by_pace || a->pace.steps * b->pace.records == b->pace.steps * a->pace.records);
}

measured_end measured_count(const trials *t, table *made, int row, const table_words *words) {
    const bool runs = t->image[0]->contacts > 0;
    table_row counted = made->row[row];
    const int status = runs ? count_runs(t, words, &counted) : count_step(t, words, &counted);
    if (status == STATUS_MISSING) {
        return MEASURED_MISSING;
    }
    int kept = 0;
    const bool by_pace = runs || setting_price_varies(&counted.setting);
    for (int i = 0; i < made->count; i++) {
        table_row now = made->row[i];
        const bool alike = is_alike(&now, &counted, by_pace);
        if (alike) {
            bool known;
            now.cost = counted.cost;
            now.run = counted.run;
            now.counted = true;
            now.price = table_price_of(&now.cost, ratio_times(1, trial_step(t, now.pace)), &known);
        }
        if (!alike || status == 0) {
            made->row[kept++] = now;
        }
    }
    made->count = kept;
    if (status != 0) {
        made->unpriced++;
        made->why = "it cannot be built, linked or run there";
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

measured_end measured_front(const trials *t, table *made, const table_words *words,
                            const table_wish *w) {
    int i = t->image[0]->contacts > 0 ? made->count : uncounted(made);
    while (i < made->count && !interrupted) {
        if (w->progress != NULL) {
            w->progress(w->context, i, made->count);
        }
        if (measured_count(t, made, i, words) == MEASURED_MISSING) {
            return MEASURED_MISSING;
        }
        i = uncounted(made);
    }
    return MEASURED_COUNTED;
}
