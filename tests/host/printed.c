
#include "test.h"

#include "printed.h"

#include <dirent.h>

#include "host/emit/emit.h"
#include "host/show/show.h"

void each_mechanism(checker *check) {
    static const char *const own[] = {"spherical_particle",  "masses_relative", "masses_absolute",
                                      "epicyclic_rail_drag", "driven_hinge",    "thomson",
                                      "thomson_a_spin",      "rig_fixed",       "carriage_free"};
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        derived d = derived_builtin(own[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(d.image, own[i]);
        check(own[i], &d);
        derived_free(&d);
    }
    DIR *folder = opendir("tests/mechanisms");
    TEST_ASSERT_NOT_NULL_MESSAGE(folder, "run from the project's root");
    int files = 0;
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char path[512];
        snprintf(path, sizeof path, "tests/mechanisms/%s", entry->d_name);
        if (strstr(path, ".whirl") != NULL) {
            derived d = derived_file(path);
            TEST_ASSERT_NOT_NULL_MESSAGE(d.image, path);
            check(path, &d);
            derived_free(&d);
            files++;
        }
    }
    closedir(folder);
    TEST_ASSERT_GREATER_THAN_INT(25, files);
}

char *printed(const derived *d, language as) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    switch (as) {
    case TEXT: show_text(out, d->equations); break;
    case STEPS: show_steps(out, d->equations, SHOW_TEXT); break;
    case LATEX: show_latex(out, d->equations); break;
    case LATEX_STEPS: show_steps(out, d->equations, SHOW_LATEX); break;
    case FOLDED: derived_octave(out, d, "x.whirl", true); break;
    case OCTAVE: derived_octave(out, d, "x.whirl", false); break;
    }
    fclose(out);
    /* a copy, because gcc takes the stream's buffer for an address in this stack frame */
    char *copy = malloc(size + 1);
    TEST_ASSERT_NOT_NULL(copy);
    memcpy(copy, text, size + 1);
    free(text);
    return copy;
}
