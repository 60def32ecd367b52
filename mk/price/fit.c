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
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/hashing.h"
#include "host/commands/load.h"
#include "host/commands/options.h"
#include "host/price/cost_row.h"

enum { ROWS_MAX = 20000, COLUMNS = 15, WORDS_MAX = 16, SWEEPS = 4000 };

typedef struct counted {
    char line[1024];
    char *column[COLUMNS];
    int board; /* of cost_boards */
    cost_number number;
    bool fitted; /* else it is for testing */
    bool contacts;
    bool derived;
    cost predicted;
    double feature[COST_FEATURES];
    double value[COST_QUANTITIES]; /* 0: not counted */
    wh_method method;
} counted;

static counted *rows;
static int row_count;

/* --- reading -----------------------------------------------------------------------------------------*/

static bool cut(counted *r) {
    int count = 0;
    bool quoted = false;
    r->column[count++] = r->line;
    for (char *at = r->line; *at != '\0'; at++) {
        quoted = quoted != (*at == '"');
        if (*at == '\n') {
            *at = '\0';
            break;
        }
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

/* "rk38-compensated-lookup" as words of a command line; returns how many. */
static int setting_words(char *setting, char *words[WORDS_MAX]) {
    static char of_angles[] = "--angles";
    static char of_method[] = "--method";
    static char options[WORDS_MAX][64];
    int count = 0;
    size_t longest = 0;
    for (int m = 0; m < WH_METHODS; m++) {
        const size_t length = strlen(wh_methods[m].word);
        if (strncmp(setting, wh_methods[m].word, length) == 0 && length > longest &&
            (setting[length] == '-' || setting[length] == '\0')) {
            longest = length;
        }
    }
    words[count++] = of_method;
    snprintf(options[count], sizeof options[count], "%.*s", (int)longest, setting);
    words[count] = options[count];
    count++;
    for (char *word = strtok(setting + longest, "-"); word != NULL; word = strtok(NULL, "-")) {
        bool is_angles = false;
        for (int a = 0; a < IMAGE_ANGLES; a++) {
            is_angles = is_angles || strcmp(word, image_angles_words[a]) == 0;
        }
        if (is_angles) {
            words[count++] = of_angles;
        }
        snprintf(options[count], sizeof options[count], "%s%s", is_angles ? "" : "--", word);
        words[count] = options[count];
        count++;
    }
    return count;
}

/* The scene once more, with its setting, and what is counted in it. */
static bool derive(counted *r) {
    char setting[128];
    char *words[WORDS_MAX];
    source_model from;
    loaded made = {0};
    const mechanism *of;
    const scene *in;
    common_options options = options_defaults();
    bool bad = false;
    snprintf(setting, sizeof setting, "%s", r->column[6]);
    const int count = setting_words(setting, words);
    for (int at = 0; at < count && !bad;) {
        bad = !options_take("price_fit", OPTIONS_ENGINE, count, words, &at, &options, &bad) || bad;
    }
    bool done = !bad && source_open(&from, r->column[4]) == EXIT_DONE;
    if (done) {
        const load_wish wish = {
            .settings = options.integration, .use = IMAGE_TO_WRITE, .conserve = true};
        const overrides changes = options_overrides(&options.change);
        done = source_pick(&from, true, &of, &in) == EXIT_DONE &&
               load(&made, &from, of, in, &changes, &wish) == EXIT_DONE;
        if (done) {
            const cost_board *board = &cost_boards[r->board];
            cost_counts c = cost_counts_of(made.image, board->fpu, r->number);
            c.smooth = 1.0;
            cost_features(&c, r->feature);
            r->contacts = made.image->contacts > 0;
            r->method = made.image->settings.method;
            r->predicted = cost_of(made.image, board, r->number);
            unload(&made);
        }
        source_close(&from);
    }
    options_forget(&options);
    return done;
}

/* Are there random steps behind the most of its scenes with contacts (measure.sh)? On emulators under the plugin. */
static bool has_worst(const counted *r) {
    return cost_boards[r->board].cycles != COST_SIMULATED &&
           strcmp(cost_boards[r->board].name, "host") != 0;
}

static void read_rows(const char *path) {
    FILE *in = fopen(path, "r");
    char line[1024];
    if (in == NULL) {
        fprintf(stderr, "price_fit: error: %s cannot be read\n", path);
        exit(2);
    }
    while (fgets(line, sizeof line, in) != NULL && row_count < ROWS_MAX) {
        counted *r = &rows[row_count];
        memset(r, 0, sizeof *r);
        memcpy(r->line, line, sizeof line);
        if (!cut(r) || strcmp(r->column[0], "commit") == 0) {
            continue;
        }
        const cost_board *board = cost_board_named(r->column[3]);
        r->board = board != NULL ? (int)(board - cost_boards) : -1;
        r->number = strcmp(r->column[5], "double") == 0 ? COST_DOUBLE : COST_FLOAT;
        r->fitted = hash_text(r->column[4], strlen(r->column[4])) / 16 % 2 == 0;
        if (strlen(r->column[4]) > 6 &&
            strcmp(r->column[4] + strlen(r->column[4]) - 6, ".whirl") == 0) {
            continue; /* a mechanism without a scene stands still: zeros are no operands to take a mean of */
        }
        if (r->board < 0 || !derive(r)) {
            fprintf(stderr, "price_fit: left out: %s %s\n", r->column[4], r->column[6]);
            continue;
        }
        const double instructions = strtod(r->column[7], NULL);
        r->value[r->contacts ? COST_OF_CONTACT_MEAN : COST_OF_INSTRUCTIONS] = instructions;
        if (r->contacts && has_worst(r)) {
            r->value[COST_OF_CONTACT_WORST] = strtod(r->column[8], NULL);
        }
        if (!r->contacts) {
            r->value[COST_OF_CYCLES] = strtod(r->column[9], NULL);
            r->value[COST_OF_FLASH] = strtod(r->column[12], NULL);
            r->value[COST_OF_RAM] = strtod(r->column[13], NULL);
            r->value[COST_OF_STACK] = strtod(r->column[14], NULL);
        }
        row_count++;
    }
    fclose(in);
}

/* --- fitting ------------------------------------------------------------------------------------------*/

static bool takes_part(const counted *r, int board, cost_number number, cost_quantity q) {
    return r->board == board && r->number == number && r->value[q] > 0.0;
}

/* Least squares of (sum - value) / value, no figure below zero, one figure after the other: the normal equations
 * A figure = b, minimised along each axis in turn. */
static void solve(double (*a)[COST_FEATURES], const double *b, double *figure) {
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int i = 0; i < COST_FEATURES; i++) {
            if (a[i][i] <= 0.0) {
                continue;
            }
            double rest = b[i];
            for (int k = 0; k < COST_FEATURES; k++) {
                rest -= k == i ? 0.0 : a[i][k] * figure[k];
            }
            figure[i] = rest > 0.0 ? rest / a[i][i] : 0.0;
        }
    }
}

