/* test_ledger_scenes.c: the books of energy and momentum on the built-in scenes: they close, they say who
 * gave what, and they leave the run as it is. */
#include "derived.h"
#include "motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/derive/ledger_lists.h"

#include "unity.h"

void suite_ledger_scenes(void);

enum { ENTRIES_MAX = 400 };

typedef struct account_book {
    double smooth; /* of the energies, inputs and dampers */
    double contact[16];
    double left_over; /* numerical drift */
} account_book;

/* The account of the energy (name NULL) or of a coordinate's momentum. */
static account_book book_of(const motion *m, const char *name) {
    const image *p = m->image;
    const image_ledger *l = &p->ledger;
    static double total[ENTRIES_MAX];
    static double error[ENTRIES_MAX];
    TEST_ASSERT_TRUE(l->kept);
    TEST_ASSERT_TRUE(l->entries <= ENTRIES_MAX);
    int account = 0;
    while (name != NULL &&
           (account == 0 ||
            strcmp(m->equations->unknowns[l->unknown[account]].symbol->name, name) != 0)) {
        account++;
        TEST_ASSERT_TRUE_MESSAGE(account < l->accounts, name);
    }
    m->kind->ledger(m->run, total, error);
    account_book book = {.left_over = error[account]};
    for (int i = 0; i < l->smooth; i++) {
        book.smooth += l->entry[i].account == account ? total[i] : 0.0;
    }
    for (int k = 0; k < p->contacts; k++) {
        book.contact[k] = total[l->smooth + k * (1 + p->coordinates) + account];
    }
    return book;
}

static const stepping booked = {.kind = &engine_double, .method = WH_RK4, .ledger = true};

static account_book run_to_end(motion *m, const char *scene_name, const char *account) {
    motion_open(m, scene_name, booked);
    motion_to(m, m->instance->until_s);
    return book_of(m, account);
}

/* --- smooth scenes ----------------------------------------------------------------------------- */

/* The gear's torque M = 2 N m is constant, so its work is M theta exactly, and all of it is motion; the
 * momentum of X gets nothing from anybody. */
static void test_the_gears_torque_gives_what_theta_says(void) {
    motion m;
    motion_open(&m, "epicyclic_from_rest", booked);
    motion_to(&m, 5.0);
    const account_book energy = book_of(&m, NULL);
    const account_book momentum = book_of(&m, "X");
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 2.0 * motion_value(&m, "theta"), energy.smooth);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.0, energy.left_over);
    TEST_ASSERT_TRUE(momentum.smooth == 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, momentum.left_over);
    motion_close(&m);
}

/* What the books leave is the method's error: of fourth order. */
static void test_what_is_left_over_falls_at_fourth_order(void) {
    double left[3];
    for (int k = 0; k < 3; k++) {
        motion m;
        stepping how = booked;
        how.step_s = 2e-3 / (1 << k);
        motion_open(&m, "thomson_a", how);
        motion_to(&m, 4.0);
        left[k] = fabs(book_of(&m, NULL).left_over);
        motion_close(&m);
    }
    for (int k = 0; k < 2; k++) {
        const double order = log2(left[k] / left[k + 1]);
        char line[100];
        snprintf(line, sizeof line, "left over %.3e, %.3e J: order %.2f", left[k], left[k + 1],
                 order);
        puts(line);
        TEST_ASSERT_TRUE_MESSAGE(order > 3.7 && order < 4.5, line);
    }
}

/* --- scenes with contacts ------------------------------------------------------------------------ */

/* The carriage's net momentum is what the stop and the friction gave it, and nothing else has an entry:
 * within 1e-9 N s, over 60 s of impacts, slips and sticks. */
static void test_the_carriages_momentum_is_from_stop_and_friction(void) {
    motion m;
    motion_open(&m, "carriage_stop", booked);
    const double before = motion_value(&m, "momentum");
    motion_to(&m, m.instance->until_s);
    const account_book book = book_of(&m, "X");
    const double net = motion_value(&m, "momentum") - before;
    TEST_ASSERT_TRUE(book.smooth == 0.0);
    TEST_ASSERT_TRUE(book.contact[0] > 0.1);  /* the stop pushes away from itself */
    TEST_ASSERT_TRUE(book.contact[1] < -0.1); /* friction ends the walk */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, net, book.contact[0] + book.contact[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, book.left_over);
    motion_close(&m);
}

