/* console.h: a console for the suites of the station: typed lines and their answers. The suite defines period(). */
#ifndef TESTS_CORE_CONSOLE_H
#define TESTS_CORE_CONSOLE_H

#include <string.h>

#include "core/station/station.h"
#include "even_rig.h"
#include "unity.h"

#define STEPS_PER_S (WH_RIG_TICKS_PER_S / EVEN_STEP_TICKS)

static even_rig even;
static wh_station station;
static char heard[WH_STATION_OUT_BYTES + 1U];
static unsigned heard_length;

static void period(void); /* one control step of the rig and the station */

/* Starts a rig at rest, and a station that has neither received nor sent anything. */
static inline void console_begin(void) {
    even_start(&even);
    even_rest(&even);
    wh_station_start(&station, "rig", "here", STEPS_PER_S);
    heard_length = 0;
}

static inline void type(const char *line) {
    wh_station_take(&station, line, (unsigned)strlen(line));
}

/* Adds the waiting output to heard[], as much as there is room for. */
static inline void hear(void) {
    const unsigned count =
        wh_station_peek(&station, heard + heard_length, (unsigned)sizeof heard - 1U - heard_length);
    wh_station_drop(&station, count);
    heard_length += count;
    heard[heard_length] = '\0';
}

/* Types a line. Returns its answer, one line without its line end. */
static inline const char *ask(const char *line) {
    heard_length = 0;
    type(line);
    type("\n");
    for (unsigned i = 0; i < 3; i++) {
        period();
    }
    hear();
    TEST_ASSERT_TRUE(heard_length >= 4U);
    TEST_ASSERT_TRUE(heard[heard_length - 2U] == '\r' && heard[heard_length - 1U] == '\n');
    heard[heard_length - 2U] = '\0';
    TEST_ASSERT_TRUE(strchr(heard, '\n') == NULL);
    return heard;
}

static inline void check_begins(const char *with, const char *answer) {
    TEST_ASSERT_EQUAL_STRING_LEN(with, answer, strlen(with));
}

#endif
