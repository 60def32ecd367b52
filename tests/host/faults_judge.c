/* faults_judge.c: verdict on a run from the true state of the plant, not from the firmware's messages. */
#include "faults.h"
#include "host/pil/lockstep.h"
#include "test.h"

#define TURN_RAD 6.283185307179586477
#define RPM_PER_RADPS 9.5492965855137202
#define SHARE 0.01 /* allowed error of a good result beyond its interval */
#define LASTING_S 1.0
#define HALT_S 2e-3  /* a control period: the motor may drive for this long */
#define WATCH_S 1e-3 /* time between two calls of watch() */
#define WATCHED_S 12.0
/* after turns that show a drive, the enable must be off or a trip reported within this time */
#define SHOWN_S 1.0
#define HAND_RPM 61.0             /* a rotor that a hand turns is at most as fast */
#define RISE 1.05                 /* rise of the speed over three turns together */
#define SHIFTS 3                  /* a result may refer to turns that ended this many turns ago */
enum { GOOD, DOUBTFUL, REFUSED }; /* wh_quality */

/* --- outputs and notes ------------------------------------------------------------------------------------------ */

static bool find_outputs(judge *j, const wh_hello *hello) {
    static const char *const notes[] = {
#define WORD(name, word, unit) word,
        HAL_NOTE_ROWS(WORD)
#undef WORD
    };
    int outputs = 0;
    int note = 0;
    j->at_duty = -1;
    j->at_enable = -1;
    memset(j->at_note, -1, sizeof j->at_note);
    for (unsigned i = 0; i < hello->signals; i++) {
        const wh_signal *s = &hello->signal[i];
        if (s->kind == WH_SIGNAL_OUTPUT) {
            j->at_duty = strcmp(s->name, "duty") == 0 ? outputs : j->at_duty;
            j->at_enable = strcmp(s->name, "enable") == 0 ? outputs : j->at_enable;
            outputs++;
        }
    }
    for (unsigned i = 0; i < hello->signals; i++) {
        const wh_signal *s = &hello->signal[i];
        for (int n = 0; s->kind == WH_SIGNAL_NOTE && n < HAL_NOTES; n++) {
            j->at_note[n] = strcmp(s->name, notes[n]) == 0 ? outputs + note : j->at_note[n];
        }
        note += s->kind == WH_SIGNAL_NOTE;
    }
    bool all = j->at_duty >= 0 && j->at_enable >= 0;
    for (int n = 0; n < HAL_NOTES; n++) {
        all = all && j->at_note[n] >= 0;
    }
    return all;
}

static bool start(void *of, const wh_hello *hello, plant *p) {
    judge *j = of;
    j->plant = p;
    j->per_count = talk_instructions_per_count(hello);
    j->ticks_per_s = (double)hello->ticks_per_s;
    const bool good = find_outputs(j, hello) && bind_read(&j->angle, p->image, "theta") != NULL &&
                      bind_read(&j->rate, p->image, "theta'") != NULL &&
                      bind_read(&j->force, p->image, "pin_force") != NULL;
    if (!good) {
        fprintf(stderr,
                "faults: error: no rig on its bench: theta, pin_force, duty, enable, notes\n");
    }
    return good;
}

/* --- the true force and speed
 * ----------------------------------------------------------------------------------------------------- */

/* Trapezoids over the angle: a millisecond is two degrees at 330 rpm. */
static void add_up(judge *j, double from, double force_from, double to, double force_to) {
    const double half = (to - from) / 2.0;
    j->sum.cosine_N += half * (force_from * cos(from) + force_to * cos(to));
    j->sum.sine_N += half * (force_from * sin(from) + force_to * sin(to));
}

/* Does a whole turn show a drive while the motor must not drive? */
static void see_undriven(judge *j, double at_s, double rpm) {
    const bool faster = rpm > j->rpm;
    j->on_turns++;
    if (j->on_turns > 1 && faster && j->on_shown_s < 0.0) {
        j->on_shown_s = at_s;
    }
    j->rises = faster ? j->rises + 1U : 0U;
    j->rises_rpm = j->rises == 1U ? j->rpm : j->rises_rpm;
    if (j->rises > 2U && j->rpm > HAND_RPM && rpm > RISE * j->rises_rpm && j->off_shown_s < 0.0) {
        j->off_shown_s = at_s;
    }
    j->rpm = rpm;
}

