"""Random values at the edges of their types."""

from kinds import (Array, Enumeration, INTEGERS, REALS, Scalar, Structure, Subrange, Text, bits_of,
                   integer_range)

MS = 1_000_000
REAL_EDGES = [0.0, 1.0, -1.0, 0.5, 1.5, 2.5, -2.5, 100.0, 300.0, 16777217.0, 1e10, -1e30, 127.0,
              -128.0, 255.0, 32767.0, 65535.5, 2147483647.0, 1e300, 3.4e38, 1e-45, 0.1, -0.0]


def integer(random, low, high):
    edges = [low, high, low + 1, high - 1, 0, 1, -1, 2, 100, 127, 128, 255, 256, -128, -129, 300,
             32767, 32768, 40000, 65535, 65536, 16777217, 2**31 - 1, 2**53 + 1, -2**31]
    fitting = [value for value in edges if low <= value <= high]
    return random.choice(fitting) if random.random() < 0.8 else random.randint(low, high)


def real(random, name):
    special = ['nan', 'inf', '-inf']
    number = float(random.choice(special)) if random.random() < 0.2 else random.choice(REAL_EDGES)
    return bits_of(name, number)


def text(random, kind):
    length = random.choice([0, 1, kind.capacity // 2, kind.capacity, kind.capacity])
    pool = [65, 90, 97, 122, 48, 126] + ([0x20AC, 0x3A9, 0xE9] if kind.wide else [0xE9])
    return tuple(random.choice(pool) for _ in range(length))


def live(random, version, kind):
    """A value that a variable may have while the program runs."""
    kind = version.resolve(kind)
    if isinstance(kind, Text):
        return text(random, kind)
    if isinstance(kind, Subrange):
        return integer(random, kind.low, kind.high)
    if isinstance(kind, Enumeration):
        return random.choice(kind.literals).value
    if kind.name in INTEGERS:
        return integer(random, *integer_range(kind.name))
    if kind.name in REALS:
        return real(random, kind.name)
    if kind.name == 'BOOL':
        return random.randint(0, 1)
    if kind.name == 'CHAR':
        return random.choice([65, 122, 0xE9])
    if kind.name == 'WCHAR':
        return random.choice([65, 0xE9, 0x20AC])
    return random.choice([0, 1, 999, MS, 1500 * MS, 86_399 * 1000 * MS])


def written(random, version, kind):
    """An initial value as sources write it, or None for the type's own."""
    kind = version.resolve(kind)
    if isinstance(kind, Array):
        return array(random, version, kind)
    if isinstance(kind, Structure):
        return structure(random, version, kind)
    if isinstance(kind, Text):
        return tuple(random.choice(b'xyz') for _ in range(random.randint(0, kind.capacity)))
    if isinstance(kind, (Subrange, Enumeration)):
        return live(random, version, kind)
    if not isinstance(kind, Scalar):
        return None
    if kind.name in REALS:
        return bits_of(kind.name, random.choice([0.0, 1.5, -7.0, 12.0]))
    if kind.name in ('CHAR', 'WCHAR'):
        return random.choice([65, 66])
    if kind.name in INTEGERS:
        low, high = integer_range(kind.name)
        return random.choice([1, 7, 42, low, high])
    if kind.name == 'BOOL':
        return random.randint(0, 1)
    return random.choice([0, 5000 * MS, 86_000_000 * MS - 86_000_000 * MS % (1000 * MS)]) \
        if kind.name not in ('DATE', 'LDATE') else 86_400_000 * MS * random.randint(0, 5)


def array(random, version, kind):
    count = 1
    for low, high in kind.bounds:
        count *= high - low + 1
    values = [written(random, version, kind.element) for _ in range(count)]
    return None if any(value is None for value in values) else values


def holds_structure(version, kind):
    kind = version.resolve(kind)
    return holds_structure(version, kind.element) if isinstance(kind, Array) else (
        isinstance(kind, Structure))


def structure(random, version, kind):
    if kind.union:
        return None
    plain = [one for one in kind.members if not holds_structure(version, one.type)]
    chosen = [one for one in plain if random.random() < 0.5]
    values = {one.name: written(random, version, one.type) for one in chosen}
    return {name: value for name, value in values.items() if value is not None} or None
