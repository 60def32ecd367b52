#include "panels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/spelling.h"

/* der(der(x)) as x''. Free it. */
static char *shown_name(const char *name) {
    size_t length = strlen(name);
    static const char primes[] = "'''''''''''''''";
    int order = 0;
    while (strncmp(name, "der(", 4) == 0 && name[length - 1] == ')' &&
           order < (int)sizeof primes - 1) {
        name += 4;
        length -= 5;
        order++;
    }
    return alloc_words("%.*s%.*s", (int)length, name, order, primes);
}

static int column_named(const plot_run *run, const char *name) {
    for (int i = 0; i < run->columns; i++) {
        char *shown = shown_name(run->column[i].name);
        const bool is = strcmp(shown, name) == 0 || strcmp(run->column[i].name, name) == 0;
        free(shown);
        if (is) {
            return i;
        }
    }
    return -1;
}

static void say_unknown(const char *command, const char *name, const plot_run *runs, int count) {
    nearest search = nearest_start(name, strlen(name));
    char **kept = alloc((int64_t)count * PANELS_QUANTITIES, sizeof *kept);
    int names = 0;
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < runs[k].columns && i < PANELS_QUANTITIES; i++) {
            kept[names] = shown_name(runs[k].column[i].name);
            nearest_offer(&search, kept[names++]);
        }
    }
    fprintf(stderr, "whirl %s: error: no quantity is called '%.80s'\n", command, name);
    if (search.best != NULL) {
        fprintf(stderr, "hint: did you mean %s?\n", search.best);
    } else {
        fputs("hint: the quantities are ", stderr);
        for (int i = 0; i < runs[0].columns; i++) {
            fprintf(stderr, "%s%s", i > 0 ? ", " : "", kept[i]);
        }
        fputc('\n', stderr);
    }
    for (int i = 0; i < names; i++) {
        free(kept[i]);
    }
    free(kept);
}

static bool same_unit(const char *a, const char *b) {
    return a != NULL && b != NULL && strcmp(a, b) == 0;
}

static const char *unit_words(const char *unit) {
    return unit == NULL ? "a unit that no file tells" : unit;
}

/* The quantity's columns and its unit. False, reported, if no run has it, or the runs' units differ. */
static bool find_columns(const char *command, const char *name, const plot_run *runs, int count,
                         int *column, const char **unit) {
    int first = -1;
    for (int k = 0; k < count; k++) {
        column[k] = column_named(&runs[k], name);
        if (column[k] < 0) {
            continue;
        }
        const char *own = runs[k].column[column[k]].unit;
        if (first >= 0 && own != NULL && *unit != NULL && strcmp(own, *unit) != 0) {
            fprintf(stderr,
                    "whirl %s: error: %s is in %s in %s, and in %s in %s: one axis has one unit\n"
                    "hint: draw them in two pictures\n",
                    command, name, *unit, runs[first].label, own, runs[k].label);
            return false;
        }
        first = first < 0 ? k : first;
        *unit = *unit == NULL ? own : *unit;
    }
    if (first < 0) {
        say_unknown(command, name, runs, count);
    }
    return first >= 0;
}

/* `panel` below 0: the panel of its unit. */
static bool add(panels *p, const char *command, const char *name, const plot_run *runs, int panel) {
    panels_quantity *q = &p->quantity[p->quantities];
    const char *unit = NULL;
    if (p->quantities == PANELS_QUANTITIES) {
        fprintf(stderr, "whirl %s: error: at most %d quantities\nhint: --y NAME,NAME\n", command,
                PANELS_QUANTITIES);
        return false;
    }
    q->column = alloc(p->runs, sizeof *q->column);
    q->name = shown_name(name);
    p->quantities++;
    if (!find_columns(command, name, runs, p->runs, q->column, &unit)) {
        return false;
    }
    for (int i = 0; panel < 0 && i < p->count; i++) {
        panel = same_unit(p->unit[i], unit) ? i : panel;
    }
    panel = panel < 0 ? p->count : panel;
    if (panel == PANELS_MOST) {
        fprintf(stderr, "whirl %s: error: at most %d panels\nhint: --y NAME,NAME\n", command,
                PANELS_MOST);
        return false;
    }
    if (panel < p->count && !same_unit(p->unit[panel], unit) &&
        (p->unit[panel] != NULL || unit != NULL)) {
        const char *other = "";
        for (int i = 0; i < p->quantities - 1; i++) {
            other = p->quantity[i].panel == panel ? p->quantity[i].name : other;
        }
        fprintf(stderr,
                "whirl %s: error: %s is in %s, %s in %s: one panel has one unit\n"
                "hint: --y \"%s, %s\" makes a panel for each unit\n",
                command, other, unit_words(p->unit[panel]), q->name, unit_words(unit), other,
                q->name);
        return false;
    }
    if (panel == p->count) {
        p->unit[p->count++] = unit;
    }
    q->panel = panel;
    return true;
}

