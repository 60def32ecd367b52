#include "pricing_scene.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/derive/lagrange.h"
#include "host/lang/value.h"

/* --- changes and points as text --------------------------------------------------------------------*/

char *pricing_quoted(const char *word) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-+.,:/=@%";
    if (word[0] != '\0' && word[strspn(word, plain)] == '\0') {
        return alloc_words("%s", word);
    }
    if (strpbrk(word, "\"\\$`!") == NULL) {
        return alloc_words("\"%s\"", word);
    }
    char *text;
    FILE *out = alloc_text(&text, NULL);
    fputc('\'', out);
    for (; *word != '\0'; word++) {
        fputs(*word == '\'' ? "'\\''" : (char[]){*word, '\0'}, out);
    }
    fputc('\'', out);
    alloc_text_end(out);
    return text;
}

char *pricing_words(const overrides *c, bool as_label) {
    char *text;
    const struct {
        const char *option;
        const char *label; /* NULL: not in labels */
        const char *const *list;
        int count;
    } parts[] = {{"--set ", "", c->sets, c->set_count},
                 {"--start ", "", c->starts, c->start_count},
                 {"--with ", "with ", c->with, c->with_count},
                 {"--without ", "without ", c->without, c->without_count},
                 {"--step ", NULL, &c->step, c->step != NULL},
                 {"--until ", NULL, &c->until, c->until != NULL}};
    const char *separator = as_label ? "" : " ";
    FILE *out = alloc_text(&text, NULL);
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        for (int k = 0; k < parts[i].count && (!as_label || parts[i].label != NULL); k++) {
            char *word =
                as_label ? alloc_words("%s", parts[i].list[k]) : pricing_quoted(parts[i].list[k]);
            fprintf(out, "%s%s%s", separator, as_label ? parts[i].label : parts[i].option, word);
            separator = as_label ? ", " : " ";
            free(word);
        }
    }
    alloc_text_end(out);
    return text;
}

/* Is this point the scene with its own values? */
static bool is_own(const pricing_scene *p, int point) {
    return p->grid->count == 0 || (p->has_own && point == p->source.points - 1);
}

static const char *name_of(void *context, int point) {
    pricing_scene *p = context;
    double *value = alloc(p->grid->count, sizeof *value);
    char number[NUMBER_SIZE];
    free(p->name);
    FILE *out = alloc_text(&p->name, NULL);
    const int axes = is_own(p, point) ? 0 : p->grid->count;
    if (axes > 0) {
        grid_values(p->grid, (uint64_t)point, value);
    }
    for (int i = 0; i < axes; i++) {
        const axis *a = &p->grid->axes[i];
        char *word = shown_assignment(a->symbol, a->primes, number_shortest(value[i], number));
        char *quoted = pricing_quoted(word);
        fprintf(out, " %s %s", a->is_start ? "--start" : "--set", quoted);
        free(word);
        free(quoted);
    }
    alloc_text_end(out);
    free(value);
    return p->name;
}

/* --- images ----------------------------------------------------------------------------------------*/

/* The command line's changes, then the varied values, which override them. Free with changes_forget(). */
static overrides changes_in(const pricing_scene *p, int point) {
    static const grid none = {0};
    return changes_at(is_own(p, point) ? &none : p->grid, p->changes, (uint64_t)point);
}

/* Do these settings give the same operation lists? Method and angles matter only with a matrix or --stabilized. */
static bool same_lists(const image_settings *a, const image_settings *b) {
    const bool matrix = a->matrix != MATRIX_NONE;
    return a->compensated == b->compensated && a->stabilized == b->stabilized &&
           a->matrix == b->matrix && a->tables == b->tables && a->cells == b->cells &&
           (!(matrix || a->stabilized) || (a->method == b->method && a->angles == b->angles));
}

