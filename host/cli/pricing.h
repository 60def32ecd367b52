/* pricing.h: the common part of `whirl price` and `whirl choose`: options, scene and references. */
#ifndef CLI_PRICING_H
#define CLI_PRICING_H

#include "host/cli/load.h"
#include "host/study/price_table.h"
#include "options.h"
#include "pricing_scene.h"

enum { PRICING_PRICE = 1, PRICING_CHOOSE = 2, PRICING_BOTH = 3 };

/* X(id, commands, word, value or NULL, text) */
#define PRICING_OPTION_ROWS(X) \
    X(PRICING_BOARD, BOTH, "--board", "B", \
      "the board of the costs: an emulated board of docs/boards.md, or host (default: " \
      "mps2-an386, a Cortex-M4F, also for an STM32F405)") \
    X(PRICING_OF, BOTH, "--of", "X", \
      "the error of one output, coordinate or rate, in its declared unit (default: the " \
      "worst coordinate or rate, as a part of its largest value)") \
    X(PRICING_ERROR, BOTH, "--error", "0.1mm", \
      "the allowed error: with --of in its unit, else a fraction of the largest value. X=0.1mm " \
      "includes --of X. A bare number is refused if the declared unit is not SI.") \
    X(PRICING_HORIZON, BOTH, "--horizon", "T", \
      "compare errors up to this time (default: the scene's end). In a chaotic motion Whirl " \
      "uses an earlier time, and the output says so.") \
    X(PRICING_VARY, BOTH, "--vary", "RANGE", \
      "use the worst error and cost over several values of a parameter, an input or a start " \
      "value. " \
      "duty=0.2..0.8 takes three values, both ends included; duty=0.2..0.8:5 takes five. " \
      "Repeatable: all combinations, at most 64. The scene's own values are always " \
      "included.") \
    X(PRICING_METHOD, BOTH, "--method", "M,...", \
      "try these methods instead of rk4,nystroem3,nystroem4,nystroem5; all: every method") \
    X(PRICING_EFFORT, BOTH, "--effort", "1e9", \
      "operations that all trials may evaluate: 1e9 take about 5 s. The table leaves " \
      "out steps that need more, and says how many.") \
    X(PRICING_ALL, PRICE, "--all", NULL, "every row") \
    X(PRICING_CSV, PRICE, "--csv", "FILE", \
      "every row, with its command lines; - is standard output (the table then goes to " \
      "standard error)") \
    X(PRICING_JSON, BOTH, "--json", NULL, \
      "one JSON object on standard output instead of words (docs/warnings.md)") \
    X(PRICING_RATE, CHOOSE, "--rate", "500Hz", \
      "the firmware's control rate: a whole number of steps per period (default: any step)") \
    X(PRICING_CLOCK, CHOOSE, "--clock", "16MHz", \
      "the processor's clock: a period's longest steps must fit into the period " \
      "(default: the board's own, if it is one chip)") \
    X(PRICING_FLASH, CHOOSE, "--flash", "32KB", \
      "the available flash; K, KB and KiB are 1024 bytes (default: the board's, if it is " \
      "one chip)") \
    X(PRICING_RAM, CHOOSE, "--ram", "2KB", \
      "the available RAM for data and stack, in the same units") \
    X(PRICING_PREDICT, CHOOSE, "--predict", NULL, \
      "predict costs instead of counting, which saves a few seconds; not for scenes with " \
      "contacts") \
    X(PRICING_MEASURE, BOTH, "--measure", NULL, \
      "count instructions, or fail with exit status 2. Needs Whirl's source tree and the board's " \
      "compiler and emulator. `whirl price` counts the rows of the front, which takes minutes.") \
    X(PRICING_QUIET, BOTH, "--quiet", NULL, "no progress; `whirl price` prints no table")
#define PRICING_OPTION_ID(id, who, word, value, text) id,
typedef enum pricing_option {
    PRICING_OPTION_ROWS(PRICING_OPTION_ID) PRICING_OPTIONS
} pricing_option;
#undef PRICING_OPTION_ID

enum { PRICING_GROUPS = OPTIONS_CHANGE };

typedef struct pricing {
    const char *command; /* "price" */
    common_options common;
    const char *typed;                  /* the target as typed */
    const char *value[PRICING_OPTIONS]; /* as typed, or NULL; `vary` has the values of --vary */
    const char **vary;                  /* [number of command-line words] */
    int vary_count;
    bool balance; /* keep a ledger if the run has contacts */

    source_model from;
    const mechanism *of;
    const scene *in;
    overrides changes;
    grid grid;
    pricing_scene *scene;
    const cost_board *board;
    const char *quantity; /* named by --of or --error X=0.1mm; NULL: the worst coordinate or rate */
    char *named;          /* the name in --error, owned */
    double error_si;
    double until_s; /* --horizon, or without it the end of the run */
    double effort;  /* limit of --effort: operations of all trials together */
    bool method[WH_METHODS];
    char *words;  /* changes of the scene, as typed */
    char *target; /* the target, quoted for a shell */
    trials trial;
} pricing;

/* To be freed with pricing_close(). */
pricing pricing_defaults(const char *command, int word_count);
/* Reads the options and the scene. Returns an exit status; call pricing_close() in any case. */
int pricing_open(pricing *p);
void pricing_close(pricing *p);
/* The board of --board. Returns NULL (reported) if it is unknown or has no prices. */
const cost_board *pricing_board(const char *command, const char *value);
/* Reads a positive *value, in SI. If `name` is NULL, *value has the dimension `wanted`. Otherwise *value has the
 * dimension of the output, coordinate or rate `name`. Returns false after an error (reported). */
bool pricing_quantity(const char *command, const mechanism *of, const char *name, const char *what,
                      const char *text, dimension wanted, double *value);
/* Computes the references of p->trial, with records at intervals of `spacing`, in s. Returns an exit status. */
int pricing_begin(pricing *p, whole_ratio spacing);
/* Least number of records of `whirl price` until the horizon. The most is 2.5 * PRICING_RECORDS. */
#define PRICING_RECORDS 1000.0
/* The interval between records: 1, 2 or 5 times a power of ten, in s. It gives `count` to 2.5 * `count` records. */
whole_ratio pricing_spacing(double until_s, double count);

#endif
