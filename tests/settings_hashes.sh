#!/bin/sh
# settings_hashes.sh WHIRL OUT STEPS [INTERVAL SCENE]...: writes scenes with the settings of `whirl price` as C into
# OUT, with the state hashes of runs of STEPS steps (float.hashes, double.hashes, fixed.hashes) and their options
# (settings.txt). Among settings that give different C, every INTERVAL-th is taken, and each with a new word; in fixed
# point, all.
set -eu
whirl=$1 out=$2 steps=$3
shift 3
words_of() { "$whirl" run two_mass_relative "--$1" '?' 2>&1 | sed -n 's/,//g; s/none//; s/^hint: choose one of //p'; }
methods=$(words_of method) matrices=$(words_of matrix) tables=$(words_of tables)
settings() {
    for sums in "" " --compensated"; do
        for method in $methods; do
            echo "--method $method$sums"
            echo "--method $method --angles lookup$sums"
            for form in $tables; do echo "--method $method --tables $form$sums"; done
        done
        for matrix in $matrices; do echo "--matrix $matrix$sums"; done
    done
}
write() { # write SCENE NAME NUMBER OPTIONS: C and header; fails if the scene refuses the options, or has given the same C
    if "$whirl" derive "$1" --as c --name "$2" --header "$out/$2.h" --until "$until" --number "$3" $4 >"$out/$2.c" 2>"$out/errors"; then
        sum="$1 $(sed "s/$2//g; s/_HEADER_[0-9a-f]*//" "$out/$2.c" | cksum)"
        ! grep -qxF "$sum" "$out/sums" && echo "$sum" >>"$out/sums" && return
    fi
    rm -f "$out/$2".[ch]
    return 1
}
hash() { # hash SCENE NAME NUMBER OPTIONS
    "$whirl" run "$1" --until "$until" --strict=off --number "$3" $4 2>"$out/errors" |
        sed -n "s/^state hash *\(.*\)/scene $2 steps $steps hash \1 ok/p" | grep . >>"$out/$3.hashes"
}
number=0 seen=0 words=
: >"$out/sums"
while [ $# -ge 2 ]; do
    until=$("$whirl" describe "$2" --json | awk -F '[:,]' -v n="$steps" '/"step_s"/ { print n * $2 }')
    scene=$("$whirl" describe "$2" --json | sed -n 's/^  "name": "\(.*\)",/\1/p')
    settings >"$out/settings"
    while read -r options; do
        number=$((number + 1)) name=${scene}_$number
        ! write "$2" "${name}_fixed" fixed "$options" || hash "$2" "${name}_fixed" fixed "$options"
        write "$2" "$name" float "$options" || continue
        taken=$((seen % $1))
        for word in $(echo "$options" | sed 's/--//g; s/\([a-z]\) \([a-z]\)/\1=\2/g'); do
            case " $words " in *" $word "*) ;; *) taken=0 words="$words $word" ;; esac
        done
        if [ "$taken" -eq 0 ]; then
            echo "$name $options " >>"$out/settings.txt"
            hash "$2" "$name" float "$options"
            hash "$2" "$name" double "$options"
        else
            rm "$out/$name".[ch]
        fi
        seen=$((seen + 1))
    done <"$out/settings"
    shift 2
done
rm -f "$out/sums" "$out/settings" "$out/errors"
