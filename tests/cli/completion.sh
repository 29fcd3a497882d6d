#!/bin/sh
# R-08 Completion and manual pages: every command and every option of the tables is in each of them,
# and what is shipped is what the tables say.
. "$(dirname "$0")/lib.sh"

"$source_dir/scripts/shell_files.py" "$bin" share
diff -r share "$source_dir/share" || fail "share/ is not what the tables say; run make docs"

# The words that each shell must know.
for tool in stc stvm; do
  expect 0 $tool help --format json
  python3 - $tool >>words <<'PY'
import json, sys
for command in json.load(open("out"))["commands"]:
    for option in command["options"]:
        short = option.get("short", "-")
        print(sys.argv[1], command["name"], option["name"], short, " ".join(option["choices"]) or "-")
PY
done
[ "$(wc -l <words)" -gt 300 ] || fail "few words"

# bash, as it asks.
cat >ask.bash <<'BASH'
source share/bash-completion/completions/$1
COMP_WORDS=("${@}")
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_$1
printf '%s\n' "${COMPREPLY[@]}"
BASH
[ "$(bash ask.bash stc chec)" = check ] || fail "a command"
[ "$(bash ask.bash stc check --format s)" = sarif ] || fail "a choice"
[ "$(bash ask.bash stc check --format = s)" = sarif ] || fail "a choice after ="
[ "$(bash ask.bash stc check --format = | tr '\n' ' ')" = "text json sarif github " ] || fail "after ="
[ "$(bash ask.bash stvm help und)" = undo ] || fail "help of a command"
touch a_source.st
bash ask.bash stc check a_so | grep -q '^a_source.st$' || fail "a file"
mkdir a_folder
[ "$(bash ask.bash stvm get --dir a_)" = a_folder ] || fail "a folder, and no file"
cut -d' ' -f1,2 words | sort -u >commands
while read -r tool command; do
  bash ask.bash $tool $command - | sort >known
  grep "^$tool $command " words | awk '{ print $3; if ($4 != "-") print $4 }' | sort >wanted
  cmp -s known wanted || fail "bash: options of $tool $command"
  page=share/man/man1/$tool-$command.1
  while read -r option; do
    grep -qF "\\fB$(echo "$option" | sed 's/-/\\-/g')\\fR" "$page" || fail "$page: $option"
  done <wanted
done <commands

# The other shells, where they are installed, read their files without a complaint.
while read -r tool command option short choices; do
  grep -q -- "__fish_seen_subcommand_from $command' -l ${option#--}[ -]" \
    share/fish/vendor_completions.d/$tool.fish || fail "fish: $tool $command $option"
  grep -q -- "[)*]$option[=\[]" share/zsh/site-functions/_$tool || fail "zsh: $tool $command $option"
done <words
for tool in stc stvm; do
  if command -v zsh >which; then zsh -n share/zsh/site-functions/_$tool || fail "zsh: _$tool"; fi
  if command -v fish >which; then
    fish --no-config -n share/fish/vendor_completions.d/$tool.fish || fail "fish: $tool"
    fish --no-config -c "source share/fish/vendor_completions.d/$tool.fish; complete -C '$tool --versio'" \
      >answer 2>&1 || fail "fish: $tool"
  fi
done
if command -v fish >which; then
  fish --no-config -c 'source share/fish/vendor_completions.d/stc.fish; complete -C "stc check --format s"' |
    grep -q '^--format=sarif\|^sarif' || fail "fish: a choice"
fi

# Manual pages are read without a warning.
if command -v groff >which; then
  for page in share/man/man1/*; do
    groff -man -Tutf8 -ww -z "$page" 2>warnings || fail "$page"
    [ ! -s warnings ] || { cat warnings; fail "$page"; }
  done
fi

# --color and what the environment says of it.
printf 'PROGRAM p n := 1; END_PROGRAM\n' >bad.st
escape=$(printf '\033')
coloured() { grep -q "$escape" err || fail "no colour: $*"; }
plain() { if grep -q "$escape" err; then fail "colour: $*"; fi; }
run() { code=0; "$@" >out 2>err </dev/null || code=$?; }
run "$bin/stc" check bad.st
plain auto, to a file
run "$bin/stc" check bad.st --color=always
coloured always
run env NO_COLOR=1 "$bin/stc" check bad.st --color always
coloured "the option wins"
run env CLICOLOR_FORCE=1 "$bin/stc" check bad.st
coloured CLICOLOR_FORCE
run env CLICOLOR_FORCE=1 "$bin/stc" check bad.st --color never
plain never
run env CLICOLOR_FORCE=0 "$bin/stc" check bad.st
plain CLICOLOR_FORCE=0
run env CLICOLOR_FORCE=1 NO_COLOR=1 "$bin/stc" check bad.st
plain NO_COLOR
mkdir p
printf 'nmae = 1\n' >p/stc.toml
cp bad.st p
run "$bin/stc" check p --color always
coloured "settings"
run env CLICOLOR_FORCE=1 "$bin/stvm" run p --virtual-time --scans 1
coloured "settings, by stvm"
[ "$code" -eq 7 ] || fail "a coloured refusal of stc is not understood: $code"
