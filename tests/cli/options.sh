#!/bin/sh
# The command line itself, of both tools: what it says of itself, and every kind of mistake.
. "$(dirname "$0")/lib.sh"

cat >good.st <<'ST'
TYPE Mode : (Filling, Draining); END_TYPE
VAR_GLOBAL speed : INT; END_VAR
PROGRAM Main VAR counter : INT; mode : Mode; END_VAR counter := counter + 1; END_PROGRAM
ST
expect 0 stc build good.st -o good.img

# R-01 What runs here: version, commit, formats, protocol, adapters, native tier.
version=$(cat "$source_dir/VERSION")
commit=$(sed -n 's/.*kCommit\[\] = "\(.*\)";/\1/p' "$bin/../generated/tools/identity.cc")
for tool in stc stvm; do
  for way in version --version -V; do
    expect 0 $tool $way
    said "^$tool $version$"
    said "^commit +$commit$"
    said '^image formats +7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20$'
    said '^adapters +(none|(modbus|xml, plcopen, twincat|keys)(, keys)?)$'
    said '^native tier +(none|x86-64|aarch64)$'
    silent_on err
  done
  expect 0 $tool --version --format json
  json "d['tool'] == '$tool' and d['version'] == '$version' and d['commit'] == '$commit'"
  json 'd["image_formats"] == list(range(7, 21)) and isinstance(d["adapters"], list)'
  expect 2 $tool version good.img
  said 'R0504: version: too many arguments: good.img'
done
expect 0 stvm version
said '^protocol +14$'

# The programs beside it that know a broker say what they were built with.
for tool in stvm-agent stvm-fleet; do
  expect 0 "$bin/$tool" --version
  said "^$tool $version$"
  said '^adapters +(none|mqtt)$'
  expect 0 "$bin/$tool" --version --format json
  json "d['tool'] == '$tool' and d['adapters'] in ([], ['mqtt'])"
done

# R-01 The commit is looked up in every build, and the file is written only when it is another one.
if command -v git >git.path; then
  identity() {
    cmake -DOUT="$work/identity.cc" -DSOURCE_DIR="$work/repository" -DVERSION=9.8.7 "$@" \
      -P "$source_dir/scripts/identity.cmake" >out 2>err || fail "identity.cmake"
    cp identity.cc out
  }
  mkdir repository
  identity
  said 'kVersion\[\] = "9\.8\.7"'
  said 'kCommit\[\] = "unknown"'
  identity -DCOMMIT=v1-tarball
  said 'kCommit\[\] = "v1-tarball"'
  git_here() { git -C repository -c user.name=n -c user.email=e "$@" >git.out 2>&1; }
  git_here init
  echo 1 >repository/file
  git_here add file
  git_here commit -m one
  identity
  said "kCommit\[\] = \"$(git -C repository rev-parse --short=12 HEAD)\""
  touch -d 2001-01-01 identity.cc
  identity
  [ "$(date -r identity.cc +%Y)" = 2001 ] || fail "written anew without need"
  echo 2 >repository/file
  identity
  said 'kCommit\[\] = "[0-9a-f]{12}-changed"'
fi

# R-01 Help: of the tool, of a command, in three ways; the tables for programs.
for tool in stc stvm; do
  expect 0 $tool --help
  cp out help
  expect 0 $tool help
  cmp -s out help || fail "help and --help differ"
  expect 2 $tool help frobnicate
  said 'unknown command `frobnicate`'
  expect 0 $tool help --format json
  json "d['tool'] == '$tool' and {'help', 'version'} <= {c['name'] for c in d['commands']}"
  for verb in $(python3 -c 'import json; print(*[c["name"] for c in json.load(open("out"))["commands"]])'); do
    grep -q "^  $verb " help || fail "$verb is not in the overview"
    expect 0 $tool help $verb
    cp out help_of_verb
    said "^usage: $tool $verb"
    expect 0 $tool $verb --help
    cmp -s out help_of_verb || fail "$tool $verb --help"
    # R-08 In 80 columns.
    awk 'length($0) > 80 { print; bad = 1 } END { exit bad }' help_of_verb || fail "help of $verb"
  done
  awk 'length($0) > 80 { print; bad = 1 } END { exit bad }' help || fail "help of $tool"
  awk '$0 == "" && last == "" { bad = 1 } { last = $0 } END { exit bad }' help || fail "empty lines"
done

# R-01 Short options with what they take attached, and several flags in one word.
expect 0 stc build good.st -j2 -oattached.img -q
[ -s attached.img ] || fail "-oFILE"
silent_on out
expect 0 stc build good.st -qj1 -oattached.img
silent_on out
expect 2 stc build good.st -o=x.img
said 'build: -o=x.img: write -o x.img, or --output=x.img'
expect 2 stc build good.st -qx
said 'unknown option -x'

