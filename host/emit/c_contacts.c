/* c_contacts.c: the lists and the table of a scene's contacts. */
#include "c_contacts.h"

#include "c_list.h"
#include "host/image/core_rows.h"
#include "host/number/hex.h"

void c_contacts_include(FILE *out, const image *im) {
    fprintf(out, "#define WH_CONTACTS_MAX %d\n#define WH_SETS_MAX %d\n", im->contacts,
            im->set_count > 0 ? im->set_count : 1);
    fprintf(out, "#include \"core/contact.h\"\nstatic const wh_contact_system contacts;\n"
                 "#define WH_CONTACTS_OF(model) (&contacts)\n#include \"core/contact_step.h\"\n");
}

#define KIND_TEXT(name, is) [name] = #name,
static const char *const kinds[WH_CONTACT_KIND_COUNT] = {WH_CONTACT_KINDS(KIND_TEXT)};
#undef KIND_TEXT

static void write_table(FILE *out, const image *im) {
    fprintf(out, "static const wh_contact contact_table[%d] = {", im->contacts);
    for (int k = 0; k < im->contacts; k++) {
        const wh_contact row = core_contact_row(&im->contact[k]);
        fprintf(out, "%s\n    {%s, %d, %d, %d, %d}", k > 0 ? "," : "", kinds[row.kind],
                row.direction, row.pin, row.first_set, row.sets);
    }
    fprintf(out, "};\n");
    if (im->set_count > 0) {
        fprintf(out, "static const uint8_t contact_target[%d] = {", im->set_count);
        for (int i = 0; i < im->set_count; i++) {
            fprintf(out, "%s%d", i > 0 ? ", " : "", im->target[i]);
        }
        fprintf(out, "};\n");
    }
}

void c_contacts_write(FILE *out, const image *im) {
    char hex[HEX_SIZE];
    const bool sets = im->list[IMAGE_SETS] != NULL;
    const wh_contact_system system = core_contact_system(im, NULL, NULL);
    c_list_function(out, im->list[IMAGE_SIGNALS], C_PHASES, "contact_signals", true, true);
    c_list_function(out, im->list[IMAGE_FORCES], C_PHASES, "contact_forces", true, true);
    if (sets) {
        c_list_function(out, im->list[IMAGE_SETS], C_PHASES, "contact_sets", true, true);
    }
    write_table(out, im);
    fprintf(
        out,
        "static const wh_contact_system contacts = {\n    .accel = accelerations,\n"
        "    .signals = contact_signals,\n    .forces = contact_forces,\n    .sets = %s,\n"
        "    .contact = contact_table,\n    .target = %s,\n    .ledger = %s,\n    .contacts = %d,\n"
        "    .forced = %d,\n    .kinds = ",
        sets ? "contact_sets" : "NULL", im->set_count > 0 ? "contact_target" : "NULL",
        im->ledger.kept ? "&ledger" : "NULL", system.contacts, system.forced);
    const char *between = "";
    for (unsigned kind = 0; kind < WH_CONTACT_KIND_COUNT; kind++) {
        if ((system.kinds & WH_KIND_BIT(kind)) != 0) {
            fprintf(out, "%sWH_KIND_BIT(%s)", between, kinds[kind]);
            between = " | ";
        }
    }
    fprintf(out,
            "%s,\n    .pinned = %d,\n    .held = %d,\n"
            "    .evaluations = WH_CONTACT_EVALUATIONS(%d, %d, %d),\n"
            "    .method = %s,\n    .compensated = %s,\n"
            "    .angles = %d,\n    .coordinates = %d,\n",
            system.kinds != 0 ? "" : "0", system.pinned, system.held, core_stages(im),
            core_stops(im), system.forced, wh_methods[system.method].name,
            system.compensated ? "true" : "false", system.angles, system.coordinates);
    if (system.driven != 0) {
        fprintf(out, "    .driven = %d,\n", system.driven);
    }
    fputs("};\n\n", out);
    fprintf(out,
            "WH_INLINE wh_status one_step(const wh_scene *scene, wh_state *state) {\n"
            "    (void)scene;\n    return wh_step_contact(&contacts, WH_R(%s), state);\n}\n\n",
            hex_write(im->step_s, hex));
}
