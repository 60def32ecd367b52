/* plot_run.c: reading and writing of runs. CSV follows RFC 4180, with comment lines after a #. The description is TOML
 * 1.0. */
#include "plot_run.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "host/base/alloc.h"
#include "host/base/atomic_file.h"
#include "host/base/spelling.h"
#include "host/number/decimal.h"

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
    put(&c->unit, unit);
    put(&c->text, text);
}

void plot_run_close(plot_run *run) {
    for (int i = 0; i < run->columns; i++) {
        free(run->column[i].name);
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

/* --- the file about it --------------------------------------------------------------------------------------------- */

char *plot_run_quoted(const char *text) {
    char *made = NULL;
    size_t length = 0;
    FILE *to = alloc_text(&made, &length);
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

bool plot_run_about(const char *csv, const plot_run *run, const char *facts, const char *tables) {
    char *file = alloc_words("%s.toml", csv);
    char *title = plot_run_quoted(run->title);
    char *label = plot_run_quoted(run->label);
    FILE *to = atomic_file_open(file);
    bool good = false;
    if (to != NULL) {
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
        good = atomic_file_close(to, file, true);
    }
    free(file);
    free(title);
    free(label);
    return good;
}

/* The string at *at, which advances past it; NULL if it is missing. Free it. */
static char *string_at(const char **at) {
    char *made = alloc_words("%s", *at);
    size_t length = 0;
    if (*(*at)++ != '"') {
        free(made);
        return NULL;
    }
    for (; **at != '"' && **at != '\0'; (*at)++) {
        if (**at == '\\' && (*at)[1] == 'u' && strlen(*at) > 6) {
            *at += 5; /* a control character: a blank */
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

/* "NAME" = "TEXT" of a table. */
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

/* --- the numbers ----------------------------------------------------------------------------------------------------- */

/* The next line other than a comment, without its end, as UTF-8 text; false at the file's end. */
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

/* The next field, without quotes and blanks at its ends; NULL at the line's end. */
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

/* The spellings of NaN in other programs. */
static bool is_nan(const char *field) {
    return strcasecmp(field + (field[0] == '-'), "nan") == 0 || strcmp(field, "NA") == 0;
}

/* "theta [deg]": name and unit. */
static void name_columns(plot_run *run, char *line) {
    for (char *name = next_field(&line); name != NULL; name = next_field(&line)) {
        char *unit = strrchr(name, '[');
        char *end = unit != NULL ? strchr(unit, ']') : NULL;
        if (unit != NULL && unit > name && unit[-1] == ' ' && end != NULL && end[1] == '\0') {
            unit[-1] = '\0';
            *end = '\0';
            unit++;
        } else {
            unit = strcmp(name, "time") == 0 ? "s" : NULL;
        }
        run->column = alloc_more(run->column, run->columns + 1, sizeof *run->column);
        run->column[run->columns] = (plot_column){0};
        plot_run_name(run, run->columns++, name, unit, "");
    }
}

/* An empty cell, or a missing one at the end, is an unknown value. */
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

/* The file's name without folders and ending. */
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
                fprintf(stderr, "%s: error: no rows: `whirl %s` has nothing to draw\n", csv,
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
