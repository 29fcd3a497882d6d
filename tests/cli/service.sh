#!/bin/sh
# R-12, R-09: the packages on a machine with a real systemd. It runs beside this one, in namespaces of
# its own, on a copy of this machine's files that is in memory and goes with it. The three commands
# of the README have the bottling line running as a service; then it is changed, killed, hung,
# upgraded and stopped.
. "$(dirname "$0")/lib.sh"
build=$(dirname "$bin")

[ "$(id -u)" = 0 ] && [ -x /lib/systemd/systemd ] && command -v dpkg-shlibdeps >/dev/null &&
  grep -qw overlay /proc/filesystems && unshare -mpfiuC true 2>/dev/null || {
  echo "needs root, systemd, dpkg-dev, namespaces and overlayfs"
  exit 77
}
expect 0 cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work/packages"

# The root has to be that of its mount namespace: one that was only changed by chroot gets no
# namespace of users (PrivateUsers of the unit).
cat >boot.sh <<'SH'
set -eu
mount -t tmpfs none "$1"
mkdir "$1/upper" "$1/work" "$1/root"
mount -t overlay overlay -o "lowerdir=/,upperdir=$1/upper,workdir=$1/work" "$1/root"
cp "$2"/stc_*.deb "$2"/stvm_*.deb "$1/root/root/"
cd "$1/root"
rm -rf etc/systemd/system/* etc/stvm var/lib/stvm
: >etc/fstab
mount -t tmpfs tmpfs tmp
mount -t tmpfs tmpfs run
mount -t proc proc proc
mount -t sysfs sysfs sys -o ro
mount -t tmpfs tmpfs sys/fs/cgroup
mount -t cgroup2 cgroup2 sys/fs/cgroup
mount --bind /dev dev
mkdir -p old
pivot_root . old
umount -l old
exec env -i container=other PATH="$PATH" /lib/systemd/systemd --system \
  --unit=multi-user.target --log-target=journal --show-status=no
SH
mkdir machine
unshare -mpfiuC --propagation private --kill-child sh boot.sh "$work/machine" "$work/packages" \
  >boot.log 2>&1 &
# Its first process is the child of unshare; everything there ends with it.
first=
trap '[ -z "$first" ] || kill -KILL "$first"; cleanup' EXIT INT TERM
for _ in $(seq 4000); do
  first=$(cat "/proc/$!/task/$!/children" 2>/dev/null) || fail "no machine: $(cat boot.log)"
  first=${first% }
  [ -n "$first" ] && [ "$(cat "/proc/$first/comm")" = systemd ] && break
  sleep 0.05
done
there() {
  nsenter -t "$first" -m -p -u -i -C -r -w env -i HOME=/root \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"
}
wait_for '^(running|degraded)$' there systemctl is-system-running
plc=/var/lib/stvm/line

# As the README has it.
expect 0 there sh -c 'apt-get install -y --no-install-recommends /root/stc_*.deb /root/stvm_*.deb'
expect 0 there stc build /usr/share/doc/stc/examples/bottling_line -o /etc/stvm/line.img
expect 0 there systemctl enable --now stvm@line

# It is ready when the command ends, as a user of its own, and root's tools talk to it.
expect 0 there systemctl show stvm@line -p ActiveState -p User -p StatusText
said '^ActiveState=active$'
said '^User=stvm$'
said '^StatusText=[0-9a-f]{12}'
expect 0 there stvm status --dir $plc
said ': running$'
expect 0 there journalctl -u stvm@line --no-pager
said 'ready: BottlingLine'
expect 0 there systemd-analyze security --threshold=25 stvm@line
expect 0 there stvm change /usr/share/doc/stc/examples/bottling_line_v2 --dir $plc --allow-loss \
  --yes --permanent --allow-overrun
expect 0 there stvm get --dir $plc CurrentState
changed=$(there stvm status --dir $plc --format json | sed 's/.*"running":"\([0-9a-f]*\)".*/\1/')
[ ${#changed} = 64 ] || fail "which program? $changed"

# pid_is_not PID: the service has another process.
pid() { there systemctl show stvm@line -p MainPID --value; }
runs_anew() {
  for _ in $(seq 4000); do
    now=$(pid)
    [ "$now" != "$1" ] && [ "$now" != 0 ] && there stvm status --dir $plc >out 2>err &&
      grep -q ': running$' out && return
    sleep 0.05
  done
  fail "process $1 has no follower"
}
runs_changed() {
  expect 0 there stvm status --dir $plc --format json
  json "d['running'] == '$changed'"
}

# An upgrade leaves it alone: the plant runs on with the process that it has.
was=$(pid)
expect 0 there sh -c 'apt-get install -y --reinstall --no-install-recommends /root/stvm_*.deb'
[ "$(pid)" = "$was" ] || fail "an upgrade has stopped the controller"

# Killed: it comes back with the program of the change, whatever /etc/stvm holds.
there kill -KILL "$was"
runs_anew "$was"
runs_changed

# Hung: its control loop gives no more signs of life, and the manager starts it anew.
there mkdir -p /run/systemd/system/stvm@line.service.d
echo '[Service]
WatchdogSec=1' | there tee /run/systemd/system/stvm@line.service.d/watchdog.conf >/dev/null
expect 0 there systemctl daemon-reload
was=$(pid)
expect 0 there systemctl restart stvm@line
runs_anew "$was"
was=$(pid)
there kill -STOP "$was"
runs_anew "$was"
runs_changed
expect 0 there journalctl -u stvm@line --no-pager
said 'Watchdog timeout'

# Stopped in order, and no start of its own after that.
expect 0 there systemctl stop stvm@line
expect 0 there systemctl show stvm@line -p ActiveState -p Result
said '^ActiveState=inactive$'
said '^Result=success$'
expect 7 there stvm status --dir $plc
said 'R0404'

# The package goes; what the controller knows stays.
expect 0 there apt-get remove -y stvm
expect 0 there test -e $plc/journal
