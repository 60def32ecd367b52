/* test_contact_margins.c: the margins of the search in core/contact/contact_locate.h, the search's path, and the
 * contact that is reported for NaN. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 3000 : 60 };

/* Draws contacts of some kinds in some modes, and one or two crossings if there is room. */
static void draw(uint64_t *seed, wh_contact_work *w) {
    bench_draw(seed, true);
    while (bench_now.system.contacts < BENCH_FORCED && draw_one_in(seed, 2)) {
        const unsigned k = bench_add(seed, WH_WHEN, -1);
        bench_now.contact[k].direction = (int8_t)draw_whole(seed, -1, 1);
    }
    bench_work(seed, true, w);
    for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
        w->slack[k] = draw_whole(seed, 0, 4) / 4;
        if (bench_now.contact[k].kind == WH_WHEN) {
            w->mode[k] = (int8_t)draw_whole(seed, -1, 1);
        }
        if (k < bench_now.system.contacts) {
            bench_now.signal[2 * k] *= draw_one_in(seed, 4) ? WH_R(0.0) : WH_R(0.25);
        }
    }
    w->inside = (unsigned)draw_bits(seed) % 32U;
}

/* Returns a bound on the round-off of the acceleration along k that the other contacts' forces cause. */
static wh_real others_of(const wh_contact_work *w, unsigned k) {
    wh_real others = WH_R(0.0);
    for (unsigned l = 0; l < bench_now.system.forced; l++) {
        others += l == k ? WH_R(0.0) : WH_ABS(bench_delassus(k, l) * w->force[l]);
    }
    return others;
}

TEST(contact_margins, forces_exceed_limits_beyond_round_off) {
    uint64_t seed = 181;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        draw(&seed, &w);
        const wh_contact_system *of = &bench_now.system;
        const unsigned k = draw_one_of(&seed, of->forced);
        const wh_real least = WH_CONTACT_QUIET * others_of(&w, k) / bench_delassus(k, k);
        TEST_ASSERT_TRUE(wh_contact_beyond(of, &w, k, WH_R(-0.99) * least) == WH_R(0.0));
        TEST_ASSERT_TRUE(wh_contact_beyond(of, &w, k, WH_R(-1.01) * least) == WH_R(-1.01) * least);
        TEST_ASSERT_TRUE(wh_contact_beyond(of, &w, k, WH_R(-1e3)) == WH_R(-1e3));
        TEST_ASSERT_TRUE(wh_contact_beyond(of, &w, k, WH_R(0.0)) == WH_R(0.0));
        TEST_ASSERT_TRUE(wh_contact_beyond(of, &w, k, least / 2) == least / 2);
    }
}

static wh_real beyond(const wh_contact_work *w, unsigned k, wh_real margin) {
    const wh_real noise = WH_CONTACT_QUIET * others_of(w, k);
    return margin < WH_R(0.0) && -margin * bench_delassus(k, k) <= noise ? WH_R(0.0) : margin;
}

static wh_real margin_of(const wh_contact_work *w, unsigned k) {
    const wh_contact *c = &bench_now.contact[k];
    const wh_real at = bench_now.signal[2 * k];
    const wh_real rate = bench_now.signal[2 * k + 1];
    const bool out = (w->inside >> k & 1U) != 0 && rate > WH_R(0.0);
    switch ((wh_contact_kind)c->kind) {
    case WH_STOP: return bench_keeps(w, k) ? beyond(w, k, w->force[k]) : out ? WH_ABS(at) : at;
    case WH_HOLD: return bench_keeps(w, k) ? at : -at;
    case WH_FRICTION:
        if (bench_keeps(w, k)) {
            return beyond(w, k, bench_now.first[k] - WH_ABS(w->force[k]));
        }
        return (wh_real)w->mode[k] * at + w->slack[k];
    case WH_WHEN:
        return w->mode[k] == 0 || w->mode[k] == c->direction
                   ? WH_R(1.0)
                   : (wh_real)w->mode[k] * at + w->slack[k];
    case WH_CONTACT_KIND_COUNT: break;
    }
    return BENCH_SENTINEL;
}

/* Returns the sum of the signals that a step depends on: both signals of a stop or hold, one of a crossing or friction,
 * the limit of a sticking friction. */
