/* c_run.c: evaluation of generated C (c_read.h). */
#include "c_read.h"
#include "test.h"

/* --- made-up values ---------------------------------------------------------------------------------------------- */

static double spread(const char *name, size_t length) {
    unsigned sum = 17;
    for (size_t i = 0; i < length; i++) {
        sum = (sum * 31 + (unsigned char)name[i]) % 10007;
    }
    return (double)sum / 10007.0;
}

double c_leaf(const char *name, int index) {
    return 0.2 + spread(name, strlen(name)) * (1.0 + 0.37 * index) * (index % 2 == 0 ? 1.0 : -1.0);
}

double c_called(const char *name, double x, double y) {
    return spread(name, strlen(name)) + 0.5 * x - 0.25 * y;
}

double c_looked_up(const char *form, double phase, int number) {
    return spread(form, strlen(form)) + 0.125 * phase + 0.0625 * number;
}

double c_mirrored(double value, double phase) { return 0.5 - value * (phase < 1.0 ? 1.5 : -0.5); }

/* --- expressions ------------------------------------------------------------------------------------------ */

typedef struct runner {
    const c_file *file;
    c_values *v;
    int at;
} runner;

static double choice(runner *r);

static bool next_is(const runner *r, const char *word) { return c_is(r->file, r->at, word); }

static bool take(runner *r, const char *word) {
    const bool is = next_is(r, word);
    r->at += is;
    return is;
}

static void need(runner *r, const char *word) {
    if (!take(r, word)) {
        char text[200];
        c_text(r->file, r->at, r->at + 8, text, sizeof text);
        printf("  no '%s' before %s\n", word, text);
        TEST_FAIL_MESSAGE(word);
    }
}

static int whole(runner *r) {
    TEST_ASSERT_TRUE_MESSAGE(isdigit((unsigned char)*r->file->word[r->at].at),
                             r->file->word[r->at].at);
    return (int)strtol(r->file->word[r->at++].at, NULL, 10);
}

/* The number after the letters of a name such as row12; -1 for another name. */
static int numbered(const runner *r, const char *letters) {
    const c_word w = r->file->word[r->at];
    const int length = (int)strlen(letters);
    if (w.length <= length || strncmp(w.at, letters, strlen(letters)) != 0 ||
        !isdigit((unsigned char)w.at[length])) {
        return -1;
    }
    const int number = (int)strtol(w.at + length, NULL, 10);
    TEST_ASSERT_TRUE(number < C_NAMES);
    return number;
}

static int need_numbered(runner *r, const char *letters) {
    const int number = numbered(r, letters);
    TEST_ASSERT_TRUE_MESSAGE(number >= 0, r->file->word[r->at].at);
    r->at++;
    return number;
}

/* An angle in phase units of the float build: WH_TURN(radians, units of 2^-32 turn). */
static double turn(runner *r) {
    need(r, "(");
    const double rad = c_number(r->file, &r->at);
    need(r, ",");
    const double units = strtod(r->file->word[r->at++].at, NULL);
    const double turns = rad / 6.283185307179586477;
    const double apart = remainder(turns * 0x1p32 - units, 0x1p32);
    TEST_ASSERT_TRUE_MESSAGE(fabs(apart) <= 0.51, "a turn in whole numbers is not that in radians");
    need(r, ")");
    return rad;
}

/* wh_phase_times(angle[k], WH_FACTOR(multiple, whole, part)): the float build uses the integers. */
static double times(runner *r) {
    need(r, "(");
    need(r, "angle");
    need(r, "[");
    const double angle = c_leaf("angle", whole(r));
    need(r, "]");
    need(r, ",");
    need(r, "WH_FACTOR");
    need(r, "(");
    const double multiple = c_number(r->file, &r->at);
    need(r, ",");
    const double units = strtod(r->file->word[r->at++].at, NULL);
    need(r, ",");
    need(r, "UINT64_C");
    need(r, "(");
    const double part = strtod(r->file->word[r->at++].at, NULL);
    TEST_ASSERT_TRUE(fabs(remainder(units + part * 0x1p-64 - multiple, 0x1p32)) < 0x1p-20);
    need(r, ")");
    need(r, ")");
    need(r, ")");
    return multiple * angle;
}

/* wh_table_linear(&row3[4], y3) */
static double looked_up(runner *r, const char *form) {
    need(r, "(");
    need(r, "&");
    const int row = need_numbered(r, "row");
    need(r, "[");
    const int number = whole(r);
    need(r, "]");
    need(r, ",");
    TEST_ASSERT_EQUAL_INT(row, need_numbered(r, "y"));
    need(r, ")");
    return c_looked_up(form, r->v->row[row], number);
}

static double mirrored(runner *r) {
    need(r, "(");
    const double value = choice(r);
    need(r, ",");
    const int row = need_numbered(r, "back");
    need(r, ")");
    return c_mirrored(value, r->v->row[row]);
}

