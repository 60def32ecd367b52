/* c_contacts.h: a scene's contacts as C. */
#ifndef EMIT_C_CONTACTS_H
#define EMIT_C_CONTACTS_H

#include <stdio.h>

#include "host/derive/contact_lists.h"
#include "host/run/engine.h"

/* The declared bounds and the core's header. */
void c_contacts_include(FILE *out, const contact_lists *c);

/* The lists, the table and advance(). */
void c_contacts_write(FILE *out, const program *p, const engine_settings *settings, double step_s);

/* The most that a step evaluates: the accelerations (or slopes), and the contacts' signals. */
int c_contacts_evaluations(const program *p, const engine_settings *settings);
int c_contacts_signals(const program *p);

#endif
