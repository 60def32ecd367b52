# scenes.awk: writes random smooth mechanisms with a scene each, for counting steps: awk -v n=N -v seed=S -f scenes.awk
# </dev/null. With -v rest=1, a part of each mechanism does not accelerate: it rests, moves evenly, falls freely, or lies at
# a place without force, beside a part that swings. (Software arithmetic takes less time for zeros.) With -v flies=1, no
# part swings: all accelerations are constants, which compilers fold away.
#
# There are ten families in turn, so that the classes of work occur in other proportions than in the built-in scenes: masses
# in a row with springs (no sine), a cart with pendulums, arms that carry each other with springs between them (angles in
# radians), particles in potentials of functions, first-order systems, wheels on one shaft; linear mechanisms of second and
# of first order (a step is one matrix); masses in a row that an unbalanced wheel shakes (tables of one angle), and
# first-order systems with turn angles. Of the first six, every third has a ledger, every second outputs. The random
# numbers come from a generator in this file, so that every awk writes the same files.
function draw(bound) { # Park and Miller, Random number generators: good ones are hard to find, 1988
    state = (state * 16807) % 2147483647
    return int(state / 2147483647 * bound)
}
function number(least, most) { return sprintf("%.3f", least + (most - least) * draw(10000) / 10000) }
function say(text) { print text }

function row_of_masses(k,    i, T, V, F) {
    for (i = 1; i <= k; i++) {
        say("coordinate x" i " [m]")
        T = T " + " number(0.2, 3) " [kg]*x" i "'^2/2"
        V = V " + " number(5, 90) " [N/m]*(x" i (i > 1 ? " - x" (i - 1) : "") ")^2/2"
        if (draw(3) == 0) { V = V " + " number(1, 40) " [N/m^3]*x" i "^4/4*1 [1/m]" }
        if (draw(2) == 0) { F = F " + " number(0.1, 2) " [N*s/m]*x" i "'^2/2" }
        if (draw(5) == 0) { F = F " + " number(0.1, 2) " [N*s^2/m^2]*abs(x" i "')^3/3" }
        if (draw(4) == 0) { V = V " + " number(1, 9) " [J]*max(x" i "/1 [m], 0)^2" }
    }
    gsub(/\[N\/m\^3\]/, "[N/m^2]", V)
    energies(T, V, F)
    start("x", k, "[m]")
}

function cart(k,    i, T, V, F) {
    say("coordinate x [m]")
    T = " + " number(1, 5) " [kg]*x'^2/2"
    for (i = 1; i <= k; i++) {
        say("coordinate a" i " [rad]")
        say("parameter l" i " = " number(0.2, 0.9) " [m]")
        say("parameter m" i " = " number(0.1, 0.9) " [kg]")
        T = T " + m" i "*((x' + l" i "*a" i "'*cos(a" i "))^2 + (l" i "*a" i "'*sin(a" i "))^2)/2"
        V = V " - m" i "*9.81 [m/s^2]*l" i "*cos(a" i ")"
        if (draw(2) == 0) { F = F " + " number(0.01, 0.1) " [N*m*s]*a" i "'^2/2" }
    }
    if (draw(2) == 0) { V = V " + " number(5, 50) " [N/m]*x^2/2" }
    energies(T, V, F)
    start("a", k, "[rad]")
}

function arms(k,    i, T, V, F, x, y) {
    for (i = 1; i <= k; i++) { say("coordinate a" i " [rad]") }
    for (i = 1; i <= k; i++) {
        x = x (i > 1 ? " + " : "") number(0.2, 0.5) " [m]*a" i "'*cos(a" i ")"
        y = y (i > 1 ? " + " : "") number(0.2, 0.5) " [m]*a" i "'*sin(a" i ")"
        say("let u" i " = " x)
        say("let v" i " = " y)
        T = T " + " number(0.2, 0.8) " [kg]*(u" i "^2 + v" i "^2)/2 + " number(0.01, 0.05) " [kg*m^2]*a" i "'^2/2"
        V = V " + " number(0.5, 3) " [J]*" (draw(2) ? "cos" : "sin") "(" (draw(3) == 0 ? "2*" : "") "a" i ")"
        if (draw(4) == 0) { V = V " + " number(0.5, 3) " [J]*(a" i (i > 1 ? " - a" (i - 1) : "") ")^2/2" }
    }
    energies(T, V, F)
    start("a", k, "[rad]")
}

