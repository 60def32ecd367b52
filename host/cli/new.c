/* new.c: `whirl new`: a commented file as a starting point. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/lang/lexer.h"
#include "host/os/atomic_file.h"
#include "options.h"

static const command_usage usage = {
    .head =
        "usage: whirl new NAME\n"
        "\n"
        "Writes NAME.whirl: a pendulum on a cart, with a comment on every line. Change it into your own\n"
        "mechanism. Whirl never overwrites an existing file.\n",
    .why = {"", "the file was not written completely",
            "NAME is not a valid name, or NAME.whirl exists"}};

/* A printf() format for three strings: the mechanism's name, this name again, and the suffix of the scene's name. */
static const char template[] =
    "# One mechanism: coordinates, constants, energies. Values carry their units.\n"
    "mechanism %s \"A pendulum on a cart\"\n"
    "\n"
    "coordinate x     [m]   \"cart, along the rail\"\n"
    "coordinate theta [rad] \"pendulum, from hanging straight down\"\n"
    "\n"
    "parameter M = 3 [kg]                # cart\n"
    "parameter m = 1 [kg]                # bob\n"
    "parameter l = 40 [cm]               # length\n"
    "parameter g = 9.81 [m/s^2]\n"
    "\n"
    "let vx = x' + l*theta'*cos(theta)   # velocity of the bob; x' is the rate of x\n"
    "let vy = l*theta'*sin(theta)\n"
    "\n"
    "T = M*x'^2/2 + m*(vx^2 + vy^2)/2    # kinetic energy\n"
    "V = -m*g*l*cos(theta)               # potential energy\n"
    "\n"
    "output x_cm [m] = x + m/(M + m)*l*sin(theta)\n"
    "\n"
    "# An effect is off unless a scene or --with asks for it.\n"
    "effect drag \"viscous drag on the rail\" { parameter b = 0.5 [N*s/m]; F += b*x'^2/2 }\n"
    "effect push \"a hand at the cart\" { input hand = 1 [N]; Q(x) += hand }\n"
    "\n"
    "# A scene: where the motion starts, how fine the step is, when it ends.\n"
    "scene %s%s \"let go at 80 degrees\" {\n"
    "  start theta = 80 [deg]\n"
    "  step 1 [ms]\n"
    "  until 5 [s]\n"
    "}\n";

static const char suffix[] = "_swing";

static int write_new(const char *name, const char *file) {
    if (access(file, F_OK) == 0) {
        fprintf(stderr, "whirl new: error: %s exists\nhint: whirl new %s_2\n", file, name);
        return EXIT_BAD_INPUT;
    }
    FILE *out = atomic_file_open(file);
    if (out == NULL) {
        return EXIT_BAD_INPUT;
    }
    fprintf(out, template, name, name, suffix);
    if (!atomic_file_close(out, file, true)) {
        return EXIT_RUN_FAILED;
    }
    printf("whirl wrote %s. Next:\n"
           "  whirl derive %s\n"
           "  whirl run %s --plot %s.svg\n",
           file, file, file, name);
    return EXIT_DONE;
}

static int new_work(void *options) {
    const char *const name = *(const char **)options;
    if (!options_is_name("new", name, NAME_LENGTH_MAX - (int)strlen(suffix))) {
        return EXIT_BAD_INPUT;
    }
    char *file = alloc_words("%s.whirl", name);
    const int code = write_new(name, file);
    free(file);
    return code;
}

int command_new(int count, char **words) {
    const char *name;
    const target_reader reader = {
        .command = "new", .usage = &usage, .one = "name", .work = new_work};
    return target_command(&reader, count, words, NULL, &name, &name);
}
