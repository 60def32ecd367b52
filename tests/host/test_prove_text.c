/* test_prove_text.c: reads back the text of `whirl prove` for random results (host/prove/containment.h). Numbers must
 * be rounded up, but not by much; the text must end with the right state; rows must be exact to the last bit. */
#include "drawn_image.h"
#include "host/base/alloc.h"
#include "host/prove/containment.h"
#include "test.h"

static dice die;
static drawn_image drawn;
static exact_state states[DRAWN_STATES];
static containment_state found_states[DRAWN_STATES];
static exact_motion of;
static containment_request request;
static containment_found found;

static double drawn_size(void) {
    return dice_one_of(&die, 8) == 0
               ? 0.0
               : dice_between(&die, 1.0, 10.0) * pow(10.0, dice_between(&die, -20.0, 3.0));
}

static void draw(void) {
    drawn_image_draw(&drawn, &die, MATRIX_NONE);
    drawn.im.settings.method = (wh_method)dice_one_of(&die, 2);
    of = (exact_motion){.states = 2 * drawn.im.count, .state = states};
    request = (containment_request){.motion = &of, .image = &drawn.im, .kind = &engine_float};
    found = (containment_found){.state = found_states,
                                .states = of.states,
                                .flowpipe_steps = dice_one_of(&die, 1000000),
                                .tube_s = dice_between(&die, 0.0, 30.0),
                                .end = (containment_end)dice_one_of(&die, CONTAINMENT_STOPPED + 1)};
    request.kind = dice_one_of(&die, 2) == 0 ? &engine_float : &engine_double;
    const unsigned likely = 1 + dice_one_of(&die, 4);
    for (int i = 0; i < of.states; i++) {
        containment_state *s = &found_states[i];
        states[i] = (exact_state){i / 2, i % 2};
        *s = (containment_state){
            .verdict = dice_one_of(&die, likely) == 0
                           ? CONTAINMENT_TO_THE_END
                           : (containment_verdict)dice_one_of(&die, CONTAINMENT_UNENDED + 1),
            .within = drawn_size(),
            .until_s = 0.001 * dice_one_of(&die, 20),
            .off = drawn_size(),
            .radius = drawn_size()};
        s->begun = s->verdict == CONTAINMENT_TO_THE_END || s->verdict == CONTAINMENT_UNENDED ||
                   dice_one_of(&die, 3) > 0;
    }
}

static char *said_of(void) {
    char *text = NULL;
    size_t length = 0;
    FILE *out = alloc_text(&text, &length);
    containment_print(out, &found, &request);
    alloc_text_end(out);
    return text;
}

static const char *read_time(const char *at, double wanted_s) {
    double time_s;
    at = said_number(at, &time_s);
    TEST_ASSERT_TRUE(fabs(time_s - wanted_s) <= 1e-14 * fabs(wanted_s));
    return at;
}

/* Reads a number with `places` digits. The number must not be below the value, and not more than two units of its
 * last place above. */
static const char *read_not_less(const char *at, const image_unit *unit, double si, int places) {
    const long double wanted =
        (long double)si * (long double)unit->divisor / (long double)unit->scale;
    char word[40];
    double number;
    (void)said_word(at, word, sizeof word);
    at = said_number(at, &number);
    TEST_ASSERT_EQUAL_size_t((size_t)places, strcspn(strchr(word, '.') + 1, "e"));
    TEST_ASSERT_TRUE_MESSAGE((long double)number >= wanted * (1.0L - 4e-16L), "less");
    const long double unit_of_last = powl(10.0L, floorl(log10l(fmaxl(wanted, 1e-300L))) - places);
    TEST_ASSERT_TRUE_MESSAGE((long double)number <= wanted + 1.1L * unit_of_last, "more");
    TEST_ASSERT_TRUE_MESSAGE(si > 0.0 || number == 0.0, "nothing");
    return at;
}

static const char *said_behind(const char *at, const containment_state *s) {
    switch (s->verdict) {
    case CONTAINMENT_TO_THE_END: return said_exactly(at, "\n");
    case CONTAINMENT_LEFT: return said_exactly(at, "; proved: error too large after that\n");
    case CONTAINMENT_UNDECIDED:
        return said_exactly(at, "; after that the tube is too wide to decide\n");
    case CONTAINMENT_UNENDED: break;
    }
    switch (found.end) {
    case CONTAINMENT_AT_END: return said_exactly(at, "\n");
    case CONTAINMENT_RUN_ENDS: return said_exactly(at, "; at that time the run fails\n");
    case CONTAINMENT_NO_STEP: return said_exactly(at, "; at that time the tube ends\n");
    case CONTAINMENT_SPENT: return said_exactly(at, "; at that time the effort is used up\n");
    case CONTAINMENT_STOPPED: return said_exactly(at, "; at that time the proof was interrupted\n");
    }
    return at;
}

static const char *said_state(const char *at, int i, const char *name) {
    const containment_state *s = &found.state[i];
    const image_unit *unit = &drawn.unit[i / 2][i % 2];
    const char *shown = strcmp(unit->shown, "1") == 0 ? "" : unit->shown;
    at = said_exactly(at, "  ");
    at = said_exactly(at, name);
    /* the names have a column of 16 characters */
    for (size_t wide = strlen(name); wide < 16; wide++) {
        at = said_exactly(at, " ");
    }
    at = said_exactly(at, " ");
    TEST_ASSERT_TRUE(*at != ' ');
    if (!s->begun) {
        at = said_words(at, "never ");
    } else if (s->verdict == CONTAINMENT_TO_THE_END) {
        at = said_words(at, "to the end ");
    } else {
        at = read_time(at, s->until_s);
    }
    at = said_words(at, "within ");
    at = read_not_less(at, unit, s->within, 2);
    at = said_exactly(at, " ");
    at = said_exactly(at, shown);
    at = said_exactly(at, ": ");
    if (!s->begun) {
        return said_exactly(at, s->verdict == CONTAINMENT_LEFT
                                    ? "proved: the error is too large at the start\n"
                                    : "the uncertainty of the start value exceeds this\n");
    }
    at = said_exactly(at, "error at most ");
    at = read_not_less(at, unit, s->off, 1);
    at = said_exactly(at, ", width of the tube ");
    at = read_not_less(at, unit, 2.0 * s->radius, 1);
    return said_behind(at, s);
}

