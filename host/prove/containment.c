/* containment.c: step-by-step comparison of a run's records with the tube. */
#include "host/prove/containment.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/engine/loop.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/number/ratio.h"
#include "host/os/system.h"

typedef struct going {
    const containment_request *request;
    containment_found *held;
    void *run;
    double *output;   /* [outputs] of the run */
    double *value;    /* [states] of the run */
    enclosure *exact; /* [states] box of the tube; in find_ranges(), range of the run's values */
    flowpipe *tube;
    enclosure step_s; /* length of a step of the run */
    enclosure next_s; /* time from the flowpipe's end to the next record of the run */
    uint64_t done;    /* completed steps of the run */
} going;

static void put(const going *g, int unknown, int primes, double value) {
    const exact_motion *m = g->request->motion;
    for (int i = 0; i < m->states; i++) {
        if (m->state[i].unknown == unknown && m->state[i].primes == primes) {
            g->value[i] = value;
        }
    }
}

static void read_run(const going *g) {
    const image *im = g->request->image;
    double state[3 * IMAGE_COMPONENTS_MAX];
    g->request->kind->state(g->run, state, state + im->angles);
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        put(g, c.unknown, c.primes, state[i]);
    }
    if (im->recovered > 0) {
        g->request->kind->outputs(g->run, g->output);
        for (int k = 0; k < im->recovered; k++) {
            const int at = im->own_outputs + 2 * k;
            put(g, im->from_momentum[k], 0, g->output[at]);
            put(g, im->from_momentum[k], 1, g->output[at + 1]);
        }
    }
}

#define LITTLE 1e-3
#define STILL 1e-9 /* assumed range of a state that is always 0, in SI units */

static const image_unit *unit_of(const containment_request *w, int i) {
    const exact_state s = w->motion->state[i];
    return &w->image->unknown[s.unknown].unit[s.primes];
}

static void set_within(const containment_request *w, containment_found *h) {
    for (int i = 0; i < h->states; i++) {
        double most = h->state[i].range;
        for (int j = 0; j < h->states; j++) {
            if (strcmp(unit_of(w, i)->si, unit_of(w, j)->si) == 0) {
                most = number_most(most, LITTLE * h->state[j].range);
            }
        }
        most = most > 0.0 ? most : STILL;
        h->state[i].within = w->within[i] > 0.0 ? w->within[i] : w->tolerance * most;
    }
}

static bool see(void *of, uint64_t step) {
    const going *g = of;
    read_run(g);
    for (int i = 0; i < g->held->states; i++) {
        const double value = g->value[i];
        g->exact[i] = step == 0 ? enclosure_of(value)
                                : (enclosure){number_least(g->exact[i].low, value),
                                              number_most(g->exact[i].high, value)};
    }
    return true;
}

static void find_ranges(going *g) {
    const containment_request *w = g->request;
    containment_found *h = g->held;
    g->run = w->kind->start(w->image);
    const loop l = {.kind = w->kind, .run = g->run, .steps = w->image->steps, .see = see, .of = g};
    h->ranged = loop_run(&l, &h->status) != LOOP_INTERRUPTED;
    h->run_steps = w->kind->steps(g->run);
    w->kind->stop(g->run);
    for (int i = 0; i < h->states; i++) {
        const double low = g->exact[i].low;
        const double high = g->exact[i].high;
        h->state[i].open = true;
        h->state[i].range = number_most(high - low, LITTLE * number_most(fabs(low), fabs(high)));
    }
    set_within(w, h);
}

static bool all_closed(const containment_found *h) {
    for (int i = 0; i < h->states; i++) {
        if (h->state[i].open) {
            return false;
        }
    }
    return true;
}

static void look(containment_found *h, const double *value, const enclosure *exact, double time_s) {
    for (int i = 0; i < h->states; i++) {
        containment_state *s = &h->state[i];
        const enclosure off = enclosure_sub(enclosure_of(value[i]), exact[i]);
        const double most = enclosure_size(off);
        if (!s->open) {
            continue;
        }
        if (enclosure_is_finite(off) && most <= s->within) {
            s->begun = true;
            s->until_s = time_s;
            s->off = number_most(s->off, most);
            s->radius = number_most(s->radius, enclosure_radius(exact[i]));
        } else {
            s->open = false;
            s->verdict = off.low > s->within || off.high < -s->within ? CONTAINMENT_LEFT
                                                                      : CONTAINMENT_UNDECIDED;
        }
    }
}

static void look_now(going *g) {
    const containment_request *w = g->request;
    read_run(g);
    look(g->held, g->value, g->exact, ratio_times(g->done, w->image->step));
    if (w->see != NULL) {
        w->see(w->context, g->done, g->exact, g->value);
    }
}

/* Compares the run's records within the tube's open step, whose length is h_s. Returns the number of records.
 * *last_s: time from the open step's start to the last record. */
