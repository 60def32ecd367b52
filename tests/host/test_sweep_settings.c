/* test_sweep_settings.c: a sweep's header, the settings that stand beside its file, and its points as workers run them: each
 * way in which one ends, which gives everything back. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "host/base/alloc.h"
#include "host/study/session.h"
#include "made_sweep.h"
#include "unity.h"

void suite_sweep_settings(void);

static dice die;

/* --- headers and settings ----------------------------------------------------------------------------------------*/

/* As RFC 4180 has it: read back, they are the names. */
static void test_headers(void) {
    static const char *const asked[] = {"x",      "max(x, y)", "amplitude(x)", " x' ",
                                        "x\t+ y", "max(x,y)",  "min(y)",       "2*x"};
    for (unsigned c = 0; c < 30U; c++) {
        made_sweep m;
        const char *const axes[] = {"x=1..9:9", "y'=1..9:9", "step=1..2:2"};
        const char *names[8];
        const int count = 1 + (int)dice_one_of(&die, 8);
        const int swept = (int)dice_one_of(&die, 3) + 1;
        char *text = NULL;
        size_t length = 0;
        for (int i = 0; i < count; i++) {
            names[i] = asked[dice_one_of(&die, 8)];
        }
        made_sweep_open(&m, made_sweep_floor, axes, swept, names, count, &engine_double);
        FILE *out = alloc_text(&text, &length);
        sweep_header(&m.sweep, out);
        alloc_text_end(out);
        const char *at = text;
        for (int i = 0; i < swept + count + 1; i++) {
            char field[80];
            size_t size = 0;
            const bool quoted = *at == '"';
            at += quoted ? 1 : 0;
            while (quoted ? !(at[0] == '"' && at[1] != '"') : strchr(",\r", *at) == NULL) {
                at += *at == '"' ? 1 : 0;
                field[size++] = *at++;
            }
            field[size] = '\0';
            at += quoted ? 1 : 0;
            const char *name = i < swept           ? m.grid.axes[i].column
                               : i < swept + count ? names[i - swept]
                                                   : "energy_left_over";
            TEST_ASSERT_EQUAL_STRING(name + (i < swept ? 0 : strspn(name, " ")), field);
            TEST_ASSERT_EQUAL(strchr(field, ',') != NULL, quoted);
            at = said_exactly(at, i < swept + count ? "," : swept == 3 ? ",end_s\r\n" : "\r\n");
        }
        TEST_ASSERT_EQUAL_STRING("", at);
        free(text);
        made_sweep_close(&m);
    }
}

static const char settings_text[] =
    "mechanism m\ncoordinate x [m]\ncoordinate a [rad]\nparameter m = 2 [kg]\ninput u = 3 [N]\n"
    "T = m*x'^2/2 + 1 [kg*m^2]*a'^2/2\nQ(x) = u\neffect drag \"d\" { parameter b = 4 [N*s/m]; "
    "F += b*x'^2/2 }\n"
    "effect tug { F += 1 [N*s/m]*x'^2 }\nscene s { step 1 [ms]; until 3 [s] }\n";

