/* free_swing.c: the sensors' positions, from the free swing of a rotor that comes to rest. */
#include "free_swing.h"

#include "core/root.h"
#include "core/text.h"
#include "datasheet.h"
#include "polar.h"

static wh_real square_of(wh_real x) { return x * x; }

static void begin(wh_swing *swing) {
    swing->result = (wh_swung){.why = WH_SWING_SWINGS};
    swing->any = false;
    swing->forward = true;
    swing->swings = false;
    swing->passed = 0;
    swing->kept = 0;
}

static void keep(wh_swing *swing, unsigned sensor, uint32_t ticks) {
    if (!swing->swings && swing->kept > WH_SWING_TURNING) {
        for (unsigned i = 0; i < WH_SWING_TURNING; i++) {
            swing->kept_ticks[i] = swing->kept_ticks[i + 1U];
            swing->kept_sensor[i] = swing->kept_sensor[i + 1U];
        }
        swing->kept = WH_SWING_TURNING;
    }
    if (swing->kept < WH_SWING_PULSES) {
        swing->kept_ticks[swing->kept] = ticks;
        swing->kept_sensor[swing->kept++] = (uint8_t)sensor;
    }
}

WH_CALLED void wh_swing_pulse(wh_swing *swing, unsigned sensor, uint32_t ticks) {
    if (swing->result.why != WH_SWING_SWINGS) {
        return;
    }
    /* Two successive pulses of the same sensor mean that the rotor has reversed between them. */
    const bool again = swing->any && sensor == swing->sensor;
    if (!swing->forward && sensor == 1U && swing->sensor == 0) {
        /* A pulse was lost: the rotor turns forwards. */
        swing->forward = true;
        swing->swings = false;
        swing->kept = 0;
        swing->passed = 0;
    } else {
        swing->forward = swing->forward != again;
    }
    swing->any = true;
    swing->sensor = (uint8_t)sensor;
    keep(swing, sensor, ticks);
    if (!swing->swings && sensor == 0 && !swing->forward) {
        swing->swings = true;
        swing->first = swing->kept - 1U;
    }
    if (swing->swings && sensor == 0) {
        for (unsigned i = WH_SWING_LAST - 1U; i > 0; i--) {
            swing->last_ticks[i] = swing->last_ticks[i - 1U];
        }
        swing->last_ticks[0] = ticks;
        swing->passed++;
    }
}

#define STEP_TICKS 8000

/* Integrates one step towards the next pulse. Returns false if the pulse is reached. */
static bool advance(wh_swing *swing) {
    const int32_t left = (int32_t)(swing->kept_ticks[swing->at] - swing->ticks);
    if (left == 0) {
        return false;
    }
    const int32_t ticks = left > STEP_TICKS ? STEP_TICKS : left < -STEP_TICKS ? -STEP_TICKS : left;
    const wh_real h = (wh_real)ticks / (wh_real)WH_RIG_TICKS_PER_S;
    wh_free_rotor_step(swing->x, &swing->way, h);
    swing->ticks += (uint32_t)ticks;
    return true;
}

#define PASSES 12U
#define SOFT_PASSES 6U
/* From this pass on, a large residual does not end the forward integration. */
#define SURE_PASSES SOFT_PASSES

/* Returns the angle q at a pulse of `sensor`. `lead` is 0 if the rotor turns forwards, else 2 lead_rad. */
static WH_CALLED wh_real stands(const wh_rotor_config *rotor, const wh_swing *swing,
                                unsigned sensor, wh_real lead) {
    return rotor->pulse_rad[sensor] + lead - rotor->gravity_rad + swing->x[WH_SWING_PLACE + sensor];
}

/* Starts the integration at the first backward pulse of sensor 1. */
static void set_out(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing) {
    swing->ticks = swing->kept_ticks[swing->first];
    wh_free_rotor_start(&swing->way,
                        stands(rotor, swing, 0, WH_R(2.0) * config->lead_rad) + swing->x[WH_FREE_Q],
                        swing->x[WH_FREE_RATE]);
}

static void begin_pass(const wh_swing_config *config, const wh_rotor_config *rotor,
                       wh_swing *swing) {
    wh_real left[WH_NORMAL_UNKNOWNS];
    for (unsigned i = 0; i < WH_NORMAL_UNKNOWNS; i++) {
        left[i] = (swing->guess[i] - swing->x[i]) / swing->within[i];
    }
    wh_normal_start(&swing->normal, left);
    /* At first, large and nonlinear residuals need an additional variance, which falls from pass to pass. */
    swing->soft_rad2 = swing->pass == 0            ? WH_R(0.0025)
                       : swing->pass < SOFT_PASSES ? WH_R(0.3) * swing->soft_rad2
                                                   : WH_R(0.0);
    swing->fits = 0;
    swing->strays = 0;
    swing->fits_of[0] = 0;
    swing->fits_of[1] = 0;
    swing->piece = WH_SWING_GOES;
    swing->at = swing->first + 1U;
    set_out(config, rotor, swing);
}

