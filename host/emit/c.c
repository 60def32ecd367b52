/* c.c: a scene as C for the core. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "c_contacts.h"
#include "c_header.h"
#include "c_ledger.h"
#include "c_list.h"
#include "emit.h"
#include "host/image/core_rows.h"
#include "host/image/turned.h"
#include "host/number/hex.h"

static void write_observer(FILE *out, const image *im) {
    const tape *t = im->list[IMAGE_OBSERVE];
    fprintf(out, "static void observe(const wh_scene *scene, const wh_state *state, "
                 "wh_real *output) {\n");
    c_list_ignore(out, c_list_uses(t, OP_TIME), "scene");
    if (c_list_uses_phase(t)) {
        fprintf(out,
                "    wh_phase phase[%d];\n    for (int i = 0; i < %d; i++) {\n"
                "        phase[i] = wh_phase_of(state->angle[i]);\n    }\n",
                im->angles, im->angles);
    }
    if (tape_reads_turns(t)) {
        fprintf(out, "    const wh_angle *angle = state->angle;\n");
    }
    if (c_list_uses(t, OP_LINEAR)) {
        fprintf(out, "    const wh_real *linear = state->real;\n");
    }
    if (c_list_uses(t, OP_RATE)) {
        fprintf(out, "    const wh_real *rate = state->real + %d;\n", im->coordinates - im->angles);
    }
    if (c_list_uses(t, OP_INPUT)) {
        fprintf(out, "    const wh_real *input = state->input;\n");
    }
    if (c_list_uses(t, OP_ACCEL)) {
        fprintf(out, "    wh_real accel[%d];\n    wh_contact_observe(&contacts, state, accel);\n",
                im->coordinates);
    }
    if (!c_list_uses_phase(t) && !tape_reads_turns(t) && !c_list_uses(t, OP_LINEAR) &&
        !c_list_uses(t, OP_RATE) && !c_list_uses(t, OP_INPUT) && !c_list_uses(t, OP_TIME) &&
        !c_list_uses(t, OP_ACCEL) && !c_list_uses(t, OP_NOISE)) {
        fprintf(out, "    (void)state;\n");
    }
    c_list_body(out, t, C_PHASES, "output");
}

static void write_starts(FILE *out, const image *im) {
    char hex[HEX_SIZE];
    if (im->angles > 0) {
        fprintf(out, "static const wh_angle start_angle[%d] = {", im->angles);
        for (int i = 0; i < im->angles; i++) {
            fprintf(out, "%sWH_TURN(%s, INT64_C(%" PRId64 "))", i > 0 ? ", " : "",
                    hex_write(im->start_rad[i], hex), im->start_turns[i]);
        }
        fprintf(out, "};\n");
    }
    if (im->reals > 0) {
        fprintf(out, "static const wh_real start_real[%d] = {", im->reals);
        for (int i = 0; i < im->reals; i++) {
            fprintf(out, "%sWH_R(%s)", i > 0 ? ", " : "", hex_write(im->start_real[i], hex));
        }
        fprintf(out, "};\n");
    }
    if (im->inputs > 0) {
        fprintf(out, "static const wh_real start_input[%d] = {", im->inputs);
        for (int i = 0; i < im->inputs; i++) {
            fprintf(out, "%sWH_R(%s)", i > 0 ? ", " : "", hex_write(im->input[i].value, hex));
        }
        fprintf(out, "};\n");
    }
    fprintf(out, "\n");
}

/* Contacts, books and inputs with a rate change more than wh_advance_ahead() keeps. */
static bool has_ahead(const image *im) {
    return im->contacts == 0 && !im->ledger.kept && im->drives == 0;
}

static void write_scene(FILE *out, const image *im) {
    char hex[HEX_SIZE];
    /* declared here and not above, where it would stand before the names in functions */
    c_header_link(out, "wh_scene", im->name, c_header_of_image, im);
    fprintf(out, "const wh_scene %s = {\n    .name = \"%s\",\n    .form = %s,\n    .method = %s,\n",
            im->name, im->name, im->form == WH_SECOND_ORDER ? "WH_SECOND_ORDER" : "WH_FIRST_ORDER",
            wh_methods[im->settings.method].name);
    fprintf(out, "    .angles = %d,\n    .reals = %d,\n    .inputs = %d,\n    .outputs = %d,\n",
            im->angles, im->reals, im->inputs, im->outputs);
    if (im->contacts > 0) {
        fprintf(out, "    .contacts = %d,\n    .held = %d,\n", im->contacts, im->held);
    }
    if (im->ledger.kept) {
        fprintf(out, "    .ledger = &ledger,\n");
    }
    fprintf(out,
            "    .compensated = %s,\n    .step_s = WH_R(%s),\n"
            "    .step = {UINT64_C(%" PRIu64 "), UINT64_C(%" PRIu64 ")},\n"
            "    .steps = UINT64_C(%" PRIu64 "),\n",
            im->settings.compensated ? "true" : "false", hex_write(im->step_s, hex),
            im->step.numerator, im->step.denominator, im->steps);
    fprintf(out, "    .start_angle = %s,\n", im->angles > 0 ? "start_angle" : "NULL");
    fprintf(out, "    .start_real = %s,\n", im->reals > 0 ? "start_real" : "NULL");
    fprintf(out, "    .start_input = %s,\n", im->inputs > 0 ? "start_input" : "NULL");
    fprintf(out, "    .model = NULL,\n    .model_hash = UINT64_C(0x%016" PRIx64 "),\n", im->hash);
    fprintf(out,
            "    .advance = advance,\n%s    .observe = %s,\n    .arithmetic = wh_arithmetic,\n};\n",
            has_ahead(im) ? "#if defined(WH_AHEAD) && WH_AHEAD\n    .ahead = ahead,\n#endif\n" : "",
            im->outputs > 0 ? "observe" : "NULL");
}

