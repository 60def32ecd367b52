/* kept_settings.c: hal/settings.h in plain memory, for a simulated rig. The settings are lost when the program ends. */
#include "core/real.h"
#include "hal/settings.h"

#if !WH_DOUBLE

static uint8_t kept[2][HAL_SETTINGS_BYTES];

bool hal_settings_erase(unsigned slot) {
    for (unsigned i = 0; i < HAL_SETTINGS_BYTES; i++) {
        kept[slot][i] = 0xFF;
    }
    return true;
}

bool hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        kept[slot][at + i] = bytes[i];
    }
    return true;
}

bool hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        bytes[i] = kept[slot][at + i];
    }
    return true;
}

#endif
