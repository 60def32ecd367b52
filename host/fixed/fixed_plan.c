/* fixed_plan.c: a scene's step in fixed point: its ranges, binary points and constants. */
#include "host/fixed/fixed_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

static const char refused_part[] =
    "choose --number float; or put this statement into an effect, and use --without EFFECT";

/* Returns false (reported) if fixed point does not support the scene or its settings. */
static bool fixed_has_step(const image *im, diags *errors) {
    const image_settings *s = &im->settings;
    if (op_list_has(im->list[IMAGE_OBSERVE], OP_NOISE)) {
        diag_error(errors, im->at, refused_part,
                   "outputs of '%s' have noise, which fixed point does not support", im->name);
    } else if (im->contacts > 0) {
        diag_error(errors, im->contact[0].at, refused_part,
                   "fixed point does not support events, but '%s' has this %s", im->name,
                   im->contact[0].word);
    } else if (im->drives > 0) {
        diag_error(errors, im->input[im->drive[0].input].at,
                   "leave out the rate of the input, or choose --number float",
                   "in fixed point inputs are constant within a step, but '%s' has a rate",
                   im->input[im->drive[0].input].name);
    } else if (s->stabilized) {
        diag_error(errors, im->at, "leave out --stabilized, or choose --number float",
                   "there is no --stabilized in fixed point");
    } else if (im->ledger.kept) {
        diag_error(errors, im->at, "--without ledger, or --number float",
                   "'%s' keeps a ledger, which fixed point does not support", im->name);
    } else if (s->method != WH_RK4) {
        diag_error(errors, im->at, "leave out --method, or choose --number float",
                   "fixed point supports only --method rk4, not %s", wh_methods[s->method].word);
    } else if (s->compensated) {
        diag_error(errors, im->at, "leave out --compensated, or choose --number float",
                   "sums in fixed point are not compensated");
    } else if (s->matrix != MATRIX_NONE) {
        diag_error(errors, im->at, "leave out --matrix, or choose --number float",
                   "there is no --matrix %s in fixed point", image_matrix_words[s->matrix]);
    } else if (s->tables != TABLES_NONE) {
        diag_error(errors, im->at, "leave out --tables, or choose --number float",
                   "there are no --tables %s in fixed point", image_tables_words[s->tables]);
    } else if (im->angles + im->reals == 0) {
        diag_error(errors, im->at, NULL, "'%s' has no coordinate or state to integrate", im->name);
    } else {
        return true;
    }
    return false;
}

/* Returns false (reported) if a range is too large or does not contain the start value. */
static bool fixed_ranges_hold(const image *im, const enclosure *range, diags *errors) {
    bool good = true;
    for (int i = 0; i < im->reals + im->inputs; i++) {
        if (!(enclosure_size(range[i]) <= FIXED_SIZE_MOST)) {
            diag_error(
                errors, im->range[i].at, "declare a narrower range: range NAME = A .. B",
                "the range of '%s' reaches beyond %.2g (SI), the most that fixed point allows",
                im->range[i].name, FIXED_SIZE_MOST);
            good = false;
        }
    }
    for (int i = 0; i < im->reals + im->inputs && good; i++) {
        const double value = i < im->reals ? im->start_real[i] : im->input[i - im->reals].value;
        if (value < range[i].low || value > range[i].high) {
            diag_error(errors, im->range[i].at, "widen the range, or start within it",
                       "'%s' starts at %.9g, outside its range", im->range[i].name, value);
            good = false;
        }
    }
    return good;
}

bool fixed_inputs_declared(const image *im, const enclosure *range, diags *errors) {
    bool good = true;
    for (int i = im->reals; i < im->reals + im->inputs; i++) {
        const char *si = im->input[i - im->reals].unit.si;
        const bool has_unit = strcmp(si, "1") != 0;
        if (!im->range[i].declared) {
            char hint[200];
            snprintf(hint, sizeof hint, "in the scene: range %.60s = %.9g .. %.9g%s%.40s%s",
                     im->range[i].name, range[i].low < 0.0 ? range[i].low : 0.0,
                     range[i].high > 0.0 ? range[i].high : 0.0, has_unit ? " [" : "",
                     has_unit ? si : "", has_unit ? "]" : "");
            diag_error(errors, im->range[i].at, hint,
                       "code in fixed point needs the range of the input '%s'", im->range[i].name);
            good = false;
        }
    }
    return good;
}

/* === the plan ================================================================================= */

#define PHASE_PER_RAD 683565275.57643159 /* 2^32/(2 pi) */

static wh_fixed_format format_of(enclosure range, int bits) {
    return (wh_fixed_format){(int16_t)bits, (int32_t)number_ceiling(number_scaled(range.low, bits)),
                             (int32_t)number_floor(number_scaled(range.high, bits))};
}

