"""Random versions of a program: declarations of every kind that a change treats by a rule of its
own, few enough that a pair is judged in a moment."""

import values
from kinds import (Array, Block, Enumeration, Literal, Named, Reference, Scalar, Structure,
                   Subrange, Text, Variable)
from version import BYTES, WRITER, Instance, Task, Version, bits_at

SCALARS = ['BOOL', 'SINT', 'INT', 'DINT', 'LINT', 'USINT', 'UINT', 'UDINT', 'ULINT', 'BYTE', 'WORD',
           'DWORD', 'LWORD', 'REAL', 'LREAL', 'TIME', 'LTIME', 'DATE', 'LDATE', 'TOD', 'LTOD', 'DT',
           'LDT', 'CHAR', 'WCHAR']
COMMON = ['BOOL', 'SINT', 'INT', 'DINT', 'UINT', 'LINT', 'REAL', 'LREAL', 'WORD']
ADDRESSED = {'BOOL': 'X', 'BYTE': 'B', 'SINT': 'B', 'USINT': 'B', 'INT': 'W', 'WORD': 'W',
             'UINT': 'W', 'DINT': 'D', 'DWORD': 'D', 'REAL': 'D', 'LINT': 'L', 'LREAL': 'L'}


class Generator:
    def __init__(self, random):
        self.random = random
        self.number = 0

    def name(self, letter):
        self.number += 1
        return f'{letter}{self.number}'

    def one_in(self, count):
        return self.random.randrange(count) == 0

    # --- types ---

    def scalar(self):
        return Scalar(self.random.choice(COMMON if self.one_in(2) else SCALARS))

    def subrange(self):
        base = self.random.choice(['SINT', 'INT', 'DINT', 'UINT'])
        low = self.random.choice([0, 1, 5, -10 if base != 'UINT' else 2])
        return Subrange(base, low, low + self.random.choice([1, 10, 50, 100]))

    def text(self):
        return Text(self.one_in(3), self.random.choice([1, 3, 8, 10, 20]))

    def simple(self, version):
        kinds = [self.scalar, self.scalar, self.scalar, self.subrange, self.text]
        enums = [one for one in version.types.values() if isinstance(one, Enumeration)]
        if enums:
            kinds.append(lambda: Named(self.random.choice(enums).name))
        return self.random.choice(kinds)()

    def bounds(self):
        low = self.random.choice([0, 1, 1, -2])
        return (low, low + self.random.randint(0, 3))

    def array(self, version, element=None):
        dims = 2 if self.one_in(3) else 1
        return Array([self.bounds() for _ in range(dims)], element or self.simple(version))

    def any(self, version, blocks=()):
        """A type for a variable; blocks: function blocks that it may be an instance of."""
        structures = [one for one in version.types.values() if isinstance(one, Structure)]
        chance = self.random.random()
        if chance < 0.15 and structures:
            return Named(self.random.choice(structures).name)
        if chance < 0.20 and structures:
            return self.array(version, Named(self.random.choice(structures).name))
        if chance < 0.35 and blocks:
            return Named(self.random.choice(blocks))
        if chance < 0.40 and blocks:
            return Array([self.bounds()], Named(self.random.choice(blocks)))
        if chance < 0.50:
            return self.array(version)
        return self.simple(version)

    # --- declarations ---

    def variable(self, version, blocks=(), letter='v'):
        kind = self.any(version, blocks)
        out = Variable(self.name(letter), kind)
        if self.one_in(2):
            out.initial = values.written(self.random, version, kind)
        return out

    def attributed(self, version, blocks=(), sections=('VAR',)):
        section = self.random.choice(sections)
        out = self.variable(version, blocks if section != 'VAR_TEMP' else ())
        out.section = section
        if out.section == 'VAR' and self.one_in(8):
            self.make_constant(version, out)
        elif out.section in ('VAR', 'VAR_INPUT', 'VAR_OUTPUT') and self.one_in(6):
            out.retain = True
        return out

    def make_constant(self, version, variable):
        kind = version.resolve(variable.type)
        if isinstance(kind, (Scalar, Subrange, Text)):
            variable.constant, variable.retain = True, False
            variable.initial = values.written(self.random, version, variable.type)

    def enumeration(self):
        names = [self.name('L') for _ in range(self.random.randint(2, 4))]
        start = self.random.choice([0, 0, 5])
        literals = [Literal(name, start + number) for number, name in enumerate(names)]
        return Enumeration(self.name('E'), self.random.choice(['INT', 'INT', 'DINT', 'USINT']),
                           literals)

    def structure(self, version):
        members = [self.variable(version, (), 'm') for _ in range(self.random.randint(1, 4))]
        return Structure(self.name('S'), members)

    def union_member(self):
        kind = self.random.choice([Scalar('DINT'), Scalar('REAL'), Scalar('WORD'), Scalar('BYTE'),
                                   Array([(0, 3)], Scalar('BYTE')), Array([(1, 2)], Scalar('INT'))])
        return Variable(self.name('u'), kind)

    def union(self):
        members = [self.union_member() for _ in range(self.random.randint(2, 3))]
        return Structure(self.name('U'), members, union=True)

    def block(self, version):
        known = [one.name for one in version.blocks.values() if not one.program]
        out = Block(self.name('F'), [])
        if known and self.one_in(3):
            out.base = self.random.choice(known)
        sections = ('VAR', 'VAR', 'VAR_INPUT', 'VAR_OUTPUT', 'VAR_TEMP')
        inner = known if not out.base else ()
        for _ in range(self.random.randint(1, 4)):
            out.variables.append(self.attributed(version, inner, sections))
        if self.one_in(4):
            out.statics.append(self.variable(version))
        return out

    def program(self, version):
        known = [one.name for one in version.blocks.values() if not one.program]
        out = Block(self.name('P'), [], program=True)
        for _ in range(self.random.randint(2, 6)):
            out.variables.append(self.attributed(version, known, ('VAR', 'VAR', 'VAR', 'VAR_TEMP')))
        return out

    def located(self, version, taken):
        scalar = self.random.choice(list(ADDRESSED))
        out = Variable(self.name('g'), Scalar(scalar))
        out.address = self.address(scalar, taken)
        return out

    def address(self, scalar, taken):
        letter = ADDRESSED[scalar]
        area = self.random.choice('MMQQI')
        size = BYTES[letter]
        while True:
            at = self.random.randrange(24)
            span = {(area, byte) for byte in range(at * size, (at + 1) * size)}
            if not span & taken:
                break
        taken |= span
        bit = f'.{self.random.randrange(8)}' if letter == 'X' else ''
        return f'%{area}{letter}{at}{bit}'

    def references(self, version):
        plain = [one for one in version.globals
                 if isinstance(one.type, Scalar) and not one.address and not one.constant]
        if plain and self.one_in(2):
            target = self.random.choice(plain)
            version.globals.append(Variable(self.name('r'), Reference(target.type),
                                            target=target.name))

    def tasks(self, version):
        version.tasks = [Task('Fast', self.random.choice([5, 10]), 1),
                         Task('Slow', self.random.choice([20, 50]), 5)]
        for task in version.tasks:
            if self.one_in(4):
                task.attributes['watchdog'] = 'T#80ms'
            if self.one_in(4):
                task.attributes['overrun'] = 'stretch'
        programs = [one.name for one in version.blocks.values() if one.program]
        version.blocks[WRITER] = Block(WRITER, [], program=True)
        version.instances.append(Instance('writer', WRITER, 'Fast'))
        for name in programs + ([programs[0]] if self.one_in(4) else []):
            version.instances.append(Instance(self.name('i'), name,
                                              self.random.choice(['Fast', 'Slow'])))

    def version(self):
        out = Version()
        for _ in range(self.random.randint(0, 2)):
            self.declare(out, self.enumeration())
        for _ in range(self.random.randint(1, 3)):
            self.declare(out, self.structure(out))
        if self.one_in(2):
            self.declare(out, self.union())
        for _ in range(self.random.randint(1, 3)):
            block = self.block(out)
            out.blocks[block.name] = block
        for _ in range(self.random.randint(1, 2)):
            program = self.program(out)
            out.blocks[program.name] = program
        blocks = [one.name for one in out.blocks.values() if not one.program]
        for _ in range(self.random.randint(2, 7)):
            out.globals.append(self.attributed(out, blocks))
        taken = set()
        for _ in range(self.random.randint(0, 4)):
            out.globals.append(self.located(out, taken))
        self.references(out)
        self.tasks(out)
        self.safe(out)
        return out

    def safe(self, version):
        outputs = [one for one in version.globals if one.address.startswith('%Q')]
        if outputs and self.one_in(2):
            bit, bits = bits_at(self.random.choice(outputs).address)
            version.safe[bit] = (bits, self.random.randrange(1 << min(bits, 16)))

    @staticmethod
    def declare(version, kind):
        version.types[kind.name] = kind
