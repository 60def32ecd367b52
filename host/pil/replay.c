/* replay.c: a tape in the plant's place. */
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "host/base/room.h"
#include "lockstep.h"
#include "talk.h"
#include "taped.h"

static void say_difference(const wh_orders *kept, const wh_orders *now, const talk *t) {
    fprintf(stderr, "whirl pil: error: exchange %llu, t = %.6f s: other orders than on the tape\n",
            (unsigned long long)t->report->exchanges, t->report->time_s);
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
    r->time_s = kept.time_s;
    if (kept.is_reset) {
        return talk_restart(t, kept.ticks, &kept.reset);
    }
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
    r->tape_hash = from->hash;
    if (r->tape_hash != r->hash) {
        say_difference(&kept.orders, &now, t);
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
        if (!talk_is_same_hello(&from->hello, &t->hello)) {
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
