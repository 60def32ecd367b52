# checks.sh: what the scripts of tests/cli share, to be sourced. $whirl is the program under test, $scratch a folder
# that is gone at the end; a script ends with `exit $failed`.
set -u

whirl=${WHIRL:-build/whirl}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
failed=0
checks=0

# verdict STATUS WHAT [FILE]: "ok" if STATUS is 0; else "not ok", with the first lines of FILE, or of what was said
# on standard error, if the script keeps it in $scratch/err.
verdict() {
    checks=$((checks + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok - $2"
    else
        echo "not ok - $2"
        head -n 4 "${3:-$scratch/err}" 2>/dev/null | sed 's/^/    /'
        failed=1
    fi
}

# check WHAT COMMAND...: the command must succeed.
check() {
    what=$1
    shift
    "$@" >"$scratch/check" 2>&1
    verdict $? "$what" "$scratch/check"
}

# shown_calls FILE COMMAND LEAST: each "    $ build/whirl COMMAND ..." that FILE shows must print what stands below it; there
# must be so many at least.
shown_calls() {
    shown=0
    grep "^    [$] build/whirl $2" "$1" >"$scratch/calls"
    while read -r call; do
        shown=$((shown + 1))
        awk -v call="    $call" '$0 == call { on = 1; next }
            on && (/^    [$]/ || /^[^ ]/) { exit }
            on { sub(/^    /, ""); print }' "$1" | sed '${/^$/d;}' >"$scratch/wanted"
        words=${call#* build/whirl }
        (eval "\"\$whirl\" $words") >"$scratch/said" 2>"$scratch/shown" </dev/null
        diff "$scratch/wanted" "$scratch/said" >>"$scratch/shown"
        verdict $? "$1: whirl $words" "$scratch/shown"
    done <"$scratch/calls"
    [ "$shown" -ge "$3" ]
    verdict $? "$shown calls of whirl $2 are shown in $1" /dev/null
}

# The rows of host/commands/options.h: "--word VALUE GROUP".
option_rows() {
    tr -d '\n\\' <host/commands/options.h | grep -o 'X(OPTION_[A-Z]*, "--[a-z]*", "[^"]*", OPTIONS_[A-Z]*' |
        sed 's/X([A-Z_]*, "\(.*\)", "\(.*\)", OPTIONS_\(.*\)/\1 \2 \3/; s/  / - /'
}

# options_of FILE: the options that a help text lists, each "--word" or "--word VALUE".
options_of() {
    awk '/^  --[a-z]+ (--|[(]as)/ { words = 1 } # those of `whirl run`, by their words
        words { for (i = 1; i <= NF; i++) { if ($i ~ /^--[a-z]+$/) { print $i, "?" } } }
        /[(]as for `whirl run`[)]/ { words = 0; next }
        !words && /^  --[a-z]+/ {
            word = $1
            sub(/[^-a-z].*/, "", word)
            print word, $0 ~ /^  --[a-z]+ [^ ]/ ? $2 : ""
        }' "$1" | sort -u -k 1,1 | while read -r word value; do
        if [ "$value" = '?' ]; then
            option_rows | sed -n "s/^\($word .*\) [A-Z]*$/\1/p" | sed 's/ -$//'
        else
            echo "$word $value"
        fi
    done
}
