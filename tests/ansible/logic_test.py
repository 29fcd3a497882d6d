"""What ansible/stvm_change.py decides, without Ansible and without a controller.

A fake `stvm` answers in the forms of docs/schemas, and notes how it was called.
usage: logic_test.py FOLDER_OF_THE_MODULE
"""

import json
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv.pop(1))
import stvm_change as module  # noqa: E402

OLD = "a" * 64
NEW = "b" * 64


def report(**more):
    out = {"counts": {"kept": 5, "moved": 0, "converted": 1, "initialised": 0, "dropped": 0},
           "predicted_pause_ns": 8623, "boundary_bytes": 2,
           "fates": [{"variable": "Filled", "fate": "converted", "count": 1, "old_type": "DINT",
                      "new_type": "INT", "may_lose": True, "reason": "retyped"}],
           "code": [{"pou": "Line", "change": "follows", "instances": 1, "what": ""}],
           "system": [], "loss_count": 0, "losses": [], "exchange": [], "switched": False}
    out.update(more)
    return out


def said(code, text, help_text=""):
    return "stvm: %s: %s\n" % (code, text) + ("  help: %s\n" % help_text if help_text else "")


def refusal(code, text, help_text="", exit_code=7):
    row = {"code": code, "severity": "error", "message": text, "fix": help_text, "notes": []}
    answer = {"diagnostics": [row], "errors": 1, "warnings": 0, "notes": 0}
    return exit_code, json.dumps(answer), said(code, text, help_text)


class Plc:
    """Runs OLD; a change brings NEW. What a verb answers instead stands in `answers`."""

    def __init__(self, running=OLD, trial=False):
        self.running = running
        self.trial = trial
        self.answers = {}
        self.calls = []

    def run(self, command):
        verb = command[1]
        if "--dry-run" in command:
            verb = "dry"
        self.calls.append(verb)
        self.last = command
        if self.answers.get(verb):
            return self.answers[verb]
        return getattr(self, verb)(command)

    def status(self, _command):
        answer = {"name": "line", "running": self.running, "trial": self.trial}
        return 0, json.dumps(answer), ""

    def dry(self, _command):
        if self.running == NEW:
            return refusal("R0308", "version %s is running already" % NEW[:12], "Nothing to do.")
        return 0, json.dumps(report()), ""

    def change(self, command):
        self.running = NEW
        self.trial = "--permanent" not in command
        return 0, json.dumps(report(switched=True, pause_ns=7000, missed=0)), ""

    def accept(self, _command):
        self.trial = False
        return 0, "{}", ""


def bring(plc, check_mode=False, **params):
    params.setdefault("src", ["line"])
    tool = module.Tool(plc.run, "stvm", module.place_of(params))
    return module.bring(tool, params, check_mode)