static wh_real sum_of(const wh_contact_work *w) {
    wh_real all = WH_R(0.0);
    for (unsigned k = 0; k < bench_now.system.contacts; k++) {
        const uint8_t kind = bench_now.contact[k].kind;
        all += bench_now.signal[2 * k];
        all += kind == WH_STOP || kind == WH_HOLD ? bench_now.signal[2 * k + 1] : WH_R(0.0);
        all += kind == WH_FRICTION && bench_keeps(w, k) ? bench_now.first[k] : WH_R(0.0);
    }
    return all;
}

TEST(contact_margins, margins_of_each_kind) {
    uint64_t seed = 182;
    for (unsigned round = 0; round < 2U * ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state s;
        wh_contact_point at;
        wh_margins m;
        bool watched = false;
        draw(&seed, &w);
        const wh_contact_system *of = &bench_now.system;
        bench_state(&seed, &s);
        wh_contact_point_of(of, &s, &at);
        for (unsigned k = 0; k < of->forced; k++) {
            watched = watched || (bench_now.contact[k].kind != WH_HOLD && bench_keeps(&w, k));
        }
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
            m.value[k] = BENCH_SENTINEL;
        }
        m.accel[0] = BENCH_SENTINEL;
        const unsigned laws = bench_now.laws;
        TEST_ASSERT_TRUE(wh_contact_watched(of, &w) == watched);
        wh_contact_margins(of, &w, &at, NULL, &m);
        TEST_ASSERT_EQUAL_UINT(laws + watched, bench_now.laws);
        TEST_ASSERT_TRUE((m.accel[0] == BENCH_SENTINEL) != watched);
        TEST_ASSERT_TRUE(m.all == sum_of(&w));
        unsigned happened = 0;
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
            const bool used = k < of->contacts;
            const wh_real right = used ? margin_of(&w, k) : BENCH_SENTINEL;
            TEST_ASSERT_TRUE(bench_near(m.value[k], right));
            if (used) {
                TEST_ASSERT_TRUE((m.value[k] < WH_R(0.0)) == (right < WH_R(0.0)));
                TEST_ASSERT_TRUE(m.signal[2 * k] == bench_now.signal[2 * k]);
                happened |= right < WH_R(0.0) ? 1U << k : 0U;
            }
        }
        TEST_ASSERT_EQUAL_UINT(happened, wh_contact_happened(of, &m));
        TEST_ASSERT_TRUE(wh_contact_calm(of, &m) == (happened == 0));
    }
}

static wh_real draw_none(uint64_t *seed) {
    const wh_real zero = WH_R(0.0) * bench_now.free[0];
    return draw_one_in(seed, 3)   ? zero / zero
           : draw_one_in(seed, 2) ? 1 / (zero * zero)
                                  : -1 / (zero * zero);
}

static bool is_number(wh_real value) { return value - value == WH_R(0.0); }

/* True if the law that the contact's present mode needs is finite. A stop needs none. */
static bool law_is_number(const wh_contact_work *w, unsigned k) {
    const uint8_t kind = bench_now.contact[k].kind;
    const bool asked = kind == WH_FRICTION || (kind == WH_HOLD && bench_keeps(w, k));
    const bool second = kind == WH_FRICTION && !bench_keeps(w, k);
    return !asked || is_number(second ? bench_now.second[k] : bench_now.first[k]);
}

/* If several contacts have NaN, signals are checked first, then laws (if a contact acts), then margins. The first NaN
 * that is found is reported, and an earlier report stays. */
