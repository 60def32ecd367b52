/* c_contacts.c: the lists and the table of a scene's contacts. */
#include "c_contacts.h"

#include "c_bounds.h"
#include "c_list.h"
#include "host/number/hex.h"

void c_contacts_include(FILE *out, const contact_lists *c) {
    fprintf(out, "#define WH_CONTACTS_MAX %d\n#define WH_SETS_MAX %d\n", c->count,
            c->set_count > 0 ? c->set_count : 1);
    fprintf(out, "#include \"core/contact.h\"\nstatic const wh_contact_system contacts;\n"
                 "#define WH_CONTACTS_OF(model) (&contacts)\n#include \"core/contact_step.h\"\n");
}

static void write_table(FILE *out, const contact_lists *c) {
    static const char *const kinds[] = {"WH_STOP", "WH_HOLD", "WH_FRICTION", "WH_WHEN"};
    fprintf(out, "static const wh_contact contact_table[%d] = {", c->count);
    for (int k = 0; k < c->count; k++) {
        const contact_row *row = &c->row[k];
        fprintf(out, "%s\n    {%s, %d, %d, %d, %d}", k > 0 ? "," : "", kinds[row->kind],
                row->direction, row->pin, row->first_set, row->sets);
    }
    fprintf(out, "};\n");
    if (c->set_count > 0) {
        fprintf(out, "static const uint8_t contact_target[%d] = {", c->set_count);
        for (int i = 0; i < c->set_count; i++) {
            fprintf(out, "%s%d", i > 0 ? ", " : "", c->target[i]);
        }
        fprintf(out, "};\n");
    }
}

void c_contacts_write(FILE *out, const program *p, const engine_settings *settings, double step_s) {
    char hex[HEX_SIZE];
    const contact_lists *c = p->contacts;
    c_list_function(out, c->signals, "contact_signals", true, true);
    c_list_function(out, c->forces, "contact_forces", true, true);
    if (c->sets != NULL) {
        c_list_function(out, c->sets, "contact_sets", true, true);
    }
    write_table(out, c);
    fprintf(
        out,
        "static const wh_contact_system contacts = {\n    .accel = accelerations,\n"
        "    .signals = contact_signals,\n    .forces = contact_forces,\n    .sets = %s,\n"
        "    .contact = contact_table,\n    .target = %s,\n    .ledger = %s,\n    .contacts = %d,\n"
        "    .forced = %d,\n    .held = %d,\n    .evaluations = WH_CONTACT_EVALUATIONS(%d, %d, %d),\n"
        "    .method = %s,\n    .compensated = %s,\n"
        "    .angles = %d,\n    .coordinates = %d,\n};\n\n",
        c->sets != NULL ? "contact_sets" : "NULL", c->set_count > 0 ? "contact_target" : "NULL",
        p->ledger != NULL ? "&ledger" : "NULL", c->count, c->forced, c->held,
        wh_methods[settings->method].stages, contact_lists_stops(c), c->forced,
        wh_methods[settings->method].name, settings->compensated ? "true" : "false", p->angles,
        p->coordinates);
    fprintf(out,
            "static wh_status advance(const wh_scene *scene, wh_state *state) {\n"
            "    (void)scene;\n    return wh_step_contact(&contacts, WH_R(%s), state);\n}\n\n",
            hex_write(step_s, hex));
}

int c_contacts_evaluations(const program *p, const engine_settings *settings) {
    const contact_lists *c = p->contacts;
    const int stages = wh_methods[settings->method].stages;
    return c == NULL ? stages : c_bound_evaluations(stages, contact_lists_stops(c), c->forced);
}

int c_contacts_signals(const program *p) {
    const contact_lists *c = p->contacts;
    return c == NULL ? 0 : c_bound_signals(c->forced, c->count - c->forced);
}
