/* pil_cart.c: a controller that holds a rod upright on a cart (docs/plants/cart.whirl), for `whirl pil`. It reads two
 * encoders every millisecond and a light barrier in the middle of the rail. The force is a weighted sum of angle,
 * position and their smoothed rates. The weights put the linear system's poles at -6, -6, -2 and -2 per second
 * (docs/pil.md). Exit status 0: after ten seconds the rod is upright in the middle; 1: it is not; 2: no plant. */
#include "boards/board.h"
#include "core/text.h"
#include "hal/pil/turns.h"

#define TICKS_PER_S 1000000U
#define PERIOD_TICKS 1000U
#define RUN_PERIODS 10000U
#define SMOOTH 0.1f /* weight of the newest rate in the smoothed rate */
#define PERIODS_PER_S 1000.0f

#define RAD_PER_COUNT (6.2831853f / 8192.0f)
#define M_PER_COUNT 1e-5f
#define PUSH_MAX_N 20.0f
#define BARRIER_M 0.005f
#define UPRIGHT_RAD 0.02f /* below this angle the rod is upright */
#define MIDDLE_M 0.03f

/* gains of the force, in N/rad, N s/rad, N/m, N s/m */
#define GAIN_ANGLE 20.725f
#define GAIN_ANGLE_RATE 3.281f
#define GAIN_PLACE 2.2026f
#define GAIN_PLACE_RATE 2.9368f

enum { PUSH = 0, ANGLE = 0, PLACE = 1 };

static const wh_signal signals[] = {
    {.kind = WH_SIGNAL_OUTPUT, .name = "push", .unit = "N", .low = -PUSH_MAX_N, .high = PUSH_MAX_N},
    {.kind = WH_SIGNAL_SAMPLE,
     .name = "theta",
     .unit = "rad",
     .low = -3.0f,
     .high = 3.0f,
     .per_count = RAD_PER_COUNT,
     .period_ticks = PERIOD_TICKS},
    {.kind = WH_SIGNAL_SAMPLE,
     .name = "x",
     .unit = "m",
     .low = -1.0f,
     .high = 1.0f,
     .per_count = M_PER_COUNT,
     .period_ticks = PERIOD_TICKS},
    {.kind = WH_SIGNAL_EDGE, .name = "x", .unit = "m", .low = -BARRIER_M, .high = BARRIER_M},
};

static hal_turns plant;

/* An encoder's value and its rate. */
typedef struct motion {
    float value;
    float rate; /* change per second */
    int32_t raw;
    bool known;
} motion;

static void see(motion *m, int32_t raw, float per_count) {
    if (m->known) {
        const float rate = (float)(raw - m->raw) * per_count * PERIODS_PER_S;
        m->rate += SMOOTH * (rate - m->rate);
    }
    m->value = (float)raw * per_count;
    m->raw = raw;
    m->known = true;
}

static void put_value(const char *name, float value, unsigned decimals, const char *unit) {
    char bytes[64];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, name);
    wh_text_add_fixed(&text, value, decimals);
    wh_text_add(&text, unit);
    hal_console_write(text.bytes, text.length);
}

static float size_of(float value) { return value < 0.0f ? -value : value; }

int main(void) {
    const wh_hello hello = {.program = "cart",
                            .ticks_per_s = TICKS_PER_S,
                            .signal = signals,
                            .signals = sizeof signals / sizeof signals[0]};
    motion motion_of[2] = {{.known = false}, {.known = false}};
    unsigned passings = 0;
    board_start();
    if (!hal_turns_start(&plant, &hello)) {
        board_exit(2);
    }
    for (uint32_t period = 1; period <= RUN_PERIODS; period++) {
        hal_turns_wait(&plant, period * PERIOD_TICKS);
        wh_edge edge;
        while (hal_turns_take_edge(&plant, &edge)) {
            passings++;
        }
        wh_sample sample;
        while (hal_turns_take_sample(&plant, &sample)) {
            see(&motion_of[sample.channel == ANGLE ? ANGLE : PLACE], sample.raw,
                sample.channel == ANGLE ? RAD_PER_COUNT : M_PER_COUNT);
        }
        hal_turns_set(
            &plant, PUSH,
            GAIN_ANGLE * motion_of[ANGLE].value + GAIN_ANGLE_RATE * motion_of[ANGLE].rate +
                GAIN_PLACE * motion_of[PLACE].value + GAIN_PLACE_RATE * motion_of[PLACE].rate);
    }
    const bool stands =
        size_of(motion_of[ANGLE].value) < UPRIGHT_RAD && size_of(motion_of[PLACE].value) < MIDDLE_M;
    put_value("rod  ", motion_of[ANGLE].value, 4, " rad from upright\n");
    put_value("cart ", motion_of[PLACE].value, 4, " m from the middle\n");
    put_value("came to the barrier ", (float)passings, 0, " times\n");
    board_exit(stands ? 0 : 1);
}
