"""events.py: mechanisms with stops, friction, holds and crossings, integrated from event to event.

Independent of Whirl. This file has its own conditions for the modes. Between events, motions are
integrated by Gragg's extrapolation of order 16 (Hairer, Norsett & Wanner, Solving Ordinary Differential
Equations I, section II.9). Events are bisected to 1e-17 s; each tried time is integrated anew, so that
nothing is interpolated. Needs only Python 3.
"""
import itertools
import math

COLUMNS = 8  # of the extrapolation table, which gives order 16
REST = 1e-10  # m/s: a stop that is left at a lower speed does not bounce
FREE, HELD, STUCK, SLIDES = "free", "held", "stuck", "slides"
LAST = 1e-17  # s: accuracy of the times of events
TINY = 1e-12  # pivot, relative to the diagonal: below, a row depends on earlier rows


def solve(rows, right):
    """Elimination with diagonal pivots. Unknowns of rows that depend on earlier rows become zero."""
    n = len(right)
    a = [list(r) + [b] for r, b in zip(rows, right)]
    whole = [abs(a[i][i]) for i in range(n)]
    idle = [False] * n
    for i in range(n):
        idle[i] = abs(a[i][i]) <= TINY * whole[i]
        for k in range(i + 1, n):
            if not idle[i]:
                factor = a[k][i] / a[i][i]
                a[k] = [p - factor * q for p, q in zip(a[k], a[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        if not idle[i]:
            x[i] = (a[i][n] - sum(a[i][k] * x[k] for k in range(i + 1, n))) / a[i][i]
    return x


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


class Contact:
    mode = FREE

    def row(self, q):
        return self.fixed_row

    def bias(self, q, v):
        return 0.0


class Stop(Contact):
    """A stop gap(q) >= 0. row(q): gradient of the gap; bias(q, v) = d(row)/dt v."""

    def __init__(self, restitution, gap, row, bias=None):
        self.restitution, self.gap = restitution, gap
        if callable(row):
            self.row, self.bias = row, bias
        else:
            self.fixed_row = row


class Friction(Contact):
    def __init__(self, row, static, kinetic, normal):
        self.fixed_row = row
        self.static, self.kinetic, self.normal = static, kinetic, normal
        self.mode, self.sign = STUCK, 0


class Hold(Contact):
    def __init__(self, row, condition):
        self.fixed_row, self.condition = row, condition


class Crossing(Contact):
    def __init__(self, value, change):
        self.value, self.change = value, change


class Run:
    """A motion q'' = M^-1 (force + contacts), with mass(q) and force(q, v)."""

    def __init__(self, mass, force, contacts, q, v, span):
        self.mass, self.force, self.contacts = mass, force, contacts
        self.n, self.y, self.span, self.t = len(q), list(q) + list(v), span, 0.0
        self.log = []  # (time, contact, its mode before)
        self.begin()

    # --- accelerations in the present modes ---------------------------------------------------

    def active(self):
        return [c for c in self.contacts if c.mode in (HELD, STUCK)]

    def accelerations(self, q, v):
        m = self.mass(q)
        f = list(self.force(q, v))
        for c in self.contacts:
            if c.mode == SLIDES:
                size = c.kinetic * max(c.normal(q, v), 0.0)
                f = [a - c.sign * size * b for a, b in zip(f, c.row(q))]
        free = solve(m, f)
        held = self.active()
        if not held:
            return free, {}
        rows = [c.row(q) for c in held]
        ways = [solve(m, r) for r in rows]
        gram = [[dot(r, w) for w in ways] for r in rows]
        want = [-c.bias(q, v) - dot(r, free) for c, r in zip(held, rows)]
        forces = solve(gram, want)
        for w, s in zip(ways, forces):
            free = [a + s * b for a, b in zip(free, w)]
        return free, dict(zip(held, forces))

    def slope(self, y):
        q, v = y[:self.n], y[self.n:]
        return v + self.accelerations(q, v)[0]

    def advance(self, y, span):
        """Extrapolated midpoint rule over `span`."""
        if span == 0.0:
            return list(y)
        parts = max(1, math.ceil(span / self.span - 1e-9))
        for _ in range(parts):
            y = self.stretch(y, span / parts)
        return y

    def stretch(self, y, span):
        first = self.slope(y)
        table = []
        for k in range(COLUMNS):
            count = 2 * (k + 1)
            h = span / count
            before, now = [0.0] * len(y), [h * s for s in first]  # relative to y, for less round-off
            for _ in range(count):
                slope = self.slope([a + b for a, b in zip(y, now)])
                last, before, now = before, now, [b + 2 * h * s for b, s in zip(before, slope)]
            row = [[(a + b + h * s) / 2 for a, b, s in zip(last, before, slope)]]
            for j in range(1, k + 1):
                ratio = ((k + 1) / (k + 1 - j)) ** 2 - 1
                row.append([b + (b - c) / ratio for b, c in zip(row[j - 1], table[-1][j - 1])])
            table.append(row)
        return [a + b for a, b in zip(y, table[-1][-1])]

    # --- events ----------------------------------------------------------------------------------

    def due(self, y):
        """The contacts whose present mode has ended at the state y."""
        q, v = y[:self.n], y[self.n:]
        forces = self.accelerations(q, v)[1]
        found = []
        for c in self.contacts:
            if isinstance(c, Stop):
                happened = (forces[c] < 0 if c.mode == HELD
                            else c.gap(q) < 0 and dot(c.row(q), v) < 0)
            elif isinstance(c, Friction):
                happened = (abs(forces[c]) > c.static * max(c.normal(q, v), 0.0)
                            if c.mode == STUCK else c.sign * dot(c.row(q), v) < 0)
            elif isinstance(c, Hold):
                happened = (c.condition(q) > 0) != (c.mode == HELD)
            else:
                happened = c.value(q) > 0 and c.below
            if happened:
                found.append(c)
        return found

    def impulse(self, c, target):
        """Changes v so that row v = target. Held contacts stay held, sticking frictions need not."""
        q, v = self.y[:self.n], self.y[self.n:]
        members = [c] + [o for o in self.contacts if o is not c and o.mode == HELD]
        rows = [o.row(q) for o in members]
        ways = [solve(self.mass(q), r) for r in rows]
        gram = [[dot(r, w) for w in ways] for r in rows]
        want = [(target if o is c else 0.0) - dot(r, v) for o, r in zip(members, rows)]
        for w, s in zip(ways, solve(gram, want)):
            v = [a + s * b for a, b in zip(v, w)]
        self.y[self.n:] = v
        return v

    def settle(self):
        """Chooses the modes from now on. Friction at rest sticks or slides, and a stop that would pull opens.
        Of all combinations that agree with their own forces and accelerations, takes one with the largest
        number of held contacts."""
        q, v = self.y[:self.n], self.y[self.n:]
        open_ = []  # contacts whose mode is open
        for c in self.contacts:
            if isinstance(c, Friction):
                speed = dot(c.row(q), v)
                c.mode, c.sign = (SLIDES, math.copysign(1, speed)) if speed != 0.0 else (STUCK, 0)
            if c.mode == STUCK or (isinstance(c, Stop) and c.mode == HELD):
                open_.append(c)
        ways = [[(STUCK, 0), (SLIDES, 1), (SLIDES, -1)] if isinstance(c, Friction)
                else [(HELD, 0), (FREE, 0)] for c in open_]
        for way in sorted(itertools.product(*ways), key=lambda w: sum(m in (SLIDES, FREE) for m, _ in w)):
            for c, (c.mode, c.sign) in zip(open_, way):
                pass
            if self.agrees(open_, q, v):
                return
        raise ArithmeticError("no way for the contacts to hold or give")

    def agrees(self, open_, q, v):
        accel, forces = self.accelerations(q, v)
        for c in open_:
            if c.mode == STUCK:
                fits = abs(forces[c]) <= c.static * max(c.normal(q, v), 0.0)
            elif c.mode == HELD:
                fits = forces[c] >= 0.0
            else:
                moves = dot(c.row(q), accel) + c.bias(q, v)
                fits = moves * c.sign > 0.0 if c.mode == SLIDES else moves > 0.0
            if not fits:
                return False
        return True

    def take(self, c):
        q, v = self.y[:self.n], self.y[self.n:]
        if isinstance(c, Stop) and c.mode == HELD:
            c.mode = FREE
        elif isinstance(c, Stop):
            speed = dot(c.row(q), v)
            leaves = -c.restitution * speed
            self.impulse(c, leaves if leaves > REST else 0.0)
            if leaves <= REST:
                c.mode = HELD
        elif isinstance(c, Friction) and c.mode == SLIDES:
            i = c.fixed_row.index(1.0)
            self.y[self.n + i] = 0.0
        elif isinstance(c, Hold):
            c.mode = FREE if c.mode == HELD else HELD
            if c.mode == HELD:
                self.impulse(c, 0.0)
                i = c.fixed_row.index(1.0)
                self.y[self.n + i] = 0.0
        elif isinstance(c, Crossing):
            self.y = self.y[:self.n] + c.change(q, v)
            c.below = False
        if not (isinstance(c, Friction) and c.mode == STUCK):
            self.settle()
        else:
            force = self.accelerations(q, v)[1][c]
            c.mode, c.sign = SLIDES, math.copysign(1, -force)

    def begin(self):
        q, v = self.y[:self.n], self.y[self.n:]
        for c in self.contacts:
            if isinstance(c, Hold) and c.condition(q) > 0:
                self.take(c)
            if isinstance(c, Stop) and c.gap(q) <= 0 and dot(c.row(q), v) <= 0:
                self.take(c)
            if isinstance(c, Crossing):
                c.below = c.value(q) < 0
        self.settle()

    def to(self, until):
        """Integrates to the time `until`."""
        while self.t < until:
            span = min(self.span, until - self.t)
            end = self.advance(self.y, span)
            if not self.due(end):
                for c in self.contacts:
                    if isinstance(c, Crossing) and c.value(end[:self.n]) < 0:
                        c.below = True
                self.y, self.t = end, (until if span == until - self.t else self.t + span)
                continue
            low, high = 0.0, span
            while high - low > LAST:
                middle = 0.5 * (low + high)
                if self.due(self.advance(self.y, middle)):
                    high = middle
                else:
                    low = middle
            self.y = self.advance(self.y, high)
            self.t += high
            for c in self.due(self.y):
                self.log.append((self.t, c, c.mode))
                self.take(c)