# R-01 Did you mean: commands, options, values of options.
expect 2 stc biuld good.st
said 'unknown command `biuld`.*did you mean `build`\?'
expect 2 stvm statsu
said 'did you mean `status`\?'
expect 2 stc build good.st --outptu x.img
said 'build: unknown option --outptu; did you mean `--output`\?'
expect 2 stc build good.st --frobnicate
said 'unknown option --frobnicate$'
expect 2 stvm serve --format json
said 'serve: unknown option --format$'
expect 2 stvm fleet chnage x
said '`chnage` is none of its verbs: change, .*, watch; did you mean `change`\?'
expect 2 stc check good.st --format jsno
said 'check: --format is text, json, sarif or github, not `jsno`; did you mean `json`\?'
expect 2 stvm run good.img --tier nativ
said 'run: --tier is auto, native or interp, not `nativ`; did you mean `native`\?'

# R-01 Did you mean: variables, parts of them, and literals.
run() { stvm run good.img --virtual-time --scans 1 "$@"; }
expect 7 run --print Mian.counter
said '`Mian` is neither a program nor a global variable; did you mean `Main`\?'
expect 7 run --print Gvl.speed
said '`Gvl` is neither .*: the variable is `speed`$'
printf "VAR_GLOBAL Maid : INT; END_VAR\n{attribute 'qualified_only'}\nVAR_GLOBAL Y1 : INT; Z1 : INT; END_VAR\n" >List.st
printf 'VAR_GLOBAL Y : INT; END_VAR\nPROGRAM Main Y := Y + 1; END_PROGRAM\n' >Plain.st
expect 7 stvm run List.st Plain.st --virtual-time --scans 1 --print Plain.Y
said '`Plain` is neither .*: the variable is `Y`$'
expect 7 stvm run List.st Plain.st --virtual-time --scans 1 --print Z1
said '`Z1` is neither a program nor a global variable; did you mean `List.Z1`\?'
expect 7 run --print sped
said 'did you mean `speed`\?'
expect 7 run --print Main.conuter
said '`conuter` is no member of `Main`; did you mean `counter`\?'
expect 7 run --print Main.nothing_like_it
said 'is no member of `Main`$'
expect 7 run --set Main.mode=Drainig
said 'is no value of type Mode; did you mean `Draining`\?'
expect 7 run --set Main.mode=Mode#Filing
said 'did you mean `Filling`\?'

# R-02 An option that takes one value takes one, and options that contradict each other are refused.
for tool in stc stvm; do
  expect 0 $tool help --format json
  python3 - >cases <<'PY'
import json
for command in json.load(open("out"))["commands"]:
    values = {option["name"]: (option["choices"] or ["7"])[0]
              for option in command["options"] if "value" in option}
    if "--passes" in values:
        values["--passes"] = "fold"
    for option in command["options"]:
        others = [f"{other}={values[other]}" if other in values else other
                  for other in option["excludes"]]
        print(command["name"], option["name"], values.get(option["name"], "-"),
              option["repeatable"], ",".join(others) or "-")
PY
  while read -r verb option value repeatable excludes; do
    if [ "$value" = - ]; then
      expect 2 $tool "$verb" "$option=1"
      said "R0504: $verb: $option takes no value"
    else
      expect 2 $tool "$verb" "$option"
      said "R0504: $verb: $option needs a value"
      if [ "$repeatable" = False ]; then
        expect 2 $tool "$verb" "$option=$value" "$option=$value"
        said "R0504: $verb: $option takes one value, and there are two"
      fi
    fi
    misspelt=$(echo "$option" | sed 's/\(..\)$/x\1/')
    expect 2 $tool "$verb" "$misspelt"
    said "R0504: $verb: unknown option $misspelt; did you mean"
    [ "$excludes" = - ] && continue
    for other in $(echo "$excludes" | tr , ' '); do
      set -- "$option" "$other"
      [ "$value" = - ] || set -- "$option=$value" "$other"
      expect 2 $tool "$verb" "$@"
      said "R0504: $verb: .* contradict each other; leave one out"
    done
  done <cases
  [ "$(wc -l <cases)" -gt 20 ] || fail "few options of $tool"
done
expect 2 stc build good.st --output --quiet
said 'build: --output needs a value: FILE, and --quiet is an option; if it is meant, write --output=--quiet'
# An empty value is an empty value, and what begins with `=` is no option.
for name in "" "=5"; do
  expect 0 stc build good.st -o named.img --name "$name"
done
# Names that are defined.
for define in 1x 'A B=1' '' '=1'; do
  expect 2 stc check good.st "--define=$define"
  said "R0504: --define: .$define. does not begin with a name; write NAME or NAME=VALUE"
done
expect 2 stc check good.st --define A=1 --define a=2
said 'R0504: --define: .A=1. and .a=2. contradict each other; leave one out'
expect 0 stc check good.st --define A=1 --define a=1 --define B
# Codes in letters of either case.
for page in w0001 e3001 r0301; do
  expect 0 stc explain $page
  said "^$(echo $page | tr a-z A-Z): "
done
expect 2 stc explain W001
said 'did you mean .W0001.'
# A RESOURCE where none is declared.
expect 1 stc build good.st -o named.img --resource foo
said 'error\[E2018\]: there is no RESOURCE .foo.: nothing declares one'
# A text of the other kind is shown as it is written.
printf 'PROGRAM Main VAR i : INT; END_VAR i := "aä"; END_PROGRAM\n' >wide.st
expect 1 stc check wide.st
said 'error\[E3001\]: "aä" does not go with .INT.'
