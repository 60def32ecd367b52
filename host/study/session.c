/* session.c: runs a sweep's points and writes their rows and messages. */
#include "host/study/session.h"
#include "host/os/system.h"

#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/method.h"
#include "core/version.h"
#include "host/base/alloc.h"
#include "host/base/exit.h"
#include "host/base/hashing.h"
#include "host/check/energy_residual.h"
#include "host/check/finding.h"
#include "host/check/run_json.h"
#include "host/image/image.h"
#include "host/lang/units.h"
#include "host/lang/value.h"
#include "host/number/decimal.h"
#include "host/os/atomic_file.h"
#include "host/os/jobs.h"

/* === a CSV file that is continued ============================================================= */

static int refuse(const char *path, const char *why) {
    fprintf(
        stderr,
        "%s: error: %s\nhint: use another --csv to keep this file, or --fresh to overwrite it\n",
        path, why);
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
    size_t size = 0;
    if (getdelim(&text, &size, '\0', in) < 0) { /* the file is empty */
        free(text);
        text = alloc_words("%s", "");
    }
    fclose(in);
    return text;
}

#define NOTED "noted: "

static int line_length(const char *text) { return (int)strcspn(text, "\n"); }

static int check_fingerprint(resumable_csv *sh, const resumable_csv_settings *s) {
    char *there = read_text(sh->beside);
    if (there == NULL) {
        char *why = alloc_words("the file is not from a sweep: %s is missing", sh->beside);
        const int code = refuse(s->path, why);
        free(why);
        return code;
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
        code = refuse(s->path, "the file contains another sweep");
        fprintf(stderr, "  there: %.*s\n  here:  %.*s\n", line_length(old), old, line_length(new),
                new);
    }
    free(there);
    return code;
}

/* --- the rows of the file ----------------------------------------------------------------------*/

