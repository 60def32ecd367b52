/* pil_carriage.c: the rig's firmware (rig.c) on a carriage that somebody else plays: `whirl pil` with
 * docs/plants/carriage.whirl (docs/rig.md). Speed, radius of the discs and weight ratio are dialled in by the operator, and
 * read once, before the rig is armed. */
#define HAL_VIRTUAL 0
#define HAL_FRAMES 1
#define RIG_CARRIAGE 1
#include "rig.c" // NOLINT(bugprone-suspicious-include): the same program
