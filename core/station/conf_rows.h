/* conf_rows.h: the rig's settings, one row each: X(name, number, kind, unit, least, most, goes, member, words). The
 * user types the name; permanent memory stores the number. Never change them, and never reuse a number. `least`
 * and `most` are in `unit`, `goes` is a wh_conf_goes, `member` is in wh_rig_config. */
#ifndef WH_STATION_CONF_ROWS_H
#define WH_STATION_CONF_ROWS_H

/* X(kind, words). The values of a choice are numbered from 0, in the order of the words. */
#define WH_CONF_KIND_ROWS(X) \
    X(WH_CONF_REAL, "|" \
                    "real") \
    X(WH_CONF_WHOLE, "|" \
                     "whole") \
    X(WH_CONF_SWITCH, WH_LIST_OFF_ON) \
    X(WH_CONF_WHEN, "|" \
                    "never" \
                    "|" \
                    "slow" \
                    "|" \
                    "always")

/* X(unit, word, number): a setting's value in this unit is `number` times the value of the row's `member`. */
#define WH_CONF_SCALED_ROWS(X) \
    X(DEG, "deg", 57.29577951308232) \
    X(RPM, "rpm", 9.549296585513721) \
    X(RPM_S, "rpm_s", 9.549296585513721) \
    X(MILLINEWTON, "mN", 1000.0)
#define WH_CONF_UNIT_ROWS(X) \
    WH_CONF_SCALED_ROWS(X) \
    X(ONE, "1", 1.0) \
    X(NEWTON, "N", 1.0) \
    X(SECOND, "s", 1.0) \
    X(MICROSECOND, "us", 1.0) \
    X(VOLT, "V", 1.0) \
    X(VOLT_SECOND, "Vs", 1.0) \
    X(KGM, "kgm", 1.0) \
    X(KGM2, "kgm2", 1.0) \
    X(NMS, "Nms", 1.0) \
    X(NM, "Nm", 1.0) \
    X(MPS2, "mps2", 1.0)

