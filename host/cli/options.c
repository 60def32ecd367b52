/* options.c: parsing of the command line. */
#include "options.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "host/base/alloc.h"
#include "host/base/spelling.h"
#include "host/check/finding.h"
#include "host/engine/start.h"
#include "host/fixed/engine_fixed.h"
#include "host/image/image.h"
#include "host/io/gnuplot.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"

typedef struct option_row {
    const char *word;
    const char *value; /* the value's name; "" without a value */
    option_group group;
    const char *text;
} option_row;

#define ROW(id, word, value, group, text) [id] = {word, value, group, text},
static const option_row option_rows[OPTIONS] = {OPTION_ROWS(ROW)};

/* Columns of help texts: a description is between TEXT_COLUMN and TEXT_END; a list of names ends at LINE_COLUMNS. */
enum { TEXT_COLUMN = 23, TEXT_END = 99, LINE_COLUMNS = 78 };

void options_describe(FILE *out, const char *word, const char *value, const char *text) {
    const int width = fprintf(out, "  %s %s", word, value);
    fprintf(out, "%*s", TEXT_COLUMN - width, "");
    int column = TEXT_COLUMN;
    for (; *text != '\0'; text++) {
        const int next = 1 + (int)strcspn(text + 1, " \n"); /* includes the blank before the word */
        if (*text == '\n' || (*text == ' ' && column + next > TEXT_END)) {
            fprintf(out, "\n%*s", TEXT_COLUMN, "");
            column = TEXT_COLUMN;
        } else {
            fputc(*text, out);
            column++;
        }
    }
    fputc('\n', out);
}

static void put_word(FILE *out, const char *word, int *column) {
    const int length = (int)strlen(word) + 1;
    if (*column + length > LINE_COLUMNS) {
        fprintf(out, "\n ");
        *column = 1;
    }
    *column += fprintf(out, " %s", word);
}

void options_usage(FILE *out, const command_usage *usage) {
    char methods[METHODS_TEXT_SIZE];
    const bool named = !usage->described && usage->groups != 0;
    fputs(usage->head, out);
    int column = named ? fprintf(out, " ") : 0;
    for (int i = 0; i < OPTIONS; i++) {
        const option_row *row = &option_rows[i];
        if ((row->group & usage->groups) != 0 && named) {
            put_word(out, row->word, &column);
        } else if ((row->group & usage->groups) != 0) {
            options_describe(out, row->word, row->value,
                             i == OPTION_METHOD ? methods_in_help(methods) : row->text);
        }
    }
    if (named) {
        put_word(out, "(as for `whirl run`)", &column);
        fputc('\n', out);
    }
    fputs(usage->tail != NULL ? usage->tail : "", out);
    if (usage->why[0] != NULL) {
        exit_describe(out, usage->why);
    }
}

bool options_help(int count, char **words, const command_usage *usage) {
    for (int i = 0; i < count; i++) {
        if (strcmp(words[i], "--help") == 0 || strcmp(words[i], "-h") == 0) {
            options_usage(stdout, usage);
            return true;
        }
    }
    return false;
}

bool options_is(const char *word, const char *name) {
    const size_t length = strlen(name);
    return strncmp(word, name, length) == 0 && (word[length] == '\0' || word[length] == '=');
}

const char *options_value(int count, char **words, int at, const char *name) {
    const size_t length = strlen(name);
    return words[at][length] == '=' ? words[at] + length + 1 : at + 1 < count ? words[at + 1] : "";
}

static bool is_new(int count, char **words, int at, const char *name) {
    for (int i = 0; i < at; i++) {
        if (options_is(words[i], name)) {
            fprintf(stderr, "whirl: error: %s is given twice: '%s' and '%s'\n", name, words[i],
                    words[at]);
            if (strcmp(name, "--y") == 0) { /* --y takes a list */
                fprintf(stderr, "hint: --y \"%s, %s\"\n", options_value(count, words, i, name),
                        options_value(count, words, at, name));
            } else {
                fputs("hint: leave one out\n", stderr);
            }
            return false;
        }
    }
    return true;
}

/* If words[*at] is the option `name`, advances *at and returns its value (the word itself if `is_bare`). Else returns
 * NULL. If the value is missing, or if the option is given twice without `repeats`, reports the error and sets *bad. */
