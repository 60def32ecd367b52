/* rig_time.h: the time of hal/clock.h from board_ticks(), for boards whose clock also stamps the captures. */
#ifndef BOARDS_SHARED_RIG_TIME_H
#define BOARDS_SHARED_RIG_TIME_H

#include <stdbool.h>

/* True if the clock advances within some microseconds. Waiting for a stopped clock would never end. */
bool board_ticks_go_on(void);

#endif
