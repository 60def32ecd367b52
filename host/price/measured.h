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

/* Of a scene with contacts all steps of its run are counted, at each place of a range: mean and longest are its price. */
typedef struct measured_run {
    double steps; /* counted, of all places; 0: these were no whole runs */
    double
        instructions_bound; /* the most that a step is declared to take (docs/dev/events.md); 0: not known */
    double cycles_bound; /* the same; 0: not known, or nobody counts cycles there */
} measured_run;

typedef struct measured_price {
    char options[SETTING_TEXT];
    deviation_pace pace; /* any, where the price does not vary with it */
    cost cost;           /* no price where the setting is refused */
    measured_run run;
} measured_price;

/* What a run with contacts took beside what was expected of it: the next are expected by that. */
typedef struct measured_lesson {
    double share;                               /* of its longest step; 0: none was counted yet */
    double flash_bytes, ram_bytes, stack_bytes; /* more than a step without events */
} measured_lesson;

typedef struct measured_prices {
    const table_words *words;
    measured_price *price; /* [count] */
    int count;
    bool by_run; /* prices are those of whole runs, which each pace has for itself */
    measured_lesson lesson[COST_NUMBERS]; /* of the run that was counted last */
} measured_prices;

/* Why can nothing be counted on a board? NULL where it can; what is compiled once for it is then there. `text` has room for
 * the answer. */
enum { MEASURED_TEXT = 160 };
const char *measured_missing(const cost_board *board, char text[MEASURED_TEXT]);
/* Runs with contacts are counted in emulators, and not on a PC. */
bool measured_takes_runs(const cost_board *board);
/* Is a number counted there? Double is none of an AVR's compiler, and fixed point is for boards. */
bool measured_takes(const cost_board *board, const setting *s);
void measured_free(measured_prices *m);
/* Of a setting's number. */
measured_lesson *measured_lesson_of(measured_prices *m, const setting *s);
bool measured_has(const measured_prices *m, const setting *s, deviation_pace pace);
/* In place of what is predicted: what was counted, if it was. */
void measured_tell(const measured_prices *m, const setting *s, deviation_pace pace, cost *c);
measured_run measured_run_of(const measured_prices *m, const setting *s, deviation_pace pace);
/* Count the steps of a setting; seconds. `predicted` says what counting does not. `point` is of no matter to whole runs. */
measured_end measured_count(measured_prices *m, const trials *t, const setting *s,
                            deviation_pace pace, int point, const cost *predicted);

#endif
