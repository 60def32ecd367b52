#!/bin/sh
# tree.sh TREE: makes or renews a copy of the tree and of its build in TREE. An existing copy may have been built from
# something else: equal files keep their time, others become newer than everything built from them.
set -eu
export LC_ALL=C
tree=$1
parts="Makefile README.md CITATION.cff mk core hal boards host tests docs"
if [ ! -d "$tree" ]; then
    rm -rf "$tree.new"
    mkdir -p "$tree.new/build"
    cp -a $parts "$tree.new/"
    for part in host float double gen unity tests tools whirl pil_rig pil_swing pil_dialled pil_carriage pil_cart station; do
        [ ! -e "build/$part" ] || cp -a "build/$part" "$tree.new/build/"
    done
    mv "$tree.new" "$tree"
    exit 0
fi
for part in $parts; do
    diff -rq "$part" "$tree/$part" || true
done | while read -r what from in to rest; do
    case $what in
    Files) cp "$from" "$to" ;;
    Only) # "Only in FOLDER: NAME"
        in=${in%:}
        case $in in
        "$tree"/*) rm -rf "${in:?}/$to" ;;
        *) cp -r "$in/$to" "$tree/$in/" ;;
        esac
        ;;
    *) echo "tree.sh: $what $from $in $to $rest" >&2 && exit 1 ;;
    esac
done
