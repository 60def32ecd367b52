/* test_method.c: the first-order form of `whirl derive`, for mechanisms with random names. Each slope must have its
 * component's name and a prime, and the letter of the components must not be the name of a coordinate. Also the
 * effects, the rows of core/method.h, and the ways to compute RK4. */
#include "core/step/ledger_step.h"
#include "host/cli/commands.h"
#include "host/engine/start.h"
#include "host/show/show.h"

#include "command.h"
#include "derived.h"
#include "motion.h"

/* === suite first_order ======================================================================== */

enum { COORDINATES_MOST = 5, NAME = 24, COMPONENTS = 2 * COORDINATES_MOST };

static const char *const names[] = {"a", "y1", "b", "s2", "x", "y", "w3", "s", "y23", "q4", "y1b"};
enum { NAMES = sizeof names / sizeof names[0] };

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

static int number_behind(const char *letter, const char *word) {
    const size_t length = strlen(letter);
    const char *digits = word + length;
    const bool is = strncmp(word, letter, length) == 0 && digits[0] != '\0' &&
                    strspn(digits, "0123456789") == strlen(digits);
    return is ? (int)strtol(digits, NULL, 10) : 0;
}

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
    for (int i = 0; i < count; i++) { /* no component is named by this letter and a number */
        TEST_ASSERT_EQUAL_INT(0, number_behind(letter, part[i]));
    }
}

TEST(first_order, slopes_of_components) {
    dice d = dice_of("first-order forms", 20261124);
    const unsigned cases = dice_cases(60);
    for (unsigned c = 0; c < cases; c++) {
        char text[1200];
        const int count = 1 + (int)dice_one_of(&d, COORDINATES_MOST);
        write(&d, text, sizeof text, count);
        derived made = derived_surely(derived_scene(text, "s"), text);
        FILE *out = tmpfile();
        TEST_ASSERT_NOT_NULL(out);
        show_text(out, made.equations);
        check_form(out, count);
        fclose(out);
        derived_free(&made);
    }
}

TEST(first_order, effects_are_listed) {
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
        COMMAND_SAY(command_derive, &what, file, "--with", list);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        for (unsigned k = 0; k < EFFECTS; k++) {
            char line[60];
            snprintf(line, sizeof line, "  with       e%u         word %u\n", k, k);
            TEST_ASSERT_EQUAL((with >> k & 1U) != 0, strstr(what.out, line) != NULL);
        }
    }
    model_drop();
}

/* === suite method_rows ======================================================================== */
/* The rows of core/method.h must be explicit and have different words. test_method_order.c tests their orders,
 * test_limits.c their stability. */

#define ROUNDING 1e-6 /* round-off of sums of a few shares, in float */

typedef struct butcher {
    int stages;
    double a[WH_STAGES_MAX][WH_STAGES_MAX];
    double b[WH_STAGES_MAX];        /* b: weights of the rates */
    double position[WH_STAGES_MAX]; /* weights of the positions */
    double c[WH_STAGES_MAX];
} butcher;

static butcher row_of(int method) {
    const wh_tableau *t = wh_tableau_of((wh_method)method);
    butcher made = {.stages = (int)t->stages};
    for (int i = 0; i < made.stages; i++) {
        made.b[i] = (double)(t->rates[i] / t->parts);
        made.position[i] = (double)(t->positions[i] / t->parts);
        for (int j = 0; j < made.stages; j++) {
            made.a[i][j] = (double)(t->stage[i].share[j] / t->stage[i].parts);
            made.c[i] += made.a[i][j];
        }
    }
    return made;
}

static bool near(double a, double b) { return fabs(a - b) < ROUNDING; }

TEST(method_rows, rows_are_explicit) {
    for (int m = 0; m < WH_METHODS; m++) {
        const butcher t = row_of(m);
        const char *word = wh_methods[m].word;
        TEST_ASSERT_TRUE_MESSAGE(wh_methods[m].stages == t.stages, word);
        for (int i = 0; i < t.stages; i++) {
            for (int j = i; j < t.stages; j++) {
                TEST_ASSERT_TRUE_MESSAGE(t.a[i][j] == 0.0, word);
                const wh_places *places = wh_tableau_of((wh_method)m)->places;
                TEST_ASSERT_TRUE_MESSAGE(places == NULL || (places->reach[i].share[j] == 0.0F &&
                                                            places->reach[i].parts != 0.0F),
                                         word);
            }
        }
    }
}

