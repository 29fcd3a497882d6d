#!/usr/bin/env python3
"""Projects as the editors of Beremiz and OpenPLC store them (PLCopen TC6 2.01), made from the short
notation of beremiz_cases.txt: draw_beremiz.py FOLDER writes a NAME.xml for each project there.

A project is `project NAME`, types and POUs in their declarations, and bodies behind a line that names
the language: ST and IL as text; LD, a rung a line; FBD, a statement a line; SFC, an element a line.

LD    start (a | b) /c >d <e [TON t IN Q PT=T#1s ET:v] -> coil, /coil, S:coil, R:coil, >coil, <coil
      `/` negated, `>` and `<` edges; of a box: type, instance if it has one, pin of the power that
      comes (- none), pin of that which goes on, inputs `=`, outputs `:`. No coil: the box ends it.
FBD   a, S:b := AND(x, /y, t.Q)   t:TON(IN=x, PT=T#1s)   @wire := NODE   $n = NODE   {2} in front of a
      box or a variable: its executionOrderId. `@wire` as a value is a continuation, `$n` that box
      once more, `x^` a variable that is read where it is written (inOutVariable): `x^ := NODE`.
SFC   step NAME [: QUALIFIER[,TIME] ACTION | QUALIFIER { ST }]..., when CONDITION, when =NAME (of a
      transition), when << RUNG or NODE (a wire), jump NAME; either, beside, or, end for branches.
      when (N) gives a priority.
//    a comment that stands there
"""
import os
import re
import sys
from xml.sax.saxutils import escape, quoteattr

ELEMENTARY = set("BOOL BYTE WORD DWORD LWORD SINT INT DINT LINT USINT UINT UDINT ULINT REAL LREAL TIME "
                 "DATE TOD DT".split())
# Pins of what the editors know: inputs and outputs in their order.
BLOCKS = {
    "TON": ("IN PT", "Q ET"), "TOF": ("IN PT", "Q ET"), "TP": ("IN PT", "Q ET"), "R_TRIG": ("CLK", "Q"),
    "F_TRIG": ("CLK", "Q"), "CTU": ("CU R PV", "Q CV"), "CTD": ("CD LD PV", "Q CV"),
    "CTUD": ("CU CD R LD PV", "QU QD CV"), "SR": ("S1 R", "Q1"), "RS": ("S R1", "Q1"),
    "SEL": ("G IN0 IN1", "OUT"), "LIMIT": ("MN IN MX", "OUT"), "MUX": ("K IN0 IN1 IN2 IN3", "OUT"),
    "SHL": ("IN N", "OUT"), "SHR": ("IN N", "OUT"), "ROL": ("IN N", "OUT"), "LEN": ("IN", "OUT"),
    "NOT": ("IN", "OUT"), "ABS": ("IN", "OUT"), "SQRT": ("IN", "OUT"), "MOVE": ("IN", "OUT"),
    "LEFT": ("IN L", "OUT"), "MID": ("IN L P", "OUT"), "HYSTERESIS": ("XIN1 XIN2 EPS", "Q"),
    "INTEGRAL": ("RUN R1 XIN X0 CYCLE", "Q XOUT"), "PID": ("AUTO PV SP X0 KP TR TD CYCLE", "XOUT"),
}


def tag(name, attributes=(), children=None):
    return (name, list(attributes), children if children is not None else [])


def render(node, depth, out):
    name, attributes, children = node
    pad = "  " * depth
    head = pad + "<" + name + "".join(f" {key}={quoteattr(str(value))}" for key, value in attributes)
    if isinstance(children, str):
        body = f"<![CDATA[{children}]]>" if name == "xhtml:p" else escape(children)
        out.append(f"{head}>{body}</{name}>")
    elif not children:
        out.append(head + "/>")
    else:
        out.append(head + ">")
        for child in children:
            render(child, depth + 1, out)
        out.append(f"{pad}</{name}>")


def point(x, y, name="position"):
    return tag(name, [("x", x), ("y", y)])


def words(text, name="documentation"):
    return tag(name, (), [tag("xhtml:p", (), text)])


# --- declarations

def type_of(text):
    text = text.strip()
    array = re.fullmatch(r"ARRAY\s*\[(.*)\]\s*OF\s+(.*)", text, re.S)
    if array:
        bounds = [part.split("..") for part in array[1].split(",")]
        return tag("array", (), [tag("dimension", [("lower", a.strip()), ("upper", b.strip())])
                                 for a, b in bounds] + [tag("baseType", (), [type_of(array[2])])])
    string = re.fullmatch(r"(STRING|WSTRING)(?:\[(\d+)\])?", text)
    if string:
        return tag(string[1].lower(), [("length", string[2])] if string[2] else ())
    if text in ELEMENTARY:
        return tag(text)
    return tag("derived", [("name", text)])


