/* light_expect.h: what the record of a board's first light should have: the interpreter's runs of the scenes, and a board whose
 * crystal, sensors and stop line answer. */
#ifndef COMMANDS_LIGHT_EXPECT_H
#define COMMANDS_LIGHT_EXPECT_H

#include "host/monitor/light.h"

enum { LIGHT_EXPECTED = 100 };

/* Of each field; "": nothing. All zeros before light_expect(). */
typedef struct light_expected {
    char of[LIGHT_FIELDS][LIGHT_EXPECTED];
} light_expected;

/* The number of the field `name` + `more`, which there is. */
int light_field(const char *name, const char *more);

/* Runs the scenes. Returns an exit code. */
int light_expect(light_expected *e);

typedef enum light_verdict {
    LIGHT_EQUAL,
    LIGHT_DIFFERS,
    LIGHT_NONE, /* the board or emulator cannot give it */
    LIGHT_TOLD  /* nothing is expected */
} light_verdict;

light_verdict light_judge(int field, const char *value, const char *wanted);

#endif
