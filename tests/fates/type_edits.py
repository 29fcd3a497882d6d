"""Random edits of enumerations, structures, unions and blocks: the part of Editor (edits.py) that
edits types."""

from kinds import Array, Block, Literal, Named, Structure


class TypeEdits:
    def literals(self):
        if not self.enumerations():
            return
        kind = self.random.choice(self.enumerations())
        choice = self.random.random()
        used = {one.value for one in kind.literals}
        if choice < 0.4:  # inserted: those behind it get other numbers
            kind.literals.insert(self.random.randint(0, len(kind.literals)),
                                 Literal(self.generator.name('L'), 0))
            for number, one in enumerate(kind.literals):
                one.value = number
        elif choice < 0.6 and len(kind.literals) > 1:
            gone = self.random.choice(kind.literals)
            kind.literals.remove(gone)
        elif choice < 0.8:
            one = self.random.choice(kind.literals)
            if not one.renamed_from:
                old, one.name = one.name, self.generator.name('L')
                one.renamed_from = old if self.random.random() < 0.7 else ''
        else:
            self.random.choice(kind.literals).value = max(used) + 3
        self.mend_initials(kind)

    def mend_initials(self, kind):
        """Initial values that are no literals any more."""
        def uses(one):
            one = self.version.resolve(one)
            if isinstance(one, Array):
                return uses(one.element)
            if isinstance(one, (Structure, Block)):
                return any(uses(member.type) for member in self.version.members(one))
            return one is kind
        every = [one for scope, _ in self.scopes() for one in scope]
        every += [one for block in self.blocks() for one in block.statics]
        for one in every:
            if uses(one.type) and not one.target:
                one.initial = None
                if one.constant:
                    one.constant = False

    def rename_type(self):
        kinds = list(self.version.types.values())
        if not kinds:
            return
        kind = self.random.choice(kinds)
        if not kind.renamed_from:
            self.new_name(kind, self.version.types, self.random.random() < 0.7)

    def rename_block(self):
        block = self.random.choice(self.blocks())
        if not block.renamed_from:
            self.new_name(block, self.version.blocks, self.random.random() < 0.7)

    def new_name(self, kind, table, with_rule):
        old, kind.name = kind.name, self.generator.name('T')
        if with_rule:
            kind.renamed_from = old
        entries = [(kind.name if key == old else key, one) for key, one in table.items()]
        table.clear()
        table.update(entries)
        for scope in [one for one, _ in self.scopes()] + [one.statics for one in self.blocks()]:
            for variable in scope:
                self.follow(variable.type, old, kind.name)
        for block in self.blocks():
            if block.base == old:
                block.base = kind.name
        for instance in self.version.instances:
            if instance.type == old:
                instance.type = kind.name

    def follow(self, kind, old, new):
        if isinstance(kind, Named) and kind.name == old:
            kind.name = new
        if isinstance(kind, Array):
            self.follow(kind.element, old, new)

    def extends(self):
        blocks = self.blocks(program=False)
        block = self.random.choice(blocks)
        if block.base:
            self.drop_inherited_initials(block)
            block.base = ''
            return
        earlier = blocks[:blocks.index(block)]
        if earlier and not self.holds_block(block):
            block.base = self.random.choice(earlier).name

    def drop_inherited_initials(self, block):
        for variable in self.version.members(self.version.blocks[block.base]):
            self.forget_member(None, variable.name)

    def holds_block(self, block):
        def holds(kind):
            kind = self.version.resolve(kind)
            return holds(kind.element) if isinstance(kind, Array) else isinstance(kind, Block)
        return any(holds(one.type) for one in block.variables)

    def union(self):
        unions = [one for one in self.structures() if one.union]
        if not unions:
            return
        kind = self.random.choice(unions)
        if self.random.random() < 0.2:
            self.random.choice(kind.members).type = self.generator.union_member().type
        elif self.random.random() < 0.5 and len(kind.members) > 1:
            kind.members.remove(self.random.choice(kind.members))
        else:
            kind.members.insert(self.random.randint(0, len(kind.members)),
                                self.generator.union_member())
