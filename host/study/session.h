/* session.h: one call of `whirl sweep`, which computes the rows that its CSV file still lacks. */
#ifndef STUDY_SESSION_H
#define STUDY_SESSION_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "host/base/json.h"
#include "host/study/point.h"

/* === a CSV file that is continued ============================================================= */
/* The CSV file of a sweep, which a later run of the same sweep can continue.
 *
 * FILE.sweep, next to FILE, lists the settings that determine every byte of FILE. After them, lines "noted: WORD" list
 * the findings of existing rows. A sweep continues FILE if settings, header and swept values are the same, and drops an
 * incomplete last line. It refuses any other FILE. A sweep locks FILE while it writes. */

typedef struct resumable_csv {
    FILE *out;
    const char *path;
    bool is_file;    /* it can be continued: not standard output, a pipe or a device */
    uint64_t rows;   /* number of existing rows */
    uint64_t failed; /* number of existing rows with empty measures */
    char *beside;    /* FILE.sweep */
    char *notes;     /* lines "noted: WORD" of FILE.sweep; "" if there are none */
} resumable_csv;

typedef struct resumable_csv_settings {
    const char *path;        /* "-" is standard output */
    const char *fingerprint; /* lines of "name: value" */
    const char *header;      /* header with its line's end, or "" */
    uint64_t rows;           /* number of rows of the complete file, without the header */
    int measures;            /* number of fields after the swept fields */
    /* The swept fields of row `row`, as in the file. */
    void (*swept)(const void *context, uint64_t row, FILE *out);
    const void *context;
    bool fresh; /* start again, even if the file has rows */
} resumable_csv_settings;

/* Opens and checks the file, and writes a missing header. Returns an exit status, and reports an error. 1: the file
 * could not be written. 2: it belongs to another sweep, is in use, or cannot be opened. */
int resumable_csv_open(resumable_csv *sh, const resumable_csv_settings *s);
/* Returns false if something was not written (reported). */
bool resumable_csv_close(resumable_csv *sh);

/* === the axes of a sweep ====================================================================== */
/* The declared unit of an axis if it is an SI unit, else the axis's SI unit. The caller frees the text. */
char *sweep_axis_unit(const axis *a);
/* Writes name and unit of each axis as JSON (docs/warnings.md has the schema). */
void sweep_json_axes(json *j, const grid *g);

/* === everything that decides the bytes of a sweep's CSV, as lines of text ===================== */

typedef struct shard {
    uint64_t number; /* number of this shard, from 1 */
    uint64_t of;     /* number of shards */
} shard;

/* `base`: the instance before the sweep changes its values. `im`: its image. The caller frees the result. */
char *fingerprint_make(const sweep *s, const char *model_text, const instance *base,
                       const image *im, shard part);

/* === running the points ======================================================================= */

/* Draws the progress line again. `done` of `end` points are done; `elapsed_s` ago, `from` points were done. */
void sweep_progress(FILE *out, uint64_t from, uint64_t done, uint64_t end, double elapsed_s);

typedef struct session_settings {
    const char *csv;         /* file, or "-" for standard output */
    const char *fingerprint; /* from fingerprint_make() */
    uint64_t first;          /* points first <= point < end */
    uint64_t end;
    bool header; /* the rows have a header */
    int jobs;    /* worker processes */
    bool fresh;
    bool quiet;
    bool json; /* JSON goes to standard output; `csv` is then /dev/null */
} session_settings;

/* Returns an exit status (host/base/exit.h), reported on standard error. EXIT_RUN_FAILED: points failed, findings fail
 * the sweep, or rows could not be written. EXIT_BAD_INPUT: the file belongs to another sweep. */
int session_run(const sweep *s, const session_settings *settings);

#endif
