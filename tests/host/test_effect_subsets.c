/* test_effect_subsets.c: `whirl effects` compared with an exhaustive search, for two carts with up to four random
 * effects. The test itself integrates every subset of the effects, from the scene's numbers, by RK4 with bisected
 * events, without code of the program. */
#include "command.h"
#include "host/study/subsets.h"

/* X(id, statement with one number p) */
#define EFFECT_ROWS(X) \
    X(SPRING, "V += %g [N/m]*x^2/2") \
    X(DRAG, "F += %g [N*s/m]*y'^2/2") \
    X(AIR, "Q(x) += -%g [kg/m]*abs(x')*x'") \
    X(COUPLING, "V += %g [N/m]*(x - y)^2/2") \
    X(HARD, "V += %g [N/m^3]*y^4/4") \
    X(STOP, "stop x <= %g [m] restitution 0.6") \
    X(FRICTION, "friction y static 0.3 kinetic 0.2 normal %g [N]") \
    X(FAR_SPRING, "V += %g [N/m]*max(y - 50 [m], 0)^2/2") \
    X(NO_DRAG, "Q(y) += -0*%g [N*s/m]*y'") \
    X(FAR_STOP, "stop y <= 50*%g [m] restitution 0.6") \
    X(NOISE, "noise place deviation %g [m] seed 3")
#define EFFECT_ID(id, text) id,
enum { EFFECT_ROWS(EFFECT_ID) KINDS };
#define EFFECT_TEXT(id, text) text,
static const char *const effect_text[KINDS] = {EFFECT_ROWS(EFFECT_TEXT)};
/* Bounds of the decimal logarithm of p, so that there are effects of all sizes. */
static const double bounds[KINDS][2] = {
    [SPRING] = {-4, 0.5}, [DRAG] = {-4, 0},    [AIR] = {-4, 0},        [COUPLING] = {-4, 0.5},
    [HARD] = {-4, 0.5},   [STOP] = {-0.5, 0},  [FRICTION] = {-4, 0.5}, [FAR_SPRING] = {0, 2},
    [NO_DRAG] = {0, 1},   [FAR_STOP] = {0, 0}, [NOISE] = {-4, -2}};

enum { MOST = 8, X = 0, VX = 1, Y = 2, VY = 3, N = 4, STEPS = 2000, CASES = 50, CASES_FEW = 10 };
#define STEP_S 1e-3

typedef struct carts {
    int kind[MOST]; /* the kinds in random sequence */
    int effects;
    double p[KINDS];
    double m[2]; /* masses, kg */
    double k[2]; /* stiffness of springs to the ground, N/m */
    double start[N];
} carts;

typedef struct state {
    double q[N];
    int slides; /* sign of y' with friction; 0: sticks, or no friction */
} state;

typedef struct world {
    const carts *of;
    bool with[KINDS];
    bool acted[KINDS];
} world;

static double pull_y(const world *w, const double *q) {
    const double *p = w->of->p;
    return -w->of->k[1] * q[Y] - (w->with[DRAG] ? p[DRAG] * q[VY] : 0.0) +
           (w->with[COUPLING] ? p[COUPLING] * (q[X] - q[Y]) : 0.0) -
           (w->with[HARD] ? p[HARD] * q[Y] * q[Y] * q[Y] : 0.0);
}

static void slope(const world *w, const double *q, int slides, double *d) {
    const double *p = w->of->p;
    const double fx = -w->of->k[0] * q[X] - (w->with[SPRING] ? p[SPRING] * q[X] : 0.0) -
                      (w->with[AIR] ? p[AIR] * fabs(q[VX]) * q[VX] : 0.0) -
                      (w->with[COUPLING] ? p[COUPLING] * (q[X] - q[Y]) : 0.0);
    const double rub = w->with[FRICTION] ? 0.2 * p[FRICTION] * slides : 0.0;
    const bool stuck = w->with[FRICTION] && slides == 0;
    d[X] = q[VX];
    d[VX] = fx / w->of->m[0];
    d[Y] = stuck ? 0.0 : q[VY];
    d[VY] = stuck ? 0.0 : (pull_y(w, q) - rub) / w->of->m[1];
}

