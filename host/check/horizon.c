#include "host/check/horizon.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/check/nonfinite.h"
#include "host/number/functions.h"

/* Factor on the round-off bound, because the bound omits the round-off of library functions and of a step's sums. */
#define ROUNDING_ROOM 8.0
/* If a column has no rate, the column's range counts as at least this part of the column's largest |value|. */
#define LEAST_RANGE 1e-3
#define LEAST_RANGE_DOUBLE 1e-9
/* A position is constant if its range is small, relative to its magnitude (STAYS) or other ranges (BESIDE_OTHERS). */
#define STAYS 1e-9
#define FLOAT_STAYS 3e-7 /* in float, a range up to this part of the magnitude is round-off */
#define BESIDE_OTHERS 1e-3
#define STARTS 1e-12 /* a computed start value up to this, in SI units, counts as zero */
/* Round-off may hide an error if the bound on the round-off exceeds BOUND_OVER times the error. The bound is 8 to 20
 * times the true round-off. */
#define BOUND_OVER 8.0

static double size_of(const step_doubling_column *c) {
    return number_most(fabs(c->low), fabs(c->high));
}

static bool stays(const step_doubling *t, int k) {
    const step_doubling_column *c = &t->column[t->column[k].place];
    const double range = c->high - c->low;
    return range <= STAYS * number_most(size_of(c), c->one) || range <= BESIDE_OTHERS * c->alike;
}

bool horizon_moves(const step_doubling *t, int k) {
    const step_doubling_column *c = &t->column[t->column[k].place];
    const double moved = number_most(c->high - c->low, c->off.most);
    if (t->shape->kind == &engine_float && moved <= FLOAT_STAYS * size_of(c)) {
        return false;
    }
    return !stays(t, k) || fabs(c->start) > (c->written ? 0.0 : STARTS * c->one);
}

/* The scale of round-off: the column's largest magnitude, and at least one SI unit if the column starts at zero. */
static double least_size(const step_doubling_column *c) {
    const double least = c->written ? 0.0 : STARTS * c->one;
    return fabs(c->start) > least ? size_of(c) : number_most(size_of(c), c->one);
}

static bool has_few_digits(const step_doubling *t, int k, double least) {
    const step_doubling_column *c = &t->column[k];
    return c->rounding > BOUND_OVER * least && (!stays(t, k) || c->rounding > least_size(c));
}

static horizon_column judge(const step_doubling *t, int k, double tolerance) {
    const step_doubling_column *c = &t->column[k];
    const double range = c->high - c->low;
    const double least = t->shape->kind == &engine_double ? LEAST_RANGE_DOUBLE : LEAST_RANGE;
    const double by = number_most(range, c->has_rate ? 0.0 : least * size_of(c));
    const double level = tolerance * by / t->left_out;
    horizon_column made = {.range = by,
                           .off = c->off.most * t->left_out,
                           .rounding = c->rounding,
                           .until_s = passages_until_s(&c->off, level)};
    if (t->aliased.column > 0) { /* both runs are wrong from an unknown time on */
        made.verdict = HORIZON_UNTIL;
        made.until_s = 0.0;
        return made;
    }
    const bool passed = isfinite(made.until_s);
    const bool few = has_few_digits(t, k, tolerance * by);
    if (passed && !(few && c->rounding > least_size(c)) &&
        (!t->refolded || made.off <= ROUNDING_ROOM * c->rounding) &&
        range <= ROUNDING_ROOM * c->rounding && isfinite(made.off) && stays(t, k)) {
        made.verdict = HORIZON_ROUNDING;
        made.until_s = t->end_s;
    } else if (passed && t->unwrapped && made.until_s >= t->cut_s) {
        made.verdict = HORIZON_UNKNOWN;
    } else if (passed) {
        made.verdict = HORIZON_UNTIL;
    } else if (few) {
        made.verdict = HORIZON_UNKNOWN;
        made.until_s = 0.0;
    } else {
        made.verdict = range > 0.0 || made.off > 0.0 ? HORIZON_TO_THE_END : HORIZON_STILL;
        made.until_s = t->end_s;
    }
    return made;
}

horizon horizon_of(const step_doubling *t, double tolerance) {
    horizon h = {.of = t,
                 .tolerance = tolerance,
                 .column = alloc(t->columns, sizeof *h.column),
                 .to_the_end = true,
                 .first = -1,
                 .until_s = t->end_s};
    for (int k = 1; k < t->columns; k++) {
        h.column[k] = judge(t, k, tolerance);
        if (h.column[k].verdict == HORIZON_UNTIL || h.column[k].verdict == HORIZON_UNKNOWN) {
            h.to_the_end = false;
            if (h.first < 0 || h.column[k].until_s < h.until_s) {
                h.first = k;
                h.until_s = h.column[k].until_s;
            }
        }
    }
    return h;
}

