/* bench.c: see bench.h. */
#include "bench.h"

bench bench_now;

/* Notes in bench_now.astray if this evaluation is not at the expected state. */
static void look_at(const void *model, const wh_phase *phase, const wh_real *linear,
                    const wh_real *rate, const wh_real *input) {
    const wh_contact_point *at = bench_now.at;
    const unsigned angles = bench_now.system.angles;
    if (at == NULL) {
        return;
    }
    bool right = model == &bench_now && input == bench_now.input;
    for (unsigned i = 0; i < bench_now.system.coordinates && right; i++) {
        right =
            rate[i] == at->rate[i] &&
            (i < angles ? phase[i] == at->phase[i] : linear[i - angles] == at->linear[i - angles]);
    }
    bench_now.astray = bench_now.astray || !right;
}

static void bench_accel(const void *model, const wh_phase *phase, const wh_real *linear,
                        const wh_real *rate, const wh_real *input, wh_real *accel) {
    look_at(model, phase, linear, rate, input);
    for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
        accel[i] = bench_now.free[i];
        if (bench_now.ramp[i] != WH_R(0.0)) {
            accel[i] += bench_now.ramp[i] * linear[0];
        }
    }
}

static void bench_signals(const void *model, const wh_phase *phase, const wh_real *linear,
                          const wh_real *rate, const wh_real *input, wh_real *result) {
    const unsigned angles = bench_now.system.angles;
    look_at(model, phase, linear, rate, input);
    bench_now.looks++;
    for (unsigned k = 0; k < 2U * bench_now.system.contacts; k++) {
        const bool place = k % 2U == 0 && bench_now.contact[k / 2U].kind != WH_FRICTION;
        result[k] = bench_now.signal[k];
        for (unsigned i = 0; i < bench_now.system.coordinates && bench_now.moves; i++) {
            const wh_real line = i < angles ? WH_R(0.0) : linear[i - angles];
            result[k] += bench_now.row[k / 2U][i] * (place ? line : rate[i]);
        }
        if (place && bench_now.moves && bench_now.lean[k / 2U] != WH_R(0.0)) {
            result[k] += bench_now.lean[k / 2U] / 2 * linear[0] * linear[0];
        }
    }
}

static void bench_forces(const void *model, const wh_phase *phase, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *result) {
    const unsigned n = bench_now.system.coordinates;
    look_at(model, phase, linear, rate, input);
    bench_now.laws++;
    for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
        wh_real *law = result + k * (WH_LAW_ROWS + 2U * n);
        const wh_real straight = bench_now.row[k][0];
        if (bench_now.lean[k] != WH_R(0.0)) {
            bench_now.row[k][0] += bench_now.lean[k] * linear[0];
        }
        law[WH_LAW_FIRST] = bench_now.first[k];
        law[WH_LAW_SECOND] = bench_now.second[k];
        law[WH_LAW_BIAS] = bench_now.bias[k];
        for (unsigned i = 0; i < n; i++) {
            law[(unsigned)WH_LAW_ROWS + i] = bench_now.row[k][i];
            law[(unsigned)WH_LAW_ROWS + n + i] = bench_way(k, i);
        }
        bench_now.row[k][0] = straight;
    }
}

/* Levels of the accounts: account 0 is the position of the first coordinate; account 1 + i is ten times the rate i. */
static void bench_levels(const void *model, const wh_angle *angle, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *level) {
    (void)model;
    (void)angle;
    (void)input;
    level[0] = linear[0];
    for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
        level[1U + i] = WH_R(10.0) * rate[i];
    }
}

