/* contacts.h: helpers of suites of scenes with contacts. Their references are computed by contacts.py, which locates
 * the events (tests/reference/contacts.txt). */
#ifndef TESTS_CONTACTS_H
#define TESTS_CONTACTS_H

#include "ranges.h"

/* The number NAME in the line `core/models/FILE:scene | at | NAME=...`. */
double contacts_reference(const char *scene, const char *at, const char *name);

/* Largest error of `m` at `time`, over all coordinates and rates; SI. */
double contacts_error(const motion *m, const char *scene, const char *time);

/* Events since the start, including those of steps with more events than are logged. */
uint64_t contacts_events(const motion *m);
uint64_t contacts_overruns(const motion *m);

uint64_t contacts_steps(const motion *m);

#endif
