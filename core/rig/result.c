/* result.c: turns merged into a measurement with its uncertainty. */
#include "result.h"

#include "core/root.h"
#include "core/text.h"
#include "datasheet.h"
#include "polar.h"

#define PI WH_R(3.141592653589793)
/* Largest part of gravity that the compensation may leave. If it leaves more, its angle or size is wrong. */
#define FED_LEFT_MOST WH_R(0.15)

/* ripple_off_rad may exceed the phase's half-width by this much, because the configured damping has an error. */
#define SWING_OFF_RAD WH_R(0.01)

/* Limits on sums of squared coefficients, in units of a coefficient's variance: REPEATS_NOISE for harmonics 3 to 6
 * (eight coefficients), THIRD_NOISE for harmonic 3 (two). Noise exceeds each limit in one of 100,000 results. */
#define REPEATS_NOISE WH_R(37.3)
#define THIRD_NOISE WH_R(23.0)

/* Without noise and jitter, a healthy rig's repeating residual is at most the force times the sum of these terms
 * (tests/host/test_repeats_truth.c). turn_angle.h defines psi, E, A and `cut`. */
#define REPEATS_LAG WH_R(0.4)    /* times psi E^2: effect of the damping */
#define REPEATS_ARROW WH_R(1.6)  /* times E ripple_off_rad: effect of the ripple's error */
#define REPEATS_CUT WH_R(0.29)   /* times `cut`: effect of a motor that cannot brake enough */
#define REPEATS_TWICE WH_R(6.0)  /* times wh_turn_angle.twice_rad: effect of the carriage */
#define REPEATS_CELL WH_R(1e-4)  /* constant: nonlinearity of the cell */
#define REPEATS_STEP WH_R(0.012) /* times (angle between samples)^2, rad^2: effect of sampling */

/* Repeating residual of one turn, as a fraction of the force, per radian of the pulses' jitter. */
#define REPEATS_JITTER WH_R(0.15)

static wh_real square_of(wh_real x) { return x * x; }

static wh_real floor_or(wh_real entered, wh_real uncalibrated) {
    return entered > WH_R(0.0) ? entered : uncalibrated;
}

wh_real wh_student(uint32_t freedom) {
    static const wh_real first[] = {WH_R(0.0),   WH_R(12.706), WH_R(4.303), WH_R(3.182),
                                    WH_R(2.776), WH_R(2.571),  WH_R(2.447), WH_R(2.365)};
    if (freedom < sizeof first / sizeof first[0]) {
        return first[freedom];
    }
    /* Cornish and Fisher's expansion about the normal distribution's 1.95996 */
    const wh_real per = WH_R(1.0) / (wh_real)freedom;
    return WH_R(1.95996) + per * (WH_R(2.3723) + per * (WH_R(2.8225) + per * WH_R(2.5556)));
}

static void add_jitter(wh_merge *merge, uint32_t before_ticks, uint32_t now_ticks) {
    const wh_real off_s = wh_rig_way_s(before_ticks, now_ticks);
    merge->jitter_s2 += off_s * off_s;
    merge->jitters++;
}

/* Adds the second differences of each sensor's pulse times: the differences of successive turns' durations. */
static void add_pulses(wh_merge *merge, const wh_lockin_turn *turn) {
    const bool adjoins =
        merge->follows && merge->begin_ticks + merge->last_ticks == turn->begin_ticks;
    if (adjoins) {
        add_jitter(merge, merge->last_ticks, turn->turn_ticks);
    }
    const bool split_adjoins =
        adjoins && merge->second_ticks != merge->begin_ticks && turn->second_seen;
    const uint32_t split_turn = turn->second_ticks - merge->second_ticks;
    if (split_adjoins && merge->second_follows) {
        add_jitter(merge, merge->second_turn_ticks, split_turn);
    }
    merge->second_follows = split_adjoins;
    merge->second_turn_ticks = split_turn;
    merge->begin_ticks = turn->begin_ticks;
    merge->second_ticks = turn->second_seen ? turn->second_ticks : turn->begin_ticks;
    merge->last_ticks = turn->turn_ticks;
    merge->follows = true;
}

/* Updates a running mean; `part` is the weight of `value`. */
static WH_CALLED void go_on(wh_real *mean, wh_real value, wh_real part) {
    *mean += part * (value - *mean);
}

