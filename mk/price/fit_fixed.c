/* fit_fixed.c: figures of each class of work in fixed point, fitted to counted steps: `make price-fit-fixed` calls it.
 *
 *     price_fit_fixed ROWS.csv >cost_fixed_rows.h    fits, and tells on standard error how well
 *     price_fit_fixed --check ROWS.csv               holds what the program predicts against rows that it was not fitted
 *                                                    to; exit status 1 where one is beyond its bound
 *
 * As fit.c does it for reals, with the features of host/price/cost_fixed_row.h: least squares of the relative error, no figure
 * below zero; scenes of one half, drawn by a hash of their names, are fitted, the others tell how far off it is. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/hashing.h"
#include "host/commands/load.h"
#include "host/fixed/fixed_plan.h"
#include "host/price/cost_fixed.h"

enum { FEATURES = COST_FIXED_FEATURES, ROWS_MOST = 4000, COLUMNS = 15, SWEEPS = 3000, WIDTH = 120 };
/* A bound is so many times as far as the farthest scene was, fitted or not: as in fit.c; of the stack, too. */
#define MARGIN 1.6
#define MARGIN_STACK 2.2

typedef struct counted_row {
    char line[1024];
    char *column[COLUMNS];
    const cost_board *board;
    bool fitted;
    double feature[FEATURES];
    double value[COST_QUANTITIES];
    cost predicted;
} counted_row;

static counted_row *rows;
static int row_count;

/* --- reading --------------------------------------------------------------------------------------------*/

static bool cut(counted_row *r) {
    int count = 0;
    bool quoted = false;
    r->line[strcspn(r->line, "\r\n")] = '\0';
    r->column[count++] = r->line;
    for (char *at = r->line; *at != '\0'; at++) {
        quoted = quoted != (*at == '"');
        if (*at == ',' && !quoted) {
            *at = '\0';
            if (count < COLUMNS) {
                r->column[count] = at + 1;
            }
            count++;
        }
    }
    return count == COLUMNS;
}

/* What stands behind "-WORD:" in a setting such as rk4-step:0.3ms; NULL: nothing. */
static const char *option_of(const char *setting, const char *word, char text[static 40]) {
    const char *at = strstr(setting, word);
    if (at == NULL) {
        return NULL;
    }
    at += strlen(word);
    snprintf(text, 40, "%.*s", (int)strcspn(at, "-"), at);
    return text;
}

/* The scene once more, and what is counted in its step. */
static bool derive(counted_row *r) {
    char step[40];
    char until[40];
    source_model from;
    loaded made = {0};
    const mechanism *of;
    const scene *in;
    const overrides changes = {.step = option_of(r->column[6], "-step:", step),
                               .until = option_of(r->column[6], "-until:", until)};
    const load_wish wish = {
        .settings = IMAGE_SETTINGS_DEFAULT, .use = IMAGE_TO_WRITE, .conserve = true};
    bool done = source_open(&from, r->column[4]) == EXIT_DONE;
    if (done) {
        done = source_pick(&from, true, &of, &in) == EXIT_DONE &&
               load(&made, &from, of, in, &changes, &wish) == EXIT_DONE;
        fixed_plan *plan = done ? fixed_plan_make(made.image, from.errors) : NULL;
        done = plan != NULL;
        if (done) {
            made.image->fixed = plan;
            cost_fixed_features(made.image, r->feature);
            r->predicted = cost_fixed_of(made.image, r->board);
            made.image->fixed = NULL;
        }
        fixed_plan_free(plan);
        unload(&made);
        source_close(&from);
    }
    return done;
}

/* Another board's row of that scene and setting, which has the features already. */
static const counted_row *same_scene(const counted_row *r) {
    for (int i = 0; i < row_count; i++) {
        if (strcmp(rows[i].column[4], r->column[4]) == 0 &&
            strcmp(rows[i].column[6], r->column[6]) == 0) {
            return &rows[i];
        }
    }
    return NULL;
}

/* Features, and where that is asked for what the program says, of which there is another for each board. */
static bool count_row(counted_row *r, bool checks) {
    const counted_row *same = checks ? NULL : same_scene(r);
    if (same != NULL) {
        memcpy(r->feature, same->feature, sizeof r->feature);
    }
    return same != NULL || derive(r);
}

static void read_rows(const char *path, bool checks) {
    FILE *in = fopen(path, "r");
    char line[1024];
    if (in == NULL) {
        fprintf(stderr, "price_fit_fixed: error: %s cannot be read\n", path);
        exit(2);
    }
    while (fgets(line, sizeof line, in) != NULL && row_count < ROWS_MOST) {
        counted_row *r = &rows[row_count];
        memset(r, 0, sizeof *r);
        memcpy(r->line, line, sizeof line);
        if (!cut(r) || strcmp(r->column[5], "fixed") != 0) {
            continue;
        }
        r->board = cost_board_named(r->column[3]);
        r->fitted = hash_text(r->column[4], strlen(r->column[4])) / 16 % 2 == 0;
        if (r->board == NULL || !count_row(r, checks)) {
            fprintf(stderr, "price_fit_fixed: left out: %s %s\n", r->column[4], r->column[6]);
            continue;
        }
        static const int columns[COST_QUANTITIES] = {[COST_OF_INSTRUCTIONS] = 7,
                                                     [COST_OF_CYCLES] = 9,
                                                     [COST_OF_FLASH] = 12,
                                                     [COST_OF_RAM] = 13,
                                                     [COST_OF_STACK] = 14};
        for (int q = 0; q < COST_QUANTITIES; q++) {
            r->value[q] = columns[q] > 0 ? strtod(r->column[columns[q]], NULL) : 0.0;
        }
        row_count++;
    }
    fclose(in);
}

