/* engine_float.c: the interpreter in the boards' arithmetic. */
#define WH_DOUBLE 0
#include "engine.inc"

uint32_t engine_phase_of_constant(double rad) {
    return (uint32_t)(uint64_t)engine_angle_of_start(rad);
}

int64_t engine_angle_of_start(double rad) {
    const double turns = rad / 6.283185307179586477;
    return engine_angle_is_held(rad) ? (int64_t)llround(turns * 4294967296.0) : 0;
}

bool engine_angle_is_held(double rad) { return fabs(rad) < ENGINE_ANGLE_MOST_RAD; }
