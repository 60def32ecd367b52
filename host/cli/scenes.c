/* scenes.c: the C code and state hashes of all built-in scenes, or of the scenes of some files, for Whirl's build. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/emit/emit.h"
#include "host/engine/engine.h"
#include "host/engine/loop.h"
#include "host/lang/builtin.h"
#include "host/os/atomic_file.h"
#include "host/show/show.h"

/* Called for each scene. Returns an exit status. */
typedef int scene_visitor(void *context, const char *file, const loaded *made);

/* Visits every scene of an opened source, even if one before it is refused. Returns the highest exit status. */
static int each_scene_of(source_model *from, scene_visitor *visit, void *context) {
    static const load_request request = {
        .settings = IMAGE_SETTINGS_DEFAULT, .use = IMAGE_TO_WRITE, .conserve = true};
    int code = EXIT_DONE;
    for (int k = 0; k < from->model->scene_count; k++) {
        const scene *in = from->model->scenes[k];
        loaded made;
        int one = load(&made, from, in->mechanism, in, NULL, &request);
        one = one == EXIT_DONE ? visit(context, from->file, &made) : one;
        unload(&made);
        code = one > code ? one : code;
    }
    return code;
}

/* Visits the scenes of the files, or, without files, the built-in ones. Returns an exit status. */
static int each_scene(int files, char **file, scene_visitor *visit, void *context) {
    int code = EXIT_DONE;
    for (int i = 0; i < files && code == EXIT_DONE; i++) {
        source_model from;
        code = source_open(&from, file[i]);
        code = code == EXIT_DONE ? each_scene_of(&from, visit, context) : code;
        source_close(&from);
    }
    for (size_t i = 0; files == 0 && i < builtin_model_count && code == EXIT_DONE; i++) {
        source_model from;
        code = source_builtin(&from, &builtin_models[i]) ? each_scene_of(&from, visit, context)
                                                         : EXIT_BAD_INPUT;
        source_close(&from);
    }
    return code;
}

/* Opens FOLDER/NAME + ending for writing. Returns NULL after an error (reported). */
static FILE *scenes_open(const char *folder, const char *name, const char *ending) {
    char *path = alloc_words("%s/%s%s", folder, name, ending);
    FILE *out = atomic_file_open_in_place(path);
    free(path);
    return out;
}

typedef struct emission {
    const char *folder;
    FILE *declarations;
    FILE *index;
    bool all_forms; /* also write text, LaTeX, Octave and the runs' hashes */
} emission;

/* Writes the line of a run, "WHAT NAME steps N hash 0x... ok", with the hash of the last state. */
static void scenes_write_hash(FILE *out, const char *what, const engine_kind *kind,
                              const image *im) {
    void *run = kind->start(im);
    const wh_status status = loop_steps(kind, run, im->steps);
    fprintf(out, "%s %s steps %" PRIu64 " hash 0x%016" PRIx64 " %s\n", what, im->name,
            kind->steps(run), kind->hash(run), wh_status_text(status));
    kind->stop(run);
}

static int emit_scene(void *context, const char *file, const loaded *made) {
    static const char *const endings[] = {".c", ".h", ".txt", ".hash"};
    const emission *to = context;
    const image *im = made->image;
    for (int i = 0; i < (to->all_forms ? 4 : 2); i++) {
        FILE *out = scenes_open(to->folder, im->name, endings[i]);
        if (out == NULL) {
            return EXIT_RUN_FAILED;
        }
        if (i < 2) {
            (i == 0 ? emit_c : emit_c_header)(out, im, file);
        } else if (i == 2) {
            show_text(out, made->equations);
            show_latex(out, made->equations);
            if (im->recovered == 0) {
                char *contacts = contacts_in_octave(made->equations);
                emit_octave(out, im, file, contacts);
                free(contacts);
            }
        } else {
            scenes_write_hash(out, "scene", &engine_float, im);
            scenes_write_hash(out, "double", &engine_double, im);
        }
        (void)atomic_file_close(out, to->folder, true);
    }
    fprintf(to->declarations, "extern const wh_scene %s;\n", im->name);
    fprintf(to->index, "    &%s,\n", im->name);
    return EXIT_DONE;
}

int command_emit_scenes(int count, char **words) {
    if (count < 1) {
        fputs("usage: whirl emit-scenes FOLDER [FILE ...]\n", stderr);
        return EXIT_BAD_INPUT;
    }
    emission to = {.folder = words[0], .all_forms = count > 1};
    to.declarations = scenes_open(to.folder, "scenes", ".h");
    to.index = scenes_open(to.folder, "scenes", ".c");
    int code = to.declarations == NULL || to.index == NULL ? EXIT_RUN_FAILED : EXIT_DONE;
    if (code == EXIT_DONE) {
        fputs(
            "/* " EMIT_BANNER " from the built-in models: do not edit. */\n"
            "#ifndef GEN_SCENES_H\n#define GEN_SCENES_H\n\n#include \"core/scene.h\"\n\n"
            "#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n"
            "extern const wh_scene *const wh_scenes[];\nextern const unsigned wh_scene_count;\n\n",
            to.declarations);
        fputs("/* " EMIT_BANNER " from the built-in models: do not edit. */\n"
              "#include \"scenes.h\"\n\nconst wh_scene *const wh_scenes[] = {\n",
              to.index);
        code = each_scene(count - 1, words + 1, emit_scene, &to);
        fputs("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n", to.declarations);
        fputs("};\n\nconst unsigned wh_scene_count = sizeof wh_scenes / sizeof wh_scenes[0];\n",
              to.index);
    }
    (void)atomic_file_close(to.declarations, to.folder, true);
    (void)atomic_file_close(to.index, to.folder, true);
    return code;
}

static int hash_one(void *context, const char *file, const loaded *made) {
    (void)context;
    (void)file;
    scenes_write_hash(stdout, "scene", &engine_float, made->image);
    return EXIT_DONE;
}

int command_hashes(int count, char **words) {
    (void)words;
    if (count != 0) {
        fputs("usage: whirl hashes\n", stderr);
        return EXIT_BAD_INPUT;
    }
    return each_scene(0, NULL, hash_one, NULL);
}
