/* test_tape_gauge.c: lists with compensated sums are scaled so that float represents their constants. Results in
 * double must stay the same, the number of operations must stay within its limit, and the bias from rounded
 * constants must fall. Generated mechanisms are tested with other states than those of the search, and with another
 * evaluator. */
#include "host/image/op_list_scaling.h"
#include "host/image/program.h"

#include "command.h"
#include "derived.h"
#include "mechanism.h"

enum { TEXT = 2000, STATES = 30 };

static double decimal(uint64_t *seed) {
    const double digits = floor(random_between(seed, 10.0, 999.0));
    return digits / (random_bits(seed) % 2 == 0 ? 100.0 : 1000.0);
}

/* Writes a scene of kind `kind`: an epicyclic gear on a carriage, a driven pendulum on a carriage, a pendulum of two
 * links, or a single pendulum on a carriage. */
static void write_decimal(unsigned kind, uint64_t *seed, char text[TEXT]) {
    static const char *const bodies[] = {
        "coordinate a [rad]\ncoordinate X [m]\ninput M = 2 [N*m]\n"
        "T = m1*X'^2/2 + m2*((X' - 2*r*a'*sin(a))^2 + (2*r*a'*cos(a))^2)/2 + m2*r^2*a'^2\n"
        "Q(a) = M\n",
        "coordinate a [rad]\ncoordinate X [m]\ninput M = 1 [N*m]\n"
        "T = m1*X'^2/2 + m2*((X' + r*a'*cos(a))^2 + (r*a'*sin(a))^2)/2\n"
        "V = -m2*9.81*r*cos(a)*1 [m/s^2]\nQ(a) = M\n",
        "coordinate a [rad]\ncoordinate b [rad]\ninput M = 1 [N*m]\n"
        "T = m1*r^2*a'^2/2 + m2*((r*a'*cos(a) + l*b'*cos(b))^2 + (r*a'*sin(a) + l*b'*sin(b))^2)/2\n"
        "V = -9.81*((m1 + m2)*r*cos(a) + m2*l*cos(b))*1 [m/s^2]\nQ(a) = M\n",
        "coordinate a [rad]\ncoordinate b [rad]\ncoordinate X [m]\ninput M = 1 [N*m]\n"
        "T = m1*X'^2/2 + m2*((X' + r*a'*cos(a))^2 + (r*a'*sin(a))^2)/2"
        " + m3*((X' + r*a'*cos(a) + l*b'*cos(b))^2 + (r*a'*sin(a) + l*b'*sin(b))^2)/2\n"
        "Q(a) = M\n"};
    const double m1 = decimal(seed);
    const double m2 = decimal(seed);
    const double m3 = decimal(seed);
    const double r = decimal(seed);
    const double l = decimal(seed);
    snprintf(text, TEXT,
             "mechanism drawn\nparameter m1 = %g [kg]\nparameter m2 = %g [kg]\n"
             "parameter m3 = %g [kg]\nparameter r = %g [m]\nparameter l = %g [m]\n%s",
             m1, m2, m3, r, l, bodies[kind % (sizeof bodies / sizeof bodies[0])]);
}

static program *before_gauge(const derived *d, const char *scene_name) {
    const bool *conserve = NULL;
    for (int i = 0; i < d->model->scene_count && scene_name != NULL; i++) {
        if (strcmp(d->model->scenes[i]->name, scene_name) == 0) {
            conserve = d->model->scenes[i]->conserve;
        }
    }
    diags *errors = diags_new();
    program *p =
        program_make(d->equations, conserve, &(image_settings){.compensated = true}, errors);
    diags_free(errors);
    return p;
}

static image *compensated_image(const derived *d) {
    image_settings settings = plainly;
    settings.compensated = true;
    diags *errors = diags_new();
    image *im = image_make(d->equations, NULL, &settings, IMAGE_TO_WRITE, errors);
    diags_free(errors);
    return im;
}

/* Rounds the list's constants to float in place. kept[t->count]: the original constants. */
static void round_constants(op_list *t, double *kept) {
    for (int i = 0; i < t->count; i++) {
        kept[i] = t->ops[i].value;
        if (t->ops[i].code == OP_CONSTANT) {
            t->ops[i].value = (double)(float)t->ops[i].value;
        }
    }
}

static void put_back(op_list *t, const double *kept) {
    for (int i = 0; i < t->count; i++) {
        t->ops[i].value = kept[i];
    }
}

enum { RESULTS = 64, OPERATIONS = 4000 };

/* The bias of angular accelerations by rounded constants: the mean error over many states divided by the mean size,
 * averaged over the accelerations. */
static double bias_of(op_list *t, const op_list *like, const derived *d, uint64_t seed) {
    double kept[OPERATIONS];
    double meant[RESULTS];
    double now[RESULTS];
    double off[RESULTS] = {0};
    double size[RESULTS] = {0};
    double sum = 0.0;
    const int results = d->image->angles > 0 ? d->image->angles : t->results;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, d, &seed);
        derived_run(like, d, &s, meant);
        round_constants(t, kept);
        derived_run(t, d, &s, now);
        put_back(t, kept);
        for (int i = 0; i < results; i++) {
            const bool told = isfinite(meant[i]) && isfinite(now[i]);
            off[i] += told ? fabs(now[i] - meant[i]) : 0.0;
            size[i] += told ? fabs(meant[i]) : 0.0;
        }
    }
    for (int i = 0; i < results; i++) {
        sum += size[i] > 0.0 ? off[i] / size[i] / results : 0.0;
    }
    return sum;
}

/* Expects equal results up to round-off in double. Each constant may change by a relative 1e-15, which is nine units
 * in the last place. */
