/* list.c: `whirl list`: mechanisms, their effects and scenes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/cli/options.h"
#include "host/lang/builtin.h"
#include "host/lang/units.h"

/* === the hard cases ================================================================================ */
/* A case is a section of docs/hard_cases.md. Scenes are files of docs/hard or built-in scenes, separated by blanks. */
static const struct {
    const char *name, *scenes, *limit, *verdict;
} hard_rows[] = {
    {"case", "scenes", "limit of the theory", "verdict"},
    {"Chaos", "thomson_a", "each further digit adds the same trusted time",
     "warning, with the time until which the run is right"},
    {"The pole and the origin", "polar", "no fixed step resolves every distance",
     "right, or a warning that names a step"},
    {"Mass matrices that are nearly singular", "disc masses soft_spring",
     "no correct digit at a ratio of 1e16 (in float 1e7)", "right, or a warning, or an error"},
    {"Dead centres", "dead_centre", "with rigid bodies a redundant load is undetermined", "right"},
    {"Springs too stiff for the step", "stiff_spring", "Runge-Kutta 4 is unstable above h w = 2.83",
     "warning before 1 % of the energy is lost"},
    {"A hard floor", "stiff_stop", "above h w = 1 the energy after a bounce is random",
     "warning; right with a stop"},
    {"Resonance without damping", "resonance", "relative phase error (h w)^4/120",
     "right: order 4"},
    {"A motor too weak for a resonance", "sommerfeld", "none, except the error of the method",
     "right"},
    {"Friction under a load that vanishes", "pulsating_load",
     "a step across a kink is of second order", "right, of order 4: steps end at kinks"},
    {"Bounces that end", "moving_floor", "infinitely many impacts happen in a finite time",
     "right"},
    {"Contacts that repeat each other", "redundant", "only the moment of release is determined",
     "right"},
    {"Newton's cradle", "cradle", "with rigid bodies the sequence of impacts is undetermined",
     "right"},
    {"Rotation", "rotor", "the direction is ambiguous at half a turn per step",
     "right, or a warning, or an error"},
    {"Very long runs", "long", "no explicit step keeps the energy", "right with --stabilized"},
    {"Very large and very small numbers", "scales", "float has no numbers below 1.4e-45",
     "right, or a warning, or an error"},
    {"Inputs that jump", "jump", "an input is constant within a step",
     "right if it jumps between steps or in a `when`"},
    {"Poles that a step jumps over", "used_up",
     "no error estimate sees the motion between evaluations", "warning, and not trusted"},
};

/* === the command ============================================================================== */

static const command_usage usage = {
    .head =
        "usage: whirl list [FILE ...] [--as text|table]\n"
        "       whirl list --units|--hard|--figures\n"
        "\n"
        "Lists the mechanisms and scenes of FILEs, or the built-in ones.\n"
        "\n"
        "  --as text            a line each: kind, name, title (default)\n"
        "  --as table           for programs: mechanisms, effects and scenes, a line each, with tabs between\n"
        "                       the fields, named in line 1. '-' is an empty field; \\t, \\n, \\r and \\\\\n"
        "                       are escapes. `first_line` and `last_line` bound the block; a mechanism ends\n"
        "                       before the next one. `holds` lists terms, contacts, noise and conserve.\n"
        "  --units              every unit: its name, its SI unit and its value in that SI unit, with tabs\n"
        "                       between them\n"
        "  --hard               the hard cases of docs/hard_cases.md, and their results\n"
        "  --figures            the figures that `whirl figure` draws: name and title\n"};

enum { OUTSIDE = -1 }; /* outside every effect */

static void add_word(bool *any, const char *word) {
    printf("%s%s", *any ? "," : "", word);
    *any = true;
}

static void end_words(bool any) { fputs(any ? "\t" : "-\t", stdout); }

static void put_effects(const mechanism *m, const bool *with, bool ledger) {
    bool any = false;
    for (int i = 0; i < m->effect_count; i++) {
        if (with == NULL || with[i]) {
            add_word(&any, m->effects[i].name);
        }
    }
    if (ledger) {
        add_word(&any, "ledger");
    }
    end_words(any);
}

