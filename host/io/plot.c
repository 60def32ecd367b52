/* plot.c: curves of runs: data, choice of quantities, and gnuplot's commands. */
#include "host/io/plot.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/version.h"
#include "host/base/alloc.h"
#include "host/base/spelling.h"
#include "host/io/gnuplot.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"

/* Converts der(der(x)) to x''. The caller frees the result. */
static char *shown_name(const char *name) {
    size_t length = strlen(name);
    static const char primes[] = "'''''''''''''''";
    int order = 0;
    while (strncmp(name, "der(", 4) == 0 && name[length - 1] == ')' &&
           order < (int)sizeof primes - 1) {
        name += 4;
        length -= 5;
        order++;
    }
    return alloc_words("%.*s%.*s", (int)length, name, order, primes);
}

static int column_named(const plot_run *run, const char *name) {
    for (int i = 0; i < run->columns; i++) {
        if (strcmp(run->column[i].shown, name) == 0 || strcmp(run->column[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static void say_unknown(const char *command, const char *name, const plot_run *runs, int count) {
    nearest search = nearest_start(name, strlen(name));
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < runs[k].columns; i++) {
            nearest_offer(&search, runs[k].column[i].shown);
        }
    }
    fprintf(stderr, "whirl %s: error: there is no quantity '%.80s'\n", command, name);
    if (search.best != NULL) {
        fprintf(stderr, "hint: did you mean %s?\n", search.best);
    } else {
        fputs("hint: the quantities are ", stderr);
        for (int i = 0; i < runs[0].columns; i++) {
            fprintf(stderr, "%s%s", i > 0 ? ", " : "", runs[0].column[i].shown);
        }
        fputc('\n', stderr);
    }
}

static bool same_unit(const char *a, const char *b) {
    return a != NULL && b != NULL && strcmp(a, b) == 0;
}

static const char *unit_words(const char *unit) { return unit == NULL ? "an unknown unit" : unit; }

/* Finds the quantity's columns and unit. Reports a quantity that no run has, and runs with different units. */
static bool find_columns(const char *command, const char *name, const plot_run *runs, int count,
                         int *column, const char **unit) {
    int first = -1;
    for (int k = 0; k < count; k++) {
        column[k] = column_named(&runs[k], name);
        if (column[k] < 0) {
            continue;
        }
        const char *own = runs[k].column[column[k]].unit;
        if (first >= 0 && own != NULL && *unit != NULL && strcmp(own, *unit) != 0) {
            fprintf(
                stderr,
                "whirl %s: error: the unit of %s is %s in %s, but %s in %s: one axis has one unit\n"
                "hint: draw them in two pictures\n",
                command, name, *unit, runs[first].label, own, runs[k].label);
            return false;
        }
        first = first < 0 ? k : first;
        *unit = *unit == NULL ? own : *unit;
    }
    if (first < 0) {
        say_unknown(command, name, runs, count);
    }
    return first >= 0;
}

/* Adds a quantity to a panel; `panel` < 0: to the panel of its unit. */
static bool add(panels *p, const char *command, const char *name, const plot_run *runs, int panel) {
    panels_quantity *q = &p->quantity[p->quantities];
    const char *unit = NULL;
    if (p->quantities == PANELS_QUANTITIES) {
        fprintf(stderr,
                "whirl %s: error: the plot has more than %d quantities\nhint: --y NAME,NAME\n",
                command, PANELS_QUANTITIES);
        return false;
    }
    q->column = alloc(p->runs, sizeof *q->column);
    q->name = shown_name(name);
    p->quantities++;
    if (!find_columns(command, name, runs, p->runs, q->column, &unit)) {
        return false;
    }
    for (int i = 0; panel < 0 && i < p->count; i++) {
        panel = same_unit(p->unit[i], unit) ? i : panel;
    }
    panel = panel < 0 ? p->count : panel;
    if (panel < p->count && !same_unit(p->unit[panel], unit) &&
        (p->unit[panel] != NULL || unit != NULL)) {
        const char *other = "";
        for (int i = 0; i < p->quantities - 1; i++) {
            other = p->quantity[i].panel == panel ? p->quantity[i].name : other;
        }
        fprintf(stderr,
                "whirl %s: error: %s is in %s, but %s is in %s: one panel has one unit\n"
                "hint: --y \"%s, %s\" makes a panel for each unit\n",
                command, other, unit_words(p->unit[panel]), q->name, unit_words(unit), other,
                q->name);
        return false;
    }
    if (panel == p->count) {
        p->unit[p->count++] = unit;
    }
    q->panel = panel;
    return true;
}

static bool add_list(panels *p, const char *command, const char *list, const plot_run *runs,
                     int panel) {
    bool good = true;
    for (char *name; good && (name = alloc_entry(&list)) != NULL; free(name)) {
        good = add(p, command, name, runs, panel);
    }
    return good;
}

static bool add_all(panels *p, const char *command, const plot_run *runs) {
    for (int k = 0; k < p->runs; k++) {
        for (int i = 1; i < runs[k].columns; i++) {
            const char *name = runs[k].column[i].name;
            bool there = strncmp(name, "der(", 4) == 0;
            for (int q = 0; q < p->quantities; q++) {
                there = there || p->quantity[q].column[k] == i;
            }
            if (!there && !add(p, command, name, runs, -1)) {
                return false;
            }
        }
    }
    return true;
}

static bool name_runs(panels *p, const char *command, const char *legend, const plot_run *runs) {
    const char *list = legend;
    for (int k = 0; k < p->runs; k++) {
        char *label = alloc_entry(&list);
        if (label == NULL && legend != NULL) {
            fprintf(stderr,
                    "whirl %s: error: --legend has %d name%s for %d runs\n"
                    "hint: --legend \"first, second\"\n",
                    command, k, k == 1 ? "" : "s", p->runs);
            return false;
        }
        p->label[k] = label != NULL ? label : alloc_words("%s", runs[k].label);
    }
    if (list != NULL) {
        fprintf(stderr,
                "whirl %s: error: --legend names more than %d run%s\n"
                "hint: --legend \"first, second\"\n",
                command, p->runs, p->runs == 1 ? "" : "s");
    }
    return list == NULL;
}

/* Is there at most one label for each panel? If not, reports it. */
static bool labels_fit(const panels *p, const char *command, const char *labels) {
    int more = 0;
    for (const char *at = labels; at != NULL && *at != '\0'; at++) {
        more += *at == ',';
    }
    if (more >= p->count && p->count > 0) {
        fprintf(stderr,
                "whirl %s: error: --ylabel has %d texts for %d panel%s\n"
                "hint: write a comma between the texts of two panels\n",
                command, more + 1, p->count, p->count == 1 ? "" : "s");
    }
    return more < p->count || p->count == 0;
}

bool plot_is_path(const plot_choice *choice) {
    return choice->x != NULL && strcmp(choice->x, "t") != 0 && strcmp(choice->x, "time") != 0;
}

/* Returns false after an error (reported). Call panels_free() in any case. */
static bool panels_make(panels *p, const char *command, const plot_choice *choice,
                        const plot_run *runs, int count) {
    *p = (panels){.runs = count, .x = alloc(count, sizeof *p->x)};
    if (!name_runs(p, command, choice->legend, runs)) {
        return false;
    }
    p->x_unit = runs[0].column[0].unit;
    p->x_name =
        plot_is_path(choice) ? shown_name(choice->x) : alloc_words("%s", runs[0].column[0].name);
    if (plot_is_path(choice)) {
        p->x_unit = NULL;
        if (!find_columns(command, choice->x, runs, count, p->x, &p->x_unit)) {
            return false;
        }
    }
    for (int i = 0; i < choice->panels; i++) {
        if (!add_list(p, command, choice->panel[i], runs, p->count)) {
            return false;
        }
    }
    const bool chosen = choice->y != NULL || choice->panels > 0;
    const bool added = !chosen             ? add_all(p, command, runs)
                       : choice->y != NULL ? add_list(p, command, choice->y, runs, -1)
                                           : true;
    return added && labels_fit(p, command, choice->ylabel);
}

static void panels_free(panels *p) {
    for (int i = 0; i < p->quantities; i++) {
        free(p->quantity[i].name);
        free(p->quantity[i].column);
    }
    for (int k = 0; k < p->runs; k++) {
        free(p->label[k]);
    }
    free(p->x);
    free(p->x_name);
}

bool plot_fits(const char *command, const plot_choice *choice, const plot_run *runs, int count) {
    panels p;
    const bool fits = panels_make(&p, command, choice, runs, count);
    panels_free(&p);
    return fits;
}

/* === plot run ================================================================================= */
/* CSV follows RFC 4180, and lines that begin with # are comments. CSV.toml follows TOML 1.0. */

void plot_run_open(plot_run *run, const char *title, const char *label, int columns) {
    *run = (plot_run){.title = alloc_words("%s", title),
                      .label = alloc_words("%s", label),
                      .column = alloc(columns, sizeof *run->column),
                      .columns = columns};
}

static void put(char **place, const char *text) {
    free(*place);
    *place = text != NULL ? alloc_words("%s", text) : NULL;
}

void plot_run_name(plot_run *run, int column, const char *name, const char *unit,
                   const char *text) {
    plot_column *c = &run->column[column];
    put(&c->name, name);
    free(c->shown);
    c->shown = shown_name(name);
    put(&c->unit, unit);
    put(&c->text, text);
}

void plot_run_head(plot_run *run, int column, const char *heading) {
    char *name = alloc_words("%s", heading);
    char *unit = strrchr(name, '[');
    char *end = unit != NULL ? strchr(unit, ']') : NULL;
    if (unit != NULL && unit > name && unit[-1] == ' ' && end != NULL && end[1] == '\0') {
        unit[-1] = '\0';
        *end = '\0';
        plot_run_name(run, column, name, unit + 1, "");
    } else {
        plot_run_name(run, column, name, strcmp(name, "time") == 0 ? "s" : NULL, "");
    }
    free(name);
}

void plot_run_close(plot_run *run) {
    for (int i = 0; i < run->columns; i++) {
        free(run->column[i].name);
        free(run->column[i].shown);
        free(run->column[i].unit);
        free(run->column[i].text);
    }
    free(run->title);
    free(run->label);
    free(run->column);
    free(run->data);
    free(run->mark_s);
    *run = (plot_run){0};
}

/* --- the description, CSV.toml ------------------------------------------------------------------------------------- */

char *plot_run_quoted(const char *text) {
    char *made = NULL;
    FILE *to = alloc_text(&made, NULL);
    fputc('"', to);
    for (const char *at = text; *at != '\0'; at++) {
        const unsigned char code = (unsigned char)*at;
        if (code < 0x20 || code == 0x7f) {
            fprintf(to, "\\u%04x", (unsigned)code);
        } else {
            fprintf(to, "%s%c", *at == '"' || *at == '\\' ? "\\" : "", *at);
        }
    }
    fputc('"', to);
    alloc_text_end(to);
    return made;
}

static void write_texts(FILE *to, const plot_run *run, bool units) {
    fprintf(to, "\n[%s]\n", units ? "units" : "words");
    for (int i = 0; i < run->columns; i++) {
        const plot_column *c = &run->column[i];
        const char *text = units ? c->unit : c->text;
        if (text != NULL && text[0] != '\0') {
            char *name = plot_run_quoted(c->name);
            char *value = plot_run_quoted(text);
            fprintf(to, "%s = %s\n", name, value);
            free(name);
            free(value);
        }
    }
}

/* Writes CSV.toml. Returns false after an error (reported). */
static bool write_beside(const char *csv, const char *text) {
    char *file = alloc_words("%s.toml", csv);
    const bool good = atomic_file_print(file, "%s", text);
    if (!good) {
        atomic_file_not_whole();
    }
    free(file);
    return good;
}

bool plot_run_about(const char *csv, const plot_run *run, const char *facts, const char *tables) {
    char *text;
    FILE *to = alloc_text(&text, NULL);
    char *title = plot_run_quoted(run->title);
    char *label = plot_run_quoted(run->label);
    fprintf(to, "%stitle = %s\nlabel = %s\n", facts, title, label);
    if (run->trusted_s > 0.0) {
        fprintf(to, "trusted_s = %.17g\n", run->trusted_s);
    }
    fputs("marks_s = [", to);
    for (int i = 0; i < run->marks; i++) {
        fprintf(to, "%s%.17g", i > 0 ? ", " : "", run->mark_s[i]);
    }
    fputs("] # events, at most 400\n", to);
    write_texts(to, run, true);
    write_texts(to, run, false);
    fputs(tables, to);
    alloc_text_end(to);
    const bool good = write_beside(csv, text);
    free(title);
    free(label);
    free(text);
    return good;
}

bool plot_run_csv_end(FILE *csv, const char *name, bool keep, const char *command,
                      const char *scene) {
    const bool described = keep && csv != NULL && csv != stdout && atomic_file_is_regular(csv);
    /* CSV.toml is written last: if closing fails, the old CSV keeps its old description. */
    const bool closed = atomic_file_close(csv, name, keep);
    if (!closed || !described) {
        return closed;
    }
    char *text = alloc_words("whirl = \"" WH_VERSION "\"\ncommand = \"%s\"\nscene = \"%s\"\n",
                             command, scene);
    const bool good = write_beside(name, text);
    free(text);
    return good;
}

/* Reads the string at *at, and advances *at. Returns NULL if it is missing. The caller frees the result. */
static char *string_at(const char **at) {
    char *made = alloc_words("%s", *at);
    size_t length = 0;
    if (*(*at)++ != '"') {
        free(made);
        return NULL;
    }
    for (; **at != '"' && **at != '\0'; (*at)++) {
        if (**at == '\\' && (*at)[1] == 'u' && strlen(*at) > 6) {
            *at += 5; /* skip \uXXXX, a control character, which becomes a blank */
            made[length++] = ' ';
            continue;
        }
        *at += **at == '\\' && (*at)[1] != '\0' ? 1 : 0;
        made[length++] = **at;
    }
    *at += **at == '"' ? 1 : 0;
    made[length] = '\0';
    return made;
}

static void take_marks(plot_run *run, const char *at) {
    const char *end;
    while (*at == '[' || *at == ',') {
        at += 1 + strspn(at + 1, " ");
        const double mark_s = decimal_read(at, &end);
        if (end == at) {
            break;
        }
        run->mark_s = alloc_more(run->mark_s, run->marks + 1, sizeof *run->mark_s);
        run->mark_s[run->marks++] = mark_s;
        at = end;
    }
}

/* Takes a column's unit (if `units`) or description from a line "NAME" = "TEXT". */
static void take_text(plot_run *run, const char *line, bool units) {
    char *name = string_at(&line);
    line += strspn(line, " =");
    char *text = name != NULL ? string_at(&line) : NULL;
    for (int i = 0; text != NULL && i < run->columns; i++) {
        if (strcmp(run->column[i].name, name) == 0) {
            put(units ? &run->column[i].unit : &run->column[i].text, text);
        }
    }
    free(name);
    free(text);
}

static void take_fact(plot_run *run, const char *line) {
    const size_t length = strcspn(line, " =");
    const char *at = line + length + strspn(line + length, " =");
    char **place = strncmp(line, "title ", 6) == 0   ? &run->title
                   : strncmp(line, "label ", 6) == 0 ? &run->label
                                                     : NULL;
    if (place != NULL) {
        char *text = string_at(&at);
        if (text != NULL) {
            put(place, text);
        }
        free(text);
    } else if (strncmp(line, "trusted_s ", 10) == 0) {
        run->trusted_s = decimal_read(at, NULL);
    } else if (strncmp(line, "marks_s ", 8) == 0) {
        take_marks(run, at);
    }
}

static void read_about(const char *csv, plot_run *run) {
    char *file = alloc_words("%s.toml", csv);
    FILE *from = fopen(file, "rb");
    char line[16384];
    char table = '\0';
    while (from != NULL && fgets(line, sizeof line, from) != NULL) {
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] == '[') {
            table = line[1];
        } else if (table == 'u' || table == 'w') {
            take_text(run, line, table == 'u');
        } else if (table == '\0') {
            take_fact(run, line);
        }
    }
    if (from != NULL) {
        fclose(from);
    }
    free(file);
}

/* Reads the next line except comments, as UTF-8, without its end. Returns false at the end of the file. */
static bool next_line(FILE *from, char **line, size_t *size) {
    ssize_t length;
    do {
        length = getline(line, size, from);
    } while (length > 0 && (*line)[0] == '#');
    for (size_t i = 0; length > 0 && i < (size_t)length;) {
        const size_t one = utf8_length(*line + i, (size_t)length - i);
        (*line)[i] = one == 0 && (*line)[i] != '\0' ? '?' : (*line)[i];
        i += one > 0 ? one : 1;
    }
    if (length > 0) {
        (*line)[strcspn(*line, "\r\n")] = '\0';
    }
    return length > 0;
}

/* The next field, without quotes, trimmed; NULL at the end of the line. */
static char *next_field(char **line) {
    char *at = *line;
    if (at == NULL) {
        return NULL;
    }
    const bool quoted = *at == '"';
    at += quoted ? 1 : strspn(at, " ");
    char *end = at + strcspn(at, quoted ? "\"" : ",");
    char *comma = end + strcspn(end, ",");
    *line = *comma == ',' ? comma + 1 : NULL;
    *comma = '\0';
    *end = '\0';
    return at;
}

static double number_of(const char *field) {
    const char *end;
    const double value = decimal_read(field, &end);
    return end == field || end[strspn(end, " ")] != '\0' ? (double)NAN : value;
}

/* Is the field a spelling of NaN that some program writes? */
static bool is_nan(const char *field) {
    return strcasecmp(field + (field[0] == '-'), "nan") == 0 || strcmp(field, "NA") == 0;
}

static void name_columns(plot_run *run, char *line) {
    for (char *name = next_field(&line); name != NULL; name = next_field(&line)) {
        run->column = alloc_more(run->column, run->columns + 1, sizeof *run->column);
        run->column[run->columns] = (plot_column){0};
        plot_run_head(run, run->columns++, name);
    }
}

/* A cell that is empty, or missing at the end of a row, becomes NaN. */
static bool take_rows(const char *csv, FILE *from, char **line, size_t *size, plot_run *run) {
    int64_t most = 0;
    while (next_line(from, line, size)) {
        if (run->rows == most) {
            most = 2 * most + 1024;
            run->data = alloc_more(run->data, most * run->columns, sizeof *run->data);
        }
        double *row = run->data + (size_t)run->rows++ * (size_t)run->columns;
        char *rest = *line;
        for (int i = 0; i < run->columns; i++) {
            const char *field = next_field(&rest);
            row[i] = field != NULL ? number_of(field) : (double)NAN;
            if (isnan(row[i]) && field != NULL && field[0] != '\0' && !is_nan(field)) {
                fprintf(stderr, "%s: error: row %lld, column '%.60s': '%.60s' is no number\n", csv,
                        (long long)run->rows, run->column[i].name, field);
                return false;
            }
        }
        if (rest != NULL) {
            fprintf(stderr, "%s: error: row %lld has more cells than the header has names\n", csv,
                    (long long)run->rows);
            return false;
        }
    }
    return true;
}

static char *name_of(const char *csv) {
    const char *slash = strrchr(csv, '/');
    const char *name = slash != NULL ? slash + 1 : csv;
    const char *dot = strrchr(name, '.');
    return alloc_copy(name, dot != NULL && dot > name ? (size_t)(dot - name) : strlen(name));
}

bool plot_run_read(const char *command, const char *csv, plot_run *run) {
    char *line = NULL;
    size_t size = 0;
    char *name = name_of(csv);
    plot_run_open(run, name, name, 0);
    free(name);
    FILE *from = fopen(csv, "rb");
    bool good = false;
    if (from == NULL || !next_line(from, &line, &size)) {
        fprintf(stderr, "%s: error: %s\nhint: whirl run SCENE --csv %s writes one\n", csv,
                from == NULL ? strerror(errno) : "an empty file", csv);
    } else if (!isnan(number_of(line)) || isdigit((unsigned char)line[0])) {
        fprintf(stderr,
                "%s: error: the first line is no header\n"
                "hint: begin the file with the names of its columns: time,x,der(x)\n",
                csv);
    } else {
        const char *other = strpbrk(line, ";\t");
        name_columns(run, line);
        if (run->columns == 1 && other != NULL) {
            fprintf(stderr,
                    "%s: error: the header has no comma, but %s\n"
                    "hint: separate the columns by commas\n",
                    csv, *other == ';' ? "';'" : "a tab");
        } else {
            good = take_rows(csv, from, &line, &size, run);
            read_about(csv, run);
            if (good && run->rows == 0) {
                fprintf(stderr,
                        "%s: error: the file has no rows, so `whirl %s` has nothing to draw\n", csv,
                        command);
            }
        }
    }
    if (from != NULL) {
        fclose(from);
    }
    free(line);
    return good && run->rows > 0;
}

/* === the plot ================================================================================= */

/* In characters. LEFT_MARGIN has room for a label and tics such as -2.5x10^-300. It aligns the panels' x axes. */
#define LEFT_MARGIN 15
#define RIGHT_MARGIN 4
#define AXIS_MOST 26
#define TEXT_MOST 60

/* In pixels. PANEL_HEIGHT has room for one line of legend; each further line adds KEY_LINE. */
enum { PANEL_HEIGHT = 260, KEY_LINE = 21, KEY_WIDTH = 760, KEY_SAMPLE = 60 };
#define KEY_LETTER 8.5

/* Writes gnuplot's enhanced text, with escapes. If `raised`, exponents such as 1/2 in "m^(1/2)" are superscripts. */
static void write_part(FILE *to, const char *text, bool raised) {
    for (const char *at = text; *at != '\0'; at++) {
        if (*at != '^' || !raised) {
            fputs(strchr("_{}@&~^\\", *at) != NULL ? "\\134" : "", to);
            gnuplot_character(to, text, (size_t)(at - text));
            continue;
        }
        const bool open = at[1] == '(';
        const char *from = at + (open ? 2 : 1);
        const size_t length = strspn(from, open ? "-0123456789/" : "-0123456789");
        fprintf(to, "^{%.*s}", (int)length, from);
        at = from + length - (open && from[length] == ')' ? 0 : 1);
    }
}

static void write_axis(FILE *to, const char *axis, const char *name, const char *unit) {
    fprintf(to, "set %slabel \"", axis);
    write_part(to, name, false);
    if (unit != NULL) {
        fputs(name[0] != '\0' ? " [" : "[", to);
        write_part(to, unit, true);
        fputc(']', to);
    }
    fputs("\"\n", to);
}

/* A curve is flat if its range relative to its size is smaller than this: tics could not show the range. */
#define FLAT 1e-10

/* gnuplot's own range would cause warnings or errors if a curve is flat, or has no points. */
static void write_range(FILE *to, const char *axis, double least, double most) {
    if (!(least <= most)) {
        fprintf(to, "set %srange [-1:1]\n", axis);
        return;
    }
    const double size = number_most(fabs(least), fabs(most));
    if (most - least > FLAT * size) {
        fprintf(to, "set %srange [*:*]\n", axis);
        return;
    }
    const double room = size > 0.0 ? 0.1 * size : 1.0;
    fprintf(to, "set %srange [%.17g:%.17g]\n", axis, least - room, most + room);
}

typedef struct extent {
    double least;
    double most;
} extent;

static extent joined(extent e, const plot_run *run, int column) {
    for (int r = 0; r < run->rows && column >= 0; r++) {
        const double value = run->data[(size_t)r * (size_t)run->columns + (size_t)column];
        e.least = isfinite(value) ? number_least(e.least, value) : e.least;
        e.most = isfinite(value) ? number_most(e.most, value) : e.most;
    }
    return e;
}

static const extent nothing = {(double)INFINITY, -(double)INFINITY};

static extent quantity_extent(const panels *p, const plot_run *runs, const int *column) {
    extent e = nothing;
    for (int k = 0; k < p->runs; k++) {
        e = joined(e, &runs[k], column[k]);
    }
    return e;
}

/* Panel -1 is all panels. The caller frees the text. */
static char *names_of(const panels *p, int panel, size_t most) {
    char *names;
    size_t length;
    FILE *to = alloc_text(&names, &length);
    int count = 0;
    for (int i = 0; i < p->quantities; i++) {
        if (panel < 0 || p->quantity[i].panel == panel) {
            fprintf(to, "%s%s", count++ > 0 ? ", " : "", p->quantity[i].name);
        }
    }
    alloc_text_end(to);
    if (length > most && count > 1) {
        free(names);
        names = alloc_words("%d quantities", count);
    }
    return names;
}

/* For one run, the quantity's name, and its description if that fits. For several runs, the run's label, and the
 * quantity's name if the panel has several quantities. */
static char *legend_of(const panels *p, const panels_quantity *q, int k, const plot_run *run) {
    const char *text = run->column[q->column[k]].text;
    int together = 0; /* quantities of the panel */
    for (int i = 0; i < p->quantities; i++) {
        together += p->quantity[i].panel == q->panel;
    }
    return p->runs == 1 && together <= 2 && text[0] != '\0' && strlen(text) <= TEXT_MOST
               ? alloc_words("%s: %s", q->name, text)
           : p->runs == 1  ? alloc_words("%s", q->name)
           : together == 1 ? alloc_words("%s", p->label[k])
                           : alloc_words("%s, %s", q->name, p->label[k]);
}

/* One run: a colour for each quantity. Several runs: a colour for each run, and one of five dashes for each curve, so
 * that curves are distinguishable without colour. */
static void write_style(FILE *to, const panels *p, int of_panel, int k, bool points) {
    const int line = p->runs == 1 ? of_panel : k;
    const int dash = p->runs == 1 ? palette_dash(line) : 1 + (of_panel * p->runs + k) % 5;
    if (points) {
        fprintf(to, "points pt %d ps 0.6 lc rgb '%s'", palette_point(line), palette_line(line));
    } else {
        fprintf(to, "lines lw 1.8 dt %d lc rgb '%s'", dash, palette_line(line));
    }
}

static double first_trusted_s(const plot_run *runs, int count) {
    double least = 0.0;
    for (int k = 0; k < count; k++) {
        const double own = runs[k].trusted_s;
        least = own > 0.0 && !(least > 0.0 && least < own) ? own : least;
    }
    return least;
}

/* The legend's entry for the shade, or "". */
static char *trust_sign(const plot_run *runs, int count) {
    const double until_s = first_trusted_s(runs, count);
    return !(until_s > 0.0) ? alloc_words("%s", "")
           : count > 1
               ? alloc_words("trusted until %.6g s", until_s)
               : alloc_words("after %.6g s only energy and momenta are meaningful", until_s);
}

static int marks_in(const plot_run *runs, int count) {
    int marks = 0;
    for (int k = 0; k < count; k++) {
        marks += runs[k].marks;
    }
    return marks;
}

/* The number of lines of a panel's legend. All its columns are as wide as the longest entry. */
static int key_lines(const panels *p, const plot_run *runs, int panel, bool time) {
    const bool signs = time && panel == 0;
    char *trusted = trust_sign(runs, p->runs);
    size_t longest = signs ? strlen(trusted) : 0;
    free(trusted);
    int entries = (longest > 0 ? 1 : 0) + (signs && marks_in(runs, p->runs) > 0 ? 1 : 0);
    for (int i = 0; i < p->quantities; i++) {
        for (int k = 0; k < p->runs && p->quantity[i].panel == panel; k++) {
            char *words = legend_of(p, &p->quantity[i], k, &runs[k]);
            longest = strlen(words) > longest ? strlen(words) : longest;
            free(words);
            entries++;
        }
    }
    const int columns =
        (int)number_most(1.0, KEY_WIDTH / (KEY_SAMPLE + KEY_LETTER * (double)longest));
    return (entries + columns - 1) / columns;
}

/* Adds the shade and the events to the legend of the first panel. */
static void write_signs(FILE *to, const plot_run *runs, int count) {
    char *trusted = trust_sign(runs, count);
    if (trusted[0] != '\0') {
        fprintf(to,
                ", keyentry with boxes fillstyle solid noborder lc rgb '" PALETTE_SHADE
                "' title '%s'",
                trusted);
    }
    free(trusted);
    if (marks_in(runs, count) > 0) {
        fputs(", keyentry with points pt 2 ps 0.7 lc rgb '" PALETTE_FRAME "' title 'event'", to);
    }
}

/* Frees `ylabel`. */
static void write_panel(FILE *to, const panels *p, const plot_run *runs, int panel, bool time,
                        char *ylabel) {
    extent e = nothing;
    int drawn = 0;
    int of_panel = 0;
    for (int i = 0; i < p->quantities; i++) {
        if (p->quantity[i].panel == panel) {
            const extent own = quantity_extent(p, runs, p->quantity[i].column);
            e = (extent){number_least(e.least, own.least), number_most(e.most, own.most)};
        }
    }
    write_range(to, "y", e.least, e.most);
    fprintf(to, "set key vertical maxrows %d\n", key_lines(p, runs, panel, time));
    char *names = ylabel != NULL ? ylabel : names_of(p, panel, AXIS_MOST);
    write_axis(to, "y", names, ylabel != NULL ? NULL : p->unit[panel]);
    free(names);
    for (int i = 0; i < p->quantities; i++) {
        const panels_quantity *q = &p->quantity[i];
        for (int k = 0; k < p->runs && q->panel == panel; k++) {
            if (q->column[k] >= 0 && p->x[k] >= 0) {
                fprintf(to, "%s$data%d using %d:%d with ", drawn++ > 0 ? ", " : "plot ", k,
                        p->x[k] + 1, q->column[k] + 1);
                write_style(to, p, of_panel, k, runs[k].rows == 1);
                char *words = legend_of(p, q, k, &runs[k]);
                fputs(" title ", to);
                gnuplot_quote(to, words);
                free(words);
            }
        }
        of_panel += q->panel == panel ? 1 : 0;
    }
    if (drawn == 0) {
        fputs("plot NaN notitle", to);
    }
    if (time && panel == 0) {
        write_signs(to, runs, p->runs);
    }
    fputc('\n', to);
}

void plot_shade(FILE *to, double from_s) {
    fprintf(to,
            "set object 1 rectangle from first %.17g, graph 0 to graph 1, graph 1 behind "
            "fillcolor rgb '" PALETTE_SHADE "' fillstyle solid noborder\n",
            from_s);
}

/* For every panel: shades the time after the shortest trusted time, and marks events by a cross on the time axis. */
static void write_times(FILE *to, const plot_run *runs, int count) {
    const double trusted_s = first_trusted_s(runs, count);
    if (trusted_s > 0.0) {
        plot_shade(to, trusted_s);
    }
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < runs[k].marks; i++) {
            fprintf(to,
                    "set label at first %.17g, graph 0 '' point pt 2 ps 0.7 lc rgb '%s' front\n",
                    runs[k].mark_s[i], count > 1 ? palette_line(k) : PALETTE_FRAME);
        }
    }
}

