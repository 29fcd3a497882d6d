#!/bin/sh
# Ladder and FBD of PLCopen XML: as text of this language, in the right order, and running.
. "$(dirname "$0")/lib.sh"
samples=$source_dir/tests/fuzz/corpus/plcopen
cp "$samples"/ladder.xml "$samples"/blocks.xml .
needs_xml stc check ladder.xml
# values IMAGE SCANS NAME=VALUE...
values() {
  image=$1
  scans=$2
  shift 2
  for pair in "$@"; do
    expect 0 stvm run "$image" --scans "$scans" --virtual-time --print "${pair%%=*}"
    grep -qxF "$pair" out || fail "$image after $scans scans: $pair"
  done
}

expect 0 stc import ladder.xml -o made
cat >wanted <<'T'
LADDER
  (* seal-in *)
  |--[ Start ]--+--[/ Stop ]------------------------( Run )--|
  |--[ Run ]----+

  |--[ Run ]--[ delay: TON  IN:=_, PT:=T#20ms ]----( Late )--|

  |--[P Run ]-------------------------------------(S Once )--|

  |--[ Late ]---------------------------------( JMP Quiet )--|

  |--[/ Late ]----------------------------------( Skipped )--|

  Quiet:
  |--[ n > 1 ]------------------------------------(/ Lamp )--|

  |--[ n := ADD(n, 1) ]--------------------------------------|
END_LADDER
T
sed -n '/^LADDER/,/^END_LADDER/p' made/Line.st | cmp - wanted || fail "the ladder is drawn differently"
expect 0 stc build ladder.xml -o ladder.img
expect 0 stc build made -o made.img
for image in ladder.img made.img; do
  values $image 2 L.Run=TRUE L.Late=FALSE L.Once=TRUE L.n=2 L.Lamp=TRUE
  values $image 5 L.Late=TRUE L.Skipped=TRUE L.n=5 L.Lamp=FALSE  # jumped over, so it stays TRUE
done

expect 0 stc build blocks.xml -o blocks.img
values blocks.img 1 M.both=FALSE M.total=5 M.seen=5 M.pulses=0 M.b=2 M.c=6 M.a=2
values blocks.img 6 M.total=30 M.seen=30 M.pulses=2 M.a=2
rm -r made
expect 0 stc import blocks.xml -o made
grep -q 'clock : TON(IN := NOT clock.Q, PT := T#10ms);' made/Main.st || fail feedback
grep -q 'both of (\* these \*)' made/Main.st || fail comment

# fbd ELEMENTS, ld ELEMENTS: a program of them.
body() {
  printf '<project><types><pous><pou name="P" pouType="program"><interface><localVars><variable name="a"><type><INT/></type></variable><variable name="b"><type><BOOL/></type></variable><variable name="c"><type><BOOL/></type></variable><variable name="t"><type><derived name="TON"/></type></variable></localVars></interface><body><%s>%s</%s></body></pou></pous></types></project>' "$1" "$2" "$1" >small.xml
}
in_variable() { printf '<inVariable localId="%s"><expression>%s</expression></inVariable>' "$1" "$2"; }
out_variable() { printf '<outVariable localId="%s"><connectionPointIn>%s</connectionPointIn><expression>%s</expression></outVariable>' "$1" "${3:-}" "$2"; }
from() { printf '<connection refLocalId="%s"/>' "$1"; }
add() { printf '<block localId="%s" typeName="ADD"><inputVariables><variable formalParameter="IN1"><connectionPointIn>%s</connectionPointIn></variable><variable formalParameter="IN2"><connectionPointIn>%s</connectionPointIn></variable></inputVariables><outputVariables><variable formalParameter="OUT"/></outputVariables></block>' "$1" "$2" "$3"; }
wrong() {
  expect 1 stc check small.xml
  said "small\.xml:1:[0-9]+: error\[$1\]: POU P.*$2"
  rm -rf bad
  expect 1 stc import small.xml -o bad
  expect 1 stc check bad
  said "bad/P\.st:[0-9]+:[0-9]+: error.*the body of P was not imported"
}
good() { expect 0 stc check small.xml; }

body FBD "$(in_variable 0 1)$(out_variable 5 a "$(from 0)")"  # ids begin at 0, in any order
good
body FBD "$(in_variable 1 1)$(out_variable 1 a "$(from 1)")"
wrong E1075 'localId 1 is there twice'
body FBD '<inVariable><expression>1</expression></inVariable>'
wrong E1073 'has no attribute `localId`'
body FBD '<inVariable localId="x"><expression>1</expression></inVariable>'
wrong E1074 'localId `x` is no number'
body FBD "$(out_variable 1 a "$(from 7)")"
wrong E1076 'localId `7`, which is no element'
body FBD "$(add 1 "$(from 2)" "$(from 2)")$(in_variable 2 1)$(out_variable 3 a '<connection refLocalId="1" formalParameter="SUM"/>')"
wrong E1076 'has no output `SUM`'
body FBD "$(out_variable 1 a "$(from 2)")$(out_variable 2 a '')"
wrong E1076 '<outVariable localId="2"> has no output'
body FBD "<continuation localId=\"1\" name=\"K\"/>$(out_variable 2 a "$(from 1)")"
wrong E1076 'there is no connector `K`'
connector() { printf '<connector localId="%s" name="K"><connectionPointIn>%s</connectionPointIn></connector>' "$1" "$2"; }
body FBD "$(in_variable 1 1)$(connector 2 "$(from 1)")$(connector 3 "$(from 1)")"
wrong E1077 'two connectors `K`'
body FBD "<continuation localId=\"1\" name=\"K\"/>$(connector 2 "$(from 1)")$(out_variable 3 a "$(from 1)")"
wrong E1078 'connectors lead in a circle'
body FBD "$(in_variable 1 1)$(add 2 "$(from 1)" "$(from 3)")$(add 3 "$(from 1)" "$(from 2)")$(out_variable 4 a "$(from 3)")"
wrong E1078 'network 1: the value of `ADD`, `ADD` goes in a circle'
# Numbers against the flow of data are no circle. What has no number in between changes nothing.
ordered() { add "$1" "$3" "$4" | sed "s/typeName=\"ADD\"/typeName=\"$5\" executionOrderId=\"$2\"/"; }
for rest in "$(ordered 3 1 "$(from 1)" "$(from 2)" MUL)" "$(add 5 "$(from 1)" "$(from 2)")$(ordered 3 1 "$(from 1)" "$(from 5)" MUL)"; do
  body FBD "$(in_variable 1 3)$(ordered 2 2 "$(from 1)" "$(from 1)" ADD)$rest$(ordered 6 3 "$(from 1)" "$(from 1)" SUB)$(out_variable 4 a "$(from 3)")$(out_variable 7 a "$(from 6)")"
  good
  said 'warning\[W0076\]: POU P, network 1: `MUL` \(executionOrderId 1\) reads `ADD` \(executionOrderId 2\)'
  rm -rf made
  expect 0 stc import small.xml -o made
  grep -E '(ADD|MUL|SUB)\(' made/P.st | sed 's/.*\(ADD\|MUL\|SUB\)(.*/\1/' | tr '\n' ' ' | grep -qE '^(ADD )+MUL SUB $' || fail "order: $(cat made/P.st)"
done
body FBD "$(in_variable 1 1)$(add 2 "$(from 1)$(from 1)" "$(from 1)")"
wrong E1079 'several connections lead to the input `IN1`'
body FBD "$(in_variable 1 b)$(in_variable 2 c)$(out_variable 3 b "$(from 1)$(from 2)")"
wrong E1079 'several connections lead to one input'
body FBD '<cfcElement localId="1"/>'
wrong E1083 '<cfcElement localId="1"> in the body of P is not understood'
body FBD '<block localId="1" typeName="EXECUTE"><addData><data name="http://www.3s-software.com/plcopenxml/stcode" handleUnknown="implementation"><STCode>a := 1;</STCode></data></addData></block>'
wrong E1083 'holds statements of its own'
body FBD '<block localId="1" typeName="a; b"/>'
wrong E1074 'no type or instance that is a name'
body FBD "$(in_variable 1 'a; b := 1')"
wrong E1074 'is no operand'
# Operands are one expression: nothing in them reaches the text around them.
for operand in 'a /*' 'a //' '(* a' 'a (* b *)' 'a {x}' '(a' 'a)' 'a ]--[ b' 'a, b' 'a := b' 'P b' '[/ b]' 'JMP b' \
  '/ b' 'END_FBD' '_'; do
  body FBD "$(in_variable 1 "$operand")$(out_variable 2 b "$(from 1)")"
  wrong E1074 'is no operand'
  body FBD "$(in_variable 1 b)$(out_variable 2 "$operand" "$(from 1)")"
  wrong E1074 'is no operand'
  body FBD "<outVariable localId=\"2\"><connectionPointIn><expression>$operand</expression></connectionPointIn><expression>b</expression></outVariable>"
  wrong E1074 'is no operand'
done
for operand in '(a + 1) * 2' '-a' 'MAX(a, IN2 := 3)' '16#FF' 'INT#5 MOD 2' 'NOT_a[1, a].x^' ; do
  body FBD "$(in_variable 1 "$operand")$(out_variable 2 a "$(from 1)")"
  expect 0 stc import small.xml -o operand --force
done
# output PIN: a block whose output has these attributes, into two variables.
output() { body FBD "$(in_variable 1 b)<block localId=\"2\" typeName=\"NOT\"><inputVariables><variable formalParameter=\"IN\"><connectionPointIn>$(from 1)</connectionPointIn></variable></inputVariables><outputVariables><variable formalParameter=\"OUT\" $1><connectionPointOut>${2:-}</connectionPointOut></variable></outputVariables></block>$(out_variable 3 c "$(from 2)")$(out_variable 4 b "$(from 2)")${3:-}"; }
output 'storage="set"'
expect 0 stc import small.xml -o operand --force
grep -q '^  c S= not1;$' operand/P.st && grep -q '^  b S= not1;$' operand/P.st || fail "outputs that set"
output 'edge="rising"'
wrong E1083 'an output sees edges'
output 'storage="reset"' '' "$(out_variable 5 b "$(from 6)")<block localId=\"6\" typeName=\"NOT\"><inputVariables><variable formalParameter=\"IN\"><connectionPointIn>$(from 2)</connectionPointIn></variable></inputVariables><outputVariables><variable formalParameter=\"OUT\"/></outputVariables></block>"
wrong E1083 'sets or resets something else than a plain variable'
output '' '<expression>c := TRUE; b</expression>'
wrong E1074 'is no operand'
# A variable that nothing is connected to keeps its value.
body FBD "$(out_variable 1 c)$(in_variable 2 TRUE)$(out_variable 3 b "$(from 2)")"
good
said 'warning\[W0070\]: POU P: nothing is connected to `c`'
expect 0 stc import small.xml -o operand --force
[ "$(sed -n '/^FBD/,/^END_FBD/p' operand/P.st | grep -c ':=')" -eq 1 ] || fail "an open variable is written"
body FBD '<inVariable localId="1" negated="perhaps"><expression>b</expression></inVariable>'
wrong E1074 'neither true nor false'
body FBD "$(in_variable 1 b)<outVariable localId=\"2\" negated=\"true\" storage=\"set\"><connectionPointIn>$(from 1)</connectionPointIn><expression>c</expression></outVariable>"
wrong E1083 'several of negated, edge and storage at once'
body FBD '<jump localId="1" label="no name"/>'
wrong E1074 '`no name` is no name'
body FBD '<label localId="1" label="A"/><label localId="2" label="B"/><jump localId="3" label="A"/>'
expect 0 stc import small.xml -o operand --force
[ "$(sed -n '/^FBD/,/^END_FBD/p' operand/P.st | tr -d ' \n')" = "FBDA:B:JMPA;END_FBD" ] || fail "two labels at one network"
body FBD "$(in_variable 1 b)"
good
said 'warning\[W0072\]: POU P, network 1: nothing takes what this network computes'
body FBD ''
good
body FBD '<block localId="1" typeName="Unheard_of" instanceName="t"/>'  # comes in; the compiler knows
expect 1 stc check small.xml
said 'small\.xml/P\.st:'

rail='<leftPowerRail localId="1"/>'
contact() { printf '<contact localId="%s" %s><connectionPointIn>%s</connectionPointIn><variable>b</variable></contact>' "$1" "${3:-}" "$2"; }
coil() { printf '<coil localId="%s" %s><connectionPointIn>%s</connectionPointIn><variable>c</variable></coil>' "$1" "${3:-}" "$2"; }
body LD "$rail$(contact 2 "$(from 1)")$(contact 3 "$(from 1)")$(coil 4 "$(from 2)$(from 3)")"
good  # an OR
body LD "$rail$(contact 2 '')$(coil 3 "$(from 2)")"
wrong E1076 'nothing is connected to <contact localId="2">'
body LD "$rail$(contact 2 "$(from 3)")$(contact 3 "$(from 2)")$(coil 4 "$(from 3)")"
wrong E1078 'goes in a circle'
body LD "$rail$(contact 2 "$(from 1)" 'edge="sideways"')$(coil 3 "$(from 2)")"
wrong E1074 'edge `sideways` is unknown'
body LD "$rail$(contact 2 "$(from 1)")$(coil 3 "$(from 2)" 'storage="latch"')"
wrong E1074 'storage `latch` is unknown'
body LD "$rail$(contact 2 "$(from 1)" 'storage="set"')$(coil 3 "$(from 2)")"
wrong E1083 'cannot set or reset'
body LD "$rail$(contact 2 "$(from 1)")"
good
said 'W0072.*network 1'
# As CODESYS writes it: no places, titles, operators whose pins are counted from EN, open pins.
title='<vendorElement localId="100"><position x="0" y="0"/><alternativeText><xhtml>%s</xhtml></alternativeText><addData><data name="http://www.3s-software.com/plcopenxml/fbdelementtype"><ElementType>networktitle</ElementType></data></addData></vendorElement>'
operator='<addData><data name="http://www.3s-software.com/plcopenxml/fbdcalltype"><CallType xmlns="">operator</CallType></data></addData>'
body LD "<leftPowerRail localId=\"0\"/>$(printf "$title" first)$(contact 3 "$(from 0)")<inVariable localId=\"4\"><expression>a</expression></inVariable><inVariable localId=\"5\"><expression>7</expression></inVariable><block localId=\"6\" typeName=\"ADD\"><inputVariables><variable formalParameter=\"EN\"><connectionPointIn>$(from 3)</connectionPointIn></variable><variable formalParameter=\"In2\"><connectionPointIn>$(from 4)</connectionPointIn></variable><variable formalParameter=\"In3\"><connectionPointIn>$(from 5)</connectionPointIn></variable></inputVariables><outputVariables><variable formalParameter=\"ENO\"><connectionPointOut/></variable><variable formalParameter=\"Out2\"><connectionPointOut><expression>a</expression></connectionPointOut></variable></outputVariables>$operator</block><label localId=\"7\" label=\"Second\"/>$(printf "$title" second | sed s/100/101/)<contact localId=\"8\" negated=\"true\"><connectionPointIn>$(from 0)</connectionPointIn><variable>b</variable></contact><block localId=\"9\" typeName=\"TON\" instanceName=\"t\"><inputVariables><variable formalParameter=\"IN\"><connectionPointIn>$(from 8)</connectionPointIn></variable></inputVariables><outputVariables><variable formalParameter=\"Q\"><connectionPointOut/></variable><variable formalParameter=\"ET\"><connectionPointOut><expression>???</expression></connectionPointOut></variable></outputVariables></block><coil localId=\"10\" storage=\"none\" edge=\"none\"><connectionPointIn><connection refLocalId=\"9\" formalParameter=\"Q\"/></connectionPointIn><variable>b</variable></coil><rightPowerRail localId=\"2147483646\"><connectionPointIn>$(from 10)</connectionPointIn></rightPowerRail>"
rm -rf made
expect 0 stc import small.xml -o made
cat >wanted <<'T'
LADDER
  {network 'first'}
  |--[ b ]--[ a := ADD(a, 7) ]-------------------------------|

  {network 'second'}
  Second:
  |--[/ b ]--[ t: TON  IN:=_ ]------------------------( b )--|
END_LADDER
T
sed -n '/^LADDER/,/^END_LADDER/p' made/P.st | cmp - wanted || fail "a ladder of CODESYS is drawn differently"
expect 0 stc build small.xml -o small.img
values small.img 4 P.a=14 P.b=FALSE  # the timer without PT lets b toggle
# A bridge between two branches is no ladder of series and parallel: it comes as FBD.
body LD "$rail$(contact 2 "$(from 1)")$(contact 3 "$(from 1)")$(contact 4 "$(from 2)$(from 3)")$(contact 5 "$(from 3)")$(coil 6 "$(from 4)")$(coil 7 "$(from 5)" 'negated="true"')"
cp small.xml bridge.xml
# as_fbd WHY: it comes in as FBD, the report names network and reason, and exported again it is the ladder with its places.
as_fbd() {
  rm -rf made
  expect 0 stc import small.xml -o made
  said "note\[W0075\]: POU P, network 1: the ladder became FBD: $1"
  grep -q '^FBD$' made/P.st || fail "no FBD"
  expect 0 stc check made
  expect 0 stc export small.xml -o again.xml --without-sources
  grep -q '<LD>' again.xml || fail "no ladder any more"
  grep -A1 '<coil localId="9"' again.xml | grep -q '<position x="440" y="60" />' || fail "places are lost"
  rm -rf second
  expect 0 stc import again.xml -o second
  diff -r made second || fail "another program"
  expect 0 stc export made -o text.xml --without-sources  # of the text alone it is FBD
  grep -q '<FBD>' text.xml || fail "of text"
}
sed -i 's/coil localId="6"/coil localId="9"/; s/refLocalId="6"/refLocalId="9"/' small.xml
placed() { sed 's/<\(contact\|coil\|block\) localId="\([0-9]*\)"[^>]*>/&<position x="\2" y="60"\/>/g; s/x="9" y/x="440" y/; s/<leftPowerRail localId="1"\/>/<leftPowerRail localId="1"><position x="0" y="0"\/><\/leftPowerRail>/; s/<outVariable[^>]*>/&<position x="500" y="90"\/>/' small.xml >placed.xml && mv placed.xml small.xml; }
placed
as_fbd 'its wires are no series and parallel branches'
body LD "$rail$(contact 2 "$(from 1)")$(contact 3 "$(from 1)")$(contact 4 "$(from 2)")$(contact 5 "$(from 3)")$(contact 6 "$(from 2)")$(coil 9 "$(from 4)$(from 5)$(from 6)")$(coil 8 "$(from 6)$(from 3)")"
placed
as_fbd 'its wires are no series and parallel branches'
pinned() { printf '<block localId="5" typeName="TON" instanceName="t"><inputVariables><variable formalParameter="IN"%s><connectionPointIn>%s</connectionPointIn></variable></inputVariables><outputVariables><variable formalParameter="Q"%s><connectionPointOut/></variable></outputVariables></block>' "$1" "$(from 1)" "$2"; }
from_q='<connection refLocalId="5" formalParameter="Q"/>'
body LD "$rail$(pinned ' negated="true"' '')$(coil 9 "$from_q")"
placed
as_fbd 'the pin of `t` where power arrives is negated or sees an edge'
body LD "$rail$(pinned '' '')$(coil 9 "$from_q")$(out_variable 6 b "$from_q" | sed 's/localId="6"/& storage="set"/')"
placed
as_fbd 'a variable at an output of a box is set, reset or sees an edge'
# More branches inside each other than are looked for (kMaxBranchNesting).
deep() { printf '%s' "$rail"; seq 1 "$1" | awk '{ print "<contact localId=\"" 10 + $1 "\"><connectionPointIn><connection refLocalId=\"" ($1 == 1 ? 1 : 9 + $1) "\"/></connectionPointIn><variable>b</variable></contact><coil localId=\"" 1000 + $1 "\"><connectionPointIn><connection refLocalId=\"" 10 + $1 "\"/></connectionPointIn><variable>c</variable></coil>" }'; coil 9 "$(from $((10 + $1)))"; }
body LD "$(deep 64)"
rm -rf made
expect 0 stc import small.xml -o made
grep -q '^LADDER$' made/P.st || fail "64 branches"
body LD "$(deep 70)"
placed
as_fbd 'its wires are no series and parallel branches .*more than 64'
# Blanks around the lines of a comment are layout.
body LD "<comment localId=\"7\"><content><xhtml>one  &#10;    indented &#10;&#10;&#9;tab  </xhtml></content></comment>$rail$(contact 2 "$(from 1)")<coil localId=\"3\"><documentation><xhtml>  behind &#10;   the coil </xhtml></documentation><connectionPointIn>$(from 2)</connectionPointIn><variable>c</variable></coil>"
rm -rf made
expect 0 stc import small.xml -o made
grep -q '^LADDER$' made/P.st || fail "a comment made the ladder FBD: $(cat out)"
# kMaxRungCells: columns times rows.
wide() {
  contact 2 "$(from 1)" | sed "s/<variable>b/<variable>$(yes 'b AND' | head -n 166 | tr '\n' ' ')b/"
  seq 1 "$1" | awk '{ print "<coil localId=\"" 10 + $1 "\"><connectionPointIn><connection refLocalId=\"2\"/></connectionPointIn><variable>c</variable></coil>" }'
}
for rows in 8000 9000; do
  printf '<project><types><pous><pou name="P" pouType="program"><interface/><body><LD>%s%s</LD></body></pou></pous></types></project>' "$rail" "$(wide $rows)" >small.xml
  rm -rf made
  expect 0 stc import small.xml -o made
  grep -m 1 -E '^(LADDER|FBD)$' made/P.st >>languages
done
said 'W0075.*larger than 8388608 columns times rows'
[ "$(tr '\n' ' ' <languages)" = 'LADDER FBD ' ] || fail "a large rung"
# kMaxLinks, also where connectors multiply connections.
through() {
  printf '%s<connector name="all" localId="2"><connectionPointIn>' "$rail"
  seq 1 "$1" | awk '{ print "<connection refLocalId=\"" 100000 + $1 "\"/>" }'
  printf '</connectionPointIn></connector><continuation name="all" localId="3"/>'
  seq 1 "$1" | awk '{ print "<contact localId=\"" 100000 + $1 "\"><connectionPointIn><connection refLocalId=\"1\"/></connectionPointIn><variable>b</variable></contact>" }'
  seq 1 "$2" | awk '{ print "<coil localId=\"" 200000 + $1 "\"><connectionPointIn><connection refLocalId=\"3\"/></connectionPointIn><variable>c</variable></coil>" }'
}
body LD "$(through 100 100)"
expect 0 stc check small.xml
printf '<project><types><pous><pou name="P" pouType="program"><interface/><body><LD>%s</LD></body></pou></pous></types></project>' "$(through 10000 10000)" >small.xml
expect 1 timeout 20 "$bin/stc" check small.xml
said 'E1072.*connect more than 1048576 pairs'
cp bridge.xml small.xml

# Wires get names that no variable has.
sed 's/name="t"/name="or1"/; s/<derived name="TON"\/>/<BOOL\/>/' small.xml >clash.xml
sed -i 's/<localVars>/<localVars><variable name="and1"><type><BOOL\/><\/type><\/variable>/' clash.xml
rm -rf made
expect 0 stc import clash.xml -o made
grep -q 'WIRE or2 := OR' made/P.st || fail "names of wires"
expect 0 stc check made

# Conditions of charts: a network, and wires in the chart itself.
chart() {
  printf '<project><types><pous><pou name="P" pouType="program"><interface><localVars><variable name="a"><type><INT/></type></variable><variable name="b"><type><BOOL/></type><initialValue><simpleValue value="TRUE"/></initialValue></variable><variable name="n"><type><INT/></type></variable></localVars></interface><transitions>%s</transitions><body><SFC><step localId="1" name="First" initialStep="true"/><transition localId="2"><connectionPointIn><connection refLocalId="1"/></connectionPointIn><condition>%s</condition></transition><step localId="3" name="Second"><connectionPointIn><connection refLocalId="2"/></connectionPointIn></step><actionBlock localId="4"><connectionPointIn><connection refLocalId="3"/></connectionPointIn><action qualifier="P1"><inline><FBD>%s%s</FBD></inline></action></actionBlock>%s</SFC></body></pou></pous></types></project>' "$1" "$2" "$(in_variable 8 7)" "$(out_variable 9 n "$(from 8)")" "$3" >small.xml
}
reaches_b() {
  expect 0 stc build small.xml -o chart.img
  values chart.img 3 "P.n=$1"
}
wire="<connectionPointIn>$(from 11)</connectionPointIn>"
chart '' "$wire" "$(in_variable 10 a)<block localId=\"11\" typeName=\"EQ\"><inputVariables><variable formalParameter=\"IN1\"><connectionPointIn>$(from 10)</connectionPointIn></variable><variable formalParameter=\"IN2\"><connectionPointIn><expression>0</expression></connectionPointIn></variable></inputVariables><outputVariables><variable formalParameter=\"OUT\"/></outputVariables></block>"
reaches_b 7
chart "<transition name=\"Go\"><body><LD>$rail$(contact 2 "$(from 1)")$(contact 3 "$(from 2)" 'negated="true"')<coil localId=\"4\"><connectionPointIn>$(from 3)</connectionPointIn><variable>Go</variable></coil></LD></body></transition>" '<reference name="Go"/>' ''
reaches_b 0
chart "<transition name=\"Go\"><body><LD>$rail$(contact 2 "$(from 1)")<coil localId=\"4\"><connectionPointIn>$(from 2)</connectionPointIn><variable>Go</variable></coil></LD></body></transition>" '<reference name="Go"/>' ''
reaches_b 7
chart '' "$wire" "$(contact 11 "$(from 12)" 'edge="rising"')<leftPowerRail localId=\"12\"/>"
reaches_b 7
chart '' "$wire" '<block localId="11" typeName="NOT"><outputVariables><variable formalParameter="OUT" storage="set"/></outputVariables></block>'
expect 1 stc check small.xml
said 'E1083.*an output that sets or resets is no condition'
for network in "<inVariable localId=\"1\" edge=\"rising\"><expression>b</expression></inVariable>$(out_variable 2 Go "$(from 1)")" \
  "$(in_variable 1 b)<outVariable localId=\"2\" edge=\"rising\"><connectionPointIn>$(from 1)</connectionPointIn><expression>Go</expression></outVariable>"; do
  chart "<transition name=\"Go\"><body><FBD>$network</FBD></body></transition>" '<reference name="Go"/>' ''
  reaches_b 7
done
# What a condition cannot be (what it can: cli/import_chart_conditions).
for storage in set reset; do
  chart "<transition name=\"Go\"><body><FBD>$(in_variable 1 b)<outVariable localId=\"2\" storage=\"$storage\"><connectionPointIn>$(from 1)</connectionPointIn><expression>Go</expression></outVariable></FBD></body></transition>" '<reference name="Go"/>' ''
  expect 1 stc check small.xml
  said 'E1083.*sets or resets its own end, which keeps nothing'
done
chart '' "$wire" "$(in_variable 11 b)<block localId=\"12\" typeName=\"TON\" instanceName=\"t\"/>"
expect 1 stc check small.xml
said 'E1083.*calls `t`, and leads to no condition of the chart'
said 'help: connect it to a transition, or call it in an action'
two() { chart "<transition name=\"Go\"><body><FBD>$(in_variable 1 b)$(out_variable 2 "$1" "$(from 1)")$(out_variable 3 "$2" "$(from 1)")</FBD></body></transition>" '<reference name="Go"/>' ''; }
two b a
expect 1 stc check small.xml
said 'E1083.*the condition ends in 2 coils and variables, and none has the name of its transition'
said 'help: let one coil or <outVariable> with the name of the transition take the condition'
two Go Go
expect 1 stc check small.xml
said 'E1083.*the condition ends in 2 coils and variables `Go` instead of one'
body FBD '<block localId="1" typeName="EXECUTE"><inputVariables><variable formalParameter="EN"/></inputVariables><addData><data name="http://www.3s-software.com/plcopenxml/stcode" handleUnknown="implementation"><STCode>a := 1;</STCode></data></addData></block>'
wrong E1083 'holds statements of its own'
expect 1 stc check small.xml
said 'help: make them an ACTION, a function or a function block, and call that here'

# A box with 20,000 inputs and as many outputs of their names: time follows the size of the document.
pins() {  # LIST POINT
  printf '<%s>' "$1"
  seq 20000 | sed "s|.*|<variable formalParameter=\"a&\"><$2 /></variable>|"
  printf '</%s>' "$1"
}
body FBD "<block localId=\"1\" typeName=\"F\" instanceName=\"f\">PINS</block>"
{ sed 's/PINS.*//' small.xml; pins inputVariables connectionPointIn; pins outputVariables connectionPointOut
  sed 's/.*PINS//' small.xml; } >large.xml
expect 0 sh -c 'ulimit -t 6; exec "$1" import large.xml -o large' sh "$bin/stc"
exit 0
