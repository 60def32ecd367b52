/* hand.c: see hand.h. */
#include "hand.h"

#include "draw.h"

#include "unity.h"

static void hand_accel(const void *model, const wh_phase *phase, const wh_real *linear,
                       const wh_real *rate, const wh_real *input, wh_real *accel) {
    const hand *m = model;
    (void)phase;
    (void)rate;
    (void)input;
    for (unsigned i = 0; i < m->n; i++) {
        accel[i] = WH_R(0.0);
        for (unsigned j = 0; j < m->n; j++) {
            accel[i] += m->inverse[i][j] * (m->load[j] - m->spring[j] * linear[j]);
        }
    }
}

unsigned hand_looks;

static wh_real along(const hand *m, unsigned k, const wh_real *x) {
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < m->n; i++) {
        sum += m->law[k].row[i] * x[i];
    }
    return sum;
}

static void hand_signals(const void *model, const wh_phase *phase, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *result) {
    const hand *m = model;
    (void)phase;
    hand_looks++;
    for (unsigned k = 0; k < m->system.contacts; k++) {
        result[2 * k] = along(m, k, linear) - m->law[k].offset;
        result[2 * k + 1] = along(m, k, rate);
        if (m->contact[k].kind == WH_HOLD) {
            result[2 * k] = input[0];
        } else if (m->contact[k].kind == WH_FRICTION) {
            result[2 * k] = along(m, k, rate);
        }
        const wh_real size = WH_ABS(result[2 * k]);
        for (unsigned i = 0; i < m->bent && m->contact[k].kind == WH_WHEN; i++) {
            /* The factor is the square of the value in millimetres. */
            result[2 * k] *= size * size * WH_R(1e6);
        }
        for (unsigned i = 0; i < 2; i++) {
            result[2 * k + i] = (m->lost[i] >> k & 1U) != 0 ? m->nothing : result[2 * k + i];
        }
    }
}

static void hand_forces(const void *model, const wh_phase *phase, const wh_real *linear,
                        const wh_real *rate, const wh_real *input, wh_real *result) {
    const hand *m = model;
    (void)phase;
    (void)rate;
    (void)input;
    for (unsigned k = 0; k < HAND_CONTACTS;
         k++) { /* also for the invalid contacts after the last one (put_sentinels()) */
        wh_real *law = result + k * (WH_LAW_ROWS + 2 * m->n);
        law[WH_LAW_FIRST] = m->law[k].first;
        law[WH_LAW_SECOND] = m->law[k].second;
        law[WH_LAW_BIAS] = WH_R(0.0);
        if (m->contact[k].kind == WH_HOLD && m->contact[k].direction == 0 && linear != NULL &&
            m->law[k].first == WH_R(0.0)) {
            law[WH_LAW_FIRST] = along(m, k, linear); /* the value of a curved hold */
        } else if (m->contact[k].kind == WH_HOLD && m->contact[k].direction < 0 && linear != NULL) {
            law[WH_LAW_FIRST] =
                /* the gap, for a stop or hold that inputs move */
                along(m, k, linear) - m->law[k].offset;
        }
        for (unsigned i = 0; i < m->n; i++) {
            law[WH_LAW_ROWS + i] = m->law[k].row[i];
            law[WH_LAW_ROWS + m->n + i] = along(m, k, m->inverse[i]);
        }
    }
}

/* Computes the value that a crossing assigns: minus half of the first rate, or `place` for the first coordinate. */
static void hand_sets(const void *model, const wh_phase *phase, const wh_real *linear,
                      const wh_real *rate, const wh_real *input, wh_real *result) {
    const hand *m = model;
    (void)phase;
    (void)linear;
    (void)input;
    result[0] = m->places ? m->place : WH_R(-0.5) * rate[0];
}

/* Computes the powers of the ledger's entries: the forces of loads and springs on each momentum, and the work of the
 * loads. */
