/* test_mistyped.c: if a name of any kind, at any place, is mistyped, the message must suggest the declared name. */
#include "command.h"
#include "host/cli/commands.h"

enum { NAMES = 4 };

TEST(mistyped, coordinates) {
    static const char *const names[NAMES] = {"alpha", "bravo", "charlie", "delta"};
    static const char *const typed[NAMES] = {"alphb", "bravi", "charlle", "delto"};
    for (int k = 0; k < NAMES; k++) {
        for (int first = 0; first < NAMES; first++) {
            char text[600];
            char hint[60];
            char place[20];
            said what;
            size_t at = (size_t)snprintf(text, sizeof text, "mechanism m\n");
            for (int i = 0; i < NAMES; i++) {
                at += (size_t)snprintf(text + at, sizeof text - at, "coordinate %s [m]\n",
                                       names[(first + i) % NAMES]);
            }
            snprintf(text + at, sizeof text - at, "T = 1 [kg]*alpha'^2/2\nQ(%s) = 1 [N]\n",
                     typed[k]);
            COMMAND_SAY(command_derive, &what, model_keep(text));
            snprintf(hint, sizeof hint, "did you mean '%s'?", names[k]);
            snprintf(place, sizeof place, ":%d:3: error: ", NAMES + 3);
            TEST_ASSERT_EQUAL_INT(2, what.status);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, place), what.err);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, hint), what.err);
        }
    }
    model_drop();
}