void wh_merge_add(const wh_result_config *config, const wh_rotor_config *rotor, wh_merge *merge,
                  const wh_lockin_turn *turn, const wh_turn_angle *angle) {
    merge->outliers += turn->outliers;
    merge->samples += turn->samples;
    if (turn->fault != WH_TURN_OK) {
        merge->left_out++;
        merge->follows = false;
        merge->second_follows = false;
        return;
    }
    add_pulses(merge, turn);
    if (merge->turns == 0) {
        merge->first_ticks = turn->turn_ticks;
    }
    merge->turns++;
    const wh_real part = WH_R(1.0) / (wh_real)merge->turns;
    const wh_real in_phase = turn->force_N.at[1] - merge->in_phase_N;
    const wh_real quadrature = turn->force_N.at[2] - merge->quadrature_N;
    merge->in_phase_N += part * in_phase;
    merge->quadrature_N += part * quadrature;
    go_on(&merge->second_N[0], turn->force_N.at[3], part);
    go_on(&merge->second_N[1], turn->force_N.at[4], part);
    merge->scatter_N2[0] += in_phase * (turn->force_N.at[1] - merge->in_phase_N);
    merge->scatter_N2[1] += in_phase * (turn->force_N.at[2] - merge->quadrature_N);
    merge->scatter_N2[2] += quadrature * (turn->force_N.at[2] - merge->quadrature_N);

    const wh_real turn_s = (wh_real)turn->turn_ticks / (wh_real)WH_RIG_TICKS_PER_S;
    const wh_real swing2 = angle->ripple_rad * angle->ripple_rad;
    /* Ripples E and A (turn_angle.h) raise the squared speed's mean over the angle. */
    const wh_real twice2 = WH_R(4.0) * square_of(angle->twice_rad);
    const wh_real expected = config->mount_factor * rotor->unbalance_kgm *
                             square_of(WH_RIG_TWO_PI / turn_s) *
                             (WH_R(1.0) + WH_R(1.5) * (swing2 + twice2));
    go_on(&merge->mean_N, turn->mean_N, part);
    go_on(&merge->residual_N2, square_of(turn->residual_N), part);
    go_on(&merge->expected_N, expected, part);
    go_on(&merge->ripple_rad, angle->ripple_rad, part);
    const wh_real late_s = turn_s - merge->turn_s;
    merge->turn_s += part * late_s;
    merge->turn_s2 += late_s * (turn_s - merge->turn_s);
    go_on(&merge->at_pulse_N[0], turn->at_pulse_N[0], part);
    if (turn->second_seen) {
        merge->second_turns++;
        merge->at_pulse_N[1] +=
            (turn->at_pulse_N[1] - merge->at_pulse_N[1]) / (wh_real)merge->second_turns;
    }
}

void wh_merge_harmonic(wh_merge *merge, unsigned harmonic) {
    if (merge->turns > 0) {
        const wh_real power_N2 = wh_repeats_power_N2(&merge->repeats, merge->turns, harmonic);
        merge->repeats_N2 += power_N2;
        merge->third_N2 += harmonic == 3U ? power_N2 : WH_R(0.0);
    }
}

/* Returns the part of the phase's variance, rad^2, that jitter causes and scatter_N2 misses. */
static wh_real pulses_rad2(const wh_merge *merge, const wh_turn_angle *angle, wh_real jitter_s) {
    const wh_real jitter2 = square_of(jitter_s * WH_RIG_TWO_PI / merge->turn_s);
    const wh_real turns = (wh_real)merge->turns;
    /* The mean phase has the variance jitter2 / turns. scatter_N2 contains half of that variance. */
    const wh_real shared = WH_R(0.5) * jitter2 / turns;
    if (angle->ratios == 0) {
        return shared;
    }
    /* The three pulses of a quadrature ratio give the ratio the variance (1 + 9/16 + 1/16) jitter2. */
    const wh_real averaged =
        (wh_real)(angle->ratios < WH_TURN_ANGLE_PATIENCE ? angle->ratios : WH_TURN_ANGLE_PATIENCE);
    const wh_real follows = WH_ABS(angle->base_per_ratio);
    const wh_real ratio = follows * (WH_R(1.0) + WH_R(1.625) * follows) * jitter2 / averaged;
    return shared + ratio;
}

