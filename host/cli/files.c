/* files.c: comparison of files by inode, path or attributes. */
#define _XOPEN_SOURCE 700 /* realpath() */

#include "files.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/base/alloc.h"

#ifdef __wasi__ /* not available: a file has only its given name */
static char *realpath(const char *path, char *resolved) {
    (void)resolved;
    return alloc_copy(path, strlen(path));
}
#endif

/* Do both resolve to the same path? */
static bool one_path(const char *path, const char *other_path) {
    char *resolved = realpath(path, NULL);
    char *other = realpath(other_path, NULL);
    const bool one = resolved != NULL && other != NULL && strcmp(resolved, other) == 0;
    free(resolved);
    free(other);
    return one;
}

static bool same_time(struct timespec one, struct timespec other) {
    return one.tv_sec == other.tv_sec && one.tv_nsec == other.tv_nsec;
}

/* All attributes are equal: a link, or a file that came without a name. */
static bool look_alike(const struct stat *one, const struct stat *other) {
    return one->st_dev == other->st_dev && one->st_mode == other->st_mode &&
           one->st_size == other->st_size && one->st_nlink == other->st_nlink &&
           same_time(one->st_mtim, other->st_mtim) && same_time(one->st_ctim, other->st_ctim);
}

bool files_are_one(const struct stat *one, const char *path, const struct stat *other,
                   const char *other_path) {
    if (one->st_ino != 0 && other->st_ino != 0) {
        return one->st_dev == other->st_dev && one->st_ino == other->st_ino;
    }
    if (path != NULL && other_path != NULL) {
        return one_path(path, other_path) || (one->st_nlink > 1 && look_alike(one, other));
    }
    return look_alike(one, other);
}

bool files_same(const char *one, const char *other) {
    struct stat first;
    struct stat second;
    return strcmp(one, other) == 0 ||
           (stat(one, &first) == 0 && stat(other, &second) == 0 && S_ISREG(first.st_mode) &&
            files_are_one(&first, one, &second, other));
}
