#!/bin/sh
# commands.sh: every command and option, from their rows: each is in the help texts and the documents, is accepted, and
# makes a difference.
. "$(dirname "$0")/../checks.sh"

# All commands of host/cli/commands.h, except those that only the project's own build calls.
hidden='emit-scenes|hashes'
sed -n 's/^int command_\([a-z_]*\)(.*/\1/p' host/cli/commands.h | tr _ - | grep -vxE "$hidden" >"$scratch/commands"
"$whirl" --help >"$scratch/help" 2>"$scratch/err"
verdict $? "whirl --help"
sed -n 's/^  whirl \([a-z-]*\) .*/\1/p' "$scratch/help" | diff "$scratch/commands" - >"$scratch/err"
verdict $? "whirl --help lists every command, and no other"

for page in commands commands_bench; do
    WHIRL=$whirl sh mk/commands.sh page $page 2>&1 | diff docs/$page.md - >"$scratch/err"
    verdict $? "docs/$page.md is what make docs-renew DOC_PAGES=docs/commands.md writes"
done
sh mk/commands.sh man "$scratch/man" 2>"$scratch/err"
find "$scratch/man" -name '*-*.1' | sed 's/.*whirl-//; s/[.]1$//' | sort >"$scratch/paged"
sort "$scratch/commands" | diff - "$scratch/paged" >"$scratch/err" &&
    { ! command -v groff >"$scratch/shown" || groff -man -ww -Tutf8 "$scratch"/man/*.1 2>"$scratch/err" >"$scratch/shown"; } && [ ! -s "$scratch/err" ]
verdict $? "a man page for each command, without warnings"

option_rows >"$scratch/rows"
[ "$(wc -l <"$scratch/rows")" -eq "$(grep -c '^ *X(OPTION_' host/cli/options.h)" ]
verdict $? "the rows of options.h are read" "$scratch/rows"

while read -r command; do
    for ask in --help -h; do
        "$whirl" "$command" $ask >"$scratch/text" 2>"$scratch/err" && head -n 1 "$scratch/text" | grep -q "^usage: whirl $command" &&
            [ ! -s "$scratch/err" ]
        verdict $? "whirl $command $ask" "$scratch/text"
    done
    "$whirl" "${command}x" 2>&1 | grep -q "^hint: did you mean '$command'?"
    verdict $? "and whirl ${command}x is led to it"
    ! grep -n '.\{100\}' "$scratch/text" >"$scratch/err"
    verdict $? "its help has lines of 99 columns at most"
    options_of "$scratch/text" >"$scratch/options"
    # the text reads every option at the start of a line; these commands have none
    case $command in accel | new | check) true ;; *) [ -s "$scratch/options" ] ;; esac
    verdict $? "its options are read"
    sed -n "/^## .whirl $command\`/,/^Exit status/p" docs/commands*.md >"$scratch/documents"
    while read -r word value; do
        "$whirl" "$command" $word >"$scratch/out" 2>"$scratch/err" </dev/null
        if [ -n "$value" ]; then
            grep -q "error: $word needs a value" "$scratch/err" &&
                "$whirl" "$command" $word --quiet 2>&1 </dev/null | grep -q "error: $word needs a value"
            verdict $? "whirl $command $word needs its $value, and takes no option as that"
        else
            ! grep -qE "unknown option|needs a value" "$scratch/err"
            verdict $? "whirl $command $word is taken"
        fi
        "$whirl" "$command" ${word}x 2>&1 </dev/null | grep -q "^hint: did you mean $word?"
        verdict $? "and ${word}x is led to it"
        grep -q -- "$word\([^a-z]\|$\)" "$scratch/documents"
        verdict $? "the documents tell of whirl $command $word"
    done <"$scratch/options"
done <"$scratch/commands"

# --- common options: a line of help each, and a difference each --------------------------------------------------
"$whirl" run --help >"$scratch/text"
cat >"$scratch/plain.whirl" <<'END'
mechanism plain "a mass on a spring, with drag, and a pendulum"
coordinate x [m]
coordinate a [rad]
parameter k = 8 [N/m]
input push = 0 [N]
T = 2 [kg]*x'^2/2 + 0.01 [kg*m^2]*a'^2/2
V = k*x^2/2 - 9 [J]*cos(a)
Q(x) = push
output place [m] = x
output swing [rad] = a
effect drag "drag" { Q(x) += -0.1 [N*s/m]*x' }
effect wind "wind" { Q(x) += 0.2 [N] }
scene plain_swings { with drag; start x = 1 [m], a = 1 [rad]; step 10 [ms]; until 0.1 [s]; range push = -1 .. 1 [N] }
END
sed 's/ - 9 \[J\]\*cos(a)/ + 9 [J]*a^2/' "$scratch/plain.whirl" >"$scratch/linear.whirl"
# a motion without drive and damping
sed '/^Q(x)/d; s/with drag; //; s/until 0.1/until 20/' "$scratch/plain.whirl" >"$scratch/free.whirl"
sample() { # sample OPTION: a value that differs from the scene's
    case $1 in
    --set) echo k=9 ;;
    --start) echo x=2 ;;
    --with) echo wind ;;
    --without) echo drag ;;
    --step) echo 5ms ;;
    --until) echo 0.2s ;;
    --method) echo heun ;;
    --number) echo float ;;
    --compensated | --stabilized) ;;
    --angles) echo lookup ;;
    --matrix) echo exact ;;
    --tables) echo linear ;;
    --cells) echo 16 ;;
    *) echo "no-sample-in-$0" ;;
    esac
}
ends() { # ends COMMAND [OPTION...]: all results of the command
    command=$1
    shift
    case $command in
    derive) "$whirl" derive "$plain" --as c "$@" ;;
    describe) "$whirl" describe "$plain" --json "$@" ;;
    examine) "$whirl" examine "$plain" "$@" ;;
    figure) # a figure of the scene, with the state as a curve
        printf 'title Plain\nrun a %s --every 10ms\npanel X [m]\ncurve a | {time} | {x} | -\n' "$plain" >"$scratch/plain.fig"
        "$whirl" figure "$scratch/plain.fig" --out "$scratch/plain.svg" "$@" && cat "$scratch/plain.svg"
        ;;
    run) "$whirl" run "$plain" --csv - --quiet --strict=off "$@" ;;
    sweep) "$whirl" sweep "$plain" --over x=1..1.5:2 --quiet --strict=off "$@" ;;
    map) "$whirl" map "$plain" --over x=1..1.5:2 --over a=1..1.2:2 --csv - --quiet "$@" ;;
    effects) "$whirl" effects "$plain" "$@" ;;
    trust) "$whirl" trust "$plain" --csv - --quiet "$@" ;;
    pil) # runs the cart's firmware, and prints the hash of the motion
        case " $* " in *' --until '*) ;; *) set -- --until 0.1s "$@" ;; esac
        "$whirl" pil "$plain" --firmware "$(dirname "$whirl")/pil_cart" --bind theta=a "$@" | grep -a "^plant's state"
        ;;
    prove) "$whirl" prove "$plain" --csv - --quiet "$@" ;;
    price) "$whirl" price "$plain" --csv - --quiet --effort 1e7 "$@" ;;
    choose) "$whirl" choose --predict "$plain" --error 1e-2 --quiet --effort 4e6 "$@" ;;
    *) echo "no call of $command in $0" ;;
    esac
}
while read -r word value group; do
    sed -n "s/^  $word .\{$((20 - ${#word}))\}//p" "$scratch/text" | grep -q '^[^ ]'
    verdict $? "whirl run --help describes $word"
    while read -r command; do
        "$whirl" "$command" --help | grep -q -- " $word\( \|$\)" || continue
        case $command$word in
        examine--start | examine--until) continue ;; # formulas hold at every state and time
        examine--set) set -- --set k=0 ;;            # removes the spring
        sweep--start | map--start) set -- --start "x'=1" ;; # because x is swept
        effects--without) set -- --without drag --with wind ;; # because without effects there is no result
        derive--number) set -- --number fixed ;; # because float and double have the same code
        *) set -- "$word" "$(sample "$word")" ;;
        esac
        [ -n "$2" ] || set -- "$word"
        plain=$scratch/plain.whirl:plain_swings
        [ "$word" != --matrix ] || plain=$scratch/linear.whirl:plain_swings
        [ "$word" != --stabilized ] || plain=$scratch/free.whirl:plain_swings
        [ "$command$word" != derive--number ] || plain=$scratch/linear.whirl:plain_swings
        base=
        [ "$word" != --cells ] || base="--tables cubic" # tables, which have cells
        without=$scratch/without_${command}_$(basename "$plain")${base:+_tables}
        [ -e "$without" ] || ends "$command" $base >"$without" 2>/dev/null
        ends "$command" $base "$@" >"$scratch/with" 2>"$scratch/err"
        status=$?
        [ $status -eq 0 ] && [ -s "$scratch/with" ] && ! cmp -s "$without" "$scratch/with"
        verdict $? "whirl $command $* makes a difference ($value, $group)"
    done <"$scratch/commands"
done <"$scratch/rows"
exit $failed
