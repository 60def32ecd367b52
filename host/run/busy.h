/* busy.h: what the contacts of a run do, step by step, as far as it may be too much for its steps: how many of them had
 * more moments with events than a step takes (core/contact.h), and whether a contact changes its mode at the pace of the
 * steps. Where the run was at some times is kept beside it, to be held against a run in finer steps (retrial.h). None of
 * it touches the run. */
#ifndef RUN_BUSY_H
#define RUN_BUSY_H

#include "engine.h"

/* Times at which the state is kept, evenly over the run. */
#define BUSY_LOOKS 32
/* A contact that changed its mode in so many of so many steps on end has changed at their pace: a hold or a resting stop
 * that let go or took hold, a friction that stuck, broke loose or turned. A bounce changes no mode. */
#define BUSY_CHANGES 4
#define BUSY_WINDOW 16

typedef struct busy {
    const image *image;
    uint64_t parts; /* steps in one of the run that is judged: 1, of that run itself */
    uint64_t steps; /* done */
    uint64_t overruns;
    uint64_t overran_at;                     /* steps before the first of them */
    uint64_t in_overruns[WH_CONTACTS_LIMIT]; /* events of each contact in them */
    double energy_J;                         /* after the last step, as the books have it */
    double taken_J; /* by how much it changed in steps that overran, in all */
    int mode[WH_CONTACTS_LIMIT];
    uint32_t
        changed[WH_CONTACTS_LIMIT]; /* in which of the last steps, as bits, the last the lowest */
    uint64_t changes[WH_CONTACTS_LIMIT]; /* steps with one, in such windows */
    uint64_t chatters_at;                /* steps before the first such window */
    int chatters;                        /* the contact whose it is; -1: none does */
    int n;                               /* components of the state */
    int looks;
    double *look; /* [looks * n] */
    double *low;  /* [n] over all steps */
    double *high; /* [n] */
} busy;

/* Of a run whose steps are 1/`parts` of those of the one that is judged; NULL without contacts. */
busy *busy_open(const image *im, uint64_t parts);
void busy_close(busy *b); /* NULL is fine */
/* Enter the state after each step, the start included. `energy_J`: what is booked then; 0 where there are no books. */
void busy_enter(busy *b, const engine_kind *kind, const void *run, double energy_J);

/* The most that a position of `b` is off that of `truth` at the times that both have kept, as a part of how far it went
 * there; of what hardly moves, of a thousandth of how far others of its unit went. */
double busy_off(const busy *b, const busy *truth);

#endif