WH_INLINE void begin_mean(const wh_merge *merge, const wh_turn_angle *angle, wh_real tare_N,
                          wh_measured *measured) {
    *measured = (wh_measured){.turns = merge->turns,
                              .left_out = merge->left_out,
                              .outliers = merge->outliers,
                              .expected_N = merge->expected_N,
                              .inertia_kgm2 = angle->inertia_kgm2};
    if (merge->turns == 0) {
        return;
    }
    measured->speed_radps = WH_RIG_TWO_PI / merge->turn_s;
    measured->mean_N = merge->mean_N - tare_N;
    measured->at_pulse_N[0] = merge->at_pulse_N[0] - tare_N;
    measured->at_pulse_N[1] = merge->second_turns > 0 ? merge->at_pulse_N[1] - tare_N : WH_R(0.0);
    measured->residual_N = WH_SQRT(merge->residual_N2);
    if (angle->compensated && angle->whole_rad > WH_R(0.0)) {
        measured->uncompensated_part = WH_ABS(merge->ripple_rad) / angle->whole_rad;
    }
}

static wh_real t2_of(const wh_merge *merge) {
    const wh_real student = wh_student(merge->turns - 1U);
    return student * student;
}

/* Stores squared half-widths, N^2, in *measured. amplitude_half() and phase_half() replace these squares. */
WH_INLINE void scatter_of_mean(const wh_merge *merge, wh_real size2, wh_real t2,
                               wh_measured *measured) {
    const wh_real x = merge->in_phase_N;
    const wh_real y = -merge->quadrature_N;
    const wh_real *s = merge->scatter_N2;
    const wh_real both = WH_R(2.0) * x * y * s[1];
    const wh_real n = (wh_real)merge->turns;
    const wh_real factor = t2 / (n * (n - WH_R(1.0)) * size2);
    measured->amplitude_half_N = factor * (x * x * s[0] - both + y * y * s[2]);
    measured->phase_half_rad = factor * (y * y * s[0] + both + x * x * s[2]);
}

typedef struct parts_off {
    wh_real third;
    wh_real lag;
    wh_real quadrature;
    wh_real cut; /* effect of a motor that cannot brake enough */
} parts_off;

WH_INLINE parts_off off_of(const wh_rotor_config *rotor, const wh_merge *merge,
                           const wh_turn_angle *angle) {
    const wh_real swing = merge->ripple_rad;
    return (parts_off){
        .third = WH_R(0.125) * swing * swing * swing,
        .lag = WH_ABS(angle->base_per_lag) * rotor->damping_tolerance * angle->lag_rad,
        /* An error of the compensation's angle causes this ripple, rad. */
        .quadrature =
            angle->compensated ? rotor->compensation_tolerance_rad * angle->whole_rad : WH_R(0.0),
        .cut = angle->cut * angle->cut};
}

WH_INLINE void amplitude_half(const wh_result_config *config, const wh_rotor_config *rotor,
                              const wh_merge *merge, const wh_turn_angle *angle, wh_real size2,
                              const parts_off *by, wh_measured *measured) {
    const wh_real amplitude2 =
        square_of(floor_or(config->amplitude_floor, WH_UNCALIBRATED_PART)) +
        square_of(WH_R(1.5) * merge->ripple_rad * by->lag) + square_of(by->third) +
        square_of(WH_R(3.0) * by->quadrature * by->quadrature) + square_of(WH_R(0.01) * by->cut) +
        square_of(WH_R(0.5) * angle->twice_rad * rotor->yields_tolerance);
    measured->amplitude_half_N = WH_SQRT(measured->amplitude_half_N + amplitude2 * size2);
}

WH_INLINE void phase_half(const wh_result_config *config, const wh_merge *merge,
                          const wh_turn_angle *angle, wh_real size2, wh_real t2,
                          const parts_off *by, wh_measured *measured) {
    const wh_real turned = by->quadrature * angle->base_per_quadrature;
    const wh_real drift = WH_R(0.5) * (wh_real)(int32_t)(merge->last_ticks - merge->first_ticks) /
                          ((wh_real)merge->turns * merge->turn_s * (wh_real)WH_RIG_TICKS_PER_S);
    measured->phase_half_rad = WH_SQRT(
        measured->phase_half_rad / size2 + t2 * pulses_rad2(merge, angle, measured->jitter_s) +
        square_of(by->lag) + square_of(by->third) + square_of(turned) +
        square_of(WH_R(0.1) * by->cut) + square_of(drift) +
        square_of(floor_or(config->phase_floor_rad, WH_UNCALIBRATED_RAD)));
}

