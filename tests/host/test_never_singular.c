/* test_never_singular.c: a mass matrix that is the same everywhere has no singular position, however large and small its masses
 * are, however fast its motions and dampers for the step: nothing that is said of such a run says so. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/cli/commands.h"

#include "unity.h"

void suite_never_singular(void);

/* Two or three bodies in a row, each counted from the ground or from the one before. */
static void write_bodies(dice *d, char *text, size_t size) {
    static const char *const names[] = {"x", "y", "z"};
    const unsigned bodies = 2U + dice_one_of(d, 2);
    const double step_s = pow(10.0, dice_between(d, -4.0, 0.0));
    char rate[80] = "";
    char coordinates[80] = "";
    char kinetic[400] = "";
    char stored[300] = "";
    char lost[300] = "";
    double fastest = 0.0;
    for (unsigned i = 0; i < bodies; i++) {
        char own[8];
        const double mass_kg = pow(10.0, dice_between(d, -7.0, 7.0));
        const double stiffness_Npm = mass_kg * pow(10.0, dice_between(d, -1.0, 6.0));
        const char *plus = i > 0 ? " + " : "";
        fastest = fmax(fastest, sqrt(stiffness_Npm / mass_kg));
        snprintf(own, sizeof own, "%s'", names[i]);
        if (i > 0 && dice_one_of(d, 2) == 0) {
            strcat(strcat(rate, " + "), own);
        } else {
            strcpy(rate, own);
        }
        sprintf(coordinates + strlen(coordinates), "coordinate %s [m]\n", names[i]);
        sprintf(kinetic + strlen(kinetic), "%s%.9g [kg]*(%s)^2/2", plus, mass_kg, rate);
        sprintf(stored + strlen(stored), "%s%.9g [N/m]*%s^2/2", plus, stiffness_Npm, names[i]);
        sprintf(lost + strlen(lost), "%s%.9g [N*s/m]*%s'^2/2", plus,
                dice_one_of(d, 2) * mass_kg * pow(10.0, dice_between(d, -1.0, 2.0)) / step_s,
                names[i]);
    }
    snprintf(text, size,
             "mechanism bodies\n%sT = %s\nV = %s\nF = %s\nscene s { start x = %.9g [m], x' = %.9g "
             "[m/s]\nstep %.9g [s]\nuntil %.9g [s] }\n",
             coordinates, kinetic, stored, lost, dice_between(d, -1.0, 1.0),
             fastest * dice_between(d, -1.0, 1.0), step_s, 50.0 * step_s);
}

static void test_of_the_same_mass_everywhere(void) {
    static const char *const methods[] = {"rk4", "heun", "euler", "semi-implicit-euler", "rk38"};
    dice d = dice_of("never singular", 20261129);
    const unsigned cases = dice_cases(few_or_all(usual_or(30, 15), 400));
    unsigned told = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[1600];
        said what;
        write_bodies(&d, text, sizeof text);
        const char *words[] = {model_keep(text),
                               "--quiet",
                               "--method",
                               methods[dice_one_of(&d, 5)],
                               "--number",
                               dice_one_of(&d, 2) == 0 ? "float" : "double",
                               NULL};
        command_say(command_run, words, &what);
        char about[SAID_SIZE + 1600];
        snprintf(about, sizeof about, "%s %s\n%s%s", words[3], words[5], text, what.err);
        TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "coordinates are singular"), about);
        told += what.err[0] != '\0';
    }
    model_drop();
    printf("  %u rows of bodies, something is said of %u\n", cases, told);
    TEST_ASSERT_TRUE(told > cases / 4);
}

void suite_never_singular(void) { RUN_TEST(test_of_the_same_mass_everywhere); }
