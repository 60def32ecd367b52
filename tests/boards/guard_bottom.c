/* guard_bottom.c: stores into the lowest word of the strip. */
#include "tests/boards/guard.h"

int main(void) {
    store_above_strip();
    store_into_strip(0);
    return 0;
}
