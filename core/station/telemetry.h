/* telemetry.h: the rig's data, sample by sample, on the serial line that also has the console's text.
 *
 * A frame before COBS coding (core/cobs.h), with sizes in bytes and little-endian numbers:
 *
 *     0x80 + channel 1 | sequence 2 | dropped 2 | ticks 4 | payload | CRC-16/CCITT 2
 *
 * A zero precedes and ends each coded frame. The second byte after a zero is 0x80 + channel if a frame follows, and
 * smaller if text follows. `sequence` counts all frames of the channel, and `dropped` those that did not fit into the
 * output ring. Both wrap. If `sequence` skips more numbers than `dropped` counts, the line lost frames.
 *
 * The console's `tel schema` describes the channels:
 *
 *     run    up to ten load samples, each within 1/8 of a period of its nominal time; speed, drive and state of the
 *            step in which the frame is sent
 *     event  one event, at `ticks`: an edge of a slot pulse, a new state or a trip
 *     ring   up to ten of the recorded control steps around a trigger (below); such a frame is never dropped
 *
 * Telemetry is off at first. It uses at most half of the output ring. */
#ifndef WH_STATION_TELEMETRY_H
#define WH_STATION_TELEMETRY_H

#include "answer.h"
#include "core/rig/rig.h"
#include "core/text.h"
#include "line.h"
#include "ring.h"
#include "step_inputs.h"

/* === the control steps around a trigger ====================================================== */

#define WH_CAPTURE_STEPS 192U /* 0.38 s at 500 Hz */
#define WH_CAPTURE_BYTES 8U   /* bytes of one step in a frame */

/* Triggers: X(trigger, word) */
#define WH_CAPTURE_ROWS(X) \
    X(WH_CAPTURE_OFF, "off") \
    X(WH_CAPTURE_PULSE, "pulse") /* a slot pulse */ \
    X(WH_CAPTURE_FAULT, "fault") /* a trip */

#define WH_CAPTURE_NAME(trigger, word) trigger,
typedef enum wh_capture_trigger {
    WH_CAPTURE_ROWS(WH_CAPTURE_NAME) WH_CAPTURE_TRIGGERS
} wh_capture_trigger;
#undef WH_CAPTURE_NAME

typedef struct wh_captured {
    uint16_t ticks; /* low 16 bits of the step's time */
    int16_t load;   /* counts divided by 2^wh_tel_shift() */
    uint16_t drive_mV;
    uint8_t flags; /* 1: a pulse of sensor 0; 2: one of sensor 1; 4: the trigger; 8: tripped */
    uint8_t stage;
} wh_captured;

/* States of a capture: X(state, word) */
#define WH_CAPTURE_STATE_ROWS(X) \
    X(WH_CAPTURE_NONE, "off") \
    X(WH_CAPTURE_WAITS, "waiting") \
    X(WH_CAPTURE_TRIGGERED, "triggered") \
    X(WH_CAPTURE_FULL, "full")

#define WH_CAPTURE_NAME(state, word) state,
typedef enum wh_capture_state {
    WH_CAPTURE_STATE_ROWS(WH_CAPTURE_NAME) WH_CAPTURE_STATES
} wh_capture_state;
#undef WH_CAPTURE_NAME

/* All zeros: off. */
typedef struct wh_capture {
    wh_capture_trigger trigger;
    wh_capture_state state;
    unsigned left;        /* number of steps still to record after the trigger */
    unsigned count;       /* number of stored steps */
    unsigned next;        /* index in step[] at which the next step is stored */
    uint32_t first_ticks; /* time of the oldest step; wh_captured has only its low 16 bits */
    wh_captured step[WH_CAPTURE_STEPS];
} wh_capture;

#define WH_TEL_SAMPLES 10U
#define WH_TEL_HEAD_BYTES 9U
/* Bytes of a frame on the line without its payload: head, zeros, COBS code, CRC. */
#define WH_TEL_FIXED_BYTES (WH_TEL_HEAD_BYTES + 5U)
#define WH_TEL_PAYLOAD_MOST (WH_TEL_SAMPLES * WH_CAPTURE_BYTES)
#define WH_TEL_NO_LOAD (-32768) /* no good sample */
/* Maximum number of samples per second in a text format, which takes more bytes than frames. */
#define WH_TEL_TEXT_PER_S_MOST 100U

/* X(channel, number, name) */
#define WH_TEL_CHANNEL_ROWS(X) \
    X(WH_TEL_RUN, 0, "run") \
    X(WH_TEL_EVENT, 1, "event") \
    X(WH_TEL_RING, 2, "ring")

#define WH_TEL_NAME(channel, number, name) channel = (number),
typedef enum wh_tel_channel { WH_TEL_CHANNEL_ROWS(WH_TEL_NAME) WH_TEL_CHANNELS } wh_tel_channel;
#undef WH_TEL_NAME

typedef enum wh_tel_event {
    WH_TEL_PULSE, /* value: the sensor, 0 or 1; begin of a pulse */
    WH_TEL_STATE, /* value: wh_rig_shown_stage() */
    WH_TEL_TRIP,  /* value: a wh_trip */
    WH_TEL_END    /* value: the sensor, 0 or 1; end of a pulse */
} wh_tel_event;

/* X(format, word) */
#define WH_TEL_FORMAT_ROWS(X) \
    X(WH_TEL_FRAMES, "frames") \
    X(WH_TEL_TELEPLOT, "teleplot") /* >name:value */ \
    X(WH_TEL_ARDUINO, "arduino")   /* name:value,name:value */

#define WH_TEL_NAME(format, word) format,
typedef enum wh_tel_format { WH_TEL_FORMAT_ROWS(WH_TEL_NAME) WH_TEL_FORMATS } wh_tel_format;
#undef WH_TEL_NAME

/* All zeros turn telemetry off. Large members come last, because small offsets make shorter code. */
typedef struct wh_tel {
    bool reads; /* the capture is being sent; read_at is the number of steps sent so far */
    uint16_t sequence[WH_TEL_CHANNELS];
    uint16_t dropped[WH_TEL_CHANNELS]; /* lost lines of text count as frames of WH_TEL_RUN */
    unsigned read_at;
    uint32_t read_ticks;
    uint32_t every; /* one of this many samples is sent; 0: telemetry is off */
    uint32_t passed;
    wh_tel_format format;
    unsigned samples; /* number of samples in the frame in progress */
    uint32_t first_ticks;
    int16_t load[WH_TEL_SAMPLES];
    unsigned stage; /* the stage that was reported last */
    unsigned trip;
    uint8_t line[WH_TEL_FIXED_BYTES + WH_TEL_PAYLOAD_MOST]; /* buffer of one encoded frame */
    wh_capture capture;
} wh_tel;

/* Returns the right shift that makes the cell's counts fit into 16 bits. */
unsigned wh_tel_shift(const wh_cell_config *cell);

/* Call this after each control step. A call handles at most three events, two samples and one frame of the capture.
 * It puts frames into `out`, and fills at most half of it. */
void wh_tel_step(wh_tel *tel, const wh_rig_config *config, const wh_rig *rig,
                 const wh_step_inputs *seen, wh_ring *out);

/* === the console's command `tel` ============================================================= */

/* Executes `tel`, with the subcommand in words->word[1]. Adds to *answer, or returns the error. */
wh_station_error wh_tel_answer(wh_tel *tel, const wh_cell_config *cell, const wh_words *words,
                               wh_text *answer);

#endif
