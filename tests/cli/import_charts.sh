#!/bin/sh
# Charts of CODESYS and TwinCAT: the actions that a step has itself, on entry, while it is active and
# on exit, in PLCopen XML as CODESYS writes it and in objects of TwinCAT (what those do:
# cli/vendor_sources). What does not come in is named.
. "$(dirname "$0")/lib.sh"

# --- PLCopen XML
name=38391c6d-6d4a-42f8-8ee7-9f45e5adafa8
main=700a583f-b4d4-43e4-8c14-629c7cd3bec8
entry=a6b08bd8-b696-47e3-9cbf-7408b61c9ff8
leave=a2621e18-7de3-4ea6-ae6d-89e9e0b7befd
least=cacf1a68-236e-47c2-b7b1-1cf9199718cb
most=b693554c-1b01-4a8d-afde-9e3a46f7465d
exclude=01580b27-6378-448b-8ecb-0e4b795b58d6
data() {  # data GUID VALUE ...
  printf '<addData><data name="http://www.3s-software.com/plcopenxml/sfc/element" handleUnknown="implementation"><attributes>'
  while [ $# -gt 0 ]; do
    printf '<attribute guid="%s">%s</attribute>' "$1" "$2"
    shift 2
  done
  printf '</attributes></data></addData>'
}
step() {  # step ID ABOVE MORE DATA...
  id=$1 above=$2 more=$3
  shift 3
  printf '<step localId="%s" %s><position x="0" y="0"/><connectionPointIn>' "$id" "$more"
  [ -z "$above" ] || printf '<connection refLocalId="%s"/>' "$above"
  printf '</connectionPointIn><connectionPointOut formalParameter="sfc"/>'
  data "$@"
  printf '</step>\n'
}
transition() {  # transition ID ABOVE CONDITION DATA...
  printf '<inVariable localId="%s0"><position x="0" y="0"/><connectionPointOut/><expression>%s</expression></inVariable>' "$1" "$3"
  printf '<transition localId="%s"><position x="0" y="0"/><connectionPointIn><connection refLocalId="%s" formalParameter="sfc"/></connectionPointIn><condition><connectionPointIn><connection refLocalId="%s0"/></connectionPointIn></condition>' "$1" "$2" "$1"
  shift 3
  data "$@"
  printf '</transition>\n'
}
plant() {  # the chart from standard input
  printf '<?xml version="1.0" encoding="utf-8"?><project xmlns="http://www.plcopen.org/xml/tc6_0200"><types><dataTypes/><pous>'
  printf '<pou name="Plant" pouType="program"><interface><localVars>'
  for one in n fills entered left_; do
    printf '<variable name="%s"><type><INT/></type></variable>' $one
  done
  printf '<variable name="log"><type><string length="80"/></type></variable></localVars></interface><actions>'
  for one in 'Close:left_ := left_ + 1; log := CONCAT(log, "c");' 'Count:n := n + 1;' \
    'Filling:fills := fills + 1; log := CONCAT(log, "f");' 'Open:entered := entered + 1; log := CONCAT(log, "o");'; do
    printf '<action name="%s"><body><ST><xhtml xmlns="http://www.w3.org/1999/xhtml">%s</xhtml></ST></body></action>' \
      "${one%%:*}" "$(printf %s "${one#*:}" | tr '"' "'")"
  done
  printf '</actions><body><SFC>\n'
  cat
  printf '</SFC></body></pou></pous></types><instances><configurations/></instances></project>\n'
}
chart() {  # chart DATA OF THE SECOND STEP...
  step 1 '' 'name="Init" initialStep="true"' $main Count $name Init
  transition 2 1 'n &gt;= 3' $name 'n &gt;= 3'
  step 3 2 'name="Fill"' $name Fill "$@"
  transition 4 3 'TRUE'
  printf '<jumpStep localId="5" targetName="Init"><position x="0" y="0"/><connectionPointIn><connection refLocalId="4"/></connectionPointIn>'
  data $name Init
  printf '</jumpStep>\n'
}
chart $entry Open $main Filling $leave Close $least 'T#20ms' $most 'T#1s' | plant >plant.xml
needs_xml stc check plant.xml
expect 0 stc import plant.xml -o text
said 'note\[W0071\]: POU Plant: the longest time of a step, T#1s, ends nothing: it was watched only'
grep -q W0070 err out && fail "something was not understood"
for line in 'Open(P1);' 'Filling(N);' 'Close(P0);' 'Count(N);' \
  'TRANSITION FROM Fill TO Init := ((TRUE)) AND Fill.T >= T#20ms;'; do
  grep -qF "$line" text/Plant.st || fail "no $line"
done
grep -B1 'ACTION Filling' text/Plant.st | grep -q no_final_scan || fail "a final scan of Filling"
for action in Open Close; do
  grep -B1 "ACTION $action" text/Plant.st | grep -q no_final_scan || fail "$action is of a step itself"
done
# As they run in a scan: what is left, what is entered, what is active.
[ "$(sed -n 's/^ *ACTION \(.*\):$/\1/p' text/Plant.st | tr '\n' ' ')" = 'Close Open Count Filling ' ] ||
  fail "order: $(grep ACTION text/Plant.st)"
# Two scans of each Fill: the step's own action does not run once more when it is left.
expect 0 stvm run plant.xml --virtual-time --scans 9 --print Plant.log --print Plant.n --print Plant.left_
said "^Plant.log='offcoffc'"
said '^Plant.n=5$'
said '^Plant.left_=2$'
# It goes out as it came in.
expect 0 stc export text -o again.xml
expect 0 stc import again.xml -o text_again
expect 0 stvm run text_again --virtual-time --scans 9 --print Plant.log
said "^Plant.log='offcoffc'"
[ "$(grep -c no_final_scan text_again/*.st)" -eq 4 ] || fail "the attributes of the actions"

refused() {  # refused TEXT: the chart from standard input
  plant >bad.xml
  expect 1 stc import bad.xml -o bad --force
  said "$1"
}
chart $main 'a b' | refused 'error\[E1074\]: POU Plant: the action `a b` of a step is no name'
chart $exclude TRUE | refused 'error\[E1083\]: POU Plant: a step that is excluded from the build does not come in'
chart $least 'T#1s; n := 1' | refused 'error\[E1074\]: POU Plant: the shortest time `T#1s; n := 1` of a step is neither time nor variable'
chart $main Filling | sed "s|<attribute guid=\"$name\">n &gt;= 3|<attribute guid=\"$exclude\">TRUE|" |
  refused 'error\[E1083\]: POU Plant: a transition that is excluded from the build does not come in'
chart $entry Filling $main Filling | refused 'error\[E1083\]: POU Plant: the chart: the action `filling` is that of an entry and of an active step'
chart 00000000-0000-0000-0000-000000000001 x | plant >odd.xml
expect 0 stc import odd.xml -o odd
said 'warning\[W0070\]: POU Plant: the attribute 00000000-0000-0000-0000-000000000001 of an element of a chart is not understood'

# --- objects of TwinCAT
own() {  # own ID VALUE ...
  printf '<l2 n="Attributes" cet="SFCAttribute">'
  while [ $# -gt 0 ]; do
    printf '<o><v n="AttributeId">{%s}</v><o n="Value" t="StringValue"><v n="Value">"%s"</v></o></o>' "$1" "$2"
    shift 2
  done
  printf '</l2>'
}
element() {  # element TYPE INSIDE ID VALUE ...
  type=$1 inside=$2
  shift 2
  printf '<o t="SFC%s">%s%s</o>' "$type" "$inside" "$(own "$@")"
}
object() {  # object: the elements from standard input, members in $members
  printf '<TcPlcObject><POU Name="Chart"><Declaration>PROGRAM Chart VAR n : INT; END_VAR</Declaration>'
  printf '<Implementation><SFC><XmlArchive><Data><o t="SFCImplementationObject"><o n="Root" t="SFCSegment"><o n="ElementList" t="SFCElementList"><l2 n="InnerList">'
  cat
  printf '</l2></o></o></o></Data></XmlArchive></SFC></Implementation>%s</POU></TcPlcObject>\n' "$members"
}
bad_chart() {  # bad_chart CODE TEXT: the elements from standard input
  object >chart.TcPOU
  expect 1 stc import chart.TcPOU -o bad --force
  said "error\[$1\]: POU Chart: the chart of Chart: $2"
  expect 1 stc check bad/Chart.st
}
members=
init=6844a48e-46c2-4cc8-a185-a478f3b99cc0
parallel=23bdaa98-72ec-41f7-817b-9dede5697086
a=$(element Step '' $name A $init TRUE)
b=$(element Step '' $name B)
go=$(element Transition '' $name 'TRUE')
back=$(element Jump '' $name A)
list() { printf '<o n="ElementList" t="SFCElementList"><l2 n="InnerList">%s</l2></o>' "$1"; }
ways() { printf '<l2 n="Segments" cet="SFCSegment">'; for one in "$@"; do printf '<o>%s</o>' "$(list "$one")"; done; printf '</l2>'; }
echo "$a$go$b$go$back" | object >chart.TcPOU
expect 0 stc check chart.TcPOU
echo "$a$b" | bad_chart E1082 'step `B` stands behind a step'
echo "$a$go$go$back" | bad_chart E1082 'a transition stands behind a transition'
echo "$a$go$b$go" | bad_chart E1082 'it ends with a transition'
echo "$a$back" | bad_chart E1082 'a jump to `A` stands behind no transition'
echo "$a$(element Branch "$(ways "$b" "$b")" $parallel TRUE)" | bad_chart E1082 'parallel branches stand behind a step'
echo "$a$go$(element Branch "$(ways "$go" "$go")" $parallel FALSE)" | bad_chart E1082 'branches stand behind a transition'
echo "$a$(element Branch "$(ways "$go$b" "$go")" $parallel FALSE)" | bad_chart E1082 'a branch ends with a step'
echo "$a$go$(element Branch "$(ways "$b$go" "$b")" $parallel TRUE)" | bad_chart E1082 'a parallel branch ends with a transition'
echo "$a$(element Transition '' $name '')$back" | bad_chart E1083 'a transition has no condition'
echo "$a$(element Transition '<o n="EmbeddedTransition" t="X" />' $name T)$back" | bad_chart E1083 'a transition has its condition inside of it'
echo "$(element Step '<o n="EmbeddedMainAction" t="X" />' $name A)" | bad_chart E1083 'step `A` has an action inside of it'
echo "$(element Step "$(list '<o t="SFCAction" />')" $name A)" | bad_chart E1083 'an action of step `A` has no name or no qualifier'
echo "$(element Step '' $name '1A')" | bad_chart E1074 'a step is called `1A`, which is no name'
echo "$(element Macro '' $name A)" | bad_chart E1083 'an element of type `SFCMacro` is not known here'
echo "$a$(element Transition '' $name T $exclude TRUE)$back" | bad_chart E1083 'a transition that is excluded'
echo "$a$(element Transition '' $name 'TRUE; n := 1')$back" | bad_chart E1083 'the condition `TRUE; n := 1` is no expression'
echo "$(element Step '' $name A $init TRUE $least 'T#1s; n := 1')$go$back" | bad_chart E1074 'the shortest time `T#1s; n := 1` of a step'
echo "$a$go$(element Jump '' $name A $exclude TRUE)" | bad_chart E1083 'a jump that is excluded'
echo "$a$(element Branch '' $parallel FALSE)$back" | bad_chart E1083 'branches that have no ways'
echo "$(element Step "$(list "$(element Action '' $name Act e174fc0d-80b0-4a9e-a530-ca239c249a50 'N; x')")" $name A)" |
  bad_chart E1083 'an action of step `A` has the qualifier `N; x`'
echo "$(element Step '' $name A $entry Act $leave Act)$go$back" | bad_chart E1083 'the action `act` is that of an entry and of an exit'
members='<Transition Name="T"><Implementation><ST>n := 1; n := 2;</ST></Implementation></Transition>'
echo "$a$(element Transition '' $name T)$back" | bad_chart E1083 'transition `T` is no single expression in ST'
members='<ObjectProperties><o t="SFCProperty"><d2 n="Flags"><v>Init</v><o><v n="Use">true</v></o><v>Reset</v><o><v n="Use">false</v></o></d2></o></ObjectProperties>'
echo "$a$go$back" | object >chart.TcPOU
expect 0 stc import chart.TcPOU -o flags
said 'warning\[W0070\]: POU Chart: the chart of Chart: the flag `SFCInit` does nothing here'
grep -q SFCReset err out && fail "a flag that is not used"
exit 0
