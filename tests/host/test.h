/* test.h: the C library with POSIX, Unity, and TEST(). Every suite of the host includes this file first. */
#ifndef TESTS_HOST_TEST_H
#define TESTS_HOST_TEST_H

#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif

#include <ctype.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/suites.h"

#endif
