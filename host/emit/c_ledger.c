/* c_ledger.c: the lists of a scene's books. */
#include "c_ledger.h"

#include "c_list.h"
#include "host/image/core_rows.h"

void c_ledger_bounds(FILE *out, const image *im) {
    const image_ledger *l = &im->ledger;
    fprintf(out, "#define WH_LEDGER 1\n#define WH_LEDGER_MAX %d\n#define WH_ACCOUNTS_MAX %d\n",
            l->entries > 0 ? l->entries : 1, l->accounts);
}

/* A wh_levels_fn: "ledger_levels" and "ledger_powers" are of one length. */
static void write_of_angles(FILE *out, const image *im, const tape *t, const char *name,
                            const char *result) {
    fprintf(out,
            "static void %s(const void *model, const wh_angle *angle,\n"
            "                          const wh_real *linear, const wh_real *rate,\n"
            "                          const wh_real *input, wh_real *%s) {\n"
            "    (void)model;\n",
            name, result);
    if (c_list_uses_phase(t)) {
        fprintf(out,
                "    wh_phase phase[%d];\n    for (int i = 0; i < %d; i++) {\n"
                "        phase[i] = wh_phase_of(angle[i]);\n    }\n",
                im->angles, im->angles);
    } else {
        c_list_ignore(out, tape_reads_turns(t), "angle");
    }
    c_list_ignore(out, c_list_uses(t, OP_LINEAR), "linear");
    c_list_ignore(out, c_list_uses(t, OP_RATE), "rate");
    c_list_ignore(out, c_list_uses(t, OP_INPUT), "input");
    c_list_ignore(out, t->results > 0, result);
    c_list_body(out, t, C_PHASES, result);
}

void c_ledger_write(FILE *out, const image *im) {
    const image_ledger *l = &im->ledger;
    const wh_ledger_form form = core_ledger_form(im, NULL, NULL);
    if (l->turned) {
        write_of_angles(out, im, im->list[IMAGE_POWERS], "ledger_powers", "power");
    } else {
        c_list_function(out, im->list[IMAGE_POWERS], C_PHASES, "ledger_powers", true, true);
    }
    write_of_angles(out, im, im->list[IMAGE_LEVELS], "ledger_levels", "level");
    if (l->smooth > 0) {
        fprintf(out, "static const uint8_t ledger_accounts[%d] = {", l->smooth);
        for (int i = 0; i < l->smooth; i++) {
            fprintf(out, "%s%d", i > 0 ? ", " : "", l->entry[i].account);
        }
        fprintf(out, "};\n");
    }
    if (l->inputs > 0) {
        fprintf(out, "static const uint8_t ledger_inputs[%d] = {", l->inputs);
        for (int i = 0; i < l->inputs; i++) {
            fprintf(out, "%s%d", i > 0 ? ", " : "", l->input[i]);
        }
        fprintf(out, "};\n");
    }
    fprintf(out,
            "static const wh_ledger_form ledger = {\n    .%s = ledger_powers,\n"
            "    .levels = ledger_levels,\n    .account = %s,\n    .smooth = %d,\n"
            "    .entries = %d,\n    .accounts = %d,\n    .coordinates = %d,\n"
            "    .angles = %d,\n",
            l->turned ? "turned" : "powers", l->smooth > 0 ? "ledger_accounts" : "NULL",
            form.smooth, form.entries, form.accounts, form.coordinates, form.angles);
    if (form.inputs > 0) {
        fprintf(out, "    .input = ledger_inputs,\n    .inputs = %d,\n", form.inputs);
    }
    if (form.stabilized) {
        fputs("    .stabilized = true,\n", out);
    }
    fputs("};\n\n", out);
}
