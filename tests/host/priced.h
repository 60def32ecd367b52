/* priced.h: scenes from texts, and the settings with which they have an image, for quick suites of `whirl price`
 * (host/study). */
#ifndef TESTS_HOST_PRICED_H
#define TESTS_HOST_PRICED_H

#include "derived.h"
#include "host/cli/pricing_scene.h"

enum { PRICED_POINTS = 3 };

typedef struct priced {
    derived d[PRICED_POINTS];
    pricing_scene *scene[PRICED_POINTS];
    overrides changes;
    grid grid;
    diags *errors;
    /* Returns true if the setting has an image with this step (0: the scene's own). NULL: always true. */
    bool (*takes)(const setting *s, double step_s);
    int asked; /* number of images made so far */
    char place[32];
    trial_source source;
    trial_wish wish;
    trials trial;
} priced;

/* Texts of scenes: priced_ball bounces; priced_spring hardens. */
extern const char *const priced_ball[1];
extern const char *const priced_spring[1];
/* Texts with ranges for fixed point: of second order, with a turn angle and an input, and of first order. */
enum { PRICED_SCENES = 3 };
extern const char *const priced_scenes[PRICED_SCENES];

void priced_open(priced *p, const char *const *texts, int points);
/* Begins trials of these settings' scenes with their references. Returns the result of trial_begin(). */
bool priced_begin(priced *p, const char *board, whole_ratio spacing, int count, const char *of);
void priced_close(priced *p);
/* The image of a place; to be freed. */
image *priced_image(priced *p, int point, const setting *s, const char *step);

setting priced_setting(wh_method method, const engine_kind *number);
/* Settings by number: three methods in float, then in double. */
enum { PRICED_TRIED = 6 };
setting priced_tried(int i);

#endif
