# checks.sh: shared functions of the scripts in tests/cli, to be sourced. $whirl is the program under test, $scratch a
# folder that is deleted at the end. A script ends with `exit $failed`.
set -u

whirl=${WHIRL:-build/whirl}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
failed=0
checks=0

# verdict STATUS WHAT [FILE]: prints "ok" if STATUS is 0. Otherwise prints "not ok" with the first lines of FILE or, without
# FILE, of $scratch/err, where the script keeps standard error.
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

# exits STATUS PATTERN WORD...: `whirl $about WORD...` ends with that status, and a line of standard error matches the pattern
# (of grep, with the flag $regex). Bad input (2) writes nothing to standard output; only the rig may have begun to report.
about= regex=
exits() {
    status=$1
    pattern=$2
    shift 2
    sh tests/limit.sh 60 "$whirl" $about "$@" >"$scratch/out" 2>"$scratch/err" </dev/null
    [ $? -eq "$status" ] && grep -q $regex -e "$pattern" "$scratch/err" && { [ "$status" -ne 2 ] || ! grep -qEv '^(Eccentric-mass rig on board|[0-9.]+ s  )' "$scratch/out"; }
    verdict $? "whirl${about:+ $about} $*: status $status, $pattern"
}

# await COMMAND...: repeats the command until it succeeds. Fails after ten minutes, more than a busy machine needs.
await() {
    tries=0
    until "$@"; do
        [ $tries -lt 30000 ] || return 1
        tries=$((tries + 1))
        sleep 0.02
    done
}
# has_bytes COUNT FILE: is FILE that long? has_worked HUNDREDTHS PROCESS: has it used that processor time, or ended?
has_bytes() { [ "$(wc -c 2>/dev/null <"$2" || echo 0)" -ge "$1" ]; }
has_worked() { ! [ "$(sed 's/.*) //' "/proc/$2/stat" 2>/dev/null | awk '{ print $12 + $13 }')" -lt "$1" ] 2>/dev/null; }
# stop SIGNAL WHEN WORD...: starts whirl and sends it the signal when WHEN holds, one of the two above; $code is how it ended.
stop() {
    signal=$1
    when=$2
    shift 2
    "$whirl" "$@" >"$scratch/out" 2>"$scratch/err" &
    process=$!
    await $when $process
    kill "-$signal" $process
    wait $process
    code=$?
}

# The rows of host/cli/options.h: "--word VALUE GROUP".
option_rows() {
    tr -d '\n\\' <host/cli/options.h | grep -o 'X(OPTION_[A-Z]*, "--[a-z]*", "[^"]*", OPTIONS_[A-Z]*' |
        sed 's/X([A-Z_]*, "\(.*\)", "\(.*\)", OPTIONS_\(.*\)/\1 \2 \3/; s/  / - /'
}

# options_of FILE: prints the options that a help text lists, each as "--word" or "--word VALUE".
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
