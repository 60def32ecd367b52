/* made_sweep.h: for tests of host/sweep: a sweep made of a text as the command makes it, and a sitting of it in a file of its
 * own. */
#ifndef TESTS_HOST_MADE_SWEEP_H
#define TESTS_HOST_MADE_SWEEP_H

#include "command.h"
#include "derived.h"
#include "host/study/session.h"

typedef struct made_sweep {
    derived d; /* of the first scene with its measures in the outputs' place */
    diags *errors;
    whirl_model *model;
    grid grid;
    measures *measures;
    overrides changes;
    image *image;
    sweep sweep;
} made_sweep;

/* Over over[axes], with measures asked[count]. */
void made_sweep_open(made_sweep *m, const char *text, const char *const *over, int axes,
                     const char *const *asked, int count, const engine_kind *kind);
void made_sweep_close(made_sweep *m);

/* A body between a floor at x = 0 and nothing, and what moves beside it. */
extern const char made_sweep_floor[];

/* What session_run() wrote into a file of its own, and said. */
typedef struct session_said {
    int code;
    char rows[SAID_SIZE];
    char err[SAID_SIZE];
} session_said;

/* An empty folder for the file, emptied again by the next; and gone. */
void sessions_open(void);
void sessions_close(void);
/* The file's name, and what is there cut to a length. */
const char *sessions_path(void);
void sessions_cut(size_t length);
session_said sessions_sit(const made_sweep *m, session_settings settings);

#endif