static void write_names(FILE *out, const image *im) {
    fprintf(out, " * Components of the state, SI units, angles in turns (2^32 steps each):\n");
    for (int i = 0; i < im->angles; i++) {
        fprintf(out, " *   angle[%d]  %s\n", i, im->unknown[im->angle[i].unknown].name);
    }
    for (int i = 0; i < im->reals; i++) {
        fprintf(out, " *   real[%d]   %s", i, im->unknown[im->real[i].unknown].name);
        for (int k = 0; k < im->real[i].primes; k++) {
            fputc('\'', out);
        }
        fputc('\n', out);
    }
    for (int i = 0; i < im->inputs; i++) {
        fprintf(out, " *   input[%d]  %s\n", i, im->input[i].name);
    }
    for (int i = 0; i < im->own_outputs; i++) {
        fprintf(out, " *   output[%d] %s\n", i, im->output[i].name);
    }
    for (int i = im->own_outputs; i < im->outputs; i++) {
        const int k = i - im->own_outputs;
        fprintf(out, " *   output[%d] %s%s, from its momentum\n", i,
                im->unknown[im->from_momentum[k / 2]].name, k % 2 == 0 ? "" : "'");
    }
}

/* What a step computes with: the matrix, or the right-hand side of each stage. */
static const tape *moving(const image *im) {
    return im->list[im->list[IMAGE_MATRIX] != NULL ? IMAGE_MATRIX : IMAGE_STEP];
}

static void write_banner(FILE *out, const image *im, const char *file) {
    const tape_cost cost = tape_count(moving(im));
    fputs("/* Generated by whirl from ", out);
    c_comment(out, file);
    fputs(": do not edit.\n *\n", out);
    fprintf(out, " * scene        %s\n * model hash   0x%016" PRIx64 "\n", im->name, im->hash);
    fprintf(
        out,
        im->list[IMAGE_MATRIX] != NULL
            ? " * a whole step as a matrix: %d additions and products"
            : " * a right-hand side: %d additions and products, %d divisions, %d square roots,\n"
              " *                    %d pairs of sine and cosine",
        cost.arithmetic, cost.divisions, cost.roots, cost.waves);
    if (cost.calls > 0) {
        fprintf(out, ", %d functions of core/function.h", cost.calls);
    }
    if (cost.look_ups > 0) {
        fprintf(out, ", %d looked up in tables", cost.look_ups);
    }
    fprintf(out, "\n *\n");
    write_names(out, im);
    fprintf(out, " */\n");
}

static void write_includes(FILE *out, const image *im) {
    if (im->ledger.kept) {
        c_ledger_bounds(out, im);
    }
    if (im->contacts > 0) {
        c_contacts_include(out, im);
    } else if (im->list[IMAGE_MATRIX] != NULL) {
        fputs("#include \"core/matrix_step.h\"\n", out);
    } else {
        const char *const with[2][2] = {{"step", "ledger_step"},
                                        {"stage_turn", "stage_turn_ledger"}};
        fprintf(out, "#include \"core/%s.h\"\n", with[image_turns(im)][im->ledger.kept]);
    }
    if (im->drives > 0) {
        fprintf(out, "#include \"core/driven.h\"\n");
    }
    if (im->list[IMAGE_STEP]->tables.count > 0) {
        fprintf(out, "#include \"core/table.h\"\n");
    }
    if (image_calls(im)) {
        fprintf(out, "#include \"core/function.h\"\n");
    }
    if (c_list_uses(im->list[IMAGE_OBSERVE], OP_NOISE)) {
        fprintf(out, "#include \"core/noise.h\"\n");
    }
}

