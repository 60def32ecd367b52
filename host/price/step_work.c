/* step_work.c: see step_work.h. Functions stand for those of core/step.h, step_end.h and stage_sums.h, whose names they
 * have; a value is how often it is zero, from 0 to 1. */
#include "step_work.h"

#include "core/method.h"

typedef struct counting {
    step_work work;
    const wh_tableau *by;
    bool second;
    bool compensated;
    bool is_float;
    bool keeps; /* what no list reads; other compilers leave it out but for the last stage, */
    bool tabled;
    bool twice;       /* compilers do not see that the same moves rates and positions */
    bool places_read; /* by the list, of any component */
    bool rates_read;
    bool angles_read;
    double rate;  /* of the component that is moved */
    double accel; /* or slope */
} counting;

static double product(counting *c, double of) {
    c->work.products += 1.0 - of;
    c->work.zero_products += of;
    return of;
}

static double sum(counting *c, double a, double b) {
    const double any = a > b ? a : b;
    c->work.sums += 1.0 - any;
    c->work.zero_sums += any;
    return a < b ? a : b;
}

/* share * value: twice a value is a sum to compilers. */
static double shared(counting *c, wh_real share, double value) {
    if (c->tabled) {
        return product(c, value);
    }
    if (share == WH_R(2.0)) {
        return sum(c, value, value);
    }
    return share == WH_R(1.0) || share == WH_R(-1.0) ? value : product(c, value);
}

static void convert(counting *c, double times, double of) {
    c->work.conversions += times * (1.0 - of);
    c->work.zero_conversions += times * of;
}

/* h / parts * sum_j share[j] * value of stage j; a constant zero where there is no share. */
static double stage_sum(counting *c, const wh_real *share, unsigned stage, double value) {
    bool any = false;
    for (unsigned j = 0; j < stage; j++) {
        if (share[j] != WH_R(0.0)) {
            const double one = shared(c, share[j], value);
            if (any) {
                sum(c, value, one);
            }
            any = true;
        }
    }
    return any ? product(c, value) : 1.0;
}

/* Does stage s stand where an earlier one does? */
static bool stands_again(const wh_tableau *by, unsigned s) {
    for (unsigned e = 0; e < s; e++) {
        bool same = by->places->node[e] == by->places->node[s] &&
                    by->places->reach[e].parts == by->places->reach[s].parts;
        for (unsigned j = 0; j < by->stages; j++) {
            same = same && by->places->reach[e].share[j] == by->places->reach[s].share[j];
        }
        if (same) {
            return true;
        }
    }
    return false;
}

/* Where component i stands at stage s of a row with a reach. */
static void reach(counting *c, unsigned s, bool is_angle) {
    if ((c->keeps || c->places_read) && stands_again(c->by, s)) {
        return;
    }
    const double led = product(c, c->rate);
    const double given = stage_sum(c, c->by->places->reach[s].share, s, c->accel);
    const double moved = sum(c, led, given);
    if (is_angle) {
        convert(c, 1.0, product(c, moved));
    } else {
        sum(c, 0.0, moved);
    }
}

static void stage_place(counting *c, unsigned s, bool is_angle) {
    const wh_real *share = c->by->stage[s].share;
    const double value = c->second ? c->rate : c->accel;
    const double moved = stage_sum(c, share, s, value);
    if (is_angle) {
        convert(c, 1.0, moved);
    } else {
        sum(c, 0.0, moved);
    }
}

static bool alike(const counting *c, unsigned stage) {
    const wh_tableau *by = c->by;
    return stage < by->stages && by->rates[stage] == by->rates[stage - 1] &&
           (!c->second || by->positions[stage] == by->positions[stage - 1]);
}

/* Is it computed where stage s stands? */
static bool is_placed(const counting *c, unsigned s, bool is_angle, bool turned) {
    return is_angle ? c->angles_read && !turned
                    : c->keeps || c->places_read || s + 1 == c->by->stages;
}

/* And with what rate? Later places may take it. */
static bool is_rated(const counting *c, unsigned s, bool is_angle, bool turned) {
    const bool reaches = c->by->places != NULL;
    bool is = c->keeps || c->rates_read || s + 1 == c->by->stages;
    for (unsigned t = s + 1; t < c->by->stages && !reaches; t++) {
        is = is || (is_placed(c, t, is_angle, turned) && c->by->stage[t].share[s] != WH_R(0.0));
    }
    return is;
}

