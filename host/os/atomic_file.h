/* atomic_file.h: atomic file writing: the text goes to NAME.part, which replaces NAME when it is complete. */
#ifndef OS_ATOMIC_FILE_H
#define OS_ATOMIC_FILE_H

#include <stdbool.h>
#include <stdio.h>

/* Opens a file for writing. "-" is standard output. Devices, pipes, links, and files in folders without write
 * permission are written in place. An ordinary file is locked until it is closed. Returns NULL after reporting an error. */
FILE *atomic_file_open(const char *name);
/* As atomic_file_open(), but writes in place, so that the file can be read while it grows. "-" is a name like others. */
FILE *atomic_file_open_in_place(const char *name);

/* Closes the file, and replaces the old one if all text was written and `keep` is true. Returns false after reporting
 * a failed write. `file` may be NULL. A file that another function opened is only closed. Standard output is checked
 * at the end of the program (host/whirl.c). */
bool atomic_file_close(FILE *file, const char *name, bool keep);

/* Is an open file neither a device nor a pipe? */
bool atomic_file_is_regular(FILE *file);

/* Returns true if atomic_file_open() would succeed, and changes nothing. NULL and "-" are writable. Returns false after
 * reporting the reason. */
bool atomic_file_can(const char *name);

/* Reports that the file cannot be written, with the reason from errno. */
void write_error_say(const char *name);

/* Records for the exit status that a file is incomplete. */
void atomic_file_not_whole(void);
/* Returns the program's exit status: `code`, or a failure if an opened file could not be written completely. */
int atomic_file_code(int code);

/* Writes a field of CSV, in quotes if RFC 4180 requires them. */
void atomic_file_field(FILE *out, const char *text);

#endif
