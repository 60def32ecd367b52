# draw.awk -v seed=N -v count=N: prints at most `count` different lines of candidates.awk, numbered, in random order:
# first a line of code is drawn, with equal probabilities, then one of its changes.
BEGIN { FS = OFS = "\t" }
{
    if (!(($1, $2) in index_of)) index_of[$1, $2] = places++
    at = index_of[$1, $2]
    change[at, changes[at]++] = $0
}
# Park and Miller's minimal standard: whole numbers below 2^46, the same in every awk.
function below(n) { state = (state * 16807) % 2147483647; return int(state / 2147483647 * n) }
END {
    state = seed % 2147483646 + 1
    for (i = 0; i < 20; i++) below(1)
    while (drawn < count && drawn < NR) {
        at = below(places)
        which = below(changes[at])
        if (!((at, which) in taken)) {
            taken[at, which]
            print ++drawn, change[at, which]
        }
    }
}
