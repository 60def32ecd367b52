/* again.h: a run once more, with other settings, watched and booked as the run itself was: to see what it would have been.
 * Nothing of it is told. */
#ifndef RUN_AGAIN_H
#define RUN_AGAIN_H

#include <signal.h>

#include "belief.h"
#include "watch.h"

/* What an evaluation takes beside its operations, in operations. */
#define AGAIN_BESIDE 40.0

typedef struct again {
    image image; /* whose lists are those of the image it was made of */
    const engine_kind *kind;
    void *run;
    books *books; /* NULL where there are none */
    watch *watch;
    belief balance;
    uint64_t steps; /* taken, or begun */
    bool stopped;   /* from outside */
    bool done;      /* all of them */
} again;

/* What a step takes, watching and books included, in operations. */
double again_operations_a_step(const image *im);

/* `stop` may be NULL. Points into itself: it stays where it is. The watch is not ended. */
void again_run(again *a, const image *im, const engine_kind *kind,
               const volatile sig_atomic_t *stop);
void again_forget(again *a);

#endif
