/* tape_needs.h: which operations of a list need which, and what their order costs. For host/image only. */
#ifndef IMAGE_TAPE_NEEDS_H
#define IMAGE_TAPE_NEEDS_H

#include "tape.h"

/* Single-precision registers that an FPU of Arm or RISC-V has for a list: 32, less what the step around it keeps. */
enum { TAPE_REGISTERS = 20 };

/* Who needs whom. A phase stands behind the one before it: the waves of a list are numbered by their places. */
typedef struct tape_needs {
    const tape *t;
    int *before; /* [t->count]: of a phase the one before it; else -1 */
    bool *given; /* [t->count]: nothing need be computed for it */
    int *first;  /* [t->count + 1]: where its users begin in user[], in their order */
    int *user;
} tape_needs;

enum { NEEDED_MOST = 3, TAKEN_MOST = 2 };

tape_needs tape_needs_of(const tape *t);
void tape_needs_free(tape_needs *n);

/* What must stand before operation i; returns how many. */
int tape_needed(const tape_needs *n, int i, int found[static NEEDED_MOST]);
/* The values that operation i takes from registers, each once; returns how many. Constants and phases are none. */
int tape_taken(const tape *t, int i, int found[static TAKEN_MOST]);

/* What is computed, that is not given, in the order of the list; to be freed. */
int *tape_computed(const tape_needs *n, int *count);
/* Loads and stores of values where that is done in this sequence, registers being given up as is best: those whose values
 * are wanted last (Belady, 1966). */
int tape_carried_by(const tape_needs *n, const int *sequence, int count);

#endif
