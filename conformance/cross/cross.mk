# The decoder on other machines, by other compilers; included by the Makefile. Result in
# conformance/CROSS.md.
DEPS_CROSS = dpkg-dev clang-14 lld-14 qemu-user-static nodejs wine wine64 wasi-libc \
    libclang-rt-14-dev-wasm32 gcc-mingw-w64-x86-64 gcc-i686-linux-gnu libc6-dev-i386-cross \
    gcc-aarch64-linux-gnu libc6-dev-arm64-cross gcc-arm-linux-gnueabihf libc6-dev-armhf-cross \
    gcc-powerpc64le-linux-gnu libc6-dev-ppc64el-cross gcc-s390x-linux-gnu libc6-dev-s390x-cross
deps-cross: deps
	@$(call INSTALL_DEBIAN,$(DEPS_CROSS))

# All builds of conformance/cross/builds.txt that have no row; those whose tools are missing are
# skipped.
cross: $B/ted4conf
	TED4_BUILD=$(abspath $B) conformance/cross/cross.sh
$B/tests/tools/test_cross: | $B/ted4conf $B/ted4dec

.PHONY: deps-cross cross
