
#include "test.h"

#include "made_sweep.h"

#include <unistd.h>

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

static char folder[80];
static char path[100];

void sessions_open(void) {
    char beside[110];
    if (folder[0] == '\0') {
        snprintf(folder, sizeof folder, "/tmp/whirl-sweeps-XXXXXX");
        TEST_ASSERT_NOT_NULL(mkdtemp(folder));
        snprintf(path, sizeof path, "%s/s.csv", folder);
    }
    snprintf(beside, sizeof beside, "%s.sweep", path);
    (void)remove(path);
    (void)remove(beside);
}

void sessions_close(void) {
    sessions_open();
    TEST_ASSERT_EQUAL_INT(0, rmdir(folder));
    folder[0] = '\0';
}

static void read_rows(char *rows) {
    FILE *in = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL(in);
    rows[fread(rows, 1, SAID_SIZE - 1, in)] = '\0';
    fclose(in);
}

const char *sessions_path(void) { return path; }

void sessions_cut(size_t length) { TEST_ASSERT_EQUAL_INT(0, truncate(path, (off_t)length)); }

session_said sessions_sit(const made_sweep *m, session_settings settings) {
    session_said made;
    settings.csv = path;
    settings.fingerprint = "made\n";
    errors_catch();
    made.code = session_run(&m->sweep, &settings);
    snprintf(made.err, sizeof made.err, "%s", errors_caught());
    read_rows(made.rows);
    return made;
}
