#include "host/os/atomic_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/base/exit.h"
#include "host/os/system.h"

static bool failed;

void write_error_say(const char *name) {
    const int reason = errno;
    failed = failed || reason == ENOSPC || reason == EDQUOT || reason == EFBIG || reason == EIO;
    fprintf(stderr, "%s: error: cannot be written: %s\n", name[0] != '\0' ? name : "''",
            reason != 0 ? strerror(reason) : "only a part was written");
}

void atomic_file_not_whole(void) { failed = true; }

int atomic_file_code(int code) {
    return failed && code != EXIT_INTERRUPTED ? EXIT_RUN_FAILED : code;
}

static char *part_of(const char *name) { return alloc_words("%s.part", name); }

static bool can_be_replaced(const char *name, struct stat *there) {
    if (name[0] == '\0' || lstat(name, there) != 0) {
        there->st_mode = 0;
        return name[0] != '\0' && errno == ENOENT;
    }
    return S_ISREG(there->st_mode) && there->st_nlink == 1 && access(name, W_OK) == 0;
}

/* Opens NAME.part; or `name` itself, with fopen()'s mode `in_place`, if that file cannot be replaced. */
static FILE *open_part(const char *name, const char *in_place) {
    struct stat there;
    if (!can_be_replaced(name, &there)) {
        return fopen(name, in_place);
    }
    char *part = part_of(name);
    FILE *file = fopen(part, "wb");
    if (file == NULL && (errno == EACCES || errno == ENAMETOOLONG)) {
        file = fopen(name, in_place);
    }
    if (file != NULL && there.st_mode != 0) {
        system_set_mode(file, there.st_mode & 0777U);
    }
    free(part);
    return file;
}

static FILE *open_as(const char *name, const char *in_place) {
    FILE *file = strcmp(name, "-") == 0 ? stdout : open_part(name, in_place);
    if (file == NULL) {
        write_error_say(name);
    }
    return file;
}

FILE *atomic_file_open(const char *name) { return open_as(name, "wb"); }

/* Is the open file the one at the path `name`? */
static bool is_at(FILE *file, const char *name) {
    struct stat one;
    struct stat other;
    return fstat(fileno(file), &one) == 0 && lstat(name, &other) == 0 &&
           one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

bool atomic_file_close(FILE *file, const char *name, bool keep) {
    if (file == NULL || file == stdout) {
        return true;
    }
    char *part = part_of(name);
    const bool in_place = !is_at(file, part);
    errno = 0;
    const bool taken = fflush(file) == 0 && ferror(file) == 0;
    /* an earlier write failed, and its errno is lost: a new write sets errno */
    if (!taken && errno == 0) {
        fputc('\n', file);
        (void)fflush(file);
    }
    bool good = fclose(file) == 0 && taken;
    if (good && keep && !in_place) {
        good = rename(part, name) == 0;
    }
    if (!good) {
        write_error_say(name);
        atomic_file_not_whole();
    }
    if (!in_place && !(good && keep)) {
        (void)unlink(part);
    }
    free(part);
    return good;
}

bool atomic_file_is_regular(FILE *file) {
    struct stat there;
    return fstat(fileno(file), &there) == 0 && S_ISREG(there.st_mode);
}

bool atomic_file_can(const char *name) {
    FILE *file = name != NULL ? open_as(name, "ab") : stdout;
    return file != NULL && atomic_file_close(file, name, false);
}

void atomic_file_field(FILE *out, const char *text) {
    if (strpbrk(text, ",\"\r\n") == NULL) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text != '\0'; text++) {
        fputs(*text == '"' ? "\"\"" : (char[]){*text, '\0'}, out);
    }
    fputc('"', out);
}
