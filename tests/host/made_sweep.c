#include "test.h"

#include "made_sweep.h"

const char made_sweep_floor[] =
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
    "stop x >= 0 [m] restitution 0.5\nscene s { step 1 [ms]; until 2 [ms] }\n";

void made_sweep_open(made_sweep *m, const char *text, const char *const *over, int axes,
                     const char *const *asked, int count, const engine_kind *kind) {
    *m = (made_sweep){.errors = diags_new()};
    m->model = model_parse("x.whirl", text, strlen(text), m->errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(m->model, text);
    const mechanism *of = m->model->mechanisms[0];
    for (int i = 0; i < axes; i++) {
        TEST_ASSERT_TRUE_MESSAGE(grid_add(&m->grid, of, over[i], m->errors), over[i]);
    }
    m->measures = measures_new(of, asked, count, m->errors);
    TEST_ASSERT_NOT_NULL(m->measures);
    m->changes.balance = true;
    m->d.instance =
        instance_make(&m->measures->mechanism, m->model->scenes[0], &m->changes, m->errors);
    TEST_ASSERT_NOT_NULL(m->d.instance);
    m->d.equations = equations_derive(m->d.instance, m->errors);
    TEST_ASSERT_NOT_NULL(m->d.equations);
    m->sweep = (sweep){.grid = &m->grid,
                       .mechanism = &m->measures->mechanism,
                       .measures = m->measures,
                       .scene = m->model->scenes[0],
                       .changes = &m->changes,
                       .kind = kind,
                       .engine = plainly};
    m->image = image_make(m->d.equations, m->d.instance->conserve, &m->sweep.engine, IMAGE_TO_RUN,
                          m->errors);
    TEST_ASSERT_NOT_NULL(m->image);
    m->sweep.shared = sweep_can_share(&m->grid, m->image) ? m->image : NULL;
}

void made_sweep_close(made_sweep *m) {
    image_free(m->image);
    equations_free(m->d.equations);
    instance_free(m->d.instance);
    measures_free(m->measures);
    grid_free(&m->grid);
    model_free(m->model);
    diags_free(m->errors);
}
