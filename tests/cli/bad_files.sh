#!/bin/sh
# Bad input on the command line: one clear line, the exit code, nothing half-written.
. "$(dirname "$0")/lib.sh"

cat >good.st <<'ST'
PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM
ST
expect 0 stc build good.st -o good.img
[ -s good.img ] || fail "no image"

expect 7 stc build nothing_here.st -o x.img
said 'R0501.*nothing_here.st'
expect 7 stc build good.st -o no/such/folder/x.img
said 'R0503.*no/such/folder'
expect 7 stc build good.st -o /dev/full
said 'R0503.*No space left'
# A file that may not grow is an error as a full disk is, not the end of the process by a signal.
limited=$(sh -c 'ulimit -f 0; "$@" 2>&1; echo "code $?"' sh "$bin/stc" build good.st -o limited.img)
echo "$limited" | grep -q 'R0503.*File too large' || fail "with a limit: $limited"
echo "$limited" | grep -qx 'code 7' || fail "with a limit: $limited"
expect 2 stc build
said 'R0504'
expect 2 stc build good.st --frobnicate
said 'unknown option --frobnicate'
expect 2 stc frobnicate
said 'unknown command'

mkdir empty
expect 7 stc check empty
said 'no sources'

printf 'PROGRAM Main VAR n : INT; END_VAR n := m; END_PROGRAM\n' >bad.st
expect 1 stc check bad.st
said 'bad.st:1:[0-9]+: error\[E'
expect 1 stc build bad.st -o bad.img
[ ! -e bad.img ] || fail "an image in spite of errors"
expect 1 stc check --format json bad.st
said '"code"'
expect 1 stc check --format sarif bad.st
said '2\.1\.0'

head -c 100 good.img >short.img
expect 7 stvm run short.img --virtual-time --scans 1
said 'R01'
head -c 4000 /dev/urandom >noise.img
expect 7 stvm run noise.img --virtual-time --scans 1
said 'R0'
expect 7 stvm run missing.img --virtual-time --scans 1
said 'R0501'

# Tampered with and hashed anew: what comes behind the name and a number is the size of data memory.
cp good.img evil.img
name=$(od -An -tu4 -j56 -N4 good.img | tr -d ' ')
env printf '\x00\x00\x00\x00' | dd of=evil.img bs=1 seek=$((64 + name)) conv=notrunc 2>/dev/null
sum=$(tail -c +49 evil.img | sha256sum | cut -c1-64 | sed 's/../\\x&/g')
env printf "$sum" | dd of=evil.img bs=1 seek=16 conv=notrunc 2>/dev/null
cmp -s good.img evil.img && fail "nothing was changed"
expect 7 stvm run evil.img --virtual-time --scans 1
said 'R0113'
expect 7 stc dump evil.img
said 'R0113.*evil.img'
expect 7 stc diff good.img evil.img
said 'R0113'
expect 7 stc diff evil.img good.img
expect 7 stc build good.st --base evil.img -o x.img
said 'R0113'
expect 7 stc package good.st --base evil.img -o x.pkg
said 'R0113'

printf 'name = 5\n' >empty/stc.toml
printf 'PROGRAM Main END_PROGRAM\n' >empty/a.st
expect 7 stc check empty
said 'stc.toml:1:8: error.R0506.: `name` must be a text'
printf 'colour = "red"\n' >empty/stc.toml
expect 7 stc check empty
said 'unknown key `colour`'
if ls | grep -q tmp; then fail "temporary files left"; fi
