#!/usr/bin/env python3
"""Objects of TwinCAT with drawn bodies, as its editor stores them: draw_twincat.py FOLDER writes the
folders drawn_* of tests/vendors/twincat. A tree is a tuple: its first word says what it is."""
import os
import sys
import uuid
from xml.sax.saxutils import escape

NEGATED, SET, RESET, JUMP, RETURN, RISING, FALLING = 1, 2, 3, 4, 8, 16, 32


def var(name, type_="BOOL", flags=0):
    return ("operand", name, type_, flags)


def val(text, type_="INT"):
    return ("operand", text, type_, 0)


def box(type_, *inputs, instance=None, names=(), outputs=(), out_names=(), out_types=(), en=False,
        call="Operator", flags=0, marks=None):
    """An output is None where the wire leads on, "" where nothing is connected, or a variable."""
    return ("box", type_, inputs, instance, names, outputs, out_names, out_types, en, call, flags,
            marks)


def fb(type_, instance, inputs, outputs, out_types=None, **more):
    """`inputs` and `outputs`: by the names of the pins."""
    return box(type_, *inputs.values(), instance=instance, names=tuple(inputs),
               outputs=tuple(outputs.values()), out_names=tuple(outputs),
               out_types=tuple(out_types or ["BOOL"] * len(outputs)), call="FunctionBlock", **more)


def to(targets, tree, flags=0):
    targets = targets if isinstance(targets, list) else [targets]
    return ("assign", [t if isinstance(t, tuple) else var(t) for t in targets], tree, flags)


def wire(number, tree=None):
    return ("demux", number, tree)


def parallel(feed, *trees):
    return ("parallel", feed, trees)


RAIL = ("terminator", None)


