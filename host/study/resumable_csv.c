/* resumable_csv.c: opening, checking and continuing a sweep's CSV file. */
#include "resumable_csv.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/base/atomic_file.h"
#include "host/base/exit.h"

static int refuse(const char *path, const char *why) {
    fprintf(stderr, "%s: error: %s\nhint: another --csv keeps it; --fresh overwrites it\n", path,
            why);
    return EXIT_BAD_INPUT;
}

static int cannot_write(const char *path) {
    write_error_say(path);
    return EXIT_RUN_FAILED;
}

/* --- the fingerprint ---------------------------------------------------------------------------*/

static char *read_text(const char *path) {
    FILE *in = fopen(path, "rb");
    if (in == NULL) {
        return NULL;
    }
    char *text = NULL;
    size_t length = 0;
    FILE *copy = alloc_text(&text, &length);
    for (int c = getc(in); c != EOF; c = getc(in)) {
        putc(c, copy);
    }
    alloc_text_end(copy);
    fclose(in);
    return text;
}

static bool write_fingerprint(const resumable_csv *sh, const char *fingerprint) {
    FILE *out = atomic_file_open(sh->beside);
    if (out != NULL) {
        fprintf(out, "%s%s", fingerprint, sh->notes);
    }
    return out != NULL && atomic_file_close(out, sh->beside, true);
}

#define NOTED "noted: "

static int line_length(const char *text) { return (int)strcspn(text, "\n"); }

static int check_fingerprint(resumable_csv *sh, const resumable_csv_settings *s) {
    char *there = read_text(sh->beside);
    if (there == NULL) {
        return refuse(s->path, "it is no sweep's: there is no FILE.sweep beside it");
    }
    const char *old = there;
    const char *new = s->fingerprint;
    while (*old != '\0' && *new != '\0' && line_length(old) == line_length(new) &&
           strncmp(old, new, (size_t)line_length(old)) == 0) {
        old += line_length(old) + (old[line_length(old)] == '\n');
        new += line_length(new) + (new[line_length(new)] == '\n');
    }
    int code = EXIT_DONE;
    if (*new == '\0' && strncmp(old, NOTED, sizeof NOTED - 1) == 0) {
        free(sh->notes);
        sh->notes = alloc_words("%s", old);
    } else if (*old != '\0' || *new != '\0') {
        code = refuse(s->path, "it belongs to another sweep");
        fprintf(stderr, "  there: %.*s\n  here:  %.*s\n", line_length(old), old, line_length(new),
                new);
    }
    free(there);
    return code;
}

/* --- the rows that are there -------------------------------------------------------------------*/

static bool ends_whole(const char *line, ssize_t length) {
    return length >= 2 && line[length - 2] == '\r' && line[length - 1] == '\n';
}

/* The text of the swept fields, followed by a comma. */
static char *swept_text(const resumable_csv_settings *s, uint64_t row) {
    char *text = NULL;
    size_t length = 0;
    FILE *out = alloc_text(&text, &length);
    s->swept(s->context, row, out);
    fputc(',', out);
    alloc_text_end(out);
    return text;
}

/* Is this the row: its swept fields, followed by this many numbers or empty fields? */
static bool is_row(const resumable_csv_settings *s, const char *line, size_t length, uint64_t row,
                   bool *failed) {
    char *swept = swept_text(s, row);
    const size_t start = strlen(swept);
    bool good = row < s->rows && length > start && strncmp(line, swept, start) == 0;
    free(swept);
    int commas = 0;
    for (size_t i = start; i < length - 2 && good; i++) {
        good = line[i] != '\0' && strchr("0123456789+-.einfa,", line[i]) != NULL;
        commas += line[i] == ',';
    }
    *failed = good && (line[start] == ',' || line[start] == '\r');
    return good && commas == s->measures - 1;
}

/* Checks the rows; *whole is the end of the last complete one. */
static int check_rows(resumable_csv *sh, const resumable_csv_settings *s, off_t *whole) {
    char *line = NULL;
    size_t size = 0;
    int code = EXIT_DONE;
    bool in_header = s->header[0] != '\0';
    *whole = 0;
    for (;;) {
        const ssize_t length = getline(&line, &size, sh->out);
        if (length < 0 || !ends_whole(line, length)) {
            break;
        }
        bool failed = false;
        if (in_header && strcmp(line, s->header) != 0) {
            code = refuse(s->path, "its header is another sweep's");
            break;
        }
        if (!in_header && !is_row(s, line, (size_t)length, sh->rows, &failed)) {
            char why[100];
            snprintf(why, sizeof why, "its row %llu is not this sweep's",
                     (unsigned long long)sh->rows + 1);
            code = refuse(s->path, why);
            break;
        }
        *whole += (off_t)length;
        sh->rows += in_header ? 0 : 1;
        sh->failed += failed ? 1 : 0;
        in_header = false;
    }
    free(line);
    return code;
}

