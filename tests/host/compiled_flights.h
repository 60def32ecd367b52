/* compiled_flights.h: the calls of __aeabi_fmul, and of __aeabi_fadd and __aeabi_fsub, in what arm-none-eabi-gcc 12.2.1 -O2 makes
 * of a step of `cartesian_flight`, whose list computes nothing, for a Cortex-M3 (objdump -dr). */
#ifndef TESTS_HOST_COMPILED_FLIGHTS_H
#define TESTS_HOST_COMPILED_FLIGHTS_H

#include <stdbool.h>

#include "core/method.h"

typedef struct compiled_flight {
    wh_method method;
    bool compensated;
    double products;
    double sums;
} compiled_flight;

static const compiled_flight compiled_flights[] = {
    {WH_EULER, false, 6, 11},     {WH_SEMI_IMPLICIT_EULER, false, 6, 11},
    {WH_HEUN, false, 15, 23},     {WH_RK4, false, 18, 35},
    {WH_RK38, false, 24, 62},     {WH_NYSTROEM4, false, 18, 35},
    {WH_LEAPFROG, false, 12, 23}, {WH_EULER, true, 12, 41},
    {WH_HEUN, true, 24, 56},      {WH_RK4, true, 27, 68},
    {WH_LEAPFROG, true, 21, 56}};
enum { COMPILED_FLIGHTS = sizeof compiled_flights / sizeof compiled_flights[0] };

#endif
