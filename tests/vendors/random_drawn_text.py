#!/usr/bin/env python3
"""random_drawn_text.py SEED LANGUAGE [EDIT]: a random program whose body is drawn as text (LD or FBD) or
made of instructions (IL), with edges, jumps, returns, timers, counters, a block with an in-out and a
configuration. The numbers that it writes are summed up in `sum`. With EDIT it has networks more, which
write variables of their own only, so that `sum` stays what it is."""
import random
import sys

INPUTS = [f"i{n}" for n in range(6)]
OUTPUTS = [f"o{n}" for n in range(8)]
NUMBERS = [f"c{n}" for n in range(4)]
PARTS = """FUNCTION_BLOCK Adder
VAR_INPUT go : BOOL; step : INT := 2; END_VAR
VAR_IN_OUT total : INT; END_VAR
VAR_OUTPUT full : BOOL; END_VAR
  IF go THEN total := (total + step) MOD 500; END_IF;
  full := total MOD 4 = 0;
END_FUNCTION_BLOCK
"""


class Maker:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.instances = []  # name, type
        self.labels = 0
        self.extra = None  # the random numbers of the edit
        self.extra_instances = []
        self.extras = 0

    def chance(self, share):
        return self.random.random() < share

    def bit(self):
        return self.random.choice(INPUTS + OUTPUTS)

    def number(self):
        return self.random.choice(NUMBERS)

    def instance(self, kind):
        self.instances.append((f"{'e' if self.random is self.extra else 'b'}{len(self.instances)}", kind))
        return self.instances[-1][0]

    def swap(self):
        """An extra network by its own random numbers, which writes own variables only."""
        mine = (self.random, self.instances)
        self.random, self.instances = self.extra, self.extra_instances
        made = None
        if self.random.random() < 0.35:
            made = self.extra_network()
        self.random, self.instances = mine
        return made

    def own(self, kind):
        self.extras += 1
        return f"{kind}{self.extras}"

    def label(self):
        self.labels += 1
        return f"L{self.labels}"

    def parts(self, make, count):
        """`count` networks; from some of them a jump leads over the next ones, and from some back,
        as often as `rounds` lasts."""
        out, waiting = [], []
        for number in range(count):
            out += [(None, each[1]) for each in waiting if each[0] == number]
            waiting = [each for each in waiting if each[0] != number]
            pick = self.random.random()
            if pick < 0.12:
                name = self.label()
                waiting.append((number + self.random.randint(1, 3), name))
                out.append((make("jump", name), None))
            elif pick < 0.16:
                out.append((make("return", None), None))
            elif pick < 0.22:
                name = self.label()
                out.append((None, name))
                out.append((make("network", None), None))
                out.append((make("back", name), None))
            else:
                out.append((make("network", None), None))
        out += [(None, each[1]) for each in waiting]
        if self.extra is None:
            return out
        more = []
        for part in out:
            made = self.swap()
            # Not between a label and its network, nor in front of a jump back.
            if made is not None and not (more and more[-1][0] is None):
                more.append((made, None))
            more.append(part)
        return more