void wh_merge_mean_piece(const wh_result_config *config, const wh_rotor_config *rotor,
                         const wh_merge *merge, const wh_turn_angle *angle, wh_real tare_N,
                         wh_measured *measured, unsigned piece) {
    if (piece == 0) {
        begin_mean(merge, angle, tare_N, measured);
        measured->phase_rad = wh_polar_begin(merge->in_phase_N, -merge->quadrature_N);
        return;
    }
    if (merge->turns == 0) {
        measured->phase_rad = WH_R(0.0);
        return;
    }
    if (piece < 3U) {
        wh_polar_rounds(merge->in_phase_N, -merge->quadrature_N, WH_POLAR_ROUNDS / 2U,
                        &measured->amplitude_N, &measured->phase_rad);
        return;
    }
    const wh_real size2 = square_of(merge->in_phase_N) + square_of(merge->quadrature_N);
    if (piece == 3U && merge->jitters > 0) {
        measured->jitter_s = WH_SQRT(merge->jitter_s2 / (WH_R(6.0) * (wh_real)merge->jitters));
    }
    const bool has_halves = merge->turns >= 2U && size2 > WH_R(0.0);
    if (!has_halves) {
        return;
    }
    if (piece == 3U) {
        scatter_of_mean(merge, size2, t2_of(merge), measured);
        return;
    }
    const parts_off by = off_of(rotor, merge, angle);
    if (piece == 4U) {
        amplitude_half(config, rotor, merge, angle, size2, &by, measured);
    } else {
        phase_half(config, merge, angle, size2, t2_of(merge), &by, measured);
    }
}

/* Returns the error of merge->ripple_rad, in rad, estimated from merge->second_N[]. */
static wh_real swing_off(const wh_rotor_config *rotor, const wh_merge *merge,
                         const wh_turn_angle *angle, const wh_measured *measured) {
    if (!(angle->whole_rad > WH_R(0.0)) || !(measured->amplitude_N > WH_R(0.0))) {
        return WH_R(0.0);
    }
    const wh_wave wave =
        wh_wave_of(angle->lag_rad - rotor->gravity_rad + WH_R(2.0) * measured->phase_rad);
    const wh_real swing = WH_R(1.5) * merge->ripple_rad;
    const wh_real part = (WH_R(1.0) + merge->ripple_rad * swing) / measured->amplitude_N;
    const wh_real along = part * merge->second_N[0] - swing * wave.cosine;
    const wh_real across = part * merge->second_N[1] + swing * wave.sine;
    return WH_R(0.5) * WH_SQRT(along * along + across * across);
}

static wh_real repeats_limit_N(const wh_merge *merge, const wh_turn_angle *angle,
                               const wh_measured *measured) {
    const wh_real swing = WH_ABS(merge->ripple_rad);
    const wh_real samples = (wh_real)(merge->repeats.samples > 0 ? merge->repeats.samples : 1U);
    const wh_real turns = (wh_real)(merge->turns > 0 ? merge->turns : 1U);
    const wh_real part = REPEATS_LAG * angle->lag_rad * swing * swing +
                         REPEATS_ARROW * swing * measured->ripple_off_rad +
                         REPEATS_CUT * angle->cut + REPEATS_TWICE * angle->twice_rad +
                         REPEATS_CELL + REPEATS_STEP * square_of(WH_RIG_TWO_PI * turns / samples);
    /* variance that noise gives a harmonic's coefficient */
    const wh_real noise_N2 = merge->repeats.changes_N2 / (samples * samples);
    const wh_real jitter = REPEATS_JITTER * measured->jitter_s * measured->speed_radps;
    return WH_SQRT(REPEATS_NOISE * noise_N2 +
                   square_of(measured->expected_N) * (square_of(part) + square_of(jitter) / turns));
}

/* If angle->cut > 0, amplitude and phase may be off by their half-widths plus these (fraction of the force, rad). */
#define CUT_OFF WH_R(0.005)
#define CUT_TURNED_RAD WH_R(0.01)

static wh_real no_more(wh_real value, wh_real most) { return value < most ? value : most; }

