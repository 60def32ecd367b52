/* files.h: telling whether two names lead to one file. */
#ifndef COMMANDS_FILES_H
#define COMMANDS_FILES_H

#include <stdbool.h>
#include <sys/stat.h>

/* Do these describe one file? By device and inode; where either has none (some network file systems and
 * WASI give 0), by what their paths resolve to, and, where a path is unknown (NULL) or says no, by all else that
 * is known of them: device, size, times and more than one link, or no path. Two files that are taken for
 * one cost the user another name; one that is taken for two, the file. */
bool files_are_one(const struct stat *one, const char *path, const struct stat *other,
                   const char *other_path);

/* Are both the same file, by name or, when they are there, by what the names lead to? */
bool files_same(const char *one, const char *other);

#endif
