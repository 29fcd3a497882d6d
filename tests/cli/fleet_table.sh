#!/bin/sh
# E-16 to E-18, E-22: the table of a fleet. Restricted, it takes additions only: the original
# against the new one, and each controller's own against the new one, before a byte is sent.
. "$(dirname "$0")/lib.sh"

# project FILE GLOBALS STEP: what A adds in each scan.
project() {
  cat >"$1" <<ST
VAR_GLOBAL
  $2
END_VAR
FUNCTION_BLOCK A VAR_OUTPUT n : INT; END_VAR n := n + $3; END_FUNCTION_BLOCK
PROGRAM Main VAR a1 : A; seen : INT; END_VAR a1(); seen := a1.n; END_PROGRAM
ST
}
table='level : INT; spare : INT := 5; rate : REAL;'
project original.st "$table" 1
project extended.st "before : INT; $table more : LREAL;" 2
project deleted.st 'level : INT; rate : REAL;' 2
project reordered.st 'spare : INT := 5; level : INT; rate : REAL;' 2
project retyped.st 'level : DINT; spare : INT := 5; rate : REAL;' 2
project several.st 'level : DINT; rate : REAL := 1.0;' 2

# E-16: the first difference and all others, each with its place, and the way out.
expect 0 stc fleet original.st extended.st -o extended.fleet
refused() {  # refused NEW REGEX
  expect 7 stc fleet original.st "$1" -o refused.fleet
  said "R0322.*$2"
  said 'stc fleet --table free'
  [ ! -e refused.fleet ] || fail "a file of a refused edit"
}
refused deleted.st '`spare`: removed .deleted.st:2:3.'
refused reordered.st '`spare`: it stood after `level` .reordered.st:2:3.'
refused retyped.st '`level`: type INT -> DINT .retyped.st:2:3.'
refused several.st '`level`: type INT -> DINT .*; `spare`: removed .*; `rate`: initial value 0.0 -> 1.0'
stc build -q retyped.st -o retyped.img
refused retyped.img '`level`: type INT -> DINT'

# E-18: what a controller alone has stays, with its values. The table of another is not that of
# the edit: one `spare` is a DINT, one stands elsewhere, one has another initial value.
project own.st "mine : DINT := 77; $table" 1
project other_type.st 'level : INT; spare : DINT := 5; rate : REAL;' 1
project other_order.st 'rate : REAL; level : INT; spare : INT := 5;' 1
project other_value.st 'level : INT; spare : INT := 6; rate : REAL;' 1
serve own own.st
serve other_type other_type.st
serve other_order other_order.st
serve other_value other_value.st
set -- --dir own --dir other_type --dir other_order --dir other_value
expect 0 stvm set --dir own mine=78
expect 1 stvm fleet status extended.fleet "$@"
said '^other_order: R0322: its own table: `level`: it stood after `rate`; `spare`: it stood after `rate`$'
said '^other_value: R0322: its own table: `spare`: initial value 6 -> 5$'
said '^own +own +possible +1 of 1 *$'
said '^other_type +other_type +refused +1 of 1 +R0322: its own table: '
said '^other_type: R0322: its own table: `spare`: type DINT -> INT$'
expect 1 stvm fleet change extended.fleet "$@" --yes --allow-overrun --format json
json '[c["outcome"] for c in d["controllers"]] == ["done", "refused", "refused", "refused"]'
json '[c.get("refused") for c in d["controllers"]] == [None, "R0322", "R0322", "R0322"]'
json 'd["controllers"][1]["table"] == [{"variable": "spare", "change": "type", "what": "type DINT -> INT"}]'
json 'd["controllers"][0]["table"] == []'
expect 0 stvm get --dir own mine more
said '^mine=78$'
said '^more=0.0$'
for refused in other_type other_order other_value; do
  expect 0 stvm edits --dir $refused
  said 'no edit is on trial'
  expect 0 stvm journal --dir $refused
  ! grep -q staged out || fail "something was sent to $refused"
done
# One controller alone takes the file by the same rule.
expect 7 stvm change extended.fleet --dir other_type --yes --allow-overrun
said 'R0322.*`spare`: type DINT -> INT'

# E-17: the file says that its table is free; each shows its fates, and keeps what is its own.
expect 0 stc fleet original.st extended.st -o free.fleet --table free
expect 0 stc dump free.fleet
said 'the table is free'
expect 0 stvm fleet change free.fleet --dir other_type --dir other_order --dir other_value --yes --allow-overrun
said '^other_type +other_type +done '
said '^other_value +other_value +done '
expect 0 stvm get --dir other_value spare
said '^spare=6$'
expect 0 stc fleet original.st retyped.st -o retyped.fleet --table free
serve again original.st
expect 0 stvm set --dir again level=12
expect 0 stvm fleet change retyped.fleet --dir again --yes --allow-overrun
said 'converted'
expect 0 stvm get --dir again level
said '^level=12$'

# E-22: a file that says additions only, and is not: the controller compares what it runs with
# what it is given. The tool cannot see it, since programs are compared as parts.
project speaks.st "$table" 1
sed 's/seen : INT/seen : DINT/' speaks.st >lies.st
expect 7 stc fleet speaks.st lies.st -o lies.fleet
said 'R0322.*`Main.seen`: type INT -> DINT'
expect 0 stc fleet speaks.st lies.st -o lies.fleet --table free
python3 - <<'PY'
import hashlib, struct
data = bytearray(open("lies.fleet", "rb").read())
size = struct.unpack_from("<I", data, 16)[0]
data[52 + size - 6] = 0  # how the units start is behind it
data[20:52] = hashlib.sha256(data[52:52 + size]).digest()
open("lies.fleet", "wb").write(data)
PY
serve wary speaks.st
expect 0 stvm fleet status lies.fleet --dir wary
expect 7 stvm fleet change lies.fleet --dir wary --yes --allow-overrun
said 'R0322: the table that runs: `Main.seen`: type INT -> DINT'
expect 7 stvm change lies.fleet --dir wary --yes --allow-overrun
said 'R0322: the table that runs: `Main.seen`: type INT -> DINT'
expect 7 stvm fleet change lies.fleet --dir wary --dry-run --allow-overrun
said 'R0322'
expect 0 stvm edits --dir wary
said 'no edit is on trial'