class Ladder(Maker):
    """A tree is rows of one width; power goes along the first one."""

    def contact(self):
        if self.chance(0.15):
            return [f"[ {self.number()} MOD 8 {self.random.choice(['>', '<=', '='])} {self.random.randint(0, 7)} ]"]
        mark = self.random.choice(["", "", "", "/", "P", "N"])
        return [f"[{mark} {self.bit()} ]"]

    def box(self):
        pick = self.random.random()
        if pick < 0.25:
            name = self.instance("CTU")
            return [f"[ {name}: CTU CU:=_, R:={self.bit()}, PV:={self.random.randint(1, 5)}, CV=>{self.number()} ]"]
        if pick < 0.5:
            kind = self.random.choice(["TON", "TOF", "TP"])
            return [f"[ {self.instance(kind)}: {kind} IN:=_, PT:=T#{self.random.randint(5, 45)}ms ]"]
        if pick < 0.65:
            kind = self.random.choice(["R_TRIG", "F_TRIG"])
            return [f"[ {self.instance(kind)}: {kind} CLK:=_ ]"]
        if pick < 0.8:
            return [f"[ {self.instance('Adder')}: Adder go:=_, step:={self.random.randint(1, 9)}, "
                    f"total:={self.number()}, full=>_ ]"]
        if pick < 0.9:
            return [f"[ {self.number()} := ADD({self.number()}, {self.random.randint(1, 9)}) ]"]
        return [f"[ {self.random.choice(['AND', 'OR', 'XOR'])}(_, {self.bit()}) ]"]

    def series(self, parts):
        height = max(len(part) for part in parts)
        rows = []
        for row in range(height):
            cells = [part[row] if row < len(part) else " " * len(part[0]) for part in parts]
            rows.append(("--" if row == 0 else "  ").join(cells))
        return rows

    def parallel(self, parts):
        width = max(len(part[0]) for part in parts)
        rows = []
        for index, part in enumerate(parts):
            if rows and any(above == below == "+" for above, below in zip(rows[-1][3:-3], part[0])):
                rows.append("|" + " " * (width + 4) + "|")  # what stands above each other would be joined
            rows.append("+--" + part[0].ljust(width, "-") + "--+")
            last = index == len(parts) - 1
            side = " " if last else "|"
            rows += [side + "  " + row.ljust(width) + "  " + side for row in part[1:]]
        return rows

    def tree(self, depth):
        pick = self.random.random()
        if depth == 0 or pick < 0.3:
            return self.contact()
        if pick < 0.42 and len(self.instances) < 40:
            return self.box()
        parts = [self.tree(depth - 1) for _ in range(self.random.randint(2, 3))]
        return self.series(parts) if pick < 0.75 else self.parallel(parts)

    def coils(self):
        count = self.random.randint(1, 3)
        return [f"({self.random.choice(['', '', '', '/', 'S', 'R', 'P', 'N'])} {name} )"
                for name in self.random.sample(OUTPUTS, count)]

    def rung(self, what, name):
        if what == "network":
            made = self.series([self.tree(3)] + [[coil] for coil in self.coils()])
        elif what == "back":
            made = self.series([["[ rounds > 0 ]"], ["[ rounds := rounds - 1 ]"], [f"( JMP {name} )"]])
        else:
            made = self.series([self.tree(1), [f"( JMP {name} )" if what == "jump" else "( RETURN )"]])
        return "\n".join(("  |--" if row == 0 else "  |  ") + text.rstrip() + ("--|" if row == 0 else "")
                         for row, text in enumerate(made))

    def extra_network(self):
        tree = self.extra_tree()
        coils = [[f"({self.random.choice(['', '/', 'S', 'P', 'N'])} {self.own('x')} )"]]
        made = self.series([tree] + coils)
        return "\n".join(("  |--" if row == 0 else "  |  ") + text.rstrip() + ("--|" if row == 0 else "")
                         for row, text in enumerate(made))

    def extra_tree(self):
        parts = [self.contact() for _ in range(self.random.randint(1, 2))]
        pick = self.random.random()
        if pick < 0.2:
            parts.append([f"[ {self.instance('CTU')}: CTU CU:=_, R:={self.bit()}, PV:=3, CV=>{self.own('y')} ]"])
        elif pick < 0.4:
            parts.append([f"[ {self.instance('TON')}: TON IN:=_, PT:=T#20ms ]"])
        elif pick < 0.5:
            parts.append([f"[ {self.own('y')} := ADD({self.number()}, 1) ]"])
        return self.series(parts) if self.random.random() < 0.6 else self.parallel(parts[:1] + [self.contact()])

    def body(self):
        out = []
        for network, name in self.parts(self.rung, 14):
            out.append(f"{name}:" if network is None else network + "\n")
        return "LADDER\n" + "\n".join(out) + "\nEND_LADDER"


