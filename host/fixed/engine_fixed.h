/* engine_fixed.h: the interpreter of a scene in fixed point, with the arithmetic of core/fixed.h. */
#ifndef FIXED_ENGINE_FIXED_H
#define FIXED_ENGINE_FIXED_H

#include "host/engine/engine.h"

extern const engine_kind engine_fixed;

#endif
