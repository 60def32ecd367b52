/* table_plot.c: the picture of a table (table_text.h). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"
#include "host/plot/scatter.h"
#include "table_text.h"

/* Series that are collected, and lines of a picture, the front among them: more cannot be told apart. */
enum { SERIES_MOST = 64, LINES_MOST = 8, NAME_SIZE = 80 };

typedef struct picture {
    scatter_series series[SERIES_MOST];
    char name[SERIES_MOST][NAME_SIZE];
    double *x[SERIES_MOST];
    double *y[SERIES_MOST];
    char **label; /* of the front's points */
    int count;
    int rows;
} picture;

/* A method or a matrix has one look in all pictures; a number has one dash. */
static void name_of(const table_row *row, scatter_series *s, char name[NAME_SIZE]) {
    const bool matrix = row->setting.image.matrix != MATRIX_NONE;
    snprintf(name, NAME_SIZE, "%s%s, %s", matrix ? "matrix " : "",
             setting_word(&row->setting, matrix ? AXIS_MATRIX : AXIS_METHOD),
             setting_word(&row->setting, AXIS_NUMBER));
    s->look =
        matrix ? WH_METHODS - 1 + (int)row->setting.image.matrix : (int)row->setting.image.method;
    s->dash = row->setting.number == &engine_double  ? 0
              : row->setting.number == &engine_float ? 1
                                                     : 4;
    s->dash += row->setting.image.compensated ? 2 : 0;
}

static int series_named(picture *p, const char *name, const scatter_series *like) {
    int i = 0;
    while (i < p->count && strcmp(p->name[i], name) != 0) {
        i++;
    }
    if (i < p->count || p->count == SERIES_MOST) {
        return i < p->count ? i : p->count - 1;
    }
    snprintf(p->name[i], NAME_SIZE, "%s", name);
    p->x[i] = room(p->rows, sizeof(double));
    p->y[i] = room(p->rows, sizeof(double));
    p->series[i] = *like;
    p->series[i].name = p->name[i];
    p->series[i].x = p->x[i];
    p->series[i].y = p->y[i];
    p->count++;
    return i;
}

static void put(picture *p, int i, const table_row *row) {
    if (row->result.error > 0.0 && row->price.value > 0.0) { /* what has a logarithm */
        const int k = p->series[i].count++;
        p->x[i][k] = row->price.value;
        p->y[i][k] = row->result.error;
    }
}

/* Of the forms of one method and number at one step, the cheapest. */
static bool is_cheapest(const table *made, int which) {
    const table_row *row = &made->row[which];
    if (row->setting.image.tables != TABLES_NONE) {
        return false; /* with errors of their own: they are on the front, or nowhere */
    }
    for (int i = 0; i < which; i++) { /* by rising price */
        const table_row *other = &made->row[i];
        if (other->pace.steps == row->pace.steps && other->pace.records == row->pace.records &&
            other->setting.image.method == row->setting.image.method &&
            other->setting.number == row->setting.number &&
            other->setting.image.matrix == row->setting.image.matrix &&
            other->setting.image.tables == TABLES_NONE &&
            other->setting.image.compensated == row->setting.image.compensated) {
            return false;
        }
    }
    return true;
}

/* Part of the front's decades between its names, which else would cover each other. */
#define NAMES_APART 0.05

/* The front, named where its setting changes, and the settings that are on it: they are drawn whatever is left out. */
static void put_front(picture *p, const table *made) {
    char before[NAME_SIZE] = "";
    double named_at = (double)INFINITY;
    double least = (double)INFINITY;
    double most = 0.0;
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        if (row->on_front && row->result.error > 0.0) {
            least = number_least(least, row->result.error);
            most = number_most(most, row->result.error);
        }
    }
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        char name[NAME_SIZE];
        scatter_series like = {0};
        if (row->on_front) {
            scatter_series front = {.heavy = true, .label = p->label};
            const int line = series_named(p, "front: the least error for its price", &front);
            const int at = p->series[line].count;
            put(p, line, row);
            name_of(row, &like, name);
            if (p->series[line].count > at && strcmp(name, before) != 0 &&
                named_at / row->result.error >= number_power(most / least, NAMES_APART)) {
                named_at = row->result.error;
                p->label[at] = room_words("%s", name);
                snprintf(before, sizeof before, "%s", name);
            }
        }
    }
    for (int i = 0; i < made->count; i++) {
        char name[NAME_SIZE];
        scatter_series like = {0};
        name_of(&made->row[i], &like, name);
        if (made->row[i].on_front && made->row[i].setting.image.tables == TABLES_NONE) {
            (void)series_named(p, name, &like);
        }
    }
}

bool table_plot(const char *file, const trials *t, const table *made) {
    picture *p = room(1, sizeof *p);
    char text[TRIAL_NAME];
    p->rows = made->count;
    p->label = room(made->count, sizeof *p->label);
    put_front(p, made);
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        char name[NAME_SIZE];
        scatter_series like = {0};
        name_of(row, &like, name);
        if (is_cheapest(made, i)) {
            put(p, series_named(p, name, &like), row);
        }
    }
    const int lines = p->count < LINES_MOST ? p->count : LINES_MOST;
    char *more = p->count > lines ? room_words("and %d more: --csv", p->count - lines) : NULL;
    char *title = room_words("%s on %s (%s): error against price", t->image[0]->name,
                             t->wish.board->name, t->wish.board->core);
    char *x = room_words("%s a simulated second",
                         made->count > 0 ? table_unit_words[made->row[0].price.unit] : "cycles");
    char *y = t->what.column < 0
                  ? room_words("error, part of the largest value, to %.9g s", trial_horizon_s(t))
                  : room_words("error of %s [%s] to %.9g s", trial_column(t, t->what.column, text),
                               trial_unit(t), trial_horizon_s(t));
    const bool drawn = scatter_draw(file, title, x, y, p->series, lines, more);
    for (int i = 0; i < p->count; i++) {
        free(p->x[i]);
        free(p->y[i]);
    }
    for (int i = 0; i < made->count; i++) {
        free(p->label[i]);
    }
    free(p->label);
    free(more);
    free(title);
    free(x);
    free(y);
    free(p);
    return drawn;
}
