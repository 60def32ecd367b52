# table.awk -v wanted=N -v row=NAME DRAWN FOUND: prints the score of one row, for the first N mutants in the order
# drawn, and the mutants that survived. Equivalent mutants, which no test can notice, count as survived.
BEGIN { FS = "\t" }
FILENAME == ARGV[1] {
    file[$1] = $2; line[$1] = $3; column[$1] = $4; size[$1] = $5; text[$1] = $6; kind[$1] = $7
    drawn = $1
    next
}
{ came[$1] = $2; by[$1] = $3 }
END {
    for (n = 1; n <= drawn && of["killed"] + of["survived"] < wanted; n++) {
        of[came[n]]++
        if (came[n] == "killed") { endless += by[n] ~ /no end/; crashed += by[n] ~ /crash/ }
        if (came[n] == "survived") left[of["survived"]] = n
    }
    mutants = of["killed"] + of["survived"]
    printf "%s: %d mutants, %d killed (%d by a crash, %d by a time limit), %d survived: %.1f %% (not compiled %d, same objects %d)\n",
        row, mutants, of["killed"], crashed, endless, of["survived"], mutants ? 100 * of["killed"] / mutants : 0, of["refused"],
        of["same"]
    for (i = 1; i <= of["survived"]; i++) {
        n = left[i]
        printf "  %s:%d: %s: %s (%s)\n", file[n], line[n], kind[n], shown(n), by[n] == "0 asked" ? "not reached" : by[n]
    }
}
# Returns the changed line, with the change in brackets.
function shown(n,    all, i) {
    for (i = 0; i < line[n]; i++) if ((getline all < file[n]) <= 0) return ""
    close(file[n])
    all = all " "
    all = substr(all, 1, column[n] - 1) "[" substr(all, column[n], size[n]) " -> " text[n] "]" substr(all, column[n] + size[n])
    sub(/^ +/, "", all)
    return all
}