/* Returns the largest `bits` with size * 2^bits <= most. */
static int room_for(double size, double most) {
    const int finest = fixed_point_of(size, FIXED_DIGITS) + 3;
    int less = 0;
    while (less < 8 && !(number_scaled(size, finest - less) <= most)) {
        less++;
    }
    return finest - less;
}

/* Sets *gain to multiply x by `factor`. x has `from` digits after the point, and its integer is at most `size`. The
 * product has `to` digits after the point. Returns false if the left shift of x overflows. */
static bool make_gain(fixed_gain *gain, double factor, double size, int from, int to) {
    const int bits = fixed_factor_bits(factor);
    int digits;
    (void)number_split(size + 1.0, &digits);
    const int by = from + bits - to - 32;
    gain->number = (int32_t)number_nearest(number_scaled(factor, bits));
    gain->shift = by >= 1 ? 0 : 1 - by;
    gain->by = by + gain->shift;
    return gain->shift <= 31 - digits;
}

/* Computes a gain for wh_fixed_mul_short(): `number` has 15 binary digits, and `shift` is 0. */
static fixed_gain short_gain(double factor, int from, int to) {
    const int bits = fixed_factor_bits(factor) - 16;
    const double number = number_nearest(number_scaled(factor, bits));
    return (fixed_gain){number > 32767.0 ? 32767 : (int32_t)number, 0, from - 14 + bits - to};
}

/* Returns a component's number of digits after the point, less than `list_bits`. by: largest change in half a step. */
static int kept_bits(enclosure range, double by, int list_bits) {
    const int finest = fixed_point_of(enclosure_size(range) + 2.2 * by, FIXED_KEPT_DIGITS);
    return finest < list_bits - 1 ? finest : list_bits - 1;
}

static void too_far(const fixed_plan *p, diags *errors) {
    diag_error(errors, p->image->at, "take a smaller --step, or declare narrower ranges",
               "a step of %.9g s may move '%s' too far for fixed point", p->image->step_s,
               p->image->name);
}

static void no_room(const fixed_plan *p, diags *errors) {
    diag_error(errors, p->image->at,
               "take another --step, or declare other ranges: range NAME = A .. B; or choose "
               "--number float",
               "rounding may carry values of '%s' out of their range", p->image->name);
}

static const fixed_op *result_of(const fixed_plan *p, int i) {
    return &p->list->op[p->list->result[i]];
}

/* The index of the real component that result i of the list changes; negative for an angle of a first-order system. */
static int kept_at(const fixed_plan *p, int i) {
    return p->second ? p->linears + i : i - p->image->angles;
}

enum { GUARD_MOST = 8 };

/* Sets how rate and acceleration are added to the position of a second-order coordinate. */
static bool move_place(fixed_plan *p, int i) {
    const image *im = p->image;
    fixed_mover *m = &p->mover[i];
    const fixed_op *accel = result_of(p, i);
    const wh_fixed_format *rate = &p->format[kept_at(p, i)];
    const double unit = i < im->angles ? PHASE_PER_RAD : 1.0;
    const double half = 0.5 * im->step_s * unit;
    const double by =
        half * (enclosure_size(p->range[kept_at(p, i)]) +
                2.0 * enclosure_size(accel->range)); /* largest change in half a step */
    int bits = 0;
    if (i < im->angles) {
        if (2.0 * by >= 1073741824.0) {
            return false;
        }
    } else {
        wh_fixed_format *f = &p->format[i - im->angles];
        const enclosure range = p->range[i - im->angles];
        bits = kept_bits(range, by, 1000);
        *f = format_of(range, bits);
    }
    m->guard = room_for(2.0 * by, 1073741824.0) - bits;
    m->guard = m->guard > GUARD_MOST ? GUARD_MOST : m->guard < 0 ? 0 : m->guard;
    const double rate_size = enclosure_size((enclosure){rate->low, rate->high});
    const double accel_size = number_scaled(1.0, FIXED_RESULT_DIGITS);
    for (; m->guard >= 0; m->guard--) {
        const int to = bits + m->guard;
        if (make_gain(&m->half_rate, half, rate_size, rate->bits, to) &&
            make_gain(&m->third_accel, half * (2.0 / 3.0), 3.0 * accel_size, accel->bits, to)) {
            m->half_accel = short_gain(half, accel->bits, to);
            return true;
        }
    }
    return false;
}

