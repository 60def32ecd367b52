/* priced.h: trials of scenes that are given as text, for quick suites of `whirl price` (host/study). */
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
    /* Is there an image for the setting with this step (0: the scene's own step)? NULL: there always is. */
    bool (*takes)(const setting *s, double step_s);
    int asked; /* number of images requested so far */
    char place[32];
    trial_source source;
    trial_request request;
    trials trial;
} priced;

/* Scenes as text: a bouncing ball, and a spring that hardens. */
extern const char *const priced_ball[1];
extern const char *const priced_spring[1];
/* Scenes as text, with ranges for fixed point. They are of second order, of second order with a turn angle and an
 * input, and of first order. */
enum { PRICED_SCENES = 3 };
extern const char *const priced_scenes[PRICED_SCENES];

void priced_open(priced *p, const char *const *texts, int points);
/* Begins trials of the scenes with `count` settings, and computes their references. Returns the result of
 * trial_begin(). */
bool priced_begin(priced *p, const char *board, whole_ratio spacing, int count, const char *of);
void priced_close(priced *p);
/* The image of the scene at a place. The caller frees the image. */
image *priced_image(priced *p, int point, const setting *s, const char *step);

setting priced_setting(wh_method method, const engine_kind *number);
/* Setting number i: three methods in float, then the same methods in double. */
enum { PRICED_TRIED = 6 };
setting priced_tried(int i);

#endif
