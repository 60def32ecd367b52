/* rig_settings.h: the rig's settings (conf.h) in the board's memory (hal/settings.h). Needs rig_control.h before it. */
#ifndef PROGRAMS_RIG_SETTINGS_H
#define PROGRAMS_RIG_SETTINGS_H

#include "core/station/conf.h"
#include "hal/settings.h"

_Static_assert(WH_STORE_SLOT_BYTES <= HAL_SETTINGS_BYTES, "a slot holds a record");

/* These functions lengthen the watchdog's timeout, because nothing kicks it while the memory is busy. */
static bool erase_patiently(unsigned slot) {
    hal_watchdog_start(2U * HAL_SETTINGS_TICKS);
    const bool erased = hal_settings_erase(slot);
    hal_watchdog_start(WATCHDOG_TICKS);
    return erased;
}
static bool write_patiently(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    hal_watchdog_start(2U * HAL_SETTINGS_TICKS);
    const bool written = hal_settings_write(slot, at, bytes, count);
    hal_watchdog_start(WATCHDOG_TICKS);
    return written;
}

static const wh_store_memory settings_memory = {
    .erase = erase_patiently, .write = write_patiently, .read = hal_settings_read};

#endif