/* Halvorson's vehicle: the ground gave all of its momentum; without friction there is no entry, and what
 * momentum there is lies within the drift that the book tells. */
static void test_the_vehicles_momentum_is_from_the_ground(void) {
    motion m;
    account_book book = run_to_end(&m, "halvorson_ground", "X");
    TEST_ASSERT_TRUE(book.smooth == 0.0);
    TEST_ASSERT_TRUE(fabs(book.contact[0]) > 1e-3);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, motion_value(&m, "momentum"), book.contact[0]);
    motion_close(&m);

    book = run_to_end(&m, "halvorson_smooth", "X");
    TEST_ASSERT_TRUE(book.smooth == 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, book.left_over);
    TEST_ASSERT_TRUE(fabs(motion_value(&m, "momentum")) <= fabs(book.left_over) + 1e-15);
    motion_close(&m);
}

/* The magnets act between disc and frame: they take energy, but give the carriage no momentum. */
static void test_the_magnets_give_the_carriage_nothing(void) {
    motion m;
    const account_book energy = run_to_end(&m, "thomson_magnet", NULL);
    const account_book carriage = book_of(&m, "X");
    TEST_ASSERT_TRUE(energy.contact[0] < -1.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, energy.left_over);
    TEST_ASSERT_TRUE(carriage.contact[0] == 0.0 && carriage.smooth == 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.0, carriage.left_over);
    motion_close(&m);
}

/* --- all scenes ---------------------------------------------------------------------------------- */

static bool has_energies(const scene *of) { return !of->mechanism->is_system; }

static int check_bits_with_books(const scene *s) {
    static const engine_kind *const kinds[] = {&engine_float, &engine_double};
    if (!has_energies(s)) {
        return 0;
    }
    for (int k = 0; k < 2; k++) {
        uint64_t hash[2];
        for (int with = 0; with < 2; with++) {
            motion m;
            motion_open(&m, s->name,
                        (stepping){.kind = kinds[k], .method = WH_RK4, .ledger = with});
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 400));
            hash[with] = m.kind->hash(m.run);
            motion_close(&m);
        }
        TEST_ASSERT_TRUE_MESSAGE(hash[0] == hash[1], s->name);
    }
    return 1;
}

/* With books, every scene runs to the same bits, in float and in double. */
static void test_books_leave_every_scene_as_it_is(void) {
    TEST_ASSERT_TRUE(each_builtin_scene(check_bits_with_books) > 40);
}

/* A system given by equations has no energies: it is refused, not booked as zero. */
static void test_systems_have_no_books(void) {
    static const char text[] = "mechanism decay\nstate x\nparameter k = 1 [1/s]\n"
                               "equation x' = -k*x\nscene d {\n  with ledger\n  start x = 1\n}\n";
    diags *errors = diags_new();
    whirl_model *all = model_parse("t", text, strlen(text), errors);
    TEST_ASSERT_NOT_NULL(all);
    instance *inst = instance_make(all->mechanisms[0], all->scenes[0], NULL, errors);
    equations *e = inst != NULL ? equations_derive(inst, errors) : NULL;
    image *p = e != NULL ? image_make(e, NULL, &plainly, IMAGE_TO_RUN, errors) : NULL;
    TEST_ASSERT_NULL(p);
    TEST_ASSERT_TRUE(diags_count(errors) == 1);
    equations_free(e);
    instance_free(inst);
    model_free(all);
    diags_free(errors);
}

void suite_ledger_scenes(void) {
    RUN_TEST(test_the_gears_torque_gives_what_theta_says);
    RUN_TEST(test_what_is_left_over_falls_at_fourth_order);
    RUN_TEST(test_the_carriages_momentum_is_from_stop_and_friction);
    RUN_TEST(test_the_vehicles_momentum_is_from_the_ground);
    RUN_TEST(test_the_magnets_give_the_carriage_nothing);
    RUN_TEST(test_books_leave_every_scene_as_it_is);
    RUN_TEST(test_systems_have_no_books);
}