static void write_data(FILE *to, const plot_run *run, int number) {
    fprintf(to, "$data%d << EOD\n", number);
    for (int r = 0; r < run->rows; r++) {
        for (int c = 0; c < run->columns; c++) {
            fprintf(to, "%.17g ", run->data[(size_t)r * (size_t)run->columns + (size_t)c]);
        }
        fputc('\n', to);
    }
    fputs("EOD\n", to);
}

static char *title_of(const panels *p, const plot_choice *choice, const plot_run *runs) {
    bool alike = true;
    for (int k = 1; k < p->runs; k++) {
        alike = alike && strcmp(runs[k].title, runs[0].title) == 0;
    }
    if (choice->title != NULL || alike) {
        return alloc_words("%s", choice->title != NULL ? choice->title : runs[0].title);
    }
    char *names = names_of(p, -1, TEXT_MOST);
    char *title = alloc_words("%s over %s, %d runs", names, p->x_name, p->runs);
    free(names);
    return title;
}

/* Describes the curves in words. The caller frees the result. */
static char *alternative_text(const panels *p, const plot_run *runs) {
    char *text;
    FILE *to = alloc_text(&text, NULL);
    fprintf(to, "Curves over %s.", p->x_name);
    for (int i = 0; i < p->quantities; i++) {
        const panels_quantity *q = &p->quantity[i];
        const char *unit = p->unit[q->panel];
        for (int k = 0; k < p->runs; k++) {
            const extent e = joined(nothing, &runs[k], q->column[k]);
            if (e.least <= e.most) {
                fprintf(to, " %s%s%s lies between %.4g and %.4g%s%s.", q->name,
                        p->runs > 1 ? " of " : "", p->runs > 1 ? p->label[k] : "", e.least, e.most,
                        unit != NULL ? " " : "", unit != NULL ? unit : "");
            }
        }
    }
    alloc_text_end(to);
    return text;
}

