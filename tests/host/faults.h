/* faults.h: the campaign of faults against the rig's controller (`make faults`): what is drawn, how a run is judged, what
 * is told of them all. */
#ifndef TESTS_FAULTS_H
#define TESTS_FAULTS_H

#include "hal/frames/rig_frames.h"
#include "host/pil/fault.h"
#include "host/pil/lockstep.h"

/* --- the controller's words (faults_words.c) ---------------------------------------------------------------------------*/

/* Where faults begin, in order. */
typedef struct rig_stage {
    char when[32]; /* NOTE=VALUE */
    const char *word;
    double span_s; /* a healthy run is in it for so long, about */
} rig_stage;

/* What the firmware tells: told[HAL_NOTES], as hal/frames/rig_frames.h has them. */
#define NOTE_ONE(name, word, unit) +1
enum { HAL_NOTES = HAL_NOTE_ROWS(NOTE_ONE) };
#undef NOTE_ONE

enum { RIG_STAGES_MAX = 16 };
unsigned rig_stages(rig_stage *stage);
int rig_stage_of(const float *note); /* -1: none of them */
bool rig_is_tripped(const float *note);
bool rig_is_idle(const float *note);
bool rig_may_drive(const float *note);
const char *rig_tripped_when(void); /* NOTE=VALUE */
const char *rig_trip_word(int trip);
/* The shaft's limit. */
double rig_limit_rpm(void);
double rig_nominal_rpm(void);
/* The fastest that a drive which ignores the voltage may make of a run at target_rpm until it is off. */
double rig_caught_rpm(double target_rpm);

/* --- what is wished ----------------------------------------------------------------------------------------------------*/

typedef struct campaign {
    const char *plant;
    const char *firmware;
    const char *board;
    const char *step;
    const char *only; /* rows whose word is this; or NULL */
    const char *also; /* faults that every run has; or NULL */
    unsigned runs;
    unsigned first; /* the first run's number */
    uint32_t seed;
    int jobs;
} campaign;

/* Its firmware runs in an emulator, which counts instructions. */
bool campaign_is_emulated(const campaign *c);
/* It has an operator's dials. */
bool campaign_has_dials(const campaign *c);

/* --- what is drawn (faults_draw.c) -----------------------------------------------------------------------------------*/

/* A row of the matrix. */
enum { CAMPAIGN_ROWS_MAX = 64 };
unsigned campaign_rows(void);
const char *campaign_row_word(unsigned row);

typedef struct campaign_case {
    unsigned row;
    unsigned stage;
    uint32_t seed; /* of this run */
    double target_rpm;
    bool breaks;      /* there is a fault beside the noise, */
    bool from_start;  /* and from the start */
    bool drives;      /* the plant itself drives beyond what the controller asks for */
    bool calibration; /* only calibration can tell: a result that is off by it is no lie */
    bool runs_away;   /* the drive ignores the voltage */
    bool blind;       /* a sensor is dead */
    bool delays;      /* the controller, or what it says: its watchdog may cut */
    char words[400];  /* of --fault: the fault, and the noise that every run has */
} campaign_case;

/* Its fault is the only one. */
bool campaign_is_alone(const campaign_case *one);

/* There is a fault to draw: of the word that is asked for, for this firmware. */
bool campaign_has_any(const campaign *c);

/* Run i of the campaign. */
void campaign_draw(campaign_case *one, const campaign *c, unsigned i);

/* --- how a run is judged (faults_judge.c) --------------------------------------------------------------------------*/

/* Instructions of a control step, in bins of so many; the last is for all above. */
enum { STEP_BIN = 250, STEP_BINS = 9 };

typedef enum outcome {
    OUTCOME_TRIPPED,
    OUTCOME_GOOD,
    OUTCOME_DOUBTFUL,
    OUTCOME_REFUSED,
    OUTCOME_NONE, /* it ended without a result and without a trip */
    OUTCOME_HANG, /* silent, or after a minute neither over nor with the motor off */
    OUTCOMES
} outcome;

