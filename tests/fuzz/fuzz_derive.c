/* fuzz_derive.c: a mechanism that the language accepts must neither crash nor hang the deriver, the writers or the
 * interpreter. The bytes of the input choose the rules by which a mechanism and a scene are written. If FUZZ_SHOW is
 * set in the environment, the text goes to standard error. */
#define _POSIX_C_SOURCE 200809L

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/derive/lagrange.h"
#include "host/emit/emit.h"
#include "host/engine/engine.h"
#include "host/image/image_make.h"
#include "host/show/show.h"

enum { TEXT_SIZE = 16384, UNKNOWNS_MAX = 4, LETS_MAX = 8, CONTACTS = 3, STEPS = 3 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct writer {
    const uint8_t *data;
    size_t left;
    char text[TEXT_SIZE];
    size_t used;
    int unknowns;
    int lets;
    bool rates; /* expressions may contain rates */
} writer;

static unsigned choose(writer *w, unsigned count) {
    if (w->left == 0) {
        return 0;
    }
    w->left--;
    return *w->data++ % count;
}

static void put(writer *w, const char *text) {
    const size_t length = strlen(text);
    if (w->used + length < TEXT_SIZE) {
        memcpy(w->text + w->used, text, length + 1);
        w->used += length;
    }
}

static void put_name(writer *w, const char *stem, unsigned number) {
    char digits[16];
    snprintf(digits, sizeof digits, "%u", number);
    put(w, stem);
    put(w, digits);
}

static void leaf(writer *w) {
    static const char *const numbers[] = {"2",  "0.5", "0",    "1",   "3",
                                          "-1", "0.1", "1e-9", "100", "0.3"};
    switch (choose(w, w->rates ? 5 : 4)) {
    case 0: put(w, numbers[choose(w, sizeof numbers / sizeof numbers[0])]); break;
    case 1: put(w, choose(w, 2) == 0 ? "p" : "drive"); break;
    case 2:
        if (w->lets > 0) {
            put_name(w, "a", choose(w, (unsigned)w->lets));
            break;
        }
        put_name(w, "x", choose(w, (unsigned)w->unknowns));
        break;
    case 3: put_name(w, "x", choose(w, (unsigned)w->unknowns)); break;
    default: put_name(w, "u", choose(w, (unsigned)w->unknowns)); break;
    }
}

static void expression(writer *w, int depth) {
    static const char *const operators[] = {" + ", " - ", "*", "/"};
    static const char *const exponents[] = {"2", "3", "0.5", "-1", "-2", "1.5", "7", "(1/3)"};
    if (depth == 0 || w->left == 0) {
        leaf(w);
        return;
    }
    switch (choose(w, 5)) {
    case 0: leaf(w); break;
    case 1:
    case 3: {
        const function_id called = (function_id)choose(w, FUNCTIONS);
        put(w, function_name(called));
        put(w, "(");
        expression(w, depth - 1);
        if (function_arguments(called) == 2) {
            put(w, ", ");
            expression(w, depth - 1);
        }
        put(w, ")");
        break;
    }
    case 2:
        put(w, "(");
        expression(w, depth - 1);
        put(w, ")^");
        put(w, exponents[choose(w, 8)]);
        break;
    default:
        put(w, "(");
        expression(w, depth - 1);
        put(w, operators[choose(w, 4)]);
        expression(w, depth - 1);
        put(w, ")");
        break;
    }
}

static void rated(writer *w, const char *before, int depth, bool rates) {
    put(w, before);
    w->rates = rates;
    expression(w, depth);
}

static void write_when(writer *w) {
    static const char *const directions[] = {"", " rising", " falling"};
    put_name(w, choose(w, 2) == 1 ? "when u" : "when x", choose(w, (unsigned)w->unknowns));
    rated(w, " + ", 2, true);
    rated(w, " crosses ", 1, true);
    put(w, directions[choose(w, 3)]);
    put(w, " { set ");
    const unsigned target = choose(w, (unsigned)w->unknowns);
    const bool rate = choose(w, 2) == 1;
    put_name(w, "x", target);
    put(w, rate ? "' = 1 [1/s]*" : " = ");
    rated(w, "", 2, true);
    if (choose(w, 2) == 1) {
        put_name(w, ", x", target);
        put(w, rate ? " = " : "' = 1 [1/s]*");
        rated(w, "", 2, true);
    }
    put(w, " }\n");
}

static void write_condition(writer *w) {
    static const char *const comparisons[] = {" > ", " < ", " >= ", " <= "};
    static const char *const joints[] = {" and ", " or "};
    for (unsigned more = 1 + choose(w, 3); more > 0; more--) {
        rated(w, "", 2, true);
        put(w, comparisons[choose(w, 4)]);
        expression(w, 1);
        put(w, more > 1 ? joints[choose(w, 2)] : "");
    }
}

/* Writes a stop, hold, friction or crossing, or noise on the output. */
static void write_contact(writer *w) {
    static const char *const parts[] = {"0", "1", "0.5", "p/2"};
    switch (choose(w, 5)) {
    case 0:
        put_name(w, "stop x", choose(w, (unsigned)w->unknowns));
        rated(w, " + ", 2, false);
        rated(w, " >= ", 1, false);
        put(w, " restitution ");
        put(w, parts[choose(w, 4)]);
        break;
    case 1:
        put_name(w, "friction x", choose(w, (unsigned)w->unknowns));
        put(w, " static 1 kinetic ");
        put(w, parts[choose(w, 4)]);
        rated(w, " normal 1 [J]*", 2, choose(w, 2) == 1);
        break;
    case 2:
        put_name(w, "hold x", choose(w, (unsigned)w->unknowns));
        rated(w, " - ", 2, false);
        put(w, " while ");
        write_condition(w);
        break;
    case 3: write_when(w); return;
    default: put(w, "noise o deviation p seed 7"); break;
    }
    put(w, "\n");
}

static void write_energies(writer *w) {
    put(w, "T = 1 [J]*(u0^2");
    for (int i = 1; i < w->unknowns; i++) {
        put_name(w, " + u", (unsigned)i);
        put(w, "^2");
    }
    rated(w, " + ", 2, choose(w, 3) == 0);
    put_name(w, "*u", choose(w, (unsigned)w->unknowns));
    put_name(w, "*u", choose(w, (unsigned)w->unknowns));
    rated(w, ")/2\nV = 1 [J]*", 3, false);
    rated(w, "\nF = 1 [W]*", 2, true);
    rated(w, "\nQ(x0) = 1 [J]*", 2, true);
    put(w, "\n");
}

static void write_equations(writer *w) {
    for (int i = 0; i < w->unknowns; i++) {
        const bool second = choose(w, 2) == 0;
        put_name(w, second ? "equation 1 [s^2]*x" : "equation 1 [s]*x", (unsigned)i);
        rated(w, second ? "''*(1 + " : "'*(1 + ", 2, false);
        rated(w, ") = ", 3, second);
        put(w, "\n");
    }
}

static void write_mechanism(writer *w) {
    const bool system = choose(w, 4) == 0;
    w->unknowns = 1 + (int)choose(w, UNKNOWNS_MAX);
    put(w, "mechanism fuzz\n");
    for (int i = 0; i < w->unknowns; i++) {
        put(w, system ? "state " : "coordinate ");
        put_name(w, "x", (unsigned)i);
        put(w, choose(w, 2) == 0 ? " [rad]\n" : "\n");
    }
    put(w, "parameter p = 1.25\ninput drive = 0.75\n");
    for (int i = 0; i < w->unknowns; i++) {
        put_name(w, "let u", (unsigned)i);
        put_name(w, " = 1 [s]*x", (unsigned)i);
        put(w, "'\n");
    }
    const int lets = (int)choose(w, LETS_MAX);
    for (int i = 0; i < lets; i++) {
        put_name(w, "let a", (unsigned)i);
        rated(w, " = ", 2, choose(w, 4) == 0);
        put(w, "\n");
        w->lets = i + 1;
    }
    if (system) {
        write_equations(w);
    } else {
        write_energies(w);
    }
    rated(w, "output o = ", 3, true);
    put(w, "\n");
    for (unsigned left = choose(w, 2) == 1 ? choose(w, CONTACTS + 1) : 0; left > 0; left--) {
        write_contact(w);
    }
}

static void write_scene(writer *w) {
    static const char *const numbers[] = {"0", "1", "-0.3", "1e3", "0.1"};
    put(w, "scene run {\n");
    if (choose(w, 3) == 1) {
        put(w, "with ledger\n");
    }
    for (int i = 0; i < w->unknowns; i++) {
        put_name(w, "start x", (unsigned)i);
        put(w, " = ");
        put(w, numbers[choose(w, 5)]);
        if (choose(w, 2) == 1) {
            put_name(w, "\nstart x", (unsigned)i);
            put(w, "' = 1 [1/s]*");
            put(w, numbers[choose(w, 5)]);
        }
        put(w, "\n");
    }
    if (choose(w, 3) == 1) {
        put_name(w, "conserve x", choose(w, (unsigned)w->unknowns));
        put(w, "\n");
    }
    if (choose(w, 4) == 1) {
        write_when(w);
    }
    put(w, choose(w, 2) == 1 ? "step 0.25 [s]\n}\n" : "}\n");
}

static void run(const image *p, const engine_kind *kind, bool compensated) {
    for (int i = 0; i < WH_METHODS; i++) {
        if (!wh_method_takes((wh_method)i, p->form)) {
            continue;
        }
        image each = *p;
        each.settings = (image_settings){.method = (wh_method)i, .compensated = compensated};
        void *running = kind->start(&each);
        double *output = calloc((size_t)p->outputs + 1, sizeof *output);
        if (output == NULL) {
            abort();
        }
        for (int step = 0; step < STEPS && kind->step(running) == WH_OK; step++) {
            kind->outputs(running, output);
        }
        free(output);
        kind->stop(running);
    }
}

/* Writes the equations, and makes and runs the image. `conserve` is that of image_make(). */
static void use(const equations *e, const bool *conserve, diags *all, FILE *nowhere) {
    static const image_settings settings = IMAGE_SETTINGS_DEFAULT;
    image *p = image_make(e, conserve, &settings, IMAGE_TO_RUN, all);
    if ((p == NULL) != (diags_count(all) > 0)) {
        abort(); /* the image was refused without a message, or made with one */
    }
    if (p == NULL) {
        return;
    }
    if (conserve == NULL) {
        emit_octave(nowhere, p, "fuzz.whirl", "");
    }
    run(p, &engine_double, false);
    emit_c(nowhere, p, "fuzz.whirl");
    emit_c_header(nowhere, p, "fuzz.whirl");
    run(p, &engine_float, false);
    run(p, &engine_float, true);
    image_free(p);
}

static void derive(const scene *in, const instance *inst, diags *all, FILE *nowhere) {
    equations *e = equations_derive(inst, all);
    if ((e == NULL) != (diags_count(all) > 0)) {
        abort();
    }
    if (e != NULL) {
        show_text(nowhere, e);
        show_latex(nowhere, e);
        use(e, NULL, all, nowhere);
        if (in != NULL && diags_count(all) == 0) {
            use(e, in->conserve, all, nowhere);
        }
    }
    equations_free(e);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static FILE *nowhere;
    if (nowhere == NULL) {
        nowhere = fopen("/dev/null", "w");
    }
    if (nowhere == NULL) {
        abort();
    }
    writer w = {.data = data, .left = size};
    write_mechanism(&w);
    if (choose(&w, 2) == 1) {
        write_scene(&w);
    }
    if (getenv("FUZZ_SHOW") != NULL) {
        fputs(w.text, stderr);
    }
    diags *all = diags_new();
    whirl_model *parsed = model_parse("fuzz.whirl", w.text, w.used, all);
    if (parsed != NULL) {
        const scene *in = parsed->scene_count > 0 ? parsed->scenes[0] : NULL;
        instance *inst = instance_make(parsed->mechanisms[0], in, NULL, all);
        if (inst != NULL) {
            derive(in, inst, all, nowhere);
        }
        instance_free(inst);
    }
    diags_flush(all, getenv("FUZZ_SHOW") != NULL ? stderr : nowhere);
    diags_free(all);
    model_free(parsed);
    return 0;
}
