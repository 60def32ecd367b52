/* pil.c: `whirl pil`: runs of a firmware image with a simulated plant, or with the messages of a tape. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/cli/load.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"
#include "host/os/port.h"
#include "host/os/system.h"
#include "host/pil/fault.h"
#include "host/pil/lockstep.h"
#include "options.h"

#define FINE_STEP "50us"
#define PATIENCE_S 10.0
#define BAUD 115200.0
#define LONGEST_S 3600.0
#define CLOCK_HZ 16e6
#define CYCLES 1.5

static const command_usage usage = {
    .head =
        "usage: whirl pil SCENE|MECHANISM[:SCENE]|FILE[:SCENE] --firmware IMAGE [options]\n"
        "       whirl pil SCENE --port PORT [options]\n"
        "       whirl pil --replay TAPE --firmware IMAGE [options]\n"
        "       whirl pil --read TAPE [--csv FILE]\n"
        "\n"
        "Processor in the loop (docs/pil.md): IMAGE runs in QEMU, or directly if it is a program "
        "for this\nmachine. The scene is the plant, and runs in double with the scene's step. "
        "Firmware and plant wait\nfor each other."
        " The firmware declares by name which inputs of the scene it sets, and which outputs,\n"
        "coordinates and rates it reads. The plant's time includes the firmware's computing time:\n"
        "counted instructions times --cycles, divided by --clock."
        "\n"
        "\n",
    .groups = OPTIONS_CHANGE | OPTIONS_STEP | OPTIONS_ENGINE,
    .tail =
        "  --firmware IMAGE     the program, an ELF file: build/BOARD/pil_rig.elf, build/pil_rig, or your\n"
        "                       own\n"
        "  --port PORT          instead of --firmware: a board on this serial line, /dev/ttyUSB0\n"
        "  --baud N             the speed of that line (default: 115200)\n"
        "  --board B            the emulated board: mps2-an386 (default, Cortex-M4F), mps2-an385 (M3),\n"
        "                       mps2-an500 (M7), mps2-an505 (M33), or a folder of boards/ whose board.mk has\n"
        "                       a BOARD_MACHINE of qemu-system-arm\n"
        "  --tape FILE          record all traffic between firmware and plant\n"
        "  --replay TAPE        no scene: send TAPE to the firmware, and compare its answers to the bit\n"
        "  --read TAPE          no scene: print TAPE as rows of a CSV: each edge and sample with its time\n"
        "                       and value, and each change of outputs and notes\n"
        "  --csv FILE           with --read: the rows; - is standard output (default). Without "
        "--read:\n                       the plant's records, as `whirl run --csv` writes them\n"
        "  --every 1ms          the spacing of the plant's records, a whole number of steps (default: 1ms)\n"
        "  --bind A=B,...       connect the firmware's name A to the scene's name B\n"
        "  --place X,...        how far the sensor of each edge is displaced, in the order of the firmware's\n"
        "                       edges: degrees for an angle, else SI\n"
        "  --jitter 20us        standard deviation of the edges' times (default: 0)\n"
        "  --delay 1ms          delay of every sample (default: 0)\n"
        "  --fault KIND[:CHANNEL][=SIZE][@WHEN][+DURATION],...\n"
        "                       a fault (repeatable). WHEN is a time (1.5s), a note of the firmware\n"
        "                       (state=4), or a note and a delay (state=4~200ms).\n"
        "  --faults             list the kinds of faults, and end\n"
        "  --seed N             seed of jitter and faults (default: 1)\n"
        "  --clock HZ           the processor's clock (default: 16e6)\n"
        "  --cycles C           cycles per instruction (default: 1.5; 0: computing takes no time)\n"
        "  --patience S         seconds to wait for an answer or for the end of the firmware "
        "(default: 10)\n"
        "  --quiet              no report: only the firmware's text, and errors\n"
        "\n"
        "Without --until the run ends with the firmware, at the latest after an hour of the plant's time.\n",
    .why = {"the firmware ended with status 0, or --until came",
            "the firmware ended with another status, crashed or did not answer, the plant\n       "
            "diverged, or answers differ from the tape's",
            "", ""}};

typedef struct pil_options {
    common_options common;
    const char *target;
    const char *firmware;
    const char *port; /* a serial line to the board */
    const char *board;
    char machine[GUEST_MACHINE_BYTES]; /* as set by guest_machine_of() */
    const char *tape;
    const char *replay;
    const char *read; /* a tape to print */
    const char *csv;
    const char *every;
    const char *bind;
    const char *place;
    const char *jitter;
    const char *delay;
    const char **fault; /* [fault_count] */
    int fault_count;
    fault_plan faults;
    double seed;
    double clock_Hz;
    double cycles;
    double patience_s;
    double baud; /* 0: not given */
    bool quiet;
    bool kinds; /* list the kinds of faults */
} pil_options;