def split_top(text, mark):
    parts, depth, quoted, now = [], 0, False, ""
    for c in text:
        if c == "'":
            quoted = not quoted
        if not quoted:
            depth += c in "([{"
            depth -= c in ")]}"
        if c == mark and depth == 0 and not quoted:
            parts.append(now.strip())
            now = ""
        else:
            now += c
    return parts + [now.strip()] if now.strip() else parts


def initial(text):
    text = text.strip()
    if text.startswith("["):
        parts = [re.fullmatch(r"(?:(\d+)\()?(.*?)(?(1)\))", part, re.S) for part in split_top(text[1:-1], ",")]
        return tag("arrayValue", (), [tag("value", [("repetitionValue", part[1])] if part[1] else (),
                                          [initial(part[2])]) for part in parts])
    if text.startswith("("):
        fields = [part.split(":=", 1) for part in split_top(text[1:-1], ",")]
        return tag("structValue", (), [tag("value", [("member", a.strip())], [initial(b)]) for a, b in fields])
    return tag("simpleValue", [("value", text)])


def variables(text):
    """`a, b : INT := 2; // remark`, one declaration a line."""
    out = []
    for line in text:
        found = re.fullmatch(r"\s*([\w, ]+?)(?:\s+AT\s+(%\S+))?\s*:\s*(.*?)(?:\s*:=\s*(.*?))?;\s*(?://\s*(.*))?", line)
        if not found:
            raise ValueError(f"no declaration: {line}")
        names, address, type_, value, remark = found.groups()
        for name in names.split(","):
            children = [tag("type", (), [type_of(type_)])]
            if value:
                children.append(tag("initialValue", (), [initial(value)]))
            if remark:
                children.append(words(remark))
            out.append(tag("variable", [("name", name.strip())] + ([("address", address)] if address else []),
                           children))
    return out


LISTS = {"VAR": "localVars", "VAR_INPUT": "inputVars", "VAR_OUTPUT": "outputVars", "VAR_IN_OUT": "inOutVars",
         "VAR_EXTERNAL": "externalVars", "VAR_TEMP": "tempVars", "VAR_GLOBAL": "globalVars"}


def data_type(name, text):
    """`TYPE name : ...;` of one line."""
    text, _, value = text.partition(":=") if ":=" in text and not text.startswith("STRUCT") else (text, "", "")
    text = text.strip()
    if text.startswith("("):
        base = tag("enum", (), [tag("values", (), [tag("value", [("name", one.strip())])
                                                   for one in text[1:-1].split(",")])])
    elif text.startswith("STRUCT"):
        fields = [one + ";" for one in text[6:].split("END_STRUCT")[0].split(";") if one.strip()]
        base = tag("struct", (), variables(fields))
    elif re.fullmatch(r"\w+\s*\(.*\)", text):
        of, low, high = re.fullmatch(r"(\w+)\s*\((.*)\.\.(.*)\)", text).groups()
        base = tag("subrangeUnsigned" if of.startswith("U") else "subrangeSigned", (), [
            tag("range", [("lower", low.strip()), ("upper", high.strip())]),
            tag("baseType", (), [type_of(of)])])
    else:
        base = type_of(text)
    children = [tag("baseType", (), [base])]
    if value:
        children.append(tag("initialValue", (), [initial(value)]))
    return tag("dataType", [("name", name)], children)


# --- elements of drawings

class Pin:
    """An input or output of an element, with its place within it."""

    def __init__(self, owner, name, x, y):
        self.owner, self.name, self.x, self.y = owner, name, x, y

    def place(self):
        return self.owner.x + self.x, self.owner.y + self.y


