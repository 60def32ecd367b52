/* test_vocabulary.c: the sequence of rows on which hashes depend, and messages for rare input.
 *
 * Models are hashed, and sums are ordered, by the numbers of rows. A row inserted between others would change the
 * hashes of models that never use it, and so break sweeps and boards. The lists here are the record: append a new
 * row to both lists, and never change a row. */
#include "test.h"

#include "core/contact.h"
#include "derived.h"
#include "host/image/op_list.h"
#include "host/lang/model.h"
#include "host/lang/words.h"
#include "host/number/functions.h"

enum { TEXT_SIZE = 600 };

#define EXPECT_ROW(list, index, is) \
    do { \
        char said[120]; \
        snprintf(said, sizeof said, "row %d of " list " is '%s': new ones come last, here too", \
                 index, is); \
        TEST_ASSERT_EQUAL_STRING_MESSAGE(recorded[index], is, said); \
    } while (0)

TEST(vocabulary, functions_are_in_their_recorded_order) {
    static const char *const recorded[FUNCTIONS] = {"sin",   "cos",  "tan",  "asin", "acos", "atan",
                                                    "atan2", "sqrt", "exp",  "log",  "abs",  "sign",
                                                    "min",   "max",  "sinh", "cosh", "tanh"};
    for (int i = 0; i < FUNCTIONS; i++) {
        const char *name = function_name((function_id)i);
        TEST_ASSERT_NOT_NULL_MESSAGE(recorded[i], name);
        EXPECT_ROW("functions.h", i, name);
    }
}

TEST(vocabulary, operations_are_in_their_recorded_order) {
    static const char *const recorded[OPS] = {
        "CONSTANT", "LINEAR", "RATE", "INPUT", "ACCEL", "TIME", "RADIANS", "NOISE", "PHASE",
        "SIN",      "COS",    "ADD",  "SUB",   "MUL",   "DIV",  "NEG",     "SQRT",  "ABS",
        "SIGN",     "MIN",    "MAX",  "CALL",  "POW",   "CELL", "LINE",    "CUBIC"};
#define NAME(id, ...) #id,
    static const char *const names[OPS] = {OP_ROWS(NAME)};
#undef NAME
    for (int i = 0; i < OPS; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(recorded[i], names[i]);
        EXPECT_ROW("op_list.h", i, names[i]);
    }
}

/* The sequence of contacts is not hashed. But the core and the output handle simultaneous contacts in this sequence. */
TEST(vocabulary, contacts_are_in_the_core_s_order) {
#define SAME(id, ...) TEST_ASSERT_EQUAL_INT_MESSAGE(WH_##id, CONTACT_##id, #id);
    CONTACT_KIND_ROWS(SAME)
#undef SAME
    TEST_ASSERT_TRUE(CONTACT_STOP < CONTACT_HOLD && CONTACT_HOLD < CONTACT_FRICTION &&
                     CONTACT_FRICTION < CONTACT_WHEN);
}

