/* lockstep.c: the exchange of frames between firmware and plant. */
#include "host/pil/lockstep.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "host/number/functions.h"
#include "host/os/system.h"

#define ASK_S 0.25 /* interval of requests for a hello */

static bool ends(lockstep_report *r, lockstep_end end) {
    r->end = end;
    return false;
}

static void keep_on_tape(talk *t, const uint8_t *bytes, unsigned count) {
    if (t->tape != NULL && fwrite(bytes, 1, count, t->tape) != count) {
        fprintf(stderr, "whirl pil: error: the tape cannot be written\n");
        t->report->end = LOCKSTEP_FAILED;
        t->tape = NULL;
    }
}

/* Coding the frame again gives the received bytes. */
static void keep_heard(talk *t, const wh_frame *frame) {
    uint8_t coded[WH_FRAME_BYTES(GUEST_LINE_BYTES)];
    keep_on_tape(t, coded, wh_frame_write(frame, coded, sizeof coded));
}

static void say_silent(const talk *t) {
    fprintf(stderr,
            "whirl pil: error: the firmware has sent no message for %g s\nhint: %s; --patience S "
            "waits longer\n",
            t->guest.request.patience_s,
            t->request->guest.by_line ? "reset the board, because the firmware does not repeat a "
                                        "damaged message"
                                      : "look for an endless loop in the firmware, or for a wait "
                                        "without end");
}

/* After an interrupt, the run counts as stopped, even if the firmware's end is noticed first. */
static lockstep_end when_ended(void) { return interrupted ? LOCKSTEP_STOPPED : LOCKSTEP_DONE; }

static bool hear_frame(talk *t, wh_frame *frame) {
    switch (guest_receive(&t->guest, frame)) {
    case GUEST_FRAME: break;
    case GUEST_ENDED: return ends(t->report, when_ended());
    case GUEST_SILENT: say_silent(t); return ends(t->report, LOCKSTEP_FAILED);
    case GUEST_STOPPED: return ends(t->report, LOCKSTEP_STOPPED);
    }
    if (frame->version != WH_FRAME_VERSION) {
        fprintf(stderr,
                "whirl pil: error: the firmware uses version %u of the protocol, but whirl uses "
                "version %u\nhint: build both from the same version of the sources\n",
                frame->version, WH_FRAME_VERSION);
        return ends(t->report, LOCKSTEP_BAD);
    }
    return true;
}

static bool fail(talk *t, const char *what) {
    fprintf(stderr, "whirl pil: error: the firmware sent %s in exchange %llu\n", what,
            (unsigned long long)t->report->exchanges);
    return ends(t->report, LOCKSTEP_FAILED);
}

static bool say(talk *t, const wh_frame *frame) {
    uint8_t coded[WH_FRAME_BYTES(WH_READINGS_BYTES)];
    const unsigned count = wh_frame_write(frame, coded, sizeof coded);
    keep_on_tape(t, coded, count);
    switch (guest_send(&t->guest, coded, count)) {
    case GUEST_FRAME: return true;
    case GUEST_STOPPED: return ends(t->report, LOCKSTEP_STOPPED);
    case GUEST_ENDED:
    case GUEST_SILENT: break;
    }
    t->report->end = when_ended(); /* the guest's exit status has the details */
    return false;
}

bool talk_tell(talk *t, uint32_t ticks, const wh_readings *readings) {
    uint8_t payload[WH_READINGS_BYTES];
    const wh_frame frame = {.kind = WH_FRAME_READINGS,
                            .sequence = t->sequence,
                            .ticks = ticks,
                            .payload = payload,
                            .length = wh_readings_put(readings, payload, sizeof payload)};
    return say(t, &frame);
}

/* WH_FRAME_ASK requests the hello, or acknowledges the end message. */
static guest_heard ask(talk *t) {
    uint8_t coded[WH_FRAME_BYTES(0)];
    const wh_frame frame = {.kind = WH_FRAME_ASK};
    return guest_send(&t->guest, coded, wh_frame_write(&frame, coded, sizeof coded));
}

