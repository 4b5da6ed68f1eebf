"""Random numbers without a memory: number k of a stream is a function of its seed and of k alone.

x = k mod P goes through five rounds x <- (x + key + c)**3 mod P, where the key is made of the seed
and of floor(k/P); the result is (x + 1/2)/P, between 0 and 1. P is a prime with P mod 3 = 2, so
that each round is a permutation. All numbers are whole and below 2**53: the result is the same to
the bit on each machine, in any order, and for any steps of a run.

Source: the cipher MiMC, M. Albrecht et al., ASIACRYPT 2016, with a small P: for noise, and not for
secrets.
"""

from __future__ import annotations

from tracewire.compile.tape import Tape

P = 33_554_393.0  # the largest prime below 2**25: squares and products are exact
ROUNDS = (0.0, 7_640_891.0, 27_033_781.0, 11_995_407.0, 19_088_743.0)
STRIDE = 6_364_137.0  # of the key from seed to seed, so that near seeds have far keys
BLOCK = 1_442_695.0  # of the key from one P numbers to the next


def lower_random(tape: Tape, seed: int, k: int) -> int:
    """The entry of random number k of a stream: uniform, above 0 and below 1."""
    push, prime = tape.push, tape.constant(P)

    def modulo(value: int) -> int:
        whole = push("floor", push("/", value, prime))
        return push("-", value, push("*", whole, prime))

    def plus(value: int, other: int) -> int:
        return modulo(push("+", value, other))

    stretch = modulo(push("floor", push("/", k, prime)))
    key = modulo(push("*", tape.constant(STRIDE), modulo(push("floor", seed))))
    key = plus(key, modulo(push("*", tape.constant(BLOCK), stretch)))
    x = modulo(k)
    for constant in ROUNDS:
        x = plus(plus(x, key), tape.constant(constant))
        square = modulo(push("*", x, x))
        x = modulo(push("*", square, x))
    # x is whole: its floor says that it is exact, however large the products were (see `sizes`)
    whole = push("floor", x)
    return push("/", push("+", whole, tape.constant(0.5)), prime)
