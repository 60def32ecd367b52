/* faults.h: the fault campaign against the rig's controller (`make faults`): random faults, the verdict on each run,
 * the summary. */
#ifndef TESTS_FAULTS_H
#define TESTS_FAULTS_H

#include "hal/frames/rig_frames.h"
#include "host/pil/fault.h"
#include "host/pil/lockstep.h"

/* The firmware's notes in the order of hal/frames/rig_frames.h: HAL_NOTES values. */
#define NOTE_ONE(name, word, unit) +1
enum { HAL_NOTES = HAL_NOTE_ROWS(NOTE_ONE) };
#undef NOTE_ONE

typedef struct campaign {
    const char *plant;
    const char *firmware;
    const char *board;
    const char *step;
    const char *only; /* only faults with this word; or NULL */
    const char *also; /* faults that are added to every run; or NULL */
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
    bool breaks;     /* there is a fault besides the noise */
    bool from_start; /* the fault acts from the start */
    bool drives;     /* the plant drives more than the controller asks for */
    /* only calibration can show the fault: a wrong result within this size is accepted */
    bool calibration;
    bool runs_away; /* the drive ignores the voltage */
    bool blind;     /* a sensor is dead */
    /* the fault delays the controller or its messages, so the watchdog may cut the power */
    bool delays;
    char words[400]; /* arguments of --fault: the fault and the noise of every run */
} campaign_case;

/* Does the campaign have any fault with the requested word, for this firmware? */
bool campaign_has_any(const campaign *c);

void campaign_draw(campaign_case *one, const campaign *c, unsigned i);

/* --- how a run is judged -------------------------------------------------------------------------- */

/* Bins of this many instructions per control step; the last collects all larger counts. */
enum { STEP_BIN = 250, STEP_BINS = 9 };

typedef enum outcome {
    OUTCOME_TRIPPED,
    OUTCOME_GOOD,
    OUTCOME_DOUBTFUL,
    OUTCOME_REFUSED,
    OUTCOME_NONE, /* the run ended without result and without trip */
    /* the firmware is silent, or for a minute neither ends the run nor switches the motor off */
    OUTCOME_HANG,
    OUTCOMES
} outcome;

typedef struct run_checks {
    unsigned run;
    unsigned row;
    /* stage at the begin of the fault; -1: the fault never began, or was there from the start */
    int stage;
    bool happened;
    outcome outcome;
    int trip;
    /* the run ended with the enable on, although the motor must not drive or is too fast */
    bool runs_on;
    /* the enable stayed on for a second, although turns that did not slow down showed a drive */
    bool stays_on;
    /* no trip within a second of three turns, each faster than the last, with the motor off */
    bool untold;
    bool overspeed;  /* the over-speed was caused by the controller */
    bool cut;        /* the watchdog cut the power, although nothing was late or lost */
    double turn_rpm; /* the fastest turn */
    double peak_rpm; /* the greatest instantaneous speed */
    /* how far a result of good quality is outside its interval plus 1 %, relative to the true value */
    double lie;
    bool lasting; /* the drive ignored the voltage for longer than stopping it may take */
    double target_rpm;
    double began_rpm;  /* speed at the begin of the fault */
    double off_s;      /* time from the fault's begin until the enable was off; -1: it stayed on */
    double caught_rpm; /* the greatest speed between the fault's begin and the enable's end */
    bool halted;       /* stop was pressed or the controller reset */
    /* time from the stop or reset until the drive ended; -1: it took too long, or drove again */
    double halted_s;
    bool forgets; /* after a reset the controller does not report the latched trip */
    bool latched;
    double time_s;
    uint64_t overruns;
    uint32_t steps[STEP_BINS]; /* histogram of control steps; empty if not counted */
    double most;               /* largest number of instructions of a step */
    double most_s;             /* time of that step, s */
    double loop;               /* largest count between two waits: HAL, steps and printing */
    double start;              /* instructions before the loop */
} verdict;

enum { JUDGE_TURNS = 64 };

/* The first Fourier coefficients over a turn of the arms' true force on the mount. */
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
    double ignored_s;   /* time from which the drive ignored the voltage; -1: it never did */
    double off_since_s; /* time at which the rig tripped with the motor off; -1: no trip */
    double halted_s;    /* time of the stop or the first reset */
    unsigned resets;    /* resets that the controller reported */
    const plant *plant;
    bound angle;
    bound rate;
    bound force;
    double per_count; /* instructions per count; 0: not counted */
    double ticks_per_s;
    int at_duty; /* index of the duty in orders.output; -1: there is none */
    int at_enable;
    int at_note[HAL_NOTES];
    /* The current turn: */
    double theta;
    double force_N;
    double begun_s;
    bool whole; /* the turn was observed from its begin */
    bool off;   /* the motor must not drive during the whole turn */
    true_turn sum;
    double last_s;
    /* Complete turns while the motor must not drive: */
    double rpm;         /* of the last turn */
    unsigned on_turns;  /* number of turns with the enable on throughout */
    unsigned rises;     /* number of successive turns, each faster than the last */
    double rises_rpm;   /* speed of the first of them */
    double on_shown_s;  /* time at which turns showed a drive with the enable on; -1: not shown */
    double off_shown_s; /* the same with the enable off */
    true_turn turn[JUDGE_TURNS];
    unsigned turns;
    float told[HAL_NOTES];
    bool driven; /* the motor drives, according to the last orders */
    bool has_result;
    bool began;
    double speed_rpm;
    verdict verdict;
} judge;

/* *until_s is the end of the run. Some time after a trip nothing more can happen; then *until_s is set to the present
 * time, which ends the run. */
tap judge_tap(judge *j, const campaign_case *of, const fault_plan *plan, double *until_s);
void judge_end(judge *j, const lockstep_report *report);

/* --- summary --------------------------------------------------------------------------------------- */

/* Prints the matrix and the worst runs in Markdown. Returns the exit status. */
int campaign_print(FILE *out, const campaign *c, const verdict *all, unsigned count);

#define CAMPAIGN_JITTER "60us"

#endif
