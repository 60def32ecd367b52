/* wave.c: sine and cosine of an angle. */
#include "wave.h"

WH_CALLED wh_wave wh_wave_at(wh_phase phase) {
    wh_wave wave;
    wh_sincos(phase, &wave.sine, &wave.cosine);
    return wave;
}

WH_CALLED wh_wave wh_wave_of(wh_real rad) { return wh_wave_at(wh_phase_at(rad)); }
