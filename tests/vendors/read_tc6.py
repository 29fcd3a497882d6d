#!/usr/bin/env python3
"""read_tc6.py DOCUMENT: PLCopen XML (TC6 2.01) as Structured Text and charts as text, by what the schema
says of its elements and nothing of stc's. It reads what programs of drawings are made of; anything
else is an error, so that nothing is left out unseen. addData is not read."""
import re
import sys
import xml.etree.ElementTree as tree


class Unread(Exception):
    pass


def name_of(node):
    return node.tag.rsplit("}", 1)[-1]


def child(node, name):
    found = [one for one in node if name_of(one) == name]
    return found[0] if found else None


def children(node, name=None):
    return [] if node is None else [one for one in node if name is None or name_of(one) == name]


def text_of(node):
    return "".join(node.itertext()).strip()


def flag(node, name):
    return node.get(name) in ("true", "1")


# --- declarations

def type_of(node):
    inner = list(node)[0]
    name = name_of(inner)
    if name == "derived":
        return inner.get("name")
    if name in ("string", "wstring"):
        return name.upper() + (f"[{inner.get('length')}]" if inner.get("length") else "")
    if name == "array":
        limits = ", ".join(f"{one.get('lower')}..{one.get('upper')}" for one in children(inner, "dimension"))
        return f"ARRAY[{limits}] OF {type_of(child(inner, 'baseType'))}"
    if name.isupper() and not len(inner):
        return name
    raise Unread(f"type {name}")


def value_of(node):
    inner = list(node)[0]
    if name_of(inner) == "simpleValue":
        return inner.get("value")
    raise Unread(f"initial value {name_of(inner)}")


SECTIONS = {"inputVars": "VAR_INPUT", "outputVars": "VAR_OUTPUT", "inOutVars": "VAR_IN_OUT", "localVars": "VAR",
            "tempVars": "VAR_TEMP", "externalVars": "VAR_EXTERNAL", "globalVars": "VAR_GLOBAL"}


def declarations(interface, types):
    out = []
    for section in children(interface):
        if name_of(section) in ("documentation", "addData", "returnType"):
            continue
        out += variables(section, types)
    return out


def variables(section, types):
    out = []
    if name_of(section) not in SECTIONS:
        raise Unread(f"section {name_of(section)}")
    words = [word.upper() for word in ("constant", "retain") if flag(section, word)]
    out.append(" ".join([SECTIONS[name_of(section)]] + words))
    for one in children(section, "variable"):
        kind = type_of(child(one, "type"))
        types[one.get("name").upper()] = kind
        start = child(one, "initialValue")
        value = "" if start is None else f" := {value_of(start)}"
        place = f" AT {one.get('address')}" if one.get("address") else ""
        out.append(f"  {one.get('name')}{place} : {kind}{value};")
    out.append("END_VAR")
    return out


# --- ladder and function block diagrams

BOOLS = {"AND", "OR", "XOR", "NOT", "GT", "GE", "EQ", "LE", "LT", "NE"}


