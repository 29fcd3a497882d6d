#!/usr/bin/env python3
"""random_twincat.py SEED VIEW FOLDER: a program of random networks as TwinCAT stores them (VIEW: Ld or
Fbd) in FOLDER/drawn, and what they mean, worked out from the same trees, in FOLDER/text."""
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from draw_twincat import (NEGATED, RESET, SET, RAIL, box, parallel, pou, to, val, var, wire)

INPUTS = [f"i{n}" for n in range(6)]
OUTPUTS = [f"o{n}" for n in range(10)]


class Maker:
    """A tree and its meaning in ST, made together."""

    def __init__(self, seed, ladder):
        self.random = random.Random(seed)
        self.ladder = ladder
        self.wires = 0
        self.inside = 0   # ways of branches
        self.known = []   # of this network: number, meaning
        self.before = []  # trees that define wires

    def tree(self, depth):
        pick = self.random.random()
        if depth == 0 or pick < 0.25:
            name = self.random.choice(INPUTS + OUTPUTS)
            negated = self.random.random() < 0.3
            return var(name, flags=NEGATED if negated else 0), ("NOT " if negated else "") + name
        if pick < 0.33 and self.known:
            number, meaning = self.random.choice(self.known)
            return wire(number), meaning
        if pick < 0.36:
            text = self.random.choice(["TRUE", "FALSE"])
            return val(text, "BOOL"), text
        if pick < 0.40 and self.ladder and not self.inside:
            return RAIL, "TRUE"  # in a way of a branch it stands for what feeds that
        if pick < 0.55 and self.ladder:
            feed = self.tree(depth - 1) if self.random.random() < 0.6 else (None, "TRUE")
            self.inside += 1
            ways = [self.tree(depth - 1) for _ in range(self.random.randint(1, 3))]
            self.inside -= 1
            either = " OR ".join(f"({meaning})" for _, meaning in ways)
            return parallel(feed[0], *[way for way, _ in ways]), f"({feed[1]}) AND ({either})"
        if pick < 0.62:
            below, meaning = self.tree(depth - 1)
            return box("NOT", below), f"NOT ({meaning})"
        if pick < 0.70:
            number = self.random.randint(0, 7)
            return (box("EQ", box("MOD", val("n"), val("8")), val(str(number))), f"(n MOD 8 = {number})")
        word = self.random.choice(["AND", "OR", "AND", "OR", "XOR"])
        parts = [self.tree(depth - 1) for _ in range(self.random.randint(2, 4))]
        negated = self.random.random() < 0.15
        marks = None
        meanings = [f"({meaning})" for _, meaning in parts]
        if self.random.random() < 0.15:
            marks = tuple(self.random.choice([0, NEGATED]) for _ in parts)
            meanings = [f"NOT {m}" if mark else m for m, mark in zip(meanings, marks)]
        meaning = f" {word} ".join(meanings)
        return (box(word, *[part for part, _ in parts], flags=NEGATED if negated else 0, marks=marks),
                f"NOT ({meaning})" if negated else meaning)

    def network(self):
        """The trees of one, and its statements: values are read where they stand, so a wire is
        worked out once."""
        self.known = []
        trees, lines = [], []
        for _ in range(self.random.randint(0, 2)):
            self.wires += 1
            below, meaning = self.tree(2)
            trees.append(wire(self.wires, below))
            lines.append(f"w{self.wires} := {meaning};")
            self.known.append((self.wires, f"w{self.wires}"))
        for _ in range(self.random.randint(1, 2)):
            below, meaning = self.tree(3)
            targets = self.random.sample(OUTPUTS, self.random.randint(1, 2))
            kinds = [self.random.choice([0, 0, NEGATED, SET, RESET]) for _ in targets]
            trees.append(to([var(name, flags=kind if kind != RESET else NEGATED | SET)
                             for name, kind in zip(targets, kinds)], below))
            lines.append(f"x := {meaning};")
            for name, kind in zip(targets, kinds):
                lines.append({0: f"{name} := x;", NEGATED: f"{name} := NOT x;",
                              SET: f"IF x THEN {name} := TRUE; END_IF",
                              RESET: f"IF x THEN {name} := FALSE; END_IF"}[kind])
        return trees, lines


def main(seed, view, folder):
    maker = Maker(f"{seed}{view}", view == "Ld")
    made = [maker.network() for _ in range(12)]
    bits = "\n".join(f"i{n} := n.{n};" for n in range(6))
    total = "".join(f"\nsum := sum * 2 + BOOL_TO_UDINT({name});" for name in OUTPUTS)
    declared = (f"VAR\n\tn : INT;\n\t{', '.join(INPUTS + OUTPUTS)} : BOOL;\n\tsum, all : UDINT;\n")
    work = "".join(f"w{n + 1}, " for n in range(maker.wires))
    texts = "\n".join(line for _, lines in made for line in lines)
    main_text = f"n := n + 1;\n{bits}\nRungs();\nsum := 0;{total}\nall := all * 31 + sum;"
    action = [("Action", "Rungs", "", view, [trees for trees, _ in made])]
    for part, text in (("drawn/MAIN.TcPOU", pou("MAIN", f"PROGRAM MAIN\n{declared}END_VAR\n", "ST", main_text,
                                                  action)),
                       ("text/MAIN.st", f"PROGRAM MAIN\n{declared}\t{work}x : BOOL;\nEND_VAR\nACTION Rungs:\n"
                                        f"{texts}\nEND_ACTION\n{main_text}\nEND_PROGRAM\n")):
        path = os.path.join(folder, part)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8", newline="\n") as out:
            out.write(text)


main(sys.argv[1], sys.argv[2], sys.argv[3])
