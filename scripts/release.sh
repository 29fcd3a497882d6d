#!/bin/sh
# release.sh OUT JOBS [ARCHITECTURE...]: all that a version is given out as, in OUT: Debian packages of
# this machine's architecture, the archives and images of scripts/archives.sh, and SHA256SUMS of them.
# The packages are installed and tried by their tests, lintian among them (R-12), before they are
# taken. build/release has to be built.
set -eu
out=$1
jobs=$2
shift 2
cd "$(dirname "$0")/.."
rm -rf "$out"
mkdir -p "$out"
ctest --test-dir build/release --output-on-failure --no-tests=error -R '^cli_(install|service|service_agent)$'
cpack -G DEB --config build/release/CPackConfig.cmake -B "$out" >/dev/null
rm -rf "$out/_CPack_Packages"
scripts/archives.sh "$out" "$jobs" "$@"
(cd "$out" && sha256sum -- *.deb *.tar.gz >SHA256SUMS)
ls -l "$out"