static void rest(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing,
                 bool is_free) {
    if (!is_free || !(rotor->gravity_mps2 > WH_R(0.0))) {
        swing->result.why = WH_SWING_NOT_FREE;
    } else if (swing->passed < 3U || swing->passed <= config->swings_least) {
        swing->result.why = WH_SWING_FEW;
    } else {
        swing->result.why = WH_SWING_WORKS;
        swing->start = 0;
        wh_swing_leave_top(config, swing);
        swing->piece = WH_SWING_GUESSES;
    }
}

/* A pass uses no pulses after the amplitude falls below SLOW_RAD, or below SLOW_FRICTIONS times friction/gravity. */
#define SLOW_RAD WH_R(0.12)
#define SLOW_FRICTIONS WH_R(1.5)

#define FAR_RAD WH_R(0.5)

/* Uses the pulse that the integration has reached. Returns false if it is the last in this direction of time. */
static bool take(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing) {
    const wh_free_rotor *way = &swing->way;
    const unsigned sensor = swing->kept_sensor[swing->at];
    const wh_real lead = way->rate_radps > WH_R(0.0) ? WH_R(0.0) : WH_R(2.0) * config->lead_rad;
    const wh_real off = wh_free_angle(stands(rotor, swing, sensor, lead) - way->q_rad);
    if (!(WH_ABS(off) < FAR_RAD)) {
        if (swing->at < swing->first) { /* the rotor did not get over the top */
            return false;
        }
        swing->strays++;
        return swing->pass >= SURE_PASSES;
    }
    const wh_real weight = WH_R(1.0) / (square_of(config->jitter_s * way->rate_radps) +
                                        square_of(config->rough_rad) + swing->soft_rad2);
    wh_real by[WH_NORMAL_UNKNOWNS];
    for (unsigned i = WH_FREE_Q; i < WH_SWING_PLACE; i++) {
        by[i] = swing->within[i] * way->q_by[i];
    }
    by[WH_SWING_PLACE] = swing->within[WH_SWING_PLACE] * way->q_by[WH_FREE_Q];
    by[WH_SWING_PLACE + 1U] = WH_R(0.0);
    by[WH_SWING_PLACE + sensor] -= swing->within[WH_SWING_PLACE + sensor];
    wh_normal_add(&swing->normal, by, off, weight);
    swing->fits++;
    swing->fits_of[sensor]++;
    if (swing->at <= swing->first || sensor != 0) {
        return true;
    }
    const wh_real gravity = swing->x[WH_FREE_GRAVITY];
    const wh_real wide = WH_ABS(way->rate_radps) / WH_SQRT(gravity);
    return !(wide < SLOW_RAD || wide * gravity < SLOW_FRICTIONS * swing->x[WH_FREE_FRICTION]);
}

static void conclude(const wh_swing_config *config, wh_swing *swing) {
    wh_swung *result = &swing->result;
    const wh_real freedom =
        swing->fits > WH_NORMAL_UNKNOWNS ? (wh_real)(swing->fits - WH_NORMAL_UNKNOWNS) : WH_R(1.0);
    const wh_real rough = swing->normal.misfit / freedom;
    const wh_real student = wh_student((uint32_t)freedom);
    const wh_real wider = rough > WH_R(1.0) ? student * student * rough : square_of(WH_R(1.96));
    for (unsigned i = 0; i < WH_RIG_SENSORS; i++) {
        const wh_real one = swing->within[WH_SWING_PLACE + i] *
                            wh_normal_deviation(&swing->normal, WH_SWING_PLACE + i);
        result->place_rad[i] = swing->x[WH_SWING_PLACE + i];
        result->half_rad[i] = WH_SQRT(wider * one * one + square_of(config->floor_rad));
    }
    result->swings = swing->fits_of[0];
    if (swing->strays * 4U > swing->fits) {
        result->why = WH_SWING_MISFIT;
    } else if (result->swings < config->swings_least) {
        result->why = WH_SWING_FEW;
    } else if (swing->fits_of[1] == 0) {
        result->why = WH_SWING_SIDES;
    } else {
        /* a NaN half-width counts as too wide */
        result->why = result->half_rad[0] <= config->wide_rad ? WH_SWING_FOUND : WH_SWING_WIDE;
    }
}

#define FOREIGN WH_R(9.0)

