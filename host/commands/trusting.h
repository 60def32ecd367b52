/* trusting.h: what `whirl trust` and `whirl run` share: the scene's image for the run beside it, and what may be taken of
 * time. */
#ifndef COMMANDS_TRUSTING_H
#define COMMANDS_TRUSTING_H

#include "host/run/simulate.h"
#include "host/trust/horizon.h"
#include "load.h"

/* Operations that a second takes, about. */
#define TRUSTING_OPERATIONS_1S 2.4e8

/* What load() is to keep for trusting_plain(). */
load_keep trusting_keep(const image_settings *settings);
/* The image of twins_plain(), to be freed. NULL: it is the image itself. */
image *trusting_plain(const loaded *made);

/* What `whirl run` says of trust. */
typedef struct trusting {
    twins *twins; /* NULL: not known, */
    bool dear;    /* as it takes too long */
    horizon horizon;
} trusting;

/* Looks, where it takes less than a second, and sets where the plot's shade begins. Moves no bit of the run. */
trusting trusting_look(const image *im, const image *plain, simulation_settings *s);
/* The line below the summary. `doubted`: the run has been warned of, and that both agree is no reason to trust it. */
void trusting_say(const trusting *t, const simulation_settings *s, bool doubted);
/* The time until which a run is trusted, s. Below 0: it is not told. */
double trusting_until_s(const trusting *t, bool doubted);
void trusting_end(trusting *t);

#endif
