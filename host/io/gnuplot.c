/* gnuplot.c: pictures by gnuplot, and quoting of text for it. */
#include "host/io/gnuplot.h"

#include <stdlib.h>
#include <string.h>

#include "host/os/atomic_file.h"
#include "host/os/system.h"

static const char *ending_of(const char *file) {
    const char *dot = strrchr(file, '.');
    return dot == NULL ? "" : dot + 1;
}

bool gnuplot_can_draw_for(const char *command, const char *option, const char *file) {
    const char *ending = ending_of(file);
    const bool can =
        strcmp(ending, "svg") == 0 || strcmp(ending, "png") == 0 || strcmp(ending, "pdf") == 0;
    if (!can) {
        fprintf(stderr,
                "whirl %s: error: %s draws .svg, .pdf and .png files, not '%s'\n"
                "hint: %s picture.svg\n",
                command, option, file, option);
    }
    return can;
}

/* A word joiner (U+2060) splits "]]>", because XML forbids "]]>" in an SVG file's text. */
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

void gnuplot_quote(FILE *to, const char *text) {
    fputc('"', to);
    for (size_t at = 0; text[at] != '\0'; at++) {
        gnuplot_character(to, text, at);
    }
    fputc('"', to);
}

/* Shows gnuplot's messages. If they say that an axis has no range, reports a panel without points instead. */
static void show_said(FILE *said) {
    char *text = NULL;
    size_t size = 0;
    rewind(said);
    if (getdelim(&text, &size, '\0', said) > 0) {
        const bool empty =
            strstr(text, "undefined!") != NULL || strstr(text, "range is invalid") != NULL;
        fputs(empty ? "whirl: error: a panel has no points\nhint: use a later --until\n" : text,
              stderr);
    }
    free(text);
}

bool gnuplot_is_there(void) {
    const bool there = system_end(system_read_from("command -v gnuplot 2>&1 >/dev/null")) == 0;
    if (!there) {
        fprintf(stderr, "whirl: error: plots need gnuplot, which is not installed\n"
                        "hint: make deps installs it (Debian package gnuplot-nox)\n");
    }
    return there;
}

static void set_look(gnuplot *g, int height) {
    const char *ending = ending_of(g->file);
    if (strcmp(ending, "svg") == 0) {
        fprintf(g->to, "set terminal svg size 900,%d dynamic font 'sans-serif,14' background rgb ",
                height);
    } else if (strcmp(ending, "pdf") == 0) {
        fprintf(g->to, "set terminal pdfcairo size 9in,%.2fin font 'Sans,12' background rgb ",
                (double)height / 100.0);
    } else {
        fprintf(g->to, "set terminal pngcairo size 900,%d font 'Sans,11' background rgb ", height);
    }
    fputs("'" PALETTE_WHITE "'\n"
          "set encoding utf8\n"
          "set border lw 1 lc rgb '" PALETTE_FRAME "'\n"
          "set grid lt 1 lw 0.7 lc rgb '" PALETTE_GRID "'\n"
          "set tics nomirror textcolor rgb 'black'\n",
          g->to);
}

static bool give_up(gnuplot *g) {
    FILE *const files[] = {g->drawn, g->said};
    (void)atomic_file_close(g->picture, g->file, false);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        if (files[i] != NULL) {
            fclose(files[i]);
        }
    }
    return false;
}

bool gnuplot_open(gnuplot *g, const char *file, int height, const char *title, const char *text) {
    *g = (gnuplot){.file = file, .title = title, .text = text, .picture = atomic_file_open(file)};
    if (g->picture == NULL) {
        return false;
    }
    g->drawn = system_scratch();
    g->said = system_scratch();
    if (g->drawn == NULL || g->said == NULL) {
        perror("whirl: error: a temporary file");
        return give_up(g);
    }
    /* gnuplot draws to standard output, because a file name could begin with | or ~ */
    g->to = system_write_to("LC_ALL=C.UTF-8 gnuplot", g->drawn, g->said);
    if (g->to == NULL) {
        perror("whirl: error: gnuplot");
        return give_up(g);
    }
    set_look(g, height);
    return true;
}

/* Writes an XML element. Control characters, which XML forbids, become blanks. */
static void put_element(FILE *to, const char *name, const char *text) {
    fprintf(to, "<%s>", name);
    for (const char *at = text; *at != '\0'; at++) {
        const unsigned char code = (unsigned char)*at;
        switch (*at) {
        case '&': fputs("&amp;", to); break;
        case '<': fputs("&lt;", to); break;
        case '>': fputs("&gt;", to); break;
        default: fputc(code < 0x20 || code == 0x7f ? ' ' : code, to); break;
        }
    }
    fprintf(to, "</%s>\n", name);
}

/* Makes an SVG dark on a dark page. The selectors are spelled as gnuplot writes colours. */
static const char dark[] =
    "<style>@media (prefers-color-scheme:dark){#gnuplot_canvas>rect{fill:" PALETTE_DARK "}"
    "text{fill:#e6edf3}[color=\"black\"]{color:#e6edf3}"
    "[stroke='rgb(216, 216, 216)'],[stroke=\"rgb(216, 216, 216)\"]{stroke:#30363d}"
    "[fill='rgb(228, 228, 228)'],[fill = 'rgb(228, 228, 228)']{fill:#262c36}}</style>\n";

/* In an SVG, g->title and g->text replace gnuplot's title and alternative text. */
static void copy_picture(const gnuplot *g) {
    char line[4096];
    size_t length;
    rewind(g->drawn);
    bool head = strcmp(ending_of(g->file), "svg") == 0;
    while (head && fgets(line, sizeof line, g->drawn) != NULL) {
        if (strncmp(line, "<title>", 7) == 0) {
            put_element(g->picture, "title", g->title);
        } else if (strncmp(line, "<desc>", 6) == 0) {
            put_element(g->picture, "desc", g->text);
            fputs(dark, g->picture);
            head = false;
        } else {
            const bool begins = strncmp(line, "<svg", 4) == 0;
            fprintf(g->picture, "%s%s", begins ? "<svg role=\"img\"" : "", line + (begins ? 4 : 0));
        }
    }
    while ((length = fread(line, 1, sizeof line, g->drawn)) > 0) {
        fwrite(line, 1, length, g->picture);
    }
}

/* Does the picture end as its format requires? gnuplot does not report a full disk. */
static bool is_whole(const gnuplot *g) {
    char last[17] = {0};
    const bool there = fseek(g->drawn, -16, SEEK_END) == 0 && fread(last, 1, 16, g->drawn) == 16;
    const char *ending = ending_of(g->file);
    const char *end = strcmp(ending, "svg") == 0   ? "</svg>"
                      : strcmp(ending, "pdf") == 0 ? "%%EOF"
                                                   : "IEND";
    for (size_t i = 0; there && i + strlen(end) <= 16; i++) {
        if (memcmp(last + i, end, strlen(end)) == 0) {
            return true;
        }
    }
    return false;
}

bool gnuplot_close(gnuplot *g) {
    const bool written = ferror(g->to) == 0;
    const int code = system_end(g->to);
    const bool whole = is_whole(g);
    const bool drawn = written && code == 0 && whole;
    copy_picture(g);
    const bool kept = atomic_file_close(g->picture, g->file, drawn);
    if (!drawn) {
        atomic_file_not_whole();
        show_said(g->said);
        fprintf(stderr, "whirl: error: gnuplot could not draw %s\n%s", g->file,
                code == 0 && !whole ? "hint: check the free space on the disk\n" : "");
    }
    fclose(g->drawn);
    fclose(g->said);
    return drawn && kept;
}
