/* dialogue.h: what a rig is asked before it is recorded: what its telemetry holds, then for it. */
#ifndef MONITOR_DIALOGUE_H
#define MONITOR_DIALOGUE_H

#include <stdbool.h>

enum { DIALOGUE_LINE = 48, DIALOGUE_REFUSAL = 160 };

/* So many are answered, and the rig is known to be there; was_off is known; telemetry of a time before has ended. */
enum { DIALOGUE_MET = 1, DIALOGUE_LISTED = 3, DIALOGUE_OFF = 4 };

/* All zeros but `rate`: nothing asked yet. */
typedef struct dialogue {
    int rate;  /* samples a second */
    int asked; /* the question that waits for its answer */
    bool done;
    bool rate_refused;
    bool was_off; /* telemetry was off: the rig is new, or another one */
    char refused
        [DIALOGUE_REFUSAL]; /* the first question that was not answered with OK, and what was; if any */
} dialogue;

/* The line that is to be sent now, with its end; NULL when all are answered. */
const char *dialogue_question(const dialogue *d, char line[DIALOGUE_LINE]);

/* A line that came. True when it was an answer, or the echo of a question: nobody else's. What was in the line before the
 * first question, and answers that come twice, since somebody has asked again, answer nothing: `asked` stays. */
bool dialogue_answer(dialogue *d, const char *line);

#endif
