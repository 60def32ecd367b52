/* held_text.c: see held_text.h. */
#include "held_text.h"

#include <inttypes.h>
#include <string.h>

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

static void print_head(FILE *out, const held *h, const held_wish *w) {
    const image *im = w->image;
    fprintf(out, "%s%s%s\n", im->name, im->title[0] != '\0' ? ": " : "", im->title);
    fprintf(out, "  %s%s, %s, step %.9g s, %" PRIu64 " steps to t = %.15g s\n", image_stepper(im),
            im->settings.compensated ? " compensated" : "", w->kind->name, im->step_s, im->steps,
            ratio_times(im->steps, im->step));
    fprintf(out,
            "  held against a tube round the exact motion: Taylor steps of order %d, %" PRIu64
            " of them to t = %.9g s\n",
            TUBE_ORDER, h->tube_steps, h->tube_s);
}

static void print_state(FILE *out, const held *h, const held_wish *w, int i) {
    static const char *const behind[] = {
        [HELD_TO_THE_END] = "",
        [HELD_LEFT] = "; behind it off by more: proved",
        [HELD_UNTOLD] = "; behind it the tube is too wide to tell",
        [HELD_TUBE_ENDS] = "; there the tube ends",
    };
    const held_state *s = &h->state[i];
    const image_unit *unit = unit_of(w, i);
    char name[NAME_SIZE];
    char until[40];
    snprintf(until, sizeof until, "%.9g", s->until_s);
    fprintf(out, "  %-*s %-12s within %.2e %s: off by at most %.1e, the tube %.1e wide%s\n",
            NAME_WIDTH, name_of(w, i, name), s->verdict == HELD_TO_THE_END ? "to the end" : until,
            image_shown(unit, s->within), strcmp(unit->shown, "1") == 0 ? "" : unit->shown,
            image_shown(unit, s->off), image_shown(unit, 2.0 * s->radius), behind[s->verdict]);
}

void held_print(FILE *out, const held *h, const held_wish *w) {
    int first = -1;
    print_head(out, h, w);
    fputs("\nproved at the end of every step until [s]\n", out);
    for (int i = 0; i < h->states; i++) {
        print_state(out, h, w, i);
        if (h->state[i].verdict != HELD_TO_THE_END &&
            (first < 0 || h->state[i].until_s < h->state[first].until_s)) {
            first = i;
        }
    }
    const double end_s = ratio_times(w->image->steps, w->image->step);
    char name[NAME_SIZE];
    if (first < 0) {
        fprintf(out, "proved to %s, t = %.9g s\n",
                h->run_steps == w->image->steps ? "the end" : "where the run fails",
                ratio_times(h->run_steps, w->image->step));
    } else {
        fprintf(out, "proved until t = %.9g s of %.9g s: %s is the first that is not\n",
                h->state[first].until_s, end_s, name_of(w, first, name));
    }
}
