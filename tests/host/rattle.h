/* rattle.h: mechanisms that may have more events than a step can resolve, and whose motions have closed forms: a
 * ball between two stops, a hold that ends its own condition, a body with stick-slip. */
#ifndef TESTS_HOST_RATTLE_H
#define TESTS_HOST_RATTLE_H

#include "command.h"
#include "linkage.h"

#include <stdbool.h>

typedef enum rattle_kind { BALL, HOLD, BELT, KINDS } rattle_kind;

/* A mechanism whose motion has a closed form. rattle_truth_m() continues the motion from the state that is stored
 * here. */
typedef struct rattle {
    rattle_kind kind;
    /* ball: gap, gravity, restitution below, restitution above;
     * hold: threshold, acceleration;
     * belt: stiffness, speed, static friction, kinetic friction */
    double number[6];
    double step_s;
    int steps;
    double at_s; /* time of the ball's last impact */
    double place_m;
    double speed_mps;
} rattle;

rattle rattle_drawn(dice *d, rattle_kind kind);
void rattle_write(const rattle *r, char text[static LINKAGE_TEXT]);
/* Writes the mechanism with the energy balance and a second body. The second body is slowed down by a damper if
 * `damped`, else it is on a spring. The step may be too coarse for the second body. */
void rattle_write_beside(const rattle *r, bool damped, double rate_radps, double size_m,
                         char text[static LINKAGE_TEXT]);
/* The true position at time t. The times of successive calls must rise. */
double rattle_truth_m(rattle *r, double t);

#endif