class Decisions(unittest.TestCase):
    def test_first_change(self):
        plc = Plc()
        out = bring(plc, dir="plc")
        self.assertTrue(out["changed"])
        self.assertEqual((out["before"], out["after"], out["on_trial"]), (OLD, NEW, True))
        self.assertTrue(out["report"]["switched"])
        self.assertEqual(plc.calls, ["status", "dry", "change", "status"])

    def test_the_version_that_runs_is_not_brought_again(self):
        plc = Plc()
        bring(plc)
        plc.calls = []
        out = bring(plc)
        self.assertFalse(out["changed"])
        self.assertEqual((out["before"], out["after"]), (NEW, NEW))
        self.assertNotIn("change", plc.calls)

    def test_check_mode_changes_nothing(self):
        plc = Plc()
        out = bring(plc, check_mode=True, permanent=True)
        self.assertTrue(out["changed"])
        self.assertEqual(plc.running, OLD)
        self.assertEqual(plc.calls, ["status", "dry"])
        self.assertIn("converted Filled : DINT -> INT (retyped)", out["diff"]["after"])

    def test_somebody_else_brings_it_in_between(self):
        plc = Plc()
        plc.answers["change"] = refusal("R0308", "version is running already")
        self.assertFalse(bring(plc)["changed"])

    def test_permanent_is_accepted_at_once(self):
        plc = Plc()
        self.assertFalse(bring(plc, permanent=True)["on_trial"])
        self.assertNotIn("accept", plc.calls)

    def test_permanent_accepts_what_is_on_trial_with_that_version(self):
        plc = Plc(running=NEW, trial=True)
        out = bring(plc, check_mode=True, permanent=True)
        self.assertTrue(out["changed"])
        self.assertTrue(plc.trial)
        out = bring(plc, permanent=True)
        self.assertTrue(out["changed"])
        self.assertFalse(out["on_trial"])
        self.assertFalse(bring(plc, permanent=True)["changed"])

    def test_a_trial_is_left_alone_without_permanent(self):
        plc = Plc(running=NEW, trial=True)
        self.assertFalse(bring(plc)["changed"])
        self.assertTrue(plc.trial)

    def test_somebody_else_accepts_it_in_between(self):
        plc = Plc(running=NEW, trial=True)
        plc.answers["accept"] = refusal("R0305", "there is no change in trial to accept")
        self.assertFalse(bring(plc, permanent=True)["changed"])

    def test_a_trial_that_a_roll_out_watches_is_not_accepted_past_it(self):
        plc = Plc(running=NEW, trial=True)
        status = {"name": "line", "running": NEW, "trial": True, "watched_by": "plan 1 wave 1"}
        plc.answers["status"] = (0, json.dumps(status), "")
        for check_mode in (True, False):
            with self.assertRaises(module.Refused) as caught:
                bring(plc, check_mode=check_mode, permanent=True)
            self.assertEqual(caught.exception.code, "R0302")
            self.assertIn("plan 1 wave 1", str(caught.exception))
        self.assertNotIn("accept", plc.calls)
        self.assertFalse(bring(plc)["changed"])

    def test_another_refusal_of_accept_fails(self):
        plc = Plc(running=NEW, trial=True)
        plc.answers["accept"] = refusal("R0302", "another change is not finished")
        with self.assertRaises(module.Refused):
            bring(plc, permanent=True)


class Failures(unittest.TestCase):
    def refused(self, plc, **params):
        with self.assertRaises(module.Refused) as caught:
            bring(plc, **params)
        return caught.exception.result()

    def test_a_loss_fails_in_check_mode_too_and_nothing_is_sent(self):
        plc = Plc()
        losses = [{"variable": "v%d" % i, "live": "70000", "after": "1", "what": "saturates"}
                  for i in range(12)]
        lost = report(refused="R0303", message="12 live value(s) would be lost", loss_count=12,
                      losses=losses)
        text = said("R0303", "12 live value(s) would be lost", "allow it with --allow-loss")
        plc.answers["dry"] = (7, json.dumps(lost), text)
        for check_mode in (True, False):
            out = self.refused(plc, check_mode=check_mode)
            self.assertEqual(out["code"], "R0303")
            self.assertEqual(out["help"], "allow it with --allow-loss")
            self.assertEqual(out["before"], OLD)
            lines = out["msg"].splitlines()
            self.assertEqual(lines[:2], ["R0303: 12 live value(s) would be lost",
                                         "LOSS v0: 70000 -> 1: saturates"])
            self.assertEqual(lines[-2:], ["and 2 more", "help: allow it with --allow-loss"])
            self.assertEqual(len(out["report"]["losses"]), 12)
        self.assertNotIn("change", plc.calls)

    def test_the_switch_itself_is_refused(self):
        plc = Plc()
        plc.answers["change"] = refusal("R0306", "abandoned at its deadline", "Try again.")
        self.assertEqual(self.refused(plc)["code"], "R0306")

    def test_an_unreachable_controller(self):
        plc = Plc()
        plc.answers["status"] = refusal("R0404", "no controller runs there: plc", "Start it.")
        out = self.refused(plc)
        self.assertEqual((out["code"], out["help"]), ("R0404", "Start it."))
        self.assertNotIn("before", out)
        self.assertEqual(plc.calls, ["status"])

    def test_errors_of_sources_have_their_places(self):
        plc = Plc()
        rows = [{"code": "E2001", "severity": "error", "message": "`a` is not declared",
                 "file": "bad.st", "line": 3, "column": 11, "endLine": 3, "endColumn": 12,
                 "notes": []},
                {"code": "W0003", "severity": "warning", "message": "never used", "notes": []}]
        answer = json.dumps({"diagnostics": rows, "errors": 1, "warnings": 1, "notes": 0})
        plc.answers["dry"] = (1, answer, "text\n" + said("R0505", "1 error(s)"))
        out = self.refused(plc)
        self.assertEqual(out["code"], "E2001")
        self.assertEqual(out["msg"], "bad.st:3:11: E2001: `a` is not declared")
        self.assertEqual(len(out["diagnostics"]), 1)
        self.assertEqual(out["diagnostics"][0]["line"], 3)

    def test_many_errors_are_cut_in_the_message_only(self):
        plc = Plc()
        rows = [{"code": "E2001", "severity": "error", "message": "no %d" % i} for i in range(25)]
        plc.answers["dry"] = (1, json.dumps({"diagnostics": rows}), "")
        out = self.refused(plc)
        self.assertEqual(len(out["diagnostics"]), 25)
        self.assertTrue(out["msg"].endswith("no 9\nand 15 more"))

    def test_whatever_is_printed_is_a_failure_with_a_text(self):
        broken = ['{"diagnostics": [7, {}, {"code": 1}]}', '{"diagnostics": 3}', "[]", "null",
                  "{", "", "\x00\xff", '{"losses": 3}', '{"losses": [3, {}]}',
                  '{"diagnostics": [{"code": 5, "message": null}]}']
        runs = [(code, text, err) for code in (0, 1, 2, 7, 70, 74, -9, 255) for text in broken
                for err in ("first\nKilled\n", said("R0303", "lost"))]
        for exit_code, text, err in runs:
            with self.subTest(code=exit_code, text=text, err=err):
                plc = Plc()
                plc.answers["status"] = (exit_code, text, err)
                if exit_code == 0 and text.startswith("{") and text != "{":
                    continue  # an answer; what is in it is the tool's promise
                out = self.refused(plc)
                self.assertTrue(out["code"] and out["msg"])

    def test_a_silent_end_says_so(self):
        plc = Plc()
        plc.answers["status"] = (-9, "", "")
        out = self.refused(plc)
        self.assertEqual(out["msg"], "exit code -9: it says nothing")