#define WH_CONF_ROWS(X) \
    X(mass_moment, 1, WH_CONF_REAL, KGM, 1e-4, 10.0, ROTOR, measure.rotor.unbalance_kgm, \
      "sum of mass times radius") \
    X(inertia, 2, WH_CONF_REAL, KGM2, 1e-5, 10.0, ROTOR, measure.rotor.inertia_kgm2, \
      "moment of inertia of all rotating parts") \
    X(damping, 3, WH_CONF_REAL, NMS, 0.0, 1.0, ALONE, measure.rotor.damping_Nms, \
      "damping by the motor's torque-speed line and the bearings") \
    X(damping_tolerance, 4, WH_CONF_REAL, ONE, 0.0, 1.0, ALONE, measure.rotor.damping_tolerance, \
      "relative 95 % uncertainty of damping") \
    X(gravity, 5, WH_CONF_REAL, MPS2, 0.0, 20.0, ROTOR, measure.rotor.gravity_mps2, \
      "gravity along the plane of the arms; 0: the plane is horizontal") \
    X(gravity_angle, 6, WH_CONF_REAL, DEG, -180.0, 180.0, ROTOR, measure.rotor.gravity_rad, \
      "angle at which the arms hang at rest") \
    X(mount_factor, 7, WH_CONF_REAL, ONE, 0.01, 1.0, ROTOR, measure.result.mount_factor, \
      "force divided by that on a fixed mount; M/(M + m) on a carriage M with eccentrics m") \
    X(sensor1, 8, WH_CONF_REAL, DEG, -30.0, 30.0, SENSORS, measure.rotor.pulse_rad[0], \
      "angle of sensor 1 from the loading-train axis") \
    X(sensor2, 9, WH_CONF_REAL, DEG, 60.0, 120.0, SENSORS, measure.rotor.pulse_rad[1], \
      "angle of sensor 2 from the loading-train axis") \
    X(slot_lead, 10, WH_CONF_REAL, DEG, 0.0, 20.0, SENSORS, swing.lead_rad, \
      "a pulse comes this angle before the arms reach the sensor") \
    X(cell_scale, 11, WH_CONF_REAL, MILLINEWTON, 1e-4, 1000.0, CELL, \
      measure.cell.newton_per_count, "force of one count") \
    X(cell_reversed, 12, WH_CONF_SWITCH, ONE, 0.0, 1.0, CELL, measure.cell.newton_per_count, \
      "whether the load cell is mounted in reverse") \
    X(cell_offset, 13, WH_CONF_REAL, NEWTON, -1000.0, 1000.0, ALONE, measure.cell.offset_N, \
      "force that the load cell shows without load") \
    X(cell_delay, 14, WH_CONF_WHOLE, MICROSECOND, 0.0, 100000.0, ALONE, measure.cell.delay_ticks, \
      "delay of the cell's filter and converter") \
    X(amplitude_floor, 15, WH_CONF_REAL, ONE, 0.0, 0.5, ALONE, measure.result.amplitude_floor, \
      "relative 95 % uncertainty of the force; 0: uncalibrated, uses 0.005") \
    X(phase_floor, 16, WH_CONF_REAL, DEG, 0.0, 45.0, ALONE, measure.result.phase_floor_rad, \
      "95 % uncertainty of the phase; 0: uncalibrated, uses 0.5") \
    X(record_time, 17, WH_CONF_REAL, SECOND, 0.2, 20.0, ALONE, measure.record_s, \
      "least duration of the record") \
    X(record_turns, 18, WH_CONF_REAL, ONE, 3.0, 100.0, ALONE, measure.record_turns, \
      "least duration of the record, in turns") \
    X(settle_time, 19, WH_CONF_REAL, SECOND, 0.1, 30.0, ALONE, run.settle_s, \
      "the record begins when four-turn mean speeds have been in settle_band for this time") \
    X(settle_band, 20, WH_CONF_REAL, RPM, 0.05, 20.0, ALONE, run.settle_band_radps, \
      "allowed deviation of the speed, up or down") \
    X(ramp, 21, WH_CONF_REAL, RPM_S, 5.0, 200.0, ALONE, run.drive.ramp_radps2, \
      "fastest change of the set-point") \
    X(gain, 22, WH_CONF_REAL, VOLT_SECOND, 0.01, 5.0, ALONE, run.drive.proportional_V_per_radps, \
      "proportional gain: volts per rad/s of error") \
    X(gain_integral, 23, WH_CONF_REAL, VOLT, 0.0, 20.0, ALONE, run.drive.integral_V_per_rad, \
      "integral gain: volts per second per rad/s of error") \
    X(spin_up, 24, WH_CONF_REAL, VOLT, 0.5, 60.0, ALONE, run.spin_up_V, \
      "voltage that starts the rotor") \
    X(speed_least, 25, WH_CONF_REAL, RPM, 50.0, 400.0, ALONE, guard.target_min_radps, \
      "smallest set-point") \
    X(speed_most, 26, WH_CONF_REAL, RPM, 60.0, 400.0, ALONE, guard.target_max_radps, \
      "largest set-point") \
    X(speed_limit, 27, WH_CONF_REAL, RPM, 70.0, 400.0, ALONE, guard.limit_radps, \
      "the rig trips if a turn is faster; choose a speed that is safe for the shaft") \
    X(supply_least, 28, WH_CONF_REAL, VOLT, 1.0, 60.0, ALONE, guard.supply_min_V, \
      "a lower supply voltage trips") \
    X(supply_most, 29, WH_CONF_REAL, VOLT, 1.0, 60.0, ALONE, guard.supply_max_V, \
      "a higher supply voltage trips") \
    X(armed_time, 30, WH_CONF_REAL, SECOND, 1.0, 600.0, ALONE, armed_max_s, \
      "start is allowed for this time after arm") \
    X(rest_time, 31, WH_CONF_REAL, SECOND, 5.0, 600.0, ALONE, rest_max_s, \
      "longest time until the rotor is at rest") \
    X(stop_brakes, 32, WH_CONF_SWITCH, ONE, 0.0, 1.0, ALONE, stop_brakes, \
      "brake at a run's end and after stop; off: coast") \
    X(swings, 33, WH_CONF_SWITCH, ONE, 0.0, 1.0, ALONE, swings, \
      "end a run with a free swing that measures the sensors' angles") \
    X(host_loss_stops, 34, WH_CONF_SWITCH, ONE, 0.0, 1.0, ALONE, host_loss_stops, \
      "stop a run when the host is lost") \
    X(compensation, 35, WH_CONF_WHEN, ONE, 0.0, 2.0, ALONE, compensation_when, \
      "gravity compensation by the motor") \
    X(yields, 36, WH_CONF_REAL, KGM2, 0.0, 10.0, ALONE, measure.rotor.yields_kgm2, \
      "variation of inertia on a yielding mount; needs gravity 0") \
    X(no_load_speed, 45, WH_CONF_REAL, RPM, 200.0, 2000.0, ALONE, run.no_load_radps, \
      "speed of the motor without load at its rated voltage") \
    X(rated_voltage, 46, WH_CONF_REAL, VOLT, 3.0, 60.0, ALONE, run.rated_V, \
      "rated voltage of the motor") \
    X(stall_torque, 47, WH_CONF_REAL, NM, 0.05, 50.0, ALONE, compensation.stall_Nm, \
      "torque of the motor at standstill and rated voltage") \
    X(host, 48, WH_CONF_WHOLE, SECOND, 0.0, 3600.0, ALONE, host_max_s, \
      "the host counts as lost after this time without a byte; 0: never")

#endif
