#!/bin/sh
# effects_cost_nothing.sh: an effect that is not called for costs nothing. Every built-in mechanism, with
# none of its effects, compiles to the same object, byte for byte, as a file that never mentions them;
# and so does every scene that calls for none. Mechanisms also for the board, if its compiler is there.
# And no effect does nothing: called for, each changes the generated code.
. "$(dirname "$0")/../checks.sh"

root=$(pwd)
mkdir "$scratch/with" "$scratch/without"
stripped=0

# same NAME BOARD: NAME derived from both folders' model.whirl gives the same objects, with BOARD = yes also
# for the board.
same() {
    for side in with without; do
        "$whirl" derive "$scratch/$side/model.whirl:$1" --as c >"$scratch/$side/model.c" 2>"$scratch/errors" ||
            { sed 's/^/    /' "$scratch/errors"; return 1; }
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

# code FILE:NAME OPTION...: the generated code without its comment.
code() {
    "$whirl" derive "$@" --as c | sed '1,/^ \*\//d'
}

# All that an effect can hold, its own input in front of the mechanism's parameters and input.
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
  T += m_more*X'^2/2 } # and one { here
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
    # Scenes with effects need them; those without must be in both files.
    cp "$file" "$scratch/with/model.whirl"
    plain=$("$whirl" list | awk '$1 == "scene" { print $2 }' | while read -r scene; do
        awk -v scene="$scene" '
            $1 == "scene" { inside = $2 == scene; found = found || inside }
            inside && $1 == "with" { with = 1 }
            END { if (found && !with) print scene }' "$file"
    done)
    awk -v drop="effect" -f mk/price/strip.awk "$file" >"$scratch/stripped.whirl"
    awk -v keep=" $(echo "$plain" | tr '\n' ' ') " '
        $1 == "scene" { dropping = index(keep, " " $2 " ") == 0 }
        !dropping { print }
        dropping && /^}/ { dropping = 0 }' "$scratch/stripped.whirl" >"$scratch/without/model.whirl"

    for name in $(awk '$1 == "mechanism" { print $2 }' "$file") $plain; do
        board=yes
        case " $(echo "$plain" | tr '\n' ' ') " in *" $name "*) board=no ;; esac
        same "$name" "$board"
        verdict $? "$name: the same object with and without effects in the file"
    done

    mechanism=
    for word in $(awk '$1 == "mechanism" || $1 == "effect" { print $1 "=" $2 }' "$file"); do
        case $word in
        mechanism=*)
            mechanism=${word#*=}
            code "$file:$mechanism" >"$scratch/none.c" 2>&1
            ;;
        effect=*)
            stripped=$((stripped + 1))
            code "$file:$mechanism" --with "${word#*=}" >"$scratch/one.c" 2>&1
            ! cmp -s "$scratch/none.c" "$scratch/one.c" && [ -s "$scratch/one.c" ]
            verdict $? "$mechanism with ${word#*=}: other code than without"
            ;;
        esac
    done
done

[ "$stripped" -ge 20 ] && [ "$checks" -ge 60 ]
verdict $? "$stripped effects found, in $checks checks (run from the project's root)"
exit $failed