class Diagram(Maker):
    def extra_network(self):
        lines, known = [], []
        pick = self.random.random()
        if pick < 0.5:
            wire = f"v{self.random.randint(0, 10 ** 9)}"
            lines.append(f"WIRE {wire} := AND({self.pin([])}, {self.pin([])});")
            known.append(wire)
        else:
            kind = self.random.choice(["TON", "R_TRIG"])
            name = self.instance(kind)
            lines.append(f"{name} : {kind}({'IN' if kind == 'TON' else 'CLK'} := {self.pin([])}" +
                         (", PT := T#20ms);" if kind == "TON" else ");"))
            known.append(f"{name}.Q")
        lines.append(f"{self.own('x')} {self.random.choice([':=', 'S='])} {known[0]};")
        return "\n".join(lines)

    def pin(self, known):
        text = self.random.choice(known + INPUTS + OUTPUTS)
        return ("NOT " if self.chance(0.25) else "") + text

    def network(self, what, name):
        if what == "back":
            return ("WIRE more := GT(rounds, 0);\nrounds := SUB(rounds, 1);\n"
                    f"JMP {name} IF more;".replace("more", f"more_{name}"))
        lines, known = [], []
        for _ in range(self.random.randint(1, 4)):
            lines += self.row(known)
        if what == "jump":
            lines.append(f"JMP {name} IF {self.pin(known)};")
        elif what == "return":
            lines.append(f"RETURN IF {self.pin(known)};")
        else:
            for target in self.random.sample(OUTPUTS, self.random.randint(1, 2)):
                lines.append(f"{target} {self.random.choice([':=', ':=', 'S=', 'R='])} {self.pin(known)};")
        return "\n".join(lines)

    def row(self, known):
        pick = self.random.random()
        wire = f"w{self.random.randint(0, 10 ** 9)}"
        if pick < 0.4:
            word = self.random.choice(["AND", "OR", "XOR"])
            pins = ", ".join(self.pin(known) for _ in range(self.random.randint(2, 4)))
            known.append(wire)
            return [f"WIRE {wire} := {word}({pins});"]
        if pick < 0.5:
            word = self.random.choice(["GT", "LE", "EQ"])
            known.append(wire)
            return [f"WIRE {wire} := {word}({self.number()}, {self.random.randint(0, 9)});"]
        if pick < 0.6:
            target = self.number()
            return [f"{target} := ADD({self.number()}, {self.random.randint(1, 9)});"]
        if pick < 0.72:
            name = self.instance("CTU")
            known.append(f"{name}.Q")
            return [f"{name} : CTU(CU := {self.pin(known[:-1])}, R := {self.pin(known[:-1])}, "
                    f"PV := {self.random.randint(1, 5)});", f"{self.number()} := {name}.CV;"]
        if pick < 0.86:
            kind = self.random.choice(["TON", "TOF", "TP"])
            name = self.instance(kind)
            known.append(f"{name}.Q")
            return [f"{name} : {kind}(IN := {self.pin(known[:-1])}, PT := T#{self.random.randint(5, 45)}ms);"]
        name = self.instance("Adder")
        known.append(f"{name}.full")
        return [f"{name} : Adder(go := {self.pin(known[:-1])}, step := {self.random.randint(1, 9)}, "
                f"total := {self.number()});"]

    def body(self):
        out = ["{network}"]
        for network, name in self.parts(self.network, 14):
            out += [f"{name}:"] if network is None else [network, "{network}"]
        return "FBD\n" + "\n".join(out[:-1] if out[-1] == "{network}" else out) + "\nEND_FBD"


