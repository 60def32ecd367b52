/* resumable_csv.h: the CSV file of a sweep, which a later run of the same sweep can continue.
 *
 * FILE.sweep, next to FILE, has the sweep's settings, a line each, that determine every byte of FILE. FILE
 * itself stays plain. A run continues a FILE with the same settings, header and swept values, and drops an
 * incomplete last line. It refuses any other FILE. While a sweep writes FILE it holds a lock on it. Lines
 * "noted: WORD" at the end of FILE.sweep have the findings of existing rows. */
#ifndef STUDY_RESUMABLE_CSV_H
#define STUDY_RESUMABLE_CSV_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct resumable_csv {
    FILE *out;
    const char *path;
    bool is_file;    /* not standard output, a pipe or a device: can be gone on with */
    uint64_t rows;   /* already there */
    uint64_t failed; /* rows with empty measures */
    char *beside;    /* FILE.sweep */
    char *notes;     /* its lines "noted: WORD"; "" without any */
} resumable_csv;

typedef struct resumable_csv_settings {
    const char *path;        /* "-" is standard output */
    const char *fingerprint; /* lines of "name: value" */
    const char *header;      /* header with its line's end, or "" */
    uint64_t rows;           /* the whole sheet has, without the header */
    int measures;            /* fields after the swept ones; the first is empty if a point failed */
    /* The swept fields of row `row`, as in the file. */
    void (*swept)(const void *context, uint64_t row, FILE *out);
    const void *context;
    bool fresh; /* start again, even over existing rows */
} resumable_csv_settings;

/* Opens and checks the file; writes a missing header. Returns an exit code: 0 good, 1 the file
 * could not be written, 2 it is another sweep's or in use (reported on standard error). */
int resumable_csv_open(resumable_csv *sh, const resumable_csv_settings *s);
/* Stores this word with the rows. False if it was not written (reported). */
bool resumable_csv_note(resumable_csv *sh, const char *word);
bool resumable_csv_has_note(const resumable_csv *sh, const char *word);
/* False if something was not written (reported). */
bool resumable_csv_close(resumable_csv *sh);

#endif