class Diagram:
    """Its elements are done one after the other: by executionOrderId where all that do something have
    one, which the order of the document must not contradict; else networks from top to bottom, those
    of a network as the document has them."""

    def __init__(self, body, types, scope):
        self.types = types
        self.scope = scope  # temporary variables of the POU: name -> type
        self.elements = {one.get("localId"): one for one in children(body) if one.get("localId")}
        self.lines = []
        self.values = {}   # (localId, formal parameter) -> text
        self.enabled = {}  # localId of a block with EN -> its condition

    def temporary(self, kind):
        name = f"t_{len(self.scope)}"
        self.scope[name] = kind
        return name

    def links(self, owner):
        point = child(owner, "connectionPointIn")
        return children(point, "connection")

    def network_of(self):
        root = {local: local for local in self.elements}

        def find(local):
            while root[local] != local:
                local = root[local]
            return local
        for local, one in self.elements.items():
            for link in one.iter():
                if name_of(link) != "connection":
                    continue
                other = link.get("refLocalId")
                if other not in self.elements:
                    raise Unread(f"connection to {other}, which is not there")
                if name_of(self.elements[other]) != "leftPowerRail":  # rails connect nothing
                    root[find(local)] = find(other)
        return {local: find(local) for local in self.elements}

    def value(self, link):
        key = (link.get("refLocalId"), link.get("formalParameter") or "")
        one = self.elements[key[0]]
        if name_of(one) == "leftPowerRail":
            return "TRUE"
        if key not in self.values and not key[1]:  # the only output
            own = [value for (local, _), value in self.values.items() if local == key[0]]
            if len(own) == 1:
                return own[0]
        if key not in self.values:
            raise Unread(f"output {key[1]} of {key[0]} is used before it is known")
        return self.values[key]

    def power(self, owner):
        values = [self.value(link) for link in self.links(owner)]
        return " OR ".join(values) if values else "FALSE"

    def store(self, one, target, value, condition=None):
        storage = one.get("storage", "none")
        value = f"NOT ({value})" if flag(one, "negated") else value
        value = self.edge(one, value)
        line = f"{target} := {value};"
        if storage in ("set", "reset"):
            line = f"IF {value} THEN {target} := {'TRUE' if storage == 'set' else 'FALSE'}; END_IF;"
        self.lines.append(f"IF {condition} THEN {line} END_IF;" if condition else line)

    def edge(self, one, value):
        """A value, or whether it has just become TRUE, or FALSE: since it was looked at last."""
        kind = one.get("edge", "none")
        if kind == "none":
            return value
        before, name = self.temporary("BOOL"), self.temporary("BOOL")
        now, then = ("", "NOT ") if kind == "rising" else ("NOT ", "")
        self.lines.append(f"{name} := {now}({value}) AND {then}{before}; {before} := {value};")
        return name

    def result_type(self, word, arguments):
        if word in BOOLS:
            return "BOOL"
        for argument in arguments:
            for name in re.findall(r"[A-Za-z_]\w*", argument):
                known = self.types.get(name.upper()) or self.scope.get(name)
                if known:
                    return known
        raise Unread(f"the type of {word}({', '.join(arguments)})")

    def block(self, one):
        local, kind, instance = one.get("localId"), one.get("typeName"), one.get("instanceName")
        pins, enable = [], None
        for pin in children(child(one, "inOutVariables"), "variable"):
            links = self.links(pin)
            if not instance or len(links) != 1 or flag(pin, "negated"):
                raise Unread("an in-out that is not one variable of an instance")
            pins.append((pin.get("formalParameter"), self.value(links[0])))
        for pin in children(child(one, "inputVariables"), "variable"):
            links = self.links(pin)
            if not links:
                continue
            if len(links) > 1 and name_of(self.elements[links[0].get("refLocalId")]) == "inVariable":
                raise Unread("several values at a pin")
            value = " OR ".join(self.value(link) for link in links)
            value = f"NOT ({value})" if flag(pin, "negated") else value
            if pin.get("storage", "none") != "none":
                raise Unread("a pin that sets or resets")
            value = self.edge(pin, value)
            if pin.get("formalParameter") == "EN":
                enable = self.temporary("BOOL")
                self.lines.append(f"{enable} := {value};")
            else:
                pins.append((pin.get("formalParameter"), value))
        outputs = [pin for pin in children(child(one, "outputVariables"), "variable")]
        if instance:
            call = f"{instance}({', '.join(f'{name} := {value}' for name, value in pins)});"
            for pin in outputs:
                value = enable if pin.get("formalParameter") == "ENO" else f"{instance}.{pin.get('formalParameter')}"
                negated = f"NOT ({value})" if flag(pin, "negated") else value
                self.values[(local, pin.get("formalParameter"))] = negated
        else:
            results = [pin for pin in outputs if pin.get("formalParameter") != "ENO"]
            name = self.temporary(self.result_type(kind.upper(), [value for _, value in pins]))
            call = f"{name} := {kind}({', '.join(value for _, value in pins)});"
            for pin in results[:1]:
                self.values[(local, pin.get("formalParameter") or "")] = (
                    f"NOT ({name})" if flag(pin, "negated") else name)
            if enable:
                self.values[(local, "ENO")] = enable
            if len(results) > 1:
                raise Unread(f"a function {kind} with several results")
        self.lines.append(f"IF {enable} THEN {call} END_IF;" if enable else call)
        if enable:
            self.enabled[local] = enable

    def element(self, one):
        kind, local = name_of(one), one.get("localId")
        if kind in ("leftPowerRail", "rightPowerRail", "comment"):
            return
        if kind == "contact":
            if one.get("storage", "none") != "none":
                raise Unread("a contact that sets or resets")
            negated = "NOT " if flag(one, "negated") else ""
            closed = self.edge(one, f"{negated}({text_of(child(one, 'variable'))})")
            name = self.temporary("BOOL")
            self.lines.append(f"{name} := ({self.power(one)}) AND {closed};")
            self.values[(local, "")] = name
        elif kind == "coil":
            name = self.temporary("BOOL")
            self.lines.append(f"{name} := {self.power(one)};")
            self.values[(local, "")] = name
            self.store(one, text_of(child(one, "variable")), name)
        elif kind == "inVariable":
            text = text_of(child(one, "expression"))
            self.values[(local, "")] = f"NOT ({text})" if flag(one, "negated") else text
        elif kind == "outVariable":
            links = self.links(one)
            if len(links) != 1:
                raise Unread("an outVariable without one connection")
            source = links[0].get("refLocalId")
            self.store(one, text_of(child(one, "expression")), self.value(links[0]), self.enabled.get(source))
        elif kind == "inOutVariable":
            if flag(one, "negatedIn") or flag(one, "negatedOut") or self.links(one):
                raise Unread("an inOutVariable that is negated or written")
            self.values[(local, "")] = text_of(child(one, "expression"))
        elif kind == "block":
            self.block(one)
        elif kind == "label":
            self.lines.append(f"{one.get('label')}:")
        elif kind == "jump":
            self.lines.append(f"IF {self.power(one)} THEN JMP {one.get('label')}; END_IF;")
        elif kind == "return":
            self.lines.append(f"IF {self.power(one)} THEN RETURN; END_IF;")
        else:
            raise Unread(f"an element {kind}")

    def run(self):
        doing = [one for one in self.elements.values() if name_of(one) not in
                 ("leftPowerRail", "rightPowerRail", "comment", "label", "inVariable", "inOutVariable")]
        orders = [int(one.get("executionOrderId") or 0) for one in doing]
        if orders != sorted(orders):
            raise Unread("an order of execution other than that of the document")
        if 0 not in orders:
            for one in self.elements.values():
                self.element(one)
            return self.lines
        networks = {}
        for local, network in self.network_of().items():
            networks.setdefault(network, []).append(self.elements[local])

        def top(elements):
            placed = [one for one in elements if name_of(one) not in ("leftPowerRail", "rightPowerRail", "comment")]
            return min(int(child(one, "position").get("y")) for one in placed or elements)
        for elements in sorted(networks.values(), key=top):
            for one in elements:
                self.element(one)
        return self.lines


