#include "exit.h"

#define ROW(name, status, meaning) {status, meaning},
static const struct {
    int status;
    const char *meaning;
} rows[EXITS] = {EXIT_ROWS(ROW)};

void exit_describe(FILE *out, const char *const *why) {
    fputs("\nExit status:\n", out);
    for (int i = 0; i < EXITS; i++) {
        if (why[i] != NULL) {
            fprintf(out, "  %-5d%s%s%s\n", rows[i].status, rows[i].meaning,
                    why[i][0] != '\0' ? ": " : "", why[i]);
        }
    }
}
