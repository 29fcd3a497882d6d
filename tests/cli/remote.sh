#!/bin/sh
# A controller on another machine over `ssh HOST stvm bridge`, with a stand-in for ssh that runs the command here; and the fate
# report against what runs, after the build folder is lost (X1).
. "$(dirname "$0")/lib.sh"

# Refuses what no host is, notes how it was called, runs the command as sshd's shell would.
cat >ssh <<SH
#!/bin/sh
[ "\$1" = -T ] || exit 99
echo "\$2" >>"$work/hosts"
[ "\$2" = plant7 ] || { echo "ssh: no such host" >&2; exit 255; }
PATH=$bin:\$PATH exec sh -c "\$3"
SH
chmod +x ssh
STVM_SSH=$work/ssh
export STVM_SSH

printf 'PROGRAM Main VAR n : INT; gone : INT; END_VAR n := n + 1; END_PROGRAM\n' >v1.st
printf 'PROGRAM Main VAR n : DINT; more : BOOL := TRUE; END_VAR n := n + 1; END_PROGRAM\n' >v2.st
directory="it's a folder"
serve "$directory" v1.st
rm v1.st

expect 0 stvm status --host plant7 --dir "$work/$directory"
said 'Main|v1'
expect 0 stvm set --host plant7 --dir "$work/$directory" Main.gone=5
expect 0 stvm get --dir "$directory" Main.gone
said '5'
expect 0 stc diff --against "$work/$directory" v2.st
said 'converted +Main.n : INT -> DINT'
said 'dropped +Main.gone'
expect 0 stc diff --against "$work/$directory" v2.st --format json
said '"variable": *"Main.more"'
cp out local
STVM_DIR=$work/$directory
export STVM_DIR
expect 0 stc diff --against plant7 v2.st --format json
cmp out local || fail "the report over ssh is another one"
unset STVM_DIR
grep -q plant7 hosts || fail "ssh was not used"

expect 0 stvm change v2.st --host plant7 --dir "$work/$directory" --yes --allow-loss
said 'on trial'
expect 0 stvm undo --host plant7 --dir "$work/$directory"
expect 0 stvm get --dir "$directory" Main.gone
said '5'

expect 0 stvm journal --dir "$directory"
cp out local
expect 0 stvm journal --host plant7 --dir "$work/$directory"
cmp out local || fail "the journal over ssh is another one"
said 'undone'
expect 7 stvm journal --host elsewhere
said 'R0404'

expect 7 stvm status --host elsewhere
said 'R0404.*on elsewhere'
# What the other machine writes to standard error is made visible.
cat >rogue <<'SH'
#!/bin/sh
sleep 300 >/dev/null </dev/null &  # holds standard error, as the master of ssh's ControlPersist does
echo $! >"$0.pid"
printf 'motd \033]0;gone\007 \033[2J\r\nunfinished' >&2
exit 255
SH
chmod +x rogue
STVM_SSH=$work/rogue expect 7 stvm status --host plant7
grep -q '^motd \\x1b\]0;gone\\x07 \\x1b\[2J$' err || fail "escape bytes of the other machine: $(cat -v err)"
kill -0 "$(cat rogue.pid)" || fail "the tool waited for a process that holds the pipe"
grep -q '^unfinished$' err || fail "its last line"
grep -q 'R0404' err || fail "no refusal"
expect 2 stvm status --host=-oProxyCommand=touch
said 'names a machine'
expect 7 stvm bridge --dir nowhere
said 'R0404'
expect 7 stc diff --against nowhere-at-all v2.st
said 'R0404'
expect 2 stc diff v2.st
said 'against'
expect 2 stvm image --dir "$directory"
said 'output'
# A client that goes away in the middle of a message, and one that says nothing, leave the controller alone.
printf '\377\377\377' | stvm bridge --dir "$directory" >/dev/null || true
expect 0 stvm stop --host plant7 --dir "$work/$directory"

# A controller ends connections that ask nothing for long. The bridge finds it again with the next request, and ends when
# there is none: here it was started anew in the meantime.
end() {  # until it has given its folder back
  expect 0 stvm stop --dir "$directory"
  wait "$(cat "$directory.pid")" || true
}
wait "$(cat "$directory.pid")" || true
serve "$directory"
mkfifo requests
"$bin/stvm" bridge --dir "$directory" <requests >answers 2>bridge.err &
bridge=$!
echo "$bridge" >bridge.pid
exec 3>requests
version=$(sed -n 's/.*kProtocolVersion = \([0-9]*\);.*/\1/p' "$source_dir/vm/runtime/protocol.h")
request() { printf "\\002\\000\\000\\000\\$(printf %03o "$version")\\000" >&3; }  # for a status
asked() {  # until there is more of answers than before
  before=$(stat -c %s answers)
  request
  for _ in $(seq 4000); do
    [ "$(stat -c %s answers)" -gt "$before" ] && return
    sleep 0.05
  done
  fail 'the bridge brings no answer'
}
asked
end
serve "$directory"
asked
asked
end
request
code=0
wait "$bridge" || code=$?
rm bridge.pid
[ "$code" -eq 7 ] || fail "exit code $code of a bridge without a controller"
grep -q R0404 bridge.err || fail 'the bridge does not say why it ends'
exec 3>&-