static double call(runner *r, const char *name) {
    need(r, "(");
    const double x = choice(r);
    const double y = take(r, ",") ? choice(r) : 0.0;
    need(r, ")");
    if (strcmp(name, "WH_SQRT") == 0) {
        return sqrt(x);
    }
    return strcmp(name, "WH_ABS") == 0              ? fabs(x)
           : strcmp(name, "wh_phase_from_rad") == 0 ? x
           : strcmp(name, "wh_angle_to_rad") == 0   ? x
                                                    : c_called(name, x, y);
}

/* An array element: phase[2], wave[2].sine. */
static double element(runner *r, const char *name) {
    need(r, "[");
    const int index = whole(r);
    need(r, "]");
    if (take(r, ".")) {
        char member[40];
        c_text(r->file, r->at, r->at + 1, member, sizeof member);
        r->at++;
        return c_leaf(member, index);
    }
    return c_leaf(name, index);
}

static double variable(runner *r) {
    static const char *const letters[] = {"x", "s", "c"};
    const bool *const has[] = {r->v->has_x, r->v->has_s, r->v->has_c};
    const double *const value[] = {r->v->x, r->v->s, r->v->c};
    for (int i = 0; i < 3; i++) {
        const int number = numbered(r, letters[i]);
        if (number >= 0) {
            TEST_ASSERT_TRUE_MESSAGE(has[i][number], r->file->word[r->at].at);
            r->at++;
            return value[i][number];
        }
    }
    TEST_FAIL_MESSAGE(r->file->word[r->at].at);
    return 0.0;
}

static double primary(runner *r) {
    char name[40];
    if (next_is(r, "WH_R")) {
        return c_number(r->file, &r->at);
    }
    if (take(r, "(")) {
        if (take(r, "wh_real") || take(r, "wh_phase")) { /* a cast to that type */
            need(r, ")");
            return primary(r);
        }
        const double value = choice(r);
        need(r, ")");
        return value;
    }
    if (take(r, "-")) {
        return -primary(r);
    }
    c_text(r->file, r->at, r->at + 1, name, sizeof name);
    if (isdigit((unsigned char)name[0])) {
        return whole(r);
    }
    if (strcmp(name, "scale") == 0) {
        r->at++;
        return c_leaf(name, 0);
    }
    if (c_is(r->file, r->at + 1, "[")) {
        r->at++;
        return element(r, name);
    }
    if (!c_is(r->file, r->at + 1, "(")) {
        return variable(r);
    }
    r->at++;
    if (strcmp(name, "WH_TURN") == 0) {
        return turn(r);
    }
    if (strcmp(name, "wh_phase_times") == 0) {
        return times(r);
    }
    if (strcmp(name, "wh_table_linear") == 0 || strcmp(name, "wh_table_cubic") == 0) {
        return looked_up(r, name);
    }
    if (strcmp(name, "wh_table_back") == 0) {
        return mirrored(r);
    }
    if (strcmp(name, "wh_scene_time_s") == 0) {
        r->at = c_need(r->file, r->at, "( scene , state )");
        return c_leaf("time", 0);
    }
    if (strcmp(name, "wh_noise") == 0) {
        need(r, "(");
        const double seed = strtod(r->file->word[r->at++].at, NULL);
        r->at = c_need(r->file, r->at, ", state -> steps )");
        return c_called("noise", seed / 4294967296.0, 0.0);
    }
    return call(r, name);
}

static double product(runner *r) {
    double value = primary(r);
    for (;;) {
        if (take(r, "*")) {
            value *= primary(r);
        } else if (take(r, "/")) {
            value /= primary(r);
        } else {
            return value;
        }
    }
}

static double sum(runner *r) {
    double value = product(r);
    for (;;) {
        if (take(r, "+")) {
            value += product(r);
        } else if (take(r, "-")) {
            value -= product(r);
        } else {
            return value;
        }
    }
}

static double comparison(runner *r) {
    const double value = sum(r);
    return take(r, "<")    ? value < sum(r)
           : take(r, ">")  ? value > sum(r)
           : take(r, "==") ? value == sum(r)
           : take(r, "!=") ? value != sum(r)
                           : value;
}

static double choice(runner *r) {
    double value = comparison(r);
    while (take(r, "||")) {
        const double other = comparison(r);
        value = value != 0.0 || other != 0.0;
    }
    if (take(r, "?")) {
        const double yes = choice(r);
        need(r, ":");
        const double no = choice(r);
        return value != 0.0 ? yes : no;
    }
    return value;
}

/* --- statements ------------------------------------------------------------------------------------------- */

