/* test_price_settings.c: the settings that are priced (host/study/setting.h): how many there are, in which order, what their
 * options say, read back by a reader of its own, and what they are asked. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/fixed/engine_fixed.h"
#include "priced.h"
#include "unity.h"

void suite_price_settings(void);

/* What the words of the axes stand for, written once more. */
static const struct {
    const char *word;
    const engine_kind *kind;
    bool compensated;
} numbers[] = {{"float", &engine_float, false},
               {"float compensated", &engine_float, true},
               {"double", &engine_double, false},
               {"fixed", &engine_fixed, false}};
static const struct {
    const char *word;
    image_tables form;
    int cells;
} tables[] = {{"none", TABLES_NONE, 0},         {"linear", TABLES_LINEAR, 0},
              {"linear 64", TABLES_LINEAR, 64}, {"linear 1024", TABLES_LINEAR, 1024},
              {"cubic", TABLES_CUBIC, 0},       {"cubic 32", TABLES_CUBIC, 32},
              {"cubic 256", TABLES_CUBIC, 256}};
enum { NUMBERS = sizeof numbers / sizeof numbers[0], TABLES = sizeof tables / sizeof tables[0] };

static int number_of(const setting *s) {
    for (int i = 0; i < NUMBERS; i++) {
        if (numbers[i].kind == s->number && numbers[i].compensated == s->image.compensated) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE("a number that is none of the list");
    return 0;
}

static int tables_of(const setting *s) {
    for (int i = 0; i < TABLES; i++) {
        if (tables[i].form == s->image.tables && tables[i].cells == s->image.cells) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE("tables that are none of the list");
    return 0;
}

/* Its place among all combinations, the last axis fastest. */
static long place_of(const setting *s) {
    long at = (long)s->image.method;
    at = at * NUMBERS + number_of(s);
    at = at * IMAGE_ANGLES + (long)s->image.angles;
    at = at * IMAGE_MATRICES + (long)s->image.matrix;
    return at * TABLES + tables_of(s);
}

/* Three numbers by every method, with sines turned or looked up or by one of six tables, or by one of two matrices; and fixed
 * point. */
static void test_there_are_all_and_each_once(void) {
    const int count = setting_count();
    TEST_ASSERT_EQUAL_INT(3 * (WH_METHODS * (2 + 6) + 2) + 1, count);
    long before = -1;
    int matrices = 0;
    int in_fixed = 0;
    int looked_up = 0;
    for (int i = 0; i < count; i++) {
        const setting s = setting_at(i);
        const image_settings *m = &s.image;
        const bool plain = m->angles == ANGLES_TURNED && m->tables == TABLES_NONE;
        TEST_ASSERT_TRUE(place_of(&s) > before);
        before = place_of(&s);
        TEST_ASSERT_TRUE(m->matrix == MATRIX_NONE || (m->method == WH_RK4 && plain));
        TEST_ASSERT_TRUE(m->tables == TABLES_NONE || m->angles == ANGLES_TURNED);
        matrices += m->matrix != MATRIX_NONE;
        looked_up += m->angles == ANGLES_LOOKUP;
        in_fixed += s.number == &engine_fixed;
        TEST_ASSERT_TRUE(s.number != &engine_fixed ||
                         (m->method == WH_RK4 && plain && m->matrix == MATRIX_NONE));
        TEST_ASSERT_EQUAL_INT(s.number == &engine_fixed, setting_is_fixed(&s));
        TEST_ASSERT_EQUAL_INT(s.number == &engine_fixed || m->matrix != MATRIX_NONE,
                              setting_price_varies(&s));
        TEST_ASSERT_EQUAL_INT(m->matrix != MATRIX_NONE || m->tables != TABLES_NONE,
                              setting_may_be_refused(m));
    }
    TEST_ASSERT_EQUAL_INT(6, matrices);
    TEST_ASSERT_EQUAL_INT(1, in_fixed);
    TEST_ASSERT_EQUAL_INT(3 * WH_METHODS, looked_up);
}

static void test_words_are_those_of_the_axes(void) {
    static const char *const headings[] = {"method", "number", "angles", "matrix", "tables"};
    for (int i = 0; i < AXES; i++) {
        TEST_ASSERT_EQUAL_STRING(headings[i], setting_heading((setting_axis)i));
    }
    for (int i = 0; i < setting_count(); i++) {
        const setting s = setting_at(i);
        TEST_ASSERT_EQUAL_STRING(wh_methods[s.image.method].word, setting_word(&s, AXIS_METHOD));
        TEST_ASSERT_EQUAL_STRING(numbers[number_of(&s)].word, setting_word(&s, AXIS_NUMBER));
        TEST_ASSERT_EQUAL_STRING(s.image.angles == ANGLES_TURNED ? "turned" : "lookup",
                                 setting_word(&s, AXIS_ANGLES));
        TEST_ASSERT_EQUAL_STRING(image_matrix_words[s.image.matrix], setting_word(&s, AXIS_MATRIX));
        TEST_ASSERT_EQUAL_STRING(tables[tables_of(&s)].word, setting_word(&s, AXIS_TABLES));
    }
}

/* --- options, read back --------------------------------------------------------------------------------*/

static int word_in(const char *const *words, int count, const char *word) {
    for (int i = 0; i < count; i++) {
        if (strcmp(words[i], word) == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE(word);
    return 0;
}

typedef struct read_options {
    setting s;
    int options;
    bool has_method, has_number;
} read_options;

/* As a command line is read; double is what computes where nothing is said. */
static read_options options_read(const char *text) {
    read_options r = {.s = {IMAGE_SETTINGS_DEFAULT, &engine_double}};
    char option[32];
    char word[32];
    while (text[0] != '\0') {
        TEST_ASSERT_EQUAL_CHAR(' ', text[0]);
        TEST_ASSERT_TRUE(text[1] == '-');
        text = said_word(text, option, sizeof option);
        r.options++;
        if (strcmp(option, "--compensated") == 0) {
            r.s.image.compensated = true;
            continue;
        }
        text = said_word(text, word, sizeof word);
        if (strcmp(option, "--method") == 0) {
            r.has_method = true;
            int method = 0;
            while (method < WH_METHODS && strcmp(wh_methods[method].word, word) != 0) {
                method++;
            }
            TEST_ASSERT_TRUE_MESSAGE(method < WH_METHODS, word);
            r.s.image.method = (wh_method)method;
        } else if (strcmp(option, "--number") == 0) {
            r.has_number = true;
            r.s.number = strcmp(word, "float") == 0 ? &engine_float : &engine_fixed;
            TEST_ASSERT_TRUE(r.s.number == &engine_float || strcmp(word, "fixed") == 0);
        } else if (strcmp(option, "--angles") == 0) {
            r.s.image.angles = (image_angles)word_in(image_angles_words, IMAGE_ANGLES, word);
        } else if (strcmp(option, "--matrix") == 0) {
            r.s.image.matrix = (image_matrix_of)word_in(image_matrix_words, IMAGE_MATRICES, word);
        } else if (strcmp(option, "--tables") == 0) {
            r.s.image.tables = (image_tables)word_in(image_tables_words, IMAGE_TABLES_FORMS, word);
        } else if (strcmp(option, "--cells") == 0) {
            r.s.image.cells = (int)strtol(word, NULL, 10);
        } else {
            TEST_FAIL_MESSAGE(option);
        }
    }
    return r;
}

static void test_options_say_the_setting_and_no_more(void) {
    for (int i = 0; i < setting_count(); i++) {
        const setting s = setting_at(i);
        char text[SETTING_TEXT];
        TEST_ASSERT_EQUAL_PTR(text, setting_options(&s, true, text));
        read_options r = options_read(text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(place_of(&s), place_of(&r.s), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(s.image.matrix == MATRIX_NONE, r.has_method, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(s.number != &engine_double, r.has_number, text);
        const int options = (s.image.compensated ? 1 : 0) + (s.number != &engine_double ? 1 : 0) +
                            (s.image.angles != ANGLES_TURNED ? 1 : 0) +
                            (s.image.tables != TABLES_NONE ? 1 : 0) + (s.image.cells > 0 ? 1 : 0) +
                            1;
        TEST_ASSERT_EQUAL_INT_MESSAGE(options, r.options, text);
        /* `whirl derive` is told no number but the one that it writes other code for */
        setting_options(&s, false, text);
        r = options_read(text);
        TEST_ASSERT_FALSE_MESSAGE(r.has_number, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(options - (s.number != &engine_double ? 1 : 0), r.options,
                                      text);
        r.s.number = s.number;
        TEST_ASSERT_EQUAL_INT_MESSAGE(place_of(&s), place_of(&r.s), text);
        TEST_ASSERT_EQUAL_STRING(s.number == &engine_fixed ? " --number fixed" : "",
                                 setting_form(&s));
    }
}

/* --- which are a scene's own ---------------------------------------------------------------------------*/

typedef struct owning {
    const char *text;
    bool turns;  /* has an angle that sines can be turned on by */
    bool second; /* is of second order */
    bool rates;  /* its accelerations take rates */
} owning;

static void test_a_setting_is_its_own_where_it_is_taken(void) {
    static const owning rows[] = {
        {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
         "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
         false, true, false},
        {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
         "F = 0.5 [N*s/m]*x'^2/2\nscene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
         false, true, true},
        {"mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = -8 [J]*cos(a)\n"
         "scene s { start a = 1 [rad]; step 1 [ms]; until 1 [s] }\n",
         true, true, false},
        {"mechanism m\nstate y\nequation y' + 4 [1/s]*y = 1 [1/s]\n"
         "scene s { start y = 3; step 1 [ms]; until 1 [s] }\n",
         false, false, true}};
    for (size_t n = 0; n < sizeof rows / sizeof rows[0]; n++) {
        const owning *row = &rows[n];
        derived d = derived_scene(row->text, "s");
        derived_expect(&d, row->text);
        int own = 0;
        for (int i = 0; i < setting_count(); i++) {
            const setting s = setting_at(i);
            const int takes = wh_methods[s.image.method].takes;
            const bool taken = takes == WH_ANY_SYSTEM ||
                               (row->second && (takes == WH_SECOND_ORDER_ONLY || !row->rates));
            /* leapfrog's stage stands away from the begin, the plain method looks up: no pairs to turn on */
            const bool turns =
                row->turns && s.image.method != WH_LEAPFROG && s.image.method != WH_RK4_PLAIN;
            const bool expected = taken && (turns || s.image.angles == ANGLES_TURNED);
            char options[SETTING_TEXT];
            image as = *d.image;
            as.settings = s.image;
            /* what is asked is whether its angles could be turned, whatever this image does */
            TEST_ASSERT_EQUAL_INT_MESSAGE(expected, setting_is_own(&s, &as),
                                          setting_options(&s, true, options));
            own += expected;
        }
        TEST_ASSERT_TRUE(own > 0 && own < setting_count());
        derived_free(&d);
    }
}

void suite_price_settings(void) {
    RUN_TEST(test_there_are_all_and_each_once);
    RUN_TEST(test_words_are_those_of_the_axes);
    RUN_TEST(test_options_say_the_setting_and_no_more);
    RUN_TEST(test_a_setting_is_its_own_where_it_is_taken);
}
