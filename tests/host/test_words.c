/* test_words.c: the words and units of the language follow from their rows: reserved names, hints, refusals in the
 * wrong place, and the lists in docs/language.md and events.md. Every row is tested. */
#include "derived.h"
#include "host/lang/model.h"
#include "host/lang/words.h"

enum { TEXT_SIZE = 1200, PAGE_SIZE = 200000 };

/* A mechanism that declares names for every form and contains `statement`. Its scene contains `within`. */
static const char *in_mechanism(const char *statement, const char *within) {
    static char text[TEXT_SIZE];
    snprintf(text, sizeof text,
             "mechanism trial\ncoordinate x [m]\ncoordinate y [m]\nparameter m = 2 [kg]\n"
             "parameter g = 9.81 [m/s^2]\noutput angle_read = x/1 [m]\nT = m*(x'^2 + y'^2)/2\n"
             "%s\nscene s {\n%s\n}\n",
             statement, within);
    return text;
}

static void expect_in(const char *report, const char *wanted, const char *text) {
    static char message[TEXT_SIZE + REPORT_OF_TEXT_SIZE + 200];
    snprintf(message, sizeof message, "'%s' is missing in \"%s\" about: %s", wanted, report, text);
    TEST_ASSERT_TRUE_MESSAGE(strstr(report, wanted) != NULL, message);
}

TEST(words, reserved_words_are_no_names) {
    int reserved = 0;
    for (int i = 0; i < WORD_COUNT; i++) {
        const statement_word *word = word_row((word_id)i);
        char declared[100];
        char wanted[100];
        const bool is_reserved = word_is_reserved(word->text, strlen(word->text));
        TEST_ASSERT_TRUE(is_reserved == ((word->rules & RESERVED) != 0));
        snprintf(declared, sizeof declared, "parameter %s = 1", word->text);
        snprintf(wanted, sizeof wanted, "'%s' is a reserved word", word->text);
        const char *text = in_mechanism(declared, "until 1 [s]");
        const char *report = report_of_text(text);
        if (is_reserved) {
            expect_in(report, wanted, text);
            reserved++;
        } else {
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", report, text);
        }
        TEST_ASSERT_FALSE(word_is_reserved(word->text, strlen(word->text) - 1));
    }
    TEST_ASSERT_TRUE(reserved >= 20);
}

/* With two neighbouring letters swapped, the word is one mistake away from the right one, and from no other. */
TEST(words, misspelt_statements_get_a_hint) {
    for (int i = 0; i < STATEMENT_WORDS; i++) {
        const statement_word *word = word_row((word_id)i);
        const size_t length = strlen(word->text);
        for (size_t k = 0; k + 1 < length && length >= 4; k++) {
            char wrong[40];
            char line[80];
            char wanted[80];
            strcpy(wrong, word->text);
            wrong[k] = word->text[k + 1];
            wrong[k + 1] = word->text[k];
            if (strcmp(wrong, word->text) == 0) {
                continue;
            }
            snprintf(line, sizeof line, "%s z", wrong);
            snprintf(wanted, sizeof wanted, "did you mean '%s'?", word->text);
            const bool body = (word->stands & (IN_FILE | IN_MECHANISM)) != 0;
            const char *text = body ? in_mechanism(line, "until 1 [s]") : in_mechanism("", line);
            const char *report = report_of_text(text);
            if (strcmp(wrong, "setp") != 0) { /* `setp` is as near to `set` */
                expect_in(report, wanted, text);
            }
        }
    }
}

/* Other names of energies, set or added to, alone and in an effect. The hint must name T, V or F. */
TEST(words, energies_by_other_names) {
    static const char *const meant[][2] = {{"t", "T = ..."},       {"k", "T = ..."},
                                           {"K", "T = ..."},       {"Ekin", "T = ..."},
                                           {"kinetic", "T = ..."}, {"v", "V = ..."},
                                           {"u", "V = ..."},       {"U", "V = ..."},
                                           {"Epot", "V = ..."},    {"potential", "V = ..."},
                                           {"f", "F = ..."},       {"D", "F = ..."},
                                           {"L", "T = ... and V"}, {"lagrangian", "T = ... and V"}};
    for (size_t i = 0; i < sizeof meant / sizeof meant[0]; i++) {
        for (int form = 0; form < 3; form++) {
            static const char *const forms[] = {"%s = 2 [J]", "%s += 2 [J]",
                                                "effect e { %s += 2 [J] }"};
            char line[80];
            snprintf(line, sizeof line, forms[form], meant[i][0]);
            const char *text = in_mechanism(line, "until 1 [s]");
            const char *report = report_of_text(text);
            expect_in(report, "unknown statement", text);
            expect_in(report, meant[i][1], text);
        }
    }
}