/* wh_sincos(PHASE, &s3, &c3); if the phase is a sum in radians, the sum follows once more in radians. */
static void sincos_of(runner *r, bool again) {
    need(r, "(");
    const double phase = choice(r);
    need(r, ",");
    need(r, "&");
    const int i = need_numbered(r, "s");
    need(r, ",");
    need(r, "&");
    TEST_ASSERT_EQUAL_INT(i, need_numbered(r, "c"));
    need(r, ")");
    if (again) { /* computed from the radians, because a too large phase becomes NaN */
        TEST_ASSERT_TRUE(r->v->has_s[i] && r->v->has_c[i]);
        r->v->s[i] += 1e-3 * phase;
        r->v->c[i] -= 1e-3 * phase;
        return;
    }
    TEST_ASSERT_FALSE(r->v->has_s[i]);
    r->v->has_s[i] = r->v->has_c[i] = true;
    r->v->s[i] = sin(phase);
    r->v->c[i] = cos(phase);
}

/* wh_sincos_parts(PHASE, &parts[3]) */
static void sincos_parts(runner *r) {
    need(r, "(");
    const double phase = choice(r);
    need(r, ",");
    need(r, "&");
    need(r, "parts");
    need(r, "[");
    const int i = whole(r);
    need(r, "]");
    need(r, ")");
    TEST_ASSERT_FALSE(r->v->has_result[i]);
    r->v->has_result[i] = true;
    r->v->result[i] = phase;
}

/* row3 = wh_table_cell(cells, 4U, 6U, PHASE, &y3): 2^4 cells of 6 numbers. Stored as x: cell and y. */
static void row(runner *r) {
    const int i = need_numbered(r, "row");
    need(r, "=");
    const bool folds = next_is(r, "wh_table_half");
    need(r, folds ? "wh_table_half" : "wh_table_cell");
    need(r, "(");
    need(r, "cells");
    need(r, ",");
    const int bits = whole(r);
    need(r, ",");
    const int width = whole(r);
    need(r, ",");
    r->v->row[i] = choice(r);
    need(r, ",");
    need(r, "&");
    TEST_ASSERT_EQUAL_INT(i, need_numbered(r, "y"));
    if (folds) {
        need(r, ",");
        need(r, "&");
        TEST_ASSERT_EQUAL_INT(i, need_numbered(r, "back"));
    }
    need(r, ")");
    r->v->x[i] = bits + 100.0 * width;
}

static void constant(runner *r) {
    static const char *const letters[] = {"x", "s", "c"};
    bool *const has[] = {r->v->has_x, r->v->has_s, r->v->has_c};
    double *const value[] = {r->v->x, r->v->s, r->v->c};
    need(r, "wh_real");
    if (take(r, "*")) {
        if (numbered(r, "row") >= 0) {
            row(r);
        } else { /* an observer's first statements */
            while (!next_is(r, ";")) {
                r->at++;
            }
        }
        return;
    }
    for (int i = 0; i < 3; i++) {
        const int number = numbered(r, letters[i]);
        if (number >= 0) {
            TEST_ASSERT_FALSE_MESSAGE(has[i][number], r->file->word[r->at].at);
            r->at++;
            need(r, "=");
            value[i][number] = choice(r);
            has[i][number] = true;
            return;
        }
    }
    TEST_FAIL_MESSAGE(r->file->word[r->at].at);
}

static void to_next(runner *r) {
    while (!next_is(r, ";")) {
        r->at++;
    }
}

static void statement(runner *r, const char *result) {
    if (take(r, "wh_sincos")) {
        sincos_of(r, false);
    } else if (take(r, "wh_sincos_of_range")) {
        sincos_of(r, true);
    } else if (take(r, "wh_sincos_parts")) {
        sincos_parts(r);
    } else if (next_is(r, "for")) {
        r->at = c_closing(r->file, c_need(r->file, r->at, ") {") - 1) + 1;
        return;
    } else if (next_is(r, result) && c_is(r->file, r->at + 1, "[")) {
        r->at += 2;
        const int i = whole(r);
        need(r, "]");
        need(r, "=");
        TEST_ASSERT_FALSE_MESSAGE(r->v->has_result[i], "a result that is written twice");
        r->v->result[i] = choice(r);
        r->v->has_result[i] = true;
    } else if (next_is(r, "const") && c_is(r->file, r->at + 1, "wh_real")) {
        r->at++;
        constant(r);
    } else { /* declarations and (void) casts */
        const bool left = next_is(r, "(") && c_is(r->file, r->at + 1, "void");
        TEST_ASSERT_TRUE_MESSAGE(left || next_is(r, "wh_real") || next_is(r, "bool") ||
                                     next_is(r, "wh_phase") || next_is(r, "const") ||
                                     next_is(r, "wh_contact_observe"),
                                 r->file->word[r->at].at);
        to_next(r);
    }
    need(r, ";");
}

void c_run(const c_file *f, const char *function, const char *result, c_values *v) {
    char head[80];
    memset(v, 0, sizeof *v);
    snprintf(head, sizeof head, "void %s (", function);
    const int open = c_closing(f, c_need(f, 0, head) - 1) + 1;
    const int end = c_closing(f, open);
    runner r = {f, v, open + 1};
    while (r.at < end) {
        statement(&r, result);
    }
}
