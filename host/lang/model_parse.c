/* model_parse.c: a text from its first to its last byte. */
#include "model.h"

#include <string.h>

#include "statements.h"

static void parse_all(parser *in, place start) {
    read_file(in);
    if (in->builder_count == 0 && in->pending_count == 0 && diags_count(in->diags) == 0) {
        diag_error(in->diags, start, FILE_FORM, "no mechanism here");
    }
    for (int i = 0; i < in->builder_count; i++) {
        finish_mechanism(in, in->builders[i]);
    }
    for (int i = 0; i < in->pending_count && diags_count(in->diags) <= DIAG_MAX; i++) {
        read_noted_scene(in, &in->pending[i]);
    }
}

whirl_model *model_parse(const char *file, const char *text, size_t length, diags *all) {
    struct arena *memory = arena_new();
    source *whole = arena_alloc(memory, sizeof *whole);
    whole->file = arena_copy(memory, file, strlen(file));
    const bool too_long = length > MODEL_BYTES_MAX;
    whole->length = too_long ? 0 : length;
    whole->text = arena_copy(memory, text, whole->length);
    parser in = {.diags = all, .arena = memory, .effect = -1};
    const size_t before = diags_calls(all);
    in.lexer = lexer_start(whole, all);
    if (too_long) {
        diag_error(all, in.lexer.at, NULL, "the text is longer than %zu bytes", MODEL_BYTES_MAX);
    } else {
        parse_all(&in, in.lexer.at);
    }
    if (diags_calls(all) != before || diags_count(all) > DIAG_MAX) {
        arena_free(memory);
        return NULL;
    }
    whirl_model *made = arena_alloc(memory, sizeof *made);
    const mechanism **mechanisms =
        arena_alloc(memory, (size_t)in.builder_count * sizeof *mechanisms);
    for (int i = 0; i < in.builder_count; i++) {
        mechanisms[i] = in.builders[i]->made;
    }
    made->mechanisms = mechanisms;
    made->mechanism_count = in.builder_count;
    made->scenes = in.scenes;
    made->scene_count = in.scene_count;
    made->arena = memory;
    return made;
}

void model_free(whirl_model *done) {
    if (done != NULL) {
        arena_free(done->arena);
    }
}