static void end_turn(judge *j, double at_s) {
    verdict *v = &j->verdict;
    if (j->whole && j->off) {
        see_undriven(j, at_s, TURN_RAD / (at_s - j->begun_s) * RPM_PER_RADPS);
    }
    j->off = !rig_may_drive(j->told);
    if (j->whole) {
        true_turn *t = &j->turn[j->turns++ % JUDGE_TURNS];
        *t = (true_turn){j->sum.cosine_N * 2.0 / TURN_RAD, j->sum.sine_N * 2.0 / TURN_RAD};
        const double rpm = TURN_RAD / (at_s - j->begun_s) * RPM_PER_RADPS;
        v->turn_rpm = rpm > v->turn_rpm ? rpm : v->turn_rpm;
    }
    j->sum = (true_turn){0.0, 0.0};
    j->begun_s = at_s;
    j->whole = true;
}

/* Time since the drive ended. */
static double off_since_ticks(const judge *j, const plant *p) {
    const int at[] = {j->at_duty, j->at_enable};
    double since = (double)INFINITY;
    for (int i = 0; i < 2; i++) {
        if (!(p->in_effect[at[i]] > 0.0) && p->since_ticks[at[i]] < since) {
            since = p->since_ticks[at[i]];
        }
    }
    return since;
}

/* From the halt on nothing may drive the motor: a stopped or reset controller must not start by itself. */
static void watch_halt(judge *j, double time_s, const plant *p) {
    const fault_case *f = &j->plan->fault[j->plan->count - 1U];
    verdict *v = &j->verdict;
    const bool reset = p->reset.count > 0;
    if (!v->halted && (reset || (f->kind == FAULT_STOP && f->happened))) {
        v->halted = true;
        j->halted_s = reset ? p->reset.last_ticks / j->ticks_per_s : f->begin_s;
    }
    if (!v->halted || v->halted_s < 0.0) {
        return;
    }
    const double off_s = off_since_ticks(j, p) / j->ticks_per_s;
    if (!isfinite(off_s)) {
        v->halted_s = time_s > j->halted_s + HALT_S + WATCH_S / 2.0 ? -1.0 : 0.0;
    } else if (off_s > j->halted_s) {
        v->halted_s = off_s - j->halted_s;
    }
}

/* For times when the motor must not drive: reports an enable that stays on although turns show a drive, or a missing trip. */
static void watch_off(judge *j, double time_s, const plant *p) {
    const bool on = p->in_effect[j->at_enable] > 0.0;
    if (rig_may_drive(j->told)) {
        j->off = false;
        j->rpm = (double)INFINITY;
        j->on_shown_s = -1.0;
        j->off_shown_s = -1.0;
    }
    if (!j->off || !on) {
        j->on_turns = 0;
        j->on_shown_s = -1.0;
    }
    if (!j->off || rig_is_tripped(j->told)) {
        j->rises = 0;
        j->off_shown_s = -1.0;
    }
    j->verdict.stays_on =
        j->verdict.stays_on || (j->on_shown_s >= 0.0 && time_s > j->on_shown_s + SHOWN_S);
    j->verdict.untold =
        j->verdict.untold || (campaign_is_alone(j->of) && !j->of->blind && j->off_shown_s >= 0.0 &&
                              time_s > j->off_shown_s + SHOWN_S);
}

static void watch(void *of, double time_s, const plant *p) {
    judge *j = of;
    double output[64];
    watch_halt(j, time_s, p);
    engine_double.outputs(p->run, output);
    const double theta = p->after[j->angle.index];
    const double force = output[j->force.index];
    const double rpm = fabs(p->after[j->rate.index]) * RPM_PER_RADPS;
    const double turn = floor(theta / TURN_RAD);
    const double turn_before = floor(j->theta / TURN_RAD);
    j->speed_rpm = rpm;
    j->verdict.peak_rpm = rpm > j->verdict.peak_rpm ? rpm : j->verdict.peak_rpm;
    if (turn == turn_before) {
        add_up(j, j->theta, j->force_N, theta, force);
    } else {
        const double edge = TURN_RAD * (turn > turn_before ? turn : turn_before);
        const double part = (edge - j->theta) / (theta - j->theta);
        const double there = j->force_N + part * (force - j->force_N);
        add_up(j, j->theta, j->force_N, edge, there);
        j->whole = j->whole && turn > turn_before;
        end_turn(j, j->last_s + part * (time_s - j->last_s));
        j->whole = turn > turn_before;
        add_up(j, edge, there, theta, force);
    }
    j->theta = theta;
    j->force_N = force;
    j->last_s = time_s;
    watch_off(j, time_s, p);
}

