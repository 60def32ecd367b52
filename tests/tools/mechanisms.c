/* mechanisms.c: `mechanisms COUNT SEED` writes COUNT generated mechanisms with a scene each on standard output. All of them
 * derive. It reports on standard error how many were refused and replaced. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/derive/lagrange.h"
#include "host/image/image_make.h"
#include "host/lang/model.h"
#include "tests/host/mechanism.h"

static bool derives(const char *text, diags *all) {
    whirl_model *parsed = model_parse("generated", text, strlen(text), all);
    instance *inst = NULL;
    equations *e = NULL;
    image *p = NULL;
    static const image_settings settings = IMAGE_SETTINGS_DEFAULT;
    if (parsed != NULL) {
        inst = instance_make(parsed->mechanisms[0], parsed->scenes[0], NULL, all);
    }
    if (inst != NULL) {
        e = equations_derive(inst, all);
    }
    if (e != NULL) {
        p = image_make(e, parsed->scenes[0]->conserve, &settings, IMAGE_TO_WRITE, all);
    }
    const bool done = p != NULL;
    image_free(p);
    equations_free(e);
    instance_free(inst);
    model_free(parsed);
    return done;
}

int main(int count, char **words) {
    if (count != 3) {
        fputs("usage: mechanisms COUNT SEED\n", stderr);
        return 2;
    }
    const bool tells = getenv("MECHANISMS_SHOW") != NULL; /* prints refused mechanisms */
    const unsigned wanted = (unsigned)strtoul(words[1], NULL, 10);
    uint64_t seed = strtoull(words[2], NULL, 10);
    unsigned refused = 0;
    for (unsigned made = 0; made < wanted; seed++) {
        char text[MECHANISM_SIZE];
        diags *all = diags_new();
        mechanism_write(made, seed, text);
        if (derives(text, all)) {
            fputs(text, stdout);
            made++;
        } else {
            refused++;
            if (tells) {
                fputs(text, stderr);
                diags_flush(all, stderr);
            }
        }
        diags_free(all);
        if (refused > 10 * wanted + 100) {
            fputs("mechanisms: error: nearly all are refused\n", stderr);
            return 1;
        }
    }
    fprintf(stderr, "%u mechanisms from seed %s on, %u refused and replaced\n", wanted, words[2],
            refused);
    return fflush(stdout) == 0 ? 0 : 1;
}