static wh_why reason(const wh_result_config *config, const wh_rotor_config *rotor,
                     const wh_merge *merge, const wh_turn_angle *angle,
                     const wh_measured *measured) {
    const wh_real expected = measured->expected_N;
    const wh_real off = WH_ABS(measured->amplitude_N - expected);
    const wh_real half = measured->amplitude_half_N;
    const wh_real phase = WH_ABS(measured->phase_rad);
    const wh_real inertia = measured->inertia_kgm2 / rotor->inertia_kgm2;
    const wh_real heavier = inertia < WH_R(1.0) ? WH_R(1.0) / inertia : inertia;
    wh_real off_most = config->amplitude_off * expected;
    wh_real phase_most = config->phase_off_rad;
    if (angle->cut > WH_R(0.0)) {
        off_most = no_more(half + CUT_OFF * expected, off_most);
        phase_most = no_more(measured->phase_half_rad + CUT_TURNED_RAD, phase_most);
    }
    if (measured->turns < 3U) {
        return WH_WHY_FEW_TURNS;
    }
    if (phase > WH_R(0.5) * PI) {
        return WH_WHY_POLARITY;
    }
    /* the negated comparison also refuses NaN */
    if (!(off <= config->amplitude_wrong * expected)) {
        return WH_WHY_AMPLITUDE;
    }
    if (!(phase <= config->phase_wrong_rad)) {
        return WH_WHY_PHASE;
    }
    if (!(half <= WH_R(0.25) * measured->amplitude_N) ||
        !(measured->phase_half_rad <= WH_R(0.25))) {
        return WH_WHY_UNSURE;
    }
    if (off > off_most) {
        return WH_WHY_AMPLITUDE_OFF;
    }
    if (phase > phase_most) {
        return WH_WHY_PHASE_OFF;
    }
    if (measured->left_out * 3U > measured->turns) {
        return WH_WHY_LEFT_OUT;
    }
    if (measured->outliers * 100U > merge->samples) {
        return WH_WHY_OUTLIERS;
    }
    if (measured->residual_N > config->residual_large * expected) {
        return WH_WHY_RESIDUAL;
    }
    if (WH_ABS(merge->ripple_rad) > WH_R(0.0) &&
        (merge->second_turns == 0 || !(heavier <= WH_R(1.0) + config->inertia_off))) {
        return WH_WHY_ROTOR;
    }
    if (measured->uncompensated_part >= FED_LEFT_MOST) {
        return WH_WHY_FED;
    }
    if (WH_ABS(measured->mean_N) > config->mean_off * expected) {
        return WH_WHY_MEAN;
    }
    if (half > WH_R(0.05) * measured->amplitude_N) {
        return WH_WHY_WIDE;
    }
    /* seen_rad is phase_half_rad without the calibration's error, which hardly affects ripple_off_rad */
    const wh_real floor_rad = floor_or(config->phase_floor_rad, WH_UNCALIBRATED_RAD);
    const wh_real seen_rad2 = square_of(measured->phase_half_rad) - square_of(floor_rad);
    const wh_real seen_rad = seen_rad2 > WH_R(0.0) ? WH_SQRT(seen_rad2) : WH_R(0.0);
    if (measured->ripple_off_rad > seen_rad + SWING_OFF_RAD) {
        return WH_WHY_SWING;
    }
    if (measured->repeats_N > measured->repeats_limit_N) {
        return WH_WHY_REPEATS;
    }
    return WH_WHY_NONE;
}

void wh_merge_compare(const wh_rotor_config *rotor, const wh_merge *merge,
                      const wh_turn_angle *angle, wh_measured *measured) {
    const wh_real third_N2 = REPEATS_NOISE / THIRD_NOISE * merge->third_N2;
    if (merge->turns > 1U) {
        measured->scatter_radps = measured->speed_radps / merge->turn_s *
                                  WH_SQRT(merge->turn_s2 / (wh_real)(merge->turns - 1U));
    }
    measured->ripple_off_rad = swing_off(rotor, merge, angle, measured);
    measured->repeats_N = WH_SQRT(third_N2 > merge->repeats_N2 ? third_N2 : merge->repeats_N2);
    measured->repeats_limit_N = repeats_limit_N(merge, angle, measured);
}

void wh_merge_judge(const wh_result_config *config, const wh_rotor_config *rotor,
                    const wh_merge *merge, const wh_turn_angle *angle, wh_measured *measured) {
#define WH_WHY_QUALITY(name, its_quality, words) (uint8_t)(its_quality),
    static const uint8_t qualities[] = {WH_WHY_ROWS(WH_WHY_QUALITY)};
    measured->calibrated = wh_result_is_calibrated(config);
    measured->why = reason(config, rotor, merge, angle, measured);
    measured->quality = (wh_quality)qualities[measured->why];
}

#define ITEM(name, quality, words) WH_WORDS(words)

const char *wh_why_text(wh_why why) {
    static const char words[] WH_WORD_LIST = WH_WHY_ROWS(ITEM) WH_WORDS("unknown reason");
    return wh_words_item(words, why);
}

const char *wh_quality_text(wh_quality quality) {
    static const char words[] WH_WORD_LIST =
        WH_WORDS("good") WH_WORDS("doubtful") WH_WORDS("refused") WH_WORDS("unknown quality");
    return wh_words_item(words, quality);
}