typedef struct run_checks {
    unsigned run;
    unsigned row;
    int stage; /* in which the fault began; -1: it never did, or was there from the start */
    bool happened;
    outcome outcome;
    int trip;
    bool runs_on;  /* ended with the enable on where the motor must not drive, or too fast */
    bool stays_on; /* so it was for a second, and turns that do not get slower showed a drive */
    bool
        untold; /* three turns, each faster than the last, with the motor off, and no trip in a second */
    bool overspeed;  /* caused by the controller */
    bool cut;        /* by the watchdog, though nothing was late or lost on its way */
    double turn_rpm; /* the fastest turn, */
    double peak_rpm; /* and instant */
    double
        lie; /* a good result is off by so much more than its interval and 1 %; as a share of the truth */
    bool
        lasting; /* a drive that is on ignores the voltage for longer than it may take to stop it */
    double target_rpm;
    double began_rpm;  /* the speed then */
    double off_s;      /* from then until the enable was off; -1: it was not */
    double caught_rpm; /* the fastest instant until then */
    bool halted;       /* stop was pressed, or the controller reset */
    double
        halted_s; /* so long after that nothing drove any more; -1: longer than it may, or again */
    bool
        forgets; /* a reset loses the trip that was latched, or the controller does not know of it */
    bool latched; /* it does not */
    double time_s;
    uint64_t overruns;
    uint32_t steps[STEP_BINS]; /* control steps by what they took; none where it is not counted */
    double most;               /* instructions of one, */
    double most_s;             /* then */
    double loop;               /* of all that is done between two waits: HAL, steps and printing, */
    double start;              /* and before the loop */
} verdict;

enum { JUDGE_TURNS = 64 };

/* The arms' first Fourier coefficients over a turn, of what they truly do to the mount. */
typedef struct true_turn {
    double cosine_N;
    double sine_N;
} true_turn;

typedef struct judge {
    const campaign_case *of;
    const fault_plan *plan;
    double *until_s;
    bool enabled;
    double enabled_s; /* since then */
    double
        ignored_s; /* the drive is on and ignores the voltage, since then; -1: it was not so far */
    double off_since_s; /* tripped and off; -1: it is not */
    double halted_s;    /* stop was pressed, or the controller reset for the first time */
    unsigned resets;    /* of the controller, of which it has spoken */
    const plant *plant;
    bound angle;
    bound rate;
    bound force;
    double per_count; /* instructions; 0: they are not counted */
    double ticks_per_s;
    int at_duty; /* in orders.output; -1: there is none */
    int at_enable;
    int at_note[HAL_NOTES];
    /* Of the turn that is under way: */
    double theta;
    double force_N;
    double begun_s;
    bool whole; /* it began at a turn's begin, */
    bool off;   /* and the motor must not drive since, */
    true_turn sum;
    double last_s;
    /* Of whole turns while the motor must not drive: */
    double rpm;         /* the last */
    unsigned on_turns;  /* since the enable is on all the time */
    unsigned rises;     /* turns running that were faster, */
    double rises_rpm;   /* than this, at first */
    double on_shown_s;  /* there is a drive, with the enable on, */
    double off_shown_s; /* or off; -1: no turn has shown it */
    true_turn turn[JUDGE_TURNS];
    unsigned turns;
    float told[HAL_NOTES];
    bool driven; /* by the last orders */
    bool has_result;
    bool began;
    double speed_rpm;
    verdict verdict;
} judge;

/* *until_s: when the run is let go; nothing more is to be seen some time after a trip, so then it is now. */
tap judge_tap(judge *j, const campaign_case *of, const fault_plan *plan, double *until_s);
/* When the run is over. */
void judge_end(judge *j, const lockstep_report *report);

/* --- what is told (faults_table.c) ---------------------------------------------------------------------------------*/

/* The words that repeat run i. */
void campaign_print_command(FILE *out, const campaign *c, unsigned i);
/* The matrix and the worst, in Markdown. Returns the exit status. */
int campaign_print(FILE *out, const campaign *c, const verdict *all, unsigned count);

#define CAMPAIGN_JITTER "60us"

#endif
