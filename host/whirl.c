/* whirl.c: the command line. */
#include <errno.h>
#include <locale.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "core/number/arithmetic.h"
#include "core/version.h"
#include "host/base/spelling.h"
#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/os/atomic_file.h"
#include "host/os/system.h"

typedef struct command {
    const char *name;
    int (*run)(int count, char **words);
    const char *takes; /* arguments, for the list of commands */
    const char *text;  /* purpose; NULL: not listed, because only build and tests use the command */
} command;

static const command commands[] = {
    {"list", command_list, "", "the built-in mechanisms and scenes"},
    {"new", command_new, "NAME", "a commented file to start from: NAME.whirl"},
    {"check", command_check, "FILE ...", "errors of a file, without running anything"},
    {"derive", command_derive, "FILE [--as FORM]", "equations of motion, or the scene as code"},
    {"describe", command_describe, "SCENE|FILE[:SCENE]",
     "contents of a scene: names, units, sizes; --json for programs"},
    {"examine", command_examine, "FILE [options]", "symmetries, momenta, and the forces on them"},
    {"accel", command_accel, "FILE NAME=VALUE ...", "accelerations at one state"},
    {"run", command_run, "SCENE|FILE[:SCENE] ...", "simulate"},
    {"plot", command_plot, "FILE.csv|SCENE ...", "curves of recorded or new runs"},
    {"figure", command_figure, "NUMBER", "a figure of the dissertation, as it is or varied"},
    {"sweep", command_sweep, "SCENE|FILE[:SCENE] ...", "simulate over ranges of parameters"},
    {"price", command_price, "SCENE|FILE[:SCENE] ...", "error and price of many settings"},
    {"choose", command_choose, "SCENE|FILE[:SCENE] ...",
     "the cheapest setting on a board for the error that you allow"},
    {"effects", command_effects, "SCENE|FILE[:SCENE] ...",
     "influence and cost of each effect; the needed effects"},
    {"trust", command_trust, "SCENE|FILE[:SCENE] ...", "the time until which a run can be trusted"},
    {"prove", command_prove, "SCENE|FILE[:SCENE] ...",
     "the time until which a run is proved to be accurate"},
    {"map", command_map, "SCENE|FILE[:SCENE] ...", "pairs of values for which a run is accurate"},
    {"pil", command_pil, "SCENE --firmware IMAGE",
     "firmware in an emulator, with a scene as its plant"},
    {"monitor", command_monitor, "PORT", "a rig's console, and a recording of its telemetry"},
    {"firstlight", command_firstlight, "FILE|PORT", "comparison of a board's results with Whirl's"},
    {"emit-scenes", command_emit_scenes, NULL, NULL},
    {"hashes", command_hashes, NULL, NULL},
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static void print_usage(FILE *out) {
    static const char *const why[EXITS] = {
        "", "a run failed, or an output could not be written (full disk)",
        "or an output cannot be opened (missing folder)", ""};
    fputs("usage: whirl COMMAND ...\n"
          "\n"
          "Whirl derives equations of motion from energies, runs them, and writes C for firmware.\n"
          "\n",
          out);
    for (int i = 0; i < COMMANDS; i++) {
        if (commands[i].text != NULL) {
            const int room = 30 - (int)strlen(commands[i].name);
            fprintf(out, "  whirl %s %-*s%s\n", commands[i].name, room, commands[i].takes,
                    commands[i].text);
        }
    }
    fputs("\nIn place of FILE[:SCENE] every command also takes a built-in MECHANISM[:SCENE].\n"
          "`whirl help COMMAND` says more; `whirl version` prints the version.\n",
          out);
    exit_describe(out, why);
}

static const command *command_named(const char *name) {
    for (int i = 0; i < COMMANDS; i++) {
        if (strcmp(name, commands[i].name) == 0) {
            return &commands[i];
        }
    }
    return NULL;
}

static int say_unknown(const char *name) {
    nearest search = nearest_start(name, strlen(name));
    for (int i = 0; i < COMMANDS; i++) {
        if (commands[i].text != NULL) {
            nearest_offer(&search, commands[i].name);
        }
    }
    fprintf(stderr, "whirl: error: unknown command '%s'\n", name);
    if (search.best != NULL) {
        fprintf(stderr, "hint: did you mean '%s'?\n", search.best);
    } else {
        fputs("hint: `whirl help` lists the commands\n", stderr);
    }
    return EXIT_BAD_INPUT;
}

static bool is_one_of(const char *word, const char *a, const char *b, const char *c) {
    return strcmp(word, a) == 0 || strcmp(word, b) == 0 || (c != NULL && strcmp(word, c) == 0);
}

/* Runs the command words[1]. Output may remain in a buffer. */
static int answer(int count, char **words) {
    static char help_word[] = "--help";
    char *help[] = {help_word, NULL};
    if (count < 2) {
        print_usage(stderr);
        return EXIT_BAD_INPUT;
    }
    const bool asks_for_help = is_one_of(words[1], "--help", "-h", "help");
    if (asks_for_help && count == 2) {
        print_usage(stdout);
        return EXIT_DONE;
    }
    if (is_one_of(words[1], "--version", "version", NULL)) {
        puts("whirl " WH_VERSION);
        return EXIT_DONE;
    }
    const char *name = words[asks_for_help ? 2 : 1];
    const command *named = command_named(name);
    if (named == NULL) {
        return say_unknown(name);
    }
    return asks_for_help ? named->run(1, help) : named->run(count - 2, words + 2);
}

/* Checks ferror(), because an earlier write may have failed even if this flush succeeds. */
static int after_writing(int code) {
    errno = 0;
    const bool last_part = fflush(stdout) == 0;
    const int reason = errno;
    if (last_part && ferror(stdout) == 0) {
        return atomic_file_code(code);
    }
    fprintf(stderr, "whirl: error: cannot write to standard output%s%s\n", last_part ? "" : ": ",
            last_part ? "" : strerror(reason));
    return code == EXIT_DONE ? EXIT_RUN_FAILED : code;
}

int main(int count, char **words) {
    setlocale(LC_ALL, "C");
    system_begin();
    if (wh_arithmetic_wrong(wh_arithmetic) != WH_PROBED_COUNT) {
        fputs("whirl: error: the arithmetic of this program is not that of IEEE 754\nhint: build "
              "whirl without -ffast-math, and load no library that was linked with -ffast-math\n",
              stderr);
        return EXIT_RUN_FAILED;
    }
    return after_writing(answer(count, words));
}
