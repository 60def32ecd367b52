/* test_commands.c: parts of the command line, without a process: lists of effects, built-in names, and whether two
 * names are one file on file systems without inodes. */
#define _XOPEN_SOURCE 700 /* for symlink() and mkdtemp() */
#include "derived.h"

#include <unistd.h>

#include "host/cli/load.h"
#include "host/cli/options.h"

static FILE *listening;
static int before;

static void listen_to_errors(void) {
    fflush(stderr);
    listening = tmpfile();
    TEST_ASSERT_NOT_NULL(listening);
    before = dup(STDERR_FILENO);
    dup2(fileno(listening), STDERR_FILENO);
}

static const char *said(void) {
    static char text[4000];
    fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    rewind(listening);
    const size_t length = fread(text, 1, sizeof text - 1, listening);
    text[length] = '\0';
    fclose(listening);
    return text;
}

static const char *blanks_of(uint64_t *seed) {
    static const char *const some[] = {"", "", " ", "  ", "\t", " \t "};
    return some[random_bits(seed) % (sizeof some / sizeof some[0])];
}

/* Takes `text` as the value of --with (or --without) and stores its names in *o. */
static bool take(common_options *o, bool with, const char *text, bool joined) {
    char option[20];
    char whole[400];
    char value[400];
    int at = 0;
    bool bad = false;
    snprintf(option, sizeof option, with ? "--with" : "--without");
    snprintf(whole, sizeof whole, "%s=%s", option, text);
    snprintf(value, sizeof value, "%s", text);
    char *words[] = {joined ? whole : option, value};
    *o = options_defaults();
    listen_to_errors();
    const bool taken = options_take("run", OPTIONS_CHANGE, 2, words, &at, o, &bad);
    TEST_ASSERT_TRUE(taken);
    TEST_ASSERT_EQUAL_INT(joined ? 1 : 2, at);
    const char *complaint = said();
    TEST_ASSERT_TRUE_MESSAGE(bad == (complaint[0] != '\0'), complaint);
    if (bad) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(complaint, option), complaint);
    }
    return !bad;
}

TEST(commands, lists_of_effects) {
    uint64_t seed = 5050;
    for (int i = 0; i < 400; i++) {
        static const char *const names[] = {"a", "c", "rail_drag", "ledger", "b2"};
        const int count = 1 + (int)(random_bits(&seed) % 5);
        /* 1: an empty name in the list; 2: a name twice */
        const int mistake = (int)(random_bits(&seed) % 3);
        const int which = (int)(random_bits(&seed) % (unsigned)count);
        const bool with = random_bits(&seed) % 2 == 0;
        char text[300] = "";
        for (int k = 0; k < count; k++) {
            const bool gone = mistake == 1 && k == which;
            const char *name = gone ? "" : names[mistake == 2 && k == which ? (k + 1) % count : k];
            strcat(text, blanks_of(&seed));
            strcat(text, name);
            strcat(text, blanks_of(&seed));
            strcat(text, k + 1 < count ? "," : "");
        }
        common_options o;
        const overrides *c = &o.changes;
        const bool good = mistake != 1; /* a repeated name is no mistake */
        TEST_ASSERT_TRUE_MESSAGE(take(&o, with, text, i % 2 == 0) == good, text);
        const char *const *list = with ? c->with : c->without;
        if (mistake == 0) {
            TEST_ASSERT_EQUAL_INT(count, with ? c->with_count : c->without_count);
            TEST_ASSERT_EQUAL_INT(0, with ? c->without_count : c->with_count);
            for (int k = 0; k < count; k++) {
                TEST_ASSERT_EQUAL_STRING(names[k], list[k]);
            }
        }
        options_forget(&o);
    }
}

typedef struct found {
    int code;
    char file[40];
    char name[80];
    char said[4000];
} found;

