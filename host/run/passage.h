/* passage.h: when a difference that is looked at again and again first passed each level. */
#ifndef TRUST_PASSAGE_H
#define TRUST_PASSAGE_H

/* Behind `time_s` it was for the first time as large as `size`. */
typedef struct passage {
    double time_s;
    double size;
} passage;

typedef struct passages {
    passage *passed; /* [count] rising in both */
    int count;
    int room;
    double most;
} passages;

/* Levels are told apart to this part of themselves. */
#define PASSAGE_GRAIN 1e-3

/* The difference is `size` at one look, the look before that was at before_s. What is no number passes every level. */
void passages_enter(passages *p, double before_s, double size);
void passages_free(passages *p);

/* The last look before it was more than `level`; infinite where it never was. */
double passages_until_s(const passages *p, double level);

#endif
