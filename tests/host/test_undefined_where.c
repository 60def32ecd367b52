/* test_undefined_where.c: where an expression is undefined (host/check/nonfinite.h): the innermost undefined part of
 * random formulas, by its column; the states within a step that are tried; and a sine whose angle is too large. */
#include "command.h"
#include "derived.h"
#include "host/base/alloc.h"
#include "host/check/nonfinite.h"

enum { FORMULA = 600 };

static dice die;

/* The message of `ask`, "" if nothing was found. The caller frees the text. */
static char *told_of(const nonfinite_at *at, bool (*ask)(const nonfinite_at *, diags *)) {
    char *told = NULL;
    size_t length = 0;
    diags *errors = diags_new();
    FILE *out = alloc_text(&told, &length);
    const bool found = ask(at, errors);
    diags_flush(errors, out);
    alloc_text_end(out);
    TEST_ASSERT_EQUAL(found, told[0] != '\0');
    diags_free(errors);
    return told;
}

static derived scene_of(const char *text) { return derived_surely(derived_scene(text, "s"), text); }

/* '@' stands for the undefined part. Each form is undefined if that part is, and only then. */
static const char *const around[] = {
    "-(@)",  "2*(@)",  "(@)*x/u",    "1 + (@)",         "(@) - 3",  "(@)/2",       "1/((@)^2 + 1)",
    "(@)^2", "abs(@)", "cos(@ - 1)", "max(1, 2 - (@))", "e0 + (@)", "min(@, 0.5)", "3 - x/u - (@)"};
static const char *const parts[] = {"log(x/u)", "sqrt(x/u)", "sqrt(9 + log(x/u))", "(x/u)^0.5"};
/* For each of `parts`, the offset of the place that the message must name. For a power, this is its ^. */
static const int inside[] = {0, 0, 9, 5};

static void put_around(char *formula, int *column, const char *wrapper) {
    char made[FORMULA];
    const char *at = strchr(wrapper, '@');
    TEST_ASSERT_TRUE(strlen(formula) + strlen(wrapper) < FORMULA);
    snprintf(made, sizeof made, "%.*s%s%s", (int)(at - wrapper), wrapper, formula, at + 1);
    *column += (int)(at - wrapper);
    memcpy(formula, made, sizeof made);
}

TEST(undefined_where, the_innermost_part_is_named) {
    for (unsigned c = 0; c < dice_cases(usual_or(80, 20)); c++) {
        char formula[FORMULA];
        char text[FORMULA + 300];
        char wanted[FORMULA + 200];
        const unsigned part = dice_one_of(&die, sizeof parts / sizeof parts[0]);
        int column = inside[part];
        snprintf(formula, sizeof formula, "%s", parts[part]);
        for (unsigned k = dice_one_of(&die, 6); k > 0; k--) {
            put_around(formula, &column,
                       around[dice_one_of(&die, sizeof around / sizeof around[0])]);
        }
        put_around(formula, &column, "V = 1 [J]*(@)");
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nparameter u = 1 [m]\nlet e0 = 2 + x/u\n"
                 "T = 1 [kg]*x'^2/2\n%s\nscene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
                 formula);
        derived d = scene_of(text);
        const double real[] = {-dice_between(&die, 2.0, 4.0), dice_between(&die, -1.0, 1.0)};
        const nonfinite_at at = {
            .image = d.image, .real = real, .angle_rad = real, .when = "now and then"};
        char *told = told_of(&at, nonfinite_term);
        snprintf(wanted, sizeof wanted,
                 "x.whirl:6:%d: error: now and then the stored energy is not a finite number: %s\n",
                 column + 1, formula);
        TEST_ASSERT_EQUAL_STRING_LEN(strchr(wanted, ':'), strchr(told, ':'),
                                     strlen(strchr(wanted, ':')));
        TEST_ASSERT_NOT_NULL(strstr(told, "hint: avoid a root or logarithm of a negative number"));
        free(told);
        const double good[] = {1.1, 0.0};
        nonfinite_at elsewhere = at;
        elsewhere.real = good;
        told = told_of(&elsewhere, nonfinite_term);
        TEST_ASSERT_EQUAL_STRING("", told);
        free(told);
        derived_free(&d);
    }
}

/* A term is undefined in a window of the step. The term must be found if a sampled place is in the window and not
 * beyond the range `ahead`. */
TEST(undefined_where, undefined_windows_within_a_step) {
    static const double shares[] = {0.0, 0.25, 0.5, 0.75, 1.0, 1.01, 1.5, 2.0};
    for (unsigned c = 0; c < dice_cases(usual_or(150, 40)); c++) {
        char text[700];
        const bool right_at = c % 2U == 0;
        const double share = shares[c / 2U % 8U];
        const double from = right_at ? share - 0.004 : dice_between(&die, -0.2, 2.2);
        const double to = from + (right_at ? 0.008 : dice_between(&die, 0.001, 0.3));
        const double v = dice_between(&die, 0.5, 2.0);
        const double x = dice_between(&die, -1.0, 1.0);
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                 "V = 1 [J]*sqrt((x/1 [m] - %.17g)*(x/1 [m] - %.17g))\n"
                 "scene s { start x' = 1 [m/s]; step 0.1 [s]; until 1 [s] }\n",
                 x + 0.1 * v * from, x + 0.1 * v * to);
        derived d = scene_of(text);
        const double real[] = {x, v};
        for (int ahead = 0; ahead <= 4; ahead++) {
            const nonfinite_at at = {.image = d.image,
                                     .real = real,
                                     .angle_rad = real,
                                     .ahead_steps = 0.25 * ahead,
                                     .when = "when"};
            bool wanted = false;
            for (int i = 0; i < 8; i++) {
                wanted = wanted || (shares[i] > from && shares[i] < to &&
                                    (i == 0 || shares[i] <= 0.5 * ahead));
            }
            char *told = told_of(&at, nonfinite_term);
            TEST_ASSERT_EQUAL_MESSAGE(wanted, told[0] != '\0', text);
            free(told);
        }
        derived_free(&d);
    }
}

