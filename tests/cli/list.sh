#!/bin/sh
# list.sh: `whirl list --as table` against a file with known items, and uses of its names: --with and --without all,
# --without conserve, --name.
. "$(dirname "$0")/../checks.sh"
regex=-E


# --- the table: generated files, of which everything is known ---------------------------------------------
seed=${WHIRL_SEED:-11}
cases=${WHIRL_CASES:-30}
bad=0
for number in $(seq "$cases"); do
    awk -v seed="$seed$number" -v file="$scratch/m.whirl" -v wanted="$scratch/wanted" '
        function put(line) { print line >file; at++ }
        function pick(n) { return int(n * rand()) }
        function row(kind, name, first, last, effects, holds, step, until, title) {
            rows[++count] = kind "\t" name "\t" "m" k "\t" file "\t" first "\t" last "\t" effects "\t" holds "\t" step "\t" until "\t" title
        }
        function blank() { if (pick(2)) put("") ; if (pick(3) == 0) put("# { a brace in a comment") }
        function ends(line) { if (mine) sub(/\t[0-9]+\t[0-9]+\t/, "\t" first "\t" line "\t", rows[mine]) }
        BEGIN {
            srand(seed)
            for (k = 1; k <= 1 + pick(3); k++) {
                blank()
                title = pick(2) ? "a } in a title" : ""
                put("mechanism m" k (title ? " \"" title "\"" : ""))
                ends(at - 1)
                first = at
                put("coordinate x [m]")
                put("coordinate y [m]")
                put("T = 1 [kg]*(x'"'"'^2 + y'"'"'^2)/2")
                put("output o [m] = x")
                n = pick(4)
                names = ""
                mine = count + 1
                row("mechanism", "m" k, first, first, "", "terms", "-", "-", title ? title : "-")
                for (i = 1; i <= n; i++) {
                    blank()
                    holds = ""
                    put("effect e" i " \"{ effect\" {" (pick(2) ? "" : " # }"))
                    from = at
                    if (pick(2)) { put("  V += 1 [N/m]*x^2/2"); holds = "terms" }
                    if (pick(2)) { put("  stop x >= -" i " [m] restitution 0"); holds = holds (holds ? "," : "") "contacts" }
                    if (i == 1 && pick(2)) { put("  noise o deviation 1 [mm] seed 1"); holds = holds (holds ? "," : "") "noise" }
                    put(pick(2) ? "}" : "  parameter p" i " = 1; }")
                    row("effect", "e" i, from, at, "-", holds == "" ? "-" : holds, "-", "-", "{ effect")
                    names = names (names ? "," : "") "e" i
                }
                sub(/\t[0-9]+\t[0-9]+\t/, "&" (names ? names : "-"), rows[mine])
                for (i = 1; i <= pick(3); i++) {
                    blank()
                    put("scene s" k "_" i " {")
                    from = at
                    with = ""
                    if (n > 0 && pick(2)) { put("  with e" n); with = "e" n }
                    if (pick(2)) { put("  with ledger"); with = with (with ? "," : "") "ledger" }
                    conserve = pick(2)
                    if (conserve) put("  conserve y")
                    ms = 1 + pick(9)
                    put("  step " ms " [ms]; until " i " [s]")
                    put("}")
                    row("scene", "s" k "_" i, from, at, with ? with : "-", conserve ? "conserve" : "-", ms / 1000, i, "-")
                }
            }
            ends(at)
            for (i = 1; i <= count; i++) print rows[i] >wanted
        }'
    "$whirl" list --as table "$scratch/m.whirl" >"$scratch/got" 2>"$scratch/err" || bad=1
    sed 1d "$scratch/got" | cmp -s - "$scratch/wanted" || bad=1
    [ $bad -eq 0 ] || { diff "$scratch/wanted" "$scratch/got" >>"$scratch/err"; break; }
done
verdict $bad "every line of $cases generated files (seed $seed)"

"$whirl" list --as table >"$scratch/table" 2>"$scratch/err" &&
    awk -F '\t' 'NF != 11 { bad = 1 } NR == 1 { bad = bad || $1 != "kind" } END { exit bad || NR < 100 }' "$scratch/table"