static const char *value_of(int count, char **words, int *at, const char *name, bool is_bare,
                            bool repeats, bool *bad) {
    const size_t length = strlen(name);
    const char *word = words[*at];
    if (is_bare ? strcmp(word, name) != 0 : !options_is(word, name)) {
        return NULL;
    }
    ++*at;
    if (is_bare) {
        return word;
    }
    if (!repeats && !is_new(count, words, *at - 1, name)) {
        *bad = true;
    } else if (word[length] == '=') {
        return word + length + 1;
    } else if (*at < count && strncmp(words[*at], "--", 2) != 0) {
        return words[(*at)++];
    } else {
        fprintf(stderr, "whirl: error: %s needs a value\nhint: %s VALUE, or %s=VALUE\n", name, name,
                name);
        *bad = true;
    }
    return NULL;
}

static void push(const char *const **list, int *count, const char *text) {
    const char **longer = alloc_more((void *)*list, *count + 1, sizeof **list);
    *list = longer;
    longer[(*count)++] = text;
}

static const char *keep(common_options *to, char *text) {
    to->owned = alloc_more(to->owned, to->owned_count + 1, sizeof *to->owned);
    to->owned[to->owned_count++] = text;
    return text;
}

void options_set(common_options *options, char *text) {
    if (text != NULL) {
        push(&options->changes.sets, &options->changes.set_count, keep(options, text));
    }
}

static bool is_in(const char *const *list, int count, const char *name) {
    for (int i = 0; i < count; i++) {
        if (strcmp(list[i], name) == 0) {
            return true;
        }
    }
    return false;
}

/* Adds the names in `text`, "E, E,...", to *list. Returns false after an error (reported). */
static bool push_names(common_options *to, const char *const **list, int *count, const char *option,
                       const char *text) {
    const overrides *c = &to->changes;
    for (const char *at = text;; at++) {
        const size_t field = strcspn(at, ",");
        const char *name = keep(to, alloc_trimmed(at, field));
        if (name[0] == '\0') {
            fprintf(stderr,
                    "whirl: error: a name is missing in %s \"%s\"\n"
                    "hint: write names with commas between them: %s drag,ledger\n",
                    option, text, option);
            return false;
        }
        if (strcmp(name, "conserve") == 0 && list == &c->with) {
            fputs("whirl: error: 'conserve' is not an effect, so --with cannot add it: write "
                  "conserve in the scene\n",
                  stderr);
            return false;
        }
        push(list, count, name);
        if (is_in(c->with, c->with_count, "all") && is_in(c->without, c->without_count, "all")) {
            fputs("whirl: error: --with all and --without all contradict each other\n", stderr);
            return false;
        }
        at += field;
        if (*at == '\0') {
            return true;
        }
    }
}

common_options options_defaults(void) {
    return (common_options){.integration = IMAGE_SETTINGS_DEFAULT, .number = &engine_double};
}

void options_forget(common_options *options) {
    const overrides *c = &options->changes;
    const char *const *const lists[] = {c->sets, c->starts, c->with, c->without};
    for (int i = 0; i < options->owned_count; i++) {
        free(options->owned[i]);
    }
    free(options->owned);
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        free((void *)lists[i]);
    }
}

bool options_fail(const char *command, const char *format, ...) {
    va_list values;
    va_start(values, format);
    fprintf(stderr, "whirl %s: error: ", command);
    vfprintf(stderr, format, values);
    fputc('\n', stderr);
    va_end(values);
    return false;
}

bool options_is_standard(const char *file) { return file != NULL && strcmp(file, "-") == 0; }

bool options_json_is_alone(const char *command, bool json, const char *csv) {
    return !json || !options_is_standard(csv) ||
           options_fail(command,
                        "--json and rows cannot share standard output\nhint: --csv rows.csv");
}

int options_choose(const char *command, const char *what, const char *value, const void *rows,
                   size_t size, int count) {
    const char *row = rows;
    for (int i = 0; i < count; i++) {
        const char *const *word = (const void *)(row + (size_t)i * size);
        if (strcasecmp(value, *word) == 0) {
            return i;
        }
    }
    fprintf(stderr, "whirl %s: error: there is no %s '%s'\nhint: choose one of", command, what,
            value);
    for (int i = 0; i < count; i++) {
        const char *const *word = (const void *)(row + (size_t)i * size);
        fprintf(stderr, "%s %s", i > 0 ? "," : "", *word);
    }
    fputc('\n', stderr);
    return -1;
}

