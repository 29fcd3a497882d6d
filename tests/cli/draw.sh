#!/bin/sh
# stc draw: pictures of bodies, one or all, and what is powered in a running controller.
. "$(dirname "$0")/lib.sh"
examples="$source_dir/examples"

# One picture: to a file, or to standard output.
expect 0 stc draw "$examples/motor_starter" -o starter.svg
head -c 4 starter.svg | grep -q '<svg' || fail "starter.svg is no SVG"
grep -q 'PROGRAM Starter' starter.svg || fail "no title"
expect 0 stc draw "$examples/motor_starter" Starter
cmp -s out starter.svg || fail "standard output is another picture"
cmp -s "$source_dir/docs/ladder.svg" starter.svg || fail "docs/ladder.svg is an older picture"
expect 0 stc draw "$examples/palletiser" layers -o layers.svg
grep -q 'squeeze it' layers.svg || fail "no comment in layers.svg"

# All of them, into a folder.
expect 0 stc draw "$examples/palletiser" -o pictures
[ "$(ls pictures | tr '\n' ' ')" = "Alarms.svg Belts.svg Layers.svg Modes.svg Pallets.svg " ] ||
  fail "other pictures: $(ls pictures)"
expect 0 stc draw "$examples/crossing_chart" Crossing -o crossing.svg
expect 0 stc draw "$examples/heating" -o heating.svg

# A narrow picture has rungs in several strips, and addresses can be left out.
expect 0 stc draw "$examples/motor_starter" --width 300 -o narrow.svg
cmp -s starter.svg narrow.svg && fail "a narrow picture is as wide as any"
expect 0 stc draw "$examples/motor_starter" --plain -o plain.svg
grep -q 'contactor' starter.svg || fail "no comment of an operand"
if grep -q 'contactor' plain.svg; then fail "a comment in a plain picture"; fi

# What cannot be drawn.
expect 2 stc draw "$examples/palletiser" -o one.svg
grep -q 'Belts, Layers' err || fail "does not say which there are"
expect 2 stc draw "$examples/palletiser" Plant
grep -q 'no drawing `Plant`' err || fail "Plant is no drawing"
expect 2 stc draw "$examples/small/blink.st"
grep -q 'nothing there is drawn' err || fail "blink.st has no drawing"
printf 'PROGRAM p\nLADDER\n  |--[ a \nEND_LADDER\nEND_PROGRAM\n' > bad.st
expect 1 stc draw bad.st

# Names in namespaces.
printf 'NAMESPACE A FUNCTION_BLOCK M VAR x : BOOL; END_VAR\nFBD\n  x := TRUE;\nEND_FBD\nEND_FUNCTION_BLOCK END_NAMESPACE\n' >spaces.st
sed 's/SPACE A/SPACE B.C/; s/TRUE/FALSE/' spaces.st >spaces2.st
expect 0 stc draw spaces.st spaces2.st -o spaces
[ "$(ls spaces | tr '\n' ' ')" = "A.M.svg B.C.M.svg " ] || fail "other pictures: $(ls spaces)"
expect 0 stc draw spaces.st spaces2.st A.M -o one.svg

# An expression of wires is a box: its wires arrive there.
printf 'PROGRAM P\nVAR a : INT; r : REAL; END_VAR\nFBD\n  WIRE e := ADD(a, 1);\n  r := e * 2.0;\nEND_FBD\nEND_PROGRAM\n' >expression.st
expect 0 stc draw expression.st -o expression.svg
printf 'P.a=1\nP.r=4.0\n' >expression.values
expect 0 stc draw expression.st --values expression.values -o expression_live.svg
for picture in expression.svg expression_live.svg; do
  grep -q '>e \* 2.0</text>' $picture || fail "no box of the expression: $(cat $picture)"
  grep -q '>e</text>' $picture || fail "no pin of the wire"
done

# With values of a file.
printf 'Starter.Motor=TRUE\nStarter.Stop=FALSE\nStarter.Tripped=FALSE\nStarter.Starts.CV=3\n' > values
expect 0 stc draw "$examples/motor_starter" --values values -o live.svg
grep -q 'class="l on"' live.svg || fail "nothing is powered"
if grep -q 'class="l on"' starter.svg; then fail "powered without values"; fi
expect 0 stc draw "$examples/motor_starter" --values values --instance Other -o other.svg
expect 7 stc draw "$examples/motor_starter" --values nowhere -o live.svg

# With those of a running controller.
serve plc "$examples/motor_starter"
expect 0 stvm set Starter.Start=TRUE --dir plc
expect 0 stc draw "$examples/motor_starter" --live plc -o now.svg
grep -q 'class="l on"' now.svg || fail "nothing is powered in the controller"
grep -q '(Starter)' now.svg || fail "does not say whose values these are"
expect 7 stc draw "$examples/traffic_lights" --live plc -o now.svg
stvm stop --dir plc >/dev/null
expect 7 stc draw "$examples/motor_starter" --live plc -o now.svg
