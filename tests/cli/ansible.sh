#!/bin/sh
# The module of Ansible in playbooks, over a connection to this machine: first change, the same
# again, check and diff mode, what is refused. Skipped without ansible-core, which
# `make test-ansible` installs.
command -v ansible-playbook >/dev/null && command -v ansible-doc >/dev/null || exit 77
. "$(dirname "$0")/lib.sh"

cat >ansible.cfg <<CFG
[defaults]
library = $source_dir/ansible
local_tmp = $work/local_tmp
remote_tmp = $work/remote_tmp
interpreter_python = auto_silent
nocows = true
localhost_warning = false
CFG
ANSIBLE_CONFIG=$work/ansible.cfg ANSIBLE_HOME=$work/home HOME=$work ANSIBLE_NOCOLOR=1
LC_ALL=C.UTF-8 PATH=$bin:$PATH
export ANSIBLE_CONFIG ANSIBLE_HOME HOME ANSIBLE_NOCOLOR LC_ALL PATH

# What the documentation in the module promises is what it takes.
cat >promised.py <<'PY'
import json, sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
from stvm_change import SPEC
told = json.load(open("out"))["stvm_change"]["doc"]["options"]
words = ("type", "elements", "choices", "default", "required")
def facts(row): return {w: row[w] for w in words if row.get(w) not in (None, False)}
wrong = [k for k in told.keys() | SPEC.keys() if facts(told.get(k, {})) != facts(SPEC.get(k, {}))]
sys.exit(f"other in DOCUMENTATION: {wrong}" if wrong else 0)
PY
expect 0 ansible-doc --type module --json stvm_change
python3 promised.py "$source_dir/ansible" || fail 'the documentation says something else'

printf 'PROGRAM Main VAR n : DINT; END_VAR n := n + 1; END_PROGRAM\n' >v1.st
printf 'PROGRAM Main VAR n : DINT; more : INT; END_VAR n := n + 2; END_PROGRAM\n' >v2.st
printf 'PROGRAM Main VAR n : SINT; END_VAR n := 1; END_PROGRAM\n' >narrow.st
printf 'PROGRAM Main VAR n : DINT; END_VAR n := nobody; END_PROGRAM\n' >bad.st
serve plc --name v v1.st
# task NAME SETTINGS...: a playbook of one task, which keeps its answer in NAME.json.
task() {
  file=$1
  shift
  {
    printf -- '- hosts: localhost\n  gather_facts: false\n  tasks:\n    - stvm_change:\n'
    printf '        name: v\n        allow_overrun: true\n'
    for setting; do printf '        %s\n' "$setting"; done
    printf '      register: answer\n      ignore_errors: true\n'
    printf '    - copy: {content: "{{ answer | to_json }}", dest: "%s/%s.json"}\n' "$work" "$file"
    printf '      check_mode: false\n      diff: false\n'
  } >"$file.yml"
}
# play NAMES OPTIONS...: runs them, one behind the other. What Ansible printed is in `printed`, the
# answer of the last one in `out`.
play() {
  names=$1
  books=""
  shift
  for file in $names; do books="$books $file.yml"; done
  for _ in $(seq 200); do
    code=0
    # shellcheck disable=SC2086
    ansible-playbook -i localhost, -c local "$@" $books >printed 2>err </dev/null || code=$?
    cp printed out
    [ "$code" -eq 0 ] || fail "ansible-playbook ends with $code"
    grep -qE 'R030[46]' "$file.json" || break
  done
  cp "$file.json" out
}
# answer NAME: `out` is what that one answered.
answer() { cp "$1.json" out; }
running() { stvm status --dir plc --format json | python3 -c 'import json, sys
print(json.load(sys.stdin)["running"])'; }

task v2 "src: [$work/v2.st]" "dir: $work/plc"
was=$(running)
play v2 --check --diff
json 'd["changed"] and not d.get("failed") and d["before"] == "'"$was"'"'
grep -q '^+initialised Main.more : INT (new)$' printed || fail 'diff mode shows no fate'
grep -q '^+1 kept, 0 moved, 0 converted, 1 initialised, 0 dropped$' printed || fail 'no counts'
[ "$(running)" = "$was" ] || fail 'check mode changed it'

play v2
json 'd["changed"] and d["on_trial"] and d["before"] == "'"$was"'" and d["report"]["switched"]'
is=$(running)
[ "$is" != "$was" ] || fail 'nothing was changed'
play v2
json 'not d["changed"] and d["before"] == d["after"] == "'"$is"'"'
grep -qE 'changed=0 ' printed || grep -qE 'ok: .localhost.' printed || fail 'not idempotent'
play v2 --check
json 'not d["changed"]'

task good "src: [$work/v2.st]" "dir: $work/plc" 'permanent: true'
play good
json 'd["changed"] and not d["on_trial"]'
expect 0 stvm edits --dir plc
said 'no edit is on trial'
play good
json 'not d["changed"]'

expect 0 stvm set Main.n=100000 --dir plc
task narrow "src: [$work/narrow.st]" "dir: $work/plc"
task bad "src: [$work/bad.st]" "dir: $work/plc"
task none "src: [$work/none.st]" "dir: $work/plc"
task nowhere "src: [$work/v1.st]" "dir: $work/nowhere"
task nobody "src: [$work/v1.st]"
for mode in --check --diff; do
  rm -f ./*.json
  play 'narrow bad none nowhere nobody' $mode
  answer narrow
  json 'd["failed"] and d["code"] == "R0303" and "--allow-loss" in d["help"]'
  json '"LOSS Main.n: " in d["msg"] and "help: " in d["msg"]'
  answer bad
  json 'd["failed"] and d["code"] == "E2001" and "bad.st:1:41: E2001: " in d["msg"]'
  answer none
  json 'd["failed"] and d["code"] == "R0501" and "none.st" in d["msg"]'
  answer nowhere
  json 'd["failed"] and d["code"] == "R0404" and "nowhere" in d["msg"]'
  answer nobody
  json 'd["failed"] and "one of the following is required: dir, host" in d["msg"]'
done
[ "$(running)" = "$is" ] || fail 'a refused change changed it'
task lost "src: [$work/narrow.st]" "dir: $work/plc" 'allow_loss: true'
play lost --diff
json 'd["changed"] and d["report"]["loss_count"] > 0'
grep -q '^+LOSS Main.n: ' printed || fail 'no loss in diff mode'

# Without the tool the task fails as those of Ansible do.
task tool "src: [$work/v1.st]" "dir: $work/plc" 'executable: stvm-that-is-not-there'
play tool
json 'd["failed"] and "stvm-that-is-not-there" in d["msg"]'
expect 0 stvm stop --dir plc
