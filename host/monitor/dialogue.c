/* dialogue.c: see dialogue.h. */
#include "dialogue.h"

#include <stdio.h>
#include <string.h>

/* The rate behind what describes its frames. The first has an answer that nothing else is: until it comes,
 * what is heard may have been said to somebody before. */
static const struct {
    const char *words;
    const char *answer; /* how it begins */
} questions[] = {{"id", "OK program="},
                 {"talk off", "OK"},
                 {"tel list", "OK rate="},
                 {"tel off", "OK"},
                 {"tel fmt frames", "OK fmt="},
                 {"tel schema run", "OK channel=0"},
                 {"tel schema event", "OK channel=1"},
                 {"tel schema ring", "OK channel=2"},
                 {"tel schema states", "OK 0="},
                 {"tel rate", "OK rate="}};
enum { QUESTIONS = sizeof questions / sizeof questions[0], LIST = 2, RATE = QUESTIONS - 1 };

const char *dialogue_question(const dialogue *d, char line[DIALOGUE_LINE]) {
    if (d->asked >= (int)QUESTIONS) {
        return NULL;
    }
    if (d->asked == RATE) {
        snprintf(line, DIALOGUE_LINE, "%s %d\n", questions[RATE].words, d->rate);
    } else {
        snprintf(line, DIALOGUE_LINE, "%s\n", questions[d->asked].words);
    }
    return line;
}

/* Those that are OK alone are nothing else. */
static bool begins(const char *line, const char *answer) {
    return strcmp(answer, "OK") == 0 ? strcmp(line, answer) == 0
                                     : strncmp(line, answer, strlen(answer)) == 0;
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
    const bool met = d->asked >= DIALOGUE_MET;
    const char *from = met ? line : strstr(line, questions[0].answer); /* behind half a frame */
    const bool good = from != NULL && begins(from, questions[d->asked].answer);
    const bool refuses = met && strncmp(line, "ERR ", 4) == 0;
    if (!good && !refuses) {
        return strncmp(line, "OK", 2) == 0 || strncmp(line, "ERR ", 4) == 0;
    }
    if (refuses && d->refused[0] == '\0') {
        snprintf(d->refused, sizeof d->refused, "%s: %s", question, line);
    }
    d->rate_refused = d->rate_refused || (refuses && d->asked == RATE);
    if (d->asked == LIST) {
        d->was_off = strstr(line, " rate=0 ") != NULL;
    }
    d->asked++;
    d->done = d->asked == (int)QUESTIONS;
    return true;
}
