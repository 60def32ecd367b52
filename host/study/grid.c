/* grid.c: reading ranges and numbering points. */
#include "host/study/grid.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/lang/override.h"
#include "host/lang/value.h"
#include "host/number/functions.h"

overrides changes_at(const grid *g, const overrides *base, uint64_t point) {
    overrides changes = *base;
    double *value = alloc(g->count, sizeof *value);
    const char **texts = alloc(g->count, sizeof(const char *));
    grid_values(g, point, value);
    changes.value_count = 0;
    for (int i = 0; i < g->count; i++) {
        const axis *a = &g->axes[i];
        char number[NUMBER_SIZE];
        snprintf(number, sizeof number, "%.17g", value[i]);
        if (a->symbol == NULL) {
            changes.step = alloc_words("%s", number);
        } else {
            texts[changes.value_count++] = shown_assignment(a->symbol, a->primes, number);
        }
    }
    changes.values = texts;
    free(value);
    return changes;
}

void changes_forget(const overrides *base, overrides *changes) {
    for (int i = 0; i < changes->value_count; i++) {
        free((void *)(uintptr_t)changes->values[i]);
    }
    free((void *)(uintptr_t)changes->values);
    if (changes->step != base->step) {
        free((void *)(uintptr_t)changes->step);
    }
}

static const char *option_of(const grid *g) { return g->option != NULL ? g->option : "--over"; }
static const char *command_of(const grid *g) { return g->command != NULL ? g->command : "sweep"; }

bool changes_take_part(const grid *g, const instance *base) {
    for (int i = 0; i < g->count; i++) {
        const symbol *swept = g->axes[i].symbol;
        const effect *missing = swept != NULL ? instance_lacks(base, swept) : NULL;
        if (missing != NULL) {
            fprintf(stderr,
                    "whirl %s: error: '%s' belongs to the effect '%s', which is not selected here\n"
                    "hint: add --with %s\n",
                    command_of(g), swept->name, missing->name, missing->name);
            return false;
        }
    }
    return true;
}

/* Does one of texts[count], NAME=VALUE, have this name? */
static bool names(const char *const *texts, int count, const char *name) {
    for (int i = 0; i < count; i++) {
        const char *from = texts[i] + strspn(texts[i], " \t");
        const char *rest = from + strcspn(from, " \t=");
        if (strlen(name) == (size_t)(rest - from) && strncmp(from, name, strlen(name)) == 0) {
            return true;
        }
    }
    return false;
}

bool changes_are_apart(const grid *g, const overrides *base) {
    for (int i = 0; i < g->count; i++) {
        const axis *a = &g->axes[i];
        const char *option = a->symbol == NULL ? (base->step != NULL ? "--step" : NULL)
                             : names(base->sets, base->set_count, a->name)     ? "--set"
                             : names(base->starts, base->start_count, a->name) ? "--start"
                                                                               : NULL;
        if (option != NULL) {
            fprintf(stderr,
                    "whirl %s: error: --over sweeps '%s', but %s sets it, too\nhint: leave out "
                    "one of these options\n",
                    command_of(g), a->name, option);
            return false;
        }
    }
    return true;
}

/* === points and their order =================================================================== */

/* Begins a message with the option and its value. */
static void say(const grid *g, const char *over) {
    fprintf(stderr, "whirl %s: error: %s \"%s\"", command_of(g), option_of(g), over);
}

/* If there is a problem with the option's value, reports it, and returns false. */
static bool has_no(const char *problem, const grid *g, const char *over) {
    if (problem != NULL) {
        say(g, over);
        fprintf(stderr, ": %s\n", problem);
    }
    return problem == NULL;
}

/* --- the text of a range -----------------------------------------------------------------------*/

typedef struct range_text {
    char *name;
    char *from;
    char *to;
    char *count;
} range_text;

