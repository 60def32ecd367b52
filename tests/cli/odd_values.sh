#!/bin/sh
# odd_values.sh: every option with a value, of every command, gets invalid values. They are refused quickly, with a message
# and in little memory, and nothing is started. (`whirl pil`: pil.sh.)
. "$(dirname "$0")/../checks.sh"

gear=epicyclic_from_rest
values='1e999 nan = -1e300'
if [ -n "${WHIRL_FEW:-}" ]; then
    values=nan # no limit, because the sanitizers reserve all of the address space
else
    ulimit -v 4000000
fi

# COMMAND, its options that take any words (files, expressions), and its required arguments
while read -r command any words; do
    "$whirl" "$command" --help >"$scratch/help" 2>"$scratch/err"
    options_of "$scratch/help" >"$scratch/options"
    asked=0
    while read -r option value; do
        case ",$any," in *",$option,"*) value= ;; esac
        [ -n "$value" ] || continue
        asked=$((asked + 1))
        for value in $values ''; do
            case $words in # once is enough, except for options that may be repeated
            *"$option "*) [ "$option" = --over ] || continue ;;
            esac
            sh tests/limit.sh 60 "$whirl" "$command" $words "$option" "$value" >"$scratch/out" 2>"$scratch/err" </dev/null
            status=$?
            [ $status -eq 2 ] && grep -q 'error: ' "$scratch/err" && [ ! -s "$scratch/out" ] ||
                { echo "$option '$value': status $status" && cat "$scratch/err"; } >>"$scratch/passed"
        done
    done <"$scratch/options"
    [ $asked -ge 1 ] && [ ! -s "$scratch/passed" ]
    verdict $? "whirl $command: $asked options refuse what is no value" "$scratch/passed"
    rm -f "$scratch/passed"
done <<END
run --csv,--columns,--vcd,--strict $gear
derive --header $gear --as c
describe - $gear
sweep --csv,--measure $gear --over r=0.1..0.2:2
map --csv $gear --over step=1ms..2ms:2 --over r=0.1..0.2:2
trust --csv $gear
prove --csv $gear
price --csv $gear
choose - $gear --error 1e-2
list -
END

# --- files ---------------------------------------------------------------------------------------------------------------
mkdir "$scratch/kept"
while read -r command option words; do
    for file in /dev/null/x "$scratch" ''; do
        sh tests/limit.sh 60 "$whirl" "$command" $words --until 50ms "$option" "$file" >"$scratch/out" 2>"$scratch/err" </dev/null
        status=$?
        [ $status -ge 1 ] && [ $status -le 2 ] && [ ! -s "$scratch/out" ] &&
            grep -qE "^('*|$file): error: cannot be written: |error: --plot draws|error: --header needs" "$scratch/err"
        verdict $? "whirl $command $option '$file': status $status"
    done
    # the disk is full after a random number of blocks: the old file stays, and no partial file appears beside it
    kept=$scratch/kept/a.svg
    # a price takes long, and its files are written in the same way as a map's
    [ "$command" = price ] ||
        "$whirl" "$command" $words --until 50ms "$option" "$kept" >"$scratch/out" 2>"$scratch/err" </dev/null
    blocks=$(($(cat "$kept" 2>"$scratch/err" | wc -c) / 512))
    case $command in
    run | derive | trust | prove) draws='1 2 3' ;;
    price) draws= ;;
    *) draws=1 ;;
    esac
    for draw in $draws; do
        most=$(echo "$command $option $draw" | cksum | awk -v blocks=$blocks '{ print $1 % (blocks + 1) }')
        rm -f "$scratch/kept"/*
        [ "$command" = sweep ] || echo old >"$kept" # a sweep keeps the rows so far, because it continues
        (ulimit -f "$most" && "$whirl" "$command" $words --until 50ms "$option" "$kept" 2>&1 >/dev/null </dev/null
            echo "status $?") | cat >"$scratch/err"
        grep -q '^status 1$' "$scratch/err" && grep -qE "$kept.*: cannot be written: |gnuplot could not draw $kept" "$scratch/err" &&
            { [ "$command" = sweep ] || { [ "$(cat "$kept")" = old ] && [ "$(ls "$scratch/kept")" = a.svg ]; }; }
        verdict $? "whirl $command $option: full after $most of $blocks blocks"
    done
    rm -f "$scratch/kept"/*
    [ -c /dev/full ] && [ "$option" != --plot ] || continue
    sh tests/limit.sh 60 "$whirl" "$command" $words --until 50ms "$option" /dev/full >"$scratch/out" 2>"$scratch/err" </dev/null
    status=$?
    [ $status -eq 1 ] && grep -q '^/dev/full: error: cannot be written: ' "$scratch/err"
    verdict $? "whirl $command $option /dev/full: status $status"
    [ "$option" = --csv ] || [ "$option" = --columns ] || continue
    # enough rows for a part to be written before the end
    sh tests/limit.sh 60 "$whirl" "$command" $words --until 50ms "$option" - >/dev/full 2>"$scratch/err" </dev/null
    status=$?
    [ $status -eq 1 ] && grep -q '^whirl: error: cannot write to standard output' "$scratch/err" &&
        ! grep -q '^-: ' "$scratch/err"
    verdict $? "whirl $command $option - into what is full: status $status"
done <<END
run --csv thomson_a
run --columns thomson_a
run --vcd thomson_a
run --plot thomson_a
derive --header thomson_a --as c
sweep --csv $gear --over r=0.1..0.2:300
map --csv $gear --over step=1ms..2ms:2 --over r=0.1..0.2:100
map --plot $gear --over step=1ms..2ms:2 --over r=0.1..0.2:2
trust --csv $gear
prove --csv $gear
price --csv $gear --effort 1e7
END
# `price` reports a quantity without an error, with or without a table
for quiet in '' --quiet; do
    "$whirl" price $gear --effort 1e7 --until 0.1s --horizon 1e18s $quiet >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 1 ] && grep -q '^whirl price: error: no setting of .* has a known error' "$scratch/err"
    verdict $? "whirl price ${quiet:-(with its table)}: that no error is known"
done
exit $failed
