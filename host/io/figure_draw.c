/* figure_draw.c: the picture of a figure's description. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/io/gnuplot.h"
#include "host/io/plot.h"

enum { FIELDS = 5 };

typedef struct figure {
    FILE *to; /* commands of the panels */
    const char *where;
    int line;
    const figure_data *data;
    int count;
    int panels;
    int curves;       /* curves in this panel */
    int named;        /* curves in the legend */
    bool varied;      /* the runs have changed options */
    double trusted_s; /* trusted time of this panel's curves; 0: no limit */
    char *plot;       /* gnuplot text of the curves */
    char *xlabel;
} figure;

char *figure_line(const char **at, const char *word) {
    const size_t length = strlen(word);
    while (**at != '\0') {
        const char *from = *at;
        const size_t all = strcspn(from, "\n");
        *at = from + all + (from[all] == '\n' ? 1 : 0);
        if (all > length && strncmp(from, word, length) == 0 && from[length] == ' ') {
            return alloc_copy(from + length + 1, all - length - 1);
        }
    }
    return NULL;
}

static bool is_wrong(const figure *f, const char *what, const char *which) {
    fprintf(stderr, "%s:%d: error: %s%.60s\n", f->where, f->line, what, which);
    return false;
}

static void join(char **text, const char *more) {
    char *longer = alloc_words("%s%s", *text, more);
    free(*text);
    *text = longer;
}

/* Writes an expression for gnuplot: {name} becomes column("name"). */
static void write_expression(FILE *to, const char *text) {
    fputc('(', to);
    for (const char *at = text; *at != '\0'; at++) {
        const size_t length = *at == '{' ? strcspn(at, "}") : 0;
        if (length > 0 && at[length] == '}') {
            char *name = alloc_copy(at + 1, length - 1);
            fputs("column(", to);
            gnuplot_quote(to, name);
            fputc(')', to);
            free(name);
            at += length;
        } else {
            fputc(*at, to);
        }
    }
    fputc(')', to);
}

static void end_panel(figure *f) {
    if (f->panels > 0) {
        if (f->trusted_s > 0.0) {
            plot_shade(f->to, f->trusted_s);
        }
        fputs("set xlabel ", f->to);
        gnuplot_quote(f->to, f->xlabel != NULL ? f->xlabel : "");
        fprintf(f->to,
                "\n%s\n%s\nunset arrow; unset label; unset object; unset logscale; set format\n",
                f->named > 0 ? "set key above center horizontal samplen 3" : "unset key", f->plot);
        fputs("set xrange [*:*]; set yrange [*:*]; set xtics autofreq; set ytics autofreq\n",
              f->to);
    }
    free(f->plot);
    free(f->xlabel);
    f->plot = alloc_words("plot ");
    f->xlabel = NULL;
    f->curves = 0;
    f->named = 0;
    f->trusted_s = 0.0;
}

/* Splits "A | B | C" in place; returns the number of fields. */
static int split(char *text, char *field[FIELDS]) {
    int count = 0;
    for (char *at = text; at != NULL && count < FIELDS; count++) {
        char *bar = strchr(at, '|');
        char *end = bar != NULL ? bar : at + strlen(at);
        while (end > at && end[-1] == ' ') {
            end--;
        }
        field[count] = at + strspn(at, " ");
        at = bar != NULL ? bar + 1 : NULL;
        *end = '\0';
    }
    return count;
}

/* Does the first line of the CSV text have a column of this name? */
static bool has_column(const char *csv, const char *name, size_t length) {
    while (*csv != '\0' && *csv != '\r' && *csv != '\n') {
        const bool quoted = *csv == '"';
        csv += quoted ? 1 : 0;
        const size_t size = strcspn(csv, quoted ? "\"" : ",\r\n");
        if (size == length && strncmp(csv, name, length) == 0) {
            return true;
        }
        csv += size + (quoted && csv[size] == '"' ? 1 : 0);
        csv += *csv == ',' ? 1 : 0;
    }
    return false;
}

/* Do the records have every column {name} of the expression? If not, reports the column. */
static bool has_columns(const figure *f, const figure_data *d, const char *text) {
    for (const char *at = strchr(text, '{'); at != NULL; at = strchr(at + 1, '{')) {
        const size_t length = strcspn(at + 1, "}");
        if (at[1 + length] == '\0') {
            return is_wrong(f, "there is no } after ", at);
        }
        if (!has_column(d->csv, at + 1, length)) {
            fprintf(stderr, "%s:%d: error: the records '%s' have no column '%.*s'\n", f->where,
                    f->line, d->name, (int)length, at + 1);
            return false;
        }
    }
    return true;
}

