#!/usr/bin/env python3
"""random_text_export.py SEED VIEW FOLDER: a program of random networks as CODESYS V2.3 exports them
(VIEW: LD or FBD) in FOLDER/drawn, and what they mean, worked out from the same trees, in FOLDER/text.
The block that some boxes call is in an export of its own."""
import os
import random
import sys

INPUTS = [f"i{n}" for n in range(6)]
OUTPUTS = [f"o{n}" for n in range(10)]
NUMBERS = [f"c{n}" for n in range(4)]
LATCH = """FUNCTION_BLOCK Latch
VAR_INPUT
	open, hold: BOOL;
	step: INT := 3;
END_VAR
VAR_OUTPUT
	q: BOOL;	(* held *)
	seen: INT;
END_VAR
VAR
	last: BOOL;
END_VAR
(* @END_DECLARATION := '0' *)
IF open AND NOT last THEN seen := (seen + step) MOD 1000; END_IF
last := open;
q := open OR (q AND hold);
END_FUNCTION_BLOCK
"""


def sign(negated):
    return "_NEGATIV" if negated else "_POSITIV"


def ends(targets):
    """[(name, negated, set)]"""
    lines = [f"_OUTPUTS : {len(targets)}"]
    for name, negated, sets in targets:
        lines += ["_OUTPUT", sign(negated), "_SET" if sets else "_NO_SET", name or "_EMPTY"]
    return lines


def operand(text, negated=False):
    return ["_OPERAND", "_EXPRESSION", sign(negated), text]


def function(word, *parts, negated=False, enabled=False):
    lines = ["_OPERATOR", f"_BOX_EXPR : {len(parts)}"] + (["_ENABLED"] if enabled else [])
    return lines + sum(parts, []) + ["_EXPRESSION", sign(negated), word]


class Maker:
    """The lines of a tree, the statements in front of it, and its meaning in ST, made together."""

    def __init__(self, seed, ladder):
        self.random = random.Random(seed)
        self.ladder = ladder
        self.plain = ladder and int(seed[:-2]) % 2 == 0  # what has a form as rungs
        self.blocks = []  # instance, type
        self.temps = 0

    def leaf(self):
        name = self.random.choice(INPUTS + OUTPUTS)
        negated = self.random.random() < 0.3
        meaning = ("NOT " if negated else "") + name
        if self.ladder:
            return ["_LD_CONTACT", name, "_EXPRESSION", sign(negated)], [], meaning
        return operand(name, negated), [], meaning

    def compare(self):
        word, mark = self.random.choice([("GT", ">"), ("LE", "<="), ("EQ", "=")])
        number = self.random.randint(0, 7)
        rest = function("MOD", operand("n"), operand("8"))
        return function(word, rest, operand(str(number))), [], f"(n MOD 8 {mark} {number})"

    def call(self, depth):
        """A function block; its further outputs go to numbers that no tree of the network reads."""
        kind = self.random.choice(["R_TRIG", "CTU", "Latch", "SR"])
        name = f"b{len(self.blocks)}"
        self.blocks.append((name, kind))
        lines, before, meaning = self.tree(depth - 1)
        number = self.random.choice(NUMBERS + [""])
        out = [] if kind in ("R_TRIG", "SR") else [(number, False, False)]
        if kind == "R_TRIG":
            pins, call = [lines], f"CLK := {meaning}"
        elif kind == "SR":
            pins, call = [lines, operand("i0", True)], f"S1 := {meaning}, R := NOT i0"
        elif kind == "CTU":
            pins = [lines, operand("i5"), operand("3")]
            call = f"CU := {meaning}, R := i5, PV := 3"
        else:
            hold, more, held = (operand("i1"), [], "i1") if self.plain else self.tree(depth - 1)
            before = before + more
            pins, call = [lines, hold, operand("") if self.ladder else ["_EMPTY"]], f"open := {meaning}, hold := {held}"
        lines = ["_FUNCTIONBLOCK", name, f"_BOX_EXPR : {len(pins)}"] + sum(pins, [])
        lines += ["_EXPRESSION", "_POSITIV", kind] + ends(out)
        before = before + [f"{name}({call});"]
        if out and number:
            before.append(f"{number} := {name}.{'CV' if kind == 'CTU' else 'seen'};")
        return lines, before, f"{name}.{'Q1' if kind == 'SR' else 'Q'}"

    def tree(self, depth):
        pick = self.random.random()
        if depth <= 0 or pick < 0.3:
            return self.leaf()
        if pick < 0.4 and not self.plain:
            return self.compare()
        if pick < 0.5 and len(self.blocks) < 40:
            return self.call(depth)
        word = self.random.choice(["AND", "OR"] if self.ladder else ["AND", "OR", "XOR"])
        parts = [self.tree(depth - 1) for _ in range(self.random.randint(2, 4))]
        if self.plain and word == "AND":  # a block begins a row
            parts[1:] = [self.leaf() if part[1] else part for part in parts[1:]]
        before = sum((part[1] for part in parts), [])
        meaning = "(" + f" {word} ".join(f"({part[2]})" for part in parts) + ")"
        if self.ladder:
            lines = [f"_LD_{word}", f"_LD_OPERATOR : {len(parts)}"]
            return lines + sum((part[0] for part in parts), []) + ["_EXPRESSION", "_POSITIV"], before, meaning
        negated = self.random.random() < 0.2
        return (function(word, *[part[0] for part in parts], negated=negated), before,
                ("NOT " if negated else "") + meaning)

    def targets(self):
        names = self.random.sample(OUTPUTS, self.random.randint(1, 2))
        made = [(name, self.random.random() < 0.3, self.random.random() < 0.4) for name in names]
        lines = []
        for name, negated, sets in made:
            lines.append(f"IF x THEN {name} := {'FALSE' if negated else 'TRUE'}; END_IF" if sets
                         else f"{name} := {'NOT ' if negated else ''}x;")
        return made, lines

    def network(self):
        lines, before, meaning = self.tree(3)
        made, after = self.targets()
        head = ["_NETWORK", "", "_COMMENT", f"'it's {self.random.randint(1, 99)}'", "_END_COMMENT"]
        text = before + [f"x := {meaning};"]
        if not self.ladder:
            return head + ["_ASSIGN"] + lines + ["_EXPRESSION", "_POSITIV"] + ends(made), text + after
        beside = []
        if self.random.random() < 0.3:
            number = self.random.choice(NUMBERS)
            beside = (["_ASSIGN"] + function("ADD", operand(number), operand("1"), enabled=True) +
                      ["_EXPRESSION", "_POSITIV"] + ends([(number, False, False)]))
            text.append(f"IF x THEN {number} := {number} + 1; END_IF")
        count = 1 if beside else 0
        return (head + ["_LD_ASSIGN"] + lines + ["_EXPRESSION", "_POSITIV", "", "", f"ENABLELIST : {count}"] +
                beside + ["ENABLELIST_END"] + ends(made), text + after)


