/* firstlight.c: first test of a board: five scenes, the rig's control loop at rest, and the console's self-test. Prints
 * the results as one record (docs/firstlight.md). Real hardware repeats the record after each received line end. The
 * motor stays off: the image does not call hal_motor_start() (boards/check_image.sh). */
#define LINE_BYTES 200U /* the compiler's version and the self-test's answer are long */
#include "core/light_fields.h"

#include "boards/board.h"
#include "boards/programs/line.h"
#include "boards/programs/step_cycles.h"
#include "core/frame.h"
#include "core/text.h"
#include "core/version.h"

/* 1: the board has the rig's hardware; 0: the rig's fields are `none` */
#ifndef LIGHT_HARDWARE
#define LIGHT_HARDWARE 0
#endif
#if LIGHT_HARDWARE
#define HAL_VIRTUAL 0
#define RIG_DRIVES 0
#include "core/station/selftest.h"
#include "rig_control.h"
#endif

#include "build/gen/driven_hinge_from_rest.h"
#include "build/gen/epicyclic_from_rest.h"
#include "build/gen/rig_fixed.h"
#include "build/gen/shuttle_buffers.h"
#include "build/gen/thomson_a_conserved.h"

#define ADDRESS_OF(scene) &(scene),
static const wh_scene *const scenes[] = {WH_LIGHT_SCENES(ADDRESS_OF)};
#define SCENES (sizeof scenes / sizeof scenes[0])
_Static_assert(SCENES == 5U, "five scenes");

/* one memory for all scenes, because they run one after the other */
#define MEMORY_OF(scene) uint64_t scene[scene##_MEMORY_WORDS];
static union { WH_LIGHT_SCENES(MEMORY_OF) } scene_memory;

typedef struct run {
    uint64_t hash;
    uint64_t steps;
    wh_status status;
    uint32_t least, median, most; /* cycles of a step */
} run;
static run runs[SCENES];
static bool counts_cycles;

static void run_scene(const wh_scene *scene, run *to) {
    static step_cycles cycles;
    const uint64_t every = scene->steps / STEP_CYCLES_KEPT + 1U;
    wh_state state;
    to->status = wh_scene_start(scene, &state, &scene_memory, sizeof scene_memory);
    step_cycles_start(&cycles);
    while (to->status == WH_OK && state.steps < scene->steps) {
        to->status = step_counted(&cycles, scene, &state, state.steps % every == 0);
    }
    to->steps = state.steps;
    to->hash = wh_scene_hash(scene, &state);
    to->least = cycles.least;
    to->median = step_cycles_median(&cycles);
    to->most = cycles.most;
}

static uint32_t crc;

/* Ends a line. The CRC always contains "\n", although the rig's hardware sends "\r\n". */
static void end_line(void) {
    wh_text_add_char(&line, '\n');
    crc = wh_frame_crc(crc, (const uint8_t *)line.bytes, line.length);
#if LIGHT_HARDWARE
    line.bytes[line.length - 1U] = '\r';
    wh_text_add_char(&line, '\n');
#endif
    hal_console_write(line.bytes, line.length);
}
static void say(const char *name, const char *value) {
    line_of(name, value);
    end_line();
}
static void begin_field(const char *kind, const wh_scene *scene) {
    line_begin(kind);
    wh_text_add(&line, scene->name);
}

static void say_scene(const wh_scene *scene, const run *of) {
    begin_field("model.", scene);
    line_hex(scene->model_hash, 16);
    end_line();
    begin_field("hash.", scene);
    line_hex(of->hash, 16);
    line_number((int64_t)of->steps);
    line_word("steps,");
    line_word(wh_status_text(of->status));
    end_line();
    begin_field("cycles.", scene);
    if (counts_cycles && of->steps > 0) {
        line_number(of->least);
        line_number(of->median);
        line_number(of->most);
    } else {
        line_word(WH_LIGHT_NONE);
    }
    end_line();
}

static void say_head(void) {
    say("board", board_name);
    line_begin("chip");
    if (board_chip() != 0) {
        line_hex(board_chip(), 8);
    } else {
        line_word(WH_LIGHT_NONE);
    }
    end_line();
    say("version", WH_VERSION);
    say("compiler", __VERSION__);
}

static void say_stack(void) {
    line_begin("stack");
    if (board_stack_size_bytes() > 0) {
        line_number(board_stack_used_bytes());
        line_word("of");
        line_number(board_stack_size_bytes());
        line_word("bytes");
    } else {
        line_word(WH_LIGHT_NONE);
    }
    end_line();
}

#if LIGHT_HARDWARE
#define PERIODS 1000U /* two seconds, because rest is recognized after 1.5 s without pulses */

typedef struct range {
    int32_t least;
    int32_t most;
} range;
#define RANGE_EMPTY ((range){INT32_MAX, INT32_MIN})
static void range_take(range *r, int32_t value) {
    r->least = value < r->least ? value : r->least;
    r->most = value > r->most ? value : r->most;
}

static struct {
    const char *why_not; /* reason why the rig's hardware did not start; NULL: it started */
    range period_ticks;
    range period_cycles;
    unsigned samples;
    unsigned bad_samples;
    range load;
    int64_t load_sum;
    unsigned edges[2];
    bool stop_heard;
} rest;
static wh_rig_config config;

