#include "priced.h"
#include "test.h"

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

/* Names a place by its options. If there is only one place, its name is empty. */
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
    p->request = (trial_request){.source = &p->source,
                                 .board = cost_board_named(board),
                                 .target = "f.whirl:s",
                                 .changes = " --set m=3",
                                 .of = of,
                                 .spacing = spacing,
                                 .records = count};
    TEST_ASSERT_NOT_NULL_MESSAGE(p->request.board, board);
    return trial_begin(&p->trial, &p->request);
}

void priced_close(priced *p) {
    if (p->trial.request.source != NULL) {
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

const char *const priced_spring[1] = {
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 40 [N/m]*x^2/2 + 9 [N/m^3]*x^4/4\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n"};

const char *const priced_scenes[PRICED_SCENES] = {
    ("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
     "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
     "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n"),
    ("mechanism m\ncoordinate a [rad]\ncoordinate x [m]\ninput u = 1 [N]\n"
     "T = 2 [kg]*x'^2/2 + 1 [kg]*((x' + 1 [m]*a'*cos(a))^2 + (1 [m]*a'*sin(a))^2)/2\n"
     "V = -8 [J]*cos(a) + 3 [N/m]*x^2/2\nQ(x) = u\n"
     "scene s { start a = 1 [rad]; step 1 [ms]; until 1 [s]\n"
     "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s], a' = -20 .. 20 [rad/s], u = -2 .. 2 [N] }\n"),
    ("mechanism m\nstate y\nequation y' + 4 [1/s]*y + 1 [1/s]*y^3 = 1 [1/s]\n"
     "scene s { start y = 3; step 1 [ms]; until 1 [s]\nrange y = -4 .. 4 }\n")};

setting priced_tried(int i) {
    static const wh_method methods[] = {WH_HEUN, WH_RK4, WH_RK38};
    return priced_setting(methods[i % 3], i < 3 ? &engine_float : &engine_double);
}
