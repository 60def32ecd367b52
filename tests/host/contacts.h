/* contacts.h: counts of the events of scenes with contacts. */
#ifndef TESTS_CONTACTS_H
#define TESTS_CONTACTS_H

#include "ranges.h"

static inline uint64_t contacts_overruns(const motion *m) {
    uint64_t overruns;
    (void)m->kind->events(m->run, &overruns);
    return overruns;
}

/* Events since the start, including those of steps with more events than are logged. */
static inline uint64_t contacts_events(const motion *m) {
    uint64_t overruns;
    return m->kind->events(m->run, &overruns);
}

#endif
