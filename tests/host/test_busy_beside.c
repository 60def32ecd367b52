/* test_busy_beside.c: contacts that are too busy for a step which is too coarse for a spring or a damper beside them, too: whatever a warning
 * says would do does, of all that was told. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"
#include "rattle.h"
#include "unity.h"

void suite_busy_beside(void);

static void say(const char *text, const char *step, said *what) {
    const char *words[] = {model_keep(text),
                           "--quiet",
                           "--number",
                           "double",
                           step != NULL ? "--step" : NULL,
                           step,
                           NULL};
    command_say(command_run, words, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what->err), what->status, text);
}

static void test_a_cure_is_one_of_all(void) {
    dice d = dice_of("busy beside", 15005);
    const unsigned cases = dice_cases(few_or_all(usual_or(80, 12), 300));
    unsigned energies = 0;
    unsigned both = 0;
    unsigned cured = 0;
    for (unsigned i = 0; i < cases; i++) {
        const bool damped =
            i % 2 == 1; /* what is agreed on may leave most of a damper's loss over */
        const rattle r = rattle_drawn(&d, damped ? HOLD : (rattle_kind)(i / 2 % KINDS));
        const double rate_radps =
            pow(10.0, damped ? dice_between(&d, -0.1, 0.4) : dice_between(&d, -0.8, 0.1)) /
            r.step_s;
        const double speed = r.kind == BALL ? fabs(r.speed_mps) : r.number[r.kind == HOLD ? 0 : 1];
        const double size_m = speed / rate_radps * pow(10.0, dice_between(&d, -0.5, 3.0));
        char text[LINKAGE_TEXT];
        said what;
        rattle_write_beside(&r, damped, rate_radps, size_m, text);
        say(text, NULL, &what);
        const bool energy = strstr(what.err, "cannot be believed") != NULL;
        energies += energy ? 1U : 0U;
        both += energy && strstr(what.err, "[events]") != NULL ? 1U : 0U;
        for (const char *at = what.err; (at = strstr(at, "--step ")) != NULL; at++) {
            char step[40];
            if (sscanf(at, "--step %39s", step) == 1 &&
                strncmp(at + strlen("--step ") + strlen(step), " would do", 9) == 0) {
                said then;
                say(text, step, &then);
                cured++;
                if (then.err[0] != '\0') {
                    printf("%s%s# and with %s: %s\n", text, what.err, step, then.err);
                }
                TEST_ASSERT_EQUAL_STRING("", then.err);
            }
        }
    }
    model_drop();
    printf(
        "  %u rattles beside a spring or a damper: %u told of their energy, %u of both; %u cures, all silent\n",
        cases, energies, both, cured);
    TEST_ASSERT_TRUE(energies > cases / 4 && cured > cases / 4 && (both > 0 || cases < 30));
}

void suite_busy_beside(void) { RUN_TEST(test_a_cure_is_one_of_all); }
