/* contacts.h: what the suites of the scenes with contacts share: references located event by event by
 * another program (tests/reference/contacts.txt, made by contacts.py), and the count of events. */
#ifndef TESTS_CONTACTS_H
#define TESTS_CONTACTS_H

#include "ranges.h"

/* The number NAME of the line `core/models/FILE:scene | at | NAME=...`. */
double contacts_reference(const char *scene, const char *at, const char *name);

/* Largest difference between `m` and the reference at `time`, over all coordinates and rates; SI. */
double contacts_error(const motion *m, const char *scene, const char *time);

/* Events since the start; of them steps with more than the core takes. */
uint64_t contacts_events(const motion *m);
uint64_t contacts_overruns(const motion *m);

/* Steps until the scene's end. */
uint64_t contacts_steps(const motion *m);

#endif