function particles(k,    i, T, V, F, f, which) {
    split("exp log sqrt tanh atan sinh cosh asin acos tan atan2 pow", f, " ")
    for (i = 1; i <= k; i++) {
        say("coordinate x" i " [m]")
        T = T " + " number(0.2, 3) " [kg]*x" i "'^2/2"
        V = V " + " number(5, 90) " [N/m]*x" i "^2/2"
        which = draw(13)
        if (which < 12) { V = V " + " number(0.1, 2) " [J]*" of(f[which + 1], i, k) }
        else { V = V " + " number(0.1, 2) " [J]/(2 + (x" i "/1 [m])^2)" }
        if (draw(3) == 0) { V = V " + " number(0.1, 2) " [J]*sin(x" i "/1 [m])" }
        if (draw(3) == 0) { F = F " + " number(0.1, 2) " [N*s/m]*x" i "'^2/2" }
    }
    energies(T, V, F)
    start("x", k, "[m]")
}
function of(name, i, k,    x) {
    x = "x" i "/1 [m]"
    if (name == "atan2") { return "atan2(" x ", 2 + (x" (i % k + 1) "/1 [m])^2)" }
    if (name == "pow") { return "(2 + (" x ")^2)^(0.3 + " x ")" }
    if (name == "log" || name == "sqrt") { return name "(2 + (" x ")^2)" }
    if (name == "asin" || name == "acos") { return name "(" x "/4)" }
    return name "(" x ")"
}

function first_order(k,    i, j, e) {
    for (i = 1; i <= k; i++) { say("state z" i) }
    say("parameter rate = 1 [1/s]")
    say("input drive = 0.4")
    for (i = 1; i <= k; i++) {
        e = "rate*(-" number(0.3, 2) "*z" i
        for (j = draw(3); j >= 0; j--) {
            e = e " + " number(0.1, 1) "*z" (draw(k) + 1) (draw(2) ? "*z" (draw(k) + 1) : "")
        }
        if (draw(3) == 0) { e = e " + drive" }
        if (draw(4) == 0) { e = e " + sin(z" (draw(k) + 1) ")" }
        if (draw(4) == 0) { e = e "/(2 + z" (draw(k) + 1) "^2)" }
        say("equation z" i "' = " e ")")
    }
    for (i = 1; i <= k; i++) { starts = starts (i > 1 ? ", " : "") "z" i " = " number(0.05, 0.4) }
    say("scene " name " {\n  start " starts "\n  step 1 [ms]\n  until 1 [s]\n}")
    starts = ""
}

function wheels(k,    i, T, V, F) {
    for (i = 1; i <= k; i++) {
        say("coordinate a" i " [rad]")
        T = T " + " number(0.2, 3) " [kg*m^2]*a" i "'^2/2"
        V = V " + " number(0.2, 3) " [J]*cos(" (i > 1 && draw(2) ? "a" i " - a" (i - 1) : "a" i) ")"
        if (draw(2) == 0) { F = F " + " number(0.01, 0.1) " [N*m*s]*a" i "'^2/2" }
    }
    say("input M = 0.5 [N*m]")
    say("Q(a1) = M")
    energies(T, V, F)
    start("a", k, "[rad]")
}

function linear(k,    i, T, V, F) {
    say("input push = 0.7 [N]")
    for (i = 1; i <= k; i++) {
        say("coordinate x" i " [m]")
        T = T " + " number(0.2, 3) " [kg]*x" i "'^2/2"
        if (i == 1 || draw(4) > 0) { V = V " + " number(5, 90) " [N/m]*(x" i (i > 1 ? " - x" (i - 1) : "") ")^2/2" }
        if (draw(2) == 0) { F = F " + " number(0.1, 2) " [N*s/m]*(x" i "'" (i > 1 && draw(2) ? " - x" (i - 1) "'" : "") ")^2/2" }
    }
    if (draw(2) == 0) { V = V " - " number(0.2, 3) " [kg]*9.81 [m/s^2]*x" k }
    if (draw(2) == 0) { say("Q(x" 1 + draw(k) ") = push") }
    bookless = 1
    energies(T, V, F)
    start("x", k, "[m]")
}

