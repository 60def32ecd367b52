#!/bin/sh
# update_files.sh NEW OLD [KEEP...]: makes OLD's .c and .h files equal to those of NEW, and touches only files that
# differ. Files of OLD named KEEP stay. NEW is used up.
set -eu
new=$1 old=$2
shift 2
for file in "$old"/*.[ch]; do
    name=${file##*/}
    case " $* " in *" $name "*) continue ;; esac
    [ -e "$new/$name" ] || rm -f "$file"
done
for file in "$new"/*.[ch]; do
    [ ! -e "$file" ] || cmp -s "$file" "$old/${file##*/}" || mv "$file" "$old/"
done
rm -rf "$new"
