/* table.h: a program's scenes: all of build/gen (`whirl emit-scenes`), or a selection by mk/count/index.sh. */
#ifndef BOARDS_PROGRAMS_TABLE_H
#define BOARDS_PROGRAMS_TABLE_H

#include "core/fixed_scene.h"
#include "core/scene.h"

/* Memory for any scene in float or double, of up to 16 angles, 48 reals, 16 inputs and 16 contacts, with the ledger. */
#ifndef WH_SCENE_WORDS
#define WH_SCENE_WORDS \
    (WH_STATE_WORDS(16, 48, 16) + WH_CONTACT_WORDS(16) + WH_HELD_WORDS(16) + \
     WH_LEDGER_WORDS(128, 34))
#endif

/* Largest numbers of evaluations in a step: of the accelerations, and of the contacts' signals. */
typedef struct wh_scene_bound {
    unsigned evaluations;
    unsigned signals;
} wh_scene_bound;

extern const wh_scene *const wh_scenes[];
/* one for each scene; only index.sh makes them */
extern const wh_scene_bound wh_scene_bounds[];
extern const wh_fixed_scene *const wh_fixed_scenes[]; /* only index.sh --fixed makes them */
extern const unsigned wh_scene_count;

#endif
