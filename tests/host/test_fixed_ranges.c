/* test_fixed_ranges.c: ranges and steps of all sizes in fixed point: planning ends, with a step or with a refusal whose
 * hint helps. Coordinates without acceleration still move. */
#include "command.h"
#include "derived.h"
#include "host/base/alloc.h"
#include "host/cli/commands.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"

/* Result and messages of fixed_plan_make(); `report` to be freed. */
static fixed_plan *plan_of(const image *im, char **report) {
    size_t length;
    diags *errors = diags_new();
    fixed_plan *p = fixed_plan_make(im, false, errors);
    FILE *out = alloc_text(report, &length);
    diags_flush(errors, out);
    alloc_text_end(out);
    diags_free(errors);
    return p;
}

static bool is_made(const image *im) {
    char *report;
    fixed_plan *p = plan_of(im, &report);
    const bool made = p != NULL;
    free(report);
    fixed_plan_free(p);
    return made;
}

static void set_ranges(image *im, double size) {
    for (int i = 0; i < im->reals + im->inputs; i++) {
        im->range[i].declared = true;
        im->range[i].low = -size;
        im->range[i].high = size;
    }
}

static const char *const wide[] = {
    "coordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 100 [N/m^3]*x^4/4\n",
    "coordinate x [m]\ninput u = 0 [N]\nT = 1 [kg]*x'^2/2\nV = 1 [N/m^7]*x^8\nF = 3 [N*s/m]*x'^2\nQ(x) = u\n",
    "coordinate x [m]\nT = 1 [kg]*x'^2/2 + 2 [kg/m^2]*x^2*x'^2\nV = 40 [N/m]*x^2/2\n",
    "coordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = -2 [J]*cos(a)\nF = 1e-3 [N*m*s]*a'^2\n",
    ("coordinate a [rad]\ncoordinate b [rad]\n"
     "T = 1 [kg*m^2]*(2*a'^2 + b'^2 + a'*b'*cos(a - b))/2\nV = -2 [J]*cos(a)\n"),
    "state x\nequation x'*1 [s] = -x^3\n",
    "state x\nequation x'*1 [s] = x - x^5\n",
    "state x\nstate p [rad]\nequation x'*1 [s] = -x^3*sin(p)\nequation p'*1 [s] = x^2\n",
    "state x\nstate y\nequation x'*1 [s] = 1/(1 + x^2) - y\nequation y'*1 [s] = x*y\n",
};

/* Following this hint, and the next one, succeeds: by smaller steps, or narrower ranges. */
static void check_hint(image *im, double size, const char *report) {
    const double step_s = im->step_s;
    bool helped = false;
    for (int down = 0; size * pow(0.1, down) > 1e-11 && !helped; down++) {
        set_ranges(im, size * pow(0.1, down));
        for (int k = 0; k <= 4 && !helped; k++) {
            im->step_s = step_s * pow(0.1, k);
            helped = is_made(im);
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(helped, report);
}

TEST(fixed_ranges, ranges_and_steps_of_all_sizes) {
    static const double step_s[] = {1e-6, 1e-4, 1e-3, 1e-2, 1.0};
    int made = 0;
    int refused = 0;
    for (size_t k = 0; k < sizeof wide / sizeof wide[0]; k++) {
        char *text = alloc_words("mechanism m\n%sscene s { until 1 [s] }\n", wide[k]);
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        for (int power = -9; power <= 300;
             power += power < 12 ? (int)few_or_all(4, 1) : (int)few_or_all(96, 32)) {
            for (size_t n = 0; n < sizeof step_s / sizeof step_s[0]; n += few_or_all(2, 1)) {
                const double size = pow(10.0, power);
                char *report;
                set_ranges(d.image, size);
                d.image->step_s = step_s[n];
                fixed_plan *p = plan_of(d.image, &report);
                made += p != NULL;
                if (p == NULL) {
                    refused++;
                    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report, "hint: "), report);
                    check_hint(d.image, size, report);
                }
                free(report);
                fixed_plan_free(p);
            }
        }
        derived_free(&d);
        free(text);
    }
    TEST_ASSERT_GREATER_THAN_INT((int)few_or_all(25, 200), made);
    TEST_ASSERT_GREATER_THAN_INT((int)few_or_all(25, 200), refused);
}

static void run_to_end(const image *im, double *angle, double *real) {
    void *run = engine_fixed.start(im);
    for (uint64_t k = 0; k < im->steps; k++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, engine_fixed.step(run));
    }
    TEST_ASSERT_EQUAL_UINT64(0, engine_fixed.saturated(run));
    engine_fixed.state(run, angle, real);
    engine_fixed.stop(run);
}

/* Half a unit of each step, and of the rate in it. */
static double bound_of(const fixed_plan *p, int at, int rate, double until_s) {
    const double unit = at >= 0 ? ldexp(1.0, -p->format[at].bits) : 1.4629180793e-9;
    const double of_rate = rate >= 0 ? ldexp(1.0, -p->format[rate].bits) : 0.0;
    return 0.51 * (double)p->image->steps * unit + until_s * of_rate;
}