/* --- fitting --------------------------------------------------------------------------------------------*/

static bool takes_part(const counted_row *r, const cost_board *board, int q) {
    return r->board == board && r->value[q] > 0.0;
}

/* Least squares of (sum - value) / value, no figure below zero: the normal equations a figure = b, minimised along one axis
 * after the other. */
static void solve(double (*a)[FEATURES], const double *b, double *figure) {
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int i = 0; i < FEATURES; i++) {
            if (a[i][i] > 0.0) {
                double rest = b[i] + a[i][i] * figure[i];
                for (int k = 0; k < FEATURES; k++) {
                    rest -= a[i][k] * figure[k];
                }
                figure[i] = rest > 0.0 ? rest / a[i][i] : 0.0;
            }
        }
    }
}

static cost_fixed_fit fit(const cost_board *board, int q) {
    static double a[FEATURES][FEATURES];
    static double b[FEATURES];
    cost_fixed_fit f = {.cases = 0};
    memset(a, 0, sizeof a);
    memset(b, 0, sizeof b);
    for (int n = 0; n < row_count; n++) {
        const counted_row *r = &rows[n];
        if (!takes_part(r, board, q) || !r->fitted) {
            continue;
        }
        double x[FEATURES];
        for (int i = 0; i < FEATURES; i++) {
            const bool taken = (cost_fixed_taken[i] >> q & 1U) != 0;
            x[i] = taken ? r->feature[i] / r->value[q] : 0.0;
        }
        for (int i = 0; i < FEATURES; i++) {
            b[i] += x[i];
            for (int k = 0; k < FEATURES; k++) {
                a[i][k] += x[i] * x[k];
            }
        }
        f.cases++;
        f.largest = r->value[q] > f.largest ? r->value[q] : f.largest;
    }
    solve(a, b, f.figure);
    for (int i = 0; i < FEATURES; i++) {
        if (a[i][i] <= 0.0) {
            f.figure[i] = -1.0; /* no fitted scene has it */
        }
    }
    return f;
}

static int by_size(const void *one, const void *other) {
    const double a = *(const double *)one;
    const double b = *(const double *)other;
    return (a > b) - (a < b);
}

static const char *const quantity_words[COST_QUANTITIES] = {
#define QUANTITY_WORD(id, word) word,
    COST_QUANTITY_ROWS(QUANTITY_WORD)};

/* How far off the fitted rows are and the others, a line; the bound. */
static double judge(const cost_fixed_fit *f, const cost_board *board, int q) {
    static double off[2][ROWS_MOST];
    int count[2] = {0, 0};
    double most = 0.0;
    for (int n = 0; n < row_count; n++) {
        const counted_row *r = &rows[n];
        const double sum =
            takes_part(r, board, q) ? cost_fixed_sum(f, (cost_quantity)q, r->feature) : -1.0;
        if (sum > 0.0) {
            const double by = (sum > r->value[q] ? sum / r->value[q] : r->value[q] / sum) - 1.0;
            off[r->fitted][count[r->fitted]++] = by;
            most = by > most ? by : most;
            if (getenv("PRICE_SHOW") != NULL) {
                fprintf(stderr, "    %.3f %s %s %s %s: %g, predicted %.4g%s\n", by,
                        quantity_words[q], board->name, r->column[4], r->column[6], r->value[q],
                        sum, r->fitted ? "" : " (test)");
            }
        }
    }
    const double bound =
        1.0 + ceil((q == COST_OF_STACK ? MARGIN_STACK : MARGIN) * most * 100.0 + 1.0) / 100.0;
    fprintf(stderr, "| `%s` | %s |", board->name, quantity_words[q]);
    for (int half = 1; half >= 0; half--) {
        const int n = count[half];
        qsort(off[half], (size_t)n, sizeof off[half][0], by_size);
        fprintf(stderr, " %d |", n);
        for (int k = 0; k < 3 && n > 0; k++) {
            fprintf(stderr, " %.1f %% |",
                    100.0 * off[half][k == 0   ? n / 2
                                      : k == 1 ? n * 9 / 10
                                               : n - 1]);
        }
    }
    fprintf(stderr, " %.2f |\n", bound);
    return bound;
}

/* --- writing --------------------------------------------------------------------------------------------*/

