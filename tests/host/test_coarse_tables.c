/* test_coarse_tables.c: random slider-cranks whose coarse tables make them lose energy. The warning must name the
 * tables. More cells must remove the loss, and a smaller step must not. */
#include "command.h"
#include "host/cli/commands.h"
#include "host/image/image.h"

static void run(const char *text, const char *form, int cells, const char *step, said *what) {
    char count[20];
    snprintf(count, sizeof count, "%d", cells);
    COMMAND_SAY(command_run, what, model_keep(text), "--tables", form, "--cells", count, "--step",
                step, "--quiet");
}

TEST(coarse_tables, more_cells_end_the_warning) {
    dice d = dice_of("coarse tables", 14006);
    const unsigned cases = dice_cases(few_or_all(usual_or(2, 1), 40));
    unsigned told = 0;
    for (unsigned i = 0; i < cases; i++) {
        const bool cubic = dice_one_of(&d, 2) != 0;
        const char *form = cubic ? "cubic" : "linear";
        const int cells = cubic ? 8 : 16;
        char text[700];
        said what;
        snprintf(text, sizeof text,
                 "mechanism crank\ncoordinate a [rad]\nparameter r = 5 [cm]\n"
                 "parameter l = %.4f [cm]\n"
                 "let s = r*cos(a) + sqrt(l^2 - r^2*sin(a)^2)\n"
                 "let v = -r*sin(a)*a'*(1 + r*cos(a)/sqrt(l^2 - r^2*sin(a)^2))\n"
                 "T = %.4g [kg*m^2]*a'^2/2 + %.3f [kg]*v^2/2\nV = 300 [N/m]*(s - 6 [cm])^2/2\n"
                 "Q(a) = 0.1 [N*m]\n"
                 "scene s { start a = 0.4 [rad]; step 1 [ms]; until 3 [s] }\n",
                 dice_between(&d, 5.2, 6.0), dice_between(&d, 1e-3, 3e-3),
                 dice_between(&d, 0.3, 0.6));
        COMMAND_SAY(command_run, &what, model_keep(text), "--quiet");
        const bool is_fine = what.err[0] == '\0';
        run(text, form, cells, "1ms", &what);
        if (!is_fine || what.err[0] == '\0') {
            continue; /* skipped: the step alone is too coarse, or no energy is lost */
        }
        told++;
        char twice[60];
        snprintf(twice, sizeof twice, "try --cells %d, or no --tables:", 2 * cells);
        TEST_ASSERT_TRUE_MESSAGE(strstr(what.err, twice) != NULL, what.err);
        run(text, form, cells, "0.1ms", &what);
        TEST_ASSERT_TRUE_MESSAGE(strstr(what.err, twice) != NULL, text);
        run(text, form, IMAGE_CELLS_MOST, "30ms",
            &what); /* the step is too coarse, too, so more cells cannot help */
        TEST_ASSERT_TRUE_MESSAGE(strstr(what.err, "hint: try no --tables:") != NULL, what.err);
        run(text, form, cells * 128, "1ms", &what);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, text);
    }
    model_drop();
    printf("  %u of %u told\n", told, cases);
    TEST_ASSERT_TRUE(told > 0);
}
