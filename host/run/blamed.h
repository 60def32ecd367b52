/* blamed.h: the expressions of a file (image_blame in host/image/image.h) at one state, node by node. */
#ifndef RUN_BLAMED_H
#define RUN_BLAMED_H

#include "engine.h"

typedef struct blamed {
    const image *image;
    double **state; /* [unknowns][order + 1] value, rate, ... */
    double *input;  /* [inputs] as they start */
    double *value;  /* [blame.nodes] */
} blamed;

blamed blamed_open(const image *im);
void blamed_close(blamed *b);

/* The components of a state, as engine_kind.state() gives them; what is none of them stays. */
void blamed_place(blamed *b, const double *angle_rad, const double *real);
/* The value of a node whose operands have theirs. */
double blamed_node(const blamed *b, const blame_node *n);
/* Its operands, and how many it has. */
int blamed_operands(const blame_node *n, int of[static 2]);
/* [node + 1]: the nodes that this one is made of, itself among them; the caller frees it. */
bool *blamed_parts(const image *im, int node);

#endif
