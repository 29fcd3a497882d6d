#!/bin/sh
# What a controller stores is its owner's alone, and a state folder that others can write is refused.
. "$(dirname "$0")/lib.sh"
umask 022
cat >p.st <<'ST'
PROGRAM P VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#10ms, PRIORITY := 1); PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION
ST
stc build p.st -o p.img 2>/dev/null
mode() { stat -c %a "$1"; }
is() { [ "$(mode "$1")" = "$2" ] || fail "$1 has mode $(mode "$1"), not $2"; }

serve new --record new.rec p.img
is new 700
for file in new/*; do is "$file" 600; done
is new.rec 600
expect 0 stvm image --dir new --output copy.img
is copy.img 600
expect 0 stvm stop --dir new

refused() {  # refused DIR: says what to type, and after that it is served
  expect 7 stvm serve --dir "$1" p.img
  said "R0508: .*others can write it and could exchange what runs: .chmod go-w "
  eval "$(grep -o 'chmod go-w [^`]*' err)"
  serve "$1" p.img
  expect 0 stvm stop --dir "$1"
}
for bits in g+w o+w a+w,+t; do
  mkdir "open-$bits"
  chmod "$bits" "open-$bits"
  refused "open-$bits"
done
# A parent that others can write lets them put another folder in its place, but not when it is sticky.
mkdir parent
chmod 777 parent
cd parent
cp ../p.img .
refused state
mkdir sticky
chmod 1777 sticky
cd sticky
serve state ../p.img
expect 0 stvm stop --dir state
cd ../..

if [ "$(id -u)" = 0 ]; then
  mkdir foreign
  chown 65534 foreign
  expect 7 stvm serve --dir foreign p.img
  said 'R0508: .*foreign: it belongs to another user'
  # Whoever owns a parent can put another folder in its place, too.
  mkdir -m 755 host host/state
  chown 65534 host
  expect 7 stvm serve --dir host/state p.img
  said 'R0508: .*host: it belongs to another user'
fi

# A link that leads elsewhere later leads nobody there.
mkdir -m 700 real other
ln -s real link
serve link p.img
ln -sfn other link
rm real/slot_a
wait_for slot_a ls real
[ -z "$(ls other)" ] || fail "written into another folder: $(ls other)"

# Another state folder takes the place of the one that runs: nothing is written there, status says
# so, and when the right one is back, all is well.
sums() { cat "$1"/control_* "$1"/slot_* "$1"/retain_* "$1"/journal "$1"/traps | cksum; }
sed 's/n + 1/n + 2/' p.st >q.st
serve beside q.st
expect 0 stvm stop --dir beside
serve own p.st
before=$(sums beside)
mv own own.old
mv beside own
wait_for 'another folder is there now' stvm status --dir own.old
sleep 3
[ "$(sums own)" = "$before" ] || fail 'something was written into the folder of another controller'
mv own beside
mv own.old own
settled() { stvm status --dir own | grep -q 'another folder' && return 1; echo settled; }
wait_for settled settled
expect 0 stvm stop --dir own
serve own
expect 0 stvm stop --dir own

# A lock that is a link makes no file elsewhere.
rm beside/lock
ln -s ../made-by-lock beside/lock
expect 7 stvm serve --dir beside
said 'lock: it is a link; remove it'
[ ! -e made-by-lock ] || fail 'the target of the link was made'
