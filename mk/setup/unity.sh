#!/bin/sh
# unity.sh DIR: puts the Unity test framework (unity.c, unity.h, unity_internals.h) into DIR.
#
# Debian has no binary package of Unity, but its source package ntpsec contains Unity 2.5.1. apt fetches it from this
# machine's own package sources, with package lists in a folder of their own. So nothing outside DIR is written, and
# root is not needed. UNITY=checkout copies from a checkout of Unity instead (its root or its src folder).
set -eu

package=ntpsec
sum_c=2e3a0610268455520a5796345b503d00c34a47fe97ed3750349cbd4b2b1990f3
sum_h=681ac98a63ac11effb11e59d580f6ca82abca1bd34069465c38e3b15344256c0
sum_internals=adfd612c217e59468c5ebe978640e77e5f539e820ffc0c195a98c5a36f0ac868

dir=${1:?usage: unity.sh DIR}
dir=$(mkdir -p "$dir" && cd "$dir" && pwd)
work=$dir.work

fail() {
    echo "unity.sh: $*" >&2
    echo "  Get Unity 2.5 or newer yourself and say where it is: make test UNITY=path/to/Unity" >&2
    exit 1
}

install_from() {
    for file in unity.c unity.h unity_internals.h; do
        [ -f "$1/$file" ] || fail "no $file in $1"
        cmp -s "$1/$file" "$dir/$file" || cp "$1/$file" "$dir/$file"
    done
    exit 0
}
pinned() {
    printf '%s  %s\n' "$sum_c" "$1/unity.c" "$sum_h" "$1/unity.h" "$sum_internals" "$1/unity_internals.h" |
        sha256sum --check --status 2>/dev/null
}

if [ -n "${UNITY:-}" ]; then
    [ ! -f "$UNITY/src/unity.c" ] || install_from "$UNITY/src"
    install_from "$UNITY"
fi
! pinned "$dir" || exit 0
command -v apt-get >/dev/null || fail "this is no Debian: there is no apt-get"
command -v xz >/dev/null || fail "xz is missing (package xz-utils)"

echo "  GET   Unity, the test framework, into $dir (from Debian's source package $package, a few MB; installs nothing)"
rm -rf "$work"
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
mkdir -p "$work/lists/partial" "$work/cache/archives/partial" "$work/sources" "$work/src" "$work/unity"

# The machine's sources, one-line and deb822 style, with deb turned into deb-src.
etc=/etc/apt
for list in "$etc/sources.list" "$etc"/sources.list.d/*.list; do
    [ -f "$list" ] || continue
    sed -n 's/^[[:space:]]*deb[[:space:]]/deb-src /p' "$list"
done >"$work/sources/one-line.list"
for list in "$etc"/sources.list.d/*.sources; do
    [ -f "$list" ] || continue
    sed 's/^[Tt]ypes:.*/Types: deb-src/' "$list" >"$work/sources/$(basename "$list")"
done

# apt's sandbox user may be unable to read a home folder, but these files are in one.
apt() {
    apt-get -q -o APT::Sandbox::User="$(id -un)" \
        -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/sources" \
        -o Dir::State::lists="$work/lists" -o Dir::Cache="$work/cache" "$@"
}

log=$work/log
# An extra package source that cannot be reached does not matter if the needed one answers.
apt update >"$log" 2>&1 || echo "unity.sh: note: apt-get update complained; trying what it got" >&2
(cd "$work/src" && apt source --download-only "$package") >>"$log" 2>&1 || {
    tail -n 5 "$log" >&2
    fail "apt could not fetch the source package $package"
}
tarball=$(find "$work/src" -name "${package}_*.orig.tar.*" ! -name '*.asc' | head -n 1)
[ -n "$tarball" ] || fail "the source package $package has no original tarball"
tar -xf "$tarball" -C "$work/unity" --strip-components=1 --wildcards '*/tests/unity/*' ||
    fail "the source package $package no longer carries tests/unity"
found=$(find "$work/unity" -name unity.c | head -n 1)
[ -n "$found" ] || fail "no unity.c in the source package $package"
found=$(dirname "$found")
for file in unity.h unity_internals.h; do # some versions keep the headers in another folder
    [ -f "$found/$file" ] || cp "$(find "$work/unity" -name "$file" | head -n 1)" "$found/"
done
pinned "$found" || fail "the Unity in $package is not the version this project knows (checksums differ)"
install_from "$found"
