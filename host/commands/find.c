/* find.c: looking through the built-in models. */
#include "find.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/exit.h"
#include "host/base/nearest.h"
#include "host/base/room.h"

/* What is looked for. */
typedef struct wish {
    const char *mechanism; /* [mechanism_length]; NULL: any */
    size_t mechanism_length;
    const char *name; /* a scene's, or a mechanism's */
} wish;

static wish wish_of(const char *target) {
    const char *colon = strrchr(target, ':');
    return colon == NULL ? (wish){NULL, 0, target}
                         : (wish){target, (size_t)(colon - target), colon + 1};
}

static bool is_mechanism(const wish *w, const mechanism *m) {
    return w->mechanism == NULL || (strlen(m->name) == w->mechanism_length &&
                                    strncmp(m->name, w->mechanism, w->mechanism_length) == 0);
}

static bool knows_mechanism(const wish *w, const whirl_model *m) {
    for (int i = 0; i < m->mechanism_count; i++) {
        if (is_mechanism(w, m->mechanisms[i])) {
            return true;
        }
    }
    return false;
}

/* The mechanism that the wish leads to in one model, as source_pick() will find it; NULL: none. */
static const mechanism *find_in(const wish *w, const whirl_model *m) {
    for (int i = 0; i < m->scene_count; i++) {
        if (is_mechanism(w, m->scenes[i]->mechanism) && strcmp(m->scenes[i]->name, w->name) == 0) {
            return m->scenes[i]->mechanism;
        }
    }
    for (int i = 0; i < m->mechanism_count; i++) {
        if (is_mechanism(w, m->mechanisms[i]) && strcmp(m->mechanisms[i]->name, w->name) == 0) {
            return m->mechanisms[i];
        }
    }
    return NULL;
}

static void say_ambiguous(const wish *w, const struct builtin_model *models,
                          whirl_model *const *read, size_t count) {
    fprintf(stderr, "whirl: error: '%s' is the name of more than one built-in thing\nhint: one of:",
            w->name);
    for (size_t i = 0; i < count; i++) {
        const mechanism *of = find_in(w, read[i]);
        if (of != NULL) {
            fprintf(stderr, " %s:%s (%s)", of->name, w->name, models[i].file);
        }
    }
    fputc('\n', stderr);
}

/* All scenes of the mechanism that was named. */
static void say_scenes(const wish *w, whirl_model *const *read, size_t count) {
    fputs("hint: one of:", stderr);
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < read[i]->scene_count; k++) {
            if (is_mechanism(w, read[i]->scenes[k]->mechanism)) {
                fprintf(stderr, " %s", read[i]->scenes[k]->name);
            }
        }
    }
    fputs(", or the mechanism alone\n", stderr);
}

/* The nearest scene of the mechanism that was named; without one, the nearest of everything. */
static void say_unknown(const wish *w, const char *target, whirl_model *const *read, size_t count) {
    bool known = false;
    for (size_t i = 0; i < count && w->mechanism != NULL; i++) {
        known = known || knows_mechanism(w, read[i]);
    }
    const char *meant = known || w->mechanism == NULL ? w->name : w->mechanism;
    nearest search =
        nearest_start(meant, meant == w->mechanism ? w->mechanism_length : strlen(meant));
    for (size_t i = 0; i < count; i++) {
        const whirl_model *m = read[i];
        for (int k = 0; k < m->scene_count && meant == w->name; k++) {
            if (is_mechanism(w, m->scenes[k]->mechanism)) {
                nearest_offer(&search, m->scenes[k]->name);
            }
        }
        for (int k = 0; k < m->mechanism_count && !known; k++) {
            nearest_offer(&search, m->mechanisms[k]->name);
        }
    }
    if (known) {
        fprintf(stderr, "whirl: error: the built-in mechanism '%.*s' has no scene '%s'\n",
                (int)w->mechanism_length, w->mechanism, w->name);
    } else {
        fprintf(stderr, "whirl: error: there is no file and no built-in scene or mechanism '%s'\n",
                target);
    }
    if (search.best != NULL) {
        fprintf(stderr, "hint: did you mean '%s'? `whirl list` shows all\n", search.best);
    } else if (known) {
        say_scenes(w, read, count);
    } else {
        fprintf(stderr, "hint: `whirl list` shows the built-in ones\n");
    }
}

int find_builtin(const struct builtin_model *models, size_t count, const char *target,
                 diags *errors, whirl_model **found, const struct builtin_model **from,
                 const char **name) {
    const wish w = wish_of(target);
    whirl_model **read = room((int64_t)count, sizeof(whirl_model *));
    size_t hits = 0;
    size_t hit = 0;
    size_t good = 0;
    for (; good < count; good++) {
        const struct builtin_model *b = &models[good];
        read[good] = model_parse(b->file, b->text, b->length, errors);
        if (read[good] == NULL) {
            diags_flush(errors, stderr);
            break;
        }
        if (find_in(&w, read[good]) != NULL) {
            hit = good;
            hits++;
        }
    }
    const bool one = good == count && hits == 1;
    if (good == count && hits == 0) {
        say_unknown(&w, target, read, count);
    } else if (good == count && hits > 1) {
        say_ambiguous(&w, models, read, count);
    } else if (one) {
        *found = read[hit];
        *from = &models[hit];
        *name = w.name;
    }
    for (size_t i = 0; i < good; i++) {
        if (!one || i != hit) {
            model_free(read[i]);
        }
    }
    free(read);
    return one ? EXIT_DONE : EXIT_BAD_INPUT;
}