double horizon_trusted_s(const horizon *h) {
    const bool unknown = !h->to_the_end && (h->column[h->first].verdict == HORIZON_UNKNOWN ||
                                            h->of->aliased.column > 0);
    return unknown ? -1.0 : h->until_s;
}

void horizon_free(horizon *h) {
    free(h->column);
    h->column = NULL;
}

/* === aliasing ==================================================================================== */
/* Detects forcing that aliases with the step. Example: if the steps are 4 ms and 2 ms, a force of 1 kHz has the same
 * value at every stage. Then the run and its finer run agree, although both are wrong. A third run with a prime number
 * of steps samples other phases of the force, so its last state differs. */

/* The third run has about STEPS times as many steps as the run. */
#define STEPS 1.41
/* The third run may have an error of ITS_OWN times the difference between the run and the finer run. */
#define ITS_OWN 2.0
#define ALIKE 1e-9 /* constant part of the allowed difference, in SI units */

static bool is_prime(uint64_t n) {
    for (uint64_t i = 3; i * i <= n; i += 2) {
        if (n % i == 0) {
            return false;
        }
    }
    return n % 2U == 1U;
}

/* The image of the third run. Returns false if its step is not a ratio of two 64-bit numbers. */
static bool third_image(const step_doubling *t, uint64_t steps, image *im) {
    const image *run = t->shape->image;
    *im = t->finer;
    im->steps = 1U + (uint64_t)(STEPS * (double)steps);
    while (!is_prime(im->steps)) {
        im->steps++;
    }
    im->step = run->step;
    if (__builtin_mul_overflow(im->step.numerator, steps, &im->step.numerator) ||
        __builtin_mul_overflow(im->step.denominator, im->steps, &im->step.denominator)) {
        return false;
    }
    im->step_s = ratio_times(1, im->step);
    return true;
}

/* With contacts, rates are not compared: they jump at impacts, and not at the same time in both runs. */
static void compare(step_doubling *t, const horizon *h, const double *now, const double *other,
                    double step_s) {
    for (int k = 1; k < t->columns; k++) {
        const horizon_column *c = &h->column[k];
        const double off = fabs(other[k] - now[k]);
        const double range = number_most(c->range, off);
        /* up to now the run and the finer one agree within this error */
        const double within = h->tolerance * range;
        const double least = within + ITS_OWN * (number_least(c->off, within) + c->rounding) +
                             ALIKE * t->column[k].one;
        const bool jumps = t->shape->image->contacts > 0 && t->shape->column[k].primes > 0;
        if (!jumps && c->verdict != HORIZON_ROUNDING && off > least &&
            off / range > t->aliased.part) {
            t->aliased = (step_doubling_aliased){.column = k,
                                                 .part = off / range,
                                                 .value = now[k],
                                                 .other = other[k],
                                                 .at_s = now[0],
                                                 .step_s = step_s};
        }
    }
}

/* The number of the run's steps in which all columns are accurate. */
static uint64_t trusted_steps(const step_doubling *t, const horizon *h) {
    const image *im = t->shape->image;
    double until_s = t->end_s;
    for (int k = 1; k < t->columns; k++) {
        if (h->column[k].verdict == HORIZON_UNTIL) {
            until_s = number_least(until_s, h->column[k].until_s);
        }
    }
    return until_s < t->end_s ? (uint64_t)(until_s / im->step_s) : im->steps;
}

/* Runs the image to its end; row[columns] gets the last state. */
static loop_end end_of(const step_doubling *t, const image *im, const budget *of, double *row) {
    wh_status status;
    records *r = records_open(NULL, im, &engine_double);
    void *run = engine_double.start(im);
    const loop l = {.kind = &engine_double, .run = run, .steps = im->steps, .pays = of};
    const loop_end end = loop_run(&l, &status);
    records_read(r, run, ratio_times(im->steps, im->step));
    memcpy(row, r->row, (size_t)t->columns * sizeof *row);
    engine_double.stop(run);
    records_close(r);
    return end;
}

