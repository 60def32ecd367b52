/* monitor.c: `whirl monitor`: a rig's console, and its telemetry recorded. */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "commands.h"
#include "files.h"
#include "host/base/unwritten.h"
#include "host/monitor/dialogue.h"
#include "host/monitor/port.h"
#include "host/monitor/recording.h"
#include "host/monitor/taping.h"
#include "host/plot/gnuplot.h"
#include "host/plot/plot.h"
#include "interrupts.h"
#include "target.h"

enum { WAIT_MS = 100, AGAIN_MS = 300, ANSWER_MS = 1500, BYTES = 4096, TYPED = 256 };

static const command_usage usage = {
    .head =
        "usage: whirl monitor PORT [options]\n"
        "\n"
        "A rig's console on a serial line or a pseudo-terminal: what is typed goes to the rig, what it says\n"
        "is shown, and its telemetry is recorded, until Ctrl-C. Where the line goes away it is waited for.\n"
        "PORT may be a file that --raw has kept: what it holds is recorded, and that is all.\n"
        "\n",
    .tail =
        "  --csv FILE           samples, as records: time, then what the rig says it tells, with its units;\n"
        "                       - is standard output (what the rig says then goes to standard error)\n"
        "  --vcd FILE           samples as real numbers, slot pulses as wires, for waveform viewers\n"
        "  --tape FILE          all that control steps see and answer, for whirl pil --replay; the rig, once\n"
        "                       it is idle, starts anew\n"
        "  --ring FILE          what `tel ring read` brings, as records\n"
        "  --plot FILE.svg|.png samples over time, drawn by gnuplot at the end\n"
        "  --raw FILE           all bytes that come, as they come\n"
        "  --rate N             samples a second (default: 500)\n"
        "  --for S              end after so many seconds\n"
        "  --baud B             the line's speed (default: 115200)\n"
        "  --strict             fail when anything was lost\n"
        "  --quiet              no summary\n",
    .why = {[EXIT_ROW_OF(EXIT_DONE)] = "Ctrl-C, --for, or the end of a file",
            [EXIT_ROW_OF(EXIT_RUN_FAILED)] =
                "what was recorded could not be written, or --strict and something was lost",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "",
            [EXIT_ROW_OF(EXIT_INTERRUPTED)] = NULL}};

/* What can be written: a file each. */
enum { CSV, VCD, RING, TAPE, RAW, PLOT, OUTPUTS };
static const char *const output_option[OUTPUTS] = {"--csv",  "--vcd", "--ring",
                                                   "--tape", "--raw", "--plot"};

typedef struct monitor_options {
    common_options common;
    const char *port;
    const char *output[OUTPUTS];
    double rate;
    double for_s;
    double baud;
    bool strict;
    bool quiet;
} monitor_options;

typedef struct monitor {
    const monitor_options *o;
    port line;
    wire wire;
    schema schema;
    dialogue dialogue;
    recording recording;
    taping taping;
    FILE *file[OUTPUTS];
    FILE *shown; /* what the rig says */
    bool open;
    bool typing; /* standard input has not ended */
    int64_t asked_ms;
    uint64_t times; /* that the line was opened */
} monitor;

/* --- options ------------------------------------------------------------------------------------------------ */

static bool take_number(int count, char **words, int *at, monitor_options *o, bool *bad) {
    const number_option rows[] = {
        {"--rate", &o->rate, 1.0, 100000.0, true, "samples a second: --rate 500"},
        {"--for", &o->for_s, 0.0, 1e9, false, "in seconds: --for 60"},
        {"--baud", &o->baud, 1.0, 1e7, false, "9600 to 230400: --baud 115200"}};
    return options_take_number("monitor", rows, sizeof rows / sizeof rows[0], count, words, at,
                               bad);
}

