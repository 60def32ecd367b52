#!/bin/sh
# update_files.sh NEW OLD [KEEP...]: make OLD's .c and .h files those of NEW, touching only those that
# differ; files of OLD named KEEP stay. NEW is used up.
set -eu

new=$1
old=$2
shift 2
for file in "$old"/*.c "$old"/*.h; do
    [ -e "$file" ] || continue
    name=$(basename "$file")
    case " $* " in
    *" $name "*) continue ;;
    esac
    [ -e "$new/$name" ] || rm "$file"
done
for file in "$new"/*.c "$new"/*.h; do
    [ -e "$file" ] || continue
    name=$(basename "$file")
    cmp -s "$file" "$old/$name" || mv "$file" "$old/$name"
done
rm -rf "$new"
