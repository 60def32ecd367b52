/* written.h: files that are written whole or stay as they were: the text stands in NAME.part until it is complete. */
#ifndef BASE_WRITTEN_H
#define BASE_WRITTEN_H

#include <stdbool.h>
#include <stdio.h>

/* "-" is standard output. Devices, pipes, links and files of folders that take no new file are written in place.
 * NULL is reported. */
FILE *written_open(const char *name);

/* Puts the text in its place if all of it was taken and `keep` says so. False, reported: it was not taken. NULL is
 * closed already, and a file that was opened otherwise is only closed.
 * Standard output is checked at the program's end (host/whirl.c). */
bool written_close(FILE *file, const char *name, bool keep);

/* Whether written_open() would succeed; nothing is changed. NULL and "-" can be written. False is reported. */
bool written_can(const char *name);

/* Reports that the file cannot be written, with the reason from errno. */
void unwritten_say(const char *name);

/* For the exit code: a file could not be written whole. */
void written_not_whole(void);
/* The program's exit code: a failure if a file that could be opened was not taken whole. */
int written_code(int code);

#endif