static void expect_equal(const op_list *t, const op_list *other, const derived *d, uint64_t seed,
                         const char *what) {
    double x[RESULTS];
    double y[RESULTS];
    double off_x[RESULTS];
    double off_y[RESULTS];
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, d, &seed);
        derived_run_known(t, d, &s, x, off_x);
        derived_run_known(other, d, &s, y, off_y);
        for (int i = 0; i < t->results; i++) {
            if (isfinite(x[i]) && isfinite(off_x[i]) && isfinite(off_y[i])) {
                const double bound = 0x1p-53 * (10.0 * (off_x[i] + off_y[i]) + 10.0 * fabs(x[i]));
                TEST_ASSERT_TRUE_MESSAGE(fabs(x[i] - y[i]) <= bound, what);
            } else {
                TEST_ASSERT_TRUE_MESSAGE(isfinite(x[i]) == isfinite(y[i]), what);
            }
        }
    }
}

typedef struct tally {
    int lists;
    int changed;
    int worse;     /* number of lists whose bias has grown */
    int more;      /* number of added operations */
    double before; /* sums of the biases of changed lists */
    double after;
} tally;

static bool hold(const char *text, uint64_t seed, tally *all) {
    derived d = derived_text(text);
    const bool derives = d.image != NULL && d.image->list[IMAGE_STEP]->count <= OPERATIONS;
    if (derives) {
        image *im = compensated_image(&d);
        program *p = before_gauge(&d, NULL);
        op_list *plain = p->draft.made->list[IMAGE_STEP];
        op_list *gauged = im->list[IMAGE_STEP];
        const int more = op_list_operations(gauged) - op_list_operations(plain);
        const bool changed = op_list_hash(gauged) != op_list_hash(plain);
        TEST_ASSERT_TRUE_MESSAGE(more <= op_list_scaling_price(plain), text);
        expect_equal(plain, gauged, &d, seed, text);
        all->lists++;
        if (changed) {
            const double before = bias_of(plain, plain, &d, seed);
            const double after = bias_of(gauged, plain, &d, seed);
            all->changed++;
            all->more += more;
            all->before += before;
            all->after += after;
            all->worse += after > before + 1e-15;
        }
        image_free(im);
        image_free(p->draft.made);
    }
    derived_free(&d);
    return derives;
}

static void tell(const char *what, const tally *all) {
    printf("  %s: %d lists, %d changed, %d worse, %d operations more; bias: %.3g, was %.3g\n", what,
           all->lists, all->changed, all->worse, all->more, all->after / all->changed,
           all->before / all->changed);
}

TEST(tape_gauge, decimal_mechanisms_lose_their_bias) {
    const int each = (int)few_or_all(4, 30);
    uint64_t seed = 20061;
    for (unsigned kind = 0; kind < 4; kind++) {
        tally all = {0};
        char what[20];
        for (int k = 0; k < each; k++) {
            char text[TEXT];
            write_decimal(kind, &seed, text);
            TEST_ASSERT_TRUE_MESSAGE(hold(text, seed + 1, &all), text);
        }
        snprintf(what, sizeof what, "kind %u", kind);
        tell(what, &all);
        TEST_ASSERT_TRUE(all.changed >= each / 2);
        TEST_ASSERT_EQUAL_INT(0, all.worse);
        TEST_ASSERT_TRUE(all.after <= 0.25 * all.before);
    }
}

TEST(tape_gauge, random_mechanisms_have_equal_results) {
    const unsigned cases = few_or_all(15, 120);
    tally all = {0};
    for (unsigned k = 0; k < cases; k++) {
        char text[MECHANISM_SIZE];
        mechanism_write(k, 1000U + k, text);
        hold(text, 5 * k + 1, &all);
    }
    tell("any", &all);
    TEST_ASSERT_TRUE(all.lists > (int)cases / 2 && all.changed > (int)cases / 10);
    TEST_ASSERT_TRUE(all.worse <= all.changed / 20); /* for states that the search did not use */
    TEST_ASSERT_TRUE(all.after <= 0.5 * all.before);
}

TEST(tape_gauge, scenes_need_a_price_for_scaling) {
    static const char *const names[] = {"epicyclic_from_rest", "thomson_a_conserved"};
    /* limit of the bias for each scene, relative to that before; op_list_scale() promises 0.5 */
    static const double left[] = {0.1, 0.5};
    for (int k = 0; k < 2; k++) {
        derived d = derived_builtin(names[k]);
        program *p = before_gauge(&d, names[k]);
        op_list **step = &p->draft.made->list[IMAGE_STEP];
        const uint64_t hash = op_list_hash(*step);
        const double bias = op_list_bias(*step, *step);
        op_list_scale(step, 0);
        TEST_ASSERT_TRUE_MESSAGE(op_list_hash(*step) == hash, names[k]);
        op_list_scale(step, op_list_scaling_price(*step));
        TEST_ASSERT_TRUE_MESSAGE(op_list_bias(*step, *step) < left[k] * bias, names[k]);
        image_free(p->draft.made);
        derived_free(&d);
    }
}

/* Lists without constants, with exact constants only, or with one constant whose scaling would cost a product. */
TEST(tape_gauge, lists_without_inexact_constants_stay) {
    static const double number[] = {1.0, 0.375, 0.3};
    for (int k = 0; k < 3; k++) {
        op_list *t = op_list_new(0, 1);
        const int w = op_list_leaf(t, OP_RATE, 0);
        t->result[0] = op_list_mul(t, op_list_constant(t, number[k]), op_list_mul(t, w, w));
        op_list_prune(t);
        const uint64_t hash = op_list_hash(t);
        op_list_scale(&t, number[k] == 0.3 ? 0 : 3);
        TEST_ASSERT_TRUE(op_list_hash(t) == hash);
        op_list_free(t);
    }
}
