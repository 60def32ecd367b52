#include "image_parts.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/lang/value.h"

image_draft image_draft_new(void) {
    struct arena *memory = arena_new();
    image_draft d = {.made = arena_alloc(memory, sizeof *d.made)};
    d.made->memory = memory;
    return d;
}

void *image_room(image_draft *d, int count, size_t size) {
    return count > 0 ? arena_alloc(d->made->memory, (size_t)count * size) : NULL;
}

const char *image_text(image_draft *d, const char *text) {
    return arena_copy(d->made->memory, text, strlen(text));
}

static source *copy_source(image_draft *d, const source *from) {
    source *made = image_room(d, 1, sizeof *made);
    made->file = image_text(d, from->file);
    made->length = from->length;
    if (from->text != NULL) {
        made->text = arena_copy(d->made->memory, from->text, from->length);
    }
    d->original = arena_room(d->made->memory, d->original, d->sources, sizeof(const source *));
    d->copy = arena_room(d->made->memory, d->copy, d->sources, sizeof(source *));
    d->original[d->sources] = from;
    d->copy[d->sources++] = made;
    return made;
}

place image_place(image_draft *d, place at) {
    for (int i = 0; i < d->sources && at.source != NULL; i++) {
        if (d->original[i] == at.source) {
            at.source = d->copy[i];
            return at;
        }
    }
    at.source = at.source != NULL ? copy_source(d, at.source) : NULL;
    return at;
}

image_unit image_unit_of(image_draft *d, const symbol *s, int primes) {
    const unit_scale in = shown_unit(s);
    char *name = shown_unit_name(s, primes);
    char *si = shown_si_name(s, primes);
    const image_unit made = {image_text(d, name), image_text(d, si), in.scale, in.divisor};
    free(name);
    free(si);
    return made;
}

image_quantity image_quantity_of(image_draft *d, const symbol *s, double value) {
    return (image_quantity){.name = image_text(d, s->name),
                            .text = image_text(d, s->text),
                            .unit = image_unit_of(d, s, 0),
                            .value = value,
                            .at = image_place(d, s->at)};
}