static void hand_powers(const void *model, const wh_phase *phase, const wh_real *linear,
                        const wh_real *rate, const wh_real *input, wh_real *result) {
    const hand *m = model;
    (void)phase;
    (void)input;
    result[0] = WH_R(0.0);
    for (unsigned i = 0; i < m->n; i++) {
        result[0] += m->weighs ? WH_R(0.0) : m->load[i] * rate[i];
        result[1 + i] = m->load[i] - m->spring[i] * linear[i];
    }
}

static void hand_levels(const void *model, const wh_angle *angle, const wh_real *linear,
                        const wh_real *rate, const wh_real *input, wh_real *level) {
    const hand *m = model;
    (void)angle;
    (void)input;
    level[0] = WH_R(0.0);
    for (unsigned i = 0; i < m->n; i++) {
        level[1 + i] = WH_R(0.0);
        for (unsigned j = 0; j < m->n; j++) {
            level[1 + i] += m->mass[i][j] * rate[j];
        }
        level[0] += WH_R(0.5) * (level[1 + i] * rate[i] + m->spring[i] * linear[i] * linear[i]);
        level[0] -= m->weighs ? m->load[i] * linear[i] : WH_R(0.0);
    }
}

/* Fills memory with numbers that are not zero, so that a missing initialization shows. */
static void soil(void *memory, unsigned size) {
    unsigned char *byte = memory;
    for (unsigned i = 0; i < size; i++) {
        byte[i] = 0xA5;
    }
}

/* wh_step_contact() without its shortcut for calm steps. */
static wh_status eventful(const wh_contact_system *of, wh_real h, wh_state *state) {
    wh_contact_work work;
    wh_contact_attempt attempt;
    wh_ledger_work books;
    soil(&work, sizeof work);
    soil(&attempt, sizeof attempt);
    soil(&books, sizeof books);
    attempt.made = false;
    wh_contact_work_begin(of, state, &work);
    if (of->ledger != NULL) {
        work.books = &books;
        wh_ledger_open(of->ledger, state, &books);
    }
    return wh_contact_eventful(of, &work, h, &attempt, state);
}

static wh_status hand_advance(const wh_scene *scene, wh_state *state) {
    const hand *m = scene->model;
    if (m->eventful) {
        return wh_step_counted(eventful(&m->system, scene->step_s, state), state);
    }
    return wh_step_counted(wh_step_contact(&m->system, scene->step_s, state), state);
}

hand hand_now;
static const uint8_t accounts[3] = {0, 1, 2};
wh_ledger_form hand_books;
static uint64_t memory[WH_STATE_WORDS(0, 8, 1) + WH_CONTACT_WORDS(3) + WH_HELD_WORDS(1) +
                       WH_LEDGER_WORDS(16, 6)];
wh_state hand_state;
wh_real hand_pushed;

void hand_build(unsigned n, wh_real m00, wh_real m01, wh_real m11) {
    const wh_real det = m00 * m11 - m01 * m01;
    hand_now = (hand){.n = n,
                      .mass = {{m00, m01}, {m01, m11}},
                      .inverse = {{m11 / det, -m01 / det}, {-m01 / det, m00 / det}}};
    if (n == 1) {
        hand_now.inverse[0][0] = WH_R(1.0) / m00;
    }
}

unsigned hand_add(wh_contact_kind kind, int pin, wh_real row0, wh_real row1, wh_real offset,
                  wh_real first, wh_real second) {
    const unsigned k = hand_now.system.contacts++;
    hand_now.system.forced = (uint8_t)(hand_now.system.forced + (kind != WH_WHEN));
    hand_now.system.kinds =
        (uint8_t)(hand_now.system.kinds | (kind != WH_WHEN ? WH_KIND_BIT(kind) : 0U));
    hand_now.system.pinned = (uint8_t)(hand_now.system.pinned + (kind != WH_WHEN && pin >= 0));
    hand_now.contact[k] = (wh_contact){(uint8_t)kind, 0, (int16_t)pin, 0, kind == WH_WHEN};
    hand_now.law[k].row[0] = row0;
    hand_now.law[k].row[1] = row1;
    hand_now.law[k].offset = offset;
    hand_now.law[k].first = first;
    hand_now.law[k].second = second;
    return k;
}