static cost_fit fit(int board, cost_number number, cost_quantity q) {
    static double a[COST_FEATURES][COST_FEATURES];
    static double b[COST_FEATURES];
    cost_fit f = {.bound = 1.0};
    memset(a, 0, sizeof a);
    memset(b, 0, sizeof b);
    for (int r = 0; r < row_count; r++) {
        if (!takes_part(&rows[r], board, number, q) || !rows[r].fitted) {
            continue;
        }
        f.cases++;
        f.largest = rows[r].value[q] > f.largest ? rows[r].value[q] : f.largest;
        for (int i = 0; i < COST_FEATURES; i++) {
            const double x = (cost_feature_taken[i] >> q & 1U) != 0
                                 ? rows[r].feature[i] / rows[r].value[q]
                                 : 0.0;
            b[i] += x;
            for (int k = 0; k < COST_FEATURES && x != 0.0; k++) {
                const bool taken = (cost_feature_taken[k] >> q & 1U) != 0;
                a[i][k] += taken ? x * (rows[r].feature[k] / rows[r].value[q]) : 0.0;
            }
        }
    }
    solve(a, b, f.figure);
    for (int i = 0; i < COST_FEATURES; i++) {
        if ((cost_feature_taken[i] >> q & 1U) != 0 && a[i][i] <= 0.0) {
            f.figure[i] = COST_UNSEEN;
        }
    }
    return f;
}

