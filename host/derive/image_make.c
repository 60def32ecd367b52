/* image_make.c: see image_make.h. The image, and what it would be if its numbers had been folded otherwise. */
#include "image_make.h"

#include "host/number/folding.h"
#include "lagrange.h"

/* Where sums of constants lose more of an addend, it is asked what that does. */
#define FOLDED_MUCH 1e-9

_Static_assert((int)FOLDING_WAYS - (int)FOLDING_OTHER == (int)IMAGE_WAYS, "a place for each way");

/* Has it the same state and the same signals? */
static bool is_alike(const image *im, const image *other) {
    bool alike = im->form == other->form && im->coordinates == other->coordinates &&
                 im->angles == other->angles && im->reals == other->reals &&
                 im->recovered == other->recovered && im->contacts == other->contacts;
    for (int i = 0; i < im->angles + im->reals && alike; i++) {
        const component a = image_component(im, i);
        const component b = image_component(other, i);
        alike = a.unknown == b.unknown && a.primes == b.primes;
    }
    for (int role = 0; role < IMAGE_ROLES && alike; role++) {
        const tape *a = im->list[role];
        const tape *b = other->list[role];
        alike = (a == NULL) == (b == NULL) && (a == NULL || a->results == b->results);
    }
    return alike;
}

/* The numbers and all of the derivation again; NULL where it comes to something else. */
static image *make_otherwise(image *im, const equations *e, const bool *conserve,
                             const image_settings *settings, int way) {
    diags *unsaid = diags_new();
    const folding before = folding_begin(way, NULL);
    instance *again = instance_again(e->instance);
    im->unbounded = im->unbounded || again == NULL;
    equations *other = again != NULL ? equations_derive(again, unsaid) : NULL;
    image *made =
        other != NULL ? image_once(other, conserve, settings, IMAGE_TO_WRITE, unsaid) : NULL;
    (void)folding_end(before);
    equations_free(other);
    instance_free(again);
    diags_free(unsaid);
    if (made != NULL && !is_alike(im, made)) {
        image_free(made);
        made = NULL;
    }
    return made;
}

image *image_make(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors) {
    const folding before = folding_begin(FOLDING_NEAREST, &e->folding);
    image *im = image_once(e, conserve, settings, use, errors);
    const double lost = folding_end(before).lost;
    if (im == NULL) {
        return NULL;
    }
    const bool asks = use == IMAGE_TO_RUN && lost > FOLDED_MUCH;
    for (int way = FOLDING_OTHER; way < FOLDING_WAYS && asks; way++) {
        image *other = make_otherwise(im, e, conserve, settings, way);
        if (other != NULL) {
            im->otherwise[im->ways++] = other;
        }
    }
    return im;
}
