#!/bin/sh
# TwinCAT projects and objects: imported in memory by check, build and test, and to files by import.
. "$(dirname "$0")/lib.sh"

object() {  # object FILE KIND NAME: the inside from standard input
  printf '\357\273\277<?xml version="1.0" encoding="utf-8"?>\r\n<TcPlcObject Version="1.1.0.1" ProductVersion="3.1.4024.12">\n' >"$1"
  printf '  <%s Name="%s" Id="{0b7e4bd5-7f5c-4b0e-9d0e-1f5d2c3b4a5e}" SpecialFunc="None">\n' "$2" "$3" >>"$1"
  cat >>"$1"
  printf '  </%s>\n</TcPlcObject>\n' "$2" >>"$1"
}
mkdir -p plc/POUs/Drives plc/DUTs plc/GVLs
object plc/POUs/MAIN.TcPOU POU MAIN <<'X'
    <Declaration><![CDATA[{attribute 'TcLinkTo' := 'x'}
PROGRAM MAIN // the only one
VAR
	pump : FB_Pump;
	state : E_State;
	data : ST_Data;
	speed : LREAL;
END_VAR
]]></Declaration>
    <Implementation><ST><![CDATA[pump.Limit := 5.0;
pump.Start(factor := 3);
Count();
IF pump.Speed < 5 AND GVL_Io.n >= 1 THEN
	state := E_State.Running;
END_IF
speed := pump.Speed; // no line end behind this]]></ST></Implementation>
    <Folder Name="Work" Id="{1}" />
    <Action Name="Count" Id="{2}" FolderPath="Work\">
      <Implementation><ST><![CDATA[GVL_Io.n := GVL_Io.n + 1;
data.n := GVL_Io.n;]]></ST></Implementation>
    </Action>
    <LineIds Name="MAIN"><LineId Id="3" Count="0" /></LineIds>
X
object plc/POUs/Drives/FB_Pump.TcPOU POU FB_Pump <<'X'
    <Declaration><![CDATA[(* PROGRAM in a comment *)
FUNCTION_BLOCK FINAL FB_Pump EXTENDS FB_Base IMPLEMENTS I_Run
VAR
	limit_ : LREAL := 100;
END_VAR
]]></Declaration>
    <Implementation><ST><![CDATA[]]></ST></Implementation>
    <Method Name="Start" Id="{4}">
      <Declaration><![CDATA[METHOD PUBLIC Start : BOOL
VAR_INPUT
	factor : INT;
END_VAR
]]></Declaration>
      <Implementation><ST><![CDATA[speed_ := MIN(factor * 1.5, limit_);
Start := TRUE;]]></ST></Implementation>
    </Method>
    <Property Name="Limit" Id="{5}">
      <Declaration><![CDATA[PROPERTY PUBLIC Limit : LREAL]]></Declaration>
      <Get Name="Get" Id="{6}"><Declaration><![CDATA[VAR
END_VAR
]]></Declaration><Implementation><ST><![CDATA[Limit := limit_;]]></ST></Implementation></Get>
      <Set Name="Set" Id="{7}"><Declaration><![CDATA[]]></Declaration><Implementation><ST><![CDATA[limit_ := Limit;]]></ST></Implementation></Set>
    </Property>
    <Property Name="Speed" Id="{8}">
      <Declaration><![CDATA[PROPERTY PUBLIC Speed : LREAL]]></Declaration>
      <Get Name="Get" Id="{9}"><Declaration><![CDATA[]]></Declaration><Implementation><ST><![CDATA[Speed := speed_;]]></ST></Implementation></Get>
      <Set Name="Set" Id="{10}"><Declaration><![CDATA[PRIVATE VAR
END_VAR
]]></Declaration><Implementation><ST><![CDATA[speed_ := Speed;]]></ST></Implementation></Set>
    </Property>
X
object plc/POUs/Drives/FB_Base.TcPOU POU FB_Base <<'X'
    <Declaration><![CDATA[FUNCTION_BLOCK FB_Base
VAR
	speed_ : LREAL;
END_VAR
]]></Declaration>
    <Implementation><ST><![CDATA[]]></ST></Implementation>
X
object plc/POUs/I_Run.TcIO Itf I_Run <<'X'
    <Declaration><![CDATA[INTERFACE I_Run
]]></Declaration>
    <Method Name="Start" Id="{10}"><Declaration><![CDATA[METHOD Start : BOOL
VAR_INPUT
	factor : INT;
END_VAR
]]></Declaration></Method>
    <Property Name="Speed" Id="{11}"><Declaration><![CDATA[PROPERTY Speed : LREAL]]></Declaration>
      <Get Name="Get" Id="{12}"><Declaration><![CDATA[]]></Declaration></Get></Property>
X
object plc/DUTs/E_State.TcDUT DUT E_State <<'X'
    <Declaration><![CDATA[{attribute 'qualified_only'}
TYPE E_State : (Idle := 0, Running := 10) INT; END_TYPE
]]></Declaration>
X
object plc/DUTs/ST_Data.TcDUT DUT ST_Data <<'X'
    <Declaration><![CDATA[TYPE ST_Data :
STRUCT
	n : DINT; // größer
END_STRUCT
END_TYPE
]]></Declaration>
X
object plc/GVLs/GVL_Io.TcGVL GVL GVL_Io <<'X'
    <Declaration><![CDATA[{attribute 'qualified_only'}
VAR_GLOBAL
	n : DINT;
END_VAR]]></Declaration>
X
cat >plc/PlcTask.TcTTO <<'X'
<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject Version="1.1.0.1" ProductVersion="3.1.4024.12">
  <Task Name="PlcTask" Id="{13}">
    <!--CycleTime in micro seconds.-->
    <CycleTime>5000</CycleTime>
    <Priority>20</Priority>
    <PouCall><Name>MAIN</Name></PouCall>
    <ObjectProperties />
  </Task>
</TcPlcObject>
X
cat >plc/Plant.plcproj <<'X'
<?xml version="1.0" encoding="utf-8"?>
<Project DefaultTargets="Build" xmlns="http://schemas.microsoft.com/developer/msbuild/2003">
  <PropertyGroup><Name>Plant</Name></PropertyGroup>
  <ItemGroup>
    <Compile Include="DUTs\E_State.TcDUT"><SubType>Code</SubType></Compile>
    <Compile Include="DUTs\ST_Data.TcDUT"><SubType>Code</SubType></Compile>
    <Compile Include="GVLs\GVL_Io.TcGVL"><SubType>Code</SubType></Compile>
    <Compile Include="PlcTask.TcTTO"><SubType>Code</SubType></Compile>
    <Compile Include="POUs\drives\FB_Base.TcPOU"><SubType>Code</SubType></Compile>
    <Compile Include="POUs\Drives\FB_Pump.TcPOU"><SubType>Code</SubType></Compile>
    <Compile Include="POUs\I_Run.TcIO"><SubType>Code</SubType></Compile>
    <Compile Include="POUs\MAIN.TcPOU"><SubType>Code</SubType></Compile>
    <Compile Include="POUs\Old.TcPOU"><ExcludeFromBuild>True</ExcludeFromBuild></Compile>
    <Compile Include="Visu\Start.TcVIS"><SubType>Code</SubType></Compile>
  </ItemGroup>
  <ItemGroup>
    <PlaceholderReference Include="Tc2_Standard"><DefaultResolution>Tc2_Standard, * (Beckhoff Automation GmbH)</DefaultResolution></PlaceholderReference>
  </ItemGroup>
</Project>
X

needs_xml stc check plc/Plant.plcproj
said 'Plant\.plcproj:[0-9]+:[0-9]+: warning\[W0070\]: `Visu/Start\.TcVIS` is of a kind not known here'
# As files of its own, as a folder, and by the project, it is the same program.
expect 0 stc build plc -o folder.img
expect 0 stc build plc/Plant.plcproj --name plc -o project.img
expect 0 stc build plc/*.TcTTO plc/*/*.Tc* plc/*/*/*.Tc* --name plc -o files.img
for image in folder project files; do
  expect 0 stvm run $image.img --scans 3 --virtual-time --print MAIN.speed --print MAIN.state \
    --print MAIN.data.n --print GVL_Io.n
  said '^MAIN.speed=4\.5$'
  said '^MAIN.state=.*Running|^MAIN.state=10$'
  said '^MAIN.data.n=3$'
  said '^GVL_Io.n=3$'
done
expect 0 stc dump project.img
said '^PlcTask +5000 +20 +MAIN'

# What is not in the project is not taken from its folder.
object plc/POUs/Stray.TcPOU POU Stray <<'X'
    <Declaration>nonsense</Declaration>
X
expect 0 stc check plc

# To files, with a report.
expect 0 stc import plc/Plant.plcproj -o st
said '^plc/POUs/MAIN\.TcPOU -> st/MAIN\.st$'
said 'note\[W0071\]: <PlaceholderReference> `Tc2_Standard`'
said '`POUs/Old\.TcPOU` is excluded from the build'
said 'MAIN\.TcPOU:[0-9]+:[0-9]+: note\[W0071\]: POU MAIN: <LineIds name="MAIN">|note\[W0071\]: POU MAIN: <LineIds> is of the editor only'
said '^8 source\(s\), 0 error\(s\), 1 warning\(s\)'
expect 0 stc build st --name plc -o st.img
expect 0 stvm run st.img --scans 3 --virtual-time --print MAIN.speed
said '^MAIN.speed=4\.5$'
expect 0 stc import plc/Plant.plcproj -o st  # the same again is no overwriting
echo '// edited' >>st/MAIN.st
expect 7 stc import plc/Plant.plcproj -o st
said 'R0503: st/MAIN\.st: is there and differs; nothing was written'
expect 0 stc import plc/Plant.plcproj -o st --force --format json
said '"file":"st/MAIN\.st"'
said '"severity":"warning","code":"W0070","file":"plc/Plant\.plcproj","line":14'

# Messages show the text that was made.
object bad.TcPOU POU Bad <<'X'
    <Declaration><![CDATA[PROGRAM Bad
VAR n : INT; END_VAR]]></Declaration>
    <Implementation><ST><![CDATA[n := missing;]]></ST></Implementation>
X
expect 1 stc check bad.TcPOU
said 'bad\.TcPOU/Bad\.st:4:6: error\[E2001\]'

# Graphical bodies: an error, and never an empty body.
object ladder.TcPOU POU Ladder <<'X'
    <Declaration><![CDATA[PROGRAM Ladder
VAR END_VAR]]></Declaration>
    <Implementation><NWL><XmlArchive><Data><o t="NWLImplementationObject" /></Data></XmlArchive></NWL></Implementation>
X
expect 1 stc check ladder.TcPOU
said "ladder\.TcPOU:6:[0-9]+: error\[E1083\]: POU Ladder: the body of Ladder holds no list of networks"
expect 1 stc import ladder.TcPOU -o nwl
expect 1 stc check nwl
said 'nwl/Ladder\.st:[0-9]+:[0-9]+: error\[E[0-9]+\]: the body of Ladder was not imported'
for word in CFC IL Other; do
  sed "s/NWL>/$word>/g" ladder.TcPOU >other.TcPOU
  expect 1 stc check other.TcPOU
  said "other\.TcPOU:6:[0-9]+: error\[E1080\]: POU Ladder: the body of Ladder is in .*$word"
done
sed 's/NWL>/CFC>/g' ladder.TcPOU >other.TcPOU
expect 1 stc check other.TcPOU
said 'write it in ST, ladder or FBD in TwinCAT'
sed 's/NWL>/IL>/g' ladder.TcPOU >other.TcPOU
expect 1 stc check other.TcPOU
said 'export the POU as PLCopen XML in TwinCAT \(Export PLCopenXML\), and import that file'

# Ladder and FBD come in (cli/vendor_sources has what they do); what does not is named, with its network.
drawn() {  # drawn VIEW: the items of the second network from standard input
  object drawn.TcPOU POU Drawn <<X
    <Declaration><![CDATA[PROGRAM Drawn
VAR a, b, c : BOOL; n : INT; t : TON; END_VAR]]></Declaration>
    <Implementation><NWL><XmlArchive><Data><o xml:space="preserve" t="NWLImplementationObject">
      <v n="NetworkListComment">"All"</v><v n="DefaultViewMode">"$1"</v>
      <l2 n="NetworkList" cet="Network">
        <o><v n="Comment">""</v><l2 n="NetworkItems" /></o>
        <o><v n="Title">"Second"</v>$(cat)</o>
      </l2></o></Data></XmlArchive></NWL></Implementation>
X
}
op() { printf '<o n="Operand" t="Operand"><v n="Operand">"%s"</v><v n="Type">"%s"</v><o n="Flags" t="Flags"><v n="Flags">%s</v></o></o>' "$1" "${3:-BOOL}" "${2:-0}"; }
to() { printf '<o n="OutputItems" t="OutputItemList"><l2 n="OutputItems" cet="Operand"><o><v n="Operand">"%s"</v><v n="Type">"BOOL"</v></o></l2></o>' "$1"; }
refused() {  # refused TEXT: the network from standard input
  drawn "${2:-Fbd}"
  expect 1 stc check drawn.TcPOU
  said "drawn\.TcPOU:[0-9]+:[0-9]+: error\[E1083\]: POU Drawn, network 2: the body of Drawn: $1"
}
items() { printf '<l2 n="NetworkItems"%s>' "$1"; cat; printf '</l2>'; }
box() {  # box TYPE MORE: its pins from standard input
  printf '<o t="BoxTreeBox"><v n="BoxType">"%s"</v>%s<l2 n="InputItems" cet="BoxTreeOperand">' "$1" "$2"; cat
  printf '</l2></o>'
}
printf '<o>%s<o n="RValue" t="BoxTreeOperand">%s</o></o>' "$(to a)" "$(op b)" | items ' cet="BoxTreeAssign"' | drawn Ld
expect 0 stc import drawn.TcPOU -o drawn_text
grep -Eqx '  .--\[ b \]-+\( a \)--.' drawn_text/Drawn.st || fail "the rung"
grep -qx "  {network 'Second'}" drawn_text/Drawn.st || fail "the title"
grep -q '(\* All \*)' drawn_text/Drawn.st || fail "the comment"
items '' <<X | refused 'an element of type .\?. is not known here'
<o>$(op b)</o>
X
items '' <<X | refused 'an element of type .BoxTreeNew. is not known here'
<o t="BoxTreeNew">$(op b)</o>
X
items '' <<X | refused 'a branch leads from wire 7, which begins nowhere in front of it'
<o t="BoxTreeDemux"><v n="VarId">7</v><n n="Input" /></o>
X
printf '<o>%s</o>' "$(op b)" | box EXECUTE '<v n="ProvidesSTSnippet">true</v>' | items '' |
  refused 'a box with statements of its own \(EXECUTE\) does not come in'
printf '<o>%s</o>' "$(op b)" | box TON '<v n="CallType" t="Operator">FunctionBlock</v>' | items '' |
  refused 'the box .TON. calls an instance that has no name'
printf '<o>%s</o>' "$(op b)" | box TON '<o n="Instance" t="Operand"><v n="Operand">"???"</v></o>' | items '' |
  refused 'the box .TON. calls an instance that has no name'
printf '<o>%s</o><n />' "$(op b)" | box AND '' | items '' | refused 'a pin of the box .AND. is not connected'
printf '<o>%s</o>' "$(op b 16)" | box NOT '<l2 n="InputFlags" cet="Flags"><o><v n="Flags">1</v></o></l2>' | items '' |
  refused 'a pin has two marks, an edge and another one'
printf '<o>%s</o>' "$(op b)" | box NOT '<l2 n="InputFlags" cet="Flags"><o><v n="Flags">2</v></o></l2>' | items '' |
  refused 'a pin of the box .NOT. has the marks 2, which are not known here'
items '' <<X | refused 'a coil or output has no variable' Ld
<o t="BoxTreeAssign">$(to '???')<o n="RValue" t="BoxTreeOperand">$(op b)</o></o>
X
items '' <<X | refused 'a contact has no variable' Ld
<o t="BoxTreeAssign">$(to a)<o n="RValue" t="BoxTreeOperand">$(op '???')</o></o>
X
items '' <<X | refused 'an assignment has the marks 2, which its variables have not'
<o t="BoxTreeAssign">$(to a)<o n="Flags" t="Flags"><v n="Flags">2</v></o><o n="RValue" t="BoxTreeOperand">$(op b)</o></o>
X
refused 'an instruction list does not come in' <<'X'
<v n="ILActive">true</v><l2 n="ILLines"><o/></l2><l2 n="NetworkItems" />
X
mark() { printf '<o n="Flags" t="Flags"><v n="Flags">%s</v></o>' "$1"; }
coil() { printf '<o n="OutputItems" t="OutputItemList"><l2 n="OutputItems" cet="Operand"><o><v n="Operand">"%s"</v>%s</o></l2></o>' "$1" "$(mark "$2")"; }
set_to() { printf '<o t="BoxTreeAssign">%s<o n="RValue" t="BoxTreeOperand">%s</o></o>' "$1" "$2"; }
for odd in 17 2 64 x 4294967297; do
  set_to "$(to a)" "$(op b $odd)" | items '' | refused 'an operand has (the marks|marks that are no number)'
done
for odd in 18 17 48 12 64; do
  set_to "$(coil a $odd)" "$(op b)" | items '' | refused 'a (coil or output|jump) has (the )?marks'
done
for way in 4 8; do  # a jump, RETURN
  printf '<o t="BoxTreeAssign">%s%s<n n="RValue" /></o>' "$(coil L 0)" "$(mark $way)" | items '' |
    refused 'nothing is connected to a jump or RETURN'
done
set_to "$(coil '1 + 2' 4)" "$(op b)" | items '' | refused 'a jump goes to .1 \+ 2., which is no label'
for text in 'b; c := TRUE' 'b (* ' 'b // ' 'P b' ')'; do
  set_to "$(to a)" "$(op "$text")" | items '' | refused 'an operand is .*, which is no expression'
done
set_to "$(to 'a; b')" "$(op b)" | items '' | refused 'a coil or output is .a; b., which is no expression'
printf '<v n="Label">"my label"</v><l2 n="NetworkItems" />' | refused 'the label .my label. is no name'
printf '<o>%s</o><o>%s</o>' "$(op a)" "$(op b)" | box 'AND(a, b); c := OR' '' | items '' | refused 'a box is of type'
printf '<o>%s</o>' "$(op b)" | box NOT '<v n="EN">true</v>' | items '' | refused 'the box .NOT. has EN, and no pin of that name'
printf '<o>%s</o>' "$(op b)" | box NOT '<l2 n="InputFlags" cet="Flags"><n/><o><v n="Flags">1</v></o></l2>' | items '' |
  refused 'a pin of the box .NOT. has the marks 1'
two=$(printf '<o>%s</o>' "$(op b)" | box F '<o n="OutputItems" t="OutputItemList"><l2 n="OutputItems"><n/><n/></l2></o>')
printf '%s' "$two" | box NOT '' | items '' | refused 'which output of the box .F. leads on is not said'
printf '<o t="BoxTreeAssign"><o n="OutputItems" t="OutputItemList"><l2 n="OutputItems" /></o><o n="RValue" t="BoxTreeOperand">%s</o></o>' "$(op b)" |
  items '' | refused 'an assignment has no variable'
wire() { printf '<o t="BoxTreeDemux"><v n="VarId">%s</v><o n="Input" t="BoxTreeOperand">%s</o></o>' "$1" "$(op "$2")"; }
printf '%s%s' "$(wire 1 a)" "$(wire 1 b)" | items '' | refused 'there are two wires 1'
wire '' a | items '' | refused 'there are two wires'
wire 1 '' | items '' | refused 'nothing is connected to wire 1'
ways() { printf '<o t="BoxTreeAssign">%s<o n="RValue" t="BoxTreeParallel"><v n="Mode">%s</v><l2 n="Trees">%s</l2></o></o>' "$(to a)" "$1" "$2"; }
leaf="<o t=\"BoxTreeOperand\">$(op b)</o>"
called=$(printf '%s' "$leaf" | box TON '<o n="Instance" t="Operand"><v n="Operand">"t"</v></o><o n="InputParam" t="ParamList"><l2 n="Names" cet="String"><v>IN</v></l2></o>')
ways Other "$leaf$leaf" | items '' | refused 'branches of mode .Other. are not known here' Ld
ways BoxShortCircuit "$leaf$called" | items '' | refused 'a function block stands in a branch whose evaluation ends early' Ld
ways Sequential '' | items '' | refused 'a branch has no ways' Ld
printf '<l2 n="Connectors"><o/></l2><l2 n="NetworkItems" />' | refused 'connectors are not known here'
printf '<v n="Comment">"c"</v>' | refused 'a network has no elements'
whole() {  # whole TEXT: of the archive itself
  drawn Fbd
  expect 1 stc check drawn.TcPOU
  said "error\\[E1083\\]: POU Drawn: the body of Drawn: $1"
}
printf '<l2 n="NetworkItems" /><l2 n="NetworkItems" />' | whole 'a member has no name, or that of another one'
printf '<l2 n="NetworkItems"><v>1</v></l2>' | whole 'a list holds what is no object'
# What is commented out may be unfinished.
printf '<v n="OutCommented">true</v><l2 n="NetworkItems">%s</l2>' "$(set_to "$(to '???')" "$(op b)")" | drawn Fbd
expect 0 stc import drawn.TcPOU -o drawn_out
said 'note\[W0071\]: POU Drawn, network 2: a network that is commented out does not come in: a coil or output has no variable'
# Nothing at a coil is said, and the rest comes in.
items '' <<X | drawn Fbd
<o t="BoxTreeAssign">$(to a)<n n="RValue" /></o><o t="BoxTreeAssign">$(to c)<o n="RValue" t="BoxTreeOperand">$(op b)</o></o>
X
expect 0 stc import drawn.TcPOU -o drawn_part
said 'note\[W0071\]: POU Drawn, network 2: nothing is connected to a coil or output'
grep -qx '  c := b;' drawn_part/Drawn.st || fail "the other assignment"
# A ladder that is no series and branches as text is FBD, with the reason.
pins=$(printf '<o>%s</o><o>%s</o>' "$(op a)" "$(op b)" | box AND '')
printf '%s%s' "$pins" "$pins" | box XOR '' | items '' | drawn Ld
expect 0 stc import drawn.TcPOU -o drawn_fbd
said 'note\[W0075\]: POU Drawn, network [12]: the ladder became FBD: power arrives at several pins of .XOR.'
# Names of wires are none of the variables.
sed 's/a, b, c : BOOL/a, b, c, and1, and2 : BOOL/' drawn.TcPOU >names.TcPOU
expect 0 stc check names.TcPOU

# A comparison of variables stands among the contacts as one, whatever is in front of it; what sees an
# edge, has a pin with a mark or gives its result away is a box.
numbers="<o>$(op n 0 INT)</o><o>$(op 5 0 INT)</o>"
greater() { printf '%s' "$numbers" | box GT "${1:-}"; }
rung() { printf '<o t="BoxTreeBox" n="RValue"><v n="BoxType">"AND"</v><l2 n="InputItems">%s</l2></o>' "$1"; }
rung_of() { printf '<o t="BoxTreeAssign">%s%s</o>' "$(to a)" "$(rung "$1")" | items '' | drawn Ld; }
rung_of "<o t=\"BoxTreeOperand\">$(op b)</o>$(greater)$(greater "$(mark 1)")"
expect 0 stc import drawn.TcPOU -o drawn_compared
grep -Eqx '  .--\[ b \]--\[ n > 5 \]--\[/ n > 5 \]-+\( a \)--.' drawn_compared/Drawn.st || fail "comparisons"
if grep -q W0075 out err; then fail "the ladder is one"; fi
printf '<o>%s</o><o>%s</o><o>%s</o>' "$(op n 0 INT)" "$(op 3 0 INT)" "$(op 9 0 INT)" >three
rung_of "$(box LT '' <three)<o t=\"BoxTreeOperand\">$(op b 16)</o>"
expect 0 stc import drawn.TcPOU -o drawn_three
grep -Eqx '  .--\[ LT\(n, 3, 9\) \]--\[P b \]-+\( a \)--.' drawn_three/Drawn.st || fail "three operands"
for odd in "$(mark 16)" '<l2 n="InputFlags" cet="Flags"><o><v n="Flags">1</v></o></l2>' "$(to c)"; do
  rung_of "<o t=\"BoxTreeOperand\">$(op b)</o>$(greater "$odd")"
  stc import drawn.TcPOU -o drawn_box --force >out 2>err || true
  if grep -q '\[ n > 5 \]' drawn_box/Drawn.st; then fail "no contact says $odd"; fi
done

# Files that are missing, of another kind, or no XML.
sed 's/ST_Data/ST_Gone/' plc/Plant.plcproj >plc/Gone.plcproj
expect 1 stc import plc/Gone.plcproj -o gone
said 'Gone\.plcproj:6:[0-9]+: error\[E1081\]: `DUTs/ST_Gone\.TcDUT` is listed, but there is no such file'
printf '<a><b></a>' >broken.TcPOU
expect 1 stc check broken.TcPOU
said 'broken\.TcPOU:1:[0-9]+: error\[E1070\]'
printf '<library/>' >other.xml
expect 1 stc check other.xml
said 'other\.xml:1:2: error\[E1071\]: <library> begins nothing'
printf '<?xml version="1.0" encoding="EBCDIC"?><a/>' >strange.xml
expect 1 stc check strange.xml
said 'E1070.*`ebcdic` is not read'
printf '<TcPlcObject><POU Name="../evil"><Declaration>PROGRAM x</Declaration></POU></TcPlcObject>' >evil.TcPOU
expect 1 stc import evil.TcPOU -o evil
said 'E1074.*`\.\./evil` is no name'
printf '<TcPlcObject><POU><Declaration>PROGRAM x</Declaration></POU></TcPlcObject>' >anonymous.TcPOU
expect 1 stc import anonymous.TcPOU -o evil
said 'E1073.*<POU> has no attribute `Name`'
# kMaxXmlDepth: 256 levels are allowed, one more is not.
nested() { printf '<TcPlcObject>'; yes '<a>' | head -n "$1" | tr -d '\n'; yes '</a>' | head -n "$1" | tr -d '\n'; printf '</TcPlcObject>'; }
nested 255 >deep.TcPOU
expect 1 stc check deep.TcPOU
said 'W0070'
nested 256 >deep.TcPOU
expect 1 stc check deep.TcPOU
said 'E1072.*deeper than 256 levels'
nested 400000 >deep.TcPOU
expect 1 stc check deep.TcPOU
said E1072
head -c 67108865 /dev/zero | tr '\0' ' ' >large.xml  # kMaxXmlBytes and one
expect 1 stc check large.xml
said 'E1072.*67108865 bytes; the limit is 67108864'
# Usage.
expect 2 stc import plc
expect 2 stc import plc -o x --format sarif
expect 2 stc import st/MAIN.st -o x
expect 7 stc import nothing.xml -o x
