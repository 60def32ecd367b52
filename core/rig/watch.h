/* watch.h: what the guard is told of the rig, in every state: how fast its next pulse may come, and what else would stop it.
 * A part of rig.c, for nobody else. */
#ifndef WH_RIG_WATCH_H
#define WH_RIG_WATCH_H

#include "rig.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_rig_expect WH_NAME(wh_rig_expect)
#define wh_rig_watch WH_NAME(wh_rig_watch)

/* Before a pulse of `sensor`, captured at `ticks`, is taken: bounds and window for it. */
void wh_rig_expect(const wh_rig_config *config, wh_rig *rig, unsigned sensor, uint32_t ticks);

/* Each control step, before orders are: the guard trips by what it sees. */
void wh_rig_watch(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs);

#ifdef __cplusplus
}
#endif

#endif
