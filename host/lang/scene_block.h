/* scene.h: a scene being read, for the two files that read it. */
#ifndef LANG_SCENE_H
#define LANG_SCENE_H

#include "parser.h"

/* A scene being read. */
typedef struct draft {
    scene *made;
    bool *with;
    bool *conserve;
    builder *of;
    int number;       /* from 1: marks the symbols that were set */
    bool has_content; /* a statement other than `use` was met */
    place step_at;    /* line 0: none yet */
    place until_at;
} draft;

typedef bool item_reader(parser *in, draft *into);

/* One item of a list; false when it gave up. */
bool scene_with_item(parser *in, draft *into);
bool scene_set_item(parser *in, draft *into);
bool scene_start_item(parser *in, draft *into);
bool scene_conserve_item(parser *in, draft *into);

/* When the scene has been read: what it sets must belong to effects that it names, which may stand behind. */
void scene_check_sets(parser *in, const draft *read);

/* "WHAT needs a name": the token in hand is none. */
bool scene_fail_name(parser *in, const char *what);

#endif
