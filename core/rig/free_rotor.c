/* free_rotor.c: a rotor under gravity and friction alone. */
#include "free_rotor.h"

#include "wave.h"

void wh_free_rotor_start(wh_free_rotor *rotor, wh_real q_rad, wh_real rate_radps) {
    *rotor = (wh_free_rotor){.q_rad = wh_free_angle(q_rad), .rate_radps = rate_radps};
    rotor->q_by[WH_FREE_Q] = WH_R(1.0);
    rotor->rate_by[WH_FREE_RATE] = WH_R(1.0);
}

static void drift(wh_free_rotor *rotor, wh_real h) {
    rotor->q_rad = wh_free_angle(rotor->q_rad + h * rotor->rate_radps);
    for (unsigned i = 0; i < WH_FREE_CAUSES; i++) {
        rotor->q_by[i] += h * rotor->rate_by[i];
    }
}

static void kick(const wh_real *cause, wh_free_rotor *rotor, wh_real h) {
    const wh_wave wave = wh_wave_of(rotor->q_rad);
    const wh_real rate = rotor->rate_radps;
    const wh_real sign = rate < WH_R(0.0) ? WH_R(-1.0) : WH_R(1.0);
    const wh_real pulled = -cause[WH_FREE_GRAVITY] * wave.sine;
    const wh_real slowed = pulled - sign * cause[WH_FREE_FRICTION] - cause[WH_FREE_DRAG] * rate;
    wh_real before = h; /* it turns back */
    wh_real after = WH_R(0.0);
    wh_real ratio = WH_R(1.0);
    rotor->rate_radps = rate + h * slowed;
    if (rotor->rate_radps * sign < WH_R(0.0)) {
        before = -rate / slowed;
        after = h - before;
        ratio = (pulled + sign * cause[WH_FREE_FRICTION]) / slowed;
        ratio = ratio > WH_R(0.0) ? ratio : WH_R(0.0); /* friction holds it there */
        rotor->rate_radps = ratio * slowed * after;
    }
    const wh_real both = ratio * before + after;
    const wh_real by_q = -both * cause[WH_FREE_GRAVITY] * wave.cosine;
    const wh_real by_rate = ratio * (WH_R(1.0) - before * cause[WH_FREE_DRAG]);
    for (unsigned i = 0; i < WH_FREE_CAUSES; i++) {
        rotor->rate_by[i] = by_rate * rotor->rate_by[i] + by_q * rotor->q_by[i];
    }
    rotor->rate_by[WH_FREE_GRAVITY] -= both * wave.sine;
    rotor->rate_by[WH_FREE_FRICTION] += sign * (after - ratio * before);
    rotor->rate_by[WH_FREE_DRAG] -= ratio * before * rate;
}

void wh_free_rotor_step(const wh_real *cause, wh_free_rotor *rotor, wh_real h) {
    drift(rotor, WH_R(0.5) * h);
    kick(cause, rotor, h);
    drift(rotor, WH_R(0.5) * h);
}