/* How far off, as a factor of 1 or more; 0 where nothing is predicted. */
static double off_by(const cost_fit *f, const counted *r, cost_quantity q) {
    double feature[COST_FEATURES];
    int unseen;
    for (int i = 0; i < COST_FEATURES; i++) {
        feature[i] = (cost_feature_taken[i] >> q & 1U) != 0 ? r->feature[i] : 0.0;
    }
    const double value = cost_fit_at(f, feature, &unseen);
    return value <= 0.0 ? 0.0 : value > r->value[q] ? value / r->value[q] : r->value[q] / value;
}

static int by_size(const void *one, const void *other) {
    const double a = *(const double *)one;
    const double b = *(const double *)other;
    return (a > b) - (a < b);
}

static const char *const quantity_words[COST_QUANTITIES] = {
#define QUANTITY_WORD(id, word) word,
    COST_QUANTITY_ROWS(QUANTITY_WORD)};

/* What a step of the scenes with contacts would take without, as the fit has it: their figures lean on it. */
static void add_smooth(const cost_fit *smooth, int board, cost_number number) {
    for (int i = 0; i < row_count; i++) {
        counted *r = &rows[i];
        if (r->board == board && r->number == number && r->contacts) {
            double feature[COST_FEATURES];
            int unseen;
            for (int f = 0; f < COST_FEATURES; f++) {
                feature[f] =
                    (cost_feature_taken[f] >> COST_OF_INSTRUCTIONS & 1U) != 0 ? r->feature[f] : 0.0;
            }
            const double value = cost_fit_at(smooth, feature, &unseen);
            r->feature[COST_F_SMOOTH] *= value;
            r->feature[COST_F_EVENT_SMOOTH] *= value;
            if (value <= 0.0) {
                r->value[COST_OF_CONTACT_MEAN] = r->value[COST_OF_CONTACT_WORST] = 0.0;
            }
        }
    }
}

/* The line of the table, and the bound: the farthest of either half, and a quarter of that again. */
static void judge(cost_fit *f, int board, cost_number number, cost_quantity q) {
    static double off[2][ROWS_MAX];
    int count[2] = {0, 0};
    int unseen = 0;
    double farthest = 1.0;
    const bool shows = getenv("PRICE_SHOW") != NULL;
    for (int r = 0; r < row_count; r++) {
        if (takes_part(&rows[r], board, number, q)) {
            const double by = off_by(f, &rows[r], q);
            unseen += by == 0.0;
            if (by > 0.0) {
                off[rows[r].fitted][count[rows[r].fitted]++] = by;
                farthest = by > farthest ? by : farthest;
            }
            if (shows && by > 1.08) {
                fprintf(stderr, "    %s %s %s %s: %g, off by %.3f%s\n", quantity_words[q],
                        rows[r].column[3], rows[r].column[4], rows[r].column[6], rows[r].value[q],
                        by, rows[r].fitted ? "" : " (test)");
            }
        }
    }
    f->bound = 1.0 + ceil(1.25 * (farthest - 1.0) * 100.0) / 100.0;
    fprintf(stderr, "| `%s` | %s | %s |", cost_boards[board].name, cost_number_words[number],
            quantity_words[q]);
    for (int half = 1; half >= 0; half--) {
        qsort(off[half], (size_t)count[half], sizeof off[half][0], by_size);
        if (count[half] == 0) {
            fprintf(stderr, " 0 | | |");
            continue;
        }
        fprintf(stderr, " %d | %.1f %% | %.1f %% |", count[half],
                100.0 * (off[half][count[half] / 2] - 1.0),
                100.0 * (off[half][count[half] - 1] - 1.0));
    }
    fprintf(stderr, " %d | %.2f |\n", unseen, f->bound);
}

/* --- writing ------------------------------------------------------------------------------------------*/