bool options_is_name(const char *command, const char *name, int most) {
    static const char letters[] = "_ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    const size_t length = strlen(name);
    const bool good = length > 0 && length <= (size_t)most && strspn(name, letters) == length &&
                      !(name[0] >= '0' && name[0] <= '9');
    return good || options_fail(command,
                                "'%.70s' is not a valid name\nhint: use letters, digits and _, "
                                "at most %d characters, no digit at the beginning",
                                name, most);
}

bool options_number(const char *command, const char *option, const char *text, double least,
                    double most, const char *hint, double *number) {
    const char *end = text;
    *number = decimal_read(text, &end);
    const bool good = end != text && *end == '\0' && *number >= least && *number <= most;
    return good || options_fail(command, "%s takes a number from %g to %g, not '%.40s'\nhint: %s",
                                option, least, most, text, hint);
}

bool options_time(const char *command, const char *option, const char *text, const mechanism *of,
                  double most_s, double *time_s) {
    diags *errors = diags_new();
    *time_s = 0.0;
    const bool good =
        text == NULL ||
        (instance_duration(of, NULL, NULL, option, text, errors, time_s) && *time_s <= most_s);
    diags_free(errors); /* not printed: the message below is clearer */
    return good || options_fail(command,
                                "--%s '%s' is not a time%s\nhint: write a time such as 20us or 1ms",
                                option, text, isfinite(most_s) ? " from 0 to one hour" : "");
}

/* Reads --strict, --strict=off or --strict=LIMIT (run_checks_fails()). Returns false for other words. */
static bool take_strict(const char *command, int count, char **words, int *at, double *strict,
                        bool *bad) {
    if (*bad || !options_is(words[*at], "--strict")) {
        return false;
    }
    const char *value = words[*at] + sizeof "--strict" - 1;
    ++*at;
    *strict = STRICT_FINDINGS;
    if (strcmp(value, "=off") == 0) {
        *strict = STRICT_OFF;
    } else if (*value == '=') {
        const char *end;
        *strict = decimal_read(value + 1, &end);
        *bad = end == value + 1 || *end != '\0' || !(*strict > 0.0 && *strict <= 1.0);
    } else { /* "--strict 1e-3" */
        *bad = *at < count && isdigit((unsigned char)words[*at][0]);
    }
    if (*bad) {
        fprintf(
            stderr,
            "whirl %s: error: --strict takes 'off', or a fraction of the largest entry of the energy balance, above 0 and at most 1\n"
            "hint: --strict=off or --strict=1e-6\n",
            command);
    }
    return true;
}

static bool take_cells(const char *command, const char *value, int *cells) {
    static const char hint[] = "a power of two: --cells 64, --cells 256, ...";
    double number;
    if (!options_number(command, "--cells", value, IMAGE_CELLS_LEAST, IMAGE_CELLS_MOST, hint,
                        &number)) {
        return false;
    }
    *cells = (int)number;
    if (number > (double)*cells || (*cells & (*cells - 1)) != 0) {
        return options_fail(command, "--cells %s is not a power of two\nhint: %s", value, hint);
    }
    return true;
}

#define CHOOSE(what, rows, count, type, setting) \
    chosen = options_choose(command, what, value, rows, sizeof(rows)[0], count); \
    to->integration.setting = chosen < 0 ? to->integration.setting : (type)chosen; \
    return chosen >= 0

