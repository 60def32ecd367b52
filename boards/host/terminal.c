/* terminal.c: a pseudo-terminal that replaces a board's serial line. Any terminal program can open it by the link
 * RIG_TTY (default build/rig.tty). The link is removed when the program ends, also after Ctrl-C. */
#define _XOPEN_SOURCE 700

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "boards/board.h"

static int line = -1;
/* kept open, so that the line works even if no terminal program has opened it */
static int other_end = -1;
static const char *link_name;
static char own_terminal[64];

/* Async-signal-safe, because end_by() calls it. If a newer program has replaced the link, the new link stays. */
static void remove_link(void) {
    if (link_name != NULL) {
        char to[sizeof own_terminal];
        const ssize_t length = readlink(link_name, to, sizeof to);
        if (length == (ssize_t)strlen(own_terminal) &&
            memcmp(to, own_terminal, (size_t)length) == 0) {
            (void)unlink(link_name);
        }
        link_name = NULL;
    }
}

static void end_by(int number) {
    remove_link();
    (void)signal(number, SIG_DFL);
    (void)raise(number);
}

/* Replaces a link of an earlier run, but no other file. */
static bool make_link(const char *terminal) {
    struct stat there;
    const char *wanted = getenv("RIG_TTY");
    wanted = wanted != NULL && wanted[0] != '\0' ? wanted : "build/rig.tty";
    if (lstat(wanted, &there) == 0 && S_ISLNK(there.st_mode)) {
        if (access(wanted, F_OK) == 0) {
            fprintf(stderr,
                    "warning: %s belonged to another running rig and now leads to this "
                    "one\nhint: for a second rig: RIG_TTY=build/rig2.tty make rig\n",
                    wanted);
        }
        (void)unlink(wanted);
    }
    if (symlink(terminal, wanted) != 0) {
        fprintf(stderr,
                "%s: error: the link to the terminal cannot be made: %s\nhint: choose "
                "another path: RIG_TTY=/tmp/rig.tty make rig\n",
                wanted, strerror(errno));
        return false;
    }
    snprintf(own_terminal, sizeof own_terminal, "%s", terminal);
    link_name = wanted;
    return atexit(remove_link) == 0 && signal(SIGINT, end_by) != SIG_ERR &&
           signal(SIGTERM, end_by) != SIG_ERR && signal(SIGHUP, end_by) != SIG_ERR;
}

/* A serial line: no echo, no line editing, no signals, no conversion. */
static bool make_plain(int terminal) {
    struct termios plain;
    if (tcgetattr(terminal, &plain) != 0) {
        return false;
    }
    plain.c_iflag &= ~(tcflag_t)(BRKINT | ICRNL | IGNCR | INLCR | INPCK | ISTRIP | IXON);
    plain.c_oflag &= ~(tcflag_t)OPOST;
    plain.c_lflag &= ~(tcflag_t)(ECHO | ECHONL | ICANON | IEXTEN | ISIG);
    plain.c_cflag = (plain.c_cflag & ~(tcflag_t)(CSIZE | PARENB)) | CS8;
    return cfsetospeed(&plain, B38400) == 0 && tcsetattr(terminal, TCSANOW, &plain) == 0;
}

bool board_converse(void) {
    const char *terminal = NULL;
    line = posix_openpt(O_RDWR | O_NOCTTY);
    if (line >= 0 && grantpt(line) == 0 && unlockpt(line) == 0) {
        terminal = ptsname(line);
    }
    other_end = terminal != NULL ? open(terminal, O_RDWR | O_NOCTTY) : -1;
    if (other_end < 0 || !make_plain(other_end) ||
        fcntl(line, F_SETFL, fcntl(line, F_GETFL) | O_NONBLOCK) != 0) {
        fprintf(stderr, "error: no pseudo-terminal: %s\n", strerror(errno));
        return false;
    }
    if (!make_link(terminal)) {
        return false;
    }
    printf(
        "The rig's console is %s, which is %s. In another window:\n"
        "    picocom %s        (or tio, screen, minicom; any speed)\n"
        "and there: talk on, help, arm, start 330, status, measure, stop. Ctrl-C here ends it.\n",
        link_name, terminal, link_name);
    fflush(stdout);
    return true;
}

unsigned hal_console_read(char *bytes, unsigned room) {
    const ssize_t count = read(line, bytes, room);
    return count > 0 ? (unsigned)count : 0U;
}

unsigned hal_console_offer(const char *bytes, unsigned count) {
    const ssize_t taken = count > 0 ? write(line, bytes, count) : 0;
    return taken > 0 ? (unsigned)taken : 0U;
}