static void go(const world *w, const double *from, int slides, double h, double *to) {
    static const double reach[4] = {0.0, 0.5, 0.5, 1.0};
    static const double weight[4] = {1.0, 2.0, 2.0, 1.0};
    double d[N] = {0};
    double sum[N] = {0};
    for (int stage = 0; stage < 4; stage++) {
        double q[N];
        for (int i = 0; i < N; i++) {
            q[i] = from[i] + h * reach[stage] * d[i];
        }
        slope(w, q, slides, d);
        for (int i = 0; i < N; i++) {
            sum[i] += weight[stage] * d[i] / 6.0;
        }
    }
    for (int i = 0; i < N; i++) {
        to[i] = from[i] + h * sum[i];
    }
}

/* The event in state q. 0: no event; 1: the stop; 2: the end of sliding; 3: the end of sticking. */
static int happened(const world *w, const double *q, int slides) {
    const double *p = w->of->p;
    if (w->with[STOP] && q[X] > p[STOP] && q[VX] > 0.0) {
        return 1;
    }
    if (w->with[FRICTION] && slides != 0 && q[VY] * slides < 0.0) {
        return 2;
    }
    return w->with[FRICTION] && slides == 0 && fabs(pull_y(w, q)) > 0.3 * p[FRICTION] ? 3 : 0;
}

/* Lets y stick if the static friction suffices, else slide in the direction of the pull. */
static void settle(const world *w, state *s) {
    const double pull = pull_y(w, s->q);
    s->q[VY] = 0.0;
    s->slides = fabs(pull) <= 0.3 * w->of->p[FRICTION] ? 0 : pull > 0.0 ? 1 : -1;
}

static void advance(world *w, state *s, double h) {
    for (int events = 0; h > 0.0 && events < 50; events++) {
        double q[N];
        double low = 0.0;
        double high = h;
        go(w, s->q, s->slides, h, q);
        const int what = happened(w, q, s->slides);
        for (int k = 0; what != 0 && k < 60; k++) {
            const double middle = 0.5 * (low + high);
            go(w, s->q, s->slides, middle, q);
            *(happened(w, q, s->slides) != 0 ? &high : &low) = middle;
        }
        go(w, s->q, s->slides, high, q);
        const int first = happened(w, q, s->slides);
        memcpy(s->q, q, sizeof q);
        h = what == 0 ? 0.0 : h - high;
        if (first == 1) {
            s->q[VX] *= -0.6;
            w->acted[STOP] = true;
        } else if (first == 2) {
            settle(w, s);
        } else if (first == 3) {
            s->slides = pull_y(w, s->q) > 0.0 ? 1 : -1;
        }
    }
}

static state begin(const world *w) {
    state s = {.slides = 0};
    memcpy(s.q, w->of->start, sizeof s.q);
    if (w->with[FRICTION] && s.q[VY] == 0.0) {
        settle(w, &s);
    } else {
        s.slides = s.q[VY] > 0.0 ? 1 : -1;
    }
    return s;
}

/* *moved: the changes of x and y without the effects in the bits of `out`. *acted: which effects act in the full
 * run. */
static void brute(const carts *c, unsigned out, double moved[2], bool *acted) {
    world full = {.of = c};
    for (int i = 0; i < c->effects; i++) {
        full.with[c->kind[i]] = true;
    }
    world less = full;
    for (int i = 0; i < c->effects; i++) {
        less.with[c->kind[i]] = (out >> (unsigned)i & 1U) == 0;
        /* these kinds always act; the stop acts if it is hit; other kinds never act */
        full.acted[c->kind[i]] =
            c->kind[i] <= HARD || c->kind[i] == FRICTION || c->kind[i] == NOISE;
    }
    state a = begin(&full);
    state b = begin(&less);
    moved[0] = moved[1] = 0.0;
    for (int step = 0; step <= STEPS; step++) {
        moved[0] = fmax(moved[0], fabs(a.q[X] - b.q[X]));
        moved[1] = fmax(moved[1], fabs(a.q[Y] - b.q[Y]));
        for (int part = 0; part < 4; part++) {
            advance(&full, &a, STEP_S / 4.0);
            advance(&less, &b, STEP_S / 4.0);
        }
    }
    for (int i = 0; i < c->effects; i++) {
        acted[i] = full.acted[c->kind[i]];
    }
}

