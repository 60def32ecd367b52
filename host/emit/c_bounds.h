/* c_bounds.h: what core/contact.h declares that a step takes at most. By itself, since names of the core's
 * functions are types of the language. */
#ifndef EMIT_C_BOUNDS_H
#define EMIT_C_BOUNDS_H

/* Evaluations of the accelerations, with a method of so many stages, and of the contacts' signals. `forced`:
 * contacts that have a force, `stops` among them; `crossings`: the others. */
int c_bound_evaluations(int stages, int stops, int forced);
int c_bound_signals(int forced, int crossings);

#endif