static void put_what_is_in(const mechanism *m, int within) {
    static const char *const words[] = {"terms", "contacts", "noise"};
    bool has[3] = {false};
    bool any = false;
    for (int i = 0; i < m->term_count; i++) {
        has[0] = has[0] || m->terms[i].effect == within;
    }
    for (int i = 0; i < m->contact_count; i++) {
        has[1] = has[1] || m->contacts[i].effect == within;
    }
    for (int i = 0; i < m->noise_count; i++) {
        has[2] = has[2] || m->noises[i].effect == within;
    }
    for (int i = 0; i < 3; i++) {
        if (has[i]) {
            add_word(&any, words[i]);
        }
    }
    end_words(any);
}

static void put_what_is_in_scene(const scene *in) {
    bool any = false;
    bool conserves = false;
    if (in->when_count > 0) {
        add_word(&any, "contacts");
    }
    for (int i = 0; i < in->mechanism->coordinate_count; i++) {
        conserves = conserves || in->conserve[i];
    }
    if (conserves) {
        add_word(&any, "conserve");
    }
    end_words(any);
}

/* Prints the text with escapes as in C, because it may contain separators of fields and lines. */
static void put_text(const char *text) {
    static const char escaped[] = "\t\n\r\\";
    for (const char *at = text; *at != '\0'; at++) {
        const char *found = strchr(escaped, *at);
        printf("%s%c", found != NULL ? "\\" : "", found != NULL ? "tnr\\"[found - escaped] : *at);
    }
}

static void put_title(const char *title) {
    put_text(title[0] == '\0' ? "-" : title);
    putchar('\n');
}

static void put_place(const char *kind, const char *name, const mechanism *of, const char *file,
                      int first_line, int last_line) {
    printf("%s\t%s\t%s\t", kind, name, of->name);
    put_text(file);
    printf("\t%d\t%d\t", first_line, last_line);
}

static bool put_rows(const source_model *from, const mechanism *m) {
    put_place("mechanism", m->name, m, from->file, m->at.line, m->last_line);
    put_effects(m, NULL, false);
    put_what_is_in(m, OUTSIDE);
    fputs("-\t-\t", stdout);
    put_title(m->title);
    for (int i = 0; i < m->effect_count; i++) {
        const effect *each = &m->effects[i];
        put_place("effect", each->name, m, from->file, each->at.line, each->last_line);
        fputs("-\t", stdout);
        put_what_is_in(m, i);
        fputs("-\t-\t", stdout);
        put_title(each->text);
    }
    for (int i = 0; i < from->model->scene_count; i++) {
        const scene *each = from->model->scenes[i];
        if (each->mechanism == m) {
            put_place("scene", each->name, m, from->file, each->at.line, each->last_line);
            put_effects(m, each->with, each->ledger);
            put_what_is_in_scene(each);
            instance *made = instance_make(m, each, NULL, from->errors);
            if (made == NULL) {
                return false;
            }
            printf("%.15g\t%.15g\t", made->step_s, made->until_s);
            instance_free(made);
            put_title(each->title);
        }
    }
    return true;
}

static void put_lines(const source_model *from, const mechanism *of) {
    const whirl_model *m = from->model;
    printf("mechanism  %-24s %s\n", of->name, of->title);
    for (int i = 0; i < m->scene_count; i++) {
        if (m->scenes[i]->mechanism == of) {
            printf("scene      %-24s %s\n", m->scenes[i]->name, m->scenes[i]->title);
        }
    }
}

static int list_one(const source_model *from, bool table, bool first) {
    bool good = true;
    if (first && table) {
        puts(
            "kind\tname\tmechanism\tfile\tfirst_line\tlast_line\teffects\tholds\tstep_s\tuntil_s\ttitle");
    }
    for (int i = 0; good && i < from->model->mechanism_count; i++) {
        if (table) {
            good = put_rows(from, from->model->mechanisms[i]);
        } else {
            put_lines(from, from->model->mechanisms[i]);
        }
    }
    diags_flush(from->errors, stderr);
    return good ? EXIT_DONE : EXIT_BAD_INPUT;
}

