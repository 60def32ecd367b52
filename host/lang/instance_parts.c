/* instance_parts.c: what takes part in an instance. */
#include "model.h"

bool instance_has_term(const instance *of, const term *each) {
    return each->effect < 0 || of->with[each->effect];
}

bool instance_has_contact(const instance *of, const contact_statement *each) {
    return each->effect < 0 || of->with[each->effect];
}

bool instance_has_noise(const instance *of, const noise *each) {
    return each->effect < 0 || of->with[each->effect];
}

const effect *instance_lacks(const instance *of, const symbol *what) {
    return what->effect < 0 || of->with[what->effect] ? NULL
                                                      : &of->mechanism->effects[what->effect];
}
