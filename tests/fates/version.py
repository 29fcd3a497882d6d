"""One version of a program as a model of its declarations: what the generator makes, what the
oracle judges, and the source text of it."""

import copy
from dataclasses import dataclass, field

from kinds import (Array, Block, Enumeration, INTEGERS, Named, REALS, Reference, Scalar, Structure,
                   Subrange, Text, TIMES, real_of)


@dataclass
class Task:
    name: str
    interval_ms: int
    priority: int
    attributes: dict = field(default_factory=dict)


@dataclass
class Instance:
    """A program of the configuration."""
    name: str
    type: str
    task: str
    renamed_from: str = ''


@dataclass
class Leaf:
    path: str
    type: object
    initial: object
    constant: bool = False
    retain: bool = False
    address: str = ''
    target: str = ''
    union: str = ''    # the path of the outermost union around it
    area: str = ''     # the instance whose area holds it; '' for globals
    root: str = ''     # the variable of that area


class Version:
    def __init__(self):
        self.types = {}      # Enumeration, Structure
        self.blocks = {}     # function blocks and programs
        self.globals = []
        self.tasks = []
        self.instances = []
        self.safe = {}       # bit of %Q: (bits, value)

    def copy(self):
        return copy.deepcopy(self)

    # --- meaning ---

    def resolve(self, kind):
        """What a name stands for; anything else is itself."""
        if isinstance(kind, Named):
            return self.types.get(kind.name) or self.blocks[kind.name]
        return kind

    def members(self, kind):
        """Variables of a structure, block or program, those of its bases first."""
        if isinstance(kind, Structure):
            return kind.members
        base = self.members(self.blocks[kind.base]) if kind.base else []
        return base + kind.variables

    def default(self, kind):
        kind = self.resolve(kind)
        if isinstance(kind, Text):
            return ()
        if isinstance(kind, Subrange):
            return kind.low if kind.low > 0 or kind.high < 0 else 0
        if isinstance(kind, Enumeration):
            return kind.literals[0].value
        if isinstance(kind, Reference):
            return None
        return 0

    def leaves(self):
        """Every variable with a value of its own, by its path."""
        out = {}
        for variable in self.globals:
            self._variable('', '', variable, out, {})
        for block in self.blocks.values():
            for variable in block.statics:
                self._variable(block.name + '.', '', variable, out, {})
        for instance in self.instances:
            program = self.blocks[instance.type]
            for variable in self.members(program):
                self._variable(instance.name + '.', instance.name, variable, out, {})
        return out

    def _variable(self, prefix, area, variable, out, around):
        if variable.section == 'VAR_TEMP':
            return
        facts = dict(around, constant=around.get('constant') or variable.constant,
                     retain=around.get('retain') or variable.retain,
                     address=variable.address, target=variable.target, area=area,
                     root=prefix + variable.name)
        self._walk(prefix + variable.name, variable.type, variable.initial, facts, out)

    def _walk(self, path, kind, initial, facts, out):
        kind = self.resolve(kind)
        if isinstance(kind, Array):
            for number, index in enumerate(indices(kind.bounds)):
                value = initial[number] if initial and number < len(initial) else None
                self._walk(f"{path}[{','.join(map(str, index))}]", kind.element, value, facts, out)
        elif isinstance(kind, Structure):
            inside = dict(facts)
            if kind.union and not facts.get('union'):
                inside['union'] = path
            for member in kind.members:
                value = (initial or {}).get(member.name, member.initial)
                if kind.union and member is not kind.members[0]:
                    value = None
                self._walk(f'{path}.{member.name}', member.type, value, inside, out)
        elif isinstance(kind, Block):
            around = {key: facts.get(key, '') for key in ('constant', 'retain')}
            for variable in self.members(kind):
                shown = copy.copy(variable)
                if initial and variable.name in initial:
                    shown.initial = initial[variable.name]
                self._variable(path + '.', path, shown, out, around)
        else:
            value = self.default(kind) if initial is None else initial
            out[path] = Leaf(path, kind, value, **{
                key: facts.get(key, '') for key in ('constant', 'retain', 'address', 'target',
                                                    'union', 'area', 'root')})

    def safe_rows(self):
        """Safe values of the outputs that there are: {first bit: (bits, value)}."""
        bits = {one.address for one in self.globals if one.address.startswith('%Q')}
        known = dict(bits_at(address) for address in bits)
        return {bit: row for bit, row in self.safe.items() if known.get(bit) == row[0]}

    def areas(self):
        """The variables of every area with their whole types: {area: {path: type}}."""
        out = {'': {}}
        for block in self.blocks.values():
            self._area('', '', [(f'{block.name}.{one.name}', one) for one in block.statics], out)
        self._area('', '', [(one.name, one) for one in self.globals], out)
        for instance in self.instances:
            self._block_area(instance.name, self.blocks[instance.type], out)
        return out

    def _block_area(self, path, block, out):
        out[path] = {'': block.base}
        self._area(path, path + '.', [(one.name, one) for one in self.members(block)], out)

    def _area(self, area, prefix, variables, out):
        for name, variable in variables:
            if variable.section != 'VAR_TEMP':
                out[area][prefix + name] = self.whole_type(variable.type)
                self._inner_areas(prefix + name, variable.type, out)

    def _inner_areas(self, path, kind, out):
        kind = self.resolve(kind)
        if isinstance(kind, Array):
            for index in indices(kind.bounds):
                self._inner_areas(f"{path}[{','.join(map(str, index))}]", kind.element, out)
        elif isinstance(kind, Block):
            self._block_area(path, kind, out)

    def whole_type(self, kind):
        """A type as text, with all that it consists of; a block is a place of its own."""
        kind = self.resolve(kind)
        if isinstance(kind, Array):
            return f'{kind.bounds} {self.whole_type(kind.element)}'
        if isinstance(kind, Structure):
            members = [(one.name, self.whole_type(one.type)) for one in kind.members]
            return f'{kind.renamed_from or kind.name} {members}'
        if isinstance(kind, Enumeration):
            literals = [(one.name, one.value) for one in kind.literals]
            return f'{kind.renamed_from or kind.name} {kind.base} {literals}'
        if isinstance(kind, Block):
            return f'{kind.renamed_from or kind.name} {kind.base}'
        return kind.text()

    # --- text ---

    def text(self):
        parts = [self._type_text(kind) for kind in self.types.values()]
        parts.append(self._global_text())
        parts += [self._block_text(block) for block in self.blocks.values()]
        parts.append(self._configuration_text())
        return '\n'.join(parts) + '\n'

    def _type_text(self, kind):
        rule = rule_text(kind.renamed_from)
        if isinstance(kind, Enumeration):
            literals = ', '.join(f'{rule_text(one.renamed_from)}{one.name} := {one.value}'
                                 for one in kind.literals)
            return f'TYPE {rule}{kind.name} : ({literals}) {kind.base}; END_TYPE'
        word = 'UNION' if kind.union else 'STRUCT'
        lines = [self._declaration(member) for member in kind.members]
        return f'TYPE {rule}{kind.name} : {word}\n' + ''.join(lines) + f'END_{word} END_TYPE'

    def _block_text(self, block):
        word = 'PROGRAM' if block.program else 'FUNCTION_BLOCK'
        base = f' EXTENDS {block.base}' if block.base else ''
        lines = [f'{rule_text(block.renamed_from)}{word} {block.name}{base}']
        for variable in block.variables:
            lines.append(section_text(variable) + self._declaration(variable).rstrip('\n') +
                         ' END_VAR')
        for variable in block.statics:
            lines.append('VAR_STAT ' + self._declaration(variable).rstrip('\n') + ' END_VAR')
        if block.program:
            lines += [f'  IF never THEN {text} END_IF' for text in self.writes(block)]
        lines.append(f'  ;\nEND_{word}')
        return '\n'.join(lines)

    def writes(self, program):
        """Statements that never run, in one program: they make outputs written ones."""
        if program.name != WRITER:
            return []
        return [f'{one.name} := {self._nothing(one.type)};' for one in self.globals
                if one.address.startswith('%Q') and one.written]

    def _nothing(self, kind):
        kind = self.resolve(kind)
        return 'FALSE' if isinstance(kind, Scalar) and kind.name == 'BOOL' else '0'

    def _global_text(self):
        lines = ['VAR_GLOBAL never : BOOL; END_VAR']
        for variable in self.globals:
            lines.append(section_text(variable, 'VAR_GLOBAL') +
                         self._declaration(variable).rstrip('\n') + ' END_VAR')
        return '\n'.join(lines)

    def _declaration(self, variable):
        where = f' AT {variable.address}' if variable.address else ''
        text = (f'  {rule_text(variable.renamed_from)}{variable.name}{where} : '
                f'{variable.type.text()}')
        if variable.target:
            text += f' := REF({variable.target})'
        elif variable.initial is not None:
            text += f' := {self.value_text(variable.type, variable.initial)}'
        return text + ';\n'

    def value_text(self, kind, value):
        kind = self.resolve(kind)
        if isinstance(kind, Array):
            return '[' + ', '.join(self.value_text(kind.element, one) for one in value) + ']'
        if isinstance(kind, (Structure, Block)):
            types = {one.name: one.type for one in self.members(kind)}
            return '(' + ', '.join(f'{name} := {self.value_text(types[name], one)}'
                                   for name, one in value.items()) + ')'
        if isinstance(kind, Text):
            quote = '"' if kind.wide else "'"
            return quote + ''.join(chr(code) for code in value) + quote
        if isinstance(kind, Enumeration):
            return f'{kind.name}#{next(one.name for one in kind.literals if one.value == value)}'
        return scalar_text(kind.base if isinstance(kind, Subrange) else kind.name, value)

    def _configuration_text(self):
        lines = ['CONFIGURATION Plant', '  RESOURCE Line ON cpu']
        for task in self.tasks:
            for name, value in task.attributes.items():
                lines.append(f"    {{attribute '{name}' := '{value}'}}")
            lines.append(f'    TASK {task.name} (INTERVAL := T#{task.interval_ms}ms, '
                         f'PRIORITY := {task.priority});')
        for one in self.instances:
            lines.append(f'    {rule_text(one.renamed_from)}PROGRAM {one.name} WITH {one.task} : '
                         f'{one.type};')
        return '\n'.join(lines + ['  END_RESOURCE', 'END_CONFIGURATION'])


