/* pil_carriage.c: the rig's firmware (rig.c) on a simulated carriage: `whirl pil` with docs/plants/carriage.whirl
 * (docs/rig.md). The operator dials speed, radius of the discs and weight ratio, which are read once, before the rig is
 * armed. */
#define HAL_VIRTUAL 0
#define HAL_FRAMES 1
#define RIG_CARRIAGE 1
#include "rig.c" // NOLINT(bugprone-suspicious-include): the same program
