/* rating.h: the rows of accuracy and cost at the end of a run (docs/price.md), and the step for `--error`. */
#ifndef CLI_RATING_H
#define CLI_RATING_H

#include "host/check/horizon.h"
#include "host/cli/load.h"
#include "host/study/cost.h"
#include "host/study/simulate.h"
#include "options.h"
#include "pricing_scene.h"

typedef struct rating_request {
    const char *target;
    const cost_board *board;
    const char *board_word;    /* NULL: the default board */
    const engine_kind *number; /* --number; NULL: the board's number type */
    const image_settings *settings;
    const overrides *changes;
    const mechanism *of;
    const scene *in;
    diags *errors;
    const image *image;
} rating_request;

/* Prints the rows, or why there are none. */
void rating_say(FILE *out, const rating_request *w, const simulation_trust *trust);

/* Opens the target like source_open(), and chooses the step for `--error X=0.1mm`. The caller frees *step and its
 * description *chosen. Returns an exit status. */
int rating_choose(const common_options *common, const char *target, const char *error,
                  source_model *from, char **step, char **chosen);

#endif
