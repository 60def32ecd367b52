/* orders.h: what an order asks for, beside the state that life.h has: a supply, a rig at rest, a cause that is gone. */
#ifndef WH_RIG_ORDERS_H
#define WH_RIG_ORDERS_H

#include "rig.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_rig_refuses WH_NAME(wh_rig_refuses)

/* What is against an order that the state allows; WH_ALLOWED: nothing. */
wh_refusal wh_rig_refuses(const wh_rig_config *config, const wh_rig *rig,
                          const wh_rig_inputs *inputs, const wh_rig_order *order);

#ifdef __cplusplus
}
#endif

#endif
