/* statements.h: the readers of statements, one for each row of words.h, called at the token after the statement's word.
 * After an error that ends the statement, a reader returns false, and its caller skips to the next statement. */
#ifndef LANG_STATEMENTS_H
#define LANG_STATEMENTS_H

#include "host/lang/expression.h"
#include "host/lang/parser.h"

typedef bool statement_reader(parser *in, const statement_word *word);

statement_reader read_unknown, read_valued;              /* declare.c */
statement_reader read_energy, read_force, read_equation; /* statements.c */
statement_reader read_stop, read_friction, read_hold;    /* contact_statement.c */
statement_reader read_when;                              /* contact_statement.c */
statement_reader read_noise;                             /* declare.c */

/* Reports that the contact is not possible in a mechanism with `state` and `equation`. */
void contact_on_system(parser *in, const contact_statement *each);

/* True if both are the same effect, or if one is the mechanism itself (-1), which is always active. */
static inline bool always_meet(int one, int other) { return one == other || one < 0 || other < 0; }

/* Reads the text. Scenes are only noted: they are read last, because they may name later effects. */
void read_file(parser *in);                                      /* statements.c */
void finish_inputs(parser *in, mechanism *made);                 /* derivative.c */
void read_noted_scene(parser *in, const pending_scene *pending); /* scene_block.c */

#endif
