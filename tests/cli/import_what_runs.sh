#!/bin/sh
# Imported projects do what they did where they were made: what is excluded stays out, instances,
# tasks, alternatives and programs as boxes are those that were meant, and older forms are read.
. "$(dirname "$0")/lib.sh"
html='<xhtml xmlns="http://www.w3.org/1999/xhtml">'
vendor=http://www.3s-software.com/plcopenxml

# runs INPUT SCANS VARIABLE=VALUE...
runs() {
  input=$1
  scans=$2
  shift 2
  for pair in "$@"; do
    expect 0 stvm run "$input" --dialect codesys --scans "$scans" --virtual-time --print "${pair%%=*}"
    grep -qxF "$pair" out || fail "$input: not $pair"
  done
}
project() {  # project VERSION POUS REST: a document
  printf '<project xmlns="http://www.plcopen.org/xml/%s"><types><dataTypes/><pous>%s</pous></types>%s</project>\n' "$@"
}
pou() {  # pou NAME KIND INTERFACE BODY [REST]
  printf '<pou name="%s" pouType="%s"><interface>%s</interface>%s%s</pou>' "$1" "$2" "$3" "$4" "${5:-}"
}
variable() { printf '<variable name="%s"><type><%s/></type></variable>' "$1" "$2"; }
st() { printf '<body><ST>%s%s</xhtml></ST></body>' "$html" "$1"; }
counter="<localVars>$(variable n INT)</localVars>"
none='<instances><configurations/></instances>'
instances() {  # instances TASK
  printf '<instances><configurations><configuration name="C"><resource name="R">%s</resource></configuration></configurations></instances>' "$1"
}

# --- TC6 1.0: the type of an instance, times of a clock, a condition that hangs at a wire.
pous="$(pou Slow program "$counter" '<body><ST>n := n + 1;</ST></body>')$(pou Fast program "$counter" '<body><ST>n := n + 100;</ST></body>')"
project tc6.xsd "$pous" \
  "$(instances '<task name="T" interval="00:00:00.010" priority="0"><pouInstance name="Slow" type="Fast"/></task>')" >old.xml
