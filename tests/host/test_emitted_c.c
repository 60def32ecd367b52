/* test_emitted_c.c: generated C of random scenes, read back word by word. Used and declared names agree, and operations
 * have the values of the list. Scripts, which take longer, check that it compiles and steps with the same bits. */
#include "emitted.h"
#include "host/image/image.h"
#include "test.h"

/* Values of a list's operations with c_read.h's made-up values; waves[] numbers the pairs. */
static double phase_value(const op_list *t, const op *o, const double *x) {
    double phase = o->value;
    for (int k = 0; k < t->angles; k++) {
        phase += o->turns != NULL ? o->turns[k] * c_leaf("phase", k) : 0.0;
    }
    for (int k = 0; k < t->angles; k++) {
        phase += o->parts != NULL ? o->parts[k] * c_leaf("angle", k) : 0.0;
    }
    return phase + (o->b >= 0 ? x[o->b] : 0.0);
}

static double row_value(const op_list *t, const op *o, const double *x) {
    const double a = x[o->a >= 0 ? o->a : 0];
    const double b = o->b >= 0 ? x[o->b] : 0.0;
    char name[40];
    switch (o->code) {
    case OP_CONSTANT: return o->value;
    case OP_LINEAR: return c_leaf("linear", o->a);
    case OP_RATE: return c_leaf("rate", o->a);
    case OP_INPUT: return c_leaf("input", o->a);
    case OP_ACCEL: return c_leaf("accel", o->a);
    case OP_TIME: return c_leaf("time", 0);
    case OP_RADIANS: return c_leaf("angle", o->a);
    case OP_NOISE: return c_called("noise", o->value / 4294967296.0, 0.0);
    case OP_PHASE:
    case OP_CELL: return phase_value(t, o, x);
    case OP_SIN: return sin(a);
    case OP_COS: return cos(a);
    case OP_ADD: return a + b;
    case OP_SUB: return a - b;
    case OP_MUL: return a * b;
    case OP_DIV: return a / b;
    case OP_NEG: return -a;
    case OP_SQRT: return sqrt(a);
    case OP_ABS: return fabs(a);
    case OP_SIGN: return isnan(a) ? a : (double)((a > 0.0) - (a < 0.0));
    case OP_MIN: return isnan(b) || b < a ? b : a; /* as in op_list.h: the first of two zeros */
    case OP_MAX: return isnan(b) || b > a ? b : a;
    case OP_CALL:
        snprintf(name, sizeof name, "wh_%s", function_name(o->function));
        return c_called(name, a, b);
    case OP_POW: return c_called("wh_pow", a, b);
    case OP_LINE:
    case OP_CUBIC: {
        const double value = c_looked_up(o->code == OP_LINE ? "wh_table_linear" : "wh_table_cubic",
                                         a, (int)o->value);
        const bool back = t->tables.folds && t->tables.odd[(int)o->value / t->tables.terms];
        return back ? c_mirrored(value, a) : value;
    }
    }
    return (double)NAN;
}

/* NaN cannot be compared: counts of finite and undefined values. */
static unsigned finite, undefined;

static void expect_same(double wanted, double got, const char *what) {
    const bool both_none = !isfinite(wanted) && (isnan(wanted) ? isnan(got) : wanted == got);
    if (!both_none && !(fabs(wanted - got) <= 1e-9 * (fabs(wanted) + 1.0))) {
        printf("  %s, %s: %.17g for %.17g in\n%s", emitted.about, what, got, wanted, emitted.text);
        TEST_FAIL_MESSAGE(what);
    }
    finite += isfinite(wanted) ? 1 : 0;
    undefined += both_none;
}

static bool is_taken(const op_list *t, op_code code, int i) {
    bool found = false;
    for (int k = 0; k < t->count; k++) {
        found = found || (t->ops[k].code == code && t->ops[k].a == i);
    }
    return found;
}

