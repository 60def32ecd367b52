/* lockstep.c: the exchange of firmware and plant in turns. */
#include "lockstep.h"

#include <math.h>
#include <time.h>

#include "host/base/interrupts.h"
#include "talk.h"

/* A firmware may catch up on missed periods: so many exchanges at the same time. */
#define STANDING_MOST 10000U
#define PIECE_S 0.1
#define WATCHED_PIECE_S 1e-3
#define PIECE_STEPS 1e4 /* at most: steps may be arbitrarily short */

static double now_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void note_most(peak *m, double value, double at_s) {
    if (value > m->value) {
        *m = (peak){value, at_s};
    }
}

typedef struct loop {
    talk talk;
    plant plant;
    binding binding;
    lockstep_report *report;
    double ticks_per_s;
    double per_count; /* instructions */
    bool watched;
    unsigned standing; /* exchanges since the plant's time last advanced */
} loop;

static double plant_s(const loop *l) { return plant_now(&l->plant) / l->ticks_per_s; }

static bool start_taps(loop *l) {
    const lockstep_wish *wish = l->talk.wish;
    for (int i = 0; i < wish->tap_count; i++) {
        const tap *t = &wish->taps[i];
        if (t->start != NULL && !t->start(t->of, &l->talk.hello, &l->plant)) {
            return false;
        }
        l->watched = l->watched || t->watch != NULL;
    }
    return true;
}

static void tell_taps_orders(const loop *l, wh_orders *orders, double *late_s) {
    const lockstep_wish *wish = l->talk.wish;
    for (int i = 0; i < wish->tap_count; i++) {
        if (wish->taps[i].orders != NULL) {
            wish->taps[i].orders(wish->taps[i].of, plant_s(l), orders, late_s);
        }
    }
}

static void tell_taps_readings(const loop *l, wh_readings *readings) {
    const lockstep_wish *wish = l->talk.wish;
    for (int i = 0; i < wish->tap_count; i++) {
        if (wish->taps[i].readings != NULL) {
            wish->taps[i].readings(wish->taps[i].of, plant_s(l), readings);
        }
    }
}

static void let_taps_watch(const loop *l) {
    const lockstep_wish *wish = l->talk.wish;
    for (int i = 0; i < wish->tap_count; i++) {
        if (wish->taps[i].watch != NULL) {
            wish->taps[i].watch(wish->taps[i].of, plant_s(l), &l->plant);
        }
    }
}

/* The time of the next readings: the later of the requested time and the end of computing. */
static double next_ticks(loop *l, const wh_orders *orders, double busy_ticks) {
    const double now = plant_now(&l->plant);
    const int32_t ahead = (int32_t)(orders->until_ticks - plant_ticks(&l->plant));
    const double wanted = now + (ahead > 0 ? (double)ahead : 0.0);
    const double late = now + busy_ticks - wanted;
    if (late > 0.0) {
        l->report->overruns++;
        note_most(&l->report->late_s, late / l->ticks_per_s, now / l->ticks_per_s);
        return now + busy_ticks;
    }
    return wanted;
}

/* Advance in pieces, so that an interrupt is noticed on long ways; never past the end. */
static bool advance(loop *l, double until_ticks) {
    const lockstep_wish *wish = l->talk.wish;
    const double most = wish->until_s * l->ticks_per_s;
    const double end = until_ticks < most ? until_ticks : most;
    const double wished = (l->watched ? WATCHED_PIECE_S : PIECE_S) * l->ticks_per_s;
    const double most_at_once = PIECE_STEPS * l->plant.step_ticks;
    const double piece = wished < most_at_once ? wished : most_at_once;
    const unsigned resets = l->plant.reset.count;
    while (!plant_has_reached(&l->plant, end) && l->plant.reset.count == resets) {
        const double next = plant_now(&l->plant) + piece;
        if (!plant_advance(&l->plant, next < end ? next : end)) {
            return false;
        }
        let_taps_watch(l);
        if (interrupted) {
            break;
        }
    }
    return true;
}

static bool advance_or_tell(loop *l, double until_ticks) {
    if (!advance(l, until_ticks)) {
        fprintf(stderr,
                "whirl pil: error: the plant left all bounds at t = %.9g s (%s)\n"
                "hint: a smaller --step, or look at what the firmware told it to do\n",
                plant_s(l), wh_status_text(l->plant.status));
        l->report->end = LOCKSTEP_FAILED;
        return false;
    }
    return true;
}

static bool plant_goes_on(loop *l, const wh_orders *orders, double late_s) {
    lockstep_report *r = l->report;
    const double acted = (double)orders->acted_timer * l->per_count;
    const double busy = (double)orders->busy_timer * l->per_count;
    const double ticks = l->talk.wish->instruction_s * l->ticks_per_s; /* per instruction */
    note_most(&r->acted, acted, plant_s(l));
    note_most(&r->busy, busy, plant_s(l));
    const double late = late_s * l->ticks_per_s;
    plant_order(&l->plant, orders, acted * ticks + late);
    if (!advance_or_tell(l, next_ticks(l, orders, busy * ticks + late))) {
        return false;
    }
    if (l->plant.cut && !r->cut) {
        r->cut = true;
        r->cut_s = l->plant.cut_ticks / l->ticks_per_s;
    }
    return true;
}

