/* held_text.c: see held_text.h. */
#include "held_text.h"

#include <inttypes.h>
#include <string.h>

#include "host/number/decimal.h"
#include "host/number/ratio.h"

enum { NAME_WIDTH = 16, NAME_SIZE = 160 };

static const char *name_of(const held_wish *w, int i, char text[NAME_SIZE]) {
    const exact_state s = w->motion->state[i];
    snprintf(text, NAME_SIZE, "%.120s%.*s", w->image->unknown[s.unknown].name, s.primes,
             "''''''''''''''''");
    return text;
}

static const image_unit *unit_of(const held_wish *w, int i) {
    const exact_state s = w->motion->state[i];
    return &w->image->unknown[s.unknown].unit[s.primes];
}

static void print_head(FILE *out, const held_found *h, const held_wish *w) {
    const image *im = w->image;
    fprintf(out, "%s%s%s\n", im->name, im->title[0] != '\0' ? ": " : "", im->title);
    fprintf(out, "  %s%s, %s, step %.9g s, %" PRIu64 " steps to t = %.15g s\n", image_stepper(im),
            image_sums(im), w->kind->name, im->step_s, im->steps, ratio_times(im->steps, im->step));
    fprintf(out,
            "  held against a tube round the exact motion: Taylor steps of order %d, %" PRIu64
            " of them to t = %.15g s\n",
            TUBE_ORDER, h->tube_steps, h->tube_s);
}

typedef struct figure {
    char text[40];
} figure;

/* Not less than x, with so many places: what is proved of x is true of what is printed. */
static figure not_less(double x, int places) {
    figure f;
    const char *end;
    double shown = enclosure_above(enclosure_above(x)); /* it may have been divided by its unit */
    snprintf(f.text, sizeof f.text, "%.*e", places, x);
    while (x > 0.0 && decimal_read(f.text, &end) < x) {
        shown *= 1.001;
        snprintf(f.text, sizeof f.text, "%.*e", places, shown);
    }
    return f;
}

/* What is behind the last proved time. */
static const char *behind(const held_found *h, const held_state *s) {
    static const char *const ends[] = {[HELD_AT_END] = "",
                                       [HELD_RUN_ENDS] = "; there the run fails",
                                       [HELD_NO_STEP] = "; there the tube ends",
                                       [HELD_SPENT] = "; there the effort is spent",
                                       [HELD_STOPPED] = "; there it was interrupted"};
    switch (s->verdict) {
    case HELD_TO_THE_END: return "";
    case HELD_LEFT: return "; behind it off by more: proved";
    case HELD_UNTOLD: return "; behind it the tube is too wide to tell";
    case HELD_UNENDED: return ends[h->end];
    }
    return "";
}

static void print_state(FILE *out, const held_found *h, const held_wish *w, int i) {
    const held_state *s = &h->state[i];
    const image_unit *unit = unit_of(w, i);
    const char *shown = strcmp(unit->shown, "1") == 0 ? "" : unit->shown;
    char name[NAME_SIZE];
    const figure within = not_less(image_shown(unit, s->within), 2);
    char until[40];
    snprintf(until, sizeof until, "%.15g", s->until_s);
    fprintf(out, "  %-*s ", NAME_WIDTH, name_of(w, i, name));
    if (!s->begun) {
        fprintf(out, "%-12s within %s %s: %s\n", "never", within.text, shown,
                s->verdict == HELD_LEFT ? "its start is off by more: proved"
                                        : "its start is not known so well");
        return;
    }
    const figure off = not_less(image_shown(unit, s->off), 1);
    const figure wide = not_less(image_shown(unit, 2.0 * s->radius), 1);
    fprintf(out, "%-12s within %s %s: off by at most %s, the tube %s wide%s\n",
            s->verdict == HELD_TO_THE_END ? "to the end" : until, within.text, shown, off.text,
            wide.text, behind(h, s));
}

/* The state of which the least is proved; -1: all is. */
static int first_of(const held_found *h) {
    int first = -1;
    for (int i = 0; i < h->states; i++) {
        const held_state *s = &h->state[i];
        if (s->verdict != HELD_TO_THE_END &&
            (first < 0 || !s->begun ||
             (h->state[first].begun && s->until_s < h->state[first].until_s))) {
            first = i;
            if (!s->begun) {
                break;
            }
        }
    }
    return first;
}

void held_print(FILE *out, const held_found *h, const held_wish *w) {
    const double end_s = ratio_times(w->image->steps, w->image->step);
    const int first = first_of(h);
    char name[NAME_SIZE];
    print_head(out, h, w);
    fputs("\nproved at the end of every step until [s]\n", out);
    for (int i = 0; i < h->states; i++) {
        print_state(out, h, w, i);
    }
    if (first < 0) {
        fprintf(out, "proved to the end, t = %.15g s\n", end_s);
    } else if (!h->state[first].begun) {
        fprintf(out, "nothing is proved: %s is not within at the start\n", name_of(w, first, name));
    } else {
        const held_state *s = &h->state[first];
        fprintf(out, "proved until t = %.15g s of %.15g s", s->until_s, end_s);
        fprintf(out, s->verdict == HELD_UNENDED ? "\n" : ": %s is the first that is not\n",
                name_of(w, first, name));
    }
}

/* --- rows ----------------------------------------------------------------------------------------------*/

void held_rows_head(FILE *out, const held_wish *w) {
    char name[NAME_SIZE];
    fputs("time [s]", out);
    for (int i = 0; i < w->motion->states; i++) {
        const char *si = unit_of(w, i)->si;
        name_of(w, i, name);
        fprintf(out, ",%s least [%s],%s most [%s],%s run [%s]", name, si, name, si, name, si);
    }
    fputs("\r\n", out);
}

void held_row(FILE *out, const held_wish *w, uint64_t step, const enclosure *exact,
              const double *run) {
    fprintf(out, "%.15g", ratio_times(step, w->image->step));
    for (int i = 0; i < w->motion->states; i++) {
        fprintf(out, ",%.17g,%.17g,%.17g", exact[i].low, exact[i].high, run[i]);
    }
    fputs("\r\n", out);
}
