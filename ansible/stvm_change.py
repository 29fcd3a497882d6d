#!/usr/bin/python
# Brings a program to a running controller by Ansible: `stvm change`, once for each version. The
# tool decides and checks; this module asks it first what would happen (--dry-run), does nothing
# where the controller runs that version already, and says in the words of Ansible what came out.
#
# The upper part knows nothing of Ansible: a way to run commands comes in, a dictionary goes out.
# tests/ansible/ tests it alone. A refusal is an exception inside of it (Refused), and a failed task
# outside.
"""An Ansible module around `stvm change`; ansible-doc stvm_change."""

import json
import re

DOCUMENTATION = r"""
module: stvm_change
short_description: Changes the program of a running stvm controller without stopping it
description:
  - Brings sources, an image or a fleet file to a controller by C(stvm change).
  - Nothing is done when the controller runs that version already, which is known by its hash.
  - Check mode is C(stvm change --dry-run). The controller itself says what would be lost, and
    what it would refuse fails in check mode, too.
  - Diff mode shows the fate report in short.
requirements:
  - C(stvm) on the machine where the module runs, and C(stc) beside it.
options:
  src:
    description: Sources, a folder with a stc.toml, an image, or a fleet file of C(stc fleet).
    type: list
    elements: path
    required: true
  dir:
    description: The state directory of the controller. With I(host), on that machine.
    type: path
  host:
    description: The controller runs there, C([user@]host). It is reached by ssh, which must not
      need to ask for anything. Without I(dir) it takes what that machine says.
    type: str
  permanent:
    description: Accept at once. An edit that is on trial with that version is accepted as well.
    type: bool
    default: false
  allow_loss:
    description: Change even if live values are lost, as the report says.
    type: bool
    default: false
  allow_overrun:
    description: Change even if a task may be delayed.
    type: bool
    default: false
  matching:
    description: Of a fleet file, take only the units that are there as before the edit.
    type: bool
    default: false
  restricted:
    description: Refuse when the interface of a POU is edited. As the project says by default.
    type: bool
  strategy:
    description: How it is switched. As the project says by default.
    type: str
    choices: [in-place, standby]
  health:
    description: A BOOL that stays TRUE while all is well; FALSE in the first 1000 cycles undoes it.
    type: str
  unless:
    description: A BOOL of the running program; while it is TRUE nothing is switched.
    type: str
  dialect:
    description: The dialect of the sources. As the project says by default.
    type: str
    choices: [iec, codesys, twincat]
  resource:
    description: The RESOURCE to compile, when there are several.
    type: str
  define:
    description: Names, or C(NAME=VALUE), for C({IF defined(NAME)}).
    type: list
    elements: str
    default: []
  name:
    description: The name of the program, instead of that of the folder or the file.
    type: str
  executable:
    description: The tool.
    type: path
    default: stvm
notes:
  - Where controllers have no compiler, run this on the machine that has it, with I(host) and
    C(delegate_to).
"""

EXAMPLES = r"""
- name: The line runs the program of this repository
  stvm_change:
    src: ["{{ playbook_dir }}/line"]
    host: "plc@{{ inventory_hostname }}"
  delegate_to: localhost

- name: An edit for many controllers, for good
  stvm_change:
    src: [faster.fleet]
    dir: /var/lib/stvm/line
    permanent: true
"""

RETURN = r"""
before:
  description: The hash of the version that ran before.
  type: str
  returned: always, where the controller was reached
after:
  description: The hash of the version that runs now. Empty where check mode says that one would
    come.
  type: str
  returned: success
on_trial:
  description: Whether C(stvm undo) can take something back.
  type: bool
  returned: success
report:
  description: What C(stvm change --format json) says, also of a change that is refused for it.
  type: dict
  returned: when there is one
code:
  description: The code of the refusal, R0303 for example, or of the first error of the sources.
  type: str
  returned: failure
help:
  description: The way out of it. Empty where there is none.
  type: str
  returned: failure
diagnostics:
  description: All that was said, each with code and message, and file, line and column if it has
    a place.
  type: list
  returned: failure
"""

NOTHING_TO_DO = "R0308"
NO_TRIAL = "R0305"
BUSY = "R0302"
ROWS_SHOWN = 40  # of the fate report; `stvm change --dry-run --all` has all
MESSAGES_SHOWN = 10
LOSS = ("variable", "live", "after", "what")
FLAGS = ("allow_loss", "allow_overrun", "matching")
TEXTS = ("strategy", "health", "unless", "dialect", "resource", "name")


