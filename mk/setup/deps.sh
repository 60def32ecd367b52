#!/bin/sh
# deps.sh GROUP...: installs the Debian packages that a make target needs and that are missing.
#
# Groups: host (compiler), plot, firmware (Arm compiler and emulator), boards (those of all processors) or a folder of
# boards/ with a packages.sh (its own), tests, quality (linters, sanitizers), bench; hosts (other compilers, C libraries and
# processors) and flash (programmers and a debugger) only if they are named.
# Installed tools are recognised by their command or file, not by their package, so a compiler from another source counts.
# If nothing is missing, the script prints nothing and takes milliseconds. Before it installs, it prints the packages, what
# needs them, and the size. If it cannot install, it prints the command to do so (exit status 1).
# DEPS_DRY_RUN=1 only prints what is missing (exit status 1 if anything is).
set -eu
boards=${0%/*}/../../boards

missing="" # packages to install
told=""    # a line for each package: its name, the part of Whirl that needs it, and its purpose
part=""    # the part of Whirl that needs the current group

# want PACKAGE "purpose" TEST...: notes the package as missing if the test fails.
want() {
    package=$1 what=$2
    shift 2
    "$@" && return 0
    case " $missing " in *" $package "*) return 0 ;; esac
    missing="$missing $package"
    told="$told$(printf '    %-26s %-14s %s' "$package" "$part" "$what")
"
}
have() { command -v "$1" >/dev/null 2>&1; }
# True when the pattern names at least one file.
have_file() {
    for file in "$@"; do [ ! -e "$file" ] || return 0; done
    return 1
}
# gcc-multilib would allow -m32, but cannot be installed beside the cross compilers.
can_m32() { have gcc && echo 'int main(void) { return 0; }' | gcc -m32 -x c - -o /dev/null 2>/dev/null; }
# The packages of a family of boards are `want` lines in its folder.
family() {
    # shellcheck source=/dev/null
    . "$boards/$1/packages.sh"
}

group() {
    case $1 in
    host) part="whirl"
        want gcc "the C compiler" have "${CC:-gcc}"
        want binutils "ar, objdump and size" have ar
        want libc6-dev "the C library's headers" have_file /usr/include/stdio.h /usr/lib/musl/include/stdio.h ;;
    plot) part="plots"
        want gnuplot-nox "plots" have gnuplot ;;
    firmware) part="boards"
        family cortexm ;;
    boards) part="make check"
        for packages in "$boards"/*/packages.sh; do
            # shellcheck source=/dev/null
            . "$packages"
        done ;;
    tests) part="make test"
        [ -n "${UNITY:-}" ] || want xz-utils "unpacking the Unity test framework" have xz
        want g++ "embedding scenes in C++" have g++ ;;
    quality) part="make check"
        want clang "the second compiler" have clang
        want libclang-rt-dev "clang's sanitizers and fuzzer" \
            have_file /usr/lib/llvm-*/lib/clang/*/lib/linux/libclang_rt.fuzzer*
        want clang-format "the layout gate" have clang-format
        want clang-tidy "the lint gate" have clang-tidy
        want cppcheck "the second lint gate" have cppcheck
        want musl-tools "another C library" have musl-gcc
        want wasi-libc "the C library of WebAssembly" have_file /usr/lib/wasm32-wasi/libc.a
        want libclang-rt-dev-wasm32 "clang's support code for WebAssembly" \
            have_file /usr/lib/llvm-*/lib/clang/*/lib/wasi/libclang_rt.builtins-wasm32.a
        want llvm "its archiver" have llvm-ar
        want lld "the linker for WebAssembly" have wasm-ld
        want nodejs "running WebAssembly" have node ;;
    bench) part="make bench"
        want valgrind "instruction counts on the PC" have valgrind ;;
    hosts) part="make hosts"
        major=$(gcc -dumpversion 2>/dev/null | cut -d . -f 1)
        want "lib32gcc-${major:-12}-dev" "32-bit programs" can_m32
        want libc6-dev-i386 "32-bit programs" can_m32
        want gcc-aarch64-linux-gnu "the compiler for aarch64" have aarch64-linux-gnu-gcc
        want libc6-dev-arm64-cross "its C library" have_file /usr/aarch64-linux-gnu/lib/libc.a
        want gcc-arm-linux-gnueabihf "the compiler for armhf" have arm-linux-gnueabihf-gcc
        want libc6-dev-armhf-cross "its C library" have_file /usr/arm-linux-gnueabihf/lib/libc.a
        want qemu-user "running programs for these" have qemu-aarch64 ;;
    flash) part="make flash"
        want openocd "programming and debugging through a probe" have openocd
        want dfu-util "programming through USB" have dfu-util
        want gdb-multiarch "the debugger" have gdb-multiarch ;;
    *) part="boards"
        [ -e "$boards/$1/packages.sh" ] || { echo "deps.sh: no such group: $1" >&2; exit 2; }
        family "$1" ;;
    esac
}
[ $# -gt 0 ] || set -- host plot firmware boards tests quality bench
for name in "$@"; do group "$name"; done

[ -n "$missing" ] || exit 0
line="apt-get install --no-install-recommends -y$missing"
echo "Missing on this machine (Debian package, what of Whirl needs it, what for):"
printf '%s' "$told"
[ -z "${DEPS_DRY_RUN:-}" ] || exit 1

give_up() {
    printf '%s Please have this done, then try again:\n\n    %s\n\n' "$1" "$line" >&2
    exit 1
}
have apt-get || give_up "This is no Debian: these are the packages' names there."

# Prints the total size with all dependencies. Fails if the package lists lack a package.
size() {
    LC_ALL=C apt-get install --no-install-recommends -o Debug::NoLocking=1 --print-uris $missing 2>/dev/null </dev/null |
        sed -n 's/^Need to get /To be fetched: /p; s/^After this operation, /On disk: /p' | grep .
}
if [ "$(id -u)" -eq 0 ]; then
    as_root=""
elif have sudo && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
    as_root="sudo"
else
    size || true
    give_up "Installing takes root's rights, and sudo does not give them here."
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
trap 'exit 1' HUP INT TERM
update() {
    echo "Updating the package lists (apt-get update)"
    $as_root apt-get update >"$log" 2>&1 </dev/null || true
}
install() { $as_root env DEBIAN_FRONTEND=noninteractive $line >"$log" 2>&1 </dev/null; }

# The package lists are fetched only if they are absent or too old to install from.
size || { update && size; } || true
echo "Installing them: $as_root${as_root:+ }$line"
install || { update && install; } || { tail -n 5 "$log" >&2; give_up "Installing did not work."; }
# Success is decided by the tools, not by the package manager.
DEPS_DRY_RUN=1 "$0" "$@" || give_up "Still missing after installing."
