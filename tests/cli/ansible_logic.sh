#!/bin/sh
# The module of Ansible, without Ansible: what it decides with a fake tool, and what it does with
# controllers. tests/cli/ansible.sh has the same cases in playbooks.
. "$(dirname "$0")/lib.sh"

module=$source_dir/ansible
tests=$source_dir/tests/ansible
expect 0 python3 "$tests/logic_test.py" "$module"
said '^OK$'

printf 'PROGRAM Main VAR n : DINT; END_VAR n := n + 1; END_PROGRAM\n' >v1.st
printf 'PROGRAM Main VAR n : DINT; more : INT; END_VAR n := n + 2; END_PROGRAM\n' >v2.st
printf 'PROGRAM Main VAR n : SINT; END_VAR n := 1; END_PROGRAM\n' >narrow.st
printf 'PROGRAM Main VAR n : DINT; END_VAR n := nobody; END_PROGRAM\n' >bad.st
serve plc --name v v1.st
# bring CODE PARAMETERS [--check]: the answer is in `out`. No task is to be late for a test.
bring() {
  code=$1 params=$2
  shift 2
  case $params in *'"allow_overrun"'*) ;; *) params="${params%\}}, \"allow_overrun\": true}" ;; esac
  for _ in $(seq 4000); do
    got=0
    python3 "$tests/bring.py" "$module" "$bin/stvm" "$params" "$@" >out 2>err </dev/null || got=$?
    [ "$code$got" = 01 ] && grep -q '"R030[46]"' out || break
    sleep 0.05
  done
  [ "$got" -eq "$code" ] || fail "exit code $got instead of $code: $params"
}
running() { "$bin/stvm" status --dir plc --format json | python3 -c 'import json, sys
print(json.load(sys.stdin)["running"])'; }

# Check mode says what would come, and nothing comes.
was=$(running)
bring 0 '{"src": ["v2.st"], "name": "v", "dir": "plc"}' --check
json 'd["changed"] and d["before"] == "'"$was"'" and not d["report"]["switched"]'
json '"initialised Main.more : INT (new)" in d["diff"]["after"].splitlines()'
[ "$(running)" = "$was" ] || fail 'check mode changed it'
expect 0 stvm edits --dir plc
said 'no edit is on trial'

# The first time it comes, the second time it is there.
bring 0 '{"src": ["v2.st"], "name": "v", "dir": "plc"}'
json 'd["changed"] and d["before"] == "'"$was"'" and d["on_trial"] and d["report"]["switched"]'
is=$(running)
json 'd["after"] == "'"$is"'" != d["before"]'
bring 0 '{"src": ["v2.st"], "name": "v", "dir": "plc"}'
json 'not d["changed"] and d["after"] == d["before"] == "'"$is"'"'
bring 0 '{"src": ["v2.st"], "name": "v", "dir": "plc"}' --check
json 'not d["changed"]'
expect 0 stvm edits --dir plc --format json
json 'len(d["edits"]) == 1'

# For good: what is on trial is accepted, once.
bring 0 '{"src": ["v2.st"], "name": "v", "dir": "plc", "permanent": true}' --check
json 'd["changed"] and d["on_trial"]'
bring 0 '{"src": ["v2.st"], "name": "v", "dir": "plc", "permanent": true}'
json 'd["changed"] and not d["on_trial"]'
bring 0 '{"src": ["v2.st"], "name": "v", "dir": "plc", "permanent": true}'
json 'not d["changed"]'

# An image and a fleet file are brought once, too.
expect 0 stc build v1.st --name v -o v1.img
bring 0 '{"src": ["v1.img"], "dir": "plc", "allow_loss": true}'
json 'd["changed"]'
bring 0 '{"src": ["v1.img"], "dir": "plc"}'
json 'not d["changed"]'
printf 'PROGRAM Main VAR n : DINT; END_VAR n := n + 3; END_PROGRAM\n' >v3.st
expect 0 stc fleet v1.st v3.st --name v -o x.fleet
bring 0 '{"src": ["x.fleet"], "dir": "plc"}'
json 'd["changed"]'
bring 0 '{"src": ["x.fleet"], "dir": "plc"}'
json 'not d["changed"]'

# What is refused fails with code, place and way out, in check mode too, and changes nothing.
was=$(running)
expect 0 stvm set Main.n=100000 --dir plc
for mode in --check ''; do
  bring 1 '{"src": ["narrow.st"], "name": "v", "dir": "plc"}' $mode
  json 'd["code"] == "R0303" and "--allow-loss" in d["help"] and d["before"] == "'"$was"'"'
  json 'any(line.startswith("LOSS Main.n: ") for line in d["msg"].splitlines())'
  bring 1 '{"src": ["bad.st"], "name": "v", "dir": "plc"}' $mode
  json 'd["code"] == "E2001" and d["msg"].startswith("bad.st:1:41: E2001: ")'
  json '[(e["file"], e["line"], e["column"]) for e in d["diagnostics"]] == [("bad.st", 1, 41)]'
  bring 1 '{"src": ["none.st"], "dir": "plc"}' $mode
  json 'd["code"] == "R0501" and "none.st" in d["msg"] and d["help"]'
  bring 1 '{"src": ["v1.st"], "dir": "nowhere"}' $mode
  json 'd["code"] == "R0404" and "nowhere" in d["msg"] and d["help"] and "before" not in d'
done
[ "$(running)" = "$was" ] || fail 'a refused change changed it'
bring 0 '{"src": ["narrow.st"], "name": "v", "dir": "plc", "allow_loss": true}'
json 'd["changed"] and d["report"]["loss_count"] == 1'
json 'any(line.startswith("LOSS Main.n: ") for line in d["diff"]["after"].splitlines())'
bring 1 '{"src": ["v1.st"], "dir": "plc", "host": "-oProxyCommand=touch x"}'
json 'd["code"] == "R0504"'

# Another machine, by a stand-in for ssh.
cat >ssh <<SH
#!/bin/sh
[ "\$2" = plant7 ] || { echo "ssh: no such host" >&2; exit 255; }
PATH=$bin:\$PATH exec sh -c "\$3"
SH
chmod +x ssh
STVM_SSH=$work/ssh
export STVM_SSH
bring 0 '{"src": ["narrow.st"], "name": "v", "host": "plant7", "dir": "'"$work"'/plc"}'
json 'not d["changed"]'
bring 1 '{"src": ["narrow.st"], "host": "plant8"}'
json 'd["code"] == "R0404" and "plant8" in d["msg"]'
expect 0 stvm stop --dir plc
