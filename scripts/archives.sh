#!/bin/sh
# archives.sh OUT JOBS [ARCHITECTURE...]: for each of amd64 and arm64 (or those named) an archive of
# static tools, stc-VERSION-linux-ARCHITECTURE.tar.gz, to be unpacked in /usr/local; and of `stvm` an
# image in the layout of OCI. The same sources give the same bytes. Each archive is unpacked into an
# empty root, where the bottling line is compiled, run and changed; then the image is started as it
# says itself, with that line in its volume.
set -eu
out=$1
jobs=$2
shift 2
[ $# -ne 0 ] || set -- amd64 arm64
source=$(cd "$(dirname "$0")/.." && pwd)
cd "$source"
mkdir -p "$out"
out=$(cd "$out" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
version=$(cat VERSION)

# pack FILE FOLDER...: of the working folder; neither times nor owners of this machine.
pack() {
  file=$1
  shift
  tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -cf - "$@" | gzip -9n >"$file"
}

digest() { sha256sum "$1" | cut -d ' ' -f 1; }

# blob FILE: takes it into the image; prints its digest and size as JSON fields.
blob() {
  sum=$(digest "$1")
  cp "$1" "$image/blobs/sha256/$sum"
  printf '"digest":"sha256:%s","size":%s' "$sum" "$(stat -c %s "$1")"
}

# oci_image ARCHITECTURE BIN: the image has the tools, since changes are made by them, and a folder
# for packages. It serves what its volume /var/lib/stvm holds; the first program is
# /etc/stvm/first.img, which is to be mounted there.
oci_image() {
  image=$work/oci-$1
  mkdir -p "$image/blobs/sha256" "$work/layer-$1/bin" "$work/layer-$1/var/lib/stvm"
  mkdir -m 1777 "$work/layer-$1/tmp"
  cp "$2/"* "$work/layer-$1/bin/"
  (cd "$work/layer-$1" && pack "$work/layer-$1.tar.gz" bin tmp var)
  gzip -dc "$work/layer-$1.tar.gz" >"$work/layer-$1.tar"
  cat >"$work/config.json" <<JSON
{"architecture":"$1","os":"linux","config":{"Entrypoint":["/bin/stvm"],"Cmd":["serve","--dir","/var/lib/stvm","--first","/etc/stvm/first.img"],"Volumes":{"/var/lib/stvm":{}},"StopSignal":"SIGTERM","Labels":{"org.opencontainers.image.title":"stvm","org.opencontainers.image.version":"$version"}},"rootfs":{"type":"layers","diff_ids":["sha256:$(digest "$work/layer-$1.tar")"]}}
JSON
  printf '{"schemaVersion":2,"mediaType":"application/vnd.oci.image.manifest.v1+json","config":{"mediaType":"application/vnd.oci.image.config.v1+json",%s},"layers":[{"mediaType":"application/vnd.oci.image.layer.v1.tar+gzip",%s}]}\n' \
    "$(blob "$work/config.json")" "$(blob "$work/layer-$1.tar.gz")" >"$work/manifest.json"
  printf '{"schemaVersion":2,"manifests":[{"mediaType":"application/vnd.oci.image.manifest.v1+json",%s,"annotations":{"org.opencontainers.image.ref.name":"%s"}}]}\n' \
    "$(blob "$work/manifest.json")" "$version" >"$image/index.json"
  printf '{"imageLayoutVersion":"1.0.0"}\n' >"$image/oci-layout"
  (cd "$image" && pack "$out/stvm-$version-oci-$1.tar.gz" blobs index.json oci-layout)
  if command -v skopeo >/dev/null; then
    skopeo inspect "oci-archive:$out/stvm-$version-oci-$1.tar.gz" >/dev/null
  fi
}

# enter ROOT ARCHITECTURE: in_root COMMAND... runs there; elsewhere by qemu, which it gets.
enter() {
  root=$1
  runner=""
  if [ "$2" = arm64 ] && [ "$(uname -m)" != aarch64 ]; then
    cp "$(command -v qemu-aarch64-static)" "$root/qemu"
    # -R: qemu keeps tables for every page of data memory that was ever reserved.
    runner="/qemu -R 64G"
  fi
}
in_root() { chroot "$root" $runner "$@"; }

# serve STVM DIRECTORY COMMAND...: in the root, until the program runs.
serve() {
  tool=$1
  state=$2
  shift 2
  # shellcheck disable=SC2086
  chroot "$root" $runner "$@" >"$work/served" 2>&1 </dev/null &
  served=$!
  trap 'kill $served 2>/dev/null; rm -rf "$work"' EXIT
  tries=0
  until in_root "$tool" status --dir "$state" 2>/dev/null | grep -q ': running$'; do
    tries=$((tries + 1))
    [ "$tries" -lt 600 ] || { cat "$work/served"; echo "archives: the line does not run" >&2; exit 1; }
    sleep 0.1
  done
}
served_ends() {
  in_root "$1" stop --dir "$2"
  wait "$served"
  trap 'rm -rf "$work"' EXIT
}

# change BIN DIRECTORY: to /next.img. Under qemu the package is made apart: the kernel starts no stc of
# that processor when stvm asks for it; and it is slow, so scans are missed.
change() {
  if [ -n "$runner" ]; then
    in_root "$1/stc" package --base /line.img /next.img -o /next.pkg >"$work/built"
    set -- "$@" /next.pkg --allow-overrun
  else
    set -- "$@" /next.img
  fi
  tool=$1/stvm
  state=$2
  shift 2
  in_root "$tool" change "$@" --dir "$state" --allow-loss --yes --permanent
}

# runs_line ARCHITECTURE: with nothing in the root but the archive (and, elsewhere, qemu).
runs_line() {
  mkdir -p "$work/root-$1/usr/local" "$work/root-$1/tmp"
  tar -xzf "$out/stc-$version-linux-$1.tar.gz" -C "$work/root-$1/usr/local"
  enter "$work/root-$1" "$1"
  tools=/usr/local/bin
  in_root $tools/stc build /usr/local/share/doc/stc/examples/bottling_line -o /line.img >"$work/built"
  in_root $tools/stc build /usr/local/share/doc/stc/examples/bottling_line_v2 -o /next.img >"$work/built"
  serve $tools/stvm /state $tools/stvm serve --dir /state --first /line.img
  change $tools /state
  served_ends $tools/stvm /state
  echo "archives: the line runs and is changed in an empty root ($1)"
}

# starts_image ARCHITECTURE: the OCI image by its own entry point and command; behind runs_line.
starts_image() {
  mkdir -p "$work/image-$1/etc/stvm"
  "$source/scripts/unpack_image.py" "$out/stvm-$version-oci-$1.tar.gz" "$work/image-$1" >"$work/command"
  cp "$work/root-$1/line.img" "$work/image-$1/etc/stvm/first.img"
  cp "$work/root-$1/line.img" "$work/root-$1/next.img" "$work/image-$1/"
  enter "$work/image-$1" "$1"
  # shellcheck disable=SC2046
  serve /bin/stvm /var/lib/stvm $(cat "$work/command")
  change /bin /var/lib/stvm
  served_ends /bin/stvm /var/lib/stvm
  echo "archives: the image starts and is changed ($1)"
}

for architecture in "$@"; do
  preset=static
  [ "$architecture" = "$(dpkg --print-architecture)" ] || preset=static-$architecture
  cmake --preset "$preset" >/dev/null
  cmake --build "build/$preset" -j "$jobs" --target stc stvm
  tree=$work/tree-$architecture
  DESTDIR=$tree cmake --install "build/$preset" --prefix /usr/local >/dev/null
  strip=strip
  [ "$architecture" = "$(dpkg --print-architecture)" ] || strip=aarch64-linux-gnu-strip
  "$strip" "$tree/usr/local/bin/"*
  cp LICENSE "$tree/usr/local/share/doc/stc/"
  (cd "$tree/usr/local" && pack "$out/stc-$version-linux-$architecture.tar.gz" bin lib share)
  oci_image "$architecture" "$tree/usr/local/bin"
  runs_line "$architecture"
  starts_image "$architecture"
done
(cd "$out" && sha256sum -- *.tar.gz >SHA256SUMS && cat SHA256SUMS)
