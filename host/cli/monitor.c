/* monitor.c: `whirl monitor`: a rig's console, and a recorder of its telemetry. */
#include <errno.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/cli/options.h"
#include "host/io/plot.h"
#include "host/monitor/recording.h"
#include "host/monitor/wire.h"
#include "host/os/atomic_file.h"
#include "host/os/port.h"
#include "host/os/system.h"

enum { CSV, VCD, RING, RAW, PLOT, OUTPUTS };

typedef struct monitor_options {
    const char *port;
    const char *output[OUTPUTS];
    double rate;
    double for_s;
    double baud;
    bool strict;
    bool quiet;
} monitor_options;

static const command_usage monitor_usage = {
    .head =
        "usage: whirl monitor PORT [options]\n"
        "\n"
        "A terminal for the console of a rig, on a serial line or a pseudo-terminal (docs/console.md). It\n"
        "sends your input, shows the answers, and records the telemetry until Ctrl-C. If the line goes away,\n"
        "it waits. It sends an empty line every 0.3 s, because boards stop a run without a host. PORT may\n"
        "also be a file recorded with --raw.\n"
        "\n",
    .tail =
        "  --csv FILE           the samples: `time` in seconds since the first, then the rig's quantities\n"
        "                       with units; unknown cells are empty. - is standard output (the answers then\n"
        "                       go to standard error).\n"
        "  --vcd FILE           samples as real numbers, slot pulses as wires, for waveform viewers\n"
        "  --ring FILE          the records of `tel ring read`\n"
        "  --plot FILE.svg|.png the samples over time, drawn by gnuplot at the end\n"
        "  --raw FILE           all received bytes, unchanged\n"
        "  --rate N             samples per second, a divisor of the load cell's rate (default: 500)\n"
        "  --for S              end after this many seconds\n"
        "  --baud B             the speed of the line, 9600 to 230400 (default: 115200)\n"
        "  --strict             fail if samples were lost\n"
        "  --quiet              no summary\n",
    .why = {"Ctrl-C, --for, or the end of a file",
            "the rig did not answer or refused --rate, a file was not written or not read to\n    "
            "   its end, or samples were lost with --strict",
            "", NULL}};

static const char *const output_option[OUTPUTS] = {"--csv", "--vcd", "--ring", "--raw", "--plot"};
#define OUTPUT(which, kind) \
    { .word = output_option[which], .text = &o.output[which], .file = kind }

static bool are_possible(const monitor_options *o) {
    if (!port_has_speed(o->baud)) {
        return options_fail("monitor", "--baud: this speed is not supported\nhint: " PORT_SPEEDS);
    }
    for (int i = CSV + 1; i < OUTPUTS; i++) {
        if (options_is_standard(o->output[i])) {
            return options_fail("monitor", "%s takes a file's name", output_option[i]);
        }
    }
    return true;
}

/* === the command ============================================================================== */

enum {
    WAIT_MS = 100,
    AGAIN_MS = 300,
    ALIVE_MS = 300,
    ANSWER_MS = 1500,
    KEPT_MS = 1000,
    BYTES = 4096,
    TYPED = 256
};

typedef struct monitor {
    const monitor_options *o;
    port line;
    wire wire;
    schema schema;
    dialogue dialogue;
    recording recording;
    FILE *file[OUTPUTS];
    FILE *shown; /* the rig's messages */
    bool open;
    bool typing;     /* standard input has not ended */
    bool half_typed; /* the typed text has no end of line yet */
    bool live;       /* true: a serial line; false: a recorded file */
    bool met;        /* the rig has answered at least once */
    bool begun;      /* frames that arrive now belong to the recording */
    int unheard;     /* unanswered questions since the line was opened */
    int64_t asked_ms;
    int64_t kept_ms;  /* when records were last written to their files */
    int64_t alive_ms; /* when the rig was last sent a message */
    uint64_t times;   /* how often the line was opened */
} monitor;

static int64_t now_ms(void) { return (int64_t)(1000.0 * system_now_s()); }

static void ask(monitor *m) {
    char line[DIALOGUE_LINE];
    const char *question = dialogue_question(&m->dialogue, line);
    if (question != NULL) {
        /* if this fails, the question is sent again */
        (void)port_write(&m->line, question, strlen(question));
        m->asked_ms = now_ms();
    }
}

static void ask_again(monitor *m) {
    if (++m->unheard == 2 && m->dialogue.asked < DIALOGUE_MET) {
        fprintf(
            stderr,
            "whirl monitor: no answer from %s; trying again\nhint: check that it is the rig's console, that --baud is its speed, and that no other program uses it\n",
            m->o->port);
    }
    ask(m);
}

static bool open_line(monitor *m) {
    if (!port_open(&m->line, m->o->port, m->o->baud)) {
        return false;
    }
    m->open = true;
    m->times++;
    m->unheard = 0;
    port_forget(&m->line);
    wire_forget(&m->wire);
    m->dialogue = (dialogue){.rate = (int)m->o->rate};
    if (m->line.is_line) {
        /* end an unfinished line of the user */
        (void)port_write(&m->line, "\n", 1);
        ask(m);
    }
    return true;
}

