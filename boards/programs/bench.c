/* bench.c: counts the instructions of single steps of every generated scene, on a board under the counting plugin or on
 * the PC under callgrind (count_rows.sh). The program prints the meaning of the counted intervals:
 *
 *     count NAME METHOD NUMBER FIRST LAST    each of the intervals FIRST to LAST has one step
 *     stack NAME BYTES                       deepest stack of the program during the counted steps
 *     silicon NAME MIN MEDIAN MAX            cycles of a step, if the board has a cycle counter (board.h)
 *     failed NAME STATUS                     the scene could not be counted
 *
 * NUMBER is float or double. If METHOD ends in "-multistep", each interval has STEPS_A_CALL steps. Interval 0 is empty.
 * On a board, an interval includes the call; callgrind counts only the called function. */
#include "boards/programs/counted.h"
#include "boards/programs/step_cycles.h"
#include "core/function.h"
#include "core/scene.h"

#define WARM_STEPS 20U
#ifndef COUNTED_STEPS
#define COUNTED_STEPS 100U
#endif
#ifndef BENCH_SMALL
#define BENCH_SMALL 0
#endif
#define STEPS_A_CALL 100U /* mk/count/figures.awk divides by the same number */
#define COUNTED_PAIRS 64U

static unsigned intervals;

void bench_pair(wh_phase phase, wh_real *pair);
wh_real bench_one(wh_real (*function)(wh_real x), wh_real x);
wh_real bench_two(wh_real (*function)(wh_real x, wh_real y), wh_real x, wh_real y);

__attribute__((noinline)) void bench_pair(wh_phase phase, wh_real *pair) {
    wh_sincos(phase, &pair[0], &pair[1]);
}

__attribute__((noinline)) wh_real bench_one(wh_real (*function)(wh_real x), wh_real x) {
    return function(x);
}

__attribute__((noinline)) wh_real bench_two(wh_real (*function)(wh_real x, wh_real y), wh_real x,
                                            wh_real y) {
    return function(x, y);
}

static void say_stack(const char *name) {
    line_of("stack", name);
    line_number(board_stack_used_bytes());
    line_end();
}

static void say_failed(const char *name, wh_status status) {
    line_of("failed", name);
    line_word(wh_status_text(status));
    line_end();
}

static void count_nothing(void) {
    wh_count_begin();
    wh_count_end();
    intervals++;
}

static void count_pairs(void) {
    const unsigned first = intervals;
    for (unsigned i = 0; i < COUNTED_PAIRS; i++) {
        volatile wh_real out[2];
        wh_real pair[2];
        const wh_phase phase = wh_phase_from_rad((wh_real)i * WH_R(0.618034) - WH_R(20.0));
        wh_count_begin();
        bench_pair(phase, pair);
        wh_count_end();
        intervals++;
        out[0] = pair[0];
        out[1] = pair[1];
        (void)out;
    }
    say_counted("wh_sincos", "-", "", first, intervals - 1U);
}

#if !BENCH_SMALL
static const struct {
    const char *name;
    wh_real (*one)(wh_real x);
    wh_real (*two)(wh_real x, wh_real y);
    wh_real scale; /* the first argument is from offset - scale to offset + scale */
    wh_real offset;
} functions[] = {
    {"wh_exp", wh_exp, NULL, WH_R(20.0), WH_R(0.0)},
    {"wh_log", wh_log, NULL, WH_R(20.0), WH_R(20.01)},
    {"wh_tan", wh_tan, NULL, WH_R(20.0), WH_R(0.0)},
    {"wh_asin", wh_asin, NULL, WH_R(1.0), WH_R(0.0)},
    {"wh_acos", wh_acos, NULL, WH_R(1.0), WH_R(0.0)},
    {"wh_atan", wh_atan, NULL, WH_R(4.0), WH_R(0.0)},
    {"wh_atan2", NULL, wh_atan2, WH_R(4.0), WH_R(0.0)},
    {"wh_pow", NULL, wh_pow, WH_R(20.0), WH_R(20.01)},
    {"wh_sinh", wh_sinh, NULL, WH_R(4.0), WH_R(0.0)},
    {"wh_cosh", wh_cosh, NULL, WH_R(4.0), WH_R(0.0)},
    {"wh_tanh", wh_tanh, NULL, WH_R(4.0), WH_R(0.0)},
};
#define ONE_MORE(name) +1
_Static_assert(sizeof functions / sizeof functions[0] == 0 WH_FUNCTIONS(ONE_MORE, ONE_MORE),
               "every function of core/function.h is counted");

