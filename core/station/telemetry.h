/* telemetry.h: what the rig does, sample by sample, beside the console's text on the same line.
 *
 * A frame is, before it is coded (core/cobs.h), with numbers of several bytes low byte first:
 *
 *     0x80 + channel 1 | sequence 2 | dropped 2 | ticks 4 | payload | CRC-16/CCITT 2
 *
 * and on the line it stands between two zeros. Text has no zero, and its second byte is no 0x80 or more: whoever looks at
 * what stands between two zeros knows by its second byte what it is, and text can be shown as it comes. `sequence` is the
 * channel's and counts also frames that are dropped here, for want of room; `dropped` counts the channel's that were, so
 * what a gap in the sequence has more was lost on the way. Both wrap.
 *
 * Channels describe themselves: WH_TEL_CHANNEL_ROWS, and `tel schema` at the console.
 *
 *   run    ten samples of the load, and speed, drive, state at the last of them. A frame has less where samples are late,
 *          bad or missing: their times are ticks + i periods within an eighth of a period
 *   event  one thing that happened, at `ticks`: a slot pulse, another state, a trip
 *   ring   what was kept of the control steps round a trigger (capture.h), ten a frame
 *
 * It waits for nobody and takes none of the console's room: frames that find none in theirs are dropped. Off at first. */
#ifndef WH_STATION_TELEMETRY_H
#define WH_STATION_TELEMETRY_H

#include "capture.h"
#include "ring.h"
#include "seen.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_TEL_SAMPLES 10U
#define WH_TEL_HEAD_BYTES 9U
#define WH_TEL_FIXED_BYTES (WH_TEL_HEAD_BYTES + 5U) /* on the line: zeros, code, sum */
#define WH_TEL_PAYLOAD_MOST (WH_TEL_SAMPLES * WH_CAPTURE_BYTES)
#define WH_TEL_NO_LOAD (-32768) /* there was no good sample */
/* Text takes more room: no more samples a second. */
#define WH_TEL_TEXT_PER_S_MOST 100U

/* X(channel, number, name) */
#define WH_TEL_CHANNEL_ROWS(X) \
    X(WH_TEL_RUN, 0, "run") \
    X(WH_TEL_EVENT, 1, "event") \
    X(WH_TEL_RING, 2, "ring")

#define WH_TEL_NAME(channel, number, name) channel = (number),
typedef enum wh_tel_channel { WH_TEL_CHANNEL_ROWS(WH_TEL_NAME) WH_TEL_CHANNELS } wh_tel_channel;
#undef WH_TEL_NAME

/* What an event is of. */
typedef enum wh_tel_event {
    WH_TEL_PULSE, /* value: the sensor, 0 or 1 */
    WH_TEL_STATE, /* wh_rig_shown_stage() */
    WH_TEL_TRIP,  /* a wh_trip */
    WH_TEL_END    /* of a pulse, as WH_TEL_PULSE has its beginning */
} wh_tel_event;

/* X(format, word) */
#define WH_TEL_FORMAT_ROWS(X) \
    X(WH_TEL_FRAMES, "frames") \
    X(WH_TEL_TELEPLOT, "teleplot") /* >name:value */ \
    X(WH_TEL_ARDUINO, "arduino")   /* name:value,name:value */

#define WH_TEL_NAME(format, word) format,
typedef enum wh_tel_format { WH_TEL_FORMAT_ROWS(WH_TEL_NAME) WH_TEL_FORMATS } wh_tel_format;
#undef WH_TEL_NAME

/* All zeros: off. What is large comes last: what is near has shorter instructions. */
typedef struct wh_tel {
    bool reads; /* the ring goes out, from: */
    uint16_t sequence[WH_TEL_CHANNELS];
    uint16_t dropped[WH_TEL_CHANNELS]; /* of text: of WH_TEL_RUN */
    unsigned read_at;
    uint32_t read_ticks;
    uint32_t every; /* so many samples of the cell for one of these; 0: off */
    uint32_t passed;
    wh_tel_format format;
    unsigned samples; /* of the frame that is under way: */
    uint32_t first_ticks;
    int16_t load[WH_TEL_SAMPLES];
    unsigned stage; /* as last told */
    unsigned trip;
    uint8_t line[WH_TEL_FIXED_BYTES + WH_TEL_PAYLOAD_MOST]; /* a frame, as it goes out */
    wh_capture capture;
} wh_tel;

#define wh_tel_shift WH_NAME(wh_tel_shift)
#define wh_tel_rate WH_NAME(wh_tel_rate)
#define wh_tel_read WH_NAME(wh_tel_read)
#define wh_tel_step WH_NAME(wh_tel_step)

/* The cell's counts in 16 bits: shifted by so many. */
unsigned wh_tel_shift(const wh_cell_config *cell);

/* From now on each so many-th of the cell's samples; 0: off. */
void wh_tel_rate(wh_tel *tel, uint32_t every);

/* The ring's frames are to go out, from its begin. False: it is not full yet. */
bool wh_tel_read(wh_tel *tel);

/* After each control step: at most its pulse's and two samples' work, or a frame's of the ring. What wants out goes into
 * `out`, of which half are not its own. */
void wh_tel_step(wh_tel *tel, const wh_rig_config *config, const wh_rig *rig, const wh_seen *seen,
                 wh_ring *out);

#ifdef __cplusplus
}
#endif

#endif
