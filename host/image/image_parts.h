/* image_parts.h: copying names, units and places of the language into an image. For host/derive only. */
#ifndef IMAGE_IMAGE_PARTS_H
#define IMAGE_IMAGE_PARTS_H

#include "host/image/image.h"
#include "host/lang/model.h"

typedef struct image_draft {
    image *made;
    /* [sources] copy[i] is the copy of original[i]. The image's memory owns the copies and both arrays. */
    const source **original;
    source **copy;
    int sources;
} image_draft;

image_draft image_draft_new(void);

/* Returns zeroed memory of the image, or NULL for count 0. */
void *image_room(image_draft *d, int count, size_t size);
const char *image_text(image_draft *d, const char *text);

/* Converts a place to one in the image's copy of the source. */
place image_place(image_draft *d, place at);

/* The unit of a symbol's derivative with `primes` primes. */
image_unit image_unit_of(image_draft *d, const symbol *s, int primes);
image_quantity image_quantity_of(image_draft *d, const symbol *s, double value);

#endif