class Writer:
    def __init__(self):
        self.ids = 0
        self.lines = []

    def line(self, depth, text):
        self.lines.append("  " * depth + text)

    def value(self, depth, name, text, quoted=True):
        self.line(depth, f'<v n="{name}">' + (f'"{escape(text)}"' if quoted else escape(str(text))) +
                  "</v>")

    def identity(self, depth):
        self.value(depth, "Id", f"{self.ids}L", False)
        self.ids += 1

    def flags(self, depth, bits, name=' n="Flags"'):
        self.line(depth, f'<o{name} t="Flags">')
        self.value(depth + 1, "Flags", bits, False)
        self.value(depth + 1, "Fixed", "false", False)
        self.value(depth + 1, "Extensible", "false", False)
        self.line(depth, "</o>")

    def operand(self, depth, opening, text, type_, bits, target=False, instance=False):
        self.line(depth, opening)
        if text is None:
            self.line(depth + 1, '<n n="Operand" />')
        else:
            self.value(depth + 1, "Operand", text)
        for name, field in (("Type", type_), ("Comment", ""), ("SymbolComment", ""), ("Address", "")):
            self.value(depth + 1, name, field)
        self.flags(depth + 1, bits)
        for name, field in (("LValue", target), ("Boolean", type_ == "BOOL"), ("IsInstance", instance)):
            self.value(depth + 1, name, str(field).lower(), False)
        self.identity(depth + 1)
        self.line(depth, "</o>")

    def outputs(self, depth, operands):
        self.line(depth, '<o n="OutputItems" t="OutputItemList">')
        if not operands:
            self.line(depth + 1, '<l2 n="OutputItems" />')
        else:
            self.line(depth + 1, '<l2 n="OutputItems" cet="Operand">')
            for one in operands:
                if one is None:
                    self.line(depth + 2, "<n />")
                elif one == "":
                    self.operand(depth + 2, "<o>", "", "", 0, target=True)
                else:
                    one = one if isinstance(one, tuple) else var(one)
                    self.operand(depth + 2, "<o>", one[1], one[2], one[3], target=True)
            self.line(depth + 1, "</l2>")
        self.line(depth, "</o>")

    def texts(self, depth, name, texts):
        if not texts:
            self.line(depth, f'<l2 n="{name}" />')
            return
        self.line(depth, f'<l2 n="{name}" cet="String">')
        for text in texts:
            self.line(depth + 1, f"<v>{escape(text)}</v>")
        self.line(depth, "</l2>")

    TYPES = {"operand": "BoxTreeOperand", "box": "BoxTreeBox", "assign": "BoxTreeAssign",
             "demux": "BoxTreeDemux", "parallel": "BoxTreeParallel", "terminator": "BoxTreeTerminator"}

    def tree(self, depth, tree, name=None, common=None):
        if tree is None:
            self.line(depth, f'<n n="{name}" />' if name else "<n />")
            return
        type_ = self.TYPES[tree[0]]
        opening = "<o" + (f' n="{name}"' if name else "") + ("" if common == type_ else f' t="{type_}"')
        self.line(depth, opening + ">")
        getattr(self, "in_" + tree[0])(depth + 1, *tree[1:])
        self.identity(depth + 1)
        self.line(depth, "</o>")

    def trees(self, depth, name, trees):
        kinds = {self.TYPES[t[0]] for t in trees if t is not None}
        common = next(iter(kinds)) if len(kinds) == 1 else None
        if not trees:
            self.line(depth, f'<l2 n="{name}" />')
            return
        self.line(depth, f'<l2 n="{name}"' + (f' cet="{common}">' if common else ">"))
        for one in trees:
            self.tree(depth + 1, one, common=common)
        self.line(depth, "</l2>")

    def in_operand(self, depth, text, type_, bits):
        self.operand(depth, '<o n="Operand" t="Operand">', text, type_, bits)

    def in_box(self, depth, type_, inputs, instance, names, outputs, out_names, out_types, en, call,
               bits, marks):
        self.value(depth, "BoxType", type_)
        self.operand(depth, '<o n="Instance" t="Operand">', instance, "", 0, instance=True)
        self.outputs(depth, outputs)
        self.flags(depth, bits)
        if marks:
            self.line(depth, '<l2 n="InputFlags" cet="Flags">')
            for mark in marks:
                self.flags(depth + 1, mark, "")
            self.line(depth, "</l2>")
        else:
            self.line(depth, '<n n="InputFlags" />')
        self.trees(depth, "InputItems", inputs)
        for name, pins, types in (("InputParam", names, ["BOOL"] * len(names)),
                                  ("OutputParam", out_names, out_types)):
            self.line(depth, f'<o n="{name}" t="ParamList">')
            self.texts(depth + 1, "Names", pins)
            self.texts(depth + 1, "Types", types)
            self.line(depth, "</o>")
        self.line(depth, f'<v n="CallType" t="Operator">{call}</v>')
        for name in ("EN", "ENO"):
            self.value(depth, name, str(en).lower(), False)
        self.line(depth, '<n n="STSnippet" />')
        self.value(depth, "ContainsExtensibleInputs", "false", False)
        self.value(depth, "ProvidesSTSnippet", "false", False)

    def in_assign(self, depth, targets, tree, bits):
        self.outputs(depth, targets)
        self.flags(depth, bits)
        self.tree(depth, tree, "RValue")

    def in_demux(self, depth, number, tree):
        self.value(depth, "VarId", number, False)
        self.tree(depth, tree, "Input")

    def in_parallel(self, depth, feed, trees):
        self.tree(depth, feed, "Input")
        self.line(depth, '<v n="Mode" t="OperationMode">BoxShortCircuit</v>')
        self.trees(depth, "Trees", trees)
        self.flags(depth, 0)

    def in_terminator(self, depth, tree):
        self.tree(depth, tree, "Input")
        self.flags(depth, 0)

    def network(self, depth, trees, title="", comment="", label="", disabled=False):
        self.line(depth, "<o>")
        for name in ("ILActive", "FBDValid", "ILValid"):
            self.value(depth + 1, name, "false", False)
        self.line(depth + 1, '<l2 n="ILLines" />')
        for name, text in (("Comment", comment), ("Title", title), ("Label", label)):
            self.value(depth + 1, name, text)
        self.value(depth + 1, "OutCommented", str(disabled).lower(), False)
        self.trees(depth + 1, "NetworkItems", trees)
        self.line(depth + 1, '<l2 n="Connectors" />')
        self.identity(depth + 1)
        self.line(depth, "</o>")

    def body(self, depth, view, networks):
        self.line(depth, "<Implementation>")
        self.line(depth + 1, "<NWL>")
        self.line(depth + 2, "<XmlArchive>")
        self.line(depth + 3, "<Data>")
        self.line(depth + 4, '<o xml:space="preserve" t="NWLImplementationObject">')
        self.value(depth + 5, "NetworkListComment", "")
        self.value(depth + 5, "DefaultViewMode", view)
        self.line(depth + 5, '<l2 n="NetworkList" cet="Network">')
        for one in networks:
            trees, options = one if isinstance(one, tuple) and isinstance(one[-1], dict) else (one, {})
            self.network(depth + 6, trees, **options)
        self.line(depth + 5, "</l2>")
        self.value(depth + 5, "BranchCounter", 9, False)
        self.value(depth + 5, "ValidIds", "true", False)
        self.line(depth + 4, "</o>")
        self.line(depth + 3, "</Data>")
        self.line(depth + 3, "<TypeList>")
        for name in ("Boolean", "Int32", "Int64", "String"):
            self.line(depth + 4, f'<Type n="{name}">System.{name}</Type>')
        self.line(depth + 3, "</TypeList>")
        self.line(depth + 2, "</XmlArchive>")
        self.line(depth + 1, "</NWL>")
        self.line(depth, "</Implementation>")


    # --- charts: steps, transitions, jumps and branches, each with attributes by their ids

    def attributes(self, depth, values):
        self.line(depth, '<l2 n="Attributes" cet="SFCAttribute">')
        for name, value in values.items():
            self.line(depth + 1, "<o>")
            self.value(depth + 2, "AttributeId", "{" + CHART_IDS[name] + "}", False)
            bool_ = value in (True, False)
            self.line(depth + 2, f'<o n="Value" t="{"BoolValue" if bool_ else "StringValue"}">')
            self.value(depth + 3, "Value", str(value).upper() if bool_ else value)
            self.value(depth + 3, "DefaultValue", "FALSE" if bool_ else "")
            self.line(depth + 2, "</o>")
            self.identity(depth + 2)
            self.value(depth + 2, "IdParent", "0L", False)
            self.line(depth + 1, "</o>")
        self.line(depth, "</l2>")

    def chart_list(self, depth, elements):
        self.line(depth, '<o n="ElementList" t="SFCElementList">')
        if elements:
            self.line(depth + 1, '<l2 n="InnerList">')
            for one in elements:
                getattr(self, "chart_" + one[0])(depth + 2, *one[1:])
            self.line(depth + 1, "</l2>")
        else:
            self.line(depth + 1, '<l2 n="InnerList" />')
        self.line(depth, "</o>")

    def chart_step(self, depth, name, own, actions):
        self.line(depth, '<o t="SFCStep">')
        for what in ("Main", "Entry", "Exit"):
            self.line(depth + 1, f'<n n="Embedded{what}Action" />')
        self.chart_list(depth + 1, [("action", *one) for one in actions])
        values = {"Name": name, "Comment": own.get("Comment", ""), "Exclude": False,
                  "InitStep": own.get("InitStep", False), "Duplication": False}
        for key in ("MinTime", "MaxTime", "MainAction", "EntryAction", "ExitAction"):
            values[key] = own.get(key, "")
        self.attributes(depth + 1, values)
        self.identity(depth + 1)
        self.line(depth, "</o>")

    def chart_action(self, depth, name, qualifier):
        self.line(depth, '<o t="SFCAction">')
        self.attributes(depth + 1, {"Name": name, "Qualifier": qualifier})
        self.line(depth, "</o>")

    def chart_transition(self, depth, condition, comment=""):
        self.line(depth, '<o t="SFCTransition">')
        self.line(depth + 1, '<n n="VariableName" />')
        self.line(depth + 1, '<n n="EmbeddedTransition" />')
        self.attributes(depth + 1, {"Name": condition, "Comment": comment, "Exclude": False})
        self.identity(depth + 1)
        self.line(depth, "</o>")

    def chart_jump(self, depth, target):
        self.line(depth, '<o t="SFCJump">')
        self.attributes(depth + 1, {"Name": target, "Comment": "", "Exclude": False})
        self.identity(depth + 1)
        self.line(depth, "</o>")

    def chart_branch(self, depth, parallel_, ways):
        self.line(depth, '<o t="SFCBranch">')
        self.line(depth + 1, '<l2 n="Segments" cet="SFCSegment">')
        for way in ways:
            self.line(depth + 2, "<o>")
            self.chart_list(depth + 3, way)
            self.line(depth + 3, '<l2 n="Attributes" />')
            self.line(depth + 2, "</o>")
        self.line(depth + 1, "</l2>")
        self.attributes(depth + 1, {"Exclude": False, "Parallel": parallel_})
        self.identity(depth + 1)
        self.line(depth, "</o>")

    def chart(self, depth, elements):
        self.line(depth, "<Implementation>")
        self.line(depth + 1, "<SFC>")
        self.line(depth + 2, "<XmlArchive>")
        self.line(depth + 3, "<Data>")
        self.line(depth + 4, '<o xml:space="preserve" t="SFCImplementationObject">')
        self.line(depth + 5, '<o n="Root" t="SFCSegment">')
        self.chart_list(depth + 6, elements)
        self.line(depth + 6, '<l2 n="Attributes" />')
        self.line(depth + 5, "</o>")
        self.line(depth + 5, '<d2 n="Attributes" ckt="Guid" cvt="SFCAttributeDescription">')
        for name, id_ in CHART_IDS.items():
            self.line(depth + 6, f"<v>{id_}</v>")
            self.line(depth + 6, "<o>")
            self.value(depth + 7, "Id", "{" + id_ + "}", False)
            self.value(depth + 7, "Identifier", name)
            self.line(depth + 6, "</o>")
        self.line(depth + 5, "</d2>")
        self.line(depth + 4, "</o>")
        self.line(depth + 3, "</Data>")
        self.line(depth + 2, "</XmlArchive>")
        self.line(depth + 1, "</SFC>")
        self.line(depth, "</Implementation>")