/* A function of the file against its list; `waves`: its sines are given. */
static void check_list(const op_list *t, const char *function, const char *result, bool waves) {
    static c_values v;
    double x[SCENE_OPS];
    double sine[SCENE_OPS];
    double cosine[SCENE_OPS];
    int wave = 0;
    int written = 0;
    c_run(&emitted.file, function, result, &v);
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const op_kind kind = op_rows[o->code].kind;
        x[i] = row_value(t, o, x);
        sine[i] = sin(x[i]);
        cosine[i] = cos(x[i]);
        if (waves && op_list_is_wave(o)) {
            sine[i] = c_leaf("sine", wave);
            cosine[i] = c_leaf("cosine", wave++);
            TEST_ASSERT_EQUAL_MESSAGE(is_taken(t, OP_SIN, i), v.has_s[i], function);
            TEST_ASSERT_EQUAL_MESSAGE(is_taken(t, OP_COS, i), v.has_c[i], function);
        } else if (kind == OP_IS_PHASE) {
            TEST_ASSERT_TRUE_MESSAGE(v.has_s[i] && v.has_c[i], function);
            sine[i] += o->b >= 0 ? 1e-3 * x[o->b] : 0.0;
            cosine[i] -= o->b >= 0 ? 1e-3 * x[o->b] : 0.0;
        } else if (kind == OP_IS_CELL) {
            expect_same(x[i], v.row[i], "a cell");
            expect_same(t->tables.bits + 100.0 * (t->tables.count * t->tables.terms), v.x[i],
                        "a cell of so many");
        }
        if (kind == OP_IS_WAVE) {
            x[i] = o->code == OP_SIN ? sine[o->a] : cosine[o->a];
        }
        const bool stands = kind != OP_IS_CONSTANT && kind != OP_IS_PHASE && kind != OP_IS_CELL;
        TEST_ASSERT_EQUAL_MESSAGE(stands, v.has_x[i], function);
        if (stands) {
            expect_same(x[i], v.x[i], function);
        }
    }
    for (int i = 0; i < C_NAMES; i++) {
        written += v.has_result[i];
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(t->results, written, function);
    for (int i = 0; i < t->results; i++) {
        TEST_ASSERT_TRUE_MESSAGE(v.has_result[i], function);
        expect_same(x[t->result[i]], v.result[i], function);
    }
}

/* Phase and rate of each pair, by which a step rotates it. */
static void check_waves(const op_list *t) {
    static c_values v[2];
    c_run(&emitted.file, "wave_sines", "result", &v[0]);
    c_run(&emitted.file, "wave_rates", "result", &v[1]);
    int wave = 0;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        if (op_list_is_wave(o)) {
            double rate = 0.0;
            for (int k = 0; k < t->angles; k++) {
                rate += o->turns[k] * c_leaf("rate", k);
            }
            TEST_ASSERT_TRUE(v[0].has_result[wave] && v[1].has_result[wave]);
            expect_same(phase_value(t, o, NULL), v[0].result[wave], "the phase of a pair");
            expect_same(rate * c_leaf("scale", 0), v[1].result[wave], "the rate of a pair");
            wave++;
        }
    }
    TEST_ASSERT_FALSE(v[0].has_result[wave] || v[1].has_result[wave]);
    char words[120];
    snprintf(words, sizeof words,
             "static const wh_waves waves = { NULL , wave_sines , wave_rates , %dU } ;", wave);
    c_need(&emitted.file, 0, words);
}

static void check_operations(const image *im) {
    const bool waves = image_turns(im);
    const char *step = im->form == WH_SECOND_ORDER ? "accelerations" : "slopes";
    if (im->list[IMAGE_MATRIX] != NULL) {
        check_list(im->list[IMAGE_MATRIX], "step_matrix", "result", false);
        TEST_ASSERT_FALSE(emitted_says("void accelerations") || emitted_says("void slopes"));
    } else {
        check_list(im->list[IMAGE_STEP], step, "result", waves);
        TEST_ASSERT_FALSE(emitted_says("void step_matrix"));
    }
    if (waves) {
        check_waves(im->list[IMAGE_STEP]);
    }
    if (im->outputs > 0) {
        check_list(im->list[IMAGE_OBSERVE], "observe", "output", false);
    }
    if (im->contacts > 0) {
        check_list(im->list[IMAGE_SIGNALS], "contact_signals", "result", false);
        check_list(im->list[IMAGE_FORCES], "contact_forces", "result", false);
    }
    if (im->set_count > 0) {
        check_list(im->list[IMAGE_SETS], "contact_sets", "result", false);
    }
    if (im->ledger.kept) {
        check_list(im->list[IMAGE_POWERS], "ledger_powers", im->ledger.turned ? "power" : "result",
                   false);
        check_list(im->list[IMAGE_LEVELS], "ledger_levels", "level", false);
    }
}

