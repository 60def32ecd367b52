/* atomic_file.h: atomic file writing: the text goes to NAME.part, which replaces NAME when it is complete. */
#ifndef OS_ATOMIC_FILE_H
#define OS_ATOMIC_FILE_H

#include <stdbool.h>
#include <stdio.h>

/* Opens a file for writing; "-" is standard output. Devices, pipes, links, and files in folders without write
 * permission are written in place. An ordinary file is locked until closed. Returns NULL on failure (reported). */
FILE *atomic_file_open(const char *name);
/* Like atomic_file_open(), but in place, so that the file can be read while it grows. "-" is an ordinary name. */
FILE *atomic_file_open_in_place(const char *name);

/* Closes the file, which may be NULL. If `keep`, and if all text was written, NAME.part replaces NAME. Standard output
 * stays open: host/whirl.c checks it at the program's end. Returns false on failure (reported). */
bool atomic_file_close(FILE *file, const char *name, bool keep);

/* Opens, writes and closes a file, with the text that printf() would print. Returns false on failure (reported). */
bool atomic_file_print(const char *name, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

bool atomic_file_is_regular(FILE *file);

/* Returns true if atomic_file_open() would succeed, or if `name` is NULL; else reports why. Keeps the file's text. */
bool atomic_file_can(const char *name);

/* Reports that the file cannot be written, with the reason from errno. */
void write_error_say(const char *name);

/* Makes atomic_file_code() return a failure. */
void atomic_file_not_whole(void);
/* The program's exit status: `code`, or a failure if an opened file is incomplete. */
int atomic_file_code(int code);

/* Writes a CSV field, in quotes if RFC 4180 requires them. */
void atomic_file_field(FILE *out, const char *text);

#endif
