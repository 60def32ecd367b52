/* extrapolation.h: the motion of an image without contacts by the method of Gragg, Bulirsch and Stoer in long double.
 * It extrapolates modified midpoint rules of 2, 4, ..., 2 k substeps to step zero by Aitken and Neville (Hairer,
 * Norsett and Wanner, Solving Ordinary Differential Equations I, II.9). It shares no step, sine or method with the
 * core. */
#ifndef STUDY_EXTRAPOLATION_H
#define STUDY_EXTRAPOLATION_H

#include "host/engine/engine.h"

typedef struct extrapolation extrapolation;

/* Accuracy: `columns` rules (order 2 columns). In each step the last two columns agree within `tolerance` of each
 * component's largest value so far. */
typedef struct extrapolation_setting {
    int columns; /* <= EXTRAPOLATION_COLUMNS */
    double tolerance;
} extrapolation_setting;
enum { EXTRAPOLATION_COLUMNS = 12 };

typedef enum extrapolation_status {
    EXTRAPOLATION_OK,
    EXTRAPOLATION_SMALL, /* no step is small enough: a jump, a pole, or no finite number */
    EXTRAPOLATION_LONG   /* more operations than it may take */
} extrapolation_status;

/* At the image's start. It must outlive this. `operations`: most that it may evaluate in all. */
extrapolation *extrapolation_new(const image *im, extrapolation_setting how, double operations);
void extrapolation_free(extrapolation *e);
/* On by span_s, which need not be a whole number of anything. */
extrapolation_status extrapolation_go(extrapolation *e, long double span_s);
/* The state: angles first, as engine_kind.state() has it; long as the extrapolation. */
const long double *extrapolation_state(const extrapolation *e);
double extrapolation_operations(const extrapolation *e);

#endif
