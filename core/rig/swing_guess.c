/* swing_guess.c: the first guess of a free swing, from the times of its pulses alone. */
#include "free_swing.h"

#include "core/root.h"
#include "datasheet.h"

static wh_real square_of(wh_real x) { return x * x; }

/* Returns sin(A/2), A the amplitude. `time` is period(A) / period(0) = 2/pi K(sin(A/2)), K an elliptic integral. */
static wh_real sine_of_time(wh_real time) {
    static const wh_real times[] = {WH_R(1.0),    WH_R(1.0174), WH_R(1.0732), WH_R(1.1803),
                                    WH_R(1.3729), WH_R(1.7622), WH_R(2.1807), WH_R(2.8777)};
    static const wh_real sines[] = {WH_R(0.0),    WH_R(0.2588), WH_R(0.5),    WH_R(0.7071),
                                    WH_R(0.8660), WH_R(0.9659), WH_R(0.9914), WH_R(0.9990)};
    for (unsigned i = 1; i < sizeof times / sizeof times[0]; i++) {
        if (time < times[i]) {
            const wh_real part = (time - times[i - 1U]) / (times[i] - times[i - 1U]);
            return sines[i - 1U] + part * (sines[i] - sines[i - 1U]);
        }
    }
    return WH_R(1.0);
}

/* Returns sqrt(g) from the second shortest of the last periods. If there are only one or two, uses the shortest. */
static wh_real guess_root(const wh_swing *swing) {
    wh_real shortest_s = WH_R(100.0);
    wh_real second_s = WH_R(100.0);
    const unsigned count = swing->passed < WH_SWING_LAST ? swing->passed : WH_SWING_LAST;
    for (unsigned i = 0; i + 2U < count; i++) {
        const wh_real period_s = wh_rig_since_s(swing->last_ticks[i + 2U], swing->last_ticks[i]);
        if (period_s < shortest_s) {
            second_s = shortest_s;
            shortest_s = period_s;
        } else if (period_s < second_s) {
            second_s = period_s;
        }
    }
    const wh_real longer = WH_R(1.0) + WH_R(0.1) / (wh_real)swing->passed;
    return longer * WH_RIG_TWO_PI / (count > 4U ? second_s : shortest_s);
}

static WH_CALLED unsigned next_of(const wh_swing *swing, unsigned at) {
    unsigned next = at + 1U;
    while (next < swing->kept && swing->kept_sensor[next] != 0) {
        next++;
    }
    return next;
}

/* Returns the time between the first two passages of the bottom, divided by the duration of half a small swing. */
static wh_real first_time(const wh_swing *swing, wh_real root) {
    const unsigned next = next_of(swing, swing->first);
    const unsigned last = next < swing->kept ? next : swing->kept - 1U;
    return wh_rig_since_s(swing->kept_ticks[swing->first], swing->kept_ticks[last]) * root /
           (WH_R(0.5) * WH_RIG_TWO_PI);
}

#define NEAR_TOP WH_R(1.5) /* first_time() at an amplitude of 133 deg */

void wh_swing_leave_top(const wh_swing_config *config, wh_swing *swing) {
    const wh_real root = guess_root(swing);
    while (swing->passed > config->swings_least + 2U && first_time(swing, root) > NEAR_TOP) {
        const unsigned next = next_of(swing, next_of(swing, swing->first));
        if (next >= swing->kept) {
            break;
        }
        swing->first = next;
        swing->passed -= 2U;
    }
}

/* mean of 4 sin^2(q/2) over q = 0 to 90 deg */
#define FALLEN WH_R(0.727)

void wh_swing_guess(const wh_swing_config *config, wh_swing *swing) {
    wh_real *x = swing->guess;
    const unsigned first = swing->first;
    static const wh_real factors[WH_SWING_STARTS] = {WH_R(1.0), WH_R(1.04), WH_R(0.98)};
    const wh_real root = factors[swing->start] * guess_root(swing);
    const wh_real time = first_time(swing, root);
    wh_real sine = sine_of_time(time);
    sine = sine > WH_R(0.4) ? sine : WH_R(0.4);
    if (first > 0 && swing->kept_sensor[first - 1U] == 1U) { /* the rotor came from sensor 2 */
        const wh_real mean_radps =
            WH_R(0.25) * WH_RIG_TWO_PI /
            wh_rig_since_s(swing->kept_ticks[first - 1U], swing->kept_ticks[first]);
        sine = WH_R(0.5) * WH_SQRT(square_of(mean_radps / root) + FALLEN);
    }
    const wh_real gravity = square_of(root);
    for (unsigned i = 0; i < WH_NORMAL_UNKNOWNS; i++) {
        x[i] = WH_R(0.0);
        swing->within[i] = WH_R(0.5) * config->most_rad;
    }
    x[WH_FREE_RATE] = WH_R(-2.0) * root * sine;
    x[WH_FREE_GRAVITY] = gravity;
    /* The amplitude begins near 2.3 * sine. Each quarter swing reduces the amplitude by friction / gravity. */
    x[WH_FREE_FRICTION] = gravity * WH_R(2.3) * sine / (wh_real)(2U * swing->passed + 1U);
    x[WH_FREE_DRAG] = WH_R(0.003) * gravity;
    swing->within[WH_FREE_Q] =
        WH_SQRT(square_of(config->jitter_s * x[WH_FREE_RATE]) + square_of(config->rough_rad));
    swing->within[WH_FREE_RATE] = WH_R(-0.3) * x[WH_FREE_RATE];
    swing->within[WH_FREE_GRAVITY] = WH_R(0.3) * gravity;
    swing->within[WH_FREE_FRICTION] = x[WH_FREE_FRICTION] + WH_R(0.01) * gravity;
    swing->within[WH_FREE_DRAG] = WH_R(0.005) * gravity;
    for (unsigned i = 0; i < WH_NORMAL_UNKNOWNS; i++) {
        swing->x[i] = x[i];
    }
}
