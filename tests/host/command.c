#include "command.h"

#include <sys/wait.h>
#include <unistd.h>

enum { WORDS_MAX = 32 };

static void read_back(FILE *from, char text[SAID_SIZE]) {
    rewind(from);
    const size_t length = fread(text, 1, SAID_SIZE - 1, from);
    text[length] = '\0';
    fclose(from);
}

void command_say(int (*command)(int count, char **words), const char *const *words, said *what) {
    FILE *out = tmpfile();
    FILE *err = tmpfile();
    TEST_ASSERT_TRUE(out != NULL && err != NULL);
    fflush(NULL);
    const pid_t child = fork();
    TEST_ASSERT_TRUE(child >= 0);
    if (child == 0) {
        char *copies[WORDS_MAX + 1] = {NULL};
        int count = 0;
        while (count < WORDS_MAX && words[count] != NULL) {
            copies[count] = strdup(words[count]);
            count++;
        }
        const bool good =
            dup2(fileno(out), STDOUT_FILENO) >= 0 && dup2(fileno(err), STDERR_FILENO) >= 0;
        const int status = good ? command(count, copies) : 99;
        fflush(NULL);
        _exit(status);
    }
    int status = 0;
    TEST_ASSERT_TRUE(waitpid(child, &status, 0) == child);
    what->status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    read_back(out, what->out);
    read_back(err, what->err);
}

int said_owes(const char *err) {
    bool owes = false;
    for (const char *at = err; (at = strstr(at, ": warning: ")) != NULL; at++) {
        const char *end = at + strcspn(at, "\n");
        const char *first = strstr(at, "]; first: ");
        owes = owes || end[-1] == ']' || (first != NULL && first < end);
    }
    return owes ? 1 : 0;
}

static char kept[] = "build/tests/model-XXXXXX";
static bool is_kept;

const char *model_keep(const char *text) {
    model_drop();
    snprintf(kept, sizeof kept, "build/tests/model-XXXXXX");
    const int file = mkstemp(kept);
    if (file < 0) {
        TEST_FAIL_MESSAGE("run from the project's root");
        return NULL;
    }
    is_kept = true;
    const size_t length = strlen(text);
    TEST_ASSERT_TRUE(write(file, text, length) == (ssize_t)length);
    close(file);
    return kept;
}

void command_say_model(int (*command)(int count, char **words), const char *text, said *what) {
    const char *const words[] = {model_keep(text), NULL};
    command_say(command, words, what);
    model_drop();
}

void model_drop(void) {
    if (is_kept) {
        unlink(kept);
        is_kept = false;
    }
}

double said_step_s(const char *word) {
    char *unit;
    const double number = strtod(word, &unit);
    return number * (strcmp(unit, "ms") == 0   ? 1e-3
                     : strcmp(unit, "us") == 0 ? 1e-6
                     : strcmp(unit, "ns") == 0 ? 1e-9
                                               : 1.0);
}

double said_named_step_s(const char *text) {
    char word[40];
    const char *at = strstr(text, "--step ");
    if (at == NULL) {
        return 0.0;
    }
    at += strlen("--step ");
    snprintf(word, sizeof word, "%.*s", (int)strcspn(at, " ;,\n"), at);
    return said_step_s(word);
}

static int kept_stderr = -1;
static FILE *caught;

void errors_catch(void) {
    fflush(stderr);
    caught = tmpfile();
    kept_stderr = dup(STDERR_FILENO);
    TEST_ASSERT_TRUE(caught != NULL && kept_stderr >= 0);
    TEST_ASSERT_TRUE(dup2(fileno(caught), STDERR_FILENO) >= 0);
}

const char *errors_caught(void) {
    static char text[SAID_SIZE];
    fflush(stderr);
    TEST_ASSERT_TRUE(dup2(kept_stderr, STDERR_FILENO) >= 0);
    close(kept_stderr);
    read_back(caught, text);
    return text;
}

const char *said_words(const char *text, const char *words) {
    text += strspn(text, " ");
    TEST_ASSERT_EQUAL_STRING_LEN(words, text, strlen(words));
    return text + strlen(words);
}

const char *said_exactly(const char *text, const char *words) {
    TEST_ASSERT_EQUAL_STRING_LEN(words, text, strlen(words));
    return text + strlen(words);
}

const char *said_number(const char *text, double *number) {
    char *behind;
    *number = strtod(text, &behind);
    TEST_ASSERT_TRUE_MESSAGE(behind != text, text);
    return behind;
}

const char *said_row(const char *text, int count, double *number) {
    const char *end = strchr(text, '\n');
    if (end == NULL || end[1] == '\0') {
        return NULL;
    }
    const char *at = end + 1;
    for (int k = 0; k < count; k++) {
        at = said_number(k > 0 ? said_exactly(at, ",") : at, &number[k]);
    }
    return end + 1;
}

const char *said_word(const char *text, char *word, size_t size) {
    text += strspn(text, " ");
    const size_t length = strcspn(text, " \n");
    TEST_ASSERT_TRUE_MESSAGE(length > 0 && length < size, text);
    snprintf(word, size, "%.*s", (int)length, text);
    return text + length;
}

dice dice_of(const char *suite, unsigned long seed) {
    const char *given = getenv("WHIRL_SEED");
    const unsigned long long used = given != NULL ? strtoull(given, NULL, 10) : seed;
    printf("  %s: seed %llu\n", suite, used);
    return (dice){used * 2862933555777941757ULL + 3037000493ULL};
}

/* Knuth's MMIX generator: only its high bits are random enough */
static unsigned long long roll(dice *d) {
    d->state = d->state * 6364136223846793005ULL + 1442695040888963407ULL;
    return d->state >> 11;
}

double dice_between(dice *d, double low, double high) {
    return low + (high - low) * (double)roll(d) * 0x1p-53;
}

unsigned dice_one_of(dice *d, unsigned count) { return (unsigned)(roll(d) >> 20) % count; }

static bool asked(const char *variable) {
    const char *given = getenv(variable);
    return given != NULL && given[0] != '\0';
}

unsigned usual_or(unsigned usual, unsigned fewest) { return asked("WHIRL_FEW") ? fewest : usual; }

unsigned dice_cases(unsigned usual) {
    const char *given = getenv("WHIRL_CASES");
    return given != NULL ? (unsigned)strtoul(given, NULL, 10) : usual;
}

unsigned few_or_all(unsigned few, unsigned all) { return asked("WHIRL_FULL") ? all : few; }
