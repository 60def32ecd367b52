#include "named_cures.h"

#include "command.h"

static void read_word(const char *from, const char *option, char word[CURE_WORD]) {
    const char *at = strstr(from, option);
    word[0] = '\0';
    if (at != NULL) {
        sscanf(at + strlen(option), " %39[a-z0-9.-]", word);
    }
}

static named_cure read_options(const char *piece, bool tried) {
    named_cure cure = {.compensated = strstr(piece, "--compensated") != NULL,
                       .in_double = strstr(piece, "--number double") != NULL,
                       .tried = tried};
    read_word(piece, "--step", cure.step);
    read_word(piece, "--method", cure.method);
    return cure;
}

/* Splits a list such as "--step 1ms, or --number double" at each "or --". Changes the text. Returns the new count. */
static int read_alternatives(char *piece, bool tried, named_cure *list, int count) {
    while (piece != NULL && count < NAMED_CURES) {
        char *next = strstr(piece, "or --");
        if (next != NULL) {
            *next = '\0';
            next += strlen("or ");
        }
        list[count++] = read_options(piece, tried && strstr(piece, "(Whirl's own search") == NULL);
        piece = next;
    }
    return count;
}

int named_cures(const char *err, named_cure *list) {
    static const char *const says[] = {" cures this", " should do", " resolves it;",
                                       " resolves it ("};
    int count = 0;
    char text[SAID_SIZE];
    snprintf(text, sizeof text, "%s", err);
    char *rest = NULL;
    for (char *line = strtok_r(text, "\n", &rest); line != NULL;
         line = strtok_r(NULL, "\n", &rest)) {
        char *end = NULL;
        for (size_t k = 0; k < sizeof says / sizeof *says && end == NULL; k++) {
            end = strstr(line, says[k]);
        }
        if (strncmp(line, "hint: ", 6) != 0 || end == NULL) {
            continue;
        }
        char *other = strstr(end, ", or --");
        const bool tried = strncmp(end, says[1], strlen(says[1])) != 0 &&
                           strncmp(end, says[3], strlen(says[3])) != 0;
        *end = '\0';
        char *begin = strstr(line, "--");
        TEST_ASSERT_NOT_NULL_MESSAGE(begin, err);
        count = read_alternatives(begin, tried, list, count);
        count =
            other == NULL ? count : read_alternatives(other + strlen(", or "), true, list, count);
    }
    return count;
}

bool named_with_step(const char *err, named_cure *cure) {
    named_cure list[NAMED_CURES];
    const int count = named_cures(err, list);
    for (int k = 0; k < count; k++) {
        if (list[k].step[0] != '\0') {
            *cure = list[k];
            return true;
        }
    }
    return false;
}

int named_words(const named_cure *cure, const char *method, const char *number, const char **words,
                int count) {
    words[count++] = "--number";
    words[count++] = cure->in_double ? "double" : number;
    words[count++] = "--method";
    words[count++] = cure->method[0] != '\0' ? cure->method : method;
    if (cure->step[0] != '\0') {
        words[count++] = "--step";
        words[count++] = cure->step;
    }
    if (cure->compensated) {
        words[count++] = "--compensated";
    }
    words[count] = NULL;
    return count;
}
