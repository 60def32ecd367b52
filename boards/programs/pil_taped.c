/* pil_taped.c: the rig's controller on what `whirl monitor --tape` has recorded of another one, for `whirl pil --replay`: every
 * control step sees what that one saw, and must answer what it did (core/step_tape.h). It never ends by itself: the tape
 * does. Exit status 2: nobody plays a tape. */
#include "boards/board.h"
#include "core/station/conf.h"
#include "core/step_tape.h"
#include "hal/frames/turns.h"
#include "rig_own.h"

static hal_turns tape;
static wh_rig rig;
static wh_rig_config config;
static wh_conf conf;
static bool started;
static uint8_t settings[WH_CONF_COUNT * WH_TAPED_SETTING_BYTES]; /* as they came */
static wh_bytes taken = {.to = settings, .room = sizeof settings};

/* Of an exchange that is no step: settings, then the start. */
static void take_start(const wh_readings *readings, uint32_t now_ticks) {
    uint32_t number = 0;
    for (unsigned i = 0; i < readings->samples; i++) {
        const wh_sample *sample = &readings->sample[i];
        if (sample->channel == WH_TAPED_SETTING) {
            number = (uint32_t)sample->raw;
        } else if (sample->channel == WH_TAPED_SETTING_VALUE) {
            wh_bytes_put(&taken, number, 1);
            wh_bytes_put(&taken, (uint32_t)sample->raw, 4);
        } else if (sample->channel == WH_TAPED_STARTS && sample->raw == (int32_t)WH_TAPED_VERSION) {
            wh_conf_take(&conf, settings, taken.at);
            wh_rig_start(&config, &rig, now_ticks, NULL);
            started = true;
        }
    }
}

/* As rig_control.h does it; orders first, which were given after the step before. */
static void take_step(const wh_taped_step *step) {
    const wh_rig_inputs inputs = {.now_ticks = step->ticks,
                                  .supply_V = wh_taped_float(step->supply),
                                  .stop_pressed = (step->pins & WH_TAPED_STOP) != 0,
                                  .clock_is_fallback = (step->pins & WH_TAPED_FALLBACK) != 0,
                                  .watchdog_has_cut = (step->pins & WH_TAPED_CUT) != 0};
    for (unsigned i = 0; i < step->orders; i++) {
        (void)wh_rig_post(&rig, (wh_rig_event)step->order[i].event,
                          wh_taped_float(step->order[i].value));
    }
    if (step->pulsed) {
        wh_rig_pulse(&config, &rig, step->sensor, step->pulse_ticks);
    }
    for (unsigned i = 0; i < step->samples; i++) {
        wh_rig_load(&config, &rig, step->sample[i].ticks, step->sample[i].raw,
                    (wh_load_status)step->sample[i].status);
    }
    (void)wh_rig_step(&config, &rig, &inputs);
}

static void answer(uint32_t now_ticks) {
    const wh_taped_answer said = {.way = (uint8_t)rig.command.way,
                                  .volts = wh_taped_bits(rig.command.volts),
                                  .stage = (uint8_t)wh_rig_stage(&rig),
                                  .trip = (uint8_t)rig.guard.trip};
    wh_orders orders;
    wh_taped_orders(&said, now_ticks, &orders);
    for (unsigned i = 0; i < orders.outputs; i++) {
        tape.orders.output[i] = orders.output[i];
    }
    hal_turns_wait(&tape, orders.until_ticks);
}

int main(void) {
    wh_hello hello;
    wh_taped_step step;
    board_start();
    wh_taped_hello(&hello, board_name);
    wh_conf_start(&conf, own_configuration, NULL, &config);
    if (!hal_turns_start(&tape, &hello)) {
        board_exit(2);
    }
    for (;;) {
        /* all that came is this step's: nothing is left for the next */
        tape.edge = tape.readings.edges;
        tape.sample = tape.readings.samples;
        if (started) {
            wh_taped_step_of(&tape.readings, tape.ticks, &step);
            take_step(&step);
        } else {
            take_start(&tape.readings, tape.ticks);
        }
        answer(tape.ticks);
    }
}