class Element:
    def __init__(self, drawing, kind, width, height, x, y):
        drawing.elements.append(self)
        self.drawing, self.kind, self.id = drawing, kind, drawing.new_id()
        self.width, self.height, self.x, self.y = width, height, x, y
        self.attributes, self.front, self.back = [], [], []
        self.inputs, self.outputs = {}, {}
        self.order = 0
        self.negated, self.edges = set(), {}

    def input(self, name, y):
        self.inputs[name] = (Pin(self, name, 0, y), [])

    def output(self, name, y):
        self.outputs[name] = Pin(self, name, self.width, y)

    def join(self, name, *sources):
        self.inputs[name][1].extend(sources)

    def point_in(self, name, with_name=False):
        pin, sources = self.inputs[name]
        children = [point(pin.x, pin.y, "relPosition")]
        for source in sources:
            x, y = pin.place()
            at, up = source.place()
            way = [point(x, y)]
            if up != y:
                way += [point(x - 10, y), point(x - 10, up)]
            way.append(point(at, up))
            named = [("formalParameter", source.name)] if source.owner.kind == "block" else []
            children.append(tag("connection", [("refLocalId", source.owner.id)] + named, way))
        return tag("connectionPointIn", [("formalParameter", "")] if with_name else (), children)

    def point_out(self, name, formal=False):
        pin = self.outputs[name]
        return tag("connectionPointOut", [("formalParameter", "")] if formal else (),
                   [point(pin.x, pin.y, "relPosition")])

    def modifiers(self, name):
        out = [("negated", "true")] if name in self.negated else []
        return out + ([("edge", self.edges[name])] if name in self.edges else [])

    def xml(self):
        head = [("localId", self.id)] + self.attributes
        if self.kind not in ("comment", "step", "transition", "jumpStep", "actionBlock",
                             "selectionDivergence", "selectionConvergence", "simultaneousDivergence",
                             "simultaneousConvergence", "connector", "continuation"):
            head.append(("executionOrderId", self.order))
        head += [("height", self.height), ("width", self.width)]
        children = [point(self.x, self.y)]
        if self.kind == "block":
            children += [
                tag("inputVariables", (), [tag("variable", [("formalParameter", name)] + self.modifiers(name),
                                               [self.point_in(name)]) for name in self.inputs]),
                tag("inOutVariables"),
                tag("outputVariables", (), [tag("variable", [("formalParameter", name)], [self.point_out(name)])
                                            for name in self.outputs])]
        elif self.kind == "leftPowerRail":
            children += [self.point_out(name, True) for name in self.outputs]
        elif self.kind == "rightPowerRail":
            children += [self.point_in(name) for name in self.inputs]
        elif self.kind in ("selectionDivergence", "simultaneousDivergence"):
            children += [self.point_in(name) for name in self.inputs]
            children += [self.point_out(name, True) for name in self.outputs]
        elif self.kind == "step":
            children += [self.point_in(name) for name in self.inputs]
            children.append(self.point_out("", True))
            if "action" in self.outputs:
                pin = self.outputs["action"]
                children.append(tag("connectionPointOutAction", [("formalParameter", "")],
                                    [point(pin.x, pin.y, "relPosition")]))
        elif self.kind == "transition":
            children += [self.point_in("in"), self.point_out("")]
        else:
            children += [self.point_in(name) for name in self.inputs]
            children += [self.point_out(name) for name in self.outputs]
        return tag(self.kind, head + self.back, children + self.front)


class Drawing:
    """Elements of one body."""

    def __init__(self, pous, kinds):
        self.pous, self.kinds = pous, kinds  # pins of own POUs; types of instances here
        self.elements, self.ids = [], 0
        self.y = 40

    def new_id(self):
        self.ids += 1
        return self.ids

    def comment(self, text):
        one = Element(self, "comment", max(80, 7 * len(text)), 30, 20, self.y)
        one.front = [words(text, "content")]
        self.y += 40

    def value(self, text, x, y):
        one = Element(self, "inVariable", max(20, 8 * len(text)), 26, x, y)
        one.back = [("negated", "false")]
        one.output("", 13)
        one.front = [tag("expression", (), text)]
        return one

    def target(self, text, x, y, negated=False):
        one = Element(self, "outVariable", max(20, 8 * len(text)), 26, x, y)
        one.back = [("negated", "true" if negated else "false")]
        one.input("", 13)
        one.front = [tag("expression", (), text)]
        return one

    def block(self, type_, instance, names, outputs, x, y):
        one = Element(self, "block", max(60, 8 * len(type_) + 20), 30 + 20 * max(len(names), len(outputs)), x, y)
        one.attributes = [("typeName", type_)] + ([("instanceName", instance)] if instance else [])
        for row, name in enumerate(names):
            one.input(name, 30 + 20 * row)
        for row, name in enumerate(outputs):
            one.output(name, 30 + 20 * row)
        return one

    def pins(self, type_, given):
        """Names of inputs and outputs; `given` inputs for what takes any number."""
        if type_ in self.pous:
            return self.pous[type_]
        if type_ in BLOCKS:
            return tuple(part.split() for part in BLOCKS[type_])
        if "_TO_" in type_ or given == 1:
            return ["IN"], ["OUT"]
        return [f"IN{n + 1}" for n in range(given)], ["OUT"]