CHART_IDS = {
    "Name": "38391c6d-6d4a-42f8-8ee7-9f45e5adafa8", "MainAction": "700a583f-b4d4-43e4-8c14-629c7cd3bec8",
    "EntryAction": "a6b08bd8-b696-47e3-9cbf-7408b61c9ff8",
    "ExitAction": "a2621e18-7de3-4ea6-ae6d-89e9e0b7befd",
    "InitStep": "6844a48e-46c2-4cc8-a185-a478f3b99cc0", "Parallel": "23bdaa98-72ec-41f7-817b-9dede5697086",
    "Qualifier": "e174fc0d-80b0-4a9e-a530-ca239c249a50", "MinTime": "cacf1a68-236e-47c2-b7b1-1cf9199718cb",
    "MaxTime": "b693554c-1b01-4a8d-afde-9e3a46f7465d", "Comment": "7d894980-aeea-405c-a0f6-e2b26429c58f",
    "Exclude": "01580b27-6378-448b-8ecb-0e4b795b58d6", "Monitoring": "8294df19-5962-4dee-a874-1051dabb0e3e",
    "Duplication": "62e1754b-7629-4e63-9cec-10ae0c536f1f", "Symbol": "bc882c11-1e91-4dd8-a6b8-2075724ed18b",
}


def step(name, *actions, **own):
    return ("step", name, own, actions)


def when(condition, comment=""):
    return ("transition", condition, comment)


def jump(target):
    return ("jump", target)


def either(*ways):
    return ("branch", False, ways)


def beside(*ways):
    return ("branch", True, ways)


def identity_of(name):
    return "{" + str(uuid.uuid5(uuid.NAMESPACE_URL, name)) + "}"


