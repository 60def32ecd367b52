/* measure.h: the measurement of a run: the lock-in's turns that lie entirely within the record, merged into one result.
 * The work for a turn is divided into pieces, one per control step. */
#ifndef WH_RIG_MEASURE_H
#define WH_RIG_MEASURE_H

#include "core/real.h"
#include "lockin.h"
#include "pulses.h"
#include "result.h"

WH_C_BEGIN

/* === the tare ================================================================================ */
/* The load cell's reading at rest, from noisy samples, and a check that the rig was at rest.
 *
 * Motion is slow: drift, a rotor that swings (1 to 3 Hz), a vibrating frame (up to some 10 Hz). Mains hum is fast. So
 * the check uses means of 40 samples with triangular weights. A new mean begins every 20 samples. At 2 ms per sample,
 * the gain of a mean is at most 1.6 % from 45 to 65 Hz, 0 at 50 Hz, and 87 % at 5 Hz. White noise of variance s^2 gives
 * the means the variance s^2/30. s^2 is estimated as half the mean square of the differences of successive samples (von
 * Neumann, Annals of Mathematical Statistics 12 (1941) 367). The limit on the variance of the means is 4 s^2/30 +
 * still_N^2. Noise alone exceeds 4 s^2/30 in less than one of 10,000 tares of eleven means. */

typedef struct wh_tare_config {
    uint32_t samples; /* at least 4 WH_TARE_BLOCK */
    wh_real still_N;  /* largest standard deviation that slow motion may add to the means */
    wh_real most_N;   /* largest standard error of the mean */
} wh_tare_config;

#define WH_TARE_BLOCK 20U /* samples */

typedef struct wh_tare {
    uint32_t count;
    wh_real mean_N;
    wh_real square_N2;  /* sum of squared deviations from the mean */
    wh_real changes_N2; /* sum of squared differences of successive samples */
    wh_real last_N;
    wh_real rises_N;  /* sum of the present block's samples, with weights that rise from 0 to 1 */
    wh_real falls_N;  /* the same sum, with weights that fall from 1 to 0 */
    wh_real before_N; /* rises_N of the previous block */
    uint32_t means;   /* number of triangular means */
    wh_real slow_N;   /* mean of the triangular means */
    wh_real slow_N2;  /* sum of their squared deviations from slow_N */
} wh_tare;

/* Add a sample to the tare. A new tare is all zeros. */
void wh_tare_add(wh_tare *tare, wh_real force_N);

/* Returns the standard error of the mean; 0 with fewer than two samples. */
wh_real wh_tare_error_N(const wh_tare *tare);

/* True if the samples show only noise and hum about one force, and the mean's standard error is at most most_N. */
bool wh_tare_is_still(const wh_tare_config *config, const wh_tare *tare);

/* === the measurement ========================================================================= */

typedef struct wh_measure_config {
    wh_rotor_config rotor;
    wh_cell_config cell;
    wh_tare_config tare;
    wh_result_config result;
    wh_real record_s;     /* whole turns within this time are measured */
    wh_real record_turns; /* least number of turns, even if they take longer than record_s */
} wh_measure_config;

typedef struct wh_rig_result {
    wh_measured force;    /* the load's once-per-turn component (result.h) */
    wh_real tare_N;       /* the cell's reading at rest */
    wh_real tare_error_N; /* standard error of tare_N */
    wh_real low_N;        /* lowest and highest load of the record, minus the tare */
    wh_real high_N;
    wh_real volts; /* the motor's voltage at the record's end */
    uint32_t lost; /* number of lost pulses */
    uint32_t rejected;
} wh_rig_result;

typedef struct wh_measure {
    bool records;
    bool adds;            /* lockin.turn must still be added to `merge` */
    bool peaks;           /* low_N and high_N are valid */
    bool ends;            /* the record's last turn is finished */
    uint8_t due;          /* remaining pieces of work, for the last turn or the record's end */
    uint32_t begin_ticks; /* time at which the record began */
    wh_real record_s;
    uint32_t skipped_before; /* skipped turns before the record began */
    wh_tare tare;
    wh_merge merge;       /* the turns of the record so far */
    wh_rig_result result; /* renewed after each turn of the record */
    wh_lockin lockin;     /* lockin.turn is the last turn's load */
} wh_measure;

/* Begin a run and drop the old tare. Before the first run, *measure is all zeros. */
void wh_measure_begin(const wh_measure_config *config, wh_measure *measure);

/* Process a confirmed pulse, in the order of time. */
void wh_measure_pulse(wh_measure *measure, const wh_index_pulse *index);

/* Take a load sample: for the tare if at_rest, otherwise for the measurement. */
void wh_measure_load(wh_measure *measure, const wh_load *load, bool at_rest);

/* Call this once per control step. The call does one piece of the work. Each sample or pulse is summed in two parts; a
 * call sums at most `halves` parts. Below WH_LOCKIN_HALVES_AT_ONCE, a call does no other work. */
void wh_measure_work(const wh_measure_config *config, wh_measure *measure, unsigned halves);

/* Begin a record now, at a speed > 0; drop an earlier record. */
void wh_measure_record(const wh_measure_config *config, wh_measure *measure, wh_real speed_radps,
                       uint32_t now_ticks);

bool wh_measure_lasts(const wh_measure *measure, uint32_t ticks);

/* Call this in each control step after the record's time until it returns true. Then the record's last turn is
 * finished, and all turns are merged. If no turn was usable, result.force.turns is 0. */
bool wh_measure_end(wh_measure *measure, uint32_t now_ticks);

WH_C_END

#endif