verdict $? "eleven fields a line"
"$whirl" list >"$scratch/text"
awk -F '\t' '$1 == "mechanism" || $1 == "scene" { print $1, $2 }' "$scratch/table" >"$scratch/names"
awk '{ print $1, $2 }' "$scratch/text" | cmp -s - "$scratch/names"
verdict $? "the same mechanisms and scenes as text"
"$whirl" list core/models/*.whirl --as=table | cmp -s - "$scratch/table"
verdict $? "the built-in models are their files"
# File names and titles contain characters that would end a field or a line, and their escapes.
names=$(awk -v seed="$seed" 'BEGIN {
    srand(seed)
    split("\\\\t \\\\n \\\\r \\\\\\\\ t n \\\\\\\\t \\042 %s", part, " ")
    for (k = 0; k < 12; k++) {
        name = ""
        for (i = 1 + int(5 * rand()); i > 0; i--) name = name part[1 + int(9 * rand())]
        print name
    }
}')
bad=0
for name in $names; do
    mkdir -p "$scratch/odd"
    file=$(printf '%bx' "$scratch/odd/$name.whirl") # a name may end in characters that $() removes
    file=${file%x}
    tab=$(printf '\t')
    printf 'mechanism m "a%sand \\ b"\ncoordinate x [m]\nT = 1 [kg]*x'"'"'^2\neffect e "" {\n}\nscene s {\n}\n' "$tab" >"$file" &&
        "$whirl" list --as table "$file" >"$scratch/got" 2>"$scratch/err" || bad=1
    [ "$(awk -F '\t' 'NF == 11' "$scratch/got" | wc -l)" -eq 4 ] && [ "$(wc -l <"$scratch/got")" -eq 4 ] || bad=1
    printf '%bx' "$(sed -n 2p "$scratch/got" | cut -f 4)" >"$scratch/name"
    printf '%sx' "$file" | cmp -s - "$scratch/name" || bad=1
    [ "$(sed -n 2p "$scratch/got" | cut -f 11)" = 'a\tand \\ b' ] || bad=1
    [ $bad -eq 0 ] || { cat "$scratch/got" >>"$scratch/err"; break; }
done
verdict $bad "names of files and titles with ends of fields and lines in them (seed $seed)"
exits 2 "there is no form 'csv'" list --as csv
exits 2 'is a part of a file' list core/models/cuff.whirl:cuff --as table
exits 2 'unknown option' list --table

# --- all effects, and none ---------------------------------------------------------------------------------
# code WORD...: prints the C without its first line, which names the file
code() { "$whirl" derive "$@" --as c; }
same() { # same WHAT "WORDS" "WORDS": both give the same code
    code $2 >"$scratch/one" 2>"$scratch/err" && code $3 >"$scratch/two" 2>>"$scratch/err" &&
        cmp -s "$scratch/one" "$scratch/two"
    verdict $? "$1"
}
same "all effects by one word" "ball_bounces --with all" "ball_bounces --with ceiling,air"
same "all but one" "ball_bounces --with all --without air" "ball_bounces --with ceiling"
same "none but one, whatever the order" "ball_in_air --with ceiling --without all" "ball_in_air --without air,floor --with ceiling"
same "none" "ball_in_air --without=all" "ball_in_air --without floor,air"
same "the ledger is not among all" "ball_bounces --without all --with ledger" "ball_bounces --without floor --with ledger"
exits 2 'contradict each other' derive ball_bounces --with all --without all --as c
same "a name that --with repeats" "ball_bounces --with all,all,air" "ball_bounces --with all"

# --- conserve ----------------------------------------------------------------------------------------------
cat >"$scratch/slide.whirl" <<'END'
mechanism slide
coordinate x [m]
coordinate y [m]
T = 1 [kg]*(x'^2 + y'^2 + x'*y')/2
V = 4 [N/m]*x^2/2
effect drag { F += 1 [N*s/m]*y'^2/2 }
scene kept { start x = 1 [m]; conserve y; step 1 [ms]; until 1 [s] }
scene moved { start x = 1 [m]; step 1 [ms]; until 1 [s] }
END
exits 2 'hint: .*--without conserve' derive "$scratch/slide.whirl:kept" --with drag --as c
same "integrated after all" "$scratch/slide.whirl:kept --without conserve --name moved" "$scratch/slide.whirl:moved"
for number in float double; do
    "$whirl" run "$scratch/slide.whirl:kept" --without conserve --with drag --number $number | sed -n '/^state hash/p' >"$scratch/one"
    "$whirl" run "$scratch/slide.whirl:moved" --with drag --number $number | sed -n '/^state hash/p' | cmp -s - "$scratch/one" && [ -s "$scratch/one" ]
    verdict $? "and run so, in $number"
done
"$whirl" sweep "$scratch/slide.whirl:kept" --without conserve --with drag --over x=1..2:2 --csv - --quiet >"$scratch/one" 2>"$scratch/err"
"$whirl" sweep "$scratch/slide.whirl:moved" --with drag --over x=1..2:2 --csv - --quiet 2>>"$scratch/err" | cmp -s - "$scratch/one" && [ -s "$scratch/one" ]
verdict $? "and swept so"
exits 2 '.conserve. is not an effect, so --with cannot add it' derive "$scratch/slide.whirl:kept" --with conserve --as c
for word in all conserve none ledger; do
    printf 'mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'"'"'^2/2\neffect %s { V += 1 [N]*x }\n' "$word" >"$scratch/word.whirl"
    exits 2 "^.*word.whirl:4:8: error: '$word' is a reserved word" derive "$scratch/word.whirl"
done

# --- a name for generated code -----------------------------------------------------------------------------
code thomson_a --name other --header "$scratch/other.h" >"$scratch/other.c" 2>"$scratch/err"
code thomson_a >"$scratch/plain.c"
for code in plain other; do # linked with a header of this name
    sed 's/\bthomson_a\b/other/g; s/\b[a-z_]*_HEADER_[0-9a-f]\{8\}\b/header/; s/SCENE_thomson_a_/SCENE_other_/' "$scratch/$code.c" >"$scratch/$code.words"
done
cmp -s "$scratch/plain.words" "$scratch/other.words" &&
    grep -q 'other_MEMORY_BYTES' "$scratch/other.h" && ! grep -q 'thomson_a_' "$scratch/other.h"
verdict $? "--name: the same code under another name, in the header too"
"$whirl" derive thomson_a --as octave --name other 2>"$scratch/err" | grep -q '^function .*other('
verdict $? "--name: in Octave's form"
exits 2 '.--name. is not a valid name|is not a valid name' derive thomson_a --as c --name 1x
exits 2 'is not a valid name' derive thomson_a --as c --name=
exits 2 'is not a valid name' derive thomson_a --as c --name 'a b'
exits 2 'is not a valid name' derive thomson_a --as c --name "$(printf '%064d' 0 | tr 0 a)"
exits 2 'given twice' derive thomson_a --as c --name a --name b
exits 2 "'int' is a word of C" derive thomson_a --as c --name int
exits 2 'error: --name needs --as octave or c' derive thomson_a --name other

# --- hard cases: sections and scenes of the page, and each scene keeps the verdict ---------------------------
"$whirl" list --hard >"$scratch/hard" 2>"$scratch/err"
sed 1d "$scratch/hard" | awk -F '   *' '{ print $1 >"'"$scratch"'/cases"; n = split($4, scene, " ")
    for (i = 1; i <= n; i++) { print scene[i] "\t" $3 } }' >"$scratch/scenes"
sort "$scratch/cases" >"$scratch/sorted"
awk '/^## / { section = substr($0, 4) } /^\*\*(Hard|Difficulty)\.\*\*/ { print section }' docs/hard_cases.md docs/dev/hard_cases.md | sort |
    diff "$scratch/sorted" - >"$scratch/diff" 2>&1