def pou(name, declaration, view, networks, members=()):
    """`members`: (word, name, declaration, view, networks)."""
    out = Writer()
    out.lines += ['<?xml version="1.0" encoding="utf-8"?>',
                  '<TcPlcObject Version="1.1.0.1" ProductVersion="3.1.4024.12">',
                  f'  <POU Name="{name}" Id="{identity_of(name)}" SpecialFunc="None">',
                  f"    <Declaration><![CDATA[{declaration}]]></Declaration>"]
    if view == "ST":
        out.lines.append(f"    <Implementation>\n      <ST><![CDATA[{networks}]]></ST>\n"
                         "    </Implementation>")
    elif view == "SFC":
        out.chart(2, networks)
    else:
        out.body(2, view, networks)
    for word, member, text, kind, body in members:
        out.lines.append(f'    <{word} Name="{member}" Id="{identity_of(name + member)}">')
        if text:
            out.lines.append(f"      <Declaration><![CDATA[{text}]]></Declaration>")
        if kind == "ST":
            out.lines.append(f"      <Implementation>\n        <ST><![CDATA[{body}]]></ST>\n"
                             "      </Implementation>")
        else:
            out.body(3, kind, body)
        out.lines.append(f"    </{word}>")
    out.lines += ["  </POU>", "</TcPlcObject>", ""]
    return "\n".join(out.lines)


CASES = {}

CASES["drawn_logic"] = {"MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	n, m, big, half, prod : INT;
	w : WORD := 16#0FF0;
	bits, mixed : WORD;
	a, b, both, either, none, odd, copy, more : BOOL;
END_VAR
""", "Fbd", [
    ([to(var("n", "INT"), box("ADD", val("n"), val("1")))], {"title": "Counts", "comment": "one\nmore"}),
    ([to("a", box("GT", box("MOD", val("n"), val("4")), val("1"))),
      to("b", box("EQ", box("MOD", val("n"), val("3")), val("0")))], {}),
    [to(["both", "copy"], box("AND", var("a"), var("b")))],
    [to("either", box("OR", var("a"), var("b", flags=NEGATED), box("AND", var("a"), var("b"))))],
    [to("none", box("AND", var("a"), var("b"), marks=(NEGATED, NEGATED)))],
    [to("odd", box("XOR", var("a"), var("b"), flags=NEGATED))],
    [to(var("more", flags=NEGATED), box("NOT", var("a")))],
    [to(var("m", "INT"), box("SEL", var("a"), val("10"), val("MAX(n, 20)")))],
    [to(var("bits", "WORD"), box("AND", val("w", "WORD"), val("16#00FF", "WORD")))],
    [to(var("mixed", "WORD"), box("OR", val("bits", "WORD"), box("SHL", val("w", "WORD"), val("n"))))],
    [box("MOVE", var("a"), val("n"), names=("EN",), out_names=("ENO", ""), out_types=("BOOL", "INT"),
         outputs=(None, var("big", "INT")), en=True, call="Move")],
    [to(var("half", "INT"), box("DIV", val("n"), val("2")))],
    # The second output leads on; nothing is written while EN is FALSE.
    [to(var("prod", "INT"), box("MUL", var("a"), val("n"), val("2"), names=("EN",), out_names=("ENO", ""),
                                out_types=("BOOL", "INT"), outputs=("", None), en=True, call="Mul"))],
]), "twin": """PROGRAM MAIN
VAR
  n, m, big, half, prod : INT;
  w : WORD := 16#0FF0;
  bits, mixed : WORD;
  a, b, both, either, none, odd, copy, more : BOOL;
END_VAR
n := n + 1;
a := n MOD 4 > 1;
b := n MOD 3 = 0;
both := a AND b;
copy := both;
either := a OR NOT b OR (a AND b);
none := NOT a AND NOT b;
odd := NOT (a XOR b);
more := a;
m := SEL(a, 10, MAX(n, 20));
bits := w AND 16#00FF;
mixed := bits OR SHL(w, n);
IF a THEN big := n; END_IF
half := n / 2;
IF a THEN prod := n * 2; END_IF
END_PROGRAM
"""}

CASES["drawn_timers"] = {"MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	tonRun : TON;
	ctuRuns : CTU;
	trig : R_TRIG;
	pulse : TP;
	tonLate : TON;
	go, done, full, rose, lit, two : BOOL;
	t, late : TIME;
	n, k : INT;
END_VAR
""", "Fbd", [
    [to(var("n", "INT"), box("ADD", val("n"), val("1")))],
    [to("go", box("LT", box("MOD", val("n"), val("7")), val("5")))],
    [fb("TON", "tonRun", {"IN": var("go"), "PT": val("T#30ms", "TIME")},
        {"Q": "done", "ET": var("t", "TIME")}, ("BOOL", "TIME"))],
    # The timer's Q leads on, its ET goes nowhere; the counter resets itself.
    [to("full", fb("CTU", "ctuRuns",
                   {"CU": fb("TON", "tonRun", {"IN": var("go"), "PT": val("T#30ms", "TIME")},
                             {"Q": None, "ET": ""}, ("BOOL", "TIME")),
                    "RESET": val("ctuRuns.Q", "BOOL"), "PV": val("3")},
                   {"Q": None, "CV": var("k", "INT")}, ("BOOL", "INT")))],
    [fb("R_TRIG", "trig", {"CLK": var("done", flags=NEGATED)}, {"Q": "rose"})],
    [fb("TP", "pulse", {"IN": var("go", flags=RISING), "PT": val("T#20ms", "TIME")},
        {"Q": var("lit", flags=NEGATED), "ET": ""}, ("BOOL", "TIME"))],
    [to(var("late", "TIME"), fb("TON", "tonLate", {"IN": var("go"), "PT": val("T#1s", "TIME")},
                                {"Q": "", "ET": None}, ("BOOL", "TIME")))],
    [to("two", box("AND", var("go", flags=FALLING), var("n", "INT") and val("n > 10", "BOOL")))],
]), "twin": """PROGRAM MAIN
VAR
  tonRun : TON;
  ctuRuns : CTU;
  trig : R_TRIG;
  pulse : TP;
  tonLate : TON;
  go, done, full, rose, lit, two : BOOL;
  t, late : TIME;
  n, k : INT;
  goRose : R_TRIG; goFell : F_TRIG;
END_VAR
n := n + 1;
go := n MOD 7 < 5;
tonRun(IN := go, PT := T#30ms, Q => done, ET => t);
tonRun(IN := go, PT := T#30ms);
ctuRuns(CU := tonRun.Q, RESET := ctuRuns.Q, PV := 3, CV => k);
full := ctuRuns.Q;
trig(CLK := NOT done, Q => rose);
goRose(CLK := go);
pulse(IN := goRose.Q, PT := T#20ms);
lit := NOT pulse.Q;
tonLate(IN := go, PT := T#1s, ET => late);
goFell(CLK := go);
two := goFell.Q AND n > 10;
END_PROGRAM
"""}