void bench_build(uint64_t *seed, unsigned coordinates, unsigned angles) {
    wh_real lower[BENCH_COORDS][BENCH_COORDS] = {{WH_R(0.0)}};
    bench_now = (bench){.moves = false};
    for (unsigned i = 0; i < BENCH_COORDS; i++) {
        for (unsigned j = 0; j < i; j++) {
            lower[i][j] = draw_whole(seed, -1, 1);
        }
        lower[i][i] = draw_whole(seed, 1, 2);
    }
    for (unsigned i = 0; i < WH_COORDS; i++) {
        bench_now.free[i] = draw_whole(seed, -8, 8);
        for (unsigned j = 0; j < WH_COORDS; j++) {
            const bool inside = i < coordinates && j < coordinates;
            bench_now.inverse[i][j] = inside ? WH_R(0.0) : BENCH_SENTINEL;
            for (unsigned l = 0; l < BENCH_COORDS && inside; l++) {
                bench_now.inverse[i][j] += lower[i][l] * lower[j][l];
            }
        }
    }
    for (unsigned k = 0; k < BENCH_CONTACTS; k++) { /* no contact uses this entry yet */
        bench_now.contact[k].pin = -1;
        bench_now.first[k] = BENCH_SENTINEL;
        bench_now.second[k] = BENCH_SENTINEL;
        bench_now.bias[k] = BENCH_SENTINEL;
        bench_now.signal[2 * k] = -BENCH_SENTINEL;
        bench_now.signal[2 * k + 1] = -BENCH_SENTINEL;
        for (unsigned i = 0; i < WH_COORDS; i++) {
            bench_now.row[k][i] = BENCH_SENTINEL;
        }
    }
    bench_now.books = (wh_ledger_form){.levels = bench_levels,
                                       .entries = (uint16_t)(BENCH_CONTACTS * (1U + coordinates)),
                                       .accounts = (uint8_t)(1U + coordinates),
                                       .coordinates = (uint8_t)coordinates,
                                       .angles = (uint8_t)angles};
    bench_now.system = (wh_contact_system){.model = &bench_now,
                                           .accel = bench_accel,
                                           .signals = bench_signals,
                                           .forces = bench_forces,
                                           .contact = bench_now.contact,
                                           .ledger = &bench_now.books,
                                           .method = WH_RK4,
                                           .angles = (uint8_t)angles,
                                           .coordinates = (uint8_t)coordinates};
}

unsigned bench_add(uint64_t *seed, wh_contact_kind kind, int pin) {
    wh_contact_system *of = &bench_now.system;
    const unsigned k = of->contacts++;
    bool any = false;
    for (unsigned i = 0; i < of->coordinates; i++) {
        const bool is_pin = pin == (int)i;
        bench_now.row[k][i] = is_pin ? WH_R(1.0) : pin >= 0 ? WH_R(0.0) : draw_whole(seed, -2, 2);
        if (is_pin && kind != WH_FRICTION && draw_one_in(seed, 2)) {
            bench_now.row[k][i] = WH_R(-2.0);
        }
        any = any || bench_now.row[k][i] != WH_R(0.0);
    }
    if (!any) {
        bench_now.row[k][0] = WH_R(1.0);
    }
    for (unsigned i = of->coordinates; i < WH_COORDS; i++) {
        bench_now.row[k][i] = BENCH_SENTINEL;
    }
    bench_now.contact[k] = (wh_contact){.kind = (uint8_t)kind, .pin = (int16_t)pin};
    bench_now.first[k] = draw_whole(seed, 1, 4);
    bench_now.second[k] = bench_now.first[k] - WH_R(0.5);
    /* a pinned contact has a straight path */
    bench_now.bias[k] = pin >= 0 ? WH_R(0.0) : draw_whole(seed, -3, 3);
    bench_now.signal[2 * k] = draw_whole(seed, -4, 4);
    bench_now.signal[2 * k + 1] = draw_whole(seed, -4, 4);
    if (kind != WH_WHEN) {
        of->forced++;
        of->kinds = (uint8_t)(of->kinds | WH_KIND_BIT(kind));
        of->pinned = (uint8_t)(of->pinned + (pin >= 0));
    }
    for (unsigned l = k + 1; l < BENCH_CONTACTS; l++) {
        /* the contact gets the row of another contact */
        bench_now.contact[l] = bench_now.contact[k];
    }
    return k;
}

