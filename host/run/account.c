/* account.c: see account.h. */
#include "account.h"

#include <math.h>

#include "host/number/zero.h"

book_account account_of(const double level[2]) {
    return (book_account){.level = {level[0], level[1]}, .left = level[1] - level[0]};
}

void account_enter(book_account *a, double given) {
    a->left -= given;
    a->largest = fabs(given) > a->largest ? fabs(given) : a->largest;
}

void account_print_level(FILE *out, const char *text, const double level[2]) {
    fprintf(out, "  %-*s %.9g -> %.9g\n", ACCOUNT_WIDTH, text, level[0], level[1]);
}

void account_print_entry(FILE *out, const char *text, double given, const char *more) {
    fprintf(out, "  %-*s %+.9g%s\n", ACCOUNT_WIDTH, text, number_shown(given), more);
}

void account_print_end(FILE *out, double change, double left) {
    account_print_entry(out, "change", change, "");
    fprintf(out, "  %-*s %+.2e (numerical)\n", ACCOUNT_WIDTH, "left over", left);
}