CASES["drawn_jumps"] = {"MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	n, passes, late, off : INT;
	skip, leave : BOOL;
END_VAR
""", "Fbd", [
    [to(var("n", "INT"), box("ADD", val("n"), val("1")))],
    [to("skip", box("EQ", box("MOD", val("n"), val("2")), val("0")))],
    [to(var("Behind", flags=JUMP), var("skip"), JUMP)],
    [to(var("passes", "INT"), box("ADD", val("passes"), val("1")))],
    ([to(var("off", "INT"), box("ADD", val("off"), val("1")))], {"disabled": True, "title": "Not now"}),
    ([to("leave", box("GE", val("n"), val("9")))], {"label": "Behind"}),
    [to(var("", flags=RETURN), var("leave"), RETURN)],
    [],
    [to(var("late", "INT"), val("n"))],
]), "twin": """PROGRAM MAIN
VAR
  n, passes, late, off : INT;
  skip, leave : BOOL;
END_VAR
n := n + 1;
skip := n MOD 2 = 0;
IF NOT skip THEN passes := passes + 1; END_IF
leave := n >= 9;
IF leave THEN RETURN; END_IF
late := n;
END_PROGRAM
"""}

CASES["drawn_branches"] = {"MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	n : INT;
	hot, cold, latched, alarm, both, never, calm, rest, mild, rose, rose2, flip, flop, turn, was : BOOL;
END_VAR
""", "Fbd", [
    [to(var("n", "INT"), box("MOD", box("ADD", val("n"), val("3")), val("10")))],
    [wire(1, box("GT", val("n"), val("6"))),
     to("hot", wire(1)),
     to(var("latched", flags=SET), box("AND", wire(1), val("n < 9", "BOOL"))),
     to(var("alarm", flags=NEGATED), wire(1))],
    [to("cold", box("LT", val("n"), val("2")))],
    [to(var("latched", flags=RESET), var("cold"))],
    # What begins a wire is negated, or sees an edge: so is all that it goes to.
    [wire(3, var("hot", flags=NEGATED)), to("calm", wire(3)), to("rest", box("AND", wire(3), var("latched")))],
    [wire(4, box("OR", var("hot"), var("cold"), flags=NEGATED)), to("mild", wire(4))],
    # Read once, although what is written first is the variable itself.
    [to(["flip", "flop"], var("flip", flags=NEGATED))],
    [wire(6, var("turn")), to(var("turn", flags=NEGATED), wire(6)), to("was", wire(6))],
    [wire(5, var("hot", flags=RISING)), to("rose", wire(5)), to("rose2", wire(5))],
    [to("both", wire(2, box("OR", var("hot"), var("cold")))), to("never", box("AND", wire(2), val("FALSE", "BOOL")))],
]), "twin": """PROGRAM MAIN
VAR
  n : INT;
  hot, cold, latched, alarm, both, never, calm, rest, mild, rose, rose2, flip, flop, turn, was : BOOL;
  trig : R_TRIG;
END_VAR
n := (n + 3) MOD 10;
hot := n > 6;
IF hot AND n < 9 THEN latched := TRUE; END_IF
alarm := NOT hot;
cold := n < 2;
IF cold THEN latched := FALSE; END_IF
calm := NOT hot;
rest := NOT hot AND latched;
mild := NOT (hot OR cold);
flip := NOT flip;
flop := flip;
was := turn;
turn := NOT turn;
trig(CLK := hot);
rose := trig.Q;
rose2 := trig.Q;
both := hot OR cold;
never := FALSE;
END_PROGRAM
"""}

