/* test_leaks.c: memory leaks. After a scene is derived, run, written or refused, as many blocks
 * are in use as before. If the C library has no count, the sanitizers check. */
#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "host/base/alloc.h"
#include "host/base/exit.h"
#include "host/check/findings.h"
#include "host/check/horizon.h"
#include "host/check/summary.h"
#include "host/emit/description.h"
#include "host/emit/emit.h"

/* The first round may allocate caches of the libraries. */
enum { ROUNDS = 2 };

static int check_scene(const scene *s) {
    const long before = blocks_in_use();
    derived d = derived_builtin(s->name);
    derived_free(&d);
    TEST_ASSERT_TRUE_MESSAGE(blocks_in_use() == before, s->name);
    return 1;
}

TEST(leaks, scenes_give_everything_back) {
    TEST_ASSERT_GREATER_THAN_INT(50, each_builtin_scene(check_scene));
}

static const char kept_books[] =
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput u = 2 [N]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
    "V = 9 [N/m]*(x - y)^2/2\nF = 0.5 [N*s/m]*x'^2/2\nQ(y) = u\nstop x >= 0 [m] restitution 0.5\n"
    "scene s { with ledger; start x' = -1 [m/s]; step 1 [ms]; until 1 [s] }\n";

/* Contacts, ledgers, angles, inputs and outputs, a linear mechanism, a system. */
static const char *const scenes[] = {"epicyclic_from_rest", "carriage_stop", "two_mass_relative",
                                     "rig_fixed",           "ball_bounces",  kept_books};

static const image_settings ways[] = {
    {.method = WH_RK4, .compensated = true},
    {.method = WH_RK4, .angles = ANGLES_LOOKUP},
    {.method = WH_RK4, .tables = TABLES_LINEAR},
    {.method = WH_NYSTROEM4, .tables = TABLES_CUBIC, .cells = 64},
    {.method = WH_RK4, .matrix = MATRIX_EXACT},
    {.method = WH_RK4, .matrix = MATRIX_RK4, .compensated = true}};

static void write_all(const image *im) {
    FILE *out = tmpfile();
    TEST_ASSERT_NOT_NULL(out);
    emit_c(out, im, "file.whirl");
    emit_c_header(out, im, "file.whirl");
    describe_json(out, im, "file.whirl");
    describe_text(out, im, "file.whirl");
    fclose(out);
}

static void run_watched(const image *im, const image *plain) {
    static const engine_kind *const kinds[] = {&engine_double, &engine_float};
    for (int k = 0; k < 2; k++) {
        void *run = kinds[k]->start(im);
        run_checks *v = run_checks_open(im, plain, kinds[k], run, NULL);
        wh_status status = WH_OK;
        run_checks_enter(v);
        for (uint64_t i = 0; i < im->steps && status == WH_OK; i++) {
            status = kinds[k]->step(run);
            run_checks_enter(v);
        }
        run_checks_end(v, status);
        FILE *out = tmpfile();
        TEST_ASSERT_NOT_NULL(out);
        status == WH_OK ? findings_say(out, v, true) : findings_say_failed(out, v);
        summary_print(out, im, kinds[k], run, v->books, &v->balance);
        fclose(out);
        run_checks_close(v);
        kinds[k]->stop(run);
        const step_doubling_wish wish = {
            .image = im, .kind = kinds[k], .plain = plain, .books = true};
        step_doubling *t = step_doubling_run(&wish);
        horizon h = horizon_of(t, HORIZON_TOLERANCE);
        horizon_free(&h);
        step_doubling_free(t);
    }
}

static image *made_in(const derived *d, const image_settings *how) {
    diags *errors = diags_new();
    image *im = image_make(d->equations, d->instance->conserve, how, IMAGE_TO_RUN, errors);
    TEST_ASSERT_EQUAL_INT(im == NULL, diags_count(errors) > 0);
    diags_free(errors);
    return im;
}