/* A Gauss-Newton step: each unknown moves by at most the uncertainty of its guess. Returns the next piece of work. */
static wh_swing_piece move(wh_swing *swing) {
    const wh_real *y = swing->normal.right;
    wh_normal_solve(&swing->normal);
    wh_real most = WH_R(0.0);
    for (unsigned i = WH_FREE_RATE; i < WH_NORMAL_UNKNOWNS; i++) {
        most = WH_ABS(y[i]) > most ? WH_ABS(y[i]) : most;
    }
    const wh_real part = most > WH_R(1.0) ? WH_R(1.0) / most : WH_R(1.0);
    for (unsigned i = 0; i < WH_NORMAL_UNKNOWNS; i++) {
        swing->x[i] += part * swing->within[i] * y[i];
    }
    for (unsigned i = WH_FREE_FRICTION; i <= WH_FREE_DRAG; i++) {
        swing->x[i] = swing->x[i] > WH_R(0.0) ? swing->x[i] : WH_R(0.0);
    }
    swing->pass++;
    const bool fits =
        swing->strays * 4U <= swing->fits && swing->normal.misfit < FOREIGN * (wh_real)swing->fits;
    const bool stays = swing->pass > SOFT_PASSES && swing->strays == 0 && most < WH_R(2e-3);
    if (swing->pass == PASSES && !fits && swing->start + 1U < WH_SWING_STARTS) {
        swing->start++;
        return WH_SWING_GUESSES;
    }
    return swing->pass == PASSES || (fits && stays) ? WH_SWING_ENDS : WH_SWING_PASSES;
}

/* Adds a pulse and selects the next: first the pulses after swing->first, then, backwards in time, those before it. */
static void go_on(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing) {
    const bool later = swing->at > swing->first;
    const unsigned next = later ? swing->at + 1U : swing->at - 1U; /* -1 wraps to a large index */
    if (take(config, rotor, swing) && next < swing->kept) {
        swing->at = next;
    } else if (later && swing->first > 0) {
        swing->at = swing->first - 1U;
        set_out(config, rotor, swing);
    } else {
        swing->piece = WH_SWING_FACTORS;
    }
}

#define STEPS 3U /* integration steps per control step */

static WH_CALLED void work(const wh_swing_config *config, const wh_rotor_config *rotor,
                           wh_swing *swing) {
    switch (swing->piece) {
    case WH_SWING_GOES:
        if (!advance(swing)) {
            go_on(config, rotor, swing);
            return;
        }
        for (unsigned i = 1; i < STEPS && advance(swing); i++) {
        }
        break;
    case WH_SWING_FACTORS:
        wh_normal_factor(&swing->normal);
        swing->piece = WH_SWING_SOLVES;
        break;
    case WH_SWING_SOLVES: swing->piece = move(swing); break;
    case WH_SWING_PASSES: begin_pass(config, rotor, swing); break;
    case WH_SWING_GUESSES:
        swing->pass = 0;
        wh_swing_guess(config, swing);
        swing->piece = WH_SWING_PASSES;
        break;
    case WH_SWING_ENDS: conclude(config, swing); break;
    }
}

void wh_swing_step(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing,
                   bool swings, bool rests) {
    if (swings && !swing->free) {
        begin(swing);
    } else if (!swings && swing->free) {
        rest(config, rotor, swing, rests);
    } else if (rests && wh_swing_works(swing)) {
        work(config, rotor, swing);
    }
    swing->free = swings;
}

void wh_swing_doubt(const wh_swing_config *config, const wh_swing *swing, wh_measured *measured) {
    const wh_swung *swung = &swing->result;
    if (swung->why == WH_SWING_FOUND && measured->turns > 0 && measured->quality == WH_GOOD &&
        WH_ABS(swung->place_rad[0]) > swung->half_rad[0] + config->off_rad) {
        measured->quality = WH_DOUBTFUL;
        measured->why = WH_WHY_PLACE;
    }
}

#define ITEM(name, words) WH_WORDS(words)

const char *wh_swing_text(wh_swing_why why) {
    static const char words[] WH_WORD_LIST = WH_SWING_ROWS(ITEM) WH_WORDS("unknown reason");
    return wh_words_item(words, why);
}

/* === the rotor =============================================================================== */

void wh_free_rotor_start(wh_free_rotor *rotor, wh_real q_rad, wh_real rate_radps) {
    *rotor = (wh_free_rotor){.q_rad = wh_free_angle(q_rad), .rate_radps = rate_radps};
    rotor->q_by[WH_FREE_Q] = WH_R(1.0);
    rotor->rate_by[WH_FREE_RATE] = WH_R(1.0);
}

static void drift(wh_free_rotor *rotor, wh_real h) {
    rotor->q_rad = wh_free_angle(rotor->q_rad + h * rotor->rate_radps);
    for (unsigned i = 0; i < WH_FREE_CAUSES; i++) {
        rotor->q_by[i] += h * rotor->rate_by[i];
    }
}