static bool take_end(talk *t, const wh_frame *frame) {
    wh_bytes bytes = {.from = frame->payload, .room = frame->length};
    t->said_end = frame->length == 4U;
    t->end_status = (int)(int32_t)wh_bytes_get(&bytes, 4);
    if (!t->said_end) {
        return fail(t, "an invalid end message");
    }
    (void)ask(t);
    return ends(t->report, when_ended());
}

static bool hear_past_remembered(talk *t, wh_frame *frame) {
    while (hear_frame(t, frame)) {
        if (frame->kind == WH_FRAME_END) {
            return take_end(t, frame);
        }
        if (frame->kind == WH_FRAME_HELLO && t->request->guest.by_line && t->sequence == 0) {
            continue;
        }
        if (frame->kind != WH_FRAME_REMEMBER) {
            return true;
        }
        if (frame->length > WH_REMEMBER_MAX) {
            return fail(t, "too many bytes to keep over a reset");
        }
        keep_heard(t, frame);
        t->report->hash = talk_hash_bytes(t->report->hash, frame->payload, frame->length);
        t->remembered.count = frame->length;
        memcpy(t->remembered.remembered, frame->payload, frame->length);
    }
    return false;
}

bool talk_hear(talk *t, wh_orders *orders) {
    wh_frame frame;
    if (!hear_past_remembered(t, &frame)) {
        return false;
    }
    if (frame.kind != WH_FRAME_ORDERS || frame.sequence != t->sequence) {
        return fail(t, "a message that is not an answer");
    }
    if (!wh_orders_get(orders, frame.payload, frame.length) || orders->outputs != t->outputs) {
        return fail(t, "invalid orders");
    }
    keep_heard(t, &frame);
    t->sequence++;
    t->report->exchanges++;
    t->report->hash = talk_hash(t->report->hash, orders);
    for (unsigned i = 0; i < t->report->notes; i++) {
        t->report->note[i].value = (double)orders->output[t->outputs - t->report->notes + i];
    }
    return t->report->end != LOCKSTEP_FAILED;
}

uint64_t talk_hash(uint64_t hash, const wh_orders *orders) {
    hash = wh_hash_u64(hash, orders->until_ticks);
    hash = wh_hash_u64(hash, orders->watchdog_ticks);
    hash = wh_hash_u64(hash, orders->flags);
    for (unsigned i = 0; i < orders->outputs; i++) {
        uint32_t bits;
        memcpy(&bits, &orders->output[i], sizeof bits);
        hash = wh_hash_u64(hash, bits);
    }
    return hash;
}

uint64_t talk_hash_bytes(uint64_t hash, const uint8_t *bytes, unsigned count) {
    hash = wh_hash_u64(hash, count);
    for (unsigned i = 0; i < count; i++) {
        hash = wh_hash_u64(hash, bytes[i]);
    }
    return hash;
}

/* Reports that the firmware ended before its hello. If the image could not run, the child has reported that. */
static void say_no_hello(talk *t) {
    const guest_end_status end = guest_end(&t->guest);
    t->report->end = LOCKSTEP_BAD;
    if (end.status == GUEST_NOT_RUN) {
        fputs(t->guest.emulated ? "hint: make deps installs QEMU\n"
                                : "hint: check that the image is an executable program of this "
                                  "machine\n",
              stderr);
    } else {
        fprintf(
            stderr,
            "%s: error: this program ended without its first message (hello)\nhint: use an image "
            "made for `whirl pil`, such as build/pil_rig or build/BOARD/pil_rig.elf\n",
            t->guest.request.image);
    }
}

/* words[GUEST_LINE_BYTES] gets the texts of *hello. */
static bool take_hello_frame(talk *t, const wh_frame *frame, wh_hello *hello, wh_signal *signal,
                             uint8_t *words) {
    if (frame->kind != WH_FRAME_HELLO || frame->length > GUEST_LINE_BYTES) {
        return fail(t, "no hello");
    }
    memcpy(words, frame->payload, frame->length);
    if (!wh_hello_get(hello, signal, words, frame->length) || hello->ticks_per_s == 0) {
        return fail(t, "an invalid hello");
    }
    keep_heard(t, frame);
    return true;
}

