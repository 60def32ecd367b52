/* run_json.h: a run as one JSON object: its end, its findings and how it ended (docs/warnings.md has the schema). */
#ifndef RUN_RUN_JSON_H
#define RUN_RUN_JSON_H

#include "records.h"
#include "verdict.h"

enum { RUN_JSON_FILES = 4 };

typedef struct run_json_wish {
    const verdict *verdict;
    const records *records;           /* with the last state */
    const char *said;                 /* by findings_say(); or NULL */
    double until_s;                   /* trusted; below 0: not told */
    int status;                       /* exit status */
    const char *file[RUN_JSON_FILES]; /* that were asked for; or NULL */
} run_json_wish;

void run_json(FILE *out, const run_json_wish *w);

#endif
