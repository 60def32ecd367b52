/* scenes.c: for the project's own build: every built-in scene, or every scene of some files, as C, and its state hash. */
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

/* Both are called for each scene: the first with its equations (NULL: no call), the second with its image. They return
 * an exit status. */
typedef int equations_visitor(void *context, const char *file, const loaded *made);
typedef int image_visitor(void *context, const char *file, const image *im);

typedef struct visit {
    equations_visitor *equations;
    image_visitor *image;
    void *context;
} visit;

/* Visits every scene of an opened source, also after a refused one, and frees its model. Returns an exit code. */
static int each_scene_of(source_model *from, const visit *v) {
    static const load_wish wish = {.settings = IMAGE_SETTINGS_DEFAULT,
                                   .use = IMAGE_TO_WRITE,
                                   .keep = KEEP_EQUATIONS,
                                   .conserve = true,
                                   .comment = EMIT_OCTAVE_COMMENT};
    const int count = from->model->scene_count;
    const char *file = from->file;
    image **made = alloc(count, sizeof(image *));
    int code = EXIT_DONE;
    for (int k = 0; k < count; k++) {
        const scene *in = from->model->scenes[k];
        loaded each;
        int one = load(&each, from, in->mechanism, in, NULL, &wish);
        if (one == EXIT_DONE && v->equations != NULL) {
            one = v->equations(v->context, file, &each);
        }
        if (one == EXIT_DONE) { /* made[] keeps the image */
            made[k] = each.image;
            each.image = NULL;
        }
        unload(&each);
        code = one > code ? one : code;
    }
    source_forget(from);
    for (int k = 0; k < count; k++) {
        const int one = made[k] != NULL ? v->image(v->context, file, made[k]) : EXIT_DONE;
        code = one > code ? one : code;
        image_free(made[k]);
    }
    free(made);
    return code;
}

/* The scenes of the files, or, without files, every built-in one. Returns an exit code. */
static int each_scene(int files, char **file, const visit *v) {
    int code = EXIT_DONE;
    for (int i = 0; i < files && code == EXIT_DONE; i++) {
        source_model from;
        code = source_open(&from, file[i]);
        code = code == EXIT_DONE ? each_scene_of(&from, v) : code;
        source_close(&from);
    }
    for (size_t i = 0; files == 0 && i < builtin_model_count && code == EXIT_DONE; i++) {
        const struct builtin_model *b = &builtin_models[i];
        source_model from = {.file = b->file, .errors = diags_new()};
        from.model = model_parse(b->file, b->text, b->length, from.errors);
        diags_flush(from.errors, stderr);
        code = from.model == NULL ? EXIT_BAD_INPUT : each_scene_of(&from, v);
        source_close(&from);
    }
    return code;
}

/* The file FOLDER/NAME + ending, to write; NULL, reported. */
static FILE *scenes_open(const char *folder, const char *name, const char *ending) {
    char path[1024];
    if (snprintf(path, sizeof path, "%s/%s%s", folder, name, ending) >= (int)sizeof path) {
        fprintf(stderr, "%s: error: the path is too long\n", folder);
        return NULL;
    }
    FILE *out = fopen(path, "w");
    if (out == NULL) {
        write_error_say(path);
    }
    return out;
}

/* Writes a scene's C or header. False: reported. */
static bool write_code(const char *folder, const image *im, const char *file, bool header) {
    FILE *out = scenes_open(folder, im->name, header ? ".h" : ".c");
    if (out != NULL) {
        (header ? emit_c_header : emit_c)(out, im, file);
        (void)atomic_file_close(out, folder, true);
    }
    return out != NULL;
}

typedef struct emission {
    const char *folder;
    FILE *declarations;
    FILE *index;
    bool all_forms; /* also write text, LaTeX, Octave and the runs' hashes */
} emission;

/* Writes the scene's run as a line with the hash of its last state: "WHAT NAME steps N hash 0x... ok". */
static void scenes_write_hash(FILE *out, const char *what, const engine_kind *kind,
                              const image *im) {
    void *run = kind->start(im);
    const wh_status status = loop_steps(kind, run, im->steps);
    fprintf(out, "%s %s steps %" PRIu64 " hash 0x%016" PRIx64 " %s\n", what, im->name,
            kind->steps(run), kind->hash(run), wh_status_text(status));
    kind->stop(run);
}

/* Writes the forms of a file's scene that need the equations, and Octave's. */
static int emit_equations(void *context, const char *file, const loaded *made) {
    const emission *to = context;
    FILE *out = scenes_open(to->folder, made->image->name, ".txt");
    if (out == NULL) {
        return EXIT_RUN_FAILED;
    }
    show_text(out, made->equations);
    show_latex(out, made->equations);
    if (made->image->recovered == 0) {
        emit_octave(out, made->image, file, made->contacts);
    }
    (void)atomic_file_close(out, to->folder, true);
    return EXIT_DONE;
}

/* Writes the hashes of the runs of a file's scene. */
static int emit_hashes(const emission *to, const image *im) {
    FILE *out = scenes_open(to->folder, im->name, ".hash");
    if (out == NULL) {
        return EXIT_RUN_FAILED;
    }
    scenes_write_hash(out, "scene", &engine_float, im);
    scenes_write_hash(out, "double", &engine_double, im);
    (void)atomic_file_close(out, to->folder, true);
    return EXIT_DONE;
}

static int emit_image(void *context, const char *file, const image *im) {
    const emission *to = context;
    if (to->all_forms) {
        const int code = emit_hashes(to, im);
        if (code != EXIT_DONE) {
            return code;
        }
    }
    if (!write_code(to->folder, im, file, false) || !write_code(to->folder, im, file, true)) {
        return EXIT_RUN_FAILED;
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
        const visit all = {to.all_forms ? emit_equations : NULL, emit_image, &to};
        code = each_scene(count - 1, words + 1, &all);
        fputs("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n", to.declarations);
        fputs("};\n\nconst unsigned wh_scene_count = sizeof wh_scenes / sizeof wh_scenes[0];\n",
              to.index);
    }
    if (to.declarations != NULL) {
        (void)atomic_file_close(to.declarations, to.folder, true);
    }
    if (to.index != NULL) {
        (void)atomic_file_close(to.index, to.folder, true);
    }
    return code;
}

static int hash_one(void *context, const char *file, const image *im) {
    (void)context;
    (void)file;
    scenes_write_hash(stdout, "scene", &engine_float, im);
    return EXIT_DONE;
}

int command_hashes(int count, char **words) {
    (void)words;
    if (count != 0) {
        fputs("usage: whirl hashes\n", stderr);
        return EXIT_BAD_INPUT;
    }
    return each_scene(0, NULL, &(visit){.image = hash_one});
}
