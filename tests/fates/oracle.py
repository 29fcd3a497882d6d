"""The fate of every variable when one version of a program becomes another: written from the
requirements A1, A14, A15, X1 and X2, and knowing nothing of the planner."""

import dataclasses
from dataclasses import dataclass

from conversions import convert
from kinds import (INTEGERS, Array, Block, Enumeration, Reference, Scalar, Structure,
                   integer_range)
from rows import rows
from version import bits_at, indices, rules


@dataclass
class Fate:
    path: str           # in the new version; of what is dropped: in the old one
    old_path: str       # '' for what is added
    fates: tuple        # those that are right
    value: object = None
    told: bool = True   # False: the oracle does not say which value
    loss: object = False  # None: it does not say


class Oracle:
    def __init__(self, old, new, before):
        """before: the value of each variable of the old version, by its path."""
        self.old, self.new, self.before = old, new, before
        self.pairs = []       # (path, old declaration, new one) of variables that go on
        self.old_leaves, self.new_leaves = old.leaves(), new.leaves()
        self.fates = []
        self.place = {}       # old path -> the new path with the same bits, for references
        self.replaced = []    # old path, new path: instances that got another type
        self.gathered = []    # new path, bit, old path, bit: what stays at its address
        self.block_rules = rules(list(old.blocks.values()), list(new.blocks.values()))
        self.type_rules = rules(list(old.types.values()), list(new.types.values()))
        self._globals()
        self._statics()
        self._programs()
        self._addresses()
        self._references()
        self.rows = rows(old, new, before, self.pairs)

    # --- areas ---

    def _globals(self):
        self._scope('', self.old.globals, '', self.new.globals)

    def _statics(self):
        for block in self.old.blocks.values():
            after = self._block_after(block.name)
            self._scope(block.name + '.', block.statics, (after or block.name) + '.',
                        self.new.blocks[after].statics if after else [])
        for block in self.new.blocks.values():
            if block.name not in self.block_rules:
                self._scope('', [], block.name + '.', block.statics)

    def _block_after(self, old_name):
        return next((new for new, old in self.block_rules.items() if old == old_name), None)

    def _programs(self):
        continued = rules(self.old.instances, self.new.instances)
        known = {one.name: one for one in self.old.instances}
        for one in self.new.instances:
            kind = self.new.blocks[one.type]
            if one.name in continued:
                before = known[continued[one.name]]
                self._blocks(self.old.blocks[before.type], before.name, kind, one.name)
            else:
                self._fresh(kind, one.name)
        gone = set(known) - set(continued.values())
        for name in gone:
            self._gone(self.old.blocks[known[name].type], name)

    def _scope(self, old_prefix, old_variables, new_prefix, new_variables):
        lasting = [one for one in old_variables if one.section != 'VAR_TEMP']
        continued = rules(lasting, [one for one in new_variables if one.section != 'VAR_TEMP'])
        known = {one.name: one for one in lasting}
        for one in new_variables:
            if one.section == 'VAR_TEMP':
                continue
            if one.name in continued:
                before = known[continued[one.name]]
                self.pairs.append((new_prefix + one.name, before, one))
                self._pair(before.type, old_prefix + before.name, one.type, new_prefix + one.name)
            else:
                self._fresh(one.type, new_prefix + one.name)
        for name in set(known) - set(continued.values()):
            self._gone(known[name].type, old_prefix + name)

    # --- pairs ---

    def _pair(self, old_kind, old_path, new_kind, new_path):
        old_kind, new_kind = self.old.resolve(old_kind), self.new.resolve(new_kind)
        if isinstance(old_kind, Array) and isinstance(new_kind, Array):
            self._arrays(old_kind, old_path, new_kind, new_path)
        elif isinstance(old_kind, Structure) and isinstance(new_kind, Structure):
            self._structures(old_kind, old_path, new_kind, new_path)
        elif isinstance(old_kind, Block) and isinstance(new_kind, Block):
            self._blocks(old_kind, old_path, new_kind, new_path)
        elif is_leaf(old_kind) and is_leaf(new_kind):
            self._leaf(old_kind, old_path, new_kind, new_path)
        else:
            self._replace(old_kind, old_path, new_kind, new_path)

    def _replace(self, old_kind, old_path, new_kind, new_path):
        """No rule: the new initial value, and every value of the old one is lost."""
        self.replaced.append((old_path, new_path))
        self._gone(old_kind, old_path)
        self._fresh(new_kind, new_path)

    def _arrays(self, old_kind, old_path, new_kind, new_path):
        if len(old_kind.bounds) != len(new_kind.bounds):
            return self._replace(old_kind, old_path, new_kind, new_path)
        before, after = indices(old_kind.bounds), indices(new_kind.bounds)
        for index in after:
            at = f"[{','.join(map(str, index))}]"
            if index in set(before):
                self._pair(old_kind.element, old_path + at, new_kind.element, new_path + at)
            else:
                self._fresh(new_kind.element, new_path + at)
        for index in set(before) - set(after):
            self._gone(old_kind.element, f"{old_path}[{','.join(map(str, index))}]")

    def _structures(self, old_kind, old_path, new_kind, new_path):
        if old_kind.union != new_kind.union:
            return self._replace(old_kind, old_path, new_kind, new_path)
        if old_kind.union:
            return self._unions(old_kind, old_path, new_kind, new_path)
        # Rules of members are those of the type: they mean nothing where it is another one.
        same = self.type_rules.get(new_kind.name) == old_kind.name
        members = new_kind.members if same else without_rules(new_kind.members)
        self._scope(old_path + '.', old_kind.members, new_path + '.', members)

    def _unions(self, old_kind, old_path, new_kind, new_path):
        """Members that live on keep the bytes (case 74). One that goes or comes is another view of
        the same bytes, so it has no value of its own to lose or to begin with. But when no member
        lives on, or one with another type, the union begins anew."""
        same = self.type_rules.get(new_kind.name) == old_kind.name
        continued = rules(old_kind.members,
                          new_kind.members if same else without_rules(new_kind.members))
        known = {one.name: one for one in old_kind.members}
        kept = [one for one in new_kind.members if one.name in continued and
                known[continued[one.name]].type == one.type]
        if not kept or len(kept) != len(continued):
            return self._replace(old_kind, old_path, new_kind, new_path)
        for one in new_kind.members:
            before = continued.get(one.name)
            if one in kept:
                self._pair(known[before].type, f'{old_path}.{before}', one.type,
                           f'{new_path}.{one.name}')
            else:
                self._view(one.type, f'{new_path}.{one.name}')
        for name in set(known) - {continued[one.name] for one in kept}:
            for leaf in self._under(self.old_leaves, f'{old_path}.{name}'):
                self.fates.append(Fate(leaf.path, leaf.path, ('dropped',)))

    def _view(self, kind, path):
        for leaf in self._under(self.new_leaves, path):
            self.fates.append(Fate(leaf.path, '', ('initialised', 'kept', 'moved', 'converted'),
                                   told=False))

    def _blocks(self, old_kind, old_path, new_kind, new_path):
        if self.block_rules.get(new_kind.name) != old_kind.name:
            return self._replace(old_kind, old_path, new_kind, new_path)
        self._scope(old_path + '.', self.old.members(old_kind), new_path + '.',
                    self.new.members(new_kind))

    def _leaf(self, old_kind, old_path, new_kind, new_path):
        old, new = self.old_leaves[old_path], self.new_leaves[new_path]
        value = self.before[old_path]
        if isinstance(old_kind, Reference) or isinstance(new_kind, Reference):
            return self._reference(old_kind, old_path, new_kind, new_path, value)
        rule, result, exact = convert(old_kind, value, new_kind, new.initial,
                                      self._literals(old_kind, new_kind))
        fate = Fate(new_path, old_path, {
            'same': ('kept', 'moved'), 'number': ('kept', 'moved', 'converted'),
            'converted': ('converted',),
            'none': ('initialised',)}[rule], result, loss=not exact)
        if rule in ('same', 'number'):
            self.place[old_path] = new_path
        if new.constant:   # case 12: what the source says
            fate.fates = ('initialised', 'kept', 'moved', 'converted')
            fate.loss = not old.constant and (new.initial != result or not exact)
            fate.value = new.initial
        elif old.constant:  # nothing live; A1 keeps the value of what has the same name and type
            fate.loss = None if rule == 'converted' else False
        if '%I' in new.address and '%I' not in old.address:  # from now on the plant says it
            fate.fates, fate.told, fate.loss = ('initialised',), False, True
        elif '%I' in new.address:
            fate.told, fate.loss = False, False
        self.fates.append(fate)

    def _literals(self, old_kind, new_kind):
        if not (isinstance(old_kind, Enumeration) and isinstance(new_kind, Enumeration)):
            return {}
        same = self.type_rules.get(new_kind.name) == old_kind.name
        return rules(old_kind.literals,
                     new_kind.literals if same else without_rules(new_kind.literals))

    def _fresh(self, kind, path):
        for leaf in self._under(self.new_leaves, path):
            self.fates.append(Fate(leaf.path, '', ('initialised',), leaf.initial,
                                   told='%I' not in leaf.address))

    def _gone(self, kind, path):
        for leaf in self._under(self.old_leaves, path):
            loss = None if '%I' in leaf.address else not leaf.constant
            self.fates.append(Fate(leaf.path, leaf.path, ('dropped',), loss=loss))

    @staticmethod
    def _under(leaves, path):
        return [leaf for at, leaf in leaves.items()
                if at == path or at.startswith((path + '.', path + '['))]

    # --- addresses ---

    def _addresses(self):
        """Case 75: what comes to %M or %Q has the bits that were there, if their variable goes; that
        is no loss when all of its bits go on."""
        gone = {}    # of one bit: the path and the value of it
        for fate in self.fates:
            leaf = self.old_leaves.get(fate.path)
            if fate.fates == ('dropped',) and leaf and keeps_bits(leaf):
                first, count = bits_at(leaf.address)
                for i in range(count):
                    gone[leaf.address[1], first + i] = leaf.path, i
        taken = {}   # by path: how many bits of it go on
        for fate in self.fates:
            leaf = self.new_leaves.get(fate.path)
            if fate.fates != ('initialised',) or fate.old_path or not leaf or not keeps_bits(leaf):
                continue
            first, count = bits_at(leaf.address)
            bits = [gone.get((leaf.address[1], first + i)) for i in range(count)]
            if not any(bits):
                continue
            value = 0
            for i, bit in enumerate(bits):
                source = self.before[bit[0]] >> bit[1] if bit else leaf.initial >> i
                value |= (source & 1) << i
                if bit:
                    taken[bit[0]] = taken.get(bit[0], 0) + 1
                    self.gathered.append((leaf.path, i, *bit))
            fate.fates, fate.value = ('moved',), signed(leaf, value)
        self.fates = [fate for fate in self.fates if fate.fates != ('dropped',) or
                      taken.get(fate.path, 0) == 0 or
                      taken[fate.path] < bits_at(self.old_leaves[fate.path].address)[1]]

    # --- references ---

    def _reference(self, old_kind, old_path, new_kind, new_path, value):
        if old_kind != new_kind:
            return self._replace(old_kind, old_path, new_kind, new_path)
        self.fates.append(Fate(new_path, old_path, ('kept', 'moved', 'converted'), ('to', value)))

    def _references(self):
        """A reference leads to the variable that its target has become, if that has the same bits;
        else it is NULL, and that is a loss."""
        for fate in self.fates:
            if isinstance(fate.value, tuple) and fate.value[:1] == ('to',):
                target = fate.value[1]
                fate.value = self.place.get(target) if target else None
                fate.loss = bool(target) and fate.value is None
            elif fate.path in self.new_leaves and not fate.old_path:
                leaf = self.new_leaves[fate.path]
                if isinstance(leaf.type, Reference):
                    fate.value = leaf.target or None

    # --- undo ---

    def undone(self, written):
        """X4: the old variables behind undo, as {path: value}; what the oracle does not say is left
        out. written: what new variables were given behind the switch, by path."""
        out = dict(self.before)
        for path, bit, old_path, old_bit in self.gathered:
            if path in written:
                rest = out[old_path] & ~(1 << old_bit)
                value = rest | (written[path] >> bit & 1) << old_bit
                out[old_path] = signed(self.old_leaves[old_path], value)
        for fate in self.fates:
            if fate.path not in written or fate.path not in self.new_leaves or not fate.old_path:
                continue
            old, new = self.old_leaves[fate.old_path], self.new_leaves[fate.path]
            value = written[fate.path]
            if old.constant or '%I' in old.address + new.address:
                continue
            if fate.fates == ('kept', 'moved'):
                out[fate.old_path] = value
            elif 'converted' in fate.fates and value != fate.value:
                literals = {a: b for b, a in self._literals(old.type, new.type).items()}
                rule, back, exact = convert(new.type, value, old.type, LOST, literals)
                out[fate.old_path] = back
                if back is LOST:
                    del out[fate.old_path]
        return out


LOST = object()


def without_rules(items):
    return [dataclasses.replace(one, renamed_from='') for one in items]


def signed(leaf, bits):
    """The value of these bits in a variable at an address."""
    count = bits_at(leaf.address)[1]
    bits &= (1 << count) - 1
    negative = leaf.type.name in INTEGERS and integer_range(leaf.type.name)[0] < 0
    return bits - (bits >> (count - 1) << count) if negative else bits


def keeps_bits(leaf):
    return leaf.address[:2] in ('%M', '%Q') and not leaf.constant


def is_leaf(kind):
    return not isinstance(kind, (Array, Structure, Block))
