# For scripts that need a machine with a real systemd, after lib.sh: one that runs beside this one, in
# namespaces of its own but for the network, on a copy of this machine's files that is in memory and
# goes with it. The Debian packages of this build lie in its /root. The test is skipped where that
# cannot be.
[ -n "$seccomp" ] || {
  echo "left out: the unit asks for --seccomp"
  exit 77
}
[ "$(id -u)" = 0 ] && [ -x /lib/systemd/systemd ] && command -v dpkg-shlibdeps >/dev/null &&
  grep -qw overlay /proc/filesystems && unshare -mpfiuC true 2>/dev/null || {
  echo "needs root, systemd, dpkg-dev, namespaces and overlayfs"
  exit 77
}
expect 0 cpack -G DEB --config "$(dirname "$bin")/CPackConfig.cmake" -B "$work/packages"

# The root has to be that of its mount namespace: one that was only changed by chroot gets no
# namespace of users (PrivateUsers of the unit).
cat >boot.sh <<'SH'
set -eu
mount -t tmpfs none "$1"
mkdir "$1/upper" "$1/work" "$1/root"
mount -t overlay overlay -o "lowerdir=/,upperdir=$1/upper,workdir=$1/work" "$1/root"
cp "$2"/*.deb "$1/root/root/"
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
trap '[ -z "$first" ] || kill -KILL "$first" 2>/dev/null; cleanup' EXIT
trap 'exit 1' INT TERM
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

# has_followed UNIT PID CHECK...: another process of the service, with which the check succeeds.
main_pid() { there systemctl show "$1" -p MainPID --value; }
has_followed() {
  unit=$1
  old=$2
  shift 2
  for _ in $(seq 4000); do
    now=$(main_pid "$unit")
    [ "$now" != "$old" ] && [ "$now" != 0 ] && "$@" && return
    sleep 0.05
  done
  fail "process $old of $unit has no follower"
}
