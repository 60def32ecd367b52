/* test_contact_bound.c: random states of every built-in scene with contacts. No step may hang or evaluate the
 * accelerations more often than declared, and no stop, friction or hold may add energy.
 *
 * RANDOM_STEPS steps per scene; WHIRL_RANDOM_STEPS=N asks for N. */
#include "command.h"
#include "derived.h"
#include "host/engine/engine.h"
#include "host/engine/start.h"
#include "host/image/program.h"

enum { FEW_STEPS = 6000, RANDOM_STEPS = 20000, RUN = 20, SAMPLES = 200 };

static long random_steps(void) {
    const char *wanted = getenv("WHIRL_RANDOM_STEPS");
    const long count = wanted != NULL ? strtol(wanted, NULL, 10) : 0;
    return count > 0 ? count : (long)few_or_all(FEW_STEPS, RANDOM_STEPS);
}

/* States at equal times of the scene's own run. */
typedef struct samples {
    int count;
    double value[SAMPLES][IMAGE_COMPONENTS_MAX]; /* [sample][unknown] */
    double rate[SAMPLES][IMAGE_COMPONENTS_MAX];
    double rate_scale[IMAGE_COMPONENTS_MAX]; /* largest absolute rate in the run */
} samples;

static void take_sample(const image *p, const engine_kind *kind, const void *run, samples *s) {
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    kind->state(run, angle_rad, real);
    for (int i = 0; i < p->angles; i++) {
        s->value[s->count][p->angle[i].unknown] = angle_rad[i];
    }
    for (int i = 0; i < p->reals; i++) {
        const component c = p->real[i];
        (c.primes == 0 ? s->value : s->rate)[s->count][c.unknown] = real[i];
        if (c.primes == 1) {
            s->rate_scale[c.unknown] = fmax(s->rate_scale[c.unknown], fabs(real[i]));
        }
    }
    s->count++;
}

static void take_samples(const derived *d, const engine_kind *kind, samples *s) {
    const double until_s = fmin(d->instance->until_s, 20.0);
    const long each = (long)(until_s / d->instance->step_s) / SAMPLES + 1;
    void *run = kind->start(d->image);
    *s = (samples){0};
    for (int i = 0; i < SAMPLES; i++) {
        take_sample(d->image, kind, run, s);
        for (long k = 0; k < each; k++) {
            TEST_ASSERT_EQUAL_INT(WH_OK, kind->step(run));
        }
    }
    kind->stop(run);
}

/* Sets a random start: a state of the run with changed rates (a random factor and an offset), positions moved by a
 * few steps' motion, and any angles. */
static void throw_start(const instance *inst, const samples *s, uint64_t *seed) {
    const mechanism *m = inst->mechanism;
    const int from = (int)(random_bits(seed) % SAMPLES);
    for (int i = 0; i < m->coordinate_count; i++) {
        double *start = inst->start[i];
        start[1] = random_between(seed, -2.0, 2.0) * s->rate[from][i] +
                   random_between(seed, -0.2, 0.2) * fmax(s->rate_scale[i], 0.05);
        start[0] =
            m->coordinates[i]->is_angle
                ? random_between(seed, -6.3, 6.3)
                : s->value[from][i] + random_between(seed, -8.0, 8.0) * start[1] * inst->step_s;
    }
}

typedef struct worst {
    uint64_t evaluations;
    uint64_t declared;
    uint64_t events;
    uint64_t overruns;
    /* largest energy that a contact added in a run, beyond the energy residual */
    double gained_J;
} worst;

/* Records the largest energy that a stop, a friction or a hold has added, beyond the energy residual. The `set` of a
 * crossing may add energy and is left out. */
