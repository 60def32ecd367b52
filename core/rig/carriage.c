/* carriage.c: the rig on a carriage that moves freely along a level rail. */
#include "carriage.h"

#include "datasheet.h"

/* Tolerance of the rotor's inertia, which gravity does not show here. */
#define YIELDS_TOLERANCE WH_R(0.1)

void wh_carriage_mount(wh_rig_config *config, const wh_carriage *carriage) {
    wh_rotor_config *rotor = &config->measure.rotor;
    const wh_real moment = WH_RIG_UNBALANCE_AT_KGM(carriage->disc_m);
    const wh_real part = WH_R(1.0) / (WH_R(1.0) + carriage->ratio);
    rotor->unbalance_kgm = moment;
    rotor->inertia_kgm2 = WH_RIG_INERTIA_AT_KGM2(carriage->disc_m);
    rotor->gravity_mps2 = WH_R(0.0);
    rotor->yields_kgm2 = moment * moment / WH_RIG_ECCENTRIC_KG * carriage->ratio * part;
    rotor->yields_tolerance = YIELDS_TOLERANCE;
    config->measure.result.mount_factor = part;
    config->guard.load_still_kgm = WH_R(0.1) * moment * part;
    config->observer.scene = NULL;
    config->feeds = WH_COMPENSATION_NEVER;
}

wh_real wh_carriage_displacement_m(const wh_rig_config *config, const wh_carriage *carriage,
                                   const wh_measured *force) {
    /* the expected force is the part S <w^2> */
    const wh_real square = force->expected_N / (config->measure.result.mount_factor *
                                                config->measure.rotor.unbalance_kgm);
    return square > WH_R(0.0)
               ? force->amplitude_N * carriage->ratio / (WH_RIG_ECCENTRIC_KG * square)
               : WH_R(0.0);
}