static void write_fit(const cost_fit *f, cost_quantity q) {
    static const char *const ids[COST_QUANTITIES] = {
#define QUANTITY_ID(id, word) "COST_OF_" #id,
        COST_QUANTITY_ROWS(QUANTITY_ID)};
    printf("             [%s] = {.cases = %d, .bound = %.2f, .largest = %.0f, .figure = {\n",
           ids[q], f->cases, f->bound, f->largest);
    for (int i = 0; i < COST_FEATURES; i++) {
        if (f->figure[i] == COST_UNSEEN) {
            printf("                 [COST_F_%s] = COST_UNSEEN,\n", cost_feature_words[i]);
        } else if (f->figure[i] > 0.0) {
            printf("                 [COST_F_%s] = %.5g,\n", cost_feature_words[i], f->figure[i]);
        }
    }
    printf("             }},\n");
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
        cost_fit f = fit(board, number, (cost_quantity)q);
        if (q == COST_OF_INSTRUCTIONS) {
            add_smooth(&f, board, number);
        }
        if (f.cases > 0) {
            judge(&f, board, number, (cost_quantity)q);
            write_fit(&f, (cost_quantity)q);
        }
    }
    printf("     }},\n");
}

static void write_all(void) {
    printf(
        "/* cost_rows.h: what each class of work costs, by board and number: fitted to counted steps and written by\n"
        " * `make price-fit`. Do not edit. */\n/* clang-format off */\n#include \"cost_row.h\"\n\n"
        "static const cost_row cost_rows[] = {\n");
    fprintf(
        stderr,
        "| board | number | quantity | fitted | median | largest | not fitted | median | largest | unseen | bound |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int b = 0; b < cost_board_count; b++) {
        for (int n = 0; n < COST_NUMBERS; n++) {
            write_row(b, (cost_number)n);
        }
    }
    printf("};\n/* clang-format on */\n");
}

/* --- checking ------------------------------------------------------------------------------------------*/

typedef struct checked {
    double off[ROWS_MAX];
    int count;
    int beyond;
    int unknown;
} checked;

static void check_figure(const cost_figure *told, double value, const counted *r, const char *what,
                         checked *to) {
    if (value <= 0.0) {
        return;
    }
    if (told->basis != COST_PREDICTED) {
        to->unknown++;
        return;
    }
    to->off[to->count++] = told->value > value ? told->value / value : value / told->value;
    if (value > told->most * (1.0 + 1e-9) || value < told->least * (1.0 - 1e-9)) {
        to->beyond++;
        printf(
            "not within its bound: %s %s %s %s %s: predicted %.0f (%.0f to %.0f), counted %.0f\n",
            r->column[3], r->column[5], r->column[4], r->column[6], what, told->value, told->least,
            told->most, value);
    }
}

static int check_all(void) {
    static checked to[COST_QUANTITIES];
    int beyond = 0;
    for (int i = 0; i < row_count; i++) {
        const counted *r = &rows[i];
        const cost *p = &r->predicted;
        check_figure(&p->instructions, r->value[COST_OF_INSTRUCTIONS], r, "instructions",
                     &to[COST_OF_INSTRUCTIONS]);
        check_figure(&p->cycles, r->value[COST_OF_CYCLES], r, "cycles", &to[COST_OF_CYCLES]);
        check_figure(&p->flash_bytes, r->value[COST_OF_FLASH], r, "flash", &to[COST_OF_FLASH]);
        check_figure(&p->ram_bytes, r->value[COST_OF_RAM], r, "RAM", &to[COST_OF_RAM]);
        check_figure(&p->stack_bytes, r->value[COST_OF_STACK], r, "stack", &to[COST_OF_STACK]);
        check_figure(&p->instructions, r->value[COST_OF_CONTACT_MEAN], r, "mean with contacts",
                     &to[COST_OF_CONTACT_MEAN]);
    }
    for (int q = 0; q < COST_QUANTITIES; q++) {
        checked *t = &to[q];
        qsort(t->off, (size_t)t->count, sizeof t->off[0], by_size);
        if (t->count > 0) {
            printf(
                "%s: %d predictions, off by %.1f %% (median), %.1f %% (nine of ten), %.1f %% (largest); %d beyond their bound, %d not predicted\n",
                quantity_words[q], t->count, 100.0 * (t->off[t->count / 2] - 1.0),
                100.0 * (t->off[t->count * 9 / 10] - 1.0), 100.0 * (t->off[t->count - 1] - 1.0),
                t->beyond, t->unknown);
        }
        beyond += t->beyond;
    }
    return row_count == 0 || beyond > 0;
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