static bool is_among(const char *word, const char *words) {
    const size_t length = strlen(word);
    for (const char *at = words; (at = strstr(at, word)) != NULL; at++) {
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

/* At the start of a line inside a block, these words show that the block's brace is missing. Then the block must end
 * before the word, without a second error. All other words are read as part of the block, or refused. */
TEST(vocabulary, which_words_end_a_block) {
    static const struct {
        const char *before;
        const char *behind;
        const char *enders;
    } blocks[] = {
        {"effect e {\nV += m*x*1 [m/s^2]", "}\n", "mechanism effect scene"},
        {"scene s {\nuntil 1 [s]", "}\n",
         "mechanism coordinate state parameter let equation output effect scene"},
        {"when x crosses 0 [m] {\nset x' = 0 [m/s]", "}\n",
         "mechanism coordinate state parameter input let T V F Q equation output effect scene stop "
         "friction hold when"},
    };
    for (size_t b = 0; b < sizeof blocks / sizeof blocks[0]; b++) {
        for (int i = 0; i < STATEMENT_WORDS; i++) {
            const char *word = word_row((word_id)i)->text;
            char text[TEXT_SIZE];
            snprintf(text, sizeof text,
                     "mechanism trial\ncoordinate x [m]\nparameter m = 2 [kg]\nT = m*x'^2/2\n"
                     "%s\n%s zz = 1\n%s",
                     blocks[b].before, word, blocks[b].behind);
            const bool ended = strstr(report_of_text(text), "is not closed with '}'") != NULL;
            TEST_ASSERT_TRUE_MESSAGE(ended == is_among(word, blocks[b].enders), text);
        }
    }
}

static void expect_report(const char *statements, const char *wanted) {
    char text[TEXT_SIZE];
    snprintf(text, sizeof text,
             "mechanism trial\ncoordinate x [m]\nparameter m = 2 [kg]\ninput u = 1\nlet l = 3\n"
             "output o = 1\nT = m*x'^2/2\n%s\n",
             statements);
    const char *report = report_of_text(text);
    if (strstr(report, wanted) == NULL) {
        printf("  '%s' is missing in: %s", wanted, report);
    }
    TEST_ASSERT_TRUE_MESSAGE(strstr(report, wanted) != NULL, text);
}

TEST(vocabulary, symbols_have_their_names) {
    expect_report("V = m'*x", "'m' is a parameter: it has no derivative");
    expect_report("V = u'*x", "'u' is an input: it has no derivative");
    expect_report("output p = o'", "'o' is an output: it has no derivative");
    expect_report("V = T*x", "the kinetic energy");
    expect_report("T += V*x", "the potential energy");
    expect_report("V = F*x", "the dissipation function");
}

TEST(vocabulary, energies_have_their_dimension) {
    expect_report("V = m*x", "potential energy V must be an energy [kg*m^2/s^2]");
    expect_report("T += m*x", "kinetic energy T must be an energy [kg*m^2/s^2]");
    expect_report("F = m*x", "dissipation function F must be a power [kg*m^2/s^3]");
}

static void expect_word_hint(const char *form, const char *word) {
    char line[100];
    char wanted[300];
    const char *hint = first_word_hint(word, strlen(word));
    TEST_ASSERT_NOT_NULL_MESSAGE(hint, word);
    snprintf(line, sizeof line, form, word); // NOLINT
    snprintf(wanted, sizeof wanted, "hint: %s\n", hint);
    expect_report(line, wanted);
}

/* Words of other languages, and words that users try first, anywhere in a file. Each must have a hint of its own
 * instead of the hint of the nearest spelling. */
TEST(vocabulary, first_words_get_a_hint) {
    static const char *const words[] = {
        "t",          "time",       "if",      "floor", "heaviside",  "table",
        "constraint", "given",      "tunable", "every", "sgn",        "pow",
        "ln",         "log10",      "const",   "param", "parameters", "Piecewise",
        "diff",       "derivative", "random",  "dirac", "PI"};
    static const char *const signs[][2] = {{"V = x %s 0", "=="},
                                           {"V = x %s 0", ">"},
                                           {"V = x %s 0", "<="},
                                           {"let c = 3 %s 2", "?"},
                                           {"V = 3 [J] %s x", "if"},
                                           {"hold x while x > 0 [m] %s 1 > 0", "given"},
                                           {"hold x while %s > 1", "t"},
                                           {"stop x - %s >= 0 restitution 1", "time"},
                                           {"hold x while x > 0 [m] %s x < 1 [m]", "&"},
                                           {"hold x while x > 0 [m] %s x < 1 [m]", "|"}};
    static const char *const places[] = {
        "V = 1 [J]*%s", "V = 1 [J]*%s(x/1 [m])", "let l2 = 3*%s + 2", "output w = sin(%s*2)",
        "%s y x",       "effect e {\n%s x\n}"};
    static const char *const attempts[][2] = {
        {"F = m*x", "hint: the expression contains no speed; write: F = "},
        {"V = 1/2*m*9.81", "hint: check the unit of each parameter"},
        {"friction x - l static 1 kinetic 1 normal 1 [N]", "hint: for friction between two bodies"},
        {"input w", "hint: give the input a start value: input w = 0"},
        {"input F", "hint: choose another name, such as F_1"},
        {"Q = 3", "hint: write Q(x) = "},
        {"V = 1 [J]*arctan(x/1 [m])", "hint: did you mean 'atan'?"},
        {"V = 1 [J]*arcsin(x/1 [m])", "hint: did you mean 'asin'?"},
        {"V = 1 [J]*arccos(x/1 [m])", "hint: did you mean 'acos'?"},
        {"hold x given 1 > 0", "hint: hold x - y while"},
        {"V = 1 [J] \xe2\x88\x92 x", "hint: write -\n"},
        {"let v = x\xe2\x80\x99", "hint: write '\n"},
        {"let c = 3 [m\xc2\xb2]", "hint: write ^2\n"},
        {"let c = 3 [\xc2\xb0]", "hint: write deg\n"},
        {"let c = 3 [centimetre]", "hint: `whirl list --units` lists the units"}};
    for (size_t w = 0; w < sizeof words / sizeof words[0]; w++) {
        for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
            expect_word_hint(places[k], words[w]);
        }
    }
    for (size_t i = 0; i < sizeof signs / sizeof signs[0]; i++) {
        expect_word_hint(signs[i][0], signs[i][1]);
    }
    for (size_t i = 0; i < sizeof attempts / sizeof attempts[0]; i++) {
        expect_report(attempts[i][0], attempts[i][1]);
    }
}

/* Statements of other languages, with random names and numbers. If a statement is changed as the hint asks, it must
 * be accepted. */
TEST(vocabulary, hints_repair_other_notations) {
    static const char names[][6] = {"q", "theta", "x_1", "arm"};
    static const char units[][8] = {"kg", "m/s", "N*s/m", "deg", "kg*m^2"};
    static const char calls[][6] = {"sin", "cos", "exp", "tanh", "sqrt"};
    static const struct { /* $: name, K: number, U: unit, C: function */
        const char *wrong, *hint, *right;
    } rows[] = {
        {"let a = $dot*2", "write $'", "let a = $'*2"},
        {"let a = $_dot", "write $'", "let a = $'"},
        {"let a = 3*d$", "write $'", "let a = 3*$'"},
        {"let a = d$_dt", "write $'", "let a = $'"},
        {"let a = $ddot", "write $''", "let a = $''"},
        {"let a = dd$", "write $''", "let a = $''"},
        {"let a = $(t)", "a coordinate has no (t)", "let a = $"},
        {"let a = K*e", "write exp(1)", "let a = K*exp(1)"},
        {"let a = Pi*K", "write pi", "let a = pi*K"},
        {"let a = K .* $", "write the operators", "let a = K * $"},
        {"let a = |$|", "write abs(x)", "let a = abs($)"},
        {"let a = K$", "write K*$", "let a = K*$"},
        {"let a = (K $)", "write K*$", "let a = (K*$)"},
        {"let a = K*$ $'", "write $*$'", "let a = K*$*$'"},
        {"let a = K($ + 1)", "write K*($ + 1)", "let a = K*($ + 1)"},
        {"let a = C^2(K)", "write C(x)^2", "let a = C(K)^2"},
        {"let a = C K", "write C(x)", "let a = C(K)"},
        {"let a = integrate($)", "the functions are sin, cos", "let a = exp($)"},
        {"let a = [K K; K K]", "there are no matrices", "let a = K"},
        {"parameter a = K U", "write K [U]", "parameter a = K [U]"},
        {"parameter a = K (U)", "write K [U]", "parameter a = K [U]"},
        {"parameter a = K [-]", "leave the brackets out", "parameter a = K"},
        {"parameter a = K [ ]", "leave the brackets out", "parameter a = K"},
        {"parameter a = K [N*m/s2]", "write s^2", "parameter a = K [N*m/s^2]"},
        {"parameter a = K // U", "begin a comment with #", "parameter a = K # U"},
        {"parameter a = K /* U */", "begin a comment with #", "parameter a = K # U"},
        {"/* U\n $ */ parameter a = K", "begin a comment with #", "parameter a = K"},
        {"% U\nparameter a = K", "begin a comment with #", "# U\nparameter a = K"},
        {"paramter a = K [U]\nlet b = 2*a\nV = b*a*mass", "did you mean 'parameter'?", "let b = $"},
        {"coordiante b [m]\nV = 1 [N/m]*b^2\nQ(b) = 1 [N]", "mean 'coordinate'?", "let b = $"}};
    uint64_t seed = 7;
    for (unsigned i = 0; i < 8U * (unsigned)(sizeof rows / sizeof rows[0]); i++) {
        const char *const of[3] = {rows[i / 8U].wrong, rows[i / 8U].hint, rows[i / 8U].right};
        const char *name = names[(unsigned)(random_bits(&seed) % 4)];
        const char *unit = units[(unsigned)(random_bits(&seed) % 5)];
        const char *call = calls[(unsigned)(random_bits(&seed) % 5)];
        const unsigned number = 1U + (unsigned)(random_bits(&seed) % 99);
        char made[3][200];
        for (unsigned k = 0; k < 3U; k++) {
            size_t at = 0;
            for (const char *c = of[k]; *c != '\0'; c++) {
                char digits[12];
                snprintf(digits, sizeof digits, "%u", number);
                const char *put = *c == 'K'   ? digits
                                  : *c == 'U' ? unit
                                  : *c == 'C' ? call
                                  : *c == '$' ? name
                                              : NULL;
                at += (size_t)snprintf(made[k] + at, sizeof made[k] - at,
                                       put != NULL ? "%s" : "%.1s", put != NULL ? put : c);
            }
        }
        char text[TEXT_SIZE];
        static const char form[] =
            "mechanism trial\ncoordinate %s [rad]\nparameter mass = 2 [kg*m^2]\n"
            "T = mass*%s'^2/2\n%s\n";
        snprintf(text, sizeof text, form, name, name, made[0]);
        const char *report = report_of_text(text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report, made[1]), report);
        const char *first = strstr(report, ": error: ");
        TEST_ASSERT_NOT_NULL_MESSAGE(first, text);
        const bool bars = strchr(made[0], '|') != NULL; /* the second | may be another error */
        TEST_ASSERT_TRUE_MESSAGE(bars || strstr(first + 1, ": error: ") == NULL, report);
        snprintf(text, sizeof text, form, name, name, made[2]);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", report_of_text(text), text);
    }
}

TEST(vocabulary, a_decimal_comma_gets_a_hint) {
    static const char *const forms[] = {
        "parameter a = %u,%u [m]", "V = %u,%u [N/m]*x^2", "scene s { step %u,%u [ms] }",
        "scene s { start x = %u,%u [m] }", "scene s { set m = %u,%u [kg] }"};
    uint32_t drawn = 45;
    for (unsigned i = 0; i < 40U; i++) {
        char text[120];
        drawn = drawn * 1664525U + 1013904223U;
        snprintf(text, sizeof text, forms[i % 5U], drawn >> 28U, drawn >> 20U & 255U);
        expect_report(text, "a decimal point");
    }
}