TEST(emitted_c, operations_come_to_what_the_lists_have) {
    finite = undefined = 0;
    each_emitted(check_operations);
    TEST_ASSERT_TRUE(finite > 10 * undefined);
}

static void check_whole(const image *im) {
    (void)im;
    c_expect_whole(&emitted.file, emitted.about);
}

TEST(emitted_c, all_names_are_there_and_used) { each_emitted(check_whole); }

/* Layout: blocks of their own follow an empty line, without double empty lines and trailing blanks. Continuation lines
 * are indented. */
static void check_layout(const image *im) {
    (void)im;
    size_t open = 0;
    for (const char *line = emitted.text, *last = NULL; *line != '\0';) {
        const size_t length = strcspn(line, "\n");
        const bool empty = length == 0;
        const bool last_empty = last != NULL && *last == '\n';
        const bool guarded = last != NULL && strncmp(last, "#if", 3) == 0;
        const char *parenthesis = memchr(line, '(', length);
        const bool is_function =
            (strncmp(line, "static", 6) == 0 || strncmp(line, "WH_IN", 5) == 0) &&
            parenthesis != NULL && memchr(line, '=', length) == NULL;
        TEST_ASSERT_FALSE_MESSAGE(empty && last_empty, emitted.text);
        TEST_ASSERT_FALSE_MESSAGE(length > 0 && line[length - 1] == ' ', emitted.text);
        TEST_ASSERT_EQUAL_CHAR('\n', line[length]);
        if (is_function) {
            TEST_ASSERT_TRUE_MESSAGE(last_empty || guarded, line);
        }
        if (is_function && line[length - 1] == ',') {
            open = (size_t)(parenthesis - line) + 1;
        } else if (open > 0) {
            TEST_ASSERT_EQUAL_size_t_MESSAGE(open, strspn(line, " "), line);
            open = line[length - 1] == '{' ? 0 : open;
        }
        last = line;
        line += length + 1;
        const bool ends = last[0] == '}' && last[1] == '\n';
        TEST_ASSERT_FALSE_MESSAGE(ends && *line != '\n' && *line != '#', last);
    }
}

TEST(emitted_c, the_layout_is_regular) { each_emitted(check_layout); }

/* Functions called by pointer need no inlining, and long ones are not inlined. */
static void expect_linkage(const char *function, const char *inlined, const op_list *t) {
    char words[100];
    snprintf(words, sizeof words, "%s void %s (", op_list_operations(t) > 150 ? "static" : inlined,
             function);
    const int at = c_need(&emitted.file, 0, words);
    const int head =
        at - 4 - (strcmp(inlined, "static inline") == 0 && op_list_operations(t) <= 150);
    const bool first =
        head == 0 || c_is(&emitted.file, head - 1, "}") || c_is(&emitted.file, head - 1, ";");
    TEST_ASSERT_TRUE_MESSAGE(first, words);
}

static void check_linkage(const image *im) {
    const bool by_pointer = im->contacts > 0 || im->ledger.asked;
    if (im->settings.matrix != MATRIX_NONE) {
        expect_linkage("step_matrix", "WH_INLINE", im->list[IMAGE_MATRIX]);
    } else {
        expect_linkage(im->form == WH_SECOND_ORDER ? "accelerations" : "slopes",
                       by_pointer ? "static inline" : "WH_INLINE_WITH_FPU", im->list[IMAGE_STEP]);
    }
    if (im->contacts > 0) {
        expect_linkage("contact_signals", "static inline", im->list[IMAGE_SIGNALS]);
        expect_linkage("contact_forces", "static inline", im->list[IMAGE_FORCES]);
    }
    if (im->set_count > 0) {
        expect_linkage("contact_sets", "static inline", im->list[IMAGE_SETS]);
    }
    if (im->ledger.kept && !im->ledger.turned) {
        expect_linkage("ledger_powers", "static inline", im->list[IMAGE_POWERS]);
    }
}

TEST(emitted_c, long_lists_are_not_inlined) { each_emitted(check_linkage); }

SUITE(emitted_c) { emitted_die = dice_of("emitted_c", 4100); }
