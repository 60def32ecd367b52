/* dialogue.c: see dialogue.h. */
#include "dialogue.h"

#include <stdio.h>
#include <string.h>

/* The rate behind what describes its frames, the tape last. */
static const char *const questions[] = {
    "talk off",         "tel list",        "tel off",           "tel fmt frames", "tel schema run",
    "tel schema event", "tel schema ring", "tel schema states", "tel rate",       "tel tape on"};
enum { QUESTIONS = sizeof questions / sizeof questions[0], LIST = 1, RATE = QUESTIONS - 2 };

static int count_of(const dialogue *d) { return d->tapes ? QUESTIONS : QUESTIONS - 1; }

const char *dialogue_question(const dialogue *d, char line[DIALOGUE_LINE]) {
    if (d->asked >= count_of(d)) {
        return NULL;
    }
    if (d->asked == RATE) {
        snprintf(line, DIALOGUE_LINE, "%s %d\n", questions[RATE], d->rate);
    } else {
        snprintf(line, DIALOGUE_LINE, "%s\n", questions[d->asked]);
    }
    return line;
}

bool dialogue_answer(dialogue *d, const char *line) {
    char question[DIALOGUE_LINE];
    if (d->done || dialogue_question(d, question) == NULL) {
        return false;
    }
    question[strcspn(question, "\n")] = '\0';
    if (strcmp(line, question) == 0) {
        return true; /* its echo */
    }
    const bool good = strncmp(line, "OK", 2) == 0;
    if (!good && strncmp(line, "ERR ", 4) != 0) {
        return false;
    }
    if (!good && d->refused[0] == '\0') {
        snprintf(d->refused, sizeof d->refused, "%s", question);
    }
    if (d->asked == LIST) {
        d->was_off = strstr(line, " rate=0 ") != NULL;
    }
    d->asked++;
    d->done = d->asked == count_of(d);
    return true;
}
