/* carriage.h: the rig on a carriage that is free along a level rail, its arms turning in a level plane.
 *
 * Almesallmy (2006), I.3.2.2 and I.3.5: the load cell sits between the shaft's pin and the carriage. Of what the arms' force is on
 * a fixed mount it feels M/(M + m), M being the carriage's mass and m the eccentric one; and the carriage goes to and
 * fro by X = S/(M + m), whatever the speed. */
#ifndef WH_RIG_CARRIAGE_H
#define WH_RIG_CARRIAGE_H

#include "rig.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wh_carriage {
    wh_real disc_m; /* centres of the discs, from the shaft */
    wh_real ratio;  /* m/M; 0: it is too heavy to move */
} wh_carriage;

#define wh_carriage_mount WH_NAME(wh_carriage_mount)
#define wh_carriage_displacement_m WH_NAME(wh_carriage_displacement_m)

/* wh_rig_standard, or a copy with other cells and sensors, becomes the rig on that carriage. Without gravity there is nothing
 * to observe or to feed. */
void wh_carriage_mount(wh_rig_config *config, const wh_carriage *carriage);

/* By how much the carriage goes to either side, in m: of what the cell feels F/(M <w^2>), the mean taken over the angle. 0 of a
 * mount that does not move. */
wh_real wh_carriage_displacement_m(const wh_rig_config *config, const wh_carriage *carriage,
                                   const wh_measured *force);

#ifdef __cplusplus
}
#endif

#endif