char *panels_next(const char **list) {
    if (*list == NULL) {
        return NULL;
    }
    const char *from = *list + strspn(*list, " ");
    size_t length = strcspn(from, ",");
    *list = from[length] == ',' ? from + length + 1 : NULL;
    while (length > 0 && from[length - 1] == ' ') {
        length--;
    }
    return alloc_copy(from, length);
}

static bool add_list(panels *p, const char *command, const char *list, const plot_run *runs,
                     int panel) {
    bool good = true;
    for (char *name = panels_next(&list); name != NULL; name = good ? panels_next(&list) : NULL) {
        good = add(p, command, name, runs, panel);
        free(name);
    }
    return good;
}

/* All coordinates and outputs of all runs, each once. */
static bool add_all(panels *p, const char *command, const plot_run *runs) {
    for (int k = 0; k < p->runs; k++) {
        for (int i = 1; i < runs[k].columns; i++) {
            const char *name = runs[k].column[i].name;
            bool there = strncmp(name, "der(", 4) == 0;
            for (int q = 0; q < p->quantities; q++) {
                there = there || p->quantity[q].column[k] == i;
            }
            if (!there && !add(p, command, name, runs, -1)) {
                return false;
            }
        }
    }
    return true;
}

static bool name_runs(panels *p, const char *command, const char *legend, const plot_run *runs) {
    const char *list = legend;
    for (int k = 0; k < p->runs; k++) {
        char *label = panels_next(&list);
        if (label == NULL && legend != NULL) {
            fprintf(stderr,
                    "whirl %s: error: --legend names %d of %d runs\n"
                    "hint: --legend \"first, second\"\n",
                    command, k, p->runs);
            return false;
        }
        p->label[k] = label != NULL ? label : alloc_words("%s", runs[k].label);
    }
    if (list != NULL) {
        fprintf(stderr,
                "whirl %s: error: --legend names more than %d run%s\n"
                "hint: --legend \"first, second\"\n",
                command, p->runs, p->runs == 1 ? "" : "s");
    }
    return list == NULL;
}

/* An axis without its own label shows quantity and unit; a label without an axis is an error. */
static bool labels_fit(const panels *p, const char *command, const char *labels) {
    int more = 0;
    for (const char *at = labels; at != NULL && *at != '\0'; at++) {
        more += *at == ',';
    }
    if (more >= p->count && p->count > 0) {
        fprintf(stderr,
                "whirl %s: error: --ylabel has %d texts for %d panel%s\n"
                "hint: a comma stands between the texts of two panels\n",
                command, more + 1, p->count, p->count == 1 ? "" : "s");
    }
    return more < p->count || p->count == 0;
}

bool plot_is_path(const plot_choice *choice) {
    return choice->x != NULL && strcmp(choice->x, "t") != 0 && strcmp(choice->x, "time") != 0;
}

bool panels_make(panels *p, const char *command, const plot_choice *choice, const plot_run *runs,
                 int count) {
    *p = (panels){.runs = count, .x = alloc(count, sizeof *p->x)};
    if (!name_runs(p, command, choice->legend, runs)) {
        return false;
    }
    p->x_unit = runs[0].column[0].unit;
    p->x_name =
        plot_is_path(choice) ? shown_name(choice->x) : alloc_words("%s", runs[0].column[0].name);
    if (plot_is_path(choice)) {
        p->x_unit = NULL;
        if (!find_columns(command, choice->x, runs, count, p->x, &p->x_unit)) {
            return false;
        }
    }
    for (int i = 0; i < choice->panels; i++) {
        if (!add_list(p, command, choice->panel[i], runs, p->count)) {
            return false;
        }
    }
    const bool chosen = choice->y != NULL || choice->panels > 0;
    const bool added = !chosen             ? add_all(p, command, runs)
                       : choice->y != NULL ? add_list(p, command, choice->y, runs, -1)
                                           : true;
    return added && labels_fit(p, command, choice->ylabel);
}

void panels_free(panels *p) {
    for (int i = 0; i < p->quantities; i++) {
        free(p->quantity[i].name);
        free(p->quantity[i].column);
    }
    for (int k = 0; k < p->runs; k++) {
        free(p->label[k]);
    }
    free(p->x);
    free(p->x_name);
}

bool plot_fits(const char *command, const plot_choice *choice, const plot_run *runs, int count) {
    panels p;
    const bool fits = panels_make(&p, command, choice, runs, count);
    panels_free(&p);
    return fits;
}
