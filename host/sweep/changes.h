/* changes.h: the swept values of one point as changes of the command line. */
#ifndef SWEEP_CHANGES_H
#define SWEEP_CHANGES_H

#include "grid.h"
#include "host/lang/model.h"

/* Those of `base` with the point's values behind them and so over them. Numbers of 17 digits: none is lost. Free with
 * changes_forget(). */
overrides changes_at(const grid *g, const overrides *base, uint64_t point);
void changes_forget(const overrides *base, overrides *changes);

#endif
