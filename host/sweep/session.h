/* session.h: one `whirl sweep` from its first missing row to its last. */
#ifndef SWEEP_SESSION_H
#define SWEEP_SESSION_H

#include <signal.h>

#include "point.h"

typedef struct session_settings {
    const char *csv;         /* file, or "-" for standard output */
    const char *fingerprint; /* see sheet.h */
    uint64_t first;          /* points first <= point < end */
    uint64_t end;
    bool header; /* the rows have a header */
    int jobs;    /* worker processes */
    bool fresh;
    bool quiet;
    const volatile sig_atomic_t *stop; /* set from outside to end it cleanly */
} session_settings;

enum {
    SESSION_DONE = 0,
    SESSION_FAILED = 1,  /* points failed, or rows could not be written */
    SESSION_REFUSED = 2, /* the file is another sweep's */
    SESSION_INTERRUPTED = 130
};

/* Returns one of the above; what is wrong has been said on standard error. */
int session_run(const sweep *s, const session_settings *settings);

#endif
