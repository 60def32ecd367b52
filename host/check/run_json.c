#include "run_json.h"

#include <stdlib.h>
#include <string.h>

#include "core/version.h"
#include "findings.h"
#include "host/base/alloc.h"
#include "host/check/horizon.h"

void json_begin(json *j, const char *command, const char *scene, const char *title,
                const engine_kind *kind, wh_method method) {
    json_open(j, NULL, '{');
    json_whole(j, "schema", 1);
    json_text(j, "command", command);
    json_text(j, "version", WH_VERSION);
    json_text(j, "scene", scene);
    json_text(j, "title", title);
    if (kind != NULL) {
        json_text(j, "number", kind->name);
        json_text(j, "method", wh_methods[method].word);
    }
}

void json_unlooked(json *j, unsigned ids) {
    json_open(j, "not_looked_at", '[');
    for (int id = 0; id < FINDINGS; id++) {
        if ((ids & FINDING_BIT(id)) != 0) {
            json_text(j, NULL, finding_rows[id].word);
        }
    }
    json_close(j, ']');
}

void json_time(json *j, const char *key, double time_s) {
    if (time_s >= 0.0) {
        json_number(j, key, time_s);
    } else {
        json_null(j, key);
    }
}

static void put_head(json *j, const char *command, const image *im, const engine_kind *kind,
                     const void *run) {
    json_begin(j, command, im->name, im->title, kind, im->settings.method);
    json_number(j, "step_s", im->step_s);
    json_count(j, "steps", kind->steps(run));
    json_number(j, "end_s", ratio_times(kind->steps(run), im->step));
}

static void put_values(json *j, const records *r) {
    json_open(j, "values", '[');
    for (int i = 1; i < r->columns; i++) {
        char *name = records_name(&r->column[i]);
        json_open(j, NULL, '{');
        json_text(j, "name", name);
        json_number(j, "value", r->row[i]);
        json_text(j, "unit", r->column[i].unit->shown);
        json_close(j, '}');
        free(name);
    }
    json_close(j, ']');
}

static void put_findings(json *j, const run_checks *v) {
    json_open(j, "findings", '[');
    for (int id = 0; id < FINDINGS; id++) {
        const finding *f = &v->found[id];
        if (!f->reported) {
            continue;
        }
        char where[FINDINGS_NAME];
        char *message = NULL;
        size_t length;
        FILE *text = alloc_text(&message, &length);
        findings_message(text, v, (finding_id)id);
        alloc_text_end(text);
        json_open(j, NULL, '{');
        json_text(j, "id", finding_rows[id].word);
        json_text(j, "severity", (v->warned & FINDING_BIT(id)) != 0 ? "warning" : "note");
        if (findings_where(v, (finding_id)id, where)) {
            json_text(j, "where", where);
        } else {
            json_null(j, "where");
        }
        json_time(j, "from_s", f->at_s);
        json_number(j, "value", f->value);
        json_number(j, "limit", findings_limit(v, (finding_id)id));
        json_text(j, "limit_unit", finding_rows[id].unit);
        json_text(j, "message", message);
        json_close(j, '}');
        free(message);
    }
    json_close(j, ']');
}

/* Writes the lines that begin with "hint: ", without this word. */
static void put_hints(json *j, const char *said) {
    static const char begin[] = "hint: ";
    const size_t skip = sizeof begin - 1;
    json_open(j, "hints", '[');
    for (const char *at = said; *at != '\0'; at += strcspn(at, "\n"), at += *at == '\n' ? 1 : 0) {
        if (strncmp(at, begin, skip) == 0) {
            char *hint = alloc_copy(at + skip, strcspn(at, "\n") - skip);
            json_text(j, NULL, hint);
            free(hint);
        }
    }
    json_close(j, ']');
}

/* Writes the reason of a failure: the text after "error: ". */
static void put_error(json *j, const char *said) {
    const char *at = said != NULL ? strstr(said, "error: ") : NULL;
    if (at == NULL) {
        json_null(j, "error");
        return;
    }
    at += strlen("error: ");
    char *reason = alloc_copy(at, strcspn(at, "\n"));
    json_text(j, "error", reason);
    free(reason);
}

void run_json(FILE *out, const run_json_request *w) {
    const run_checks *v = w->checks;
    const image *im = v->image;
    json j = {.out = out};
    put_head(&j, "run", im, v->kind, v->run);
    json_time(&j, "trusted_until_s", w->until_s);
    put_values(&j, w->records);
    if (v->balance.known) {
        json_number(&j, ENERGY_RESIDUAL_COLUMN, v->balance.ratio);
    } else {
        json_null(&j, ENERGY_RESIDUAL_COLUMN);
    }
    put_error(&j, w->failed ? w->said : NULL);
    put_findings(&j, v);
    json_unlooked(&j, run_checks_unlooked(v));
    put_hints(&j, w->said != NULL ? w->said : "");
    json_open(&j, "files", '[');
    for (int i = 0; i < RUN_JSON_FILES; i++) {
        if (w->file[i] != NULL) {
            json_text(&j, NULL, w->file[i]);
        }
    }
    json_close(&j, ']');
    json_whole(&j, "exit", w->status);
    json_close(&j, '}');
}

void horizon_json(FILE *out, const horizon *h, int status) {
    const records *shape = h->of->shape;
    json j = {.out = out};
    put_head(&j, "trust", shape->image, shape->kind, h->of->run);
    json_number(&j, "tolerance", h->tolerance);
    json_time(&j, "trusted_until_s", horizon_trusted_s(h));
    json_open(&j, "columns", '[');
    for (int k = 1; k < h->of->columns; k++) {
        const horizon_column *c = &h->column[k];
        const record_column *r = &shape->column[k];
        char name[RECORDS_SHOWN_NAME];
        json_open(&j, NULL, '{');
        json_text(&j, "name", records_shown_name(r, name));
        json_text(&j, "unit", r->unit->shown);
        json_text(&j, "verdict", horizon_words[c->verdict]);
        json_number(&j, "until_s", c->until_s);
        json_number(&j, "range", c->range);
        json_number(&j, "off", c->off);
        json_close(&j, '}');
    }
    json_close(&j, ']');
    json_unlooked(&j, h->of->unaliased ? FINDING_BIT(FINDING_ALIASED) : 0U);
    json_whole(&j, "exit", status);
    json_close(&j, '}');
}
