/* table.c: the table of figures that prices are predicted from (host/study/cost_rows.inc): `make price-table` calls it.
 *
 *     price_table ROWS.csv >cost_rows.inc    writes the table, and its errors to standard error
 *
 * ROWS.csv is written by measure.sh. A figure is what one operation of a class takes: the least squares of the relative
 * error over the counted steps of a board and number, with no figure below zero. The stated error is that of scenes that
 * did not take part: the scenes are halved by a hash of their names, and each half is predicted from the other. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/hashing.h"
#include "host/cli/load.h"
#include "host/cli/options.h"
#include "host/fixed/fixed_plan.h"
#include "host/study/cost.h"

enum { ROWS_MOST = 20000, SWEEPS = 4000, WORDS_MOST = 16 };

typedef struct row {
    const cost_board *board;
    cost_number number;
    unsigned half;
    cost_counts counts;
    double value[COST_QUANTITIES]; /* 0: not counted */
    double longest[2];             /* over the mean, of instructions and of cycles */
} row;

static row *rows;
static int row_count;
static const char *const words_of[COST_QUANTITIES] = {"INSTRUCTIONS", "CYCLES", "FLASH", "RAM",
                                                      "STACK"};

/* --- reading -----------------------------------------------------------------------------------------*/

static bool count_row(row *r, char *const column[COST_COLUMNS]) {
    char setting[128];
    char *words[WORDS_MOST];
    source_model from;
    loaded made = {0};
    const mechanism *of;
    const scene *in;
    common_options options = options_defaults();
    bool bad = false;
    snprintf(setting, sizeof setting, "%s", column[6]);
    int count = 0;
    for (char *word = strtok(setting, " \""); word != NULL && count < WORDS_MOST;
         word = strtok(NULL, " \"")) {
        words[count++] = word;
    }
    for (int at = 0; at < count && !bad;) {
        bad = !options_take("price_table", OPTIONS_ENGINE | OPTIONS_CHANGE | OPTIONS_STEP, count,
                            words, &at, &options, &bad) ||
              bad;
    }
    bool good = false;
    if (!bad && source_open(&from, column[4]) == EXIT_DONE) {
        const load_request request = {
            .settings = options.integration, .use = IMAGE_TO_WRITE, .conserve = true};
        if (source_pick(&from, true, &of, &in) == EXIT_DONE &&
            load(&made, &from, of, in, &options.changes, &request) == EXIT_DONE) {
            image *im = made.image;
            fixed_plan *plan =
                r->number == COST_FIXED ? fixed_plan_make(im, false, from.errors) : NULL;
            im->fixed = plan;
            good = im->contacts == 0 && (r->number != COST_FIXED || plan != NULL);
            if (good) {
                r->counts = cost_count(im, r->board, r->number);
            }
            im->fixed = NULL;
            fixed_plan_free(plan);
        }
        unload(&made);
        source_close(&from);
    }
    options_forget(&options);
    return good;
}

static double number_at(const char *text) { return strtod(text, NULL); }

static void read_rows(const char *path) {
    FILE *in = fopen(path, "r");
    char line[1024];
    char *column[COST_COLUMNS];
    if (in == NULL) {
        fprintf(stderr, "price_table: error: %s cannot be read\n", path);
        exit(2);
    }
    while (fgets(line, sizeof line, in) != NULL && row_count < ROWS_MOST) {
        row *r = &rows[row_count];
        if (!cost_cut(line, column, COST_COLUMNS) || strcmp(column[0], "commit") == 0) {
            continue;
        }
        *r = (row){.board = cost_board_named(column[3]),
                   .half = (unsigned)(hash_text(column[4], strlen(column[4])) / 16 % 2)};
        for (int n = 0; n < COST_NUMBERS; n++) {
            r->number = strcmp(column[5], cost_number_words[n]) == 0 ? (cost_number)n : r->number;
        }
        if (r->board == NULL || !count_row(r, column)) {
            continue;
        }
        static const int at[COST_QUANTITIES] = {7, 9, 12, 13, 14};
        for (int q = 0; q < COST_QUANTITIES; q++) {
            r->value[q] = number_at(column[at[q]]);
        }
        for (int q = 0; q < 2; q++) {
            const double most = number_at(column[at[q] + 1]);
            r->longest[q] = r->value[q] > 0.0 && most > r->value[q] ? most / r->value[q] : 1.0;
        }
        row_count++;
    }
    fclose(in);
}

/* --- figures -----------------------------------------------------------------------------------------*/

typedef struct selection {
    const cost_board *board;
    cost_number number;
    cost_quantity quantity;
} selection;

static bool is_of(const row *r, const selection *s) {
    return r->board == s->board && r->number == s->number && r->value[s->quantity] > 0.0;
}

