#!/bin/sh
# X9: sources travel with the image when the project says so, a controller brings them back, and what is
# built of them is the same image, bit for bit. Nothing is overwritten, nothing written elsewhere.
. "$(dirname "$0")/lib.sh"
mkdir -p plant/src plant/lib elsewhere
printf 'name = "plant"\nembed_sources = true\nsources = ["src/main.st", "lib/pump.st"]\n' >plant/stc.toml
cat >plant/src/main.st <<'ST'
PROGRAM Main VAR p : Pump; n : INT; END_VAR
  n := n + 1;  (* counts *)
  p(on := TRUE);
END_PROGRAM
ST
cat >plant/lib/pump.st <<'ST'
FUNCTION_BLOCK Pump VAR_INPUT on : BOOL; END_VAR VAR runs : INT; END_VAR
  IF on THEN runs := runs + 1; END_IF
END_FUNCTION_BLOCK
ST

# The image depends on what is in the folder, not on where it is or what was typed.
expect 0 stc build plant -o plant.img
expect 0 stc build "$work/elsewhere/../plant/" -o same.img
cmp plant.img same.img || fail "another way to the same folder"
(cd plant/src && "$bin/stc" build .. -o "$work/same.img" 2>/dev/null)
cmp plant.img same.img || fail "from inside of the folder"
expect 0 stc source plant.img
said '^ *[0-9]+ +lib/pump.st$'
said '3 sources of plant,'
expect 0 stc source plant.img --format json
said '"path": *"src/main.st"'
expect 0 stc dump --sources plant.img
said '^==> src/main.st <==$'
said 'counts'
expect 0 stc dump plant.img
said 'sources: 3 files'

# build_again FOLDER: as the tool says.
build_again() {
  command=$(sed -n 's/^build: stc //p' out)
  [ -n "$command" ] || fail "no word on how to build it"
  eval "expect 0 stc $command -o again.img"
}
expect 0 stc source plant.img -o back
said '^ *[0-9]+ +new +src/main.st$'
diff -r plant back || fail "other files came back"
build_again
cmp plant.img again.img || fail "another image is built of what came back"

# Nothing is overwritten without a word.
echo '(* mine *)' >>back/src/main.st
cp back/src/main.st mine.st
rm back/lib/pump.st
expect 7 stc source plant.img -o back
said 'R0510.*back/src/main.st.*--overwrite'
cmp mine.st back/src/main.st || fail "it was overwritten"
[ ! -e back/lib/pump.st ] || fail "half of them were written"
expect 0 stc source plant.img -o back --overwrite
said '^ *[0-9]+ +replaced +src/main.st$'
said '^ *[0-9]+ +same +stc.toml$'
diff -r plant back || fail "other files came back"

# Links in the folder lead nobody out.
mkdir trap && ln -s "$work/elsewhere" trap/src
expect 7 stc source plant.img -o trap
said 'R0503.*trap/src'
rm trap/src && mkdir trap/src && ln -s "$work/elsewhere/main.st" trap/src/main.st
expect 7 stc source plant.img -o trap --overwrite
[ -z "$(ls elsewhere)" ] || fail "written outside of the folder"

# What is said on the command line travels, too, and no sources without a word.
sed -i '/embed_sources/d; /^name/d' back/stc.toml
mv back other
expect 0 stc build other -o none.img
expect 7 stc source none.img
said 'R0509: no sources travel with other'
sed -i 's/^  IF on/{IF defined(SIM)} runs := runs + 10; {END_IF}\n  IF on/' other/lib/pump.st
expect 0 stc build other --embed-sources --define 'SIM' --no-opt --name 'my plant' -o other.img
expect 0 stc source other.img -o back
said '^build: stc build --no-opt --embed-sources --define=SIM .--name=my plant. back$'
build_again
cmp other.img again.img || fail "options are lost"
cp other/src/main.st other/lib/pump.st .
expect 0 stc build main.st pump.st --embed-sources -o files.img
expect 0 stc source files.img -o listed
build_again
cmp files.img again.img || fail "of a list of files"

