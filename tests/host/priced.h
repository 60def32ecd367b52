/* priced.h: for the quick suites of host/price: scenes of a text each as the places of trials, and which settings they have
 * an image of. */
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
    /* Is there an image with this step, 0 for the scene's own? NULL: wherever the scenes take the setting. */
    bool (*takes)(const setting *s, double step_s);
    int asked; /* images so far */
    char place[32];
    trial_source source;
    trial_wish wish;
    trials trial;
} priced;

/* Texts: a ball that bounces; a spring that hardens. */
extern const char *const priced_ball[1];
extern const char *const priced_spring[1];
/* And with ranges, for fixed point: of second order, with a turn angle and an input, of first order. */
enum { PRICED_SCENES = 3 };
extern const char *const priced_scenes[PRICED_SCENES];

/* Scenes `s` of so many texts. */
void priced_open(priced *p, const char *const *texts, int points);
/* Trials of these, with their references: what trial_begin() says. */
bool priced_begin(priced *p, const char *board, whole_ratio spacing, int count, const char *of);
void priced_close(priced *p);
/* The image of a place. To be freed. */
image *priced_image(priced *p, int point, const setting *s, const char *step);

/* A plain setting. */
setting priced_setting(wh_method method, const engine_kind *number);
/* A few of them, by number: three methods in float, then in double; and whether a setting is one of these, for `takes`. */
enum { PRICED_TRIED = 6 };
setting priced_tried(int i);
bool priced_is_tried(const setting *s, double step_s);

#endif