static uint64_t look_within(going *g, double h_s, enclosure *last_s) {
    uint64_t count = 0;
    while (g->done < g->held->run_steps && !all_closed(g->held)) {
        const enclosure tau = enclosure_add(g->next_s, enclosure_times(g->step_s, (double)count));
        if (!(tau.high <= h_s) || loop_steps(g->request->kind, g->run, 1) != WH_OK) {
            break;
        }
        g->done++;
        count++;
        *last_s = tau;
        flowpipe_at(g->tube, tau, g->exact);
        look_now(g);
    }
    return count;
}

static bool go_on(going *g) {
    const image *im = g->request->image;
    const double left_s = 1.001 * ratio_times(g->held->run_steps - g->done, im->step);
    const double h_s = flowpipe_open(g->tube, left_s);
    if (!(h_s > 0.0)) {
        return false;
    }
    enclosure last_s;
    bool good;
    if (look_within(g, h_s, &last_s) > 0) {
        good = flowpipe_on(g->tube, last_s);
        g->next_s = g->step_s;
    } else { /* the tube's step ends before the run's step */
        const double part_s = number_least(h_s, 0.5 * g->next_s.low);
        good = flowpipe_on(g->tube, enclosure_of(part_s));
        g->next_s = enclosure_sub(g->next_s, enclosure_of(part_s));
    }
    return good && g->next_s.low > 0.0;
}

/* Returns the reason to end, or CONTAINMENT_AT_END if there is none. `on`: the result of go_on(). */
static containment_end ended(const going *g, bool on) {
    const containment_request *w = g->request;
    const bool spent = w->products_most > 0.0 && flowpipe_products(g->tube) > w->products_most;
    return interrupted ? CONTAINMENT_STOPPED
           : !on       ? CONTAINMENT_NO_STEP
           : spent     ? CONTAINMENT_SPENT
                       : CONTAINMENT_AT_END;
}

static void hold(going *g) {
    containment_found *h = g->held;
    for (int i = 0; i < h->states; i++) {
        g->exact[i] = g->request->motion->start[i];
    }
    look_now(g);
    while (h->end == CONTAINMENT_AT_END && g->done < h->run_steps && !all_closed(h)) {
        h->end = ended(g, go_on(g));
        if (g->request->progress != NULL && (flowpipe_steps(g->tube) & 7U) == 0) {
            g->request->progress((double)g->done / (double)h->run_steps);
        }
    }
    const bool whole = g->done == h->run_steps;
    h->end = whole ? h->status == WH_OK ? CONTAINMENT_AT_END : CONTAINMENT_RUN_ENDS : h->end;
    h->flowpipe_steps = flowpipe_steps(g->tube);
    h->tube_s = ratio_times(g->done, g->request->image->step);
    for (int i = 0; i < h->states; i++) {
        if (h->state[i].open) {
            h->state[i].verdict =
                h->end == CONTAINMENT_AT_END ? CONTAINMENT_TO_THE_END : CONTAINMENT_UNENDED;
        }
    }
}

static enclosure counted(uint64_t count) {
    const double near = (double)count;
    return near < 0x1p53 ? enclosure_of(near) : enclosure_about(near, 0);
}

containment_found containment_run(const containment_request *w) {
    const image *im = w->image;
    containment_found h = {.states = w->motion->states, .end = CONTAINMENT_STOPPED};
    h.state = alloc(h.states, sizeof *h.state);
    going g = {.request = w,
               .held = &h,
               .output = alloc(im->outputs, sizeof(double)),
               .value = alloc(h.states, sizeof(double)),
               .exact = alloc(h.states, sizeof(enclosure))};
    find_ranges(&g);
    if (h.ranged) {
        h.end = CONTAINMENT_AT_END;
        g.tube = flowpipe_new(w->motion, FLOWPIPE_ORDER);
        g.run = w->kind->start(im);
        g.step_s = enclosure_div(counted(im->step.numerator), counted(im->step.denominator));
        g.next_s = g.step_s;
        hold(&g);
        w->kind->stop(g.run);
        flowpipe_free(g.tube);
    }
    free(g.output);
    free(g.value);
    free(g.exact);
    return h;
}

void containment_free(containment_found *h) { free(h->state); }

/* === results in words ========================================================================= */

enum { NAME_WIDTH = 16, NAME_SIZE = 160 };

static const char *name_of(const containment_request *w, int i, char text[NAME_SIZE]) {
    const exact_state s = w->motion->state[i];
    snprintf(text, NAME_SIZE, "%.120s%.*s", w->image->unknown[s.unknown].name, s.primes,
             "''''''''''''''''");
    return text;
}

enum { FIGURE = 40 };

/* Prints x with this number of decimal places, rounded up, because a printed bound must not be below x. */
static const char *not_less(double x, int places, char text[FIGURE]) {
    const char *end;
    double shown = enclosure_above(enclosure_above(x));
    snprintf(text, FIGURE, "%.*e", places, x);
    while (x > 0.0 && decimal_read(text, &end) < x) {
        shown *= 1.001;
        snprintf(text, FIGURE, "%.*e", places, shown);
    }
    return text;
}

