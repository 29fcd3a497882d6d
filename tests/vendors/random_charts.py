#!/usr/bin/env python3
"""random_charts.py SEED FOLDER: a random chart as TwinCAT stores it in FOLDER/drawn, and in FOLDER/text
a program in ST that simulates it: which steps are active, left and entered, and what actions run."""
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from draw_twincat import action, beside, either, jump, pou, step, when

CONDITIONS = ["TRUE", "n MOD 2 = 0", "n MOD 3 <> 1", "n MOD 5 < 2", "sum MOD 2 = 1"]
OWN = (("entry", "EntryAction"), ("main", "MainAction"), ("exit", "ExitAction"))


class Maker:
    """The elements of the editor, and beside them what they mean: steps and transitions. What is
    open behind an element is ("steps", names), which one transition leaves together, or
    ("transitions", numbers), whose next steps are to come."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.steps = []        # names
        self.transitions = []  # [from, condition, to]
        self.actions = []      # (kind, step)

    def chance(self, part):
        return self.random.random() < part

    def step(self, elements, open_, initial=False):
        name = f"S{len(self.steps) + 1}"
        self.steps.append(name)
        own = {"InitStep": True} if initial else {}
        for kind, attribute in OWN:
            if self.chance(0.5):
                own[attribute] = f"{kind}_{name}"
                self.actions.append((kind, name))
        others = []
        if self.chance(0.6):  # an action of the standard, which has a final scan
            others = [(f"iec_{name}", "N"), (f"early_{name}", "N")]  # by name the second one is first
            self.actions += [("iec", name), ("early", name)]
        elements.append(step(name, *others, **own))
        self.enter(open_, name)
        return "steps", [name]

    def enter(self, open_, name):
        if open_[0] == "transitions":
            for number in open_[1]:
                self.transitions[number][2].append(name)

    def transition(self, elements, open_, condition=None):
        condition = condition or self.random.choice(CONDITIONS)
        self.transitions.append([list(open_[1]), condition, []])
        elements.append(when(condition))
        return "transitions", [len(self.transitions) - 1]

    def until(self, kind, elements, open_, depth):
        """Elements up to one behind which `kind` is open."""
        while open_[0] != kind or not self.chance(0.55):
            if open_[0] == "steps" and depth and self.chance(0.35):
                open_ = self.alternatives(elements, open_, depth - 1)
                if not open_[1]:
                    return open_
            elif open_[0] == "steps":
                open_ = self.transition(elements, open_)
            elif depth and self.chance(0.3):
                open_ = self.simultaneous(elements, open_, depth - 1)
            else:
                open_ = self.step(elements, open_)
        return open_

    def alternatives(self, elements, open_, depth):
        ways, numbers = [], []
        for _ in range(self.random.randint(2, 3)):
            way = []
            end = self.transition(way, open_)
            if self.chance(0.25):
                way.append(jump(self.steps[0]))
                self.enter(end, self.steps[0])
                end = ("transitions", [])
            elif self.chance(0.6):
                end = self.until("transitions", way, self.step(way, end), depth)
            ways.append(way)
            numbers += end[1]
        elements.append(either(*ways))
        return "transitions", numbers

    def simultaneous(self, elements, open_, depth):
        ways, names = [], []
        for _ in range(2):
            way = []
            end = self.until("steps", way, self.step(way, open_), depth)
            ways.append(way)
            names += end[1] if end[0] == "steps" else []
        elements.append(beside(*ways))
        return "steps", names

    def chart(self):
        elements = []
        open_ = self.step(elements, ("steps", []), initial=True)
        for _ in range(self.random.randint(1, 3)):
            open_ = self.until("transitions", elements, open_, 2)
            if not open_[1]:
                return elements
            open_ = self.step(elements, open_)
        open_ = self.transition(elements, open_, "TRUE")
        elements.append(jump(self.steps[0]))
        self.enter(open_, self.steps[0])
        return elements


def simulation(maker, bodies):
    """One scan: transitions see the steps of before, then exits, then entries, then actions of active
    steps, each in the order of the chart, then the actions of the standard in the order of their
    names, final scans first."""
    lines = ["n := n + 1;"]
    for name in maker.steps:
        lines.append(f"left_{name} := FALSE; came_{name} := FALSE;")
    first = maker.steps[0]
    lines.append(f"IF started THEN")
    for from_, condition, to in maker.transitions:
        ready = " AND ".join(f"on_{name} AND NOT left_{name}" for name in from_)
        lines.append(f"IF {ready} AND ({condition}) THEN")
        lines += [f"left_{name} := TRUE;" for name in from_] + [f"came_{name} := TRUE;" for name in to]
        lines.append("END_IF")
    lines.append(f"ELSE came_{first} := TRUE; started := TRUE; END_IF")
    for name in maker.steps:
        lines.append(f"was_{name} := on_{name}; on_{name} := (on_{name} AND NOT left_{name}) OR came_{name};")
    def run(wanted, condition, order=lambda name: 0):
        for kind, name in sorted(maker.actions, key=lambda one: order(one[1])):
            if kind == wanted:
                lines.append(f"IF {condition.replace('*', name)} THEN {bodies[kind, name]} END_IF")

    run("exit", "left_*")
    run("entry", "came_*")
    run("main", "on_*")
    for condition in ("was_* AND NOT on_*", "on_*"):
        run("early", condition, str)
        run("iec", condition, str)
    flags = ", ".join(f"{flag}_{name}" for name in maker.steps for flag in ("on", "was", "left", "came"))
    return (f"PROGRAM MAIN\nVAR\n  n : INT;\n  sum : UDINT;\n  started, {flags} : BOOL;\nEND_VAR\n" +
            "\n".join(lines) + "\nEND_PROGRAM\n")


def main(seed, folder):
    maker = Maker(seed)
    elements = maker.chart()
    bodies = {one: f"sum := sum * 31 + {7 * number + 3};" for number, one in enumerate(maker.actions)}
    members = [action(f"{kind}_{name}", bodies[kind, name]) for kind, name in maker.actions]
    maker.random.shuffle(members)  # where they stand in the file says nothing
    chart = pou("FB_Chart", "FUNCTION_BLOCK FB_Chart\nVAR_IN_OUT\n\tn : INT;\n\tsum : UDINT;\nEND_VAR\n", "SFC",
                elements, members=members)
    program = pou("MAIN", "PROGRAM MAIN\nVAR\n\tn : INT;\n\tsum : UDINT;\n\tchart : FB_Chart;\nEND_VAR\n", "ST",
                  "n := n + 1;\nchart(n := n, sum := sum);")
    for part, text in (("drawn/FB_Chart.TcPOU", chart), ("drawn/MAIN.TcPOU", program),
                       ("text/MAIN.st", simulation(maker, bodies))):
        path = os.path.join(folder, part)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8", newline="\n") as out:
            out.write(text)


main(sys.argv[1], sys.argv[2])
