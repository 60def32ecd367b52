# rows.awk: splits claims.rows, whose format stands at its head, into files below `into`:
#   N.command   a command; a command that several rows share comes once
#   N.take      the awk program of a row, after the functions and rules below
#   list        a line for each row: its number, and the names of its commands' outputs
#   rows        a line for each row, with tabs between: section, claim, theirs, within, digits, verdict, note, commands
BEGIN {
    known = " section claim theirs within digits run take verdict note "
    prelude = \
        "function abs(x) { return x < 0 ? -x : x }\n" \
        "function most(x, y) { return x > y ? x : y }\n" \
        "# how far the final states of the first two runs are apart, of each number\n" \
        "function apart(    k, worst) {\n" \
        "    for (k in names) if ((1, k) in v && (2, k) in v)\n" \
        "        worst = most(worst, abs(v[1, k] - v[2, k]) / most(1e-300, most(abs(v[1, k]), abs(v[2, k]))))\n" \
        "    return worst\n" \
        "}\n" \
        "FNR == 1 { run++; rows = 0 }\n" \
        "/^  [A-Za-z]/ && $3 ~ /^[-+]?[0-9]/ { v[run, $2] = $3; names[$2] } # a run's summary\n" \
        "/^  (param|input|angle|real) / { p[$4] = $6 } # of `whirl describe`, in SI\n" \
        "/drifts by at most/ { d = $0; sub(/.*drifts by at most /, \"\", d); drift = most(drift, d + 0) }\n" \
        "/^[-0-9.e+]+,/ { rows++; n = split($0, part, \",\"); for (i = 1; i <= n; i++) cell[run, rows, i] = part[i] }\n"
}
function fail(why) { print "error: " FILENAME ":" NR ": " why > "/dev/stderr"; bad = 1; exit 1 }
function finish(    i, one, names, count) {
    if (!("claim" in f)) return
    if (section == "" || !("theirs" in f)) fail("a row needs section, claim and theirs")
    if (("verdict" in f) == ("take" in f)) fail("a row needs either take, or a verdict that no number decides")
    if ("verdict" in f && f["verdict"] != "opinion" && f["verdict"] != "not yet") fail("a verdict is computed, or opinion, or not yet")
    if ("take" in f && !("run" in f)) f["run"] = before
    if ("take" in f && f["run"] == "") fail("take without run")
    if ("run" in f) before = f["run"]
    row++
    if (!("digits" in f)) f["digits"] = f["theirs"] !~ /[1-9]/ && f["within"] !~ /%/ && f["within"] + 0 < 1e-7 ? 2 : 4
    count = split(f["run"], one, "\n")
    for (i = 1; i <= count; i++) {
        if (!(one[i] in number)) {
            number[one[i]] = sprintf("%04d.command", ++commands)
            print one[i] > (into number[one[i]])
            close(into number[one[i]])
        }
        names = names " " number[one[i]] ".said"
    }
    if ("take" in f) print prelude f["take"] > (into row ".take")
    close(into row ".take")
    print row ("take" in f ? names : "") > (into "list")
    gsub(/\n/, "`<br>`", f["run"])
    printf "%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\n", section, f["claim"], f["theirs"], f["within"], f["digits"], f["verdict"], f["note"],
        f["run"] > (into "rows")
    split("", f)
}
/^#/ || NF == 0 { next }
{
    key = $1
    text = $0
    sub(/^[a-z]+ +/, "", text)
    if (index(known, " " key " ") == 0) fail("no such field: " key)
    if (key == "section" || (key == "claim" && "theirs" in f)) finish()
    if (key == "section") { section = text; next }
    if (key == "claim" && match(text, / = [^=]*$/)) {
        if ("claim" in f) f["claim"] = f["claim"] " " substr(text, 1, RSTART - 1)
        else f["claim"] = substr(text, 1, RSTART - 1)
        key = "theirs"
        text = substr(text, RSTART + 3)
    }
    if (key == "theirs" && match(text, / within /)) {
        f["within"] = substr(text, RSTART + RLENGTH)
        text = substr(text, 1, RSTART - 1)
    }
    if (!(key in f)) f[key] = text
    else if (key == "claim" || key == "note") f[key] = f[key] " " text
    else if (key == "run" || key == "take") f[key] = f[key] "\n" text
    else fail(key " twice")
}
END { if (!bad) finish() }
