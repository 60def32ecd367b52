# choose_draw.awk: requests for `whirl choose`, drawn from a seed (-v seed= -v n=) over the rows of choose_scenes.rows. One line
# each, fields between '|':
#
#   scene|board|horizon or -|column for --of or -|digits of the error|vary or -|rate Hz or -|clock or -|flash or -|RAM or -
#
# The error stands as a part of the largest value; choose_check.sh brings it into the column's unit.
function draw(most) { # a whole number from 0 to most - 1: Lehmer's, the same from any awk
    state = (state * 16807) % 2147483647
    return int(state / 2147483647 * most)
}
function one_of(words, between,    part, count) {
    count = split(words, part, between)
    return part[draw(count) + 1]
}
function maybe(percent, word) { return draw(100) < percent ? word : "-" }
BEGIN {
    state = (seed * 7919 + 12345) % 2147483646 + 1
    for (i = 0; i < 20; i++) { draw(2) }
}
/^#/ || NF == 0 { next }
{ row[++rows] = $0 }
END {
    for (i = 1; i <= n; i++) {
        split(row[draw(rows) + 1], f, "|")
        # boards whose cycles are counted more often: only there a load is one number
        board = one_of("mps2-an386 mps2-an386 mps2-an386 mps2-an385 mps2-an385 mps2-an385-m0 atmega328p atmega328p " \
            "atmega2560 mps2-an500 mps2-an505 rv32imac rv32imafc host", " ")
        # beside these, the program that counts has no room
        if (board == "atmega328p" && f[1] ~ /laskowitz|cuff|plane|pair/) { board = "atmega2560" }
        # and what has contacts is counted in emulators alone, and too large for the small chip
        if (f[5] == "contacts" && board == "host") { board = "mps2-an386" }
        if (f[5] == "contacts" && board == "atmega328p") { board = "atmega2560" }
        horizon = f[5] == "contacts" ? one_of(f[2], " ") : maybe(70, one_of(f[2], " "))
        columns = f[3]
        gsub(/ \[/, "_[", columns)
        of = maybe(55, one_of(columns, " "))
        sub(/_\[/, " [", of)
        error = one_of("1 2 5", " ") "e-" (2 + draw(5))
        vary = f[4] == "" ? "-" : maybe(25, f[4])
        slow = board ~ /^atmega|m0$/
        rate = maybe(70, slow ? one_of("20 25 50 100", " ") : one_of("50 100 120 200 250 300 500 1000", " "))
        clock = board ~ /^atmega/ ? maybe(50, one_of("8MHz 16MHz 20MHz", " ")) \
            : maybe(60, one_of("8MHz 16MHz 48MHz 64MHz 168MHz", " "))
        clock = rate == "-" && clock == "-" ? "16MHz" : clock # what nothing bounds, nobody can try
        flash = board == "host" ? "-" : maybe(35, one_of("16KB 32KB 64KB 128KB", " "))
        ram = board == "host" ? "-" : maybe(30, one_of("1KB 2KB 4KB 20KB", " "))
        print f[1] "|" board "|" horizon "|" of "|" error "|" vary "|" rate "|" clock "|" flash "|" ram
    }
}
