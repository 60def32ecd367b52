/* gravity_compensation.c: the motor voltage that cancels gravity's torque. */
#include "gravity_compensation.h"

#include "datasheet.h"
#include "polar.h"

const wh_compensation_config wh_compensation_standard = WH_COMPENSATION_STANDARD;

wh_real wh_compensation_step(const wh_compensation_config *config, wh_compensation *compensation,
                             const wh_observer *observer, uint32_t now_ticks, wh_real step_s) {
    if (!observer->valid) {
        compensation->part = WH_R(0.0);
        return WH_R(0.0);
    }
    if (compensation->part < WH_R(1.0)) {
        const wh_real part = compensation->part * config->fade_s + step_s;
        compensation->part = part < config->fade_s ? part / config->fade_s : WH_R(1.0);
    }
    const wh_wave wave = wh_wave_at(wh_observer_phase(observer, now_ticks + config->lead_ticks) -
                                    wh_phase_from_rad(config->gravity_rad));
    const wh_real voltage = compensation->part * wave.sine * (config->weight_Nm / config->stall_Nm);
    if (!(WH_ABS(voltage) <= config->most)) { /* also true for NaN */
        return voltage > WH_R(0.0) ? config->most : voltage < WH_R(0.0) ? -config->most : WH_R(0.0);
    }
    return voltage;
}
