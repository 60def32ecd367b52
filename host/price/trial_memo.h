/* trial_memo.h: trials that were run before are not run again. */
#ifndef PRICE_TRIAL_MEMO_H
#define PRICE_TRIAL_MEMO_H

#include "trial.h"

typedef struct trial_known {
    char options[SETTING_TEXT];
    deviation_pace pace;
    trial_result result;
    double operations; /* that it evaluated */
} trial_known;

typedef struct trial_memo {
    trial_known *known; /* [count] */
    int count;
} trial_memo;

void trial_memo_free(trial_memo *m);
/* As trial_run(); t->operations grows as if it had been run anew. m NULL: it is. */
trial_result trial_memo_run(trial_memo *m, trials *t, const setting *s, deviation_pace pace);

#endif
