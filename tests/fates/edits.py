"""Random edits of a version's declarations, one function for each kind."""

import values
from generate import ADDRESSED
from kinds import Array, Block, Enumeration, Named, Scalar, Structure, Subrange, Text, Variable
from type_edits import TypeEdits
from version import BYTES, WRITER, Instance, Task, bits_at


class Editor(TypeEdits):
    def __init__(self, generator, version):
        self.generator, self.random = generator, generator.random
        self.version = version

    def edited(self, count):
        for _ in range(count):
            edit = self.random.choice(EDITS)
            edit(self)
        return self.version

    # --- where ---

    def blocks(self, program=None):
        return [one for one in self.version.blocks.values() if one.name != WRITER and
                (program is None or one.program == program)]

    def scopes(self):
        """Lists of variables that can be edited, with the blocks that they may use."""
        known = [one.name for one in self.blocks(program=False)]
        out = [(self.version.globals, known)]
        for number, block in enumerate(self.blocks()):
            usable = known if block.program else ([] if block.base else known[:number])
            out.append((block.variables, usable))
        out += [(one.members, ()) for one in self.structures() if not one.union]
        return out

    def scope(self):
        return self.random.choice(self.scopes())

    def structures(self):
        return [one for one in self.version.types.values() if isinstance(one, Structure)]

    def enumerations(self):
        return [one for one in self.version.types.values() if isinstance(one, Enumeration)]

    def plain(self, variables):
        """Those that nothing else refers to."""
        bound = {one.target for one in self.version.globals}
        return [one for one in variables if not one.address and not one.target and
                one.name not in bound and one.section != 'VAR_TEMP']

    def pick(self, variables):
        variables = self.plain(variables)
        return self.random.choice(variables) if variables else None

    def before(self, structure):
        """The types that a structure may use: those declared before it."""
        out = self.version.copy()
        names = list(out.types)
        for name in names[names.index(structure):]:
            del out.types[name]
        return out

    def usable(self, variables):
        for one in self.structures():
            if one.members is variables:
                return self.before(one.name)
        return self.version

    def begin(self, variable):
        """A new initial value that fits the type."""
        variable.initial = None
        if variable.constant or self.random.random() < 0.5:
            variable.initial = values.written(self.random, self.version, variable.type)
        if variable.constant and variable.initial is None:
            variable.constant = False

    # --- variables ---

    def add(self):
        variables, blocks = self.scope()
        new = self.generator.variable(self.usable(variables), blocks)
        variables.insert(self.random.randint(0, len(variables)), new)

    def remove(self):
        variables, _ = self.scope()
        gone = self.pick(variables)
        if gone and len(variables) > 1:
            variables.remove(gone)
            self.forget_member(variables, gone.name)

    def forget_member(self, variables, name):
        """Lists of initial values name members."""
        for scope, _ in self.scopes():
            for one in scope:
                self.strip(one, name)
        for block in self.blocks():
            for one in block.statics:
                self.strip(one, name)

    def strip(self, variable, name):
        def walk(value):
            if isinstance(value, dict):
                value.pop(name, None)
                for one in value.values():
                    walk(one)
            if isinstance(value, list):
                for one in value:
                    walk(one)
        walk(variable.initial)
        if variable.initial == {} or (isinstance(variable.initial, list) and
                                      {} in variable.initial):
            variable.initial = None

    def reorder(self):
        self.random.shuffle(self.scope()[0])

    def retype(self):
        variables, blocks = self.scope()
        one = self.pick(variables)
        if not one:
            return
        self.forget_member(variables, one.name)
        kind = self.version.resolve(one.type)
        if self.random.random() < 0.8 and not isinstance(kind, (Array, Structure, Block)):
            one.type = self.generator.simple(self.usable(variables))
        else:
            one.type = self.generator.any(self.usable(variables), blocks)
        if isinstance(self.version.resolve(one.type), (Array, Structure, Block)):
            one.constant = False
        self.begin(one)

    def resize(self):
        """Bounds, element type, capacity or range."""
        variables, _ = self.scope()
        candidates = [one for one in self.plain(variables)
                      if isinstance(one.type, (Array, Text, Subrange))]
        if not candidates:
            return self.retype()
        one = self.random.choice(candidates)
        self.forget_member(variables, one.name)
        kind = one.type
        if isinstance(kind, Text):
            one.type = Text(self.random.random() < 0.3, self.random.choice([1, 3, 5, 10, 20]))
        elif isinstance(kind, Subrange):
            low = kind.low + self.random.choice([-1, 0, 1, 3])
            low = max(low, 0 if kind.base == 'UINT' else -100)
            one.type = Subrange(kind.base, low, low + self.random.choice([0, 1, 20, 30]))
        else:
            self.resize_array(variables, one)
        self.begin(one)

    def resize_array(self, variables, one):
        choice = self.random.choice
        bounds = [(low + choice([-1, 0, 0, 1]), high + choice([-1, 0, 1, 2]))
                  for low, high in one.type.bounds]
        bounds = [(low, max(low, high)) for low, high in bounds]
        element = one.type.element
        if self.random.random() < 0.3 and not isinstance(element, Named):
            element = self.generator.simple(self.usable(variables))
        if self.random.random() < 0.1:
            bounds = bounds[:1] if len(bounds) > 1 else bounds + [(0, 1)]
        one.type = Array(bounds, element)

    def new_initial(self):
        variables, _ = self.scope()
        one = self.pick(variables)
        if one:
            self.begin(one)

    def rename(self):
        variables, _ = self.scope()
        one = self.pick(variables)
        if not one or one.renamed_from:
            return
        self.forget_member(variables, one.name)
        old = one.name
        one.name = self.generator.name('n')
        taken = any(other.renamed_from == old for other in variables)  # by another rule
        if self.random.random() < 0.7 and not taken:
            one.renamed_from = old
            if self.random.random() < 0.2:  # and somebody else takes the name
                new = Variable(old, self.generator.simple(self.usable(variables)))
                variables.append(new)

    def cross(self):
        variables, _ = self.scope()
        taken = {one.renamed_from for one in variables}
        free = [one for one in self.plain(variables)
                if not one.renamed_from and one.name not in taken]
        if len(free) < 2:
            return
        one, two = self.random.sample(free, 2)
        self.forget_member(variables, one.name)
        self.forget_member(variables, two.name)
        one.name, two.name = two.name, one.name
        one.renamed_from, two.renamed_from = two.name, one.name

    def retain(self):
        scopes = [self.version.globals] + [one.variables for one in self.blocks()]
        one = self.pick(self.random.choice(scopes))
        if one and not one.constant and one.section != 'VAR_TEMP':
            one.retain = not one.retain

    def constant(self):
        scopes = [self.version.globals] + [one.variables for one in self.blocks()]
        one = self.pick(self.random.choice(scopes))
        if not one or one.section != 'VAR':
            return
        if one.constant:
            one.constant = False
        else:
            self.generator.make_constant(self.version, one)

    def section(self):
        block = self.random.choice(self.blocks())
        one = self.pick(block.variables)
        if one and not one.constant and not one.retain and not block.program:
            holds = self.holds_block(Block('', [one]))
            one.section = self.random.choice(['VAR', 'VAR_INPUT', 'VAR_OUTPUT'] +
                                             ([] if holds or one.renamed_from else ['VAR_TEMP']))
            if one.section == 'VAR_TEMP':
                self.forget_member(block.variables, one.name)

    # --- addresses, tasks ---

    def taken(self):
        out = set()
        for one in self.version.globals:
            if one.address:
                letter, at = one.address[2], int(one.address[3:].split('.')[0])
                size = {'X': 1, 'B': 1, 'W': 2, 'D': 4, 'L': 8}[letter]
                out |= {(one.address[1], byte) for byte in range(at * size, (at + 1) * size)}
        return out

    def address(self):
        located = [one for one in self.version.globals if one.address]
        plain = [one for one in self.plain(self.version.globals)
                 if isinstance(one.type, Scalar) and one.type.name in ADDRESSED
                 and not one.constant and not one.retain]
        choice = self.random.random()
        if located and choice < 0.6:
            one = self.random.choice(located)
            one.address = self.generator.address(one.type.name, self.taken())
        elif located and choice < 0.8:
            self.random.choice(located).address = ''
        elif plain:
            one = self.random.choice(plain)
            one.address = self.generator.address(one.type.name, self.taken())
            one.initial = None

    def remap(self):
        """Case 75: a marker goes, and others come to its bytes."""
        markers = [one for one in self.version.globals if one.address.startswith('%M')]
        if not markers:
            return
        gone = self.random.choice(markers)
        self.version.globals.remove(gone)
        first, count = bits_at(gone.address)
        size = self.random.choice([size for size in (1, 2, 4, 8) if size <= max(count // 8, 1)])
        for byte in range(first // 8, first // 8 + max(count // 8, 1), size):
            name = self.random.choice([name for name, letter in ADDRESSED.items()
                                       if BYTES[letter] == size])
            one = Variable(self.generator.name('g'), Scalar(name))
            bit = f'.{self.random.randrange(8)}' if name == 'BOOL' else ''
            one.address = f'%M{ADDRESSED[name]}{byte // size}{bit}'
            if self.random.random() < 0.8:
                self.version.globals.append(one)

    def output(self):
        """Nobody writes it any more, or it goes."""
        outputs = [one for one in self.version.globals if one.address.startswith('%Q')]
        if outputs:
            one = self.random.choice(outputs)
            if self.random.random() < 0.7:
                one.written = not one.written
            else:
                self.version.globals.remove(one)

    def safe(self):
        if self.version.safe and self.random.random() < 0.5:
            del self.version.safe[self.random.choice(list(self.version.safe))]
        self.generator.safe(self.version)

    def task(self):
        choice = self.random.random()
        task = self.random.choice(self.version.tasks)
        if choice < 0.3:
            task.interval_ms = self.random.choice([5, 10, 20, 40, 50])
        elif choice < 0.5:
            task.priority = self.random.randint(0, 9)
        elif choice < 0.7:
            if task.attributes.pop('overrun', None) is None:
                task.attributes['overrun'] = self.random.choice(['stretch', 'fault'])
        elif choice < 0.8:
            task.attributes['watchdog'] = self.random.choice(['T#70ms', 'T#90ms'])
        elif choice < 0.9:
            self.version.tasks.append(Task(self.generator.name('T'), 30, 7))
        else:
            self.remove_task(task)

    def remove_task(self, task):
        used = {one.task for one in self.version.instances}
        if task.name not in used and len(self.version.tasks) > 1:
            self.version.tasks.remove(task)

    def instance(self):
        choice = self.random.random()
        mine = [one for one in self.version.instances if one.type != WRITER]
        one = self.random.choice(mine)
        programs = [block.name for block in self.blocks(program=True)]
        if choice < 0.3:
            one.task = self.random.choice(self.version.tasks).name
        elif choice < 0.5:
            one.type = self.random.choice(programs)
        elif choice < 0.7:
            self.version.instances.append(Instance(
                self.generator.name('i'), self.random.choice(programs),
                self.random.choice(self.version.tasks).name))
        elif choice < 0.85:
            if len(mine) > 1:
                self.version.instances.remove(one)
        elif not one.renamed_from:
            old, one.name = one.name, self.generator.name('i')
            one.renamed_from = old if self.random.random() < 0.7 else ''


E = Editor
EDITS = [E.add, E.add, E.remove, E.reorder, E.retype, E.retype, E.retype, E.resize, E.resize,
         E.new_initial, E.rename, E.rename, E.cross, E.retain, E.constant, E.section, E.literals,
         E.literals, E.rename_type, E.rename_block, E.extends, E.union, E.address, E.remap, E.output,
         E.task, E.instance, E.safe]