static found look(const struct builtin_model *models, size_t count, const char *target) {
    found f = {0};
    source_model from;
    listen_to_errors();
    f.code = source_find(&from, models, count, target);
    snprintf(f.said, sizeof f.said, "%s", said());
    TEST_ASSERT_TRUE_MESSAGE((f.code == EXIT_DONE) == (f.said[0] == '\0'), f.said);
    if (f.code == EXIT_DONE) {
        snprintf(f.file, sizeof f.file, "%s", from.file);
        snprintf(f.name, sizeof f.name, "%s", from.name);
    }
    source_close(&from);
    return f;
}

#define BODY "\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
#define MODEL(file, text) \
    { file, text, sizeof(text) - 1 }

static const struct builtin_model made_up[] = {
    MODEL("one.whirl", "mechanism gear" BODY "scene rest { }\nscene spun { }\nmechanism rod" BODY
                       "scene rod { }\nscene falls { }\n"),
    MODEL("two.whirl", "mechanism lever" BODY "scene rest { }\nscene only { }\n"),
    MODEL("three.whirl", "mechanism gear" BODY "scene slow { }\n")};

TEST(commands, built_in_names) {
    static const struct {
        const char *target;
        const char *file; /* NULL: the name must be refused */
        const char *name; /* name of the scene, or the message */
    } all[] = {{"spun", "one.whirl", "spun"},
               {"gear:spun", "one.whirl", "spun"},
               {"gear:slow", "three.whirl", "slow"},
               {"gear:rest", "one.whirl", "rest"},
               {"lever:rest", "two.whirl", "rest"},
               {"lever", "two.whirl", "lever"},
               {"lever:lever", "two.whirl", "lever"},
               {"rod", "one.whirl", "rod"}, /* scene rod, not mechanism rod */
               {"rod:falls", "one.whirl", "falls"},
               {"rest", NULL, "hint: choose one of: gear:rest (one.whirl) lever:rest (two.whirl)"},
               {"gear", NULL, "hint: choose one of: gear:gear (one.whirl) gear:gear (three.whirl)"},
               {"gear:only", NULL, "no built-in scene or mechanism 'gear:only'"},
               {"gear:spum", NULL, "hint: did you mean 'spun'?"},
               {"rod:xyzzy", NULL, "hint: `whirl list` shows the built-in ones"},
               {"gaer:spun", NULL, "hint: `whirl list` shows the built-in ones"},
               {"onyl", NULL, "hint: did you mean 'only'?"},
               {"", NULL, "no file and no built-in"},
               {":", NULL, "no file and no built-in"},
               {":rest", NULL, "no file and no built-in"},
               {"lever:", NULL, "no file and no built-in"},
               {"gear:spun:spun", NULL, "no file and no built-in"}};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        const found f = look(made_up, 3, all[i].target);
        if (all[i].file != NULL) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(EXIT_DONE, f.code, all[i].target);
            TEST_ASSERT_EQUAL_STRING(all[i].file, f.file);
            TEST_ASSERT_EQUAL_STRING(all[i].name, f.name);
        } else {
            TEST_ASSERT_EQUAL_INT_MESSAGE(EXIT_BAD_INPUT, f.code, all[i].target);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(f.said, all[i].name), f.said);
        }
    }
}

static int check_both_names(const scene *s) {
    char both[200];
    snprintf(both, sizeof both, "%s:%s", s->mechanism->name, s->name);
    const found alone = look(builtin_models, builtin_model_count, s->name);
    const found whole = look(builtin_models, builtin_model_count, both);
    TEST_ASSERT_EQUAL_INT_MESSAGE(EXIT_DONE, alone.code, alone.said);
    TEST_ASSERT_EQUAL_INT_MESSAGE(EXIT_DONE, whole.code, whole.said);
    TEST_ASSERT_EQUAL_STRING(alone.file, whole.file);
    TEST_ASSERT_EQUAL_STRING(alone.name, whole.name);
    return 1;
}

TEST(commands, built_in_scenes_by_both_names) {
    TEST_ASSERT_TRUE(each_builtin_scene(check_both_names) > 40);
}

static void write_file(const char *path, const char *text) {
    FILE *out = fopen(path, "w");
    TEST_ASSERT_NOT_NULL(out);
    fputs(text, out);
    fclose(out);
}

