/* choice_price.h: what a setting is taken to cost while one is chosen. */
#ifndef PRICE_CHOICE_PRICE_H
#define PRICE_CHOICE_PRICE_H

#include "choice_wish.h"

/* As trial_cost(), or trial_any_cost() where `any` step will do. Where nothing is counted, what is predicted. Else what was
 * counted of it; and of the rest, since whatever is chosen is counted before it is told, no more than is likely: the best one number
 * of a step's time, the least bytes; where nobody predicts, the same setting's in float; with contacts, a step's without
 * an event. */
cost choice_price(trials *t, const choice_wish *w, const setting *s, deviation_pace pace, bool any,
                  bool *own);

/* With contacts: is what a run takes known, or to be expected, by its steps? */
bool choice_prices_runs(const choice_wish *w);
/* Its price then, once it was run: what was counted; or by the evaluations of the step that took most of them, and of all.
 * `step` is that of a step without an event. */
cost choice_price_of_run(const trials *t, const choice_wish *w, const setting *s,
                         deviation_pace pace, const cost *step, const trial_result *r);
/* Would its run take too long to be counted? */
bool choice_run_is_long(const trials *t, deviation_pace pace, const cost *run);
/* A row as it was before it was counted: what its run's longest step took of what was expected of it, the next ones' are
 * expected by. */
void choice_learn_run(measured_prices *m, const choice_row *row);

#endif