static void write_fit(const cost_fixed_fit *f, int q) {
    static const char *const ids[COST_QUANTITIES] = {
#define QUANTITY_ID(id, word) "COST_OF_" #id,
        COST_QUANTITY_ROWS(QUANTITY_ID)};
    int column = 0;
    printf("         [%s] = {.cases = %d, .bound = %.2f, .largest = %.0f, .figure = {\n", ids[q],
           f->cases, f->bound, f->largest);
    for (int i = 0; i < FEATURES; i++) {
        if ((cost_fixed_taken[i] >> q & 1U) == 0 || f->figure[i] == 0.0) {
            continue;
        }
        column += column == 0 ? printf("            ") : 0;
        column += printf(" [COST_X_%s] = %.4g,", cost_fixed_words[i], f->figure[i]);
        if (column > WIDTH) {
            printf("\n");
            column = 0;
        }
    }
    printf("%s         }},\n", column > 0 ? "\n" : "");
}

static void write_row(const cost_board *board) {
    double spread[2] = {1.0, 1.0};
    const counted_row *any = NULL;
    for (int n = 0; n < row_count; n++) {
        const counted_row *r = &rows[n];
        for (int k = 0; k < 2 && r->board == board; k++) {
            const double mean = strtod(r->column[7 + 2 * k], NULL);
            const double most = strtod(r->column[8 + 2 * k], NULL);
            spread[k] = mean > 0.0 && most / mean > spread[k] ? most / mean : spread[k];
            any = r;
        }
    }
    if (any == NULL) {
        return;
    }
    const char *flags = any->column[2] + (any->column[2][0] == '"');
    printf("    {.board = \"%s\",\n     .compiler = \"%s %.*s\",\n"
           "     .spread = %.3f, .spread_cycles = %.3f,\n     .fit = {\n",
           board->name, any->column[1], (int)strcspn(flags, "\""), flags, spread[0] + 0.0005,
           spread[1] + 0.0005);
    for (int q = 0; q < COST_QUANTITIES; q++) {
        cost_fixed_fit f = fit(board, q);
        if (f.cases > 0) {
            f.bound = judge(&f, board, q);
            write_fit(&f, q);
        }
    }
    printf("     }},\n");
}

static void write_all(void) {
    printf(
        "/* cost_fixed_rows.h: what each class of work costs in fixed point, by board: fitted to counted steps and written "
        "by\n * `make price-fit-fixed`. Do not edit. */\n/* clang-format off */\n#include \"cost_fixed_row.h\"\n\n"
        "static const cost_fixed_row cost_fixed_rows[] = {\n");
    fprintf(
        stderr,
        "| board | quantity | fitted | median | nine of ten | largest | not fitted | median | nine of ten | "
        "largest | bound |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int b = 0; b < cost_board_count; b++) {
        write_row(&cost_boards[b]);
    }
    printf("};\n/* clang-format on */\n");
}

/* --- checking -------------------------------------------------------------------------------------------*/

static int check_all(void) {
    int beyond = 0;
    int told = 0;
    double off[ROWS_MOST];
    int count = 0;
    for (int n = 0; n < row_count; n++) {
        const counted_row *r = &rows[n];
        const cost *c = &r->predicted;
        const cost_figure *const figures[COST_QUANTITIES] = {[COST_OF_INSTRUCTIONS] =
                                                                 &c->instructions,
                                                             [COST_OF_CYCLES] = &c->cycles,
                                                             [COST_OF_FLASH] = &c->flash_bytes,
                                                             [COST_OF_RAM] = &c->ram_bytes,
                                                             [COST_OF_STACK] = &c->stack_bytes};
        for (int q = 0; q < COST_QUANTITIES; q++) {
            const cost_figure *f = figures[q];
            if (f == NULL || f->basis != COST_PREDICTED || r->value[q] <= 0.0) {
                continue;
            }
            told++;
            if (q == COST_OF_INSTRUCTIONS) {
                off[count++] = fabs(f->value / r->value[q] - 1.0);
            }
            if (r->value[q] < f->least || r->value[q] > f->most) {
                beyond++;
                printf("not within its bound: %s %s %s, %s: %g, promised %g to %g\n", r->column[3],
                       r->column[4], r->column[6], quantity_words[q], r->value[q], f->least,
                       f->most);
            }
        }
    }
    qsort(off, (size_t)count, sizeof off[0], by_size);
    if (count > 0) {
        printf("instructions: %d steps, %.1f %% off in the middle, %.1f %% at most\n", count,
               100.0 * off[count / 2], 100.0 * off[count - 1]);
    }
    printf("%d figures predicted of %d rows, %d beyond their bounds\n", told, row_count, beyond);
    return beyond > 0 || told == 0 ? 1 : 0;
}

int main(int count, char **words) {
    const bool checks = count == 3 && strcmp(words[1], "--check") == 0;
    if (count != 2 && !checks) {
        fputs("usage: price_fit_fixed [--check] ROWS.csv\n", stderr);
        return 2;
    }
    rows = calloc(ROWS_MOST, sizeof *rows);
    if (rows == NULL) {
        return 1;
    }
    read_rows(words[count - 1], checks);
    if (checks) {
        return check_all();
    }
    write_all();
    return 0;
}
