#include "test.h"

#include "parsed.h"

diags *said;
whirl_model *parsed;
instance *made;

void drop(void) {
    instance_free(made);
    model_free(parsed);
    diags_free(said);
    made = NULL;
    parsed = NULL;
    said = NULL;
}

const mechanism *parse(const char *text) {
    drop();
    said = diags_new();
    parsed = model_parse("x.whirl", text, strlen(text), said);
    if (diags_count(said) > 0) {
        diags_flush(said, stdout);
    }
    TEST_ASSERT_NOT_NULL(parsed);
    return parsed->mechanisms[0];
}

void instantiate(const overrides *changes) {
    instance_free(made);
    const scene *first = parsed->scene_count > 0 ? parsed->scenes[0] : NULL;
    made = instance_make(parsed->mechanisms[0], first, changes, said);
    if (made == NULL) {
        diags_flush(said, stdout);
    }
    TEST_ASSERT_NOT_NULL(made);
}

void expect_said(const char *wanted) {
    char *report = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&report, &size);
    TEST_ASSERT_NOT_NULL(out);
    diags_flush(said, out);
    fclose(out);
    /* no hint may be empty */
    const bool found = strstr(report, wanted) != NULL && strstr(report, "hint: \n") == NULL;
    if (!found) {
        printf("wanted: %s\ngot: %s\n", wanted, report);
    }
    free(report);
    TEST_ASSERT_TRUE(found);
}

double parameter(const char *name) {
    for (int i = 0; i < made->mechanism->parameter_count; i++) {
        if (strcmp(made->mechanism->parameters[i]->name, name) == 0) {
            return made->parameter[i];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return 0.0;
}

void expect_exactly(double wanted, double got) {
    if (wanted != got) {
        printf("wanted %.17g, got %.17g\n", wanted, got);
    }
    TEST_ASSERT_TRUE(wanted == got);
}

void expect_nearly(double wanted, double got) {
    if (!(fabs(got - wanted) <= 4e-16 * fabs(wanted))) {
        printf("wanted %.17g, got %.17g\n", wanted, got);
    }
    TEST_ASSERT_TRUE(fabs(got - wanted) <= 4e-16 * fabs(wanted));
}