static bool take_hello(talk *t, wh_hello *hello, wh_signal *signal, uint8_t *words) {
    wh_frame frame;
    if (!hear_frame(t, &frame)) {
        if (t->report->end == LOCKSTEP_DONE) { /* ended before its hello */
            say_no_hello(t);
        }
        return false;
    }
    return take_hello_frame(t, &frame, hello, signal, words);
}

/* For a serial line: repeats the request until the hello comes. Skips other frames, which an earlier run has left. */
static bool ask_for_hello(talk *t) {
    const double patience_s = t->guest.request.patience_s;
    wh_frame frame;
    guest_heard heard = GUEST_SILENT;
    t->guest.request.patience_s = ASK_S;
    for (unsigned asked = 0; asked * ASK_S < patience_s && heard == GUEST_SILENT; asked++) {
        heard = ask(t);
        while (heard == GUEST_FRAME) {
            heard = guest_receive(&t->guest, &frame);
            if (heard == GUEST_FRAME && frame.kind == WH_FRAME_HELLO) {
                t->guest.request.patience_s = patience_s;
                return take_hello_frame(t, &frame, &t->hello, t->signal, t->words);
            }
        }
    }
    t->report->end = heard == GUEST_STOPPED ? LOCKSTEP_STOPPED : LOCKSTEP_BAD;
    if (heard != GUEST_STOPPED) {
        fprintf(
            stderr,
            "whirl pil: error: the firmware's first message (hello) has not come over the line in "
            "%g s\nhint: reset the board, and check that it runs pil_line.elf and that --baud is "
            "its speed\n",
            patience_s);
    }
    return false;
}

bool talk_is_same_hello(const wh_hello *one, const wh_hello *other) {
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

bool talk_start(talk *t, const lockstep_request *request, lockstep_report *report, FILE *onto) {
    *t = (talk){.request = request, .report = report, .tape = onto};
    report->hash = WH_HASH_START;
    if (!guest_start(&t->guest, &request->guest)) {
        return ends(report, LOCKSTEP_BAD);
    }
    if (!(request->guest.by_line ? ask_for_hello(t)
                                 : take_hello(t, &t->hello, t->signal, t->words))) {
        return false;
    }
    report->notes = hello_channels(&t->hello, WH_SIGNAL_NOTE);
    t->outputs = hello_channels(&t->hello, WH_SIGNAL_OUTPUT) + report->notes;
    for (unsigned i = 0; i < report->notes; i++) {
        const wh_signal *s = hello_signal(&t->hello, WH_SIGNAL_NOTE, i);
        snprintf(report->note[i].name, sizeof report->note[i].name, "%s", s->name);
        snprintf(report->note[i].unit, sizeof report->note[i].unit, "%s", s->unit);
    }
    snprintf(report->program, sizeof report->program, "%s", t->hello.program);
    snprintf(report->board, sizeof report->board, "%s", t->hello.board);
    return true;
}

bool talk_restart(talk *t, uint32_t ticks, const wh_reset *reset) {
    uint8_t words[GUEST_LINE_BYTES];
    wh_signal signal[WH_SIGNALS_MAX];
    wh_hello hello;
    uint8_t payload[WH_RESET_BYTES];
    const wh_frame frame = {.kind = WH_FRAME_RESET,
                            .ticks = ticks,
                            .payload = payload,
                            .length = wh_reset_put(reset, payload, sizeof payload)};
    if (t->request->guest.by_line) {
        return fail(t, "a reset, which is not possible over a serial line");
    }
    (void)guest_end(&t->guest);
    if (!guest_start(&t->guest, &t->request->guest)) {
        return ends(t->report, LOCKSTEP_FAILED);
    }
    t->sequence = 0;
    if (!take_hello(t, &hello, signal, words)) {
        return false;
    }
    if (!talk_is_same_hello(&hello, &t->hello)) {
        return fail(
            t,
            "a hello after the reset that differs from its hello at the start in name, ticks or signals");
    }
    return say(t, &frame);
}

double talk_instructions_per_count(const wh_hello *hello) {
    return hello->timer_per_s == 0 ? 0.0
                                   : 1e9 / (double)hello->timer_per_s / (double)(1 << GUEST_SHIFT);
}

void talk_end(talk *t) {
    t->report->status = guest_end(&t->guest);
    if (t->report->end != LOCKSTEP_DONE) {
        return;
    }
    if (t->request->guest.by_line) {
        t->report->status.status = t->end_status;
        if (!t->said_end) {
            fprintf(stderr, "whirl pil: error: the serial line is disconnected\n");
            t->report->end = LOCKSTEP_FAILED;
        }
        return;
    }
    if (t->report->status.killed) {
        fprintf(stderr, "whirl pil: error: the firmware closed the connection but did not end, so "
                        "whirl killed it\n");
        t->report->end = LOCKSTEP_FAILED;
    } else if (t->report->status.signal_number != 0) {
        fprintf(stderr, "whirl pil: error: the firmware's process ended by signal %d (%s)\n",
                t->report->status.signal_number, t->report->status.signal_name);
        t->report->end = LOCKSTEP_FAILED;
    }
}

/* === turns ==================================================================================== */

/* Limit of exchanges at the same plant time. A firmware that catches up on missed periods needs several. */
#define STANDING_MOST 10000U
#define PIECE_S 0.1
#define WATCHED_PIECE_S 1e-3
#define PIECE_STEPS 1e4 /* limits the work in a piece, because steps may be arbitrarily short */

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
    double per_count; /* instructions per tick of the firmware's timer; 0: not counted */
    bool watched;
    unsigned standing; /* exchanges at the present plant time */
} loop;

