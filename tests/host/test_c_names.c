/* test_c_names.c: the names that generated code may give to a scene: no name known to a C or C++ compiler and no
 * word of Octave. Compilers decide which names they know (tests/embed/known_names.sh). */
#include <unistd.h>

#include "host/emit/emit.h"
#include "test.h"

enum { LINE = 256 };

static char folder[] = "/tmp/whirl_names_XXXXXX";
static char for_c[64];
static char for_cpp[64];

static FILE *opened(const char *name, const char *how) {
    FILE *file = fopen(name, how);
    TEST_ASSERT_NOT_NULL_MESSAGE(file, name);
    return file;
}

/* Passes each line of a command's output to `take`. Returns the number of lines. */
static int each_line(const char *command, void (*take)(const char *line)) {
    char line[LINE];
    int count = 0;
    FILE *pipe = popen(command, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(pipe, command);
    while (fgets(line, sizeof line, pipe) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        take(line);
        count++;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, pclose(pipe), command);
    return count;
}

static FILE *c_names;
static FILE *cpp_names;
static int refused;

static void sort_out(const char *name) {
    if (!emit_c_name_is_free(name)) {
        refused++;
        return;
    }
    fprintf(c_names, "%s\n", name);
    if (emit_c_name_is_free_in_cpp(name)) {
        fprintf(cpp_names, "%s\n", name);
    }
}

static void complain(const char *line) { printf("  not refused: %s\n", line); }

TEST(c_names, accepted_names_compile_without_warnings) {
    char command[LINE];
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(for_c, sizeof for_c, "%s/c", folder);
    snprintf(for_cpp, sizeof for_cpp, "%s/cpp", folder);
    c_names = opened(for_c, "w");
    cpp_names = opened(for_cpp, "w");
    const int asked = each_line("sh tests/embed/known_names.sh ask", sort_out);
    const bool written = fclose(c_names) == 0 && fclose(cpp_names) == 0;
    snprintf(command, sizeof command, "sh tests/embed/known_names.sh judge %s %s", for_c, for_cpp);
    const int complaints = each_line(command, complain);
    (void)remove(for_c);
    (void)remove(for_cpp);
    rmdir(folder);
    printf("  %d words asked, %d refused\n", asked, refused);
    TEST_ASSERT_TRUE(written);
    TEST_ASSERT_GREATER_THAN_INT(2000, asked);
    TEST_ASSERT_GREATER_THAN_INT(600, refused);
    TEST_ASSERT_EQUAL_INT(0, complaints);
}

TEST(c_names, ordinary_names_are_free) {
    char names[] =
        "spring strut string_pendulum memory_wheel isolator tower torsion top sling logger "
        "cosmos sine pendulum ball expander floor_falls rounder integral internal INTAKE "
        "PRIMARY EPICYCLIC SIGMA M1 x c s x1a waiter indexer times shaft printer mtx "
        "flywheel_t int_t interval_t int_fast_t int_faster8_t int8 PRIdx PRIx_1 SCNdA "
        "x_8_MAX U8_C PRINTER";
    char *rest = NULL;
    for (char *name = strtok_r(names, " ", &rest); name != NULL;
         name = strtok_r(NULL, " ", &rest)) {
        TEST_ASSERT_TRUE_MESSAGE(emit_c_name_is_free(name), name);
        TEST_ASSERT_TRUE_MESSAGE(emit_c_name_is_free_in_cpp(name), name);
        TEST_ASSERT_TRUE_MESSAGE(emit_octave_name_is_free(name), name);
    }
}

/* Names of C23, of newer compilers and of other processors. */
TEST(c_names, names_of_newer_compilers_are_refused) {
    static const char *const names[] = {
        "sinpi",     "acospif",         "fmaximum_numf64x", "exp10m1l",
        "nullptr",   "typeof_unqual",   "constexpr",        "stdc_bit_ceil",
        "ckd_add",   "memset_explicit", "strlcpy",          "sqrtbf16",
        "AVR",       "sparc",           "int24_t",          "UINT_FAST8_WIDTH",
        "PRIbFAST8", "lgammaf_r"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(emit_c_name_is_free(names[i]), names[i]);
    }
}

/* The name of a function with the suffix of a number type, with or without _r after it, is refused. */
TEST(c_names, variants_of_functions_are_refused) {
    static const char *const of[] = {"sin", "lgamma", "exp10", "nextafter", "fmaximum_mag_num"};
    static const char *const types[] = {"",     "f",    "l",     "f16",  "f32", "f64", "f128",
                                        "f32x", "f64x", "f128x", "bf16", "d32", "d64", "d128"};
    static const char *const others[] = {"g", "f8", "ff", "l_", "d", "f32y", "_x"};
    char name[60];
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        for (size_t k = 0; k < sizeof types / sizeof types[0]; k++) {
            snprintf(name, sizeof name, "%s%s", of[i], types[k]);
            TEST_ASSERT_FALSE_MESSAGE(emit_c_name_is_free(name), name);
            snprintf(name, sizeof name, "%s%s_r", of[i], types[k]);
            TEST_ASSERT_FALSE_MESSAGE(emit_c_name_is_free(name), name);
            snprintf(name, sizeof name, "a%s%s", of[i], types[k]);
            TEST_ASSERT_EQUAL_MESSAGE(i > 0, emit_c_name_is_free(name), name); /* asin exists */
        }
        for (size_t k = 0; k < sizeof others / sizeof others[0]; k++) {
            snprintf(name, sizeof name, "%s%s", of[i], others[k]);
            TEST_ASSERT_TRUE_MESSAGE(emit_c_name_is_free(name), name);
        }
    }
    for (size_t k = 1; k < sizeof types / sizeof types[0]; k++) { /* a mere suffix is free */
        TEST_ASSERT_TRUE_MESSAGE(emit_c_name_is_free(types[k]), types[k]);
    }
    TEST_ASSERT_TRUE(emit_c_name_is_free("r"));
}

TEST(c_names, words_of_octave_are_refused) {
    static const char *const names[] = {
        "end", "endfunction", "function", "i",     "j",   "e",         "Inf",   "NaN",
        "NA",  "ans",         "nargin",   "pi",    "eps", "varargout", "zeros", "sin",
        "abs", "tanh",        "isreal",   "ode45", "t",   "dy",        "_x",    "until"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(emit_octave_name_is_free(names[i]), names[i]);
    }
}
