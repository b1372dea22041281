"""Rates as studies write them."""
import math


def binomial(inside, n):
    """Clopper and Pearson's 95 % interval, by bisection."""
    if n == 0:
        return "–"
    def tail(p, k):
        return sum(math.comb(n, i) * p**i * (1 - p) ** (n - i) for i in range(k, n + 1))
    def solve(f):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if f(middle) else (low, middle)
        return low
    low = 0.0 if inside == 0 else solve(lambda p: tail(p, inside) < 0.025)
    high = 1.0 if inside == n else solve(lambda p: 1 - tail(p, inside + 1) > 0.025)
    return f"{inside} of {n}, {100 * inside / n:.0f} % ({100 * low:.0f}–{100 * high:.0f})"
