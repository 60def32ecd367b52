/* builtin.h: the models built into the program: copies of the files in core/models, by mk/setup/embed_models.sh. */
#ifndef LANG_BUILTIN_H
#define LANG_BUILTIN_H

#include <stddef.h>

struct builtin_model {
    const char *file; /* path within the project, for messages: "core/models/NAME.whirl" */
    const char *text; /* UTF-8; every line ends in a line feed; NUL-terminated */
    size_t length;    /* without the final NUL */
};

/* [builtin_model_count], ordered by file name, followed by one zero entry. */
extern const struct builtin_model builtin_models[];
extern const size_t builtin_model_count;

/* Like builtin_models, but the descriptions of figures, mk/figures/NAME.fig (host/io/plot.h). */
extern const struct builtin_model builtin_figures[];
extern const size_t builtin_figure_count;

#endif