class Refused(Exception):
    """What becomes of the task when the tool, or the controller, refuses."""

    def __init__(self, diagnostics, help_text="", report=None):
        self.diagnostics = diagnostics
        self.help = help_text
        self.report = report  # of a change that was refused for what it says
        self.before = ""
        super().__init__(message_of(diagnostics, losses_in(report or {}), help_text))

    @property
    def code(self):
        return self.diagnostics[0]["code"]

    def result(self):
        out = {"msg": str(self), "code": self.code, "help": self.help,
               "diagnostics": self.diagnostics}
        if self.before:
            out["before"] = self.before
        if self.report is not None:
            out["report"] = self.report
        return out


def line_of(diagnostic):
    place = ""
    if diagnostic.get("file"):
        place = "%(file)s:%(line)d:%(column)d: " % diagnostic
    return "%s%s: %s" % (place, diagnostic["code"], diagnostic["message"])


def shortened(lines, most):
    more = len(lines) - most
    return lines[:most] + (["and %d more" % more] if more > 0 else [])


def losses_in(report):
    rows = report.get("losses")
    return ["LOSS %s: %s -> %s: %s" % tuple(row.get(key) for key in LOSS)
            for row in (rows if isinstance(rows, list) else []) if isinstance(row, dict)]


def message_of(diagnostics, losses, help_text):
    lines = shortened([line_of(one) for one in diagnostics], MESSAGES_SHOWN)
    lines += shortened(losses, MESSAGES_SHOWN)
    if help_text:
        lines.append("help: " + help_text)
    return "\n".join(lines)


def object_in(text):
    """The object that the tool has printed; None when it is none."""
    try:
        value = json.loads(text)
    except ValueError:
        return None
    return value if isinstance(value, dict) else None


def refusal_in(err):
    """(code, text, help) of `stvm: R0303: text` and the line below it; None without one."""
    found = re.search(r"^stvm: (R\d{4}): (.*)$", err, re.M)
    if found is None:
        return None
    below = re.match(r"\n  help: (.*)", err[found.end():])
    return found.group(1), found.group(2), below.group(1) if below else ""


def diagnostic_of(row):
    """A row of the answer, if it is one."""
    if not isinstance(row, dict) or "code" not in row or "message" not in row:
        return None
    kept = ("code", "severity", "message", "fix")
    out = {key: str(row[key]) for key in kept if key in row}
    if all(key in row for key in ("file", "line", "column")):
        out.update(file=str(row["file"]), line=int(row["line"]), column=int(row["column"]))
    return out


def refused(code, out, err):
    """The exception for a run that did not end with 0, whatever it has printed."""
    answer = object_in(out) or {}
    rows = answer.get("diagnostics")
    errors = [row for row in map(diagnostic_of, rows if isinstance(rows, list) else [])
              if row and row.get("severity", "error") == "error"]
    said = refusal_in(err)
    help_text = said[2] if said else ""
    if errors:
        return Refused(errors, help_text or errors[0].get("fix", ""))
    if said:
        report = answer if "losses" in answer else None
        return Refused([{"code": said[0], "message": said[1]}], help_text, report)
    last = err.strip().splitlines()[-1:] or ["it says nothing"]
    return Refused([{"code": "exit code %d" % code, "message": last[0]}])


class Tool:
    """`stvm` for one controller. `run` takes a command and returns (exit code, stdout, stderr)."""

    def __init__(self, run, executable, place):
        self.run = run
        self.executable = executable
        self.place = place  # ["--dir=DIR", "--host=HOST"]

    def ask(self, verb, arguments=()):
        """What it answers as JSON. Refused when it does not."""
        options = ["--format", "json", "--color", "never"]
        command = [self.executable, verb] + self.place + options + list(arguments)
        code, out, err = self.run(command)
        answer = object_in(out)
        if code == 0 and answer is not None:
            return answer
        raise refused(code, out, err)


def place_of(params):
    place = []
    for key in ("dir", "host"):
        if params.get(key):
            place.append("--%s=%s" % (key, params[key]))
    return place


def change_arguments(params):
    out = ["--" + flag.replace("_", "-") for flag in FLAGS if params.get(flag)]
    for key in TEXTS:
        if params.get(key):
            out.append("--%s=%s" % (key, params[key]))
    out += ["--define=" + name for name in params.get("define") or []]
    if params.get("restricted") is not None:
        out.append("--restricted" if params["restricted"] else "--unrestricted")
    return out + ["--"] + list(params["src"])


