# draw.awk -v seed=N -v count=N: lines of candidates.awk in an order drawn at random, at most `count`,
# numbered, none twice: a line of code first, all lines alike, then one of its changes.
BEGIN { FS = OFS = "\t" }

{
    place = $1 ":" $2
    if (!(place in index_of)) {
        index_of[place] = places++
    }
    at = index_of[place]
    change[at, changes[at]++] = $0
    all++
}

# Park and Miller's minimal standard: whole numbers below 2^46, the same in every awk.
function next_random() { return state = (state * 16807) % 2147483647 }
function below(n) { return int(next_random() / 2147483647 * n) }

END {
    state = seed % 2147483646 + 1
    for (i = 0; i < 20; i++) {
        next_random()
    }
    for (drawn = 0; drawn < count && drawn < all;) {
        at = below(places)
        which = below(changes[at])
        if (!((at, which) in taken)) {
            taken[at, which] = 1
            print ++drawn, change[at, which]
        }
    }
}