verdict $? "--hard: a row for each section of a hard case" "$scratch/diff"
{ grep -v '^thomson_a' "$scratch/scenes" | cut -f1; } | sort >"$scratch/named"
for file in docs/hard/*.whirl; do basename "$file" .whirl; done | sort | diff "$scratch/named" - >"$scratch/diff" 2>&1
verdict $? "--hard: every file of docs/hard in one row" "$scratch/diff"
tab=$(printf '\t')
while IFS="$tab" read -r name promised; do
    warned=0
    file=docs/hard/$name.whirl
    [ -f "$file" ] || file=$name
    for each in $([ -f "$file" ] && "$whirl" list "$file" | awk '$1 == "scene" { print $2 }' || echo .); do
        scene=$file:$each
        [ -f "$file" ] || scene=$name
        "$whirl" run "$scene" --strict=off $([ "$scene" = "$file:$each" ] || echo --step 1ms --number float) >"$scratch/out" 2>"$scratch/err"
        status=$?
        if [ $status -ne 0 ]; then is=error
        elif grep -q '^whirl run: warning: ' "$scratch/err" || { [ "$scene" = thomson_a ] && grep -q '^trusted  *until t = ' "$scratch/out"; }; then is=warning
        else is=right; fi
        [ $is != warning ] || warned=1
        case "$is of $promised" in *"of "*$is* | "right of warning"*) true ;; *) false ;; esac
        verdict $? "--hard: $scene is $is, of: $promised"
    done
    case "$promised" in warning*) [ $warned -eq 1 ]; verdict $? "--hard: $name has a warning in one of its scenes" ;; esac
done <"$scratch/scenes"
exits 2 'error: --units, --hard and --figures allow no other option' list --hard thomson_a
exits 2 'error: --units, --hard and --figures allow no other option' list --units --hard
exit $failed
