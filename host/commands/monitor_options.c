/* monitor_options.c: see monitor_options.h. */
#include "monitor_options.h"

#include <stdio.h>
#include <string.h>

#include "files.h"
#include "host/monitor/port.h"
#include "host/plot/gnuplot.h"
#include "target.h"

const command_usage monitor_usage = {
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
                "nothing could be recorded, or what was could not be written, or --strict and\n"
                "       something was lost",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "",
            [EXIT_ROW_OF(EXIT_INTERRUPTED)] = NULL}};

static const char *const output_option[OUTPUTS] = {"--csv", "--vcd", "--ring", "--raw", "--plot"};

static bool take_number(int count, char **words, int *at, monitor_options *o, bool *bad) {
    const number_option rows[] = {
        {"--rate", &o->rate, 1.0, 100000.0, true, "samples a second: --rate 500"},
        {"--for", &o->for_s, 0.001, 1e9, false, "in seconds: --for 60"},
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
              "hint: " PORT_SPEEDS "\n",
              stderr);
        return false;
    }
    if (o->output[PLOT] != NULL && !gnuplot_can_draw_for("monitor", "--plot", o->output[PLOT])) {
        return false;
    }
    return are_apart(o) && (o->output[PLOT] == NULL || gnuplot_is_there());
}

bool monitor_options_read(int count, char **words, monitor_options *o) {
    static const char *const own[] = {"--csv", "--vcd",  "--ring",   "--plot",  "--raw", "--rate",
                                      "--for", "--baud", "--strict", "--quiet", NULL};
    const target_reader reader = {
        .command = "monitor", .own = own, .take = take_one, .one = "line"};
    return target_read(&reader, count, words, &o->common, o, &o->port) &&
           target_is_there(o->port, &monitor_usage) && are_possible(o);
}
