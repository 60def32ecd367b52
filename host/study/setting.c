#include "setting.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "host/engine/start.h"
#include "host/fixed/engine_fixed.h"
#include "host/image/turned.h"

/* Numbers: the arithmetic, and if sums are compensated. The number of generated C is chosen when it is compiled, except for
 * fixed point. */
static const struct {
    const char *word;
    const char *run;    /* additional options of `whirl run` */
    const char *derive; /* options of both */
    const char *form;   /* options of `whirl derive` only */
    const engine_kind *kind;
    bool compensated;
} numbers[] = {{"float", " --number float", "", "", &engine_float, false},
               {"float compensated", " --number float", " --compensated", "", &engine_float, true},
               {"double", "", "", "", &engine_double, false},
               {"fixed", " --number fixed", "", " --number fixed", &engine_fixed, false}};
static_assert(sizeof numbers / sizeof numbers[0] == SETTING_NUMBERS, "a row for each number");

int setting_number(const setting *s) {
    int i = 0;
    while (i < SETTING_NUMBERS - 1 &&
           (numbers[i].kind != s->number || numbers[i].compensated != s->image.compensated)) {
        i++;
    }
    return i;
}

static const char *method_word(int i) { return wh_methods[i].word; }
static int method_of(const setting *s) { return (int)s->image.method; }
static void method_put(setting *s, int i) { s->image.method = (wh_method)i; }

static const char *number_word(int i) { return numbers[i].word; }
static void number_put(setting *s, int i) {
    s->number = numbers[i].kind;
    s->image.compensated = numbers[i].compensated;
}

static const char *matrix_word(int i) { return image_matrix_words[i]; }
static int matrix_of(const setting *s) { return (int)s->image.matrix; }
static void matrix_put(setting *s, int i) { s->image.matrix = (image_matrix_of)i; }

/* Tables of each form with the cells that it has by itself, and with a quarter or half, and four times as many. */
static const struct {
    const char *word;
    const char *options;
    image_tables form;
    int cells;
} tables[] = {{"none", "", TABLES_NONE, 0},
              {"linear", " --tables linear", TABLES_LINEAR, 0},
              {"linear 64", " --tables linear --cells 64", TABLES_LINEAR, 64},
              {"linear 1024", " --tables linear --cells 1024", TABLES_LINEAR, 1024},
              {"cubic", " --tables cubic", TABLES_CUBIC, 0},
              {"cubic 32", " --tables cubic --cells 32", TABLES_CUBIC, 32},
              {"cubic 256", " --tables cubic --cells 256", TABLES_CUBIC, 256}};
enum { TABLES = sizeof tables / sizeof tables[0] };

static const char *tables_word(int i) { return tables[i].word; }
static int tables_of(const setting *s) {
    int i = 0;
    while (i < TABLES - 1 &&
           (tables[i].form != s->image.tables || tables[i].cells != s->image.cells)) {
        i++;
    }
    return i;
}
static void tables_put(setting *s, int i) {
    s->image.tables = tables[i].form;
    s->image.cells = tables[i].cells;
}

static const char *angles_word(int i) { return image_angles_words[i]; }
static int angles_of(const setting *s) { return (int)s->image.angles; }
static void angles_put(setting *s, int i) { s->image.angles = (image_angles)i; }

typedef struct axis_row {
    int count;
    const char *(*word)(int i);
    int (*of)(const setting *s);
    void (*put)(setting *s, int i);
    const char *option;  /* NULL: it has words of its own */
    bool always_written; /* also its first word */
} axis_row;

static bool has_matrix(const setting *s) { return s->image.matrix != MATRIX_NONE; }

static const axis_row rows[AXES] = {
    [AXIS_METHOD] = {WH_METHODS, method_word, method_of, method_put, "--method", true},
    [AXIS_NUMBER] = {SETTING_NUMBERS, number_word, setting_number, number_put, NULL, true},
    [AXIS_ANGLES] = {IMAGE_ANGLES, angles_word, angles_of, angles_put, "--angles", false},
    [AXIS_MATRIX] = {IMAGE_MATRICES, matrix_word, matrix_of, matrix_put, "--matrix", false},
    [AXIS_TABLES] = {TABLES, tables_word, tables_of, tables_put, NULL, false}};

