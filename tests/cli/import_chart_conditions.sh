#!/bin/sh
# Conditions of charts in PLCopen XML that call function blocks, see edges or write: each becomes a
# method that keeps the drawing, runs while its transition is asked, and goes out as it came in.
. "$(dirname "$0")/lib.sh"
sample=$source_dir/tests/fuzz/corpus/plcopen/conditions.xml
needs_xml stc check "$sample"
# places IMAGE: step by step, what the chart has counted by scans
places() {
  for pair in 4=0 5=1 7=1 8=2 9=3 11=3 12=4; do
    expect 0 stvm run "$1" --scans "${pair%=*}" --virtual-time --print Plant.place
    grep -qxF "Plant.place=${pair#*=}" out || fail "$1 after ${pair%=*} scans: not ${pair#*=}"
  done
  for pair in 12=FALSE 13=TRUE; do
    expect 0 stvm run "$1" --scans "${pair%=*}" --virtual-time --print Plant.Done.X --print Plant.asked
    grep -qxF "Plant.Done.X=${pair#*=}" out || fail "$1 after ${pair%=*} scans: Done"
  done
  grep -qxF Plant.asked=TRUE out || fail "$1: the other end of a condition"
}
expect 0 stc build "$sample" -o first.img
places first.img

# As text: a method each, drawn as the condition was.
expect 0 stc import "$sample" -o text
grep -q W0075 out err && fail "a drawing became another one"
has() { grep -qF -- "$1" text/Plant.st || fail "no $1"; }
has 'TRANSITION FROM Wait TO Hold := Ready();'
has 'late : TON(IN := go, PT := T#30ms);'
has '|--[ go ]--[ holding: TON  IN:=_, PT:=T#20ms ]--( Hold_condition )--|'
has 'seen : R_TRIG(CLK := lamp);'
has '|--[ go ]--[ third: Third  on:=_ ]------( Own_condition )--|'
has '|--[P lamp ]--'
[ "$(grep -c 'METHOD PRIVATE' text/Plant.st)" = 5 ] || fail "methods"
cp -r text laid
expect 0 stc fmt laid
for made in text laid; do
  expect 0 stc build $made -o text.img
  places text.img
done

# Not changed, it goes out as it was drawn: boxes in conditions, and no methods.
for more in '' --without-sources; do
  # shellcheck disable=SC2086
  expect 0 stc export "$sample" -o again.xml --force $more
  for part in '<Method' 'Hold_condition<' ; do
    sed '/<addData/,/<\/addData/d' again.xml | grep -qF "$part" && fail "$part stands in the chart"
  done
  [ "$(sed '/plcopen-xml\/sources/,$d' again.xml | grep -o 'instanceName="[a-z]*"' | sort | tr '\n' ' ')" = \
    'instanceName="holding" instanceName="late" instanceName="seen" instanceName="third" ' ] ||
    fail "boxes of the chart that went out"
  grep -q '<reference name="Ready"' again.xml || fail "the name of a condition"
  expect 0 stc build again.xml -o again.img
  places again.img
done

# Changed, it goes out as a chart that calls methods, which are drawings.
sed 's/^STEP Done:/STEP Done:\n  Count(P0);/' text/Plant.st >changed && mv changed text/Plant.st
expect 0 stc export text -o changed.xml --without-sources
[ "$(grep -c '<Method ' changed.xml)" = 5 ] || fail "methods of a chart that was changed"
[ "$(sed -n '/<Method /,$p' changed.xml | grep -cE '<(LD|FBD)>')" = 5 ] || fail "drawings of methods"
expect 0 stc build changed.xml -o changed.img
places changed.img

# One named condition of two transitions is one method; names that are taken are left alone.
sed 's/<condition><reference name="Risen"/<condition><reference name="Ready"/; s/name="asked"/name="Ready"/; s/>asked</>Ready</' \
  "$sample" >twice.xml
expect 0 stc import twice.xml -o twice
[ "$(grep -c ':= Ready_2();' twice/Plant.st)" = 2 ] || fail "one condition of two transitions"
[ "$(grep -c 'METHOD PRIVATE Ready_2' twice/Plant.st)" = 1 ] || fail "the method of two transitions"
expect 0 stc check twice
# Statements that call a block and give the transition its value, under a name that is taken as well.
python3 - "$sample" <<'P'
import re, sys
text = re.sub(r'(?s)(<transition name="Ready"><body>).*?(</body>)',
              r'\1<ST><xhtml:p><![CDATA[late(IN := go, PT := T#30ms);\nREADY := late.Q;]]></xhtml:p></ST>\2',
              open(sys.argv[1]).read())
open("statements.xml", "w").write(text)
open("taken.xml", "w").write(text.replace('name="asked"', 'name="Ready"').replace(">asked<", ">Ready<"))
P
expect 0 stc import statements.xml -o statements
grep -qF 'Wait TO Hold := Ready();' statements/Plant.st || fail "a condition of statements"
expect 0 stc build statements -o statements.img
places statements.img
expect 0 stc import taken.xml -o taken
grep -qF 'Wait TO Hold := Ready_2();' taken/Plant.st || fail "a name that is taken"
expect 0 stc build taken -o taken.img
expect 0 stvm run taken.img --scans 8 --virtual-time --print Plant.place --print Plant.Ready
grep -qxF Plant.place=2 out || fail "the result of statements under another name"
grep -qxF Plant.Ready=FALSE out || fail "a variable with the name of a transition"
# A negated one.
sed 's/<condition negated="false">/<condition negated="true">/' "$sample" >negated.xml
expect 0 stc import negated.xml -o negated
grep -qF 'Look TO Own := NOT (Look_condition());' negated/Plant.st || fail "a negated condition"
# A network that many transitions share is not copied without an end.
python3 - <<'P' >many.xml
count = 1000
out = []
def hang(at): return f'<connectionPointIn><connection refLocalId="{at}"/></connectionPointIn>'
out.append('<leftPowerRail localId="1"/>')
for i in range(count):
    edge = ' edge="rising"' if i == 0 else ""
    out.append(f'<contact localId="{i + 2}"{edge}>{hang(i + 1)}<variable>a</variable></contact>')
for i in range(count):
    at = 10000 + 2 * i
    first = ' initialStep="true"' if i == 0 else ""
    out.append(f'<step localId="{at}" name="S{i}"{first}>{hang(at - 1) if i else ""}</step>')
    out.append(f'<transition localId="{at + 1}">{hang(at)}<condition>{hang(count + 1)}</condition></transition>')
out.append(f'<jumpStep localId="9000" targetName="S0">{hang(10000 + 2 * count - 1)}</jumpStep>')
print('<project><types><pous><pou name="P" pouType="program"><interface><localVars><variable name="a"><type><BOOL/>'
      f'</type></variable></localVars></interface><body><SFC>{"".join(out)}</SFC></body></pou></pous></types></project>')
P
expect 1 timeout 60 "$bin/stc" import many.xml -o many
said 'E1082.*there are too many ways through divergences, convergences and conditions'
[ "$(grep -c E1082 err out | sed 's/.*://' | sort -n | tail -1)" = 1 ] || fail "said more than once"
# A box that leads to two transitions would be called twice in a scan.
sed 's/refLocalId="32" formalParameter="Q"/refLocalId="21" formalParameter="Q"/' "$sample" >shared.xml
expect 1 stc check shared.xml
said 'E1083.*leads to several transitions, and each would call `seen`'
said 'help: call it in an action, and make its outputs the conditions'
