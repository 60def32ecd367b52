/* pil_carriage.c: the rig's firmware (rig.c) on a simulated carriage: `whirl pil` with docs/plants/carriage.whirl
 * (docs/rig.md). It reads the dials (speed, radius of the discs, weight ratio) once, before it arms. */
#define HAL_VIRTUAL 0
#define HAL_FRAMES 1
#define RIG_CARRIAGE 1
#include "rig.c" // NOLINT(bugprone-suspicious-include): the same program
