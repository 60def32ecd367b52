#include "host/os/atomic_file.h"

#include <errno.h>
#include <stdarg.h>
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
            reason == EBUSY ? "another whirl is writing it\nhint: use another file"
            : reason != 0   ? strerror(reason)
                            : "only a part was written");
    const char *slash = strrchr(name, '/');
    if (reason == ENOENT && slash != NULL && name[0] != '-' && strchr(name, '\'') == NULL) {
        char *folder = alloc_words("%.*s", (int)(slash - name), name);
        if (access(folder, F_OK) != 0) {
            fprintf(stderr, "hint: mkdir -p '%s'\n", folder);
        }
        free(folder);
    }
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

/* Is the open file still the one at the path? */
static bool is_at(FILE *file, const char *name) {
    struct stat one;
    struct stat other;
    return fstat(fileno(file), &one) == 0 && stat(name, &other) == 0 &&
           one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

/* Opens a file, and locks an ordinary one. Sets errno to EBUSY if another process writes it or just replaced it. */
static FILE *open_alone(const char *name, bool empties) {
    FILE *file = fopen(name, "ab");
    if (file != NULL && atomic_file_is_regular(file)) {
        const bool alone = system_lock(file) && is_at(file, name);
        if (!alone || (empties && ftruncate(fileno(file), 0) != 0)) {
            const int reason = alone ? errno : EBUSY;
            fclose(file);
            errno = reason;
            return NULL;
        }
    }
    return file;
}

/* Opens NAME.part. If `name` cannot be replaced, opens `name` itself, and empties it if `empties`. */
static FILE *open_part(const char *name, bool empties) {
    struct stat there;
    if (!can_be_replaced(name, &there)) {
        return open_alone(name, empties);
    }
    FILE *old = there.st_mode != 0 ? open_alone(name, false) : NULL;
    if (old == NULL ? there.st_mode != 0 : fclose(old) != 0) {
        return NULL; /* another process is writing `name` in place */
    }
    char *part = part_of(name);
    FILE *file = open_alone(part, true);
    if (file == NULL && (errno == EACCES || errno == ENAMETOOLONG)) {
        file = open_alone(name, empties);
    }
    if (file != NULL && there.st_mode != 0) {
        system_set_mode(file, there.st_mode & 0777U);
    }
    free(part);
    return file;
}

static FILE *or_say(FILE *file, const char *name) {
    if (file == NULL) {
        write_error_say(name);
    }
    return file;
}

static FILE *open_as(const char *name, bool empties) {
    return strcmp(name, "-") == 0 ? stdout : or_say(open_part(name, empties), name);
}

FILE *atomic_file_open(const char *name) { return open_as(name, true); }

FILE *atomic_file_open_in_place(const char *name) { return or_say(open_alone(name, true), name); }

bool atomic_file_close(FILE *file, const char *name, bool keep) {
    if (file == NULL || file == stdout) {
        return true;
    }
    char *part = part_of(name);
    const bool in_place = !is_at(file, part);
    errno = 0;
    const bool taken = fflush(file) == 0 && ferror(file) == 0;
    /* an earlier write failed, and its errno is lost: write again to set errno */
    if (!taken && errno == 0) {
        fputc('\n', file);
        (void)fflush(file);
    }
    /* this must be before fclose(), which unlocks NAME.part for other processes */
    bool good = taken && (in_place || !keep || rename(part, name) == 0);
    if (!in_place && !(good && keep)) {
        (void)unlink(part);
    }
    good = fclose(file) == 0 && good;
    if (!good) {
        write_error_say(name);
        atomic_file_not_whole();
    }
    free(part);
    return good;
}

bool atomic_file_print(const char *name, const char *format, ...) {
    FILE *file = atomic_file_open(name);
    if (file != NULL) {
        va_list values;
        va_start(values, format);
        vfprintf(file, format, values);
        va_end(values);
    }
    return file != NULL && atomic_file_close(file, name, true);
}

bool atomic_file_is_regular(FILE *file) {
    struct stat there;
    return fstat(fileno(file), &there) == 0 && S_ISREG(there.st_mode);
}

bool atomic_file_can(const char *name) {
    FILE *file = name != NULL ? open_as(name, false) : stdout;
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
