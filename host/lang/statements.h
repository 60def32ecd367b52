/* statements.h: the functions that read statements: a row of words.h each. When one is called, the token in hand is the
 * one behind the statement's word; it returns false when it gave up inside the statement (the error is reported), and
 * its caller skips to the next one. */
#ifndef LANG_STATEMENTS_H
#define LANG_STATEMENTS_H

#include "host/lang/cursor.h"
#include "host/lang/expression.h"

typedef bool statement_reader(parser *in, const statement_word *word);

statement_reader read_unknown, read_constant, read_output; /* declare.c */
statement_reader read_energy, read_force, read_equation;   /* terms.c */
statement_reader read_stop, read_friction, read_hold;      /* contact_statement.c */
statement_reader read_when;                                /* contact_statement.c */
statement_reader read_noise;                               /* declare.c */

/* A contact of the statement being read; and adding it to its mechanism, or to the scene being read: true. */
contact_statement contact_begun(const parser *in, const statement_word *word);
bool add_contact(parser *in, const contact_statement *made);
void contact_on_system(parser *in, const contact_statement *each);

/* The whole text, but for its scenes: these are noted, since effects may follow that they name. */
void read_file(parser *in);                                      /* statements.c */
void finish_mechanism(parser *in, builder *made);                /* statements.c */
void finish_inputs(parser *in, mechanism *made);                 /* input_rate.c */
void read_noted_scene(parser *in, const pending_scene *pending); /* scene_block.c */

#endif