/* The position weights of a method for any system must be b A: the Runge-Kutta method applied to x' = f(x). */
TEST(method_rows, positions_follow_from_the_rates) {
    for (int m = 0; m < WH_METHODS; m++) {
        const butcher t = row_of(m);
        double off = 0.0;
        double all = 0.0;
        for (int j = 0; j < t.stages; j++) {
            double wanted = 0.0;
            for (int i = 0; i < t.stages; i++) {
                wanted += t.b[i] * t.a[i][j];
            }
            off = fmax(off, fabs(t.position[j] - wanted));
            all += t.position[j];
        }
        const bool runge_kutta =
            wh_methods[m].takes == WH_ANY_SYSTEM && wh_tableau_of((wh_method)m)->places == NULL;
        TEST_ASSERT_TRUE_MESSAGE(!runge_kutta || off < ROUNDING, wh_methods[m].word);
        TEST_ASSERT_TRUE_MESSAGE(wh_methods[m].takes == WH_ANY_SYSTEM || off > ROUNDING,
                                 wh_methods[m].word);
        TEST_ASSERT_TRUE_MESSAGE(wh_methods[m].order < 2 || near(all, 0.5), wh_methods[m].word);
    }
}

TEST(method_rows, ledger_weights_equal_the_rates_weights) {
    for (int m = 0; m < WH_METHODS; m++) {
        const butcher t = row_of(m);
        for (int i = 0; i < t.stages; i++) {
            TEST_ASSERT_TRUE(near((double)wh_ledger_weight((wh_method)m, (unsigned)i), t.b[i]));
        }
    }
}

TEST(method_rows, words_are_unique_and_plain) {
    for (int m = 0; m < WH_METHODS; m++) {
        const wh_method_row *row = &wh_methods[m];
        TEST_ASSERT_TRUE(row->word[0] >= 'a' && row->word[0] <= 'z');
        TEST_ASSERT_TRUE(strspn(row->word, "abcdefghijklmnopqrstuvwxyz0123456789-") ==
                         strlen(row->word));
        TEST_ASSERT_TRUE(strncmp(row->name, "WH_", 3) == 0 && row->title[0] != '\0');
        for (int k = 0; k < m; k++) {
            TEST_ASSERT_TRUE(strcmp(row->word, wh_methods[k].word) != 0);
            TEST_ASSERT_TRUE(strcmp(row->title, wh_methods[k].title) != 0);
        }
    }
    TEST_ASSERT_TRUE(wh_method_takes(WH_METHOD_DEFAULT, WH_FIRST_ORDER));
    TEST_ASSERT_TRUE(!wh_method_takes((wh_method)WH_METHODS, WH_SECOND_ORDER));
}

static unsigned times_in(const char *text, const char *word) {
    const char *const signs = " ,;()";
    unsigned times = 0;
    for (const char *at = text + strspn(text, signs); *at != '\0';) {
        const size_t length = strcspn(at, signs);
        times += length == strlen(word) && strncmp(at, word, length) == 0 ? 1U : 0U;
        at += length;
        at += strspn(at, signs);
    }
    return times;
}

/* The sentence must name each method once and the default first, or only the methods for one form. Old text in the
 * buffer must not matter. */
TEST(method_rows, sentences_have_each_method_once) {
    char text[METHODS_TEXT_SIZE];
    char first[80];
    memset(text, 'x', sizeof text);
    TEST_ASSERT_TRUE(methods_in_help(text) == text);
    snprintf(first, sizeof first, "%s (default), ", wh_methods[WH_METHOD_DEFAULT].word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, strncmp(text, first, strlen(first)), text);
    for (int m = 0; m < WH_METHODS; m++) {
        TEST_ASSERT_EQUAL_UINT_MESSAGE(1, times_in(text, wh_methods[m].word), text);
    }
    for (int form = WH_SECOND_ORDER; form <= WH_FIRST_ORDER; form++) {
        memset(text, 'x', sizeof text);
        TEST_ASSERT_TRUE(methods_of_form((wh_form)form, text) == text);
        for (int m = 0; m < WH_METHODS; m++) {
            const bool named =
                wh_method_takes((wh_method)m, (wh_form)form) && wh_methods[m].takes != WH_NO_RATES;
            TEST_ASSERT_EQUAL_UINT_MESSAGE(named, times_in(text, wh_methods[m].word), text);
        }
    }
}

