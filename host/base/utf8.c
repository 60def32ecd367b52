#include "utf8.h"

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
