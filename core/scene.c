/* scene.c: start, step, time and hash of a run. step.h has the arithmetic. */
#include "scene.h"

#include "hash.h"
#include "ledger.h"
#include "number/arithmetic.h"
#include "step/refuse.h"

#if WH_DOUBLE
#define UNIT 0x1p-52
#define FACTOR_LESS_ONE 0x1p-27
#define LEAST 0x1p-1022
#else
#define UNIT 0x1p-23f
#define FACTOR_LESS_ONE 0x1p-12f
#define LEAST 0x1p-126f
#endif
const wh_probes wh_probe = {
    .factor = WH_R(1.0) + FACTOR_LESS_ONE,
    .square = WH_R(1.0) + WH_R(2.0) * FACTOR_LESS_ONE,
    .one = WH_R(1.0),
    .quarter_unit = WH_R(0.25) * UNIT,
    .half_unit = WH_R(0.5) * UNIT * (WH_R(1.0) + UNIT),
    .least = LEAST,
    .half = WH_R(0.5),
    .two = WH_R(2.0),
    .three = WH_R(3.0),
    .five = WH_R(5.0),
    .seven = WH_R(7.0),
    .ten = WH_R(10.0),
    .minus_zero = -WH_R(0.0),
#if WH_DOUBLE
    .infinity = __builtin_inf(),
#else
    .infinity = __builtin_inff(),
#endif
};

static const wh_real probed[WH_PROBED_COUNT] = {
    [WH_PROBED_ROUNDING] = UNIT,
    [WH_PROBED_SUBNORMAL] = LEAST,
    [WH_PROBED_FIVE] = WH_R(0x1.aaaaaaaaaaaabp0),
    [WH_PROBED_SEVEN] = WH_R(0x1.2aaaaaaaaaaabp1),
    [WH_PROBED_TEN] = WH_R(0x1.aaaaaaaaaaaabp1),
    [WH_PROBED_THIRD] = WH_R(0x1.2aaaaaaaaaaabp1),
    [WH_PROBED_NAN] = WH_R(1.0),
    [WH_PROBED_LITERAL] = WH_R(70.0),
};

/* Compares bits, because a floating-point comparison here could hide the error. */
wh_probed wh_arithmetic_wrong(void (*compute)(wh_real *result)) {
    wh_real result[WH_PROBED_COUNT];
    unsigned i = 0;
    compute(result);
    while (i < WH_PROBED_COUNT && wh_real_bits(result[i]) == wh_real_bits(probed[i])) {
        i++;
    }
    return (wh_probed)i;
}

/* Checks the core's own arithmetic, and that of the scene's file, which may have been compiled with other flags. */
static wh_probed first_wrong(const wh_scene *scene) {
    void (*const compute[])(wh_real * result) = {wh_arithmetic, scene->arithmetic};
    wh_probed wrong = WH_PROBED_COUNT;
    for (unsigned i = 0; i < 2 && wrong == WH_PROBED_COUNT && compute[i] != NULL; i++) {
        wrong = wh_arithmetic_wrong(compute[i]);
    }
    return wrong;
}

static size_t carries(const wh_scene *scene) {
    return scene->compensated ? (size_t)scene->angles + scene->reals : 0U;
}

/* The first step finds the contacts' modes. */
static void start_contacts(const wh_scene *scene, wh_state *state, wh_contacts *memory) {
    state->contacts = memory;
    memory->events = 0;
    memory->overruns = 0;
    memory->logged = 0;
    for (unsigned i = 0; i < scene->contacts; i++) {
        memory->mode[i] = WH_UNSET;
    }
}

/* Returns how many reals the ledger needs. */
static size_t ledgers(const wh_scene *scene) {
    return scene->ledger == NULL ? 0U
                                 : 2U * (size_t)scene->ledger->entries + scene->ledger->accounts;
}

static size_t all_reals(const wh_scene *scene) {
    return scene->reals + carries(scene) + scene->inputs + scene->held + ledgers(scene);
}

