/* about.h: what a run was, as lines of TOML for the file beside its records (host/plot/plot_run.h). */
#ifndef RUN_ABOUT_H
#define RUN_ABOUT_H

#include "engine.h"

/* Version, scene, step, method, state hash. Free it. */
char *about_facts(const image *im, const engine_kind *kind, const void *run);
/* Parameters and inputs, SI. Free it. */
char *about_tables(const image *im);

#endif
