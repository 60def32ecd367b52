/* describe.c: `whirl describe`: the contents of a scene's image, for programs and for readers. */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "host/cli/load.h"
#include "host/emit/description.h"
#include "target.h"

static const command_usage usage = {
    .head =
        "usage: whirl describe FILE[:NAME]|SCENE|MECHANISM[:SCENE] [--json] [options]\n"
        "\n"
        "Says what a scene holds: names, units, indices, start values, step, method, contacts, ledger,\n"
        "memory, costs and the model's hash; all that runs and all generated code is made of the same.\n"
        "Values are SI.\n"
        "  --json       the same for programs: one JSON object (docs/describe.md)\n",
    .groups = OPTIONS_CHANGE | OPTIONS_STEP | OPTIONS_ENGINE,
    .described = false,
    .tail = ""};

typedef struct describe_options {
    common_options common;
    const char *target;
    bool as_json;
} describe_options;

static bool take_one(int count, char **words, int *at, void *options, bool *bad) {
    (void)count;
    (void)bad;
    describe_options *o = options;
    const bool is_json = strcmp(words[*at], "--json") == 0;
    if (is_json) {
        o->as_json = true;
        ++*at;
    }
    return is_json;
}

static int describe_loaded(source_model *from, const describe_options *o) {
    loaded made;
    const int code =
        target_load(&made, from, &o->common, (load_wish){.use = IMAGE_TO_WRITE, .conserve = true});
    source_forget(from);
    if (code == EXIT_DONE && o->as_json) {
        describe_json(stdout, made.image, from->file);
    } else if (code == EXIT_DONE) {
        describe_text(stdout, made.image, from->file);
    }
    unload(&made);
    return code;
}

int command_describe(int count, char **words) {
    static const char *const own[] = {"--json", NULL};
    describe_options o = {.common = options_defaults()};
    if (options_help(count, words, &usage)) {
        return EXIT_DONE;
    }
    int code = EXIT_BAD_INPUT;
    if (target_ask("describe", own, take_one, &usage, count, words, &o.common, &o, &o.target)) {
        source_model from;
        code = source_open(&from, o.target);
        if (code == EXIT_DONE) {
            code = describe_loaded(&from, &o);
        }
        source_close(&from);
    }
    options_forget(&o.common);
    return code;
}