# --- ladders

class Ladder(Drawing):
    def rungs(self, lines):
        self.left = Element(self, "leftPowerRail", 10, 40, 20, self.y)
        ends = []
        for line in lines:
            if line.startswith("//"):
                self.comment(line[2:].strip())
                continue
            ends += self.rung(line)
        self.left.height = self.y
        if ends:
            right = Element(self, "rightPowerRail", 10, self.y, max(e.place()[0] for e in ends) + 60, self.left.y)
            for number, end in enumerate(ends):
                right.input(str(number), end.place()[1] - right.y)
                right.join(str(number), end)
        return self

    def power(self, y):
        name = str(y)
        if name not in self.left.outputs:
            self.left.output(name, y - self.left.y)
        return self.left.outputs[name]

    def rung(self, line):
        ways, _, coils = line.partition("->")
        tokens = re.findall(r"\[(?:[^\[\]]|\[[^\]]*\])*\]|[()|]|[^\s()|\[\]]+(?:\[[^\]]*\])?", ways)
        self.deepest = self.y
        ends, at, x, rest = self.series(tokens, None, 80, self.y)
        assert not rest, rest
        if not ends:
            ends = [self.power(self.y + 8)]
        out, y = [], self.y
        for text in split_top(coils, ","):
            kinds = {"/": [("negated", "true")], ">": [("edge", "rising")], "<": [("edge", "falling")]}
            back = [("negated", "false")]
            if text[:2] in ("S:", "R:"):
                back.append(("storage", "set" if text[0] == "S" else "reset"))
                text = text[2:]
            elif text[0] in kinds:
                back = kinds[text[0]] if text[0] == "/" else back + kinds[text[0]]
                text = text[1:]
            coil = Element(self, "coil", 21, 15, x + 40, y)
            coil.back = back
            coil.input("", 8)
            coil.output("", 8)
            coil.join("", *ends)
            coil.front = [tag("variable", (), text)]
            out.append(coil.outputs[""])
            y += 40
        self.y = max(self.deepest, y) + 60
        return out

    def series(self, tokens, fed, x, y):
        """`fed`: pins that have the power, None at the rail."""
        ends = fed
        while tokens and tokens[0] not in "|)":
            one, tokens = tokens[0], tokens[1:]
            if one == "(":
                begin, ways, wide, row = ends, [], x, y
                while True:
                    more, _, far, tokens = self.series(tokens, begin, x, row)
                    ways += more if more else [self.power(row + 8)]
                    wide = max(wide, far)
                    row = max(row, self.deepest) + 40
                    self.deepest = row
                    mark, tokens = tokens[0], tokens[1:]
                    if mark == ")":
                        break
                self.deepest = row - 40
                ends, x = ways, wide
            elif one.startswith("["):
                ends, x = self.box(one[1:-1].split(), ends, x, y)
            else:
                contact = Element(self, "contact", 21, 15, x, y)
                contact.back = [("negated", "true" if one[0] == "/" else "false")]
                if one[0] in "<>":
                    contact.back.append(("edge", "rising" if one[0] == ">" else "falling"))
                contact.input("", 8)
                contact.output("", 8)
                contact.join("", *(ends or [self.power(y + 8)]))
                contact.front = [tag("variable", (), one.lstrip("/<>"))]
                ends = [contact.outputs[""]]
                x += 80
        return ends, y, x, tokens

    def box(self, parts, ends, x, y):
        type_, parts = parts[0], parts[1:]
        instance = None
        if self.kinds.get(parts[0]) == type_:
            instance, parts = parts[0], parts[1:]
        comes, goes, pins = parts[0], parts[1], parts[2:]
        given = [one.split("=", 1) for one in pins if "=" in one and not re.match(r"\w+:", one)]
        taken = [one.split(":", 1) for one in pins if re.match(r"\w+:", one)]
        names, outputs = self.pins(type_, len([one for one in given if one[0] != "EN"]))
        if comes == "EN":
            names, outputs = ["EN"] + list(names), ["ENO"] + list(outputs)
        high = 22
        block = self.block(type_, instance, names, outputs, x + 80, y - high)
        for name, text in given:
            pin = block.inputs[name][0]
            modifier, text = (text[0], text[1:]) if text[0] in "/" else ("", text)
            source = self.value(text, block.x - 20 - max(20, 8 * len(text)), pin.place()[1] - 13)
            block.join(name, source.outputs[""])
            if modifier:
                block.negated.add(name)
        if comes == "-":
            assert not ends, parts  # it has no input that takes the power
        else:
            block.join(comes, *(ends or [self.power(block.inputs[comes][0].place()[1])]))
        for name, text in taken:
            pin = block.outputs[name]
            target = self.target(text, block.x + block.width + 20, pin.place()[1] - 13)
            target.join("", pin)
        self.deepest = max(self.deepest, y + block.height)
        wide = max([0] + [8 * len(text) for _, text in taken])
        return ([block.outputs[goes]] if goes != "-" else []), block.x + block.width + 60 + wide


