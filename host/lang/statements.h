/* statements.h: the readers of statements, one for each row of words.h. The current token is the one after the
 * statement's word. A reader returns false, after a report, if it gave up inside the statement; its caller then skips
 * to the next one. */
#ifndef LANG_STATEMENTS_H
#define LANG_STATEMENTS_H

#include "host/lang/expression.h"
#include "host/lang/parser.h"

typedef bool statement_reader(parser *in, const statement_word *word);

statement_reader read_unknown, read_constant, read_output; /* declare.c */
statement_reader read_energy, read_force, read_equation;   /* statements.c */
statement_reader read_stop, read_friction, read_hold;      /* contact_statement.c */
statement_reader read_when;                                /* contact_statement.c */
statement_reader read_noise;                               /* declare.c */

/* Begin the contact of the current statement. Add it to its mechanism or to the current scene; returns true. */
void contact_on_system(parser *in, const contact_statement *each);

/* Are statements of these effects active together whenever one of them is? -1: of no effect. */
static inline bool always_meet(int one, int other) { return one == other || one < 0 || other < 0; }

/* Read the whole text except the scenes. Scenes are read last, because they may name effects that come after them. */
void read_file(parser *in);                                      /* statements.c */
void finish_inputs(parser *in, mechanism *made);                 /* derivative.c */
void read_noted_scene(parser *in, const pending_scene *pending); /* scene_block.c */

#endif
