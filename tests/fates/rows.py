"""X1: what a change does beside values and code; each has a row of its own in the report."""

from dataclasses import dataclass

from version import bits_at, rules


@dataclass
class Row:
    kind: str      # address, retain, constant, task, program, safe, output
    name: str      # what the row is about
    said: tuple    # texts that it has to contain
    may_be_left_out: bool = False
    live: str = ''  # the variable of an output that is on: a loss


def rows(old, new, before, pairs):
    """before: values of the old version by path. pairs: (path, old declaration, new one) of every
    variable that goes on."""
    return [*attributes(pairs), *lone_addresses(old, new), *tasks(old, new), *programs(old, new),
            *safe_values(old, new), *left_outputs(old, new, before)]


def lone_addresses(old, new):
    """The address of a variable that comes or goes: its fate says so, but a row is welcome."""
    continued = rules(old.globals, new.globals)
    for one in old.globals:
        if one.address and one.name not in continued.values():
            yield Row('address', one.name, (one.address,), may_be_left_out=True)
    for one in new.globals:
        if one.address and one.name not in continued:
            yield Row('address', one.name, (one.address,), may_be_left_out=True)


def attributes(pairs):
    for path, was, now in pairs:
        if was.address != now.address:
            yield Row('address', path, tuple(one for one in (was.address, now.address) if one))
        if was.retain != now.retain:
            yield Row('retain', path, ('now RETAIN' if now.retain else 'no longer RETAIN',))
        if was.constant != now.constant:
            yield Row('constant', path, ('now CONSTANT' if now.constant else 'no longer CONSTANT',))


def tasks(old, new):
    before = {one.name: one for one in old.tasks}
    after = {one.name: one for one in new.tasks}
    for name in before.keys() | after.keys():
        was, now = before.get(name), after.get(name)
        if not was or not now:
            yield Row('task', name, ('new' if now else 'removed',))
            continue
        if was.interval_ms != now.interval_ms:
            yield Row('task', name, (f'{was.interval_ms}ms', f'{now.interval_ms}ms'))
        if was.priority != now.priority:
            yield Row('task', name, ('priority', str(was.priority), str(now.priority)))
        if watchdog(was) != watchdog(now):
            yield Row('task', name, ('watchdog', watchdog(was), watchdog(now)))
        was, now = was.attributes.get('overrun'), now.attributes.get('overrun')
        if was != now:
            yield Row('task', name, tuple(one for one in ('overrun', was, now) if one))


def watchdog(task):
    """docs/TASKS.md: ten periods when nothing is said."""
    return task.attributes.get('watchdog', f'T#{10 * task.interval_ms}ms')


def programs(old, new):
    continued = rules(old.instances, new.instances)
    known = {one.name: one for one in old.instances}
    for one in new.instances:
        was = known.get(continued.get(one.name))
        if not was:
            yield Row('program', one.name, ('new',))
        elif was.task != one.task:
            yield Row('program', one.name, (was.task, one.task))
    for name in known.keys() - set(continued.values()):
        yield Row('program', name, ('removed',))


def safe_values(old, new):
    before, after = old.safe_rows(), new.safe_rows()
    outputs = {bits_at(one.address)[0]: one.address for version in (old, new)
               for one in version.globals if one.address.startswith('%Q')}
    for bit in before.keys() | after.keys():
        if value_at(before, bit) != value_at(after, bit):
            yield Row('safe', outputs[bit], ('safe value',))


def value_at(rows_by_bit, bit):
    return rows_by_bit.get(bit, (0, 0))[1]  # docs/TASKS.md: else it becomes 0


def left_outputs(old, new, before):
    """Outputs that code has written and that no code of the new version writes."""
    outputs = {bits_at(one.address): one for one in new.globals if one.address.startswith('%Q')}
    for one in old.globals:
        now = outputs.get(bits_at(one.address)) if one.address.startswith('%Q') else None
        if one.address.startswith('%Q') and one.written and not (now and now.written):
            # Without any variable it takes its safe value; with one it stays as it is.
            yield Row('output', one.address, ('no longer written',),
                      live=now.name if now and before[one.name] else '')