/* Uniform motion: closed forms. */
TEST(fixed_ranges, what_has_no_acceleration_moves) {
    static const struct {
        const char *text;
        int at, rate; /* of the reals; -1: the angle, or absent */
        bool moves;
    } kinds[] = {
        {"coordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nscene s { start a' = %.9f [rad/s]", -1, 0,
         true},
        {"coordinate y [m]\nT = 3 [kg]*y'^2/2\nscene s { start y' = %.9f [m/s]", 0, 1, true},
        {"coordinate t [s]\nT = 1e-9 [J]*t'^2/2\nscene s { start t' = %.9f", 0, 1, true},
        {"coordinate x [m]\ncoordinate t [s]\nT = 2 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\n"
         "V = 50 [N/m]*x^2/2\nQ(x) = 4 [N/s]*t\nscene s { start t' = %.9f",
         1, 3, true},
        {"state c\nstate d\nequation c'*1 [s] = 0\nequation d'*1 [s] = c - d\n"
         "scene s { start c = %.9f",
         0, -1, false},
        {"state c\nequation c'*1 [s] = %.9f\nscene s {", 0, -1, true},
    };
    uint64_t seed = 91;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        for (int i = 0; i < 12; i++) {
            double angle[4] = {0};
            double real[4] = {0};
            const double value = pow(10.0, random_between(&seed, -2.0, 2.0));
            const double until_s = 2.0;
            char *with = alloc_words(kinds[k].text, value);
            char *text = alloc_words("mechanism m\n%s; step %d [us]; until 2 [s] }\n", with,
                                     (int[]){50, 100, 500, 1000, 5000, 20000}[i % 6]);
            derived d = derived_scene(text, "s");
            char *report;
            derived_expect(&d, text);
            fixed_plan *p = plan_of(d.image, &report);
            TEST_ASSERT_NOT_NULL_MESSAGE(p, report);
            d.image->fixed = p;
            run_to_end(d.image, angle, real);
            const double end = kinds[k].at < 0 ? angle[0] : real[kinds[k].at];
            const double expected = kinds[k].moves ? value * until_s : value;
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(bound_of(p, kinds[k].at, kinds[k].rate, until_s) +
                                                  1e-9 * value,
                                              expected, end, text);
            fixed_plan_free(p);
            derived_free(&d);
            free(report);
            free(text);
            free(with);
        }
    }
}

/* A swing so small that a step adds more at the lowest place than the whole range of the rate: with all ranges not
 * declared. */
TEST(fixed_ranges, small_swings) {
    for (int power = -7; power <= 0; power++) {
        char *report;
        char *text = alloc_words("mechanism m\ncoordinate th [rad]\nT = 0.144 [kg*m^2]*th'^2/2\n"
                                 "V = -2.3544 [J]*cos(th)\nF = 0.02 [N*m*s]*th'^2\n"
                                 "scene s { start th = %.9g [rad]; step 1 [ms]; until 2 [s] }\n",
                                 pow(10.0, power));
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        fixed_plan *p = plan_of(d.image, &report);
        TEST_ASSERT_NOT_NULL_MESSAGE(p, report);
        fixed_plan_free(p);
        derived_free(&d);
        free(report);
        free(text);
    }
}

enum { INPUTS_MOST = 3, RANGES_TEXT = 400 };

/* A scene with inputs that push to either side, and these ranges. Returns the message of `whirl derive` on its
 * fixed-point code. */
static void derive_pushed(int inputs, const double *start, const char *ranges, said *what) {
    char text[1500];
    int length = snprintf(text, sizeof text, "mechanism pushed\ncoordinate x [m]\n");
    for (int i = 0; i < inputs; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, "input u%d = %.17g [N]\n",
                           i, start[i]);
    }
    length += snprintf(text + length, sizeof text - (size_t)length,
                       "T = 2 [kg]*x'^2/2\nV = 50 [N/m]*x^2/2\nF = 3 [N*s/m]*x'^2/2\nQ(x) = u0");
    for (int i = 1; i < inputs; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, " + u%d", i);
    }
    snprintf(text + length, sizeof text - (size_t)length,
             "\nscene s { start x = 0.3 [m]; until 1 [s]%s }\n", ranges);
    const char *words[] = {model_keep(text), "--as", "c", "--number", "fixed", NULL};
    command_say(command_derive, words, what);
    model_drop();
}

/* Each input without a range is refused with a hint; pasting the hints suffices. */
TEST(fixed_ranges, inputs_must_declare_ranges) {
    dice d = dice_of("fixed_ranges", 46);
    const unsigned cases = dice_cases(usual_or(24, 8));
    for (unsigned k = 0; k < cases; k++) {
        const int inputs = 1 + (int)(k % INPUTS_MOST);
        const unsigned declared = dice_one_of(&d, 1U << inputs);
        double start[INPUTS_MOST];
        char ranges[RANGES_TEXT] = "";
        size_t length = 0;
        said what;
        for (int i = 0; i < inputs; i++) {
            start[i] = dice_one_of(&d, 4) == 0 ? 0.0 : dice_between(&d, -2.0, 2.0);
            if ((declared >> i & 1U) != 0) { /* around its start, and perhaps zero */
                length += (size_t)snprintf(
                    ranges + length, sizeof ranges - length, "; range u%d = %.17g .. %.17g [N]", i,
                    start[i] - dice_between(&d, 0.1, 3.0), start[i] + dice_between(&d, 0.1, 3.0));
            }
        }
        derive_pushed(inputs, start, ranges, &what);
        const bool all = declared == (1U << inputs) - 1U;
        TEST_ASSERT_EQUAL_INT_MESSAGE(all ? 0 : 2, what.status, what.err);
        const char *at = what.err;
        for (int i = 0; i < inputs; i++) {
            char wanted[40];
            snprintf(wanted, sizeof wanted, "range of the input 'u%d'", i);
            TEST_ASSERT_TRUE_MESSAGE(
                (strstr(what.err, wanted) != NULL) == ((declared >> i & 1U) == 0), what.err);
        }
        while ((at = strstr(at, "in the scene: ")) != NULL) {
            at += strlen("in the scene: ");
            length += (size_t)snprintf(ranges + length, sizeof ranges - length, "; %.*s",
                                       (int)strcspn(at, "\n"), at);
        }
        derive_pushed(inputs, start, ranges, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    }
}
