/* caught.h: collects the output to a stream as text. */
#ifndef TESTS_HOST_CAUGHT_H
#define TESTS_HOST_CAUGHT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "unity.h"

/* `text` is complete after alloc_text_end(to). The caller frees `text`. */
typedef struct caught {
    char *text;
    size_t length;
    FILE *to;
} caught;

static inline FILE *catch_text(caught *c) {
    c->to = alloc_text(&c->text, &c->length);
    return c->to;
}

/* Fails the test if `text` differs from the file tests/host/NAME.txt. Then `text` is written to
 * build/tests/NAME.txt, to be compared by hand. */
static inline void expect_printed(const char *name, const char *text) {
    char *kept = alloc_words("tests/host/%s.txt", name);
    char *now = alloc_words("build/tests/%s.txt", name);
    char *want = calloc(1, 1U << 20U);
    FILE *in = fopen(kept, "rb");
    TEST_ASSERT_TRUE(want != NULL);
    if (in != NULL) {
        (void)fread(want, 1, (1U << 20U) - 1U, in);
        fclose(in);
    }
    if (strcmp(want, text) != 0) {
        FILE *out = fopen(now, "wb");
        TEST_ASSERT_TRUE(out != NULL && fputs(text, out) >= 0 && fclose(out) == 0);
        TEST_FAIL_MESSAGE(alloc_words("diff %s %s", kept, now));
    }
    free(want);
    free(now);
    free(kept);
}

#endif
