/* test_choice.c: the two answers of `whirl choose` (host/study/choice.h) to random requests, compared with an
 * exhaustive search; and the table of rows from which it chooses (price_table.h). */
#include "derived.h"

#include "command.h"
#include "host/base/alloc.h"
#include "host/cli/pricing_scene.h"
#include "host/emit/emit.h"
#include "host/engine/start.h"
#include "host/study/choice.h"

static const char *const texts[] = {
    "mechanism spring\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 90 [N/m]*x^2/2\n"
    "F = 0.3 [N*s/m]*x'^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
    "mechanism pendulum\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = -20 [J]*cos(a)\n"
    "scene s { start a = 2.5 [rad]; step 1 [ms]; until 1 [s] }\n",
    "mechanism cart\ncoordinate x [m]\ncoordinate a [rad]\ninput u = 2 [N]\n"
    "T = 2 [kg]*x'^2/2 + 0.5 [kg]*((x' + 0.4 [m]*a'*cos(a))^2 + (0.4 [m]*a'*sin(a))^2)/2\n"
    "V = -0.5 [kg]*9.81 [m/s^2]*0.4 [m]*cos(a)\nQ(x) = u\n"
    "scene s { start a = 1 [rad]; step 1 [ms]; until 1 [s] }\n",
    "mechanism decay\nstate y\nequation y' + 4 [1/s]*y + 1 [1/s]*y^3 = 1 [1/s]\n"
    "scene s { start y = 3; step 1 [ms]; until 1 [s] }\n"};
enum { SPRING, PENDULUM, CART, TEXTS = sizeof texts / sizeof texts[0] };

static const char *const boards[] = {"mps2-an386", "atmega328p", "mps2-an385"};

typedef struct request {
    derived d;
    overrides changes;
    grid grid;
    diags *errors;
    pricing_scene *scene;
    trials trial;
    choice_request asked;
    table *made;
} request;

static void open_request(request *q, const char *text, const char *board, double rate_Hz) {
    *q = (request){.d = derived_scene(text, "s"), .errors = diags_new()};
    derived_expect(&q->d, text);
    q->scene = pricing_scene_new(q->d.model->mechanisms[0], q->d.model->scenes[0], &q->changes,
                                 &q->grid, q->errors);
    const trial_request asked = {.source = &q->scene->source,
                                 .board = cost_board_named(board),
                                 .spacing = ratio_of(1.0 / rate_Hz),
                                 .records = (int)(rate_Hz + 0.5)};
    TEST_ASSERT_TRUE(trial_begin(&q->trial, &asked));
    TEST_ASSERT_TRUE(q->trial.reliable);
    q->asked = (choice_request){
        .table = {.rate_Hz = rate_Hz, .periods = 1, .operations = 8e8, .workers = 2}};
}

static void close_request(request *q) {
    table_free(q->made);
    trial_end(&q->trial);
    pricing_scene_free(q->scene);
    diags_free(q->errors);
    derived_free(&q->d);
}

/* Does this setting, with this number of steps per period, meet all limits? Computed independently of
 * host/study/choice.c. *worst: cycles per second by the largest stated number per step (of instructions if cycles are
 * unknown). */
static bool keeps(request *q, const setting *s, uint64_t substeps, double *worst) {
    bool own;
    const deviation_pace pace = {substeps, 1};
    const cost c = trial_cost(&q->trial, s, pace, &own);
    const cost_figure *f =
        c.cycles_worst.basis != COST_NOT_KNOWN ? &c.cycles_worst : &c.instructions_worst;
    *worst = f->most * (double)substeps * q->asked.table.rate_Hz;
    if (!own || c.instructions_worst.basis == COST_NOT_KNOWN ||
        (q->asked.clock_Hz > 0.0 && *worst > q->asked.clock_Hz) ||
        (q->asked.flash_bytes > 0.0 && c.flash_bytes.most > q->asked.flash_bytes) ||
        (q->asked.ram_bytes > 0.0 && c.ram_bytes.most + c.stack_bytes.most > q->asked.ram_bytes)) {
        return false;
    }
    const trial_result r = trial_run(&q->trial, s, pace);
    return r.ran && r.usable && 2.0 * r.error <= q->asked.table.error;
}

