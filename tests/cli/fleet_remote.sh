#!/bin/sh
# E-27, E-30: a fleet on other machines, over `ssh HOST stvm bridge`, with a stand-in for ssh. One
# host is not there, and one says nothing.
. "$(dirname "$0")/lib.sh"

cat >ssh <<SH
#!/bin/sh
[ "\$1" = -T ] || exit 99
echo "\$2" >>"$work/hosts"
case "\$2" in
  plc@*) STVM_DIR=$work/\${2#plc@} PATH=$bin:\$PATH exec sh -c "\$3" ;;
  silent) echo \$\$ >"$work/silent"; exec sleep 1000 ;;
esac
echo "ssh: no such host" >&2
exit 255
SH
chmod +x ssh
STVM_SSH=$work/ssh
export STVM_SSH

# own NAME: how the controller of that machine differs.
project() {
  cat >"$1" <<ST
FUNCTION_BLOCK A VAR_OUTPUT n : INT; END_VAR n := n + $2; END_FUNCTION_BLOCK
FUNCTION_BLOCK B VAR_OUTPUT n : INT; END_VAR n := n + $3; END_FUNCTION_BLOCK
PROGRAM Main VAR a1 : A; b1 : B; END_VAR a1(); b1(); END_PROGRAM
ST
}
project original.st 1 1
project new.st 2 1
project own.st 1 7
expect 0 stc fleet original.st new.st -o x.fleet
serve line1 original.st
serve line2 own.st
cat >fleet.toml <<'TOML'
[controllers.line1]
host = "plc@line1"
[controllers.line2]
host = "plc@line2"
name = "Line 2"
[controllers.gone]
host = "gone"
TOML
expect 1 stvm fleet status --fleet fleet.toml
said '^part +line1 +Line 2$'
said '^unit B +[0-9a-f]{8} +[0-9a-f]{8}[*]$'
said '^gone +unreachable +R0404: '
awk 'length($0) > 80 { exit 1 }' out || fail "wider than 80 columns"
said '^gone: R0404: the controller on gone closed the connection$'
expect 7 stvm fleet status --host silent --timeout 1
said '^silent: R0404: the controller on silent does not answer$'
if kill -0 "$(cat silent)" 2>/dev/null; then fail "the ssh that says nothing is still there"; fi

# A `dir` is a folder, also one that is not there, and a `host` is a host, also one that a folder has
# the name of: ssh is asked for hosts only. So it is for who is left, and in a plan.
rm hosts
printf '[controllers.off]\ndir = "off"\n' >off.toml
expect 7 stvm fleet change x.fleet --fleet off.toml --dir other --yes
said '^not done: R0404: no controller runs there: off: '
said '^not done: R0404: no controller runs there: other: '
expect 7 stvm fleet continue x.fleet --yes
said '^not done: R0404: no controller runs there: .*/off: '
printf '[roll]\nsoak = "0s"\n[[wave]]\ncount = 1\nmax_failed = 1\n' >>off.toml
expect 1 stvm fleet roll x.fleet --fleet off.toml --yes
said 'no controller runs there: .*/off: '
[ ! -e hosts ] || fail "ssh was asked for a folder: $(cat hosts)"
expect 7 stvm fleet status x.fleet --host line1
said '^line1: R0404: the controller on line1 closed the connection$'
rm x.fleet.*

expect 1 stvm fleet change x.fleet --fleet fleet.toml --yes --allow-overrun --jobs 4
said '^line1 +original +done '
said '^Line 2 +own +done '
said '^1 left: '
sed -i '/gone\]/,$d' fleet.toml
expect 0 stvm fleet status x.fleet --fleet fleet.toml
said '^unit A +has it$'
expect 1 stvm fleet diff line1 'Line 2' --fleet fleet.toml
said '^unit B +[0-9a-f]{12} +[0-9a-f]{12}$'
expect 0 stvm journal --host plc@line2
said 'edit E1, fleet file'
expect 0 stvm fleet accept x.fleet --host plc@line1 --yes
said '^plc@line1 +original +accepted +E1 *$'
expect 1 stvm fleet undo x.fleet --fleet fleet.toml --yes --allow-overrun
said '^line1 +original +refused +- +R0305: '
said '^Line 2 +own +undone +E1 '
expect 0 stvm edits --dir line2
said 'no edit is on trial'
expect 0 stvm fleet change x.fleet --fleet fleet.toml --yes --allow-overrun
said '^Line 2 +own +done '
expect 0 stvm status --units --host plc@line1