/* The reason, in words, why the proved time ends. */
static const char *behind(const containment_found *h, const containment_state *s) {
    static const char *const ends[] = {[CONTAINMENT_AT_END] = "",
                                       [CONTAINMENT_RUN_ENDS] = "; at that time the run fails",
                                       [CONTAINMENT_NO_STEP] = "; at that time the tube ends",
                                       [CONTAINMENT_SPENT] = "; at that time the effort is used up",
                                       [CONTAINMENT_STOPPED] =
                                           "; at that time the proof was interrupted"};
    switch (s->verdict) {
    case CONTAINMENT_TO_THE_END: return "";
    case CONTAINMENT_LEFT: return "; proved: error too large after that";
    case CONTAINMENT_UNDECIDED: return "; after that the tube is too wide to decide";
    case CONTAINMENT_UNENDED: return ends[h->end];
    }
    return "";
}

static void print_state(FILE *out, const containment_found *h, const containment_request *w,
                        int i) {
    const containment_state *s = &h->state[i];
    const image_unit *unit = unit_of(w, i);
    const char *shown = strcmp(unit->shown, "1") == 0 ? "" : unit->shown;
    char name[NAME_SIZE];
    char within[FIGURE];
    char off[FIGURE];
    char wide[FIGURE];
    char until[FIGURE];
    not_less(image_shown(unit, s->within), 2, within);
    snprintf(until, sizeof until, "%.15g", s->until_s);
    fprintf(out, "  %-*s ", NAME_WIDTH, name_of(w, i, name));
    if (!s->begun) {
        fprintf(out, "%-12s within %s %s: %s\n", "never", within, shown,
                s->verdict == CONTAINMENT_LEFT ? "proved: the error is too large at the start"
                                               : "the uncertainty of the start value exceeds this");
        return;
    }
    fprintf(out, "%-12s within %s %s: error at most %s, width of the tube %s%s\n",
            s->verdict == CONTAINMENT_TO_THE_END ? "to the end" : until, within, shown,
            not_less(image_shown(unit, s->off), 1, off),
            not_less(image_shown(unit, 2.0 * s->radius), 1, wide), behind(h, s));
}

/* Returns the state with the shortest proved time, or -1 if all are proved to the end. */
static int first_of(const containment_found *h) {
    int first = -1;
    for (int i = 0; i < h->states; i++) {
        const containment_state *s = &h->state[i];
        if (s->verdict != CONTAINMENT_TO_THE_END &&
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

void containment_print(FILE *out, const containment_found *h, const containment_request *w) {
    const image *im = w->image;
    const double end_s = ratio_times(im->steps, im->step);
    const int first = first_of(h);
    char name[NAME_SIZE];
    fprintf(out, "%s%s%s\n", im->name, im->title[0] != '\0' ? ": " : "", im->title);
    fprintf(out, "  %s%s, %s, step %.9g s, %" PRIu64 " steps to t = %.15g s\n", image_stepper(im),
            image_sums(im), w->kind->name, im->step_s, im->steps, end_s);
    fprintf(out,
            "  compared with a tube around the exact motion: Taylor steps of order %d, %" PRIu64
            " of them to t = %.15g s\n",
            FLOWPIPE_ORDER, h->flowpipe_steps, h->tube_s);
    fputs("\ntime [s] until which the accuracy at the end of every step is proved\n", out);
    for (int i = 0; i < h->states; i++) {
        print_state(out, h, w, i);
    }
    if (first < 0) {
        fprintf(out, "proved to the end, t = %.15g s\n", end_s);
    } else if (!h->state[first].begun) {
        fprintf(out, "nothing is proved: %s is not within its tolerance at the start\n",
                name_of(w, first, name));
    } else {
        const containment_state *s = &h->state[first];
        fprintf(out, "proved until t = %.15g s of %.15g s", s->until_s, end_s);
        fprintf(out,
                s->verdict == CONTAINMENT_UNENDED ? "\n"
                                                  : ": %s is the first quantity "
                                                    "without a proof\n",
                name_of(w, first, name));
    }
}

void containment_rows_head(FILE *out, const containment_request *w) {
    char name[NAME_SIZE];
    fputs("time [s]", out);
    for (int i = 0; i < w->motion->states; i++) {
        const char *si = unit_of(w, i)->si;
        name_of(w, i, name);
        fprintf(out, ",%s least [%s],%s most [%s],%s run [%s]", name, si, name, si, name, si);
    }
    fputs("\r\n", out);
}

void containment_row(FILE *out, const containment_request *w, uint64_t step, const enclosure *exact,
                     const double *run) {
    fprintf(out, "%.15g", ratio_times(step, w->image->step));
    for (int i = 0; i < w->motion->states; i++) {
        fprintf(out, ",%.17g,%.17g,%.17g", exact[i].low, exact[i].high, run[i]);
    }
    fputs("\r\n", out);
}