/* --- opening -----------------------------------------------------------------------------------*/

static int lock(const resumable_csv *sh, const char *path) {
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(fileno(sh->out), F_SETLK, &whole) == 0) {
        return EXIT_DONE;
    }
    if (errno != EACCES && errno != EAGAIN) {
        return EXIT_DONE; /* a file system without locks */
    }
    fprintf(stderr, "%s: error: another sweep is writing it\n", path);
    return EXIT_BAD_INPUT;
}

static int go_on(resumable_csv *sh, const resumable_csv_settings *s, off_t size) {
    off_t whole = 0;
    int code = EXIT_DONE;
    if (size > 0 && !s->fresh) {
        code = check_fingerprint(sh, s);
        code = code == EXIT_DONE ? check_rows(sh, s, &whole) : code;
    }
    if (code != EXIT_DONE) {
        return code;
    }
    /* the file must never be newer than its fingerprint */
    if (whole == 0 && ftruncate(fileno(sh->out), 0) != 0) {
        return cannot_write(s->path);
    }
    if (!write_fingerprint(sh, s->fingerprint)) {
        return EXIT_RUN_FAILED;
    }
    if (ftruncate(fileno(sh->out), whole) != 0 || fseeko(sh->out, whole, SEEK_SET) != 0) {
        return cannot_write(s->path);
    }
    if (whole == 0 && (fputs(s->header, sh->out) < 0 || fflush(sh->out) != 0)) {
        return cannot_write(s->path);
    }
    return EXIT_DONE;
}

static void forget(resumable_csv *sh) {
    free(sh->beside);
    free(sh->notes);
    sh->beside = sh->notes = NULL;
}

int resumable_csv_open(resumable_csv *sh, const resumable_csv_settings *s) {
    *sh = (resumable_csv){.path = s->path, .notes = alloc_words("%s", "")};
    struct stat about = {0};
    const bool is_stdout = strcmp(s->path, "-") == 0;
    const bool exists = !is_stdout && stat(s->path, &about) == 0;
    if (is_stdout || (exists && !S_ISREG(about.st_mode))) {
        sh->out = is_stdout ? stdout : fopen(s->path, "wb");
        if (sh->out == NULL || fputs(s->header, sh->out) < 0) {
            forget(sh);
            return cannot_write(s->path);
        }
        return EXIT_DONE;
    }
    sh->is_file = true;
    const int file = open(s->path, O_RDWR | O_CREAT, 0666);
    sh->out = file < 0 ? NULL : fdopen(file, "r+b");
    if (sh->out == NULL) {
        cannot_write(s->path);
        forget(sh);
        return EXIT_BAD_INPUT; /* a wrong path is bad input, as for `run` */
    }
    int code = lock(sh, s->path);
    if (code == EXIT_DONE && fstat(file, &about) != 0) {
        code = cannot_write(s->path);
    }
    if (code == EXIT_DONE) {
        sh->beside = alloc_words("%s.sweep", s->path);
        code = go_on(sh, s, about.st_size);
    }
    if (code != EXIT_DONE) {
        fclose(sh->out);
        sh->out = NULL;
        forget(sh);
    }
    return code;
}

bool resumable_csv_has_note(const resumable_csv *sh, const char *word) {
    char *line = alloc_words(NOTED "%s\n", word);
    const bool has = strstr(sh->notes, line) != NULL;
    free(line);
    return has;
}

bool resumable_csv_note(resumable_csv *sh, const char *word) {
    if (resumable_csv_has_note(sh, word)) {
        return true;
    }
    char *notes = alloc_words("%s" NOTED "%s\n", sh->notes, word);
    free(sh->notes);
    sh->notes = notes;
    FILE *out = sh->beside != NULL ? fopen(sh->beside, "ab") : NULL;
    const bool good = out == NULL || fprintf(out, NOTED "%s\n", word) > 0;
    const bool closed = out == NULL || fclose(out) == 0;
    if (sh->beside != NULL && (out == NULL || !good || !closed)) {
        write_error_say(sh->beside);
        return false;
    }
    return true;
}

bool resumable_csv_close(resumable_csv *s) {
    forget(s);
    if (s->out == NULL) {
        return true;
    }
    /* standard output is checked at the end of the program (host/whirl.c) */
    const bool is_file = s->out != stdout;
    const bool good = !is_file || (fflush(s->out) == 0 && ferror(s->out) == 0);
    const bool closed = !is_file || fclose(s->out) == 0;
    if (!good || !closed) {
        write_error_say(s->path);
    }
    s->out = NULL;
    return good && closed;
}
