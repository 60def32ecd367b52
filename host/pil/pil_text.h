/* pil_text.h: what a run in the loop was, in words. */
#ifndef PIL_PIL_TEXT_H
#define PIL_PIL_TEXT_H

#include "report.h"

/* `im` is the plant's; NULL: it was a tape. */
void pil_print(FILE *out, const lockstep_wish *wish, const image *im, const lockstep_report *r);

#endif
