/* run_json.h: the results of `whirl run` and `whirl trust` as one JSON object each (schema: docs/warnings.md). */
#ifndef CHECK_RUN_JSON_H
#define CHECK_RUN_JSON_H

#include "host/base/json.h"
#include "host/check/horizon.h"
#include "host/io/records.h"

enum { RUN_JSON_FILES = 4 };

typedef struct run_json_request {
    const struct run_checks *checks;
    const records *records; /* records, whose current row is the last state */
    const char *said;       /* text of the findings, or of the failure, with hints; or NULL */
    double until_s;         /* the run is accurate until this time; below 0: unknown */
    bool failed;
    int status;                       /* exit status */
    const char *file[RUN_JSON_FILES]; /* the requested files; or NULL */
} run_json_request;

void run_json(FILE *out, const run_json_request *w);
void horizon_json(FILE *out, const horizon *h, int status);

/* The first keys of every command's object. `kind` is NULL for commands that compare number types and methods. */
void json_begin(json *j, const char *command, const char *scene, const char *title,
                const engine_kind *kind, wh_method method);
/* Writes the key "not_looked_at", with the words of the findings in `ids`. */
void json_unlooked(json *j, unsigned ids);
/* Writes a time, or null if it is negative. */
void json_time(json *j, const char *key, double time_s);

#endif
