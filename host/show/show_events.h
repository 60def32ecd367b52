/* show_events.h: stops, frictions, holds and crossings, for readers. */
#ifndef SHOW_SHOW_EVENTS_H
#define SHOW_SHOW_EVENTS_H

#include "host/derive/equations.h"
#include "host/show/show.h"

/* A heading, then a line for each active contact, in the order of simultaneous events; nothing without contacts. Every
 * line begins with `prefix`. */
void show_events(FILE *out, const equations *e, const char *prefix, const char *heading);

/* The same after the equations, in the style of `s` and with its names for sums. */
void show_contacts(const show *s, const equations *e);

#endif