CASES["drawn_ladder"] = {"MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	n, k, runs : INT;
	start, stop, thermal, motor, lamp, fault, blink, hold, always, third, held, counted : BOOL;
	tofHeld : TOF;
END_VAR
""", "Ld", [
    [box("ADD", RAIL, val("n"), val("1"), names=("EN",), out_names=("ENO", ""), out_types=("BOOL", "INT"),
         outputs=(None, var("n", "INT")), en=True, call="Add")],
    [to("start", box("EQ", RAIL, val("n MOD 9"), val("2"), names=("EN",), out_names=("",), out_types=("BOOL",),
                     outputs=(None,), en=True, call="Eq"))],
    [to("stop", box("EQ", RAIL, val("n MOD 9"), val("7"), names=("EN",), out_names=("",), out_types=("BOOL",),
                    outputs=(None,), en=True, call="Eq"))],
    ([to("motor", box("AND", box("OR", var("start"), var("motor")), var("stop", flags=NEGATED),
                      var("thermal", flags=NEGATED)))], {"title": "Motor", "comment": "seals itself in"}),
    [to(["lamp", var("blink", flags=NEGATED)], parallel(var("motor"), var("start", flags=NEGATED), var("stop")))],
    [to(var("fault", flags=SET), box("AND", var("motor", flags=FALLING), val("n > 12", "BOOL")))],
    [to(var("fault", flags=RESET), var("start", flags=RISING))],
    [to("hold", parallel(None, box("AND", var("motor"), var("lamp")), var("fault")))],
    [to("always", RAIL)],
    # Boxes in the ways of a branch begin with what feeds it; what they give is their output.
    [to("held", parallel(box("AND", var("motor"), var("stop", flags=NEGATED)),
                         fb("TOF", "tofHeld", {"IN": RAIL, "PT": val("T#20ms", "TIME")}, {"Q": None, "ET": ""},
                            ("BOOL", "TIME"))))],
    [to("counted", parallel(var("motor"), box("ADD", RAIL, val("k"), val("1"), names=("EN",), out_names=("ENO", ""),
                                               out_types=("BOOL", "INT"), outputs=(None, var("k", "INT")), en=True,
                                               call="Add"),
                            box("EQ", val("n"), val("5"))))],
    # The jump is one of a negated value.
    [to(var("Over", flags=JUMP | NEGATED), var("motor"), JUMP)],
    [box("ADD", RAIL, val("runs"), val("1"), names=("EN",), out_names=("ENO", ""), out_types=("BOOL", "INT"),
         outputs=(None, var("runs", "INT")), en=True, call="Add")],
    ([to("third", ("terminator", box("AND", var("motor"), parallel(var("lamp"), var("start"), var("hold")))))], {"label": "Over"}),
]), "twin": """PROGRAM MAIN
VAR
  n, k, runs : INT;
  start, stop, thermal, motor, lamp, fault, blink, hold, always, third, held, counted : BOOL;
  tofHeld : TOF;
  fell : F_TRIG; rose : R_TRIG;
END_VAR
n := n + 1;
start := n MOD 9 = 2;
stop := n MOD 9 = 7;
motor := (start OR motor) AND NOT stop AND NOT thermal;
lamp := motor AND (NOT start OR stop);
blink := NOT (motor AND (NOT start OR stop));
fell(CLK := motor);
IF fell.Q AND n > 12 THEN fault := TRUE; END_IF
rose(CLK := start);
IF rose.Q THEN fault := FALSE; END_IF
hold := (motor AND lamp) OR fault;
always := TRUE;
tofHeld(IN := motor AND NOT stop, PT := T#20ms);
held := tofHeld.Q;
IF motor THEN k := k + 1; END_IF
counted := motor;
IF motor THEN runs := runs + 1; END_IF
third := motor AND lamp AND (start OR hold);
END_PROGRAM
"""}

CASES["drawn_rung_boxes"] = {"MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	n, k, state, copy : INT;
	run, done, reset, full, moved : BOOL;
	tonFill : TON;
	ctuFill : CTU;
END_VAR
""", "Ld", [
    [box("ADD", RAIL, val("n"), val("1"), names=("EN",), out_names=("ENO", ""), out_types=("BOOL", "INT"),
         outputs=(None, var("n", "INT")), en=True, call="Add")],
    [to("run", box("LT", RAIL, val("n MOD 8"), val("6"), names=("EN",), out_names=("",), out_types=("BOOL",),
                   outputs=(None,), en=True, call="Lt"))],
    [to("done", fb("TON", "tonFill", {"IN": var("run"), "PT": val("T#20ms", "TIME")},
                   {"Q": None, "ET": ""}, ("BOOL", "TIME")))],
    [to("full", fb("CTU", "ctuFill", {"CU": var("done"), "RESET": var("reset"), "PV": val("2")},
                   {"Q": None, "CV": var("k", "INT")}, ("BOOL", "INT")))],
    [to("reset", box("AND", var("full"), var("run", flags=NEGATED)))],
    # MOVE gets its EN from the ENO of another one.
    [box("MOVE",
         box("MOVE", var("full"), val("n"), names=("EN",), out_names=("ENO", ""), out_types=("BOOL", "INT"),
             outputs=(None, var("state", "INT")), en=True, call="Move"),
         val("state"), names=("EN",), out_names=("ENO", ""), out_types=("BOOL", "INT"),
         outputs=("moved", var("copy", "INT")), en=True, call="Move")],
]), "twin": """PROGRAM MAIN
VAR
  n, k, state, copy : INT;
  run, done, reset, full, moved : BOOL;
  tonFill : TON;
  ctuFill : CTU;
END_VAR
n := n + 1;
run := n MOD 8 < 6;
tonFill(IN := run, PT := T#20ms, Q => done);
ctuFill(CU := done, RESET := reset, PV := 2, Q => full, CV => k);
reset := full AND NOT run;
IF full THEN state := n; copy := state; END_IF
moved := full;
END_PROGRAM
"""}

