/* findings.h: the findings of a run in words, each with its cause and its remedy. */
#ifndef CHECK_FINDINGS_H
#define CHECK_FINDINGS_H

#include <stdio.h>

#include "host/base/diag.h"
#include "run_checks.h"

/* One line for each finding, "whirl run: warning: ... [word]", then hints. Remedies are tried. `fails`: the energy is an
 * error, whichever its limit. */
void findings_say(FILE *out, const run_checks *v, bool fails);
/* The text of a reported finding, without its name; and its subject, false if that is the whole run. */
enum { FINDINGS_NAME = STATEMENT_SIZE };
void findings_message(FILE *out, const run_checks *v, finding_id id);
bool findings_where(const run_checks *v, finding_id id, char name[FINDINGS_NAME]);
/* For a run that ended too early, or with undefined energies: an option with which it completes, if one is found. */
void findings_say_failed(FILE *out, const run_checks *v);
/* A step came back with `status`: the expression that was no number there, or the coordinate that left all bounds. */
void failure_say(FILE *out, wh_status status, const run_checks *v);

/* Is a run of this image without findings? */
bool remedy_not_needed(const image *im, const image *plain, const engine_kind *kind);

#endif