static int make_all_ways(const char *name) {
    int made = 0;
    derived d =
        strncmp(name, "mechanism", 9) == 0 ? derived_scene(name, "s") : derived_builtin(name);
    derived_expect(&d, name);
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        image *im = made_in(&d, &ways[i]);
        image_settings finer;
        if (im != NULL) {
            (void)step_doubling_plain(&ways[i], &finer);
            image *plain = made_in(&d, &finer);
            im->steps = im->steps < 20 ? im->steps : 20;
            run_watched(im, plain);
            write_all(im);
            image_free(plain);
            made++;
        }
        image_free(im);
    }
    derived_free(&d);
    return made;
}

TEST(leaks, other_settings_give_everything_back) {
    int made = 0;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        long before = 0;
        for (int round = 0; round < ROUNDS; round++) {
            before = blocks_in_use();
            made += make_all_ways(scenes[i]);
        }
        TEST_ASSERT_TRUE_MESSAGE(blocks_in_use() == before, scenes[i]);
    }
    TEST_ASSERT_GREATER_THAN_INT(24, made);
}

#define TWO "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n"

TEST(leaks, what_is_refused_gives_everything_back) {
    static const char *const refused[] = {
        TWO "T = 1 [kg]*x'^2\n",                                     /* no inertia */
        TWO "T = 1 [kg]*(x' + y')^2\n",                              /* singular */
        TWO "T = 1 [kg]*(x'^2 - y'^2)\n",                            /* negative */
        TWO "T = 1 [kg]*(x'^2 + y'^2)/((x - x)/(1 [m]))\n",          /* not finite */
        TWO "T = 1 [kg]*(x'^2 + y'^2)\nV = log(-1)*1 [J]\n",         /* nowhere */
        TWO "T = 1 [kg]*(x'^2 + y'^2)\nscene s { conserve x, y }\n", /* no coordinates remain */
        TWO "T = 1 [kg]*(x'^2 + y'^2)\nV = 1 [N/m]*x^2\nscene s { conserve x }\n",
        "mechanism m\nstate a\nstate b\nequation 1 [s]*(a' + b') = b\nequation a = b\n", /* a constraint */
        "mechanism m\nstate a\nstate b\nequation 1 [s]*(a' + b') = 1\nequation 2 [s]*(a' + b') = a\n",
    };
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        long before = 0;
        for (int round = 0; round < ROUNDS; round++) {
            before = blocks_in_use();
            diags *all = diags_new();
            whirl_model *m = model_parse("t.whirl", refused[i], strlen(refused[i]), all);
            TEST_ASSERT_NOT_NULL_MESSAGE(m, refused[i]);
            const scene *s = m->scene_count > 0 ? m->scenes[0] : NULL;
            instance *inst = instance_make(m->mechanisms[0], s, NULL, all);
            equations *e = inst == NULL ? NULL : equations_derive(inst, all);
            image *p = e == NULL ? NULL
                                 : image_make(e, s == NULL ? NULL : s->conserve, &plainly,
                                              IMAGE_TO_RUN, all);
            TEST_ASSERT_NULL_MESSAGE(p, refused[i]);
            equations_free(e);
            instance_free(inst);
            model_free(m);
            diags_free(all);
        }
        TEST_ASSERT_TRUE_MESSAGE(blocks_in_use() == before, refused[i]);
    }
}

/* Allocations have the full size and, where promised, zeros. Impossible sizes end the program with
 * its message, however they arise. */
enum { BYTES_MOST = 5000 };

static bool all_are(const unsigned char *bytes, size_t count, unsigned char value) {
    for (size_t i = 0; i < count; i++) {
        if (bytes[i] != value) {
            return false;
        }
    }
    return true;
}