static void kick(const wh_real *cause, wh_free_rotor *rotor, wh_real h) {
    const wh_wave wave = wh_wave_of(rotor->q_rad);
    const wh_real rate = rotor->rate_radps;
    const wh_real sign = rate < WH_R(0.0) ? WH_R(-1.0) : WH_R(1.0);
    const wh_real pulled = -cause[WH_FREE_GRAVITY] * wave.sine;
    const wh_real slowed = pulled - sign * cause[WH_FREE_FRICTION] - cause[WH_FREE_DRAG] * rate;
    wh_real before = h; /* time until the rotor reverses, at most h */
    wh_real after = WH_R(0.0);
    wh_real ratio = WH_R(1.0);
    rotor->rate_radps = rate + h * slowed;
    if (rotor->rate_radps * sign < WH_R(0.0)) {
        before = -rate / slowed;
        after = h - before;
        ratio = (pulled + sign * cause[WH_FREE_FRICTION]) / slowed;
        ratio = ratio > WH_R(0.0) ? ratio : WH_R(0.0); /* 0: friction holds the rotor */
        rotor->rate_radps = ratio * slowed * after;
    }
    const wh_real both = ratio * before + after;
    const wh_real by_q = -both * cause[WH_FREE_GRAVITY] * wave.cosine;
    const wh_real by_rate = ratio * (WH_R(1.0) - before * cause[WH_FREE_DRAG]);
    for (unsigned i = 0; i < WH_FREE_CAUSES; i++) {
        rotor->rate_by[i] = by_rate * rotor->rate_by[i] + by_q * rotor->q_by[i];
    }
    rotor->rate_by[WH_FREE_GRAVITY] -= both * wave.sine;
    rotor->rate_by[WH_FREE_FRICTION] += sign * (after - ratio * before);
    rotor->rate_by[WH_FREE_DRAG] -= ratio * before * rate;
}

void wh_free_rotor_step(const wh_real *cause, wh_free_rotor *rotor, wh_real h) {
    drift(rotor, WH_R(0.5) * h);
    kick(cause, rotor, h);
    drift(rotor, WH_R(0.5) * h);
}

/* === normal equations ======================================================================== */

#define N WH_NORMAL_UNKNOWNS

void wh_normal_start(wh_normal *normal, const wh_real guess[N]) {
    for (unsigned i = 0; i < N; i++) {
        for (unsigned j = 0; j < N; j++) {
            normal->matrix[i][j] = i == j ? WH_R(1.0) : WH_R(0.0);
        }
        normal->right[i] = guess[i];
    }
    normal->misfit = WH_R(0.0);
}

void wh_normal_add(wh_normal *normal, const wh_real row[N], wh_real off, wh_real weight) {
    for (unsigned i = 0; i < N; i++) {
        const wh_real weighted = weight * row[i];
        normal->right[i] += weighted * off;
        for (unsigned j = 0; j <= i; j++) {
            normal->matrix[i][j] += weighted * row[j];
        }
    }
    normal->misfit += weight * off * off;
}

/* Exact pivots are at least 1, because of the prior. Round-off can make them smaller. */
#define PIVOT_LEAST WH_R(1e-3)

void wh_normal_factor(wh_normal *normal) {
    wh_real(*m)[N] = normal->matrix;
    for (unsigned j = 0; j < N; j++) {
        for (unsigned i = j; i < N; i++) {
            wh_real sum = m[i][j];
            for (unsigned k = 0; k < j; k++) {
                sum -= m[i][k] * m[j][k];
            }
            m[i][j] = i != j ? sum / m[j][j] : WH_SQRT(sum > PIVOT_LEAST ? sum : PIVOT_LEAST);
        }
    }
}

/* Replaces y by L^-1 y. The entries y[0] to y[from - 1] are zero. */
static WH_CALLED void forward(const wh_normal *normal, wh_real y[N], unsigned from) {
    for (unsigned i = from; i < N; i++) {
        for (unsigned k = from; k < i; k++) {
            y[i] -= normal->matrix[i][k] * y[k];
        }
        y[i] /= normal->matrix[i][i];
    }
}

void wh_normal_solve(wh_normal *normal) {
    wh_real *y = normal->right;
    forward(normal, y, 0);
    for (unsigned i = N; i-- > 0;) {
        for (unsigned k = i + 1U; k < N; k++) {
            y[i] -= normal->matrix[k][i] * y[k];
        }
        y[i] /= normal->matrix[i][i];
    }
}

/* The variance of an unknown is the squared length of its column of L^-1. */
wh_real wh_normal_deviation(const wh_normal *normal, unsigned which) {
    wh_real y[N] = {WH_R(0.0)};
    wh_real sum = WH_R(0.0);
    y[which] = WH_R(1.0);
    forward(normal, y, which);
    for (unsigned i = which; i < N; i++) {
        sum += y[i] * y[i];
    }
    return WH_SQRT(sum);
}
