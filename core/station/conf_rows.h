/* conf_rows.h: the settings of a rig: one row each.
 *
 * X(name, number, kind, unit, least, most, words): the name as it is typed, which stays; the number as it is stored, which
 * stays and is not used again; the range in the unit. What a setting does to the configuration, and what it is where
 * nobody has set it, is in conf.c; words[] of a choice too. */
#ifndef WH_STATION_CONF_ROWS_H
#define WH_STATION_CONF_ROWS_H

/* X(kind, word) */
#define WH_CONF_KIND_ROWS(X) \
    X(WH_CONF_REAL, "real") \
    X(WH_CONF_WHOLE, "whole") \
    X(WH_CONF_SWITCH, "off|on") \
    X(WH_CONF_FEEDS, "never|slow|always")

#define WH_CONF_ROWS(X) \
    X(mass_moment, 1, WH_CONF_REAL, "kgm", 1e-4, 10.0, "sum of mass times radius") \
    X(inertia, 2, WH_CONF_REAL, "kgm2", 1e-5, 10.0, "of all that turns") \
    X(damping, 3, WH_CONF_REAL, "Nms", 0.0, 1.0, "the motor's torque line and the bearings") \
    X(damping_tolerance, 4, WH_CONF_REAL, "1", 0.0, 1.0, "it may be off by this part, 95 %") \
    X(gravity, 5, WH_CONF_REAL, "mps2", 0.0, 20.0, "in the arms' plane; 0: it lies level") \
    X(gravity_angle, 6, WH_CONF_REAL, "deg", -180.0, 180.0, "at which the arms hang") \
    X(mount_factor, 7, WH_CONF_REAL, "1", 0.01, 1.0, \
      "force as a part of that on a fixed mount; carriage: 1/(1 + ratio)") \
    X(sensor1, 8, WH_CONF_REAL, "deg", -30.0, 30.0, \
      "where it stands, from the loading-train axis") \
    X(sensor2, 9, WH_CONF_REAL, "deg", 60.0, 120.0, "likewise") \
    X(slot_lead, 10, WH_CONF_REAL, "deg", 0.0, 20.0, "pulses come so far before a sensor") \
    X(cell_scale, 11, WH_CONF_REAL, "mN", 1e-4, 1000.0, "of one count") \
    X(cell_reversed, 12, WH_CONF_SWITCH, "1", 0.0, 1.0, "mounted the other way round") \
    X(cell_offset, 13, WH_CONF_REAL, "N", -1000.0, 1000.0, "shown without any force") \
    X(cell_delay, 14, WH_CONF_WHOLE, "us", 0.0, 100000.0, "of filter and converter") \
    X(amplitude_floor, 15, WH_CONF_REAL, "1", 0.0, 0.5, \
      "calibration of the force, 95 %, as a part of it") \
    X(phase_floor, 16, WH_CONF_REAL, "deg", 0.0, 45.0, "calibration of the phase, 95 %") \
    X(record_time, 17, WH_CONF_REAL, "s", 0.2, 20.0, "of whole turns that are measured, at least") \
    X(record_turns, 18, WH_CONF_REAL, "1", 3.0, 100.0, "in the time of so many, at least") \
    X(settle_time, 19, WH_CONF_REAL, "s", 0.1, 30.0, "within the band before the record") \
    X(settle_band, 20, WH_CONF_REAL, "rpm", 0.05, 20.0, "of speed, either way") \
    X(ramp, 21, WH_CONF_REAL, "rpm_s", 5.0, 200.0, "fastest change of the set-point") \
    X(gain, 22, WH_CONF_REAL, "Vs", 0.01, 5.0, "volts per rad/s of error") \
    X(gain_integral, 23, WH_CONF_REAL, "V", 0.0, 20.0, "volts a second per rad/s of error") \
    X(spin_up, 24, WH_CONF_REAL, "V", 0.5, 60.0, "with which the rotor starts") \
    X(speed_least, 25, WH_CONF_REAL, "rpm", 50.0, 400.0, "smallest set-point") \
    X(speed_most, 26, WH_CONF_REAL, "rpm", 60.0, 400.0, "largest set-point") \
    X(speed_limit, 27, WH_CONF_REAL, "rpm", 70.0, 400.0, \
      "a faster turn trips: what the shaft carries") \
    X(supply_least, 28, WH_CONF_REAL, "V", 1.0, 60.0, "a lower one trips") \
    X(supply_most, 29, WH_CONF_REAL, "V", 1.0, 60.0, "a higher one trips") \
    X(armed_time, 30, WH_CONF_REAL, "s", 1.0, 600.0, "for which arm allows a start") \
    X(rest_time, 31, WH_CONF_REAL, "s", 5.0, 600.0, "in which the rotor comes to rest") \
    X(stop_brakes, 32, WH_CONF_SWITCH, "1", 0.0, 1.0, \
      "the motor, when it goes off; else it coasts") \
    X(swings, 33, WH_CONF_SWITCH, "1", 0.0, 1.0, \
      "a run ends in a free swing, which tells where the sensors stand") \
    X(host_loss_stops, 34, WH_CONF_SWITCH, "1", 0.0, 1.0, "a run, when the host is lost") \
    X(feeds, 35, WH_CONF_FEEDS, "1", 0.0, 2.0, "gravity's torque to the motor") \
    X(yields, 36, WH_CONF_REAL, "kgm2", 0.0, 10.0, \
      "by which a mount that gives way lets the inertia vary; with gravity 0")

#endif
