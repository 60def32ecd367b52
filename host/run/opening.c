/* opening.c: see opening.h. */
#include "opening.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/functions.h"
#include "host/number/zero.h"

/* Rows that are looked at, of a long run; an output stays where it moves by this part of the furthest coordinate of its
 * unit; coordinates that are named. */
enum { ROWS = 100000, NAMED = 3 };
#define STAYS 1e-6

opening opening_begin(const records *r, uint64_t steps) {
    opening o = {.each = steps / ROWS + 1};
    o.first = room(3 * (int64_t)r->columns, sizeof *o.first);
    o.low = o.first + r->columns;
    o.high = o.low + r->columns;
    memcpy(o.first, r->row, (size_t)r->columns * sizeof *o.first);
    memcpy(o.low, r->row, (size_t)r->columns * sizeof *o.low);
    memcpy(o.high, r->row, (size_t)r->columns * sizeof *o.high);
    return o;
}

void opening_end(opening *o) { free(o->first); }

void opening_enter(opening *o, const records *r) {
    for (int i = 0; i < r->columns; i++) {
        o->low[i] = r->row[i] < o->low[i] ? r->row[i] : o->low[i];
        o->high[i] = r->row[i] > o->high[i] ? r->row[i] : o->high[i];
    }
}

/* How far the values of this unit went, rates apart. */
static double furthest(const opening *o, const records *r, const char *si) {
    double most = 0.0;
    for (int i = 1; i < r->columns; i++) {
        const record_column *c = &r->column[i];
        if (c->primes == 0 && strcmp(c->unit->si, si) == 0) {
            most = number_most(most, (o->high[i] - o->low[i]) * c->unit->scale / c->unit->divisor);
        }
    }
    return most;
}

/* A length among the outputs that stays while another length moves: a centre of mass before any other, and of several the
 * first name, so that the order of the file does not matter. -1: none. */
static int staying(const opening *o, const records *r, double *within) {
    int found = -1;
    bool is_found_centre = false;
    const double most = furthest(o, r, "m");
    for (int i = 1; i < r->columns; i++) {
        const record_column *c = &r->column[i];
        const bool is_centre = strstr(c->name, "cm") != NULL;
        const double far = number_most(o->high[i] - o->first[i], o->first[i] - o->low[i]);
        const bool stays = c->unknown < 0 && strcmp(c->unit->si, "m") == 0 &&
                           far * c->unit->scale / c->unit->divisor < STAYS * most;
        if (stays &&
            (found < 0 || (is_centre && !is_found_centre) ||
             (is_centre == is_found_centre && strcmp(c->name, r->column[found].name) < 0))) {
            found = i;
            is_found_centre = is_centre;
            *within = far;
        }
    }
    return found;
}

/* The moving coordinate whose name follows `after`; -1: none. */
static int next_moving(const opening *o, const records *r, const char *after) {
    int next = -1;
    for (int i = 1; i < r->columns; i++) {
        const record_column *c = &r->column[i];
        if (c->unknown >= 0 && c->primes == 0 && o->high[i] > o->low[i] &&
            strcmp(c->name, after) > 0 && (next < 0 || strcmp(c->name, r->column[next].name) < 0)) {
            next = i;
        }
    }
    return next;
}

/* "At the end: X = 0.17 m (from 0 m), theta = 62 deg (from 80 deg)." */
static void print_ways(FILE *out, const opening *o, const records *r) {
    int moving = 0;
    for (int i = next_moving(o, r, ""); i >= 0; i = next_moving(o, r, r->column[i].name)) {
        const record_column *c = &r->column[i];
        if (moving++ < NAMED) {
            fprintf(out, "%s%s = %.3g %s (from %.3g %s)",
                    moving > 1 ? ", " : "At the end: ", c->name, number_shown(r->row[i]),
                    c->unit->shown, number_shown(o->first[i]), c->unit->shown);
        }
    }
    if (moving > NAMED) {
        fprintf(out, ", and %d more move", moving - NAMED);
    }
    fputs(moving > 0 ? ".\n" : "Nothing moves.\n", out);
}

/* "The momentum of x stays 0 kg*m/s within 5.9e-11. ", of the first length whose momentum is
 * conserved. That of an angle, such as a clock's, says nothing of where the device goes. */
static void print_momentum(FILE *out, const image *im, const books *b) {
    int found = -1;
    for (int i = 0; i < im->count && b != NULL; i++) {
        if (im->unknown[i].conserved && im->unknown[i].is_length && isfinite(b->drift[i]) &&
            (found < 0 || strcmp(im->unknown[i].name, im->unknown[found].name) < 0)) {
            found = i;
        }
    }
    if (found >= 0) {
        fprintf(out, "The momentum of %s stays %.3g %s within %.1e. ", im->unknown[found].name,
                number_shown(b->momentum[found]), im->unknown[found].momentum_si, b->drift[found]);
    }
}

void opening_print(FILE *out, const opening *o, const records *r, const books *b) {
    double within;
    const int stays = staying(o, r, &within);
    if (stays >= 0) {
        const record_column *c = &r->column[stays];
        fprintf(out, "%s stays at %s = %.3g %s within %.1e %s.\n",
                strstr(c->name, "cm") != NULL ? "The centre of mass" : "An output", c->name,
                number_shown(o->first[stays]), c->unit->shown, 1.05 * within, c->unit->shown);
        return;
    }
    print_momentum(out, r->image, b);
    print_ways(out, o, r);
}