static double plant_s(const loop *l) { return plant_now(&l->plant) / l->ticks_per_s; }

static bool start_taps(loop *l) {
    const lockstep_request *request = l->talk.request;
    for (int i = 0; i < request->tap_count; i++) {
        const tap *t = &request->taps[i];
        if (t->start != NULL && !t->start(t->of, &l->talk.hello, &l->plant)) {
            return false;
        }
        l->watched = l->watched || t->watch != NULL;
    }
    return true;
}

static void tell_taps_orders(const loop *l, wh_orders *orders, double *late_s) {
    const lockstep_request *request = l->talk.request;
    for (int i = 0; i < request->tap_count; i++) {
        if (request->taps[i].orders != NULL) {
            request->taps[i].orders(request->taps[i].of, plant_s(l), orders, late_s);
        }
    }
}

static void tell_taps_readings(const loop *l, wh_readings *readings) {
    const lockstep_request *request = l->talk.request;
    for (int i = 0; i < request->tap_count; i++) {
        if (request->taps[i].readings != NULL) {
            request->taps[i].readings(request->taps[i].of, plant_s(l), readings);
        }
    }
}

/* The next readings come at the requested time, or at the end of computing if that is later. */
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

/* Advances the plant in pieces. After each piece, the taps can watch, and an interrupt can stop the run. */
static bool advance(loop *l, double until_ticks) {
    const double end = number_least(until_ticks, l->talk.request->until_s * l->ticks_per_s);
    const double piece = number_least((l->watched ? WATCHED_PIECE_S : PIECE_S) * l->ticks_per_s,
                                      PIECE_STEPS * l->plant.step_ticks);
    const unsigned resets = l->plant.reset.count;
    while (!plant_has_reached(&l->plant, end) && l->plant.reset.count == resets && !interrupted) {
        if (!plant_advance(&l->plant, number_least(plant_now(&l->plant) + piece, end))) {
            fprintf(
                stderr,
                "whirl pil: error: the plant grew without bound at t = %.9g s (%s)\nhint: use a "
                "smaller --step, or check the firmware's outputs\n",
                plant_s(l), wh_status_text(l->plant.status));
            return ends(l->report, LOCKSTEP_FAILED);
        }
        for (int i = 0; i < l->talk.request->tap_count; i++) {
            const tap *t = &l->talk.request->taps[i];
            if (t->watch != NULL) {
                t->watch(t->of, plant_s(l), &l->plant);
            }
        }
    }
    return true;
}