void bench_add_some(uint64_t *seed, unsigned kinds) {
    const unsigned n = bench_now.system.coordinates;
    const unsigned count = 1U + draw_one_of(seed, BENCH_FORCED);
    for (unsigned kind = WH_STOP; kind < WH_WHEN; kind++) {
        for (unsigned i = 0; i < count && (kinds >> kind & 1U) != 0; i++) {
            const unsigned k = bench_now.system.contacts;
            const bool last = kinds >> (kind + 1U) == 0 && k == 0;
            const bool pinned = kind == WH_FRICTION || draw_one_in(seed, 3);
            if (k < count && (last || draw_one_in(seed, 2))) {
                (void)bench_add(seed, (wh_contact_kind)kind,
                                pinned ? (int)draw_one_of(seed, n) : -1);
                const bool again = k > 0 && !pinned && draw_one_in(seed, 4);
                for (unsigned c = 0; c < n && again; c++) {
                    bench_now.row[k][c] = -bench_now.row[k - 1][c];
                }
            }
        }
    }
    if (bench_now.system.contacts == 0) {
        (void)bench_add(seed, (kinds & WH_KIND_BIT(WH_STOP)) != 0 ? WH_STOP : WH_HOLD, -1);
    }
}

void bench_draw(uint64_t *seed, bool angles) {
    const unsigned all = WH_KIND_BIT(WH_STOP) | WH_KIND_BIT(WH_HOLD) | WH_KIND_BIT(WH_FRICTION);
    const unsigned kinds = 1U + draw_one_of(seed, all);
    const unsigned n = 1U + draw_one_of(seed, BENCH_COORDS);
    bench_build(seed, n, angles ? draw_one_of(seed, n + 1U) : 0U);
    bench_add_some(seed, kinds);
}

bool bench_keeps(const wh_contact_work *w, unsigned k) {
    const bool friction = bench_now.contact[k].kind == WH_FRICTION;
    return friction ? w->mode[k] == WH_STUCK : w->mode[k] == WH_ACTIVE;
}

void bench_work(uint64_t *seed, bool some, wh_contact_work *w) {
    *w = (wh_contact_work){.undefined = -1, .fault = -1};
    for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
        const bool used = k < bench_now.system.contacts;
        const bool friction = bench_now.contact[k].kind == WH_FRICTION;
        const int8_t way = draw_one_in(seed, 2) ? 1 : -1;
        const bool holds = !used || !some || draw_one_in(seed, 2);
        w->mode[k] = (int8_t)(friction ? (holds ? WH_STUCK : way) : holds ? WH_ACTIVE : WH_FREE);
        w->force[k] = used ? draw_whole(seed, -4, 4) : BENCH_SENTINEL;
    }
    bench_forces(NULL, NULL, NULL, NULL, NULL, w->law);
}

void bench_vector(uint64_t *seed, wh_real *x) {
    for (unsigned i = 0; i < WH_COORDS; i++) {
        x[i] = i < bench_now.system.coordinates ? draw_whole(seed, -4, 4) : BENCH_SENTINEL;
    }
}

void bench_state(uint64_t *seed, wh_contact_state *s) {
    const unsigned angles = bench_now.system.angles;
    const unsigned reals = 2U * bench_now.system.coordinates - angles;
    for (unsigned i = 0; i < WH_COORDS; i++) {
        s->angle[i] = (wh_angle)draw_whole(seed, -100, 100);
    }
    for (unsigned i = 0; i < 2U * WH_COORDS; i++) {
        s->real[i] = i < reals ? draw_whole(seed, -4, 4) : BENCH_SENTINEL;
        s->carry[i] = WH_R(0.0);
    }
}

wh_real bench_moved(const wh_contact_state *from, const wh_contact_state *to, unsigned i) {
    const unsigned angles = bench_now.system.angles;
    if (i < angles) {
        return (wh_real)((double)(to->angle[i] - from->angle[i]) / (double)WH_PHASE_PER_RAD);
    }
    return to->real[i - angles] - from->real[i - angles];
}

unsigned bench_members(uint64_t *seed, uint8_t *member) {
    const unsigned forced = bench_now.system.forced;
    for (unsigned i = 0; i < forced; i++) {
        const unsigned j = draw_one_of(seed, i + 1U);
        member[i] = member[j];
        member[j] = (uint8_t)i;
    }
    const unsigned count = 1U + draw_one_of(seed, forced);
    for (unsigned i = count; i < BENCH_CONTACTS; i++) {
        member[i] = BENCH_CONTACTS - 1U;
    }
    return count;
}