/* Cuts the text at its '=', "..", and last ':'. */
static bool range_split(const grid *g, const char *text, range_text *r) {
    const char *equals = strchr(text, '=');
    const char *colon = strrchr(text, ':');
    const char *dots = equals != NULL ? strstr(equals, "..") : NULL;
    const char *problem = NULL;
    if (equals == NULL || colon == NULL || dots == NULL || dots > colon) {
        problem = "is not NAME=FROM..TO:COUNT";
    } else if (dots[2] == '.') {
        problem = "has three dots in a row";
    }
    if (problem != NULL) {
        say(g, text);
        fprintf(stderr,
                " %s\nhint: write a range such as %s \"r=10..60 [mm]:11\", or ...:11,log for a "
                "logarithmic range\n",
                problem, option_of(g));
        return false;
    }
    r->name = alloc_trimmed(text, (size_t)(equals - text));
    r->from = alloc_trimmed(equals + 1, (size_t)(dots - equals - 1));
    r->to = alloc_trimmed(dots + 2, (size_t)(colon - dots - 2));
    r->count = alloc_trimmed(colon + 1, strlen(colon + 1));
    return true;
}

/* The end of the number at the start of `text`; NULL without a number. */
static const char *behind_number(const char *text) {
    const char *end;
    (void)decimal_read(text, &end);
    return end == text ? NULL : end + strspn(end, " \t");
}

/* Gives FROM the unit of TO if FROM has none: "10..60 [mm]". */
static void share_unit(range_text *r) {
    const char *rest = behind_number(r->from);
    const char *suffix = behind_number(r->to);
    const bool from_is_bare = rest != NULL && *rest == '\0';
    if (from_is_bare && suffix != NULL && (*suffix == '[' || isalpha((unsigned char)*suffix))) {
        char *with_unit = alloc_words("%s%s", r->from, suffix);
        free(r->from);
        r->from = with_unit;
    }
}

static bool read_count(const grid *g, const char *over, const char *text, axis *made) {
    const size_t digits = strspn(text, "0123456789");
    const char *rest = text + digits;
    made->is_log = strcmp(rest, ",log") == 0;
    if (digits > 0 && digits <= 12 && (made->is_log || *rest == '\0')) {
        made->count = strtoull(text, NULL, 10);
    }
    const char *problem = NULL;
    if (made->count == 0) {
        problem =
            "the COUNT after the last ':' must be a whole number from 1 to 999999999999, perhaps "
            "with ',log' after it";
    } else if (made->count == 1 && made->from != made->to) {
        problem = "a COUNT of 1 needs FROM = TO";
    } else if (made->is_log && !(made->from * made->to > 0.0)) {
        problem = "the ends of a logarithmic range must both be above zero or both below zero";
    }
    return has_no(problem, g, over);
}

/* --- its values --------------------------------------------------------------------------------*/

/* Reads FROM or TO as an expression, and sets the axis's symbol. A hint about a missing unit shows the whole range. */
static const expr *read_end(const mechanism *of, const range_text *r, const char *text,
                            struct arena *arena, diags *errors, axis *made) {
    if (strcmp(r->name, "step") == 0) {
        return override_duration(of, "step", text, arena, errors);
    }
    const bool is_to = text == r->to;
    char *whole = alloc_words("%s=%s", r->name, text);
    char *before = alloc_words("%s%s", is_to ? r->from : "", is_to ? ".." : "");
    char *after = alloc_words("%s%s:%s", is_to ? "" : "..", is_to ? "" : r->to, r->count);
    const char *around[] = {before, after};
    assignment change;
    const bool good = override_parse(of, OVERRIDE_EITHER, whole, around, arena, errors, &change);
    free(whole);
    free(before);
    free(after);
    if (!good) {
        return NULL;
    }
    made->symbol = change.symbol;
    made->primes = change.primes;
    return change.value;
}

/* Sets both ends of the axis. Returns false, and reports why, unless both are finite numbers of the same kind. */
static bool take_ends(const grid *g, const char *over, const expr *from, const expr *to,
                      axis *made) {
    const char *problem = NULL;
    if (((from->uses | to->uses) & ~(unsigned)USES_UNIT) != 0) {
        problem = "FROM and TO must be numbers";
    } else {
        made->from = expr_value(from, NULL);
        made->to = expr_value(to, NULL);
        if (!isfinite(made->from) || !isfinite(made->to) || !isfinite(made->to - made->from)) {
            problem = "FROM and TO must be finite numbers";
        } else if (from->uses != to->uses && made->from != 0.0 && made->to != 0.0) {
            problem = "one end has a unit and the other has none";
        } else if (made->symbol == NULL && !(made->from > 0.0 && made->to > 0.0)) {
            problem = "step must be above zero";
        }
    }
    return has_no(problem, g, over);
}

