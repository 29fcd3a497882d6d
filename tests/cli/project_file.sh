#!/bin/sh
# R-03 stc.toml: where it is looked for, what it may list, and how its mistakes are shown.
. "$(dirname "$0")/lib.sh"

mkdir -p plant/src/lib plant/old
cat >plant/src/main.st <<'ST'
PROGRAM Main VAR n : INT; twice : INT; END_VAR
twice := Double(n); {IF defined(FAST)} n := n + 10; {ELSE} n := n + 1; {END_IF}
END_PROGRAM
ST
printf 'FUNCTION Double : INT VAR_INPUT n : INT; END_VAR Double := n + n; END_FUNCTION\n' >plant/src/lib/double.st
printf 'FUNCTION Broken : INT Broken := nothing; END_FUNCTION\n' >plant/old/broken.st
toml() { cat >plant/stc.toml; }

# What `sources` takes: files, folders and patterns.
listed() {
  printf 'sources = [%s]\n' "$1" >plant/stc.toml
  expect 0 stc check plant
  silent_on err
}
listed '"src"'
listed '"src/main.st", "src/lib"'
listed '"src/**"'
listed '"src/**/*.st"'
listed '"src/*.st", "src/lib/dou???.st"'
listed '"s*"'
listed '"src", "src/main.st", "./src/lib/../main.st"'
listed '"**/src/**/lib/*", "src/m*"'
# Many stars cost no more than few.
stars=$(printf '*a%.0s' $(seq 40))
folders=$(printf '**/a/%.0s' $(seq 30))
deep=plant/src/$(printf 'a/%.0s' $(seq 40))
mkdir -p "$deep"
touch "$deep/$(printf 'a%.0s' $(seq 200)).st"
printf 'sources = ["src/%s%sb.st"]\n' "$folders" "$stars" >plant/stc.toml
expect 7 timeout 20 "$bin/stc" check plant
said 'names no source'
rm -r plant/src/a
refused() { # refused LINE:COLUMN TEXT: the file is on standard input
  toml
  expect 7 stc check plant
  said "^plant/stc.toml:$1: error\[R0506\]: $2"
}
refused 1:12 '`src/\*.iecst` names no source' <<'T'
sources = ["src/*.iecst"]
T
refused 1:12 '`src/\*/main.st` names no source' <<'T'
sources = ["src/*/main.st"]
T
refused 2:3 '`srx` is not there; paths begin at the folder of this file' <<'T'
sources = ["src",
  "srx"]
T
# It is found above what is named, and says how the sources of a part are compiled.
toml <<'T'
name = "bottling"
sources = ["src"]
defines = ["FAST"]
T
expect 0 stc build plant -o whole.img
expect 0 stvm run whole.img --virtual-time --scans 1 --print Main.n
said '^Main.n=10$'
for path in plant/src plant/src/../src "plant/src/main.st plant/src/lib/double.st"; do
  expect 0 stvm run $path --virtual-time --scans 1 --print Main.n
  said '^Main.n=10$'
done
cd plant/src/lib
expect 0 stvm run .. --virtual-time --scans 1 --print Main.n
said '^Main.n=10$'
cd "$work"
# In a folder of its own `expect` writes there, too.
rm -f plant/src/lib/out plant/src/lib/err
printf '[change]\nstrategy = "standby"\nrestricted = true\n' >>plant/stc.toml
serve line whole.img
sed -i 's/VAR_INPUT n : INT;/VAR_INPUT n : INT; more : INT := 0;/' plant/src/lib/double.st
expect 7 stvm change --dir line plant/src --yes
said 'R0307'
sed -i 's/ more : INT := 0;//; s/n + n/2 * n/' plant/src/lib/double.st
expect 0 stvm change --dir line plant/src --yes --permanent
expect 0 stvm stop --dir line

# Mistakes look as in sources: place, line, caret, help; and the name that was meant.
toml <<'T'
name = "bottling"
	dialetc = "codesys"
T
expect 7 stc check plant
cat >wanted <<'T'
plant/stc.toml:2:2: error[R0506]: unknown key `dialetc`; did you mean `dialect`?
    2 | 	dialetc = "codesys"
      | 	^~~~~~~
   help: The text names line and column; docs/PROJECT.md lists the keys.
T
cmp wanted err || fail "the shape of a mistake"
refused 1:12 '`dialect` must be "iec", "codesys" or "twincat", not "codesis"; did you mean `codesys`\?' <<'T'
  dialect= "codesis"