static bool plant_goes_on(loop *l, const wh_orders *orders, double late_s) {
    lockstep_report *r = l->report;
    const double acted = (double)orders->acted_timer * l->per_count;
    const double busy = (double)orders->busy_timer * l->per_count;
    const double ticks = l->talk.request->instruction_s * l->ticks_per_s; /* per instruction */
    note_most(&r->acted, acted, plant_s(l));
    note_most(&r->busy, busy, plant_s(l));
    const double late = late_s * l->ticks_per_s;
    plant_order(&l->plant, orders, acted * ticks + late);
    if (!advance(l, next_ticks(l, orders, busy * ticks + late))) {
        return false;
    }
    if (l->plant.cut && !r->cut) {
        r->cut = true;
        r->cut_s = l->plant.cut_ticks / l->ticks_per_s;
    }
    return true;
}

/* NaN is a bug of the firmware; its effect on real hardware is unknown. */
static bool are_numbers(loop *l, const wh_orders *orders) {
    for (unsigned i = 0; i < l->binding.count; i++) {
        const bound *b = &l->binding.bound[i];
        if (b->signal.kind == WH_SIGNAL_OUTPUT && isnan(orders->output[b->channel])) {
            fprintf(
                stderr,
                "whirl pil: error: the firmware set '%s' to NaN at t = %.9g s\nhint: look for 0/0 or the root of a negative number\n",
                b->signal.name, plant_s(l));
            return ends(l->report, LOCKSTEP_FAILED);
        }
    }
    return true;
}

/* Without this check, a firmware that always asks for readings at once would run forever. */
static bool time_goes_on(loop *l, double before_ticks) {
    l->standing = plant_now(&l->plant) > before_ticks ? 0 : l->standing + 1;
    if (l->standing < STANDING_MOST) {
        return true;
    }
    fprintf(stderr,
            "whirl pil: error: time does not advance after t = %.9g s: the firmware asked %u "
            "times to be called again without delay\n"
            "hint: give hal_turns_wait() a later time, in ticks of the "
            "firmware's timer\n",
            plant_s(l), STANDING_MOST);
    return ends(l->report, LOCKSTEP_FAILED);
}

static bool is_over(loop *l) {
    const bool over = plant_s(l) >= l->talk.request->until_s;
    l->report->end = over ? LOCKSTEP_LET_GO : l->report->end;
    return over;
}

