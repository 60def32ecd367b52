/* dialogue.h: what a rig is asked before it is recorded: what its telemetry holds, then for it. */
#ifndef MONITOR_DIALOGUE_H
#define MONITOR_DIALOGUE_H

#include <stdbool.h>

enum { DIALOGUE_LINE = 48 };

/* So many are answered, and was_off is known. */
enum { DIALOGUE_LISTED = 2 };

/* All zeros but `rate` and `tapes`: nothing asked yet. */
typedef struct dialogue {
    int rate;   /* samples a second */
    bool tapes; /* a tape is wanted */
    int asked;  /* the question that waits for its answer */
    bool done;
    bool was_off;                /* telemetry was off: the rig is new, or another one */
    char refused[DIALOGUE_LINE]; /* the question that was not answered with OK, if any */
} dialogue;

/* The line that is to be sent now, with its end; NULL when all are answered. */
const char *dialogue_question(const dialogue *d, char line[DIALOGUE_LINE]);

/* A line that came. True when it was an answer, or the echo of a question: nobody else's. */
bool dialogue_answer(dialogue *d, const char *line);

#endif