static void count_functions(void) {
    for (unsigned k = 0; k < sizeof functions / sizeof functions[0]; k++) {
        const unsigned first = intervals;
        for (unsigned i = 0; i < COUNTED_PAIRS; i++) {
            volatile wh_real out;
            wh_real result;
            const wh_real part = ((wh_real)i + WH_R(0.3)) * WH_R(0.03125) - WH_R(1.0);
            const wh_real x = part * functions[k].scale + functions[k].offset;
            const wh_real y = (wh_real)(i * 37U % COUNTED_PAIRS) * WH_R(0.0618034) - WH_R(2.0);
            wh_count_begin();
            if (functions[k].one != NULL) {
                result = bench_one(functions[k].one, x);
            } else {
                result = bench_two(functions[k].two, x, y);
            }
            wh_count_end();
            intervals++;
            out = result;
            (void)out;
        }
        say_counted(functions[k].name, "-", "", first, intervals - 1U);
    }
}

static void time_scene(const wh_scene *scene, wh_state *state) {
    static step_cycles cycles;
    step_cycles_start(&cycles);
    for (unsigned i = 0; i < COUNTED_STEPS; i++) {
        (void)step_counted(&cycles, scene, state, true);
    }
    line_of("silicon", scene->name);
    line_number(cycles.least);
    line_number(step_cycles_median(&cycles));
    line_number(cycles.most);
    line_end();
}
#endif

static wh_status count_multi_step(const wh_scene *scene, wh_state *state) {
    const unsigned first = intervals;
    wh_status status = WH_OK;
    for (unsigned i = 0; i < COUNTED_STEPS / STEPS_A_CALL + 1U && status == WH_OK; i++) {
        wh_count_begin();
        status = wh_scene_steps(scene, state, STEPS_A_CALL);
        wh_count_end();
        intervals++;
    }
    say_counted(scene->name, wh_methods[scene->method].word, "-multistep", first, intervals - 1U);
    return status;
}

static bool count_scene(const wh_scene *scene) {
    const char *sums = scene->compensated ? "-compensated" : "";
    wh_state state;
    wh_status status = wh_scene_start(scene, &state, memory, sizeof memory);
    for (unsigned i = 0; i < WARM_STEPS && status == WH_OK; i++) {
        status = wh_scene_step(scene, &state);
    }
    const unsigned first = intervals;
    board_stack_paint();
    for (unsigned i = 0; i < COUNTED_STEPS && status == WH_OK; i++) {
        wh_count_begin();
        status = wh_scene_step(scene, &state);
        wh_count_end();
        intervals++;
    }
    if (status == WH_OK) {
        say_stack(scene->name);
        say_counted(scene->name, wh_methods[scene->method].word, sums, first, intervals - 1U);
        status = scene->multi_step != NULL ? count_multi_step(scene, &state) : WH_OK;
    }
    if (status != WH_OK) {
        say_failed(scene->name, status);
        return false;
    }
#if !BENCH_SMALL
    if (board_cycles_start()) {
        time_scene(scene, &state);
    }
#endif
    return true;
}

int main(void) {
    board_start();
    count_nothing();
    count_pairs();
#if !BENCH_SMALL
    count_functions();
#endif
    bool all = true;
    for (unsigned i = 0; i < wh_scene_count; i++) {
        all = count_scene(wh_scenes[i]) && all;
    }
    return all ? 0 : 1;
}