/* True if `memory` is aligned for every object of a state. */
static bool is_aligned(const void *memory) {
    struct behind_a_byte {
        char byte;
        union {
            wh_angle angle;
            wh_real real;
            wh_contacts contacts;
        } behind;
    };
    return (uintptr_t)memory % offsetof(struct behind_a_byte, behind) == 0;
}

static bool is_possible(const wh_scene *scene, const wh_state *state, const void *memory) {
    return scene != NULL && state != NULL && scene->contacts <= WH_CONTACTS_LIMIT &&
           wh_method_takes(scene->method, scene->form) && is_aligned(memory);
}

wh_status wh_scene_start(const wh_scene *scene, wh_state *state, void *memory, size_t bytes) {
    if (state != NULL) {
        state->real = NULL; /* not started yet */
    }
    if (!is_possible(scene, state, memory)) {
        return WH_E_ARGUMENT;
    }
    const size_t numbers = all_reals(scene);
    if (memory == NULL || bytes < WH_MEMORY_BYTES(scene->angles, numbers, scene->contacts)) {
        return WH_E_MEMORY;
    }
    const wh_probed wrong = first_wrong(scene);
    if (wrong != WH_PROBED_COUNT) {
        state->fault = (int)wrong;
        return WH_E_ARITHMETIC;
    }
    wh_real *reals;
    state->angle = memory;
    reals = (wh_real *)(void *)(state->angle + scene->angles);
    state->real = reals;
    reals += scene->reals;
    state->carry = scene->compensated ? reals : NULL;
    reals += carries(scene);
    state->input = reals;
    reals += scene->inputs;
    state->held = reals;
    reals += scene->held;
    state->ledger = scene->ledger != NULL ? reals : NULL;

    for (size_t i = 0; i < numbers; i++) { /* carry, held and ledger begin at 0 */
        state->real[i] = WH_R(0.0);
    }
    for (unsigned i = 0; i < scene->angles; i++) {
        state->angle[i] = scene->start_angle[i];
    }
    for (unsigned i = 0; i < scene->reals; i++) {
        state->real[i] = scene->start_real[i];
    }
    for (unsigned i = 0; i < scene->inputs; i++) {
        state->input[i] = scene->start_input[i];
    }
    state->contacts = NULL;
    if (scene->contacts > 0) {
        const size_t at = (WH_NUMBER_BYTES(scene->angles, numbers) + 7U) / 8U * 8U;
        start_contacts(scene, state, (wh_contacts *)(void *)((unsigned char *)memory + at));
    }
    state->steps = 0;
    state->fault = -1;
    return WH_OK;
}

wh_status wh_scene_step(const wh_scene *scene, wh_state *state) {
    if (state->real == NULL) {
        return WH_E_ARGUMENT;
    }
    return scene->advance(scene, state);
}

wh_status wh_scene_steps(const wh_scene *scene, wh_state *state, uint32_t steps) {
    if (state->real == NULL) {
        return WH_E_ARGUMENT;
    }
    if (scene->multi_step != NULL && steps > 0) {
        return scene->multi_step(scene, state, steps);
    }
    wh_status status = WH_OK;
    for (; status == WH_OK && steps > 0; steps--) {
        status = wh_scene_step(scene, state);
    }
    return status;
}

/* Returns part / of, rounded to the nearest real, for 0 <= part < of < 2^63. The result may be 1. Long division: the
 * quotient has one bit more than a real, and a sticky bit stands for the lower bits. */
static wh_real rounded(uint64_t part, uint64_t of) {
    const unsigned bits = sizeof(wh_real) == sizeof(float) ? 25 : 54;
    wh_real unit = WH_R(1.0);
    uint64_t quotient = 0;
    if (part == 0) {
        return WH_R(0.0);
    }
    for (; part < of; part <<= 1) {
        unit *= WH_R(0.5);
    }
    for (unsigned i = 0; i < bits; i++) {
        quotient <<= 1;
        if (part >= of) {
            quotient |= 1U;
            part -= of;
        }
        part <<= 1;
        unit *= WH_R(0.5);
    }
    return (wh_real)(quotient << 1 | (part != 0)) * unit;
}

