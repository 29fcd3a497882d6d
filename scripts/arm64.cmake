# Toolchain for AArch64 on a Debian of another kind (make test-arm64). Programs run under qemu.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
# -R: without it qemu keeps tables for every page of data memory (4 GiB) that was ever reserved.
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -R 64G -L /usr/aarch64-linux-gnu)