/* Least squares of sum / value - 1, by coordinate descent; rows of a half, or of both (2). */
static void solve(const selection *s, unsigned half, double figure[static COST_CLASSES]) {
    double products[COST_CLASSES][COST_CLASSES] = {{0}};
    double right[COST_CLASSES] = {0};
    for (int i = 0; i < row_count; i++) {
        const row *r = &rows[i];
        if (!is_of(r, s) || (half < 2 && r->half != half)) {
            continue;
        }
        const double *count = cost_counted(&r->counts, s->quantity);
        for (int a = 0; a < COST_CLASSES; a++) {
            right[a] += count[a] / r->value[s->quantity];
            for (int b = 0; b < COST_CLASSES; b++) {
                products[a][b] +=
                    count[a] * count[b] / r->value[s->quantity] / r->value[s->quantity];
            }
        }
    }
    memset(figure, 0, sizeof(double) * COST_CLASSES);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int a = 0; a < COST_CLASSES; a++) {
            double slope = right[a];
            for (int b = 0; b < COST_CLASSES; b++) {
                slope -= products[a][b] * figure[b];
            }
            if (products[a][a] > 0.0) {
                figure[a] = fmax(0.0, figure[a] + slope / products[a][a]);
            }
        }
    }
    for (int a = 0; a < COST_CLASSES; a++) {
        figure[a] = products[a][a] > 0.0 ? figure[a] : COST_UNSEEN;
    }
}

static double sum_of(const row *r, const selection *s, const double figure[static COST_CLASSES]) {
    const double *count = cost_counted(&r->counts, s->quantity);
    double sum = 0.0;
    for (int a = 0; a < COST_CLASSES; a++) {
        sum += figure[a] > 0.0 ? count[a] * figure[a] : 0.0;
    }
    return sum;
}

static int by_size(const void *one, const void *other) {
    const double a = *(const double *)one;
    const double b = *(const double *)other;
    return (a > b) - (a < b);
}

/* A line of a table: half, nine of ten and all of the factors are no more than. Returns nine of ten. */
static double tell(const selection *s, double *factor, int count) {
    qsort(factor, (size_t)count, sizeof *factor, by_size);
    const double nine = factor[(int)(0.9 * (count - 1) + 0.5)];
    fprintf(stderr, "| %s | %s | %s | %d | %.0f %% | %.0f %% | %.0f %% |\n", s->board->name,
            cost_number_words[s->number], words_of[s->quantity], count,
            100.0 * (factor[count / 2] - 1.0), 100.0 * (nine - 1.0),
            100.0 * (factor[count - 1] - 1.0));
    return nine;
}

static double factor_of(double one, double other) {
    return one > other ? one / other : other / one;
}

static void write_row(const selection *s) {
    static double factor[ROWS_MOST];
    double figure[3][COST_CLASSES];
    double longest = 1.0;
    int count = 0;
    for (unsigned half = 0; half < 3; half++) {
        solve(s, half, figure[half]);
    }
    for (int i = 0; i < row_count; i++) {
        const row *r = &rows[i];
        if (is_of(r, s)) {
            const double sum = sum_of(r, s, figure[1 - r->half]);
            factor[count++] = sum > 0.0 ? factor_of(sum, r->value[s->quantity]) : 1e3;
            if (s->quantity <= COST_OF_CYCLES) {
                longest = fmax(longest, r->longest[s->quantity]);
            }
        }
    }
    if (count == 0 || (s->quantity == COST_OF_CYCLES && s->board->cycles == COST_RANGE)) {
        return;
    }
    static const char *const numbers[COST_NUMBERS] = {"FLOAT", "DOUBLE", "FIXED"};
    printf("{\"%s\", COST_%s, COST_OF_%s, %.3g, %.3g, {", s->board->name, numbers[s->number],
           words_of[s->quantity], tell(s, factor, count), longest);
    for (int a = 0; a < COST_CLASSES; a++) {
        printf("%s%.3g", a > 0 ? ", " : "", figure[2][a]);
    }
    printf("}},\n");
}

int main(int count, char **words) {
    if (count != 2) {
        fputs("usage: price_table ROWS.csv\n", stderr);
        return 2;
    }
    rows = calloc(ROWS_MOST, sizeof *rows);
    if (rows == NULL) {
        return 1;
    }
    read_rows(words[1]);
    puts(
        "/* cost_rows.inc: the cost of one operation of each class (cost.h); written by `make price-table`. */\n\n"
        "/* clang-format off */\nstatic const cost_row cost_rows[] = {");
    fputs(
        "| board | number | of a step | counted | half within | nine of ten within | all within |\n"
        "|---|---|---|---|---|---|---|\n",
        stderr);
    for (int b = 0; b < cost_board_count; b++) {
        for (int n = 0; n < COST_NUMBERS; n++) {
            for (int q = 0; q < COST_QUANTITIES; q++) {
                const selection s = {&cost_boards[b], (cost_number)n, (cost_quantity)q};
                write_row(&s);
            }
        }
    }
    puts("};\n/* clang-format on */");
    return row_count > 0 ? 0 : 1;
}