static choice choose(request *q) {
    table_free(q->made);
    q->made = table_new(&q->trial, &q->asked.table);
    return choice_make(&q->trial, q->made, &q->asked);
}

static const table_row *row_of(const request *q, const choice_row *r) {
    return &q->made->row[r->row];
}

enum { SUBSTEPS_MOST = 40 };

/* Exhaustive search: the least cycles and flash of all settings and numbers of substeps that meet all limits.
 * Without WHIRL_FULL, only each fifth setting is tried. */
static void try_all(request *q, double *cycles, double *flash) {
    *cycles = *flash = (double)INFINITY;
    for (int i = 0; i < setting_count(); i += (int)few_or_all(5, 1)) {
        const setting s = setting_at(i);
        bool kept = !setting_is_asked(&s, NULL);
        for (int k = 0; !kept; k++) {
            double worst;
            bool own;
            deviation_pace pace;
            if (!table_pace(&q->asked.table, k, &pace) || pace.steps > SUBSTEPS_MOST) {
                break;
            }
            kept = keeps(q, &s, pace.steps, &worst);
            if (kept) {
                const cost c = trial_cost(&q->trial, &s, pace, &own);
                *cycles = fmin(*cycles, worst);
                *flash = fmin(*flash, c.flash_bytes.value);
            }
        }
    }
}

TEST(choice, drawn_requests) {
    dice d = dice_of("choice", 501);
    const unsigned cases = dice_cases(few_or_all(4, 20));
    int found = 0;
    for (unsigned n = 0; n < cases; n++) {
        static const double rates[] = {20.0, 50.0, 80.0, 100.0};
        request q;
        const char *text = texts[dice_one_of(&d, TEXTS)];
        const char *board = boards[dice_one_of(&d, 3)];
        open_request(&q, text, board, rates[dice_one_of(&d, 4)]);
        q.asked.table.error = pow(10.0, dice_between(&d, -5.0, -1.0));
        q.asked.clock_Hz = dice_one_of(&d, 3) == 0 ? 0.0 : pow(10.0, dice_between(&d, 3.5, 7.0));
        q.asked.flash_bytes = dice_one_of(&d, 3) == 0 ? dice_between(&d, 4000.0, 9000.0) : 0.0;
        q.asked.ram_bytes = dice_one_of(&d, 4) == 0 ? dice_between(&d, 200.0, 700.0) : 0.0;
        const choice c = choose(&q);
        double cycles;
        double flash;
        char what[200];
        snprintf(what, sizeof what, "case %u: %.20s on %s, error %.3g, %g Hz, clock %g, flash %g",
                 n, text, board, q.asked.table.error, q.asked.table.rate_Hz, q.asked.clock_Hz,
                 q.asked.flash_bytes);
        try_all(&q, &cycles, &flash);
        if (c.of[CHOICE_FASTEST].row >= 0) {
            double worst;
            const choice_row *const answers[] = {&c.of[CHOICE_FASTEST], &c.of[CHOICE_SMALLEST]};
            found++;
            for (int i = 0; i < 2; i++) {
                const table_row *r = row_of(&q, answers[i]);
                TEST_ASSERT_TRUE_MESSAGE(keeps(&q, &r->setting, r->pace.steps, &worst), what);
                TEST_ASSERT_TRUE_MESSAGE(fabs(worst / answers[i]->worst - 1) < 0.03, what);
            }
            TEST_ASSERT_TRUE_MESSAGE(c.of[CHOICE_FASTEST].worst <= cycles * 1.03, what);
            TEST_ASSERT_TRUE_MESSAGE(
                row_of(&q, &c.of[CHOICE_SMALLEST])->cost.flash_bytes.value <= flash * 1.03, what);
        } else {
            TEST_ASSERT_TRUE_MESSAGE(isinf(cycles) || q.made->broken_off > 0, what);
        }
        close_request(&q);
    }
    printf("  %u requests, %d with an answer\n", cases, found);

    TEST_ASSERT_TRUE(found > 0 && found < (int)cases);
}

static bool is_same(const table_row *a, const table_row *b) {
    return setting_order(&a->setting) == setting_order(&b->setting) &&
           a->pace.steps == b->pace.steps && a->pace.records == b->pace.records &&
           a->result.error == b->result.error && a->price.value == b->price.value;
}

/* With the same effort, the rows do not depend on the number of processors. With less effort there are fewer rows,
 * and the output says so. */
