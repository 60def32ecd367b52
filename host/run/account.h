/* account.h: an account of a run's books, of the energy or of a momentum: the one place of what balances, of the signs
 * and of the words.
 *
 *     left over = level now - level at the start - sum of the entries
 *
 * An entry is positive where it gives (the work of a motor, a push along a coordinate) and negative where it takes (a
 * damper, an impact). An exact solution leaves nothing over. Who enters: the books beside a run (books.h) what they
 * integrate themselves, and what the run itself kept (ledger_read.h). */
#ifndef RUN_ACCOUNT_H
#define RUN_ACCOUNT_H

#include <stdio.h>

typedef struct book_account {
    double level[2]; /* at the start, now */
    double left;     /* left over, with what was entered so far */
    double largest;  /* size of the largest entry */
} book_account;

book_account account_of(const double level[2]);
void account_enter(book_account *a, double given);

/* The columns that the text of a line gets. */
#define ACCOUNT_WIDTH 44

void account_print_level(FILE *out, const char *text, const double level[2]);
/* `more` stands behind it, or is "". */
void account_print_entry(FILE *out, const char *text, double given, const char *more);
/* The last two lines: the change, and what of it is left over. */
void account_print_end(FILE *out, double change, double left);

#endif
