/* test_prove_drawn.c: tubes of `whirl prove` for random mechanisms. Masses on arms have decimal parameters that no
 * double equals, and references in 113 bits by d'Alembert's equations. If a coefficient is wrong by 1e-6 or 1e-12,
 * the reference must leave the tube. Linkages with springs, dampers and drives have references in long double. */
#include "command.h"
#include "derived.h"
#include "host/prove/containment.h"
#include "linkage.h"
#include "quad_arms.h"

/* Compares a proved enclosure of a motion (a tube, host/prove/containment.h) with a reference of 113 bits, record by
 * record. */

/* The reference, which is integrated beside the tube, and the result of the comparison. */
typedef struct beside {
    quad_slopes *slopes;
    const void *of;
    quad step_s;
    quad state[QUAD_STATES]; /* in the tube's sequence */
    uint64_t records;
    uint64_t outside; /* first record with a state outside the tube; 0: none */
    double widest;    /* largest width of the tube while the state is inside */
    /* least distance of the reference from an end of its interval, divided by the interval's width */
    double nearest;
} beside;

typedef struct seeing {
    beside *beside;
    int states;
} seeing;

static void see(void *context, uint64_t step, const enclosure *exact, const double *run) {
    (void)run;
    const seeing *s = context;
    beside *b = s->beside;
    if (step > 0) {
        quad_follow(b->slopes, b->of, s->states, b->step_s, b->state);
        b->records++;
    }
    TEST_ASSERT_EQUAL_UINT64(b->records, step);
    for (int i = 0; i < s->states && b->outside == 0; i++) {
        const quad x = b->state[i];
        const double wide = exact[i].high - exact[i].low;
        if (!((quad)exact[i].low <= x && x <= (quad)exact[i].high)) {
            b->outside = step > 0 ? step : 1;
            return;
        }
        b->widest = fmax(b->widest, wide);
        if (wide > 0.0) {
            const double below = (double)((x - (quad)exact[i].low) / (quad)wide);
            b->nearest = fmin(b->nearest, fmin(below, 1.0 - below));
        }
    }
}