/* Reports a scene or option that is given with --read, which only prints a tape. */
static bool is_read_alone(const pil_options *o) {
    const char *beside = o->target != NULL     ? "scene"
                         : o->every != NULL    ? "--every"
                         : o->firmware != NULL ? "--firmware"
                         : o->tape != NULL     ? "--tape"
                         : o->replay != NULL   ? "--replay"
                         : o->fault_count > 0  ? "--fault"
                                               : NULL;
    if (beside != NULL) {
        return options_fail("pil", "--read only prints a tape, so it excludes %s", beside);
    }
    return true;
}

static double baud_of(const pil_options *o) { return o->baud > 0.0 ? o->baud : BAUD; }

static bool go_together(const pil_options *o) {
    if (o->kinds) {
        return true;
    }
    if (o->read != NULL) {
        return is_read_alone(o);
    }
    if (o->every != NULL && o->csv == NULL) {
        return options_fail("pil", "--every needs --csv FILE");
    }
    if (o->port == NULL && o->baud > 0.0) {
        return options_fail("pil", "--baud needs --port");
    }
    if (o->port != NULL && (o->firmware != NULL || o->board != NULL)) {
        return options_fail("pil",
                            "--port excludes %s, because the firmware already runs on the board",
                            o->firmware != NULL ? "--firmware" : "--board");
    }
    if (o->port != NULL && !port_has_speed(baud_of(o))) {
        return options_fail("pil", "--baud: this speed is not supported\nhint: " PORT_SPEEDS);
    }
    if (o->firmware == NULL && o->port == NULL) {
        return options_fail(
            "pil", "--firmware IMAGE is missing\nhint: `make pil-images` builds "
                   "build/mps2-an386/pil_rig.elf, which runs against docs/plants/rig.whirl");
    }
    if (o->target == NULL && o->replay == NULL) {
        return options_fail("pil", "a scene for the plant is missing\nhint: name a scene, such as "
                                   "docs/plants/rig.whirl, or a tape: --replay TAPE");
    }
    if (o->replay != NULL &&
        (o->target != NULL || o->tape != NULL || o->csv != NULL || o->fault_count > 0)) {
        return options_fail("pil", "--replay excludes %s, because the tape replaces the plant",
                            o->target != NULL ? "scene"
                            : o->tape != NULL ? "--tape"
                            : o->csv != NULL  ? "--csv"
                                              : "--fault");
    }
    return true;
}

/* The boards are compiled in: the program must know them without the source tree. */
static bool is_known_board(pil_options *o) {
    static const char *const boards[] = {"mps2-an386", "mps2-an385", "mps2-an500", "mps2-an505"};
    return o->board == NULL || guest_machine_of(o->board, o->machine) ||
           options_choose("pil", "board", o->board, boards, sizeof boards[0],
                          (int)(sizeof boards / sizeof boards[0])) >= 0;
}

static lockstep_request request_of(const pil_options *o) {
    return (lockstep_request){.guest = {.image = o->firmware,
                                        .board = o->machine[0] != '\0' ? o->machine
                                                 : o->board != NULL    ? o->board
                                                                       : "mps2-an386",
                                        .patience_s = o->patience_s},
                              .plant = {.seed = (uint32_t)o->seed},
                              .renames = o->bind,
                              .until_s = LONGEST_S,
                              .instruction_s = o->cycles / o->clock_Hz};
}

