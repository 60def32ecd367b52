/* engine_float.c: the interpreter in the boards' arithmetic. */
#define WH_DOUBLE 0
#include "engine.inc"
