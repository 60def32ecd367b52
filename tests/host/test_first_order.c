/* test_first_order.c: the first-order form that `whirl derive` prints, of mechanisms with drawn names: each component's slope
 * is the one that has its name and a prime, and the components' letter is no coordinate's. And the effects above it. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/cli/commands.h"
#include "host/show/show_equations.h"
#include "unity.h"

void suite_first_order(void);

enum { COORDINATES_MOST = 5, NAME = 24, COMPONENTS = 2 * COORDINATES_MOST };

static const char *const names[] = {"a", "y1", "b", "s2", "x", "y", "w3", "s", "y23", "q4", "y1b"};
enum { NAMES = sizeof names / sizeof names[0] };

/* Writes a mechanism of `count` coordinates with other names each. */
static void write(dice *d, char *text, size_t size, int count) {
    const unsigned first = dice_one_of(d, NAMES);
    size_t at = (size_t)snprintf(text, size, "mechanism m\n");
    for (int i = 0; i < count; i++) {
        at += (size_t)snprintf(text + at, size - at, "coordinate %s [m]\n",
                               names[(first + 4 * (unsigned)i) % NAMES]);
    }
    at += (size_t)snprintf(text + at, size - at, "T = 0 [J]");
    for (int i = 0; i < count; i++) {
        at += (size_t)snprintf(text + at, size - at, " + %d [kg]*%s'^2/2", 1 + i,
                               names[(first + 4 * (unsigned)i) % NAMES]);
    }
    snprintf(text + at, size - at, "\nscene s { until 1 [s] }\n");
}

/* A letter and a number, as components are called: the number, or 0. */
static int number_behind(const char *letter, const char *word) {
    const size_t length = strlen(letter);
    const char *digits = word + length;
    const bool is = strncmp(word, letter, length) == 0 && digits[0] != '\0' &&
                    strspn(digits, "0123456789") == strlen(digits);
    return is ? (int)strtol(digits, NULL, 10) : 0;
}

/* The names between the brackets, in their order. */
static int read_components(const char *line, char *letter, char part[][NAME]) {
    int count = 0;
    TEST_ASSERT_EQUAL_INT(1, sscanf(line, "first-order form, %23s = (", letter));
    for (const char *at = strchr(line, '(') + 1; count < COMPONENTS;) {
        const size_t length = strcspn(at, ",)");
        snprintf(part[count++], NAME, "%.*s", (int)length, at);
        if (at[length] != ',') {
            break;
        }
        at += length + 2;
    }
    return count;
}

static void check_form(FILE *out, int count) {
    char line[400];
    char letter[NAME] = "";
    char part[COMPONENTS][NAME] = {{0}};
    int slopes = 0;
    int all = 0;
    rewind(out);
    while (fgets(line, sizeof line, out) != NULL) {
        int of = 0;
        char slope[NAME + 1];
        char name[NAME] = "";
        char form[40];
        if (strncmp(line, "first-order form", 16) == 0) {
            all = read_components(line, letter, part);
        }
        snprintf(form, sizeof form, "  %s%%d' = %%23s", letter);
        if (all == 0 || sscanf(line, form, &of, name) < 2) {
            continue;
        }
        const int is = number_behind(letter, name);
        TEST_ASSERT_TRUE(of >= 1 && of <= all && is <= all);
        snprintf(slope, sizeof slope, "%s'", part[of - 1]);
        TEST_ASSERT_EQUAL_STRING(slope, is > 0 ? part[is - 1] : name);
        TEST_ASSERT_EQUAL_INT(slopes + 1, of);
        slopes++;
    }
    TEST_ASSERT_EQUAL_INT(2 * count, all);
    TEST_ASSERT_EQUAL_INT(all, slopes);
    for (int i = 0; i < count; i++) { /* no coordinate looks like a component */
        TEST_ASSERT_EQUAL_INT(0, number_behind(letter, part[i]));
    }
}

static void test_slopes_of_components(void) {
    dice d = dice_of("first-order forms", 20261124);
    const unsigned cases = dice_cases(60);
    for (unsigned c = 0; c < cases; c++) {
        char text[1200];
        const int count = 1 + (int)dice_one_of(&d, COORDINATES_MOST);
        write(&d, text, sizeof text, count);
        derived made = derived_scene(text, "s");
        derived_expect(&made, text);
        FILE *out = tmpfile();
        TEST_ASSERT_NOT_NULL(out);
        show_text(out, made.equations);
        check_form(out, count);
        fclose(out);
        derived_free(&made);
    }
}

/* What a scene calls for is told with its own words, and nothing of what it leaves out. */
static void test_effects_are_told(void) {
    enum { EFFECTS = 4 };
    static const char text[] =
        "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
        "effect e0 \"word 0\" { V += 1 [N]*x }\neffect e1 \"word 1\" { V += 2 [N]*x }\n"
        "effect e2 \"word 2\" { F += 1 [N*s/m]*x'^2/2 }\neffect e3 \"word 3\" { V += 3 [N]*x }\n";
    const char *file = model_keep(text);
    for (unsigned with = 1; with < 1U << EFFECTS; with++) {
        char list[40] = "";
        said what;
        for (unsigned k = 0; k < EFFECTS; k++) {
            const size_t length = strlen(list);
            if ((with >> k & 1U) != 0) {
                snprintf(list + length, sizeof list - length, "%se%u", length > 0 ? "," : "", k);
            }
        }
        const char *words[] = {file, "--with", list, NULL};
        command_say(command_derive, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        for (unsigned k = 0; k < EFFECTS; k++) {
            char line[60];
            snprintf(line, sizeof line, "  with       e%u         word %u\n", k, k);
            TEST_ASSERT_EQUAL((with >> k & 1U) != 0, strstr(what.out, line) != NULL);
        }
    }
    model_drop();
}

void suite_first_order(void) {
    RUN_TEST(test_slopes_of_components);
    RUN_TEST(test_effects_are_told);
}
