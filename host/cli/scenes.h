/* scenes.h: the common part of the commands of the project's own build: files in a folder, and lines of
 * hashes. */
#ifndef CLI_SCENES_H
#define CLI_SCENES_H

#include <stdio.h>

#include "host/engine/engine.h"

/* The file FOLDER/NAME + ending, to write; NULL, reported. */
FILE *scenes_open(const char *folder, const char *name, const char *ending);

/* Writes the scene's run as a line with the hash of its last state: "WHAT NAME steps N hash 0x... ok". Returns the
 * events. */
uint64_t scenes_write_hash(FILE *out, const char *what, const engine_kind *kind, const image *im);

#endif