# --- function block diagrams

class Blocks(Drawing):
    TOKEN = re.compile(r"\s*('(?:[^']|'')*'|\{\d+\}|[(),=<>/]|[^\s(),={}<>/'\[]+(?:\[[^\]]*\][^\s(),={}<>/']*)?)")

    def statements(self, lines):
        self.instances, self.named, self.waiting = {}, {}, []
        for line in lines:
            if line.startswith("//"):
                self.comment(line[2:].strip())
                continue
            self.bottom = self.y
            if re.match(r"\$\w+ = ", line):
                name, _, line = line.partition(" = ")
                self.named[name] = self.node(line, 400)
            elif " := " in line:
                targets, _, line = line.partition(" := ")
                source, y = self.node(line, 400), self.y
                for text in split_top(targets, ","):
                    self.write(text, source, y)
                    y += 40
                self.bottom = max(self.bottom, y)
            else:
                self.node(line, 400)
            self.y = self.bottom + 40
        for element, name, text, x, y in self.waiting:
            element.join(name, self.reference(text, x, y))
        return self

    def write(self, text, source, y):
        order = re.match(r"\{(\d+)\}\s*", text)
        if order:
            text = text[order.end():]
        if text.startswith("@"):
            one = Element(self, "connector", 8 * len(text) + 20, 26, 560, y)
            one.attributes = []
            one.back = [("name", text[1:])]
            one.input("", 13)
        elif text.endswith("^"):
            one = Element(self, "inOutVariable", 8 * len(text), 26, 560, y)
            one.back = [("negatedOut", "false"), ("negatedIn", "false")]
            one.input("", 13)
            one.output("", 13)
            one.front = [tag("expression", (), text[:-1])]
            self.named[text] = one.outputs[""]
        else:
            one = self.target(text.lstrip("/"), 560, y, text.startswith("/"))
        if order:
            one.order = int(order[1])
        self.connect(one, "", source)

    def connect(self, element, name, source):
        if isinstance(source, tuple):
            self.waiting.append((element, name, *source))
        else:
            element.join(name, source)

    def node(self, text, x):
        tokens = [found[1] for found in self.TOKEN.finditer(text)]
        assert "".join(tokens).replace(" ", "") == text.replace(" ", ""), (text, tokens)
        source, rest, _ = self.tree(tokens, x, self.y)
        assert not rest, (text, rest)
        return source

    def tree(self, tokens, x, y):
        """The pin, what is left, and the row below."""
        order = 0
        if tokens[0].startswith("{"):
            order, tokens = int(tokens[0][1:-1]), tokens[1:]
        name, tokens = tokens[0], tokens[1:]
        if not tokens or tokens[0] != "(":
            self.bottom = max(self.bottom, y + 30)
            return (name, x + 60 - 8 * len(name), y), tokens, y + 40
        inputs, tokens, row = [], tokens[1:], y
        while tokens[0] != ")":
            if tokens[0] == ",":
                tokens = tokens[1:]
            pin = None
            if len(tokens) > 1 and tokens[1] == "=":
                pin, tokens = tokens[0], tokens[2:]
            marks = ""
            while tokens[0] in ("/", "<", ">"):
                marks, tokens = marks + tokens[0], tokens[1:]
            source, tokens, row = self.tree(tokens, x - 160, row)
            inputs.append((pin, marks, source))
        tokens = tokens[1:]
        instance, _, type_ = name.rpartition(":")
        names, outputs = self.pins(type_, len([one for one in inputs if one[0] != "EN"]))
        if any(one[0] == "EN" for one in inputs):
            names, outputs = ["EN"] + list(names), ["ENO"] + list(outputs)
        block = self.block(type_, instance, names, outputs, x, y)
        block.order = order
        self.bottom = max(self.bottom, y + block.height, row - 10)
        for number, (pin, marks, source) in enumerate(inputs):
            pin = pin or names[number]
            if "/" in marks:
                block.negated.add(pin)
            if ">" in marks or "<" in marks:
                block.edges[pin] = "rising" if ">" in marks else "falling"
            self.connect(block, pin, source)
        pin = "OUT" if "OUT" in block.outputs else list(block.outputs)[0]
        if tokens and tokens[0].startswith("."):
            pin, tokens = tokens[0][1:], tokens[1:]
        if instance:
            self.instances[instance] = block
        return block.outputs[pin], tokens, max(row, y + block.height)

    def reference(self, text, x, y):
        """A value by its text: a box, a wire by name, or a variable."""
        if text in self.named:
            source = self.named[text]
            return self.reference(*source) if isinstance(source, tuple) else source
        owner, _, pin = text.partition(".")
        if owner in self.instances and pin in self.instances[owner].outputs:
            return self.instances[owner].outputs[pin]
        if text.startswith("@"):
            one = Element(self, "continuation", 8 * len(text) + 20, 26, x - 20, y)
            one.back = [("name", text[1:])]
            one.output("", 13)
            return one.outputs[""]
        return self.value(text, x, y).outputs[""]


