/* hybrid_draw.c: random contacts for random linkages, and their text (hybrid.h). */
#include "derived.h"
#include "hybrid.h"

static double eighths(uint64_t *seed, int least, int most) {
    return (least + (int)(random_bits(seed) % (uint64_t)(most - least + 1))) / 8.0;
}

/* Draws a stop that is open at the start. Returns false if there is no room for a stop. */
static bool stop_draw(const hybrid *h, const linkage_numbers *at, uint64_t *seed,
                      hybrid_contact *c) {
    c->kind = (hybrid_kind)(random_bits(seed) % 3);
    c->body = (int)(random_bits(seed) % (uint64_t)h->of.bodies);
    const double away = eighths(seed, 1, 5) / (h->of.body[c->body].slides ? 4.0 : 1.0);
    c->restitution = eighths(seed, 0, 7);
    double here = h->of.start[c->body];
    if (c->kind == HYBRID_FLOOR) {
        double moves = 0.0;
        for (int i = 0; i < h->of.bodies; i++) {
            moves += fabs((double)at->end[c->body].row[i]);
        }
        here = (double)at->end[c->body].y_m;
        if (moves < 0.1) {
            return false;
        }
    }
    c->limit = here + (c->kind == HYBRID_MOST ? away : -away);
    return true;
}

/* Draws dry friction on a coordinate. Returns false if the coordinate has a friction already. */
static bool friction_draw(const hybrid *h, uint64_t *seed, hybrid_contact *c) {
    c->kind = HYBRID_FRICTION;
    c->body = (int)(random_bits(seed) % (uint64_t)h->of.bodies);
    c->limit = eighths(seed, 8, 120);
    c->loaded_by = (int)(random_bits(seed) % (uint64_t)h->of.bodies);
    c->load = random_bits(seed) % 2 == 0 ? 0.0 : eighths(seed, -200, 200);
    for (int k = 0; k < h->contacts; k++) {
        if (h->contact[k].kind == HYBRID_FRICTION && h->contact[k].body == c->body) {
            return false;
        }
    }
    return true;
}

hybrid hybrid_draw(uint64_t *seed) {
    hybrid h = {.of = linkage_draw(seed)};
    linkage_numbers at;
    long double q[LINKAGE_BODIES];
    long double rate[LINKAGE_BODIES] = {0};
    for (int k = 0; k < h.of.bodies; k++) {
        q[k] = (long double)h.of.start[k];
    }
    linkage_evaluate(&h.of, q, rate, &at);
    const int wanted = 1 + (int)(random_bits(seed) % HYBRID_CONTACTS);
    const int stops = (int)(random_bits(seed) % (uint64_t)(wanted + 1));
    for (int k = 0; k < wanted; k++) {
        hybrid_contact *c = &h.contact[h.contacts];
        if (k < stops ? stop_draw(&h, &at, seed, c) : friction_draw(&h, seed, c)) {
            h.contacts++;
        }
    }
    return h;
}

void hybrid_statements(const hybrid *h, char text[static HYBRID_TEXT]) {
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; k < h->contacts && used < HYBRID_TEXT; k++) {
        const hybrid_contact *c = &h->contact[k];
        const bool slides = h->of.body[c->body].slides;
        char line[160];
        if (c->kind == HYBRID_FRICTION) {
            const char *unit = slides ? "N" : "N*m";
            int end =
                snprintf(line, sizeof line, "friction q%d static 1 kinetic 1 normal %.17g [%s]",
                         c->body, c->limit, unit);
            if (c->load != 0.0) {
                end +=
                    snprintf(line + end, sizeof line - (size_t)end, " + %.17g [%s/%s]*q%d", c->load,
                             unit, h->of.body[c->loaded_by].slides ? "m" : "rad", c->loaded_by);
            }
            snprintf(line + end, sizeof line - (size_t)end, "\n");
        } else {
            snprintf(line, sizeof line, "stop %s%d %s %.17g [%s] restitution %.17g\n",
                     c->kind == HYBRID_FLOOR ? "ey" : "q", c->body,
                     c->kind == HYBRID_MOST ? "<=" : ">=", c->limit,
                     slides || c->kind == HYBRID_FLOOR ? "m" : "rad", c->restitution);
        }
        used += (size_t)snprintf(text + used, HYBRID_TEXT - used, "%s", line);
    }
}
