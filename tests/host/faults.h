/* faults.h: the fault campaign against the rig's controller (`make faults`): random faults, a verdict on each run,
 * and a summary. */
#ifndef TESTS_FAULTS_H
#define TESTS_FAULTS_H

#include "hal/pil/rig_frames.h"
#include "host/pil/fault.h"
#include "host/pil/lockstep.h"

/* HAL_NOTES: the number of the firmware's notes. Their sequence is that of hal/pil/rig_frames.h. */
#define NOTE_ONE(name, word, unit) +1
enum { HAL_NOTES = HAL_NOTE_ROWS(NOTE_ONE) };
#undef NOTE_ONE

typedef struct campaign {
    const char *plant;
    const char *firmware;
    const char *board;
    const char *step;
    const char *only; /* only faults with this word; NULL: all faults */
    const char *also; /* faults that are added to every run; NULL: no such faults */
    unsigned runs;
    unsigned first;
    uint32_t seed;
    int jobs;
} campaign;

/* --- random cases --------------------------------------------------------------------------------- */

typedef struct campaign_case {
    unsigned row;
    unsigned stage;
    uint32_t seed; /* seed of this run */
    double target_rpm;
    bool breaks;     /* the run has a fault besides the noise */
    bool from_start; /* the fault acts from the start of the run */
    bool drives;     /* the plant drives harder than the controller orders */
    /* only a calibration could show the fault, so the judge accepts wrong results */
    bool calibration;
    bool runs_away; /* the drive ignores the ordered voltage */
    bool blind;     /* a sensor is dead */
    /* the fault delays the controller or its messages, so the watchdog may cut the power */
    bool delays;
    char words[400]; /* arguments of --fault: the fault and the noise of every run */
} campaign_case;

/* Does any fault of the campaign have the word `only`, with this firmware? */
bool campaign_has_any(const campaign *c);

void campaign_draw(campaign_case *one, const campaign *c, unsigned i);

/* --- how a run is judged -------------------------------------------------------------------------- */

/* Histogram of instructions per control step: bins of 250 instructions. The last bin counts all longer steps. */
enum { STEP_BIN = 250, STEP_BINS = 9 };

typedef enum outcome {
    OUTCOME_TRIPPED,
    OUTCOME_GOOD,
    OUTCOME_DOUBTFUL,
    OUTCOME_REFUSED,
    OUTCOME_NONE, /* the run ended without a result and without a trip */
    /* the firmware is silent, or it still drives the motor when the time of the run is over */
    OUTCOME_HANG,
    OUTCOMES
} outcome;

typedef struct run_checks {
    unsigned run;
    unsigned row;
    /* stage of the run when the fault began; -1: the fault never began, or was there from the start */
    int stage;
    bool happened;
    outcome outcome;
    int trip;
    /* at the end of the run the motor was driven above the speed limit, or the enable line was on although the motor
     * must not drive */
    bool runs_on;
    /* the motor must not drive, but turns showed a drive, and the enable line stayed on for another second */
    bool stays_on;
    /* turns with the motor off became faster, and there was no trip within a second */
    bool untold;
    bool overspeed;  /* over-speed although the plant drives no harder than ordered */
    bool cut;        /* the watchdog cut the power although nothing was late or lost */
    double turn_rpm; /* speed of the fastest turn */
    double peak_rpm; /* greatest instantaneous speed */
    /* error of the worst result of good quality, beyond the result's own interval and another 1 %; an error of the
     * amplitude is relative to the true one, an error of the phase is in rad */
    double lie;
    /* the drive ignored the voltage for at least LASTING_S, and this was the only fault */
    bool lasting;
    double target_rpm;
    double began_rpm; /* speed when the fault began */
    /* time from the fault's begin until the enable line was off; -1: the line stayed on */
    double off_s;
    double caught_rpm; /* greatest speed until the enable line was off */
    bool halted;       /* stop was pressed, or the controller was reset */
    /* time from the stop or reset until the drive ended; -1: the drive ended too late or started again */
    double halted_s;
    bool forgets; /* after a reset the controller does not report the latched trip */
    bool latched;
    double time_s;
    uint64_t overruns;
    uint32_t steps[STEP_BINS]; /* histogram of instructions per control step; zero if not counted */
    double most;               /* largest number of instructions in a control step */
    double most_s;             /* time at which the longest step was reported */
    /* largest number of instructions from one wait to the next: HAL, control step and printing */
    double loop;
    double start; /* number of instructions before the control loop */
} verdict;

enum { JUDGE_TURNS = 64 };

/* First Fourier coefficients, over one turn, of the true force of the arms on the mount. */
typedef struct true_turn {
    double cosine_N;
    double sine_N;
} true_turn;

typedef struct judge {
    const campaign_case *of;
    const fault_plan *plan;
    double *until_s;
    bool enabled;
    double enabled_s;   /* time at which the enable was last switched on */
    double ignored_s;   /* time since which the drive has ignored the voltage; -1: never */
    double off_since_s; /* time at which the rig tripped and the motor was off; -1: no trip */
    double halted_s;    /* time of the stop or of the first reset */
    unsigned resets;    /* resets that the controller reported */
    const plant *plant;
    bound angle;
    bound rate;
    bound force;
    double per_count; /* instructions per count of the firmware's step timer; 0: not counted */
    double ticks_per_s;
    int at_duty; /* index of the duty in orders.output; -1: no such output */
    int at_enable;
    int at_note[HAL_NOTES];
    /* The turn in progress: */
    double theta;
    double force_N;
    double begun_s;
    bool whole; /* the judge has seen this turn from its begin */
    bool off;   /* the motor has not been allowed to drive in this turn */
    true_turn sum;
    double last_s;
    /* Complete turns during which the motor must not drive: */
    double rpm;        /* speed of the last complete turn */
    unsigned on_turns; /* number of successive turns with the enable line on */
    /* number of successive turns of which each was faster than the one before */
    unsigned rises;
    double rises_rpm; /* speed of the turn before the first faster one */
    /* time at which the turns proved that the motor is driven, with the enable line on; -1: never */
    double on_shown_s;
    /* the same with the enable line off */
    double off_shown_s;
    true_turn turn[JUDGE_TURNS];
    unsigned turns;
    float told[HAL_NOTES];
    bool driven; /* the firmware's last orders drive the motor */
    bool has_result;
    bool began;
    double speed_rpm;
    verdict verdict;
} judge;

/* *until_s is the end of the run. Some time after a trip nothing more can happen: then the judge sets *until_s to
 * the present time and so ends the run. */
tap judge_tap(judge *j, const campaign_case *of, const fault_plan *plan, double *until_s);
void judge_end(judge *j, const lockstep_report *report);

/* --- summary --------------------------------------------------------------------------------------- */

/* Prints the outcomes by fault and state, and the worst runs, in Markdown. Returns the exit status. */
int campaign_print(FILE *out, const campaign *c, const verdict *all, unsigned count);

#define CAMPAIGN_JITTER "60us"

#endif
