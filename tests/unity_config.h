/* unity_config.h: how Unity is built, on the PC and on boards (UNITY_INCLUDE_CONFIG_H).
 *
 * Boards compile without a hosted C library: no libm and no double; results go out by hal_console_write(). Only the
 * jump out of a failed test is from the C library. Unity declares that its failure functions never return. Without
 * the jump, a failed assertion would run on into the code that follows in flash. */
#ifndef WH_UNITY_CONFIG_H
#define WH_UNITY_CONFIG_H

#define UNITY_SUPPORT_64

#if __STDC_HOSTED__
#define UNITY_INCLUDE_DOUBLE
#else
#include "boards/board.h"
#define UNITY_EXCLUDE_MATH_H
#define UNITY_EXCLUDE_DOUBLE
#define UNITY_OUTPUT_CHAR(character) \
    do { \
        const char byte = (char)(character); \
        hal_console_write(&byte, 1); \
    } while (0)
#endif

#endif
