#include "show_events.h"

static void show_crossing(const show *s, const contact_law *law, const contact_set *set) {
    const contact_statement *from = law->from;
    fputs(contact_loosens(from) ? "normal force that comes and goes: when " : "when ", s->out);
    show_poly(s, law->value);
    fputs(" crosses 0", s->out);
    fputs(from->direction > 0 ? " rising" : from->direction < 0 ? " falling" : "", s->out);
    for (int i = 0; i < from->set_count; i++) {
        fputs(i == 0 ? ": " : ", ", s->out);
        show_symbol(s, from->sets[i].symbol, from->sets[i].primes);
        fputs(" = ", s->out);
        show_poly(s, set->value[i]);
    }
}

static void show_friction(const show *s, const contact_law *law) {
    fputs("friction on ", s->out);
    show_symbol(s, law->from->coordinate, 0);
    fputs(": sticks up to ", s->out);
    show_poly(s, law->first);
    fputs(", slides with ", s->out);
    show_poly(s, law->second);
}

void show_events(FILE *out, const equations *e, const char *prefix, const char *heading) {
    const show s = show_start(out, SHOW_TEXT, e->algebra);
    const contact_laws *laws = e->contacts;
    if (laws == NULL) {
        return;
    }
    fprintf(out, "%s%s\n", prefix, heading);
    for (int k = 0; k < laws->count; k++) {
        const contact_law *law = &laws->law[k];
        fprintf(out, "%s  ", prefix);
        switch (law->from->kind) {
        case CONTACT_STOP:
            fputs("stop ", out);
            show_poly(&s, law->value);
            fputs(" >= 0, restitution ", out);
            show_poly(&s, law->first);
            break;
        case CONTACT_FRICTION: show_friction(&s, law); break;
        case CONTACT_HOLD:
            fputs("hold ", out);
            show_poly(&s, law->speed);
            fputs(" = 0 while ", out);
            show_poly(&s, law->value);
            fputs(" > 0", out);
            break;
        case CONTACT_WHEN: show_crossing(&s, law, &laws->sets[k]); break;
        }
        fputc('\n', out);
    }
}