/* Shows a line of the rig, with "?" for control characters, which a terminal would obey. Before the rig's first answer,
 * hides disturbed lines and lines that may begin with a part of a frame. */
static void show(const monitor *m, const char *line) {
    char shown[WIRE_LINE + 1];
    size_t count = 0;
    bool clean = true;
    for (; line[count] != '\0' && count < WIRE_LINE; count++) {
        const unsigned char c = (unsigned char)line[count];
        const bool is_text = (c >= 0x20U && c < 0x7fU) || c == '\t';
        shown[count] = is_text ? line[count] : '?';
        clean = clean && is_text;
    }
    shown[count] = '\0';
    if ((clean && !m->wire.torn) || m->met || !m->line.is_line) {
        fprintf(m->shown, "%s\n", shown);
        fflush(m->shown);
    }
}

static void go_on(monitor *m) {
    m->met = true;
    if (m->dialogue.asked == DIALOGUE_OFF && !m->begun) {
        m->begun = true;
        m->wire.damaged = 0; /* damage from before the recording does not count */
    }
    if (m->dialogue.asked == DIALOGUE_LISTED && m->dialogue.was_off) {
        recording_anew(&m->recording);
    }
    if (m->dialogue.done && m->dialogue.refused[0] != '\0') {
        fprintf(stderr, "whirl monitor: the rig refused: %s\n", m->dialogue.refused);
    }
    ask(m);
}

static void take_text(monitor *m, const char *line) {
    const int asked = m->dialogue.asked;
    const bool typed = m->dialogue.done || !m->line.is_line;
    if (typed && strncmp(line, "OK rate=", 8) == 0 && strstr(line, " period_ticks=") != NULL) {
        recording_asked(&m->recording);
    }
    if (schema_take(&m->schema, line) && !m->line.is_line) {
        return;
    }
    if (m->line.is_line && dialogue_answer(&m->dialogue, line)) {
        if (m->dialogue.asked > asked) {
            go_on(m);
        }
        return;
    }
    if (line[0] != '\0') { /* an empty line is the echo of stay_alive() */
        show(m, line);
    }
}

static void take_bytes(monitor *m, const uint8_t *bytes, int count) {
    if (m->file[RAW] != NULL) {
        fwrite(bytes, 1, (size_t)count, m->file[RAW]);
    }
    for (int i = 0; i < count; i++) {
        switch (wire_take(&m->wire, bytes[i])) {
        case WIRE_TEXT: take_text(m, m->wire.line); break;
        case WIRE_FRAME:
            if (!m->line.is_line || m->begun) { /* else the frame is from before the recording */
                recording_frame(&m->recording, &m->schema, &m->wire.frame);
            }
            break;
        case WIRE_NOTHING: break;
        }
    }
}

static void take_typed(monitor *m) {
    char line[TYPED];
    const ssize_t count = read(STDIN_FILENO, line, sizeof line);
    m->typing = count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
    m->half_typed = count > 0 && line[count - 1] != '\n';
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

/* Writes records to their files once a second, so that a sudden end loses at most a second of records. */
static void keep_records(monitor *m) {
    const int64_t now = now_ms();
    if (now - m->kept_ms < KEPT_MS) {
        return;
    }
    m->kept_ms = now;
    for (int i = 0; i < OUTPUTS; i++) {
        if (m->file[i] != NULL) {
            (void)fflush(m->file[i]); /* ferror() is checked later */
        }
    }
}

/* Sends an empty line regularly, because the rig ends a run after silence (setting `host`). Sends none while the user
 * types a line, because the typed line would be split. */
static void stay_alive(monitor *m) {
    const int64_t now = now_ms();
    if (m->line.is_line && m->met && !m->half_typed && now - m->alive_ms >= ALIVE_MS) {
        m->alive_ms = now;
        (void)port_write(&m->line, "\n", 1);
    }
}

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
                return; /* the end of a file, or of the part of it that can be read */
            }
            fprintf(stderr, "whirl monitor: %s is disconnected; waiting until it is back\n",
                    m->o->port);
            continue;
        }
        take_bytes(m, bytes, count);
        if (typed) {
            take_typed(m);
        }
        if (m->line.is_line && !m->dialogue.done && now_ms() - m->asked_ms > ANSWER_MS) {
            ask_again(m);
        }
        stay_alive(m);
        keep_records(m);
    }
}

static bool open_outputs(monitor *m) {
    for (int i = 0; i < PLOT; i++) {
        const char *name = m->o->output[i];
        if (name == NULL) {
            continue;
        }
        m->file[i] = strcmp(name, "-") == 0 ? stdout : atomic_file_open_in_place(name);
        if (m->file[i] == NULL) {
            return false;
        }
    }
    m->shown = m->file[CSV] == stdout ? stderr : stdout;
    return true;
}

