/* telemetry.h: the rig's data, sample by sample, on the same line as the console's text.
 *
 * A frame before coding (core/cobs.h), with multi-byte numbers low byte first:
 *
 *     0x80 + channel 1 | sequence 2 | dropped 2 | ticks 4 | payload | CRC-16/CCITT 2
 *
 * On the line it stands between two zeros. Text has no zeros, and its second byte is below 0x80. So the second byte
 * between two zeros distinguishes frames from text, and text can be shown as it comes. `sequence` counts the channel's
 * frames, including those dropped here for lack of room; `dropped` counts the dropped ones. The rest of a gap in the
 * sequence was lost on the line. Both wrap.
 *
 * Channels describe themselves: WH_TEL_CHANNEL_ROWS, and `tel schema` at the console.
 *
 *   run    ten samples of the load, and speed, drive, state at the last of them. A frame has fewer if samples are late,
 *          bad or missing: their times are ticks + i periods within an eighth of a period
 *   event  one event, at `ticks`: a slot pulse, another state, a trip
 *   ring   the stored control steps around a trigger (capture.h), ten a frame
 *
 * It never waits and takes none of the console's room: frames without room of their own are dropped. Off at first. */
#ifndef WH_STATION_TELEMETRY_H
#define WH_STATION_TELEMETRY_H

#include "capture.h"
#include "ring.h"
#include "step_inputs.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_TEL_SAMPLES 10U
#define WH_TEL_HEAD_BYTES 9U
#define WH_TEL_FIXED_BYTES (WH_TEL_HEAD_BYTES + 5U) /* on the line: zeros, code, sum */
#define WH_TEL_PAYLOAD_MOST (WH_TEL_SAMPLES * WH_CAPTURE_BYTES)
#define WH_TEL_NO_LOAD (-32768) /* no good sample */
/* Text takes more room: the limit on samples a second. */
#define WH_TEL_TEXT_PER_S_MOST 100U

/* X(channel, number, name) */
#define WH_TEL_CHANNEL_ROWS(X) \
    X(WH_TEL_RUN, 0, "run") \
    X(WH_TEL_EVENT, 1, "event") \
    X(WH_TEL_RING, 2, "ring")

#define WH_TEL_NAME(channel, number, name) channel = (number),
typedef enum wh_tel_channel { WH_TEL_CHANNEL_ROWS(WH_TEL_NAME) WH_TEL_CHANNELS } wh_tel_channel;
#undef WH_TEL_NAME

/* Kinds of events. */
typedef enum wh_tel_event {
    WH_TEL_PULSE, /* value: the sensor, 0 or 1 */
    WH_TEL_STATE, /* wh_rig_shown_stage() */
    WH_TEL_TRIP,  /* a wh_trip */
    WH_TEL_END    /* of a pulse; WH_TEL_PULSE is its beginning */
} wh_tel_event;

/* X(format, word) */
#define WH_TEL_FORMAT_ROWS(X) \
    X(WH_TEL_FRAMES, "frames") \
    X(WH_TEL_TELEPLOT, "teleplot") /* >name:value */ \
    X(WH_TEL_ARDUINO, "arduino")   /* name:value,name:value */

#define WH_TEL_NAME(format, word) format,
typedef enum wh_tel_format { WH_TEL_FORMAT_ROWS(WH_TEL_NAME) WH_TEL_FORMATS } wh_tel_format;
#undef WH_TEL_NAME

/* All zeros: off. Large members come last: instructions for near ones are shorter. */
typedef struct wh_tel {
    bool reads; /* the ring is being sent, from: */
    uint16_t sequence[WH_TEL_CHANNELS];
    uint16_t dropped[WH_TEL_CHANNELS]; /* of text: of WH_TEL_RUN */
    unsigned read_at;
    uint32_t read_ticks;
    uint32_t every; /* cell samples for each one here; 0: off */
    uint32_t passed;
    wh_tel_format format;
    unsigned samples; /* of the frame in progress: */
    uint32_t first_ticks;
    int16_t load[WH_TEL_SAMPLES];
    unsigned stage; /* as last reported */
    unsigned trip;
    uint8_t line[WH_TEL_FIXED_BYTES + WH_TEL_PAYLOAD_MOST]; /* a frame, as sent */
    wh_capture capture;
} wh_tel;

#define wh_tel_shift WH_NAME(wh_tel_shift)
#define wh_tel_rate WH_NAME(wh_tel_rate)
#define wh_tel_read WH_NAME(wh_tel_read)
#define wh_tel_step WH_NAME(wh_tel_step)

/* Shift that makes the cell's counts fit 16 bits. */
unsigned wh_tel_shift(const wh_cell_config *cell);

/* From now on send every `every`-th sample of the cell; 0: off. */
void wh_tel_rate(wh_tel *tel, uint32_t every);

/* Send the ring's frames from its begin. False: it is not full yet. */
bool wh_tel_read(wh_tel *tel);

/* After each control step: at most the work of its pulse and two samples, or of one frame of the ring. Bytes to send go
 * into `out`, half of which belongs to others. */
void wh_tel_step(wh_tel *tel, const wh_rig_config *config, const wh_rig *rig,
                 const wh_step_inputs *seen, wh_ring *out);

#ifdef __cplusplus
}
#endif

#endif
