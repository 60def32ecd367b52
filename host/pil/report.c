/* report.c: the report of a run in the loop. */
#include "host/pil/report.h"

#include <inttypes.h>
#include <string.h>

/* === the report of `whirl pil` ================================================================ */

static void print_computing(FILE *out, const lockstep_wish *wish, const lockstep_report *r) {
    if (!r->counted) {
        fputs("computing          not counted: no emulator\n", out);
        return;
    }
    fprintf(out, "until outputs set  %.0f instructions at most, %.4g ms, at t = %.6g s\n",
            r->acted.value, 1e3 * r->acted.value * wish->instruction_s, r->acted.at_s);
    fprintf(out, "until it waits     %.0f instructions at most, %.4g ms, at t = %.6g s\n",
            r->busy.value, 1e3 * r->busy.value * wish->instruction_s, r->busy.at_s);
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
        const told_note *note = &r->note[i];
        const bool bare = strcmp(note->unit, "1") == 0;
        fprintf(out, "%s%s %.6g%s%s", i == 0 ? "it tells           " : ", ", note->name,
                note->value, bare ? "" : " ", bare ? "" : note->unit);
    }
    fputs(r->notes > 0 ? "\n" : "", out);
}

/* For a replay: the result of comparing the orders with the tape. */
static const char *as_on_tape(lockstep_end end) {
    switch (end) {
    case LOCKSTEP_DONE:
    case LOCKSTEP_LET_GO: return ", as on the tape";
    case LOCKSTEP_DIFFERENT: return ", not as on the tape";
    case LOCKSTEP_BAD:
    case LOCKSTEP_FAILED:
    case LOCKSTEP_STOPPED: break;
    }
    return ", as on the tape so far; the rest was not replayed";
}

void pil_print(FILE *out, const lockstep_wish *wish, const image *im, const lockstep_report *r) {
    fprintf(out, "\nfirmware           %s on board %s, %s\n", r->program, r->board,
            wish->guest.image);
    if (im != NULL) {
        print_plant(out, im, r);
        print_computing(out, wish, r);
    }
    if (r->resets > 0) {
        fprintf(out, "resets             %u, the last at t = %.6g s\n", r->resets, r->reset_s);
    }
    print_notes(out, r);
    fprintf(out, "exchanges          %" PRIu64 " in %.9g s of the plant's time", r->exchanges,
            r->time_s);
    if (im != NULL && r->wall_s > 0.0) {
        fprintf(out, "; %.0f a second, %.3g x real time", (double)r->exchanges / r->wall_s,
                r->time_s / r->wall_s);
    }
    fprintf(out, "\ncommand stream     0x%016" PRIx64 "%s\n", r->hash,
            im != NULL ? "" : as_on_tape(r->end));
    if (im != NULL) {
        fprintf(out, "plant's state      0x%016" PRIx64 "\n", r->plant_hash);
    }
}