static bool close_outputs(monitor *m) {
    bool good = true;
    for (int i = 0; i < PLOT; i++) {
        const char *name = m->o->output[i];
        good = (i == CSV || i == RING ? plot_run_csv_end(m->file[i], name, true, "monitor", "")
                                      : atomic_file_close(m->file[i], name, true)) &&
               good;
    }
    return good;
}

static void tell(const monitor *m) {
    const recording_counts *c = &m->recording.counts;
    fprintf(
        stderr,
        "whirl monitor: %" PRIu64 " samples, %" PRIu64 " pulses in %" PRIu64
        " frames; lost: %" PRIu64 " frames (%" PRIu64
        " because the rig's buffer was full), %" PRIu64 " samples; damaged frames: %" PRIu64 "\n",
        c->samples, c->pulses, c->frames, c->lost, c->dropped, c->lost_samples, m->wire.damaged);
    if (c->strange > 0) {
        fprintf(stderr, "whirl monitor: %" PRIu64 " frames of unknown type\n", c->strange);
    }
    if (m->times > 1 || c->restarts > 0) {
        fprintf(stderr,
                "whirl monitor: the line was opened %" PRIu64 " times, the rig restarted %" PRIu64
                " times\n",
                m->times, c->restarts);
    }
}

/* Returns false (reported) if the rig could not send the samples to be recorded, or if reading a file failed. */
static bool has_source(const monitor *m) {
    bool records = false;
    for (int i = 0; i < OUTPUTS; i++) {
        records = records || (i != RAW && m->o->output[i] != NULL);
    }
    const bool silent = m->live && (!m->met || m->dialogue.rate_refused);
    if (records && silent && m->recording.counts.samples == 0) {
        return options_fail("monitor", "nothing was recorded: %s%s", m->o->port,
                            m->met ? " cannot send samples at this --rate" : " has not answered");
    }
    const bool whole = m->live || m->line.failed == 0;
    if (!whole) {
        fprintf(stderr, "%s: error: reading stopped: %s\n", m->o->port, strerror(m->line.failed));
    }
    return whole;
}

static int run(void *options) {
    const monitor_options *o = options;
    static monitor one;
    monitor *m = &one;
    if (!are_possible(o)) {
        return EXIT_BAD_INPUT;
    }
    one = (monitor){.o = o, .typing = true};
    if (!open_line(m)) {
        port_say_unopened(
            m->o->port,
            "for the simulated rig, run `make rig`, which creates the line build/rig.tty");
        return EXIT_BAD_INPUT;
    }
    m->live = m->line.is_line;
    if (!open_outputs(m)) {
        (void)close_outputs(m);
        port_close(&m->line);
        return EXIT_BAD_INPUT;
    }
    recording_begin(&m->recording, m->file[CSV], m->file[VCD], m->file[RING],
                    m->o->output[PLOT] != NULL);
    interrupts_catch_waiting();
    listen(m);
    if (m->open && m->line.is_line) {
        (void)port_write(&m->line, "tel off\n", 8);
    }
    bool good = has_source(m);
    port_close(&m->line);
    good = good && (m->o->output[PLOT] == NULL ||
                    recording_plot(&m->recording, &m->schema, m->o->output[PLOT]));
    recording_end(&m->recording);
    if (!m->o->quiet) {
        tell(m);
    }
    good = close_outputs(m) && good;
    const recording_counts *c = &m->recording.counts;
    if (m->o->strict && (c->lost > 0 || c->strange > 0 || m->wire.damaged > 0)) {
        fputs("whirl monitor: error: data were lost (--strict)\n", stderr);
        good = false;
    }
    return good ? EXIT_DONE : EXIT_RUN_FAILED;
}

int command_monitor(int count, char **words) {
    monitor_options o = {.rate = 500.0, .baud = 115200.0};
    const own_option own[] = {
        OUTPUT(CSV, FILE_WRITTEN),
        OUTPUT(VCD, FILE_WRITTEN),
        OUTPUT(RING, FILE_WRITTEN),
        OUTPUT(RAW, FILE_WRITTEN),
        OUTPUT(PLOT, FILE_DRAWN),
        OWN_WHOLE("--rate", o.rate, 1.0, 100000.0, "samples per second: --rate 500"),
        OWN_NUMBER("--for", o.for_s, 0.001, 1e9, "in seconds: --for 60"),
        OWN_NUMBER("--baud", o.baud, 1.0, 1e7, "9600 to 230400: --baud 115200"),
        {.word = "--strict", .flag = &o.strict},
        {.word = "--quiet", .flag = &o.quiet},
        {.word = NULL}};
    const target_reader reader = {
        .command = "monitor", .usage = &monitor_usage, .table = own, .one = "line", .work = run};
    return target_command(&reader, count, words, NULL, &o, &o.port);
}
