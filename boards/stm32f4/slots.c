/* slots.c: the slot sensors on two inputs of timer 2, which stores the time of an edge in hardware (RM0090, 18.3.5),
 * after a filter of 12 us. Both channels of a pair (1 and 2, or 3 and 4) can capture the same input (18.3.6). One gets
 * a sensor's rising edges, the other its falling edges, so the end of a pulse never overwrites its begin. */
#include "hal/slots.h"

#include "ring.h"
#include "stm32f4.h"

#define TIM2_IRQ 28U
#define TIM2_FUNCTION 1U

#define ALL (TIM_SR_CCIF(1U) | TIM_SR_CCIF(2U) | TIM_SR_CCIF(3U) | TIM_SR_CCIF(4U))
#define OVERRUNS (ALL << 8)

#define EDGES_KEPT 16U

static hal_slot_edge kept_edges[EDGES_KEPT];
static stm32f4_ring_counts edge_counts;
static const stm32f4_ring edges = {&edge_counts, kept_edges, EDGES_KEPT, sizeof *kept_edges};
static volatile uint32_t overruns;

/* Stores an edge. If the ring is full after the store, counts an overrun and returns false. */
static bool keep_edge(const hal_slot_edge *edge) {
    if (stm32f4_ring_put(&edges, edge) && stm32f4_ring_has_room(&edges)) {
        return true;
    }
    overruns++;
    return false;
}

static const uint8_t pins[2] = {BOARD_SLOT_PINS};
static const uint8_t inputs[2] = {BOARD_SLOT_CHANNELS};

#define OTHER_PAIRS(one, two) (((one)-1U) / 2U != ((two)-1U) / 2U)
#define IN_OTHER_PAIRS(...) OTHER_PAIRS(__VA_ARGS__)
_Static_assert(IN_OTHER_PAIRS(BOARD_SLOT_CHANNELS), "each sensor takes a pair of channels");

static unsigned channel_of(unsigned sensor, hal_slot_end end) {
    return ((inputs[sensor] - 1U) ^ (unsigned)end) + 1U;
}

static void capture(unsigned channel, uint32_t mode, uint32_t edge) {
    stm32f4_field(TIM_CCMR(TIM2, (channel - 1U) / 2U), 8U, (channel - 1U) % 2U, mode);
    reg_set(TIM_CCER(TIM2), TIM_CCER_CCE(channel) | edge);
}

void stm32f4_slots_start(void) {
    for (unsigned sensor = 0; sensor < 2; sensor++) {
        const unsigned falling = channel_of(sensor, HAL_SLOT_TRAILING);
        stm32f4_pin_is(pins[sensor], PIN_ALTERNATE(TIM2_FUNCTION) | PULL_DOWN);
        capture(inputs[sensor], TIM_CCMR_CAPTURE | TIM_CCMR_FILTER_SLOWEST, 0);
        capture(falling, TIM_CCMR_CAPTURE_OTHER, TIM_CCER_CCP(falling));
    }
    reg_store(TIM_SR(TIM2), 0);
    reg_store(TIM_DIER(TIM2), ALL);
    stm32f4_interrupt(TIM2_IRQ);
}

/* Stores the captured edges in the order of their times. */
void on_tim2(void) {
    const uint32_t status = reg_load(TIM_SR(TIM2));
    hal_slot_edge seen[4];
    unsigned count = 0;
    for (uint8_t i = 0; i < 4; i++) {
        const unsigned channel = channel_of(i / 2U, (hal_slot_end)(i % 2U));
        if ((status & TIM_SR_CCIF(channel)) != 0) {
            const hal_slot_edge one = {reg_load(TIM_CCR(TIM2, channel)), i / 2U, i % 2U};
            unsigned at = count++;
            for (; at > 0 && (int32_t)(one.ticks - seen[at - 1U].ticks) < 0; at--) {
                seen[at] = seen[at - 1U];
            }
            seen[at] = one;
        }
    }
    const uint32_t overrun = status & OVERRUNS;
    if (overrun != 0) {
        reg_store(TIM_SR(TIM2), ~overrun);
        overruns++;
    }
    bool room = true;
    for (unsigned n = 0; n < count; n++) {
        room = keep_edge(&seen[n]);
    }
    if (!room) {
        reg_store(TIM_DIER(TIM2), 0);
    }
}

/* Restarts a paused capture. Before that, old times in the capture registers are dropped. */
bool hal_slots_take(hal_slot_edge *edge) {
    const bool there = stm32f4_ring_take(&edges, edge);
    if (there && reg_load(TIM_DIER(TIM2)) == 0) {
        for (unsigned channel = 1; channel <= 4; channel++) {
            (void)reg_load(TIM_CCR(TIM2, channel));
        }
        reg_store(TIM_SR(TIM2), 0);
        reg_store(TIM_DIER(TIM2), ALL);
    }
    return there;
}

uint32_t hal_slots_overruns(void) { return overruns; }
