"""What the editors of Beremiz and OpenPLC need of a document of PLCopen XML, which no schema says.

usage: for_editors.py DOCUMENT...
"""
import re
import sys
import xml.etree.ElementTree as tree

XHTML = "{http://www.w3.org/1999/xhtml}"
BOUND = re.compile(r"(<xhtml:p>)?<!\[CDATA\[")


def plain(element):
    return element.tag.rsplit("}", 1)[-1]


def point(element):
    return (int(element.get("x")), int(element.get("y")))


def pins(element):
    """Places of the pins of one element, by pin and by its kind and name."""
    origin = None
    for child in element:
        if plain(child) == "position":
            origin = point(child)
    out = {}

    def add(pin, name):
        inside = [child for child in pin if plain(child) == "relPosition"]
        if not inside:
            raise ValueError(f"no relPosition at {plain(element)} {element.get('localId')}")
        x, y = point(inside[0])
        out.setdefault((plain(pin), name), []).append((origin[0] + x, origin[1] + y))
        out[(id(pin),)] = (origin[0] + x, origin[1] + y)

    for child in element.iter():
        if plain(child) == "variable" and child.get("formalParameter") is not None:
            for pin in child:
                if plain(pin).startswith("connectionPoint"):
                    add(pin, child.get("formalParameter"))
    for child in list(element) + [each for own in element if plain(own) == "condition" for each in own]:
        if plain(child).startswith("connectionPoint"):
            add(child, child.get("formalParameter") or "")
    return out


def check_body(body):
    by_id = {}
    for element in body:
        if element.get("localId") is None or plain(element) == "vendorElement":
            continue
        if element.get("width") is None or element.get("height") is None:
            raise ValueError(f"no size of {plain(element)} {element.get('localId')}")
        by_id[element.get("localId")] = (element, pins(element))
    wires = 0
    for element, places in by_id.values():
        named = [v for v in element.iter() if plain(v) == "variable" and "formalParameter" in v.attrib]
        names = [v.get("formalParameter") for v in named]
        method = "." in (element.get("typeName") or "")  # other tools have none, nor addresses
        if element.get("instanceName") is None and "" in names and not method and element.get("typeName") not in ("ADR", "SIZEOF"):
            raise ValueError(f"a pin of {element.get('typeName')} has no name")
        for pin in element.iter():
            if plain(pin) != "connectionPointIn":
                continue
            for wire in pin:
                if plain(wire) != "connection":
                    continue
                way = [point(each) for each in wire if plain(each) == "position"]
                if len(way) < 2:
                    raise ValueError(f"a wire to {element.get('localId')} has {len(way)} points")
                if way[0] != places[(id(pin),)]:
                    raise ValueError(f"a wire to {element.get('localId')} ends beside its pin")
                source = by_id[wire.get("refLocalId")][1]
                action = "Action" if plain(element) == "actionBlock" else ""
                kind = "connectionPointOut" + action
                begins = source.get((kind, wire.get("formalParameter") or ""))
                if begins is None:  # the only one, whatever it is called
                    given = [place for key, place in source.items() if key[0:1] == (kind,)]
                    if not given and plain(by_id[wire.get("refLocalId")][0]) == "jumpStep":
                        continue  # of a wrong document
                    [begins] = given
                if way[-1] not in begins:
                    raise ValueError(f"a wire from {wire.get('refLocalId')} begins beside its pin")
                wires += 1
    return wires


def main():
    wires = texts = 0
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as file:
            text = file.read()
        try:
            for bound in BOUND.finditer(text):
                if bound[1] is None:
                    raise ValueError("CDATA that is not directly behind <xhtml:p>")
            root = tree.fromstring(text)
            for element in root.iter():
                if plain(element) in ("LD", "FBD", "SFC"):
                    wires += check_body(element)
                if plain(element) in ("ST", "IL", "content", "documentation"):
                    if len(element) and element[0].tag != XHTML + "p":
                        raise ValueError(f"the text of {plain(element)} is in no <xhtml:p>")
                    texts += 1
        except (ValueError, KeyError) as error:
            print(f"{path}: {error}")
            sys.exit(1)
    print(f"{len(sys.argv) - 1} documents, {wires} wires, {texts} texts")


main()
