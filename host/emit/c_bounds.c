#include "c_bounds.h"

#include "core/contact.h"

int c_bound_evaluations(int stages, int stops, int forced) {
    return WH_CONTACT_EVALUATIONS(stages, stops, forced);
}

int c_bound_signals(int forced, int crossings) { return WH_CONTACT_SIGNALS(forced, crossings); }
