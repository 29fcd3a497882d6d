#!/bin/sh
# R-12: what is installed, and what is in the Debian packages, runs by itself in an empty root: the
# bottling line is compiled there, becomes the first program of a controller as the unit of systemd
# starts it, and is changed. The unit is hardened.
. "$(dirname "$0")/lib.sh"
build=$(dirname "$bin")

# runs_line ROOT: the line is compiled and changed with what is below ROOT/usr.
runs_line() {
  root=$1
  installed=$root/usr/bin
  examples=$root/usr/share/doc/stc/examples
  state=$work/$(basename "$root").state
  [ -x "$examples/fleet/run.sh" ] || fail "the fleet to try cannot be run"
  # Ansible finds it there without being told, below /usr.
  [ -e "$root/usr/share/ansible/plugins/modules/stvm_change.py" ] || fail "no module of Ansible"
  expect 0 "$installed/stc" build "$examples/bottling_line" -o "$root/line.img"
  # As the unit does it, but for the places.
  grep -q '^ExecStart=/usr/bin/stvm serve --seccomp --dir /var/lib/stvm/%i --first /etc/stvm/%i.img$' \
    "$root"/usr/lib/systemd/system/stvm@.service || fail "the unit starts something else"
  "$installed/stvm" serve $seccomp --dir "$state" --first "$root/line.img" >"$state.log" 2>&1 &
  echo $! >"$state.pid"
  wait_for ': running$' "$installed/stvm" status --dir "$state"
  expect 0 "$installed/stvm" change "$examples/bottling_line_v2" --dir "$state" --allow-loss --yes \
    --permanent
  expect 0 "$installed/stvm" stop --dir "$state"
  wait "$(cat "$state.pid")" || true
  # From then on the first image is not read, not even looked for.
  rm "$root/line.img"
  "$installed/stvm" serve $seccomp --dir "$state" --first "$root/line.img" >"$state.log" 2>&1 &
  echo $! >"$state.pid"
  wait_for ': running$' "$installed/stvm" status --dir "$state"
  expect 0 "$installed/stvm" get --dir "$state" CurrentState
  expect 0 "$installed/stvm" stop --dir "$state"
}

expect 2 "$bin/stvm" serve --dir none --first a.img b.img
said '--first is for a start without other programs'
expect 7 "$bin/stvm" serve --dir none --first missing.img
said 'missing.img'

expect 0 env DESTDIR="$work/root" cmake --install "$build" --prefix /usr --strip
runs_line "$work/root"

# unit FILE SED: the installed unit, with the program where it is installed here.
unit() {
  sed "s#^ExecStart=/usr/bin/stvm#ExecStart=$work/root/usr/bin/stvm#; $2" \
    root/usr/lib/systemd/system/stvm@.service >"$1"
}
if command -v systemd-analyze >/dev/null; then
  # No system runs here: systemd reads the unit, knows every key of it, and rates it.
  unit stvm@line.service ''
  expect 0 systemd-analyze verify --man=no "$work/stvm@line.service"
  silent_on err
  expect 0 systemd-analyze security --offline=true --threshold=25 stvm@line.service
  # Also with what its comments say of a port below 1024.
  said 'PrivateUsers'
  unit stvm@port.service '/^CapabilityBoundingSet=/s/$/CAP_NET_BIND_SERVICE/
    s/^PrivateUsers=yes/PrivateUsers=no\nAmbientCapabilities=CAP_NET_BIND_SERVICE/'
  [ "$(grep -c 'CAP_NET_BIND_SERVICE$' stvm@port.service)" -eq 2 ] || fail 'another unit'
  expect 0 systemd-analyze verify --man=no "$work/stvm@port.service"
  silent_on err
  expect 0 systemd-analyze security --offline=true --threshold=25 stvm@port.service
fi

if command -v dpkg-deb >/dev/null && command -v dpkg-shlibdeps >/dev/null; then
  expect 0 cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work/packages"
  for package in stc stvm; do
    file=$(ls packages/${package}_*.deb)
    expect 0 dpkg-deb --field "$file" Package Depends
    said "^Package: $package\$"
    said 'libc6'
    expect 0 dpkg-deb --extract "$file" deb
  done
  if command -v lintian >/dev/null; then
    expect 0 lintian --allow-root --fail-on error packages/*.deb
  fi
  expect 0 dpkg-deb --field packages/stvm_*.deb Depends
  said 'systemd'
  runs_line "$work/deb"
  # A machine that only runs programs needs no compiler.
  expect 0 dpkg-deb --contents packages/stvm_*.deb
  if grep -qE '/stc$' out; then fail "the compiler is in the package of stvm"; fi
fi
