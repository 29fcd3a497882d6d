"""What ansible/stvm_change.py does with a real `stvm`, without Ansible.

usage: bring.py FOLDER_OF_THE_MODULE STVM PARAMETERS_AS_JSON [--check]
Prints what the task would return. Exit code 1: it would fail.
"""

import json
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import stvm_change as module  # noqa: E402


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


params = json.loads(sys.argv[3])
tool = module.Tool(run, sys.argv[2], module.place_of(params))
try:
    print(json.dumps(module.bring(tool, params, "--check" in sys.argv[4:])))
except module.Refused as why:
    print(json.dumps(why.result()))
    sys.exit(1)
