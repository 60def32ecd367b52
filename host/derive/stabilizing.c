#include "stabilizing.h"

static const char no_stabilized[] = "leave out --stabilized";

bool stabilizing_possible(const layout *map, const contact_lists *contacts, const poly *integral,
                          const image_settings *settings, diags *errors) {
    const mechanism *m = map->equations->instance->mechanism;
    if (m->is_system) {
        diag_error(errors, m->at, no_stabilized,
                   "--stabilized gives back what the energy drifts by: '%s' is given by equations "
                   "and has none",
                   m->name);
    } else if (contacts != NULL) {
        const contact_statement *first = contacts->row[0].from;
        diag_error(errors, first->at, "leave it out, --without; or leave out --stabilized",
                   "--stabilized: '%s' has events, and their energies are taken as they happen",
                   m->name);
    } else if (settings->matrix != MATRIX_NONE) {
        diag_error(errors, m->at, "leave out --matrix, or --stabilized",
                   "--stabilized wants the stages of a step, and a matrix has none");
    } else if (wh_methods[settings->method].takes == WH_NO_RATES) {
        diag_error(errors, m->at, "choose another --method, or leave out --stabilized",
                   "--stabilized keeps books, and %s none: its kicks know no rates",
                   wh_methods[settings->method].title);
    } else if (settings->method == WH_SEMI_IMPLICIT_EULER) {
        diag_error(errors, m->at, "choose another --method, or leave out --stabilized",
                   "--stabilized gives back what the energy drifts by, and with %s it goes up and "
                   "down about the right one instead",
                   wh_methods[settings->method].title);
    } else if (map->form != WH_SECOND_ORDER) {
        diag_error(errors, m->at, "--without conserve, or leave out --stabilized",
                   "--stabilized keeps books, which a coordinate that is integrated from its "
                   "momentum has not");
    } else if (integral != NULL) {
        diag_error(errors, m->at, no_stabilized,
                   "--stabilized: the kinetic energy of '%s' is no quadratic form of its rates",
                   m->name);
    } else {
        return true;
    }
    return false;
}

bool stabilizing_conserves(const ledger_lists *books, const equations *e, diags *errors) {
    for (int i = 0; i < books->smooth; i++) {
        if (books->entry[i].account == 0) {
            diag_error(errors, *books->entry[i].at,
                       "leave it out, --without; or leave out --stabilized",
                       "--stabilized is for what nothing drives or damps: this does");
            return false;
        }
    }
    if (books->inputs > 0) {
        diag_error(errors, e->instance->mechanism->at, no_stabilized,
                   "--stabilized is for what nothing drives or damps: the energies of '%s' name an "
                   "input",
                   e->instance->mechanism->name);
        return false;
    }
    return true;
}