TEST(choice, rows_depend_only_on_the_effort) {
    for (int n = 0; n < TEXTS; n++) {
        request q;
        open_request(&q, texts[n], boards[n % 3], 50.0);
        table_request w = {.operations = 2e7, .periods = 1, .workers = 1};
        table *one = table_new(&q.trial, &w);
        w.workers = 3;
        table *three = table_new(&q.trial, &w);
        w.operations = 2e6;
        table *less = table_new(&q.trial, &w);
        TEST_ASSERT_EQUAL_INT(one->count, three->count);
        for (int i = 0; i < one->count; i++) {
            TEST_ASSERT_TRUE_MESSAGE(is_same(&one->row[i], &three->row[i]), texts[n]);
        }
        TEST_ASSERT_TRUE_MESSAGE(less->count < one->count && less->broken_off > one->broken_off,
                                 texts[n]);
        for (int i = 0; i < less->count; i++) {
            int k = 0;
            while (k < one->count && !is_same(&less->row[i], &one->row[k])) {
                k++;
            }
            TEST_ASSERT_TRUE_MESSAGE(k < one->count, texts[n]);
        }
        table_free(one);
        table_free(three);
        table_free(less);
        close_request(&q);
    }
}

/* If no setting meets the limits, the answer names a faster clock and a larger error limit. With either of the two,
 * a setting must be found; with 2 % less than that, none must be found. */
TEST(choice, named_clock_and_error_limit_suffice) {
    request q;
    open_request(&q, texts[1], "atmega328p", 100.0);
    q.asked.table.error = 1e-5;
    q.asked.clock_Hz = 2e5;
    const choice c = choose(&q);
    TEST_ASSERT_TRUE(c.of[CHOICE_FASTEST].row < 0 && c.of[CHOICE_DEARER].row >= 0);
    choice_request w = q.asked;
    w.clock_Hz = q.asked.clock_Hz * c.of[CHOICE_DEARER].load_most * (1.0 + 1e-9);
    TEST_ASSERT_TRUE_MESSAGE(choice_make(&q.trial, q.made, &w).of[CHOICE_FASTEST].row >= 0,
                             "a faster chip");
    w.clock_Hz *= 0.98;
    TEST_ASSERT_TRUE_MESSAGE(choice_make(&q.trial, q.made, &w).of[CHOICE_FASTEST].row < 0,
                             "a slower one");
    if (c.of[CHOICE_WEAKER].row >= 0) {
        w = q.asked;
        w.table.error =
            TABLE_MARGIN * row_of(&q, &c.of[CHOICE_WEAKER])->result.error * (1.0 + 1e-9);
        TEST_ASSERT_TRUE(choice_make(&q.trial, q.made, &w).of[CHOICE_FASTEST].row >= 0);
        w.table.error *= 0.98;
        TEST_ASSERT_TRUE(choice_make(&q.trial, q.made, &w).of[CHOICE_FASTEST].row < 0);
    }
    close_request(&q);
}