static void stages(counting *c, bool is_angle, bool turned) {
    const wh_tableau *by = c->by;
    const bool reaches = c->second && by->places != NULL;
    for (unsigned s = reaches && by->places->node[0] != WH_R(0.0) ? 0 : 1; s < by->stages; s++) {
        const bool placed = is_placed(c, s, is_angle, turned);
        if (s > 0 && c->second && is_rated(c, s, is_angle, turned)) {
            sum(c, c->rate, stage_sum(c, by->stage[s].share, s, c->accel));
        }
        if (reaches && placed) {
            reach(c, s, is_angle);
        } else if (placed) {
            stage_place(c, s, is_angle);
        }
        if (s > 0 && alike(c, s)) {
            sum(c, c->accel, c->accel);
        }
    }
}

/* sum += share * more; returns whether there is a sum now. */
static bool total_add(counting *c, bool any, wh_real share) {
    if (share == WH_R(0.0)) {
        return any;
    }
    const double more = shared(c, share, c->accel);
    if (any) {
        sum(c, c->accel, more);
    }
    return true;
}

/* wh_sum_product(), and the product before it */
static void sum_product(counting *c, double value, double by) {
    product(c, by);
    if (!c->compensated) {
        sum(c, value, by);
        return;
    }
    for (int i = 0; i < (c->is_float ? 6 : 4); i++) {
        sum(c, value, by);
    }
    if (c->is_float) {
        product(c, by);
    }
}

static void angle_move(counting *c, double by) {
    convert(c, 1.0, product(c, by));
    if (c->compensated && c->is_float) {
        product(c, by);
        for (int i = 0; i < 4; i++) {
            sum(c, by, by);
        }
        convert(c, 3.0, by);
    }
}

static void end(counting *c, bool is_angle) {
    const wh_tableau *by = c->by;
    bool moved = false;
    bool rest = false;
    for (unsigned s = 0; s < by->stages; s++) {
        if (!alike(c, s + 1)) {
            moved = c->second ? total_add(c, moved, by->positions[s]) : moved;
            rest = total_add(c, rest, c->second ? by->rates[s] - by->positions[s] : by->rates[s]);
        }
    }
    const double leads = c->second ? (moved && c->accel < c->rate ? c->accel : c->rate) : c->accel;
    if (moved && (rest || c->twice)) { /* else it is what moves the rate */
        sum(c, c->rate, product(c, c->accel));
    } else if (moved && c->compensated) {
        sum(c, c->rate, c->accel);
    }
    if (moved && rest) {
        sum(c, c->accel, c->accel);
    }
    if (c->second && moved && c->compensated && c->is_float) { /* wh_carry_positions() */
        sum(c, 0.0, product(c, c->accel));
    }
    if (is_angle) {
        angle_move(c, leads);
    } else {
        sum_product(c, 0.0, leads);
    }
    if (c->second) {
        sum_product(c, c->rate, c->accel);
    }
    c->work.sums += !is_angle + c->second; /* that no component is absurd */
}

static void add_reads(const tape *t, counting *c) {
    for (int i = 0; i < t->count; i++) {
        const op_code code = t->ops[i].code;
        c->places_read = c->places_read || code == OP_LINEAR;
        c->rates_read = c->rates_read || code == OP_RATE;
        c->angles_read =
            c->angles_read || code == OP_PHASE || code == OP_CELL || code == OP_RADIANS;
    }
}

/* Sizes are added up to be checked, unless they are compared by their bits (wh_matrix_believable()). */
step_work step_work_of_matrix(const image *im, const operands *given) {
    const bool compensated = im->settings.compensated;
    counting c = {.compensated = compensated, .is_float = given->is_float};
    for (int i = 0; i < im->angles; i++) {
        angle_move(&c, 0.0);
    }
    for (int i = 0; i < im->reals && compensated; i++) {
        for (int k = 0; k < (c.is_float ? 9 : 8); k++) {
            sum(&c, 0.0, given->real[i]);
        }
    }
    c.work.sums += im->angles == 0 && !compensated && c.is_float ? 0 : im->reals;
    return c.work;
}

step_work step_work_of(const image *im, bool turned, bool keeps, bool tabled,
                       const operands *given) {
    const bool second = im->form == WH_SECOND_ORDER;
    const int components = second ? im->coordinates : im->angles + im->reals;
    counting c = {.by = wh_tableau_of(im->settings.method),
                  .second = second,
                  .compensated = im->settings.compensated,
                  .is_float = given->is_float,
                  .keeps = keeps,
                  .tabled = tabled,
                  .twice = turned && !keeps};
    add_reads(im->list[IMAGE_STEP], &c);
    for (int i = 0; i < components; i++) {
        c.rate = given->rate[i];
        c.accel = given->accel[i];
        stages(&c, i < im->angles, turned);
        end(&c, i < im->angles);
    }
    c.work.sums -= im->reals > 0;
    return c.work;
}