/* Relative error of a result beyond its interval and 1 %. The result may refer to several series of turns: the smallest
 * error counts. */
static double off_by(const judge *j, unsigned turns) {
    const double amplitude = (double)j->told[HAL_NOTE_AMPLITUDE];
    const double phase = (double)j->told[HAL_NOTE_PHASE];
    double least = (double)INFINITY;
    for (unsigned shift = 0; shift < SHIFTS; shift++) {
        true_turn mean = {0.0, 0.0};
        if (turns + shift > j->turns || turns + shift > JUDGE_TURNS) {
            break;
        }
        for (unsigned i = 0; i < turns; i++) {
            const true_turn *t = &j->turn[(j->turns - 1U - shift - i) % JUDGE_TURNS];
            mean.cosine_N += t->cosine_N / turns;
            mean.sine_N += t->sine_N / turns;
        }
        const double truth = hypot(mean.cosine_N, mean.sine_N);
        const double angle = remainder(phase - atan2(-mean.sine_N, mean.cosine_N), TURN_RAD);
        const double amplitude_off =
            (fabs(amplitude - truth) - (double)j->told[HAL_NOTE_AMPLITUDE_HALF]) / truth - SHARE;
        const double phase_off = fabs(angle) - (double)j->told[HAL_NOTE_PHASE_HALF] - SHARE;
        const double most = amplitude_off > phase_off ? amplitude_off : phase_off;
        least = most < least ? most : least;
    }
    return isfinite(least) ? least : 1.0; /* the result has more turns than were recorded */
}

/* --- the controller's messages -------------------------------------------------------------------------------- */

static void look_for_fault(judge *j) {
    const fault_case *f = &j->plan->fault[j->plan->count - 1U];
    if (j->of->breaks && f->happened && !j->began) {
        const bool always = j->of->from_start || fault_rows[f->kind].place == FAULT_PARAMETER;
        j->began = true;
        j->verdict.happened = true;
        j->verdict.stage = always ? -1 : rig_stage_of(j->told);
    }
}

/* The first message after a reset, while the earlier ones are still known. */
static void look_for_reset(judge *j, const wh_orders *orders) {
    float now[HAL_NOTES];
    if (j->plant->reset.count == j->resets) {
        return;
    }
    j->resets = j->plant->reset.count;
    for (int n = 0; n < HAL_NOTES; n++) {
        now[n] = orders->output[j->at_note[n]];
    }
    const bool tripped = rig_is_tripped(j->told);
    const bool knows = tripped ? rig_is_tripped(now) && now[HAL_NOTE_TRIP] == j->told[HAL_NOTE_TRIP]
                               : rig_is_idle(now);
    j->verdict.latched = j->verdict.latched || (tripped && knows);
    j->verdict.forgets = j->verdict.forgets || !knows || now[HAL_NOTE_RESET] == 0.0F;
}

static bool is_of_result(int note) {
    return note == HAL_NOTE_QUALITY || note == HAL_NOTE_AMPLITUDE || note == HAL_NOTE_PHASE ||
           note == HAL_NOTE_AMPLITUDE_HALF || note == HAL_NOTE_PHASE_HALF || note == HAL_NOTE_TURNS;
}

static void take_notes(judge *j, const wh_orders *orders) {
    bool changed = false;
    for (int n = 0; n < HAL_NOTES; n++) {
        const float value = orders->output[j->at_note[n]];
        changed = changed || (is_of_result(n) && value != j->told[n]);
        j->told[n] = value;
    }
    const unsigned turns = (unsigned)j->told[HAL_NOTE_TURNS];
    if (j->told[HAL_NOTE_TRIP] != 0.0F) {
        j->verdict.trip = (int)j->told[HAL_NOTE_TRIP];
    }
    j->has_result = turns > 0;
    if (changed && turns > 0 && (int)j->told[HAL_NOTE_QUALITY] == GOOD && !j->of->calibration) {
        const double off = off_by(j, turns);
        j->verdict.lie = off > j->verdict.lie ? off : j->verdict.lie;
    }
}

