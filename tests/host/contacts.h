/* contacts.h: shared code for suites of scenes with contacts. References come from event location by another program
 * (tests/reference/contacts.txt, made by contacts.py). */
#ifndef TESTS_CONTACTS_H
#define TESTS_CONTACTS_H

#include "ranges.h"

/* The number NAME in the line `core/models/FILE:scene | at | NAME=...`. */
double contacts_reference(const char *scene, const char *at, const char *name);

/* Largest error of `m` at `time`, over all coordinates and rates; SI. */
double contacts_error(const motion *m, const char *scene, const char *time);

/* Events since the start, including steps with more events than the core takes. */
uint64_t contacts_events(const motion *m);
uint64_t contacts_overruns(const motion *m);

uint64_t contacts_steps(const motion *m);

#endif
