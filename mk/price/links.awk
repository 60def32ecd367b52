# links.awk: writes a pendulum of n links as a file: awk -v n=N -v scene=1 -f links.awk </dev/null. Angles are
# measured from hanging straight down. Speeds and heights are those of the link above plus the link's own part. With
# `scene`, the file has a scene from rest.
BEGIN {
    if (n !~ /^[1-9][0-9]*$/) {
        print "links.awk: error: n=" n ": a number of links, 1 or more" > "/dev/stderr"
        exit 2
    }
    print "mechanism links_" n " \"Pendulum of " n " links\""
    print "parameter m = 0.5 [kg]\nparameter l = 0.2 [m]\nparameter g = 9.81 [m/s^2]"
    for (k = 1; k <= n; k++) { print "coordinate a" k " [rad]" }
    for (k = 1; k <= n; k++) {
        above = k > 1 ? k - 1 : ""
        print "let x" k " = " (k > 1 ? "x" above " + " : "") "l*a" k "'*cos(a" k ")"
        print "let y" k " = " (k > 1 ? "y" above " + " : "") "l*a" k "'*sin(a" k ")"
        print "let h" k " = " (k > 1 ? "h" above : "") " - l*cos(a" k ")"
        squares = squares (k > 1 ? " + " : "") "x" k "^2 + y" k "^2"
        heights = heights (k > 1 ? " + " : "") "h" k
    }
    print "T = m*(" squares ")/2\nV = m*g*(" heights ")"
    if (scene) {
        print "scene swing_" n " \"From rest\" {\n  step 1 [ms]\n  until 10 [s]"
        for (k = 1; k <= n; k++) { print "  start a" k " = " 20 + 5*k " [deg]" }
        print "}"
    }
}
