/* table_plot.c: the picture of a table (table_text.h). */
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/plot/scatter.h"
#include "table_text.h"

/* Lines of a picture: one more than one can tell apart are drawn alike. */
enum { SERIES_MOST = 64, NAME_SIZE = 80 };

typedef struct picture {
    scatter_series series[SERIES_MOST];
    char name[SERIES_MOST][NAME_SIZE];
    double *x[SERIES_MOST];
    double *y[SERIES_MOST];
    int count;
    int rows;
} picture;

static int series_named(picture *p, const char *name, bool heavy) {
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
    p->series[i] = (scatter_series){p->name[i], heavy, 0, p->x[i], p->y[i]};
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

bool table_plot(const char *file, const trials *t, const table *made) {
    picture *p = room(1, sizeof *p);
    char text[TRIAL_NAME];
    p->rows = made->count;
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        if (row->on_front) {
            put(p, series_named(p, "front", true), row);
        }
    }
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        char name[NAME_SIZE];
        const bool matrix = row->setting.image.matrix != MATRIX_NONE;
        snprintf(name, sizeof name, "%s%s, %s", matrix ? "matrix " : "",
                 setting_word(&row->setting, matrix ? AXIS_MATRIX : AXIS_METHOD),
                 setting_word(&row->setting, AXIS_NUMBER));
        if (is_cheapest(made, i)) {
            put(p, series_named(p, name, false), row);
        }
    }
    char *title = room_words("%s on %s (%s): error against price", t->image[0]->name,
                             t->wish.board->name, t->wish.board->core);
    char *x = room_words("%s a simulated second",
                         made->count > 0 ? table_unit_words[made->row[0].price.unit] : "cycles");
    char *y = t->what.column < 0
                  ? room_words("error, part of the largest value, to %.9g s", trial_horizon_s(t))
                  : room_words("error of %s [%s] to %.9g s", trial_column(t, t->what.column, text),
                               trial_unit(t), trial_horizon_s(t));
    const bool drawn = scatter_draw(file, title, x, y, p->series, p->count);
    for (int i = 0; i < p->count; i++) {
        free(p->x[i]);
        free(p->y[i]);
    }
    free(title);
    free(x);
    free(y);
    free(p);
    return drawn;
}
