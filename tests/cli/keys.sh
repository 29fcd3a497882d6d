#!/bin/sh
# F-03: a real controller with keys. Whatever is not signed, forged, foreign, expired, replayed or
# for another controller is refused with its code, by every verb that brings a program; the program
# runs on.
. "$(dirname "$0")/lib.sh"

if ! stc key new office -o office.key >trust.toml 2>err; then
  grep -q 'R0428.*libssl-dev' err || fail "no keys, and no word why"
  echo 'PROGRAM Main END_PROGRAM' >a.st
  expect 7 stvm serve --dir plc --trust trust.toml a.st
  said 'R0428: .*libssl-dev'
  echo "built without OpenSSL: refused, as it should be"
  exit 0
fi
stc key new chief --revokes -o chief.key >>trust.toml
stc key new other -o other.key >other.toml
program() { echo "PROGRAM Main VAR n : INT; END_VAR n := n + $2; END_PROGRAM" >"$1"; }
program a.st 1
program b.st 2
program c.st 3
stc build -q a.st -o a.img

# What the first word was meant to be is said before what is missing of it.
expect 2 stc key sgin a.img
said 'key: `sgin` is none of new, sign, verify, revoke; did you mean `sign`\?'
expect 2 stc key frobnicate a.img
said 'key: `frobnicate` is none of new, sign, verify, revoke$'

# Private keys are private, and none is written over.
[ "$(stat -c %a office.key)" = 600 ] || fail "others can read the key"
expect 7 stc key new office -o office.key
said 'R0503: office.key: is there already'
cp office.key open.key && chmod 644 open.key
expect 7 stc key sign a.img --key open.key -o x
said 'R0427: open.key: others can read'
echo rubbish >rubbish.key && chmod 600 rubbish.key
expect 7 stc key sign a.img --key rubbish.key -o x
said 'R0427: rubbish.key: no Ed25519 private key'
expect 7 stc key sign a.st --key office.key -o x
said 'R0101: a.st: neither an image'
expect 2 stc key sign a.img -o x
said 'needs --key'

# F-03: the start image.
expect 7 stvm serve --dir plc --trust missing.toml a.img
said 'R0501'
expect 7 stvm serve --dir plc --trust trust.toml a.img
said 'R0420'
expect 7 stvm serve --dir plc --trust trust.toml a.st
said 'R0420'
stc key sign a.img --key other.key -o foreign.signed
expect 7 stvm serve --dir plc --trust trust.toml foreign.signed
said 'R0422'
stc key sign a.img --key office.key --until 2020-01-01 -o old.signed
expect 7 stvm serve --dir plc --trust trust.toml old.signed
said 'R0424: .*signed by office until 2020-01-01'
expect 7 stc key verify old.signed --trust trust.toml
said R0424
stc key sign a.img --key office.key -o a.signed
expect 0 stc key verify a.signed --trust trust.toml
said 'image of [0-9]* bytes, signed by office, plan key-'
expect 7 stc key verify a.img --trust trust.toml
said R0420
expect 0 stvm run a.signed --scans 1 --virtual-time --print Main.n
serve plc --trust trust.toml a.signed
expect 0 stvm events --dir plc
grep -q alarm out && fail "a first start with keys is no alarm"
running() { stvm status --dir plc --format json | sed 's/.*"running":"\([0-9a-f]*\)".*/\1/'; }
first=$(running)

# F-03: nothing unsigned, by no verb.
none() {  # none CODE COMMAND...: refused so, and the same program runs.
  refusal=$1
  shift
  expect 7 "$@"
  said "$refusal"
  [ "$(running)" = "$first" ] || fail "another program runs after $*"
}
stc fleet a.st b.st -o b.fleet 2>/dev/null
none R0420 stvm change b.st --dir plc --yes
none R0420 stvm change b.st --dir plc --dry-run
none R0420 stvm change b.st --dir plc --yes --strategy standby --permanent
none R0420 stvm change b.fleet --dir plc --yes
none R0420 stvm fleet change b.fleet --dir plc --yes
none R0422 stvm change b.st --dir plc --yes --sign other.key
none R0422 stvm fleet change b.fleet --dir plc --yes --sign other.key
printf '[controllers.line2]\ndir = "%s/plc"\n[roll]\nsoak = "1s"\n[[wave]]\npercent = 100\n' \
  "$work" >fleet.toml
none R0420 stvm fleet roll b.fleet --fleet fleet.toml --yes

