/* test_crossings.c: several crossings, each with assignments of its own: each does its own ones, and in its own time. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "derived.h"
#include "motion.h"

#include "unity.h"

void suite_crossings(void);

/* x moves on at 1 m/s and crosses a level a second; each crossing gives some of y, z, u other rates. */
static void test_each_crossing_sets_its_own(void) {
    static const char *const others[] = {"y", "z", "u"};
    uint64_t seed = 47;
    for (int round = 0; round < 40; round++) {
        const int levels = 2 + round % 4;
        char text[2048];
        size_t length = (size_t)snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate z [m]\ncoordinate u [m]\n"
            "T = 1 [kg]*(x'^2 + y'^2 + z'^2 + u'^2)/2\n"
            "scene s {\nstep 10 [ms]\nuntil 10 [s]\nstart x' = 1 [m/s]\n");
        double rate[3] = {0.0};
        double rates[6][3]; /* after so many levels */
        memcpy(rates[0], rate, sizeof rate);
        for (int level = 0; level < levels; level++) {
            length += (size_t)snprintf(text + length, sizeof text - length,
                                       "when x crosses %d.505 [m] rising { set", level);
            const unsigned which = 1 + (unsigned)(random_bits(&seed) % 7);
            bool first = true;
            for (unsigned k = 0; k < 3; k++) {
                if ((which >> k & 1U) != 0) {
                    rate[k] = (double)(random_bits(&seed) % 17) / 4.0 - 2.0;
                    length +=
                        (size_t)snprintf(text + length, sizeof text - length, "%s %s' = %g [m/s]",
                                         first ? "" : ",", others[k], rate[k]);
                    first = false;
                }
            }
            length += (size_t)snprintf(text + length, sizeof text - length, " }\n");
            memcpy(rates[level + 1], rate, sizeof rate);
        }
        snprintf(text + length, sizeof text - length, "}\n");
        motion m;
        motion_open_text(&m, text, IN_DOUBLE);
        double moved[3] = {0.0};
        for (int level = 0; level <= levels; level++) {
            motion_to(&m, level);
            for (int k = 0; k < 3; k++) {
                char name[8];
                snprintf(name, sizeof name, "%s'", others[k]);
                TEST_ASSERT_DOUBLE_WITHIN(1e-12, rates[level][k], motion_value(&m, name));
                moved[k] +=
                    level == 0 ? 0.0 : 0.505 * rates[level - 1][k] + 0.495 * rates[level][k];
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, moved[k], motion_value(&m, others[k]));
            }
        }
        motion_close(&m);
    }
}

void suite_crossings(void) { RUN_TEST(test_each_crossing_sets_its_own); }
