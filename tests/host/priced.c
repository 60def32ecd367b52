/* priced.c: see priced.h. */
#include "priced.h"

#include <stdio.h>
#include <stdlib.h>

#include "unity.h"

const char *const priced_ball[1] = {
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [kg]*9.81 [m/s^2]*x\n"
    "stop x >= 0 [m] restitution 0.5\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n"};

static image *make(void *context, int point, const setting *s, const char *step,
                   const char *until) {
    priced *p = context;
    p->asked++;
    if (p->takes != NULL && !p->takes(s, step != NULL ? strtod(step, NULL) : 0.0)) {
        return NULL;
    }
    return p->scene[point]->source.make(p->scene[point], 0, s, step, until);
}

/* Nothing varies at one place alone. */
static const char *name(void *context, int point) {
    priced *p = context;
    p->place[0] = '\0';
    if (p->source.points > 1) {
        snprintf(p->place, sizeof p->place, " --set place=%d", point);
    }
    return p->place;
}

void priced_open(priced *p, const char *const *texts, int points) {
    *p = (priced){.errors = diags_new()};
    for (int i = 0; i < points; i++) {
        p->d[i] = derived_scene(texts[i], "s");
        derived_expect(&p->d[i], texts[i]);
        p->scene[i] = pricing_scene_new(p->d[i].model->mechanisms[0], p->d[i].model->scenes[0],
                                        &p->changes, &p->grid, p->errors);
    }
    p->source = (trial_source){.context = p, .points = points, .make = make, .name = name};
}

bool priced_begin(priced *p, const char *board, whole_ratio spacing, int count, const char *of) {
    p->wish = (trial_wish){.source = &p->source,
                           .board = cost_board_named(board),
                           .of = of,
                           .spacing = spacing,
                           .records = count};
    TEST_ASSERT_NOT_NULL_MESSAGE(p->wish.board, board);
    return trial_begin(&p->trial, &p->wish);
}

void priced_close(priced *p) {
    if (p->trial.wish.source != NULL) {
        trial_end(&p->trial);
    }
    for (int i = 0; i < p->source.points; i++) {
        pricing_scene_free(p->scene[i]);
        derived_free(&p->d[i]);
    }
    diags_free(p->errors);
}

image *priced_image(priced *p, int point, const setting *s, const char *step) {
    return p->scene[point]->source.make(p->scene[point], 0, s, step, NULL);
}

setting priced_setting(wh_method method, const engine_kind *number) {
    setting s = {IMAGE_SETTINGS_DEFAULT, number};
    s.image.method = method;
    return s;
}