/* === suite rk4 ================================================================================ */
/* `rk4` compared with core/rk4.h: one step of each built-in scene without contacts, from random states, with rotated
 * sines, with sines from a table, and with the energy balance. */

enum { DRAWS = 5, VALUES = 3 * IMAGE_COMPONENTS_MAX };

static uint64_t seed;
static int compared; /* number of compared steps */

/* Does one step from the state `from` (angles first, rad) with this engine. Returns false if the step is refused. */
static bool step_from(const motion *m, const engine_kind *kind, const double *from, double *to) {
    for (int i = 0; i < m->image->angles; i++) {
        m->image->start_rad[i] = from[i];
        m->image->start_turns[i] = 0;
    }
    for (int i = 0; i < m->image->reals; i++) {
        m->image->start_real[i] = from[m->image->angles + i];
    }
    void *run = kind->start(m->image);
    TEST_ASSERT_NOT_NULL(run);
    const bool done = kind->step(run) == WH_OK;
    kind->state(run, to, to + m->image->angles);
    kind->stop(run);
    return done;
}

static double largest(const double *from, const double *to, int begin, int end) {
    double size = 0.0;
    for (int k = begin; k < end; k++) {
        size = fmax(size, fmax(fabs(from[k]), fabs(to[k])));
    }
    return size;
}

/* The scale of round-off if terms cancel: the largest component of the same kind as i (angles, positions or rates)
 * before and after the step, plus the change of position. */
static double size_of(const image *im, int i, const double *from, const double *to) {
    const int count = im->angles + im->reals;
    const int rates = im->form == WH_SECOND_ORDER ? im->coordinates : im->angles;
    const double way = im->step_s * largest(from, to, rates, count);
    return i < im->angles ? fmax(way, largest(from, to, 0, im->angles))
           : i < rates    ? fmax(way, largest(from, to, im->angles, rates))
                          : largest(from, to, rates, count);
}

static void compare(const motion *path, const motion *plain, const engine_kind *kind,
                    const double *from, double within, const char *name) {
    double one[VALUES];
    double other[VALUES];
    const bool done = step_from(path, kind, from, one);
    TEST_ASSERT_EQUAL_INT_MESSAGE(done, step_from(plain, kind, from, other), name);
    for (int i = 0; i < plain->image->angles + plain->image->reals; i++) {
        const double size = size_of(plain->image, i, from, other);
        TEST_ASSERT_TRUE_MESSAGE(fabs(one[i] - other[i]) <= within * size, name);
    }
    compared++;
}

static int paths_of_a_scene(const scene *s) {
    stepping how = {.kind = &engine_double, .method = WH_RK4_PLAIN};
    motion plain;
    motion_open(&plain, s->name, how);
    how.method = WH_RK4;
    static unsigned scenes;
    const unsigned first = scenes++;
    for (unsigned n = 0; n < usual_or(3, 1) && plain.image->contacts == 0; n++) {
        const unsigned i = (first + n) % 3U;
        how.angles = i == 1 ? ANGLES_LOOKUP : ANGLES_TURNED;
        how.ledger = i == 2;
        if (how.ledger && !plain.image->has_energies) {
            continue;
        }
        motion path;
        motion_open(&path, s->name, how);
        for (int k = 0; k < DRAWS && motion_step(&plain, 1 + random_bits(&seed) % 50) == WH_OK;
             k++) {
            double from[VALUES];
            plain.kind->state(plain.run, from, from + plain.image->angles);
            compare(&path, &plain, &engine_double, from, 1e-13, s->name);
            compare(&path, &plain, &engine_float, from, 4.0 * (double)FLT_EPSILON, s->name);
        }
        motion_close(&path);
    }
    motion_close(&plain);
    return 1;
}

TEST(rk4, all_paths_equal_the_plain_one) {
    each_builtin_scene(paths_of_a_scene);
    TEST_ASSERT_TRUE(compared > (int)usual_or(500, 200));
}

SUITE(rk4) { seed = 20261129; }
