/* find.h: a built-in scene or mechanism by its name. */
#ifndef COMMANDS_FIND_H
#define COMMANDS_FIND_H

#include "host/lang/builtin.h"
#include "host/lang/model.h"

/* Look for `target`, SCENE, MECHANISM or MECHANISM:SCENE, in models [count]. *found is then parsed (free with
 * model_free()), *from is its entry, and *name, within `target`, what source_pick() shall look for.
 * Returns an exit code; what is wrong (unknown, or in more than one model) is said on standard error. */
int find_builtin(const struct builtin_model *models, size_t count, const char *target,
                 diags *errors, whirl_model **found, const struct builtin_model **from,
                 const char **name);

#endif
