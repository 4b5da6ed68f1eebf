"""From a formula to the tape: every relation becomes a mode and the guard that changes it."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import replace

from tracewire.compile.curves import PARTS, lower_curve, table_name
from tracewire.compile.differentiate import differentiate, linear_in_t, substitute
from tracewire.compile.draws import lower_random
from tracewire.compile.flat import Flat
from tracewire.compile.holding import holding, modes_read, moving
from tracewire.compile.kept import kept_states
from tracewire.compile.limits import MODEL
from tracewire.compile.linear import solve_linear, work
from tracewire.compile.lowered import Delay, Lowered, Mode, ModeKind
from tracewire.compile.shifting import ShiftError, shift_signals
from tracewire.compile.tape import BINARY, UNARY, Entry
from tracewire.errors import DiagramError, Location, Problem
from tracewire.formula import Call, Expression, Name, Number, to_text

PRESCRIBED = frozenset({"t", "param", "const", "table", "mode"})  # leaves that no state moves


def comparison_text(strict: bool) -> str:
    """What the modes of comparisons are known by."""
    return ">" if strict else ">="


def text_of(guard: Expression) -> str:
    """A guard in a message and in a log, where 'v - 0' is 'v'."""
    if isinstance(guard, Call) and guard.arguments[-1:] == (Number(0.0),):
        return to_text(guard.arguments[0])
    return to_text(guard)


class Lowering:
    """A tape while it is written; what is lowered next belongs to `signal`.

    `held` are the modes that a slide may hold, by signal and text, as far as they are known.
    `laws` are the comparisons and signs, by signal and text, that share the mode of a law that
    moves the rate of what it compares, such as a friction; `compared` has the mode, the signal and
    the text of each other one.
    `on_the_spot` are the entries that were compared as if their modes changed at events alone.
    """

    def __init__(
        self,
        flat: Flat,
        held: Collection[tuple[str, str]] = (),
        laws: Collection[tuple[str, str]] = (),
    ) -> None:
        self.held = frozenset(held)
        self.laws = frozenset(laws)
        self.compared: list[tuple[int, str, str]] = []
        self.looped = {name for loop in flat.loops for name in loop.names}
        self.on_the_spot: list[int] = []
        self.flat = flat
        self.out = Lowered()
        self.tape = self.out.tape
        self.t = self.tape.push("t")
        self.by_guard: dict[tuple[str, int], int] = {}
        self.by_multiple: dict[int, tuple[int, float]] = {}  # of an entry: a relay, and its factor
        self.delayed: dict[tuple[Expression, ...], int] = {}  # of their arguments, the entries
        self.index = {state.name: number for number, state in enumerate(flat.states)}
        self.kept = kept_states(flat)
        self.signal = ""

    def start(self, formula: Expression, name: str, place: Location) -> int:
        entry = self.lower(formula)
        if not self.tape.leaves([entry]) <= {"param", "const"}:
            what = f"the start '{to_text(formula)}' reads a signal"
            hint = "A start value may only read parameters."
            at = Location(place.file, place.line, place.column, name)
            raise DiagramError([Problem(what, at, (), hint)])
        return entry

    def static(self, entry: int) -> bool:
        """Whether an entry changes at events alone, and so needs no guard.

        It reads parameters, modes, and states that stand still between events.
        """
        leaves = self.tape.leaves([entry])
        if not leaves <= {"param", "const", "mode", "hold", "state"}:
            return False
        if "state" in leaves:
            read = (self.tape.entries[i] for i in self.tape.needed([entry]))
            if any(e.op == "state" and e.payload not in self.kept for e in read):
                return False
        return self.stands_still(entry)

    def stands_still(self, entry: int) -> bool:
        """Whether no mode that an entry reads is one that a slide may hold, as far as is known."""
        read = modes_read(self.tape, [entry])
        if any((self.out.modes[i].signal, self.out.modes[i].text) in self.held for i in read):
            return False
        if read:
            self.on_the_spot.append(entry)
        return True

    def flow(self) -> dict[int, int]:
        """The rates of the states and of t."""
        rates = dict(zip(self.out.states, self.out.rates, strict=True))
        return rates | {self.t: self.tape.constant(1.0)}

    def holding(self) -> frozenset[int]:
        """The modes that a slide may hold; all rates are known."""
        flow = self.flow()
        rates = differentiate(self.tape, [mode.guard for mode in self.out.modes], flow)
        return holding(self.out, moving(self.out, rates, flow))

    def moving_laws(self) -> frozenset[tuple[str, str]]:
        """The comparisons that move the rate of what they compare, as `laws`; all rates are known.

        Such a mode may slide. The comparisons of one law share it, and so do others of the same
        guard, which are true for the same part of the time, but where a friction holds the guard.
        """
        tape, modes = self.tape, self.out.modes
        flow = self.flow()
        rates = differentiate(tape, [mode.guard for mode in modes], flow)
        movers = moving(self.out, rates, flow)
        held = holding(self.out, movers)
        moved = {
            i: tape.needed([rates[i], *(rates[other] for other in movers[i] & held)])
            for i in {mode for mode, _, _ in self.compared}
            if i in movers[i]
        }
        guards = {modes[i].guard for i in moved}
        guards -= {mode.guard for mode in modes if mode.holds}
        roots = self.out.entries | {
            state.name: rate for state, rate in zip(self.flat.states, self.out.rates, strict=True)
        }
        return frozenset(
            (signal, text)
            for i, signal, text in self.compared
            if modes[i].guard in guards or roots.get(signal) in moved.get(i, ())
        )

    def lower(self, node: Expression) -> int:
        if isinstance(node, Number):
            return self.tape.constant(node.value)
        if isinstance(node, Name):
            return self.out.entries[node.name]
        function, arguments = node.function, node.arguments
        special: dict[str, Callable[[tuple[Expression, ...]], int]] = {
            "if": self.choice,
            "sign": self.sign,
            "abs": self.absolute,
            "min": lambda a: self.extreme(a, largest=False),
            "max": lambda a: self.extreme(a, largest=True),
            "floor": lambda a: self.floor(self.lower(a[0])),
            "mod": self.modulo,
            "dry": self.dry,
            "is_held": self.is_held,
            "delayed": self.delay,
            "shifted": self.shift,
            "interp": self.interp,
            "cubic_spline": self.curve,
            "monotone_cubic": self.curve,
            "random_number": self.random_number,
        }
        if function in special:
            return special[function](arguments)
        if function in ("<", "<=", ">", ">=", "and", "or", "not"):
            return self.boolean(node)
        if function == "[]":
            return self.unknown(node)
        if function in UNARY or function in BINARY:
            return self.tape.push(function, *(self.lower(argument) for argument in arguments))
        raise AssertionError(f"no entry for {function}")

    def unknown(self, node: Call) -> int:
        """The entry of one unknown of a linear system, written `solve(matrix, right)[index]`."""
        system, index = node.arguments
        if not isinstance(system, Call) or not isinstance(index, Number):
            raise AssertionError("elements of signals are signals of their own")
        rows, right = (part.arguments for part in system.arguments if isinstance(part, Call))
        cells = [cell for row in rows if isinstance(row, Call) for cell in row.arguments]
        matrix = [self.lower(cell) for cell in cells]
        if index.value == 0:
            self.refuse_large(matrix, len(rows))
        return solve_linear(self.tape, matrix, [self.lower(f) for f in right])[int(index.value)]

    def refuse_large(self, matrix: list[int], size: int) -> None:
        """Raise where the equations of a linear system would take minutes to compile."""
        if work(self.tape, matrix, size) > MODEL.most_work:
            what = f"the matrix of {size} unknowns has too few zeros to be solved"
            hint = f"Full ones may have {MODEL.most_full} unknowns. "
            hint += "Split the system, or write zeros as 0."
            raise self.refused(what, hint)

    def refused(self, what: str, hint: str) -> DiagramError:
        """What is wrong with the signal that is being lowered, at the place of its block."""
        block = self.flat.blocks.get(self.signal)
        return DiagramError([Problem(what, block.place if block else Location(), (), hint)])

    def boolean(self, node: Call) -> int:
        push = self.tape.push
        if node.function == "not":
            return push("not", self.lower(node.arguments[0]))
        if node.function in ("and", "or"):
            parts = [self.lower(argument) for argument in node.arguments]
            result = parts[0]
            for part in parts[1:]:
                result = push(node.function, result, part)
            return result
        difference = Call("-", node.arguments)
        above = self.comparison(difference, strict=node.function in (">", "<="))
        return above if node.function in (">", ">=") else push("not", above)

    def comparison(self, difference: Expression, strict: bool) -> int:
        """The entry of difference >= 0 (or > 0) in a formula."""
        guard, text = self.lower(difference), text_of(difference)
        if self.static(guard) or self.shares(guard, text):
            return self.positive(guard, text, strict)
        return self.compare(guard, text, strict)

    def shares(self, guard: int, text: str) -> bool:
        """Whether a comparison is a law, or has a guard a*t + b, which rests nowhere."""
        if (self.signal, text) in self.laws or self.signal in self.looped:
            return True
        plain = self.tape.leaves([guard]) <= {"t", "param", "const"}
        return plain and linear_in_t(self.tape, guard, self.t) is not None

    def compare(self, guard: int, text: str, strict: bool, shown: str = "") -> int:
        """As `positive`, for a comparison that does not move what it compares.

        It has a mode of its own, so that it may differ where the guard rests at zero from what
        slides there, and > from >=. The log shows the guard as `shown`.
        """
        push, entry = self.tape.push, self.tape.entries[guard]
        if entry.op == "neg":
            inner = f"-({shown or text})"
            return push("not", self.compare(entry.operands[0], text, not strict, inner))
        mirrored = None
        if entry.op == "-":
            mirrored = self.tape.known.get(Entry("-", entry.operands[::-1]))
        if mirrored is not None and (comparison_text(not strict), mirrored) in self.by_guard:
            return push("not", self.compare(mirrored, text, not strict))
        mode = self.mode("sign", guard, shown or text, at_zero=0 if strict else 1, compares=True)
        self.compared.append((mode, self.signal, text))
        return self.out.modes[mode].leaf

    def condition(self, guard: Expression, strict: bool) -> int:
        """The entry of guard >= 0 (or > 0) for an event: a mode in any case."""
        return self.positive(self.lower(guard), text_of(guard), strict, always=True)

    def positive(
        self,
        guard: int,
        text: str,
        strict: bool = False,
        holds: bool = False,
        always: bool = False,
    ) -> int:
        """The entry that is 1 where guard >= 0 (or > 0): a mode, shared up to sign.

        A guard that never changes within a mode combination is compared on the spot, unless
        `always` asks for a mode: the event of a reset needs one.
        """
        tape = self.tape
        if self.static(guard) and not always:
            return tape.push("gt" if strict else "ge", guard, tape.constant(0.0))
        entry = tape.entries[guard]
        if entry.op == "neg":
            inner = self.positive(entry.operands[0], f"-({text})", not strict, holds, always)
            return tape.push("not", inner)
        mirrored = tape.known.get(Entry("-", entry.operands[::-1])) if entry.op == "-" else None
        if mirrored is not None and ("sign", mirrored) in self.by_guard:
            mode = self.mode("sign", mirrored, text, holds=holds)
            return tape.push("not", self.out.modes[mode].leaf)
        mode = self.mode("sign", guard, text, at_zero=0 if strict else 1, holds=holds)
        return self.out.modes[mode].leaf

    def relay(self, guard: int, text: str) -> int:
        """As `positive`, for a relay, whose mode is shared up to a constant factor.

        Relays on multiples of one signal turn together: that they share a mode lets the difference
        of two that drive it apart hold it at zero. Frictions on multiples have each their own, and
        comparisons, of which > and >= differ where the signal rests at zero.
        """
        base, factor = self.scaled(guard)
        known = self.by_multiple.get(base)
        if known is not None and ("sign", guard) not in self.by_guard:
            return known[0] if known[1] * factor > 0 else self.tape.push("not", known[0])
        positive = self.positive(guard, text)
        if not self.out.modes[self.side(positive)[0]].holds:
            self.by_multiple.setdefault(base, (positive, factor))
        return positive

    def scaled(self, guard: int) -> tuple[int, float]:
        """An entry and the number that it is multiplied with to be a guard."""
        factor = 1.0
        while (entry := self.tape.entries[guard]).op == "*":
            left, right = entry.operands
            value = self.tape.value(left)
            if value is None:
                left, right, value = right, left, self.tape.value(right)
            if not value:
                break
            guard, factor = right, factor * value
        return guard, factor

    def mode(
        self,
        kind: ModeKind,
        guard: int,
        text: str,
        at_zero: int = 1,
        holds: bool = False,
        table: int = -1,
        compares: bool = False,
    ) -> int:
        """The index of the mode of a guard; one guard has one mode, whoever asks.

        But for a mode that `compares`.
        """
        modes = self.out.modes
        name: str = comparison_text(at_zero == 0) if compares else kind
        key = (name if table < 0 else f"{kind}{table}", guard)
        found = self.by_guard.get(key)
        if found is not None:
            old = modes[found]
            if holds and not old.holds:
                modes[found] = replace(old, holds=True)
            return found
        index = self.by_guard[key] = len(modes)
        leaf = self.tape.push("mode", payload=index)
        reads_t = "t" in self.tape.leaves([guard])
        timed = linear_in_t(self.tape, guard, self.t) if reads_t else None
        if timed and not self.stands_still(guard):
            timed = None
        modes.append(
            Mode(
                kind,
                guard,
                leaf,
                self.signal,
                text,
                timed,
                holds=holds,
                at_zero=at_zero,
                compares=compares,
                table=table,
            )
        )
        return index

    def memory(self, names: tuple[str, ...]) -> int:
        """The leaf of a new memory with modes of these names."""
        modes = self.out.modes
        leaf = self.tape.push("mode", payload=len(modes))
        start = self.tape.constant(0.0)
        modes.append(Mode("memory", start, leaf, self.signal, "/".join(names), names=names))
        return leaf

    def side(self, condition: int) -> tuple[int, int]:
        """The number of the mode behind a condition, and the value of the mode where it holds."""
        entry = self.tape.entries[condition]
        if entry.op == "not":
            return int(self.tape.entries[entry.operands[0]].payload), 0
        return int(entry.payload), 1

    def choice(self, arguments: tuple[Expression, ...]) -> int:
        condition, then, other = (self.lower(argument) for argument in arguments)
        return self.tape.push("select", condition, then, other)

    def sign(self, arguments: tuple[Expression, ...]) -> int:
        return self.sign_of(self.lower(arguments[0]), to_text(arguments[0]))

    def sign_of(self, guard: int, text: str, holds: bool = False) -> int:
        tape, push = self.tape, self.tape.push
        one = tape.constant(1.0)
        if self.static(guard):
            zero = tape.constant(0.0)
            above = push("select", push("gt", guard, zero), one, zero)
            return push("select", push("ge", guard, zero), above, tape.constant(-1.0))
        if not holds and not self.shares(guard, text):  # of zero it is 0
            reached = self.compare(guard, text, strict=False)
            return push("-", push("+", reached, self.compare(guard, text, strict=True)), one)
        positive = self.positive(guard, text, holds=True) if holds else self.relay(guard, text)
        return push("-", push("*", tape.constant(2.0), positive), one)

    def absolute(self, arguments: tuple[Expression, ...]) -> int:
        value = self.lower(arguments[0])
        positive = self.positive(value, to_text(arguments[0]))
        return self.tape.push("select", positive, value, self.tape.push("neg", value))

    def extreme(self, arguments: tuple[Expression, ...], largest: bool) -> int:
        push = self.tape.push
        result = self.lower(arguments[0])
        for argument in arguments[1:]:
            other = self.lower(argument)
            text = to_text(Call("-", (arguments[0], argument)))
            above = self.positive(push("-", result, other), text)
            pair = (result, other) if largest else (other, result)
            result = push("select", above, *pair)
        return result

    def floor(self, value: int) -> int:
        if self.static(value):
            return self.tape.push("floor", value)
        return self.out.modes[self.mode("floor", value, f"floor in {self.signal}")].leaf

    def random_number(self, arguments: tuple[Expression, ...]) -> int:
        """A random number; its arguments change at events alone, and so it needs no guard."""
        entries = [self.lower(argument) for argument in arguments]
        for entry, argument in zip(entries, arguments, strict=True):
            if not self.static(entry):
                what = f"'{to_text(argument)}' flows, and a random number needs what only jumps"
                raise self.refused(what, "Write random_number(seed, floor(t/period)).")
        return lower_random(self.tape, *entries)

    def modulo(self, arguments: tuple[Expression, ...]) -> int:
        push = self.tape.push
        value, base = (self.lower(argument) for argument in arguments)
        whole = self.floor(push("/", value, base))
        return push("-", value, push("*", base, whole))

    def dry(self, arguments: tuple[Expression, ...]) -> int:
        """slip*sign(u), or a level within +-stick while the mode holds u at zero. What no state
        moves cannot be held: the sign of a prescribed u that rests at zero is 0."""
        push = self.tape.push
        guard, slip, stick = (self.lower(argument) for argument in arguments)
        if self.tape.leaves([guard]) <= PRESCRIBED:
            return push("*", self.sign_of(guard, to_text(arguments[0])), slip)
        sign = self.sign_of(guard, to_text(arguments[0]), holds=True)
        if slip == stick or self.static(guard):
            return push("*", sign, slip)
        mode = next(i for i, m in enumerate(self.out.modes) if m.leaf in self.tape.needed([sign]))
        held = push("hold", payload=mode)
        level = push("select", held, stick, slip)
        return push("*", sign, level)

    def is_held(self, arguments: tuple[Expression, ...]) -> int:
        """1 while the mode of a guard holds it at zero."""
        guard = self.lower(arguments[0])
        if self.static(guard):
            return self.tape.constant(0.0)
        mode, _ = self.side(self.positive(guard, to_text(arguments[0])))
        return self.tape.push("hold", payload=mode)

    def delay(self, arguments: tuple[Expression, ...]) -> int:
        """What a signal was; the entry of the signal itself is for later."""
        known = self.delayed.get(arguments)
        if known is not None:
            return known
        tape, push = self.tape, self.tape.push
        signal, time, before, *bounds = arguments
        own, earlier, text = self.lower(time), self.lower(before), to_text(signal)
        shortest, longest = bounds or (time, time)
        fixed = [self.lower(shortest), self.lower(longest)]
        if not tape.leaves(fixed) <= {"param", "const"}:
            what = f"the delay '{to_text(time)}' of '{text}' changes during a run"
            raise self.refused(what, "Use a block of type variable_delay.")
        if not tape.leaves([earlier]) <= {"t", "param", "const"}:
            what = f"'{to_text(before)}' is given as the past of '{text}', and reads more than t"
            hint = "Before the start there is no state: wire a smooth signal of t and parameters."
            raise self.refused(what, hint)
        s, number = push("-", self.t, own), len(self.out.delays)
        mode = self.mode("delay", s, f"jump of {text}", table=number)
        stretch = self.out.modes[mode].leaf
        kept = push("past", push("history", payload=number), s, stretch)
        begun = push("ge", stretch, tape.constant(1.0))
        told = push("recorded", push("record", payload=number), s)
        is_told = push("ge", s, push("record_begin"))
        earlier = push("select", is_told, told, substitute(tape, earlier, {self.t: s}))
        entry = push("select", begun, kept, earlier)
        self.out.delays.append(Delay(-1, own, fixed[1], mode, shortest, longest, text))
        self.delayed[arguments] = entry
        return entry

    def shift(self, arguments: tuple[Expression, ...]) -> int:
        """What a signal of t alone was."""
        try:
            signals = shift_signals(self.flat, *arguments)
        except ShiftError as error:
            raise self.refused(str(error), error.hint) from None
        self.out.shifts = True
        for name, formula in signals.items():
            if name not in self.out.entries:
                self.out.entries[name] = self.lower(formula)
        return self.out.entries[name]

    def interp(self, arguments: tuple[Expression, ...]) -> int:
        return self.interpolated(self.lower(arguments[0]), table_name(arguments))

    def interpolated(self, value: int, name: str) -> int:
        table = self.out.tables.index(name)
        mode = self.mode("segment", value, f"breakpoint of {name}", table=table)
        return self.tape.push("segment", self.table(name), value, self.out.modes[mode].leaf)

    def curve(self, arguments: tuple[Expression, ...]) -> int:
        value, name = self.lower(arguments[0]), table_name(arguments)
        parts = {part: self.table(f"{name}.{part}") for part in PARTS}
        return lower_curve(self.tape, value, self.interpolated(value, name), parts)

    def table(self, name: str) -> int:
        return self.tape.push("table", payload=self.out.tables.index(name))
