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

enum { ROWS_MAX = 20000, COLUMNS = 15, WORDS_MAX = 16, SWEEPS = 3000, ROUNDS = 6 };
/* Beyond this a row counts less. */
#define FAR_OFF 0.04
/* Of the smallest figure that is fitted: what a compiler makes of the smallest steps is half chance. */
#define SLACK 0.25

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

/* Least squares of weight (sum - value) / value, no figure below zero: the normal equations A figure = b, minimised
 * along one axis after the other. */
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

static bool is_taken(int feature, cost_quantity q) {
    return (cost_feature_taken[feature] >> q & 1U) != 0;
}

/* A row of the system: its features over its value, with this weight. */
static void add_equation(const counted *r, cost_quantity q, double weight,
                         double (*a)[COST_FEATURES], double *b) {
    double x[COST_FEATURES];
    for (int i = 0; i < COST_FEATURES; i++) {
        x[i] = is_taken(i, q) ? r->feature[i] / r->value[q] : 0.0;
    }
    for (int i = 0; i < COST_FEATURES; i++) {
        b[i] += weight * x[i];
        for (int k = 0; k < COST_FEATURES && x[i] != 0.0; k++) {
            a[i][k] += weight * x[i] * x[k];
        }
    }
}

/* The sum of a row. */
static double sum_of(const cost_fit *f, const counted *r, cost_quantity q) {
    double feature[COST_FEATURES];
    int unseen;
    for (int i = 0; i < COST_FEATURES; i++) {
        feature[i] = is_taken(i, q) ? r->feature[i] : 0.0;
    }
    return cost_fit_at(f, feature, &unseen);
}

/* Fitted again and again, each time with less weight for what was far off (Cauchy's weights): a few scenes of which
 * a compiler makes something else must not bend the figures of all others. */
static cost_fit fit(int board, cost_number number, cost_quantity q) {
    static double a[COST_FEATURES][COST_FEATURES];
    static double b[COST_FEATURES];
    cost_fit f = {.cases = 0};
    double smallest = 0.0;
    for (int round = 0; round < ROUNDS; round++) {
        memset(a, 0, sizeof a);
        memset(b, 0, sizeof b);
        f.cases = 0;
        for (int r = 0; r < row_count; r++) {
            if (takes_part(&rows[r], board, number, q) && rows[r].fitted) {
                const double off =
                    round == 0 ? 0.0 : sum_of(&f, &rows[r], q) / rows[r].value[q] - 1.0;
                add_equation(&rows[r], q, 1.0 / (1.0 + off * off / (FAR_OFF * FAR_OFF)), a, b);
                f.cases++;
                smallest =
                    smallest == 0.0 || rows[r].value[q] < smallest ? rows[r].value[q] : smallest;
                f.largest = rows[r].value[q] > f.largest ? rows[r].value[q] : f.largest;
            }
        }
        solve(a, b, f.figure);
    }
    f.slack = q == COST_OF_FLASH || q == COST_OF_RAM || q == COST_OF_STACK ? 0.0 : SLACK * smallest;
    for (int i = 0; i < COST_FEATURES; i++) {
        if (is_taken(i, q) && a[i][i] <= 0.0) {
            f.figure[i] = COST_UNSEEN;
        }
    }
    return f;
}

/* How far off, as a factor of 1 or more; 0 where nothing is predicted. *told: what is predicted. */
static double off_by(const cost_fit *f, const counted *r, cost_quantity q, double *told) {
    const double value = sum_of(f, r, q);
    *told = value;
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
            const double value = sum_of(smooth, r, COST_OF_INSTRUCTIONS);
            r->feature[COST_F_SMOOTH] *= value;
            r->feature[COST_F_EVENT_SMOOTH] *= value;
            if (value <= 0.0) {
                r->value[COST_OF_CONTACT_MEAN] = r->value[COST_OF_CONTACT_WORST] = 0.0;
            }
        }
    }
}

/* What the sum is made of, where PRICE_PARTS names the setting. */
static void show_parts(const cost_fit *f, const counted *r, cost_quantity q) {
    const char *wanted = getenv("PRICE_PARTS");
    for (int i = 0; i < COST_FEATURES && wanted != NULL && strcmp(wanted, r->column[6]) == 0; i++) {
        if ((cost_feature_taken[i] >> q & 1U) != 0 && r->feature[i] * f->figure[i] != 0.0) {
            fprintf(stderr, "        %s: %g times %.4g\n", cost_feature_words[i], r->feature[i],
                    f->figure[i]);
        }
    }
}