/* Of a scene without contacts. */
static void write_one_step(FILE *out, const image *im) {
    const bool second = im->form == WH_SECOND_ORDER;
    const char *method = wh_methods[im->settings.method].name;
    const char *compensated = im->settings.compensated ? "true" : "false";
    char hex[HEX_SIZE];
    char rest[HEX_SIZE];
    hex_write(im->step_s, hex);
    hex_write(im->step_s - (double)(float)im->step_s, rest);
    const bool turns = image_turns(im);
    fputs(
        "WH_INLINE wh_status one_step(const wh_scene *scene, wh_state *state) {\n    (void)scene;\n",
        out);
    if (im->list[IMAGE_MATRIX] != NULL) {
        fprintf(out,
                "    return wh_step_matrix(NULL, step_matrix, %s, %dU, %dU, %dU,\n"
                "                          WH_SPAN(%s, %s), state);\n}\n\n",
                compensated, im->angles, im->reals, core_rates_at(im), hex, rest);
    } else if (im->ledger.kept) {
        fprintf(out,
                "    return wh_%s_ledger(&ledger, NULL, accelerations,%s %s, %s,\n"
                "                          WH_SPAN(%s, %s), state);\n}\n\n",
                turns ? "turn" : "step", turns ? " &waves," : "", method, compensated, hex, rest);
    } else {
        fprintf(out,
                "    return wh_%s_%s(NULL, %s,%s %s, %s, %dU, %dU,\n"
                "                          WH_SPAN(%s, %s), state);\n}\n\n",
                turns ? "turn" : "step", second ? "second" : "first",
                second ? "accelerations" : "slopes",
                !turns   ? ""
                : second ? " &waves, NULL,"
                         : " &waves,",
                method, compensated, im->angles, second ? im->coordinates : im->reals, hex, rest);
    }
}

static void write_advance(FILE *out, const image *im) {
    fputs("static wh_status advance(const wh_scene *scene, wh_state *state) {\n", out);
    if (im->drives == 0) {
        fputs("    return wh_step_counted(one_step(scene, state), state);\n}\n\n", out);
    } else {
        fprintf(out, "    static const wh_driven drive[%d] = {", im->drives);
        for (int i = 0; i < im->drives; i++) {
            const wh_driven d = core_drive(&im->drive[i]);
            fprintf(out, "%s{%d, %d, %d, %d}", i > 0 ? ", " : "", d.input, d.rate, d.value_at,
                    d.rate_at);
        }
        fprintf(out,
                "};\n    wh_driven_begin(drive, %dU, %s, state);\n"
                "    const wh_status status = one_step(scene, state);\n"
                "    if (status == WH_OK) {\n        wh_driven_end(drive, %dU, state);\n    }\n"
                "    return wh_step_counted(status, state);\n}\n\n",
                im->drives, im->ledger.kept ? "&ledger" : "NULL", im->drives);
    }
    if (has_ahead(im)) {
        fprintf(out,
                "#if defined(WH_AHEAD) && WH_AHEAD\n"
                "static wh_status ahead(const wh_scene *scene, wh_state *state, uint32_t steps) {\n"
                "    return wh_steps_ahead(scene, one_step, %dU, %dU, %s, state, steps);\n"
                "}\n#endif\n\n",
                im->angles, im->reals, im->settings.compensated ? "true" : "false");
    }
}

/* Room for fewer than four would make gcc spill other things, not fewer. */
static int most_stages(const image *im) {
    const int stages = wh_methods[im->settings.method].stages;
    return stages > 4 ? stages : 4;
}

void emit_c(FILE *out, const image *im, const char *file) {
    const bool second = im->form == WH_SECOND_ORDER;
    const bool turns = image_turns(im);
    const int components = second ? im->coordinates : im->angles + im->reals;
    write_banner(out, im, file);
    fprintf(out, "#define WH_COORDS %d\n#define WH_STAGES %d\n", components, most_stages(im));
    if (turns) {
        const int waves = tape_waves(im->list[IMAGE_STEP]);
        fprintf(out, "#define WH_WAVES %d\n", waves > 0 ? waves : 1);
    }
    if (c_list_is_long(moving(im))) {
        fprintf(out, "#define WH_LONG_LIST 1\n");
    } else if (im->contacts == 0 && !im->ledger.kept && !im->settings.compensated) {
        fprintf(out, "#define WH_SMALL_STEP 1\n");
    }
    write_includes(out, im);
    fprintf(out, "\n");
    write_starts(out, im);
    c_list_cells(out, im->list[IMAGE_STEP]);
    if (im->list[IMAGE_MATRIX] != NULL) {
        c_list_matrix(out, im->list[IMAGE_MATRIX]);
    } else {
        c_list_function(out, im->list[IMAGE_STEP], turns ? C_WAVES : C_PHASES,
                        second ? "accelerations" : "slopes", second,
                        im->contacts > 0 || im->ledger.asked);
    }
    if (turns) {
        c_list_waves(out, im->list[IMAGE_STEP]);
    }
    if (im->ledger.kept) {
        c_ledger_write(out, im);
    }
    if (im->contacts > 0) {
        c_contacts_write(out, im);
    } else {
        write_one_step(out, im);
    }
    write_advance(out, im);
    if (im->outputs > 0) {
        write_observer(out, im);
    }
    write_scene(out, im);
}
