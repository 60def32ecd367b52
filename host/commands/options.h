/* options.h: reading the words of a command line. */
#ifndef COMMANDS_OPTIONS_H
#define COMMANDS_OPTIONS_H

#include <stdbool.h>

#include "host/lang/model.h"
#include "host/run/engine.h"

/* Prints `usage` and returns true when --help or -h is among the words. */
bool options_help(int count, char **words, const char *usage);

/* If words[*at] is `name` (or `name=VALUE`), returns its value and steps *at past it. Returns NULL if
 * it is not; a missing value is reported and sets *bad. */
const char *options_value(int count, char **words, int *at, const char *name, bool *bad);

/* The options that change an instance: --set, --start, --with, --without, --step, --until. */
typedef struct change_options {
    const char **sets;
    int set_count;
    const char **starts;
    int start_count;
    const char **with;
    int with_count;
    const char **without;
    int without_count;
    const char *step;
    const char *until;
    const char *name; /* --name, where a command has it; else NULL */
    char **owned;     /* pieces of comma lists */
    int owned_count;
} change_options;

#define CHANGE_OPTIONS "--set", "--start", "--with", "--without", "--step", "--until"

/* If words[*at] is one of them, takes it and returns true. */
bool options_change(int count, char **words, int *at, change_options *changes, bool *bad);
overrides change_options_overrides(const change_options *changes);
void change_options_free(change_options *changes);

/* How to integrate: --method M and --compensated, as for options_change(). */
#define ENGINE_OPTIONS "--method", "--compensated"
bool options_engine(const char *command, int count, char **words, int *at, image_settings *settings,
                    bool *bad);

/* What computes: --number N; *kind is left alone without it. */
bool options_number(const char *command, int count, char **words, int *at, const engine_kind **kind,
                    bool *bad);

/* Report a word that no option takes, with the nearest of `known` (NULL ends the list). */
void options_unknown(const char *command, const char *word, const char *const *known);

#endif