void aliasing_find(step_doubling *t, budget *of) {
    const image *im = t->shape->image;
    if (t->status != WH_OK || im->steps == 0 || t->shape->kind->steps(t->run) != im->steps) {
        return; /* the run has failed, or was interrupted */
    }
    budget_begin(of);
    image third;
    loop_end end = LOOP_DONE;
    horizon h = horizon_of(t, HORIZON_TOLERANCE);
    const uint64_t steps = trusted_steps(t, &h);
    if (steps > 0 && im->settings.matrix == MATRIX_NONE && third_image(t, steps, &third)) {
        image finer = t->finer;
        double *row = alloc(2 * (int64_t)t->columns, sizeof *row);
        finer.steps = steps * t->each;
        const bool whole = steps == im->steps;
        const double runs = (double)(third.steps + (whole ? 0 : finer.steps));
        const double wanted = runs / (double)(im->steps * t->each) * (double)t->operations;
        end = wanted > budget_left(of) ? LOOP_SPENT : end_of(t, &third, of, row);
        if (end == LOOP_DONE && !whole) {
            end = end_of(t, &finer, of, row + t->columns);
        }
        if (end == LOOP_DONE) {
            compare(t, &h, whole ? t->finers->row : row + t->columns, row, third.step_s);
        }
        free(row);
    }
    horizon_free(&h);
    budget_end(of);
    t->unaliased = end != LOOP_DONE && end != LOOP_FAILED;
}

/* === in words ================================================================================= */

/* Width of column names in tables; longer ones shift the rest of the row. */
enum { NAME_WIDTH = 16 };

static const image *image_of(const horizon *h) { return h->of->shape->image; }

/* Prints why the accuracy of this column is unknown. */
static void say_unknown(FILE *out, const horizon *h, int k) {
    const horizon_column *c = &h->column[k];
    if (h->of->unwrapped && c->until_s >= h->of->cut_s) {
        fprintf(out, "unknown after t = %.6g s: sine is computed only up to %g rad in double",
                h->of->cut_s, ANGLE_SINE_MOST_RAD);
    } else if (c->range > 0.0) {
        fprintf(out, "unknown: even in double, round-off may change the value by %.2g of its range",
                c->rounding / c->range);
    } else {
        fputs("unknown: even in double, round-off may be the reason that the value does not change",
              out);
    }
}

static void print_column(FILE *out, const horizon *h, int k) {
    const horizon_column *c = &h->column[k];
    const record_column *column = &h->of->shape->column[k];
    const char *unit = strcmp(column->unit->shown, "1") == 0 ? "" : column->unit->shown;
    char name[RECORDS_SHOWN_NAME];
    fprintf(out, "  %-*s ", NAME_WIDTH, records_shown_name(column, name));
    switch (c->verdict) {
    case HORIZON_TO_THE_END:
        fprintf(out, "to the end      error %.2e of its range of %.4g %s", c->off / c->range,
                c->range, unit);
        break;
    case HORIZON_UNTIL:
        fprintf(out, "%-15.9g error at most %.2g %s; range %.4g %s", c->until_s,
                h->tolerance * c->range, unit, c->range, unit);
        break;
    case HORIZON_STILL: fputs("to the end      constant in this run", out); break;
    case HORIZON_UNKNOWN: say_unknown(out, h, k); break;
    case HORIZON_ROUNDING:
        fprintf(out, "to the end      only round-off moves it, by %.2e %s",
                number_most(c->off, c->range), unit);
        break;
    }
    fputc('\n', out);
}

/* --- quantities that stay correct --------------------------------------------------------------------*/

/* Prints the balances, which stay meaningful after the coordinates have become inaccurate. */
static void print_invariants(FILE *out, const horizon *h, const books *b,
                             const energy_residual *balance) {
    fputs("after that no single coordinate is accurate", out);
    if (b == NULL) {
        fputs("; a system of equations has no energy balance\n", out);
        return;
    }
    fputs("; only the balances are meaningful, to t = ", out);
    fprintf(out, "%.9g s:\n", h->of->end_s);
    if (!balance->known) {
        fputs("  energy: the balance is not known\n", out);
    } else if (energy_residual_lost(balance, ENERGY_RESIDUAL_LIMIT)) {
        fprintf(out, "  energy: the balance fails too, residual %.2e of its largest entry\n",
                balance->ratio);
    } else {
        fprintf(out, "  energy: residual %.2e of the largest entry of the balance\n",
                balance->ratio);
    }
    for (int i = 0; i < b->image->count; i++) {
        const image_unknown *u = &b->image->unknown[i];
        if (u->conserved) {
            fprintf(out, "  momentum of %s: drifts by at most %.2e %s\n", u->name, b->drift[i],
                    u->momentum_si);
        }
    }
}

