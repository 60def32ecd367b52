# packages.sh: the tools of this family (mk/setup/deps.sh).
have_picolibc() {
    have riscv64-unknown-elf-gcc && [ -e "$(riscv64-unknown-elf-gcc -print-file-name=picolibc.specs)" ]
}

want gcc-riscv64-unknown-elf "the compiler for RISC-V" have riscv64-unknown-elf-gcc
want picolibc-riscv64-unknown-elf "its C library, for the test programs" have_picolibc
want qemu-system-misc "the emulated RISC-V boards" have qemu-system-riscv32