static double drawn(dice *d, double low, double high, bool is_log) {
    const double value = dice_between(d, low, high);
    char text[32];
    snprintf(text, sizeof text, "%.3g", is_log ? pow(10.0, value) : value);
    return strtod(text, NULL);
}

static carts draw(dice *d, int effects) {
    carts c = {.effects = effects};
    for (int i = 0; i < 2; i++) {
        c.m[i] = drawn(d, 0.5, 3.0, false);
        c.k[i] = drawn(d, -1.0, 1.3, true);
        c.start[2 * i] = drawn(d, -0.3, 0.3, false);
        c.start[2 * i + 1] =
            drawn(d, 1.0, 4.0, false) * (i == 1 && dice_one_of(d, 2) == 0 ? -1.0 : 1.0);
    }
    for (int i = 0; i < effects; i++) {
        bool again = true;
        while (again) {
            c.kind[i] = (int)dice_one_of(d, KINDS);
            again = false;
            for (int k = 0; k < i; k++) {
                again = again || c.kind[k] == c.kind[i];
            }
        }
        const double *log = bounds[c.kind[i]];
        c.p[c.kind[i]] = drawn(d, log[0], log[1], true);
    }
    return c;
}

static void write_scene(const carts *c, char *text, size_t size) {
    size_t at = (size_t)snprintf(
        text, size,
        "mechanism carts\ncoordinate x [mm]\ncoordinate y [m]\n"
        "T = %g [kg]*x'^2/2 + %g [kg]*y'^2/2\nV = %g [N/m]*x^2/2 + %g [N/m]*y^2/2\n"
        "output place [m] = x\n",
        c->m[0], c->m[1], c->k[0], c->k[1]);
    for (int i = 0; i < c->effects; i++) {
        at += (size_t)snprintf(text + at, size - at, "effect e%d {\n  ", i);
        at += (size_t)snprintf(text + at, size - at, effect_text[c->kind[i]], c->p[c->kind[i]]);
        at += (size_t)snprintf(text + at, size - at, "\n}\n");
    }
    at += (size_t)snprintf(text + at, size - at, "scene s {\n  with ");
    for (int i = 0; i < c->effects; i++) {
        at += (size_t)snprintf(text + at, size - at, "%se%d", i > 0 ? ", " : "", i);
    }
    snprintf(text + at, size - at,
             "\n  start x = %g [m], x' = %g [m/s], y = %g [m], y' = %g [m/s]\n"
             "  step %g [s]\n  until %g [s]\n}\n",
             c->start[X], c->start[VX], c->start[Y], c->start[VY], STEP_S, STEP_S * STEPS);
}

/* Draws a limit just above one of the movements. The gap to the next movement is larger than round-off. */
static double limit_between(dice *d, const double (*moved)[2], int count, int which) {
    for (int tries = 0; tries < 200; tries++) {
        const double near = moved[dice_one_of(d, (unsigned)count)][which];
        const double limit =
            near > 1e-7 ? near * dice_between(d, 1.02, 1.5) : pow(10.0, dice_between(d, -7.0, 1.0));
        bool clear = true;
        for (int i = 0; i < count; i++) {
            clear = clear && (moved[i][which] < 0.99 * limit || moved[i][which] > 1.01 * limit);
        }
        if (clear) {
            return limit;
        }
    }
    return (double)INFINITY;
}

typedef struct figures {
    int scenes, sets, events, untested, left_out, ties;
    double off; /* largest difference of a movement, relative to the range */
} figures;

static whirl_model *model;
static diags *errors;