CASES["drawn_members"] = {"FB_Count": pou("FB_Count", """FUNCTION_BLOCK FB_Count
VAR_INPUT
	bUp : BOOL;
END_VAR
VAR_OUTPUT
	nValue : INT;
END_VAR
VAR
	bSeen : BOOL;
END_VAR
""", "Fbd", [
    [to(var("bSeen"), box("AND", var("bUp"), var("bSeen", flags=NEGATED)))],
    [to(var("nValue", "INT"), box("Next", var("bSeen"), val("nValue"), names=("step", "from"), out_names=("Next",),
                                  out_types=("INT",), outputs=(None,), call="Method"))],
], members=[
    ("Method", "Next", """METHOD Next : INT
VAR_INPUT
	step : BOOL;
	from : INT;
END_VAR
""", "Fbd", [[to(var("Next", "INT"), box("SEL", var("step"), val("from"), box("ADD", val("from"), val("1"))))]]),
    ("Action", "Clear", "", "Ld", [[box("MOVE", RAIL, val("0"), names=("EN",), out_names=("ENO", ""),
                                         out_types=("BOOL", "INT"), outputs=(None, var("nValue", "INT")), en=True,
                                         call="Move")]]),
]), "MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	fbCount : FB_Count;
	n, seen : INT;
END_VAR
""", "ST", """n := n + 1;
fbCount(bUp := n MOD 2 = 1, nValue => seen);
IF n = 30 THEN
	fbCount.Clear();
END_IF"""), "twin": """FUNCTION_BLOCK FB_Count
VAR_INPUT bUp : BOOL; END_VAR
VAR_OUTPUT nValue : INT; END_VAR
VAR bSeen : BOOL; END_VAR
METHOD Next : INT
VAR_INPUT step : BOOL; from : INT; END_VAR
Next := SEL(step, from, from + 1);
END_METHOD
ACTION Clear: nValue := 0; END_ACTION
bSeen := bUp AND NOT bSeen;
nValue := Next(bSeen, nValue);
END_FUNCTION_BLOCK
PROGRAM MAIN
VAR fbCount : FB_Count; n, seen : INT; END_VAR
n := n + 1;
fbCount(bUp := n MOD 2 = 1, nValue => seen);
IF n = 30 THEN fbCount.Clear(); END_IF
END_PROGRAM
"""}

CASES["drawn_calls"] = {"FB_Valve": pou("FB_Valve", """FUNCTION_BLOCK FB_Valve
VAR
	bOpen : BOOL;
	nMoves : INT;
END_VAR
""", "ST", "", members=[
    ("Method", "Open", """METHOD Open : BOOL
VAR_INPUT
	bForce : BOOL;
END_VAR
""", "Fbd", [[to(var("bOpen", flags=SET), val("bForce OR nMoves < 3", "BOOL"))],
             [to(var("nMoves", "INT"), box("ADD", val("nMoves"), val("1")))],
             [to("Open", var("bOpen"))]]),
]), "F_Scale": pou("F_Scale", """FUNCTION F_Scale : INT
VAR_INPUT
	nRaw, nFactor : INT;
END_VAR
""", "Fbd", [[to(var("F_Scale", "INT"), box("MUL", val("nRaw"), val("nFactor")))]]),
    "MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	fbValve : FB_Valve;
	n, scaled, more, most : INT;
	opened, ok : BOOL;
END_VAR
""", "Ld", [
    [box("ADD", RAIL, val("n"), val("1"), names=("EN",), out_names=("ENO", ""), out_types=("BOOL", "INT"),
         outputs=(None, var("n", "INT")), en=True, call="Add")],
    # A method of an instance, gated: ENO is the first output, its result the second.
    [box("fbValve.Open", box("EQ", RAIL, val("n MOD 5"), val("0"), names=("EN",), out_names=("",),
                             out_types=("BOOL",), outputs=(None,), en=True, call="Eq"),
         val("n > 20", "BOOL"), names=("EN", "bForce"), out_names=("ENO", "Open"), out_types=("BOOL", "BOOL"),
         outputs=("ok", "opened"), en=True, call="Method")],
    [box("F_Scale", RAIL, val("n"), val("3"), names=("EN", "nRaw", "nFactor"), out_names=("ENO", "F_Scale"),
         out_types=("BOOL", "INT"), outputs=("", var("scaled", "INT")), en=True, call="Function")],
    # A program, twice: it is its own instance.
    [box("P_Sum", val("n"), names=("nPart",), out_names=("nSum",), out_types=("INT",),
         outputs=(var("more", "INT"),), call="Program")],
    [box("P_Sum", val("3"), names=("nPart",), out_names=("nSum",), out_types=("INT",),
         outputs=(var("most", "INT"),), call="Program")],
]), "P_Sum": pou("P_Sum", """PROGRAM P_Sum
VAR_INPUT
	nPart : INT;
END_VAR
VAR_OUTPUT
	nSum : INT;
END_VAR
""", "Fbd", [[to(var("nSum", "INT"), box("ADD", val("nSum"), val("nPart")))]]), "twin": """FUNCTION_BLOCK FB_Valve
VAR bOpen : BOOL; nMoves : INT; END_VAR
METHOD Open : BOOL
VAR_INPUT bForce : BOOL; END_VAR
IF bForce OR nMoves < 3 THEN bOpen := TRUE; END_IF
nMoves := nMoves + 1;
Open := bOpen;
END_METHOD
END_FUNCTION_BLOCK
FUNCTION F_Scale : INT
VAR_INPUT nRaw, nFactor : INT; END_VAR
F_Scale := nRaw * nFactor;
END_FUNCTION
PROGRAM MAIN
VAR fbValve : FB_Valve; n, scaled, more, most : INT; opened, ok : BOOL; END_VAR
n := n + 1;
ok := n MOD 5 = 0;
IF ok THEN opened := fbValve.Open(bForce := n > 20); END_IF
scaled := F_Scale(n, 3);
P_Sum(nPart := n);
more := P_Sum.nSum;
P_Sum(nPart := 3);
most := P_Sum.nSum;
END_PROGRAM
PROGRAM P_Sum
VAR_INPUT nPart : INT; END_VAR
VAR_OUTPUT nSum : INT; END_VAR
nSum := nSum + nPart;
END_PROGRAM
"""}


def action(name, text):
    return ("Action", name, "", "ST", text)


