#!/bin/sh
# Exports of CODESYS V3 (.export): objects with their members, whatever folders they stand in.
. "$(dirname "$0")/lib.sh"

number=0
declare_object() {  # declare_object VARIABLE: the GUID of the next object
  number=$((number + 1))
  eval "$1=00000000-0000-0000-0000-$(printf '%012d' $number)"
}
# entry GUID PARENT TYPE NAME [DECLARATION [BODY]]; a body `-` is drawn
entry() {
  printf '        <Single Type="{6198ad31-4b98-445c-927f-3258a0e82fe3}" Method="IArchivable">\n'
  printf '          <Single Name="IsRoot" Type="bool">False</Single>\n'
  printf '          <Single Name="MetaObject" Type="{81297157-7ec9-45ce-845e-84cab2b88ade}" Method="IArchivable">\n'
  printf '            <Single Name="Guid" Type="System.Guid">%s</Single>\n' "$1"
  printf '            <Single Name="ParentGuid" Type="System.Guid">%s</Single>\n' "$2"
  printf '            <Single Name="Name" Type="string">%s</Single>\n' "$4"
  printf '            <Single Name="TypeGuid" Type="System.Guid">%s</Single>\n          </Single>\n' "$3"
  printf '          <Single Name="Object" Type="{%s}" Method="IArchivable">\n' "$3"
  if [ "${6:-}" = - ]; then
    printf '            <Single Name="Implementation" Type="{1d3bfd54-4a0d-4bd6-9d2f-4a2b39d9b5d2}" Method="IArchivable"><Single Name="Items" /></Single>\n'
  elif [ $# -ge 6 ]; then
    text Implementation "$6"
  fi
  if [ -n "${5:-}" ]; then text Interface "$5"; fi
  printf '          </Single>\n          <Single Name="ParentSVNodeGuid" Type="System.Guid">%s</Single>\n        </Single>\n' "$2"
}
text() {  # text PART TEXT
  printf '            <Single Name="%s" Method="IArchivable"><Single Name="TextDocument" Method="IArchivable">\n' "$1"
  if [ -n "${rows:-}" ]; then  # as older versions write it
    printf '<List Name="TextLines">\n'
    printf '%s\n' "$2" | while IFS= read -r row; do
      printf '<Single><Single Name="Id" Type="long">1</Single><Single Name="Text" Type="string">%s</Single></Single>\n' "$row"
    done
    printf '</List>\n'
  else
    printf '              <Single Name="TextBlobForSerialisation" Type="string">%s</Single>\n' "$2"
  fi
  printf '            </Single></Single>\n'
}
document() {
  printf '\357\273\277<?xml version="1.0" encoding="utf-8"?>\n<ExportFile>\n  <StructuredView Guid="{21af5390-2942-461a-bf89-951aaf6999f1}">\n    <Single xml:space="preserve" Type="{3daac5e4-660e-42e4-9cea-3711b98bfb63}" Method="IArchivable">\n      <Null Name="Profile" />\n      <List2 Name="EntryList">\n'
  cat
  printf '      </List2>\n    </Single>\n  </StructuredView>\n</ExportFile>\n'
}
pou=6f9dac99-8de1-4efc-8465-68ac443b7d08
method=f8a58466-d7f6-439f-bbb8-d4600e41d099
property=5a3b8626-d3e9-4f37-98b5-66420063d91e
accessor=792f2eb6-721e-4e64-ba20-bc98351056db
action=8ac092e5-3128-4e26-9e7e-11016c6684f2
dut=2db5746d-d284-4425-9f7f-2663a34b0ebc
gvl=ffbfa93a-b94d-45fc-a329-229860183b1d
folder=738bea1e-99bb-4f04-90bb-a7a567e74e3a
interface=6654496c-404d-479a-aad2-8551054e5f1e
interface_method=f89f7675-27f1-46b3-8abb-b7da8e774ffd
task=98a2708a-9b18-4f31-82ed-a1465b24fa2d
application=639b491f-5557-464c-af91-1471bac9f549
for name in app work main count pump start inner limit get set io state itf itf_start task_one other; do declare_object $name; done

{
  entry $app 00000000-0000-0000-0000-000000000000 $application Application
  entry $work $app $folder Work
  entry $main $work $pou PLC_PRG 'PROGRAM PLC_PRG
VAR
	pump : FB_Pump;
	any : I_Start;
	state : E_State;
	n : INT;
END_VAR
' 'pump.Limit := 5.0;
any := pump;
IF any.Start(3) AND pump.Limit &lt; 6 THEN
	state := E_State.Running;
END_IF
Count();'
  entry $count $main $action Count '' 'n := n + GVL_Io.step;'
  entry $pump $app $pou FB_Pump '// drives
FUNCTION_BLOCK FB_Pump IMPLEMENTS I_Start
VAR
	limit_ : LREAL := 100;
END_VAR
' ''
  entry $inner $pump $folder Private
  entry $start $inner $method Start 'METHOD Start : BOOL
VAR_INPUT
	factor : INT;
END_VAR
' 'Start := factor * 1.0 &lt; limit_;'
  entry $limit $pump $property Limit 'PROPERTY Limit : LREAL'
  entry $get $limit $accessor Get 'VAR
END_VAR
' 'Limit := limit_;'
  entry $set $limit $accessor Set '' 'limit_ := Limit;'
  entry $io $app $gvl GVL_Io "{attribute 'qualified_only'}
VAR_GLOBAL
	step : INT := 2;
END_VAR"
  rows=yes entry $state $app $dut E_State 'TYPE E_State :
(Idle, Running);
END_TYPE'
  entry $itf $app $interface I_Start 'INTERFACE I_Start'
  entry $itf_start $itf $interface_method Start 'METHOD Start : BOOL
VAR_INPUT
	factor : INT;
END_VAR
'
  entry $task_one $app $task MainTask
  entry $other $app 11111111-2222-3333-4444-555555555555 Visu
} | document >plant.export

needs_xml "$bin/stc" import plant.export -o made
said '5 source.s., 0 error.s., 2 warning.s., 3 note.s.'
said 'plant.export:[0-9]*:[0-9]*: warning.W0070.: `MainTask` belongs to a task, which is not read; declare the task in a CONFIGURATION'
said 'W0070.: `Visu` is an object of a kind that is not known here'
said 'W0071.: `Application` is of the editor or of its devices only'
expect 0 stvm run plant.export --dialect codesys --virtual-time --scans 3 --name p --state
cp out direct
expect 0 stvm run made --dialect codesys --virtual-time --scans 3 --name p --state
cmp -s direct out || fail "imported, it is another program"
for value in PLC_PRG.n=6 PLC_PRG.pump.limit_=5.0 PLC_PRG.state=Running; do
  grep -qF -- "$value" out || fail "not $value: $(cat out)"
done
# In a folder, and as XML by another name.
mkdir folder && cp plant.export folder/ && cp plant.export plant.xml
expect 0 stc check folder --dialect codesys
expect 0 stc check plant.xml --dialect codesys

# A drawn body is an error, never empty; so is a member without its POU.
{ entry $main $app $pou PLC_PRG 'PROGRAM PLC_PRG
VAR
END_VAR
' -
} | document >drawn.export
expect 1 stc import drawn.export -o drawn
said 'E1080.: POU PLC_PRG: the body of PLC_PRG is drawn, .*; export the POU as PLCopen XML in CODESYS'
grep -q '{error' drawn/PLC_PRG.st || fail "it is taken for empty"
entry $start $pump $method Start 'METHOD Start : BOOL' 'Start := TRUE;' | document >member.export
expect 1 stc import member.export -o member
said 'E1073.: `Start` belongs to an object that is not in this file; export the whole POU'
# What is there in part only is an error, and nothing of it is taken for empty or left out.
broken() {  # broken REGEX: an error of broken.export
  document >broken.export
  expect 1 stc import broken.export -o broken --force
  said "error.*$1"
}
header='PROGRAM P
VAR
END_VAR
'
entry $main $app $pou P "$header" | broken '`P` has no body'
entry $main $app $pou P "$header" 'x := 1;' |
  sed 's|<Single Name="TextBlobForSerialisation" Type="string">x := 1;|<Null Name="TextBlobForSerialisation" /><Single Name="Other">|' |
  broken 'E1080.*the body of P is drawn'
rows=yes entry $main $app $pou P "$header" 'x := 1;' | sed 's|<Single Name="Text" Type="string">x := 1;</Single>||' |
  broken 'E1080.*the body of P is drawn'
rows=yes entry $main $app $pou P "$header" 'x := 1;' | sed 's|x := 1;|<Part>x := 1;</Part>|' |
  broken 'E1080.*the body of P is drawn'
{ entry $main $app $pou P "$header" ';'; entry $limit $main $property L 'PROPERTY L : INT'; entry $start $limit $method S 'METHOD S' ';'; } |
  broken '`S` belongs to an object that is not in this file'
{ entry $main $app $pou P "$header" ';'; entry $main $app $pou Q 'PROGRAM Q' ';'; } | broken 'E1075.*two objects have the number of `Q`'
{ entry $limit $get $property L 'PROPERTY L : INT'; entry $get $limit $accessor Get '' ';'; } | broken 'belongs to an object'
# Objects that are each other's parent end.
{ entry $work $inner $folder A; entry $inner $work $folder B; entry $start $inner $method Start 'METHOD Start' ''; } |
  document >loop.export
expect 1 stc import loop.export -o loop
said 'E1073'