static bool restart(loop *l) {
    plant *p = &l->plant;
    wh_reset reset = l->talk.remembered;
    reset.cause = p->reset.starved ? WH_RESET_WATCHDOG : WH_RESET_OTHER;
    l->report->resets = p->reset.count;
    l->report->reset_s = p->reset.last_ticks / l->ticks_per_s;
    if (!advance(l, p->reset.last_ticks + p->reset.takes_ticks) || is_over(l) ||
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
    plant_start(&l->plant, im, &l->binding, hello, &l->talk.request->plant);
    const double begun_s = system_now_s();
    if (start_taps(l)) {
        take_turns(l);
    } else {
        l->report->end = LOCKSTEP_BAD;
    }
    l->report->wall_s = system_now_s() - begun_s;
    l->report->time_s = plant_s(l);
    l->report->edges = l->plant.edges_seen;
    l->report->samples = l->plant.samples_seen;
    l->report->lost = l->plant.lost;
    l->report->plant_hash = engine_double.hash(l->plant.run);
    plant_stop(&l->plant);
}

static bool has_places(const loop *l, unsigned places) {
    const unsigned edges = hello_channels(&l->talk.hello, WH_SIGNAL_EDGE);
    if (places > edges) {
        fprintf(stderr,
                "whirl pil: error: --place has %u values, but the firmware has %u edges\n"
                "hint: give one value for each edge, in the firmware's sequence\n",
                places, edges);
    }
    return places <= edges;
}

void lockstep_run(const lockstep_request *request, const image *im, lockstep_report *report) {
    loop l = {.report = report};
    *report = (lockstep_report){.end = LOCKSTEP_DONE};
    if (talk_start(&l.talk, request, report, request->tape)) {
        if (bind_signals(&l.binding, &l.talk.hello, im, request->renames) &&
            has_places(&l, request->plant.places)) {
            run_bound(&l, im);
        } else {
            report->end = LOCKSTEP_BAD;
        }
    }
    talk_end(&l.talk);
}

/* === the report of `whirl pil` ================================================================ */

static void print_computing(FILE *out, const lockstep_request *request, const lockstep_report *r) {
    if (!r->counted) {
        fputs("computing          not counted, because the firmware does not run in an emulator\n",
              out);
        return;
    }
    fprintf(out, "reading -> outputs %.0f instructions at most, %.4g ms, at t = %.6g s\n",
            r->acted.value, 1e3 * r->acted.value * request->instruction_s, r->acted.at_s);
    fprintf(out, "reading -> wait    %.0f instructions at most, %.4g ms, at t = %.6g s\n",
            r->busy.value, 1e3 * r->busy.value * request->instruction_s, r->busy.at_s);
    fprintf(out, "overruns           %" PRIu64, r->overruns);
    if (r->overruns > 0) {
        fprintf(out, ", the longest by %.4g ms after t = %.6g s", 1e3 * r->late_s.value,
                r->late_s.at_s);
    }
    fputc('\n', out);
}

static void print_plant(FILE *out, const image *im, const lockstep_report *r) {
    fprintf(out, "plant              %s, step %.9g us, double, %s", im->name, 1e6 * im->step_s,
            image_stepper(im));
    for (int i = 0; i < im->effects; i++) {
        if (im->effect[i].with) {
            fprintf(out, ", with %s", im->effect[i].name);
        }
    }
    fprintf(out, "\nreadings           %" PRIu64 " edges, %" PRIu64 " samples, %" PRIu64 " lost\n",
            r->edges, r->samples, r->lost);
    if (r->cut) {
        fprintf(out, "watchdog           cut the outputs at t = %.6g s\n", r->cut_s);
    }
}

static void print_notes(FILE *out, const lockstep_report *r) {
    for (unsigned i = 0; i < r->notes; i++) {
        const last_note *note = &r->note[i];
        const bool bare = strcmp(note->unit, "1") == 0;
        fprintf(out, "%s%s %.6g%s%s", i == 0 ? "notes              " : ", ", note->name,
                note->value, bare ? "" : " ", bare ? "" : note->unit);
    }
    fputs(r->notes > 0 ? "\n" : "", out);
}

/* For a replay: how the orders compare with the tape. */
static const char *as_on_tape(lockstep_end end) {
    return end == LOCKSTEP_DONE || end == LOCKSTEP_LET_GO ? ", as on the tape"
           : end == LOCKSTEP_DIFFERENT                    ? ", not as on the tape"
                                       : ", as on the tape so far; the remainder was not replayed";
}

void pil_print(FILE *out, const lockstep_request *request, const image *im,
               const lockstep_report *r) {
    fprintf(out, "\nfirmware           %s on board %s, %s\n", r->program, r->board,
            request->guest.image);
    if (im != NULL) {
        print_plant(out, im, r);
        print_computing(out, request, r);
    }
    if (r->resets > 0) {
        fprintf(out, "resets             %u, the last at t = %.6g s\n", r->resets, r->reset_s);
    }
    print_notes(out, r);
    fprintf(out, "exchanges          %" PRIu64 " in %.9g s of the plant's time", r->exchanges,
            r->time_s);
    if (im != NULL && r->wall_s > 0.0) {
        fprintf(out, "; %.0f per second, %.3g x real time", (double)r->exchanges / r->wall_s,
                r->time_s / r->wall_s);
    }
    fprintf(out, "\ncommand stream     0x%016" PRIx64 "%s\n", r->hash,
            im != NULL ? "" : as_on_tape(r->end));
    if (im != NULL) {
        fprintf(out, "plant's state      0x%016" PRIx64 "\n", r->plant_hash);
    }
}
