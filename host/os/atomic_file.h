/* atomic_file.h: atomic file writing: the text goes to NAME.part, which replaces NAME when it is complete. */
#ifndef OS_ATOMIC_FILE_H
#define OS_ATOMIC_FILE_H

#include <stdbool.h>
#include <stdio.h>

/* "-" is standard output. Devices, pipes, links, and files in folders without write permission are written in place.
 * Returns NULL after reporting an error. */
FILE *atomic_file_open(const char *name);

/* Replace the file if all text was written and `keep` is true. Returns false after reporting a failed write. NULL
 * counts as closed, and a file from another function is only closed. The end of the program checks standard output
 * (host/whirl.c). */
bool atomic_file_close(FILE *file, const char *name, bool keep);

/* Is an open file neither a device nor a pipe? */
bool atomic_file_is_regular(FILE *file);

/* True if atomic_file_open() would succeed; changes nothing. NULL and "-" are writable. Returns false after reporting. */
bool atomic_file_can(const char *name);

/* Report that the file cannot be written, with the reason from errno. */
void write_error_say(const char *name);

/* Record for the exit status that a file is incomplete. */
void atomic_file_not_whole(void);
/* The program's exit status: a failure if an opened file could not be written completely. */
int atomic_file_code(int code);

/* Write a field of CSV, quoted if RFC 4180 requires it. */
void atomic_file_field(FILE *out, const char *text);

#endif
