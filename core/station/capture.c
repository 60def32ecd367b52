/* capture.c: the control steps around a trigger. */
#include "capture.h"

#define HALF (WH_CAPTURE_STEPS / 2U)
#define PULSED 3U
#define TRIGGERED 4U
#define TRIPPED 8U

void wh_capture_start(wh_capture *capture, wh_capture_trigger trigger) {
    capture->trigger = trigger;
    capture->state = trigger == WH_CAPTURE_OFF ? WH_CAPTURE_NONE : WH_CAPTURE_WAITS;
    capture->left = HALF;
    capture->count = 0;
    capture->next = 0;
}

static bool triggers(const wh_capture *capture, uint8_t flags) {
    switch (capture->trigger) {
    case WH_CAPTURE_PULSE: return (flags & PULSED) != 0 && capture->count >= HALF;
    case WH_CAPTURE_FAULT: return (flags & TRIPPED) != 0;
    case WH_CAPTURE_OFF:
    case WH_CAPTURE_TRIGGERS: break;
    }
    return false;
}

void wh_capture_step(wh_capture *capture, const wh_captured *step, uint32_t now_ticks) {
    wh_captured *to = &capture->step[capture->next];
    if (capture->count == 0) {
        capture->first_ticks = now_ticks;
    } else if (capture->count == WH_CAPTURE_STEPS) { /* the oldest makes room */
        const uint16_t second = capture->step[(capture->next + 1U) % WH_CAPTURE_STEPS].ticks;
        capture->first_ticks += (uint16_t)(second - to->ticks);
    }
    *to = *step;
    if (capture->state == WH_CAPTURE_WAITS && triggers(capture, step->flags)) {
        capture->state = WH_CAPTURE_TRIGGERED;
        to->flags |= TRIGGERED;
    }
    capture->next = (capture->next + 1U) % WH_CAPTURE_STEPS;
    capture->count += capture->count < WH_CAPTURE_STEPS ? 1U : 0U;
    if (capture->state == WH_CAPTURE_TRIGGERED && --capture->left == 0) {
        capture->state = WH_CAPTURE_FULL;
    }
}

const wh_captured *wh_capture_at(const wh_capture *capture, unsigned i) {
    const unsigned oldest = capture->next + WH_CAPTURE_STEPS - capture->count;
    return &capture->step[(oldest + i) % WH_CAPTURE_STEPS];
}
