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
