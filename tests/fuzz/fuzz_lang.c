/* fuzz_lang.c: random text must neither crash nor hang the language.
 *
 * The input is a .whirl file. Lines after a line `--` are changes of the command line. */
#define _POSIX_C_SOURCE 200809L

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/lang/model.h"

enum { CHANGES_MAX = 16, CHANGE_LENGTH = 200 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Copies the lines after the separator as strings. Returns their number. */
static int split_changes(const char *text, size_t length, char (*changes)[CHANGE_LENGTH]) {
    int count = 0;
    size_t used = 0;
    for (size_t i = 0; i < length && count < CHANGES_MAX; i++) {
        if (text[i] == '\n' || text[i] == '\0' || used == CHANGE_LENGTH - 1) {
            changes[count++][used] = '\0';
            used = 0;
        } else {
            changes[count][used++] = text[i];
        }
    }
    return count;
}

static void make_instances(const whirl_model *parsed, const overrides *changes, diags *all) {
    for (int i = 0; i < parsed->mechanism_count; i++) {
        instance_free(instance_make(parsed->mechanisms[i], NULL, changes, all));
    }
    for (int i = 0; i < parsed->scene_count; i++) {
        const scene *each = parsed->scenes[i];
        instance_free(instance_make(each->mechanism, each, changes, all));
        instance_free(instance_make(each->mechanism, each, NULL, all));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static FILE *nowhere;
    if (nowhere == NULL) {
        nowhere = fopen("/dev/null", "w");
    }
    char changes[CHANGES_MAX][CHANGE_LENGTH];
    const char *texts[CHANGES_MAX];
    const char *text = (const char *)data;
    size_t length = size;
    int count = 0;
    for (size_t i = 0; i + 4 <= size; i++) {
        if (memcmp(text + i, "\n--\n", 4) == 0) {
            length = i;
            count = split_changes(text + i + 4, size - i - 4, changes);
            break;
        }
    }
    for (int i = 0; i < count; i++) {
        texts[i] = changes[i];
    }
    /* a copy of the exact size, so that a sanitizer sees a read past its end */
    char *copy = malloc(length == 0 ? 1 : length);
    if (copy == NULL || nowhere == NULL) {
        abort();
    }
    if (length > 0) {
        memcpy(copy, text, length);
    }
    diags *all = diags_new();
    whirl_model *parsed = model_parse("fuzz.whirl", copy, length, all);
    if ((parsed == NULL) != (diags_count(all) > 0)) {
        abort(); /* the text was refused without a message, or accepted with one */
    }
    if (parsed != NULL) {
        const overrides wanted = {.values = texts,
                                  .value_count = count > 3 ? count - 3 : 0,
                                  .sets = texts,
                                  .set_count = count > 4 ? 1 : 0,
                                  .with = texts,
                                  .with_count = count > 5 ? 1 : 0,
                                  .step = count > 0 ? texts[count - 1] : NULL,
                                  .until = count > 1 ? texts[count - 2] : NULL};
        make_instances(parsed, &wanted, all);
    }
    diags_flush(all, nowhere);
    diags_free(all);
    model_free(parsed);
    free(copy);
    return 0;
}
