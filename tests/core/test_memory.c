/* test_memory.c: wh_scene_start() refuses memory that is too small, misaligned or absent, for scenes of every shape. A
 * refusal leaves the memory unchanged, and no step accepts the state. */
#include "core/ledger.h"
#include "core/scene.h"

#include "tests/suites.h"

#define ROOM (WH_MEMORY_BYTES(3, 40, WH_CONTACTS_LIMIT) + 2U * sizeof(uint64_t))
#define FILLED 0xa5U

static uint64_t words[(ROOM + 7U) / 8U];
static unsigned char *const room = (unsigned char *)words;
static wh_state state;

static const wh_angle no_angles[3];
static const wh_real no_reals[8];

static void fill(void) {
    unsigned char *byte = (unsigned char *)&state;
    for (size_t i = 0; i < sizeof state; i++) {
        byte[i] = FILLED;
    }
    for (size_t i = 0; i < sizeof words; i++) {
        room[i] = FILLED;
    }
}

/* True if the memory outside room[from] to room[to] still has the bytes of fill(). */
static bool is_filled(size_t from, size_t to) {
    bool all = true;
    for (size_t i = 0; i < sizeof words; i++) {
        all = all && (room[i] == FILLED || (i >= from && i < to));
    }
    return all;
}

static wh_status no_step(const wh_scene *scene, wh_state *of) {
    (void)scene;
    (void)of;
    TEST_FAIL_MESSAGE("a state that was not started was stepped");
    return WH_OK;
}

static wh_status no_steps(const wh_scene *scene, wh_state *of, uint32_t steps) {
    (void)steps;
    return no_step(scene, of);
}

/* Checks a state that was not started: every function that takes one refuses it and leaves it unchanged. */
static void must_not_run(const wh_scene *scene) {
    wh_scene with_multi_step = *scene;
    const wh_state before = state;
    with_multi_step.multi_step = no_steps;
    TEST_ASSERT_TRUE(wh_scene_step(scene, &state) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_steps(scene, &state, 2) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_steps(scene, &state, 0) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_steps(&with_multi_step, &state, 2) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_set_real(scene, &state, 0, WH_R(1.0)) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_set_angle(scene, &state, 0, WH_R(1.0)) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_move_angle(scene, &state, 0, WH_R(1.0)) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_hash(scene, &state) == 0);
    TEST_ASSERT_TRUE(wh_scene_rates(scene, &state) == NULL);
    TEST_ASSERT_TRUE(state.steps == before.steps && state.real == NULL &&
                     state.fault == before.fault);
}

static void must_refuse(const wh_scene *scene, void *memory, size_t bytes, wh_status why) {
    fill();
    TEST_ASSERT_TRUE(wh_scene_start(scene, &state, memory, bytes) == why);
    TEST_ASSERT_TRUE(is_filled(0, 0));
    if (scene != NULL) {
        must_not_run(scene);
    }
    state = (wh_state){.fault = 0}; /* zeroed, as static memory is */
    if (scene != NULL) {
        must_not_run(scene);
    }
}

/* Checks that the last byte of each part of the state is within the memory. */
static bool ends_within(const wh_scene *scene, size_t first, size_t bytes) {
    const unsigned char *end = room + first + bytes;
    const size_t carries = scene->compensated ? (size_t)scene->angles + scene->reals : 0U;
    const size_t books =
        scene->ledger == NULL ? 0U : 2U * (size_t)scene->ledger->entries + scene->ledger->accounts;
    return (const unsigned char *)(state.angle + scene->angles) <= end &&
           (const unsigned char *)(state.real + scene->reals) <= end &&
           (carries == 0 || (const unsigned char *)(state.carry + carries) <= end) &&
           (const unsigned char *)(state.input + scene->inputs) <= end &&
           (const unsigned char *)(state.held + scene->held) <= end &&
           (books == 0 || (const unsigned char *)(state.ledger + books) <= end) &&
           (scene->contacts == 0 || (const unsigned char *)(state.contacts + 1) <= end);
}

/* The compiler's alignment: the offset of a 64-bit integer after a byte in a struct. */
typedef struct behind {
    char byte;
    uint64_t word;
} behind;