/* How far off the rows of one class are: fitted ones and others. */
typedef struct judged {
    double off[2][ROWS_MAX];
    int count[2];
    int unseen;
} judged;

static void tell(const char *board, cost_number number, const char *what, judged *j, double bound) {
    fprintf(stderr, "| `%s` | %s | %s |", board, cost_number_words[number], what);
    for (int half = 1; half >= 0; half--) {
        const int n = j->count[half];
        qsort(j->off[half], (size_t)n, sizeof j->off[half][0], by_size);
        fprintf(stderr, " %d |", n);
        for (int k = 0; k < 3; k++) {
            const int at = k == 0 ? n / 2 : k == 1 ? n * 9 / 10 : n - 1;
            if (n > 0) {
                fprintf(stderr, " %.1f %% |", 100.0 * (j->off[half][at] - 1.0));
            } else {
                fprintf(stderr, " |");
            }
        }
    }
    fprintf(stderr, " %d | %.2f |\n", j->unseen, bound);
}

/* The rows of a class judged, and its line of the table. Returns the bound: the farthest of either half, and a quarter of
 * that again; where there is no row of the class, 3. */
static double judge(const cost_fit *f, int board, cost_number number, cost_quantity q,
                    cost_class class) {
    static const char *const says[COST_CLASSES] = {
#define CLASS_SAYS(id, said) said,
        COST_CLASS_ROWS(CLASS_SAYS)};
    static judged j;
    const bool shows = getenv("PRICE_SHOW") != NULL;
    double bound = 1.0;
    memset(&j, 0, sizeof j);
    for (int r = 0; r < row_count; r++) {
        if (!takes_part(&rows[r], board, number, q) || cost_class_of(rows[r].feature) != class) {
            continue;
        }
        double told;
        const double by = off_by(f, &rows[r], q, &told);
        if (by > 0.0) {
            j.off[rows[r].fitted][j.count[rows[r].fitted]++] = by;
            while (rows[r].value[q] > cost_most(f, told, bound) ||
                   rows[r].value[q] < cost_least(f, told, bound)) {
                bound += 0.005;
            }
        } else {
            j.unseen++;
        }
        if (shows) {
            fprintf(stderr, "    %.3f %s %s %s %s: %g, predicted %.4g%s\n", by, quantity_words[q],
                    rows[r].column[3], rows[r].column[4], rows[r].column[6], rows[r].value[q], told,
                    rows[r].fitted ? "" : " (test)");
            show_parts(f, &rows[r], q);
        }
    }
    bound = 1.0 + ceil(1.25 * (bound - 1.0) * 100.0) / 100.0;
    char what[64];
    snprintf(what, sizeof what, "%s%s", quantity_words[q], says[class]);
    if (j.count[0] + j.count[1] + j.unseen > 0) {
        tell(cost_boards[board].name, number, what, &j, bound);
    }
    return j.count[0] + j.count[1] > 0 ? bound : 3.0;
}

/* --- writing ------------------------------------------------------------------------------------------*/

static void write_fit(const cost_fit *f, cost_quantity q) {
    static const char *const ids[COST_QUANTITIES] = {
#define QUANTITY_ID(id, word) "COST_OF_" #id,
        COST_QUANTITY_ROWS(QUANTITY_ID)};
    printf("             [%s] = {.cases = %d, .slack = %.4g, .bound = {", ids[q], f->cases,
           f->slack);
    for (int c = 0; c < COST_CLASSES; c++) {
        printf("%s%.2f", c > 0 ? ", " : "", f->bound[c]);
    }
    printf("}, .largest = %.0f, .figure = {\n", f->largest);
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
            for (int c = 0; c < COST_CLASSES; c++) {
                f.bound[c] = judge(&f, board, number, (cost_quantity)q, (cost_class)c);
            }
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
        "| board | number | quantity | fitted | median | nine of ten | largest | not fitted | median | nine of ten | largest | unseen | bound |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
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
