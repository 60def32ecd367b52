/* tables_exhaustive.c: the step's tables (--tables) in float against the exact functions in double, at all 2^32 phases.
 *
 *     tables_exhaustive [STRIDE [SCENE...]]
 *
 * STRIDE > 1 takes one phase out of every STRIDE, at a scattered place in each. Prints the worst and the RMS error of each
 * linear and cubic table of the built-in SCENEs, with the bound: the interpolation error that `whirl describe` states, plus
 * round-off. The exit status is 1 if an error exceeds its bound. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/derive/lagrange.h"
#include "host/image/image_make.h"
#include "host/lang/builtin.h"
#include "tests/host/table_check.h"

enum { FORMS = 4 };

static const struct {
    image_tables form;
    int cells;
} forms[FORMS] = {
    {TABLES_LINEAR, 256}, {TABLES_LINEAR, 1024}, {TABLES_CUBIC, 64}, {TABLES_CUBIC, 256}};

/* Makes the built-in scene's images, one for each of forms[]. Returns false if the scene has no tables. */
static bool make(const char *name, image *im[FORMS]) {
    diags *errors = diags_new();
    for (size_t i = 0; i < builtin_model_count; i++) {
        const struct builtin_model *b = &builtin_models[i];
        whirl_model *in = model_parse(b->file, b->text, b->length, errors);
        for (int s = 0; in != NULL && s < in->scene_count; s++) {
            if (strcmp(in->scenes[s]->name, name) != 0) {
                continue;
            }
            instance *one = instance_make(in->scenes[s]->mechanism, in->scenes[s], NULL, errors);
            equations *e = equations_derive(one, errors);
            for (int m = 0; m < FORMS; m++) {
                const image_settings settings = {
                    .method = WH_METHOD_DEFAULT, .tables = forms[m].form, .cells = forms[m].cells};
                im[m] = image_make(e, one->conserve, &settings, IMAGE_TO_WRITE, errors);
            }
            equations_free(e);
            instance_free(one);
        }
        model_free(in);
    }
    diags_flush(errors, stderr);
    diags_free(errors);
    return im[FORMS - 1] != NULL;
}

static int check(const char *name, uint64_t stride) {
    image *im[FORMS] = {NULL};
    static table_error error[FORMS][TABLE_CHECK_MOST];
    int beyond = 0;
    if (!make(name, im)) {
        fprintf(stderr, "%s is no scene, or has no tables\n", name);
        return 1;
    }
    const uint64_t phases = table_check((const image *const *)im, FORMS, stride, error);
    for (int m = 0; m < FORMS; m++) {
        const op_list_tables *t = &im[m]->list[IMAGE_STEP]->tables;
        for (int k = 0; k < t->count; k++) {
            const table_error *e = &error[m][k];
            printf("%s %s %d table %d: size %.4g, interpolation off by %.2e, worst %.3e at phase "
                   "0x%08x, rms %.2e, bound %.3e%s\n",
                   name, image_tables_words[forms[m].form], forms[m].cells, k, t->size[k],
                   t->off[k], e->worst, (unsigned)e->worst_at, sqrt(e->square / (double)phases),
                   e->bound, e->worst <= e->bound ? "" : " BEYOND");
            beyond += !(e->worst <= e->bound);
        }
        image_free(im[m]);
    }
    printf("%s: %.0f phases\n", name, (double)phases);
    return beyond;
}

int main(int count, char **words) {
    static const char *const usual[] = {"epicyclic_conserved", "rig_fixed"};
    const uint64_t stride = count > 1 ? strtoull(words[1], NULL, 10) : 1;
    int beyond = 0;
    if (stride < 1) {
        fprintf(stderr, "tables_exhaustive: error: STRIDE is 1 or more\n");
        return 2;
    }
    for (int i = 2; i < count; i++) {
        beyond += check(words[i], stride);
    }
    for (size_t i = 0; i < sizeof usual / sizeof usual[0] && count <= 2; i++) {
        beyond += check(usual[i], stride);
    }
    return beyond > 0;
}
