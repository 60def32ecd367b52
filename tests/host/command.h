/* command.h: a `whirl` command in a process of its own, with its output. */
#ifndef TESTS_HOST_COMMAND_H
#define TESTS_HOST_COMMAND_H

#include "test.h"

#define SAID_SIZE 8192

typedef struct said {
    int status;          /* exit status; -1 after a signal */
    char out[SAID_SIZE]; /* standard output, truncated */
    char err[SAID_SIZE]; /* standard error, truncated */
} said;

/* Runs `command` (command_run, ...) on the words, which end with NULL. */
void command_say(int (*command)(int count, char **words), const char *const *words, said *what);

/* The exit status that `whirl run` or `whirl sweep` must have: 1 if a message warns of a finding, else 0. */
int said_owes(const char *err);

/* Converts a step as a warning writes it, such as "200us", to seconds. */
double said_step_s(const char *word);
/* The step of the first `--step` in a text, in s; 0 if there is no `--step`. */
double said_named_step_s(const char *text);

/* Readers of a text: each fails the test on a mismatch and returns the rest of the text. Leading blanks are skipped.
 * They read given words, a number, or up to the next blank into word[size]. */
const char *said_words(const char *text, const char *words);
const char *said_exactly(const char *text, const char *words); /* without skipping blanks */
const char *said_number(const char *text, double *number);
const char *said_word(const char *text, char *word, size_t size);

/* Reads the first `count` numbers of the next row of a column file. For the first row, `text` is the file with its
 * header; then it is the previous call's result. Returns NULL after the last row. */
const char *said_row(const char *text, int count, double *number);

/* Captures standard error from the first call until the second, which returns it (static). */
void errors_catch(void);
const char *errors_caught(void);

/* Writes a model's text to a temporary file and returns its name (static). model_drop() deletes it. */
const char *model_keep(const char *text);
void model_drop(void);
/* Runs command_say() on a model's text in a temporary file. */
void command_say_model(int (*command)(int count, char **words), const char *text, said *what);

/* Random numbers: uniform in [low, high), and integers in [0, count). */
typedef struct dice {
    unsigned long long state;
} dice;
dice dice_of(const char *suite, unsigned long seed); /* prints its seed; WHIRL_SEED changes it */
double dice_between(dice *d, double low, double high);
unsigned dice_one_of(dice *d, unsigned count);

/* The value of the environment variable WHIRL_CASES; `usual` if it is not set. */
unsigned dice_cases(unsigned usual);

/* `few` cases for `make test`; `all` when WHIRL_FULL is not empty (make check). */
unsigned few_or_all(unsigned few, unsigned all);

/* `usual` cases; `fewest`, with some of each class, when WHIRL_FEW is not empty (the sanitizers' gate). */
unsigned usual_or(unsigned usual, unsigned fewest);

#endif