const char *setting_heading(setting_axis axis) {
#define SETTING_HEADING(id, heading) heading,
    static const char *const headings[AXES] = {SETTING_AXES(SETTING_HEADING)};
#undef SETTING_HEADING
    return headings[axis];
}

const char *setting_word(const setting *s, setting_axis axis) {
    return rows[axis].word(rows[axis].of(s));
}

static int combinations(void) {
    int count = 1;
    for (int i = 0; i < AXES; i++) {
        count *= rows[i].count;
    }
    return count;
}

/* The last axis runs fastest. */
static setting combination(int i) {
    setting s = {IMAGE_SETTINGS_DEFAULT, &engine_double};
    for (int axis = AXES - 1; axis >= 0; axis--) {
        rows[axis].put(&s, i % rows[axis].count);
        i /= rows[axis].count;
    }
    return s;
}

bool setting_is_fixed(const setting *s) { return s->number == &engine_fixed; }

/* Does each of its words say something? Fixed point knows one method, and one way to its sines (host/fixed). */
static bool makes_sense(const setting *s) {
    const bool plain = s->image.angles == ANGLES_TURNED;
    if (setting_is_fixed(s)) {
        return s->image.method == WH_RK4 && plain && !has_matrix(s) &&
               s->image.tables == TABLES_NONE;
    }
    if (has_matrix(s)) {
        return s->image.method == WH_METHOD_DEFAULT && plain && s->image.tables == TABLES_NONE;
    }
    return s->image.tables == TABLES_NONE || plain;
}

int setting_count(void) {
    int count = 0;
    for (int i = 0; i < combinations(); i++) {
        const setting s = combination(i);
        count += makes_sense(&s) ? 1 : 0;
    }
    return count;
}

setting setting_at(int i) {
    for (int k = 0;; k++) {
        const setting s = combination(k);
        if (makes_sense(&s) && i-- == 0) {
            return s;
        }
    }
}

cost_number setting_cost_number(const setting *s) {
    return setting_is_fixed(s)           ? COST_FIXED
           : s->number == &engine_double ? COST_DOUBLE
                                         : COST_FLOAT;
}

bool setting_is_asked(const setting *s, const bool method[WH_METHODS]) {
    const wh_method m = s->image.method;
    return method != NULL
               ? method[m]
               : m == WH_RK4 || m == WH_NYSTROEM3 || m == WH_NYSTROEM4 || m == WH_NYSTROEM5;
}

int setting_order(const setting *s) {
    int order = 0;
    for (int axis = 0; axis < AXES; axis++) {
        order = order * rows[axis].count + rows[axis].of(s);
    }
    return order;
}

bool setting_may_be_refused(const image_settings *s) {
    return s->matrix != MATRIX_NONE || s->tables != TABLES_NONE;
}

bool setting_price_varies(const setting *s) { return has_matrix(s) || setting_is_fixed(s); }

const char *setting_form(const setting *s) { return numbers[setting_number(s)].form; }

bool setting_is_own(const setting *s, const image *im) {
    diags *unsaid = diags_new();
    const bool takes = start_has_method(im, s->image.method, unsaid);
    diags_free(unsaid);
    if (!takes) {
        return false;
    }
    image turned = *im;
    turned.settings.angles = ANGLES_TURNED;
    return setting_may_be_refused(&s->image) || s->image.angles == ANGLES_TURNED ||
           image_turns(&turned);
}

const char *setting_options(const setting *s, bool with_number, char text[SETTING_TEXT]) {
    text[0] = '\0';
    for (int axis = 0; axis < AXES; axis++) {
        const axis_row *row = &rows[axis];
        const int i = row->of(s);
        size_t used = strlen(text);
        if (axis == AXIS_NUMBER) {
            snprintf(text + used, SETTING_TEXT - used, "%s%s", with_number ? numbers[i].run : "",
                     numbers[i].derive);
        } else if (axis == AXIS_TABLES) {
            snprintf(text + used, SETTING_TEXT - used, "%s", tables[i].options);
        } else if (axis == AXIS_METHOD && has_matrix(s)) {
            continue; /* it takes a method's place */
        } else if (row->always_written || i > 0) {
            snprintf(text + used, SETTING_TEXT - used, " %s %s", row->option, row->word(i));
        }
    }
    return text;
}
