/* motion.c: scenes that are stepped inside a test. */
#include "motion.h"

#include "host/derive/lagrange.h"
#include "host/lang/builtin.h"

#define OUTPUTS_MAX 64

static const scene *scene_named(const whirl_model *in, const char *name) {
    for (int i = 0; i < in->scene_count; i++) {
        if (strcmp(in->scenes[i]->name, name) == 0) {
            return in->scenes[i];
        }
    }
    return NULL;
}

static void start(motion *m, const scene *in, stepping how) {
    char step[64];
    snprintf(step, sizeof step, "%.17g", how.step_s);
    const overrides changes = {.step = how.step_s > 0.0 ? step : NULL,
                               .sets = &how.set,
                               .set_count = how.set != NULL ? 1 : 0,
                               .starts = &how.start,
                               .start_count = how.start != NULL ? 1 : 0};
    m->instance = instance_make(in->mechanism, in, &changes, m->errors);
    if (m->instance != NULL) {
        m->instance->ledger = m->instance->ledger || how.ledger || how.stabilized;
    }
    m->equations = m->instance != NULL ? equations_derive(m->instance, m->errors) : NULL;
    if (m->equations != NULL) {
        m->image = image_make(m->equations, in->conserve,
                              &(image_settings){.method = how.method,
                                                .compensated = how.compensated,
                                                .stabilized = how.stabilized,
                                                .angles = how.angles,
                                                .matrix = how.matrix},
                              IMAGE_TO_RUN, m->errors);
    }
    diags_flush(m->errors, stdout);
    TEST_ASSERT_NOT_NULL_MESSAGE(m->image, in->name);
    m->kind = how.kind;
    m->run = how.kind->start(m->image);
}

void motion_open(motion *m, const char *scene_name, stepping how) {
    for (size_t i = 0; i < builtin_model_count; i++) {
        const struct builtin_model *b = &builtin_models[i];
        *m = (motion){.errors = diags_new()};
        m->model = model_parse(b->file, b->text, b->length, m->errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(m->model, b->file);
        const scene *in = scene_named(m->model, scene_name);
        if (in != NULL) {
            start(m, in, how);
            return;
        }
        model_free(m->model);
        diags_free(m->errors);
    }
    TEST_FAIL_MESSAGE(scene_name);
}

void motion_open_text(motion *m, const char *text, stepping how) {
    *m = (motion){.errors = diags_new()};
    m->model = model_parse("test", text, strlen(text), m->errors);
    diags_flush(m->errors, stdout);
    TEST_ASSERT_NOT_NULL(m->model);
    TEST_ASSERT_TRUE(m->model->scene_count > 0);
    start(m, m->model->scenes[0], how);
}

void motion_open_more(motion *m, const char *file, const char *more, stepping how) {
    for (size_t i = 0; i < builtin_model_count; i++) {
        const struct builtin_model *b = &builtin_models[i];
        const char *slash = strrchr(b->file, '/');
        if (strcmp(slash != NULL ? slash + 1 : b->file, file) != 0) {
            continue;
        }
        const size_t size = b->length + strlen(more) + 1;
        char *text = malloc(size);
        TEST_ASSERT_NOT_NULL(text);
        snprintf(text, size, "%s%s", b->text, more);
        *m = (motion){.errors = diags_new()};
        m->model = model_parse(file, text, size - 1, m->errors);
        diags_flush(m->errors, stdout);
        TEST_ASSERT_NOT_NULL_MESSAGE(m->model, more);
        start(m, m->model->scenes[m->model->scene_count - 1], how);
        free(text);
        return;
    }
    TEST_FAIL_MESSAGE(file);
}

/* Returns the text of a file, followed by `more`. The caller frees the text. */
static char *text_of_file(const char *path, const char *more) {
    FILE *in = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, path);
    TEST_ASSERT_EQUAL_INT(0, fseek(in, 0, SEEK_END));
    const long size = ftell(in);
    TEST_ASSERT_TRUE_MESSAGE(size > 0, path);
    char *text = malloc((size_t)size + strlen(more) + 1);
    TEST_ASSERT_NOT_NULL(text);
    rewind(in);
    TEST_ASSERT_EQUAL_size_t((size_t)size, fread(text, 1, (size_t)size, in));
    fclose(in);
    memcpy(text + size, more, strlen(more) + 1);
    return text;
}

void motion_open_file(motion *m, const char *path, const char *more, const char *scene_name,
                      stepping how) {
    char *text = text_of_file(path, more);
    *m = (motion){.errors = diags_new()};
    m->model = model_parse(path, text, strlen(text), m->errors);
    free(text);
    diags_flush(m->errors, stdout);
    TEST_ASSERT_NOT_NULL_MESSAGE(m->model, more);
    const scene *in = scene_named(m->model, scene_name);
    TEST_ASSERT_NOT_NULL_MESSAGE(in, scene_name);
    start(m, in, how);
}