static void watch_books(const image *p, const engine_kind *kind, const void *run, worst *w) {
    const image_ledger *l = &p->ledger;
    double *total = calloc((size_t)(l->entries + l->accounts), sizeof *total);
    TEST_ASSERT_TRUE(total != NULL);
    kind->ledger(run, total, total + l->entries);
    for (int k = 0; k < p->forced; k++) {
        const double gained_J = total[l->smooth + k * (1 + p->coordinates)];
        w->gained_J = fmax(w->gained_J, gained_J - fabs(total[l->entries]));
    }
    free(total);
}

static worst run_randomly(const derived *d, const engine_kind *kind, long steps) {
    uint64_t seed = 20240131;
    worst w = {0};
    static samples around;
    take_samples(d, kind, &around);
    for (long done = 0; done < steps; done += RUN) {
        throw_start(d->instance, &around, &seed);
        /* a state inside a stop is put back, which changes the energy */
        diags *beyond = diags_new();
        image *thrown = image_again(d->image, d->instance, beyond);
        const bool apart = start_is_possible(thrown, kind, beyond);
        diags_free(beyond);
        void *run = kind->start(thrown);
        uint64_t before = 0;
        uint64_t overruns;
        wh_status status = WH_OK;
        for (int i = 0; i < RUN && status == WH_OK; i++) {
            /* a step is refused if the random state is too far from the possible states */
            status = kind->step(run);
            const uint64_t now = kind->evaluations(run, &w.declared);
            w.evaluations = now - before > w.evaluations ? now - before : w.evaluations;
            before = now;
        }
        w.events += kind->events(run, &overruns);
        w.overruns += overruns;
        if (apart) {
            watch_books(d->image, kind, run, &w);
        }
        kind->stop(run);
        image_free(thrown);
    }
    return w;
}

/* Checks a scene from random states with this number type, with its own effects or, if `all`, with every effect. */
static void check_scene(const scene *of, bool all, const engine_kind *kind) {
    diags *errors = diags_new();
    const char *with[EFFECTS_MAX];
    overrides changes = {.with = with};
    for (int i = 0; i < of->mechanism->effect_count && all; i++) {
        with[changes.with_count++] = of->mechanism->effects[i].name;
    }
    derived d = {.instance = instance_make(of->mechanism, of, &changes, errors)};
    TEST_ASSERT_NOT_NULL(d.instance);
    d.instance->ledger = true;
    d.equations = equations_derive(d.instance, errors);
    d.image = d.equations == NULL ? NULL
                                  : image_make(d.equations, all ? NULL : of->conserve, &plainly,
                                               IMAGE_TO_RUN, errors);
    diags_flush(errors, stdout);
    TEST_ASSERT_NOT_NULL(d.image);
    const worst w = run_randomly(&d, kind, random_steps());
    char line[300];
    snprintf(
        line, sizeof line,
        "%s%s %s: at most %llu evaluations a step, declared %llu; %llu events, %llu overruns; a "
        "contact gave at most %.1e J beyond the drift",
        of->name, all ? ", all effects," : "", kind->name, (unsigned long long)w.evaluations,
        (unsigned long long)w.declared, (unsigned long long)w.events,
        (unsigned long long)w.overruns, w.gained_J);
    puts(line);
    TEST_ASSERT_TRUE_MESSAGE(w.evaluations <= w.declared, line);
    TEST_ASSERT_TRUE_MESSAGE(w.events > 0, line);
    if (kind == &engine_double) {
        TEST_ASSERT_TRUE_MESSAGE(w.gained_J < 1e-9, line);
    }
    image_free(d.image);
    equations_free(d.equations);
    instance_free(d.instance);
    diags_free(errors);
}

static int check_if_contact(const scene *s) {
    derived d = derived_builtin(s->name);
    const bool contacts = d.image != NULL && d.image->contacts > 0;
    derived_free(&d);
    for (int k = 0; k < 4 && contacts; k++) {
        check_scene(s, k >= 2, k % 2 ? &engine_double : &engine_float);
    }
    return contacts;
}

TEST(contact_bound, no_step_exceeds_its_declared_bound) {
    TEST_ASSERT_TRUE(each_builtin_scene(check_if_contact) >= 5);
}
