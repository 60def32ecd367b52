/* list.c: `whirl list`: the built-in mechanisms and scenes. */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "host/lang/builtin.h"
#include "load.h"
#include "options.h"

static const char usage[] = "usage: whirl list\n"
                            "\n"
                            "The built-in mechanisms and scenes, a line each: kind, name, title.\n";

int command_list(int count, char **words) {
    if (options_help(count, words, usage)) {
        return EXIT_DONE;
    }
    if (count > 0) {
        options_unknown("list", words[0], (const char *const[]){"--help", NULL});
        return EXIT_BAD_INPUT;
    }
    diags *errors = diags_new();
    int code = EXIT_DONE;
    for (size_t i = 0; i < builtin_model_count; i++) {
        const struct builtin_model *b = &builtin_models[i];
        model *m = model_parse(b->file, b->text, b->length, errors);
        if (m == NULL) {
            diags_flush(errors, stderr);
            code = EXIT_BAD_INPUT;
            continue;
        }
        for (int k = 0; k < m->mechanism_count; k++) {
            printf("mechanism  %-24s %s\n", m->mechanisms[k]->name, m->mechanisms[k]->title);
            for (int s = 0; s < m->scene_count; s++) {
                if (m->scenes[s]->mechanism == m->mechanisms[k]) {
                    printf("scene      %-24s %s\n", m->scenes[s]->name, m->scenes[s]->title);
                }
            }
        }
        model_free(m);
    }
    diags_free(errors);
    return code;
}
