/* show_events.h: stops, frictions, holds and crossings, for readers. */
#ifndef SHOW_SHOW_EVENTS_H
#define SHOW_SHOW_EVENTS_H

#include "host/derive/equations.h"
#include "host/show/show.h"

/* A heading, then a line for each contact that takes part, in the order in which events at
 * one instant are taken; nothing when there are none. Every line begins with `prefix`. */
void show_events(FILE *out, const equations *e, const char *prefix, const char *heading);

/* The same below equations for readers, in the style of `s` and with its names for sums. */
void show_contacts(const show *s, const equations *e);

#endif
