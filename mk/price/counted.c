/* counted.c: see counted.h. */
#include "counted.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/hashing.h"
#include "host/commands/load.h"
#include "host/commands/options.h"

enum { WORDS_MAX = 16 };

counted *rows;
int row_count;

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

/* "rk38-compensated-lookup", "rk4-tables:linear-cells:64" as words of a command line; returns how many. */
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
        char *given = strchr(word, ':');
        if (given != NULL) {
            *given = '\0';
        }
        snprintf(options[count], sizeof options[count], "%s%s", is_angles ? "" : "--", word);
        words[count] = options[count];
        count++;
        if (given != NULL) {
            snprintf(options[count], sizeof options[count], "%s", given + 1);
            words[count] = options[count];
            count++;
        }
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
            cost_counts c = cost_counts_of(made.image, board, r->number);
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

void read_rows(const char *path) {
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

const char *const quantity_words[COST_QUANTITIES] = {
#define QUANTITY_WORD(id, word) word,
    COST_QUANTITY_ROWS(QUANTITY_WORD)};

int by_size(const void *one, const void *other) {
    const double a = *(const double *)one;
    const double b = *(const double *)other;
    return (a > b) - (a < b);
}