WRITER = 'Writer'  # the program with the statements that write outputs; it has one instance
BYTES = {'X': 1, 'B': 1, 'W': 2, 'D': 4, 'L': 8}


def bits_at(address):
    """First bit and number of bits of an address in its part of the process image."""
    letter, at = address[2], address[3:].split('.')
    size = BYTES[letter]
    if letter == 'X':
        return int(at[0]) * 8 + int(at[1]), 1
    return int(at[0]) * size * 8, size * 8


def rule_text(old):
    return f"{{renamed from := '{old}'}} " if old else ''


def section_text(variable, word=None):
    word = word or variable.section
    return word + (' CONSTANT' if variable.constant else '') + (
        ' RETAIN' if variable.retain else '')


def indices(bounds):
    """All index tuples of an array, the last index fastest."""
    out = [()]
    for low, high in bounds:
        out = [one + (index,) for one in out for index in range(low, high + 1)]
    return out


def scalar_text(name, value):
    if name == 'BOOL':
        return 'TRUE' if value else 'FALSE'
    if name in INTEGERS:
        return str(value)
    if name in REALS:
        return f'{real_of(name, value):.1f}'
    if name in ('CHAR', 'WCHAR'):
        quote = "'" if name == 'CHAR' else '"'
        return f'{name}#{quote}{chr(value)}{quote}'
    days, rest = divmod(value, 86_400_000_000_000)
    if name in ('TIME', 'LTIME'):
        return f"{name}#{value // 1_000_000}ms"
    clock = '{:02}:{:02}:{:02}'.format(rest // 3_600_000_000_000, rest // 60_000_000_000 % 60,
                                       rest // 1_000_000_000 % 60)
    date = f'1970-01-{days + 1:02}'
    if name in ('TOD', 'LTOD'):
        return f'{name}#{clock}'
    return f'{name}#{date}' if name in ('DATE', 'LDATE') else f'{name}#{date}-{clock}'


def rules(old_names, new_items):
    """Which old name each new one continues: {new: old}. An item has name and renamed_from."""
    carried = {one.name: one.renamed_from for one in old_names if one.renamed_from}
    names = {one.name for one in old_names}
    applied = {one.name: one.renamed_from for one in new_items
               if one.renamed_from in names and carried.get(one.name) != one.renamed_from}
    while True:  # the largest set in which each new name is free or given away
        given = set(applied.values())
        stuck = [new for new in applied if new in names and new not in given]
        if not stuck:
            break
        for new in stuck:
            del applied[new]
    given = set(applied.values())
    out = dict(applied)
    for one in new_items:
        if one.name not in out and one.name in names and one.name not in given:
            out[one.name] = one.name
    return out
