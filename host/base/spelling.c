#include "host/base/spelling.h"

#include <stdio.h>
#include <string.h>

/* === well-formed, printable UTF-8 characters ================================================== */

size_t utf8_length(const char *text, size_t left) {
    const unsigned char first = (unsigned char)text[0];
    const unsigned char second = left > 1 ? (unsigned char)text[1] : 0;
    size_t length = 1;
    if (first >= 0xf0 && first <= 0xf4) {
        length = 4;
    } else if (first >= 0xe0 && first < 0xf0) {
        length = 3;
    } else if (first >= 0xc2 && first < 0xe0) {
        length = 2;
    } else if (first >= 0x80) {
        return 0;
    }
    if (length > left) {
        return 0;
    }
    for (size_t i = 1; i < length; i++) {
        if (((unsigned char)text[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    const int is_control = first == 0xc2 && second < 0xa0;
    const int is_overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
    const int is_no_character =
        (first == 0xed && second >= 0xa0) || (first == 0xf4 && second >= 0x90);
    return is_control || is_overlong || is_no_character ? 0 : length;
}

const char *ascii_hint(const char *text, size_t left, const char *otherwise) {
    static const char *const signs[][2] = {
        {"\xe2\x88\x92", "write -"}, {"\xe2\x80\x93", "write -"},  {"\xe2\x80\x99", "write '"},
        {"\xe2\x80\xb2", "write '"}, {"\xc3\x97", "write *"},      {"\xc2\xb7", "write *"},
        {"\xc2\xb2", "write ^2"},    {"\xc2\xb3", "write ^3"},     {"\xc2\xb0", "write deg"},
        {"\xce\xa9", "write ohm"},   {"\xe2\x84\xa6", "write ohm"}};
    for (size_t i = 0; i < sizeof signs / sizeof signs[0]; i++) {
        const size_t length = strlen(signs[i][0]);
        if (length <= left && memcmp(text, signs[i][0], length) == 0) {
            return signs[i][1];
        }
    }
    return otherwise;
}

/* === the known name closest to a misspelt one ================================================= */
/* Edit distance with swaps of neighbours (optimal string alignment). An edit costs 2, a change of case 1, so
 * that `x` finds `X` before `y`. */

enum { LENGTH_MAX = 64, OFFERS_MAX = 5000 };

static int lower(char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; }

static int smaller(int a, int b) { return a < b ? a : b; }

nearest nearest_start(const char *wanted, size_t length) {
    nearest search = {wanted, length, NULL, 0, 0};
    /* search.cost: a similar name must cost less; one edit costs 2 */
    search.cost = length <= 1 ? 2 : length < 6 ? 3 : 2 * (int)(length / 3) + 1;
    return search;
}

void nearest_offer(nearest *search, const char *candidate) {
    const char *a = search->wanted;
    const size_t rows = search->length;
    const size_t columns = strlen(candidate);
    const size_t gap = rows > columns ? rows - columns : columns - rows;
    if (rows > LENGTH_MAX || columns > LENGTH_MAX || 2 * gap >= (size_t)search->cost ||
        search->offers++ > OFFERS_MAX) {
        return;
    }
    int row[3][LENGTH_MAX + 1];
    int *before = row[0];
    int *last = row[1];
    int *now = row[2];
    for (size_t j = 0; j <= columns; j++) {
        last[j] = 2 * (int)j;
        before[j] = 0;
    }
    for (size_t i = 1; i <= rows; i++) {
        now[0] = 2 * (int)i;
        for (size_t j = 1; j <= columns; j++) {
            const char b = candidate[j - 1];
            const int change = a[i - 1] == b ? 0 : lower(a[i - 1]) == lower(b) ? 1 : 2;
            int cost = smaller(last[j - 1] + change, smaller(last[j], now[j - 1]) + 2);
            if (i > 1 && j > 1 && a[i - 1] == candidate[j - 2] && a[i - 2] == b) {
                cost = smaller(cost, before[j - 2] + 2);
            }
            now[j] = cost;
        }
        int *spare = before;
        before = last;
        last = now;
        now = spare;
    }
    if (last[columns] < search->cost) {
        search->cost = last[columns];
        search->best = candidate;
    }
}

char *nearest_hint(const nearest *search, char *hint, size_t size) {
    hint[0] = '\0';
    if (search->best != NULL) {
        snprintf(hint, size, "did you mean '%s'?", search->best);
    }
    return hint;
}