static const char *name_of(int i, char *text) {
    snprintf(text, 40, "%s%s", drawn.unknown[i / 2].name, i % 2 == 0 ? "" : "'");
    return text;
}

/* Among the states without a proof to the end: the first one that was never proved; else the one whose proof ends
 * first; -1 if there is none. */
static int first_that_is_not(void) {
    for (int i = 0; i < found.states; i++) {
        if (!found.state[i].begun) {
            return i;
        }
    }
    for (int ms = 0; ms < 20; ms++) {
        for (int i = 0; i < found.states; i++) {
            const containment_state *s = &found.state[i];
            if (s->verdict != CONTAINMENT_TO_THE_END && lround(s->until_s * 1000.0) == ms) {
                return i;
            }
        }
    }
    return -1;
}

static const char *said_end(const char *at, double end_s) {
    const int first = first_that_is_not();
    char name[40];
    if (first < 0) {
        at = said_exactly(at, "proved to the end, t = ");
        return said_exactly(read_time(at, end_s), " s\n");
    }
    if (!found.state[first].begun) {
        at = said_exactly(at, "nothing is proved: ");
        at = said_exactly(at, name_of(first, name));
        return said_exactly(at, " is not within its tolerance at the start\n");
    }
    at = said_exactly(at, "proved until t = ");
    at = read_time(at, found.state[first].until_s);
    at = said_exactly(at, " s of ");
    at = said_exactly(read_time(at, end_s), " s");
    if (found.state[first].verdict != CONTAINMENT_UNENDED) {
        at = said_exactly(at, ": ");
        at = said_exactly(at, name_of(first, name));
        at = said_exactly(at, " is the first quantity without a proof");
    }
    return said_exactly(at, "\n");
}

TEST(prove_text, words) {
    for (unsigned c = 0; c < dice_cases(usual_or(300, 100)); c++) {
        char name[40];
        draw();
        const image *im = &drawn.im;
        const double end_s = (double)im->steps * (double)im->step.numerator / 1000.0;
        char *text = said_of();
        const char *at =
            said_exactly(text, im->title[0] != '\0' ? "drawn: of no mechanism\n  " : "drawn\n  ");
        at = said_exactly(at, wh_methods[im->settings.method].title);
        at = said_exactly(at, im->settings.compensated ? " compensated, " : ", ");
        at = said_exactly(at, request.kind == &engine_float ? "float, step " : "double, step ");
        at = read_time(at, im->step_s);
        at = said_exactly(at, " s, ");
        at = read_time(at, (double)im->steps);
        at = said_exactly(at, " steps to t = ");
        at = read_time(at, end_s);
        at = said_exactly(
            at, " s\n  compared with a tube around the exact motion: Taylor steps of order 26, ");
        at = read_time(at, (double)found.flowpipe_steps);
        at = said_exactly(at, " of them to t = ");
        at = read_time(at, found.tube_s);
        at = said_exactly(at, " s\n\ntime [s] until which the accuracy at the end of every step is "
                              "proved\n");
        for (int i = 0; i < found.states; i++) {
            at = said_state(at, i, name_of(i, name));
        }
        at = said_end(at, end_s);
        TEST_ASSERT_EQUAL_STRING("", at);
        free(text);
    }
}

static const char *read_exactly(const char *at, double wanted) {
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE(number == wanted);
    return at;
}

TEST(prove_text, rows) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 40)); c++) {
        enclosure exact[DRAWN_STATES] = {{0.0, 0.0}};
        double run[DRAWN_STATES] = {0.0};
        char name[40];
        char *text = NULL;
        size_t length = 0;
        draw();
        const uint64_t step = dice_one_of(&die, 1000000);
        FILE *out = alloc_text(&text, &length);
        containment_rows_head(out, &request);
        for (int i = 0; i < of.states; i++) {
            run[i] = dice_between(&die, -1.0, 1.0) * pow(10.0, dice_between(&die, -200.0, 200.0));
            exact[i] = (enclosure){run[i] - fabs(run[i]) * 1e-15, run[i] * (1.0 / 3.0)};
        }
        containment_row(out, &request, step, exact, run);
        alloc_text_end(out);
        const char *at = said_exactly(text, "time [s]");
        for (int i = 0; i < of.states; i++) {
            static const char *const parts[] = {" least [", " most [", " run ["};
            for (int part = 0; part < 3; part++) {
                at = said_exactly(at, ",");
                at = said_exactly(at, name_of(i, name));
                at = said_exactly(at, parts[part]);
                at = said_exactly(at, drawn.unit[i / 2][i % 2].si);
                at = said_exactly(at, "]");
            }
        }
        at = said_exactly(at, "\r\n");
        at = read_time(at, (double)step * (double)drawn.im.step.numerator / 1000.0);
        for (int i = 0; i < of.states; i++) {
            at = read_exactly(said_exactly(at, ","), exact[i].low);
            at = read_exactly(said_exactly(at, ","), exact[i].high);
            at = read_exactly(said_exactly(at, ","), run[i]);
        }
        TEST_ASSERT_EQUAL_STRING("\r\n", at);
        free(text);
    }
}

SUITE(prove_text) { die = dice_of("prove_text", 45); }
