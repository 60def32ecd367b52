/* test_flat_linkages.c: when a linkage lies flat, the run must end and name the redundant hold, whatever the sequence
 * of the file's statements. */
#include "command.h"
#include "host/cli/commands.h"

enum { STOPS = 3, FLAT_TEXT = 2048 };

/* The text of the file so far, and its number of lines. */
typedef struct writing {
    char text[FLAT_TEXT];
    size_t length;
    int lines;
} writing;

static int add_line(writing *w, const char *line) {
    w->length += (size_t)snprintf(w->text + w->length, sizeof w->text - w->length, "%s\n", line);
    TEST_ASSERT_TRUE(w->length < sizeof w->text);
    return ++w->lines;
}

static void add_stops(writing *w, int count) {
    for (int i = 0; i < count; i++) {
        char line[80];
        snprintf(line, sizeof line, "stop d + %d [m] >= 0 [m] restitution 0.5", 10 + i);
        add_line(w, line);
    }
}

/* A parallelogram becomes flat along the x axis. There, no angle changes a length along x, so the hold along x is
 * redundant. */
static void flat_is_named(int before, int behind, bool across_first, dice *d) {
    const double crank_m = dice_between(d, 0.05, 0.15);
    const double coupler_m = dice_between(d, 0.2, 0.4);
    const double rate_radps = dice_between(d, 3.0, 8.0);
    char along[160];
    char across[160];
    char line[200];
    writing w = {.lines = 0};
    said what;
    snprintf(along, sizeof along,
             "hold %.3f [m]*cos(a) + %.3f [m]*cos(b) - %.3f [m]*cos(c) while a > -9", crank_m,
             coupler_m, crank_m);
    snprintf(across, sizeof across,
             "hold %.3f [m]*sin(a) + %.3f [m]*sin(b) - %.3f [m]*sin(c) while a > -9", crank_m,
             coupler_m, crank_m);
    add_line(&w, "mechanism bars");
    add_line(&w, "coordinate a [rad]");
    add_line(&w, "coordinate b [rad]");
    add_line(&w, "coordinate c [rad]");
    add_line(&w, "coordinate d [m]");
    add_line(&w, "T = 0.1 [kg*m^2]*(a'^2 + b'^2/9 + c'^2/7)/2 + 1 [kg]*d'^2/2");
    add_stops(&w, before);
    int named = 0;
    for (int i = 0; i < 2; i++) {
        const bool is_across = (i == 0) == across_first;
        const int at = add_line(&w, is_across ? across : along);
        named = is_across ? named : at;
    }
    add_stops(&w, behind);
    add_line(&w, "scene s {");
    snprintf(line, sizeof line, "start a = 0.1, c = 0.1, a' = %.3f [rad/s], c' = %.3f [rad/s]",
             -rate_radps, -rate_radps);
    add_line(&w, line);
    add_line(&w, "step 1 [ms]");
    add_line(&w, "until 1 [s]");
    add_line(&w, "}");

    COMMAND_SAY(command_run, &what, model_keep(w.text), "--quiet");
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, w.text);
    snprintf(line, sizeof line, ":%d:1: error: ", named);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, line), what.err);
    snprintf(line, sizeof line, "because this hold follows from the others at this position: %s\n",
             along);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, line), what.err);
    model_drop();
}

TEST(flat_linkages, redundant_hold_is_named) {
    dice d = dice_of("flat_linkages", 26);
    for (int before = 0; before <= STOPS; before++) {
        for (int across_first = 0; across_first < 2; across_first++) {
            flat_is_named(before, (int)dice_one_of(&d, STOPS + 1), across_first != 0, &d);
        }
    }
}