def main(seed, view, folder):
    maker = Maker(f"{seed}{view}", view == "LD")
    made = [maker.network() for _ in range(12)]
    bits = "\n".join(f"i{n} := n.{n};" for n in range(6))
    total = "".join(f"\nsum := sum * 2 + BOOL_TO_UDINT({name});" for name in OUTPUTS)
    total += "".join(f"\nsum := sum * 31 + INT_TO_UDINT({name});" for name in NUMBERS)
    declared = (f"VAR\n\tn, {', '.join(NUMBERS)}: INT;\n\t{', '.join(INPUTS + OUTPUTS)}: BOOL;\n" +
                "".join(f"\t{name}: {kind};\n" for name, kind in maker.blocks) + "\tsum, all: UDINT;\n\tx: BOOL;\n")
    body = f"n := n + 1;\n{bits}\nRungs();\nsum := 0;{total}\nall := all * 31 + sum;\n"
    attributes = "(* @NESTEDCOMMENTS := 'Yes' *)\n(* @PATH := '' *)\n(* @OBJECTFLAGS := '0, 8' *)\n"
    marker = "(* @END_DECLARATION := '0' *)\n"
    drawn = [f"_{view}_BODY", f"_NETWORKS : {len(made)}"] + sum((lines for lines, _ in made), [])
    texts = "\n".join(line for _, lines in made for line in lines)
    program = f"PROGRAM MAIN\n{declared}END_VAR\n{marker}{body}END_PROGRAM\nACTION Rungs:\n"
    for part, text in (
            ("drawn/main.EXP", attributes + program + "\n".join(drawn) + "\nEND_ACTION\n"),
            ("drawn/latch.EXP", attributes + LATCH),
            ("text/main.EXP", attributes + program + texts + "\nEND_ACTION\n"),
            ("text/latch.EXP", attributes + LATCH)):
        path = os.path.join(folder, part)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8", newline="\r\n") as out:
            out.write(text)


main(sys.argv[1], sys.argv[2], sys.argv[3])