/* Counts the longest step between two answers, if the last answer was late. */
static void count_step(judge *j, double time_s, const wh_orders *orders) {
    const double instructions = (double)orders->step_timer * j->per_count;
    const double loop = (double)orders->busy_timer * j->per_count;
    verdict *v = &j->verdict;
    if (instructions > 0.0) {
        const unsigned bin = (unsigned)(instructions / STEP_BIN);
        v->steps[bin < STEP_BINS ? bin : STEP_BINS - 1]++;
        v->most_s = instructions > v->most ? time_s : v->most_s;
        v->most = instructions > v->most ? instructions : v->most;
        v->loop = loop > v->loop ? loop : v->loop;
    } else {
        v->start = loop > v->start ? loop : v->start;
    }
}

/* Ends the run some time after a trip, because the controller may watch the rotor for long. */
static void let_go(judge *j, double time_s) {
    if (!rig_is_tripped(j->told) || j->driven) {
        j->off_since_s = -1.0;
    } else if (j->off_since_s < 0.0) {
        j->off_since_s = time_s;
    } else if (time_s > j->off_since_s + WATCHED_S && *j->until_s > time_s) {
        *j->until_s = time_s;
    }
}

static void hear(void *of, double time_s, wh_orders *orders, double *late_s) {
    (void)late_s;
    judge *j = of;
    look_for_fault(j);
    look_for_reset(j, orders);
    take_notes(j, orders);
    count_step(j, time_s, orders);
    const bool enabled = orders->output[j->at_enable] > 0.0F && !j->plant->cut;
    j->enabled_s = enabled && !j->enabled ? time_s : j->enabled_s;
    j->enabled = enabled;
    const fault_case *f = &j->plan->fault[j->plan->count - 1U];
    const bool ignores = j->of->runs_away && f->active;
    j->driven = enabled && (orders->output[j->at_duty] > 0.0F || ignores);
    let_go(j, time_s);
    if (ignores && enabled && j->ignored_s < 0.0) {
        j->ignored_s = f->begin_s > j->enabled_s ? f->begin_s : j->enabled_s;
        /* with another fault, the time of detection is not defined */
        j->verdict.lasting =
            campaign_is_alone(j->of) && f->begin_s + f->duration_s - j->ignored_s >= LASTING_S;
        j->verdict.began_rpm = j->speed_rpm;
    }
    if (j->verdict.lasting && !enabled && j->verdict.off_s < 0.0) {
        j->verdict.off_s = time_s - j->ignored_s;
        j->verdict.caught_rpm = j->verdict.peak_rpm;
    }
}

tap judge_tap(judge *j, const campaign_case *of, const fault_plan *plan, double *until_s) {
    *j = (judge){
        .of = of,
        .plan = plan,
        .until_s = until_s,
        .off_since_s = -1.0,
        .ignored_s = -1.0,
        .rpm = (double)INFINITY,
        .on_shown_s = -1.0,
        .off_shown_s = -1.0,
        .verdict = {.row = of->row, .target_rpm = of->target_rpm, .stage = -1, .off_s = -1.0}};
    return (tap){.name = "judge", .of = j, .start = start, .orders = hear, .watch = watch};
}

void judge_end(judge *j, const lockstep_report *report) {
    verdict *v = &j->verdict;
    const int quality = (int)j->told[HAL_NOTE_QUALITY];
    v->time_s = report->time_s;
    v->overruns = report->overruns;
    const bool off = report->end == LOCKSTEP_LET_GO && !j->driven;
    if (report->end != LOCKSTEP_DONE && !off) {
        v->outcome = OUTCOME_HANG;
    } else if (rig_is_tripped(j->told)) {
        v->outcome = OUTCOME_TRIPPED;
    } else if (j->has_result) {
        v->outcome = quality == GOOD       ? OUTCOME_GOOD
                     : quality == DOUBTFUL ? OUTCOME_DOUBTFUL
                                           : OUTCOME_REFUSED;
    } else {
        v->outcome = OUTCOME_NONE;
    }
    v->runs_on =
        (j->enabled && !rig_may_drive(j->told)) || (j->driven && j->speed_rpm > rig_limit_rpm());
    v->overspeed = !j->of->drives && v->turn_rpm > rig_limit_rpm();
    v->cut = report->cut && !j->of->delays;
}
