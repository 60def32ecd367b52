/* pricing_scene.h: a scene with varied values, as a source of images for trials of settings (host/study/trial.h). */
#ifndef CLI_PRICING_SCENE_H
#define CLI_PRICING_SCENE_H

#include "host/image/image_make.h"
#include "host/study/grid.h"
#include "host/study/trial.h"

/* An image that is reused for the same point and the same operation lists. */
typedef struct pricing_made {
    int point;
    image_settings settings;
    image *image; /* NULL: the scene refuses the settings */
    bool lent;
} pricing_made;

typedef struct pricing_scene {
    const mechanism *mechanism;
    const scene *scene;       /* NULL for a bare mechanism */
    const overrides *changes; /* of the command line, without the varied values */
    const grid *grid;         /* the varied values; may have no axes */
    diags *errors;
    instance **instance;   /* [points] equations[i] is derived from instance[i] */
    equations **equations; /* [points] NULL: not yet derived */
    pricing_made *made;    /* [made_count] */
    int made_count;
    bool has_own; /* the last point is the scene's own values, outside the grid */
    char *name;   /* text of the last requested point */
    trial_source source;
} pricing_scene;

/* PRICING_PLACES_MAX: most points of the grid. PRICING_PLACES: values of a range without a count, such as a=1..2. */
enum { PRICING_PLACES_MAX = 64, PRICING_PLACES = 3 };

pricing_scene *pricing_scene_new(const mechanism *of, const scene *in, const overrides *changes,
                                 const grid *g, diags *errors);
/* Adds a point with the scene's own values, unless the grid has it. Call this before making an image. */
void pricing_scene_add_own(pricing_scene *p, const instance *own);
/* Lends point 0 an image, made with these settings. The caller still frees it. If `lent` is NULL, does nothing. */
void pricing_scene_lend(pricing_scene *p, const image_settings *settings, const image *lent);
void pricing_scene_free(pricing_scene *p); /* NULL is allowed */

/* A word, quoted for a shell if necessary; to be freed. */
char *pricing_quoted(const char *word);
/* The changes as options, with a blank before each. If as_label, as a list such as "m=2, with drag". To be freed. */
char *pricing_words(const overrides *c, bool as_label);

#endif
