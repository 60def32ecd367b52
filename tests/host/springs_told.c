/* springs_told.c: see springs_told.h. */
#include "springs_told.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>

#include "unity.h"

double springs_nice_s(double most_s, char word[40]) {
    static const int leading[] = {5, 2, 1};
    for (long long ns = 10000000000; ns > 0; ns /= 10) {
        for (int i = 0; i < 3; i++) {
            const long long step_ns = ns * leading[i];
            if (1e-9 * (double)step_ns <= most_s * (1.0 + 1e-9)) {
                static const char *const units[] = {"ns", "us", "ms", "s"};
                int unit = 0;
                long long count = step_ns;
                for (; count >= 1000 && unit < 3; count /= 1000) {
                    unit++;
                }
                snprintf(word, 40, "%lld%s", count, units[unit]);
                return 1e-9 * (double)step_ns;
            }
        }
    }
    TEST_FAIL_MESSAGE("too fine for this test");
    return 0.0;
}

static volatile sig_atomic_t stop_now; /* asked behind each step that is tried */

springs springs_of(const engine_kind *kind, wh_method method, double step_s, int steps, double z) {
    char text[600];
    const double stiff = z * z / (step_s * step_s);
    snprintf(
        text, sizeof text,
        "mechanism m\ncoordinate q [deg]\ncoordinate y [mm]\ncoordinate x [cm]\n"
        "T = 1 [kg]*x'^2/2 + 1 [kg]*y'^2/2 + 1 [kg*m^2]*q'^2/2\n"
        "V = %.17g [N/m]*x^2/2 + %.17g [N/m]*y^2/2\n"
        "scene s { start x = 1 [m], y = 0.3 [m], q' = 2 [rad/s]; step %.9f [s]; until %.9f [s] }\n",
        stiff, stiff / 25.0, step_s, step_s * steps);
    springs s = {.d = derived_scene(text, "s"), .step_s = step_s, .steps = steps, .method = method};
    derived_expect(&s.d, text);
    s.d.image->settings.method = method;
    s.run = kind->start(s.d.image);
    s.v = verdict_open(s.d.image, kind);
    verdict_enter(s.v, s.run);
    for (int i = 0; i < steps; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, kind->step(s.run));
        verdict_enter(s.v, s.run);
    }
    stop_now = 0;
    verdict_end(s.v, s.run, false, &stop_now);
    return s;
}

void springs_end(springs *s) {
    s->v->kind->stop(s->run);
    verdict_close(s->v);
    derived_free(&s->d);
}

static wh_status fail(void *run) {
    (void)run;
    return WH_E_DIVERGED;
}

trial springs_trial(dice *d, springs *s, engine_kind *failing) {
    const trial t = (trial)dice_one_of(d, TRIALS);
    *failing = *s->v->kind;
    failing->step = fail;
    if (t == NOT_TRIED && dice_one_of(d, 2) == 0) {
        stop_now = 1;
    } else if (t == NOT_TRIED) {
        s->v->about.cures.spent = 5e8;
    } else if (t == FAILS) {
        s->v->about.cures.kind = failing;
    }
    return t;
}

const char *const springs_done[TRIALS] = {"would do", "should do (not tried: that takes long)",
                                          "resolves that, but is not all that it takes"};

double springs_lost_by(wh_method method, double w, double step_s, double span_s) {
    const double z = w * step_s;
    const double growth_2 =
        method == WH_HEUN ? 1.0 + pow(z, 4) / 4.0 : 1.0 - pow(z, 6) / 72.0 + pow(z, 8) / 576.0;
    return fabs(pow(growth_2, 0.5 * span_s / step_s) - 1.0);
}

double springs_nice_words(const springs *s, double w, double most_s, double share, double allowed,
                          char word[40]) {
    double step_s = springs_nice_s(most_s, word);
    while (2.0 * share * springs_lost_by(s->method, w, step_s, s->steps * s->step_s) > allowed) {
        step_s = springs_nice_s(0.7 * step_s, word);
    }
    return step_s;
}