/* Sets the movers and the formats of components. Returns false if an increment does not fit. */
static bool make_movers(fixed_plan *p) {
    for (int i = 0; i < p->coordinates; i++) {
        const fixed_op *accel = result_of(p, i);
        const double by = enclosure_size(accel->range);
        const int at = kept_at(p, i);
        if (at >= 0) {
            p->format[at] = format_of(p->range[at], kept_bits(p->range[at], by, accel->bits));
        } else if (2.0 * by >= 1073741824.0) {
            return false;
        }
        fixed_mover *m = &p->mover[i];
        const double size = number_scaled(1.0, FIXED_RESULT_DIGITS);
        const int kept = at >= 0 ? p->format[at].bits : 0;
        m->to_kept = accel->bits - kept;
        if (m->to_kept < 1 || !make_gain(&m->third, 1.0 / 3.0, 6.0 * size, accel->bits, kept) ||
            (p->second && !move_place(p, i))) {
            return false;
        }
    }
    return true;
}

static void set_leaves(fixed_plan *p) {
    const image *im = p->image;
    for (int i = 0; i < p->list->count; i++) {
        fixed_op *o = &p->list->op[i];
        const int at = o->code == FIXED_LINEAR  ? o->index
                       : o->code == FIXED_RATE  ? p->linears + o->index
                       : o->code == FIXED_INPUT ? im->reals + o->index
                                                : -1;
        o->bits = at >= 0 ? p->format[at].bits : o->bits;
    }
}

/* Bounds the change of a real component in one step. */
static double most_added(const fixed_plan *p, int at) {
    const image *im = p->image;
    if (!p->second || at >= p->linears) {
        const int result = p->second ? at - p->linears : im->angles + at;
        return 2.0 * enclosure_size(result_of(p, result)->range);
    }
    const int i = im->angles + at;
    return im->step_s * (enclosure_size(p->range[p->linears + i]) +
                         2.0 * enclosure_size(result_of(p, i)->range));
}

/* Returns true if p->stage holds each range plus a step's largest change. Otherwise, widens p->stage. */
static bool widen_stages(fixed_plan *p) {
    const image *im = p->image;
    bool enough = true;
    for (int at = 0; at < im->reals; at++) {
        const double most = 1.0000001 * most_added(p, at) + number_scaled(4.0, -p->format[at].bits);
        if (!(p->range[at].high + most <= p->stage[at].high &&
              p->range[at].low - most >= p->stage[at].low)) {
            p->stage[at] = enclosure_widened(p->range[at], 1.1 * most);
            enough = false;
        }
    }
    return enough;
}

/* Finds the ranges of the list's values for leaves within p->stage. Returns false after an error (reported) or an
 * interrupt. `ranges_alone`: p->stage equals p->range. */
static bool hull_of(fixed_plan *p, bool bits_known, bool ranges_alone, diags *errors) {
    const image *im = p->image;
    const fixed_leaves leaves = {p->stage, p->stage + p->linears, p->stage + im->reals};
    p->cells = fixed_hull(p->list, im, &leaves, bits_known, errors);
    if (p->cells == FIXED_HULL_UNBOUNDED && ranges_alone) {
        diag_error(
            errors, im->at, "declare narrower ranges: range NAME = A .. B",
            "within the ranges of '%s', values in its equations may exceed %.2g, the most that fixed point allows",
            im->name, FIXED_SIZE_MOST);
    } else if (p->cells == FIXED_HULL_UNBOUNDED) {
        too_far(p, errors);
    }
    return p->cells > 0;
}

static bool enclose(fixed_plan *p, diags *errors) {
    const image *im = p->image;
    bool enough = false;
    memcpy(p->stage, p->range, (size_t)(im->reals + im->inputs) * sizeof *p->stage);
    for (int pass = 0; pass < 12 && !enough; pass++) {
        if (!hull_of(p, false, pass == 0, errors)) {
            return false;
        }
        enough = widen_stages(p);
    }
    if (!enough) {
        too_far(p, errors);
    }
    return enough;
}

/* Chooses the binary points of the list and of the state, which depend on each other. */
static bool make_points(fixed_plan *p, diags *errors) {
    const image *im = p->image;
    const int numbers = im->reals + im->inputs;
    wh_fixed_format *before = alloc(numbers, sizeof *before);
    bool stands = false;
    bool good = true;
    for (int pass = 0; pass < 8 && good && !stands; pass++) {
        memcpy(before, p->format, (size_t)numbers * sizeof *before);
        set_leaves(p);
        good = fixed_bits(p->list, im, errors);
        if (good && !make_movers(p)) {
            too_far(p, errors);
            good = false;
        }
        stands = true;
        for (int i = 0; i < numbers; i++) {
            stands = stands && before[i].bits == p->format[i].bits;
        }
    }
    free(before);
    if (good && !stands) {
        no_room(p, errors);
    }
    return good && stands;
}