wh_real bench_along(unsigned k, const wh_real *x) {
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
        sum += bench_now.row[k][i] * x[i];
    }
    return sum;
}

wh_real bench_way(unsigned k, unsigned i) { return bench_along(k, bench_now.inverse[i]); }

wh_real bench_delassus(unsigned k, unsigned l) {
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
        sum += bench_now.row[k][i] * bench_way(l, i);
    }
    return sum;
}

bool bench_near(wh_real value, wh_real wanted) {
    return WH_ABS(value - wanted) <=
           (WH_DOUBLE ? WH_R(1e-10) : WH_R(1e-3)) * (WH_R(1.0) + WH_ABS(wanted));
}

/* Makes the rows upper triangular, one by one. The arithmetic is exact, because the whole numbers are small. */
unsigned bench_repeats(const uint8_t *member, unsigned count, const int8_t *at) {
    double kept[BENCH_COORDS][BENCH_COORDS];
    unsigned lead[BENCH_COORDS];
    unsigned rank = 0;
    unsigned repeats = 0;
    const unsigned n = bench_now.system.coordinates;
    for (unsigned p = 0; p < count; p++) {
        double row[BENCH_COORDS] = {0.0};
        unsigned c = 0;
        if (at != NULL && at[p] != 0) {
            continue;
        }
        for (unsigned i = 0; i < n; i++) {
            row[i] = (double)bench_now.row[member[p]][i];
        }
        for (unsigned r = 0; r < rank; r++) { /* without division, so without round-off */
            const double mine = row[lead[r]];
            for (unsigned i = 0; i < n; i++) {
                row[i] = row[i] * kept[r][lead[r]] - mine * kept[r][i];
            }
        }
        while (c < n && row[c] == 0.0) {
            c++;
        }
        if (c == n) {
            repeats |= 1U << p;
            continue;
        }
        lead[rank] = c;
        for (unsigned i = 0; i < n; i++) {
            kept[rank][i] = row[i];
        }
        rank++;
    }
    return repeats;
}

void bench_solve(const uint8_t *member, unsigned count, unsigned out, const wh_real *wanted,
                 wh_real *lambda) {
    double a[BENCH_FORCED][BENCH_FORCED + 1];
    unsigned place[BENCH_FORCED];
    unsigned size = 0;
    for (unsigned i = 0; i < count; i++) {
        lambda[i] = WH_R(0.0);
        if ((out >> i & 1U) == 0) {
            place[size++] = i;
        }
    }
    for (unsigned r = 0; r < size; r++) {
        for (unsigned c = 0; c < size; c++) {
            a[r][c] = (double)bench_delassus(member[place[r]], member[place[c]]);
        }
        a[r][size] = (double)wanted[place[r]];
    }
    for (unsigned p = 0; p < size; p++) {
        unsigned best = p;
        for (unsigned r = p; r < size; r++) {
            best = a[r][p] * a[r][p] > a[best][p] * a[best][p] ? r : best;
        }
        for (unsigned c = 0; c <= size; c++) {
            const double kept = a[p][c];
            a[p][c] = a[best][c];
            a[best][c] = kept;
        }
        for (unsigned r = 0; r < size; r++) {
            const double factor = r == p ? 0.0 : a[r][p] / a[p][p];
            for (unsigned c = 0; c <= size; c++) {
                a[r][c] -= factor * a[p][c];
            }
        }
    }
    for (unsigned r = 0; r < size; r++) {
        lambda[place[r]] = (wh_real)(a[r][size] / a[r][r]);
    }
}

void bench_plain(uint64_t *seed, wh_contact_work *w) {
    bench_draw(seed, false);
    bench_work(seed, false, w);
}

bool bench_pins(const uint8_t *member, unsigned count, unsigned c) {
    bool pinned = false;
    for (unsigned i = 0; i < count; i++) {
        pinned = pinned || bench_now.contact[member[i]].pin == (int)c;
    }
    return pinned;
}