/* Every setting that decides the rows stands there as it is, to the last digit. */
static void test_settings(void) {
    for (unsigned c = 0; c < 60U; c++) {
        static const char *const axes[] = {"x=1..9:9", "m=0.1..7:70,log"};
        static const char *const asked[] = {"max(x)", "a"};
        made_sweep m;
        const int count = 1 + (int)dice_one_of(&die, 2);
        const engine_kind *kind = c % 2U == 0 ? &engine_float : &engine_double;
        made_sweep_open(&m, settings_text, axes, 2, asked, count, kind);
        instance *base = m.d.instance;
        base->parameter[0] = dice_between(&die, 1.0, 2.0);
        base->input[0] = dice_between(&die, 1.0, 2.0);
        base->start[0][0] = dice_between(&die, 1.0, 2.0);
        base->start[1][1] = dice_between(&die, 1.0, 2.0);
        base->with[0] = dice_one_of(&die, 2) == 0;
        base->step_s = dice_between(&die, 1.0, 2.0);
        base->until_s = dice_between(&die, 1.0, 2.0);
        m.sweep.from_s = dice_between(&die, 0.0, 1.0);
        m.sweep.engine.compensated = dice_one_of(&die, 2) == 0;
        m.sweep.engine.method = (wh_method)dice_one_of(&die, 3);
        m.sweep.engine.matrix = dice_one_of(&die, 2) == 0 ? MATRIX_NONE : MATRIX_EXACT;
        m.sweep.engine.tables = dice_one_of(&die, 2) == 0 ? TABLES_NONE : TABLES_LINEAR;
        m.image->list[IMAGE_STEP]->tables.bits = (int)dice_one_of(&die, 9);
        const shard part = {1 + dice_one_of(&die, 9), 10 + dice_one_of(&die, 90)};
        char *made =
            fingerprint_make(&m.sweep, c % 3U == 0 ? "text" : "other", base, m.image, part);
        char *text = NULL;
        size_t length = 0;
        FILE *out = alloc_text(&text, &length);
        fprintf(out, "whirl sweep: settings of the CSV beside this file, format 3\nscene: s\n");
        /* FNV-1a of eight bytes a letter, the first of which is the letter */
        uint64_t hash = 14695981039346656037ULL;
        for (const char *at = c % 3U == 0 ? "text" : "other"; *at != '\0'; at++) {
            hash = (hash ^ (unsigned char)*at) * 1099511628211ULL;
            for (int i = 1; i < 8; i++) {
                hash *= 1099511628211ULL;
            }
        }
        fprintf(out, "model text: 0x%016llx\n", (unsigned long long)hash);
        fprintf(out, "number: %s%s\n", c % 2U == 0 ? "float" : "double",
                m.sweep.engine.compensated ? ", compensated" : "");
        fprintf(out, "method: %s\nangles: turned\n", wh_methods[m.sweep.engine.method].word);
        if (m.sweep.engine.matrix == MATRIX_EXACT) {
            fprintf(out, "matrix: exact\n");
        }
        if (m.sweep.engine.tables == TABLES_LINEAR) {
            fprintf(out, "tables: linear, %.0f cells\n",
                    pow(2.0, m.image->list[IMAGE_STEP]->tables.bits));
        }
        fprintf(out, "step: %.17g s\nuntil: %.17g s\nmeasured from: %.17g s\n", base->step_s,
                base->until_s, m.sweep.from_s);
        fprintf(out, "effect drag: %s\n", base->with[0] ? "with" : "without");
        fprintf(out, "effect tug: without\n");
        fprintf(out, "set m: %.17g\nset b: 4\nset u: %.17g\n", base->parameter[0], base->input[0]);
        fprintf(out, "start x (0 primes): %.17g\nstart x (1 primes): 0\n", base->start[0][0]);
        fprintf(out, "start a (0 primes): 0\nstart a (1 primes): %.17g\n", base->start[1][1]);
        fprintf(out, "over x: 1 to 9, 9 values\n");
        fprintf(out, "over m: 0.10000000000000001 to 7, 70 values, logarithmic\n");
        fprintf(out, "measure: max(x)\n%sshard: %llu/%llu\noperations: 0x%016llx\n",
                count > 1 ? "measure: a\n" : "", (unsigned long long)part.number,
                (unsigned long long)part.of, (unsigned long long)m.image->hash);
        alloc_text_end(out);
        TEST_ASSERT_EQUAL_STRING(text, made);
        free(text);
        free(made);
        made_sweep_close(&m);
    }
}

/* --- given back --------------------------------------------------------------------------------------------------*/

/* Points as workers run them, in this process: each way in which they end; and whole sittings. */
static void run_points(void) {
    static const struct {
        const char *text;
        const char *over;
        const char *measure;
        bool good;
    } points[] = {
        {made_sweep_floor, "x=-1..1:2", "x", false},        /* refused where it starts */
        {made_sweep_floor, "x=1..2:2", "period(x)", true},  /* none: kept samples */
        {made_sweep_floor, "x=0..2:2", "mean(1/x)", false}, /* no number */
        {settings_text, "m=1..2:2", "max(x)", true},        /* derived anew */
        {settings_text, "m=0..2:2", "max(x)", false},       /* which cannot be */
        {"mechanism m\nstate x\nequation x' = 1 [1/s]*x^2\nscene s { step 1 [ms]; until 2 [s] }\n",
         "x=4..1:2", "x", false}, /* diverges */
        {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [J]*sqrt(x/(1 [m]))\n"
         "scene s { step 1 [ms]; until 2 [s] }\n",
         "x=-1..1:2", "x", false}, /* undefined */
    };
    for (size_t i = 0; i < sizeof points / sizeof points[0]; i++) {
        made_sweep m;
        char *text[2] = {NULL, NULL};
        size_t length[2];
        point_notes notes;
        made_sweep_open(&m, points[i].text, &points[i].over, 1, &points[i].measure, 1,
                        &engine_double);
        FILE *row = alloc_text(&text[0], &length[0]);
        FILE *reason = alloc_text(&text[1], &length[1]);
        const bool good = sweep_point(&m.sweep, 0, row, reason, &notes);
        alloc_text_end(row);
        alloc_text_end(reason);
        TEST_ASSERT_EQUAL_MESSAGE(points[i].good, good, text[1]);
        TEST_ASSERT_EQUAL(good, text[1][0] == '\0');
        TEST_ASSERT_TRUE(strlen(text[0]) > 2 && strchr(text[0], '\r') != NULL);
        free(text[0]);
        free(text[1]);
        made_sweep_close(&m);
    }
}

static void test_given_back(void) {
    static void (*const rounds[])(void) = {run_points, test_headers, test_settings};
    for (size_t i = 0; i < sizeof rounds / sizeof rounds[0]; i++) {
        long before = 0;
        for (int round = 0; round < (i == 0 ? 2 : 1); round++) { /* the others had one before */
            before = blocks_in_use();
            rounds[i]();
        }
        TEST_ASSERT_TRUE(blocks_in_use() == before);
    }
}

void suite_sweep_settings(void) {
    die = dice_of("sweep_settings", 63);
    RUN_TEST(test_headers);
    RUN_TEST(test_settings);
    RUN_TEST(test_given_back);
}
