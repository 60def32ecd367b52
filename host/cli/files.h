/* files.h: the test for two names of the same file. */
#ifndef CLI_FILES_H
#define CLI_FILES_H

#include <stdbool.h>
#include <sys/stat.h>

/* Do these describe the same file? Device and inode decide. If an inode is 0 (some network file systems and WASI), the
 * resolved paths are compared. If a path is unknown (NULL) or the paths differ, the other attributes decide: device,
 * size, times, and more than one link or no path. A false positive costs the user another name; a false negative costs
 * the file. */
bool files_are_one(const struct stat *one, const char *path, const struct stat *other,
                   const char *other_path);

/* Are both the same file, by name or, if they exist, by identity? */
bool files_same(const char *one, const char *other);

#endif