class Commands(unittest.TestCase):
    def test_options_become_those_of_the_tool(self):
        plc = Plc()
        bring(plc, check_mode=True, dir="plc", host="u@h", src=["-a.st", "b.st"], allow_loss=True,
              matching=True, restricted=False, strategy="standby", define=["X", "Y=1"],
              name="line")
        self.assertEqual(plc.last, [
            "stvm", "change", "--dir=plc", "--host=u@h", "--format", "json", "--color", "never",
            "--dry-run", "--allow-loss", "--matching", "--strategy=standby", "--name=line",
            "--define=X", "--define=Y=1", "--unrestricted", "--", "-a.st", "b.st"])

    def test_nothing_is_said_that_was_not_asked_for(self):
        plc = Plc()
        bring(plc, dir="plc", restricted=None, define=[], permanent=False)
        self.assertEqual(plc.calls, ["status", "dry", "change", "status"])
        self.assertEqual(module.change_arguments({"src": ["x"]}), ["--", "x"])
        self.assertEqual(module.change_arguments({"src": ["x"], "restricted": True}),
                         ["--restricted", "--", "x"])


class Reports(unittest.TestCase):
    def test_the_short_report(self):
        full = report(loss_count=1,
                      losses=[{"variable": "Filled", "live": "70000", "after": "32767",
                               "what": "saturates"}],
                      system=[{"kind": "task", "name": "Fast", "what": "interval 10 ms"}])
        self.assertEqual(module.fate_lines(full), [
            "5 kept, 0 moved, 1 converted, 0 initialised, 0 dropped",
            "converted Filled : DINT -> INT (retyped)",
            "code Line: follows",
            "task Fast: interval 10 ms",
            "LOSS Filled: 70000 -> 32767: saturates",
            "predicted pause 8.62 us"])

    def test_a_long_report_is_cut(self):
        row = {"variable": "v", "fate": "dropped", "old_type": "INT", "new_type": "", "reason": ""}
        lines = module.fate_lines(report(fates=[row] * 100, code=[]))
        self.assertEqual(len(lines), module.ROWS_SHOWN + 3)
        self.assertEqual(lines[1], "dropped v : INT")
        self.assertEqual(lines[-2], "and 60 more")


if __name__ == "__main__":
    unittest.main()