/* Repeats make_points() until p->stage has room for the round-off. Returns false on failure. */
static bool make_all_fit(fixed_plan *p, diags *errors) {
    for (int pass = 0; pass < 6; pass++) {
        if (!make_points(p, errors) || !hull_of(p, true, false, errors)) {
            return false;
        }
        const bool fits = fixed_fits(p->list);
        if (widen_stages(p)) {
            if (!fits) {
                no_room(p, errors);
            }
            return fits;
        }
    }
    too_far(p, errors);
    return false;
}

static void make_starts(fixed_plan *p) {
    const image *im = p->image;
    p->start_angle = alloc(im->angles, sizeof *p->start_angle);
    p->start_real = alloc(im->reals, sizeof *p->start_real);
    p->start_input = alloc(im->inputs, sizeof *p->start_input);
    for (int i = 0; i < im->angles; i++) {
        p->start_angle[i] = im->start_turns[i];
    }
    for (int i = 0; i < im->reals; i++) {
        p->start_real[i] =
            (int32_t)number_nearest(number_scaled(im->start_real[i], p->format[i].bits));
    }
    for (int i = 0; i < im->inputs; i++) {
        p->start_input[i] = (int32_t)number_nearest(
            number_scaled(im->input[i].value, p->format[im->reals + i].bits));
    }
}

/* Returns an initial format: `range` fits into FIXED_DIGITS digits, and `stage` into FIXED_KEPT_DIGITS. */
static wh_fixed_format first_format(enclosure range, enclosure stage) {
    const int bits = fixed_point_of(enclosure_size(range), FIXED_DIGITS);
    const int of_stage = fixed_point_of(enclosure_size(stage), FIXED_KEPT_DIGITS);
    return format_of(range, of_stage < bits ? of_stage : bits);
}

static bool make(fixed_plan *p, bool progress, diags *errors) {
    const image *im = p->image;
    const int numbers = im->reals + im->inputs;
    double scale[IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < p->coordinates; i++) {
        scale[i] = 0.5 * im->step_s * (!p->second && i < im->angles ? PHASE_PER_RAD : 1.0);
    }
    p->list = fixed_list_make(im, scale, errors);
    if (p->list == NULL || !fixed_ranges(im, p->range, progress, errors) ||
        !fixed_ranges_hold(im, p->range, errors)) {
        return false;
    }
    for (int i = 0; i < numbers; i++) {
        p->format[i] = first_format(p->range[i], p->range[i]);
    }
    if (!enclose(p, errors)) {
        return false;
    }
    for (int i = 0; i < im->reals; i++) {
        p->format[i] = first_format(p->range[i], p->stage[i]);
    }
    return make_all_fit(p, errors);
}

fixed_plan *fixed_plan_make(const image *im, bool progress, diags *errors) {
    if (!fixed_has_step(im, errors)) {
        return NULL;
    }
    fixed_plan *p = alloc(1, sizeof *p);
    const int numbers = im->reals + im->inputs;
    p->image = im;
    p->second = im->form == WH_SECOND_ORDER;
    p->coordinates = p->second ? im->coordinates : im->angles + im->reals;
    p->linears = p->coordinates - im->angles;
    p->format = alloc(numbers, sizeof *p->format);
    p->range = alloc(numbers, sizeof *p->range);
    p->stage = alloc(numbers, sizeof *p->stage);
    p->mover = alloc(p->coordinates, sizeof *p->mover);
    if (!make(p, progress, errors)) {
        fixed_plan_free(p);
        return NULL;
    }
    make_starts(p);
    return p;
}

void fixed_plan_free(fixed_plan *plan) {
    if (plan != NULL) {
        fixed_list_free(plan->list);
        free(plan->format);
        free(plan->range);
        free(plan->stage);
        free(plan->mover);
        free(plan->start_angle);
        free(plan->start_real);
        free(plan->start_input);
        free(plan);
    }
}

void fixed_plan_say(const fixed_plan *p, FILE *out, const char *begin) {
    const image *im = p->image;
    for (int i = 0; i < im->angles; i++) {
        if (im->angle_range[i].declared) {
            fprintf(out,
                    "%s'%s' is a turn angle, which takes all values: its declared range is not "
                    "used\n",
                    begin, im->angle_range[i].name);
        }
    }
    for (int i = 0; i < im->reals + im->inputs; i++) {
        if (!im->range[i].declared) {
            fprintf(out, "%srange %s = %.6g .. %.6g: not declared, taken from %s\n", begin,
                    im->range[i].name, p->range[i].low, p->range[i].high,
                    i < im->reals ? "the results of a run in double to the scene's end"
                                  : "its value");
        }
    }
}
