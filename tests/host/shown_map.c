#include "shown_map.h"

#include <math.h>
#include <string.h>

static const symbol swept[2] = {
    {.kind = SYM_PARAMETER, .name = "k", .text = "", .unit = "N/m", .dim.twelfths = {0, 12, -24}},
    {.kind = SYM_PARAMETER,
     .name = "m",
     .text = "",
     .unit = "kg",
     .index = 1,
     .dim.twelfths = {0, 12}}};

/* A logarithmic range has ends of the same sign; a step is above zero. */
static axis drawn_axis(dice *d, const symbol *of, char *name) {
    axis a = {.name = name, .column = name, .symbol = of, .count = 1 + dice_one_of(d, SHOWN_MOST)};
    a.is_log = dice_one_of(d, 2) == 0;
    const double sign = of != NULL && dice_one_of(d, 3) == 0 ? -1.0 : 1.0;
    a.from = sign * dice_between(d, 0.01, 3.0);
    a.to = a.from * dice_between(d, 1.5, 40.0);
    if (of != NULL && !a.is_log && dice_one_of(d, 2) == 0) {
        a.to = -a.to;
    }
    if (dice_one_of(d, 2) == 0) {
        const double from = a.from;
        a.from = a.to;
        a.to = from;
    }
    if (a.count == 1) {
        a.to = a.from;
    }
    return a;
}

double shown_map_value(const axis *a, uint64_t i) {
    const double share = a->count > 1 ? (double)i / (double)(a->count - 1) : 0.0;
    if (a->is_log) {
        return a->from * exp(share * log(a->to / a->from));
    }
    return (1.0 - share) * a->from + share * a->to;
}

static void rising(const axis *a, double *value, uint64_t *which) {
    for (uint64_t i = 0; i < a->count; i++) {
        which[i] = a->from <= a->to ? i : a->count - 1 - i;
        value[i] = shown_map_value(a, which[i]);
    }
}

void shown_map_draw(dice *d, shown_map *s) {
    memset(s, 0, sizeof *s);
    static char names[3][8] = {"step", "k", "m"};
    const unsigned step = dice_one_of(d, 3); /* the first axis, the second or neither is the step */
    for (unsigned k = 0; k < 2; k++) {
        s->axes[k] = drawn_axis(d, step == k ? NULL : &swept[k], names[step == k ? 0 : 1 + k]);
    }
    s->grid = (grid){.axes = s->axes, .count = 2, .points = s->axes[0].count * s->axes[1].count};
    const int along = step == 0 ? 0 : 1;
    const axis *rows = &s->axes[1 - along];
    const uint64_t across = s->axes[along].count;
    rising(&s->axes[along], s->value[0], s->place[0]);
    rising(rows, s->value[1], s->place[1]);
    s->map = (stability_map){.grid = &s->grid,
                             .cell = s->cell,
                             .done = s->grid.points,
                             .along = along,
                             .by_step = step < 2};
    const unsigned kinds = 1 + dice_one_of(d, MAP_VERDICTS);
    for (uint64_t i = 0; i < s->grid.points; i++) {
        const map_verdict verdict = (map_verdict)dice_one_of(d, kinds);
        s->cell[i] = (map_cell){verdict, dice_between(d, 1.0, 9.0), dice_between(d, 0.0, 1.0),
                                dice_one_of(d, 2) == 0 ? (double)NAN : dice_between(d, 0.0, 1.0)};
    }
    for (uint64_t row = 0; row < rows->count; row++) {
        for (uint64_t i = 0; i < across; i++) {
            const uint64_t first = along == 0 ? s->place[0][i] : s->place[1][row];
            const uint64_t second = along == 0 ? s->place[1][row] : s->place[0][i];
            s->at[row][i] = &s->cell[first * s->axes[1].count + second];
        }
    }
}

uint64_t shown_map_across(const shown_map *s) { return s->axes[s->map.along].count; }
uint64_t shown_map_rows(const shown_map *s) { return s->axes[1 - s->map.along].count; }
