"""What the product said and did, held against the oracle."""

import math
import re

from kinds import Layout, REALS, Reference, Scalar, real_of
from oracle import Fate, Oracle


def compare(old, new, written, answer):
    """Texts of what differs; none: the two agree."""
    return Comparison(old, new, written, answer).findings


class Comparison:
    def __init__(self, old, new, written, answer):
        self.old, self.new, self.answer = old, new, answer
        self.findings = []
        self.areas = {}
        self.shown = {}  # by old path: what the report calls it
        for line in answer['variables']:
            self.shown.setdefault(line.get('old_variable'), []).append(line['variable'])
        old_leaves = old.leaves()
        before = self.snapshot(old, old_leaves, answer['before'])
        self.oracle = Oracle(old, new, before)
        self.values()
        self.fates()
        self.losses()
        self.rows()
        self.undo(written)

    def say(self, text):
        self.findings.append(text)

    def snapshot(self, version, leaves, rows):
        """The variables' values, by path; a variable that only one side knows is a finding."""
        for path in rows.keys() - leaves.keys() - {'never'}:
            self.say(f'`{path}` is a variable of the product alone')
        for path in leaves.keys() - rows.keys():
            self.say(f'`{path}` is no variable of the product')
        return snapshot(version, leaves, rows)

    def values(self):
        leaves = self.oracle.new_leaves
        after = self.snapshot(self.new, leaves, self.answer['after'])
        for fate in self.oracle.fates:
            if fate.path not in leaves or 'dropped' in fate.fates or not fate.told:
                continue
            if not same(leaves[fate.path].type, after[fate.path], fate.value):
                was = self.oracle.before.get(fate.old_path)
                self.say(f'`{fate.path}` is {after[fate.path]} behind the switch, should be '
                         f'{fate.value} ({fate.fates[0]}, was {was} in `{fate.old_path}`)')

    # --- the report ---

    def fates(self):
        lines = {}
        for line in self.answer['variables']:
            lines.setdefault(line['variable'], []).append(line)
        for fate in self.oracle.fates:
            found = [one for one in lines.get(fate.path, []) if one['fate'] in fate.fates]
            if 'dropped' in fate.fates and not found:
                found = self.dropped(lines, fate)
            if not found:
                said = [one['fate'] for one in lines.get(fate.path, [])]
                self.say(f'`{fate.path}` is {" and ".join(said) or "nothing"} in the report, '
                         f'should be {" or ".join(fate.fates)} (`{fate.old_path}`)')
                continue
            self.line(fate, found[0])

    def dropped(self, lines, fate):
        """Under the names of the new version, or where another variable took the place."""
        if fate.path in self.oracle.new_leaves:
            return lines.get(fate.path)
        return [one for many in lines.values() for one in many
                if one.get('old_variable') == fate.path]

    def line(self, fate, line):
        if 'dropped' in fate.fates and line['variable'] != fate.old_path and (
                line.get('old_variable') != fate.old_path):
            self.say(f"`{fate.old_path}` goes, the report says `{line['variable']}`, "
                     f"`{line.get('old_variable')}`")
        if fate.old_path and fate.old_path != fate.path and 'dropped' not in fate.fates:
            if line.get('old_variable') != fate.old_path:
                self.say(f"`{fate.path}` was `{fate.old_path}`, the report says "
                         f"`{line.get('old_variable')}`")
        rows = self.answer['after']
        if (fate.path in rows and 'dropped' not in fate.fates and
                line['after'] not in ('', 'its initial value')):
            if line['after'] != rows[fate.path][1]:
                self.say(f"`{fate.path}` becomes {line['after']} by the report, and is "
                         f"{rows[fate.path][1]}")
        moved = line.get('old_address') != line.get('new_address')
        if not fate.old_path:
            return
        if (moved and line['fate'] == 'kept') or (line['fate'] == 'moved' and self.stays(fate)):
            self.say(f"`{fate.path}` is {line['fate']} from {line.get('old_address')} to "
                     f"{line.get('new_address')}")

    def stays(self, fate):
        """A1: its variable has the same type, and no other of its area has another place."""
        if fate.old_path not in self.oracle.old_leaves:
            return False
        old, new = self.oracle.old_leaves[fate.old_path], self.oracle.new_leaves[fate.path]
        if old.address or new.address or old.constant or new.constant:
            return False
        before, after = self.area(self.old, old), self.area(self.new, new)
        if sorted(before.values()) != sorted(after.values()):
            return False  # it may have outgrown its place (A5)
        return before.get(old.root) == after.get(new.root)

    def area(self, version, leaf):
        """The variables of a leaf's area with their types, by path."""
        if id(version) not in self.areas:
            self.areas[id(version)] = version.areas()
        return self.areas[id(version)].get(leaf.area, {})

    def rows(self):
        """Each row of the oracle is in the report, and no other one is."""
        self.attributes()
        told = self.answer['system'] + [
            {'kind': 'program', 'name': one['variable'], 'what': one['reason'], 'fate': True}
            for one in self.answer['fates'] if one['variable'] in self.instances()]
        for row in self.oracle.rows:
            if row.kind in ATTRIBUTES:
                continue
            if not row.may_be_left_out and not any(tells(one, row) for one in told):
                self.say(f'no row for {row.kind} `{row.name}` {row.said}: {told}')
        for one in told:
            if 'fate' not in one and not any(tells(one, row) for row in self.oracle.rows):
                self.say(f"a row too many: {one['kind']} `{one['name']}` {one['what']}")

    def attributes(self):
        """RETAIN and CONSTANT belong to a declaration, and one row stands for all of its instances:
        it names the first, and says how many more there are."""
        counts = {}
        for row in self.oracle.rows:
            if row.kind in ATTRIBUTES:
                key = (row.name.split('.')[-1], row.said)
                counts[key] = counts.get(key, 0) + 1
        for (name, said), count in counts.items():
            told = sum(1 + more(one['what']) for one in self.answer['system']
                       if one['kind'] == 'variable' and one['name'].split('.')[-1] == name and
                       one['what'].startswith(said[0]))
            if told != count:
                self.say(f'{told} of {count} `{name}` are told to be {said[0]}')

    def instances(self):
        """A program that comes or goes is a group of variables in the report."""
        return {one.name for version in (self.old, self.new) for one in version.instances}

    def losses(self):
        listed = [one['variable'] for one in self.answer['losses']]
        whole = self.answer['loss_count'] == len(listed)
        lines = [one['variable'] for one in self.answer['variables'] if one['loss']]
        expected = [one for one in self.oracle.fates if one.loss]
        open_ones = [one for one in self.oracle.fates if one.loss is None]
        for fate in expected:
            if whole and not any(self.covers(path, fate) for path in listed):
                self.say(f'`{fate.path}` is a loss that is not listed')
            if not any(self.covers(path, fate) for path in lines):
                self.say(f'`{fate.path}` is a loss that --all does not show')
        live = [one for one in self.oracle.rows if one.live]
        known = expected + open_ones + [Fate(one.live, one.live, ()) for one in live]
        for one in live:
            if whole and one.live not in listed:
                self.say(f'`{one.live}` is a loss that is not listed')
        for path in listed:
            if not any(self.covers(path, one) for one in known):
                self.say(f'`{path}` is listed as a loss and is none')
        for path in lines:
            if not any(self.covers(path, one) for one in known):
                self.say(f'`{path}` is shown as a loss by --all and is none')
        if (expected or live) and self.answer['switched_without_leave']:
            self.say('values are lost without leave')
        nothing = not expected and not open_ones and not live
        if nothing and not self.answer['switched_without_leave']:
            self.say('leave is needed without a loss: ' + self.answer['refused'])

    def covers(self, path, fate):
        """A loss may be told of a whole variable, and has the names of the new version."""
        names = [fate.path, fate.old_path] + self.shown.get(fate.old_path, [])
        return any(one == path or one.startswith((path + '.', path + '[')) for one in names)

    def undo(self, written):
        expected = self.oracle.undone(written)
        leaves = self.oracle.old_leaves
        undone = self.snapshot(self.old, leaves, self.answer['undone'])
        for path, value in expected.items():
            if '%I' in leaves[path].address or same(leaves[path].type, undone[path], value):
                continue
            self.say(f'`{path}` is {undone[path]} behind undo, should be {value} '
                     f'(was {self.oracle.before[path]})')


def snapshot(version, leaves, rows):
    out = {}
    for path, leaf in leaves.items():
        if path not in rows:
            out[path] = leaf.initial
        elif isinstance(leaf.type, Reference):
            out[path] = None if rows[path][1] == 'NULL' else rows[path][1]
        else:
            out[path] = Layout.decode(version, leaf.type, bytes.fromhex(rows[path][2]))
    return out


KINDS = {'address': ('variable',), 'retain': ('variable',), 'constant': ('variable',),
         'task': ('task',), 'program': ('program',), 'safe': ('output',),
         'output': ('output', 'variable')}


ATTRIBUTES = ('retain', 'constant')


def more(what):
    found = re.search(r'; and ([0-9]+) more like it$', what)
    return int(found.group(1)) if found else 0


def tells(told, row):
    if told['kind'] not in KINDS[row.kind]:
        return False
    text = told['name'] + ' ' + told['what']
    about = told['name'] == row.name or row.kind == 'output' and row.name in text
    return about and all(word in text for word in row.said)


def same(kind, one, other):
    if isinstance(kind, Scalar) and kind.name in REALS and isinstance(other, int):
        if math.isnan(real_of(kind.name, one)):
            return math.isnan(real_of(kind.name, other))
    return one == other
