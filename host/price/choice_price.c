/* choice_price.c: see choice_price.h. */
#include "choice_price.h"

#include "host/number/functions.h"

/* Behind so many that were counted, others are taken to cost the most that is promised: an answer comes to an end. */
enum { PLENTY = 40, PLENTY_OF_RUNS = 4 };
/* Before that, a run's longest step may take this part of what is expected by another's. */
#define RUN_MAY_TAKE 0.85
#define RUN_BYTES_MAY_BE 0.95 /* the same of its bytes */
/* No step in double was seen to take less than so many in float, both in software, or with an FPU for the float. */
#define DOUBLE_OF_FLOAT 1.3
#define DOUBLE_OF_FPU 4.0
/* Of another board's instructions, in place of one's own. */
#define ELSEWHERE 0.5
/* Bytes of what has no figures, of those of what stands for it: no more is sure. */
#define STAND_IN_BYTES 0.8
/* Instructions of a run that an emulator is given: some ten seconds of it. */
#define RUN_INSTRUCTIONS 1e9

static bool is_known(const cost_figure *f) { return f->basis != COST_NOT_KNOWN; }

static void no_more(cost_figure *f, double most) { f->most = f->most > most ? most : f->most; }

static cost hopeful(const cost_board *board, cost c) {
    const double each = board->cycles == COST_RANGE ? board->cycles_most : 0.0;
    no_more(&c.instructions, c.instructions.value);
    no_more(&c.instructions_worst, c.instructions_worst.value);
    no_more(&c.cycles, each > 0.0 ? each * c.instructions.value : c.cycles.value);
    no_more(&c.cycles_worst, each > 0.0 ? each * c.instructions_worst.value : c.cycles_worst.value);
    no_more(&c.flash_bytes, c.flash_bytes.least);
    no_more(&c.ram_bytes, c.ram_bytes.least);
    no_more(&c.stack_bytes, c.stack_bytes.least);
    return c;
}

static void scale(cost_figure *f, double by) {
    f->value *= by;
    f->least *= by;
    f->most *= by;
}

static void scale_steps(cost *c, double by) {
    scale(&c->instructions, by);
    scale(&c->instructions_worst, by);
    scale(&c->cycles, by);
    scale(&c->cycles_worst, by);
}

static void scale_bytes(cost *c, double by) {
    scale(&c->flash_bytes, by);
    scale(&c->ram_bytes, by);
    scale(&c->stack_bytes, by);
}

/* By the figures of a board whose arithmetic is alike, where it does what none fitted here did: cores differ, so half of it. */
static cost elsewhere(trials *t, const setting *s, deviation_pace pace, bool *own) {
    const cost_board *here = t->wish.board;
    t->wish.board = cost_board_named(here->fpu ? "mps2-an386" : "mps2-an385");
    cost c = trial_cost(t, s, pace, own);
    t->wish.board = here;
    scale_steps(&c, ELSEWHERE);
    const bool range = here->cycles == COST_RANGE;
    c.cycles = c.instructions;
    c.cycles_worst = c.instructions_worst;
    scale(&c.cycles, range ? here->cycles_most : 1.0);
    scale(&c.cycles_worst, range ? here->cycles_most : 1.0);
    c.flash_bytes = c.ram_bytes = c.stack_bytes = (cost_figure){0};
    return c;
}

/* Of what has no figures: no less than in float; by the classic method where its own was not fitted, by how many stages
 * it has; or by another board's. */
static cost stand_in(trials *t, const setting *s, deviation_pace pace, const cost *unknown) {
    setting as = *s;
    bool own;
    as.number = &engine_float;
    cost c = trial_cost(t, &as, pace, &own);
    if (own && !is_known(&c.instructions_worst)) {
        const setting before = as;
        as.image.method = WH_RK4;
        c = trial_cost(t, &as, pace, &own);
        scale_steps(&c,
                    (double)wh_methods[s->image.method].stages / (double)wh_methods[WH_RK4].stages);
        if (!(own && is_known(&c.instructions_worst))) {
            c = elsewhere(t, &before, pace, &own);
        }
    }
    if (s->number == &engine_double) {
        scale_steps(&c, cost_is_soft(t->wish.board, COST_DOUBLE)
                            ? (t->wish.board->fpu ? DOUBLE_OF_FPU : DOUBLE_OF_FLOAT)
                            : 1.0);
    }
    c.state_bytes = unknown->state_bytes;
    scale_bytes(&c, STAND_IN_BYTES);
    return own && is_known(&c.instructions_worst) ? c : *unknown;
}

