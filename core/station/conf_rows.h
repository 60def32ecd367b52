/* conf_rows.h: the settings of a rig: one row each.
 *
 * X(name, number, kind, unit, least, most, member, units, words): the name as it is typed, which stays; the number as it is
 * stored, which stays and is not used again; the range in the unit; where in wh_rig_config it is, and how many of its unit
 * are one of that. What goes with several of them is in conf.c. */
#ifndef WH_STATION_CONF_ROWS_H
#define WH_STATION_CONF_ROWS_H

/* X(kind, word) */
#define WH_CONF_KIND_ROWS(X) \
    X(WH_CONF_REAL, "real") \
    X(WH_CONF_WHOLE, "whole") \
    X(WH_CONF_SWITCH, "off|on") \
    X(WH_CONF_FEEDS, "never|slow|always")

/* X(units, number) */
#define WH_CONF_UNIT_ROWS(X) \
    X(ONE, 1.0) \
    X(DEG, 57.29577951308232) \
    X(RPM, 9.549296585513721) \
    X(MILLI, 1000.0)

#define WH_CONF_ROWS(X) \
    X(mass_moment, 1, WH_CONF_REAL, "kgm", 1e-4, 10.0, measure.rotor.mass_moment_kgm, ONE, \
      "sum of mass times radius") \
    X(inertia, 2, WH_CONF_REAL, "kgm2", 1e-5, 10.0, measure.rotor.inertia_kgm2, ONE, \
      "of all that turns") \
    X(damping, 3, WH_CONF_REAL, "Nms", 0.0, 1.0, measure.rotor.damping_Nms, ONE, \
      "the motor's torque line and the bearings") \
    X(damping_tolerance, 4, WH_CONF_REAL, "1", 0.0, 1.0, measure.rotor.damping_tolerance, ONE, \
      "it may be off by this part, 95 %") \
    X(gravity, 5, WH_CONF_REAL, "mps2", 0.0, 20.0, measure.rotor.gravity_mps2, ONE, \
      "in the arms' plane; 0: it lies level") \
    X(gravity_angle, 6, WH_CONF_REAL, "deg", -180.0, 180.0, measure.rotor.gravity_rad, DEG, \
      "at which the arms hang") \
    X(mount_factor, 7, WH_CONF_REAL, "1", 0.01, 1.0, measure.result.mount_factor, ONE, \
      "force as a part of that on a fixed mount; carriage: 1/(1 + ratio)") \
    X(sensor1, 8, WH_CONF_REAL, "deg", -30.0, 30.0, measure.rotor.mark_rad[0], DEG, \
      "where it stands, from the loading-train axis") \
    X(sensor2, 9, WH_CONF_REAL, "deg", 60.0, 120.0, measure.rotor.mark_rad[1], DEG, \
      "where it stands, from the loading-train axis") \
    X(slot_lead, 10, WH_CONF_REAL, "deg", 0.0, 20.0, swing.lead_rad, DEG, \
      "pulses come so far before a sensor") \
    X(cell_scale, 11, WH_CONF_REAL, "mN", 1e-4, 1000.0, measure.cell.newton_per_count, MILLI, \
      "of one count") \
    X(cell_reversed, 12, WH_CONF_SWITCH, "1", 0.0, 1.0, measure.cell.newton_per_count, ONE, \
      "mounted the other way round") \
    X(cell_offset, 13, WH_CONF_REAL, "N", -1000.0, 1000.0, measure.cell.offset_N, ONE, \
      "shown without any force") \
    X(cell_delay, 14, WH_CONF_WHOLE, "us", 0.0, 100000.0, measure.cell.delay_ticks, ONE, \
      "of filter and converter") \
    X(amplitude_floor, 15, WH_CONF_REAL, "1", 0.0, 0.5, measure.result.amplitude_floor, ONE, \
      "calibration of the force, 95 %, as a part of it") \
    X(phase_floor, 16, WH_CONF_REAL, "deg", 0.0, 45.0, measure.result.phase_floor_rad, DEG, \
      "calibration of the phase, 95 %") \
    X(record_time, 17, WH_CONF_REAL, "s", 0.2, 20.0, measure.record_s, ONE, \
      "of whole turns that are measured, at least") \
    X(record_turns, 18, WH_CONF_REAL, "1", 3.0, 100.0, measure.record_turns, ONE, \
      "in the time of so many, at least") \
    X(settle_time, 19, WH_CONF_REAL, "s", 0.1, 30.0, run.settle_s, ONE, \
      "within the band before the record") \
    X(settle_band, 20, WH_CONF_REAL, "rpm", 0.05, 20.0, run.settle_band_radps, RPM, \
      "of speed, either way") \
    X(ramp, 21, WH_CONF_REAL, "rpm_s", 5.0, 200.0, run.drive.ramp_radps2, RPM, \
      "fastest change of the set-point") \
    X(gain, 22, WH_CONF_REAL, "Vs", 0.01, 5.0, run.drive.proportional_V_per_radps, ONE, \
      "volts per rad/s of error") \
    X(gain_integral, 23, WH_CONF_REAL, "V", 0.0, 20.0, run.drive.integral_V_per_rad, ONE, \
      "volts a second per rad/s of error") \
    X(spin_up, 24, WH_CONF_REAL, "V", 0.5, 60.0, run.spin_up_V, ONE, \
      "with which the rotor starts") \
    X(speed_least, 25, WH_CONF_REAL, "rpm", 50.0, 400.0, guard.target_min_radps, RPM, \
      "smallest set-point") \
    X(speed_most, 26, WH_CONF_REAL, "rpm", 60.0, 400.0, guard.target_max_radps, RPM, \
      "largest set-point") \
    X(speed_limit, 27, WH_CONF_REAL, "rpm", 70.0, 400.0, guard.limit_radps, RPM, \
      "a faster turn trips: what the shaft carries") \
    X(supply_least, 28, WH_CONF_REAL, "V", 1.0, 60.0, guard.supply_min_V, ONE, \
      "a lower one trips") \
    X(supply_most, 29, WH_CONF_REAL, "V", 1.0, 60.0, guard.supply_max_V, ONE, \
      "a higher one trips") \
    X(armed_time, 30, WH_CONF_REAL, "s", 1.0, 600.0, armed_max_s, ONE, \
      "for which arm allows a start") \
    X(rest_time, 31, WH_CONF_REAL, "s", 5.0, 600.0, rest_max_s, ONE, \
      "in which the rotor comes to rest") \
    X(stop_brakes, 32, WH_CONF_SWITCH, "1", 0.0, 1.0, stop_brakes, ONE, \
      "the motor, when it goes off; else it coasts") \
    X(swings, 33, WH_CONF_SWITCH, "1", 0.0, 1.0, swings, ONE, \
      "a run ends in a free swing, which tells where the sensors stand") \
    X(host_loss_stops, 34, WH_CONF_SWITCH, "1", 0.0, 1.0, host_loss_stops, ONE, \
      "a run, when the host is lost") \
    X(feeds, 35, WH_CONF_FEEDS, "1", 0.0, 2.0, feeds, ONE, "gravity's torque to the motor") \
    X(yields, 36, WH_CONF_REAL, "kgm2", 0.0, 10.0, measure.rotor.yields_kgm2, ONE, \
      "by which a mount that gives way lets the inertia vary; with gravity 0")

#endif
