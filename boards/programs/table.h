/* table.h: the table of a program's scenes. `whirl emit-scenes` makes it of all scenes, mk/count/index.sh of some. */
#ifndef BOARDS_PROGRAMS_TABLE_H
#define BOARDS_PROGRAMS_TABLE_H

#include "core/fixed_scene.h"
#include "core/scene.h"

/* Number of 8-byte words that suffice for a scene and its ledger, in float or double. The scene has at most 16 angles,
 * 48 reals, 16 inputs and 16 contacts. */
#ifndef WH_SCENE_WORDS
#define WH_SCENE_WORDS \
    (WH_STATE_WORDS(16, 48, 16) + WH_CONTACT_WORDS(16) + WH_HELD_WORDS(16) + \
     WH_LEDGER_WORDS(128, 34))
#endif

/* Declared limits for one step. */
typedef struct wh_scene_bound {
    unsigned evaluations; /* evaluations of the accelerations */
    unsigned signals;     /* evaluations of the contacts' signals */
} wh_scene_bound;

extern const wh_scene *const wh_scenes[];
extern const wh_scene_bound wh_scene_bounds[];        /* only in tables by index.sh */
extern const wh_fixed_scene *const wh_fixed_scenes[]; /* only in tables by index.sh --fixed */
extern const unsigned wh_scene_count;

#endif