TEST(undefined_where, angle_components_are_named) {
    static const char *const orders[] = {
        "coordinate a [rad]\ncoordinate b [rad]\ncoordinate x [m]\n",
        "coordinate x [m]\ncoordinate b [rad]\ncoordinate a [rad]\n",
        "coordinate b [rad]\ncoordinate x [m]\ncoordinate a [rad]\n"};
    for (unsigned c = 0; c < dice_cases(usual_or(40, 12)); c++) {
        char text[500];
        const double level = dice_between(&die, -2.0, 2.0);
        snprintf(text, sizeof text,
                 "mechanism m\n%sinput u = 2\ninput v = %.17g\n"
                 "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*(a'^2 + b'^2)/2\n"
                 "Q(x) = 1 [N]*sqrt(v + sin(a) + 2*cos(b) + x/(3 [m]) + x'/(4 [m/s]))\n"
                 "scene s { step 0.5 [s]; until 1 [s] }\n",
                 orders[c % 3U], level);
        derived d = scene_of(text);
        const image *im = d.image;
        TEST_ASSERT_EQUAL_INT(2, im->angles);
        double angle_rad[2];
        double real[4];
        double of[3][2]; /* positions and rates of a, b and x */
        for (int i = 0; i < 6; i++) {
            const component at = image_component(im, i);
            const char name = im->unknown[at.unknown].name[0];
            const double value = dice_between(&die, -3.0, 3.0);
            *(i < 2 ? &angle_rad[i] : &real[i - 2]) = value;
            of[name == 'x' ? 2 : name - 'a'][at.primes] = value;
        }
        bool none = false;
        const double ahead =
            c % 2U == 0 ? 0.0
                        : 0.25; /* in steps of 0.5 s; the tested places reach up to 2 * ahead */
        const double shares[] = {0.0, 0.25, 0.5};
        for (int i = 0; i < 3 && shares[i] <= 2.0 * ahead; i++) {
            const double t = 0.5 * shares[i];
            const double sum = level + sin(of[0][0] + t * of[0][1]) +
                               2.0 * cos(of[1][0] + t * of[1][1]) +
                               (of[2][0] + t * of[2][1]) / 3.0 + of[2][1] / 4.0;
            none = none || sum < 0.0;
        }
        const nonfinite_at at = {.image = im,
                                 .real = real,
                                 .angle_rad = angle_rad,
                                 .ahead_steps = ahead,
                                 .when = "when"};
        char *told = told_of(&at, nonfinite_term);
        TEST_ASSERT_EQUAL_MESSAGE(none, told[0] != '\0', text);
        free(told);
        derived_free(&d);
    }
}

/* A formula contains a sine whose argument is near the limit. An angle that counts its turns has no limit. */
TEST(undefined_where, the_sine_that_is_too_far) {
    unsigned told_of_sines = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(400, 100)); c++) {
        char formula[FORMULA];
        char text[FORMULA + 300];
        int column = 0;
        const bool turns = c % 2U == 0;
        const bool of_angle = c % 4U > 1U;
        const double limit = turns ? 1e9 : 5e8;
        const double off = dice_between(&die, 1e-5, 0.5) * (dice_one_of(&die, 2) == 0 ? 1.0 : -1.0);
        const double size = (1.0 + off) * limit;
        const double factor = of_angle ? 3.0 : size / dice_between(&die, 1.0, 3.0);
        snprintf(formula, sizeof formula, "%s(%.17g*%s)", dice_one_of(&die, 2) == 0 ? "sin" : "cos",
                 factor, of_angle ? "a" : "x/u");
        for (unsigned k = dice_one_of(&die, 4); k > 0; k--) {
            put_around(formula, &column,
                       around[dice_one_of(&die, sizeof around / sizeof around[0])]);
        }
        put_around(formula, &column, "Q(x) = 1 [N]*(@)");
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\nparameter u = 1 [m]\nlet e0 = 2 + x/u\n"
            "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\nV = 1 [J]*cos(a)\n%s\n"
            "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
            formula);
        derived d = scene_of(text);
        TEST_ASSERT_EQUAL_INT(1, d.image->angles);
        const double angle_rad = of_angle ? size / factor : 0.3;
        const double real[] = {of_angle ? 0.7 : size / factor, 0.0, 0.0};
        const nonfinite_at at = {.image = d.image,
                                 .real = real,
                                 .angle_rad = &angle_rad,
                                 .turns = turns,
                                 .when = "then"};
        char *told = told_of(&at, nonfinite_term);
        const bool wanted = off > 0.0 && !(turns && of_angle);
        TEST_ASSERT_EQUAL_MESSAGE(wanted, told[0] != '\0', text);
        if (wanted) {
            char where[40];
            char hint[100];
            snprintf(where, sizeof where, ":8:%d: error: then the force", column + 1);
            snprintf(hint, sizeof hint,
                     "() of %.6g rad, but sine and cosine are computed only up to %g rad", size,
                     limit);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, where), told);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, hint), told);
            told_of_sines++;
        }
        free(told);
        derived_free(&d);
    }
    TEST_ASSERT_TRUE(told_of_sines > 10);
}

SUITE(undefined_where) { die = dice_of("undefined_where", 69); }
