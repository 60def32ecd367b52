/* kept_settings.c: hal/settings.h in plain memory, for a simulated rig. The settings are lost when the program ends. */
#include <stdbool.h>

#include "core/real.h"
#include "hal/settings.h"

#if !WH_DOUBLE

enum { SLOTS = 2 };

static uint8_t kept[SLOTS][HAL_SETTINGS_BYTES];

static bool within(unsigned slot, unsigned at, unsigned count) {
    return slot < SLOTS && at <= HAL_SETTINGS_BYTES && count <= HAL_SETTINGS_BYTES - at;
}

hal_settings_result hal_settings_erase(unsigned slot) {
    for (unsigned i = 0; slot < SLOTS && i < HAL_SETTINGS_BYTES; i++) {
        kept[slot][i] = 0xFF;
    }
    return slot < SLOTS ? HAL_SETTINGS_DONE : HAL_SETTINGS_OUTSIDE;
}

hal_settings_result hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes,
                                       unsigned count) {
    if (!within(slot, at, count)) {
        return HAL_SETTINGS_OUTSIDE;
    }
    for (unsigned i = 0; i < count; i++) {
        kept[slot][at + i] = bytes[i];
    }
    return HAL_SETTINGS_DONE;
}

hal_settings_result hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    if (!within(slot, at, count)) {
        return HAL_SETTINGS_OUTSIDE;
    }
    for (unsigned i = 0; i < count; i++) {
        bytes[i] = kept[slot][at + i];
    }
    return HAL_SETTINGS_DONE;
}

#endif
