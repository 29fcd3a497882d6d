#!/bin/sh
# E-01, E-11, E-13: [units] of stc.toml: POUs that are one unit, and actions of a PROGRAM as sections.
# Whoever makes the fleet file says what belongs together; controllers need not know.
. "$(dirname "$0")/lib.sh"

# project FOLDER PUMP LOGIC FILL DRAIN: what each of them adds.
project() {
  mkdir -p "$1"
  cat >"$1/main.st" <<ST
FUNCTION_BLOCK Pump VAR_OUTPUT n : INT; END_VAR n := n + $2; END_FUNCTION_BLOCK
FUNCTION_BLOCK Logic VAR_OUTPUT n : INT; END_VAR n := n + $3; END_FUNCTION_BLOCK
PROGRAM Main
VAR pump1 : Pump; logic1 : Logic; full, empty : INT; go : BOOL := TRUE; END_VAR
pump1(); logic1(); Fill(); Drain();
ACTION Fill:
  LADDER
    |--[ go ]--[ full := full + $4 ]--|
  END_LADDER
END_ACTION
ACTION Drain:
  LADDER
    |--[ go ]--[ empty := empty + $5 ]--|
  END_LADDER
END_ACTION
END_PROGRAM
ST
}
project original 1 1 1 1
project new 2 1 5 1
cat >new/stc.toml <<'TOML'
[units]
Pumping = ["Pump", "Logic"]
Filling = ["Main.Fill"]
TOML
project other_logic 1 100 1 1
project other_drain 1 1 1 7

expect 0 stc fleet original new -o x.fleet
said '^unit Filling +edited +[0-9a-f]{12} +[0-9a-f]{12}$'
said '^unit Pumping +edited '
said '^x.fleet: 2 part.s.'
expect 0 stc dump --parts new
said '^unit Pumping +[0-9a-f]{12} *$'
said '^unit Main +[0-9a-f]{12} *$'
if grep -qE '^unit (Pump|Logic) ' out; then fail "a POU beside its unit"; fi

serve one original
serve two other_logic
serve three other_drain
set -- --dir one --dir two --dir three

# Nobody has edited Logic, but Pump goes with its own alone. Main is another one on the third.
expect 1 stvm fleet status x.fleet "$@"
said '^unit Filling +ok +ok *$'
said '^unit Pumping +ok +different[*] *$'
said '^two +other_logic +refused +1 of 2 +R0320: Pumping is different$'
expect 1 stvm fleet change x.fleet "$@" --yes --allow-overrun
said '^one +original +done +2 of 2 '
said '^three +other_drain +done +2 of 2 '

# What is no part of the units is what it was there.
expect 0 stvm get --dir three Main.empty
seven=$(sed -n 's/^Main.empty=//p' out)
[ $((seven % 7)) -eq 0 ] || fail "another section was changed"
expect 0 stvm edits --dir three
said '^  POUs +Main.Fill .body., Pump .body.$'

# The section alone fits on the second.
expect 0 stvm fleet change x.fleet --dir two --matching --yes --allow-overrun
said '^two +other_logic +done +1 of 2 '
expect 0 stvm edits --dir two
said '^  POUs +Main.Fill .body.$'

# A controller knows the units that an edit has brought.
expect 0 stvm status --units --dir one --format json
json '{u["unit"]: u["part_of"] for u in d["units"]}["Logic"] == "Pumping"'
expect 0 stvm accept --dir one

# An image that somebody else made, with control characters in its names, is none.
expect 0 stc build -q new -o new.img
python3 - <<'PY'
import hashlib
image = bytearray(open("new.img", "rb").read())
for name in (b"Pumping", b"Logic"):
    text = len(name).to_bytes(4, "little") + name
    assert text in image
    image = image.replace(text, text[:4] + b"\x1b" + name[1:])
image[16:48] = hashlib.sha256(image[48:]).digest()
open("evil.img", "wb").write(image)
PY
expect 7 stc dump --parts evil.img
said 'R0101: evil.img: image: section `[a-z]+` is damaged'
if grep -q "$(printf '\033')" out; then fail "a control character came through"; fi

# A change of the units alone is said: controllers that take it group by them from then on.
cp -r new joined
printf '[units]\nPumping = ["Pump"]\nElse = ["Logic"]\nFilling = ["Main.Fill"]\n' >joined/stc.toml
expect 0 stc build -q new --name p -o apart.img
expect 0 stc build -q joined --name p -o joined.img
expect 0 stc diff apart.img joined.img
said '^unit +Logic +\(Pumping -> Else\)$'
if grep -qE 'Pump +\(|Fill +\(' out; then fail "units that are what they were"; fi
printf 'sources = ["."]\n' >joined/stc.toml
expect 0 stc build -q joined --name p -o joined.img
expect 0 stc diff apart.img joined.img --format json
json '[e["what"] for e in d["system"] if e["name"] == "Main.Fill"] == ["Filling -> of its own"]'

# Mistakes in stc.toml have their place.
refused() {
  printf '[units]\n%s\n' "$1" >new/stc.toml
  expect 7 stc build new -o never.img
  said "$2"
}
refused 'A = ["Pumb"]' 'new/stc.toml:2:6: .*no POU and no action `Pumb`; did you mean `Pump`'
refused 'A = ["Pump", "pump"]' 'new/stc.toml:2:14: .*`pump` is in unit `A` already'
refused 'A = []' 'unit `A` must be a list of names of POUs'
refused 'A = "Pump"' 'unit `A` must be a list of names of POUs'
refused 'Table = ["Pump"]' 'new/stc.toml:2:1: .*a unit cannot be called `Table`'
refused 'Logic = ["Pump"]' 'unit `Logic` has the name of a POU that is in no unit'
cat >>new/main.st <<'ST'
FUNCTION_BLOCK Valve METHOD Open : BOOL Open := TRUE; END_METHOD END_FUNCTION_BLOCK
ST
refused 'A = ["Valve.Open"]' '`Valve.Open` goes with its block; only actions of a PROGRAM'
