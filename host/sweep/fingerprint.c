/* fingerprint.c: a sweep's settings in words. */
#include "fingerprint.h"

#include <inttypes.h>
#include <stdlib.h>

#include "core/hash.h"
#include "host/base/room.h"
#include "host/image/turned.h"

static uint64_t hash_text(const char *text) {
    uint64_t hash = WH_HASH_START;
    for (; *text != '\0'; text++) {
        hash = wh_hash_u64(hash, (unsigned char)*text);
    }
    return hash;
}

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
    size_t length = 0;
    FILE *out = room_text(&text, &length);
    fprintf(out, "whirl sweep: settings of the CSV beside this file, format 3\n");
    fprintf(out, "scene: %s\n", base->name);
    fprintf(out, "model text: 0x%016" PRIx64 "\n", hash_text(model_text));
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
        fprintf(out, "over %s%s: %.17g to %.17g, %" PRIu64 " values%s\n", a->name, unit, a->from,
                a->to, a->count, a->is_log ? ", logarithmic" : "");
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
    room_text_end(out);
    return text;
}
