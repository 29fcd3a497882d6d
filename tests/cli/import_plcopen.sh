#!/bin/sh
# PLCopen XML: declarations, text bodies, charts and the objects of CODESYS come in and run.
. "$(dirname "$0")/lib.sh"
samples=$source_dir/tests/fuzz/corpus/plcopen
cp "$samples"/*.xml .
needs_xml stc check declarations.xml

# run FILE SCANS VARIABLE=VALUE...: from the document, and from the sources that import writes.
run() {
  file=$1
  scans=$2
  shift 2
  rm -rf made
  expect 0 stc build "$file.xml" -o "$file.img"
  expect 0 stc import "$file.xml" -o made
  cp out report
  expect 0 stc build made -o made.img
  for image in "$file" made; do
    for pair in "$@"; do
      expect 0 stvm run $image.img --scans "$scans" --virtual-time --print "${pair%%=*}"
      grep -qxF "$pair" out || fail "$image: $pair"
    done
  done
}

run declarations 3 Line.sum=24 Line.ramp1.value=9 'shared=22' Line.motor.speed=2.5 'Line.motor.limits[1]=8' \
  'Line.list[1]=1' 'Line.list[5]=9' "Line.text='ready'" Line.part=50
grep -q '^  speed : REAL := 1.5; (\* in rpm ( \* or \* ) so \*)$' made/Motor.st || fail "comment of a member"
grep -q '^VAR RETAIN$' made/Ramp.st || fail RETAIN
grep -q 'TYPE Percent : INT (0..100) := 50;' made/Percent.st || fail subrange
grep -q 'lamp AT %QX0.0 : BOOL;' made/Plant.st || fail address
grep -q 'Sum : Cpu.Line.sum : DINT READ_ONLY;' made/Plant.st || fail access
said() { cat out err report | grep -qE -- "$1" || fail "not said: $1"; }
said '^10 source\(s\), 0 error\(s\), 0 warning\(s\), 0 note\(s\)'

run chart 5 B.n=4 B.left=2 B.right=2 B.valve=TRUE
run chart 12 B.n=6 B.done=21 B.left=3 B.valve=FALSE
grep -q 'TRANSITION (PRIORITY := 2) FROM Choose TO Slow := TRUE;' made/Batch.st || fail priority
grep -q 'TRANSITION (PRIORITY := 1) FROM Choose TO Quick := NOT (n < 0 OR done > 50);' made/Batch.st || fail negated
grep -q 'TRANSITION FROM Start TO (Fill_left, FillRight) := n >= 3;' made/Batch.st || fail divergence
grep -q 'valve(L, T#1h);' made/Batch.st || fail qualifier
said 'warning\[W0073\]: POU Batch: step `Fill left` became `Fill_left`'

run objects 2 PLC_PRG.position=102 GVL.count=244 PLC_PRG.acts=2 PLC_PRG.drive1.calls=2
said 'objects.xml:[0-9]+:[0-9]+: warning\[W0070\]: POU PLC_PRG: addData `http://vendor.example/xml/trend` is not understood'
said 'note\[W0071\]: addData `http://www.3s-software.com/plcopenxml/projectstructure`'
grep -q 'METHOD PRIVATE Note' made/Drive.st || fail access
expect 0 stc check objects.xml
grep -q projectstructure err && fail "notes are for import"

# Tests in the language, of blocks that come from XML; messages for tools.
printf "TEST 'imported' VAR d : Drive; END_VAR d.Position := 5; ASSERT_EQ(d.Go(2), 7); END_TEST\n" >t.st
expect 0 stc test objects.xml t.st
said '1 passed'
expect 0 stc check objects.xml --format json
said '"file": ?"objects\.xml"'

# IEC 61131-10: other names, networks with numbers, connections by pin.
run iec10 3 M.a=18 M.sum=9 M.loop=9 M.pump.speed=2.5 L.out=TRUE L.edges.n=1
said '^7 source\(s\), 0 error\(s\), 0 warning\(s\)'
grep -q '^NAMESPACE Tools$' made/Twice.st || fail namespace
grep -q 'go : BOOL R_EDGE;' made/Counter.st || fail "order or edge of parameters"
sed -n '/^FBD/,/^END_FBD/p' made/Main.st | grep -n 'ADD(3, loop)' | grep -q '^3:' || fail "order of networks"
grep -q '^  Top:$' made/Rungs.st || fail label
# ten BODY: a program of 61131-10.
ten() { printf '<Project xmlns="www.iec.ch/public/TC65SC65BWG7TF10" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"><Types><GlobalNamespace><Program name="P"><Vars><Variable name="a"><Type>%s</Type></Variable></Vars><MainBody>%s</MainBody></Program></GlobalNamespace></Types></Project>' "${2:-<TypeName>INT</TypeName>}" "$1" >ten.xml; }
ten_wrong() {
  expect 1 stc check ten.xml
  said "ten\.xml:1:[0-9]+: error\[$1\]: .*$2"
}
network() { ten "<BodyContent xsi:type=\"FBD\"><Network evaluationOrder=\"1\">$1</Network></BodyContent>"; }
sink() { printf '<FbdObject xsi:type="DataSink" identifier="a"><ConnectionPointIn><Connection refConnectionPointOutId="%s"/></ConnectionPointIn></FbdObject>' "$1"; }
source_of() { printf '<FbdObject xsi:type="DataSource" identifier="1"><ConnectionPointOut connectionPointOutId="%s"/></FbdObject>' "$1"; }
network "$(source_of 1)$(sink 1)"
expect 0 stc check ten.xml
network "$(source_of 1)$(sink 2)"
ten_wrong E1076 'a connection leads to localId `pin 2`'
network "$(source_of 1)$(source_of 1)$(sink 1)"
ten_wrong E1075 'connectionPointOutId 1 is there twice'
# Numbers of elements count in their network, and networks keep their order however many there are.
moves() { for pair in 1 2; do printf '<FbdObject xsi:type="DataSource" identifier="%s%s"><RelPosition x="0" y="%s"/><ConnectionPointOut connectionPointOutId="%s"/></FbdObject>' "$1" "$pair" "$((pair * 20))" "$pair"; sink "$pair" | sed "s/identifier/evaluationOrder=\"$((3 - pair))\" identifier/"; done; }
ten "<BodyContent xsi:type=\"FBD\"><Network evaluationOrder=\"2\">$(moves 2)</Network><Network evaluationOrder=\"1\">$(moves 1)</Network></BodyContent>"
rm -rf order
expect 0 stc import ten.xml -o order
[ "$(sed -n 's/^  a := \(.*\);/\1/p' order/P.st | tr '\n' ' ')" = '12 11 22 21 ' ] || fail "evaluationOrder of several networks: $(cat order/P.st)"
ten "<BodyContent xsi:type=\"FBD\">$(seq 1 10100 | awk '{ print "<Network evaluationOrder=\"" $1 "\"><FbdObject xsi:type=\"DataSource\" identifier=\"" $1 "\"><RelPosition x=\"0\" y=\"" 200000 - 10 * $1 "\"/><ConnectionPointOut connectionPointOutId=\"1\"/></FbdObject><FbdObject xsi:type=\"DataSink\" identifier=\"a\"><ConnectionPointIn><Connection refConnectionPointOutId=\"1\"/></ConnectionPointIn></FbdObject></Network>" }')</BodyContent>"
rm -rf order
expect 0 stc import ten.xml -o order
sed -n 's/^  a := \(.*\);/\1/p' order/P.st >numbers
seq 1 10100 | cmp -s - numbers || fail "order of many networks"
network '<FbdObject xsi:type="v:InlineST"/>'
ten_wrong E1083 'InlineST.* is not understood'
ten '<BodyContent xsi:type="SFC"><Step/></BodyContent>'
ten_wrong E1083 'charts of IEC 61131-10 are not read'
ten '' '<InstantlyDefinedType xsi:type="OddTypeSpec"/>'
ten_wrong E1074 '`OddTypeSpec` is not known'
ten '<BodyContent xsi:type="ST"><ST>a := 2;</ST></BodyContent>' '<x/>'
ten_wrong E1073 'has no <TypeName>'

# Qualifiers of a list that CODESYS keeps beside it.
printf '<project><types><pous><pou name="P" pouType="program"><interface/><body><ST>G.b := G.a;</ST></body></pou></pous></types><addData><data name="http://www.3s-software.com/plcopenxml/globalvars"><globalVars name="G"><variable name="a"><type><INT/></type></variable><variable name="b"><type><INT/></type></variable><addData><data name="http://www.3s-software.com/plcopenxml/mixedattrsvarlist"><MixedAttrsVarList><globalVars name="G" constant="true"><variable name="a"><type><INT/></type><initialValue><simpleValue value="6"/></initialValue></variable></globalVars><globalVars name="G" retain="true"><variable name="b"><type><INT/></type></variable></globalVars></MixedAttrsVarList></data></addData></globalVars></data></addData></project>' >mixed.xml
run mixed 1 b=6
grep -q '^VAR_GLOBAL CONSTANT$' made/G.st || fail "qualifiers of mixed lists"
grep -q '^VAR_GLOBAL RETAIN$' made/G.st || fail "qualifiers of mixed lists"

# The same in other encodings.
mkdir utf16
iconv -f UTF-8 -t UTF-16 declarations.xml >utf16/declarations.xml
cd utf16
expect 0 stc build declarations.xml -o ../utf16.img
cd ..
expect 0 stc build declarations.xml -o utf8.img
cmp utf8.img utf16.img || fail "UTF-16 is another program"
small() {  # small BODY [INTERFACE] [OTHER]
  printf '<?xml version="1.0" encoding="%s"?><project><types><pous><pou name="P" pouType="program"><interface>%s</interface>%s%s</pou></pous></types></project>' \
    "${encoding:-UTF-8}" "${2:-}" "$1" "${3:-}" >small.xml
}
encoding=ISO-8859-1
small "<body><ST>(* gr$(printf '\374')n *)</ST></body>"
expect 0 stc import small.xml -o latin
grep -q 'grün' latin/P.st || fail Latin-1
encoding=UTF-8
small "<body><ST>(* gr$(printf '\374')n *)</ST></body>"
expect 1 stc check small.xml
said 'E1070.*byte [0-9]+ is no UTF-8'
encoding=utf-16
small '<body><ST>;</ST></body>'
expect 0 stc check small.xml
encoding=UTF-8

# wrong CODE TEXT: what small.xml now says is that error, at a place in it.
wrong() {
  expect 1 stc check small.xml
  said "small\.xml:1:[0-9]+: error\[$1\]: .*$2"
}
small '' '<localVars><variable><type><INT/></type></variable></localVars>'
wrong E1073 'POU P: <variable> has no attribute `name`'
small '' '<localVars><variable name="a b"><type><INT/></type></variable></localVars>'
wrong E1074 '`a b` is no name of Structured Text'
small '' '<localVars><variable name="a"><type><FLOAT/></type></variable></localVars>'
wrong E1074 '<FLOAT> is no type'
small '' '<localVars><variable name="a"/></localVars>'
wrong E1073 'a type is missing'
small '' '<localVars retain="maybe"><variable name="a"><type><INT/></type></variable></localVars>'
wrong E1074 'neither true nor false'
small '' '<localVars><variable name="a" address="QX; b"><type><INT/></type></variable></localVars>'
wrong E1074 'is no address'
small '' '<localVars><variable name="a"><type><derived name="INT; b : INT"/></type></variable></localVars>'
wrong E1074 'is no type or bound'
small '<body><CFC/></body>'
wrong E1083 'the body of P is in <CFC>'
small '<body><ST><xhtml/></ST><addData><data name="http://www.3s-software.com/plcopenxml/cfc" handleUnknown="implementation"><CFC/></data></addData></body>'
wrong E1083 'the body of P is in CFC, which does not come in'
said 'help: write it in ST, ladder or FBD where it was made'
rm -rf cfc
expect 1 stc import small.xml -o cfc
expect 1 stc check cfc  # no empty body
small '<body><ST>;</ST></body><body><IL>LD 1</IL></body>' '' ''
sed -i 's/pouType="program"/pouType="gadget"/' small.xml
wrong E1074 'pouType `gadget` is unknown'
printf '<project/>' >small.xml
wrong E1071 'has no POU, type or variable'

sfc() { small "<body><SFC><step localId=\"1\" name=\"A\" initialStep=\"true\"><connectionPointIn><connection refLocalId=\"2\"/></connectionPointIn></step>$1</SFC></body>"; }
transition() { printf '<transition localId="%s"><connectionPointIn><connection refLocalId="%s"/></connectionPointIn><condition>%s</condition></transition>' "$1" "$2" "$3"; }
good='<inline name=""><ST>TRUE</ST></inline>'
sfc "$(transition 2 1 "$good")"
expect 0 stc check small.xml
sfc "$(transition 1 1 "$good")"
wrong E1075 'localId 1 is there twice'
sfc "$(transition 2 7 "$good")"
wrong E1076 'hangs at `7`'
sfc "$(transition 2 1 "$good")$(transition 3 2 "$good")"
wrong E1082 'without a step between them'
sfc "$(transition 2 1 "$good")<jumpStep localId=\"4\" targetName=\"Nowhere\"><connectionPointIn><connection refLocalId=\"2\"/></connectionPointIn></jumpStep>"
wrong E1082 'a jump leads to `Nowhere`'
# A jump to a step whose name had to be changed; actions get names that are free.
sfc "$(transition 2 1 "$good")$(transition 9 1 "$good")<step localId=\"5\" name=\"Go on\"><connectionPointIn><connection refLocalId=\"9\"/></connectionPointIn></step>$(transition 6 5 "$good")<jumpStep localId=\"7\" targetName=\"Go on\"><connectionPointIn><connection refLocalId=\"6\"/></connectionPointIn></jumpStep><actionBlock localId=\"8\"><connectionPointIn><connection refLocalId=\"5\"/></connectionPointIn><action><inline><ST>;</ST></inline></action><action><inline><ST>;</ST></inline></action></actionBlock>"
rm -rf jump
expect 0 stc import small.xml -o jump
said 'W0073.*step `Go on` became `Go_on`'
grep -q 'TRANSITION FROM Go_on TO Go_on' jump/P.st || fail "jump to a renamed step"
grep -q '  Go_on_action_2(N);' jump/P.st || fail "names of actions"
expect 0 stc check jump
sfc "$(transition 2 1 "$good")<step localId=\"5\" name=\"a\"/>"
wrong E1082 'there are two steps `a`'
sfc "$(transition 2 1 '<inline name=""><ST>a := 1; b := 2;</ST></inline>')"
wrong E1083 'no single expression'
sfc "$(transition 2 1 '')"
wrong E1083 'has no condition'
# Negated conditions, and actions; comments.
negated() { sfc "$(transition 2 1 "$2" | sed "s/<condition>/<condition negated=\"$1\">/")"; }
negated 1 '<inline name=""><ST>TRUE // always</ST></inline>'
rm -rf negated
expect 0 stc import small.xml -o negated
grep -q ':= NOT (TRUE // always$' negated/P.st || fail "a negated condition"
expect 0 stc check negated
negated maybe "$good"
wrong E1074 'neither true nor false'
negated true '<inline name=""><IL>LD TRUE</IL></inline>'
wrong E1083 'a condition in IL is negated'
sfc "$(transition 2 1 '<reference name="a; b"/>')"
wrong E1074 '`a; b` is no variable'
sfc "$(transition 2 1 "$good")<actionBlock localId=\"3\" negated=\"true\"><connectionPointIn><connection refLocalId=\"1\"/></connectionPointIn></actionBlock>"
wrong E1083 'an action block is negated'
sfc "$(transition 2 1 "$good")<comment localId=\"3\"><content><p>What it is for</p></content></comment>"
rm -rf negated
expect 0 stc import small.xml -o negated
grep -B1 'INITIAL_STEP' negated/P.st | grep -qF '(* What it is for *)' || fail "comment of a chart"
# Uses of actions are names, times and variables, and nothing else.
uses() { sfc "$(transition 2 1 "$good")<actionBlock localId=\"3\"><connectionPointIn><connection refLocalId=\"1\"/></connectionPointIn><action $2><reference name=\"$1\"/></action></actionBlock>"; }
uses 'P (a)' ''
wrong E1074 '`P \(a\)` is no action or variable'
uses 'a(N); b' ''
wrong E1074 'is no action or variable'
uses a 'qualifier="P (a)"'
wrong E1074 '`P \(a\)` is no action qualifier'
uses a 'qualifier="D" duration="P (a)"'
wrong E1074 'duration `P \(a\)` is neither time nor variable'
uses a 'qualifier="D" duration="T#1s); b(N"'
wrong E1074 'is neither time nor variable'
uses a 'qualifier="N" indicator="P (a)"'
wrong E1074 'indicator `P \(a\)` is no variable'
# Divergences that follow each other are no deeper than others.
{
  printf '<project><types><pous><pou name="P" pouType="program"><interface/><body><SFC><step localId="1" name="A" initialStep="true"/>%s' "$(transition 2 1 "$good")"
  seq 3 40002 | sed 's/.*/<selectionDivergence localId="&"><connectionPointIn><connection refLocalId="#"\/><\/connectionPointIn><\/selectionDivergence>/' | awk '{ sub("#", NR + 1); print }'
  printf '<jumpStep localId="50000" targetName="A"><connectionPointIn><connection refLocalId="40002"/></connectionPointIn></jumpStep></SFC></body></pou></pous></types></project>'
} >small.xml
expect 0 stc check small.xml
{
  printf '<project><types><pous><pou name="P" pouType="program"><interface/><body><SFC><step localId="2" name="A" initialStep="true"/>'
  seq 3 3002 | awk '{ print "<selectionDivergence localId=\"" $1 "\"><connectionPointIn><connection refLocalId=\"" $1 - 1 "\"/></connectionPointIn></selectionDivergence>" }'
  seq 5000 6999 | awk '{ print "<transition localId=\"" $1 "\"><connectionPointIn><connection refLocalId=\"3002\"/></connectionPointIn><condition><reference name=\"b\"/></condition></transition><jumpStep localId=\"" $1 + 5000 "\" targetName=\"A\"><connectionPointIn><connection refLocalId=\"" $1 "\"/></connectionPointIn></jumpStep>" }'
  printf '</SFC></body></pou></pous></types></project>'
} >small.xml
expect 1 stc check small.xml
said 'E1082.*there are too many ways through divergences'
sfc "$(transition 2 1 "$good")<macroStep localId=\"9\"/>"
wrong E1083 'macroStep.*: steps of a chart inside of a step do not come in'
said 'help: draw its steps into the chart itself'
sfc "$(transition 2 1 "$good")<coil localId=\"9\"/>"
wrong E1083 'does something, and a chart has it nowhere'
sfc "$(transition 2 1 "$good")<gadget localId=\"9\"/>"
wrong E1083 'in a chart is not understood'
# A document type is read over, and nothing in it is expanded.
printf '<!DOCTYPE p [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]><project><types><pous><pou name="P" pouType="program"><interface/><body><ST>(* &b; *)</ST></body></pou></pous></types></project>' >small.xml
expect 0 stc import small.xml -o bomb
grep -q aaaa bomb/P.st && fail "an entity was expanded"
# Names stay in their folder.
printf '<project><types><pous><pou name="../../x" pouType="program"><interface/></pou></pous></types></project>' >small.xml
wrong E1074 'is no name'
exit 0
