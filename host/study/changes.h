/* changes.h: the swept values of one point as changes of the command line. */
#ifndef STUDY_CHANGES_H
#define STUDY_CHANGES_H

#include "grid.h"
#include "host/lang/model.h"

/* Those of `base` with the point's values behind them and so over them. Numbers of 17 digits: none is lost. Free with
 * changes_forget(). */
overrides changes_at(const grid *g, const overrides *base, uint64_t point);
void changes_forget(const overrides *base, overrides *changes);

/* False, told on standard error, where an axis varies what takes no part in `base`: it would give the same run again and
 * again. */
bool changes_take_part(const grid *g, const instance *base);
/* False, told, where `base` sets what an axis varies: one value would take the place of the other. */
bool changes_are_apart(const grid *g, const overrides *base);

#endif
