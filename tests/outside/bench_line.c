/* Frames: version, kind, sequence, ticks, payload and CRC-32, coded by COBS. */
#include "tests/outside/bench_line.h"
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATIENCE_S = 60, CPU_LIMIT_S = 120 };

_Noreturn void disagree(const char *format, ...) {
    va_list values;
    va_start(values, format);
    fputs("error: the page and the firmware disagree: ", stderr);
    vfprintf(stderr, format, values);
    fputc('\n', stderr);
    va_end(values);
    exit(2);
}

static uint32_t crc32(const uint8_t *byte, size_t n) {
    uint32_t crc = 0xFFFFFFFFU;
    for (size_t i = 0; i < 8 * n; i++) {
        crc ^= i % 8 == 0 ? byte[i / 8] : 0;
        crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    return crc ^ 0xFFFFFFFFU;
}

void put(message *m, uint32_t value, int bytes) {
    for (int i = 0; i < bytes; i++) {
        m->byte[m->n++] = (uint8_t)(value >> (8 * i));
    }
}

uint32_t get(message *m, int bytes) {
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++) {
        if (m->at == m->n) {
            disagree("a frame of kind %d has only %zu bytes", m->byte[1], m->n);
        }
        value |= (uint32_t)m->byte[m->at++] << (8 * i);
    }
    return value;
}

double get_float(message *m) {
    const uint32_t bits = get(m, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

const char *get_string(message *m) {
    const char *text = (const char *)&m->byte[m->at];
    while (get(m, 1) != 0) {
    }
    return text;
}

void line_say(const line *l, message *m) {
    uint8_t block[254];
    size_t n = 0;
    put(m, crc32(m->byte, m->n), 4);
    for (size_t i = 0; i <= m->n; i++) {
        if (i < m->n && m->byte[i] != 0) {
            block[n++] = m->byte[i];
        }
        if (i == m->n || m->byte[i] == 0 || n == sizeof block) {
            fputc((int)n + 1, l->to);
            fwrite(block, 1, n, l->to);
            n = 0;
        }
    }
    fputc(0, l->to);
    fflush(l->to);
}

static void silent(int signal_number) {
    static const char text[] = "error: the firmware owes a frame and is silent for 60 s\n";
    _exit(write(2, text, sizeof text - 1) > 0 && signal_number == SIGALRM ? 2 : 3);
}

bool line_hear(const line *l, message *m) {
    int code = 0;
    m->n = 0;
    m->at = HEADER;
    alarm(PATIENCE_S);
    while (code == 0) {
        code = getc(l->from);
    }
    while (code > 0) {
        const int block = code;
        for (int i = 1; i < block && code > 0 && m->n < sizeof m->byte - 1; i++) {
            code = getc(l->from);
            m->byte[m->n++] = (uint8_t)code;
        }
        if (code <= 0) {
            disagree("a frame ends inside a block of %d bytes", block);
        }
        code = getc(l->from);
        if (code > 0 && block < 255) {
            m->byte[m->n++] = 0;
        }
    }
    if (code == EOF) {
        return false;
    }
    const size_t n = m->at = m->n - 4;
    if (m->n < 12 || m->byte[0] != 1 || get(m, 4) != crc32(m->byte, n)) {
        disagree("a frame of %zu bytes, version %d, or its CRC", m->n, m->byte[0]);
    }
    m->n = n;
    m->at = 1;
    return true;
}

void line_start(line *l, const char *firmware) {
    int down[2], up[2];
    signal(SIGPIPE, SIG_IGN); /* the next read reports that the firmware has ended */
    signal(SIGALRM, silent);
    if (access(firmware, X_OK) != 0 || pipe(down) != 0 || pipe(up) != 0) {
        fprintf(stderr, "error: cannot start %s\nhint: make pil-images\n", firmware);
        exit(2);
    }
    l->child = fork();
    if (l->child == 0) {
        const struct rlimit most = {CPU_LIMIT_S, CPU_LIMIT_S};
        const int in = fcntl(down[0], F_DUPFD, 10), out = fcntl(up[1], F_DUPFD, 10);
        setrlimit(RLIMIT_CPU, &most);
        dup2(open("/dev/null", O_WRONLY), 1);
        dup2(in, 3);
        dup2(out, 4);
        for (int fd = 5; fd < 64; fd++) {
            close(fd);
        }
        execl(firmware, firmware, (char *)NULL);
        _exit(127);
    }
    close(down[0]);
    close(up[1]);
    l->to = fdopen(down[1], "wb");
    l->from = fdopen(up[0], "rb");
}

int line_end(const line *l) {
    int status = 0;
    fclose(l->to);
    fclose(l->from);
    waitpid(l->child, &status, 0);
    alarm(0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
