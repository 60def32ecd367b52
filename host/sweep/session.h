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
    bool json;                         /* one object on standard output; `csv` is then no file */
    const volatile sig_atomic_t *stop; /* set from outside to end it cleanly */
} session_settings;

/* Returns an exit code (host/base/exit.h): EXIT_RUN_FAILED when points failed or rows could not be written,
 * EXIT_BAD_INPUT when the file is another sweep's; what is wrong has been said on standard error. */
int session_run(const sweep *s, const session_settings *settings);

#endif