static int list_builtin(bool table) {
    int code = EXIT_DONE;
    for (size_t i = 0; i < builtin_model_count; i++) {
        source_model from;
        const int one = source_builtin(&from, &builtin_models[i]) ? list_one(&from, table, i == 0)
                                                                  : EXIT_BAD_INPUT;
        code = one > code ? one : code;
        source_close(&from);
    }
    return code;
}

static int list_file(const char *file, bool table, bool first) {
    source_model from;
    int code = source_open(&from, file);
    if (code == EXIT_DONE && from.name[0] != '\0') {
        fprintf(stderr,
                "whirl list: error: %s is a part of a file, but whirl list reads whole "
                "files\nhint: whirl list FILE\n",
                file);
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        code = list_one(&from, table, first);
    }
    source_close(&from);
    return code;
}

static int list_units(void) {
    char si[DIM_TEXT_SIZE];
    double value;
    puts("unit\tsi\tvalue");
    for (int i = 0; unit_name(i) != NULL; i++) {
        unit_in_si(i, &value, si, sizeof si);
        printf("%s\t%s\t%.17g\n", unit_name(i), si, value);
    }
    return EXIT_DONE;
}

/* The first table of docs/hard_cases.md. */
static int list_hard(void) {
    for (size_t i = 0; i < sizeof hard_rows / sizeof hard_rows[0]; i++) {
        printf("%-38s  %-54s  %-43s  %s\n", hard_rows[i].name, hard_rows[i].limit,
               hard_rows[i].verdict, hard_rows[i].scenes);
    }
    return EXIT_DONE;
}

/* Prints each figure's name and title, with "(make figures)" if whirl alone cannot make its records. */
static int list_figures(void) {
    for (size_t i = 0; i < builtin_figure_count; i++) {
        const char *file = strrchr(builtin_figures[i].file, '/') + 1;
        const char *name = file + (strncmp(file, "fig", 3) == 0 ? 3 : 0);
        const char *text = builtin_figures[i].text;
        const char *title = strstr(text, "title ");
        printf("%-16.*s %.*s%s\n", (int)strcspn(name, "."), name,
               title != NULL ? (int)strcspn(title + 6, "\n") : 0, title != NULL ? title + 6 : "",
               strstr(text, "\ntable ") != NULL ? " (make figures)" : "");
    }
    return EXIT_DONE;
}

typedef struct list_options {
    char **file; /* [files] */
    int files;
    const char *form;
    bool units, hard, figures;
} list_options;

static int list_work(void *options) {
    static const char *const forms[] = {"text", "table"};
    const list_options *o = options;
    const int other = o->units + o->hard + o->figures;
    if (other + (o->files > 0) + (o->form != NULL) > 1 && other > 0) {
        fputs("whirl list: error: --units, --hard and --figures allow no other option and no "
              "file\n",
              stderr);
        return EXIT_BAD_INPUT;
    }
    if (other > 0) {
        return o->units ? list_units() : o->hard ? list_hard() : list_figures();
    }
    const int chosen = options_choose("list", "form", o->form != NULL ? o->form : "text", forms,
                                      sizeof forms[0], 2);
    if (chosen < 0) {
        return EXIT_BAD_INPUT;
    }
    int code = o->files == 0 ? list_builtin(chosen == 1) : EXIT_DONE;
    for (int i = 0; i < o->files; i++) {
        const int one = list_file(o->file[i], chosen == 1, i == 0);
        code = one > code ? one : code;
    }
    return code;
}

int command_list(int count, char **words) {
    list_options o = {.file = alloc(count, sizeof *o.file)};
    const char *last;
    const own_option own[] = {{.word = "--as", .text = &o.form},
                              {.word = "--units", .flag = &o.units},
                              {.word = "--hard", .flag = &o.hard},
                              {.word = "--figures", .flag = &o.figures},
                              {.word = NULL}};
    const target_reader reader = {.command = "list",
                                  .usage = &usage,
                                  .table = own,
                                  .many = o.file,
                                  .many_count = &o.files,
                                  .none = true,
                                  .work = list_work};
    const int code = target_command(&reader, count, words, NULL, &o, &last);
    free(o.file);
    return code;
}
