/* test_image.c: an image stands by itself. All that runs and all that is written of it comes out the same when the
 * language and the algebra that it was made of are gone: under the sanitizers, a pointer into them that was kept
 * fails here. And one that is made again from other starts is the one that a derivation from them makes. */
#define _POSIX_C_SOURCE 200809L

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/check/books_text.h"
#include "host/check/nonfinite.h"
#include "host/check/slow.h"
#include "host/check/summary.h"
#include "host/emit/description.h"
#include "host/emit/emit.h"
#include "host/engine/start.h"
#include "host/io/records.h"
#include "unity.h"

void suite_image(void);

enum { STEPS = 20 };

/* --- everything that reads an image -----------------------------------------------------------------*/

static void write_run(FILE *out, const image *im, const engine_kind *kind) {
    diags *errors = diags_new();
    if (start_has_method(im, im->settings.method, errors) && start_is_possible(im, kind, errors)) {
        void *run = kind->start(im);
        books *b = books_open(im);
        records *r = records_open(out, im, kind);
        records_header(r);
        for (int i = 0; i < STEPS; i++) {
            if (b != NULL) {
                books_enter(b, kind, run);
            }
            records_read(r, run, 0.0);
            records_write(r);
            if (kind->step(run) != WH_OK) {
                nonfinite_step(im, kind, run, WH_E_DIVERGED, errors);
                break;
            }
        }
        const energy_residual balance = energy_residual_of(b, kind, run);
        summary_print(out, im, kind, run, b, &balance);
        if (b != NULL && im->ledger.kept) {
            books_print_kept(out, im, kind, run, b);
        }
        slow_say(out, im, kind, run);
        records_close(r);
        books_close(b);
        kind->stop(run);
    }
    diags_flush(errors, out);
    diags_free(errors);
}

/* Every message about something that has no value: where nothing is a number. */
static void write_undefined(FILE *out, const image *im) {
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < im->angles; i++) {
        angle_rad[i] = (double)NAN;
    }
    for (int i = 0; i < im->reals; i++) {
        real[i] = (double)NAN;
    }
    const nonfinite_at at = {
        .image = im, .angle_rad = angle_rad, .real = real, .ahead_steps = 1.0, .when = "here"};
    diags *errors = diags_new();
    nonfinite_term(&at, errors);
    nonfinite_set(&at, errors);
    for (int k = 0; k < im->contacts; k++) {
        nonfinite_contact(&at, k, errors);
    }
    diags_flush(errors, out);
    real[0] = 1e300;
    nonfinite_angle(&at, errors);
    diags_flush(errors, out);
    diags_free(errors);
}

static char *everything(const image *im) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    emit_c(out, im, "x.whirl");
    emit_c_header(out, im, "x.whirl");
    if (im->recovered == 0) {
        emit_octave(out, im, "x.whirl", "");
    }
    describe_json(out, im, "x.whirl");
    describe_text(out, im, "x.whirl");
    write_run(out, im, &engine_double);
    write_run(out, im, &engine_float);
    write_undefined(out, im);
    fclose(out);
    return text;
}

/* --- alone --------------------------------------------------------------------------------------------*/

static void check_alone(derived *d, const char *what) {
    derived_expect(d, what);
    char *before = everything(d->image);
    equations_free(d->equations);
    instance_free(d->instance);
    model_free(d->model);
    char *after = everything(d->image);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(before, after, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(after, "is not a finite number"), what);
    free(before);
    free(after);
    image_free(d->image);
    free(d->errors);
}

static int check_scene_alone(const scene *s) {
    derived d = derived_builtin(s->name);
    check_alone(&d, s->name);
    return 1;
}

static void test_an_image_outlives_what_it_was_made_of(void) {
    TEST_ASSERT_TRUE(each_builtin_scene(check_scene_alone) > 60);
}

/* Messages with places within a line, from lets, slopes and every part of a contact. */
static const char undefined_everywhere[] =
    "mechanism m \"a\"\n"
    "    coordinate x [m] \"x\"\n"
    "    coordinate th [deg] \"angle\"\n"
    "    parameter k = 2 [N/m] \"k\"\n"
    "    input P = 1 [N] \"P\"\n"
    "    let far = sqrt(x/1 [m])*1 [m]\n"
    "    T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*th'^2/2\n"
    "    V = k*far^2/2 + k*abs(x/1 [m])^1.5*1 [m^2]\n"
    "    F = 1 [kg/s]*x'^2/2\n"
    "    Q(x) = P*log(x/1 [m])\n"
    "    output o [mm] = 1 [m]*sqrt(-x/1 [m])\n"
    "    stop x >= 1 [m]/sqrt(th) - 10 [m] restitution 0.5\n"
    "    friction th static 0.2 kinetic 0.1 normal 1 [N*m]/th\n";

static void test_a_file_of_ones_own_is_forgotten_too(void) {
    derived d = derived_text(undefined_everywhere);
    check_alone(&d, d.errors);
}

/* --- again --------------------------------------------------------------------------------------------*/

static char *as_c(const image *im) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    emit_c(out, im, "x.whirl");
    describe_json(out, im, "x.whirl");
    fclose(out);
    return text;
}

static int check_again(const scene *s) {
    char start[100];
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    const mechanism *m = d.instance->mechanism;
    snprintf(start, sizeof start, "%s=0.125", m->coordinates[0]->name);
    const char *starts[] = {start};
    const overrides changes = {
        .starts = starts, .start_count = 1, .step = "0.7ms", .until = "1.9s"};
    diags *errors = diags_new();
    instance *other = instance_make(m, d.instance->scene, &changes, errors);
    diags_flush(errors, stdout);
    TEST_ASSERT_NOT_NULL_MESSAGE(other, s->name);
    for (int i = 0; i < m->input_count; i++) {
        other->input[i] += 0.5;
    }
    int compared = 0;
    if (d.image->recovered == 0) { /* else the lists hold the momentum of the start */
        equations *e = equations_derive(other, errors);
        image *fresh = image_make(e, other->conserve, &plainly, IMAGE_TO_RUN, errors);
        image *again = image_again(d.image, other, errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(fresh, s->name);
        char *wanted = as_c(fresh);
        char *got = as_c(again);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(wanted, got, s->name);
        free(wanted);
        free(got);
        image_free(again);
        image_free(fresh);
        equations_free(e);
        compared = 1;
    }
    instance_free(other);
    diags_free(errors);
    derived_free(&d);
    return compared;
}

static void test_other_starts_need_no_derivation(void) {
    TEST_ASSERT_TRUE(each_builtin_scene(check_again) > 50);
}

void suite_image(void) {
    RUN_TEST(test_an_image_outlives_what_it_was_made_of);
    RUN_TEST(test_a_file_of_ones_own_is_forgotten_too);
    RUN_TEST(test_other_starts_need_no_derivation);
}