/* Runs scene `name` of the text with this engine, and compares its tube with the reference. */
static containment_found beside_hold(const char *text, const char *name, const engine_kind *kind,
                                     beside *b) {
    derived d = derived_surely(derived_scene(text, name), text);
    diags *errors = diags_new();
    exact_motion *m = exact_motion_make(d.instance, errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(m, text);
    TEST_ASSERT_TRUE(m->states <= QUAD_STATES);
    double *within = calloc((size_t)m->states, sizeof *within);
    seeing s = {b, m->states};
    b->nearest = 1.0;
    const containment_request request = {.motion = m,
                                         .image = d.image,
                                         .kind = kind,
                                         .tolerance = CONTAINMENT_TOLERANCE,
                                         .within = within,
                                         .see = see,
                                         .context = &s};
    containment_found h = containment_run(&request);
    free(within);
    exact_motion_free(m);
    diags_free(errors);
    derived_free(&d);
    return h;
}

static quad hundredths(dice *d, int least, int most, char text[16]) {
    const int number = least + (int)dice_one_of(d, (unsigned)(most - least));
    const int size = abs(number);
    snprintf(text, 16, "%s%d.%02d", number < 0 ? "-" : "", size / 100, size % 100);
    return (quad)number / 100;
}

typedef struct drawn_arms {
    quad_arms arms;
    quad start[QUAD_STATES];
    char text[6000];
    size_t length;
} drawn_arms;

#define SAY(...) \
    (d->length += (size_t)snprintf(d->text + d->length, sizeof d->text - d->length, __VA_ARGS__))

/* Draws a body at the end of a chain of arms: its speeds and height, as text and as numbers. */
static void draw_body(drawn_arms *d, dice *die, int b) {
    const int angles = d->arms.coordinates - (d->arms.carriage >= 0 ? 1 : 0);
    quad_body *body = &d->arms.body[b];
    char number[16];
    char length[QUAD_ARMS][16];
    *body = (quad_body){.arms = 1 + (int)dice_one_of(die, QUAD_ARMS)};
    body->mass_kg = hundredths(die, 30, 300, number);
    SAY("parameter m%d = %s [kg]\n", b, number);
    for (int a = 0; a < body->arms; a++) {
        quad_arm *arm = &body->arm[a];
        *arm = (quad_arm){hundredths(die, 10, 90, length[a]), 1 + (int)dice_one_of(die, 2),
                          a == 0 ? b % angles : (int)dice_one_of(die, (unsigned)angles)};
        SAY("parameter l%d%d = %s [m]\n", b, a, length[a]);
    }
    const char *carried = d->arms.carriage >= 0 ? "X'" : "0 [m/s]";
    SAY("let vx%d = %s", b, carried);
    for (int a = 0; a < body->arms; a++) {
        const quad_arm *arm = &body->arm[a];
        SAY(" - l%d%d*%d*q%d'*sin(%d*q%d)", b, a, arm->multiple, arm->coordinate, arm->multiple,
            arm->coordinate);
    }
    SAY("\nlet vy%d = 0 [m/s]", b);
    for (int a = 0; a < body->arms; a++) {
        const quad_arm *arm = &body->arm[a];
        SAY(" + l%d%d*%d*q%d'*cos(%d*q%d)", b, a, arm->multiple, arm->coordinate, arm->multiple,
            arm->coordinate);
    }
    SAY("\nlet k%d = m%d*(vx%d^2 + vy%d^2)/2\nlet p%d = -m%d*g*(%s", b, b, b, b, b, b,
        d->arms.carriage >= 0 ? "X" : "0 [m]");
    for (int a = 0; a < body->arms; a++) {
        const quad_arm *arm = &body->arm[a];
        SAY(" + l%d%d*cos(%d*q%d)", b, a, arm->multiple, arm->coordinate);
    }
    SAY(")\n");
}

static void draw_scene(drawn_arms *d, dice *die) {
    char number[16];
    SAY("scene drawn { start ");
    for (int i = 0; i < d->arms.coordinates; i++) {
        const bool carriage = i == d->arms.carriage;
        d->start[2 * i] = hundredths(die, -300, 300, number);
        SAY("%s%s%d = %s [%s]", i > 0 ? ", " : "", carriage ? "X" : "q", i, number,
            carriage ? "m" : "rad");
        d->start[2 * i + 1] = hundredths(die, -400, 400, number);
        SAY(", %s%d' = %s [%s/s]", carriage ? "X" : "q", i, number, carriage ? "m" : "rad");
    }
    SAY("; step 2 [ms]; until %g [s] }\n", few_or_all(0, 1) == 1 ? 0.6 : 0.12);
}

/* Draws two or three coordinates, of which the last may be a carriage. */
static void draw_arms(drawn_arms *d, dice *die) {
    char number[16];
    const int angles = 1 + (int)dice_one_of(die, 2);
    *d = (drawn_arms){.arms = {.carriage = -1, .bodies = 2 + (int)dice_one_of(die, 2)}};
    d->arms.coordinates = angles + (angles == 1 ? 1 : (int)dice_one_of(die, 2));
    d->arms.carriage = d->arms.coordinates > angles ? angles : -1;
    SAY("mechanism arms \"masses on arms\"\n");
    for (int i = 0; i < angles; i++) {
        SAY("coordinate q%d [rad]\n", i);
    }
    if (d->arms.carriage >= 0) {
        SAY("coordinate X [m]\n");
    }
    d->arms.gravity_mps2 = hundredths(die, 200, 1000, number);
    SAY("parameter g = %s [m/s^2]\n", number);
    for (int i = 0; i < angles; i++) {
        d->arms.spin_kgm2[i] = hundredths(die, 5, 60, number);
        SAY("parameter J%d = %s [kg*m^2]\nlet s%d = J%d*q%d'^2/2\n", i, number, i, i, i);
        d->arms.load[i] = hundredths(die, -300, 300, number);
        SAY("Q(q%d) = %s [N*m]\n", i, number);
    }
    for (int b = 0; b < d->arms.bodies; b++) {
        draw_body(d, die, b);
    }
    SAY("T = s0%s + k0 + k1%s\nV = p0 + p1%s\n", angles > 1 ? " + s1" : "",
        d->arms.bodies > 2 ? " + k2" : "", d->arms.bodies > 2 ? " + p2" : "");
    draw_scene(d, die);
    TEST_ASSERT_TRUE(d->length < sizeof d->text);
}

static void name_carriage(drawn_arms *d) {
    for (char *at = d->text; (at = strstr(at, "X")) != NULL; at++) {
        if (at[1] == '0' + d->arms.carriage) {
            memmove(at + 1, at + 2, strlen(at + 2) + 1);
        }
    }
}

static beside hold_arms(const drawn_arms *d, const char *text, unsigned which, double part,
                        containment_end *end) {
    quad_arms of = d->arms;
    quad *const coefficient[] = {&of.gravity_mps2, &of.body[0].arm[0].length_m,
                                 &of.body[1].arm[0].length_m, &of.spin_kgm2[0],
                                 &of.body[1].mass_kg};
    *coefficient[which % (sizeof coefficient / sizeof coefficient[0])] *= 1 + (quad)part;
    beside b = {.slopes = quad_arms_slopes, .of = &of, .step_s = (quad)1 / 500};
    memcpy(b.state, d->start, sizeof b.state);
    containment_found h = beside_hold(text, "drawn", &engine_double, &b);
    *end = h.end;
    TEST_ASSERT_TRUE_MESSAGE(h.end != CONTAINMENT_AT_END || b.records == h.run_steps, text);
    containment_free(&h);
    return b;
}

TEST(prove_drawn, drawn_arms) {
#ifdef QUAD_KNOWN
    static drawn_arms d;
    dice die = dice_of("prove_drawn", 23);
    const unsigned cases = dice_cases(few_or_all(usual_or(6, 2), 40));
    unsigned to_the_end = 0;
    unsigned little_out = 0;
    double widest = 0.0;
    double nearest = 1.0;
    for (unsigned k = 0; k < cases; k++) {
        containment_end end;
        draw_arms(&d, &die);
        name_carriage(&d);
        const beside b = hold_arms(&d, d.text, 0, 0.0, &end);
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, b.outside, d.text);
        to_the_end += end == CONTAINMENT_AT_END ? 1 : 0;
        widest = fmax(widest, b.widest);
        nearest = fmin(nearest, b.nearest);
        /* a short scene is enough: a wrong coefficient shows soon or never */
        char *until = strstr(d.text, "until ");
        snprintf(until, sizeof d.text - (size_t)(until - d.text), "until 0.03 [s] }\n");
        const double sign = k % 2 == 0 ? 1.0 : -1.0;
        const beside off = hold_arms(&d, d.text, k, sign * 1e-6, &end);
        TEST_ASSERT_TRUE_MESSAGE(off.outside > 0, d.text);
        const beside little = hold_arms(&d, d.text, k, sign * 1e-12, &end);
        little_out += little.outside > 0 ? 1 : 0;
    }
    printf(
        "  %u drawn mechanisms of arms, %u to the end, widest %.2e, nearest to an end %.2g of the "
        "width; off by 1e-12: %u outside\n",
        cases, to_the_end, widest, nearest, little_out);
    TEST_ASSERT_TRUE(10 * to_the_end >= 9 * cases && 2 * little_out >= cases);
    TEST_ASSERT_TRUE(widest > 1e-15 && widest < 1e-9);
#else
    TEST_IGNORE_MESSAGE("no numbers of 113 bits here");
#endif
}

