/* guard_bottom.c: a store into the strip's lowest word. */
#include "tests/boards/guard.h"

int main(void) {
    store_above_strip();
    store_into_strip(0);
    return 0;
}
