#!/bin/sh
# write.sh FOLDER MECHANISMS WHIRL...: writes the output of one build of whirl to FOLDER: scenes/ (every built-in scene as
# C), mechanisms/ (every scene of the file MECHANISMS, in all forms), hashes.txt (of the float states after the runs) and
# seconds. WHIRL is the command, with an emulator before it if it needs one. log.txt gets the messages.
set -u
folder=${1:?usage: write.sh FOLDER MECHANISMS WHIRL...}
mechanisms=${2:?usage: write.sh FOLDER MECHANISMS WHIRL...}
shift 2
rm -rf "$folder"
mkdir -p "$folder/scenes" "$folder/mechanisms"
start=$(date +%s)
{
    sh tests/limit.sh 1800 "$@" emit-scenes "$folder/scenes" || echo "exit status $?: emit-scenes of the built-in scenes"
    sh tests/limit.sh 1800 "$@" emit-scenes "$folder/mechanisms" "$mechanisms" || echo "exit status $?: emit-scenes $mechanisms"
    sh tests/limit.sh 1800 "$@" hashes >"$folder/hashes.txt" || echo "exit status $?: hashes"
    cat "$folder"/mechanisms/*.hash | grep '^scene ' >>"$folder/hashes.txt"
} >"$folder/log.txt" 2>&1
echo "$(($(date +%s) - start))" >"$folder/seconds"
if grep -q '^exit status' "$folder/log.txt"; then
    touch "$folder/failed"
fi
