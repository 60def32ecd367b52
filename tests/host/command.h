/* command.h: a command of `whirl` run in a process of its own, and what it said. */
#ifndef TESTS_HOST_COMMAND_H
#define TESTS_HOST_COMMAND_H

#include <stddef.h>

#define SAID_SIZE 8192

typedef struct said {
    int status;          /* exit status; -1 when a signal ended it */
    char out[SAID_SIZE]; /* standard output, cut */
    char err[SAID_SIZE]; /* standard error, cut */
} said;

/* Runs `command` (command_run, ...) on the words, the last of which is followed by NULL. */
void command_say(int (*command)(int count, char **words), const char *const *words, said *what);

/* The exit status that `whirl run` and `whirl sweep` owe to their messages: 1 after a warning with a finding's name. */
int said_owes(const char *err);

/* A step as a warning writes it, "200us": s. */
double said_step_s(const char *word);
/* That of the first `--step` which a text names; 0 without one. */
double said_named_step_s(const char *text);

/* Text read bit by bit; each fails the test where it does not go on so, and returns what is behind it. Blanks may stand in
 * front. Words as they are; a number; what there is up to the next blank, in word[size]. */
const char *said_words(const char *text, const char *words);
const char *said_exactly(const char *text,
                         const char *words); /* no blanks but those of the words */
const char *said_number(const char *text, double *number);
const char *said_word(const char *text, char *word, size_t size);

/* The first `count` numbers of the next row of a column file, behind its head or the row that the last call has returned; NULL
 * behind the last one. */
const char *said_row(const char *text, int count, double *number);

/* From the first on what is said on standard error is kept, up to the second, which returns it: static. */
void errors_catch(void);
const char *errors_caught(void);

/* Writes a model's text into a file of its own, whose name it returns; static. Gone with model_drop(). */
const char *model_keep(const char *text);
void model_drop(void);
/* command_say() of a model's text, which is gone behind it. */
void command_say_model(int (*command)(int count, char **words), const char *text, said *what);

/* Numbers for generated cases: from `seed` on, evenly in [low, high), and a whole number in [0, count). */
typedef struct dice {
    unsigned long long state;
} dice;
dice dice_of(const char *suite, unsigned long seed); /* WHIRL_SEED changes it; printed */
double dice_between(dice *d, double low, double high);
unsigned dice_one_of(dice *d, unsigned count);

/* `usual`, or what the environment variable WHIRL_CASES says. */
unsigned dice_cases(unsigned usual);

/* `few` cases, for `make test`; where the environment variable WHIRL_FULL is not empty (make check), `all`. */
unsigned few_or_all(unsigned few, unsigned all);

/* The `usual` cases; where WHIRL_FEW is not empty (the sanitizers' gate), the `fewest` that are some of every class. */
unsigned usual_or(unsigned usual, unsigned fewest);

#endif
