/* resumable_csv.h: the CSV file of a sweep, which a later run of the same sweep goes on with.
 *
 * Beside FILE stands FILE.sweep: the sweep's settings, a line each, that decide every byte of FILE.
 * FILE itself stays plain. A run goes on with a FILE whose settings, header and swept values are
 * its own, drops a last line that was torn off, and refuses any other. While a sweep writes FILE it
 * holds a lock on it. Lines "noted: WORD" at the end of FILE.sweep keep the findings of rows that are there. */
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
    uint64_t failed; /* of them, with empty measures */
    char *beside;    /* FILE.sweep */
    char *notes;     /* its lines "noted: WORD"; "" for none */
} resumable_csv;

typedef struct resumable_csv_settings {
    const char *path;        /* "-" is standard output */
    const char *fingerprint; /* lines of "what: value" */
    const char *header;      /* with its line's end; "" for none */
    uint64_t rows;           /* the whole sheet has, without the header */
    int measures; /* fields behind the swept ones; the first is empty where a point failed */
    /* The swept fields of row `row`, as they stand in the file. */
    void (*swept)(const void *context, uint64_t row, FILE *out);
    const void *context;
    bool fresh; /* start anew, whatever is there */
} resumable_csv_settings;

/* Open and check; the header is written when it is not there yet. Returns an exit code: 0 good,
 * 1 the file could not be written, 2 it is another sweep's or in use (said on standard error). */
int resumable_csv_open(resumable_csv *sh, const resumable_csv_settings *s);
/* Keep this word beside the rows. False when it was not written (said). */
bool resumable_csv_note(resumable_csv *sh, const char *word);
bool resumable_csv_has_note(const resumable_csv *sh, const char *word);
/* False when something was not written (said). */
bool resumable_csv_close(resumable_csv *sh);

#endif