static bool draw_panels(const panels *p, const char *file, const plot_choice *choice,
                        const plot_run *runs) {
    const bool time = !plot_is_path(choice) && strcmp(runs[0].column[0].name, "time") == 0;
    char *title = title_of(p, choice, runs);
    char *text = alternative_text(p, runs);
    gnuplot g;
    int lines = 1;
    for (int i = 0; i < p->count; i++) {
        lines = (int)number_most(lines, key_lines(p, runs, i, time));
    }
    const int each = PANEL_HEIGHT + KEY_LINE * (lines - 1);
    bool drawn = gnuplot_open(&g, file, 120 + each * p->count, title, text);
    if (drawn) {
        for (int k = 0; k < p->runs; k++) {
            write_data(g.to, &runs[k], k);
        }
        fprintf(g.to, "set multiplot layout %d,1 title ", p->count);
        gnuplot_quote(g.to, title);
        fprintf(g.to,
                ".\"\\n\" noenhanced\nset key above left Left reverse noenhanced samplen %d\n"
                "set lmargin %d\nset rmargin %d\n",
                p->runs > 1 ? 4 : 2, LEFT_MARGIN, RIGHT_MARGIN);
        const extent x = quantity_extent(p, runs, p->x);
        write_range(g.to, "x", x.least, x.most);
        if (time) {
            write_times(g.to, runs, p->runs);
        }
        const char *ylabels = choice->ylabel;
        for (int i = 0; i < p->count; i++) {
            const bool last = i == p->count - 1;
            const char *own = choice->xlabel;
            write_axis(g.to, "x",
                       !last         ? ""
                       : own != NULL ? own
                                     : p->x_name,
                       last && own == NULL ? p->x_unit : NULL);
            write_panel(g.to, p, runs, i, time, alloc_entry(&ylabels));
        }
        fputs("unset multiplot\n", g.to);
        drawn = gnuplot_close(&g);
    }
    free(title);
    free(text);
    return drawn;
}

bool plot_draw(const char *command, const char *file, const plot_choice *choice,
               const plot_run *runs, int count) {
    panels p;
    bool drawn = panels_make(&p, command, choice, runs, count);
    if (drawn && p.count == 0) {
        fprintf(stderr, "whirl %s: error: there is no quantity to draw\n", command);
        drawn = false;
    }
    drawn = drawn && draw_panels(&p, file, choice, runs);
    panels_free(&p);
    return drawn;
}
