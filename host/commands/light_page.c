/* light_page.c: see light_page.h. */
#include "light_page.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "files.h"
#include "host/base/room.h"
#include "host/base/written.h"
#include "light_expect.h"
#include "load.h"

/* Medians of the scenes' steps. */
static void cycles_of(const light *l, char *cell, size_t size) {
    size_t used = 0;
    cell[0] = '\0';
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        char median[16] = WH_LIGHT_NONE;
        if (strncmp(light_names[i], "cycles.", 7) == 0 && used < size) {
            (void)sscanf(l->value[i], "%*s %15s", median);
            used +=
                (size_t)snprintf(cell + used, size - used, "%s%s", used > 0 ? " / " : "", median);
        }
    }
}

char *light_row(const light *l, int equal, const char *differ) {
    char cycles[120];
    char date[16] = "";
    const time_t now = time(NULL);
    const struct tm *day = localtime(&now);
    if (day != NULL) {
        (void)strftime(date, sizeof date, "%Y-%m-%d", day);
    }
    cycles_of(l, cycles, sizeof cycles);
#define VALUE(name) l->value[light_field(name, "")]
    char *row = room_words(
        "| %s | %s | %s | %s | %d of %d | %s | %s | %s | %.4s | %s%s | 0x%08" PRIx32 " |\n", date,
        VALUE("board"), VALUE("chip"), VALUE("clock"), equal, LIGHT_SCENES, cycles, VALUE("stack"),
        VALUE("period_us"), VALUE("selftest"), differ[0] != '\0' ? "differs: " : "equal", differ,
        l->crc);
#undef VALUE
    return row;
}

/* Behind the last row of the page's table; a record that it has is not put there again. */
int light_append(const char *page, const char *row, uint32_t crc) {
    size_t length = 0;
    char seen[24];
    char *text = read_all(page, &length);
    if (text == NULL) {
        fputs("hint: --page FILE names it; " LIGHT_PAGE " is there from the project's root\n",
              stderr);
        return EXIT_RUN_FAILED;
    }
    (void)snprintf(seen, sizeof seen, "| 0x%08" PRIx32 " |", crc);
    if (strstr(text, seen) != NULL) {
        printf("row: %s has this record already\n", page);
        free(text);
        return EXIT_DONE;
    }
    char *behind = NULL; /* the last line of a table */
    for (char *at = text; at != NULL; at = *at != '\0' ? strchr(at + 1, '\n') : NULL) {
        behind = at[0] == '|' || (at[0] == '\n' && at[1] == '|') ? at + 1 : behind;
    }
    behind = behind != NULL ? strchr(behind, '\n') : NULL;
    if (behind == NULL) {
        free(text);
        fprintf(stderr, "%s: error: there is no table for the row\nhint: " LIGHT_PAGE " has one\n",
                page);
        return EXIT_RUN_FAILED;
    }
    static const char empty[] = "\nno row yet\n";
    const char *rest = behind + 1;
    rest += strncmp(rest, empty, sizeof empty - 1) == 0 ? sizeof empty - 1 : 0;
    FILE *out = written_open(page);
    bool good = out != NULL;
    if (good) {
        fwrite(text, 1, (size_t)(behind + 1 - text), out);
        fprintf(out, "%s%s", row, rest);
        good = written_close(out, page, true);
    }
    if (good) {
        printf("row: appended to %s\n", page);
    }
    free(text);
    return good ? EXIT_DONE : EXIT_RUN_FAILED;
}
