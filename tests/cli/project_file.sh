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
   help: `stc explain stc.toml` lists the keys.
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
refused 2:1 'unknown key `frobnicate.x`; known are name, .* and the tables \[slack\], \[change\], \[warnings\]' <<'T'
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
# Tables without keys, and where the caret stands.
refused 1:2 'unknown table `frobnicate`; known are \[slack\], .*\[units\] and \[devices.NAME\]' <<'T'
[frobnicate]
T
refused 2:2 'unknown table `slak`; did you mean `slack`\?' <<'T'
[slack]
[slak]
T
printf '[slack]\n[change]\n[warnings]\n[outputs]\n[format]\n[units]\n[devices]\nsources = ["src"]\n' >plant/stc.toml
expect 7 stc check plant
said '^plant/stc.toml:8:1: error\[R0507\]: `devices.sources`: a device is a table'
printf 'sources = ["src"]\n[slack]\n[change]\n[warnings]\n[outputs]\n[format]\n[units]\n[devices]\n' >plant/stc.toml
expect 0 stc check plant
refused 2:1 '`name` is given twice' <<'T'
name = "a"
name = "b"
T
refused 2:17 'not a whole number in decimal digits' <<'T'
[slack]
globals_bytes = 0x10
T
refused 1:11 '`sources` is empty; leave it out for all sources of the folder' <<'T'
sources = []
T
refused 2:26 '`%QX0.1 = maybe` is no safe value; write' <<'T'
[outputs]
safe = ["%QX0.0 = TRUE", "%QX0.1 = maybe"]
T
grep -qF '      |                          ^~~~~~~~~~~~~~~~' err || fail "caret below the safe value"
refused 3:3 'two safe values for a bit of %QB0' <<'T'
[outputs]
safe = ["%QX0.0 = TRUE",
  "%QB0 = 3"]
T
refused 4:3 'a safe value at %QB7, but the outputs of this program end before %QB0' <<'T'
sources = ["src"]
[outputs]
safe = [
  "%QB7 = 3"]