static bool take_one(int count, char **words, int *at, void *options, bool *bad) {
    monitor_options *o = options;
    for (int i = 0; i < OUTPUTS && !*bad; i++) {
        const char *value = options_value(count, words, at, output_option[i], bad);
        if (value != NULL) {
            o->output[i] = value;
            return true;
        }
    }
    if (*bad || take_number(count, words, at, o, bad) || *bad) {
        return !*bad;
    }
    const bool strict = strcmp(words[*at], "--strict") == 0;
    const bool quiet = strcmp(words[*at], "--quiet") == 0;
    o->strict = o->strict || strict;
    o->quiet = o->quiet || quiet;
    *at += strict || quiet;
    return strict || quiet;
}

static bool are_apart(const monitor_options *o) {
    for (int i = 0; i < OUTPUTS; i++) {
        if (o->output[i] == NULL) {
            continue;
        }
        if (strcmp(o->output[i], "-") == 0 && i != CSV) {
            fprintf(stderr, "whirl monitor: error: %s takes a file's name\n", output_option[i]);
            return false;
        }
        if (files_same(o->output[i], o->port)) {
            fprintf(stderr, "whirl monitor: error: %s would be written over %s\n", output_option[i],
                    o->port);
            return false;
        }
        for (int k = 0; k < i; k++) {
            if (o->output[k] != NULL && files_same(o->output[i], o->output[k])) {
                fprintf(stderr, "whirl monitor: error: %s and %s cannot share a file\n",
                        output_option[k], output_option[i]);
                return false;
            }
        }
    }
    return true;
}

static bool are_possible(const monitor_options *o) {
    if (!port_has_speed(o->baud)) {
        fputs("whirl monitor: error: --baud: no such speed\n"
              "hint: 9600, 19200, 38400, 57600, 115200 or 230400\n",
              stderr);
        return false;
    }
    if (o->output[PLOT] != NULL && !plot_can_draw(o->output[PLOT])) {
        fputs("whirl monitor: error: --plot takes a name that ends in .svg or .png\n", stderr);
        return false;
    }
    return are_apart(o) && (o->output[PLOT] == NULL || gnuplot_is_there());
}

static bool read_options(int count, char **words, monitor_options *o) {
    static const char *const own[] = {"--csv",  "--vcd", "--ring", "--tape",   "--plot",  "--raw",
                                      "--rate", "--for", "--baud", "--strict", "--quiet", NULL};
    const target_reader reader = {.command = "monitor", .own = own, .take = take_one};
    return target_read(&reader, count, words, &o->common, o, &o->port) &&
           target_is_there(o->port, &usage) && are_possible(o);
}

/* --- the line ------------------------------------------------------------------------------------------------- */

