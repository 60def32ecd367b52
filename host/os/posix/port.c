#include "host/os/port.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

enum { WRITE_MS = 1000 };

static struct termios before; /* the line's settings, to be restored */

static const struct {
    double baud;
    speed_t speed;
} speeds[] = {{9600, B9600},   {19200, B19200},   {38400, B38400},
              {57600, B57600}, {115200, B115200}, {230400, B230400}};
enum { SPEEDS = sizeof speeds / sizeof speeds[0] };

static int index_of(double baud) {
    int i = 0;
    while (i < SPEEDS && !(speeds[i].baud <= baud && speeds[i].baud >= baud)) {
        i++;
    }
    return i;
}

bool port_has_speed(double baud) { return index_of(baud) < SPEEDS; }

static bool make_plain(port *p, double baud) {
    const int speed = index_of(baud);
    if (tcgetattr(p->file, &before) != 0 || speed == SPEEDS) {
        return false;
    }
    struct termios plain = before;
    plain.c_iflag &= ~(tcflag_t)(BRKINT | ICRNL | IGNCR | INLCR | INPCK | ISTRIP | IXON | IXOFF);
    plain.c_oflag &= ~(tcflag_t)OPOST;
    plain.c_lflag &= ~(tcflag_t)(ECHO | ECHONL | ICANON | IEXTEN | ISIG);
    plain.c_cflag = (plain.c_cflag & ~(tcflag_t)(CSIZE | PARENB | CSTOPB)) | CS8 | CLOCAL | CREAD;
    plain.c_cc[VMIN] = 1;
    plain.c_cc[VTIME] = 0;
    return cfsetospeed(&plain, speeds[speed].speed) == 0 &&
           cfsetispeed(&plain, speeds[speed].speed) == 0 &&
           tcsetattr(p->file, TCSANOW, &plain) == 0;
}

/* Two readers would take bytes from each other. */
static bool have_alone(int file) {
    if (flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) {
        return true; /* also if the system has no locks */
    }
    errno = EBUSY;
    return false;
}

bool port_open(port *p, const char *name, double baud) {
    *p = (port){.file = open(name, O_RDWR | O_NOCTTY | O_NONBLOCK)};
    if (p->file < 0 && (errno == EACCES || errno == EROFS)) {
        p->file = open(name, O_RDONLY | O_NOCTTY | O_NONBLOCK);
    }
    if (p->file < 0) {
        return false;
    }
    p->is_line = isatty(p->file) != 0;
    if (p->is_line && (!have_alone(p->file) || !make_plain(p, baud))) {
        const int why = errno;
        close(p->file);
        errno = why;
        return false;
    }
    return true;
}

void port_forget(const port *p) {
    if (p->is_line) {
        (void)tcflush(p->file, TCIFLUSH);
    }
}

void port_say_unopened(const char *name, const char *hint) {
    const int reason = errno;
    fprintf(stderr, "%s: error: cannot be opened: %s\nhint: %s\n", name[0] != '\0' ? name : "''",
            strerror(reason), reason == EBUSY ? "another program uses this line" : hint);
}

void port_close(port *p) {
    if (p->file >= 0) {
        if (p->is_line) {
            (void)tcsetattr(p->file, TCSANOW, &before);
        }
        close(p->file);
    }
    p->file = -1;
}

int port_read(port *p, uint8_t *bytes, size_t room, int wait_ms, bool *typed) {
    struct pollfd wait[2] = {{.fd = p->file, .events = POLLIN},
                             {.fd = STDIN_FILENO, .events = POLLIN}};
    const int ready = poll(wait, typed != NULL ? 2U : 1U, wait_ms);
    if (typed != NULL) {
        *typed = ready > 0 && (wait[1].revents & (POLLIN | POLLHUP)) != 0;
    }
    if (ready <= 0 || (wait[0].revents & (POLLIN | POLLHUP | POLLERR | POLLNVAL)) == 0) {
        return 0;
    }
    const ssize_t count = read(p->file, bytes, room);
    if (count > 0) {
        return (int)count;
    }
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
        return 0;
    }
    p->failed = count < 0 ? errno : 0;
    return -1;
}

bool port_write(port *p, const char *bytes, size_t count) {
    for (size_t done = 0; done < count;) {
        const ssize_t more = write(p->file, bytes + done, count - done);
        if (more > 0) {
            done += (size_t)more;
        } else if (more < 0 && errno != EAGAIN && errno != EINTR) {
            return false;
        } else {
            struct pollfd wait = {.fd = p->file, .events = POLLOUT};
            if (poll(&wait, 1, WRITE_MS) == 0) {
                return false;
            }
        }
    }
    return true;
}