static subsets opened(const carts *c, const overrides *changes) {
    static char text[4000];
    write_scene(c, text, sizeof text);
    errors = diags_new();
    model = model_parse("x.whirl", text, strlen(text), errors);
    diags_flush(errors, stdout);
    TEST_ASSERT_NOT_NULL_MESSAGE(model, text);
    subsets s = {.of = model->mechanisms[0],
                 .in = model->scenes[0],
                 .changes = changes,
                 .board = cost_board_named("mps2-an386")};
    const bool good = subsets_open(&s, errors) && subsets_run(&s, errors);
    diags_flush(errors, stdout);
    TEST_ASSERT_TRUE_MESSAGE(good, text);
    return s;
}

static void closed(subsets *s) {
    subsets_close(s);
    model_free(model);
    diags_free(errors);
}

static int ones(uint64_t bits) { return __builtin_popcountll(bits); }

/* Does this movement meet the limits in the exhaustive search? */
static bool keeps(const subsets *s, const double moved[2]) {
    return moved[0] * 1000.0 <= s->limit[1] && moved[1] <= s->limit[2];
}

/* Number of sets of the smallest size that meets the limits. */
static int ties(const subsets *s, const double (*moved)[2], unsigned acting, unsigned count) {
    int most = 0;
    int found = 0;
    for (unsigned out = 0; out < count; out++) {
        if ((out & ~acting) == 0 && keeps(s, moved[out])) {
            found = ones(out) > most ? 1 : found + (ones(out) == most);
            most = ones(out) > most ? ones(out) : most;
        }
    }
    return found;
}

/* In every second case, draws the limits so that many sets have the smallest size. Then the price decides between
 * these sets. */
static void draw_limits(dice *d, subsets *s, const double (*moved)[2], unsigned acting,
                        unsigned count) {
    double best[2] = {0.0, 0.0};
    int most = -1;
    for (int tries = dice_one_of(d, 2) == 0 ? 1 : 40; tries > 0; tries--) {
        s->limit[1] = 1000.0 * limit_between(d, moved, (int)count, 0);
        s->limit[2] = limit_between(d, moved, (int)count, 1);
        const int found = ties(s, moved, acting, count);
        if (found > most) {
            most = found;
            best[0] = s->limit[1];
            best[1] = s->limit[2];
        }
    }
    s->limit[1] = best[0];
    s->limit[2] = best[1];
}

static const subset *check_smallest(subsets *s, const double (*moved)[2], unsigned acting,
                                    unsigned count) {
    bool greedy;
    const subset *best = subsets_smallest(s, &greedy);
    TEST_ASSERT_FALSE(greedy);
    TEST_ASSERT_EQUAL_UINT(0, best->out & ~(uint64_t)acting);
    TEST_ASSERT_TRUE(keeps(s, moved[best->out]));
    for (unsigned out = 0; out < count; out++) {
        if ((out & ~acting) == 0 && keeps(s, moved[out])) {
            TEST_ASSERT_TRUE_MESSAGE(ones(out) <= ones(best->out), "there is a smaller set");
            for (int i = 0; ones(out) == ones(best->out) && i < s->count; i++) {
                const double *a = s->list[i]->figure;
                const bool cheaper = a[SUBSET_WORST] < best->figure[SUBSET_WORST] ||
                                     (a[SUBSET_WORST] == best->figure[SUBSET_WORST] &&
                                      a[SUBSET_STEP] < best->figure[SUBSET_STEP]);
                TEST_ASSERT_FALSE_MESSAGE(s->list[i]->out == out && cheaper, "one is cheaper");
            }
        }
    }
    return best;
}