/* Finds or makes the point's image. Returns NULL if the scene refuses the settings, or after an error (reported). */
static const image *base_of(pricing_scene *p, int point, const image_settings *settings) {
    for (int i = 0; i < p->made_count; i++) {
        if (p->made[i].point == point && same_lists(&p->made[i].settings, settings)) {
            return p->made[i].image;
        }
    }
    if (p->equations[point] == NULL) {
        overrides changes = changes_in(p, point);
        instance_free(p->instance[point]);
        instance *inst = instance_make(p->mechanism, p->scene, &changes, p->errors);
        p->instance[point] = inst;
        p->equations[point] = inst == NULL ? NULL : equations_derive(inst, p->errors);
        changes_forget(p->changes, &changes);
        if (p->equations[point] == NULL) {
            return NULL;
        }
    }
    const equations *e = p->equations[point];
    diags *unsaid = setting_may_be_refused(settings) ? diags_new() : NULL;
    image *made = image_make(e, e->instance->conserve, settings, IMAGE_TO_RUN,
                             unsaid != NULL ? unsaid : p->errors);
    diags_free(unsaid);
    if (made != NULL || setting_may_be_refused(settings)) {
        p->made = alloc_more(p->made, p->made_count + 1, sizeof *p->made);
        p->made[p->made_count++] = (pricing_made){point, *settings, made, false};
    }
    return made;
}

static image *make(void *context, int point, const setting *s, const char *step,
                   const char *until) {
    pricing_scene *p = context;
    overrides changes = changes_in(p, point);
    const char *own = changes.step;
    changes.step = step != NULL ? step : own;
    changes.until = until != NULL ? until : changes.until;
    const image *base = base_of(p, point, &s->image);
    instance *inst =
        base == NULL ? NULL : instance_make(p->mechanism, p->scene, &changes, p->errors);
    diags *unsaid = setting_may_be_refused(&s->image) ? diags_new() : NULL;
    image *made =
        inst == NULL ? NULL : image_again(base, inst, unsaid != NULL ? unsaid : p->errors);
    if (made != NULL) {
        made->settings.method = s->image.method;
        made->settings.angles = s->image.angles;
    }
    diags_free(unsaid);
    instance_free(inst);
    changes.step = own;
    changes_forget(p->changes, &changes);
    diags_flush(p->errors, stderr);
    return made;
}

pricing_scene *pricing_scene_new(const mechanism *of, const scene *in, const overrides *changes,
                                 const grid *g, diags *errors) {
    pricing_scene *p = alloc(1, sizeof *p);
    const int points = g->count > 0 ? (int)g->points : 1;
    *p = (pricing_scene){
        .mechanism = of,
        .scene = in,
        .changes = changes,
        .grid = g,
        .errors = errors,
        .instance = alloc(points + 1, sizeof(instance *)), /* one more for the scene's own values */
        .equations = alloc(points + 1, sizeof(equations *)),
        .source = {.points = points, .make = make, .name = name_of}};
    p->source.context = p;
    return p;
}

void pricing_scene_add_own(pricing_scene *p, const instance *own) {
    const grid *g = p->grid;
    double *value = alloc(g->count, sizeof *value);
    bool among = g->count == 0;
    for (int point = 0; point < p->source.points && !among; point++) {
        grid_values(g, (uint64_t)point, value);
        among = true;
        for (int i = 0; i < g->count; i++) {
            const axis *a = &g->axes[i];
            among = among && value[i] == instance_value(own, a->symbol, a->primes);
        }
    }
    free(value);
    p->has_own = !among;
    p->source.points += !among;
}

void pricing_scene_lend(pricing_scene *p, const image_settings *settings, const image *lent) {
    if (lent != NULL) {
        p->made = alloc_more(p->made, p->made_count + 1, sizeof *p->made);
        p->made[p->made_count++] = (pricing_made){0, *settings, (image *)(uintptr_t)lent, true};
    }
}

void pricing_scene_free(pricing_scene *p) {
    if (p == NULL) {
        return;
    }
    for (int i = 0; i < p->made_count; i++) {
        image_free(p->made[i].lent ? NULL : p->made[i].image);
    }
    for (int i = 0; i < p->source.points; i++) {
        equations_free(p->equations[i]);
        instance_free(p->instance[i]);
    }
    free(p->instance);
    free(p->equations);
    free(p->made);
    free(p->name);
    free(p);
}