# A package that was signed elsewhere: flipped, cut, for another, and then the good one, once.
expect 0 stvm image --dir plc -o running.img
stc package b.st --base running.img -o b.pkg
none R0420 stvm change b.pkg --dir plc --yes
stc key sign b.pkg --key office.key --target line3 -o b.line3
none 'R0426: signed for line3' stvm change b.line3 --dir plc --yes
stc key sign b.pkg --key office.key -o b.signed
head -c 400 b.signed >b.cut
none 'R010[12]' stvm change b.cut --dir plc --yes
python3 -c "
d = bytearray(open('b.signed', 'rb').read()); d[170] ^= 1; open('b.flipped', 'wb').write(d)"
none 'R0(10[12]|421)' stvm change b.flipped --dir plc --yes
expect 0 stvm change b.signed --dir plc --yes
expect 0 stvm undo --dir plc --yes
none R0425 stvm change b.signed --dir plc --yes

# Signed on the way: change, undo and redo, undo --only, revert.
expect 0 stvm redo --dir plc --yes
expect 0 stvm accept --dir plc
none_now() {
  first=$(running)
  none "$@"
}
none_now R0420 stvm revert --dir plc --yes
expect 0 stvm revert --dir plc --yes --sign office.key
expect 0 stvm accept --dir plc
none_now 'R0420: b.fleet is not signed' \
  stvm fleet change b.fleet --dir plc --yes --sign office.key --trust trust.toml
stc key sign b.fleet --key office.key -o signed.fleet
expect 0 stvm fleet change signed.fleet --dir plc --yes --sign office.key --trust trust.toml
expect 0 stvm accept --dir plc
expect 0 stvm revert --dir plc --yes --sign office.key --permanent
expect 0 stvm fleet roll signed.fleet --fleet fleet.toml --yes --sign office.key --trust trust.toml
expect 0 stvm journal --dir plc
said 'edit E[0-9]*, fleet file .*, signed by office'
said 'R0422: signed by key'
said 'signed by office .plan key-'

# What was taken is known over a kill, and the start image that boots no more needs a signature.
power_cut plc
serve plc --trust trust.toml
none_now R0425 stvm change b.signed --dir plc --yes
expect 0 stvm stop --dir plc

# Revoked: from now on, and over a restart. An old list is a replay. The recording of it all is
# replayed without keys.
serve plc --trust trust.toml --record run.rec
expect 0 stvm change c.st --dir plc --yes --sign office.key
expect 0 stvm undo --dir plc --yes
expect 7 stvm revoke b.signed --dir plc
said R0101
stc key revoke office --trust trust.toml --key office.key -o by_office
expect 7 stvm revoke by_office --dir plc
said 'R0426: key office may not revoke'
stc key revoke office --trust trust.toml --key chief.key -o revoked
expect 0 stvm revoke revoked --dir plc
none_now 'R0423: key office is revoked' stvm change c.st --dir plc --yes --sign office.key
expect 7 stvm revoke revoked --dir plc
said R0425
expect 0 stvm stop --dir plc
expect 0 stvm replay run.rec
# Verifying makes no other system calls.
serve plc --trust trust.toml $seccomp
none_now 'R0423: key office is revoked' stvm change c.st --dir plc --yes --sign office.key

# A new key, while the program runs.
cat trust.toml other.toml >both.toml && mv both.toml trust.toml
expect 0 stvm change c.st --dir plc --yes --sign other.key
expect 0 stvm undo --dir plc --yes

# One edit below another is taken back by a package of its own.
two() {
  echo "FUNCTION_BLOCK A VAR_OUTPUT n : INT; END_VAR n := n + $2; END_FUNCTION_BLOCK
FUNCTION_BLOCK B VAR_OUTPUT n : INT; END_VAR n := n + $3; END_FUNCTION_BLOCK
PROGRAM Main VAR a1 : A; b1 : B; END_VAR a1(); b1(); END_PROGRAM" >"$1"
}
two d.st 1 1
two e.st 2 1
two f.st 2 2
expect 0 stvm change d.st --dir plc --yes --sign other.key --permanent --allow-loss
expect 0 stvm change e.st --dir plc --yes --sign other.key
expect 0 stvm change f.st --dir plc --yes --sign other.key
lower=$(stvm edits --dir plc --format json | sed 's/.*"edits":\[{[^}]*"name":"\([^"]*\)".*/\1/')
none_now R0420 stvm undo "$lower" --only --dir plc --yes
expect 0 stvm undo "$lower" --only --dir plc --yes --sign other.key
expect 0 stvm accept --dir plc

# The policy for this machine. A bridge is another one.
{ echo 'unsigned = "local"'; cat trust.toml; } >local.toml && mv local.toml trust.toml
expect 0 stvm change c.st --dir plc --yes --allow-loss
expect 0 stvm undo --dir plc --yes
cat >ssh <<SH
#!/bin/sh
while [ "\$1" != here ]; do shift; done
PATH=$bin:\$PATH exec sh -c "\$2"
SH
chmod +x ssh
none_now 'R0420: .*another machine' env PATH="$bin:$PATH" STVM_SSH="$work/ssh" \
  "$bin/stvm" change c.st --host here --dir "$work/plc" --yes
expect 0 stvm stop --dir plc
