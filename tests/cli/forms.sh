#!/bin/sh
# forms.sh: every output form of `whirl derive`, from its row: named in help and documents, complete, and taking the
# options that help says it takes, no others.
. "$(dirname "$0")/../checks.sh"

"$whirl" derive --help >"$scratch/help" 2>"$scratch/err"
sed -n 's/^  --as \([a-z0-9]*\)  *[^ ].*/\1/p' "$scratch/help" >"$scratch/forms"
sed -n 's/^ *{*\.word = "\(.*\)",$/\1/p; s/^ *{\.word = "\([a-z0-9]*\)", .*/\1/p' host/cli/derive.c |
    diff - "$scratch/forms" >"$scratch/err" && [ -s "$scratch/forms" ]
verdict $? "help tells of every form"
"$whirl" derive thomson_a --as x 2>&1 | sed -n 's/^hint: one of //p' | tr -d ',' | tr ' ' '\n' | diff "$scratch/forms" - >"$scratch/err"
verdict $? "and so does the hint to a wrong one"

cat >"$scratch/it.whirl" <<'END'
mechanism it "a ball on a spring, with a stop"
coordinate x [m]
T = 2 [kg]*x'^2/2
V = 8 [N/m]*x^2/2
stop x >= -0.1 [m] restitution 0.5
scene it_bounces { start x = 1 [m]; step 10 [ms]; until 1 [s] }
END
it=$scratch/it.whirl:it_bounces
ask() { "$whirl" derive "$it" --as "$@" >"$scratch/out" 2>"$scratch/err"; }

# those_with WORDS FILE: the forms that a line tells of: "WORDS --as a, b or c"
those_with() { sed -n "s/.*$1 --as \([a-z0-9, ]*\).*/\1/p" "$2" | sed 's/ only$//; s/ or / /; s/,//g'; }
named=$(those_with '--name NAME, with' "$scratch/help")
headed=$(those_with '--header FILE, with' "$scratch/help")
derived=$(those_with '--steps, with' "$scratch/help")
folded=$(those_with '--folded, with' "$scratch/help")
stepped=$(those_with 'The method matters to' "$scratch/help")
is_one_of() { case " $2 " in *" $1 "*) return 0 ;; esac; return 1; }

# only_with OPTION VALUE FORM FORMS (a switch has no value): accepted if that form is one of them, else refused, naming them
only_with() {
    ask "$3" "$1" ${2:+"$2"}
    status=$?
    if is_one_of "$3" "$4"; then
        [ $status -eq 0 ]
    else
        [ $status -eq 2 ] && [ ! -s "$scratch/out" ] && [ "$(those_with "error: $1 goes with" "$scratch/err")" = "$4" ]
    fi
    verdict $? "--as $3 with $1, which is for: $4"
    sed -n "/^## .whirl derive/,/^## .whirl desc/p" docs/commands.md | grep -F -- "| \`$1" >"$scratch/told"
    ! is_one_of "$3" "$4" || grep -qw "with --as .*$3" "$scratch/told"
    verdict $? "docs/commands.md tells of it" "$scratch/told"
}
while read -r form; do
    grep -q "^| \`--as $form\` | [^ ]" docs/commands.md
    verdict $? "docs/commands.md describes --as $form"
    ask "$form" && [ -s "$scratch/out" ] && ! grep -q '(null)' "$scratch/out" && [ ! -s "$scratch/err" ]
    verdict $? "--as $form: it is printed"
    cp "$scratch/out" "$scratch/plain"
    # whatever steps nothing for a stop says at least that there is one
    grep -qi 'stop\|restitution\|contact' "$scratch/out"
    verdict $? "--as $form: the stop is told of"
    only_with --steps '' "$form" "$derived"
    only_with --folded '' "$form" "$folded"
    only_with --name other "$form" "$named"
    if is_one_of "$form" "$named"; then
        grep -qw other "$scratch/out" && ! grep -q 'it_bounces' "$scratch/out"
        verdict $? "--as $form: the name is that" "$scratch/out"
        ask "$form" --name while
        [ $? -eq 2 ] && grep -q "error: 'while' is a word of .*: the generated scene cannot have that name" "$scratch/err"
        verdict $? "--as $form: and no word of its language"
    fi
    rm -f "$scratch/x.h"
    only_with --header "$scratch/x.h" "$form" "$headed"
    [ -s "$scratch/x.h" ] && has=0 || has=1
    is_one_of "$form" "$headed" && should=0 || should=1
    [ $has -eq $should ]
    verdict $? "--as $form: a header, if any, is written"
    ask "$form" --method heun
    cmp -s "$scratch/plain" "$scratch/out" && changes=1 || changes=0
    is_one_of "$form" "$stepped" && should=0 || should=1
    [ $changes -eq $should ]
    verdict $? "--as $form: the method matters as help says"
done <"$scratch/forms"
"$whirl" derive tests/mechanisms/lorenz.whirl --steps >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q 'lorenz is given by equations' "$scratch/err" && [ ! -s "$scratch/out" ]
verdict $? "a system has no steps" "$scratch/err"
exit $failed
