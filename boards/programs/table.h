/* table.h: the scenes of a program that runs or counts them: all of build/gen (`whirl emit-scenes`), or some, as
 * mk/count/index.sh writes them. */
#ifndef BOARDS_PROGRAMS_TABLE_H
#define BOARDS_PROGRAMS_TABLE_H

#include "core/fixed_scene.h"
#include "core/scene.h"

/* Memory for any of them: up to 16 angles, 48 reals, 16 inputs and as many contacts, with the ledger, compensated or
 * not, in either number. A program of one scene may be told what that takes. */
#ifndef WH_SCENE_WORDS
#define WH_SCENE_WORDS \
    (WH_STATE_WORDS(16, 48, 16) + WH_CONTACT_WORDS(16) + WH_HELD_WORDS(16) + \
     WH_LEDGER_WORDS(128, 34))
#endif

/* The most that one step evaluates: the accelerations, and the contacts' signals. */
typedef struct wh_scene_bound {
    unsigned evaluations;
    unsigned signals;
} wh_scene_bound;

extern const wh_scene *const wh_scenes[];
extern const wh_scene_bound wh_scene_bounds[];        /* of each; of index.sh only */
extern const wh_fixed_scene *const wh_fixed_scenes[]; /* of index.sh --fixed only */
extern const unsigned wh_scene_count;

#endif