static void every_place(const wh_scene *scene, size_t need) {
    for (size_t at = 0; at < 2U * sizeof(uint64_t); at++) {
        if (at % offsetof(behind, word) != 0) {
            must_refuse(scene, room + at, need, WH_E_ARGUMENT);
            continue;
        }
        fill();
        TEST_ASSERT_TRUE(wh_scene_start(scene, &state, room + at, need) == WH_OK);
        TEST_ASSERT_TRUE(is_filled(at, at + need));
        TEST_ASSERT_TRUE(ends_within(scene, at, need));
        TEST_ASSERT_TRUE(state.steps == 0 && state.fault == -1);
    }
}

static wh_scene shape(unsigned angles, unsigned reals, unsigned inputs, unsigned contacts) {
    const wh_scene scene = {.name = "shape",
                            .method = WH_RK4,
                            .angles = (uint8_t)angles,
                            .reals = (uint8_t)reals,
                            .inputs = (uint8_t)inputs,
                            .contacts = (uint8_t)contacts,
                            .start_angle = no_angles,
                            .start_real = no_reals,
                            .start_input = no_reals,
                            .advance = no_step};
    return scene;
}

/* Calls see() for scenes of all shapes: numbers of components, with and without compensation, inputs, contacts and
 * ledger. */
static void every_shape(void (*see)(const wh_scene *scene, size_t need)) {
    static const uint8_t contacts[] = {0, 1, 7, WH_CONTACTS_LIMIT};
    static const wh_ledger_form books[] = {{.entries = 1, .accounts = 1},
                                           {.entries = 4, .accounts = 3}};
    for (unsigned i = 0; i < 4U * 4U * 2U * 4U * 2U * 2U * 3U; i++) {
        unsigned k = i;
        wh_scene scene = shape(k % 4U, k / 4U % 4U * 2U, k / 16U % 2U, contacts[k / 32U % 4U]);
        k /= 128U;
        scene.held = (uint8_t)(k % 2U);
        scene.compensated = k / 2U % 2U == 1;
        scene.ledger = k / 4U == 0 ? NULL : &books[k / 4U - 1U];
        const unsigned own = (unsigned)scene.reals + scene.inputs + scene.held;
        const unsigned carries = scene.compensated ? (unsigned)scene.angles + scene.reals : 0U;
        const unsigned kept =
            scene.ledger == NULL ? 0U : 2U * scene.ledger->entries + scene.ledger->accounts;
        see(&scene, WH_MEMORY_BYTES(scene.angles, own + carries + kept, scene.contacts));
    }
}

static void the_last_byte(const wh_scene *scene, size_t need) {
    if (need > 0) {
        must_refuse(scene, room, need - 1U, WH_E_MEMORY);
        must_refuse(scene, room, 0, WH_E_MEMORY);
    }
    must_refuse(scene, NULL, need, WH_E_MEMORY);
}

TEST(memory, one_byte_too_few_is_refused) { every_shape(the_last_byte); }

TEST(memory, only_aligned_memory_is_accepted) { every_shape(every_place); }

static void the_words(const wh_scene *scene, size_t need) {
    const size_t books = scene->ledger == NULL
                             ? 0U
                             : WH_LEDGER_WORDS(scene->ledger->entries, scene->ledger->accounts);
    const size_t enough = WH_STATE_WORDS(scene->angles, scene->reals, scene->inputs) +
                          WH_CONTACT_WORDS(scene->contacts) + WH_HELD_WORDS(scene->held) + books;
    TEST_ASSERT_TRUE(enough * sizeof(uint64_t) >= need);
}

TEST(memory, macros_give_enough_words) { every_shape(the_words); }

TEST(memory, null_and_too_many_are_refused) {
    const wh_scene scene = shape(1, 2, 1, WH_CONTACTS_LIMIT);
    wh_scene many = scene;
    many.contacts = WH_CONTACTS_LIMIT + 1;
    must_refuse(&many, words, sizeof words, WH_E_ARGUMENT);
    must_refuse(NULL, words, sizeof words, WH_E_ARGUMENT);
    fill();
    TEST_ASSERT_TRUE(wh_scene_start(&scene, NULL, words, sizeof words) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_start(NULL, NULL, NULL, 0) == WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(is_filled(0, 0));
}
