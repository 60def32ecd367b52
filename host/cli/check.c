/* check.c: `whirl check`: parses a file and derives all its scenes and mechanisms, without running them. */
#include <stdio.h>

#include "commands.h"
#include "host/cli/load.h"
#include "options.h"

static const command_usage usage = {
    .head =
        "usage: whirl check FILE|MECHANISM ...\n"
        "\n"
        "Reads each FILE and derives its mechanisms and scenes, without running anything. Errors stand\n"
        "on standard error as FILE:LINE:COLUMN: error: TEXT, which editors understand.\n",
    .tail = "",
    .why = {[EXIT_ROW_OF(EXIT_DONE)] = "every scene of every file can be run",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "a file has an error, or cannot be read"}};

static int derive_all(source_model *from) {
    const load_wish wish = {.use = IMAGE_TO_RUN};
    const whirl_model *m = from->model;
    int code = EXIT_DONE;
    for (int i = 0; i < m->mechanism_count + m->scene_count; i++) {
        const scene *in = i < m->mechanism_count ? NULL : m->scenes[i - m->mechanism_count];
        const mechanism *of = in == NULL ? m->mechanisms[i] : in->mechanism;
        loaded made;
        const int one = load(&made, from, of, in, NULL, &wish);
        code = one > code ? one : code;
        if (one == EXIT_DONE && in == NULL) {
            say_hints(&made);
        }
        unload(&made);
        if (one != EXIT_DONE && in == NULL) {
            break; /* its scenes have the same error */
        }
    }
    return code;
}

static int check_one(const char *file) {
    source_model from;
    int code = source_open(&from, file);
    if (code == EXIT_DONE && from.name[0] != '\0' && from.path != NULL) {
        fprintf(stderr, "whirl check: error: %s names a part of a file\nhint: whirl check %s\n",
                file, from.path);
        code = EXIT_BAD_INPUT;
    } else if (code == EXIT_DONE) {
        code = derive_all(&from);
    }
    if (code == EXIT_DONE) {
        printf("%s: no errors; mechanisms: %d, scenes: %d\n", from.file,
               from.model->mechanism_count, from.model->scene_count);
    }
    source_close(&from);
    return code;
}

int command_check(int count, char **words) {
    int code = EXIT_DONE;
    if (options_help(count, words, &usage)) {
        return EXIT_DONE;
    }
    for (int i = 0; i < count; i++) {
        if (words[i][0] == '-' && words[i][1] != '\0') {
            options_unknown("check", words[i], 0, (const char *const[]){NULL});
            return EXIT_BAD_INPUT;
        }
    }
    if (count == 0) {
        options_usage(stderr, &usage);
        return EXIT_BAD_INPUT;
    }
    for (int i = 0; i < count; i++) {
        const int one = check_one(words[i]);
        code = one > code ? one : code;
    }
    return code;
}
