/* scene_set.c: corrects one component of a state from a measurement. The next step finds the contacts' modes again. */
#include "step/driven.h"

/* Limit on an angle, and on the change of an angle, in rad. contact_crossing.h has the same limit for assignments. */
#define ANGLE_MOST WH_R(1e9)

static bool has_books(const wh_scene *scene, const wh_state *state) {
    return scene->ledger != NULL && state->steps > 0; /* the first step starts the ledger */
}

/* Sets component number `at` (angles first) to *angle or *real. The other pointer is NULL. */
static void replace(const wh_scene *scene, wh_state *state, unsigned at, const wh_angle *angle,
                    const wh_real *real) {
    wh_real before[WH_ACCOUNTS_MAX];
    if (has_books(scene, state)) {
        wh_ledger_last_levels(scene->ledger, state, before);
    }
    if (angle != NULL) {
        state->angle[at] = *angle;
    } else if (real != NULL) {
        state->real[at - scene->angles] = *real;
    }
    if (state->carry != NULL) {
        state->carry[at] = WH_R(0.0);
    }
    for (unsigned k = 0; k < scene->held; k++) {
        state->held[k] = WH_R(0.0);
    }
    for (unsigned k = 0; k < scene->contacts; k++) {
        state->contacts->mode[k] = WH_UNSET;
    }
    if (has_books(scene, state)) {
        wh_ledger_correct(scene->ledger, state, before);
    }
}

static bool is_started(const wh_scene *scene, const wh_state *state) {
    return scene != NULL && state != NULL && state->real != NULL;
}

/* True if this real follows an input with a rate: the next step would overwrite a new value. */
static bool is_driven(const wh_scene *scene, unsigned real) {
    const unsigned linears = ((unsigned)scene->reals - scene->angles) / 2U;
    const unsigned behind = real < linears ? linears : scene->reals;
    return real + scene->driven >= behind;
}

wh_status wh_scene_set_real(const wh_scene *scene, wh_state *state, unsigned real, wh_real value) {
    if (!is_started(scene, state) || real >= scene->reals || is_driven(scene, real) ||
        !wh_believable(value, WH_ABSURD)) {
        return WH_E_ARGUMENT;
    }
    replace(scene, state, scene->angles + real, NULL, &value);
    return WH_OK;
}

wh_status wh_scene_set_angle(const wh_scene *scene, wh_state *state, unsigned angle, wh_real rad) {
    if (!is_started(scene, state) || angle >= scene->angles || !wh_believable(rad, ANGLE_MOST)) {
        return WH_E_ARGUMENT;
    }
    const wh_angle value = wh_angle_from_rad(rad);
    replace(scene, state, angle, &value, NULL);
    return WH_OK;
}

wh_status wh_scene_move_angle(const wh_scene *scene, wh_state *state, unsigned angle,
                              wh_real by_rad) {
    if (!is_started(scene, state) || angle >= scene->angles || !wh_believable(by_rad, ANGLE_MOST)) {
        return WH_E_ARGUMENT;
    }
#if WH_DOUBLE
    const wh_angle value = state->angle[angle] + by_rad;
#else
    const wh_angle value =
        (wh_angle)((uint64_t)state->angle[angle] + (uint64_t)wh_angle_from_rad(by_rad));
#endif
    replace(scene, state, angle, &value, NULL);
    return WH_OK;
}