static bool take(common_option which, const char *command, const char *value, common_options *to) {
    static const struct {
        const char *word;
        const engine_kind *kind;
    } numbers[] = {{"double", &engine_double}, {"float", &engine_float}, {"fixed", &engine_fixed}};
    overrides *c = &to->changes;
    const char *word = option_rows[which].word;
    const bool knows_fixed = strcmp(command, "run") == 0 || strcmp(command, "derive") == 0 ||
                             strcmp(command, "trust") == 0;
    int chosen;
    switch (which) {
    case OPTION_SET: push(&c->sets, &c->set_count, value); break;
    case OPTION_START: push(&c->starts, &c->start_count, value); break;
    case OPTION_WITH: return push_names(to, &c->with, &c->with_count, word, value);
    case OPTION_WITHOUT: return push_names(to, &c->without, &c->without_count, word, value);
    case OPTION_STEP: c->step = value; break;
    case OPTION_UNTIL: c->until = value; break;
    case OPTION_METHOD: CHOOSE("method", wh_methods, WH_METHODS, wh_method, method);
    case OPTION_COMPENSATED: to->integration.compensated = true; break;
    case OPTION_STABILIZED: to->integration.stabilized = true; break;
    case OPTION_ANGLES:
        CHOOSE("form of angles", image_angles_words, IMAGE_ANGLES, image_angles, angles);
    case OPTION_MATRIX:
        CHOOSE("matrix", image_matrix_words, IMAGE_MATRICES, image_matrix_of, matrix);
    case OPTION_TABLES:
        CHOOSE("form of tables", image_tables_words, IMAGE_TABLES_FORMS, image_tables, tables);
    case OPTION_CELLS: return take_cells(command, value, &to->integration.cells);
    case OPTION_NUMBER:
        chosen = options_choose(command, "number", value, numbers, sizeof numbers[0],
                                (int)(sizeof numbers / sizeof numbers[0]) - !knows_fixed);
        to->number = chosen < 0 ? to->number : numbers[chosen].kind;
        return chosen >= 0;
    }
    return true;
}

bool options_take(const char *command, unsigned groups, int count, char **words, int *at,
                  common_options *to, bool *bad) {
    for (int i = 0; i < OPTIONS && !*bad; i++) {
        const option_row *row = &option_rows[i];
        const bool repeats = i <= OPTION_WITHOUT;
        const char *value =
            (row->group & groups) != 0
                ? value_of(count, words, at, row->word, row->value[0] == '\0', repeats, bad)
                : NULL;
        if (value != NULL) {
            *bad = *bad || !take((common_option)i, command, value, to);
            return true;
        }
    }
    return false;
}

/* === the words of a command ================================================================== */

static unsigned groups_of(const target_reader *r) {
    return r->passed != NULL ? OPTIONS_SCENE : r->usage->groups;
}

static void say_unknown(const target_reader *r, const char *word) {
    nearest search = nearest_start(word, strlen(word));
    for (int i = 0; i < OPTIONS; i++) {
        if ((option_rows[i].group & groups_of(r)) != 0) {
            nearest_offer(&search, option_rows[i].word);
        }
    }
    for (const own_option *o = r->table; o != NULL && o->word != NULL; o++) {
        nearest_offer(&search, o->word);
    }
    nearest_offer(&search, "--help");
    fprintf(stderr, "whirl %s: error: unknown option '%s'\n", r->command, word);
    if (search.best != NULL && strcmp(word, "--") != 0) {
        fprintf(stderr, "hint: did you mean %s?\n", search.best);
    } else {
        fprintf(stderr, "hint: whirl %s --help lists the options\n", r->command);
    }
}

static bool take_value(const char *command, const own_option *o, const char *value) {
    if (o->number == NULL) {
        const int at = o->count != NULL ? *o->count : 0;
        if (o->limit > 0 && at == o->limit) {
            fprintf(stderr, "whirl %s: error: more than %d %s options\n", command, o->limit,
                    o->word);
            return false;
        }
        o->text[at] = value;
        if (o->count != NULL) {
            *o->count = at + 1;
        }
        return true;
    }
    if (!options_number(command, o->word, value, o->least, o->most, o->hint, o->number)) {
        return false;
    }
    if (o->whole && number_floor(*o->number) < *o->number) {
        return options_fail(command, "%s takes a whole number, not '%.40s'\nhint: %s", o->word,
                            value, o->hint);
    }
    return true;
}

static bool take_own(const target_reader *r, int count, char **words, int *at, bool *bad) {
    for (const own_option *o = r->table; o != NULL && o->word != NULL && !*bad; o++) {
        const char *value = NULL;
        if (o->strict != NULL) {
            if (take_strict(r->command, count, words, at, o->strict, bad)) {
                return true;
            }
        } else {
            value = value_of(count, words, at, o->word, o->flag != NULL || o->is_bare,
                             o->count != NULL, bad);
        }
        if (value != NULL && o->flag != NULL) {
            *o->flag = true;
        } else if (value != NULL) {
            *bad = !take_value(r->command, o, value);
        }
        if (value != NULL) {
            return true;
        }
    }
    return false;
}

