/* linkages.c: `linkages COUNT SEED` writes random planar linkages (tests/host/linkage.h), half-second scenes l1_moves, ... */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/host/linkage.h"

int main(int count, char **words) {
    if (count != 3) {
        fputs("usage: linkages COUNT SEED\n", stderr);
        return 2;
    }
    const unsigned wanted = (unsigned)strtoul(words[1], NULL, 10);
    uint64_t seed = strtoull(words[2], NULL, 10);
    for (unsigned k = 1; k <= wanted; k++) {
        char name[24];
        char text[LINKAGE_TEXT];
        const linkage of = linkage_draw(&seed);
        snprintf(name, sizeof name, "l%u", k);
        linkage_write(&of, name, (linkage_writing){.forces = LINKAGE_INSIDE}, text);
        fputs(text, stdout);
    }
    return fflush(stdout) == 0 ? 0 : 1;
}
