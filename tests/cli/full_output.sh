#!/bin/sh
# full_output.sh: every command reports a full or closed standard output and fails, in every form and at every length.
. "$(dirname "$0")/../checks.sh"

printf 'mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'"'"'^2/2\nscene s { start x'"'"' = 1 [m/s]; until 20 [ms] }\n' >"$scratch/m.whirl"
scene=$scratch/m.whirl

# lost WORD...: runs the command with a full disk, and with a closed output
lost() {
    for output in /dev/full closed; do
        if [ $output = closed ]; then
            "$whirl" "$@" >&- 2>"$scratch/err"
        else
            "$whirl" "$@" >/dev/full 2>"$scratch/err"
        fi
        status=$?
        [ $status -eq 1 ] && [ "$(grep -c 'error: cannot write to standard output' "$scratch/err")" -eq 1 ]
        verdict $? "whirl $(echo "$*" | sed "s|$scratch/||g") $output: exit status $status"
    done
}

if [ ! -e /dev/full ]; then
    echo "ok - this machine has no /dev/full"
    exit 0
fi
commands=$("$whirl" --help | sed -n 's/^  whirl \([a-z]*\) .*/\1/p')
[ "$(echo "$commands" | wc -w)" -ge 6 ]
verdict $? "the help text lists the commands"
lost --help
lost --version
for command in $commands; do
    lost "$command" --help
done
lost list
lost list "$scene" --as table
for form in text latex octave c; do
    lost derive "$scene" --as $form
done
lost derive "$scene:m"
lost describe "$scene"
lost describe "$scene" --json
lost accel "$scene"
lost run "$scene"
lost run "$scene" --csv -
lost run "$scene" --csv - --until 5s
lost sweep "$scene" --over step=1..2:2 --until 2 --quiet --fresh
lost map "$scene" --over step=1ms..2ms:2 --over x=0..1:2
lost map "$scene" --over step=1ms..2ms:2 --over x=0..1:2 --csv - --quiet

# Without a reader a command ends, without a message.
for command in run 'sweep --over x=1..2:20 --jobs 2' 'map --over x=1..2:20 --over step=1ms..2ms:2' trust prove; do
    code=$({ { sleep 0.2 && "$whirl" $command "$scene" --quiet --until 20s --csv - 2>"$scratch/err" || echo $? >&3; } | :; } 3>&1)
    [ "$code" -eq 141 ] && [ ! -s "$scratch/err" ]
    verdict $? "whirl $command without a reader: no message"
done

# A command without output does not notice. After another error, the exit status is that error's.
check "nothing said, nothing lost" sh -c '"$1" run "$2" --quiet >/dev/full' - "$whirl" "$scene"
check "or to nothing at all" sh -c '"$1" run "$2" --quiet >&-' - "$whirl" "$scene"
"$whirl" derive "$scene:other" >/dev/full 2>"$scratch/err"
[ $? -eq 2 ]
verdict $? "bad input is bad input"
exit $failed