CASES["drawn_chart"] = {"MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	n, fills, stirs, drains, entered, left_ : INT;
	log : STRING(200);
END_VAR
""", "SFC", [
    step("Init", InitStep=True, MainAction="Count", Comment="waits"),
    when("n >= 3"),
    step("Fill", EntryAction="Open", MainAction="Filling", ExitAction="Close"),
    when("fills >= 4", "full"),
    # Stays for 30 ms at least, whatever its transition says.
    step("Rest", MinTime="T#30ms", MaxTime="T#1s"),
    when("Rested"),
    step("Drain", ("Draining", "N")),
    when("drains >= 2"),
    jump("Init"),
], members=[action("Close", "left_ := left_ + 1;\nlog := CONCAT(log, 'c');"),
            action("Count", "n := n + 1;"), action("Draining", "drains := drains + 1;\nlog := CONCAT(log, 'd');"),
            action("Filling", "fills := fills + 1;\nlog := CONCAT(log, 'f');"),
            action("Open", "entered := entered + 1;\nlog := CONCAT(log, 'o');"),
            ("Transition", "Rested", "", "ST", "Rested := n > 0 AND fills > 0;")]), "twin": """PROGRAM MAIN
VAR
  n, fills, stirs, drains, entered, left_ : INT;
  log : STRING(200);
  at_, since : INT;
END_VAR
// One scan is 10 ms. at_: 0 Init, 1 Fill, 2 Rest, 3 Drain; a chart tries its transitions first.
IF since > 0 THEN
  IF at_ = 0 AND n >= 3 THEN
    at_ := 1; since := 0; entered := entered + 1; log := CONCAT(log, 'o');
  ELSIF at_ = 1 AND fills >= 4 THEN
    at_ := 2; since := 0; left_ := left_ + 1; log := CONCAT(log, 'c');
  ELSIF at_ = 2 AND n > 0 AND fills > 0 AND since >= 3 THEN
    at_ := 3; since := 0;
  ELSIF at_ = 3 AND drains >= 2 THEN
    at_ := 0; since := 0;
    drains := drains + 1; log := CONCAT(log, 'd');  // an IEC action has its final scan
  END_IF
END_IF
since := since + 1;
CASE at_ OF
  0: n := n + 1;
  1: fills := fills + 1; log := CONCAT(log, 'f');
  3: drains := drains + 1; log := CONCAT(log, 'd');
END_CASE
END_PROGRAM
"""}

CASES["drawn_chart_branches"] = {"MAIN": pou("MAIN", """PROGRAM MAIN
VAR
	n, left_, rights, short_, long_, boths, laps : INT;
END_VAR
""", "SFC", [
    step("Start", InitStep=True, EntryAction="Lap"),
    either([when("laps MOD 2 = 0"), step("Short", EntryAction="CountShort"), when("TRUE")],
           [when("laps MOD 3 = 0"), step("Long", EntryAction="CountLong"), when("TRUE"),
            step("Longer"), when("TRUE")],
           [when("laps = 1"), jump("Start")],
           [when("TRUE")]),
    beside([step("Left", MainAction="CountLeft"), when("left_ MOD 3 = 0"), step("LeftDone")],
           [step("Right", EntryAction="CountRight")]),
    when("rights > 0"),
    step("Both", EntryAction="CountBoth"),
    when("TRUE"),
    jump("Start"),
], members=[action("CountBoth", "boths := boths + 1;"), action("CountLeft", "left_ := left_ + 1;"),
            action("CountLong", "long_ := long_ + 1;"), action("CountRight", "rights := rights + 1;"),
            action("CountShort", "short_ := short_ + 1;"), action("Lap", "laps := laps + 1;")]),
    "twin": """PROGRAM MAIN
VAR
  n, left_, rights, short_, long_, boths, laps : INT;
  at_ : INT := -1;
  new_ : INT;
  l_done : BOOL;
END_VAR
// at_: 0 Start, 1 Short, 2 Long, 3 Longer, 4 Left and Right, 5 LeftDone and Right, 6 Both
new_ := at_;
CASE at_ OF
  -1: new_ := 0;
  0:
    IF laps MOD 2 = 0 THEN new_ := 1;
    ELSIF laps MOD 3 = 0 THEN new_ := 2;
    ELSIF laps = 1 THEN new_ := 10;
    ELSE new_ := 4;
    END_IF
  1: new_ := 4;
  2: new_ := 3;
  3: new_ := 4;
  4: IF left_ MOD 3 = 0 THEN new_ := 5; END_IF
  5: IF rights > 0 THEN new_ := 6; END_IF
  6: new_ := 0;
END_CASE
IF new_ <> at_ THEN
  IF new_ = 0 OR new_ = 10 THEN laps := laps + 1; END_IF
  IF new_ = 1 THEN short_ := short_ + 1; END_IF
  IF new_ = 2 THEN long_ := long_ + 1; END_IF
  IF new_ = 4 THEN rights := rights + 1; END_IF
  IF new_ = 6 THEN boths := boths + 1; END_IF
END_IF
at_ := SEL(new_ = 10, new_, 0);
IF at_ = 4 THEN left_ := left_ + 1; END_IF
END_PROGRAM
"""}


def main(folder):
    for name, files in CASES.items():
        for file, text in files.items():
            path = os.path.join(folder, "drawn", name + ".st") if file == "twin" else \
                os.path.join(folder, "twincat", name, file + ".TcPOU")
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8", newline="\n") as out:
                out.write(text)


if __name__ == "__main__":
    main(sys.argv[1])