static bool take_target(const target_reader *r, char *word, const char **target) {
    if (word[0] == '-' && word[1] != '\0') {
        say_unknown(r, word);
        return false;
    }
    if (r->many != NULL) {
        r->many[(*r->many_count)++] = word;
    } else if (*target != NULL) {
        return options_fail(r->command, "the command takes only one %s: '%s' is a second one",
                            r->one != NULL ? r->one : "scene", word);
    }
    *target = word;
    return true;
}

/* === the files of a command ================================================================== */

bool options_can_write(const char *command, const char *option, own_file kind, const char *file) {
    if (file == NULL || kind < FILE_WRITTEN_LATE) {
        return true;
    }
    const bool draws = kind == FILE_DRAWN;
    return (!draws || gnuplot_can_draw_for(command, option, file)) && atomic_file_can(file) &&
           (!draws || gnuplot_is_there());
}

/* Reports an output that would overwrite the input. */
static bool spares(const target_reader *r, const own_option *output, const char *input) {
    char *read = source_file(input);
    const bool good = read == NULL || !files_meet(*output->text, read, true);
    if (!good) {
        (void)options_fail(
            r->command,
            "%s would overwrite %s, which whirl reads\nhint: give the output another "
            "name",
            output->word, read);
    }
    free(read);
    return good;
}

/* Is the output different from all other files of the command, and can it be written? */
static bool output_is_good(const target_reader *r, const own_option *output, const char *target) {
    for (const own_option *o = r->table; o->word != NULL; o++) {
        const char *other = o->file != FILE_NONE ? *o->text : NULL;
        if (other != NULL && o->file == FILE_READ && !spares(r, output, other)) {
            return false;
        }
        if (other != NULL && o->file != FILE_READ && o > output &&
            files_meet(*output->text, other, false)) {
            return options_fail(r->command, "%s and %s cannot share a file", output->word, o->word);
        }
    }
    for (int i = 0; r->many != NULL && i < *r->many_count; i++) {
        if (!spares(r, output, r->many[i])) {
            return false;
        }
    }
    return (target == NULL || spares(r, output, target)) &&
           options_can_write(r->command, output->word, output->file, *output->text);
}

bool target_read(const target_reader *r, int count, char **words, common_options *common,
                 const char **target) {
    bool bad = false;
    *target = NULL;
    for (int at = 0; at < count && !bad;) {
        const int from = at;
        if (options_take(r->command, groups_of(r), count, words, &at, common, &bad)) {
            for (int i = from; r->passed != NULL && i < at; i++) {
                r->passed[(*r->passed_count)++] = words[i];
            }
        } else if (!bad && !take_own(r, count, words, &at, &bad) && !bad) {
            bad = !take_target(r, words[at++], target);
        }
    }
    for (const own_option *o = r->table; !bad && o != NULL && o->word != NULL; o++) {
        bad = o->file > FILE_READ && *o->text != NULL && !output_is_good(r, o, *target);
    }
    return !bad;
}

int target_command(const target_reader *r, int count, char **words, common_options *common,
                   void *options, const char **target) {
    int code = EXIT_BAD_INPUT;
    if (options_help(count, words, r->usage)) {
        code = EXIT_DONE;
    } else if (target_read(r, count, words, common, target)) {
        if (*target == NULL && !r->none) {
            options_usage(stderr, r->usage);
        } else if (r->work_on == NULL) {
            code = r->work(options);
        } else {
            source_model from;
            code = source_open(&from, *target);
            code = code == EXIT_DONE ? r->work_on(&from, options) : code;
            source_close(&from);
        }
    }
    if (common != NULL) {
        options_forget(common);
    }
    return code;
}

int target_load(loaded *made, source_model *from, const common_options *common,
                load_request request) {
    const mechanism *of;
    const scene *in;
    *made = (loaded){0};
    request.settings = common->integration;
    const bool one = request.scene || from->model->scene_count == 1;
    const int code = source_pick(from, one, &of, &in);
    return code == EXIT_DONE ? load(made, from, of, in, &common->changes, &request) : code;
}
