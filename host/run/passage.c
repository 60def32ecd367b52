/* passage.c: see passage.h. */
#include "passage.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"

void passages_enter(passages *p, double before_s, double size) {
    const double now = isfinite(size) ? size : (double)INFINITY;
    if (!(now > p->most)) {
        return;
    }
    const double told = p->count > 0 ? p->passed[p->count - 1].size : 0.0;
    p->most = now;
    if (!(now > told * (1.0 + PASSAGE_GRAIN))) {
        return;
    }
    if (p->count == p->room) {
        p->room = p->room > 0 ? 2 * p->room : 64;
        p->passed = room_more(p->passed, p->room, sizeof *p->passed);
    }
    p->passed[p->count++] = (passage){before_s, now};
}

void passages_free(passages *p) {
    free(p->passed);
    *p = (passages){0};
}

double passages_until_s(const passages *p, double level) {
    for (int i = 0; i < p->count; i++) {
        if (p->passed[i].size > level) {
            return p->passed[i].time_s;
        }
    }
    return (double)INFINITY;
}
