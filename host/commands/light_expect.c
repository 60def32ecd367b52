/* light_expect.c: see light_expect.h. */
#include "light_expect.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/run/loop.h"
#include "load.h"

/* A control period, 2 ms, may begin so much early or late (hal/clock.h). */
#define PERIOD_LEAST_US 1900
#define PERIOD_MOST_US 2100

int light_field(const char *name, const char *more) {
    char whole[LIGHT_EXPECTED];
    (void)snprintf(whole, sizeof whole, "%s%s", name, more);
    int i = 0;
    while (strcmp(light_names[i], whole) != 0) {
        i++;
    }
    return i;
}

/* The interpreter in float has the boards' bits. */
static int run_scene(const char *name, light_expected *e) {
    static const load_wish wish = {.settings = IMAGE_SETTINGS_DEFAULT,
                                   .use = IMAGE_TO_WRITE,
                                   .keep = KEEP_IMAGE,
                                   .conserve = true};
    source_model from;
    const mechanism *of = NULL;
    const scene *in = NULL;
    loaded made = {.image = NULL};
    int code = source_open(&from, name);
    code = code == EXIT_DONE ? source_pick(&from, true, &of, &in) : code;
    code = code == EXIT_DONE ? load(&made, &from, of, in, NULL, &wish) : code;
    if (code == EXIT_DONE) {
        void *run = engine_float.start(made.image);
        const wh_status status = loop_steps(&engine_float, run, made.image->steps);
        (void)snprintf(e->of[light_field("model.", name)], LIGHT_EXPECTED, "0x%016" PRIx64,
                       made.image->hash);
        (void)snprintf(e->of[light_field("hash.", name)], LIGHT_EXPECTED,
                       "0x%016" PRIx64 " %" PRIu64 " steps, %s", engine_float.hash(run),
                       engine_float.steps(run), wh_status_text(status));
        engine_float.stop(run);
    }
    unload(&made);
    source_close(&from);
    return code;
}

int light_expect(light_expected *e) {
#define SCENE_NAME(scene) #scene,
    static const char *const scenes[] = {WH_LIGHT_SCENES(SCENE_NAME)};
    int code = EXIT_DONE;
    for (int i = 0; i < LIGHT_SCENES && code == EXIT_DONE; i++) {
        code = run_scene(scenes[i], e);
    }
    static const char *const known[][2] = {
        {"version", WH_VERSION}, {"clock", "crystal"}, {"stop", "released"}, {"selftest", "good"}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        (void)snprintf(e->of[light_field(known[i][0], "")], LIGHT_EXPECTED, "%s", known[i][1]);
    }
    (void)snprintf(e->of[light_field("period_us", "")], LIGHT_EXPECTED, "%d %d", PERIOD_LEAST_US,
                   PERIOD_MOST_US);
    return code;
}

static bool may_be_none(const char *name) {
    return strncmp(name, "model.", 6) != 0 && strncmp(name, "hash.", 5) != 0 &&
           strcmp(name, "version") != 0 && strcmp(name, "board") != 0 &&
           strcmp(name, "compiler") != 0;
}

light_verdict light_judge(int field, const char *value, const char *wanted) {
    const char *name = light_names[field];
    if (light_is_none(value) && may_be_none(name)) {
        return LIGHT_NONE;
    }
    if (wanted[0] == '\0' || strcmp(name, "stack") == 0) {
        return LIGHT_TOLD; /* interrupts of silicon take stack, too */
    }
    if (strcmp(name, "period_us") == 0) {
        char *end = NULL;
        const long least = strtol(value, &end, 10);
        const bool two = *end == ' ';
        const long most = two ? strtol(end + 1, &end, 10) : 0;
        return two && *end == '\0' && least >= PERIOD_LEAST_US && most <= PERIOD_MOST_US &&
                       least <= most
                   ? LIGHT_EQUAL
                   : LIGHT_DIFFERS;
    }
    if (strcmp(name, "selftest") == 0) { /* its parts follow */
        return strncmp(value, "good ", 5) == 0 ? LIGHT_EQUAL : LIGHT_DIFFERS;
    }
    return strcmp(value, wanted) == 0 ? LIGHT_EQUAL : LIGHT_DIFFERS;
}