static void look_at_inputs(void) {
    for (unsigned i = 0; i < seen.samples; i++) {
        range_take(&rest.load, seen.sample[i].raw);
        rest.load_sum += seen.sample[i].raw;
        rest.samples++;
        rest.bad_samples += seen.sample[i].status != WH_LOAD_OK ? 1U : 0U;
    }
    rest.edges[seen.sensor & 1U] += seen.pulsed ? 1U : 0U;
    rest.edges[seen.end_sensor & 1U] += seen.ended ? 1U : 0U;
}

static void watch_rest(void) {
    rest.period_ticks = rest.period_cycles = rest.load = RANGE_EMPTY;
    rest.why_not = why_not_started();
    if (rest.why_not != NULL) {
        return;
    }
    own_configuration(&config);
    uint32_t due = hal_clock_ticks();
    uint32_t ticks = due;
    uint32_t cycles = board_cycles();
    wh_rig_start(&config, &rig, due, NULL);
    for (unsigned i = 0; i <= PERIODS; i++) {
        due += CONTROL_TICKS;
        hal_clock_wait_until(due);
        const uint32_t now_ticks = hal_clock_ticks();
        const uint32_t now_cycles = board_cycles();
        if (i > 0) {
            range_take(&rest.period_ticks, (int32_t)(now_ticks - ticks));
            range_take(&rest.period_cycles, (int32_t)(now_cycles - cycles));
        }
        ticks = now_ticks;
        cycles = now_cycles;
        control(&config);
        look_at_inputs();
    }
    rest.stop_heard = hal_stop_heard();
}

static void say_range(const char *name, bool known, const range *r) {
    line_begin(name);
    if (known) {
        line_number(r->least);
        line_number(r->most);
    } else {
        line_word(WH_LIGHT_NONE);
    }
    end_line();
}

static void say_load(void) {
    line_begin("load");
    if (rest.samples > 0) {
        line_number(rest.load.least);
        line_number(rest.load_sum / (int64_t)rest.samples);
        line_number(rest.load.most);
        line_word("counts,");
        line_number(rest.samples);
        line_word("samples,");
        line_number(rest.bad_samples);
        line_word("bad");
    } else {
        line_word(WH_LIGHT_NONE);
    }
    end_line();
    line_begin("supply");
    /* One converter measures load and supply: the supply is known if there was a load sample. */
    if (rest.samples > 0) {
        wh_text_add_char(&line, ' ');
        wh_text_add_fixed(&line, seen.inputs.supply_V, 2);
        line_word("V");
    } else {
        line_word(WH_LIGHT_NONE);
    }
    end_line();
}

static void say_rest(void) {
    static const char *const clock[] = {[HAL_CLOCK_CRYSTAL] = "crystal",
                                        [HAL_CLOCK_FALLBACK] = "fallback",
                                        [HAL_CLOCK_PLAYED] = WH_LIGHT_NONE};
    const bool started = rest.why_not == NULL;
    const bool keeps_time = started && hal_clock_source_now() != HAL_CLOCK_PLAYED;
    char answer[200];
    wh_text text;
    wh_text_start(&text, answer, sizeof answer);
    say("clock", clock[hal_clock_source_now()]);
    say_range("period_us", keeps_time, &rest.period_ticks);
    say_range("period_cycles", keeps_time && counts_cycles, &rest.period_cycles);
    say_load();
    say("stop", !rest.stop_heard           ? WH_LIGHT_NONE
                : seen.inputs.stop_pressed ? "pressed"
                                           : "released");
    line_begin("slots");
    line_number(rest.edges[0]);
    line_number(rest.edges[1]);
    line_word("edges,");
    line_number(hal_slots_overruns());
    line_word("lost");
    end_line();
    if (started) {
        wh_selftest_answer(&config, &rig, &seen, &text);
        say("selftest", answer + sizeof " selftest=" - 1U);
    } else {
        line_begin("selftest");
        line_word("bad:");
        line_word(rest.why_not);
        end_line();
    }
}

/* True if a line end was received. Noise on an open line seldom contains one. */
static bool line_end_typed(void) {
    char typed[16];
    bool ended = false;
    for (unsigned count = 1; count > 0;) {
        count = hal_console_read(typed, sizeof typed);
        for (unsigned i = 0; i < count; i++) {
            ended = ended || typed[i] == '\r' || typed[i] == '\n';
        }
    }
    return ended;
}
#else
static void say_rest(void) {
    static const char *const names[] = {"clock",  "period_us", "period_cycles", "load",
                                        "supply", "stop",      "slots",         "selftest"};
    for (unsigned i = 0; i < sizeof names / sizeof names[0]; i++) {
        say(names[i], WH_LIGHT_NONE);
    }
}
#endif

static void say_record(void) {
    line_begin("");
    end_line(); /* the record begins on a new line, even after noise */
    crc = 0;
    line_begin(WH_LIGHT_BEGIN);
    end_line();
    say_head();
    for (unsigned i = 0; i < SCENES; i++) {
        say_scene(scenes[i], &runs[i]);
    }
    say_stack();
    say_rest();
    line_begin(WH_LIGHT_END);
    wh_text_add_hex(&line, crc, 8);
    end_line();
}

int main(void) {
    board_start();
    counts_cycles = board_cycles_start();
    for (unsigned i = 0; i < SCENES; i++) {
        run_scene(scenes[i], &runs[i]);
    }
#if LIGHT_HARDWARE
    watch_rest();
    for (;;) {
        say_record();
        (void)line_end_typed(); /* drops the bytes that came during the record */
        do {
            hal_clock_wait_until(hal_clock_ticks() + CONTROL_TICKS);
        } while (!line_end_typed());
    }
#else
    say_record();
    board_exit(0);
#endif
}
