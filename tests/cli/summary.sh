#!/bin/sh
# summary.sh: the summary of `whirl run`: a sentence, findings, then numbers; the same run has the same summary. The
# sentence is compared with the run's records. Scenes are random: WHIRL_SEED, WHIRL_CASES.
. "$(dirname "$0")/../checks.sh"

seed=${WHIRL_SEED:-45}
"$whirl" list | awk '$1 == "scene" { print $2 }' >"$scratch/scenes"
awk -v seed="$seed" 'BEGIN { srand(seed) } { print rand(), $0 }' "$scratch/scenes" | sort | awk '{ print $2 }' |
    head -n "${WHIRL_CASES:-3}" >"$scratch/drawn"
echo epicyclic_from_rest >>"$scratch/drawn"
stays=0

# its_way FILE: compares the sentence with the first and last row of the records, and their extremes
its_way() {
    awk -F, -v sentence="$(head -n 1 "$scratch/out")" '
        { sub(/\r$/, "") }
        NR == 1 { for (i = 1; i <= NF; i++) { split($i, part, " "); column[part[1]] = i; name[i] = part[1] } next }
        { for (i = 1; i <= NF; i++) { if (NR == 2) { first[i] = $i; low[i] = high[i] = $i }
              last[i] = $i; if ($i < low[i]) { low[i] = $i } if ($i > high[i]) { high[i] = $i } } }
        function near(a, b,   d) { d = a - b; return (d < 0 ? -d : d) <= 0.0051 * (a < 0 ? -a : a) + 1e-300 }
        END {
            sub(/^The momentum of .* (within [^ ]*|it is conserved)[.] /, "", sentence)
            if (sentence == "Nothing moves.") { exit !(NR > 2) }
            n = split(sentence, part, /,? and [0-9]+ more moves?|, /)
            for (i = 1; i <= n; i++) {
                words = split(part[i], word, " ")
                if (words <= 1) { continue }
                at = word[2] == "stays" || word[2] == "moves" ? 3 : 2
                c = column[word[1]]
                range = high[c] - low[c]
                way = last[c] < first[c] ? first[c] - last[c] : last[c] - first[c]
                if (word[at] == "at") {
                    bound = word[at + 4]
                    good = near(first[c], word[at + 1]) && high[c] - first[c] <= bound && first[c] - low[c] <= bound
                } else if (word[at] == "between") {
                    good = near(low[c], word[at + 1]) && near(high[c], word[at + 4]) && 2 * way < range
                } else {
                    good = word[at] == "from" && near(first[c], word[at + 1]) && near(last[c], word[at + 4]) && 2 * way >= range
                }
                if (!c || !good) { exit 1 }
                found++
            }
            exit !found
        }' "$1"
}

while read -r scene; do
    "$whirl" run "$scene" --csv "$scratch/run.csv" >"$scratch/out" 2>"$scratch/err"
    "$whirl" run "$scene" >"$scratch/again" 2>/dev/null
    cmp -s "$scratch/out" "$scratch/again"
    verdict $? "$scene: the same run has the same summary"
    head -n 1 "$scratch/out" | grep -q '^[A-Za-z].*\.$' && its_way "$scratch/run.csv"
    verdict $? "$scene: $(head -n 1 "$scratch/out")" "$scratch/out"
    awk '/^trusted/ { trusted = NR } /^final state/ { state = NR } END { exit !(state > 2 && trusted < state) }' "$scratch/out"
    verdict $? "$scene: what is to be said stands above the numbers"
    # a name proves nothing: an output with another name is reported in the same words
    sed 's/_cm\>/_qq/g' "$(grep -l "^scene $scene\>" core/models/*.whirl)" >"$scratch/renamed.whirl"
    "$whirl" run "$scratch/renamed.whirl:$scene" 2>/dev/null | head -n 1 >"$scratch/again"
    head -n 1 "$scratch/out" | sed 's/_cm /_qq /g' | cmp -s - "$scratch/again"
    verdict $? "$scene: the sentence without the name of a centre of mass" "$scratch/again"
    head -n 1 "$scratch/out" | grep -q 'stays at' && stays=$((stays + 1))
done <"$scratch/drawn"
[ "$stays" -gt 0 ]
verdict $? "$stays scenes with something that stays"

# A random cart with a bob, with random steps. Its momentum "stays" only within a part of the sum of its terms, which
# the records show: always if it is below 0.0005 of the sum, never above 0.002.
words=
for case in $(seq 1 16); do
    awk -v seed="$seed$case" 'BEGIN { srand(seed); M = exp(9 * rand() - 2); m = exp(2 * rand() - 1); l = 0.2 + rand()
        print "mechanism drawn\ncoordinate x [m]\ncoordinate a [rad]"
        printf "T = %.6g [kg]*x\047^2/2 + %.6g [kg]*((x\047 + %.6g [m]*a\047*cos(a))^2 + (%.6g [m]*a\047*sin(a))^2)/2\n", M, m, l, l
        printf "V = -%.6g [N*m]*cos(a)\nscene s { start a = %.6g [rad], x\047 = %.6g [m/s]; step %.3g [s]; until 5 [s] }\n",
            9.81 * m * l, 0.3 + 2 * rand(), rand() < 0.5 ? 0 : rand(), exp(-3.5 + 2 * rand()) * sqrt(l)
        print M, m, l >"/dev/stderr" }' >"$scratch/drawn.whirl" 2>"$scratch/masses"
    "$whirl" run "$scratch/drawn.whirl" --csv "$scratch/drawn.csv" >"$scratch/out" 2>/dev/null
    word=$(sed -n '1s/^The momentum of x \([a-z]*\) .*/\1/p' "$scratch/out")
    words="$words $word"
    awk -F, -v word="$word" -v of="$(cat "$scratch/masses")" 'function size(x) { return x < 0 ? -x : x }
        NR > 1 { split(of, mass, " "); bob = mass[2] * mass[3] * $5 * cos($3); cart = (mass[1] + mass[2]) * $4
            if (NR == 2) { first = cart + bob }
            if (size(cart + bob - first) > drift) { drift = size(cart + bob - first) }
            if (size(cart) + size(bob) > terms) { terms = size(cart) + size(bob) } }
        END { print drift / terms, word; exit !(word == "stays" ? drift <= 0.002 * terms : word == "drifts" && drift > 0.0005 * terms) }' \
        "$scratch/drawn.csv" >"$scratch/ratio"
    verdict $? "drawn cart $case: drift over the sum of the terms, and the word: $(cat "$scratch/ratio")" "$scratch/out"
done
case $words in *stays*drifts* | *drifts*stays*) true ;; *) false ;; esac
verdict $? "both words were drawn" "$scratch/out"

# an error that no step reaches is refused within seconds of processor time, or ten times that
# if instrumented
seconds=5
[ -z "${WHIRL_FEW:-}" ] || seconds=50
for digits in 20 90 300; do
    (ulimit -t $seconds && "$whirl" run epicyclic_from_rest --error "X=1e-${digits}m") >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 1 ] && grep -q 'no tried step stays within --error.*, because of round-off' "$scratch/err" && [ ! -s "$scratch/out" ]
    verdict $? "an error of 1e-$digits m is refused because of round-off" "$scratch/err"
done
exit $failed