static void check_case(dice *d, figures *f) {
    const overrides none = {0};
    const carts c = draw(d, 1 + (int)dice_one_of(d, 4));
    const unsigned count = 1U << (unsigned)c.effects;
    double moved[16][2];
    bool acted[MOST];
    unsigned acting = 0;
    for (unsigned out = 0; out < count; out++) {
        brute(&c, out, moved[out], acted);
    }
    subsets s = opened(&c, &none);
    TEST_ASSERT_EQUAL_INT(c.effects, s.effects);
    for (int k = 0; k < c.effects; k++) {
        TEST_ASSERT_EQUAL_MESSAGE(acted[k], s.acted[k], effect_text[c.kind[k]]);
        acting |= acted[k] ? 1U << (unsigned)k : 0;
    }
    for (int i = 1; i < s.columns->columns; i++) {
        s.limit[i] = (double)INFINITY;
    }
    draw_limits(d, &s, moved, acting, count);
    f->ties += ties(&s, moved, acting, count) > 1;
    for (int k = 0; k < c.effects; k++) {
        TEST_ASSERT_EQUAL(keeps(&s, moved[1U << (unsigned)k]), subsets_keeps(&s, s.list[k + 1]));
    }
    f->left_out += check_smallest(&s, moved, acting, count)->out != 0;
    for (int i = 0; i < s.count; i++) {
        const subset *each = s.list[i];
        if (each->failed != NULL) {
            TEST_ASSERT_FALSE(keeps(&s, moved[each->out]));
            continue;
        }
        const double off_x =
            fabs(each->moved[1] / 1000.0 - moved[each->out][0]) / (s.range[1] / 1000.0);
        const double off_y = fabs(each->moved[2] - moved[each->out][1]) / s.range[2];
        f->off = fmax(f->off, fmax(off_x, off_y));
        TEST_ASSERT_TRUE_MESSAGE(off_x < 1e-6 && off_y < 1e-6, "another movement");
    }
    f->scenes++;
    f->sets += (int)count;
    f->events += s.image->contacts > 0;
    f->untested += acting + 1 != count;
    closed(&s);
}

TEST(effect_subsets, against_brute_force) {
    figures f = {0};
    dice d = dice_of("effect subsets", 4501);
    const unsigned cases = dice_cases(few_or_all(CASES_FEW, CASES));
    for (unsigned i = 0; i < cases; i++) {
        check_case(&d, &f);
    }
    printf(
        "  %d scenes, %d sets: movements within %.1e of the range; %d with contacts, %d with an effect that "
        "never acts, %d that leave one out, %d with several smallest sets\n",
        f.scenes, f.sets, f.off, f.events, f.untested, f.left_out, f.ties);
    TEST_ASSERT_TRUE(cases < CASES_FEW ||
                     (f.events > 0 && f.untested > 0 && f.left_out > 0 && f.ties > 0));
}

/* With seven active effects, `whirl effects` removes one after the other until no removal is allowed. */
TEST(effect_subsets, greedy) {
    const overrides none = {0};
    dice d = dice_of("greedy effects", 4502);
    for (unsigned i = 0; i < few_or_all(2, 6); i++) {
        carts c = draw(&d, 0);
        bool acted[MOST];
        double moved[2];
        for (c.effects = 0; c.effects <= HARD; c.effects++) {
            c.kind[c.effects] = c.effects;
            c.p[c.effects] = drawn(&d, 1e-4, 0.01, false);
        }
        c.kind[c.effects] = NOISE;
        c.p[c.kind[c.effects++]] = 1e-3;
        c.kind[c.effects] = FRICTION;
        c.p[c.kind[c.effects++]] = drawn(&d, 1e-4, 0.01, false);
        subsets s = opened(&c, &none);
        for (int k = 1; k < s.columns->columns; k++) {
            s.limit[k] = (double)INFINITY;
        }
        s.limit[1] = drawn(&d, 0.2, 2.0, false);
        s.limit[2] = drawn(&d, 0.2e-3, 2e-3, false);
        bool greedy;
        const subset *best = subsets_smallest(&s, &greedy);
        TEST_ASSERT_TRUE(greedy);
        brute(&c, (unsigned)best->out, moved, acted);
        TEST_ASSERT_TRUE(best->out != 0 && keeps(&s, moved));
        for (int k = 0; k < c.effects; k++) {
            const unsigned more = (unsigned)best->out | 1U << (unsigned)k;
            brute(&c, more, moved, acted);
            TEST_ASSERT_TRUE(more == best->out || !keeps(&s, moved));
        }
        closed(&s);
    }
}