function linear_first_order(k,    i, j, e) {
    for (i = 1; i <= k; i++) { say("state z" i) }
    say("parameter rate = 1 [1/s]")
    say("input drive = 0.4")
    for (i = 1; i <= k; i++) {
        e = "rate*(-" number(0.3, 2) "*z" i
        for (j = draw(4); j > 0; j--) { e = e " + " number(0.1, 1) "*z" (draw(k) + 1) }
        if (draw(3) == 0) { e = e " + " number(0.1, 2) "*drive" }
        say("equation z" i "' = " e ")")
    }
    for (i = 1; i <= k; i++) { starts = starts (i > 1 ? ", " : "") "z" i " = " number(0.05, 0.4) }
    say("scene " name " {\n  start " starts "\n  step 1 [ms]\n  until 1 [s]\n}")
    starts = ""
}

function shaken(k,    i, T, V, F) {
    say("coordinate a [rad]")
    say("parameter l = " number(0.2, 0.9) " [m]")
    say("parameter m = " number(0.1, 0.9) " [kg]")
    say("input M = 0.3 [N*m]")
    T = " + m*((x1' + l*a'*cos(a))^2 + (l*a'*sin(a))^2)/2 + " number(0.01, 0.1) " [kg*m^2]*a'^2/2"
    V = " - m*9.81 [m/s^2]*l*cos(a)"
    for (i = 1; i <= k; i++) {
        say("coordinate x" i " [m]")
        T = T " + " number(0.5, 4) " [kg]*x" i "'^2/2"
        if (draw(4) > 0) { V = V " + " number(5, 90) " [N/m]*(x" i (i > 1 ? " - x" (i - 1) : "") ")^2/2" }
        if (draw(2) == 0) { F = F " + " number(0.1, 2) " [N*s/m]*x" i "'^2/2" }
    }
    if (draw(2) == 0) { say("Q(a) = M") }
    if (draw(3) == 0) { V = V " + " number(0.1, 2) " [J]*sin(2*a)" }
    bookless = 1
    energies(T, V, F)
    start("x", k, "[m]", "a = " number(0.1, 0.9) " [rad], a' = " number(1, 9) " [rad/s], ")
}

function first_order_turning(k,    i, e) {
    for (i = 1; i <= k; i++) { say("state b" i " [rad]") }
    say("state z")
    say("parameter rate = 1 [1/s]")
    for (i = 1; i <= k; i++) {
        e = "rate*(" number(0.3, 2) " [rad] + " number(0.1, 1) " [rad]*" (draw(2) ? "sin" : "cos") "(b" (draw(k) + 1) ")"
        if (draw(2)) { e = e "*z" }
        if (draw(3) == 0) { e = e " + " number(0.1, 1) " [rad]*sin(b" i (i > 1 ? " - b" (i - 1) : "") ")" }
        say("equation b" i "' = " e ")")
    }
    say("equation z' = rate*(" number(0.1, 1) "*cos(b1) - " number(0.3, 2) "*z)")
    for (i = 1; i <= k; i++) { starts = starts "b" i " = " number(0.1, 0.9) " [rad], " }
    say("scene " name " {\n  start " starts "z = " number(0.05, 0.4) "\n  step 1 [ms]\n  until 1 [s]\n}")
    starts = ""
}

