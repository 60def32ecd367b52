/* measured.c: see measured.h. */
#include "measured.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/base/room.h"

#define COUNTS "mk/price/measure_one.sh"
/* Of it: words are wrong, or a tool is missing. */
#define STATUS_MISSING 2

bool measured_here(void) { return access(COUNTS, R_OK) == 0; }

void measured_free(measured_prices *m) { free(m->price); }

static const measured_price *find(const measured_prices *m, const setting *s, deviation_pace pace) {
    char options[SETTING_TEXT];
    setting_options(s, true, options);
    for (int i = 0; i < m->count; i++) {
        const measured_price *p = &m->price[i];
        const bool at = !setting_price_varies(s) ||
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

/* The last line that a command prints. Returns its exit status, or -1. */
static int last_line(const char *command, char *line, int size) {
    FILE *from = popen(command, "r");
    if (from == NULL) {
        return -1;
    }
    char next[1024];
    while (fgets(next, sizeof next, from) != NULL) {
        next[strcspn(next, "\r\n")] = '\0';
        snprintf(line, (size_t)size, "%s", next);
    }
    const int status = pclose(from);
    return status != -1 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

measured_end measured_count(measured_prices *m, const trials *t, const setting *s,
                            deviation_pace pace, int point, const cost *predicted) {
    char row[1024] = "";
    char *line = table_measure_line(t, s, pace, point, m->words);
    char *command = room_words("%s 2>/dev/null", line);
    const int status = last_line(command, row, sizeof row);
    free(command);
    free(line);
    if (status == STATUS_MISSING) {
        return MEASURED_MISSING;
    }
    measured_price next = {.pace = pace, .cost = *predicted};
    setting_options(s, true, next.options);
    const bool counted = status == 0 && cost_measured(row, t->wish.board, &next.cost);
    if (!counted) {
        next.cost = (cost){.why = "it cannot be built, linked or run there"};
    }
    m->price = room_more(m->price, m->count + 1, sizeof *m->price);
    m->price[m->count++] = next;
    return counted ? MEASURED_COUNTED : MEASURED_REFUSED;
}
