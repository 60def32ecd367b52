#!/bin/sh
# bad.sh FOLDER: writes each broken text of tests/bad to a file of its own in FOLDER. In an archive a line "=== NAME"
# precedes each text.
set -eu
folder=${1:?usage: bad.sh FOLDER}
mkdir -p "$folder"
LC_ALL=C awk -v folder="$folder" '/^=== / { close(file); file = folder "/" $2; next } { print >file }' tests/bad/*.texts
