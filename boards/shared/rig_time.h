/* rig_time.h: hal/clock.h, implemented with board_ticks(), for boards whose clock also stamps the captures. */
#ifndef BOARDS_SHARED_RIG_TIME_H
#define BOARDS_SHARED_RIG_TIME_H

#include <stdbool.h>

/* True if the clock advances within some microseconds; waiting for a stopped clock would never end. */
bool board_ticks_go_on(void);

#endif