void motion_close(motion *m) {
    m->kind->stop(m->run);
    image_free(m->image);
    equations_free(m->equations);
    instance_free(m->instance);
    model_free(m->model);
    diags_free(m->errors);
}

wh_status motion_step(motion *m, uint64_t steps) {
    wh_status status = WH_OK;
    for (uint64_t i = 0; i < steps && status == WH_OK; i++) {
        status = m->kind->step(m->run);
    }
    return status;
}

void motion_to(motion *m, double time_s) {
    const double steps = time_s / m->instance->step_s;
    const uint64_t wanted = (uint64_t)floor(steps + 0.5);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-6 * steps, (double)wanted, steps, "not whole steps");
    TEST_ASSERT_TRUE(wanted >= m->kind->steps(m->run));
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(m, wanted - m->kind->steps(m->run)));
}

double motion_value(const motion *m, const char *name) {
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    double output[OUTPUTS_MAX];
    const image *p = m->image;
    const mechanism *of = m->instance->mechanism;
    const size_t length = strcspn(name, "'");
    const int primes = (int)strlen(name + length);
    m->kind->state(m->run, angle_rad, real);
    for (int i = 0; i < p->angles + p->reals; i++) {
        const component c = i < p->angles ? p->angle[i] : p->real[i - p->angles];
        const char *known = of->coordinates[c.unknown]->name;
        if (c.primes == primes && strlen(known) == length && strncmp(known, name, length) == 0) {
            return i < p->angles ? angle_rad[i] : real[i - p->angles];
        }
    }
    TEST_ASSERT_TRUE(p->outputs <= OUTPUTS_MAX);
    m->kind->outputs(m->run, output);
    for (int i = 0; i < of->output_count; i++) {
        if (strcmp(of->outputs[i]->name, name) == 0) {
            return output[i];
        }
    }
    /* A coordinate that is recovered from its momentum is not in the state. Its value and rate are two further
     * outputs after those of the mechanism. */
    for (int i = 0; i < p->recovered; i++) {
        const char *known = of->coordinates[p->from_momentum[i]]->name;
        if (primes < 2 && strlen(known) == length && strncmp(known, name, length) == 0) {
            return output[of->output_count + 2 * i + primes];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return (double)NAN;
}

double thomson_kinetic_J(const motion *m) {
    const double a = motion_value(m, "theta1");
    const double b = motion_value(m, "theta2");
    const double a_ = motion_value(m, "theta1'");
    const double b_ = motion_value(m, "theta2'");
    const double X_ = motion_value(m, "X'");
    const double bx = X_ - 0.6 * a_ * sin(a);
    const double by = 0.6 * a_ * cos(a);
    const double dx = X_ - 0.6 * a_ * (sin(a) + sin(2.0 * a)) - 0.3 * b_ * sin(b);
    const double dy = 0.6 * a_ * (cos(a) + cos(2.0 * a)) + 0.3 * b_ * cos(b);
    return X_ * X_ + (bx * bx + by * by) + 2.0 * 0.09 * a_ * a_ + (dx * dx + dy * dy);
}

double motion_error(const motion *m, const char *references, const char *of, const char *time) {
    char line[1024];
    char wanted[128];
    char *states = NULL;
    char *rest = NULL;
    double largest = 0.0;
    int missing = 0;
    snprintf(wanted, sizeof wanted, ":%s | %s | ", of, time);
    FILE *file = fopen(references, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, "run from the project's root");
    while (states == NULL && fgets(line, sizeof line, file) != NULL) {
        states = strstr(line, wanted);
    }
    fclose(file);
    TEST_ASSERT_NOT_NULL_MESSAGE(states, wanted);
    for (int i = 0; i < m->equations->count; i++) {
        missing += m->equations->unknowns[i].order;
    }
    for (char *word = strtok_r(states + strlen(wanted), " \n", &rest); word != NULL;
         word = strtok_r(NULL, " \n", &rest)) {
        char *equals = strchr(word, '=');
        TEST_ASSERT_NOT_NULL_MESSAGE(equals, word);
        *equals = '\0';
        const double error = fabs(motion_value(m, word) - strtod(equals + 1, NULL));
        TEST_ASSERT_TRUE_MESSAGE(isfinite(error), word);
        largest = fmax(largest, error);
        missing--;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, missing, "states are missing in the reference");
    return largest;
}
