/* pil_dialled.c: pil_rig.c with an operator who dials in, before the rig is armed, the set-point and how much of gravity's
 * torque is fed forward (docs/pil.md). */
#define RIG_DIALLED 1
#include "pil_rig.c" // NOLINT(bugprone-suspicious-include): the same program