static int64_t now_ms(void) {
    struct timespec now;
    if (clock_gettime(CLOCK_MONOTONIC, &now) != 0) {
        return 0;
    }
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

static void ask(monitor *m) {
    char line[DIALOGUE_LINE];
    const char *question = dialogue_question(&m->dialogue, line);
    if (question != NULL) {
        (void)port_write(&m->line, question, strlen(question)); /* else it is asked again */
        m->asked_ms = now_ms();
    }
}

static bool open_line(monitor *m) {
    if (!port_open(&m->line, m->o->port, m->o->baud)) {
        return false;
    }
    m->open = true;
    m->times++;
    wire_forget(&m->wire);
    m->dialogue = (dialogue){.rate = (int)m->o->rate, .tapes = m->o->output[TAPE] != NULL};
    if (m->line.is_line) {
        (void)port_write(&m->line, "\n",
                         1); /* what somebody has begun to type is no question's begin */
        ask(m);
    }
    return true;
}

static void take_text(monitor *m, const char *line) {
    if (schema_take(&m->schema, line) && !m->line.is_line) {
        return;
    }
    if (m->line.is_line && dialogue_answer(&m->dialogue, line)) {
        if (m->dialogue.asked == DIALOGUE_LISTED && m->dialogue.was_off) {
            recording_anew(&m->recording);
            taping_anew(&m->taping);
        }
        ask(m);
        return;
    }
    fprintf(m->shown, "%s\n", line);
    fflush(m->shown);
}

static void take_frame(monitor *m) {
    recording_frame(&m->recording, &m->schema, &m->wire.frame);
    if (m->file[TAPE] != NULL && m->wire.frame.channel == RECORDING_TAPE) {
        taping_frame(&m->taping, &m->wire.frame);
    }
}

static void take_bytes(monitor *m, const uint8_t *bytes, int count) {
    if (m->file[RAW] != NULL) {
        fwrite(bytes, 1, (size_t)count, m->file[RAW]);
    }
    for (int i = 0; i < count; i++) {
        switch (wire_take(&m->wire, bytes[i])) {
        case WIRE_TEXT: take_text(m, m->wire.line); break;
        case WIRE_FRAME: take_frame(m); break;
        case WIRE_NOTHING: break;
        }
    }
}

static void take_typed(monitor *m) {
    char line[TYPED];
    const ssize_t count = read(STDIN_FILENO, line, sizeof line);
    m->typing = count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
    if (count > 0) {
        (void)port_write(&m->line, line, (size_t)count);
    }
}

static bool written(const monitor *m) {
    for (int i = 0; i < OUTPUTS; i++) {
        if (m->file[i] != NULL && ferror(m->file[i])) {
            return false;
        }
    }
    return true;
}

/* Until it is to end. */
static void listen(monitor *m) {
    const int64_t began_ms = now_ms();
    uint8_t bytes[BYTES];
    while (!interrupted && written(m) &&
           (m->o->for_s <= 0.0 || (double)(now_ms() - began_ms) < m->o->for_s * 1e3)) {
        if (!m->open && !open_line(m)) {
            const struct timespec nap = {.tv_nsec = AGAIN_MS * 1000000L};
            (void)nanosleep(&nap, NULL);
            continue;
        }
        bool typed = false;
        const bool types = m->typing && m->line.is_line && m->dialogue.done;
        const int count = port_read(&m->line, bytes, sizeof bytes, WAIT_MS, types ? &typed : NULL);
        if (count < 0) {
            const bool was_line = m->line.is_line;
            port_close(&m->line);
            m->open = false;
            if (!was_line) {
                return; /* a file's end */
            }
            fprintf(stderr, "whirl monitor: %s is gone; waiting for it\n", m->o->port);
            continue;
        }
        take_bytes(m, bytes, count);
        if (typed) {
            take_typed(m);
        }
        if (m->line.is_line && !m->dialogue.done && now_ms() - m->asked_ms > ANSWER_MS) {
            ask(m);
        }
    }
}

/* --- all of it ---------------------------------------------------------------------------------------------------- */

static bool open_outputs(monitor *m) {
    for (int i = 0; i < PLOT; i++) {
        const char *name = m->o->output[i];
        if (name == NULL) {
            continue;
        }
        m->file[i] = strcmp(name, "-") == 0 ? stdout : fopen(name, "wb");
        if (m->file[i] == NULL) {
            unwritten_say(name);
            return false;
        }
    }
    m->shown = m->file[CSV] == stdout ? stderr : stdout;
    return true;
}

static bool close_outputs(monitor *m) {
    bool good = written(m);
    for (int i = 0; i < PLOT; i++) {
        if (m->file[i] == NULL || m->file[i] == stdout) {
            continue;
        }
        if (fclose(m->file[i]) != 0 || !good) {
            unwritten_say(m->o->output[i]);
            good = false;
        }
    }
    return good;
}

static bool lost_any(const monitor *m) {
    const recording_counts *c = &m->recording.counts;
    return c->lost > 0 || c->strange > 0 || m->wire.damaged > 0 || m->taping.lost;
}

static void tell_tape(const monitor *m) {
    const taping *t = &m->taping;
    fprintf(stderr, "whirl monitor: tape: %" PRIu64 " control steps, %.3f s%s%s\n", t->steps,
            (double)t->length_ticks / 1e6, t->lost ? "; it ends there: " : "",
            t->lost   ? t->why
            : t->over ? ""
                      : "; no more of it was heard");
}

static void tell(const monitor *m) {
    const recording_counts *c = &m->recording.counts;
    fprintf(stderr,
            "whirl monitor: %" PRIu64 " samples, %" PRIu64 " pulses in %" PRIu64
            " frames; lost: %" PRIu64 " frames (%" PRIu64 " for want of room in the rig), %" PRIu64
            " samples; damaged: %" PRIu64 "\n",
            c->samples, c->pulses, c->frames, c->lost, c->dropped, c->lost_samples,
            m->wire.damaged);
    if (c->strange > 0) {
        fprintf(stderr, "whirl monitor: %" PRIu64 " frames that the rig does not describe\n",
                c->strange);
    }
    if (m->times > 1 || c->restarts > 0) {
        fprintf(stderr,
                "whirl monitor: the line was opened %" PRIu64 " times, the rig began anew %" PRIu64
                " times\n",
                m->times, c->restarts);
    }
    if (m->file[TAPE] != NULL && m->taping.began) {
        tell_tape(m);
    }
    if (m->dialogue.refused[0] != '\0') {
        fprintf(stderr, "whirl monitor: the rig refused: %s\n", m->dialogue.refused);
    }
}

/* What of the tape is still to come, and its end. */
static void hear_tape_out(monitor *m) {
    uint8_t bytes[BYTES];
    const int64_t began_ms = now_ms();
    while (m->taping.began && !m->taping.over && now_ms() - began_ms < ANSWER_MS) {
        const int count = port_read(&m->line, bytes, sizeof bytes, WAIT_MS, NULL);
        if (count < 0) {
            return;
        }
        take_bytes(m, bytes, count);
    }
}

static bool has_tape(const monitor *m) {
    if (m->file[TAPE] != NULL && !m->taping.began) {
        fprintf(stderr,
                "whirl monitor: error: no tape was begun%s%s\n"
                "hint: it begins while the rig is idle: `status`, then `stop` or `clear`\n",
                m->taping.over ? ": " : "", m->taping.over ? m->taping.why : "");
        return false;
    }
    return true;
}

static int run(monitor *m) {
    if (!open_line(m)) {
        port_say_unopened(m->o->port, "build/rig.tty is that of make rig");
        return EXIT_BAD_INPUT;
    }
    if (!open_outputs(m)) {
        (void)close_outputs(m);
        port_close(&m->line);
        return EXIT_BAD_INPUT;
    }
    recording_begin(&m->recording, m->file[CSV], m->file[VCD], m->file[RING],
                    m->o->output[PLOT] != NULL);
    m->taping.out = m->file[TAPE];
    interrupts_catch_waiting();
    listen(m);
    if (m->open && m->line.is_line) {
        (void)port_write(&m->line, "tel off\n", 8);
        hear_tape_out(m);
    }
    port_close(&m->line);
    bool good =
        m->o->output[PLOT] == NULL || recording_plot(&m->recording, &m->schema, m->o->output[PLOT]);
    recording_end(&m->recording);
    if (!m->o->quiet) {
        tell(m);
    }
    good = has_tape(m) && good;
    good = close_outputs(m) && good;
    if (m->o->strict && lost_any(m)) {
        fputs("whirl monitor: error: something was lost, and --strict\n", stderr);
        good = false;
    }
    return good ? EXIT_DONE : EXIT_RUN_FAILED;
}

int command_monitor(int count, char **words) {
    monitor_options o = {.common = options_defaults(), .rate = 500.0, .baud = 115200.0};
    if (options_help(count, words, &usage)) {
        return EXIT_DONE;
    }
    int code = EXIT_BAD_INPUT;
    if (read_options(count, words, &o)) {
        static monitor m;
        m = (monitor){.o = &o, .typing = true};
        code = run(&m);
    }
    options_forget(&o.common);
    return code;
}
