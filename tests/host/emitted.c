#include "emitted.h"

#include "derived.h"
#include "host/emit/emit.h"

enum { SCENES = 400, SCENES_MOST = 200, SCENES_FEW = 60 };

emitted_c emitted;
dice emitted_die;

void each_emitted(void (*check)(const image *im)) {
    const unsigned cases = dice_cases(few_or_all(usual_or(SCENES_MOST, SCENES_FEW), SCENES));
    for (unsigned i = 0; i < cases; i++) {
        drawn_scene_draw(&emitted.drawn, &emitted_die);
        snprintf(emitted.about, sizeof emitted.about, "scene %u", i);
        emitted.text = derived_written(emit_c, &emitted.drawn.im);
        emitted.file = c_file_of(emitted.text);
        check(&emitted.drawn.im);
        c_file_free(&emitted.file);
        free(emitted.text);
    }
}

bool emitted_says(const char *words) { return c_behind(&emitted.file, 0, words) >= 0; }

static bool has_line(const char *line) {
    const size_t length = strlen(line);
    for (const char *at = emitted.text; (at = strstr(at, line)) != NULL; at++) {
        if ((at == emitted.text || at[-1] == '\n') && at[length] == '\n') {
            return true;
        }
    }
    return false;
}

void emitted_expect_line(const char *line, bool wanted) {
    if (has_line(line) != wanted) {
        printf("  %s: %s '%s' in\n%s", emitted.about, wanted ? "no" : "an unexpected", line,
               emitted.text);
    }
    TEST_ASSERT_EQUAL_MESSAGE(wanted, has_line(line), line);
}
