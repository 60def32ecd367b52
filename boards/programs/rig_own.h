/* rig_own.h: the rig programs' own configuration, before the settings change it. Each program includes it once. */
#ifndef PROGRAMS_RIG_OWN_H
#define PROGRAMS_RIG_OWN_H

#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "core/scene.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/slots.h"

/* The observer's model: scene rig_fixed of core/models/eccentric.whirl. Its step is the control step (mk/whirl.mk). */
extern const wh_scene rig_observed;

/* wh_arithmetic(), compiled with the flags of the model's file, or with those of this file if there is no model */
#if WH_RIG_COMPENSATES
#define OWN_ARITHMETIC (rig_observed.arithmetic)
#else
#define OWN_ARITHMETIC (wh_arithmetic)
#endif

/* Sets *config to the standard rig, with this hardware's cell and sensors. */
static void own_configuration(wh_rig_config *config) {
    *config = wh_rig_standard;
    config->measure.cell = (wh_cell_config){.newton_per_count = HAL_LOADCELL_N_PER_COUNT,
                                            .period_ticks = HAL_LOADCELL_PERIOD_TICKS,
                                            .raw_max = HAL_LOADCELL_RAW_MAX};
    config->guard.supply_max_V = hal_motor_supply_most_V();
    wh_rig_slots(config, HAL_SLOT_LEAD_DEG / WH_RIG_DEG_PER_RAD);
#if WH_RIG_COMPENSATES
    config->observer.scene = &rig_observed;
#else
    config->compensation_when = WH_COMPENSATION_NEVER;
#endif
}

#endif
