# packages.sh: the tools of this family (mk/setup/deps.sh).
# The Arm compiler knows where its C library is, wherever it came from.
have_arm_library() {
    have_file /usr/lib/arm-none-eabi/lib/libc.a /usr/lib/arm-none-eabi/newlib/libc.a && return 0
    have arm-none-eabi-gcc && [ -e "$(arm-none-eabi-gcc -print-file-name=libc.a)" ]
}

want gcc-arm-none-eabi "the compiler for the boards" have arm-none-eabi-gcc
want libnewlib-arm-none-eabi "its C library, for the test programs" have_arm_library
want qemu-system-arm "the emulated boards" have qemu-system-arm
