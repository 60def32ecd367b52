/* arkode.h: SUNDIALS' ARKStep with the classic tableau and a fixed step, one step a call. */
#include <arkode/arkode_arkstep.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

static int peer_slope(realtype t, N_Vector y, N_Vector dy, void *none) {
    (void)t;
    (void)none;
    slope(N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
}

static void *peer_new(N_Vector y, SUNContext context, double h) {
    double c[] = {0.0, 0.5, 0.5, 1.0};
    double a[] = {0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    double b[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    void *solver = ARKStepCreate(peer_slope, NULL, 0.0, y, context);
    ARKodeButcherTable classic = ARKodeButcherTable_Create(4, 4, 0, c, a, b, NULL);
    ARKStepSetTables(solver, 4, 0, NULL, classic);
    ARKodeButcherTable_Free(classic);
    ARKStepSetFixedStep(solver, h);
    return solver;
}

static N_Vector peer_state;
static void *peer_solver;

void naive_start(double y[]) {
    static SUNContext context;
    for (int i = 0; i < STATES; i++) {
        y[i] = 0.0;
    }
    if (context == NULL) {
        SUNContext_Create(NULL, &context);
    }
    peer_state = N_VMake_Serial(STATES, y, context);
    peer_solver = peer_new(peer_state, context, 1e-3);
}

void naive_step(double y[], double h) { /* fixed when it was made */
    double t;
    (void)y;
    (void)h;
    (void)ARKStepEvolve(peer_solver, 1e9, peer_state, &t, ARK_ONE_STEP);
}

void naive_read(double y[]) { (void)y; }
