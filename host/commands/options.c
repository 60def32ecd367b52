/* options.c: reading the words of a command line. */
#include "options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/nearest.h"
#include "host/base/room.h"

bool options_help(int count, char **words, const char *usage) {
    for (int i = 0; i < count; i++) {
        if (strcmp(words[i], "--help") == 0 || strcmp(words[i], "-h") == 0) {
            fputs(usage, stdout);
            return true;
        }
    }
    return false;
}

const char *options_value(int count, char **words, int *at, const char *name, bool *bad) {
    const size_t length = strlen(name);
    const char *word = words[*at];
    if (strncmp(word, name, length) != 0) {
        return NULL;
    }
    if (word[length] == '=') {
        ++*at;
        return word + length + 1;
    }
    if (word[length] != '\0') {
        return NULL;
    }
    if (*at + 1 >= count) {
        fprintf(stderr, "whirl: error: %s needs a value\nhint: %s VALUE, or %s=VALUE\n", name, name,
                name);
        *bad = true;
        ++*at;
        return NULL;
    }
    *at += 2;
    return words[*at - 1];
}

static void push(const char ***list, int *count, const char *text) {
    const char **longer = room_more(*list, *count + 1, sizeof **list);
    *list = longer;
    longer[(*count)++] = text;
}

/* A copy of text[length], which the options keep. */
static const char *keep(change_options *c, const char *text, size_t length) {
    char *name = room_copy(text, length);
    c->owned = room_more(c->owned, c->owned_count + 1, sizeof *c->owned);
    c->owned[c->owned_count++] = name;
    return name;
}

static bool is_in(const char *const *list, int count, const char *name) {
    for (int i = 0; i < count; i++) {
        if (strcmp(list[i], name) == 0) {
            return true;
        }
    }
    return false;
}

/* Each name of "E, E,...", with blanks around it or none. False when one is missing or there twice, within
 * the list or since the command began (reported). */
static bool push_names(change_options *c, const char ***list, int *count, const char *option,
                       const char *text) {
    static const char blank[] = " \t\r\n";
    for (const char *at = text;; at++) {
        const size_t field = strcspn(at, ",");
        const size_t before = strspn(at, blank);
        size_t end = field;
        while (end > before && strchr(blank, at[end - 1]) != NULL) {
            end--;
        }
        if (end <= before) {
            fprintf(stderr,
                    "whirl: error: a name is missing in %s \"%s\"\n"
                    "hint: names with commas between them: %s drag,ledger\n",
                    option, text, option);
            return false;
        }
        const char *name = keep(c, at + before, end - before);
        if (strcmp(name, "conserve") == 0 && list == &c->with) {
            fputs("whirl: error: --with takes effects: a scene says itself what it conserves\n",
                  stderr);
            return false;
        }
        if (is_in(*list, *count, name)) {
            fprintf(stderr, "whirl: error: %s names '%s' twice\n", option, name);
            return false;
        }
        push(list, count, name);
        if (is_in(c->with, c->with_count, "all") && is_in(c->without, c->without_count, "all")) {
            fputs("whirl: error: --with all and --without all: which?\n", stderr);
            return false;
        }
        at += field;
        if (*at == '\0') {
            return true;
        }
    }
}

bool options_change(int count, char **words, int *at, change_options *c, bool *bad) {
    const char *value;
    if ((value = options_value(count, words, at, "--set", bad)) != NULL) {
        push(&c->sets, &c->set_count, value);
    } else if (!*bad && (value = options_value(count, words, at, "--start", bad)) != NULL) {
        push(&c->starts, &c->start_count, value);
    } else if (!*bad && (value = options_value(count, words, at, "--with", bad)) != NULL) {
        *bad = !push_names(c, &c->with, &c->with_count, "--with", value);
    } else if (!*bad && (value = options_value(count, words, at, "--without", bad)) != NULL) {
        *bad = !push_names(c, &c->without, &c->without_count, "--without", value);
    } else if (!*bad && (value = options_value(count, words, at, "--step", bad)) != NULL) {
        c->step = value;
    } else if (!*bad && (value = options_value(count, words, at, "--until", bad)) != NULL) {
        c->until = value;
    }
    return value != NULL;
}

overrides change_options_overrides(const change_options *c) {
    return (overrides){.sets = c->sets,
                       .set_count = c->set_count,
                       .starts = c->starts,
                       .start_count = c->start_count,
                       .with = c->with,
                       .with_count = c->with_count,
                       .without = c->without,
                       .without_count = c->without_count,
                       .step = c->step,
                       .until = c->until,
                       .name = c->name};
}

void change_options_free(change_options *c) {
    for (int i = 0; i < c->owned_count; i++) {
        free(c->owned[i]);
    }
    free(c->owned);
    free(c->sets);
    free(c->starts);
    free(c->with);
    free(c->without);
}

/* `value` among `names`; when it is none of them that is reported, with the names. */
static bool choose(const char *command, const char *what, const char *value,
                   const char *const *names, int count, int *chosen) {
    for (int i = 0; i < count; i++) {
        if (strcmp(value, names[i]) == 0) {
            *chosen = i;
            return true;
        }
    }
    fprintf(stderr, "whirl %s: error: there is no %s '%s'\nhint: one of", command, what, value);
    for (int i = 0; i < count; i++) {
        fprintf(stderr, "%s %s", i > 0 ? "," : "", names[i]);
    }
    fputc('\n', stderr);
    return false;
}

bool options_engine(const char *command, int count, char **words, int *at, image_settings *settings,
                    bool *bad) {
    static const char *const methods[] = {[WH_EULER] = "euler",
                                          [WH_SEMI_IMPLICIT_EULER] = "semi-implicit-euler",
                                          [WH_HEUN] = "heun",
                                          [WH_RK4] = "rk4"};
    int chosen = 0;
    const char *value = options_value(count, words, at, "--method", bad);
    if (value != NULL) {
        *bad = !choose(command, "method", value, methods, 4, &chosen);
        settings->method = (wh_method)chosen;
    } else if (!*bad && strcmp(words[*at], "--compensated") == 0) {
        ++*at;
        settings->compensated = true;
        return true;
    }
    return value != NULL;
}

bool options_number(const char *command, int count, char **words, int *at, const engine_kind **kind,
                    bool *bad) {
    static const char *const numbers[] = {"double", "float"};
    int chosen = 0;
    const char *value = options_value(count, words, at, "--number", bad);
    if (value != NULL) {
        *bad = !choose(command, "number", value, numbers, 2, &chosen);
        *kind = chosen == 1 ? &engine_float : &engine_double;
    }
    return value != NULL;
}

void options_unknown(const char *command, const char *word, const char *const *known) {
    nearest search = nearest_start(word, strlen(word));
    for (int i = 0; known[i] != NULL; i++) {
        nearest_offer(&search, known[i]);
    }
    fprintf(stderr, "whirl %s: error: unknown option '%s'\n", command, word);
    if (search.best != NULL) {
        fprintf(stderr, "hint: did you mean %s?\n", search.best);
    } else {
        fprintf(stderr, "hint: whirl %s --help lists the options\n", command);
    }
}