/* Slopes of a linkage, from its energies in long double. Its parameters are doubles, so the tube has only round-off. */
static void linkage_slopes(const void *of, const quad *state, quad *to) {
    const linkage *l = of;
    long double q[LINKAGE_BODIES];
    long double rate[LINKAGE_BODIES];
    long double accel[LINKAGE_BODIES];
    linkage_numbers at;
    for (int i = 0; i < l->bodies; i++) {
        q[i] = (long double)state[2 * i];
        rate[i] = (long double)state[2 * i + 1];
    }
    linkage_evaluate(l, q, rate, &at);
    linkage_solve(l, &at, at.force, accel);
    for (int i = 0; i < l->bodies; i++) {
        to[2 * i] = state[2 * i + 1];
        to[2 * i + 1] = (quad)accel[i];
    }
}

TEST(prove_drawn, drawn_linkages) {
    if (LDBL_MANT_DIG < 64) {
        TEST_IGNORE_MESSAGE("no long double of more bits here");
    }
    static char text[LINKAGE_TEXT];
    dice die = dice_of("prove", 15);
    const unsigned long long first = die.state;
    double widest = 0.0;
    unsigned to_the_end = 0;
    const bool all = few_or_all(0, 1) == 1;
    const double until_s = all ? 0.5 : 0.05; /* 500 steps if all cases are tested */
    const unsigned cases = dice_cases(few_or_all(usual_or(1, 1), 8));
    for (unsigned k = 0; k < cases; k++) {
        uint64_t seed = first + 1000003U * k;
        const linkage of = linkage_draw(&seed);
        linkage_write(&of, "linkage", (linkage_writing){LINKAGE_INSIDE, .until_s = until_s}, text);
        beside b = {.slopes = linkage_slopes, .of = &of, .step_s = (quad)1 / (all ? 1000 : 10000)};
        for (int i = 0; i < of.bodies; i++) {
            b.state[2 * i] = (quad)of.start[i];
            b.state[2 * i + 1] = (quad)of.start_rate[i];
        }
        containment_found h = beside_hold(text, "linkage_moves", &engine_float, &b);
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, b.outside, text);
        to_the_end += h.end == CONTAINMENT_AT_END && b.records == h.run_steps ? 1 : 0;
        widest = fmax(widest, b.widest);
        containment_free(&h);
    }
    printf("  %u drawn linkages, %u to the end, widest %.2e\n", cases, to_the_end, widest);
    TEST_ASSERT_TRUE(10 * to_the_end >= 9 * cases);
}