# A part of mechanism `rest`: kind 0 swings, 1 rests, 2 moves evenly, 3 falls, 4 rests at the end of a slack spring, 5
# is tied to the first part.
function resting(k,    i, T, V, F, kind, turns, x) {
    for (i = 1; i <= k; i++) {
        kind = i == 1 ? (draw(3) ? 0 : 3) : draw(6)
        turns = i > 1 && kind < 5 && draw(3) == 0
        x = (turns ? "a" : "x") i
        say("coordinate " x (turns ? " [rad]" : " [m]"))
        T = T " + " number(0.2, 3) (turns ? " [kg*m^2]*" : " [kg]*") x "'^2/2"
        if (turns) {
            if (kind == 0 || kind == 4) { V = V " - " number(0.2, 3) " [J]*cos(" x ")" }
            if (kind == 3) { V = V " - " number(0.2, 3) " [J]*" x }
        } else {
            if (kind == 0 || kind == 4) { V = V " + " number(5, 90) " [N/m]*" x "^2/2" }
            if (kind == 3) { V = V " + " number(0.2, 3) " [kg]*9.81 [m/s^2]*" x }
            if (kind == 5) { V = V " + " number(5, 90) " [N/m]*(" x " - x1)^2/2" }
        }
        if (draw(3) == 0) { F = F " + " number(0.1, 2) (turns ? " [N*m*s]*" : " [N*s/m]*") x "'^2/2" }
        starts = starts (i > 1 ? ", " : "") x " = " (kind == 4 || draw(4) == 0 && kind != 0 ? "0" : number(0.1, 0.5)) (turns ? " [rad]" : " [m]")
        if (kind == 2) { starts = starts ", " x "' = " number(0.5, 3) (turns ? " [rad/s]" : " [m/s]") }
    }
    energies(T, V, F)
    say("scene " name " {\n  start " starts "\n  step 1 [ms]\n  until 1 [s]\n}")
    starts = ""
}

# A mechanism whose parts all fall, roll down or move evenly.
function flying(k,    i, T, V, turns, x) {
    for (i = 1; i <= k; i++) {
        turns = draw(3) == 0
        x = (turns ? "a" : "x") i
        say("coordinate " x (turns ? " [rad]" : " [m]"))
        T = T " + " number(0.2, 3) (turns ? " [kg*m^2]*" : " [kg]*") x "'^2/2"
        if (draw(2) == 0) { V = V " + " number(0.2, 3) (turns ? " [J]*" : " [kg]*9.81 [m/s^2]*") x }
        starts = starts (i > 1 ? ", " : "") x " = " number(0.1, 0.5) (turns ? " [rad]" : " [m]")
        if (draw(3) > 0) { starts = starts ", " x "' = " number(0.5, 3) (turns ? " [rad/s]" : " [m/s]") }
    }
    energies(T, V)
    say("scene " name " {\n  start " starts "\n  step 1 [ms]\n  until 1 [s]\n}")
    starts = ""
}

function energies(T, V, F) {
    say("T =" substr(T, 3))
    if (V != "") { say("V = 0 [J]" V) }
    if (F != "") { say("F =" substr(F, 3)) }
}

function start(letter, k, unit, more,    i) {
    for (i = draw(3); i > 0; i--) { say("output o" i " = " letter "1^" i "/(1 " unit ")^" i) }
    printf("scene %s {\n%s  step 1 [ms]\n  until 1 [s]\n  start ", name, (!bookless && draw(3) == 0 ? "  with ledger\n" : ""))
    bookless = 0
    printf("%s", more)
    for (i = 1; i <= k; i++) { printf("%s%s%d = %s %s", (i > 1 ? ", " : ""), letter, i, number(0.1, 0.5), unit) }
    print("\n}")
}

BEGIN {
    if (n !~ /^[1-9][0-9]*$/ || seed !~ /^[1-9][0-9]*$/) {
        print "scenes.awk: error: n=" n " seed=" seed ": two numbers, 1 or more" > "/dev/stderr"
        exit 2
    }
    state = seed * 7919 + 1
    for (i = 0; i < 10; i++) { draw(2) }
    for (s = 1; s <= n; s++) {
        name = (flies ? "p" : rest ? "q" : "r") seed "_" s
        print "mechanism " (flies ? "u" : rest ? "v" : "w") seed "_" s " \"Drawn at random\""
        size = 1 + draw(draw(4) == 0 ? 6 : 3)
        if (flies) { flying(size) }
        else if (rest) { resting(size + 1) }
        else if (s % 10 == 0) { row_of_masses(size + draw(3)) }
        else if (s % 10 == 1) { cart(size) }
        else if (s % 10 == 2) { arms(size > 3 ? 3 : size) }
        else if (s % 10 == 3) { particles(size) }
        else if (s % 10 == 4) { first_order(size + draw(4)) }
        else if (s % 10 == 5) { wheels(size) }
        else if (s % 10 == 6) { linear(size + draw(3)) }
        else if (s % 10 == 7) { shaken(size) }
        else if (s % 10 == 8) { linear_first_order(size + draw(4)) }
        else { first_order_turning(size) }
    }
}
