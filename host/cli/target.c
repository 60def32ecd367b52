#include "target.h"

#include <stdio.h>
#include <string.h>

#include "host/number/functions.h"

/* Takes the value of one of the table's options. Returns false, and reports the reason, if the value is wrong. */
static bool take_value(const char *command, const own_option *o, const char *value) {
    if (o->number == NULL) {
        o->text[o->count != NULL ? (*o->count)++ : 0] = value;
        return true;
    }
    if (!options_number(command, o->word, value, o->least, o->most, o->hint, o->number)) {
        return false;
    }
    if (o->whole && number_floor(*o->number) < *o->number) {
        fprintf(stderr, "whirl %s: error: %s takes a whole number, not '%.40s'\nhint: %s\n",
                command, o->word, value, o->hint);
        return false;
    }
    return true;
}

static bool take_own(const target_reader *r, int count, char **words, int *at, bool *bad) {
    for (const own_option *o = r->table; o != NULL && o->word != NULL && !*bad; o++) {
        const char *value = NULL;
        if (o->strict != NULL) {
            if (options_strict(r->command, words, at, o->strict, bad)) {
                return true;
            }
        } else if (o->flag == NULL && !o->is_bare) {
            value = options_value(count, words, at, o->word, bad);
        } else if (strcmp(words[*at], o->word) == 0) {
            value = words[(*at)++];
        }
        if (value != NULL && o->flag != NULL) {
            *o->flag = true;
        } else if (value != NULL) {
            *bad = !take_value(r->command, o, value);
        }
        if (value != NULL) {
            return true;
        }
    }
    return false;
}

static void say_unknown(const target_reader *r, const char *word) {
    const char *own[OWN_OPTIONS_MOST + 1] = {NULL};
    int all = 0;
    for (int i = 0; r->own != NULL && r->own[i] != NULL; i++) {
        own[all++] = r->own[i];
    }
    for (const own_option *o = r->table; o != NULL && o->word != NULL; o++) {
        own[all++] = o->word;
    }
    options_unknown(r->command, word, r->usage->groups, own);
}

static bool take_target(const target_reader *r, const char *word, const char **target) {
    if (word[0] == '-' && word[1] != '\0') {
        say_unknown(r, word);
        return false;
    }
    if (*target != NULL) {
        if (r->derives) {
            fprintf(stderr, "whirl %s: error: more than one thing to %s: %s\n", r->command,
                    r->command, word);
        } else {
            fprintf(stderr, "whirl %s: error: one %s at a time, not also '%s'\n", r->command,
                    r->one != NULL ? r->one : "scene", word);
        }
        return false;
    }
    *target = word;
    return true;
}

bool target_read(const target_reader *r, int count, char **words, common_options *common,
                 void *options, const char **target) {
    bool bad = false;
    *target = NULL;
    for (int at = 0; at < count && !bad;) {
        if (!options_take(r->command, r->usage->groups, count, words, &at, common, &bad) && !bad &&
            !take_own(r, count, words, &at, &bad) && !bad &&
            (r->take == NULL || !r->take(count, words, &at, options, &bad)) && !bad) {
            bad = !take_target(r, words[at++], target);
        }
    }
    return !bad;
}

int target_command(const target_reader *r, int count, char **words, common_options *common,
                   void *options, const char **target) {
    int code = EXIT_BAD_INPUT;
    if (options_help(count, words, r->usage)) {
        code = EXIT_DONE;
    } else if (target_read(r, count, words, common, options, target)) {
        if (*target == NULL && !r->none) {
            options_usage(stderr, r->usage);
        } else if (r->work_on == NULL) {
            code = r->work(options);
        } else {
            source_model from;
            code = source_open(&from, *target);
            code = code == EXIT_DONE ? r->work_on(&from, options) : code;
            source_close(&from);
        }
    }
    options_forget(common);
    return code;
}

int target_load(loaded *made, source_model *from, const common_options *common, load_wish wish) {
    const mechanism *of;
    const scene *in;
    const overrides changes = options_overrides(&common->change);
    *made = (loaded){0};
    wish.settings = common->integration;
    const int code = source_pick(from, from->model->scene_count == 1, &of, &in);
    return code == EXIT_DONE ? load(made, from, of, in, &changes, &wish) : code;
}