TEST(leaks, rooms_of_drawn_sizes) {
    dice d = dice_of("room", 2511);
    for (unsigned i = 0; i < 200; i++) {
        const size_t size = 1U + dice_one_of(&d, 40);
        const size_t head = dice_one_of(&d, 60);
        const int64_t count = (int64_t)dice_one_of(&d, 100);
        const size_t bytes = size * (size_t)count;
        unsigned char *plain = alloc(count, size);
        unsigned char *tail = alloc_tail(head + 1, count, size);
        TEST_ASSERT_TRUE(all_are(plain, bytes, 0));
        TEST_ASSERT_TRUE(all_are(tail, head + 1 + bytes, 0));
        memset(plain, 7, bytes);
        memset(tail, 9, head + 1 + bytes);
        plain = alloc_more(plain, count + 1 + (int64_t)dice_one_of(&d, 100), size);
        TEST_ASSERT_TRUE(all_are(plain, bytes, 7));
        char *copy = alloc_copy((const char *)plain, bytes);
        TEST_ASSERT_TRUE(all_are((const unsigned char *)copy, bytes, 7));
        TEST_ASSERT_EQUAL_CHAR('\0', copy[bytes]);
        free(copy);
        free(tail);
        free(plain);
    }
}

TEST(leaks, words_of_any_length) {
    for (int length = 0; length < BYTES_MOST; length = length * 5 / 4 + 1) {
        char *words = alloc_words("%*s|%d", length, "", length);
        TEST_ASSERT_EQUAL_INT('|', words[length]);
        TEST_ASSERT_EQUAL_INT(length, (int)strtol(words + length + 1, NULL, 10));
        TEST_ASSERT_EQUAL_size_t((size_t)length, strspn(words, " "));
        free(words);
    }
}

TEST(leaks, texts_of_any_length) {
    for (int length = 0; length < BYTES_MOST; length = length * 5 / 4 + 1) {
        char *text = NULL;
        size_t bytes = 0;
        FILE *to = alloc_text(&text, &bytes);
        fprintf(to, "%*s|", length, "");
        alloc_text_end(to);
        TEST_ASSERT_EQUAL_size_t((size_t)length + 1U, bytes);
        TEST_ASSERT_EQUAL_size_t(bytes, strlen(text));
        TEST_ASSERT_EQUAL_INT('|', text[length]);
        free(text);
    }
}

/* Half of SIZE_MAX, rounded up: twice it overflows to 0. */
#define HALF (SIZE_MAX / 2U + 1U)

/* The address sanitizer itself ends a program that asks for an impossible size. */
#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif

static void end_badly(const char *name, const char *mode) {
    FILE *to = fopen(name, mode);
    if (to != NULL) {
        fputs("text", to);
        alloc_text_end(to);
    }
}

/* Impossible requests: negative counts, products and sums that overflow size_t, and sizes that the heap refuses. */
static int ask(int count, char **words) {
    (void)count;
    void *made = NULL;
    switch (words[0][0]) {
    case 'a': made = alloc(-1, 8); break;
    case 'b': made = alloc_more(NULL, -1, 8); break;
    case 'c': made = alloc_tail(8, -1, 8); break;
    case 'd': made = alloc_copy("", SIZE_MAX); break;
    case 'e': made = alloc_more(NULL, 2, HALF + 4U); break;
    case 'f': made = alloc_tail(8, 2, HALF + 4U); break;
    case 'g': made = alloc_tail(SIZE_MAX - 7U, 2, 8); break;
#ifndef SANITIZED
    case 'h': made = alloc(INT64_MAX, 1); break;
    case 'i': made = alloc_more(NULL, INT64_MAX, 1); break;
    case 'j': made = alloc_tail(0, INT64_MAX, 1); break;
    case 'k': made = alloc_copy("", HALF); break;
    case 'l': made = alloc(3, HALF); break;
#endif
    /* Streams with a write error, seen on close or before. */
    case 'm': end_badly("/dev/full", "w"); break;
    case 'n': end_badly("/dev/null", "r"); break;
    default: return 0;
    }
    free(made);
    return 0;
}

#ifdef SANITIZED
#define ASKED "abcdefgmn"
#else
#define ASKED "abcdefghijklmn"
#endif

TEST(leaks, what_there_is_no_room_for) {
    static const char asked[] = ASKED "-";
    for (size_t i = 0; asked[i] != '\0'; i++) {
        const char word[] = {asked[i], '\0'};
        const char *const words[] = {word, NULL};
        const bool ends = asked[i] != '-';
        said what;
        command_say(ask, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(ends ? EXIT_RUN_FAILED : 0, what.status, word);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(ends ? "whirl: out of memory\n" : "", what.err, word);
    }
}