static int tell(const pil_options *o, const lockstep_request *request, const image *im,
                const lockstep_report *r) {
    static const int codes[] = {[LOCKSTEP_DONE] = EXIT_DONE,
                                [LOCKSTEP_LET_GO] = EXIT_DONE,
                                [LOCKSTEP_BAD] = EXIT_BAD_INPUT,
                                [LOCKSTEP_FAILED] = EXIT_RUN_FAILED,
                                [LOCKSTEP_DIFFERENT] = EXIT_RUN_FAILED,
                                [LOCKSTEP_STOPPED] = EXIT_INTERRUPTED};
    const bool failed = r->end == LOCKSTEP_DONE && r->status.status != 0;
    if (failed) {
        fprintf(stderr, "whirl pil: the firmware ended with status %d\n", r->status.status);
    }
    if (r->end == LOCKSTEP_STOPPED) {
        fprintf(stderr, "whirl pil: interrupted after %" PRIu64 " exchanges\n", r->exchanges);
    }
    if (!o->quiet && r->end != LOCKSTEP_BAD) {
        pil_print(options_is_standard(o->csv) ? stderr : stdout, request, im, r);
    }
    const int code = failed ? EXIT_RUN_FAILED : codes[r->end];
    return code == EXIT_DONE && !fault_all_occurred(&o->faults) ? EXIT_RUN_FAILED : code;
}

/* Opens the serial line of --port; without --port, sets line->file to -1, and port_close() does nothing. */
static bool open_line(const pil_options *o, lockstep_request *request, port *line) {
    line->file = -1;
    if (o->port == NULL) {
        return true;
    }
    if (!port_open(line, o->port, baud_of(o))) {
        port_say_unopened(o->port, "check that the board is plugged in: ls /dev/tty*");
        return false;
    }
    if (!line->is_line) {
        fprintf(stderr, "%s: error: this is not a serial line, so no board can answer\n", o->port);
        port_close(line);
        return false;
    }
    request->guest.by_line = true;
    request->guest.line = line->file;
    request->guest.image = o->port;
    return true;
}

static int run_image(const pil_options *o, const source_model *from, const image *im,
                     lockstep_request *request, double every_s) {
    lockstep_report report;
    recorded rows;
    if (!image_can_start(im, &engine_double, from->errors)) {
        return EXIT_BAD_INPUT;
    }
    request->tape = o->tape != NULL ? atomic_file_open_in_place(o->tape) : NULL;
    if ((o->tape != NULL && request->tape == NULL) ||
        !recorded_open(&rows, o->csv, im, o->every != NULL ? every_s : -1.0)) {
        return EXIT_BAD_INPUT;
    }
    request->plant.rows = &rows;
    if (o->common.changes.until != NULL) {
        request->until_s = im->until_s;
    }
    port line;
    const bool open = open_line(o, request, &line);
    if (open) {
        interrupts_catch_waiting();
        lockstep_run(request, im, &report);
        port_close(&line);
    }
    const bool written = recorded_close(&rows);
    const bool taped = atomic_file_close(request->tape, o->tape, true);
    request->plant.rows = NULL;
    if (!open) {
        return EXIT_BAD_INPUT;
    }
    if (!written || (!taped && report.end != LOCKSTEP_BAD)) {
        report.end = LOCKSTEP_FAILED;
    }
    return tell(o, request, im, &report);
}