wh_time wh_scene_time(const wh_scene *scene, const wh_state *state) {
    const wh_fraction step = scene->step;
    wh_time time = {0, wh_scene_time_s(scene, state)};
    /* Two conversions to 32 bits, because a conversion to 64 bits needs double arithmetic on small cores. */
    if (step.denominator == 0) {
        const wh_real high = time.fraction_s * WH_R(0x1p-24);
        const uint32_t upper = high < WH_R(0x1p32) ? (uint32_t)high : UINT32_MAX;
        time.fraction_s -= (wh_real)upper * WH_R(0x1p24);
        const uint32_t lower = (uint32_t)time.fraction_s;
        time.fraction_s -= (wh_real)lower;
        time.whole_s = ((uint64_t)upper << 24) + lower;
        return time;
    }
    /* steps * numerator / denominator, bit by bit, because the product may have 128 bits. */
    const uint64_t whole = step.numerator / step.denominator;
    const uint64_t more = step.numerator % step.denominator;
    uint64_t rest = 0;
    time.whole_s = 0;
    for (unsigned bit = 64; bit-- > 0;) {
        const uint64_t one = state->steps >> bit & 1U;
        rest <<= 1;
        time.whole_s = (time.whole_s << 1) + one * whole + (rest >= step.denominator);
        rest -= rest >= step.denominator ? step.denominator : 0;
        rest += one * more;
        time.whole_s += rest >= step.denominator;
        rest -= rest >= step.denominator ? step.denominator : 0;
    }
    time.fraction_s = rounded(rest, step.denominator);
    if (time.fraction_s == WH_R(1.0)) {
        time.whole_s++;
        time.fraction_s = WH_R(0.0);
    }
    return time;
}

wh_real wh_scene_time_s(const wh_scene *scene, const wh_state *state) {
    return (wh_real)state->steps * scene->step_s;
}

uint64_t wh_scene_hash(const wh_scene *scene, const wh_state *state) {
    uint64_t hash = wh_hash_u64(WH_HASH_START, state->steps);
    if (state->real == NULL) {
        return 0;
    }
    for (unsigned i = 0; i < scene->angles; i++) {
#if WH_DOUBLE
        hash = wh_hash_real(hash, state->angle[i]);
#else
        hash = wh_hash_u64(hash, (uint64_t)state->angle[i]);
#endif
    }
    for (unsigned i = 0; i < scene->reals; i++) {
        hash = wh_hash_real(hash, state->real[i]);
    }
    for (unsigned i = 0; i < scene->held; i++) {
        hash = wh_hash_real(hash, state->held[i]);
    }
    for (unsigned i = 0; i < scene->contacts; i++) {
        hash = wh_hash_u64(hash, (uint8_t)state->contacts->mode[i]);
    }
    return hash;
}

const wh_real *wh_scene_rates(const wh_scene *scene, const wh_state *state) {
    return state->real == NULL ? NULL : state->real + (scene->reals - scene->angles) / 2;
}

/* wh_refuse_first() in a loop that is not unrolled. */
WH_COLD static wh_status refuse_first(const wh_real *value, unsigned n, unsigned first,
                                      wh_state *state) {
    unsigned at = 0;
    while (at + 1 < n && wh_believable(value[at], WH_ABSURD)) {
        at++;
    }
    return wh_refuse(state, first + at);
}

WH_COLD wh_status wh_refuse_four(wh_state *state, unsigned first, unsigned n, wh_real a, wh_real b,
                                 wh_real c, wh_real d) {
    const wh_real value[] = {a, b, c, d};
    return refuse_first(value, n, first, state);
}

WH_COLD wh_status wh_refuse_eight(wh_state *state, unsigned first, unsigned n, wh_real a, wh_real b,
                                  wh_real c, wh_real d, wh_real e, wh_real f, wh_real g,
                                  wh_real h) {
    const wh_real value[] = {a, b, c, d, e, f, g, h};
    return refuse_first(value, n, first, state);
}

#define WORDS(name, value, words) \
    case name: return words;
const char *wh_status_text(wh_status status) {
    switch (status) { WH_STATUS_ROWS(WORDS) }
    return "unknown status";
}
