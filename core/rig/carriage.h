/* carriage.h: the rig on a carriage that moves freely along a level rail, with arms in a level plane.
 *
 * Almesallmy (2006), I.3.2.2 and I.3.5: the load cell sits between the shaft's pin and the carriage. It measures M/(M +
 * m) of the force on a fixed mount, with M the carriage's mass and m the eccentric mass. The carriage moves to and fro
 * by X = S/(M + m) at any speed. */
#ifndef WH_RIG_CARRIAGE_H
#define WH_RIG_CARRIAGE_H

#include "rig.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wh_carriage {
    wh_real disc_m; /* centres of the discs, from the shaft */
    wh_real ratio;  /* m/M; 0: too heavy to move */
} wh_carriage;

#define wh_carriage_mount WH_NAME(wh_carriage_mount)
#define wh_carriage_displacement_m WH_NAME(wh_carriage_displacement_m)

/* Change wh_rig_standard, or a copy with other cells and sensors, to the rig on that carriage. Without gravity there is
 * nothing to observe or to feed forward. */
void wh_carriage_mount(wh_rig_config *config, const wh_carriage *carriage);

/* Displacement amplitude of the carriage in m: F/(M <w^2>) with the cell's force F and the mean over the angle. 0 for a
 * fixed mount. */
wh_real wh_carriage_displacement_m(const wh_rig_config *config, const wh_carriage *carriage,
                                   const wh_measured *force);

#ifdef __cplusplus
}
#endif

#endif