/* Finds for every pair of names whether they are one file. Network file systems and WASI have no inodes, so the test
 * also sets the inode of one or both files to zero. */
TEST(commands, one_file_or_two) {
    char folder[] = "/tmp/whirl_files_XXXXXX";
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    enum { NAMES = 6 };
    static const char *const names[NAMES] = {"a", "./a", "soft", "hard", "twin", "b"};
    static const int file[NAMES] = {0, 0, 0, 0, 1, 2}; /* the file to which each name leads */
    char path[NAMES][100];
    for (int i = 0; i < NAMES; i++) {
        snprintf(path[i], sizeof path[i], "%s/%s", folder, names[i]);
    }
    write_file(path[0], "model");
    write_file(path[4], "model"); /* a different file of the same size and probably the same time */
    write_file(path[5], "another");
    TEST_ASSERT_EQUAL_INT(0, symlink("a", path[2]));
    TEST_ASSERT_EQUAL_INT(0, link(path[0], path[3]));
    for (int i = 0; i < NAMES; i++) {
        for (int k = 0; k < NAMES; k++) {
            struct stat one;
            struct stat other;
            TEST_ASSERT_EQUAL_INT(0, stat(path[i], &one));
            TEST_ASSERT_EQUAL_INT(0, stat(path[k], &other));
            const bool same = file[i] == file[k];
            TEST_ASSERT_TRUE(files_are_one(&one, path[i], &other, path[k]) == same);
            TEST_ASSERT_TRUE(files_same(path[i], path[k]) == same);
            /* without the inode of one file, of the other, or of both */
            for (int without = 1; without < 4; without++) {
                struct stat left = one;
                struct stat right = other;
                left.st_ino = (without & 1) != 0 ? 0 : left.st_ino;
                right.st_ino = (without & 2) != 0 ? 0 : right.st_ino;
                /* which then tell no hard links */
                const bool linked =
                    same && (strcmp(names[i], "hard") == 0) != (strcmp(names[k], "hard") == 0);
                TEST_ASSERT_TRUE_MESSAGE(
                    files_are_one(&left, path[i], &right, path[k]) == (same && !linked), path[k]);
            }
        }
    }
    for (int i = NAMES - 1; i >= 0; i--) {
        if (i != 1) {
            TEST_ASSERT_EQUAL_INT(0, unlink(path[i]));
        }
    }
    TEST_ASSERT_EQUAL_INT(0, rmdir(folder));
}

/* Files whose random sizes are close to that of the buffer in read_all() are read to their last byte, or refused
 * with a message that names the limit. */
TEST(commands, files_are_read_whole_or_refused) {
    char path[] = "/tmp/whirl-XXXXXX";
    const int file = mkstemp(path);
    TEST_ASSERT_TRUE(file >= 0);
    uint64_t seed = 2;
    for (unsigned c = 0; c < 40; c++) {
        const size_t size = ((size_t)1 << (14 + c % 12)) + random_bits(&seed) % 5 - 2;
        TEST_ASSERT_TRUE(ftruncate(file, 0) == 0 && ftruncate(file, (off_t)size) == 0 &&
                         pwrite(file, "!", 1, (off_t)size - 1) == 1);
        size_t length = 0;
        char *text = read_all(path, size + random_bits(&seed) % 3, &length);
        TEST_ASSERT_NOT_NULL(text);
        TEST_ASSERT_TRUE(length == size && text[size - 1] == '!' && text[size] == '\0');
        free(text);
        const size_t most = size - 1 - random_bits(&seed) % (size / 2);
        char wanted[100];
        snprintf(wanted, sizeof wanted, "%s:1:1: error: the text is longer than %zu bytes\n", path,
                 most);
        listen_to_errors();
        text = read_all(path, most, &length);
        TEST_ASSERT_EQUAL_STRING(wanted, said());
        TEST_ASSERT_NULL(text);
    }
    close(file);
    TEST_ASSERT_EQUAL_INT(0, unlink(path));
}
