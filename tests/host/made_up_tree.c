#include "test.h"

#include "made_up_tree.h"

#include <sys/stat.h>
#include <unistd.h>

#include "host/base/alloc.h"

static char root[] = "build/tests/tree-XXXXXX";
static char before[4096]; /* the working directory before tree_enter() */
static char *path_before;

void tree_keep(const char *file, const char *text) {
    FILE *to = fopen(file, "w");
    TEST_ASSERT_NOT_NULL_MESSAGE(to, file);
    fputs(text, to);
    TEST_ASSERT_EQUAL_INT(0, fclose(to));
}

const char *tree_taken(const char *file) {
    static char text[8192];
    FILE *from = fopen(file, "r");
    text[0] = '\0';
    if (from != NULL) {
        text[fread(text, 1, sizeof text - 1, from)] = '\0';
        fclose(from);
        unlink(file);
    }
    return text;
}

void tree_enter(void) {
    snprintf(root, sizeof root, "build/tests/tree-XXXXXX");
    TEST_ASSERT_NOT_NULL(getcwd(before, sizeof before));
    TEST_ASSERT_NOT_NULL_MESSAGE(mkdtemp(root), "run from the project's root");
    TEST_ASSERT_EQUAL_INT(0, chdir(root));
    TEST_ASSERT_TRUE(mkdir("mk", 0700) == 0 && mkdir("mk/price", 0700) == 0);
    tree_keep("mk/price/measure_one.sh",
              "echo \"$@\" >>asked\necho said >&2\n"
              "case \"$*\" in\n*place=1*) cat row1 ;;\n*place=2*) cat row2 ;;\n"
              "*) cat row0 ;;\nesac\n"
              "read status <status\nexit $status\n");
    tree_keep("make",
              "#!/bin/sh\necho \"$@\" >>made\ncat says\nread status <status\nexit $status\n");
    TEST_ASSERT_EQUAL_INT(0, chmod("make", 0700));
    const char *path = getenv("PATH");
    char *longer = alloc_words("%s/%s:%s", before, root, path);
    path_before = alloc_words("%s", path);
    setenv("PATH", longer, 1);
    free(longer);
    tree_keep("status", "0\n");
    tree_keep("says", "");
}

void tree_leave(void) {
    static const char *const files[] = {"mk/price/measure_one.sh",
                                        "make",
                                        "status",
                                        "says",
                                        "row0",
                                        "row1",
                                        "row2",
                                        "asked",
                                        "made"};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        unlink(files[i]);
    }
    rmdir("mk/price");
    rmdir("mk");
    setenv("PATH", path_before, 1);
    free(path_before);
    TEST_ASSERT_EQUAL_INT(0, chdir(before));
    TEST_ASSERT_EQUAL_INT(0, rmdir(root));
}