# --- charts

class Chart:
    def __init__(self, body, transitions):
        self.nodes = {one.get("localId"): one for one in children(body) if one.get("localId")}
        self.named = transitions
        self.behind = {}  # localId -> those that are connected to it
        for local, one in self.nodes.items():
            if name_of(one) == "actionBlock":
                continue
            for point in children(one, "connectionPointIn"):
                for link in children(point, "connection"):
                    self.behind.setdefault(link.get("refLocalId"), []).append(local)
        self.inside = {}

    def steps_before(self, local):
        one = self.nodes[local]
        if name_of(one) == "step":
            return [one.get("name")]
        if name_of(one) not in ("selectionDivergence", "simultaneousConvergence"):
            raise Unread(f"a {name_of(one)} in front of a transition")
        return [step for before in self.before(one) for step in self.steps_before(before)]

    def before(self, one):
        return [link.get("refLocalId") for point in children(one, "connectionPointIn")
                for link in children(point, "connection")]

    def steps_behind(self, local):
        one = self.nodes[local]
        kind = name_of(one)
        if kind == "step":
            return [one.get("name")]
        if kind == "jumpStep":
            return [one.get("targetName")]
        if kind not in ("simultaneousDivergence", "selectionConvergence"):
            raise Unread(f"a {kind} behind a transition")
        return [step for behind in self.behind.get(local, []) for step in self.steps_behind(behind)]

    def condition(self, one):
        where = child(one, "condition")
        inner = list(where)[0]
        if name_of(inner) == "reference":
            return self.named[inner.get("name").upper()]
        if name_of(inner) == "inline":
            return text_of(child(inner, "ST"))
        raise Unread(f"a condition as {name_of(inner)}")

    def run(self):
        lines, blocks = [], {}
        for one in self.nodes.values():
            if name_of(one) == "actionBlock":
                blocks.setdefault(self.before(one)[0], []).extend(children(one, "action"))
        for local, one in self.nodes.items():
            if name_of(one) != "step":
                continue
            lines.append(("INITIAL_STEP " if flag(one, "initialStep") else "STEP ") + one.get("name") + ":")
            for action in blocks.get(local, []):
                where = child(action, "reference")
                if where is None:
                    raise Unread("an action without a name")
                time = f", {action.get('duration')}" if action.get("duration") else ""
                lines.append(f"  {where.get('name')}({action.get('qualifier', 'N')}{time});")
            lines.append("END_STEP")
        found = [one for one in self.nodes.values() if name_of(one) == "transition"]
        # Of several that leave one step, the one that is further left comes first.
        for one in sorted(found, key=lambda node: int(child(node, "position").get("x"))):
            first = [step for before in self.before(one) for step in self.steps_before(before)]
            last = [step for behind in self.behind.get(one.get("localId"), []) for step in self.steps_behind(behind)]
            rank = f"(PRIORITY := {one.get('priority')}) " if one.get("priority") else ""
            lines.append(f"TRANSITION {rank}FROM {group(first)} TO {group(last)} := {self.condition(one)}; "
                         "END_TRANSITION")
        return lines