/* The earliest reason why nothing is known after cut_s. */
static const char *cut_by(const step_doubling *t) {
    if (t->finer_failed_s >= 0.0 && t->finer_failed_s <= t->cut_s) {
        return "the run with half the step fails at this time";
    }
    if (t->jumped_s < 0.0 || (t->overrun_s >= 0.0 && t->overrun_s < t->jumped_s)) {
        return "a later step of this run or of the finer run had more than eight moments with events";
    }
    return t->missed
               ? "a later step of this run or of the finer run missed a contact, an edge or a brief force"
               : "a later step of this run or of the finer run jumped over a pole of an expression";
}

/* Prints the time until which the run is accurate, and why not longer. If `end`, also prints the end of the run. */
static void say_until(FILE *out, const horizon *h, bool end) {
    const step_doubling *t = h->of;
    char name[RECORDS_SHOWN_NAME];
    (void)records_shown_name(&t->shape->column[h->first], name);
    if (h->column[h->first].verdict == HORIZON_UNKNOWN) {
        say_unknown(out, h, h->first);
        fprintf(out, " (%s)", name);
        return;
    }
    fprintf(out, "until t = %.*g s", end ? 9 : 6, h->until_s);
    if (end) {
        fprintf(out, " of %.9g s", t->end_s);
    }
    if (t->aliased.column > 0) {
        fputs(": the steps alias a fast force or motion", out);
    } else if (t->cut_s >= 0.0 && h->until_s >= t->cut_s) {
        fprintf(out, ": %s", cut_by(t));
    } else {
        fprintf(out, ": after that the error of %s exceeds %.3g of its range", name, h->tolerance);
    }
}

void horizon_print(FILE *out, const horizon *h, const books *b, const energy_residual *balance) {
    const step_doubling *t = h->of;
    const image *im = image_of(h);
    fprintf(out, "%s%s%s\n", im->name, im->title[0] != '\0' ? ": " : "", im->title);
    fprintf(out, "  %s%s, %s, step %.9g s, %" PRIu64 " steps to t = %.15g s\n", image_stepper(im),
            image_sums(im), t->shape->kind->name, im->step_s, im->steps,
            ratio_times(im->steps, im->step));
    fprintf(out, "  compared with %s%s, double, step %.9g s\n", image_stepper(&t->finer),
            image_sums(&t->finer), t->finer.step_s);
    if (im->contacts > 0) {
        fputs("  in the steps around an event, errors of rates are ignored\n", out);
    }
    fprintf(out, "\neach quantity is accurate to %.3g of its range until [s]\n", h->tolerance);
    for (int k = 1; k < t->columns; k++) {
        print_column(out, h, k);
    }
    fputs("trusted ", out);
    if (h->to_the_end) {
        fprintf(out, "to %s, t = %.9g s\n", t->status == WH_OK ? "the end" : "where the run fails",
                t->end_s);
        return;
    }
    say_until(out, h, true);
    fputc('\n', out);
    if (t->cut_s > h->until_s) {
        fprintf(out, "unknown after t = %.9g s: %s\n", t->cut_s, cut_by(t));
    }
    print_invariants(out, h, b, balance);
}

void horizon_print_line(FILE *out, const horizon *h, bool doubted) {
    fputs("trusted            ", out);
    if (h->to_the_end && doubted) {
        fputs(
            "unknown: this run and the finer run agree to the end, but both may have the error of the warning",
            out);
    } else if (h->to_the_end) {
        fprintf(out, "to the end: every coordinate to %.3g of its range", h->tolerance);
    } else if (h->of->aliased.column > 0) {
        fputs("unknown: the steps alias a fast force or motion", out);
    } else {
        say_until(out, h, false);
        const bool known = h->column[h->first].verdict == HORIZON_UNTIL;
        fputs(known && image_of(h)->has_energies ? "; only the balances below are meaningful then"
                                                 : "",
              out);
    }
    fputc('\n', out);
}

const char *const horizon_words[] = {[HORIZON_TO_THE_END] = "end",
                                     [HORIZON_UNTIL] = "until",
                                     [HORIZON_STILL] = "still",
                                     [HORIZON_ROUNDING] = "rounding",
                                     [HORIZON_UNKNOWN] = "unknown"};

void horizon_write(FILE *out, const horizon *h) {
    char name[RECORDS_SHOWN_NAME];
    fputs("column,unit,verdict,until,range,off\r\n", out);
    for (int k = 1; k < h->of->columns; k++) {
        const horizon_column *c = &h->column[k];
        const record_column *column = &h->of->shape->column[k];
        fprintf(out, "%s,%s,%s,%.15g,%.17g,%.17g\r\n", records_shown_name(column, name),
                column->unit->shown, horizon_words[c->verdict], c->until_s, c->range, c->off);
    }
}
