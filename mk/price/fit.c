/* fit.c: figures of each class of work, fitted to counted steps: `make price-fit` calls it.
 *
 *     price_fit ROWS.csv... >cost_rows.h    fits, and tells on standard error how well
 *     price_fit --check ROWS.csv...         holds what the program predicts (cost_rows.h as it was built) against rows
 *                                           that it was not fitted to; exit status 1 where one is beyond its bound
 *
 * ROWS.csv is what measure.sh writes; each scene is derived again, with its setting, and what is counted in its image
 * (host/price/cost_features.h) is one line of a linear system. The figures are least squares of the relative error,
 * none below zero. Scenes of one half, drawn by a hash of their names, are fitted; the other half tells how far off
 * a scene is that was not: a scene's settings are all in the same half. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "judged.h"

enum { WIDTH = 300, BOARDS_MAX = 32 };
/* What is fitted below this is nothing. */
#define LEAST 1e-6

/* A board whose figures, times a factor, are where another's begin: it has more rows, and its compiler and processor
 * are alike. What rows tell is stronger. NULL: none. */
static const char *likeness(int board) {
    static const char *const pairs[][2] = {
        {"mps2-an500", "mps2-an386"}, {"mps2-an505", "mps2-an386"},
        {"rv32imafc", "mps2-an386"},  {"mps2-an385-m0", "mps2-an385"},
        {"rv32imac", "mps2-an385"},   {"atmega2560", "atmega328p"}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        if (strcmp(cost_boards[board].name, pairs[i][0]) == 0) {
            return pairs[i][1];
        }
    }
    return NULL;
}

/* What a step of the scenes with contacts would take without, as the fit has it: their figures lean on it. */
static void add_smooth(const cost_fit *smooth, int board, cost_number number) {
    for (int i = 0; i < row_count; i++) {
        counted *r = &rows[i];
        if (r->board == board && r->number == number && r->contacts) {
            const double value = sum_of(smooth, r, COST_OF_INSTRUCTIONS);
            r->feature[COST_F_SMOOTH] *= value;
            r->feature[COST_F_EVENT_SMOOTH] *= value;
            r->feature[COST_F_EVENT_EVALUATIONS] *= value;
            if (value <= 0.0) {
                r->value[COST_OF_CONTACT_MEAN] = r->value[COST_OF_CONTACT_WORST] = 0.0;
            }
        }
    }
}

static void write_parts(const cost_fit *f) {
    const char *before = ", .part = {\n            ";
    int column = 0;
    for (int i = 0; i < COST_FEATURES && f->is_parted; i++) {
        if (f->part[i] > 0.0) {
            column += printf("%sF(%s, %.2g)", before, cost_feature_words[i], f->part[i]);
            before = column > WIDTH ? ",\n            " : ", ";
            column = column > WIDTH ? 0 : column;
        }
    }
    if (f->is_parted) {
        printf("\n         }");
    }
}

static void write_fit(const cost_fit *f, cost_quantity q) {
    static const char *const ids[COST_QUANTITIES] = {
#define QUANTITY_ID(id, word) "COST_OF_" #id,
        COST_QUANTITY_ROWS(QUANTITY_ID)};
    int column = 0;
    printf("         [%s] = {.cases = %d, .slack = %.4g, .bound = {", ids[q], f->cases, f->slack);
    for (int c = 0; c < COST_CLASSES; c++) {
        printf("%s%.2f", c > 0 ? ", " : "", f->bound[c]);
    }
    printf("}, .largest = %.0f, .is_parted = %s, .figure = {\n", f->largest,
           f->is_parted ? "true" : "false");
    for (int i = 0; i < COST_FEATURES; i++) {
        if (f->figure[i] != COST_UNSEEN && f->figure[i] < LEAST) {
            continue;
        }
        column += column == 0 ? printf("            ") : 0;
        column += f->figure[i] == COST_UNSEEN
                      ? printf(" U(%s),", cost_feature_words[i])
                      : printf(" F(%s, %.4g),", cost_feature_words[i], f->figure[i]);
        if (column > WIDTH) {
            printf("\n");
            column = 0;
        }
    }
    printf("%s         }", column > 0 ? "\n" : "");
    write_parts(f);
    printf("},\n");
}