T
# What the compiler says of a setting points into the file, too.
toml <<'T'
sources = ["src"]
resource = "Line"  # of several
T
expect 1 stc check plant
said '^plant/stc.toml:2:12: error\[E2018\]: there is no RESOURCE `Line`: nothing declares one'
said 'help: leave `resource` out'
grep -qF '      |            ^~~~~~' err || fail "caret below the resource"
expect 1 stc check plant --format sarif
said '"uri": *"plant/stc.toml"'
expect 1 stc check plant --resource Lane
said '^error\[E2018\]: there is no RESOURCE `Lane`'
said 'help: leave --resource out'
cat >plant/two.st <<'ST'
CONFIGURATION c
  RESOURCE Line1 ON cpu TASK t (INTERVAL := T#10ms); PROGRAM m WITH t : Main; END_RESOURCE
  RESOURCE Lane2 ON cpu TASK t (INTERVAL := T#10ms); PROGRAM m WITH t : Main; END_RESOURCE
END_CONFIGURATION
ST
printf 'sources = ["src", "two.st"]\nname = "two"\nresource = "Line2"\n' >plant/stc.toml
expect 1 stc check plant
said '^plant/stc.toml:3:12: error\[E2018\]: there is no RESOURCE `Line2`$'
said 'did you mean `Lane2`|did you mean `Line1`'
printf 'sources = ["src", "two.st"]\nname = "two"\nresource = "Line1"\n' >plant/stc.toml
expect 0 stc build plant -o settings.img
printf 'sources = ["src", "two.st"]\nname = "two"\n' >plant/stc.toml
expect 0 stc build plant -o option.img --resource Line1
cmp settings.img option.img || fail "the image depends on where its resource is named"
rm plant/two.st
# What has the name of the file, and cannot be read, is not passed over.
mkdir -p odd/stc.toml
cp plant/src/lib/double.st odd
expect 7 stc check odd
said 'R0502: odd/stc.toml: '
rmdir odd/stc.toml
ln -s nowhere.toml odd/stc.toml
expect 7 stc check odd/double.st
said 'R050[12]: odd/stc.toml: '
rm -r odd
printf 'name = "a\033[2Jb"\n' | refused 1:10 'a text has no control characters'
echo 'name = "a"' | toml
expect 2 stc check plant --name "$(printf 'a\033[2J')"
printf '[devices.press]\ndriver = "modbus"\n' >plant/stc.toml
expect 7 stc check plant
said '^plant/stc.toml:2:10: error\[R0507\]: unknown driver "modbus"'
grep -qF '      |          ^~~~~~~~' err || fail "caret below the driver"
device() { # device KEY MEANT
  printf '[devices.press]\ndriver = "modbus-tcp"\n%s = "1"\nmap = ["coil 0 -> %%IX0.0"]\n' "$1" >plant/stc.toml
  expect 7 stc check plant
  said "^plant/stc.toml:3:1: error\\[R0507\\]: unknown key \`$1\`; driver .*; did you mean \`$2\`\\?"
}
device adress address
device period period_ms
device mapp map
printf '[devices.press]\ndriver = "modbus_tcp"\n' >plant/stc.toml
expect 7 stc check plant
said 'unknown driver "modbus_tcp"; it must be one of .*; did you mean `modbus-tcp`\?'

printf '[devices.a]\n[devices.b]\ndriver = "simulated"\nmap = ["bit 0 -> %%IX0.0"]\n' >plant/stc.toml
expect 7 stc check plant
said '^plant/stc.toml:1:2: error\[R0507\]: device `a` has no `driver`$'
for address in 1.2.3.4:99999 1.2.3.4: :502 '[fe80::1' fe80::1:502 1.2.3.4:0 1.2.3.4:x; do
  printf '[devices.a]\ndriver = "modbus-tcp"\naddress = "%s"\nmap = ["coil 0 -> %%IX0.0"]\n' "$address" >plant/stc.toml
  expect 7 stc check plant
  said '^plant/stc.toml:3:11: error\[R0507\]: `.*` is no address: 10.0.0.5:502'
done
for address in 1.2.3.4 1.2.3.4:502 press.local:65535 '[fe80::1]' '[fe80::1]:502'; do
  printf 'sources = ["src"]\n[devices.a]\ndriver = "modbus-tcp"\naddress = "%s"\nmap = ["coil 0 -> %%IX0.0"]\n' "$address" >plant/stc.toml
  expect 0 stc check plant
done

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
printf '\357\273\277[slak]\n' >marked/stc.toml
expect 7 stc check marked
said '^marked/stc.toml:1:2: error\[R0506\]: unknown table `slak`'
printf '\357\273\277sources = ["a.st"]\n[warnings]\nW0003 = "off"\n' >marked/stc.toml
expect 0 stc check marked
printf '\n[warnings] # again\nW0013 = "off"\n' >>marked/stc.toml
expect 7 stc check marked
said '^marked/stc.toml:5:2: error\[R0506\]: table `warnings` is given twice'

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

# A file that two of the paths name is one file, by whatever path.
mkdir once once/lib
printf 'PROGRAM Main VAR n : INT; END_VAR n := Twice(n); END_PROGRAM\n' >once/main.st
printf 'FUNCTION Twice : INT VAR_INPUT x : INT; END_VAR Twice := x * 2; END_FUNCTION\n' >once/lib/twice.st
ln -s lib/twice.st once/again.st
for paths in 'once/main.st once/lib ./once/lib/twice.st' 'once/main.st once/again.st once/lib' 'once/lib once/main.st once/main.st'; do
  expect 0 stc check $paths
done
cp once/lib/twice.st once/copy.st
expect 1 stc check once/main.st once/lib once/copy.st
said 'E2002'
printf 'sources = ["main.st", "lib"]\n' >once/stc.toml
expect 0 stc check once once/lib/twice.st once
