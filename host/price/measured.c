/* measured.c: see measured.h. */
#include "measured.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/base/room.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

#define COUNTS "mk/price/measure_one.sh"
/* Of it: words are wrong, or a tool is missing. */
#define STATUS_MISSING 2

void measured_free(measured_prices *m) { free(m->price); }

static cost_number number_of(const setting *s) {
    return setting_is_fixed(s) ? COST_FIXED : s->number == &engine_float ? COST_FLOAT : COST_DOUBLE;
}

measured_lesson *measured_lesson_of(measured_prices *m, const setting *s) {
    return &m->lesson[number_of(s)];
}

static const measured_price *find(const measured_prices *m, const setting *s, deviation_pace pace) {
    char options[SETTING_TEXT];
    setting_options(s, true, options);
    for (int i = 0; i < m->count; i++) {
        const measured_price *p = &m->price[i];
        const bool at = !(m->by_run || setting_price_varies(s)) ||
                        p->pace.steps * pace.records == pace.steps * p->pace.records;
        if (at && strcmp(p->options, options) == 0) {
            return p;
        }
    }
    return NULL;
}

bool measured_has(const measured_prices *m, const setting *s, deviation_pace pace) {
    return find(m, s, pace) != NULL;
}

void measured_tell(const measured_prices *m, const setting *s, deviation_pace pace, cost *c) {
    const measured_price *p = m != NULL ? find(m, s, pace) : NULL;
    if (p != NULL) {
        *c = p->cost;
    }
}

measured_run measured_run_of(const measured_prices *m, const setting *s, deviation_pace pace) {
    const measured_price *p = m != NULL ? find(m, s, pace) : NULL;
    return p != NULL ? p->run : (measured_run){0};
}

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

bool measured_takes_runs(const cost_board *board) { return !is_host(board); }

bool measured_takes(const cost_board *board, const setting *s) {
    return setting_is_fixed(s) ? !is_host(board)
                               : s->number != &engine_double || strcmp(board->core, "AVR") != 0;
}

const char *measured_missing(const cost_board *board, char text[MEASURED_TEXT]) {
    static const char missing[] = " is missing";
    if (access(COUNTS, R_OK) != 0) {
        return "this is not the root of Whirl's source tree (" COUNTS ")";
    }
    char line[MEASURED_TEXT] = "";
    char *target = is_host(board) ? room_words("price-ready-host")
                                  : room_words("BOARD=%s price-ready-board", board->name);
    char *command = room_words("make -s %s 2>&1", target);
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

/* Cuts a row at its commas. */
static bool cut(char *row, const char *column[RUN_COLUMNS]) {
    int count = 0;
    column[count++] = row;
    for (char *at = row; *at != '\0'; at++) {
        if (*at == ',') {
            *at = '\0';
            if (count == RUN_COLUMNS) {
                return false;
            }
            column[count++] = at + 1;
        }
    }
    return count == RUN_COLUMNS;
}

static double value_of(const char *text) { return decimal_read(text, NULL); }

/* The larger of a figure and what was counted at one more place. */
static void grow(cost_figure *f, cost_basis basis, double value, double each_least,
                 double each_most) {
    if (!(f->basis == COST_NOT_KNOWN) && !(value * each_most > f->most)) {
        return;
    }
    *f = (cost_figure){basis,
                       COST_MEASURED,
                       basis == COST_RANGE ? 0.0 : value,
                       value * each_least,
                       value * each_most,
                       1.0};
}

/* One place's whole run into the price: false where the row is none. */
static bool enter_run(const cost_board *board, char *row, measured_price *p) {
    const char *column[RUN_COLUMNS];
    if (!cut(row, column) || strcmp(column[0], board->name) != 0) {
        return false;
    }
    cost *c = &p->cost;
    const bool range = board->cycles == COST_RANGE;
    const double least = range ? board->cycles_least : 1.0;
    const double most = range ? board->cycles_most : 1.0;
    grow(&c->instructions, COST_MEASURED, value_of(column[RUN_INSTRUCTIONS]), 1.0, 1.0);
    grow(&c->instructions_worst, COST_MEASURED, value_of(column[RUN_MOST]), 1.0, 1.0);
    grow(&c->cycles, board->cycles, value_of(column[range ? RUN_INSTRUCTIONS : RUN_CYCLES]), least,
         most);
    grow(&c->cycles_worst, board->cycles, value_of(column[range ? RUN_MOST : RUN_CYCLES_MOST]),
         least, most);
    grow(&c->flash_bytes, COST_MEASURED, value_of(column[RUN_FLASH]), 1.0, 1.0);
    grow(&c->ram_bytes, COST_MEASURED, value_of(column[RUN_RAM]), 1.0, 1.0);
    grow(&c->stack_bytes, COST_MEASURED, value_of(column[RUN_STACK]), 1.0, 1.0);
    p->run.steps += value_of(column[RUN_STEPS]);
    p->run.instructions_bound = number_most(p->run.instructions_bound, value_of(column[RUN_BOUND]));
    p->run.cycles_bound = number_most(p->run.cycles_bound, value_of(column[RUN_CYCLES_BOUND]));
    return true;
}

static measured_end count_line(char *line, char *row, int size) {
    char *command = room_words("%s 2>/dev/null", line);
    row[0] = '\0';
    const int status = line_from(command, NULL, row, size);
    free(command);
    free(line);
    return status == 0                ? MEASURED_COUNTED
           : status == STATUS_MISSING ? MEASURED_MISSING
                                      : MEASURED_REFUSED;
}

/* Whole runs at all places; no bound where one of them has none. */
static measured_end count_runs(const trials *t, const setting *s, deviation_pace pace,
                               const table_words *words, measured_price *next) {
    next->cost = (cost){.predictable = true, .why = ""};
    bool bounded = true;
    for (int p = 0; p < t->wish.source->points; p++) {
        char row[1024];
        const double before = next->run.instructions_bound;
        next->run.instructions_bound = 0.0;
        measured_end end = count_line(table_measure_line(t, s, pace, p, words), row, sizeof row);
        if (end == MEASURED_COUNTED && !enter_run(t->wish.board, row, next)) {
            end = MEASURED_REFUSED;
        }
        if (end != MEASURED_COUNTED) {
            return end;
        }
        bounded = bounded && next->run.instructions_bound > 0.0;
        next->run.instructions_bound = number_most(before, next->run.instructions_bound);
    }
    if (!bounded) {
        next->run.instructions_bound = next->run.cycles_bound = 0.0;
    }
    return MEASURED_COUNTED;
}

measured_end measured_count(measured_prices *m, const trials *t, const setting *s,
                            deviation_pace pace, int point, const cost *predicted) {
    measured_price next = {.pace = pace, .cost = *predicted};
    measured_end end;
    if (m->by_run) {
        end = count_runs(t, s, pace, m->words, &next);
    } else {
        char row[1024];
        end = count_line(table_measure_line(t, s, pace, point, m->words), row, sizeof row);
        if (end == MEASURED_COUNTED && !cost_measured(row, t->wish.board, &next.cost)) {
            end = MEASURED_REFUSED;
        }
    }
    if (end == MEASURED_MISSING) {
        return end;
    }
    setting_options(s, true, next.options);
    if (end == MEASURED_REFUSED) {
        next.cost = (cost){.why = m->by_run ? "it cannot be built, linked or run to its end there"
                                            : "it cannot be built, linked or run there"};
        next.run = (measured_run){0};
    }
    m->price = room_more(m->price, m->count + 1, sizeof *m->price);
    m->price[m->count++] = next;
    return end;
}