static int run_source(pil_options *o, source_model *from) {
    overrides *changes = &o->common.changes;
    const mechanism *of;
    const scene *in;
    lockstep_request request = request_of(o);
    double every_s;
    int code = source_open(from, o->target);
    code = code == EXIT_DONE ? source_pick(from, true, &of, &in) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    if (!options_time("pil", "jitter", o->jitter, of, LONGEST_S, &request.plant.jitter_s) ||
        !options_time("pil", "delay", o->delay, of, LONGEST_S, &request.plant.delay_s) ||
        !options_time("pil", "every", o->every, of, LONGEST_S, &every_s) ||
        !plant_read_places(o->place, &request.plant)) {
        return EXIT_BAD_INPUT;
    }
    loaded made;
    o->faults.seed = (uint32_t)o->seed;
    const tap faults = fault_tap(&o->faults);
    request.taps = &faults;
    request.tap_count = 1;
    /* some faults change a parameter, like --set */
    for (unsigned i = 0; i < o->faults.count; i++) {
        options_set(&o->common, fault_parameter(&o->faults, i));
    }
    changes->step = changes->step != NULL ? changes->step : FINE_STEP;
    const load_request what = {
        .settings = o->common.integration, .use = IMAGE_TO_RUN, .conserve = true};
    code = load(&made, from, of, in, changes, &what);
    if (code == EXIT_DONE) {
        code = run_image(o, from, made.image, &request, every_s);
    }
    unload(&made);
    return code;
}

static int replay(const pil_options *o) {
    lockstep_request request = request_of(o);
    lockstep_report report;
    port line;
    if (!open_line(o, &request, &line)) {
        return EXIT_BAD_INPUT;
    }
    interrupts_catch_waiting();
    lockstep_replay(&request, o->replay, &report);
    port_close(&line);
    return tell(o, &request, NULL, &report);
}

static int pil_work(void *options) {
    pil_options *o = options;
    for (int i = 0; i < o->fault_count; i++) {
        if (!fault_read(&o->faults, o->fault[i])) {
            return EXIT_BAD_INPUT;
        }
    }
    if (!is_known_board(o) || !go_together(o)) {
        return EXIT_BAD_INPUT;
    }
    if (o->kinds) {
        fault_print_kinds(stdout);
        return EXIT_DONE;
    }
    if (o->read != NULL) {
        return taped_show(o->read, o->csv) ? EXIT_DONE : EXIT_BAD_INPUT;
    }
    if (o->replay != NULL) {
        return replay(o);
    }
    source_model from;
    const int code = run_source(o, &from);
    source_close(&from);
    return code;
}

int command_pil(int count, char **words) {
    pil_options o = {.common = options_defaults(),
                     .fault = alloc(count, sizeof *o.fault),
                     .seed = 1.0,
                     .clock_Hz = CLOCK_HZ,
                     .cycles = CYCLES,
                     .patience_s = PATIENCE_S};
    const own_option own[] = {
        {.word = "--fault", .text = o.fault, .count = &o.fault_count},
        {.word = "--firmware", .text = &o.firmware, .file = FILE_READ},
        {.word = "--board", .text = &o.board},
        {.word = "--replay", .text = &o.replay, .file = FILE_READ},
        {.word = "--read", .text = &o.read, .file = FILE_READ},
        {.word = "--csv", .text = &o.csv, .file = FILE_WRITTEN},
        {.word = "--tape", .text = &o.tape, .file = FILE_WRITTEN},
        {.word = "--bind", .text = &o.bind},
        {.word = "--place", .text = &o.place},
        {.word = "--jitter", .text = &o.jitter},
        {.word = "--delay", .text = &o.delay},
        {.word = "--port", .text = &o.port},
        {.word = "--every", .text = &o.every},
        OWN_WHOLE("--seed", o.seed, 0.0, 4294967295.0, "a whole number: --seed 7"),
        OWN_NUMBER("--clock", o.clock_Hz, 1e3, 1e11, "in Hz: --clock 16e6"),
        OWN_NUMBER("--cycles", o.cycles, 0.0, 1e4, "cycles per instruction: --cycles 1.5"),
        OWN_WHOLE("--baud", o.baud, 1.0, 1e7, "a speed of serial lines: --baud 115200"),
        OWN_NUMBER("--patience", o.patience_s, 0.01, 1e6, "a number of seconds: --patience 10"),
        {.word = "--faults", .flag = &o.kinds},
        {.word = "--quiet", .flag = &o.quiet},
        {.word = NULL}};
    const target_reader reader = {
        .command = "pil", .usage = &usage, .table = own, .none = true, .work = pil_work};
    const int code = target_command(&reader, count, words, &o.common, &o, &o.target);
    free(o.fault);
    return code;
}
