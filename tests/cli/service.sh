#!/bin/sh
# R-12, R-09: the packages on a machine with a real systemd. The three commands of the README have the
# bottling line running as a service; then it is changed, killed, hung, upgraded and stopped.
. "$(dirname "$0")/lib.sh"
. "$source_dir/tests/cli/lib_machine.sh"
plc=/var/lib/stvm/line

# As the README has it.
grep -A3 '^sudo apt install' "$source_dir/README.md" | sed '/^```/,$d
  s/sudo apt install/apt-get install -y --no-install-recommends/; s/sudo //; s#build/release/#root/#g' >commands
[ "$(wc -l <commands)" -eq 3 ] || fail "the commands of the README: $(cat commands)"
expect 0 there sh -ec "cd /; $(cat commands)"

# It is ready when the command ends, as a user of its own, and root's tools talk to it.
expect 0 there systemctl show stvm@line -p ActiveState -p User -p StatusText
said '^ActiveState=active$'
said '^User=stvm$'
said '^StatusText=[0-9a-f]{12}'
expect 0 there stvm status --dir $plc
said ': running$'
expect 0 there journalctl -u stvm@line --no-pager
said 'ready: BottlingLine'
# What fails again and again stays down, outputs safe.
expect 0 there systemctl show stvm@line -p StartLimitBurst -p StartLimitIntervalUSec -p RestartUSec
said '^StartLimitBurst=10$'
said '^StartLimitIntervalUSec=5min$'
said '^RestartUSec=1s$'
expect 0 there systemd-analyze security --threshold=25 stvm@line
expect 0 there stvm change /usr/share/doc/stc/examples/bottling_line_v2 --dir $plc --allow-loss \
  --yes --permanent --allow-overrun
expect 0 there stvm get --dir $plc CurrentState
changed=$(there stvm status --dir $plc --format json | sed 's/.*"running":"\([0-9a-f]*\)".*/\1/')
[ ${#changed} = 64 ] || fail "which program? $changed"

is_running() { there stvm status --dir $plc >out 2>err && grep -q ': running$' out; }
runs_changed() {
  expect 0 there stvm status --dir $plc --format json
  json "d['running'] == '$changed'"
}

# An upgrade leaves it alone: the plant runs on with the process that it has.
was=$(main_pid stvm@line)
expect 0 there sh -c 'apt-get install -y --reinstall --no-install-recommends /root/stvm_*.deb'
[ "$(main_pid stvm@line)" = "$was" ] || fail "an upgrade has stopped the controller"

# Killed: it comes back with the program of the change, whatever /etc/stvm holds.
there kill -KILL "$was"
has_followed stvm@line "$was" is_running
runs_changed

# Hung: its control loop gives no more signs of life, and the manager starts it anew.
there mkdir -p /run/systemd/system/stvm@line.service.d
echo '[Service]
WatchdogSec=1' | there tee /run/systemd/system/stvm@line.service.d/watchdog.conf >/dev/null
expect 0 there systemctl daemon-reload
was=$(main_pid stvm@line)
expect 0 there systemctl restart stvm@line
has_followed stvm@line "$was" is_running
was=$(main_pid stvm@line)
there kill -STOP "$was"
has_followed stvm@line "$was" is_running
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

# The package goes, and with it a controller that runs; what it knows stays.
expect 0 there systemctl start stvm@line
expect 0 there apt-get remove -y stvm
expect 0 there systemctl show stvm@line -p ActiveState -p Result
said '^ActiveState=inactive$'
said '^Result=success$'
expect 0 there test -e $plc/journal
expect 0 there test -h /etc/systemd/system/multi-user.target.wants/stvm@line.service
expect 0 there apt-get purge -y stvm
expect 1 there test -h /etc/systemd/system/multi-user.target.wants/stvm@line.service
expect 0 there test -e $plc/journal