/* Each answer must have the least of its figure among the made-up rows that keep the limits it must keep. */
TEST(choice, answers_are_minima_of_allowed_rows) {
    enum { ROWS = 12 };
    static const struct {
        bool error, load, memory; /* limits that must be kept */
        int figure;               /* 0: cycles, 1: flash, 2: error */
    } kinds[CHOICES] = {{true, true, true, 0},  {true, true, true, 1},  {false, true, true, 2},
                        {true, false, true, 0}, {true, true, false, 1}, {true, false, false, 0}};
    dice d = dice_of("choice answers", 502);
    request q;
    open_request(&q, texts[0], "atmega328p", 100.0); /* a step of 10 ms */
    const choice_request w = {
        .table = {.error = 1e-2}, .clock_Hz = 5e6, .flash_bytes = 5000.0, .ram_bytes = 500.0};
    int none[CHOICES] = {0};
    for (unsigned n = 0; n < dice_cases(300); n++) {
        table_row row[ROWS];
        for (int i = 0; i < ROWS; i++) {
            row[i] = (table_row){.setting = setting_at(0), .pace = {1, 1}};
            row[i].result.error = pow(10.0, dice_between(&d, -3.0, 0.0));
            row[i].cost.cycles_worst = cost_known(dice_between(&d, 3e4, 2e5), COST_SIMULATED);
            row[i].cost.flash_bytes = cost_known(dice_between(&d, 3e3, 9e3), COST_MEASURED);
            row[i].cost.ram_bytes = cost_known(dice_between(&d, 100.0, 500.0), COST_MEASURED);
            row[i].cost.stack_bytes = cost_known(dice_between(&d, 100.0, 500.0), COST_MEASURED);
        }
        const table made = {.row = row, .count = ROWS, .why = ""};
        const choice c = choice_make(&q.trial, &made, &w);
        for (int k = 0; k < CHOICES; k++) {
            double least = (double)INFINITY;
            double is = (double)INFINITY;
            for (int i = 0; i < ROWS; i++) {
                const double of[] = {row[i].cost.cycles_worst.value, row[i].cost.flash_bytes.value,
                                     row[i].result.error};
                const double ram = row[i].cost.ram_bytes.value + row[i].cost.stack_bytes.value;
                if ((!kinds[k].error || 2.0 * of[2] <= 1e-2) && (!kinds[k].load || of[0] <= 5e4) &&
                    (!kinds[k].memory || (of[1] <= 5000.0 && ram <= 500.0))) {
                    least = fmin(least, of[kinds[k].figure]);
                }
                is = c.of[k].row == i ? of[kinds[k].figure] : is;
            }
            TEST_ASSERT_TRUE(is == least);
            none[k] += isinf(least) ? 1 : 0;
        }
    }
    TEST_ASSERT_TRUE(none[CHOICE_FASTEST] > 30 && none[CHOICE_FASTEST] < 300);
    close_request(&q);
}

/* The C code of the scene with this setting; NULL if the setting is not possible for the scene. The caller frees the
 * text. */
static char *code_of(const request *q, const setting *s, bool *own) {
    char *text;
    size_t length;
    image *im = q->scene->source.make(q->scene, 0, s, NULL, NULL);
    *own = im != NULL && setting_is_own(s, im);
    if (im == NULL) {
        return NULL;
    }
    FILE *out = alloc_text(&text, &length);
    emit_c(out, im, "a file");
    alloc_text_end(out);
    image_free(im);
    return text;
}

/* If several settings generate the same code, exactly one of them counts as a setting of the scene. */
TEST(choice, settings_with_equal_code_count_once) {
    for (int n = 0; n < TEXTS; n++) {
        request q;
        open_request(&q, texts[n], "mps2-an386", 20.0);
        const int count = setting_count();
        char **code = alloc(count, sizeof *code);
        bool *own = alloc(count, sizeof *own);
        int kinds[3] = {0};
        for (int i = 0; i < count; i++) {
            const setting s = setting_at(i);
            code[i] = code_of(&q, &s, &own[i]);
            kinds[0] += own[i];
            kinds[1] += own[i] && s.image.matrix != MATRIX_NONE;
            kinds[2] += own[i] && s.image.tables != TABLES_NONE;
        }
        for (int i = 0; i < count; i++) {
            const setting s = setting_at(i);
            int same = 0;
            for (int k = 0; k < count && code[i] != NULL; k++) {
                const setting other = setting_at(k);
                same +=
                    k != i && own[k] && other.number == s.number && strcmp(code[i], code[k]) == 0;
            }
            char options[SETTING_TEXT];
            setting_options(&s, true, options);
            diags *unsaid = diags_new();
            image *im = code[i] == NULL ? NULL : q.scene->source.make(q.scene, 0, &s, NULL, NULL);
            const bool takes = im != NULL && start_has_method(im, s.image.method, unsaid);
            TEST_ASSERT_EQUAL_INT_MESSAGE(own[i] || !takes ? 0 : 1, same, options);
            TEST_ASSERT_TRUE_MESSAGE(takes || !own[i], options);
            image_free(im);
            diags_free(unsaid);
        }
        for (int i = 0; i < count; i++) {
            free(code[i]);
        }
        free(code);
        free(own);
        printf("  %.20s: %d settings, %d matrices, %d with tables\n", texts[n], kinds[0], kinds[1],
               kinds[2]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(n == SPRING ? 2 * 3 : 0, kinds[1], texts[n]);
        TEST_ASSERT_TRUE_MESSAGE((n == PENDULUM || n == CART) == (kinds[2] > 0), texts[n]);
        close_request(&q);
    }
}
