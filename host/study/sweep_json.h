/* sweep_json.h: a sweep as one JSON object: its columns, a row for each point with the findings of that point, and how it
 * ended (docs/warnings.md has the schema). */
#ifndef STUDY_SWEEP_JSON_H
#define STUDY_SWEEP_JSON_H

#include "host/base/json.h"
#include "point.h"

/* A column for each axis. */
void sweep_json_axes(json *j, const grid *g);
void sweep_json_begin(json *j, const sweep *s);
/* `row`: as in the CSV file. `error`: why the point failed, or NULL. `found`, `against`: its findings and the warnings
 * among them, as bits. */
void sweep_json_point(json *j, const char *row, const char *error, unsigned found,
                      unsigned against);
void sweep_json_end(json *j, uint64_t failed, int status);

#endif
