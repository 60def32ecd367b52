/* light_fields.h: the record of a board's first light. boards/programs/firstlight.c prints the record as lines of text,
 * and `whirl firstlight` reads it:
 *
 *     firstlight record 1
 *     NAME VALUE          one line for each field, in the order of WH_LIGHT_FIELDS
 *     end 0x01234567      CRC-32 (frame.h) of all lines before, each with a line feed and no carriage return
 *
 * A field that a board or emulator cannot fill has the value `none`. */
#ifndef WH_LIGHT_FIELDS_H
#define WH_LIGHT_FIELDS_H

#include "version.h"

#define WH_LIGHT_BEGIN "firstlight record 1"
#define WH_LIGHT_END "end 0x"
#define WH_LIGHT_NONE "none"

/* Scenes that firstlight.c runs to their end. They cover an angle under gravity, a hinge, a gear on a carriage, a
 * coordinate that follows from its conserved momentum, and stops with friction. */
#define WH_LIGHT_SCENES(X) \
    X(rig_fixed) \
    X(driven_hinge_from_rest) \
    X(epicyclic_from_rest) \
    X(thomson_a_conserved) \
    X(shuttle_buffers)

/* A scene's fields. `model` has a hash of the operations. `hash` has three values: a hash of the last state, the number
 * of steps, and the status. `cycles` has the least, median and largest number of cycles of a step. */
#define WH_LIGHT_OF_SCENE(scene) "model." #scene, "hash." #scene, "cycles." #scene,
#define WH_LIGHT_FIELDS \
    "board", "chip", "version", "compiler", WH_LIGHT_SCENES(WH_LIGHT_OF_SCENE) "stack", "clock", \
        "period_us", "period_cycles", "load", "supply", "stop", "slots", "selftest"

#endif