/* Is `line` a valid row with number `row`? *failed: its measures are empty. */
static bool is_row(const resumable_csv_settings *s, const char *line, size_t length, uint64_t row,
                   bool *failed) {
    char *swept = NULL;
    size_t start = 0;
    FILE *out = alloc_text(&swept, &start);
    s->swept(s->context, row, out);
    fputc(',', out);
    alloc_text_end(out);
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

/* Checks the rows. *whole: the file's length up to the end of the last complete row. */
static int check_rows(resumable_csv *sh, const resumable_csv_settings *s, off_t *whole) {
    char *line = NULL;
    size_t size = 0;
    int code = EXIT_DONE;
    bool in_header = s->header[0] != '\0';
    *whole = 0;
    for (;;) {
        const ssize_t length = getline(&line, &size, sh->out);
        if (length < 2 || strcmp(line + length - 2, "\r\n") != 0) {
            break;
        }
        bool failed = false;
        if (in_header && strcmp(line, s->header) != 0) {
            code = refuse(s->path, "the header is that of another sweep");
            break;
        }
        if (!in_header && !is_row(s, line, (size_t)length, sh->rows, &failed)) {
            char why[100];
            snprintf(why, sizeof why, "row %llu is not from this sweep",
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
    /* old rows must not stand beside the new fingerprint, even if the program is killed */
    if (whole == 0 && ftruncate(fileno(sh->out), 0) != 0) {
        return cannot_write(s->path);
    }
    if (!atomic_file_print(sh->beside, "%s%s", s->fingerprint, sh->notes)) {
        return EXIT_BAD_INPUT;
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
        if (sh->out != NULL && fputs(s->header, sh->out) >= 0) {
            return EXIT_DONE;
        }
        forget(sh);
        write_error_say(s->path);
        return sh->out != NULL ? EXIT_RUN_FAILED : EXIT_BAD_INPUT;
    }
    sh->is_file = true;
    const int file = open(s->path, O_RDWR | O_CREAT, 0666);
    sh->out = file < 0 ? NULL : fdopen(file, "r+b");
    if (sh->out == NULL) {
        forget(sh);
        write_error_say(s->path);
        return EXIT_BAD_INPUT;
    }
    int code = EXIT_DONE;
    if (!system_lock(sh->out)) {
        fprintf(stderr, "%s: error: another sweep is writing this file\n", s->path);
        code = EXIT_BAD_INPUT;
    } else if (fstat(file, &about) != 0) {
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

static bool has_note(const resumable_csv *sh, const char *word) {
    char *line = alloc_words(NOTED "%s\n", word);
    const bool has = strstr(sh->notes, line) != NULL;
    free(line);
    return has;
}

/* Adds the line "noted: WORD" to FILE.sweep, once. Returns false if it was not written (reported). */
static bool add_note(resumable_csv *sh, const char *word) {
    if (has_note(sh, word)) {
        return true;
    }
    char *notes = alloc_words("%s" NOTED "%s\n", sh->notes, word);
    free(sh->notes);
    sh->notes = notes;
    FILE *out = sh->beside != NULL ? fopen(sh->beside, "ab") : NULL;
    const bool good = sh->beside == NULL || (out != NULL && fprintf(out, NOTED "%s\n", word) > 0);
    const bool closed = out == NULL || fclose(out) == 0;
    if (!good || !closed) {
        write_error_say(sh->beside);
    }
    return good && closed;
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

/* === columns and points as JSON =============================================================== */

/* Writes a column's name and unit: the declared unit of `of`, or else the SI unit `si`. */
static void put_column(json *j, const char *name, const symbol *of, int primes, const char *si) {
    char *unit = of != NULL ? shown_unit_name(of, primes) : alloc_words("%s", si);
    json_open(j, NULL, '{');
    json_text(j, "name", name);
    json_text(j, "unit", unit);
    json_close(j, '}');
    free(unit);
}

char *sweep_axis_unit(const axis *a) {
    return a->symbol == NULL                 ? alloc_words("s")
           : unit_is_si(a->symbol->declared) ? shown_unit_name(a->symbol, a->primes)
                                             : shown_si_name(a->symbol, a->primes);
}

void sweep_json_axes(json *j, const grid *g) {
    for (int i = 0; i < g->count; i++) {
        const axis *a = &g->axes[i];
        char *unit = sweep_axis_unit(a);
        put_column(j, a->column, NULL, 0, unit);
        free(unit);
    }
}

static void json_sweep_begin(json *j, const sweep *s) {
    char unit[DIM_TEXT_SIZE];
    const bool is_scene = s->scene != NULL;
    json_begin(j, "sweep", is_scene ? s->scene->name : s->mechanism->name,
               is_scene ? s->scene->title : s->mechanism->title, s->kind, s->engine.method);
    json_open(j, "columns", '[');
    for (int i = 0; i < s->grid->count; i++) {
        const axis *a = &s->grid->axes[i];
        put_column(j, a->column, a->symbol, a->primes, "s");
    }
    for (int i = 0; i < s->measures->count; i++) {
        const measure *m = &s->measures->list[i];
        put_column(j, m->name, measure_symbol(m), m->of->primes,
                   m->kind == MEASURE_PERIOD ? "s" : dim_symbols(m->of->dim, unit, sizeof unit));
    }
    if (!s->mechanism->is_system) {
        put_column(j, ENERGY_RESIDUAL_COLUMN, NULL, 0, "1");
    }
    if (grid_step_axis(s->grid) >= 0) {
        put_column(j, "end_s", NULL, 0, "s");
    }
    json_close(j, ']');
    json_open(j, "rows", '[');
}

/* `row`: as in the CSV file. `error`: why the point failed, or NULL. */
static void put_point(json *j, const char *row, const char *error, const point_notes *notes) {
    json_open(j, NULL, '{');
    json_open(j, "values", '[');
    for (const char *at = row;; at++) {
        const char *end;
        const double value = decimal_read(at, &end);
        json_number(j, NULL, end == at ? (double)NAN : value);
        at += strcspn(at, ",\r");
        if (*at != ',') {
            break;
        }
    }
    json_close(j, ']');
    json_open(j, "findings", '[');
    for (int id = 0; id < FINDINGS; id++) {
        if ((notes->found & FINDING_BIT(id)) != 0) {
            json_open(j, NULL, '{');
            json_text(j, "id", finding_rows[id].word);
            json_text(j, "severity", (notes->warned & FINDING_BIT(id)) != 0 ? "warning" : "note");
            json_close(j, '}');
        }
    }
    json_close(j, ']');
    json_unlooked(j, notes->unlooked);
    if (error != NULL) {
        json_text(j, "error", error);
    } else {
        json_null(j, "error");
    }
    json_close(j, '}');
}

/* === the settings of a sweep ================================================================== */

static void put_instance(FILE *out, const instance *base) {
    const mechanism *m = base->mechanism;
    for (int i = 0; i < m->effect_count; i++) {
        fprintf(out, "effect %s: %s\n", m->effects[i].name, base->with[i] ? "with" : "without");
    }
    for (int i = 0; i < m->parameter_count; i++) {
        fprintf(out, "set %s: %.17g\n", m->parameters[i]->name, base->parameter[i]);
    }
    for (int i = 0; i < m->input_count; i++) {
        fprintf(out, "set %s: %.17g\n", m->inputs[i]->name, base->input[i]);
    }
    for (int i = 0; i < m->coordinate_count; i++) {
        for (int k = 0; k < base->start_count[i]; k++) {
            fprintf(out, "start %s (%d primes): %.17g\n", m->coordinates[i]->name, k,
                    base->start[i][k]);
        }
    }
}

char *fingerprint_make(const sweep *s, const char *model_text, const instance *base,
                       const image *im, shard part) {
    char *text = NULL;
    FILE *out = alloc_text(&text, NULL);
    fprintf(out, "whirl " WH_VERSION " sweep: settings of the CSV beside this file, format 4\n");
    fprintf(out, "scene: %s\n", base->name);
    fprintf(out, "model text: 0x%08" PRIx32 "\n", hash_text(model_text, strlen(model_text)));
    fprintf(out, "number: %s%s\n", s->kind->name, s->engine.compensated ? ", compensated" : "");
    if (s->engine.stabilized) {
        fprintf(out, "stabilized\n");
    }
    fprintf(out, "method: %s\n", wh_methods[s->engine.method].word);
    fprintf(out, "angles: %s\n", image_angles_words[s->engine.angles]);
    if (s->engine.matrix != MATRIX_NONE) {
        fprintf(out, "matrix: %s\n", image_matrix_words[s->engine.matrix]);
    }
    if (s->engine.tables != TABLES_NONE) {
        fprintf(out, "tables: %s, %d cells\n", image_tables_words[s->engine.tables],
                1 << im->list[IMAGE_STEP]->tables.bits);
    }
    fprintf(out, "step: %.17g s\nuntil: %.17g s\n", base->step_s, base->until_s);
    fprintf(out, "measured from: %.17g s\n", s->from_s);
    put_instance(out, base);
    for (int i = 0; i < s->grid->count; i++) {
        const axis *a = &s->grid->axes[i];
        char *unit = sweep_unit(a->symbol, a->primes);
        char end[2][NUMBER_SIZE];
        fprintf(out, "over %s%s: %s to %s, %" PRIu64 " values%s\n", a->name, unit,
                sweep_swept_value(a, a->from, end[0]), sweep_swept_value(a, a->to, end[1]),
                a->count, a->is_log ? ", logarithmic" : "");
        free(unit);
    }
    for (int i = 0; i < s->measures->count; i++) {
        const measure *m = &s->measures->list[i];
        char *unit = sweep_unit(measure_symbol(m), m->of->primes);
        fprintf(out, "measure: %s%s\n", m->name, unit);
        free(unit);
    }
    fprintf(out, "shard: %" PRIu64 "/%" PRIu64 "\n", part.number, part.of);
    fprintf(out, "operations: 0x%016" PRIx64 "\n", im->hash);
    alloc_text_end(out);
    return text;
}

/* === the session ============================================================================== */

#define SHOW_EVERY_S 0.2 /* least time between two progress lines */

void sweep_progress(FILE *out, uint64_t from, uint64_t done, uint64_t end, double elapsed_s) {
    const double part = end > 0 ? (double)done / (double)end : 1.0;
    const double rate = (double)(done - from) / elapsed_s;
    fprintf(out, "\r%5.1f %% %llu/%llu", 100.0 * part, (unsigned long long)done,
            (unsigned long long)end);
    if (rate > 0.0) {
        const double left_s = (double)(end - done) / rate;
        fprintf(out, "  %.3g points/s  %.0f:%02.0f:%02.0f to go  ", rate,
                (double)(long)(left_s / 3600.0), (double)((long)(left_s / 60.0) % 60),
                (double)((long)left_s % 60));
    }
}

/* State of the parent process during a sweep. */
typedef struct sitting {
    const sweep *sweep;
    resumable_csv sheet;
    json *json;     /* or NULL */
    bool shows;     /* progress on standard error */
    double start_s; /* of this session */
    double shown_s; /* of the last drawn progress line; 0: no line is drawn */
    uint64_t first; /* index of the point in row 0 of `sheet` */
    uint64_t rows;  /* of the whole sheet */
    uint64_t failed;
    int described;                  /* number of failures that were described */
    uint64_t ran;                   /* number of points that ran in this session */
    uint64_t found[FINDINGS];       /* number of points with each finding */
    uint64_t found_first[FINDINGS]; /* the first point with each finding */
    uint64_t unlooked_points;       /* points that were not checked for some finding */
    unsigned unlooked;              /* bits: findings that were not checked */
    unsigned warned;
    unsigned fails; /* bits: findings after which the exit status is 1 */
} sitting;

enum { DESCRIBED_MAX = 20 };

/* Runs a point in a worker process. `reason` gets the error if the point fails, or else the bits of its notes. */
static bool work(void *context, uint64_t point, FILE *row, FILE *reason) {
    const sitting *s = context;
    point_notes notes;
    const bool good = sweep_point(s->sweep, point, row, reason, &notes);
    if (good && (notes.found | notes.fails | notes.unlooked) != 0) {
        fprintf(reason, "%u %u %u %u", notes.found, notes.warned, notes.fails, notes.unlooked);
    }
    return good;
}

static point_notes notes_of(const char *text) {
    unsigned bits[4];
    char *rest = (char *)text;
    for (int i = 0; i < 4; i++) {
        bits[i] = (unsigned)strtoul(rest, &rest, 10);
    }
    return (point_notes){
        .found = bits[0], .warned = bits[1], .fails = bits[2], .unlooked = bits[3]};
}

static bool count_notes(sitting *s, uint64_t point, const point_notes *notes) {
    bool good = true;
    s->warned |= notes->warned;
    s->fails |= notes->fails;
    s->unlooked |= notes->unlooked;
    s->unlooked_points += notes->unlooked != 0 ? 1U : 0U;
    for (int id = 0; id < FINDINGS; id++) {
        if ((notes->found & FINDING_BIT(id)) != 0) {
            s->found_first[id] = s->found[id] == 0 ? point : s->found_first[id];
            s->found[id]++;
        }
        if (((notes->warned | notes->fails) & FINDING_BIT(id)) != 0) {
            good = add_note(&s->sheet, finding_rows[id].word) && good;
        }
    }
    return good;
}

/* Prints a point: "point 17 (r=0.02, theta'=31.4)". */
static void name_point(const sweep *s, uint64_t point) {
    double *value = alloc(s->grid->count, sizeof *value);
    char text[NUMBER_SIZE];
    grid_values(s->grid, point, value);
    fprintf(stderr, "point %llu (", (unsigned long long)point + 1);
    for (int i = 0; i < s->grid->count; i++) {
        const axis *a = &s->grid->axes[i];
        char *unit = sweep_unit(a->symbol, a->primes);
        fprintf(stderr, "%s%s=%s%s", i > 0 ? ", " : "", a->name,
                sweep_swept_value(a, value[i], text), unit);
        free(unit);
    }
    fprintf(stderr, ")");
    free(value);
}

static void clear_progress(sitting *s) {
    if (s->shown_s > 0.0) {
        fprintf(stderr, "\r%70s\r", "");
        s->shown_s = 0.0;
    }
}

static bool deliver(void *context, uint64_t point, bool good, const char *row, const char *reason) {
    sitting *s = context;
    const point_notes notes = notes_of(good ? reason : "");
    s->ran++;
    if (!good) {
        s->failed++;
        if (s->described < DESCRIBED_MAX) {
            clear_progress(s);
            fputs("whirl sweep: error: ", stderr);
            name_point(s->sweep, point);
            fprintf(stderr, ": %s\n", reason);
        } else if (s->described == DESCRIBED_MAX) {
            fprintf(stderr, "further failures are not listed; their measures stay empty\n");
        }
        s->described += s->described <= DESCRIBED_MAX ? 1 : 0;
    } else if (!count_notes(s, point, &notes)) {
        return false;
    }
    if (s->json != NULL) {
        put_point(s->json, row, good ? NULL : reason, &notes);
    }
    return fputs(row, s->sheet.out) >= 0;
}

static bool pause_between(void *context, uint64_t next) {
    sitting *s = context;
    const double now_s = system_now_s();
    if (s->shows && now_s - s->shown_s >= SHOW_EVERY_S) {
        sweep_progress(stderr, s->sheet.rows, next - s->first, s->rows, now_s - s->start_s);
        s->shown_s = now_s;
    }
    return fflush(s->sheet.out) == 0;
}

static void swept(const void *context, uint64_t row, FILE *out) {
    const sitting *s = context;
    sweep_swept_fields(s->sweep, s->first + row, out);
}

/* Prints the findings of the points of this session. The file does not say which earlier points have findings. */
static void say_found(const sitting *s) {
    for (int id = 0; id < FINDINGS; id++) {
        if (s->found[id] > 0) {
            const finding_row *row = &finding_rows[id];
            fprintf(stderr, "whirl sweep: %s: %llu of %llu points %s [%s]; first: ",
                    (s->warned & FINDING_BIT(id)) == 0 ? "note" : "warning",
                    (unsigned long long)s->found[id], (unsigned long long)s->ran, row->points,
                    row->word);
            name_point(s->sweep, s->found_first[id]);
            fputs("\nhint: run the point with `whirl run`: it prints a remedy\n", stderr);
        }
    }
    if (s->unlooked != 0) {
        fprintf(stderr, "whirl sweep: note: %llu of %llu points were not checked for ",
                (unsigned long long)s->unlooked_points, (unsigned long long)s->ran);
        finding_say_names(stderr, s->unlooked);
        fputs(": each check takes more than a second\n", stderr);
    }
}

static void say_end(const session_settings *o, const sitting *s, int workers) {
    const uint64_t rows = s->rows;
    const double seconds = system_now_s() - s->start_s;
    const uint64_t done = rows - s->sheet.rows;
    if (s->failed > 0) {
        fprintf(stderr,
                "whirl sweep: error: %llu of %llu points failed: their measures are empty\n",
                (unsigned long long)s->failed, (unsigned long long)rows);
    }
    if (o->quiet) {
        return;
    }
    fprintf(stderr, "%llu points", (unsigned long long)rows);
    if (s->sheet.rows > 0) {
        fprintf(stderr, ", %llu of them found in %s", (unsigned long long)s->sheet.rows, o->csv);
    }
    if (done > 0) {
        fprintf(stderr, "; %.3g s, %.3g points/s with --jobs %d", seconds, (double)done / seconds,
                workers);
    }
    fputc('\n', stderr);
}

static int run_points(const session_settings *o, sitting *s) {
    const uint64_t next = s->first + s->sheet.rows;
    const uint64_t missing = o->end - next;
    const int workers = missing < (uint64_t)o->jobs ? (int)missing : o->jobs;
    s->failed = s->sheet.failed;
    /* the file's earlier rows count, too: a continued sweep has the exit status of an uninterrupted one */
    for (int id = 0; id < FINDINGS && s->sweep->strict >= 0.0; id++) {
        s->fails |= has_note(&s->sheet, finding_rows[id].word) ? FINDING_BIT(id) : 0U;
    }
    s->shows = !o->quiet && isatty(STDERR_FILENO);
    s->start_s = system_now_s();
    const jobs plan = {.workers = workers,
                       .first = next,
                       .end = o->end,
                       .context = s,
                       .work = work,
                       .deliver = deliver,
                       .pause = pause_between};
    const jobs_result result = missing > 0 ? jobs_run(&plan) : JOBS_DONE;
    clear_progress(s);
    if (!resumable_csv_close(&s->sheet)) {
        return EXIT_RUN_FAILED;
    }
    say_found(s);
    const char *hint = s->sheet.is_file ? "hint: repeat the command to continue from there\n" : "";
    switch (result) {
    case JOBS_DONE: say_end(o, s, workers); break;
    case JOBS_STOPPED:
        fprintf(stderr, "whirl sweep: interrupted after %llu of %llu points%s\n%s",
                (unsigned long long)(s->sheet.rows + s->ran), (unsigned long long)s->rows,
                s->sheet.is_file ? "; their rows are kept" : "", hint);
        return EXIT_INTERRUPTED;
    case JOBS_WORKER_LOST:
        fprintf(stderr, "whirl sweep: error: a worker process ended early\n%s", hint);
        return EXIT_RUN_FAILED;
    case JOBS_REFUSED: return EXIT_RUN_FAILED;
    }
    if (s->fails != 0) {
        finding_say_status(stderr, "sweep", s->fails);
    }
    return s->failed > 0 || s->fails != 0 ? EXIT_RUN_FAILED : EXIT_DONE;
}

int session_run(const sweep *s, const session_settings *o) {
    sitting here = {.sweep = s, .first = o->first, .rows = o->end - o->first};
    char *header = NULL;
    FILE *out = alloc_text(&header, NULL);
    if (o->header) {
        sweep_header(s, out);
    }
    alloc_text_end(out);
    const resumable_csv_settings settings = {.path = o->csv,
                                             .fingerprint = o->fingerprint,
                                             .header = header,
                                             .rows = here.rows,
                                             .measures = sweep_columns(s),
                                             .swept = swept,
                                             .context = &here,
                                             .fresh = o->fresh};
    int code = resumable_csv_open(&here.sheet, &settings);
    json written = {.out = stdout};
    const bool writes = code == EXIT_DONE && o->json;
    if (writes) {
        here.json = &written;
        json_sweep_begin(&written, s);
    }
    if (code == EXIT_DONE) {
        code = run_points(o, &here);
    }
    if (writes) {
        json_close(&written, ']');
        json_count(&written, "failed", here.failed);
        json_whole(&written, "exit", code);
        json_close(&written, '}');
    }
    free(header);
    return code;
}