TEST(words, words_are_allowed_in_their_places) {
    static const unsigned places[] = {IN_MECHANISM | IN_FILE, IN_EFFECT, IN_SCENE};
    for (int i = 0; i < STATEMENT_WORDS; i++) {
        const statement_word *word = word_row((word_id)i);
        for (int k = 0; k < 3; k++) {
            char line[200];
            const bool stands = (word->stands & places[k]) != 0;
            snprintf(line, sizeof line, k == 1 ? "effect e {\n%s\n}" : "%s", word->text);
            const char *text =
                k == 2 ? in_mechanism("", word->text) : in_mechanism(line, "until 1 [s]");
            const char *report = report_of_text(text);
            char quoted[60];
            snprintf(quoted, sizeof quoted, "'%s'", word->text);
            const bool refused = strstr(report, "unknown statement") != NULL ||
                                 strstr(report, "belongs in a scene") != NULL ||
                                 strstr(report, "is not possible inside") != NULL ||
                                 strstr(report, "belongs in a mechanism or an effect") != NULL ||
                                 strstr(report, "is not closed with '}'") != NULL;
            TEST_ASSERT_TRUE_MESSAGE(report[0] != '\0', text); /* no bare word is valid */
            TEST_ASSERT_TRUE_MESSAGE(stands != refused || (word->rules & ENDS_SCENE) != 0, text);
        }
    }
}

TEST(words, forms_are_good_statements) {
    static const word_id tried[] = {WORD_STOP, WORD_FRICTION, WORD_HOLD, WORD_WHEN, WORD_NOISE};
    for (size_t i = 0; i < sizeof tried / sizeof tried[0]; i++) {
        const char *text = in_mechanism(word_row(tried[i])->form, "until 1 [s]");
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", report_of_text(text), text);
    }
    for (int i = 0; i < STATEMENT_WORDS; i++) {
        TEST_ASSERT_NOT_NULL(strstr(word_row((word_id)i)->form, word_row((word_id)i)->text));
    }
}

TEST(words, kinds_have_words) {
    for (int i = 0; i < CONTACT_KINDS; i++) {
        const contact_kind kind = (contact_kind)i;
        const int word = word_find(contact_word(kind), strlen(contact_word(kind)));
        TEST_ASSERT_TRUE(word < STATEMENT_WORDS && word_row((word_id)word)->kind == i);
        TEST_ASSERT_TRUE(strlen(contact_called(kind)) > 0 && strlen(contact_undefined(kind)) > 0);
    }
}

static char page[PAGE_SIZE];

static void read_page(void) {
    size_t length = 0;
    for (int i = 0; i < 2; i++) {
        FILE *in = fopen(i == 0 ? "docs/language.md" : "docs/events.md", "rb");
        TEST_ASSERT_NOT_NULL_MESSAGE(in, "run from the root of the project");
        length += fread(page + length, 1, sizeof page - 1 - length, in);
        fclose(in);
    }
    page[length] = '\0';
}

/* Does the page have `word` between `from` and `to`, at the start of a text in backticks? */
static bool listed(const char *word, const char *from, const char *to) {
    char open[60];
    snprintf(open, sizeof open, "`%s", word);
    for (const char *at = from; (at = strstr(at, open)) != NULL && at < to; at++) {
        if (strchr("` ({", at[strlen(open)]) != NULL) {
            return true;
        }
    }
    return false;
}

TEST(words, the_page_lists_every_word) {
    read_page();
    const char *const end = page + strlen(page);
    const char *const reserved = strstr(page, "These words are reserved");
    TEST_ASSERT_NOT_NULL(reserved);
    const char *const stop = strstr(reserved, "the names of the");
    for (int i = 0; i < WORD_COUNT; i++) {
        const statement_word *word = word_row((word_id)i);
        const bool said = listed(word->text, page, end) || i >= STATEMENT_WORDS; /* other words */
        TEST_ASSERT_TRUE_MESSAGE(said && strstr(page, word->text) != NULL, word->text);
        TEST_ASSERT_TRUE_MESSAGE(
            listed(word->text, reserved, stop) == ((word->rules & RESERVED) != 0), word->text);
    }
}

TEST(words, the_page_lists_every_unit) {
    read_page();
    const char *const table = strstr(page, "| quantity | units |");
    TEST_ASSERT_NOT_NULL(table);
    const char *const end = strstr(table, "\n\n");
    int units = 0;
    int shown = 0;
    for (; unit_name(units) != NULL; units++) {
        TEST_ASSERT_TRUE_MESSAGE(listed(unit_name(units), table, end), unit_name(units));
    }
    for (const char *at = table; at < end; at++) {
        shown += *at == '`';
    }
    TEST_ASSERT_EQUAL_INT(2 * units, shown);
    TEST_ASSERT_TRUE(units >= 50);
}