static bool read_axis(const grid *g, const mechanism *of, const char *over, const range_text *r,
                      diags *errors, axis *made) {
    struct arena *arena = arena_new();
    /* TO first: if both ends lack a unit, the hint must add it to TO */
    const expr *to = read_end(of, r, r->to, arena, errors, made);
    const expr *from = to == NULL ? NULL : read_end(of, r, r->from, arena, errors, made);
    diags_flush(errors, stderr);
    const bool good =
        from != NULL && take_ends(g, over, from, to, made) && read_count(g, over, r->count, made);
    arena_free(arena);
    return good;
}

static bool fits_in(const grid *g, const char *over, const axis *made) {
    for (int i = 0; i < g->count; i++) {
        if (g->axes[i].symbol == made->symbol && g->axes[i].primes == made->primes) {
            return has_no("another option already sweeps this name", g, over);
        }
    }
    if (g->count > 0 && made->count > GRID_POINTS_MAX / g->points) {
        say(g, over);
        fprintf(stderr, ": the grid has more than %.0e points\n", (double)GRID_POINTS_MAX);
        return false;
    }
    return true;
}

bool grid_add(grid *g, const mechanism *of, const char *text, diags *errors) {
    range_text r = {0};
    if (!range_split(g, text, &r)) {
        return false;
    }
    share_unit(&r);
    axis made = {0};
    const bool good = read_axis(g, of, text, &r, errors, &made) && fits_in(g, text, &made);
    if (good) {
        axis *longer = alloc_more(g->axes, g->count + 1, sizeof *longer);
        made.name = alloc_trimmed(r.name, strlen(r.name));
        made.is_start = made.symbol != NULL && symbol_moves(made.symbol);
        made.column = alloc_words(made.is_start ? "start(%s)" : "%s", made.name);
        g->axes = longer;
        g->axes[g->count] = made;
        g->points = g->count == 0 ? made.count : g->points * made.count;
        g->count++;
    }
    free(r.name);
    free(r.from);
    free(r.to);
    free(r.count);
    return good;
}

void grid_free(grid *g) {
    for (int i = 0; i < g->count; i++) {
        free(g->axes[i].name);
        free(g->axes[i].column);
    }
    free(g->axes);
    *g = (grid){0};
}

/* from * (to / from)^share, even if the ratio overflows or underflows */
static double log_value(const axis *a, double share) {
    const double ratio = a->to / a->from;
    if (isfinite(ratio) && ratio != 0.0) {
        return a->from * number_power(ratio, share);
    }
    const double size = number_power(fabs(a->from), 1.0 - share) * number_power(fabs(a->to), share);
    return a->from < 0.0 ? -size : size;
}

static double axis_value(const axis *a, uint64_t i) {
    if (i == 0) {
        return a->from;
    }
    if (i == a->count - 1) {
        return a->to;
    }
    const double last = (double)(a->count - 1);
    return a->is_log ? log_value(a, (double)i / last)
                     : a->from + (a->to - a->from) * (double)i / last;
}

void grid_values(const grid *g, uint64_t point, double *value) {
    for (int i = g->count - 1; i >= 0; i--) {
        value[i] = axis_value(&g->axes[i], point % g->axes[i].count);
        point /= g->axes[i].count;
    }
}

int grid_step_axis(const grid *g) {
    int found = -1;
    for (int i = 0; i < g->count; i++) {
        found = g->axes[i].symbol == NULL ? i : found;
    }
    return found;
}

bool grid_varies_parameters(const grid *g) {
    for (int i = 0; i < g->count; i++) {
        if (g->axes[i].symbol != NULL && g->axes[i].symbol->kind == SYM_PARAMETER) {
            return true;
        }
    }
    return false;
}

/* points * k / n without overflow: points <= 1e12 and n <= 1e6 */
void grid_shard(const grid *g, uint64_t k, uint64_t n, uint64_t *first, uint64_t *end) {
    *first = g->points * (k - 1) / n;
    *end = g->points * k / n;
}