# --- charts

class Chart(Drawing):
    def lines(self, lines):
        self.todo = list(lines)
        self.joined = 0
        self.first = None
        self.sequence(None, 200, 40)
        return self

    def pin_in(self, element, *sources):
        element.inputs["in"] = (Pin(element, "", element.width // 2, 0), [one for one in sources if one])

    def pin_out(self, element, x=None, name=""):
        element.outputs[name] = Pin(element, name, element.width // 2 if x is None else x, element.height)
        return element.outputs[name]

    def sequence(self, above, x, y):
        """Elements in a column, from what is above; the pin they end with and the row below."""
        while self.todo and self.todo[0] not in ("or", "end"):
            line = self.todo.pop(0)
            word, _, rest = line.partition(" ")
            if word == "//":
                one = Element(self, "comment", max(80, 7 * len(rest)), 30, x + 200, y - 10)
                one.front = [words(rest, "content")]
            elif word == "step":
                above, y = self.step(rest, above, x, y)
            elif word == "when":
                above, y = self.transition(rest, above, x, y)
            elif word == "jump":
                one = Element(self, "jumpStep", 12, 13, x - 6, y)
                one.back = [("targetName", rest)]
                self.pin_in(one, above)
                above, y = None, y + 40
            elif word in ("either", "beside"):
                above, y = self.branch(word == "beside", above, x, y)
            else:
                raise ValueError(line)
        return above, y

    def step(self, text, above, x, y):
        name, _, actions = text.partition(" : ")
        first = above is None
        one = Element(self, "step", 8 * len(name) + 20, 30, x - (8 * len(name) + 20) // 2, y)
        one.attributes = [("name", name.strip()), ("initialStep", "true" if first else "false")]
        if not first:
            self.pin_in(one, above)
        out = self.pin_out(one)
        found = re.findall(r"(\w+)(?:,(\S+))?\s+(?:\{(.*?)\}|(\w+))(?:\s*\|\s*|$)", actions)
        if found:
            one.outputs["action"] = Pin(one, "", one.width, 15)
            block = Element(self, "actionBlock", 160, 20 * len(found), one.x + one.width + 30, y)
            block.input("in", 15)
            block.join("in", one.outputs["action"])
            for qualifier, time, inline, name in found:
                attributes = [("localId", 0), ("qualifier", qualifier)] + ([("duration", time)] if time else [])
                body = tag("reference", [("name", name)]) if name else \
                    tag("inline", (), [tag("ST", (), [tag("xhtml:p", (), inline.strip().replace("\\n", "\n"))])])
                block.front.append(tag("action", attributes, [point(0, 0, "relPosition"), body]))
        return out, y + 70 + 20 * len(found)

    def transition(self, text, above, x, y):
        priority = re.match(r"\((\d+)\)\s*", text)
        if priority:
            text = text[priority.end():]
        one = Element(self, "transition", 20, 2, x - 10, y)
        if priority:
            one.back = [("priority", priority[1])]
        self.pin_in(one, above)
        out = self.pin_out(one)
        if text.startswith("="):
            condition = tag("reference", [("name", text[1:])])
        elif text.startswith("<< "):
            condition = tag("connectionPointIn", (), self.wire(text[3:], one))
        else:
            condition = tag("inline", [("name", "")], [tag("ST", (), [tag("xhtml:p", (), text)])])
        one.front = [tag("condition", (), [condition])]
        return out, y + 60

    def wire(self, text, transition):
        """Contacts from a rail of their own, or values, to the left of the transition."""
        contacts = text.split()
        x, y = transition.x - 60 - 40 * len(contacts), transition.y - 7
        rail = Element(self, "leftPowerRail", 10, 40, x - 40, y - 10)
        rail.output("0", 18)
        source = rail.outputs["0"]
        for text in contacts:
            contact = Element(self, "contact", 21, 15, x, y)
            contact.back = [("negated", "true" if text[0] == "/" else "false")]
            contact.input("", 8)
            contact.output("", 8)
            contact.join("", source)
            contact.front = [tag("variable", (), text.lstrip("/"))]
            source = contact.outputs[""]
            x += 40
        at, up = source.place()
        return [point(0, 1, "relPosition"), tag("connection", [("refLocalId", source.owner.id)], [
            point(transition.x, transition.y + 1), point(at, up)])]

    def branch(self, both, above, x, y):
        kind = "simultaneous" if both else "selection"
        open_ = Element(self, kind + "Divergence", 1, 3 if both else 1, x, y)
        self.pin_in(open_, above)
        ends, column, low = [], x, y
        while True:
            pin = self.pin_out(open_, column - x, str(column))
            end, row = self.sequence(pin, column, y + 40)
            if end:
                ends.append((end, column))
            low = max(low, row)
            column += 320
            if self.todo.pop(0) == "end":
                break
        open_.width = column - 320 - x + 1
        open_.inputs["in"][0].x = 0
        if not ends:
            return None, low
        if len(ends) == 1:
            return ends[0][0], low
        close = Element(self, kind + "Convergence", ends[-1][1] - x + 1, 3 if both else 1, x, low)
        for end, at in ends:
            close.inputs[str(at)] = (Pin(close, "", at - x, 0), [end])
        return self.pin_out(close, 0), low + 40


# --- the project

def body_of(language, lines, pous, kinds):
    text = "\n".join(lines).strip("\n")
    if language in ("ST", "IL"):
        return tag(language, (), [tag("xhtml:p", (), text)])
    lines = [line.strip() for line in lines if line.strip()]
    drawing = {"LD": Ladder, "FBD": Blocks, "SFC": Chart}[language](pous, kinds)
    {"LD": lambda: drawing.rungs(lines), "FBD": lambda: drawing.statements(lines),
     "SFC": lambda: drawing.lines(lines)}[language]()
    return tag(language, (), [one.xml() for one in drawing.elements])


class Pou:
    def __init__(self, word, name, result):
        self.word, self.name, self.result = word, name, result
        self.lists, self.bodies, self.remark = [], [], ""  # bodies: (kind, name, language, lines)

    def pins(self):
        names = {key: [v[1][0][1] for kind, _, vs in self.lists if kind == key for v in vs]
                 for key in ("inputVars", "inOutVars", "outputVars")}
        outputs = ["OUT"] if self.word == "FUNCTION" else []
        # An in-out is an input and an output there.
        return names["inputVars"] + names["inOutVars"], outputs + names["inOutVars"] + names["outputVars"]

    def xml(self, pous):
        interface = [tag("returnType", (), [type_of(self.result)])] if self.result else []
        for kind, attributes, members in self.lists:
            interface.append(tag(kind, attributes, members))
        kinds = {v[1][0][1]: dict(v[2][0][2][0][1]).get("name") for _, _, vs in self.lists for v in vs}
        parts = {"action": [], "transition": [], "": []}
        for kind, name, language, lines in self.bodies:
            body = tag("body", (), [body_of(language, lines, pous, kinds)])
            parts[kind].append(tag(kind, [("name", name)], [body]) if kind else body)
        children = [tag("interface", (), interface)]
        for kind in ("action", "transition"):
            if parts[kind]:
                children.append(tag(kind + "s", (), parts[kind]))
        children += parts[""]
        if self.remark:
            children.append(words(self.remark))
        word = {"PROGRAM": "program", "FUNCTION": "function", "FUNCTION_BLOCK": "functionBlock"}[self.word]
        return tag("pou", [("name", self.name), ("pouType", word)], children)


def configuration(lines):
    """`task NAME INTERVAL PRIORITY`, or `on VARIABLE` for the interval, `run PROGRAM as NAME with TASK`,
    `var`, `constant` and `resource var` with a declaration."""
    tasks, globals_, constants, of_resource = [], [], [], []
    for line in lines:
        line = line.strip()
        if line.startswith("task "):
            _, name, *when, priority = line.split()
            tasks.append((name, ("single" if when[0] == "on" else "interval", when[-1]), priority, []))
        elif line.startswith("run "):
            _, program, _, name, _, task = line.split()
            next(one for one in tasks if one[0] == task)[3].append(
                tag("pouInstance", [("name", name), ("typeName", program)]))
        elif line.startswith("resource var "):
            of_resource.append(line[13:])
        elif line.startswith("var "):
            globals_.append(line[4:])
        elif line.startswith("constant "):
            constants.append(line[9:])
    resource = [tag("task", [("name", n), ("priority", p), when], runs) for n, when, p, runs in tasks]
    if of_resource:
        resource.append(tag("globalVars", (), variables(of_resource)))
    parts = [tag("resource", [("name", "resource1")], resource)]
    if globals_:
        parts.append(tag("globalVars", (), variables(globals_)))
    if constants:
        parts.append(tag("globalVars", [("constant", "true")], variables(constants)))
    return tag("configuration", [("name", "config")], parts)


def project(name, lines):
    types, pous, config, now, here = [], [], [], None, None
    for line in lines:
        word = line.split(" ")[0] if line and line[0] != " " else ""
        if word == "TYPE":
            found = re.fullmatch(r"TYPE (\w+) : (.*);", line)
            types.append(data_type(*found.groups()))
        elif word in ("PROGRAM", "FUNCTION", "FUNCTION_BLOCK"):
            head = line.partition(" // ")
            found = re.fullmatch(r"\w+ (\w+)(?: : (.*))?", head[0].strip())
            now = Pou(word, found[1], found[2])
            now.remark = head[2]
            pous.append(now)
            here = None
        elif word.startswith("VAR"):
            attributes = [(one.lower(), "true") for one in line.split()[1:]]
            here = []
            now.lists.append((LISTS[word], attributes, here))
        elif word in ("LD", "FBD", "SFC", "ST", "IL") or word in ("ACTION", "TRANSITION"):
            kind, part = ("", "") if word not in ("ACTION", "TRANSITION") else line.split()[:2]
            here = ("body", [])
            now.bodies.append((kind.lower(), part, line.split()[-1], here[1]))
        elif word == "CONFIGURATION":
            here = ("body", config)
        elif isinstance(here, list):
            if line.strip():
                here.extend(variables([line]))
        elif here and line:
            here[1].append(line[2:] if line.startswith("  ") else line)
        elif here:
            here[1].append("")
    known = {one.name: one.pins() for one in pous}
    day = 1 + sum(map(ord, name)) % 28
    scaling = [tag(one, (), [point(8 if one == "fbd" else 0, 8 if one == "fbd" else 0, "scaling")])
               for one in ("fbd", "ld", "sfc")]
    space = "http://www.plcopen.org/xml/tc6_0201"
    root = tag("project", [("xmlns:ns1", space), ("xmlns:xhtml", "http://www.w3.org/1999/xhtml"),
                           ("xmlns:xsd", "http://www.w3.org/2001/XMLSchema"), ("xmlns", space)], [
        tag("fileHeader", [("companyName", "Unknown"), ("productName", "Unnamed"), ("productVersion", "1"),
                           ("creationDateTime", f"2024-03-{day:02}T08:15:00")]),
        tag("contentHeader", [("name", name), ("modificationDateTime", f"2024-05-{day:02}T16:40:12")],
            [tag("coordinateInfo", (), scaling)]),
        tag("types", (), [tag("dataTypes", (), types), tag("pous", (), [one.xml(known) for one in pous])]),
        tag("instances", (), [tag("configurations", (), [configuration(config)])])])
    out = ["<?xml version='1.0' encoding='utf-8'?>"]
    render(root, 0, out)
    return "\n".join(out) + "\n"


def main():
    folder = sys.argv[1]
    cases, name = {}, None
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "beremiz_cases.txt")) as file:
        for line in file.read().split("\n"):
            if line.startswith("project "):
                name = line.split()[1]
                cases[name] = []
            elif name and not line.startswith("#"):
                cases[name].append(line)
    os.makedirs(folder, exist_ok=True)
    for name, lines in cases.items():
        with open(os.path.join(folder, name + ".xml"), "w") as file:
            file.write(project(name, lines))


main()
