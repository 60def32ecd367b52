/* test_contact_redundant.c: a plate on two to five supports in a line, more than needed: the forces are not unique, but
 * the motion is. The plate rests, or leaves all supports at once when they accelerate downwards faster than gravity, or
 * tips over the outermost one under a torque. Compared with closed forms. */
#include "command.h"
#include "contacts.h"
#include "motion.h"

enum { TEXT = 2000 };

#define GRAVITY 9.81

typedef struct plate {
    int supports;
    double place_m[5]; /* rising; the last is the furthest right */
    double mass_kg;
    double inertia_kgm2;
    double rate;   /* of the clock, rad/s */
    double height; /* amplitude of the supports' swing, m, or of the torque, N m */
} plate;

static plate drawn(dice *d) {
    plate p = {.supports = 2 + (int)dice_one_of(d, 4)};
    double at = -dice_between(d, 0.2, 1.0);
    for (int i = 0; i < p.supports - 1; i++) {
        p.place_m[i] = at * (1.0 - (double)i / p.supports);
    }
    p.place_m[p.supports - 1] = dice_between(d, 0.1, 1.0);
    p.mass_kg = dice_between(d, 0.5, 3.0);
    p.inertia_kgm2 = dice_between(d, 0.05, 1.0);
    p.rate = dice_between(d, 2.0, 20.0);
    return p;
}

/* With `falls` the supports move as height sin(c), and y is the plate's height above them. Otherwise a torque tips the plate
 * to the right. */
static void write(const plate *p, bool falls, char text[TEXT]) {
    int at = snprintf(text, TEXT,
                      "mechanism plate\ncoordinate y [m]\ncoordinate a [rad]\ncoordinate c [rad]\n"
                      "T = %.17g [kg]*y'^2/2 + %.17g [kg*m^2]*a'^2/2 + 1 [kg*m^2]*c'^2/2\n"
                      "V = %.17g [N]*y\n",
                      p->mass_kg, p->inertia_kgm2, p->mass_kg * GRAVITY);
    at += falls
              ? snprintf(text + at, (size_t)(TEXT - at), "Q(y) = %.17g [N]*sin(c)\n",
                         p->mass_kg * p->height * p->rate * p->rate)
              : snprintf(text + at, (size_t)(TEXT - at), "Q(a) = %.17g [N*m]*sin(c)\n", p->height);
    for (int i = 0; i < p->supports; i++) {
        at += snprintf(text + at, (size_t)(TEXT - at),
                       "stop y - %.17g [m]*a >= 0 [m] restitution 0\n", p->place_m[i]);
    }
    snprintf(text + at, (size_t)(TEXT - at),
             "scene s { start c' = %.17g [rad/s]\nstep 1 [ms]\nuntil 1 [s] }\n", p->rate);
}

/* Largest errors of place and angle at the steps until `until_s`. */
static double run(const plate *p, bool falls, const engine_kind *kind, double until_s) {
    char text[TEXT];
    motion m;
    double most = 0.0;
    write(p, falls, text);
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4});
    const double edge = p->place_m[p->supports - 1];
    const double weight = p->mass_kg * GRAVITY;
    const double begins = falls ? asin(GRAVITY / (p->height * p->rate * p->rate)) / p->rate
                                : asin(weight * edge / p->height) / p->rate;
    const double turned = p->inertia_kgm2 + p->mass_kg * edge * edge;
    for (int k = 1; k * 1e-3 < until_s; k++) {
        const double t = k * 1e-3;
        const double c = p->rate * t;
        const double c0 = p->rate * begins;
        const double dt = t - begins;
        double y = 0.0;
        double a = 0.0;
        if (dt > 0.0 && falls) {
            y = p->height * (sin(c0) - sin(c) + p->rate * cos(c0) * dt) - GRAVITY * dt * dt / 2.0;
        } else if (dt > 0.0) {
            a = (p->height * (sin(c0) - sin(c) + cos(c0) * p->rate * dt) / (p->rate * p->rate) -
                 weight * edge * dt * dt / 2.0) /
                turned;
            y = edge * a;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, motion_step(&m, 1), text);
        most = fmax(most, fmax(fabs(motion_value(&m, "y") - y), fabs(motion_value(&m, "a") - a)));
    }
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    motion_close(&m);
    return most;
}

static void expect(bool falls, const char *words) {
    dice d = dice_of("redundant", falls ? 15005 : 15006);
    const unsigned cases = dice_cases(few_or_all(10, 100));
    double worst[2] = {0.0, 0.0};
    for (unsigned i = 0; i < cases; i++) {
        plate p = drawn(&d);
        double until_s = 0.0;
        if (falls) {
            /* the plate flies from sin c0 = share until shortly after the top of the supports' swing */
            const double share = dice_between(&d, 0.3, 0.9);
            p.height = GRAVITY / (share * p.rate * p.rate);
            until_s = 1.7 / p.rate;
        } else {
            p.height = p.mass_kg * GRAVITY * p.place_m[p.supports - 1] / dice_between(&d, 0.3, 0.9);
            until_s = 1.55 / p.rate;
        }
        worst[0] = fmax(worst[0], run(&p, falls, &engine_double, fmin(until_s, 1.0)));
        worst[1] = fmax(worst[1], run(&p, falls, &engine_float, fmin(until_s, 1.0)));
    }
    printf("  %s, %u plates: off by at most %.1e in double, %.1e in float\n", words, cases,
           worst[0], worst[1]);
    TEST_ASSERT_TRUE(worst[0] < 1e-9);
    TEST_ASSERT_TRUE(worst[1] < 1e-5);
}

TEST(contact_redundant, supports_fall_away) { expect(true, "supports that fall away"); }
TEST(contact_redundant, plates_tip) { expect(false, "plates that tip"); }