static void more_bytes(cost_figure *f, double more, double part) {
    f->value += more;
    f->most = is_known(f) ? part * f->value : 0.0;
}

/* What was learned of a number; before that, of float. */
static measured_lesson lesson_of(measured_prices *m, const setting *s) {
    const setting in_float = {.number = &engine_float};
    const measured_lesson *own = measured_lesson_of(m, s);
    measured_lesson of = own->share > 0.0 ? *own : *measured_lesson_of(m, &in_float);
    of.share = own->share > 0.0 ? own->share : 1.0;
    return of;
}

/* Bytes as the last run's had more of them than a step without events. */
static void add_events(measured_lesson of, int counted, cost *c) {
    const double part = counted < PLENTY_OF_RUNS ? RUN_BYTES_MAY_BE : 1.0;
    more_bytes(&c->flash_bytes, of.flash_bytes, part);
    more_bytes(&c->ram_bytes, of.ram_bytes, part);
    more_bytes(&c->stack_bytes, of.stack_bytes, part);
}

cost choice_price(trials *t, const choice_wish *w, const setting *s, deviation_pace pace, bool any,
                  bool *own) {
    cost c = any ? trial_any_cost(t, s, pace, own) : trial_cost(t, s, pace, own);
    if (w->counted == NULL || !*own) {
        return c;
    }
    const bool varies = w->counted->by_run || setting_price_varies(s);
    if (!(any && varies) && measured_has(w->counted, s, pace)) {
        measured_tell(w->counted, s, pace, &c);
        return c;
    }
    if (!is_known(&c.instructions_worst) && !setting_is_fixed(s) &&
        measured_takes(t->wish.board, s)) {
        c = stand_in(t, s, pace, &c);
    }
    if (w->counted->count < PLENTY) {
        c = hopeful(t->wish.board, c);
    }
    if (w->counted->by_run) {
        add_events(lesson_of(w->counted, s), w->counted->count, &c);
    }
    return c;
}

bool choice_prices_runs(const choice_wish *w) { return w->counted != NULL && w->counted->by_run; }

static double may_take(int counted) { return counted < PLENTY_OF_RUNS ? RUN_MAY_TAKE : 1.0; }

cost choice_price_of_run(const trials *t, const choice_wish *w, const setting *s,
                         deviation_pace pace, const cost *step, const trial_result *r) {
    cost c = *step;
    if (measured_has(w->counted, s, pace)) {
        measured_tell(w->counted, s, pace, &c);
        return c;
    }
    const double stages = wh_methods[s->image.method].stages;
    const double each_s = ratio_times(1, trial_step(t, pace));
    const double share = lesson_of(w->counted, s).share;
    const double mean = number_most(1.0, r->evaluations * each_s / stages);
    const double worst =
        number_most(1.0, may_take(w->counted->count) * share * r->evaluations_most / stages);
    scale(&c.instructions, mean);
    scale(&c.cycles, mean);
    scale(&c.instructions_worst, worst);
    scale(&c.cycles_worst, worst);
    return c;
}

bool choice_run_is_long(const trials *t, deviation_pace pace, const cost *run) {
    const double steps = trial_horizon_s(t) / ratio_times(1, trial_step(t, pace));
    return run->instructions.value * steps * t->wish.source->points > RUN_INSTRUCTIONS;
}

void choice_learn_run(measured_prices *m, const choice_row *row) {
    cost counted = row->cost;
    measured_lesson lesson = lesson_of(m, &row->setting);
    measured_tell(m, &row->setting, row->pace, &counted);
    const double expected = row->cost.instructions_worst.value / may_take(m->count - 1);
    if (!m->by_run || counted.instructions_worst.basis != COST_MEASURED || !(expected > 0.0)) {
        return;
    }
    lesson.share *= counted.instructions_worst.value / expected;
    lesson.flash_bytes += counted.flash_bytes.value - row->cost.flash_bytes.value;
    lesson.ram_bytes += counted.ram_bytes.value - row->cost.ram_bytes.value;
    lesson.stack_bytes += counted.stack_bytes.value - row->cost.stack_bytes.value;
    *measured_lesson_of(m, &row->setting) = lesson;
}
