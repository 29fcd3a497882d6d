#!/usr/bin/env python3
"""random_chart_text.py SEED: a program whose body is a random chart: steps with actions, alternatives,
simultaneous branches and ways back. Whatever is done is summed up in `sum`."""
import random
import sys

CONDITIONS = ["TRUE", "n MOD 2 = 0", "n MOD 3 <> 1", "n MOD 5 < 2", "sum MOD 2 = 1", "sum MOD 3 = 0"]


class Maker:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.steps = []        # name, actions
        self.transitions = []  # from, to, condition
        self.actions = []
        self.outside = ["S0"]  # steps that a way back may lead to
        self.step("S0")

    def step(self, name=None):
        name = name or f"S{len(self.steps)}"
        done = []
        for _ in range(self.random.randint(0, 3)):
            action = f"A{len(self.actions)}"
            self.actions.append(action)
            qualifier = self.random.choice(["N", "N", "P1", "P0", "P", "L, T#25ms", "D, T#15ms"])
            done.append(f"{action}({qualifier});")
        self.steps.append((name, done))
        return name

    def arrive(self, first, last):
        self.transitions.append((first, last, self.random.choice(CONDITIONS)))

    def way(self, first, last, depth, outside):
        """From step `first` to step `last`."""
        pick = self.random.random()
        if depth == 0 or pick < 0.2:
            self.arrive(first, last)
            return
        if pick < 0.5:
            middle = self.step()
            self.way(first, middle, depth - 1, outside)
            if outside:
                self.outside.append(middle)
            self.way(middle, last, depth - 1, outside)
        elif pick < 0.75:
            for _ in range(self.random.randint(2, 3)):
                self.way(first, last, depth - 1, outside)
            if outside and self.random.random() < 0.5:
                self.arrive(first, self.random.choice(self.outside))
        else:
            count = self.random.randint(2, 3)
            begins = [self.step() for _ in range(count)]
            ends = [self.step() for _ in range(count)]
            self.arrive(first, "(" + ", ".join(begins) + ")")
            for begin, end in zip(begins, ends):
                self.way(begin, end, depth - 1, False)
            self.arrive("(" + ", ".join(ends) + ")", last)


def main(seed):
    maker = Maker(seed)
    last = maker.step()
    maker.way("S0", last, 4, True)
    maker.arrive(last, "S0")
    print("PROGRAM MAIN\nVAR\n  n : INT;\n  sum : UDINT;\nEND_VAR")
    print("  ACTION Count:\n    n := (n + 1) MOD 1000;\n  END_ACTION")
    for number, action in enumerate(maker.actions):
        print(f"  ACTION {action}:\n    sum := sum * 31 + {number + 1};\n  END_ACTION")
    for name, done in maker.steps:
        print(f"  {'INITIAL_STEP' if name == 'S0' else 'STEP'} {name}:")
        for action in (["Count(S);"] if name == "S0" else []) + done:
            print(f"    {action}")
        print("  END_STEP")
    for first, to, condition in maker.transitions:
        print(f"  TRANSITION FROM {first} TO {to} := {condition}; END_TRANSITION")
    print("END_PROGRAM")


main(sys.argv[1])
