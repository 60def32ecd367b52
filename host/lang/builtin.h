/* builtin.h: the models that are part of the program: the files of core/models, as they were when it
 * was built. The definitions are generated (mk/setup/embed_models.sh). */
#ifndef LANG_BUILTIN_H
#define LANG_BUILTIN_H

#include <stddef.h>

struct builtin_model {
    const char *file; /* path within the project, for messages: "core/models/NAME.whirl" */
    const char *text; /* UTF-8, every line ended by a line feed, and a NUL behind the last */
    size_t length;    /* bytes without that NUL */
};

/* [builtin_model_count], in the order of their file names. One more entry, all zero, ends them. */
extern const struct builtin_model builtin_models[];
extern const size_t builtin_model_count;

/* The same of the descriptions of figures, mk/figures/NAME.fig (host/plot/figure_draw.h). */
extern const struct builtin_model builtin_figures[];
extern const size_t builtin_figure_count;

#endif
