#include "jumps.h"
#include "test.h"

#include "host/check/pole.h"
#include "host/cli/commands.h"

said jumps_said;

unsigned jumps_cases(unsigned few, unsigned all, unsigned fewest) {
    return dice_cases(usual_or(few_or_all(few, all), fewest));
}

void jumps_run(const char *text, const char *number, char *const more[static JUMPS_WORDS]) {
    const char *words[4 + JUMPS_WORDS] = {model_keep(text), "--number", number};
    bool another = false;
    for (int i = 0; i < JUMPS_WORDS && more[i] != NULL; i++) {
        another = another || strcmp(more[i], "--number") == 0;
    }
    memcpy(words + (another ? 1 : 3), more, JUMPS_WORDS * sizeof *more);
    command_say(command_run, words, &jumps_said);
    model_drop();
}

bool jumps_named(char text[static SAID_SIZE], char *words[static JUMPS_WORDS]) {
    static const char before[] = "\nhint: ";
    char *at = strstr(jumps_said.err, before);
    char *end = at != NULL ? strstr(at, " cures this (tried)") : NULL;
    end = end == NULL && at != NULL ? strstr(at, " ends the run before this step") : end;
    if (end == NULL) {
        return false;
    }
    *end = '\0';
    for (char *next = at; next != NULL; next = strstr(at + 1, before)) {
        at = next;
    }
    strcpy(text, at + strlen(before));
    char *next = text;
    for (int i = 0; i < JUMPS_WORDS; i++) {
        words[i] = strtok_r(next, " ", &next);
    }
    return true;
}

bool jumps_told(void) { return strstr(jumps_said.err, "jumped over a pole") != NULL; }

bool jumps_some(motion *m) {
    pole_crossing *j = pole_crossing_open(m->image);
    for (uint64_t step = 0; step <= m->image->steps; step++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, step == 0 ? WH_OK : motion_step(m, 1));
        pole_crossing_enter(j, m->kind, m->run);
    }
    const bool some = pole_crossing_some(j);
    pole_crossing_close(j);
    return some;
}