static void write_row(int board, cost_number number) {
    bool has[WH_METHODS] = {false};
    double spread[2] = {1.0, 1.0};
    const counted *any = NULL;
    for (int i = 0; i < row_count; i++) {
        const counted *r = &rows[i];
        if (r->board == board && r->number == number) {
            any = r;
            has[r->method] = true;
            for (int k = 0; k < 2 && !r->contacts; k++) {
                const double mean = strtod(r->column[7 + 2 * k], NULL);
                const double most = strtod(r->column[8 + 2 * k], NULL);
                spread[k] = mean > 0.0 && most / mean > spread[k] ? most / mean : spread[k];
            }
        }
    }
    if (any == NULL) {
        return;
    }
    char flags[128];
    snprintf(flags, sizeof flags, "%s",
             any->column[2][0] == '"' ? any->column[2] + 1 : any->column[2]);
    flags[strcspn(flags, "\"")] = '\0';
    printf("    {.board = \"%s\", .number = %s,\n     .compiler = \"%s %s\",\n     .methods = \" ",
           cost_boards[board].name, number == COST_DOUBLE ? "COST_DOUBLE" : "COST_FLOAT",
           any->column[1], flags);
    for (int m = 0; m < WH_METHODS; m++) {
        printf("%s%s", has[m] ? wh_methods[m].word : "", has[m] ? " " : "");
    }
    printf("\",\n     .spread = %.3f, .spread_cycles = %.3f,\n     .fit = {\n", spread[0],
           spread[1]);
    for (int q = 0; q < COST_QUANTITIES; q++) {
        const char *like = number == COST_FLOAT ? likeness(board) : NULL;
        const int of = like != NULL ? (int)(cost_board_named(like) - cost_boards) : board;
        static cost_fit alike[BOARDS_MAX][COST_QUANTITIES];
        if (like != NULL && alike[of][q].cases == 0) {
            alike[of][q] = fit(of, number, (cost_quantity)q, NULL);
        }
        const bool leans = like != NULL && alike[of][q].cases > 0;
        cost_fit f = fit(board, number, (cost_quantity)q, leans ? &alike[of][q] : NULL);
        if (q == COST_OF_INSTRUCTIONS) {
            add_smooth(&f, board, number);
        }
        if (f.cases > 0) {
            judge_all(&f, board, number, (cost_quantity)q);
            if (f.bound[COST_PLAIN] <= COST_BOUND_MOST) { /* others are not told anyway */
                write_fit(&f, (cost_quantity)q);
            }
        }
    }
    printf("     }},\n");
}

static void write_all(void) {
    printf(
        "/* cost_rows.h: what each class of work costs, by board and number: fitted to counted steps and written by\n"
        " * `make price-fit`. Do not edit. */\n/* clang-format off */\n#include \"cost_row.h\"\n\n"
        "#define F(feature, figure) [COST_F_##feature] = figure\n"
        "#define U(feature) [COST_F_##feature] = COST_UNSEEN\n"
        "static const cost_row cost_rows[] = {\n");
    fprintf(
        stderr,
        "| board | number | quantity | fitted | median | nine of ten | largest | not fitted | median | nine of ten | largest | unseen | bound |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int b = 0; b < cost_board_count; b++) {
        for (int n = 0; n < COST_NUMBERS; n++) {
            write_row(b, (cost_number)n);
        }
    }
    printf("};\n#undef F\n#undef U\n/* clang-format on */\n");
}

int main(int count, char **words) {
    const bool checks = count > 2 && strcmp(words[1], "--check") == 0;
    if (count < 2) {
        fputs("usage: price_fit [--check] ROWS.csv...\n", stderr);
        return 2;
    }
    rows = calloc(ROWS_MAX, sizeof *rows);
    if (rows == NULL) {
        return 1;
    }
    for (int i = checks ? 2 : 1; i < count; i++) {
        read_rows(words[i]);
    }
    if (checks) {
        return check_all();
    }
    write_all();
    return 0;
}
