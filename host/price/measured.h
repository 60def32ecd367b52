/* measured.h: prices that were counted, where Whirl's source tree and a board's compiler and emulator are: the line that
 * counts is the one that people are told (table_measure_line()). */
#ifndef PRICE_MEASURED_H
#define PRICE_MEASURED_H

#include "table_text.h"

typedef enum measured_end {
    MEASURED_COUNTED,
    MEASURED_REFUSED, /* the setting cannot be built, linked or run there; it has no price then */
    MEASURED_MISSING  /* a tool is */
} measured_end;

typedef struct measured_price {
    char options[SETTING_TEXT];
    deviation_pace pace; /* any, where the price does not vary with it */
    cost cost;           /* no price where the setting is refused */
} measured_price;

typedef struct measured_prices {
    const table_words *words;
    measured_price *price; /* [count] */
    int count;
} measured_prices;

/* Is the working folder the root of a source tree? */
bool measured_here(void);
void measured_free(measured_prices *m);
bool measured_has(const measured_prices *m, const setting *s, deviation_pace pace);
/* In place of what is predicted: what was counted, if it was. */
void measured_tell(const measured_prices *m, const setting *s, deviation_pace pace, cost *c);
/* Count the steps of a setting; seconds. `predicted` says what counting does not. */
measured_end measured_count(measured_prices *m, const trials *t, const setting *s,
                            deviation_pace pace, int point, const cost *predicted);

#endif
