#!/bin/sh
# effects_cost_nothing.sh: an effect that a scene does not use costs nothing. Each built-in mechanism without its
# effects gives the same code, or the same objects, as a file that never mentions the effects; also for the board, if
# its compiler is installed. So does each scene without effects. Conversely, each effect that is used changes the code.
. "$(dirname "$0")/../checks.sh"

root=$(pwd)
mkdir "$scratch/with" "$scratch/without"
stripped=0

without_comment() { # removes the first comment of generated code
    sed '1,/^ \*\//d' "$1"
}

# same NAME BOARD: NAME derived from both folders' model.whirl gives the same objects; BOARD = yes: for the board too.
same() {
    for side in with without; do
        "$whirl" derive "$scratch/$side/model.whirl:$1" --as c >"$scratch/$side/model.c" 2>"$scratch/errors" ||
            { sed 's/^/    /' "$scratch/errors"; return 1; }
        without_comment "$scratch/$side/model.c" >"$scratch/$side/code.c"
    done
    [ -s "$scratch/with/code.c" ] || return 1
    ! cmp -s "$scratch/with/code.c" "$scratch/without/code.c" || return 0 # then the objects are equal, too
    for side in with without; do
        (cd "$scratch/$side" && ${CC:-gcc} -std=c11 -O2 -ffp-contract=off -I"$root" -c model.c -o host.o) ||
            return 1
        rm -f "$scratch/$side/board.o"
        if [ "$2" = yes ] && command -v arm-none-eabi-gcc >/dev/null 2>&1; then
            (cd "$scratch/$side" && arm-none-eabi-gcc -std=c11 -O2 -ffp-contract=off -ffreestanding \
                -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -I"$root" -c model.c -o board.o) ||
                return 1
        fi
    done
    for object in host.o board.o; do
        if [ -e "$scratch/with/$object" ]; then
            cmp "$scratch/with/$object" "$scratch/without/$object" || return 1
        fi
    done
}

# code FILE:NAME OPTION...: prints the generated code without its first comment.
code() {
    "$whirl" derive "$@" --as c >"$scratch/code.c"
    without_comment "$scratch/code.c"
}

# Everything that an effect can contain; its input comes before the mechanism's parameters and input.
cat >"$scratch/everything.whirl" <<'END'
mechanism everything "one of each"
coordinate X [m]
coordinate phi [rad]
output place [m] = X
effect push {
  input extra = 3 [N]
  parameter part = 0.5
  let force = part*extra
  Q(X) += force
}
effect heavier { parameter m_more = 1 [kg] "a brace } in a text"
  T += m_more*X'^2/2 } # and a { in a comment
effect spring { V += 3 [N/m]*X^2/2; F += 0.1 [N*s/m]*X'^2/2 }
effect limit { stop X <= 2 [m] restitution 0.5 }
effect dry { friction X static 0.3 kinetic 0.2 normal 10 [N] }
effect clamp { hold X while sin(phi) > 0.9 }
effect kick {
  when X crosses 0.5 [m] rising {
    set X' = -X'
  }
}
effect hiss { noise place deviation 1 [mm] seed 3 }
parameter m = 2 [kg]
parameter J = 0.1 [kg*m^2]
input f = 1 [N]
T = m*X'^2/2 + J*phi'^2/2 + 0.1 [kg*m]*X'*phi'*cos(phi)
Q(X) = f
END
for file in core/models/*.whirl "$scratch/everything.whirl"; do
    "$whirl" list --as table "$file" >"$scratch/table" || exit 1
    # Scenes with effects need them. Scenes without effects must be in both files.
    awk -F '\t' '$1 == "effect" || $1 == "scene" && $7 != "-" && $7 != "ledger" { print $5 "," $6 "d" }' \
        "$scratch/table" >"$scratch/cut"
    cp "$file" "$scratch/with/model.whirl"
    sed -f "$scratch/cut" "$file" >"$scratch/without/model.whirl"
    ! "$whirl" list --as table "$scratch/without/model.whirl" | cut -f 1 | grep -q '^effect$'
    verdict $? "$(basename "$file"): no effect is left"

    for name in $(awk -F '\t' '$1 == "mechanism" { print $2 }' "$scratch/table"); do
        same "$name" yes
        verdict $? "$name: the same object with and without effects in the file"
    done
    for name in $(awk -F '\t' '$1 == "scene" && ($7 == "-" || $7 == "ledger") { print $2 }' "$scratch/table"); do
        same "$name" no
        verdict $? "$name: the same object with and without effects in the file"
    done

    awk -F '\t' '$1 == "effect" { print $3, $2 }' "$scratch/table" >"$scratch/effects"
    while read -r mechanism effect; do
        stripped=$((stripped + 1))
        code "$file:$mechanism" >"$scratch/none.c" 2>&1
        code "$file:$mechanism" --with "$effect" >"$scratch/one.c" 2>&1
        ! cmp -s "$scratch/none.c" "$scratch/one.c" && [ -s "$scratch/one.c" ]
        verdict $? "$mechanism with $effect: other code than without"
    done <"$scratch/effects"
done

[ "$stripped" -ge 20 ] && [ "$checks" -ge 60 ]
verdict $? "$stripped effects found, in $checks checks (run from the project's root)"
exit $failed
