/* rig_time.h: hal/clock.h's time on board_ticks(), of boards whose clock is that of the captures. */
#ifndef BOARDS_SHARED_RIG_TIME_H
#define BOARDS_SHARED_RIG_TIME_H

#include <stdbool.h>

/* The clock goes on, within some microseconds: waiting for one that does not would never end. */
bool board_ticks_go_on(void);

#endif
