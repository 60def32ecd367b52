/* reference_run.h: what the runs that are priced are held against: the motion at evenly spaced records, computed twice, by
 * settings of their own. What the two differ by says how far the reference is to be trusted, and until when.
 *
 * Without contacts: by extrapolation in long double (extrapolation.h), which shares the operation list with what it
 * judges, and nothing else. With contacts, or where a jump or a pole stops that: by steps of RK4 in double with
 * compensated sums far finer than the scene's, against half as many. */
#ifndef STUDY_REFERENCE_RUN_H
#define STUDY_REFERENCE_RUN_H

#include "host/io/records.h"

/* A cheap reference: a run in double with compensated sums, compared with one of twice its step. */
typedef struct reference_steps {
    uint64_t steps; /* in a record's spacing, even; 0: not wanted, but the best reference */
    wh_method method;
    int order;    /* by which its error falls as the step gets shorter */
    double limit; /* it is trusted while the two differ by less of a component's largest value */
} reference_steps;

typedef struct reference_wish {
    const image *image;  /* whatever its step and end are */
    whole_ratio spacing; /* of the records, s */
    int records;         /* behind the start */
    double operations;   /* most that each of the two computations may evaluate */
    reference_steps by;
} reference_wish;

typedef enum reference_kind {
    REFERENCE_NONE, /* nothing that could be trusted: `why` */
    REFERENCE_EXTRAPOLATED,
    REFERENCE_FINE_STEPS
} reference_kind;

/* What a column's numbers are. */
typedef struct reference_column {
    bool
        counts; /* among the worst of all components: a value or rate that the reference knows at all */
    long double largest; /* size, over the records */
    long double off;     /* the most that the two computations differ by */
} reference_column;

typedef struct reference {
    reference_kind kind;
    records *shape;           /* names and units of the columns, as `whirl run --csv` has them */
    int columns;              /* those of the shape; column 0 is the time */
    int wanted;               /* records behind the start that were asked for, */
    int records;              /* and those that can be trusted */
    long double *row;         /* [wanted + 1][columns] in the units of the columns */
    reference_column *column; /* [columns] */
    double limit; /* a record is trusted while no column differs by more of its largest value */
    char *how;    /* the two settings, in words */
    char *why;    /* what ends the trust before the end, in words; or there is none at all; "" */
    bool broken;  /* it ends early for want of small steps, not because the motion runs apart */
    bool still;   /* there is none, because nothing moves */
    bool stopped; /* interrupted: it is of no use */
} reference;

/* Always succeeds; look at kind and stopped. The image must outlive it. */
reference *reference_new(const reference_wish *w);
/* From now on only so many records behind the start count; no more than there are. */
void reference_cut(reference *r, int until);
/* The most that the two computations differ by, of the columns that count, as a part of their largest values. */
double reference_agreement(const reference *r);
void reference_free(reference *r); /* NULL is fine */

/* The column of a name, "X", "X'" or an output's; -1: there is none. *noisy: it is an output with noise of its own,
 * which no reference can have. */
int reference_find(const reference *r, const char *name, bool *noisy);

/* A state in long double as a row of records. */
typedef struct long_rows long_rows;

long_rows *long_rows_new(const records *shape); /* which must outlive it */
void long_rows_free(long_rows *l);
/* row[shape->columns], in their units; `state` as engine_kind.state() has it, angles first. */
void long_rows_read(long_rows *l, const long double *state, long double time_s, long double *row);

/* A reference by the interpreter: RK4 in double with compensated sums, by steps far finer than the scene's. It shares much
 * with the runs that it judges.
 *
 * The steps of a record's spacing: the wished ones; else those that are fine enough for the scene and within the operations, for the finer of
 * the two computations; even. */
uint64_t fine_steps_of(const reference_wish *w);
/* Fills row[(wanted + 1)][columns] by so many steps a record; returns the records behind the start. */
int fine_steps_run(const reference_wish *w, const records *shape, uint64_t steps, long double *row);

/* === the deviation of a run =================================================================== */
/* How far a run is off its reference. */

/* How a step lies in the records: so many steps in so many spacings, one of the two being 1. Where a step is longer than a
 * spacing, only the records at its ends are looked at. */
typedef struct deviation_pace {
    uint64_t steps;
    uint64_t records;
} deviation_pace;

/* What of it is looked at. */
typedef struct deviation_of_what {
    int column; /* of the reference, in the column's unit; or -1: each that counts, as a part of its largest value */
    double give_up; /* a run that is off by more is of no use: it is not run on */
} deviation_of_what;

typedef struct deviation {
    bool
        usable; /* it came to the end without being off by more than give_up, and nothing was held at an end of its range */
    double error; /* the largest of all records; where it is not usable, that of those it came to */
    int column;   /* where */
    double
        known; /* and how well the reference knows that column there: errors near it are no more than bounds */
    double operations;       /* evaluated: what it took */
    double evaluations;      /* of the accelerations, or of the matrix, a simulated second */
    double evaluations_most; /* in one step */
} deviation;

/* `im`: the reference's scene, with a step of this pace. */
deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what);

#endif