def fate_lines(report):
    """The fate report in short: how many, what is not simply kept, and what is lost."""
    counts = report["counts"]
    named = ("kept", "moved", "converted", "initialised", "dropped")
    rows = ["%s %s" % (row["fate"], fate_text(row)) for row in report["fates"]
            if row["fate"] != "kept"]
    rows += ["code %s: %s" % (row["pou"], row["what"] or row["change"]) for row in report["code"]]
    rows += ["%s %s: %s" % (row["kind"], row["name"], row["what"]) for row in report["system"]]
    pause = "predicted pause %.3g us" % (report["predicted_pause_ns"] / 1000.0)
    return ([", ".join("%d %s" % (counts[key], key) for key in named)] +
            shortened(rows, ROWS_SHOWN) + losses_in(report) + [pause])


def fate_text(row):
    types = row["new_type"] or row["old_type"]
    if row["old_type"] and row["new_type"] and row["old_type"] != row["new_type"]:
        types = "%s -> %s" % (row["old_type"], row["new_type"])
    text = "%s : %s" % (row["variable"], types)
    return text + (" (%s)" % row["reason"] if row["reason"] else "")


def diff_of(status, report):
    """For Ansible: the fates, behind the version that runs."""
    header = "%s %s" % (status["name"], status["running"][:12])
    return {"before_header": header, "after_header": header + ", changed", "before": "",
            "after": "\n".join(fate_lines(report)) + "\n"}


def outcome(status, changed, after, **more):
    out = {"changed": changed, "before": status["running"], "after": after["running"],
           "on_trial": bool(after["trial"])}
    out.update(more)
    return out


def already_there(tool, status, params, check_mode):
    """The version runs. It may be on trial, and be wanted for good."""
    if not params.get("permanent") or not status["trial"]:
        return outcome(status, False, status)
    if status.get("watched_by"):
        raise Refused([{"code": BUSY, "message": "it is on trial, watched by " +
                        str(status["watched_by"])}],
                      "Let the roll-out accept it, or take it back (stvm fleet watch PLAN).")
    if check_mode:
        return outcome(status, True, status, accepted=False)
    try:
        tool.ask("accept")
    except Refused as why:
        if why.code != NO_TRIAL:  # somebody else was faster
            raise
        return outcome(status, False, tool.ask("status"))
    return outcome(status, True, tool.ask("status"), accepted=True)


def bring(tool, params, check_mode):
    """What the task returns. Refused with what stands against it.

    An answer that is lost behind the switch is a refusal, too: the same task again sees what runs.
    """
    status = tool.ask("status")
    try:
        return bring_to(tool, status, params, check_mode)
    except Refused as why:
        why.before = status["running"]
        raise


def bring_to(tool, status, params, check_mode):
    arguments = change_arguments(params)
    try:
        report = tool.ask("change", ["--dry-run"] + arguments)
        diff = diff_of(status, report)
        if check_mode:
            return {"changed": True, "before": status["running"], "after": "",
                    "on_trial": bool(status["trial"]), "report": report, "diff": diff}
        how = ["--yes"] + (["--permanent"] if params.get("permanent") else [])
        report = tool.ask("change", how + arguments)
    except Refused as why:
        if why.code != NOTHING_TO_DO:
            raise
        return already_there(tool, tool.ask("status"), params, check_mode)
    return outcome(status, True, tool.ask("status"), report=report, diff=diff)


SPEC = {
    "src": {"type": "list", "elements": "path", "required": True},
    "dir": {"type": "path"},
    "host": {"type": "str"},
    "permanent": {"type": "bool", "default": False},
    "allow_loss": {"type": "bool", "default": False},
    "allow_overrun": {"type": "bool", "default": False},
    "matching": {"type": "bool", "default": False},
    "restricted": {"type": "bool"},
    "strategy": {"type": "str", "choices": ["in-place", "standby"]},
    "health": {"type": "str"},
    "unless": {"type": "str"},
    "dialect": {"type": "str", "choices": ["iec", "codesys", "twincat"]},
    "resource": {"type": "str"},
    "define": {"type": "list", "elements": "str", "default": []},
    "name": {"type": "str"},
    "executable": {"type": "path", "default": "stvm"},
}


def main():
    from ansible.module_utils.basic import AnsibleModule

    module = AnsibleModule(SPEC, required_one_of=[("dir", "host")], supports_check_mode=True)
    try:
        executable = module.get_bin_path(module.params["executable"], required=True)
        tool = Tool(module.run_command, executable, place_of(module.params))
        module.exit_json(**bring(tool, module.params, module.check_mode))
    except Refused as why:
        module.fail_json(**why.result())


if __name__ == "__main__":
    main()