needs_xml stc check old.xml
runs old.xml 3 Slow.n=300
expect 0 stc import old.xml -o old
grep -q 'INTERVAL := T#00h00m00.010s' old/*.st || fail "interval: $(cat old/C.st)"
for wrong in 00:10 1:2:3:4 :00:01 00:0x:00 00:00:1.2.3 0.5:00:01; do
  sed "s/00:00:00.010/$wrong/" old.xml >wrong.xml
  expect 1 stc check wrong.xml
  said "E1074.* interval \`$wrong\` is no time"
done
place() { printf '<position x="%s" y="%s"/>' "$1" "$2"; }
from() { printf '<connectionPointIn><connection refLocalId="%s"/></connectionPointIn>' "$1"; }
step() { printf '<step localId="%s" name="%s"%s>%s%s</step>' "$1" "$2" "$5" "$(place "$3" "$4")" "${6:-}"; }
chart="$(step 1 S0 100 10 ' initialStep="true"')<inVariable localId=\"20\">$(place 10 20)<connectionPointOut/><expression>n = 0</expression></inVariable>
<transition localId=\"2\">$(place 100 40)$(from 1)<condition><connection refLocalId=\"20\"/></condition></transition>$(step 3 S1 100 60 '' "$(from 2)")"
project tc6.xsd "$(pou P program "$counter" "<body><SFC>$chart</SFC></body>")" "$none" >wire.xml
runs wire.xml 2 P.S1.X=TRUE

# --- of alternatives the left one goes first, however high it stands
always() { printf '<transition localId="%s">%s%s<condition><inline name=""><ST>TRUE</ST></inline></condition></transition>' "$1" "$(place "$2" "$3")" "$(from "$4")"; }
chart="$(step 1 S0 100 10 ' initialStep="true"')<selectionDivergence localId=\"2\">$(place 50 40)$(from 1)</selectionDivergence>
$(always 3 200 100 2)$(always 4 50 120 2)$(step 5 R 200 160 '' "$(from 3)")$(step 6 L 50 160 '' "$(from 4)")"
project tc6_0201 "$(pou P program "$counter" "<body><SFC>$chart</SFC></body>")" "$none" >left.xml
runs left.xml 2 P.L.X=TRUE P.R.X=FALSE

# --- excluded from the build
excluded="<addData><data name=\"$vendor/buildproperties\" handleUnknown=\"implementation\"><BuildProperties><ExcludeFromBuild>true</ExcludeFromBuild></BuildProperties></data></addData>"
globals="$(instances "<globalVars name=\"G\">$(variable n INT)</globalVars>")"
project tc6_0200 "$(pou PLC_PRG program '' "$(st 'G.n := G.n + 1;')" "<actions><action name=\"A\">$(st 'no;')$excluded</action></actions>")$(pou Old program '' "$(st 'G.n := 1000;')" "$excluded")" "$globals" >kept.xml
runs kept.xml 3 n=3
expect 0 stc import kept.xml -o kept
said 'note\[W0071\]: `Old` is excluded from the build'
said 'note\[W0071\].*`A` is excluded from the build'
sed 's/ExcludeFromBuild>true/ExcludeFromBuild>false/g; s/>no;/>;/' kept.xml >all.xml
runs all.xml 3 n=1000

entry() {  # entry GUID NAME PARENT TYPE STATEMENTS EXCLUDED: of an export of CODESYS
  cat <<XML
<Single Type="{x}" Method="IArchivable"><Single Name="MetaObject" Type="{y}" Method="IArchivable">
<Single Name="Guid" Type="System.Guid">$1</Single><Single Name="ParentGuid" Type="System.Guid">$3</Single>
<Single Name="Name" Type="string">$2</Single>
<Dictionary Name="Properties" Type="{2c41fa04-1834-41c1-816e-303c7aa2c05b}"><Entry>
<Key><Single Type="System.Guid">24568a24-c491-472c-a21f-ee5d33859fab</Single></Key>
<Value><Single Type="{24568a24-c491-472c-a21f-ee5d33859fab}" Method="IArchivable"><Single Name="ExcludeFromBuild" Type="bool">$6</Single></Single></Value>
</Entry></Dictionary><Single Name="TypeGuid" Type="System.Guid">$4</Single></Single>
<Single Name="Object" Type="{z}" Method="IArchivable">
<Single Name="Interface" Type="{i}" Method="IArchivable"><Single Name="TextDocument" Type="{t}" Method="IArchivable"><Single Name="TextBlobForSerialisation" Type="string">PROGRAM $2
VAR n : INT; END_VAR</Single></Single></Single>
<Single Name="Implementation" Type="{j}" Method="IArchivable"><Single Name="TextDocument" Type="{t}" Method="IArchivable"><Single Name="TextBlobForSerialisation" Type="string">$5</Single></Single></Single>
</Single></Single>
XML
}
zero=00000000-0000-0000-0000-000000000000
program=6f9dac99-8de1-4efc-8465-68ac443b7d08
folder=738bea1e-99bb-4f04-90bb-a7a567e74e3a
one=11111111-1111-1111-1111-11111111111
{
  echo '<ExportFile><StructuredView Guid="{a}"><Single xml:space="preserve" Type="{b}" Method="IArchivable"><List2 Name="EntryList">'
  entry ${one}1 Runs $zero $program 'n := n + 1;' False
  entry ${one}2 Old $zero $program 'no;' True
  entry ${one}3 Attic $zero $folder '' True
  entry ${one}4 InAttic ${one}3 $program 'no;' False
  echo '</List2></Single></StructuredView></ExportFile>'
} >plant.export
runs plant.export 3 Runs.n=3
expect 0 stc import plant.export -o exported
for name in Old Attic InAttic; do said "note\[W0071\]: \`$name\` is excluded from the build"; done

mkdir -p 'tc/POUs/Old/Back' 'tc/POUs/Drives (new)'
object() {  # object NAME STATEMENTS
  printf '<TcPlcObject Version="1.1.0.1"><POU Name="%s" Id="{1}"><Declaration><![CDATA[%sPROGRAM %s\nVAR n : INT; END_VAR]]></Declaration><Implementation><ST><![CDATA[%s]]></ST></Implementation></POU></TcPlcObject>\n' \
    "$1" "${3:-}" "$1" "$2"
}
object MAIN 'n := n + 1;' '(* once (* one *) FUNCTION in there *)
' >'tc/POUs/Drives (new)/MAIN.TcPOU'
object Old 'no;' >tc/POUs/Old/Old.TcPOU
object Back 'n := n + 2;' >tc/POUs/Old/Back/Back.TcPOU
object Own 'n := n + 3;' >tc/POUs/Old/Own.TcPOU
cat >tc/P.plcproj <<'XML'
<Project xmlns="http://schemas.microsoft.com/developer/msbuild/2003"><ItemGroup>
<Compile Include="POUs\Drives %28new%29\MAIN.TcPOU"/><Compile Include="POUs\Old\Old.TcPOU"/><Compile Include="POUs\Old\Back\Back.TcPOU"/>
<Compile Include="POUs\Old\Own.TcPOU"><ExcludeFromBuild>false</ExcludeFromBuild></Compile>
</ItemGroup><ItemGroup><Folder Include="POUs"/><Folder Include="pous\OLD\"><ExcludeFromBuild>true</ExcludeFromBuild></Folder>
<Folder Include="POUs\Old\Back"><ExcludeFromBuild>false</ExcludeFromBuild></Folder></ItemGroup></Project>
XML
runs tc/P.plcproj 3 MAIN.n=3 Back.n=6 Own.n=9
expect 0 stc import tc/P.plcproj -o tc_made
said 'note\[W0071\]: `POUs/Old/Old.TcPOU` is excluded from the build'

# --- tasks that wait for something
settings() { printf '<addData><data name="%s/tasksettings" handleUnknown="implementation"><TaskSettings KindOfTask="%s"/></data></addData>' $vendor "$1"; }
task() {  # task KIND ATTRIBUTES
  project tc6_0200 "$(pou P program "$counter" "$(st 'n := n + 1;')")" \
    "$(instances "<task name=\"T\" priority=\"1\" $2><pouInstance name=\"P\" typeName=\"\"/>$(settings "$1")</task>")"
}
task Cyclic 'interval="PT0.01S"' >cyclic.xml
runs cyclic.xml 3 P.n=3
# xsd:duration with years and months, as a library of some language writes it
task Cyclic 'interval="P0Y0M0DT0H0M0.01S"' >long.xml
runs long.xml 3 P.n=3
task Cyclic 'interval="P0Y1M0DT0H0M0.01S"' >month.xml
expect 1 stc import month.xml -o month
said 'interval `P0Y1M0DT0H0M0.01S` is no time'
task Freewheeling '' >free.xml
runs free.xml 3 P.n=3
task Event '' >event.xml
expect 1 stc import event.xml -o event
said 'error\[E1074\]: the task `T` is of kind Event: when it runs does not come in'

# --- a program as a box, of which something uses an output; worksheets; UNION
wire() { printf '<connectionPointIn><connection refLocalId="%s"%s/></connectionPointIn>' "$1" "${2:-}"; }
calls="<FBD><inVariable localId=\"5\">$(place 50 30)<connectionPointOut/><expression>n</expression></inVariable>
<block localId=\"3\" typeName=\"Sub\">$(place 100 10)<inputVariables><variable formalParameter=\"i\">$(wire 5)</variable></inputVariables><inOutVariables/><outputVariables><variable formalParameter=\"o\"><connectionPointOut/></variable></outputVariables><addData><data name=\"$vendor/fbdcalltype\" handleUnknown=\"implementation\"><CallType>program</CallType></data></addData></block>
<outVariable localId=\"7\">$(place 200 30)$(wire 3 ' formalParameter="o"')<expression>n</expression></outVariable></FBD>"
sub="$(pou Sub program "<inputVars>$(variable i INT)</inputVars><outputVars>$(variable o INT)</outputVars>" "$(st 'o := i + 7;')")"
only="$(instances '<pouInstance name="P" typeName="P"/>')"
project tc6_0201 "$sub$(pou P program "$counter" "<body>$calls</body>")" "$only" >box.xml
runs box.xml 3 P.n=21
sheet() { printf '<body WorksheetName="%s"><%s><inVariable localId="1">%s<connectionPointOut/><expression>n + 1</expression></inVariable><outVariable localId="2">%s%s<expression>n</expression></outVariable></%s></body>' "$1" "$2" "$(place 10 10)" "$(place 50 10)" "$(wire 1)" "$2"; }
project tc6_0201 "$(pou P program "$counter" "$(sheet a FBD)$(sheet b FBD)")" "$none" >sheets.xml
runs sheets.xml 3 P.n=6
project tc6_0201 "$(pou P program "$counter" "$(sheet a FBD)$(st 'n := n + 1;')")" "$none" >mixed.xml
expect 1 stc import mixed.xml -o mixed
said 'error\[E1083\]: POU P: the worksheets of P are in two languages'
project tc6_0200 "$(pou P program "<localVars><variable name=\"u\"><type><derived name=\"U\"/></type></variable></localVars>" "$(st 'u.w := 258;')")" \
  "$none<addData><data name=\"$vendor/union\" handleUnknown=\"implementation\"><union name=\"U\">$(variable w WORD)<variable name=\"b\"><type><array><dimension lower=\"0\" upper=\"1\"/><baseType><BYTE/></baseType></array></type></variable></union></data></addData>" >union.xml
runs union.xml 1 'P.u.b[0]=16#02' 'P.u.b[1]=16#01'

# --- a contact is read after the coils of the branches above it; power at the rail has an edge
cat >coils.st <<'S'
PROGRAM P
VAR a : BOOL := TRUE; b, c : BOOL; END_VAR
LADDER
  |--[ a ]--+--( b )---------|
  |         |
  |         +--[ b ]--( c )--|
END_LADDER
END_PROGRAM
S
needs_xml stc export coils.st -o coils.xml --without-sources
expect 0 stc import coils.xml -o coils
grep -q LADDER coils/P.st || fail "no ladder: $(cat coils/P.st)"
runs coils.st 1 P.c=TRUE
runs coils 1 P.c=TRUE
edge() { printf '<coil localId="%s" executionOrderId="%s" edge="rising">%s%s<variable>%s</variable></coil>' "$1" "$2" "$(place 50 "$3")" "$(from 1)" "$4"; }
pin() { printf '<variable formalParameter="%s">%s</variable>' "$1" "$(from 1)"; }
ladder="<leftPowerRail localId=\"1\">$(place 10 10)<connectionPointOut formalParameter=\"\"/></leftPowerRail>$(edge 2 1 10 b)
<block localId=\"3\" typeName=\"TON\" instanceName=\"t\" executionOrderId=\"2\">$(place 50 50)<inputVariables>$(pin EN)$(pin IN)</inputVariables><inOutVariables/><outputVariables/></block>"
project tc6_0201 "$(pou P program "<localVars>$(variable b BOOL)$(variable n INT)<variable name=\"t\"><type><derived name=\"TON\"/></type></variable></localVars>" "<body><LD>$ladder</LD></body>")" "$only" >rail.xml
expect 0 stc import rail.xml -o rail
said 'the ladder became FBD: power arrives at several pins of `t`'
runs rail 1 P.b=TRUE
runs rail 2 P.b=FALSE

# --- a variable that is read and written in one place, in a circle through itself, keeps its value
fbd="<block localId=\"1\" typeName=\"ADD\">$(place 200 20)<inputVariables><variable formalParameter=\"IN1\">$(from 2)</variable><variable formalParameter=\"IN2\">$(from 3)</variable></inputVariables><inOutVariables/><outputVariables><variable formalParameter=\"OUT\"><connectionPointOut/></variable></outputVariables></block>
<inOutVariable localId=\"2\">$(place 100 20)$(from 1)<connectionPointOut/><expression>n</expression></inOutVariable>
<inVariable localId=\"3\">$(place 100 60)<connectionPointOut/><expression>1</expression></inVariable>"
project tc6_0201 "$(pou P program "$counter" "<body><FBD>$fbd</FBD></body>")" "$none" >circle.xml
runs circle.xml 3 P.n=3

# --- places of variables that the editor has left empty: the pins stay open
open="<inVariable localId=\"7\">$(place 10 90)<connectionPointOut/><expression/></inVariable><outVariable localId=\"8\">$(place 300 20)$(from 9)<expression>???</expression></outVariable>
<block localId=\"9\" typeName=\"TON\" instanceName=\"t\">$(place 200 90)<inputVariables><variable formalParameter=\"IN\">$(from 7)</variable><variable formalParameter=\"PT\">$(from 7)</variable></inputVariables><inOutVariables/><outputVariables><variable formalParameter=\"Q\"><connectionPointOut/></variable></outputVariables></block>"
timer="<localVars>$(variable n INT)<variable name=\"t\"><type><derived name=\"TON\"/></type></variable></localVars>"
project tc6_0201 "$(pou P program "$timer" "<body><FBD>$fbd$open</FBD></body>")" "$none" >open.xml
runs open.xml 3 P.n=3 P.t.Q=FALSE

# --- what stands in the wrong place, and code of another language, are named
project tc6_0201 "$(pou P program "$counter" "$(st "n := n + 1; { a = 'no{';} {attribute 'x;y'} // {no;}")")" "<pous>$(pou Q program '' "$(st ';')")</pous>$none" >lost.xml
runs lost.xml 3 P.n=3
expect 0 stc import lost.xml -o lost
said "W0070.*a pragma has code in another language, which does not run here: \{ a = 'no\{';\}"
said 'W0070.*<pous> does not belong into <project>, and nothing of it comes in'
[ "$(grep -c W0070 out)" -eq 2 ] || fail "others, too"

# --- a comparison in front of contacts and coils is one of them, and the ladder stays one
compared() {  # compared ID IN1 IN2: a box that compares, with its variables at ID + 1 and ID + 2
  printf '<block localId="%s" typeName="GT">%s<inputVariables><variable formalParameter="IN1">%s</variable><variable formalParameter="IN2">%s</variable></inputVariables><inOutVariables/><outputVariables><variable formalParameter="OUT"><connectionPointOut/></variable></outputVariables></block>' "$1" "$(place 100 "$1")" "$(from $(($1 + 1)))" "$(from $(($1 + 2)))"
  printf '<inVariable localId="%s">%s<connectionPointOut/><expression>%s</expression></inVariable>' $(($1 + 1)) "$(place 10 "$1")" "$2" $(($1 + 2)) "$(place 10 $(($1 + 1)))" "$3"
}
mark() { printf '<%s localId="%s">%s%s<connectionPointOut/><variable>%s</variable></%s>' "$1" "$2" "$(place "$3" "$4")" "$(from "$5")" "$6" "$1"; }
ladder="$(compared 20 n 1)$(mark contact 30 200 20 20 a)$(mark coil 31 300 20 30 q)
$(compared 60 'n + 1' 3)$(mark coil 70 200 60 60 r)$(compared 90 n 2)<outVariable localId=\"100\">$(place 300 90)$(from 90)<expression>w</expression></outVariable>"
bools="<localVars>$(variable n INT)$(variable q BOOL)$(variable r BOOL)$(variable w BOOL)<variable name=\"a\"><type><BOOL/></type><initialValue><simpleValue value=\"TRUE\"/></initialValue></variable></localVars>"
rungs() { project tc6_0201 "$(pou P program "$bools" "<body><LD>$1</LD></body>" "<actions><action name=\"Up\">$(st 'n := n + 1;')</action></actions>")" "$none"; }
rungs "$ladder" >boxes.xml
rungs "${ladder%%$(compared 90 n 2)*}" >power.xml
expect 0 stc import power.xml -o power
grep -qE '^ *\|--\[ n > 1 \]--\[ a \]-+\( q \)--\|$' power/P.st || fail "a comparison: $(cat power/P.st)"
grep -qE '^ *\|--\[ GT\(n \+ 1, 3\) \]-+\( r \)--\|$' power/P.st || fail "an expression: $(cat power/P.st)"
[ "$(grep -c W00 out)" -eq 0 ] || fail "more is said"
expect 0 stc import boxes.xml -o boxes
grep -q 'W0075' out || fail "a variable behind a comparison has no rung"
for n in 0:FALSE:FALSE 1:FALSE:FALSE 2:TRUE:FALSE 3:TRUE:TRUE; do
  rest=${n#*:}
  for input in power.xml power boxes.xml; do
    expect 0 stvm run "$input" --scans 1 --virtual-time --set "P.n=${n%%:*}" --print P.q,P.r
    grep -qxF "P.q=${rest%:*}" out && grep -qxF "P.r=${rest#*:}" out || fail "$input $n"
  done
done
