/* contacts.h: counts the events of scenes with contacts. */
#ifndef TESTS_CONTACTS_H
#define TESTS_CONTACTS_H

#include "ranges.h"

static inline uint64_t contacts_overruns(const motion *m) {
    uint64_t overruns;
    (void)m->kind->events(m->run, &overruns);
    return overruns;
}

/* Number of events since the start. All events count, even those of a step that has too many for its log. */
static inline uint64_t contacts_events(const motion *m) {
    uint64_t overruns;
    return m->kind->events(m->run, &overruns);
}

#endif
