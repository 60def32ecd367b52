#!/bin/sh
# structure.sh: includes in core, hal and host, and calls in the program's objects form no circle: between folders, between
# headers, and between files (a header with the .c of its name).
. "$(dirname "$0")/../checks.sh"

# circles.awk: reads arrows, "FROM TO" a line, and prints those that lie on a circle, as "A B C: ..." lines.
cat >"$scratch/circles.awk" <<'END'
{ if (!(($1, $2) in arrow)) { arrow[$1, $2] = 1; to[$1] = to[$1] " " $2; node[$1] = node[$2] = 1 } }
function walk(from, at,   i, n, next_one) {
    n = split(to[at], next_one, " ")
    for (i = 1; i <= n; i++) {
        if (!((from, next_one[i]) in reaches)) {
            reaches[from, next_one[i]] = 1
            walk(from, next_one[i])
        }
    }
}
END {
    for (a in node) { walk(a, a) }
    for (a in node) {
        if (!((a, a) in reaches)) { continue }
        line = ""
        for (b in node) { if (((a, b) in reaches) && ((b, a) in reaches)) { line = line " " b } }
        n = split(line, member, " ")
        for (i = 2; i <= n; i++) {
            for (k = i; k > 1 && member[k] < member[k - 1]; k--) {
                swap = member[k]; member[k] = member[k - 1]; member[k - 1] = swap
            }
        }
        line = member[1]
        for (i = 2; i <= n; i++) { line = line " " member[i] }
        print line
    }
}
END

# --- who includes whom -----------------------------------------------------------------------------------------------

# arrows_of [FOLDER...]: "FROM TO" for each include of a file of these folders by another. A name in an include is a
# path from the including file's folder, or else from the project's root, as the compiler has it.
arrows_of() {
    find "$@" -type f \( -name '*.h' -o -name '*.c' -o -name '*.inc' \) | sort >"$scratch/files"
    xargs grep -H '^#include "' <"$scratch/files" | awk -F: -v files="$scratch/files" '
        BEGIN { while ((getline line < files) > 0) { known[line] = 1 } }
        {
            folder = $1
            sub("[^/]*$", "", folder)
            split($2, part, "\"")
            name = part[2]
            if ((folder name) in known) { print $1, folder name } else if (name in known) { print $1, name }
        }' | sort -u
}

arrows_of core hal host >"$scratch/includes"
files=$(wc -l <"$scratch/files")

# no_circle WHAT: the arrows in $scratch/arrows must have no circle
no_circle() {
    awk -f "$scratch/circles.awk" "$scratch/arrows" | sort -u >"$scratch/found"
    diff /dev/null "$scratch/found" >"$scratch/err" 2>&1
    verdict $? "$1"
}

# the check itself must notice an arrow back, which makes a circle
{ cat "$scratch/includes" && echo core/real.h core/step.h; } | awk -f "$scratch/circles.awk" | grep -q 'core/real.h' &&
    [ "$(wc -l <"$scratch/includes")" -gt 500 ]
verdict $? "$files files of core, hal and host, $(wc -l <"$scratch/includes") includes; one more would be seen"

grep '\.h [^ ]*\.h$' "$scratch/includes" >"$scratch/arrows"
no_circle "headers: no circle"

sed -E 's/\.(h|c|inc)( |$)/\2/g' "$scratch/includes" | awk '$1 != $2' | sort -u >"$scratch/arrows"
no_circle "files, each a header with the .c of its name: no circle"

sed 's:/[^/ ]*\( \|$\):\1:g' "$scratch/includes" | awk '$1 != $2 && $1 != "host"' | sort -u >"$scratch/arrows"
no_circle "folders: no circle"

# --- who calls whom --------------------------------------------------------------------------------------------------

objects=$(dirname "$whirl")/host/host
if ! command -v nm >/dev/null 2>&1 || [ ! -d "$objects" ]; then
    echo "ok - no nm, or no objects of the program: calls are not looked at # SKIP"
    exit $failed
fi

# Lines "FOLDER/FILE defines SYMBOL" and "FOLDER/FILE wants SYMBOL"; objects of files that are gone do not count.
for object in "$objects"/*/*.o "$objects"/os/*/*.o; do
    file=${object#"$objects/"}
    file=${file%.o}
    [ -f "host/$file.c" ] && nm "$object" | awk -v file="$file" '
        NF == 3 && $2 ~ /^[TDRBV]$/ { print file, "defines", $3 }
        NF == 2 && $1 == "U" { print file, "wants", $2 }'
done >"$scratch/symbols"

awk '$2 == "defines" { home[$3] = $1 }
     $2 == "wants" { wanted[++n] = $1; what[n] = $3 }
     END { for (i = 1; i <= n; i++) {
         if ((what[i] in home) && home[what[i]] != wanted[i]) { print wanted[i], home[what[i]] }
     } }' "$scratch/symbols" | sort -u >"$scratch/arrows"

sed 's:/[^ ]*::g' "$scratch/arrows" | awk '$1 != $2' | sort -u >"$scratch/folders"
awk -f "$scratch/circles.awk" "$scratch/folders" | sort -u >"$scratch/err"
[ "$(wc -l <"$scratch/folders")" -gt 10 ] && [ ! -s "$scratch/err" ]
verdict $? "$(sort -u -k1,1 "$scratch/folders" | wc -l) folders of host/, $(wc -l <"$scratch/folders") arrows between them: no circle"

awk '{ split($1, a, "/"); split($2, b, "/") } a[1] == b[1]' "$scratch/arrows" |
    awk -f "$scratch/circles.awk" | sort -u >"$scratch/found"
diff /dev/null "$scratch/found" >"$scratch/err" 2>&1
verdict $? "$(cut -d' ' -f1 "$scratch/symbols" | sort -u | wc -l) files: no two need each other"
exit $failed
