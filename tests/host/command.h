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

/* Runs `command`, such as command_run(), with the arguments `words`, which end with NULL. *what: exit status and
 * output. */
void command_say(int (*command)(int count, char **words), const char *const *words, said *what);
/* command_say() with the words as arguments of the macro. The first NULL ends the words. */
#define COMMAND_SAY(command, what, ...) \
    command_say(command, (const char *const[]){__VA_ARGS__, NULL}, what)

/* The exit status that `whirl run` or `whirl sweep` must have: 1 if a message warns of a finding, else 0. */
int said_owes(const char *err);

/* Converts a step from a warning, such as "200us", to seconds. */
double said_step_s(const char *word);
/* The step of the first `--step` in a text, in s; 0 if there is no `--step`. */
double said_named_step_s(const char *text);

/* Functions that read a text. Each skips leading blanks, fails the test on a mismatch and returns the rest of the
 * text. said_words() expects the given words, said_number() a number. said_word() copies the text up to the next
 * blank to word[size]. */
const char *said_words(const char *text, const char *words);
const char *said_exactly(const char *text,
                         const char *words); /* said_words(), but skips no blanks */
const char *said_number(const char *text, double *number);
const char *said_word(const char *text, char *word, size_t size);

/* Reads the first `count` numbers of the next row of a column file. For the first row, `text` is the file with its
 * header; for later rows, `text` is the result of the previous call. Returns NULL after the last row. */
const char *said_row(const char *text, int count, double *number);

/* errors_catch() starts to capture standard error. errors_caught() ends the capture and returns the text, which is
 * static. */
void errors_catch(void);
const char *errors_caught(void);

/* Writes a model to a temporary file and returns the file's name, which is static. model_drop() deletes the file. */
const char *model_keep(const char *text);
void model_drop(void);
/* Runs command_say() on a temporary file that contains the model `text`. */
void command_say_model(int (*command)(int count, char **words), const char *text, said *what);

/* A random generator. dice_between() returns a number in [low, high), dice_one_of() an integer in [0, count). */
typedef struct dice {
    unsigned long long state;
} dice;
dice dice_of(const char *suite,
             unsigned long seed); /* prints the seed, which WHIRL_SEED replaces */
double dice_between(dice *d, double low, double high);
unsigned dice_one_of(dice *d, unsigned count);

/* The environment variable WHIRL_CASES; `usual` if the variable is not set. */
unsigned dice_cases(unsigned usual);

/* Number of cases: `few` in `make test`; `all` if the environment variable WHIRL_FULL is not empty, as in `make
 * check`. */
unsigned few_or_all(unsigned few, unsigned all);

/* Number of cases: `usual`, or `fewest` if the environment variable WHIRL_FEW is not empty, as in the sanitizers'
 * gate. `fewest` must still cover each class of cases. */
unsigned usual_or(unsigned usual, unsigned fewest);

#endif