# What lies outside cannot travel, by a link neither; nor can too much.
mkdir outside && cp main.st outside/away.st
printf 'embed_sources = true\nsources = ["src/main.st", "../pump.st"]\n' >other/stc.toml
expect 7 stc build other -o bad.img
said 'R0511.*pump.st.*outside of the folder'
rm -rf linked && mkdir linked && cp pump.st linked && ln -s "$work/outside/away.st" linked/away.st
expect 7 stc build linked --embed-sources -o bad.img
said 'R0511.*away.st.*link'
expect 0 stc build linked -o good.img
mkdir large && cp main.st pump.st large
head -c 67108864 /dev/zero | tr '\0' ' ' >large/blanks.st
expect 7 stc build large --embed-sources -o bad.img
said 'R0204.*kMaxEmbeddedBytes'
rm large/blanks.st
[ ! -e bad.img ] || fail "an image of a refused build"
printf 'embed_sources = 1\n' >linked/stc.toml
expect 7 stc build linked -o bad.img
said 'stc.toml:1:.*true or false'

# From a controller.
serve plc plant.img
expect 0 stvm source plc
said '3 sources of plant,'
expect 0 stvm source --dir plc -o got
diff -r plant got || fail "other files came from the controller"
[ "$(stat -c %a got/src/main.st)" = 600 ] || fail "others can read them"
build_again
cmp plant.img again.img || fail "another image is built of what the controller has"
expect 2 stvm source plc --dir plc
expect 7 stvm source no_such_folder_and_no_host --format json

# Only a comment: the program is the same, no value is touched, and the sources follow.
cp -r plant first
sed -i 's/counts/counts scans/' plant/src/main.st
expect 0 stvm change plant --dir plc --dry-run
said '^source +src/main.st  \(edited\)$'
said '^kept'
grep -qE '^(code|dropped +x|initialised +x|moved +x|converted +x)' out && fail "more than sources"
said '\(0 bytes written at the boundary\)'
expect 0 stvm get Main.n --dir plc
before=$(sed -n 's/^Main.n=//p' out)
expect 0 stvm change plant --dir plc --yes
expect 0 stvm accept --dir plc
expect 0 stvm get Main.n --dir plc
[ "$(sed -n 's/^Main.n=//p' out)" -ge "$before" ] || fail "a value was touched"
expect 7 stvm change plant --dir plc --yes
said 'R0308'
expect 0 stvm source --dir plc -o second
diff -r plant second || fail "the sources do not follow"

# Linked against what ran, it is the same image again; after a restart, too.
sed -i 's/n : INT/n : INT; m : INT/; s/n + 1/n + 2/' plant/src/main.st
expect 0 stvm change plant --dir plc --yes --permanent
expect 0 stvm stop --dir plc
rm plc.pid
serve plc
expect 0 stvm source --dir plc -o third
diff -r plant third || fail "the store does not keep them"
expect 0 stvm image --dir plc -o running.img
expect 0 stc build third --base running.img -o again.img
cmp running.img again.img || fail "another image beside what runs"

# The version before has its own; a version without says so.
expect 0 stvm revert --dir plc --yes --allow-loss --permanent
expect 0 stvm source --dir plc -o reverted
diff -r second reverted || fail "revert brings other sources"
sed -i '/embed_sources/d' plant/stc.toml
expect 0 stvm change plant --dir plc --yes --allow-loss --permanent
said '^source +3 files  \(travel with the program no longer\)'
expect 7 stvm source --dir plc
said 'R0509: no sources travel'
expect 0 stvm change first --dir plc --yes --allow-loss --permanent
said '^source +3 files  \(travel with the program from now on\)'
expect 0 stvm stop --dir plc
rm plc.pid

# Each build of a watch has those of its time.
"$bin/stc" build first --watch -o watched.img >watch.log 2>&1 &
echo $! >watch.pid
wait_for '^3 sources' sh -c "'$bin/stc' source watched.img | sed -n 's/^\(3 sources\).*/\1/p'"
cmp plant.img watched.img || fail "a watch builds another image"
sed 's/counts/counts more/' first/src/main.st >edited.st && cat edited.st >first/src/main.st
wait_for 'counts more' stc dump --sources watched.img
expect 0 stc build first -o plant.img
cmp plant.img watched.img || fail "a watch builds another image of an edit"