T
refused 2:1 'unknown key `slack.free_byte`; did you mean `slack.free_bytes`\?' <<'T'
[slack]
free_byte = 1
T
refused 2:1 'unknown key `slak.free_bytes`; did you mean `slack.free_bytes`\?' <<'T'
[slak]
free_bytes = 1
T
refused 2:1 'unknown key `outputs.frobnicate`; known in \[outputs\] are safe' <<'T'
[outputs]
frobnicate = 1
T
refused 2:1 'unknown key `frobnicate.x`; known are name, .* and the tables' <<'T'
[frobnicate]
x = 1
T
refused 1:19 '`A=1` and `a=2` contradict each other; leave one out' <<'T'
defines = ["A=1", "a=2"]
T
refused 1:12 '`1x` does not begin with a name; write NAME or NAME=VALUE' <<'T'
defines = ["1x"]
T
refused 2:9 '`format.width` must be a whole number between 40 and 1000' <<'T'
[format]
width = 7
T
refused 1:8 '`name` must be a text' <<'T'
name = ["a"]
T
refused 1:8 'text without closing quote' <<'T'
name = "a
T
refused 1:8 'the text of `name` has control characters' <<'T'
name = "a\nb"
T
refused 1:17 'the text of `sources` has control characters' <<'T'
sources = ["a", "b\tc"]
T
printf 'name = "a\033[2Jb"\n' | refused 1:10 'a text has no control characters'
echo 'name = "a"' | toml
expect 2 stc check plant --name "$(printf 'a\033[2J')"
printf '[devices.press]\ndriver = "modbus"\n' >plant/stc.toml
expect 7 stc check plant
said '^plant/stc.toml:2:10: error\[R0507\]: unknown driver "modbus"'
grep -qF '      |          ^~~~~~~~' err || fail "caret below the driver"

# The same of every command, in every form, and from stvm.
printf 'nmae = "x"\n' >plant/stc.toml
for form in json sarif github; do
  expect 7 stc check plant/src --format $form
  said 'plant/stc.toml:1:1: error\[R0506\]: unknown key `nmae`; did you mean `name`\?'
  [ -s out ] || fail "nothing in the form $form"
done
for command in 'check plant' 'build plant -o x.img' 'test plant' 'fmt --check plant' 'diff whole.img plant' \
  'dump plant' 'draw plant' 'package plant --base whole.img -o x.pkg'; do
  expect 7 stc $command
  said '^plant/stc.toml:1:1: error\[R0506\]: unknown key `nmae`'
done
expect 7 stvm run plant --virtual-time --scans 1
said '^plant/stc.toml:1:1: error\[R0506\]: unknown key `nmae`'
grep -q '^    1 | nmae = "x"$' err || fail "the line, by stvm"

# A byte order mark in front, as editors of Windows write it, is nothing; a table twice is a mistake.
mkdir marked
printf 'PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM\n' >marked/a.st
printf '\357\273\277name = "x"\nnmae = "y"\n' >marked/stc.toml
expect 7 stc check marked
said '^marked/stc.toml:2:1: error\[R0506\]: unknown key `nmae`'
printf '\357\273\277nmae = "y"\n' >marked/stc.toml
expect 7 stc check marked
said '^marked/stc.toml:1:1: error\[R0506\]: unknown key `nmae`'
printf '\357\273\277sources = ["a.st"]\n[warnings]\nW0003 = "off"\n' >marked/stc.toml
expect 0 stc check marked
printf '\n[warnings] # again\nW0013 = "off"\n' >>marked/stc.toml
expect 7 stc check marked
said '^marked/stc.toml:5:11: error\[R0506\]: table `warnings` is given twice'

# The manifest of docs/PROJECT.md passes as it is printed; and with what needs a program, for one that has it.
mkdir page page/src page/lib
sed -n '/^```toml$/,/^```$/{/^```/d;p}' "$source_dir/docs/PROJECT.md" >page/stc.toml
sed -i '/^\[units\]/,$d; /^\[devices/,$d' page/stc.toml
printf 'PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM\n' >page/src/main.st
: >page/lib/empty.st
expect 0 stc check page
cat >page/src/main.st <<'ST'
PROGRAM Main
VAR n : INT; well : BOOL := TRUE; alarm : BOOL; o AT %QX0.0 : BOOL; w AT %QW2 : WORD; r AT %QD8 : REAL; b AT %QB6 : BYTE; END_VAR
  n := n + 1; o := alarm; w := INT_TO_WORD(n); r := n; b := 1; well := n > 0;
END_PROGRAM
CONFIGURATION Plant
  RESOURCE Line ON PLC TASK Fast(INTERVAL := T#10ms, PRIORITY := 1); PROGRAM Main WITH Fast : Main; END_RESOURCE
END_CONFIGURATION
ST
sed 's/^# //' page/stc.toml >all.toml && mv all.toml page/stc.toml
expect 0 stc check page
grep -qE '^(resource|safe|health) = ' page/stc.toml || fail "nothing of the page needs a program any more"
