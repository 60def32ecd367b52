/* feed.c: feed-forward of gravity's torque to the motor. */
#include "feed.h"

#include "datasheet.h"
#include "wave.h"

const wh_feed_config wh_feed_standard = WH_FEED_STANDARD;

wh_real wh_feed_step(const wh_feed_config *config, wh_feed *feed, const wh_observer *observer,
                     uint32_t now_ticks, wh_real step_s) {
    if (!observer->valid) {
        feed->part = WH_R(0.0);
        return WH_R(0.0);
    }
    if (feed->part < WH_R(1.0)) {
        const wh_real part = feed->part * config->fade_s + step_s;
        feed->part = part < config->fade_s ? part / config->fade_s : WH_R(1.0);
    }
    const wh_wave wave = wh_wave_at(wh_observer_phase(observer, now_ticks + config->lead_ticks) -
                                    wh_phase_from_rad(config->gravity_rad));
    const wh_real voltage = feed->part * wave.sine * (config->weight_Nm / config->stall_Nm);
    if (!(WH_ABS(voltage) <= config->most)) { /* also NaN */
        return voltage > WH_R(0.0) ? config->most : voltage < WH_R(0.0) ? -config->most : WH_R(0.0);
    }
    return voltage;
}