/* An output that is NaN is a bug of the firmware, with unknown effect on real hardware. */
static bool are_numbers(loop *l, const wh_orders *orders) {
    for (unsigned i = 0; i < l->binding.count; i++) {
        const bound *b = &l->binding.bound[i];
        if (b->signal.kind == WH_SIGNAL_OUTPUT && isnan(orders->output[b->channel])) {
            fprintf(stderr,
                    "whirl pil: error: the firmware set '%s' to what is no number (NaN) at t = "
                    "%.9g s\nhint: a quotient of zeros, or the root of less than zero\n",
                    b->signal.name, plant_s(l));
            l->report->end = LOCKSTEP_FAILED;
            return false;
        }
    }
    return true;
}

/* If computing takes no time, only this check ends the loop. */
static bool time_goes_on(loop *l, double before_ticks) {
    l->standing = plant_now(&l->plant) > before_ticks ? 0 : l->standing + 1;
    if (l->standing < STANDING_MOST) {
        return true;
    }
    fprintf(stderr,
            "whirl pil: error: time stands still at t = %.9g s: the firmware has %u times asked to "
            "be told again at once\nhint: hal_turns_wait() takes a time that is still to come, in "
            "ticks of the firmware's timer\n",
            plant_s(l), STANDING_MOST);
    l->report->end = LOCKSTEP_FAILED;
    return false;
}

static bool is_over(loop *l) {
    const bool over = plant_s(l) >= l->talk.wish->until_s;
    l->report->end = over ? LOCKSTEP_LET_GO : l->report->end;
    return over;
}

/* The processor was reset: wait for the reset time, then restart it. */
static bool restart(loop *l) {
    plant *p = &l->plant;
    wh_reset reset = l->talk.remembered;
    reset.cause = p->reset.starved ? WH_RESET_WATCHDOG : WH_RESET_OTHER;
    l->report->resets = p->reset.count;
    l->report->reset_s = p->reset.last_ticks / l->ticks_per_s;
    if (!advance_or_tell(l, p->reset.last_ticks + p->reset.takes_ticks) || is_over(l) ||
        !talk_restart(&l->talk, plant_ticks(p), &reset)) {
        return false;
    }
    plant_restart(p);
    return true;
}

static void take_turns(loop *l) {
    wh_readings readings;
    wh_orders orders;
    for (;;) {
        plant_read(&l->plant, &readings);
        tell_taps_readings(l, &readings);
        if (!talk_tell(&l->talk, plant_ticks(&l->plant), &readings) ||
            !talk_hear(&l->talk, &orders)) {
            return;
        }
        const double before_ticks = plant_now(&l->plant);
        double late_s = 0.0;
        tell_taps_orders(l, &orders, &late_s);
        if (!are_numbers(l, &orders) || !plant_goes_on(l, &orders, late_s) || is_over(l) ||
            !time_goes_on(l, before_ticks) || (l->plant.reset.now && !restart(l))) {
            return;
        }
    }
}

static void run_bound(loop *l, const image *im) {
    const wh_hello *hello = &l->talk.hello;
    l->ticks_per_s = (double)hello->ticks_per_s;
    l->per_count = l->talk.guest.emulated ? talk_instructions_per_count(hello) : 0.0;
    l->report->counted = l->per_count > 0.0;
    plant_start(&l->plant, im, &l->binding, hello, &l->talk.wish->plant);
    const double begun_s = now_s();
    if (start_taps(l)) {
        take_turns(l);
    } else {
        l->report->end = LOCKSTEP_BAD;
    }
    l->report->wall_s = now_s() - begun_s;
    l->report->time_s = plant_s(l);
    l->report->edges = l->plant.edges_seen;
    l->report->samples = l->plant.samples_seen;
    l->report->lost = l->plant.lost;
    l->report->plant_hash = engine_double.hash(l->plant.run);
    plant_stop(&l->plant);
}

static bool has_places(const loop *l, unsigned places) {
    const bool has = places <= l->binding.edges;
    if (!has) {
        fprintf(stderr,
                "whirl pil: error: --place has %u places, and the firmware %u edges\n"
                "hint: one an edge, in the firmware's order\n",
                places, l->binding.edges);
    }
    return has;
}

/* Delayed readings are queued meanwhile. If they do not fit into a queue, the plant would lose them, and the firmware
 * would starve. */
static bool has_room(const loop *l, double delay_s) {
    double most = 0.0;
    for (unsigned i = 0; i < l->binding.count; i++) {
        const wh_signal *s = &l->binding.bound[i].signal;
        most += s->kind == WH_SIGNAL_SAMPLE
                    ? 1.0 + delay_s * (double)l->talk.hello.ticks_per_s / (double)s->period_ticks
                    : 0.0;
    }
    const bool has = most <= (double)PLANT_PENDING;
    if (!has) {
        fprintf(
            stderr,
            "whirl pil: error: --delay %g s: %.0f samples of this firmware would be on their way, and "
            "there is room for %d\n"
            "hint: a shorter delay, or --fault cell-late of one channel\n",
            delay_s, most, PLANT_PENDING);
    }
    return has;
}

void lockstep_run(const lockstep_wish *wish, const image *im, lockstep_report *report) {
    loop l = {.report = report};
    *report = (lockstep_report){.end = LOCKSTEP_DONE};
    if (talk_start(&l.talk, wish, report, wish->tape)) {
        if (bind_signals(&l.binding, &l.talk.hello, im, wish->renames) &&
            has_places(&l, wish->plant.places) && has_room(&l, wish->plant.delay_s)) {
            run_bound(&l, im);
        } else {
            report->end = LOCKSTEP_BAD;
        }
    }
    talk_end(&l.talk);
}