static bool take_curve(figure *f, char *words, bool law) {
    char *field[FIELDS] = {NULL};
    const int count = split(words, field);
    const char *name = law ? field[1] : field[3];
    int number = 0;
    char *text = NULL;
    if (count < (law ? 2 : 4)) {
        return is_wrong(f, "too few fields: ", words);
    }
    while (!law && number < f->count && strcmp(f->data[number].name, field[0]) != 0) {
        number++;
    }
    if (!law && number == f->count) {
        return is_wrong(f, "there is no run, sweep or table with the name ", field[0]);
    }
    if (!law && (!has_columns(f, &f->data[number], field[1]) ||
                 !has_columns(f, &f->data[number], field[2]))) {
        return false;
    }
    FILE *to = alloc_text(&text, NULL);
    fputs(f->curves > 0 ? ", " : "", to);
    if (law) {
        fprintf(to, "(%s) with lines lw 1.2 dt 2 lc rgb '" PALETTE_FRAME "'", field[0]);
    } else {
        const char *style = count == FIELDS ? field[4] : "lines lw 1.8";
        const double trusted_s = f->data[number].trusted_s;
        if (strcmp(field[1], "{time}") == 0 && trusted_s > 0.0 &&
            (f->trusted_s == 0.0 || trusted_s < f->trusted_s)) {
            f->trusted_s = trusted_s;
        }
        fprintf(to, "$d%d using ", number);
        write_expression(to, field[1]);
        fputc(':', to);
        write_expression(to, field[2]);
        fprintf(to, " with %s", style);
        if (strstr(style, " lc ") == NULL) {
            fprintf(to, " lc rgb '%s'", palette_line(f->curves));
        }
    }
    if (strcmp(name, "-") == 0) {
        fputs(" notitle", to);
    } else {
        fputs(" title ", to);
        gnuplot_quote(to, name);
        f->named++;
    }
    alloc_text_end(to);
    join(&f->plot, text);
    free(text);
    f->curves++;
    return true;
}

static bool take_line(figure *f, char *line) {
    const size_t length = strcspn(line, " ");
    char *rest = line + length + strspn(line + length, " ");
    const bool ends = line[length] == '\0';
    line[length] = '\0';
    if (strcmp(line, "panel") == 0) {
        if (f->panels > 0 && f->curves == 0) {
            return is_wrong(f, "a panel without a curve", "");
        }
        end_panel(f);
        f->panels++;
        fputs("set ylabel ", f->to);
        gnuplot_quote(f->to, rest);
        fputc('\n', f->to);
    } else if (strcmp(line, "curve") == 0 || strcmp(line, "law") == 0) {
        return f->panels > 0 ? take_curve(f, rest, line[0] == 'l')
                             : is_wrong(f, "before the first panel: ", line);
    } else if (strcmp(line, "set") == 0 && f->panels > 0) {
        const bool marks = strncmp(rest, "arrow", 5) == 0 || strncmp(rest, "label", 5) == 0;
        if (!f->varied || !marks) {
            fprintf(f->to, "set %s\n", rest);
        }
    } else if (strcmp(line, "xlabel") == 0) {
        free(f->xlabel);
        f->xlabel = alloc_words("%s", rest);
    } else if (line[0] != '#' && line[0] != '\0' &&
               (ends || strstr(" title caption run sweep table ", line) == NULL)) {
        return is_wrong(f, "what is ", line);
    }
    return true;
}

static bool take_text(figure *f, const char *text) {
    bool good = true;
    end_panel(f);
    for (const char *at = text; good && *at != '\0';) {
        const size_t length = strcspn(at, "\n");
        char *line = alloc_copy(at, length);
        f->line++;
        good = take_line(f, line);
        free(line);
        at += length + (at[length] == '\n' ? 1 : 0);
    }
    if (good && (f->panels == 0 || f->curves == 0)) {
        good = is_wrong(f, "a figure needs a panel with a curve", "");
    }
    if (good && f->xlabel == NULL) {
        f->xlabel = alloc_words("time [s]");
    }
    end_panel(f);
    free(f->plot);
    return good;
}

static void write_figure(FILE *to, const figure *f, const char *title, const char *commands) {
    fputs("set datafile separator comma\nset samples 120\nset lmargin 12\nset rmargin 3\n", to);
    for (int i = 0; i < f->count; i++) {
        fprintf(to, "$d%d << EOD\n", i);
        for (const char *at = f->data[i].csv; *at != '\0'; at++) {
            if (*at != '\r') {
                fputc(*at, to);
            }
        }
        fputs("EOD\n", to);
    }
    fprintf(to, "set multiplot layout %d,1 title ", f->panels);
    gnuplot_quote(to, title);
    /* leave space between the title and a legend below it */
    fprintf(to, ".\"\\n\"\n%sunset multiplot\n", commands);
}

bool figure_draw(const char *file, const char *where, const char *text, const figure_data *data,
                 int count, const char *varied) {
    char *commands = NULL;
    figure f = {.where = where,
                .data = data,
                .count = count,
                .varied = varied[0] != '\0',
                .to = alloc_text(&commands, NULL)};
    bool good = take_text(&f, text);
    alloc_text_end(f.to);
    const char *at = text;
    char *title = figure_line(&at, "title");
    char *words = alloc_words("%s%s", varied[0] != '\0' ? "Varied by" : "", varied);
    at = text + (varied[0] != '\0' ? strlen(text) : 0);
    for (char *more; (more = figure_line(&at, "caption")) != NULL; free(more)) {
        join(&words, words[0] != '\0' ? " " : "");
        join(&words, more);
    }
    if (good && title == NULL) {
        good = is_wrong(&f, "a figure needs a title", "");
    }
    if (good && varied[0] != '\0') {
        join(&title, ", varied:");
        join(&title, varied);
    }
    gnuplot g;
    const int height = f.panels == 1 ? 480 : 90 + 270 * f.panels;
    if (good && gnuplot_open(&g, file, height, title, words)) {
        fputs("set termoption noenhanced\n", g.to);
        write_figure(g.to, &f, title, commands);
        good = gnuplot_close(&g);
    } else {
        good = false;
    }
    free(commands);
    free(title);
    free(words);
    return good;
}
