/* engine_fixed.h: the interpreter in fixed point: core/fixed.h's operations, one by one. */
#ifndef FIXED_ENGINE_FIXED_H
#define FIXED_ENGINE_FIXED_H

#include "host/engine/engine.h"

extern const engine_kind engine_fixed;

#endif