def group(names):
    if not names:
        raise Unread("a transition that leads nowhere")
    return names[0] if len(names) == 1 else "(" + ", ".join(names) + ")"


# --- POUs

def body_lines(body, types, scope, transitions):
    inner = [one for one in body if name_of(one) not in ("documentation", "addData")][0]
    kind = name_of(inner)
    if kind in ("ST", "IL"):
        return [text_of(inner)]
    if kind in ("LD", "FBD"):
        return Diagram(inner, types, scope).run()
    if kind == "SFC":
        return Chart(inner, transitions).run()
    raise Unread(f"a body in {kind}")


WORDS = {"program": "PROGRAM", "functionBlock": "FUNCTION_BLOCK", "function": "FUNCTION"}


def pou(one):
    types, scope = {}, {}
    word = WORDS[one.get("pouType")]
    interface = child(one, "interface")
    declared = declarations(interface, types)
    result = child(interface, "returnType")
    head = f"{word} {one.get('name')}" + ("" if result is None else f" : {type_of(result)}")
    transitions = {each.get("name").upper(): text_of(child(child(each, "body"), "ST"))
                   for each in children(child(one, "transitions"), "transition")}
    lines = []
    for each in children(child(one, "actions"), "action"):
        inside = body_lines(child(each, "body"), types, scope, transitions)
        lines += [f"ACTION {each.get('name')}:"] + inside + ["END_ACTION"]
    inside = body_lines(child(one, "body"), types, scope, transitions)
    temporary = ["VAR"] + [f"  {name} : {kind};" for name, kind in scope.items()] + ["END_VAR"] if scope else []
    return [head] + declared + temporary + lines + inside + [f"END_{word}"]


def configuration(one):
    out = [f"CONFIGURATION {one.get('name')}"]
    for section in children(one, "globalVars"):
        out += variables(section, {})
    for resource in children(one, "resource"):
        out.append(f"RESOURCE {resource.get('name')} ON PLC")
        for section in children(resource, "globalVars"):
            out += variables(section, {})
        programs = [(None, each) for each in children(resource, "pouInstance")]
        for task in children(resource, "task"):
            when = f"INTERVAL := {task.get('interval')}" if task.get("interval") else f"SINGLE := {task.get('single')}"
            out.append(f"  TASK {task.get('name')}({when}, PRIORITY := {task.get('priority')});")
            programs += [(task.get("name"), each) for each in children(task, "pouInstance")]
        for task, each in programs:
            with_task = f" WITH {task}" if task else ""
            out.append(f"  PROGRAM {each.get('name')}{with_task} : {each.get('typeName')};")
        out.append("END_RESOURCE")
    return out + ["END_CONFIGURATION"]


def main(path):
    root = tree.parse(path).getroot()
    out = []
    if children(child(child(root, "types"), "dataTypes")):
        raise Unread("types")
    for one in children(child(child(root, "types"), "pous"), "pou"):
        out += pou(one)
    for one in children(child(child(root, "instances"), "configurations")):
        out += configuration(one)
    print("\n".join(out))


try:
    main(sys.argv[1])
except Unread as what:
    print(f"{sys.argv[1]}: not read: {what}", file=sys.stderr)
    sys.exit(3)
