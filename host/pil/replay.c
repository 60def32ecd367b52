/* replay.c: a tape in the plant's place. */
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "host/base/room.h"
#include "lockstep.h"
#include "talk.h"
#include "taped.h"

/* All that matters to the exchange; not who speaks, nor how it counts. */
static bool is_same_hello(const wh_hello *one, const wh_hello *other) {
    bool same = one->ticks_per_s == other->ticks_per_s && one->start_ticks == other->start_ticks &&
                one->signals == other->signals && strcmp(one->program, other->program) == 0;
    for (unsigned i = 0; same && i < one->signals; i++) {
        const wh_signal *a = &one->signal[i];
        const wh_signal *b = &other->signal[i];
        same = a->kind == b->kind && strcmp(a->name, b->name) == 0 &&
               strcmp(a->unit, b->unit) == 0 && memcmp(&a->low, &b->low, sizeof a->low) == 0 &&
               memcmp(&a->high, &b->high, sizeof a->high) == 0 &&
               memcmp(&a->per_count, &b->per_count, sizeof a->per_count) == 0 &&
               a->period_ticks == b->period_ticks;
    }
    return same;
}

static void say_difference(const wh_orders *kept, const wh_orders *now, uint32_t since_ticks,
                           const talk *t) {
    fprintf(stderr, "whirl pil: error: exchange %llu, t = %.6f s: other orders than on the tape\n",
            (unsigned long long)t->report->exchanges,
            (double)since_ticks / (double)t->hello.ticks_per_s);
    for (unsigned i = 0; i < now->outputs && i < kept->outputs; i++) {
        if (memcmp(&now->output[i], &kept->output[i], sizeof now->output[i]) != 0) {
            fprintf(stderr, "hint: output %u is %.9g, on the tape %.9g\n", i + 1,
                    (double)now->output[i], (double)kept->output[i]);
        }
    }
}

/* One turn. False at the tape's end and when something is wrong, which report->end then says. */
static bool play(taped *from, talk *t) {
    lockstep_report *r = t->report;
    taped_turn kept;
    wh_orders now;
    if (!taped_next(from, &kept)) {
        r->end = from->failed ? LOCKSTEP_BAD : LOCKSTEP_LET_GO;
        return false;
    }
    const uint32_t since = kept.ticks - t->hello.start_ticks;
    r->time_s = (double)since / (double)t->hello.ticks_per_s;
    if (!talk_tell(t, kept.ticks, &kept.readings) || !talk_hear(t, &now)) {
        if (r->end == LOCKSTEP_DONE && kept.answered) {
            fprintf(stderr,
                    "whirl pil: error: exchange %llu, t = %.6f s: the firmware ended, and the tape "
                    "goes on\n",
                    (unsigned long long)r->exchanges, r->time_s);
            r->end = LOCKSTEP_DIFFERENT;
        }
        return false;
    }
    if (!kept.answered) { /* the taped firmware had ended here, or was let go */
        r->end = LOCKSTEP_LET_GO;
        return false;
    }
    r->tape_hash = talk_hash(r->tape_hash, &kept.orders);
    if (r->tape_hash != r->hash) {
        say_difference(&kept.orders, &now, since, t);
        r->end = LOCKSTEP_DIFFERENT;
        return false;
    }
    return true;
}

void lockstep_replay(const lockstep_wish *wish, const char *file, lockstep_report *report) {
    taped *from = room(1, sizeof *from);
    talk *t = room(1, sizeof *t);
    *report = (lockstep_report){.end = LOCKSTEP_DONE, .tape_hash = WH_HASH_START};
    t->guest.up = -1;
    t->guest.down = -1;
    t->report = report;
    if (!taped_open(from, file)) {
        report->end = LOCKSTEP_BAD;
    } else if (talk_start(t, wish, report, NULL)) {
        if (!is_same_hello(&from->hello, &t->hello)) {
            fprintf(stderr,
                    "%s: error: it is of '%s', whose signals are not those of the firmware '%s'\n",
                    file, from->hello.program, t->hello.program);
            report->end = LOCKSTEP_BAD;
        } else {
            while (play(from, t)) {
            }
        }
    }
    talk_end(t);
    taped_close(from);
    free(from);
    free(t);
}