class Instructions(Maker):
    def extra_network(self):
        lines = self.value()
        lines.append(f"{self.random.choice(['ST', 'STN', 'S'])} {self.own('x')}")
        if self.random.random() < 0.4:
            made = self.instance("TON")
            lines += [f"ST {made}.IN", f"CAL {made}(PT := T#20ms)", f"LD {made}.Q", f"ST {self.own('x')}"]
        return lines

    def value(self):
        """Instructions that leave a BOOL as the current result."""
        lines = [f"LD{self.random.choice(['', 'N'])} {self.bit()}"]
        for _ in range(self.random.randint(0, 4)):
            word = self.random.choice(["AND", "OR", "XOR"]) + self.random.choice(["", "N"])
            if self.chance(0.2):
                lines += [f"{word}( {self.bit()}", f"OR {self.bit()}", ")"]
            elif self.chance(0.15):
                lines += [f"{word.rstrip('N') if word != 'AND' else word}( {self.number()}", "MOD 8",
                          f"GT {self.random.randint(0, 7)}", ")"]
            else:
                lines.append(f"{word} {self.bit()}")
        return lines

    def network(self, what, name):
        if what == "back":
            return ["LD rounds", "SUB 1", "ST rounds", "LD rounds", "GT 0", f"JMPC {name}"]
        lines = self.value()
        if what == "jump":
            return lines + [f"JMP{self.random.choice(['C', 'CN'])} {name}"]
        if what == "return":
            return lines + [f"RET{self.random.choice(['C', 'CN'])}"]
        for target in self.random.sample(OUTPUTS, self.random.randint(1, 2)):
            lines.append(f"{self.random.choice(['ST', 'ST', 'STN', 'S', 'R'])} {target}")
        pick = self.random.random()
        if pick < 0.2:
            made = self.instance("CTU")
            lines += [f"ST {made}.CU", f"CAL {made}(R := {self.bit()}, PV := {self.random.randint(1, 5)})",
                      f"LD {made}.CV", f"ST {self.number()}"]
        elif pick < 0.4:
            kind = self.random.choice(["TON", "TOF", "TP"])
            made = self.instance(kind)
            lines += [f"ST {made}.IN", f"CAL {made}(PT := T#{self.random.randint(5, 45)}ms)", f"LD {made}.Q",
                      f"ST {self.random.choice(OUTPUTS)}"]
        elif pick < 0.6:
            made = self.instance("Adder")
            lines += [f"ST {made}.go", f"CAL {made}(step := {self.random.randint(1, 9)}, total := {self.number()})",
                      f"LD {made}.full", f"ST {self.random.choice(OUTPUTS)}"]
        elif pick < 0.7:
            number = self.number()
            lines += [f"LD {number}", f"ADD {self.random.randint(1, 9)}", f"ST {number}"]
        return lines

    def body(self):
        out = []
        for network, name in self.parts(self.network, 14):
            out += [f"{name}:"] if network is None else ["  " + line for line in network]
        return "\n".join(out)


KINDS = {"LD": Ladder, "FBD": Diagram, "IL": Instructions}


def main(seed, language, edit=None):
    maker = KINDS[language](f"{seed}{language}")
    if edit:
        maker.extra = random.Random(f"edit{edit}")
    body = maker.body()
    print(PARTS)
    print("PROGRAM Drawn\nVAR_EXTERNAL")
    print(f"  {', '.join(INPUTS + OUTPUTS)} : BOOL;\n  {', '.join(NUMBERS)}, rounds : INT;\nEND_VAR\nVAR")
    for n in range(1, maker.extras + 1):
        print(f"  x{n} : BOOL; y{n} : UINT;")
    for name, kind in maker.instances + maker.extra_instances:
        print(f"  {name} : {kind};")
    print(f"  none : BOOL;\nEND_VAR\n{body}\nEND_PROGRAM\n")
    print("PROGRAM MAIN\nVAR_EXTERNAL")
    print(f"  {', '.join(INPUTS + OUTPUTS)} : BOOL;\n  {', '.join(NUMBERS)}, rounds : INT;\n  n : INT;\n  sum : UDINT;\nEND_VAR")
    print("  n := n + 1;\n  rounds := 3;")
    for number, name in enumerate(INPUTS):
        print(f"  {name} := n.{number};")
    print("END_PROGRAM\nPROGRAM Total\nVAR_EXTERNAL")
    print(f"  {', '.join(INPUTS + OUTPUTS)} : BOOL;\n  {', '.join(NUMBERS)} : INT;\n  sum : UDINT;\nEND_VAR")
    for name in OUTPUTS:
        print(f"  sum := sum * 2 + BOOL_TO_UDINT({name});")
    for name in NUMBERS:
        print(f"  sum := sum * 31 + INT_TO_UDINT({name});")
    print("END_PROGRAM\nCONFIGURATION Plant\nVAR_GLOBAL")
    print(f"  {', '.join(INPUTS + OUTPUTS)} : BOOL;\n  {', '.join(NUMBERS)}, rounds, n : INT;\n  sum : UDINT;\nEND_VAR")
    print("RESOURCE Cpu ON PLC\n  TASK Fast(INTERVAL := T#10ms, PRIORITY := 1);\n"
          "  TASK Slow(INTERVAL := T#20ms, PRIORITY := 2);\n  PROGRAM First WITH Fast : MAIN;\n"
          "  PROGRAM Second WITH Fast : Drawn;\n  PROGRAM Third WITH Slow : Total;\nEND_RESOURCE\nEND_CONFIGURATION")


main(*sys.argv[1:])
