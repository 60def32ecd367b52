/* quantities.h: physical quantities: their names in messages, if unambiguous, and their usual units. */
#ifndef LANG_QUANTITIES_H
#define LANG_QUANTITIES_H

/* Exponents of m, kg, s, A, K; its name in messages; its unit in hints; its unit in records and the balance. "" means
 * no name, or base units. */
#define QUANTITY_ROWS(X) \
    X(NUMBER, 0, 0, 0, 0, 0, "", "", "") \
    X(ANGLE, 0, 0, 0, 0, 0, "", "", "") \
    X(LENGTH, 1, 0, 0, 0, 0, "length", "", "") \
    X(MASS, 0, 1, 0, 0, 0, "mass", "", "") \
    X(TIME, 0, 0, 1, 0, 0, "time", "", "") \
    X(CURRENT, 0, 0, 0, 1, 0, "current", "", "") \
    X(TEMPERATURE, 0, 0, 0, 0, 1, "temperature", "", "") \
    X(AREA, 2, 0, 0, 0, 0, "area", "", "") \
    X(VOLUME, 3, 0, 0, 0, 0, "volume", "", "") \
    X(SPEED, 1, 0, -1, 0, 0, "speed", "", "") \
    X(ACCELERATION, 1, 0, -2, 0, 0, "acceleration", "", "") \
    X(FREQUENCY, 0, 0, -1, 0, 0, "frequency or angular speed", "rad/s", "") \
    X(ANGULAR_ACCELERATION, 0, 0, -2, 0, 0, "angular acceleration", "rad/s^2", "") \
    X(MOMENTUM, 1, 1, -1, 0, 0, "momentum", "", "") \
    X(FORCE, 1, 1, -2, 0, 0, "force", "N", "N") \
    X(ENERGY, 2, 1, -2, 0, 0, "energy or torque", "N*m", "N*m") \
    X(POWER, 2, 1, -3, 0, 0, "power", "W", "W") \
    X(INERTIA, 2, 1, 0, 0, 0, "moment of inertia", "", "") \
    X(ANGULAR_MOMENTUM, 2, 1, -1, 0, 0, "angular momentum", "", "N*m*s") \
    X(PRESSURE, -1, 1, -2, 0, 0, "pressure", "Pa", "") \
    X(STIFFNESS, 0, 1, -2, 0, 0, "", "N/m", "") \
    X(DAMPING, 0, 1, -1, 0, 0, "", "N*s/m", "") \
    X(VOLTAGE, 2, 1, -3, -1, 0, "voltage", "V", "V") \
    X(RESISTANCE, 2, 1, -3, -2, 0, "resistance", "ohm", "") \
    X(CHARGE, 0, 0, 1, 1, 0, "charge", "C", "") \
    X(CAPACITANCE, -2, -1, 4, 2, 0, "capacitance", "F", "") \
    X(INDUCTANCE, 2, 1, -2, -2, 0, "inductance", "H", "") \
    X(FLUX, 2, 1, -2, -1, 0, "", "", "") \
    X(FLUX_DENSITY, 0, 1, -2, -1, 0, "", "", "")

#define QUANTITY(id, ...) QUANTITY_##id,
typedef enum quantity_id { QUANTITY_ROWS(QUANTITY) } quantity_id;
#undef QUANTITY

#endif