/* Puts, after a scene's contacts, a friction that would hold the first coordinate for ever if the core read it. */
static void put_sentinels(void) {
    for (unsigned k = hand_now.system.contacts; k < HAND_CONTACTS; k++) {
        hand_now.contact[k] = (wh_contact){.kind = WH_FRICTION, .pin = 0, .sets = 1};
        hand_now.law[k].row[0] = WH_R(1.0);
        hand_now.law[k].row[1] = WH_R(0.0);
        hand_now.law[k].first = WH_R(1e6);
        hand_now.law[k].second = WH_R(1e6);
    }
}

int hand_draw_row(uint64_t *seed, unsigned n, wh_real *row) {
    row[0] = draw_whole(seed, -2, 2);
    row[1] = n == 1 || draw_one_in(seed, 2) ? WH_R(0.0) : draw_whole(seed, -2, 2);
    if (row[0] == WH_R(0.0) && row[1] == WH_R(0.0)) {
        row[0] = WH_R(1.0);
    }
    return row[1] == WH_R(0.0) ? 0 : row[0] == WH_R(0.0) ? 1 : -1;
}

void hand_start(bool with_books) {
    static uint8_t target;
    put_sentinels();
    target = (uint8_t)(hand_now.places ? 0U : hand_now.n); /* component n is the first rate */
    hand_now.system.model = &hand_now;
    hand_now.system.accel = hand_accel;
    hand_now.system.signals = hand_signals;
    hand_now.system.forces = hand_forces;
    hand_now.system.sets = hand_sets;
    hand_now.system.contact = hand_now.contact;
    hand_now.system.target = &target;
    hand_now.system.method = WH_RK4;
    hand_now.system.coordinates = (uint8_t)hand_now.n;
    hand_books = (wh_ledger_form){
        .model = &hand_now,
        .powers = hand_powers,
        .levels = hand_levels,
        .account = accounts,
        .smooth = (uint16_t)(1 + hand_now.n),
        .entries = (uint16_t)(1 + hand_now.n + hand_now.system.contacts * (1 + hand_now.n)),
        .accounts = (uint8_t)(2 * (1 + hand_now.n)),
        .coordinates = (uint8_t)hand_now.n};
    hand_now.system.ledger = with_books ? &hand_books : NULL;
    hand_now.scene = (wh_scene){.name = "hand",
                                .form = WH_SECOND_ORDER,
                                .reals = (uint8_t)(2 * hand_now.n),
                                .inputs = 1,
                                .held = hand_now.system.held,
                                .compensated = hand_now.system.compensated,
                                .contacts = hand_now.system.contacts,
                                .step_s = WH_R(0.001),
                                .start_real = hand_now.start,
                                .start_input = &hand_pushed,
                                .ledger = hand_now.system.ledger,
                                .model = &hand_now,
                                .advance = hand_advance};
    TEST_ASSERT_TRUE(wh_scene_start(&hand_now.scene, &hand_state, memory, sizeof memory) == WH_OK);
}

void hand_steps(unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(wh_scene_step(&hand_now.scene, &hand_state) == WH_OK);
    }
}

bool hand_near(wh_real value, wh_real wanted, double bound, double bound_f) {
    return (double)WH_ABS(value - wanted) <= (WH_DOUBLE ? bound : bound_f);
}

void hand_build_ball(wh_real restitution) {
    hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_now.load[0] = -HAND_G;
    hand_now.start[0] = WH_R(1.0);
    hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), restitution, WH_R(0.0));
}
