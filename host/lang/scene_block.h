/* scene_block.h: the statements of a scene, for the two files that read it. The scene is the parser's draft. */
#ifndef LANG_SCENE_BLOCK_H
#define LANG_SCENE_BLOCK_H

#include "statements.h"

statement_reader read_use, read_step, read_until;                /* scene_block.c */
statement_reader read_with, read_set, read_start, read_conserve; /* scene_items.c */
statement_reader read_range;                                     /* scene_range.c */

/* When the scene has been read: what it sets must belong to effects that it names, which may stand behind. */
void scene_check_sets(parser *in, const draft *read);

/* NAME of a symbol of the mechanism; *found is NULL when it is none (reported). */
bool scene_take_symbol(parser *in, draft *into, const statement_word *word, token *name,
                       named **found);
/* ITEM {, ITEM}: a line may end after a comma. */
bool scene_list(parser *in, const statement_word *word, statement_reader *read);

/* "WORD needs a name": the token in hand is none. */
bool scene_fail_name(parser *in, const statement_word *word);

#endif
