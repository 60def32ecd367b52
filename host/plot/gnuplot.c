/* gnuplot.c: see gnuplot.h. */
#include "gnuplot.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *ending_of(const char *file) {
    const char *dot = strrchr(file, '.');
    return dot == NULL ? "" : dot + 1;
}

bool gnuplot_can_draw(const char *file) {
    return strcmp(ending_of(file), "svg") == 0 || strcmp(ending_of(file), "png") == 0;
}

/* A character, text[at], between gnuplot's double quotes. Letters and the bytes of UTF-8 stand for themselves, all
 * else is its octal code, so that nothing of it is a `command`, a @macro, an escape or a quote; digits too, lest
 * they lengthen the code before them. The picture's XML has no control characters: each becomes a blank. Nor has
 * it "]]>", whose > gnuplot leaves alone: a character without width (U+2060) parts it. */
void gnuplot_character(FILE *to, const char *text, size_t at) {
    const unsigned char code = (unsigned char)text[at];
    const unsigned char lower = code | 0x20;
    if (code == '>' && at >= 2 && text[at - 1] == ']' && text[at - 2] == ']') {
        fputs("\xe2\x81\xa0", to);
    }
    if (code >= 0x80 || (lower >= 'a' && lower <= 'z')) {
        fputc(code, to);
    } else {
        fprintf(to, "\\%03o", code < 0x20 || code == 0x7f ? (unsigned)' ' : (unsigned)code);
    }
}

/* Text as it is written, where gnuplot is told "noenhanced". */
void gnuplot_quote(FILE *to, const char *text) {
    fputc('"', to);
    for (size_t at = 0; text[at] != '\0'; at++) {
        gnuplot_character(to, text, at);
    }
    fputc('"', to);
}

/* Puts the file in the place of a stream, until put_back() of what this returns; -1 when there was none. */
static int put_in_place(FILE *file, int stream) {
    const int before = dup(stream);
    if (before >= 0) {
        dup2(fileno(file), stream);
    }
    return before;
}

static void put_back(int before, int stream) {
    if (before >= 0) {
        dup2(before, stream);
        close(before);
    }
}

/* gnuplot, which draws to its standard output, the picture: the file's name, which could begin with a | or ~,
 * never reaches it. What it says is kept in `said`: it is shown only when it fails. */
static FILE *start_gnuplot(FILE *picture, FILE *said) {
    fflush(stdout);
    fflush(stderr);
    const int output = put_in_place(picture, STDOUT_FILENO);
    const int errors = said == NULL ? -1 : put_in_place(said, STDERR_FILENO);
    FILE *to = output < 0 ? NULL : popen("LC_ALL=C.UTF-8 gnuplot", "w");
    put_back(errors, STDERR_FILENO);
    put_back(output, STDOUT_FILENO);
    return to;
}

static void show_said(FILE *said) {
    rewind(said);
    for (int c = fgetc(said); c != EOF; c = fgetc(said)) {
        fputc(c, stderr);
    }
}

bool gnuplot_is_there(void) {
    const bool there = system("command -v gnuplot >/dev/null 2>&1") == 0;
    if (!there) {
        fprintf(stderr, "whirl: error: plots need gnuplot, which is not installed\n"
                        "hint: make deps installs it (Debian package gnuplot-nox)\n");
    }
    return there;
}

bool gnuplot_open(gnuplot *g, const char *file, int height) {
    if (!gnuplot_is_there()) {
        return false;
    }
    FILE *picture = fopen(file, "wb");
    if (picture == NULL) {
        fprintf(stderr, "%s: error: cannot be written: %s\n", file, strerror(errno));
        return false;
    }
    g->file = file;
    g->before = signal(SIGPIPE, SIG_IGN);
    g->said = tmpfile(); /* without one, gnuplot says it itself */
    g->to = start_gnuplot(picture, g->said);
    fclose(picture);
    if (g->to == NULL) {
        perror("whirl: error: gnuplot");
        if (g->said != NULL) {
            fclose(g->said);
        }
        signal(SIGPIPE, g->before);
        return false;
    }
    fprintf(g->to,
            strcmp(ending_of(file), "svg") == 0
                ? "set terminal svg size 900,%d dynamic background rgb 'white'\n"
                : "set terminal pngcairo size 900,%d\n",
            height);
    fputs("set encoding utf8\n", g->to);
    return true;
}

/* gnuplot does not see that a disk is full, and says that all is well: has the file the end of such a picture? What keeps
 * nothing, such as a pipe, cannot be asked. */
static bool is_whole(const char *file) {
    char last[17] = {0};
    struct stat about;
    if (stat(file, &about) == 0 && !S_ISREG(about.st_mode)) {
        return true;
    }
    FILE *picture = fopen(file, "rb");
    const bool there =
        picture != NULL && fseek(picture, -16, SEEK_END) == 0 && fread(last, 1, 16, picture) == 16;
    if (picture != NULL) {
        fclose(picture);
    }
    const char *end = strcmp(ending_of(file), "svg") == 0 ? "</svg>" : "IEND";
    for (size_t i = 0; there && i + strlen(end) <= 16; i++) {
        if (memcmp(last + i, end, strlen(end)) == 0) {
            return true;
        }
    }
    return false;
}

bool gnuplot_close(gnuplot *g) {
    const bool written = ferror(g->to) == 0;
    const int code = pclose(g->to);
    signal(SIGPIPE, g->before);
    const bool whole = is_whole(g->file);
    const bool drawn = written && code == 0 && whole;
    if (g->said != NULL) {
        if (!drawn) {
            show_said(g->said);
        }
        fclose(g->said);
    }
    if (!drawn) {
        fprintf(stderr, "whirl: error: gnuplot could not draw %s\n%s", g->file,
                code == 0 && !whole ? "hint: is the disk full?\n" : "");
    }
    return drawn;
}
