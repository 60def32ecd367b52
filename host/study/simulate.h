/* simulate.h: one run from start to end, with records, balance, progress and summary. */
#ifndef STUDY_SIMULATE_H
#define STUDY_SIMULATE_H

#include <stdio.h>

#include "host/engine/engine.h"
#include "host/io/plot.h"

typedef struct simulation_settings {
    const engine_kind *kind;
    uint64_t every;      /* steps between records */
    const char *csv;     /* file, "-" for standard output, or NULL */
    const char *columns; /* file of plain columns, "-" for standard output, or NULL */
    const char *vcd;     /* file of a value change dump, "-" for standard output, or NULL */
    const char *plot;    /* a picture (host/io/gnuplot.h), or NULL */
    plot_choice choice;  /* the curves of the picture */
    plot_run *taken;     /* takes the data of a picture instead of drawing one; or NULL */
    const char *chosen;  /* words that say why this step was chosen, or NULL */
    const char *changes; /* changes of the scene, in words, or NULL */
    bool no_scene;       /* a bare mechanism */
    bool quiet;
    bool json;     /* one object on standard output in place of the summary (run_json.h) */
    double strict; /* argument of run_checks_fails() */
    bool progress;
} simulation_settings;

typedef enum simulation_result {
    SIMULATION_DONE,
    SIMULATION_FAILED,      /* diverged, or NaN; reported on standard error, records are kept */
    SIMULATION_INTERRUPTED, /* by the user (host/os/system.h) */
    SIMULATION_BAD_FILE     /* a file could not be written, or gnuplot failed; reported */
} simulation_result;

/* Standard output, or standard error if records go to standard output. */
FILE *simulation_summary(const simulation_settings *s);

typedef struct simulation_trust {
    unsigned fails;   /* the findings that fail the run, as bits (run_checks_fails()) */
    bool over_budget; /* the finer run would take too long */
    double left;      /* remaining operations of the checks' budget */
    bool still;       /* no coordinate moves */
    double until_s;   /* the run is accurate until this time; below 0: unknown */
} simulation_trust;

int simulation_status(simulation_result result, const simulation_trust *trust);

simulation_result simulate(const image *im, const simulation_settings *s, simulation_trust *trust);

#endif