TEST(contact_margins, first_nan_is_reported) {
    uint64_t seed = 183;
    unsigned told[BENCH_FORCED] = {0};
    for (unsigned round = 0; round < 4U * ROUNDS; round++) {
        wh_contact_work w;
        wh_margins m = {.all = WH_R(0.0)};
        int signal = -1;
        int law = -1;
        int value = -1;
        bool acts = false;
        draw(&seed, &w);
        const wh_contact_system *of = &bench_now.system;
        const bool signals = draw_one_in(&seed, 3);
        const bool laws = draw_one_in(&seed, 2);
        for (unsigned k = 0; k < of->contacts; k++) {
            bench_now.first[k] = laws && draw_one_in(&seed, 3) ? draw_none(&seed) : WH_R(1.0);
            bench_now.second[k] = laws && draw_one_in(&seed, 3) ? draw_none(&seed) : WH_R(1.0);
            m.value[k] = draw_one_in(&seed, 3) ? draw_none(&seed) : WH_R(-1.0);
            for (unsigned i = 2 * k; i <= 2 * k + 1; i++) {
                m.signal[i] = signals && draw_one_in(&seed, 3) ? draw_none(&seed) : WH_R(1.0);
            }
        }
        for (unsigned k = of->contacts; k-- > 0;) {
            const bool forced = k < of->forced;
            signal = is_number(m.signal[2 * k]) && is_number(m.signal[2 * k + 1]) ? signal : (int)k;
            law = !forced || law_is_number(&w, k) ? law : (int)k;
            value = is_number(m.value[k]) ? value : (int)k;
            acts = acts ||
                   (forced && (bench_now.contact[k].kind == WH_FRICTION || bench_keeps(&w, k)));
        }
        of->forces(NULL, NULL, NULL, NULL, NULL, w.law);
        TEST_ASSERT_TRUE(wh_contact_any_acts(of, &w) == acts);
        wh_contact_work by_laws = w;
        wh_contact_expect_laws(of, &by_laws);
        TEST_ASSERT_EQUAL_INT(law, by_laws.undefined);
        w.undefined = draw_one_in(&seed, 8) ? 3 : -1;
        const int right = w.undefined >= 0   ? w.undefined
                          : signal >= 0      ? signal
                          : law >= 0 && acts ? law
                                             : value;
        wh_contact_find_undefined(of, &w, &m);
        TEST_ASSERT_EQUAL_INT(right, w.undefined);
        if (right >= 0) {
            told[right]++;
        }
    }
    for (unsigned k = 0; k < BENCH_FORCED; k++) {
        TEST_ASSERT_TRUE(told[k] > ROUNDS / 20);
    }
}

/* Reference: the cubic with these values and slopes at its ends, in Bezier's form, by de Casteljau's algorithm. */
static double cubic(double s, double from, double slope0, double to, double slope1) {
    double point[4] = {from, from + slope0 / 3.0, to - slope1 / 3.0, to};
    for (unsigned left = 3; left > 0; left--) {
        for (unsigned i = 0; i < left; i++) {
            point[i] += s * (point[i + 1U] - point[i]);
        }
    }
    return point[0];
}

TEST(contact_margins, path_is_a_cubic) {
    uint64_t seed = 185;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state from;
        wh_contact_state to;
        wh_contact_path path;
        wh_contact_point at;
        draw(&seed, &w);
        const wh_contact_system *of = &bench_now.system;
        bench_state(&seed, &from);
        bench_state(&seed, &to);
        const wh_real h = draw_whole(&seed, 1, 8) / 8;
        const wh_real s = draw_whole(&seed, 0, 16) / 16;
        for (unsigned i = 0; i < of->angles; i++) { /* less than half a turn */
            to.angle[i] = from.angle[i] +
                          (wh_angle)(draw_whole(&seed, -3, 3) / 4 * (wh_real)WH_PHASE_PER_RAD);
            const unsigned rate = (unsigned)(of->coordinates - of->angles) + i;
            from.real[rate] /= 16;
            to.real[rate] /= 16;
        }
        wh_contact_path_of(of, &from, &to, h, &path);
        for (unsigned i = 0; i < of->coordinates; i++) {
            path.a0[i] = draw_whole(&seed, -8, 8);
            path.a1[i] = draw_whole(&seed, -8, 8);
        }
        wh_contact_between(of, &path, s, &at);
        const wh_real *v0 = wh_contact_rates(of, &from);
        const wh_real *v1 = wh_contact_rates(of, &to);
        for (unsigned i = 0; i < of->coordinates; i++) {
            const double span = (double)h;
            const double far = (double)bench_moved(&from, &to, i);
            const double moved =
                cubic((double)s, 0.0, span * (double)v0[i], far, span * (double)v1[i]);
            const double rate = cubic((double)s, (double)v0[i], span * (double)path.a0[i],
                                      (double)v1[i], span * (double)path.a1[i]);
            TEST_ASSERT_TRUE(bench_near(at.rate[i], (wh_real)rate));
            if (i < of->angles) {
                wh_contact_state there = from;
                there.angle[i] = from.angle[i] + (wh_angle)(moved * (double)WH_PHASE_PER_RAD);
                const wh_real off =
                    WH_DOUBLE
                        ? (wh_real)(at.phase[i] - wh_phase_of(there.angle[i]))
                        : (wh_real)(int32_t)(uint32_t)(at.phase[i] - wh_phase_of(there.angle[i]));
                TEST_ASSERT_TRUE(WH_ABS(off) <= (WH_DOUBLE ? WH_R(1e-12) : WH_R(4096.0)));
            } else {
                const unsigned l = i - of->angles;
                TEST_ASSERT_TRUE(bench_near(at.linear[l], from.real[l] + (wh_real)moved));
            }
        }
    }
}
